//! All delays of a system of matrices: where roots cross the axis, and how many are unstable.

use std::f64::consts::PI;

use num_complex::Complex64;

use super::MatrixSystem;
use super::on_axis::Junction;
use super::start::Start;
use crate::linear::collocation::eigenvalues_of_real;
use crate::linear::crossing::{Crossing, Direction};
use crate::linear::general::line::Passage;
use crate::linear::general::{DelayLine, Reason};
use crate::model::elementary::norm;

/// How near to 1 the spectral radius of D is taken for 1.
const LIMIT: f64 = 1e-12;
/// How near frequencies are that belong to one pair, relative.
const SAME: f64 = 1e-6;
/// So many of its errors a frequency beside a root at 0 has to be away from it.
const CLEAR: f64 = 64.0;

impl MatrixSystem {
    /// The spectral radius of D: roots accumulate at ln ρ/τ. NaN where it is not known.
    pub(super) fn neutral_radius(&self) -> f64 {
        if self.d.is_zero() {
            return 0.0;
        }
        let found = eigenvalues_of_real(self.signals(), |i, j| self.d.at(i, j));
        let sizes = |all: Vec<Complex64>| all.into_iter().map(norm).fold(0.0, f64::max);
        // Powers of a nilpotent D vanish where rounding leaves eigenvalues.
        let mut power = self.d.clone();
        for _ in 1..self.signals() {
            power = power.times(&self.d);
        }
        if power.is_zero() {
            return 0.0;
        }
        found.map_or(f64::NAN, sizes)
    }

    /// All delays.
    pub(super) fn line(&self) -> DelayLine {
        let mut line = DelayLine {
            open_from: f64::INFINITY,
            time_unit: 1.0,
            ..DelayLine::default()
        };
        let radius = self.neutral_radius();
        line.reason = if radius > 1.0 + LIMIT {
            Some(Reason::Infinite)
        } else if radius >= 1.0 - LIMIT {
            Some(Reason::NeutralLimit)
        } else {
            None
        };
        line.uncounted = line.reason.is_some() || radius.is_nan();
        let Some(start) = self.start() else {
            line.uncounted = true;
            return line;
        };
        line.without_delay = start.right;
        line.at_zero_delay = start.right;
        line.marginal_at_zero = start.origin || start.is_marginal();
        if line.uncounted {
            return line;
        }
        if start.origin {
            line.reason = Some(Reason::RootAtOrigin);
        } else if !start.resting.is_empty() {
            line.reason = Some(Reason::RootOnAxis);
        }
        line.always_marginal = line.reason.is_some();
        let known = self.signals() == 0 || self.add_crossings(&start, &mut line);
        if start.unknown || !known {
            line.always_marginal = true;
            line.reason = None;
        }
        line
    }

    /// Adds crossings, and the pairs that start on the axis; false where something is not known.
    fn add_crossings(&self, start: &Start, line: &mut DelayLine) -> bool {
        let rests = |of: &Junction| {
            let at_origin = start.origin && of.omega <= CLEAR * of.omega_error;
            let near = |omega: &f64| (of.omega - omega).abs() <= SAME * omega;
            at_origin || start.resting.iter().any(near)
        };
        let Some(on_axis) = self.on_axis(&rests) else {
            return false;
        };
        line.crossings
            .extend(on_axis.junctions.iter().map(crossing));
        if start.origin {
            line.passage = self.passage(line.crossings.last().map(|lowest| lowest.omega));
            if line.passage.is_none_or(|passage| passage.tau.is_nan()) {
                return false;
            }
            line.passage = line.passage.filter(|passage| passage.tau > passage.error);
        }
        let starts = start
            .moving
            .iter()
            .all(|omega| starts_on_axis(*omega, line));
        on_axis.complete && starts
    }

    /// Where a real root passes the one that rests at 0: D′(0) = 0. The largest frequency below
    /// which nothing else happens is that of `lowest`.
    fn passage(&self, lowest: Option<f64>) -> Option<Passage> {
        let slopes = self.slopes(Complex64::ZERO, Complex64::ONE)?;
        let tau = slopes.along_lambda.re / slopes.along_z.re;
        let error = 1e-10 * tau.abs();
        let below = 1e-3
            * lowest
                .unwrap_or(1.0 / (1.0 + tau.abs()))
                .min(1.0 / tau.abs());
        let outside = self.outside(below)?;
        let change = if outside == 0 { 1 } else { -1 };
        Some(Passage { tau, error, change })
    }
}

fn crossing(of: &Junction) -> Crossing {
    let direction = Direction::of_sign(of.sign);
    Crossing::with_errors(
        of.omega,
        of.omega_error,
        of.phase,
        of.phase_error,
        direction,
    )
}

/// Counts the pair that starts on the axis at `omega`: its crossing tells to which side it goes.
/// False where that cannot be told.
fn starts_on_axis(omega: f64, line: &mut DelayLine) -> bool {
    let near = |of: &&mut Crossing| (of.omega - omega).abs() <= SAME * omega && of.starts_at_zero();
    let Some(crossing) = line.crossings.iter_mut().find(near) else {
        return false;
    };
    crossing.first_branch = u64::from(crossing.theta < PI);
    if crossing.direction == Direction::Right {
        line.at_zero_delay += 2;
    }
    crossing.direction != Direction::Touch
}
