//! The stability of sliding over the delays of a line: the number of unstable roots, as steps, and
//! the stable delays.

use std::f64::consts::TAU;

use crate::linear::MarginalTolerance;
use crate::linear::crossing::Crossing;
use crate::linear::line::Line;
use crate::linear::stable_delays::StableInterval;
use crate::model::stop::Stop;
use crate::setting::no_answer::NoAnswer;
use crate::setting::{Parameter, Setting};

/// The line reaches at least to the end of this many stable intervals. Near a tangency there can be
/// millions.
const INTERVALS: usize = 12;
/// The most steps and the most stable intervals. With more crossings than this, the number of
/// unstable roots is sampled at this many delays.
const MOST_STEPS: u64 = 2000;
/// The longest delay of the line over the longest one of interest.
const BEYOND: f64 = 1.15;

/// The delays of a line, from 0 to just beyond the setting's own delay, the first crossings and the
/// ends of the first stable intervals. In the units of the setting.
#[derive(Debug, Clone, PartialEq)]
pub struct AlongDelay {
    /// Intervals of delays (from, to) with the number of unstable roots in each; together they
    /// cover 0 to `until`.
    pub steps: Vec<(f64, f64, u64)>,
    /// The longest delay of the line.
    pub until: f64,
    /// The stable intervals that begin before `until`, in order of delay.
    pub stable: Vec<StableInterval>,
    /// Whether others follow.
    pub more_stable: bool,
}

impl AlongDelay {
    /// The line of a setting with all its parameters.
    ///
    /// # Errors
    /// When a parameter is outside the model's range, or an expression has no value.
    pub fn of(setting: &Setting) -> Result<Self, NoAnswer> {
        let (model, time_unit) = setting.linear()?;
        let line = model.roots(&Stop::default()).line(time_unit);
        Ok(Self::of_line(&*line, setting.get(Parameter::Tau)))
    }

    /// The line; without steps where roots are not counted.
    fn of_line(line: &dyn Line, tau: f64) -> Self {
        let first: Vec<StableInterval> = line.stable_intervals().take(INTERVALS).collect();
        let until = longest(line.crossings(), &first, tau, line.time_unit());
        let changes = || {
            line.changes()
                .map(|change| change.tau)
                .take_while(|tau| *tau < until)
        };
        let count = changes().take(MOST_STEPS as usize + 1).count() as u64;
        let n_unstable = |tau: f64| line.count(tau, MarginalTolerance::default());
        let steps = match line.n_at_zero_delay() {
            None => Vec::new(),
            Some(_) => steps(count, changes(), until, |tau| {
                n_unstable(tau).map_or(0, |count| count.n_unstable)
            }),
        };
        Self {
            steps,
            until,
            ..Self::stable_before(until, line.stable_intervals())
        }
    }

    /// The stable intervals that begin before `until`.
    fn stable_before(until: f64, intervals: impl Iterator<Item = StableInterval>) -> Self {
        let mut intervals = intervals.peekable();
        let told = || intervals.next_if(|interval| interval.from < until);
        let stable = std::iter::from_fn(told).take(MOST_STEPS as usize).collect();
        Self {
            steps: Vec::new(),
            until,
            stable,
            more_stable: intervals.peek().is_some(),
        }
    }
}

/// The longest delay of the line for the setting's delay `tau`.
fn longest<'c>(
    crossings: impl Iterator<Item = &'c Crossing>,
    stable: &[StableInterval],
    tau: f64,
    time_unit: f64,
) -> f64 {
    let first = crossings.map(|c| c.delay(c.first_branch));
    let ends = stable.iter().flat_map(|s| [s.from, s.to]);
    let finite = first.chain(ends).filter(|delay| delay.is_finite());
    let matters = finite.fold(tau, f64::max);
    match matters {
        0.0 => TAU * time_unit,
        _ => BEYOND * matters,
    }
}

/// The number of unstable roots from 0 to `until`; it changes `count` times, at the delays
/// `changes`.
fn steps(
    count: u64,
    changes: impl Iterator<Item = f64>,
    until: f64,
    n_unstable: impl Fn(f64) -> u64,
) -> Vec<(f64, f64, u64)> {
    let mut edges: Vec<f64> = if count <= MOST_STEPS {
        changes.collect()
    } else {
        let place = |i| until * i as f64 / MOST_STEPS as f64;
        (1..MOST_STEPS).map(place).collect()
    };
    edges.extend([0.0, until]);
    edges.sort_by(f64::total_cmp);
    edges.dedup();
    let between = |pair: &[f64]| {
        let (from, to) = (pair[0], pair[1]);
        (from, to, n_unstable(from + 0.5 * (to - from)))
    };
    edges.windows(2).map(between).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::setting::point_file::{PointOf, PointSpec};

    fn along(fixed: &str) -> AlongDelay {
        let point = PointSpec::read(&format!("[fixed]\n{fixed}"), PointOf::Sliding).unwrap();
        AlongDelay::of(&point.setting).unwrap()
    }

    /// The count is 0 exactly inside the stable intervals, which are computed by another formula.
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
        // Near a tangency there are many lobes: those within the line are all there.
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
