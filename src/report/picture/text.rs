//! Names, values and units as written in a picture.

use super::font;
use crate::setting::Field;
use crate::setting::Parameter;
use crate::setting::quantity::Quantity;
use crate::setting::source::{OfRoots, Source};
use crate::store::map_file::MapAxis;

pub(super) use crate::meaning::numbers::{number, suffix};

/// Size of subscripts relative to the text.
const SUBSCRIPT_SIZE: f64 = 0.72;
const SUBSCRIPT_DROP: f64 = 0.18;

/// The most characters of a text: a map may come from anywhere, and a picture has no room for more.
const MOST_CHARACTERS: usize = 500;

/// A line of text in which a letter may be a subscript.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(super) struct Rich(Vec<(String, bool)>);

impl Rich {
    /// A text without subscripts. Characters that cannot be drawn are left out.
    pub(super) fn plain(text: &str) -> Self {
        Self::default().and(text)
    }

    /// The symbol of a parameter.
    pub(super) fn symbol(parameter: impl Into<Quantity>) -> Self {
        Self::default().and_symbol(parameter)
    }

    /// The text followed by `text`.
    pub(super) fn and(mut self, text: &str) -> Self {
        let there: usize = self.0.iter().map(|(run, _)| run.chars().count()).sum();
        let shown = text.chars().filter(|c| !c.is_control());
        let text: String = shown.take(MOST_CHARACTERS.saturating_sub(there)).collect();
        match self.0.last_mut() {
            Some((last, false)) => last.push_str(&text),
            _ => self.0.push((text, false)),
        }
        self
    }

    /// The text followed by `other`.
    pub(super) fn then(mut self, other: Self) -> Self {
        for (run, lowered) in other.0 {
            if lowered {
                self.0.push((run, true));
            } else {
                self = self.and(&run);
            }
        }
        self
    }

    /// The text followed by the symbol of a parameter, with its subscript; a name of several
    /// letters is not read as a formula.
    pub(super) fn and_symbol(self, parameter: impl Into<Quantity>) -> Self {
        let parameter = parameter.into();
        let symbol = parameter.symbol();
        match typeset(symbol) {
            Some((base, below)) => {
                let mut text = self.and(&base);
                text.0.push((below.to_owned(), true));
                text
            }
            None if symbol.is_ascii() => self.and(symbol),
            None => self.and_formula(symbol),
        }
    }

    /// A sentence or a title in which names of parameters, such as v0, are set as symbols.
    pub(super) fn prose(text: &str) -> Self {
        let mut prose = Self::default();
        let of_name = |c: char| c.is_alphanumeric() || c == '_';
        let mut left = text;
        while !left.is_empty() {
            let word = left.find(|c| !of_name(c)).unwrap_or(left.len());
            let (name, rest) = left.split_at(word);
            prose = match named(name) {
                Some(parameter) => prose.and_symbol(parameter),
                None => prose.and(name),
            };
            let between = rest.find(of_name).unwrap_or(rest.len());
            prose = prose.and(&rest[..between]);
            left = &rest[between..];
        }
        prose
    }

    /// The text followed by `formula`, in which the letter after each `_` is a subscript.
    pub(super) fn and_formula(self, formula: &str) -> Self {
        let mut parts = formula.split('_');
        let mut text = self.and(parts.next().unwrap_or_default());
        for part in parts {
            let letter = part.chars().next().map_or(0, char::len_utf8);
            text.0.push((part[..letter].to_owned(), true));
            if part.len() > letter {
                text = text.and(&part[letter..]);
            }
        }
        text
    }

    /// Width in pixels at a font size.
    pub(super) fn width(&self, size: f64) -> f64 {
        let runs = self.0.iter();
        runs.map(|(run, lowered)| font::width(run, run_size(size, *lowered)))
            .sum()
    }

    /// The font size, at most `size`, at which the text is no wider than `room`.
    pub(super) fn fitting(&self, size: f64, room: f64) -> f64 {
        size * (room / self.width(size).max(f64::MIN_POSITIVE)).min(1.0)
    }

    /// The runs as (distance from the start, distance below the baseline, font size, text).
    pub(super) fn placed(&self, size: f64) -> Vec<(f64, f64, f64, String)> {
        let mut offset = 0.0;
        let mut runs = Vec::with_capacity(self.0.len());
        for (run, lowered) in self.0.iter().filter(|(run, _)| !run.is_empty()) {
            let drop = if *lowered { SUBSCRIPT_DROP * size } else { 0.0 };
            let size = run_size(size, *lowered);
            runs.push((offset, drop, size, run.clone()));
            offset += font::width(run, size);
        }
        runs
    }
}

/// The parameter of a name that is no English word.
fn named(name: &str) -> Option<Parameter> {
    let no_word = |c: char| c == '_' || c.is_ascii_digit();
    let formal = name.contains(no_word) || letter(name).is_some();
    let parameter = || Parameter::ALL.into_iter().find(|p| p.name() == name);
    formal.then(parameter).flatten()
}

/// A symbol as one letter and its subscript, which may be empty; none where it is neither.
fn typeset(symbol: &str) -> Option<(String, &str)> {
    let digits = symbol.trim_end_matches(|c: char| c.is_ascii_digit());
    let (base, below) = match symbol.split_once('_') {
        Some(parts) => parts,
        None => symbol.split_at(digits.len()),
    };
    let base = letter(base).map_or_else(|| base.to_owned(), String::from);
    let letters = base.chars().filter(|c| c.is_alphanumeric()).count();
    // A dot above its letter is a part of it.
    let short = letters == 1 && base.chars().count() == 1;
    let plain = below.chars().all(char::is_alphanumeric);
    (short && plain).then_some((base, below))
}

/// The Greek letter of this name.
fn letter(name: &str) -> Option<char> {
    const LETTERS: [(&str, char); 20] = [
        ("alpha", 'α'),
        ("beta", 'β'),
        ("gamma", 'γ'),
        ("delta", 'δ'),
        ("epsilon", 'ε'),
        ("zeta", 'ζ'),
        ("eta", 'η'),
        ("theta", 'θ'),
        ("kappa", 'κ'),
        ("lambda", 'λ'),
        ("mu", 'μ'),
        ("nu", 'ν'),
        ("xi", 'ξ'),
        ("rho", 'ρ'),
        ("sigma", 'σ'),
        ("tau", 'τ'),
        ("phi", 'φ'),
        ("chi", 'χ'),
        ("psi", 'ψ'),
        ("omega", 'ω'),
    ];
    LETTERS.iter().find(|row| row.0 == name).map(|row| row.1)
}

fn run_size(size: f64, lowered: bool) -> f64 {
    if lowered { SUBSCRIPT_SIZE * size } else { size }
}

/// "μ′ = −0.3 s m⁻¹".
pub(super) fn assignment(parameter: impl Into<Quantity>, value: f64, unit: &str) -> Rich {
    Rich::symbol(parameter).and(&format!(" = {}{}", number(value), suffix(unit, " ", "")))
}

/// "gain of velocity control α_v (s⁻¹)".
pub(super) fn axis_title(axis: &MapAxis) -> Rich {
    let (long, symbol) = (axis.parameter.long_name(), axis.parameter.symbol());
    // A system's own parameter may have nothing but its name, or a name that is no symbol.
    let named = if long == symbol {
        Rich::symbol(&axis.parameter)
    } else if typeset(symbol).is_none() && symbol.is_ascii() {
        Rich::prose(long)
    } else {
        Rich::prose(long).and("  ").and_symbol(&axis.parameter)
    };
    named.and(&suffix(&axis.unit, "  (", ")"))
}

/// The full meaning of a field.
pub(super) fn field_note(about: &str, unit: &str) -> Rich {
    Rich::prose(about).and(&suffix(unit, "  (", ")"))
}

/// The short name of a field, with its unit.
pub(super) fn field_title(field: Field, unit: &str) -> Rich {
    field_name(field).and(&suffix(unit, "  (", ")"))
}

/// The short name of a field.
pub(super) fn field_name(field: Field) -> Rich {
    let name = field.short_name();
    match field.source() {
        Source::Roots(OfRoots::Derivative(slope)) => {
            let parameter = slope.parameter();
            Rich::plain(name.trim_end_matches(parameter.symbol())).and_symbol(parameter)
        }
        Source::Limit(_) => Rich::default().and_formula(name),
        _ => Rich::plain(name),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_text_is_longer_than_can_be_drawn() {
        let long = Rich::plain(&"long ".repeat(10_000))
            .and("x")
            .and_formula("v_c");
        let runs = long.placed(20.0);
        let characters: usize = runs.iter().map(|(.., run)| run.chars().count()).sum();
        assert!(
            (MOST_CHARACTERS..MOST_CHARACTERS + 3).contains(&characters),
            "{characters}"
        );
    }

    #[test]
    fn symbols_have_subscripts() {
        let runs = |p| Rich::symbol(p).0;
        assert_eq!(
            runs(Parameter::AlphaN),
            [("α".into(), false), ("N".into(), true)]
        );
        assert_eq!(
            runs(Parameter::V0),
            [("v".into(), false), ("0".into(), true)]
        );
        assert_eq!(runs(Parameter::MuPrime), [("μ′".to_string(), false)]);
        assert_eq!(
            runs(Parameter::LoadMin),
            [("N".into(), false), ("min".into(), true)]
        );
        let typeset = |name| super::typeset(name);
        assert_eq!(typeset("zeta"), Some(("ζ".to_owned(), "")));
        assert_eq!(typeset("k_tool"), Some(("k".to_owned(), "tool")));
        assert_eq!(typeset("width"), None);
        let prose = Rich::prose("load control at v0 = 0.2, tau of mu_prime; mass");
        let lowered: Vec<_> = prose.0.iter().filter(|run| run.1).collect();
        assert_eq!(lowered[0].0, "0");
        let all: String = prose.0.iter().map(|run| &*run.0).collect();
        assert_eq!(all, "load control at v0 = 0.2, τ of μ′; mass");
        assert_eq!(
            runs(Parameter::MuRatio),
            [("μ", false), ("K", true), ("/μ", false), ("S", true)].map(|(t, low)| (t.into(), low))
        );
        let text = Rich::symbol(Parameter::AlphaN);
        assert!(text.width(20.0) > Rich::plain("α").width(20.0));
    }
}
