//! Places between which the boundary of the decaying region runs, on lines across the window.

use std::f64::consts::TAU;

use super::plane::{DecayPlane, Family};
use crate::linear::curves::Vertex;
use crate::linear::plane::Plane;
use crate::linear::roots::narrowed;

/// Stretches of equal width into which columns divide the window.
pub const COLUMNS: usize = 256;
/// The least number of steps over the window's delays.
const ROWS: f64 = 256.0;
/// Steps for each period of the fastest root that can lie on the line.
const STEPS_PER_PERIOD: f64 = 16.0;
/// The most steps along one column.
const MOST_STEPS: f64 = 16384.0;
/// Relative width to which a change is enclosed before Newton's method takes over.
const ENCLOSED: f64 = 1e-9;

/// A line across the window.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Across {
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

impl<P: Plane> DecayPlane<'_, P> {
    /// The parameter of column `i` of 0 to [`COLUMNS`].
    pub(super) fn column(&self, i: usize) -> f64 {
        let (from, to) = (self.window().p.start(), self.window().p.end());
        from + (to - from) * (i as f64 / COLUMNS as f64)
    }

    fn edge(&self, longest: bool) -> f64 {
        if longest {
            *self.window().q.end()
        } else {
            *self.window().q.start()
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
        for i in (0..=COLUMNS).take_while(|_| !self.plane.stopped()) {
            self.seeds_on_column(i, &mut seeds);
        }
        seeds
    }

    fn seeds_on_column(&self, column: usize, seeds: &mut Vec<Seed>) {
        let p = self.column(column);
        let (start, end) = (self.edge(false), self.edge(true));
        let [_, delay] = self.plane.delays();
        let (mut q, mut decays) = (start, self.decays(p, start));
        while q < end && !self.plane.stopped() {
            let band = self.plane.band(p, q, self.sigma);
            if band.enough && !decays {
                return;
            }
            let mut step = (end - start) / ROWS;
            if delay {
                let period = TAU / band.highest.max(1.0 / self.plane.unit(p, q));
                step = (period / STEPS_PER_PERIOD)
                    .min(step)
                    .max((end - start) / MOST_STEPS);
            }
            let next = (q + step).min(end);
            let decays_next = self.decays(p, next);
            if decays_next != decays {
                seeds.push(Seed {
                    across: Across::Column(column),
                    from: q,
                    to: next,
                });
            }
            (q, decays) = (next, decays_next);
        }
    }

    /// The point of the boundary that `seed` encloses.
    pub(super) fn locate(&self, seed: &Seed) -> Option<(Vertex, Family)> {
        let at = |x: f64| match seed.across {
            Across::Column(i) => (self.column(i), x),
            Across::Edge { longest } => (x, self.edge(longest)),
        };
        let decays = |x: f64| {
            let (p, q) = at(x);
            self.decays(p, q)
        };
        let first = decays(seed.from);
        let enough = |from: f64, to: f64| to - from <= ENCLOSED * (seed.to - seed.from);
        let (from, to) = narrowed(seed.from, seed.to, enough, |x| decays(x) == first);
        let (p, q) = at(0.5 * (from + to));
        let row = match seed.across {
            Across::Column(_) => [1.0, 0.0, 0.0],
            Across::Edge { .. } => [0.0, 1.0, 0.0],
        };
        self.candidates(p, q).into_iter().find_map(|omega| {
            let family = self.family(p, q, omega);
            let v = self.correct(Vertex { p, q, omega }, family, row)?;
            let along = match seed.across {
                Across::Column(_) => v.q,
                Across::Edge { .. } => v.p,
            };
            let slack = 1e-6 * (seed.to - seed.from);
            let bounds = self.others(v).is_none_or(|n| n == 0) && v.omega >= 0.0;
            let enclosed = (from - slack..=to + slack).contains(&along);
            (bounds && enclosed).then(|| (v, self.family(v.p, v.q, v.omega)))
        })
    }
}
