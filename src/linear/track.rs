//! The rightmost roots along a line: all delays at one setting of the gains and the damping.
use super::certificate::roots_right_of;
use super::newton::Root;
use super::spectrum::RootFinder;
use super::status::{CERTIFIED, DISAGREE, MARGINAL, NOT_CONVERGED, SATURATED};
use crate::model::Groups;

/// Most roots that can be reported for a cell, pairs counted once.
pub const MOST_ROOTS: usize = 8;

/// What was found in one cell.
#[derive(Debug, Clone, Copy)]
pub struct Cell<'t> {
    /// The rightmost roots by falling real part, as many as the tracker was asked for; fewer where there are no more
    /// (without control or delay), none where nothing converged. Dimensionless.
    pub roots: &'t [Root],
    /// No root lies right of Re λ + margin·max(1, |Re λ|), λ being the first of `roots`.
    pub margin: f64,
}

/// Follows the rightmost roots along lines, keeping its memory from one line to the next.
#[derive(Debug, Clone)]
pub struct RootTracker {
    wanted: usize,
    finder: RootFinder,
}

impl RootTracker {
    /// A tracker that reports the `wanted` rightmost roots of each cell, 1 to [`MOST_ROOTS`].
    #[must_use]
    pub fn new(wanted: usize) -> Self {
        Self {
            wanted: wanted.clamp(1, MOST_ROOTS),
            finder: RootFinder::default(),
        }
    }

    /// Visits every cell of a line in order.
    ///
    /// `delays` increase, in units of which `time_unit` = √(M/κ) makes one dimensionless; `first` is the index of the first
    /// of them on the whole line. `counts` are their numbers of unstable roots by the closed form; `status` comes with what
    /// that form has to say and gains certified, not converged or disagree.
    pub fn follow(
        &mut self,
        groups: Groups,
        (delays, time_unit): (&[f64], f64),
        _first: usize,
        counts: &[u16],
        status: &mut [u8],
        mut visit: impl FnMut(usize, Cell),
    ) {
        for (i, delay) in delays.iter().enumerate() {
            let tau = delay / time_unit;
            let Ok(roots) =
                self.finder
                    .rightmost(groups, tau, 2 * self.wanted as u64, f64::NEG_INFINITY)
            else {
                status[i] |= NOT_CONVERGED;
                visit(
                    i,
                    Cell {
                        roots: &[],
                        margin: f64::NAN,
                    },
                );
                continue;
            };
            let roots = &roots[..roots.len().min(self.wanted)];
            let s = roots[0].lambda.re;
            let margin = 1e-6;
            status[i] |= match roots_right_of(groups, tau, s + margin * s.abs().max(1.0)) {
                Some(0) => CERTIFIED,
                Some(_) => DISAGREE,
                None => NOT_CONVERGED,
            };
            match roots_right_of(groups, tau, 0.0) {
                Some(n) if n != u64::from(counts[i]) && status[i] & (SATURATED | MARGINAL) == 0 => {
                    status[i] |= DISAGREE
                }
                None => status[i] |= MARGINAL,
                _ => {}
            }
            visit(i, Cell { roots, margin });
        }
    }
}
