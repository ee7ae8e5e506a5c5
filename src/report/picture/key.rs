//! What the colours of a heat map mean: the colour of every value of a field, and the bar or list
//! that says so.

use super::colour::{
    self, ABOVE, BELOW, INFINITE, INK, MINUS_INFINITE, NO_VALUE, Rgb, STABLE, UNSTABLE, ZERO,
};
use super::legend::{Bar, Legend, Swatch};
use super::page::Area;
use super::scale::Scale;
use super::scene::Scene;
use super::text::{Rich, decimal_exponent, field_name, number, suffix};
use crate::report::known::{Gap, Known};
use crate::sweep::Field;
use crate::sweep::input::field::{Spread, Storage};
use crate::sweep::input::source::{OfRoots, Source};

/// Width of boundary lines.
pub(super) const BOUNDARY_WIDTH: f64 = 1.8;
/// The part of all slopes and further roots that the colours tell apart. Near double roots some
/// slopes are beyond any scale, and as the delay vanishes all roots but the rightmost go to −∞.
const TOLD_APART: f64 = 0.96;
/// Decades of a velocity whose colours differ, and that a line shows: it falls to zero faster than
/// any power.
pub(super) const DECADES: i32 = 5;
/// The longest relaxation time that has a colour of its own, in units of the shortest one.
const LONGEST_RELAXATION: f64 = 100.0;

/// The largest ratio of velocities, or of stick times, that are told apart.
const LARGEST_RATIO: f64 = 1000.0;

/// A largest velocity no more than this many times those told apart is within the scale.
const FEW_TIMES: f64 = 5.0;
/// Ends of a scale are rounded.
const ROUNDED: f64 = 1e-9;

/// How values become colours.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Paint {
    /// A colour for each number of unstable roots.
    Counts,
    /// A colour for each kind of this field, or each of its small counts.
    Kinds(Field),
    /// Two colours that meet at zero and are full at ±`range`; `stable` is the sign of the values
    /// on the stable side.
    Signed { range: f64, stable: f64 },
    /// From dark to light along a scale; beyond its ends, at infinity and, where it has none or
    /// `zero` means something of its own, at 0 there are other colours.
    Sized { scale: Scale, zero: bool },
}

impl Paint {
    fn of(field: Field, values: &[f64]) -> Self {
        let finite = || values.iter().copied().filter(|v| v.is_finite());
        let largest = finite().fold(0.0, f64::max);
        match field.spread() {
            _ if matches!(field.storage(), Storage::Kind | Storage::Few) => Self::Kinds(field),
            Spread::Counts => Self::Counts,
            Spread::AboutZero { stable } => Self::Signed {
                range: symmetric_range(finite().map(|v| stable * v)),
                stable,
            },
            Spread::BetterBelow => Self::Signed {
                range: rounded_up(quantile(finite().map(f64::abs), TOLD_APART)),
                stable: -1.0,
            },
            Spread::Relaxation => {
                let positive = finite().filter(|v| *v > 0.0);
                let shortest = positive.fold(f64::INFINITY, f64::min);
                if !shortest.is_finite() {
                    return Self::sized(Scale::linear(0.0, 1.0));
                }
                let longest = largest.clamp(1.5 * shortest, LONGEST_RELAXATION * shortest);
                Self::sized(Scale::logarithmic(shortest, rounded_up(longest)))
            }
            Spread::LongTail => {
                let longest = rounded_up(quantile(finite(), TOLD_APART));
                Self::sized(Scale::linear(0.0, longest))
            }
            Spread::Decades => {
                let scale = Scale::over_decades(finite(), DECADES);
                Self::from_above_zero(scale.unwrap_or(Scale::linear(0.0, 1.0)))
            }
            Spread::RelativeError => Self::Signed {
                range: 1.0,
                stable: 1.0,
            },
            Spread::Magnitudes => {
                let positive = || finite().filter(|v| *v > 0.0);
                let smallest = positive().fold(f64::INFINITY, f64::min);
                let most = match quantile(positive(), TOLD_APART) {
                    most if largest <= FEW_TIMES * most => largest,
                    most => most,
                };
                let most = rounded_up(most);
                Self::from_above_zero(match smallest.max(most / LARGEST_RATIO) {
                    least if least < 0.1 * most => Scale::logarithmic(least, most),
                    _ => Scale::linear(0.0, most),
                })
            }
            Spread::FromZero => Self::sized(Scale::linear(0.0, rounded_up(largest))),
        }
    }

    fn sized(scale: Scale) -> Self {
        Self::Sized { scale, zero: false }
    }

    fn from_above_zero(scale: Scale) -> Self {
        Self::Sized { scale, zero: true }
    }

    fn colour(&self, value: f64) -> Rgb {
        match *self {
            Self::Counts => colour::of_count(value),
            Self::Kinds(field) => colour::of_kind(field, value),
            Self::Signed { range, stable } => colour::diverging(stable * value, range),
            Self::Sized { scale, zero } => match value {
                v if v.is_nan() => NO_VALUE,
                f64::INFINITY => INFINITE,
                f64::NEG_INFINITY => MINUS_INFINITE,
                0.0 if zero || scale.is_logarithmic() => ZERO,
                v if v > scale.value(1.0) * (1.0 + ROUNDED) => ABOVE,
                v if v < scale.value(0.0) * (1.0 - ROUNDED) => BELOW,
                v => colour::of_size(scale.part(v)),
            },
        }
    }

    /// The scale of the bar; none where a list says everything.
    fn scale(&self) -> Option<Scale> {
        match *self {
            Self::Counts | Self::Kinds(_) => None,
            Self::Signed { range, .. } => Some(Scale::linear(-range, range)),
            Self::Sized { scale, .. } => Some(scale),
        }
    }

    /// What is beyond the ends of the bar.
    fn beyond(&self, field: Field, values: &[f64]) -> Vec<(Swatch, Rich)> {
        let mut entries = Vec::new();
        let mut entry = |value: f64, text: String| {
            entries.push((
                Swatch::Box(self.colour(value)),
                Rich::default().and_formula(&text),
            ));
        };
        let (low, high, apart) = match *self {
            Self::Counts | Self::Kinds(_) => return entries,
            Self::Signed { range, .. } => (-range, range, false),
            Self::Sized { scale, zero } => {
                let zero = zero || scale.is_logarithmic();
                (scale.value(0.0), scale.value(1.0), zero)
            }
        };
        let there = |which: &dyn Fn(f64) -> bool| values.iter().copied().find(|v| which(*v));
        let counted = |v: f64| v.is_finite() && !(apart && v == 0.0);
        if let Some(more) = there(&|v| v > high + ROUNDED * high.abs() && counted(v)) {
            entry(more, format!("above {}", number(high)));
        }
        if let Some(less) = there(&|v| v < low - ROUNDED * low.abs() && counted(v)) {
            entry(less, format!("below {}", number(low)));
        }
        if apart && there(&|v| v == 0.0).is_some() {
            entry(0.0, format!("0{}", at_zero(field)));
        }
        for infinite in [f64::INFINITY, f64::NEG_INFINITY] {
            if values.contains(&infinite) {
                let unstable = field.tells_stable(infinite) == Some(false);
                let meaning = match self {
                    Self::Sized { .. } if unstable => ", unstable",
                    _ => "",
                };
                entry(infinite, format!("{}{meaning}", number(infinite)));
            }
        }
        entries
    }
}

/// What a velocity of 0 means.
fn at_zero(field: Field) -> &'static str {
    match field {
        Field::Vc | Field::VcUpper | Field::VcOverVtilde => ": stick-slip never lasts",
        Field::VSmooth => ": smooth at any v_0",
        _ => "",
    }
}

/// What the colours of a field mean, in the panels and beside them.
pub(super) struct Key {
    paint: Paint,
    /// Lines above the bar.
    heading: Vec<Rich>,
    /// What stands below the bar, or alone where there is none.
    legend: Legend,
}

impl Key {
    /// The key to all cells of `planes`; `curves`: boundaries are drawn as well.
    pub(super) fn new(field: Field, unit: &str, planes: &[Known], curves: bool) -> Self {
        let values: Vec<f64> = planes.iter().flat_map(Known::values).collect();
        let paint = Paint::of(field, &values);
        let mut legend = match paint {
            Paint::Counts => counts(&values),
            Paint::Kinds(field) => kinds(field, &values),
            _ => Legend::default(),
        };
        legend.entries.extend(paint.beyond(field, &values));
        legend.entries.extend(of_gaps(field, planes));
        if curves {
            let swatch = Swatch::Line(INK, BOUNDARY_WIDTH, None);
            legend.entries.push((swatch, Rich::plain("boundary")));
        }
        Self {
            paint,
            heading: heading(field, unit),
            legend,
        }
    }

    /// The key with more entries at the end of its list.
    pub(super) fn with(mut self, more: Vec<(Swatch, Rich)>) -> Self {
        self.legend.entries.extend(more);
        self
    }

    /// The colour of a value.
    pub(super) fn colour(&self, value: f64) -> Rgb {
        self.paint.colour(value)
    }

    /// Width in pixels.
    pub(super) fn width(&self, u: f64) -> f64 {
        let colour = |value| self.colour(value);
        let bar = self.bar(&colour).map_or(0.0, |bar| bar.width(u));
        bar.max(self.legend.width(u))
    }

    /// Draws the key into `area`.
    pub(super) fn draw(&self, scene: &mut Scene, area: Area) {
        let colour = |value| self.colour(value);
        let Some(bar) = self.bar(&colour) else {
            return self.legend.draw(scene, area);
        };
        let split = area.bottom - self.legend.height(scene.unit());
        let upper = Area {
            bottom: split,
            ..area
        };
        bar.draw(scene, upper);
        self.legend.draw(scene, Area { top: split, ..area });
    }

    fn bar<'a>(&self, colour: &'a dyn Fn(f64) -> Rgb) -> Option<Bar<'a>> {
        Some(Bar {
            heading: self.heading.clone(),
            scale: self.paint.scale()?,
            colour,
        })
    }
}

/// What of some planes is no value.
pub(super) fn of_gaps(field: Field, planes: &[Known]) -> Vec<(Swatch, Rich)> {
    let there = |gap: &Gap| planes.iter().any(|plane| plane.gaps.contains(&Some(*gap)));
    let entry = |gap: Gap| (Swatch::Gap(gap), Rich::plain(gap.words(field)));
    Gap::ALL.into_iter().filter(there).map(entry).collect()
}

/// The field's name and, where it has two sides, which of them is the stable one.
fn heading(field: Field, unit: &str) -> Vec<Rich> {
    let mut lines = vec![field_name(field).and(&suffix(unit, " (", ")"))];
    let side = match field.source() {
        Source::Roots(OfRoots::Derivative(_)) => Some("faster decay below 0"),
        _ if field.tells_stable(1.0) == Some(false) => Some("stable below 0"),
        _ if field.tells_stable(-1.0) == Some(false) => Some("stable above 0"),
        _ => None,
    };
    lines.extend(side.map(Rich::plain));
    lines
}

fn counts(values: &[f64]) -> Legend {
    let finite = values.iter().copied().filter(|v| v.is_finite());
    let most = finite.fold(0.0, f64::max);
    let mut entries = vec![(Swatch::Box(STABLE), Rich::plain("0, stable"))];
    for (i, colour) in UNSTABLE.into_iter().enumerate() {
        let n = 2 * (i + 1);
        let open = i + 1 == UNSTABLE.len() && most > n as f64;
        let text = if open {
            format!("{n} or more")
        } else {
            n.to_string()
        };
        if n as f64 <= most {
            entries.push((Swatch::Box(colour), Rich::plain(&text)));
        }
    }
    Legend {
        heading: vec![Rich::plain("unstable roots")],
        entries,
    }
}

/// The kinds that there are, or the small counts.
fn kinds(field: Field, values: &[f64]) -> Legend {
    let names = field.kinds().unwrap_or_default();
    let finite = || values.iter().copied().filter(|v| v.is_finite());
    let most = finite().fold(0.0, f64::max) as usize;
    let last = colour::last_of_few();
    let name = |number: usize| match names.get(number) {
        Some(name) => (*name).to_owned(),
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
    Legend {
        heading: vec![Rich::plain(field.short_name())],
        entries: (0..=largest)
            .filter(|number| there(*number))
            .map(|number| {
                let swatch = Swatch::Box(colour::of_kind(field, number as f64));
                (swatch, Rich::plain(&name(number)))
            })
            .collect(),
    }
}

/// The range of colours: the largest finite value of a stable cell, stable being positive, since
/// far outside the stable region the distance to it matters less; but not so small that most of the
/// others lie beyond. 1 where there is no value.
fn symmetric_range(values: impl Iterator<Item = f64>) -> f64 {
    let (mut stable, mut largest) = (0.0, 0.0);
    for value in values {
        stable = f64::max(stable, value);
        largest = f64::max(largest, value.abs());
    }
    rounded_up(f64::max(stable, 0.5 * largest))
}

/// The value below which `part` of the values lie; 0 where there are none.
fn quantile(values: impl Iterator<Item = f64>, part: f64) -> f64 {
    let mut values: Vec<f64> = values.collect();
    let place = (part * values.len() as f64) as usize;
    if place >= values.len() {
        return 0.0;
    }
    *values.select_nth_unstable_by(place, f64::total_cmp).1
}

/// A positive value rounded up to two digits; 1 for 0.
fn rounded_up(value: f64) -> f64 {
    if value == 0.0 {
        return 1.0;
    }
    let unit = 10f64.powi(decimal_exponent(value) - 1);
    (value / unit - 1e-9).ceil() * unit
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::picture::hatch;
    use crate::slip::outcome::Outcome;
    use crate::store::map_file::Plane;
    use crate::sweep::input::regime_at_v0::RegimeAtV0;

    fn plane(cells: &[f64]) -> Known {
        let gap = |value: &f64| value.is_nan().then_some(Gap::NoValue);
        Known {
            plane: Plane {
                rows: vec![0.0],
                columns: (0..cells.len()).map(|i| i as f64).collect(),
                cells: cells.to_vec(),
            },
            gaps: cells.iter().map(gap).collect(),
        }
    }

    fn texts(key: Key) -> Vec<Rich> {
        key.legend.entries.into_iter().map(|e| e.1).collect()
    }

    #[test]
    fn far_values_do_not_stretch_the_range() {
        assert_eq!(symmetric_range([1.5, -2.0].into_iter()), 1.5);
        assert_eq!(symmetric_range([0.001, -2.0].into_iter()), 1.0);
        assert!((rounded_up(2.412) - 2.5).abs() < 1e-12);
        assert_eq!(symmetric_range(std::iter::empty()), 1.0);
        assert_eq!(quantile((0..100).map(f64::from), 0.96), 96.0);
        assert_eq!(quantile(std::iter::empty(), 0.96), 0.0);
    }

    #[test]
    fn the_legend_lists_what_is_there() {
        let key = Key::new(Field::NUnstable, "1", &[plane(&[0.0, 4.0, f64::NAN])], true);
        let expected = ["0, stable", "2", "4", "no value", "boundary"];
        assert_eq!(texts(key), expected.map(Rich::plain));
        let cells = [-0.1, 0.9, f64::NEG_INFINITY];
        let key = Key::new(Field::Abscissa, "1", &[plane(&cells)], false);
        assert_eq!(texts(key), ["above 0.45", "−∞"].map(Rich::plain));
        let cells = [2.0, 900.0, f64::INFINITY];
        let key = Key::new(Field::RelaxationTime, "s", &[plane(&cells)], false);
        assert_eq!(texts(key), ["above 200", "∞, unstable"].map(Rich::plain));
        let cells = [1.0, 3.0, 1.0, f64::NAN];
        let key = Key::new(Field::Outcome, "1", &[plane(&cells)], false);
        assert_eq!(
            texts(key),
            ["stick-slip", "lift-off", "no value"].map(Rich::plain)
        );
    }

    /// No two meanings share a colour, and none has one of the bar.
    #[test]
    fn every_meaning_has_a_colour_of_its_own() {
        let far = [0.0, 0.01, 1.0, 2.0, 3.0, 1e6, f64::INFINITY];
        let wide = far.iter().copied().chain([-1e6, f64::NEG_INFINITY]);
        let mut cells: Vec<f64> = (0..400).map(|i| 1.0 + f64::from(i) * 0.01).collect();
        cells.extend(wide);
        for field in Field::ALL {
            let kinds = field.kinds().map_or(7, |kinds| kinds.len());
            // Undecided ones are hatched.
            let undecided = match field {
                Field::Outcome => Some(Outcome::Undecided as usize),
                Field::Regime => Some(RegimeAtV0::Undecided as usize),
                _ => None,
            };
            let kinds = || (0..kinds).filter(|n| Some(*n) != undecided);
            let numbers = || kinds().map(|n| n as f64).collect::<Vec<_>>();
            let cells = match field.storage() {
                Storage::Real => cells.clone(),
                Storage::Kind | Storage::Few => numbers(),
                Storage::Count => numbers().into_iter().map(|n| 2.0 * n).collect(),
            };
            let mut known = plane(&cells);
            for gap in Gap::ALL.into_iter().filter(|gap| !gap.is_unknown()) {
                known.plane.cells.push(f64::NAN);
                known.gaps.push(Some(gap));
            }
            let key = Key::new(field, "1", &[known], false);
            let colour = |swatch: &Swatch| match swatch {
                Swatch::Box(colour) => *colour,
                Swatch::Gap(gap) => hatch::ground(*gap),
                other => panic!("{other:?}"),
            };
            let mut said: Vec<Rgb> = key.legend.entries.iter().map(|e| colour(&e.0)).collect();
            if let Some(scale) = key.paint.scale() {
                // Colours of scales with two sides go with the square root.
                let parts = (-128..=128).map(|i| f64::from(i) / 128.0);
                let parts = parts.flat_map(|t| [0.5 + 0.5 * t, 0.5 + 0.5 * t * t.abs()]);
                let bar = parts.map(|part| key.colour(scale.value(part)));
                let mut bar: Vec<Rgb> = bar.filter(|colour| *colour != ZERO).collect();
                bar.sort_unstable();
                bar.dedup();
                said.extend(bar);
            }
            let all = said.len();
            said.sort_unstable();
            said.dedup();
            assert_eq!(said.len(), all, "{}", field.name());
            let told = |v: &f64| said.contains(&key.colour(*v));
            assert!(cells.iter().all(told), "{}", field.name());
        }
    }

    #[test]
    fn zero_is_no_small_velocity() {
        let key = Key::new(Field::Vc, "1", &[plane(&[0.0, 0.5, 2.0])], false);
        let said: Vec<_> = key.legend.entries.iter().collect();
        assert_eq!(said.len(), 1);
        assert_eq!(said[0].0, Swatch::Box(ZERO));
        assert_eq!(said[0].1, Rich::plain("0: stick-slip never lasts"));
        assert_ne!(key.colour(0.0), key.colour(1e-9));
    }

    /// What is not known counts for no scale, and is said in words.
    #[test]
    fn the_unknown_is_no_data() {
        let mut known = plane(&[1.0, 2.0, 1e9]);
        known.gaps[2] = Some(Gap::NotConverged);
        let key = Key::new(Field::VSmooth, "1", &[known], false);
        assert!(
            key.paint
                .scale()
                .is_some_and(|scale| scale.value(1.0) < 3.0)
        );
        let said = &key.legend.entries[..];
        let expected = (Swatch::Gap(Gap::NotConverged), Rich::plain("not converged"));
        assert_eq!(said, [expected]);
    }

    /// Teal is stable, whichever sign that is.
    #[test]
    fn every_field_has_its_stable_colour() {
        let stable = colour::diverging(1.0, 1.0);
        for (field, value) in [(Field::DelayMargin, 1.0), (Field::Abscissa, -1.0)] {
            let key = Key::new(field, "1", &[plane(&[value])], false);
            assert_eq!(key.colour(value), stable);
            assert_ne!(key.colour(-value), stable);
        }
    }

    /// Every field makes a key, even of cells that hold nothing.
    #[test]
    fn every_field_has_a_key() {
        for field in Field::ALL {
            for cells in [&[f64::NAN][..], &[0.0], &[f64::INFINITY], &[1.0, 2.0]] {
                let key = Key::new(field, "1", &[plane(cells)], false);
                assert!(key.width(1.0) > 0.0, "{field:?} {cells:?}");
                key.colour(cells[0]);
            }
        }
    }
}
