//! What a legend says of the cells of a field.

use std::collections::BTreeSet;

use super::colour::{self, LAST_COUNT, Rgb};
use super::gap::Gap;
use super::paint::Paint;
use crate::setting::Field;
use crate::setting::source::{OfRoots, Source};

/// What stands beside the words of an entry.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Mark {
    /// A box of this colour.
    Colour(Rgb),
    /// A box that is filled like cells with this gap.
    Gap(Gap),
}

/// An entry of a legend.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Entry {
    pub mark: Mark,
    /// Its words.
    pub text: String,
    /// Whether the letter after a `_` in them is a subscript.
    pub formula: bool,
}

impl Entry {
    fn of(mark: Mark, text: impl Into<String>) -> Self {
        Self {
            mark,
            text: text.into(),
            formula: false,
        }
    }
}

/// The line above a list of classes; none where there is a bar instead.
pub(crate) fn list_heading(field: Field, paint: &Paint) -> Option<&'static str> {
    match paint {
        Paint::Counts => Some("unstable roots"),
        Paint::Kinds(_) => Some(field.short_name()),
        _ => None,
    }
}

/// The side of a field with two sides that is stable, in words.
pub(crate) fn side(field: Field) -> Option<&'static str> {
    match field.source() {
        Source::Roots(OfRoots::Derivative(_)) => Some("faster decay below 0"),
        _ if field.tells_stable(1.0) == Some(false) => Some("stable below 0"),
        _ if field.tells_stable(-1.0) == Some(false) => Some("stable above 0"),
        _ => None,
    }
}

/// Entries for the classes that occur and for values beyond a bar.
pub(crate) fn entries(field: Field, paint: &Paint, values: &[f64]) -> Vec<Entry> {
    match paint {
        Paint::Counts => counts(values),
        Paint::Kinds(field) => kinds(*field, values),
        _ => paint.beyond(field, values),
    }
}

/// Entries for the gaps that are there.
pub(crate) fn of_gaps(field: Field, there: impl Fn(Gap) -> bool) -> Vec<Entry> {
    let gaps = Gap::ALL.into_iter().filter(|gap| there(*gap));
    gaps.map(|gap| Entry::of(Mark::Gap(gap), gap.words(field)))
        .collect()
}

/// All classes of a field by their numbers, the last one for all larger numbers too; none where its
/// values lie on a scale.
pub(crate) fn classes(field: Field) -> Option<Vec<Entry>> {
    let paint = Paint::of(field, &[]);
    let count = match paint {
        Paint::Counts => LAST_COUNT + 1,
        Paint::Kinds(_) => field.kinds().map_or(colour::last_of_few() + 1, |k| k.len()),
        _ => return None,
    };
    let numbers: Vec<f64> = (0..=count).map(|n| n as f64).collect();
    // A number more than there are: the last class is open, but of kinds.
    let kinds = field.kinds().is_some();
    Some(entries(
        field,
        &paint,
        &numbers[..count + usize::from(!kinds)],
    ))
}

/// The numbers of unstable roots that occur.
fn counts(values: &[f64]) -> Vec<Entry> {
    let finite = || values.iter().copied().filter(|v| v.is_finite());
    let there: BTreeSet<usize> = finite().map(colour::class_of_count).collect();
    let open = finite().any(|v| v > LAST_COUNT as f64);
    let name = |class: usize| match class {
        0 => "0, stable".to_owned(),
        LAST_COUNT if open => format!("{class} or more"),
        _ => class.to_string(),
    };
    let mark = |class: usize| Mark::Colour(colour::of_count(class as f64));
    let entry = |class: usize| Entry::of(mark(class), name(class));
    there.into_iter().map(entry).collect()
}

/// The meaning of a kind of a field, where its name alone is not clear.
fn in_words(field: Field, name: &str) -> &str {
    match (field, name) {
        (Field::Regime, "stable") => "stable, no stick-slip",
        (Field::Regime, "bistable") => "bistable: stick-slip, too",
        (Field::Regime, "lift-off") => "stable, but lifts off",
        _ => name,
    }
}

/// The kinds that occur, or the small counts.
fn kinds(field: Field, values: &[f64]) -> Vec<Entry> {
    let names = field.kinds().unwrap_or_default();
    let finite = || values.iter().copied().filter(|v| v.is_finite());
    let most = finite().fold(0.0, f64::max) as usize;
    let last = colour::last_of_few();
    let name = |number: usize| match names.get(number) {
        Some(name) => in_words(field, name).to_owned(),
        None if number == last && most > last => format!("{number} or more"),
        None => number.to_string(),
    };
    // Larger counts share a colour.
    let largest = if names.is_empty() {
        most.min(last)
    } else {
        most
    };
    let there = |number: usize| match number == largest {
        true => finite().any(|v| v >= number as f64),
        false => values.contains(&(number as f64)),
    };
    let mark = |number: usize| Mark::Colour(colour::of_kind(field, number as f64));
    (0..=largest)
        .filter(|number| there(*number))
        .map(|number| Entry::of(mark(number), name(number)))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_number_has_a_class() {
        let texts = |field| -> Vec<String> {
            let classes = classes(field).unwrap();
            classes.into_iter().map(|class| class.text).collect()
        };
        let counts = texts(Field::NUnstable);
        assert_eq!((counts.len(), &*counts[0]), (LAST_COUNT + 1, "0, stable"));
        assert_eq!(counts[LAST_COUNT], "8 or more");
        assert_eq!(texts(Field::Windows), ["0", "1", "2", "3 or more"]);
        for field in Field::ALL {
            let kinds = field.kinds().map(|kinds| kinds.len());
            let found = classes(field).map(|classes| classes.len());
            assert!(kinds.is_none() || kinds == found, "{}", field.name());
        }
        assert_eq!(classes(Field::Vc), None);
    }
}
