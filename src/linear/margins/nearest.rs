//! The change of one parameter that is nearest: where, on the way from a setting, a root first
//! comes to the line Re λ = −σ.
//!
//! Boxes of frequency and parameter are taken by their distance from the setting. One on which D
//! cannot vanish is dropped, another halved; Newton's method finds the zeros themselves. When the
//! nearest zero is nearer than every box that is left, none can be nearer.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use super::enclosure::Enclosed;

/// Boxes that are looked at along one direction before what is left of it is given up.
pub(super) const MOST_BOXES: u32 = 1 << 17;
/// Where a bound on frequencies is less than this part of another, the half that has it is taken
/// by itself.
const NARROWER: f64 = 0.5;
/// How far below a box a zero may be found.
const NEAR: f64 = 1e-9;
/// Distances that differ by less are the same.
const SAME: f64 = 1e-12;

/// D over boxes of ω and one parameter.
pub(super) trait Family {
    /// D where ω and the parameter are within these intervals.
    fn enclosed(&self, omega: (f64, f64), parameter: (f64, f64)) -> Enclosed<2>;

    /// The ω beyond which no root is on the line while the parameter is within `parameter`;
    /// infinite where none is known.
    fn bound(&self, parameter: (f64, f64)) -> f64;

    /// Whether nobody waits for the answer any more.
    fn stopped(&self) -> bool;
}

/// What a search came to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Nearest {
    /// The parameter at which a root is on the line.
    At(f64),
    /// No root comes to the line.
    None,
    /// The search took too long.
    Undecided,
}

#[derive(Debug, Clone, Copy)]
struct Part {
    distance: f64,
    omega: (f64, f64),
    parameter: (f64, f64),
}

impl PartialEq for Part {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Part {}

impl PartialOrd for Part {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Part {
    /// The nearest is the greatest, and of equals that of the lowest frequency.
    fn cmp(&self, other: &Self) -> Ordering {
        let by_distance = other.distance.total_cmp(&self.distance);
        by_distance.then_with(|| other.omega.0.total_cmp(&self.omega.0))
    }
}

/// The parameter nearest to `from` at which D has a zero on the line, on the way to `to`. `left`:
/// the boxes that may be looked at, less by those that were.
pub(super) fn nearest(family: &impl Family, (from, to): (f64, f64), left: &mut u32) -> Nearest {
    let whole = (from.min(to), from.max(to));
    let apart = |p: (f64, f64)| (p.0 - from).max(from - p.1).max(0.0);
    let mut best = f64::INFINITY;
    let mut found = Nearest::None;
    let unbounded = |parameter: (f64, f64)| Part {
        distance: apart(parameter),
        omega: (0.0, f64::INFINITY),
        parameter,
    };
    let mut parts = BinaryHeap::from([unbounded(whole)]);
    while *left > 0 && !family.stopped() {
        *left -= 1;
        let Some(part) = parts.pop().filter(|part| part.distance < best) else {
            return found;
        };
        let (w, p) = (part.omega, part.parameter);
        let [wm, pm] = [0.5 * (w.0 + w.1), 0.5 * (p.0 + p.1)];
        if w.1.is_infinite() {
            let mut halves = [(p.0, pm), (pm, p.1)].map(unbounded);
            halves.sort_by(|a, b| b.cmp(a));
            match frequencies(family, &halves, p) {
                Some(most) if most.is_infinite() => return Nearest::Undecided,
                Some(most) => parts.push(Part {
                    omega: (0.0, most),
                    ..part
                }),
                None => parts.extend(halves),
            }
            continue;
        }
        let over = family.enclosed(w, p);
        if !over.value.may_vanish() {
            continue;
        }
        if let Some(zero) = newton(family, part).filter(|zero| apart((*zero, *zero)) < best) {
            best = apart((zero, zero)) * (1.0 - SAME);
            found = Nearest::At(zero);
        }
        let halves = match (fine(w), fine(p)) {
            // Nothing is left to halve: a zero within rounding.
            (true, true) => {
                best = part.distance;
                found = Nearest::At(pm);
                continue;
            }
            (narrow, thin) if thin || (!narrow && over.weights[0] >= over.weights[1]) => {
                [((w.0, wm), p), ((wm, w.1), p)]
            }
            _ => [(w, (p.0, pm)), (w, (pm, p.1))],
        };
        parts.extend(halves.map(|(omega, parameter)| Part {
            distance: apart(parameter),
            omega,
            parameter,
        }));
    }
    Nearest::Undecided
}

/// The ω beyond which no root is on the line while the parameter is within `p`; none where its
/// halves are better taken by themselves, the nearer of which comes first.
fn frequencies(family: &impl Family, halves: &[Part; 2], p: (f64, f64)) -> Option<f64> {
    let most = family.bound(p);
    let nearer = || family.bound(halves[0].parameter);
    let stays = fine(p) || (most.is_finite() && nearer() >= NARROWER * most);
    stays.then_some(most)
}

/// Whether an interval is not worth halving. Frequencies and parameters are of order 1: below that
/// nothing is told from 0.
fn fine((a, b): (f64, f64)) -> bool {
    b - a <= 16.0 * f64::EPSILON * (1e-3 + a.abs().max(b.abs()))
}

/// A zero of D in this part, by Newton's method from its middle.
fn newton(family: &impl Family, part: Part) -> Option<f64> {
    let ((w0, w1), (p0, p1)) = (part.omega, part.parameter);
    let (mut omega, mut parameter) = (0.5 * (w0 + w1), 0.5 * (p0 + p1));
    for _ in 0..12 {
        // Over a narrow box the parts are the derivatives.
        let (dw, dp) = (1e-7 * (1.0 + omega), 1e-7 * (parameter.abs() + 1e-3));
        let around = |x: f64, d: f64| (x - d, x + d);
        let over = family.enclosed(around(omega, dw), around(parameter, dp));
        let [by_w, by_p] = [over.value.part[0] / dw, over.value.part[1] / dp];
        let value = over.value.centre;
        let determinant = by_w.re * by_p.im - by_w.im * by_p.re;
        let step_w = (value.im * by_p.re - value.re * by_p.im) / determinant;
        let step_p = (value.re * by_w.im - value.im * by_w.re) / determinant;
        omega += step_w;
        parameter += step_p;
        // A real root is at ω = 0, which rounding may make negative.
        if !(omega >= w0 - NEAR && omega <= w1 && parameter >= p0 && parameter <= p1) {
            return None;
        }
        let small = |step: f64, at: f64| step.abs() <= SAME * (1e-3 + at.abs());
        if small(step_w, omega) && small(step_p, parameter) {
            return Some(parameter);
        }
    }
    None
}
