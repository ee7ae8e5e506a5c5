//! Where the curves of a plane begin to be followed: points of them on lines across the window.

use num_complex::Complex64;

use super::plane::SystemPlane;
use super::turning::RightOf;
use crate::linear::crossing::{Crossing, Direction};
use crate::linear::curves::{MOST_ARCS, TooManyCurves, Vertex};
use crate::linear::decay::{Across, COLUMNS, Start, on_line};
use crate::linear::plane::Plane;

/// Steps along a column on which counts are compared.
const ROWS: usize = 256;
/// Relative width to which a change is enclosed before Newton's method takes over.
const ENCLOSED: f64 = 1e-9;

/// Points of all curves of the imaginary axis.
///
/// # Errors
/// When one line meets more curves than can be traced: a piece of one passes a column once at most,
/// and has two ends for the edges.
pub(super) fn starts(plane: &SystemPlane) -> Result<Vec<Start>, TooManyCurves> {
    let mut starts = Vec::new();
    for i in (0..=COLUMNS).take_while(|_| !plane.stopped()) {
        if plane.has_lines() {
            on_line_of_delays(plane, i, &mut starts)?;
        } else {
            let (from, to) = (*plane.window().q.start(), *plane.window().q.end());
            let q = |j: usize| from + (to - from) * (j as f64 / ROWS as f64);
            by_counts(plane, Across::Column(i), ROWS, 1, &q, &mut starts)?;
        }
    }
    for longest in [false, true] {
        let p = |i: usize| column(plane, i);
        by_counts(plane, Across::Edge { longest }, COLUMNS, 2, &p, &mut starts)?;
    }
    Ok(starts)
}

fn column(plane: &SystemPlane, i: usize) -> f64 {
    let (from, to) = (plane.window().p.start(), plane.window().p.end());
    from + (to - from) * (i as f64 / COLUMNS as f64)
}

/// All crossing delays in the window at one value of p.
fn on_line_of_delays(
    plane: &SystemPlane,
    i: usize,
    starts: &mut Vec<Start>,
) -> Result<(), TooManyCurves> {
    let p = column(plane, i);
    let Some((line, unit)) = plane.line(p) else {
        return Ok(());
    };
    let (from, to) = (*plane.window().q.start(), *plane.window().q.end());
    let crossings = line.crossings.iter();
    let moving = crossings.filter(|c| c.direction != Direction::Touch);
    let branches = |c: &Crossing| c.branch_at(from / unit)..c.branch_at((to / unit).next_up());
    let sizes = moving.clone().map(branches);
    let arcs = sizes.fold(0, |sum: u64, b| {
        sum.saturating_add(b.end.saturating_sub(b.start))
    });
    if arcs > MOST_ARCS {
        return Err(TooManyCurves { arcs, corners: 0 });
    }
    for crossing in moving {
        starts.extend(branches(crossing).map(|k| Start {
            across: Across::Column(i),
            vertex: Vertex {
                p,
                q: crossing.delay(k) * unit,
                omega: crossing.omega / unit,
            },
        }));
    }
    Ok(())
}

/// Where the number of unstable roots changes along a line across the window; `at` gives its points
/// in `steps` steps. An error where it meets more curves than can be traced, each `at_most` so
/// often.
fn by_counts(
    plane: &SystemPlane,
    across: Across,
    steps: usize,
    at_most: u64,
    at: &dyn Fn(usize) -> f64,
    starts: &mut Vec<Start>,
) -> Result<(), TooManyCurves> {
    let search = Search { plane, across };
    let others = starts.len();
    let mut before: Option<(f64, RightOf)> = None;
    for i in 0..=steps {
        let here = (at(i), search.count(at(i)));
        // A place on a curve tells nothing.
        if here.1 == RightOf::Undecided {
            continue;
        }
        if let Some(before) = before {
            let width = (here.0 - before.0).abs();
            search.between(before, here, ENCLOSED * width, starts);
        }
        before = Some(here);
        let arcs = (starts.len() - others) as u64 / at_most;
        if arcs > MOST_ARCS {
            return Err(TooManyCurves { arcs, corners: 0 });
        }
    }
    Ok(())
}

struct Search<'a, 'p> {
    plane: &'a SystemPlane<'p>,
    across: Across,
}

impl Search<'_, '_> {
    fn point(&self, x: f64) -> (f64, f64) {
        match self.across {
            Across::Column(i) => (column(self.plane, i), x),
            Across::Edge { longest: false } => (x, *self.plane.window().q.start()),
            Across::Edge { longest: true } => (x, *self.plane.window().q.end()),
        }
    }

    fn count(&self, x: f64) -> RightOf {
        let (p, q) = self.point(x);
        self.plane.count(p, q, 0.0, 0.0)
    }

    /// Halves a stretch at whose ends the counts differ, until it is `enough` narrow.
    fn between(
        &self,
        from: (f64, RightOf),
        to: (f64, RightOf),
        enough: f64,
        starts: &mut Vec<Start>,
    ) {
        if from.1 == to.1 || self.plane.stopped() {
            return;
        }
        let middle = 0.5 * (from.0 + to.0);
        // Towards a line at which roots accumulate there is no end of curves.
        if [from.1, to.1].contains(&RightOf::Infinite) {
            return;
        }
        if (to.0 - from.0).abs() <= enough {
            self.locate(from.0, to.0, starts);
            return;
        }
        match self.count(middle) {
            // On a curve itself.
            RightOf::Undecided => self.locate(from.0, to.0, starts),
            count => {
                self.between(from, (middle, count), enough, starts);
                self.between((middle, count), to, enough, starts);
            }
        }
    }

    fn locate(&self, from: f64, to: f64, starts: &mut Vec<Start>) {
        let (p, q) = self.point(0.5 * (from + to));
        let residual = |omega: &f64| {
            let at = self.plane.at(p, q, Complex64::new(0.0, *omega));
            at.value.norm_sqr()
        };
        let mut all = self.plane.frequencies(p, q, 0.0);
        all.sort_by(|a, b| residual(a).total_cmp(&residual(b)));
        let slack = 1e-6 * (to - from).abs() + 1e-12 * from.abs().max(to.abs());
        let enclosed = |v: &Vertex| {
            let x = match self.across {
                Across::Column(_) => v.q,
                Across::Edge { .. } => v.p,
            };
            // At frequency 0 it is a real root.
            let pair = v.omega > 1e-9 / self.plane.unit(v.p, v.q);
            from.min(to) - slack <= x && x <= from.max(to) + slack && pair
        };
        let column = matches!(self.across, Across::Column(_));
        let at = |omega: f64| on_line(self.plane, 0.0, Vertex { p, q, omega }, column);
        starts.extend(
            all.into_iter()
                .filter_map(at)
                .filter(enclosed)
                .map(|vertex| Start {
                    across: self.across,
                    vertex,
                }),
        );
    }
}
