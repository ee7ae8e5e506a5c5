//! The axes of a sweep.

use super::parameter::Parameter;
use super::quantity::Quantity;
use crate::model::elementary::pow;
use crate::text::{Shown, SpecError};

/// The most points of one axis.
pub const MOST_POINTS: u64 = 10_000_000;

/// How the values of an axis are spaced.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Spacing {
    /// Equal steps.
    Linear,
    /// Equal ratios; all values on one side of 0.
    Log,
}

/// A parameter that a sweep varies, with its values: strictly increasing or strictly decreasing.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// The parameter.
    pub parameter: Quantity,
    /// Its values, at least one.
    pub values: Vec<f64>,
}

/// The axes (p, q) of the planes in which curves can be traced. If the delay varies, it is q, and p
/// is the last gain axis, or else the last other axis on which linear stability depends. Without a
/// delay axis, p and q are the last two such axes. Only axes with at least two values count; none
/// where there are fewer than two of them.
#[must_use]
pub fn plane_of_curves(axes: &[Axis]) -> Option<(usize, usize)> {
    let matters = spans_curves;
    let is_delay = |axis: &Axis| axis.parameter == Parameter::Tau;
    let is_gain =
        |axis: &Axis| axis.parameter == Parameter::AlphaV || axis.parameter == Parameter::AlphaN;
    let place = |wanted: &dyn Fn(&Axis) -> bool| {
        axes.iter().rposition(|axis| matters(axis) && wanted(axis))
    };
    if let Some(tau) = place(&is_delay) {
        let p = place(&is_gain).or_else(|| place(&|axis| !is_delay(axis)))?;
        return Some((p, tau));
    }
    let q = place(&|_| true)?;
    let p = axes[..q].iter().rposition(matters)?;
    Some((p, q))
}

/// Whether an axis can be one of a plane of curves: it has two values or more, and linear stability
/// depends on it.
#[must_use]
pub fn spans_curves(axis: &Axis) -> bool {
    let of_start = axis.parameter.known().is_some_and(Parameter::of_start);
    axis.len() > 1 && !of_start
}

/// `points` values from `from` to `to`, each computed from its index alone. Both ends are exact.
///
/// # Errors
/// When the ends are reversed or equal, the number of points is out of range, a logarithmic axis
/// reaches zero, or neighbouring values coincide in double precision.
pub fn spaced(from: f64, to: f64, points: u64, spacing: Spacing) -> Result<Vec<f64>, SpecError> {
    let refuse = |message: String| Err(SpecError::whole(message));
    if !(2..=MOST_POINTS).contains(&points) {
        return refuse(format!(
            "points = {points} is outside its range: 2 to {MOST_POINTS} (for one value write a \
            list of one)"
        ));
    }
    if from.partial_cmp(&to) != Some(std::cmp::Ordering::Less) {
        return refuse(format!(
            "the range is empty or reversed: from = {} must be less than to = {}",
            Shown(from),
            Shown(to)
        ));
    }
    if spacing == Spacing::Log && from <= 0.0 && to >= 0.0 {
        return refuse(format!(
            "a logarithmic axis needs from and to on the same side of 0, here from = {}, to = {}",
            Shown(from),
            Shown(to)
        ));
    }
    let last = points - 1;
    let value = |i: u64| {
        let part = i as f64 / last as f64;
        match spacing {
            _ if i == 0 => from,
            _ if i == last => to,
            Spacing::Linear => from + (to - from) * part,
            Spacing::Log => from * pow(to / from, part),
        }
    };
    let values: Vec<f64> = (0..points).map(value).collect();
    if values.windows(2).any(|w| w[0] >= w[1]) {
        return refuse(format!(
            "{points} points between {} and {} are closer together than double precision resolves",
            Shown(from),
            Shown(to)
        ));
    }
    Ok(values)
}

/// The index of the value nearest to `value`; `values` has at least one.
///
/// # Errors
/// The range of `values`, if `value` is NaN or lies outside it by more than rounding.
pub fn nearest(values: &[f64], value: f64) -> Result<usize, [f64; 2]> {
    let from = values.iter().copied().fold(f64::INFINITY, f64::min);
    let to = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let slack = 1e-9 * from.abs().max(to.abs());
    if !(from - slack..=to + slack).contains(&value) {
        return Err([from, to]);
    }
    let distance = |i: &usize| (values[*i] - value).abs();
    let nearest = (0..values.len()).min_by(|a, b| distance(a).total_cmp(&distance(b)));
    Ok(nearest.unwrap_or(0))
}

impl Axis {
    /// An axis of `parameter` with these values.
    ///
    /// # Errors
    /// When a value is outside the parameter's range, or the values are not strictly monotonic.
    /// Delays must increase.
    pub fn new(parameter: impl Into<Quantity>, values: Vec<f64>) -> Result<Self, SpecError> {
        let parameter = parameter.into();
        if values.is_empty() {
            return Err(SpecError::whole("the list is empty"));
        }
        for &value in &values {
            parameter.check(value).map_err(SpecError::whole)?;
        }
        let increasing = values.windows(2).all(|w| w[0] < w[1]);
        let decreasing = values.windows(2).all(|w| w[0] > w[1]);
        if parameter == Parameter::Tau && !increasing {
            return Err(SpecError::whole(
                "values of tau must be strictly increasing",
            ));
        }
        if !(increasing || decreasing) {
            return Err(SpecError::whole(
                "the values must be strictly increasing or strictly decreasing",
            ));
        }
        Ok(Self { parameter, values })
    }

    /// Number of values, at least 1.
    #[must_use]
    #[allow(clippy::len_without_is_empty)]
    pub fn len(&self) -> usize {
        self.values.len()
    }

    /// The smallest and the largest value.
    #[must_use]
    pub fn range(&self) -> (f64, f64) {
        let (first, last) = (self.values[0], self.values[self.len() - 1]);
        (first.min(last), first.max(last))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_come_from_their_index_and_ends_are_exact() {
        let values = spaced(-1.6, 0.4, 801, Spacing::Linear).unwrap();
        assert_eq!((values[0], values[800]), (-1.6, 0.4));
        assert_eq!(values[400], -1.6 + 2.0 * 0.5);
        let values = spaced(1e-3, 1e3, 7, Spacing::Log).unwrap();
        assert_eq!((values[0], values[6]), (1e-3, 1e3));
        assert!((values[3] - 1.0).abs() < 1e-14);
        let mirrored = spaced(-1e3, -1e-3, 7, Spacing::Log).unwrap();
        assert_eq!((mirrored[0], mirrored[6]), (-1e3, -1e-3));
        assert!((mirrored[3] + 1.0).abs() < 1e-14);
    }

    #[test]
    fn the_nearest_value_must_lie_on_the_axis() {
        let values = [-0.05, -0.1, -0.2];
        assert_eq!(nearest(&values, -0.09), Ok(1));
        assert_eq!(nearest(&values, -0.2 - 1e-12), Ok(2));
        assert_eq!(nearest(&[0.0], 0.0), Ok(0));
        for outside in [-0.21, 0.0, f64::NAN, f64::INFINITY] {
            assert_eq!(nearest(&values, outside), Err([-0.2, -0.05]));
        }
    }

    #[test]
    fn impossible_ranges_are_refused() {
        for (from, to, points, spacing, says) in [
            (1.0, 0.0, 10, Spacing::Linear, "reversed"),
            (1.0, 1.0, 10, Spacing::Linear, "empty"),
            (f64::NAN, 1.0, 10, Spacing::Linear, "reversed"),
            (0.0, 1.0, 1, Spacing::Linear, "points = 1"),
            (0.0, 1.0, u64::MAX, Spacing::Linear, "outside its range"),
            (0.0, 1.0, 10, Spacing::Log, "same side of 0"),
            (-1.0, 0.0, 10, Spacing::Log, "same side of 0"),
            (-1.0, 1.0, 10, Spacing::Log, "same side of 0"),
            (1.0, 1.0 + 1e-15, 1000, Spacing::Linear, "double precision"),
        ] {
            let error = spaced(from, to, points, spacing).unwrap_err();
            assert!(error.message.contains(says), "{error}");
        }
    }

    #[test]
    fn lists_must_be_monotonic_and_in_range() {
        assert!(Axis::new(Parameter::MuPrime, vec![-0.1, -0.2, -0.5]).is_ok());
        assert!(Axis::new(Parameter::MuPrime, vec![-0.1, -0.2, -0.2]).is_err());
        assert!(Axis::new(Parameter::MuPrime, vec![]).is_err());
        assert!(Axis::new(Parameter::Tau, vec![2.0, 1.0]).is_err());
        assert!(Axis::new(Parameter::Tau, vec![-1.0, 1.0]).is_err());
        assert!(Axis::new(Parameter::Mass, vec![0.0]).is_err());
        assert!(Axis::new(Parameter::AlphaV, vec![f64::INFINITY]).is_err());
        assert!(Axis::new(Parameter::AlphaV, vec![f64::NAN]).is_err());
    }
}
