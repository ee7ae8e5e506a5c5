//! Places between which the boundary of the decaying region runs, on lines across the window.

use std::f64::consts::TAU;

use super::plane::{DecayPlane, Family};
use crate::linear::curves::Vertex;
use crate::linear::roots::narrowed;

/// Stretches of equal width into which columns divide the window.
pub(super) const COLUMNS: usize = 256;
/// Steps over the window's delays at least.
const ROWS: f64 = 256.0;
/// Steps for each period of the fastest root that can lie on the line.
const STEPS_PER_PERIOD: f64 = 16.0;
/// Steps along one column at most.
const MOST_STEPS: f64 = 16384.0;
/// Turns of (ω₊ − ω₋)τ beyond which some root is right of the line, whatever the phases are (see
/// the module).
const TURNS_ENOUGH: f64 = 3.0;
/// Relative width to which a change is enclosed before Newton's method takes over.
const ENCLOSED: f64 = 1e-9;

/// A line across the window.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Across {
    /// All delays at one value of the parameter.
    Column(usize),
    /// The shortest or the longest delay: one edge of the window.
    Edge {
        /// The longest.
        longest: bool,
    },
}

/// A stretch of a line at whose ends the predicate "all roots decay" differs.
#[derive(Debug, Clone, Copy)]
pub(super) struct Seed {
    pub across: Across,
    /// Delays on a column, values of the parameter on an edge.
    pub from: f64,
    pub to: f64,
}

impl DecayPlane<'_> {
    /// The parameter of column `i` of 0 to [`COLUMNS`].
    pub(super) fn column(&self, i: usize) -> f64 {
        let (from, to) = (self.window.p.start(), self.window.p.end());
        from + (to - from) * (i as f64 / COLUMNS as f64)
    }

    fn edge(&self, longest: bool) -> f64 {
        if longest {
            *self.window.tau.end()
        } else {
            *self.window.tau.start()
        }
    }

    /// All changes of the predicate along columns and along the edges of the window.
    pub(super) fn seeds(&self) -> Vec<Seed> {
        let mut seeds = Vec::new();
        for longest in [false, true] {
            let decays = |i: usize| self.decays(self.column(i), self.edge(longest));
            for i in (0..COLUMNS).filter(|&i| decays(i) != decays(i + 1)) {
                seeds.push(Seed {
                    across: Across::Edge { longest },
                    from: self.column(i),
                    to: self.column(i + 1),
                });
            }
        }
        for i in 0..=COLUMNS {
            self.seeds_on_column(i, &mut seeds);
        }
        seeds
    }

    fn seeds_on_column(&self, column: usize, seeds: &mut Vec<Seed>) {
        let p = self.column(column);
        let (start, end) = (self.edge(false), self.edge(true));
        let unit = self.groups(p).1;
        let (mut tau, mut decays) = (start, self.decays(p, start));
        while tau < end {
            let (lower, upper) = self.band(p, tau).unwrap_or((0.0, 0.0));
            let beyond = (upper - lower) * tau > TURNS_ENOUGH * TAU;
            if beyond && !decays {
                return;
            }
            let period = TAU / upper.max(1.0 / unit);
            let step = (period / STEPS_PER_PERIOD)
                .min((end - start) / ROWS)
                .max((end - start) / MOST_STEPS);
            let next = (tau + step).min(end);
            let decays_next = self.decays(p, next);
            if decays_next != decays {
                seeds.push(Seed {
                    across: Across::Column(column),
                    from: tau,
                    to: next,
                });
            }
            (tau, decays) = (next, decays_next);
        }
    }

    /// The point of the boundary that `seed` encloses.
    pub(super) fn locate(&self, seed: &Seed) -> Option<(Vertex, Family)> {
        let at = |x: f64| match seed.across {
            Across::Column(i) => (self.column(i), x),
            Across::Edge { longest } => (x, self.edge(longest)),
        };
        let decays = |x: f64| {
            let (p, tau) = at(x);
            self.decays(p, tau)
        };
        let first = decays(seed.from);
        let enough = |from: f64, to: f64| to - from <= ENCLOSED * (seed.to - seed.from);
        let (from, to) = narrowed(seed.from, seed.to, enough, |x| decays(x) == first);
        let (p, tau) = at(0.5 * (from + to));
        let row = match seed.across {
            Across::Column(_) => [1.0, 0.0, 0.0],
            Across::Edge { .. } => [0.0, 1.0, 0.0],
        };
        self.candidates(p, tau).into_iter().find_map(|omega| {
            let family = self.family(p, tau, omega);
            let v = self.correct(Vertex { p, tau, omega }, family, row)?;
            let along = match seed.across {
                Across::Column(_) => v.tau,
                Across::Edge { .. } => v.p,
            };
            let slack = 1e-6 * (seed.to - seed.from);
            let bounds = self.others(v).is_none_or(|n| n == 0) && v.omega >= 0.0;
            let enclosed = (from - slack..=to + slack).contains(&along);
            (bounds && enclosed).then(|| (v, self.family(v.p, v.tau, v.omega)))
        })
    }
}
