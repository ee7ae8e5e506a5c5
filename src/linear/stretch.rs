//! Crossing curves between two breakpoints: smooth arcs, cut where they cross one another.

use std::f64::consts::PI;

use super::crossing::{Crossing, Crossings, Direction};
use super::curves::{
    Corner, CurveKind, CurvePiece, FLATNESS, MOST_ARCS, MOST_CORNERS, PlaneCurves, StableSide,
    TooManyCurves, Vertex, Window,
};
use super::roots::bisect;
use crate::model::elementary::{power, sin};
use crate::model::stop::Stop;

/// Nodes at which each arc is examined for corners and for where it enters and leaves the window.
const NODES: usize = 192;
/// Segments into which a piece is cut before it is refined.
const COARSE_SEGMENTS: usize = 8;
/// Halvings of a segment until it is flat.
const MOST_HALVINGS: u32 = 12;

/// The arcs between two breakpoints.
pub(super) struct Stretch<'a, F> {
    crossings_at: &'a F,
    p0: f64,
    p1: f64,
    window: &'a Window,
    /// Arc parameters of the nodes.
    s: Vec<f64>,
    nodes: Vec<Crossings>,
}

#[derive(Clone, Copy, PartialEq)]
enum Arm {
    Upper,
    Lower,
}

/// A corner, by its place on the stretch.
struct Cut {
    s: f64,
    upper: u64,
    lower: u64,
}

fn arm_of(crossings: &Crossings, arm: Arm) -> Option<Crossing> {
    match arm {
        Arm::Upper => crossings.upper,
        Arm::Lower => crossings.lower,
    }
}

impl<'a, F: Fn(f64) -> Crossings> Stretch<'a, F> {
    pub(super) fn new(crossings_at: &'a F, p0: f64, p1: f64, window: &'a Window) -> Self {
        let mut stretch = Self {
            crossings_at,
            p0,
            p1,
            window,
            s: Vec::new(),
            nodes: Vec::new(),
        };
        let first = stretch.end_node(0.0);
        let last = stretch.end_node(1.0);
        stretch.s = (0..=NODES)
            .map(|i| (i as f64 / NODES as f64).clamp(first, last))
            .collect();
        stretch.nodes = stretch.s.iter().map(|&s| stretch.at(s)).collect();
        stretch
    }

    fn p(&self, s: f64) -> f64 {
        if s <= 0.0 {
            self.p0
        } else if s >= 1.0 {
            self.p1
        } else {
            self.p0 + (self.p1 - self.p0) * power(sin(0.5 * PI * s), 2)
        }
    }

    fn at(&self, s: f64) -> Crossings {
        (self.crossings_at)(self.p(s))
    }

    /// The end `s` (0 or 1), moved inwards as little as needed for the arcs of the middle to exist
    /// there: at a fold the two arms end within the square root of rounding of one another.
    fn end_node(&self, s: f64) -> f64 {
        // At b = 0 itself the numbering of the branches jumps.
        let arms = |c: Crossings| {
            let [upper, lower] = [Arm::Upper, Arm::Lower].map(|arm| arm_of(&c, arm).is_some());
            (upper, lower, c.undamped)
        };
        let wanted = arms(self.at(0.5));
        let inwards = |by: f64| if s == 0.0 { by } else { 1.0 - by };
        let mut by = 1e-9;
        let mut end = s;
        while arms(self.at(end)) != wanted && by < 1e-3 {
            end = inwards(by);
            by *= 2.0;
        }
        end
    }

    fn vertex(&self, s: f64, arm: Arm, branch: u64) -> Option<Vertex> {
        let crossing = arm_of(&self.at(s), arm)?;
        Some(Vertex {
            p: self.p(s),
            q: crossing.delay(branch),
            omega: crossing.omega,
        })
    }

    /// Delay of a branch, infinite where the arc has none.
    fn delay(&self, s: f64, arm: Arm, branch: u64) -> f64 {
        self.vertex(s, arm, branch).map_or(f64::INFINITY, |v| v.q)
    }

    /// The branches of an arm that have a node inside the window.
    fn branches(&self, arm: Arm) -> std::ops::Range<u64> {
        let (mut from, mut to) = (u64::MAX, 0);
        for crossing in self.nodes.iter().filter_map(|c| arm_of(c, arm)) {
            from = from.min(crossing.branch_at(*self.window.q.start()));
            to = to.max(crossing.branch_at(self.window.q.end().next_up()));
        }
        from.min(to)..to
    }

    /// Adds the pieces and corners of the stretch; once `stop` is set, only some of them.
    pub(super) fn trace(&self, curves: &mut PlaneCurves, stop: &Stop) -> Result<(), TooManyCurves> {
        let ranges = [Arm::Upper, Arm::Lower].map(|arm| self.branches(arm));
        let arcs = ranges.iter().map(|r| r.end - r.start).sum();
        if arcs > MOST_ARCS {
            return Err(TooManyCurves { arcs, corners: 0 });
        }
        let cuts = self.cuts(ranges[0].clone(), stop);
        let corners = (curves.corners.len() + cuts.len()) as u64;
        if corners > MOST_CORNERS {
            return Err(TooManyCurves { arcs, corners });
        }
        for (arm, range) in [Arm::Upper, Arm::Lower].into_iter().zip(ranges) {
            for branch in range.take_while(|_| !stop.is_set()) {
                self.trace_arc(arm, branch, &cuts, curves);
            }
        }
        curves
            .corners
            .extend(cuts.iter().filter_map(|cut| self.corner(cut)));
        Ok(())
    }

    /// All corners of the stretch, from changes in the order of delays between neighbouring nodes.
    fn cuts(&self, upper_branches: std::ops::Range<u64>, stop: &Stop) -> Vec<Cut> {
        let mut cuts = Vec::new();
        let (s, nodes) = self.corner_nodes();
        for branch in upper_branches {
            if cuts.len() as u64 > MOST_CORNERS || stop.is_set() {
                break;
            }
            let places: Vec<Option<u64>> = nodes
                .iter()
                .map(|c| {
                    let tau = arm_of(c, Arm::Upper)?.delay(branch);
                    let inside = tau <= 2.0 * self.window.q.end() + 1.0;
                    inside.then_some(arm_of(c, Arm::Lower)?.branch_at(tau))
                })
                .collect();
            for (place, s) in places.windows(2).zip(s.windows(2)) {
                let [Some(before), Some(after)] = *place else {
                    continue;
                };
                for lower in before.min(after)..before.max(after) {
                    let gap = |s: f64| {
                        self.delay(s, Arm::Upper, branch) - self.delay(s, Arm::Lower, lower)
                    };
                    let s = bisect(s[0], s[1], gap);
                    if self.window.q.contains(&self.delay(s, Arm::Upper, branch)) {
                        cuts.push(Cut {
                            s,
                            upper: branch,
                            lower,
                        });
                    }
                }
            }
        }
        cuts
    }

    /// The nodes, with those at a fold moved off it: there both arms of a branch meet without
    /// crossing.
    fn corner_nodes(&self) -> (Vec<f64>, Vec<Crossings>) {
        let (mut s, mut nodes) = (self.s.clone(), self.nodes.clone());
        let folded = |c: &Crossings| match (c.upper, c.lower) {
            (Some(u), Some(l)) => u.omega - l.omega < 1e-5 * u.omega,
            _ => false,
        };
        for (end, inner) in [(0, 1), (NODES, NODES - 1)] {
            if folded(&nodes[end]) {
                s[end] += (s[inner] - s[end]) / 1024.0;
                nodes[end] = self.at(s[end]);
            }
        }
        (s, nodes)
    }

    fn corner(&self, cut: &Cut) -> Option<Corner> {
        let crossings = self.at(cut.s);
        let (upper, lower) = (
            arm_of(&crossings, Arm::Upper)?,
            arm_of(&crossings, Arm::Lower)?,
        );
        let others = crossings.at_zero_delay as i64 + 2 * (cut.upper - upper.first_branch) as i64
            - 2 * (cut.lower - lower.first_branch) as i64;
        Some(Corner {
            p: self.p(cut.s),
            q: upper.delay(cut.upper),
            upper: (upper.omega, cut.upper),
            lower: (lower.omega, cut.lower),
            // Before and after both crossings `others` roots are unstable; on the other two sides
            // two more, and two fewer.
            bounds_stable: others == 0 || others == 2,
        })
    }

    /// Adds the pieces of one arc that lie in the window.
    fn trace_arc(&self, arm: Arm, branch: u64, cuts: &[Cut], curves: &mut PlaneCurves) {
        for (from, to) in self.stretches_inside(arm, branch) {
            let own = |cut: &&Cut| match arm {
                Arm::Upper => cut.upper == branch,
                Arm::Lower => cut.lower == branch,
            };
            let mut ends: Vec<f64> = cuts.iter().filter(own).map(|cut| cut.s).collect();
            ends.retain(|&s| from < s && s < to);
            ends.extend([from, to]);
            ends.sort_by(f64::total_cmp);
            for pair in ends.windows(2) {
                curves
                    .pieces
                    .extend(self.piece(arm, branch, pair[0], pair[1]));
            }
        }
    }

    /// The intervals of s on which a branch lies in the window, ends solved for.
    fn stretches_inside(&self, arm: Arm, branch: u64) -> Vec<(f64, f64)> {
        let (lo, hi) = (*self.window.q.start(), *self.window.q.end());
        let delays: Vec<f64> = self
            .nodes
            .iter()
            .map(|c| arm_of(c, arm).map_or(f64::INFINITY, |c| c.delay(branch)))
            .collect();
        // −1 below the window, 0 inside, 1 above.
        let side = |tau: f64| i8::from(tau > hi) - i8::from(tau < lo);
        let mut stretches = Vec::new();
        let mut from = (side(delays[0]) == 0).then_some(self.s[0]);
        for i in 0..NODES {
            let (here, next) = (side(delays[i]), side(delays[i + 1]));
            let edge = |bound: f64| {
                bisect(self.s[i], self.s[i + 1], |s| {
                    self.delay(s, arm, branch) - bound
                })
            };
            let bound = |side: i8| if side > 0 { hi } else { lo };
            match (here, next) {
                _ if here == next => {}
                // Right through a window narrower than the distance of the nodes.
                (-1, 1) => stretches.push((edge(lo), edge(hi))),
                (1, -1) => stretches.push((edge(hi), edge(lo))),
                (0, outside) => {
                    stretches.extend(from.take().map(|start| (start, edge(bound(outside)))));
                }
                (outside, _) => from = Some(edge(bound(outside))),
            }
        }
        if let Some(start) = from {
            stretches.push((start, self.s[NODES]));
        }
        stretches
    }

    fn piece(&self, arm: Arm, branch: u64, from: f64, to: f64) -> Option<CurvePiece> {
        let at = |s: f64| self.vertex(s, arm, branch);
        let mut vertices = vec![at(from)?];
        for i in 0..COARSE_SEGMENTS {
            let s = |i: usize| from + (to - from) * (i as f64 / COARSE_SEGMENTS as f64);
            self.refine(arm, branch, (s(i), s(i + 1)), MOST_HALVINGS, &mut vertices);
        }
        let distinct = vertices.first() != vertices.last();
        distinct.then(|| CurvePiece {
            kind: CurveKind::Pair,
            branch,
            direction: match arm {
                Arm::Upper => Direction::Right,
                Arm::Lower => Direction::Left,
            },
            stable_side: self.stable_side(arm, branch, 0.5 * (from + to)),
            vertices,
        })
    }

    /// Appends the vertices after `s.0` up to and with `s.1`, close enough together to draw
    /// straight lines between.
    fn refine(&self, arm: Arm, branch: u64, s: (f64, f64), halvings: u32, out: &mut Vec<Vertex>) {
        let middle = 0.5 * (s.0 + s.1);
        let at = |s: f64| self.vertex(s, arm, branch);
        let (Some(a), Some(m), Some(b)) = (at(s.0), at(middle), at(s.1)) else {
            return;
        };
        let off = |a: f64, m: f64, b: f64, width: f64| ((0.5 * (a + b) - m) / width).abs();
        let flat = off(a.p, m.p, b.p, self.window.p_width()) < FLATNESS
            && off(a.q, m.q, b.q, self.window.q_width()) < FLATNESS;
        if flat || halvings == 0 {
            out.push(b);
        } else {
            self.refine(arm, branch, (s.0, middle), halvings - 1, out);
            self.refine(arm, branch, (middle, s.1), halvings - 1, out);
        }
    }

    fn stable_side(&self, arm: Arm, branch: u64, s: f64) -> StableSide {
        let crossings = self.at(s);
        let Some(own) = arm_of(&crossings, arm) else {
            return StableSide::Neither;
        };
        let tau = own.delay(branch);
        let before = branch - own.first_branch;
        let others = |c: Option<Crossing>| c.map_or(0, |c| c.count_below(tau));
        let start = crossings.at_zero_delay;
        match arm {
            Arm::Upper if start + 2 * before == 2 * others(crossings.lower) => StableSide::Shorter,
            Arm::Lower if start + 2 * others(crossings.upper) == 2 * (before + 1) => {
                StableSide::Longer
            }
            _ => StableSide::Neither,
        }
    }
}
