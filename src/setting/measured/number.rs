//! Numbers in cells, with a decimal point or a decimal comma: which of both, the whole text tells.

use crate::setting::unit::Scale;

/// How to write numbers that are understood in one way only.
pub(super) const PLAIN: &str = "write all numbers with a decimal point, or all with a decimal \
    comma and columns separated by `;` or tabs; none with separators of thousands, 1000 and not \
    1,000";

/// What stands before the decimals of a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum DecimalMark {
    Point,
    Comma,
}

impl DecimalMark {
    const fn char(self) -> char {
        match self {
            Self::Point => '.',
            Self::Comma => ',',
        }
    }

    /// The number of a cell; none where it is no number with this mark, or beyond all numbers.
    pub(super) fn number(self, cell: &str) -> Option<f64> {
        finite(&self.plain(cell)?)
    }

    /// The number of a cell times a factor, rounded once.
    pub(super) fn scaled(self, cell: &str, scale: Scale) -> Option<f64> {
        let plain = self.plain(cell)?;
        let number = finite(&plain)?;
        // With an exponent below all numbers it is 0 in any unit.
        Some(scale.of(&plain).unwrap_or(number)).filter(|number| number.is_finite())
    }

    /// A cell with a decimal point; none where it has other marks than those of numbers.
    fn plain(self, cell: &str) -> Option<String> {
        let plain = |c: char| match c {
            '−' => Some('-'),
            c if c == self.char() => Some('.'),
            '0'..='9' | '+' | '-' | 'e' | 'E' => Some(c),
            _ => None,
        };
        cell.chars().map(plain).collect()
    }

    /// The mark of these cells, each with its place.
    ///
    /// # Errors
    /// The place of a cell that leaves open which it is, and why.
    pub(super) fn of<'c, P: Copy + Ord>(
        cells: impl Iterator<Item = (&'c str, P)>,
    ) -> Result<Self, (P, String)> {
        let (mut point, mut comma, mut decimal) = (None, None, false);
        for (cell, place) in cells {
            if is_grouped(cell) {
                return Err((place, format!("{cell} has separators of thousands")));
            }
            let seen = match is_number(cell) {
                true if cell.contains('.') => &mut point,
                true if cell.contains(',') => {
                    decimal |= !may_be_thousands(cell);
                    &mut comma
                }
                _ => continue,
            };
            seen.get_or_insert((place, cell));
        }
        match (point, comma) {
            (_, None) => Ok(Self::Point),
            (None, Some(_)) if decimal => Ok(Self::Comma),
            (None, Some((place, cell))) => {
                let [thousands, decimals] = ["", "."].map(|mark| cell.replace(',', mark));
                Err((place, format!("{cell} may be {decimals} or {thousands}")))
            }
            (Some(one), Some(other)) => {
                let ((_, before), (place, cell)) = (one.min(other), one.max(other));
                let message = format!("{cell} has another decimal mark than {before} before it");
                Err((place, message))
            }
        }
    }
}

/// The number of a text with a decimal point; none where it is beyond all numbers.
fn finite(plain: &str) -> Option<f64> {
    plain.parse().ok().filter(|number: &f64| number.is_finite())
}

/// Whether a cell is a number, with whatever marks in it.
pub(super) fn is_number(cell: &str) -> bool {
    let marks = [DecimalMark::Point, DecimalMark::Comma];
    marks.iter().any(|mark| mark.number(cell).is_some()) || is_grouped(cell)
}

/// Whether digits are grouped by points or commas: 1,234.5 or 1.234.567, but no date.
fn is_grouped(cell: &str) -> bool {
    let digits = cell.trim_start_matches(['+', '-', '−']);
    let allowed = |c: char| c.is_ascii_digit() || c == '.' || c == ',';
    let mut parts = digits.split(['.', ',']);
    let first = parts
        .next()
        .is_some_and(|part| (1..=3).contains(&part.len()));
    let inner: Vec<&str> = parts.collect();
    let grouped = match &inner[..] {
        [groups @ .., _] if inner.len() > 1 => groups.iter().all(|part| part.len() == 3),
        _ => false,
    };
    first && grouped && digits.chars().all(allowed)
}

/// Whether the comma of a number may separate thousands.
fn may_be_thousands(cell: &str) -> bool {
    let digits = cell.trim_start_matches(['+', '-', '−']);
    match digits.split_once(',') {
        Some((before, after)) => {
            let grouped = (1..=3).contains(&before.len()) && after.len() == 3;
            grouped && !before.starts_with('0') && after.bytes().all(|b| b.is_ascii_digit())
        }
        None => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::setting::unit::Unit;
    use crate::setting::units::Units;

    fn mark(cells: &[&str]) -> Result<DecimalMark, String> {
        let cells = cells.iter().enumerate().map(|(at, cell)| (*cell, at));
        DecimalMark::of(cells).map_err(|(_, message)| message)
    }

    #[test]
    fn numbers_are_told_from_other_cells() {
        for cell in [
            "0", "-1.5", "−1,5", "+3e-4", ".5", "5,", "1E3", "0,25e+1", "1,234.5",
        ] {
            assert!(is_number(cell), "{cell}");
        }
        for cell in [
            "", "-", "nan", "inf", "1.2.3", "12:30", "e", "1 000", "0x1", "3 V", "1e999", "-1e999",
        ] {
            assert!(!is_number(cell), "{cell}");
        }
        assert_eq!(DecimalMark::Comma.number("−1,5"), Some(-1.5));
        assert_eq!(DecimalMark::Comma.number("1.5"), None);
        assert_eq!(DecimalMark::Point.number("1,5"), None);
    }

    #[test]
    fn numbers_are_scaled() {
        let thousandth = Unit::read("mm").unwrap().scale_in(&Units::si()).unwrap();
        for (cell, number) in [
            ("−2,4", -0.0024),
            ("+,7e1", 0.007),
            ("5,", 0.005),
            ("1e-99999999999", 0.0),
        ] {
            let scaled = DecimalMark::Comma.scaled(cell, thousandth);
            assert_eq!(scaled, Some(number), "{cell}");
        }
        assert_eq!(DecimalMark::Point.scaled("1,5", Scale::ONE), None);
        assert_eq!(DecimalMark::Point.scaled("e", Scale::ONE), None);
        assert_eq!(DecimalMark::Point.scaled("1e999", Scale::ONE), None);
        assert_eq!(DecimalMark::Point.scaled("1e99999999999", thousandth), None);
    }

    #[test]
    fn the_mark_is_that_of_the_whole_text_or_refused() {
        let (point, comma) = (Ok(DecimalMark::Point), Ok(DecimalMark::Comma));
        assert_eq!(mark(&["0", "12.05.2024", "7"]), point);
        assert_eq!(mark(&["1.000", "2.000"]), point);
        assert_eq!(mark(&["1,000", "0,5"]), comma);
        assert_eq!(mark(&["0,500"]), comma);
        assert_eq!(
            mark(&["1,000", "12,500", "text, text"]).unwrap_err(),
            "1,000 may be 1.000 or 1000"
        );
        assert!(
            mark(&["1.000", "0,5"])
                .unwrap_err()
                .contains("0,5 has another")
        );
        for grouped in ["1,234.5", "1.234,5", "-1,234,567"] {
            assert!(
                mark(&[grouped]).unwrap_err().contains("thousands"),
                "{grouped}"
            );
        }
    }
}
