//! Round values along an axis.

use super::numbers::{decimal_exponent, tick_number};
use crate::model::elementary::{log10, power};

/// A mark on an axis.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Tick {
    /// The value that it marks.
    pub value: f64,
    /// Its text; none for a minor tick.
    pub label: Option<String>,
}

impl Tick {
    /// The tick at the negative of this one's value, which is positive.
    pub(crate) fn mirrored(self) -> Self {
        Self {
            value: -self.value,
            label: self.label.map(|label| format!("−{label}")),
        }
    }
}

/// Decades in which numbers are written without a power of ten: from 0.001 up to 99999.
const PLAIN: std::ops::Range<i32> = -3..5;

/// Ticks from `from` to `to` at steps of 1, 2 or 5 times a power of ten: at most `most`, and at
/// least `smallest_step` apart.
pub(crate) fn linear(from: f64, to: f64, most: usize, smallest_step: f64) -> Vec<Tick> {
    let rough = ((to - from) / most.max(1) as f64).max(smallest_step);
    let step = round_step(rough);
    if !(step.is_finite() && step > 0.0) {
        return Vec::new();
    }
    let (first, last) = ((from / step - 1e-9).ceil(), (to / step + 1e-9).floor());
    let largest = from.abs().max(to.abs());
    // In a very narrow range far from zero, ticks could not be told apart.
    let few = (0.0..=2.0 * most as f64 + 2.0).contains(&(last - first));
    if !few || largest / step > 1e12 {
        return Vec::new();
    }
    let exponent = decimal_exponent(largest);
    let power = (!PLAIN.contains(&exponent)).then_some(exponent);
    let decimals = power.unwrap_or(0) - log10(step).floor() as i32;
    (0..=(last - first) as u64)
        .map(|i| {
            let value = (first + i as f64) * step;
            let label = tick_number(value, decimals.max(0) as usize, power);
            Tick {
                value,
                label: Some(label),
            }
        })
        .collect()
}

/// The smallest of 1, 2, 5 times a power of ten that is at least `rough`.
fn round_step(rough: f64) -> f64 {
    let power = power(10.0, log10(rough).floor() as i32);
    let factors = [1.0, 2.0, 5.0, 10.0];
    let factor = factors.into_iter().find(|f| f * power >= rough * 0.999_999);
    factor.unwrap_or(10.0) * power
}

/// Ticks at 1 to 9 times powers of ten; labels at the powers, and at 2 and 5 times them over a
/// short range, if `most` leaves room for them.
pub(crate) fn logarithmic(from: f64, to: f64, most: usize) -> Vec<Tick> {
    let (low, high) = (log10(from).floor() as i32, log10(to).ceil() as i32);
    let decades = log10(to / from);
    let every = (decades / most.max(1) as f64).ceil().max(1.0) as i32;
    let labelled = |digit: i32, exponent: i32| match digit {
        1 => exponent.rem_euclid(every) == 0,
        2 | 5 => decades < 2.5 && 3.0 * decades <= most as f64,
        _ => false,
    };
    let plain = PLAIN.contains(&low) && PLAIN.contains(&high);
    let mut ticks = Vec::new();
    for exponent in low..=high {
        for digit in 1..=9 {
            let value = f64::from(digit) * power(10.0, exponent);
            if value < from * (1.0 - 1e-9) || value > to * (1.0 + 1e-9) {
                continue;
            }
            let label = labelled(digit, exponent).then(|| {
                let decimals = (-exponent).max(0) as usize;
                if plain {
                    tick_number(value, decimals, None)
                } else {
                    tick_number(value, 0, Some(exponent))
                }
            });
            // Over many decades the minor ticks would run together.
            if label.is_some() || every == 1 {
                ticks.push(Tick { value, label });
            }
        }
    }
    if ticks.iter().filter(|t| t.label.is_some()).count() < 2 {
        return linear(from, to, most, 0.0);
    }
    ticks
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(ticks: &[Tick]) -> Vec<&str> {
        ticks.iter().filter_map(|t| t.label.as_deref()).collect()
    }

    #[test]
    fn linear_ticks_are_round_and_inside() {
        let ticks = linear(-1.6, 0.4, 10, 0.0);
        assert_eq!(labels(&ticks)[0], "−1.6");
        assert_eq!(labels(&ticks)[8], "0.0");
        assert_eq!(ticks.len(), 11);
        assert_eq!(labels(&linear(0.0, 12.0, 6, 0.0))[1], "2");
        assert_eq!(labels(&linear(0.0, 2.0, 8, 2.0)), ["0", "2"]);
        let ticks = linear(0.0, 3e-9, 4, 0.0);
        assert_eq!(
            labels(&ticks),
            ["0", "1 × 10⁻⁹", "2 × 10⁻⁹", "3 × 10⁻⁹"].map(|l| l.replace("1 × ", ""))
        );
    }

    #[test]
    fn impossible_ranges_have_no_ticks() {
        assert!(linear(1.0, 1.0 + 1e-15, 5, 0.0).is_empty());
        assert!(linear(f64::NAN, 1.0, 5, 0.0).is_empty());
    }

    #[test]
    fn decades_are_labelled() {
        let ticks = logarithmic(0.01, 100.0, 8);
        assert_eq!(labels(&ticks), ["0.01", "0.1", "1", "10", "100"]);
        assert_eq!(ticks.len(), 4 * 9 + 1);
        assert_eq!(
            labels(&logarithmic(0.1, 1.0, 8)),
            ["0.1", "0.2", "0.5", "1"]
        );
        assert_eq!(labels(&logarithmic(1e-9, 1e3, 5)).len(), 5);
    }
}
