//! The stability of sliding over the delays of a line: the number of unstable roots in steps, and
//! the stable delays.

use std::f64::consts::TAU;

use crate::linear::Crossings;
use crate::linear::crossing::Crossing;
use crate::linear::stable_delays::StableInterval;
use crate::model::ModelError;
use crate::sweep::{Parameter, Setting};

/// Near a tangency there can be millions of stable intervals; the delays go on to the end of this
/// one.
const INTERVALS: usize = 12;
/// More crossings than this are not told one by one: the number is told at as many places. Nor are
/// more stable intervals.
const MOST_STEPS: u64 = 2000;
/// The longest delay told, over the longest one that matters.
const BEYOND: f64 = 1.15;

/// The delays of a line from 0 on, as far as they matter: to the setting's own, the first
/// crossings and the ends of the stable intervals. In the units of the setting.
#[derive(Debug, Clone, PartialEq)]
pub struct AlongDelay {
    /// Delays (from, to) with the number of unstable roots between, one after the other from 0 to
    /// `until`.
    pub steps: Vec<(f64, f64, u64)>,
    /// The longest delay told.
    pub until: f64,
    /// The stable intervals that begin before that, by growing delay.
    pub stable: Vec<StableInterval>,
    /// Others follow at longer delays.
    pub more_stable: bool,
}

impl AlongDelay {
    /// The line of a setting with all its parameters.
    ///
    /// # Errors
    /// When a parameter is outside the model's range.
    pub fn of(setting: &Setting) -> Result<Self, ModelError> {
        let (groups, time_unit) = setting.groups()?;
        let crossings = Crossings::of(groups).in_physical_time(time_unit);
        let first: Vec<StableInterval> = crossings.stable_delays().take(INTERVALS).collect();
        let until = longest(&crossings, &first, setting.get(Parameter::Tau));
        let mut intervals = crossings.stable_delays().peekable();
        let told = || intervals.next_if(|interval| interval.from < until);
        let stable = std::iter::from_fn(told).take(MOST_STEPS as usize).collect();
        Ok(Self {
            steps: steps(&crossings, until),
            until,
            stable,
            more_stable: intervals.peek().is_some(),
        })
    }
}

/// Until where the line is told.
fn longest(crossings: &Crossings, stable: &[StableInterval], tau: f64) -> f64 {
    let first = crossings.iter().map(|c| c.delay(c.first_branch));
    let ends = stable.iter().flat_map(|s| [s.from, s.to]);
    let finite = first.chain(ends).filter(|delay| delay.is_finite());
    let matters = finite.fold(tau, f64::max);
    match matters {
        0.0 => TAU * crossings.time_unit,
        _ => BEYOND * matters,
    }
}

/// The number of unstable roots from 0 to `until`.
fn steps(crossings: &Crossings, until: f64) -> Vec<(f64, f64, u64)> {
    let moving = || [&crossings.upper, &crossings.lower].into_iter().flatten();
    let count: u64 = moving().map(|c| c.count_below(until)).sum();
    let mut edges: Vec<f64> = if count <= MOST_STEPS {
        moving().flat_map(|c| crossing_delays(*c, until)).collect()
    } else {
        let place = |i| until * i as f64 / MOST_STEPS as f64;
        (1..MOST_STEPS).map(place).collect()
    };
    edges.extend([0.0, until]);
    edges.sort_by(f64::total_cmp);
    edges.dedup();
    let between = |pair: &[f64]| {
        let (from, to) = (pair[0], pair[1]);
        (from, to, crossings.n_unstable(from + 0.5 * (to - from)))
    };
    edges.windows(2).map(between).collect()
}

/// The delays of one crossing below `until`.
fn crossing_delays(crossing: Crossing, until: f64) -> impl Iterator<Item = f64> {
    let first = crossing.first_branch;
    (0..crossing.count_below(until)).map(move |i| crossing.delay(first + i))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sweep::input::point_file::{PointOf, PointSpec};

    fn along(fixed: &str) -> AlongDelay {
        let point = PointSpec::read(&format!("[fixed]\n{fixed}"), PointOf::Sliding).unwrap();
        AlongDelay::of(&point.setting).unwrap()
    }

    /// The count is 0 exactly between the ends of the stable intervals, which have another formula.
    #[test]
    fn steps_and_stable_intervals_agree() {
        for fixed in [
            "mu_prime = -0.3\nalpha_v = -0.33\ntau = 4.15\n",
            "mu_prime = -0.1\nalpha_n = 0.3\ntau = 5.5\n",
            "mu_prime = -0.2\nalpha_v = -0.4\ntau = 40\nmass = 2\nstiffness = 500\n",
            "mu_prime = 0.2\nalpha_v = 0.1\ntau = 3\n",
        ] {
            let found = along(fixed);
            let ends: Vec<f64> = found.steps.iter().map(|s| s.0).collect();
            assert_eq!(ends[0], 0.0);
            assert!(found.steps.windows(2).all(|w| w[0].1 == w[1].0), "{fixed}");
            assert_eq!(found.steps.last().unwrap().1, found.until);
            let inside = |tau: f64| found.stable.iter().any(|s| s.from < tau && tau < s.to);
            for &(from, to, n) in &found.steps {
                assert_eq!(n == 0, inside(0.5 * (from + to)), "{fixed} {from} {to}");
                assert_eq!(n % 2, 0);
            }
            let changes = found.steps.windows(2).all(|w| w[0].2.abs_diff(w[1].2) == 2);
            assert!(changes, "{fixed}");
        }
    }

    #[test]
    fn lines_of_any_length_are_told() {
        let long = along("mu_prime = -0.3\nalpha_v = -0.33\ntau = 1e6\n");
        assert_eq!(long.steps.len() as u64, MOST_STEPS);
        assert_eq!(long.until, 1.15e6);
        // Near a tangency lobe follows lobe: those of the delays told are all there.
        let many = along("mu_prime = -1e-5\nalpha_n = -0.001\ntau = 1\n");
        assert!(
            many.more_stable && many.stable.len() > INTERVALS,
            "{many:?}"
        );
        let between = many.steps.iter().filter(|step| step.2 == 0).count();
        assert_eq!(between, many.stable.len());
        let without = along("mu_prime = -0.3\ntau = 0\n");
        assert_eq!(without.steps, [(0.0, TAU, 2)]);
        assert!(without.stable.is_empty() && !without.more_stable);
        let always = along("mu_prime = 0.3\ntau = 2\n");
        assert_eq!(always.steps, [(0.0, 2.3, 0)]);
        assert_eq!(always.stable[0].to, f64::INFINITY);
    }
}
