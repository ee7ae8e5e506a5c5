//! What a picture of a map shows where nobody says more: its field, the axes of its plane, and
//! which of the other parameters are told.

use crate::setting::quantity::Quantity;
use crate::setting::{Field, Parameter};

/// The field of a picture: the one `named` by the sweep, else the most informative one that is
/// `held`.
pub(crate) fn field(named: Option<Field>, held: &[Field]) -> Field {
    let named = named.filter(|field| held.contains(field));
    let stability = || held.iter().find(|field| field.tells_stable(0.0).is_some());
    // Reasons come last: most cells are not special.
    let other = || held.iter().find(|field| **field != Field::Reason);
    named
        .or_else(|| says_more(held))
        .or_else(|| stability().or_else(other).copied())
        .unwrap_or(Field::NUnstable)
}

/// A field that shows more than the stability of sliding: the regime, the velocity above which
/// sliding is smooth, the critical velocity, the outcome, or the spectral abscissa.
pub(crate) fn says_more(held: &[Field]) -> Option<Field> {
    let more = [
        Field::Regime,
        Field::VSmooth,
        Field::Vc,
        Field::Outcome,
        Field::Abscissa,
    ];
    more.into_iter().find(|field| held.contains(field))
}

/// Whether a picture tells the value of a parameter that is no axis: those that differ from the
/// default, and the gains, as a gain of 0 means that there is no such control.
pub(crate) fn is_told(parameter: &Quantity, value: f64) -> bool {
    let gain = matches!(
        parameter,
        Quantity::Known(Parameter::AlphaV | Parameter::AlphaN)
    );
    gain || parameter.default_value() != Some(value)
}

/// Facts about the axes of a map, by which those of a plane are chosen.
pub(crate) struct Axes<'a> {
    /// Those with more than one value that are not held at one, in their order.
    pub free: &'a [usize],
    /// The plane of the crossing curves.
    pub boundary: Option<(usize, usize)>,
    /// Whether an axis is the delay.
    pub is_delay: &'a dyn Fn(usize) -> bool,
    /// Whether it is shown as a speed, and therefore from left to right.
    pub is_speed: &'a dyn Fn(usize) -> bool,
}

impl Axes<'_> {
    /// The axes from left to right and from bottom to top; the latter is missing where only one is
    /// free, both where none is.
    pub(crate) fn plane(&self) -> Option<(usize, Option<usize>)> {
        Some(match (self.boundary, self.free) {
            (_, []) => return None,
            (_, &[x]) => (x, None),
            (Some((p, q)), free) if free.contains(&p) && free.contains(&q) => {
                match (self.is_speed)(q) {
                    true => (q, Some(p)),
                    false => (p, Some(q)),
                }
            }
            (_, &[.., a, b]) if (self.is_speed)(a) => (a, Some(b)),
            (_, &[.., a, b]) if (self.is_speed)(b) => (b, Some(a)),
            (_, &[.., a, b]) if (self.is_delay)(a) => (b, Some(a)),
            (_, &[.., a, b]) => (a, Some(b)),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_field_is_the_named_one_or_says_the_most() {
        let held = [Field::NUnstable, Field::Outcome, Field::DelayMargin];
        assert_eq!(field(Some(Field::DelayMargin), &held), Field::DelayMargin);
        assert_eq!(field(Some(Field::Vc), &held), Field::Outcome);
        assert_eq!(field(None, &held[..1]), Field::NUnstable);
        assert_eq!(
            field(None, &[Field::Reason, Field::Windows]),
            Field::Windows
        );
    }

    #[test]
    fn delays_go_up_and_speeds_across() {
        let plane = |free: &[usize], boundary, speed: Option<usize>| {
            let axes = Axes {
                free,
                boundary,
                is_delay: &|axis| axis == 1,
                is_speed: &|axis| Some(axis) == speed,
            };
            axes.plane()
        };
        assert_eq!(plane(&[], None, None), None);
        assert_eq!(plane(&[2], None, None), Some((2, None)));
        assert_eq!(plane(&[0, 1, 2], None, None), Some((2, Some(1))));
        assert_eq!(plane(&[0, 2], None, None), Some((0, Some(2))));
        assert_eq!(plane(&[0, 1, 2], Some((0, 1)), None), Some((0, Some(1))));
        assert_eq!(plane(&[0, 1, 2], Some((0, 1)), Some(1)), Some((1, Some(0))));
        assert_eq!(plane(&[0, 2], Some((0, 1)), Some(2)), Some((2, Some(0))));
    }
}
