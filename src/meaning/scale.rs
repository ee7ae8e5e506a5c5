//! From the values of an axis to places along it.

use super::ticks::{self, Tick};
use crate::model::elementary::{ln, log10, pow, power};
use crate::setting::system::Turn;

/// Relative agreement of the ratios of neighbouring values on a logarithmic axis.
const SAME_RATIO: f64 = 1e-6;
/// The smallest factor between the ends of a logarithmic scale that shows more than a linear one.
const SMALLEST_SPAN: f64 = 3.0;
/// The place on a scale of speeds of everything faster.
const FASTER: f64 = 1.5;

/// The spacing of values between the ends.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Spread {
    /// Equal steps.
    Linear,
    /// Equal ratios.
    Logarithmic,
    /// The values are periods, evenly spaced in their speed.
    Speed(Turn),
}

/// A scale between two values.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Scale {
    spread: Spread,
    from: f64,
    to: f64,
    smallest_step: f64,
}

impl Scale {
    /// The scale from the smallest to the largest of `values`; logarithmic if they are spaced so,
    /// also if they are negative.
    pub(crate) fn between(values: &[f64]) -> Self {
        let (from, to) = ends(values);
        Self {
            spread: match log_spaced(values) {
                true => Spread::Logarithmic,
                false => Spread::Linear,
            },
            from,
            to,
            smallest_step: 0.0,
        }
    }

    /// The scale of the speeds of the periods `values`, the slowest to the left; none where fewer
    /// than two are positive. A period of 0 has no place on it.
    pub(crate) fn of_speeds(values: &[f64], turn: Turn) -> Option<Self> {
        let positive: Vec<f64> = values.iter().copied().filter(|v| *v > 0.0).collect();
        let (from, to) = ends(&positive);
        has_speeds(values).then_some(Self {
            spread: Spread::Speed(turn),
            from,
            to,
            smallest_step: 0.0,
        })
    }

    /// A linear scale between two different values.
    pub(crate) fn linear(from: f64, to: f64) -> Self {
        Self {
            spread: Spread::Linear,
            from,
            to,
            smallest_step: 0.0,
        }
    }

    /// A logarithmic scale between two different positive values.
    pub(crate) fn logarithmic(from: f64, to: f64) -> Self {
        Self {
            spread: Spread::Logarithmic,
            ..Self::linear(from, to)
        }
    }

    /// A logarithmic scale over all positive `values` or, if they spread wider, over the uppermost
    /// `decades` and part of one; none without a positive value.
    pub(crate) fn over_decades(values: impl Iterator<Item = f64>, decades: i32) -> Option<Self> {
        let positive = values.filter(|v| v.is_finite() && *v > 0.0);
        let (low, high) = positive.fold((f64::INFINITY, 0.0), |(low, high), v| {
            (f64::min(low, v), f64::max(high, v))
        });
        let lowest = power(10.0, (log10(high).floor() as i32).saturating_sub(decades));
        (high > 0.0).then(|| Self::logarithmic(f64::max(low / 1.3, lowest), high * 1.3))
    }

    /// True for a logarithmic scale.
    pub(crate) fn is_logarithmic(&self) -> bool {
        self.spread == Spread::Logarithmic
    }

    /// This scale with ticks at least this far apart.
    pub(crate) fn with_smallest_step(self, smallest_step: f64) -> Self {
        Self {
            smallest_step,
            ..self
        }
    }

    /// The position of a value: 0 at the lower end, 1 at the upper one.
    pub(crate) fn part(&self, value: f64) -> f64 {
        match self.spread {
            Spread::Logarithmic => ln(value / self.from) / ln(self.to / self.from),
            Spread::Linear => (value - self.from) / (self.to - self.from),
            Spread::Speed(turn) => {
                let (slowest, fastest) = (turn.over(self.to), turn.over(self.from));
                let speed = turn.over(value.max(f64::MIN_POSITIVE));
                // Everything faster than the scale is put just beyond its end.
                ((speed - slowest) / (fastest - slowest)).min(FASTER)
            }
        }
    }

    /// The value at a position.
    pub(crate) fn value(&self, part: f64) -> f64 {
        match self.spread {
            Spread::Logarithmic => self.from * pow(self.to / self.from, part),
            Spread::Linear => self.from + (self.to - self.from) * part,
            Spread::Speed(turn) => {
                let (slowest, fastest) = (turn.over(self.to), turn.over(self.from));
                // The conversion from speed to period is the same as from period to speed.
                turn.over(slowest + (fastest - slowest) * part)
            }
        }
    }

    /// Its values at part 0 and at part 1.
    pub(crate) fn ends(&self) -> (f64, f64) {
        (self.value(0.0), self.value(1.0))
    }

    /// True if the value lies on the scale.
    pub(crate) fn holds(&self, value: f64) -> bool {
        (-1e-9..=1.0 + 1e-9).contains(&self.part(value))
    }

    /// Ticks at round values, about `most` of them with a label.
    pub(crate) fn ticks(&self, most: usize) -> Vec<Tick> {
        match self.spread {
            Spread::Logarithmic if self.to < 0.0 => {
                let mirrored = ticks::logarithmic(-self.to, -self.from, most).into_iter();
                mirrored.rev().map(Tick::mirrored).collect()
            }
            Spread::Logarithmic => ticks::logarithmic(self.from, self.to, most),
            Spread::Linear => ticks::linear(self.from, self.to, most, self.smallest_step),
            Spread::Speed(turn) => {
                let (slowest, fastest) = (turn.over(self.to), turn.over(self.from));
                let of_speed = ticks::linear(slowest, fastest, most, self.smallest_step);
                let period = |tick: Tick| Tick {
                    value: turn.over(tick.value),
                    ..tick
                };
                let moving = of_speed.into_iter().filter(|tick| tick.value > 0.0);
                moving.map(period).collect()
            }
        }
    }

    /// The edges of the cells of `values`, one more than there are cells: midpoints on the scale,
    /// and as far beyond the ends. For periods the outer edges are the end values themselves.
    pub(crate) fn edges(&self, values: &[f64]) -> Vec<f64> {
        let middle = |a: f64, b: f64| match self.spread {
            Spread::Logarithmic => (a * b).sqrt().copysign(a),
            Spread::Linear | Spread::Speed(_) => 0.5 * (a + b),
        };
        let mirrored = |end: f64, edge: f64| match self.spread {
            Spread::Logarithmic => end * end / edge,
            Spread::Linear => 2.0 * end - edge,
            Spread::Speed(_) => end,
        };
        let inner: Vec<f64> = values.windows(2).map(|w| middle(w[0], w[1])).collect();
        let (Some(&first), Some(&last)) = (values.first(), values.last()) else {
            return Vec::new();
        };
        let mut edges = Vec::with_capacity(values.len() + 1);
        edges.push(mirrored(first, inner.first().copied().unwrap_or(first)));
        edges.extend(&inner);
        edges.push(mirrored(last, inner.last().copied().unwrap_or(last)));
        edges
    }

    /// The edges of cells that fill the scale: the first and the last one reach its ends.
    pub(crate) fn filling_edges(&self, values: &[f64]) -> Vec<f64> {
        let mut edges = self.edges(values);
        let growing = values.first() <= values.last();
        let (first, last) = if growing {
            (self.from, self.to)
        } else {
            (self.to, self.from)
        };
        if let [a, .., b] = edges.as_mut_slice() {
            (*a, *b) = (first, last);
        }
        edges
    }
}

/// Whether periods have a scale of speeds: two different ones are positive.
pub(crate) fn has_speeds(values: &[f64]) -> bool {
    let positive: Vec<f64> = values.iter().copied().filter(|v| *v > 0.0).collect();
    let (from, to) = ends(&positive);
    positive.len() > 1 && from < to
}

/// The smallest and the largest of some values; 0 and 1 where there are none.
pub(crate) fn ends(values: &[f64]) -> (f64, f64) {
    let both = values.iter().fold(None, |ends, &v| match ends {
        None => Some((v, v)),
        Some((low, high)) => Some((f64::min(low, v), f64::max(high, v))),
    });
    both.unwrap_or((0.0, 1.0))
}

fn log_spaced(values: &[f64]) -> bool {
    let (low, high) = ends(values);
    let span = (high / low).max(low / high);
    if values.len() < 3 || low * high <= 0.0 || span < SMALLEST_SPAN {
        return false;
    }
    let ratio = pow(
        values[values.len() - 1] / values[0],
        1.0 / (values.len() - 1) as f64,
    );
    values
        .windows(2)
        .all(|w| (w[1] / w[0] / ratio - 1.0).abs() < SAME_RATIO)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::setting::system::SpeedUnit;
    use crate::setting::units::Units;

    #[test]
    fn cells_of_uneven_values_end_midway() {
        let values = [-0.1, -0.2, -0.5, -1.5];
        let edges = Scale::between(&values).filling_edges(&values);
        for (edge, expected) in edges.iter().zip([-0.1, -0.15, -0.35, -1.0, -1.5]) {
            assert!((edge - expected).abs() < 1e-12, "{edges:?}");
        }
    }

    #[test]
    fn equal_ratios_make_a_logarithmic_scale() {
        let values = [0.01, 0.1, 1.0, 10.0];
        let scale = Scale::between(&values);
        assert!((scale.part(0.1) - 1.0 / 3.0).abs() < 1e-12);
        assert!((scale.value(2.0 / 3.0) - 1.0).abs() < 1e-12);
        assert!((scale.edges(&values)[1] - 0.1f64.powf(1.5)).abs() < 1e-12);
        for linear in [&[1.0, 2.0, 3.0][..], &[-4.0, -2.0, 1.0], &[1.0, 4.0]] {
            assert!(!Scale::between(linear).is_logarithmic(), "{linear:?}");
        }
    }

    #[test]
    fn negative_values_have_the_mirrored_scale() {
        let values = [-10.0, -1.0, -0.1, -0.01];
        let scale = Scale::between(&values);
        assert!((scale.part(-1.0) - 1.0 / 3.0).abs() < 1e-12);
        assert!((scale.value(2.0 / 3.0) + 0.1).abs() < 1e-12);
        assert!((scale.edges(&values)[1] + 10f64.powf(0.5)).abs() < 1e-12);
        let ticks = scale.ticks(5);
        let labelled: Vec<_> = ticks.iter().filter(|t| t.label.is_some()).collect();
        assert_eq!(labelled.iter().map(|t| t.value).collect::<Vec<_>>(), values);
        assert_eq!(labelled[0].label.as_deref(), Some("−10"));
        assert!(ticks.windows(2).all(|w| w[0].value < w[1].value));
    }

    #[test]
    fn decades_end_at_a_power_of_ten() {
        let scale = |values: &[f64]| Scale::over_decades(values.iter().copied(), 3);
        let ends = |values: &[f64]| scale(values).map(|s| (s.value(0.0), s.value(1.0)));
        assert_eq!(ends(&[1e-9, 0.0, 20.0]), Some((0.01, 26.0)));
        assert_eq!(ends(&[1.3, 10.0, f64::INFINITY]), Some((1.0, 13.0)));
        assert_eq!(scale(&[0.0, -1.0, f64::NAN]), None);
    }

    #[test]
    fn periods_lie_by_their_speeds() {
        let rpm = SpeedUnit::RevolutionsPerMinute;
        let turn = rpm.turn(&Units::si()).unwrap();
        let scale = Scale::of_speeds(&[0.0, 0.01, 0.02, 0.04], turn).unwrap();
        // 1500, 3000 and 6000 rpm.
        for (period, part) in [(0.04, 0.0), (0.02, 1.0 / 3.0), (0.01, 1.0), (0.0, FASTER)] {
            assert!((scale.part(period) - part).abs() < 1e-12, "{period}");
        }
        assert!((scale.value(1.0 / 3.0) - 0.02).abs() < 1e-12);
        let ticks = scale.ticks(5);
        let labels: Vec<_> = ticks.iter().filter_map(|t| t.label.as_deref()).collect();
        assert_eq!(labels, ["2000", "3000", "4000", "5000", "6000"]);
        assert!((ticks[1].value - 0.02).abs() < 1e-15);
        let edges = scale.filling_edges(&[0.0, 0.01, 0.02, 0.04]);
        assert_eq!(edges.first(), Some(&0.01));
        assert_eq!(edges.last(), Some(&0.04));
        assert_eq!(Scale::of_speeds(&[0.0, 1.0], turn), None);
    }

    #[test]
    fn thinned_cells_reach_the_ends() {
        let all: Vec<f64> = (0..10).map(f64::from).collect();
        let scale = Scale::between(&all);
        let edges = scale.filling_edges(&[0.0, 4.0, 8.0]);
        assert_eq!(edges, [0.0, 2.0, 6.0, 9.0]);
        let falling: Vec<f64> = all.iter().rev().copied().collect();
        let edges = Scale::between(&falling).filling_edges(&[9.0, 5.0, 1.0]);
        assert_eq!(edges, [9.0, 7.0, 3.0, 0.0]);
    }
}
