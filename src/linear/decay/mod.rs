//! Curves of a given degree of stability: the boundary, in a plane (p, τ), of the region where
//! every root has Re λ < −σ.
//!
//! On it a root lies on the line, D(−σ + iω; p, τ) = 0. With D = P + Q e^(−λτ) and κ = e^(στ) that
//! takes |P| = κ|Q|, a quadratic in ω² at every (p, τ), so at most two pairs and a real root lie on
//! the line at once.
//!
//! **Finding.** The number of roots right of the line is known at every point
//! ([`certificate`](super::certificate)). Along 257 columns of constant p, and along the window's
//! edges of shortest and longest delay, every change between no root and some is enclosed. A column
//! is sampled in steps of at most 1/16 of the period 2π/ω₊ of the fastest root that can lie on the
//! line, and of 1/256 of the window (but at most 16384 steps). It ends where (ω₊ − ω₋)τ > 6π: by
//! Eqs. (2) and (3) of the certificate, in which arg P and arg Q vary by at most π each,
//! n ≥ 2(ω₊ − ω₋)τ/2π − 5 there, and ω₊ − ω₋ grows with τ.
//!
//! **Following.** From each change the boundary is followed by predictor and corrector in (p, τ,
//! ω), where curves are smooth at folds ω₋ = ω₊ as well. It goes over to another curve where a
//! second root comes to the line: a corner, solved for with both roots, or a double real root −σ,
//! from which the curve of a pair starts. Every vertex is exact to rounding.
//!
//! **Limits.** A part of the region, or a hole in it, is missed if it lies between two neighbouring
//! columns (1/256 of the window in p), or if every column passes it in one step of its delays.
//! Smaller windows show smaller parts. A boundary that does not depend on the delay (no control at
//! all) is not a curve over p, and is left out.
//!
//! - `corner`: where two curves of the boundary meet, double real roots among them
//! - `letter`: the letter's characteristic function over such a plane
//! - `plane`: D on the line Re λ = −σ over the plane, Newton's method, tangents
//! - `seeds`: changes of "all roots decay" along columns and edges of the window
//! - `walk`: following the boundary by predictor and corrector
//! - `whole`: whole curves on which a pair lies on the line, cut where another root comes to it

mod corner;
mod letter;
mod plane;
mod seeds;
mod walk;
mod whole;

use std::f64::consts::TAU;

use super::Direction;
use super::curves::{
    Corner, CurveKind, CurvePiece, MOST_ARCS, MOST_CORNERS, PlaneCurves, StableSide, TooManyCurves,
    Vertex, Window,
};
use super::plane::Plane;
use crate::model::Groups;
use crate::model::stop::Stop;
use corner::Turn;
use letter::LetterPlane;
use plane::{DecayPlane, Family};
use seeds::Seed;
use walk::{Arc, Way};

pub use seeds::{Across, COLUMNS};
pub use whole::{Start, on_line, trace_whole};

/// Steps along all boundaries of one window.
const MOST_STEPS: usize = 1 << 20;
/// Two points of a line across the window are the same where they differ by less than this part of
/// the window, and of the scale of frequencies.
const SAME: f64 = 1e-6;
const SAME_FREQUENCY: f64 = 1e-3;

/// Traces the boundary of the region in `window` where every root has Re λ < −`sigma`.
///
/// `groups_at` gives the groups and the unit of time √(M/κ) at a value of p inside the window; p,
/// τ, ω and `sigma` > 0 are in the units of that time. Every piece bounds the region: `stable_side`
/// is the side on which all roots are left of the line. `direction` says how the root on the line
/// moves as the delay grows, `branch` is the number of whole turns of ωτ at the middle of the
/// piece. Along a piece p only grows or only falls. What may be missed: see the module. Once `stop`
/// is set, the answer comes soon but is meaningless.
///
/// # Errors
/// When there are more curves in the window than can be traced.
pub fn trace(
    groups_at: impl Fn(f64) -> (Groups, f64),
    sigma: f64,
    window: &Window,
    stop: &Stop,
) -> Result<PlaneCurves, TooManyCurves> {
    let plane = LetterPlane {
        groups_at: &groups_at,
        window,
        stop,
    };
    trace_in(&plane, sigma)
}

/// The curves of [`trace`] for any characteristic function over a plane.
///
/// # Errors
/// When there are more curves in the window than can be traced.
pub(crate) fn trace_in(plane: &impl Plane, sigma: f64) -> Result<PlaneCurves, TooManyCurves> {
    let mut tracer = Tracer {
        found: Traced::default(),
        curves: PlaneCurves::default(),
        steps: MOST_STEPS,
        plane: DecayPlane {
            plane,
            sigma,
            whole: false,
        },
    };
    for seed in tracer.plane.seeds() {
        if plane.stopped() {
            break;
        }
        if !tracer.found.holds(&seed) {
            tracer.follow(&seed)?;
        }
    }
    Ok(tracer.curves)
}

/// Where the boundaries traced so far meet the lines of the seeds.
#[derive(Default)]
struct Traced {
    /// q and ω, for each column.
    columns: Vec<Vec<(f64, f64)>>,
    /// p and ω on the edges of smallest and largest q.
    edges: [Vec<(f64, f64)>; 2],
}

impl Traced {
    fn on(&mut self, line: Across) -> &mut Vec<(f64, f64)> {
        match line {
            Across::Column(i) => {
                self.columns.resize(COLUMNS + 1, Vec::new());
                &mut self.columns[i]
            }
            Across::Edge { longest } => &mut self.edges[usize::from(longest)],
        }
    }

    fn holds(&mut self, seed: &Seed) -> bool {
        let slack = 1e-6 * (seed.to - seed.from);
        let range = seed.from - slack..=seed.to + slack;
        let on = self.on(seed.across);
        on.iter().any(|(x, _)| range.contains(x))
    }
}

struct Tracer<'a, P> {
    plane: DecayPlane<'a, P>,
    found: Traced,
    curves: PlaneCurves,
    steps: usize,
}

impl<P: Plane> Tracer<'_, P> {
    /// Traces the boundary on which `seed` lies.
    fn follow(&mut self, seed: &Seed) -> Result<(), TooManyCurves> {
        let Some((start, family)) = self.plane.locate(seed) else {
            return Ok(());
        };
        let mut forward = self.walk(start, family, 1.0)?;
        let arcs = if forward.closed {
            closed(std::mem::take(&mut forward.arcs))
        } else {
            let backward = self.walk(start, family, -1.0)?;
            forward.corners.extend(backward.corners);
            joined(backward.arcs, forward.arcs)
        };
        for arc in &arcs {
            if self.mark(arc) {
                self.curves.pieces.extend(self.piece(arc));
            }
        }
        let corners = forward.corners.iter().map(corner);
        self.curves.corners.extend(corners);
        self.check_limits(false)
    }

    fn walk(&mut self, start: Vertex, family: Family, sense: f64) -> Result<Way, TooManyCurves> {
        let way = self.plane.walk(start, family, sense, self.steps);
        let vertices: usize = way.arcs.iter().map(|arc| arc.vertices.len()).sum();
        self.steps = self.steps.saturating_sub(vertices);
        self.check_limits(way.too_long)?;
        Ok(way)
    }

    fn check_limits(&self, too_long: bool) -> Result<(), TooManyCurves> {
        let arcs = self.curves.pieces.len() as u64;
        let corners = self.curves.corners.len() as u64;
        if too_long || arcs > MOST_ARCS || corners > MOST_CORNERS {
            return Err(TooManyCurves { arcs, corners });
        }
        Ok(())
    }

    /// Notes where an arc meets columns and edges. Returns whether it is new: an arc that was
    /// followed before meets each column where that one did.
    fn mark(&mut self, arc: &Arc) -> bool {
        let window = self.plane.window();
        let (mut met, mut known) = (0, 0);
        for pair in arc.vertices.windows(2) {
            for i in self.columns_between(pair[0].p, pair[1].p) {
                let v = self.at_column(arc.family, (pair[0], pair[1]), self.plane.column(i));
                let scale = self.plane.scales(v)[2];
                let same = |&(q, omega): &(f64, f64)| {
                    (q - v.q).abs() <= SAME * window.q_width()
                        && (omega - v.omega).abs() <= SAME_FREQUENCY * scale
                };
                let on = self.found.on(Across::Column(i));
                met += 1;
                known += u32::from(on.iter().any(same));
                on.push((v.q, v.omega));
            }
        }
        let slack = 1e-9 * window.q_width();
        for end in [arc.vertices.first(), arc.vertices.last()]
            .into_iter()
            .flatten()
        {
            for (longest, edge) in [(false, window.q.start()), (true, window.q.end())] {
                if (end.q - edge).abs() <= slack {
                    let on = self.found.on(Across::Edge { longest });
                    on.push((end.p, end.omega));
                }
            }
        }
        known < met || met < 2
    }

    fn columns_between(&self, p: f64, q: f64) -> std::ops::Range<usize> {
        let window = self.plane.window();
        let place = |p: f64| (p - window.p.start()) / window.p_width() * COLUMNS as f64;
        let (from, to) = (place(p.min(q)), place(p.max(q)));
        let from = (from - 1e-9).ceil().max(0.0) as usize;
        // Empty where no column lies between.
        let to = (to + 1e-9).floor().min(COLUMNS as f64) + 1.0;
        from..to.max(0.0) as usize
    }

    /// Where the curve from `v` to `w` passes `p`.
    fn at_column(&self, family: Family, (v, w): (Vertex, Vertex), p: f64) -> Vertex {
        let part = if v.p == w.p {
            0.0
        } else {
            (p - v.p) / (w.p - v.p)
        };
        let between = Vertex {
            p,
            q: v.q + part * (w.q - v.q),
            omega: v.omega + part * (w.omega - v.omega),
        };
        let solved = self.plane.correct(between, family, [1.0, 0.0, 0.0]);
        let near = |tau: f64| {
            let reach = (w.q - v.q).abs() + super::curves::FLATNESS * self.plane.window().q_width();
            (tau - between.q).abs() <= reach
        };
        solved.filter(|v| near(v.q)).unwrap_or(between)
    }

    /// The piece of an arc. None where p does not vary along it, because the delay has no effect.
    fn piece(&self, arc: &Arc) -> Option<CurvePiece> {
        let (first, last) = (arc.vertices.first()?, arc.vertices.last()?);
        let middle = arc.vertices[arc.vertices.len() / 2];
        let mut piece = CurvePiece {
            kind: match arc.family {
                Family::Pair => CurveKind::Pair,
                Family::Real { .. } => CurveKind::RealRoot,
            },
            branch: turns(middle.omega, self.plane.plane.delay(middle.p, middle.q)),
            direction: Direction::Left,
            stable_side: StableSide::Longer,
            vertices: Vec::new(),
        };
        if (last.p - first.p).abs() <= 1e-13 * self.plane.window().p_width() {
            let [_, delay] = self.plane.plane.delays();
            if delay && !self.plane.whole {
                return None;
            }
            if last.q > first.q {
                (piece.direction, piece.stable_side) = (Direction::Right, StableSide::Below);
            } else {
                piece.stable_side = StableSide::Above;
            }
            piece.vertices.clone_from(&arc.vertices);
            return Some(piece);
        }
        let longer = last.p > first.p;
        if !longer {
            (piece.direction, piece.stable_side) = (Direction::Right, StableSide::Shorter);
        }
        piece.vertices = monotone(&arc.vertices, longer);
        Some(piece)
    }
}

/// The vertices of an arc from end to end, without those that rounding has put on the wrong side of
/// a neighbour in p.
fn monotone(vertices: &[Vertex], rising: bool) -> Vec<Vertex> {
    let mut kept: Vec<Vertex> = Vec::with_capacity(vertices.len());
    let follows = |v: &Vertex, w: &Vertex| if rising { w.p > v.p } else { w.p < v.p };
    for (i, v) in vertices.iter().enumerate() {
        if i + 1 == vertices.len() {
            while kept.len() > 1 && kept.last().is_some_and(|last| !follows(last, v)) {
                kept.pop();
            }
        } else if kept.last().is_some_and(|last| !follows(last, v)) {
            continue;
        }
        kept.push(*v);
    }
    kept
}

fn turns(omega: f64, tau: f64) -> u64 {
    (omega * tau / TAU).max(0.0) as u64
}

fn corner(turn: &Turn) -> Corner {
    let pair = |omega: f64| (omega, turns(omega, turn.q));
    Corner {
        p: turn.p,
        q: turn.q,
        upper: pair(turn.before.max(turn.after)),
        lower: pair(turn.before.min(turn.after)),
        bounds_stable: true,
    }
}

/// The arcs of a way that came back: its beginning belongs to its last arc.
fn closed(mut arcs: Vec<Arc>) -> Vec<Arc> {
    if arcs.len() > 1
        && let Some(last) = arcs.pop()
    {
        let first = std::mem::take(&mut arcs[0].vertices);
        arcs[0].vertices = last.vertices;
        arcs[0].vertices.extend(first.into_iter().skip(1));
    }
    arcs
}

/// The arcs of two ways from one place, the first gone backwards.
fn joined(mut backward: Vec<Arc>, forward: Vec<Arc>) -> Vec<Arc> {
    for arc in &mut backward {
        arc.vertices.reverse();
    }
    backward.reverse();
    let mut forward = forward.into_iter();
    if let (Some(arc), Some(rest)) = (backward.last_mut(), forward.next()) {
        arc.vertices.extend(rest.vertices.into_iter().skip(1));
    }
    backward.extend(forward);
    backward
}

#[cfg(test)]
mod tests;
