//! Points of the line's curves where two of them meet.

use super::plane::{DecayPlane, Family, norm, solve};
use crate::linear::curves::Vertex;
use crate::linear::plane::Plane;
use crate::model::elementary::hypot;

const MOST_ITERATIONS: u32 = 40;
/// Frequency, in units of √(κ/M), at which the curve of a pair starts next to a double real root.
const FIRST_FREQUENCY: f64 = 1e-3;

/// A corner of the decaying region: the point, and the curve on which its boundary goes on.
pub(super) struct Turn {
    pub p: f64,
    pub q: f64,
    /// Frequency of the root that lies on the line before the corner.
    pub before: f64,
    /// Frequency of the root that lies on the line after the corner.
    pub after: f64,
    /// Where to go on.
    pub next: Vertex,
    pub family: Family,
}

impl<P: Plane> DecayPlane<'_, P> {
    /// The corner near `v`, a point of a curve of `family` at which a second root has come to the
    /// line.
    pub(super) fn corner(&self, v: Vertex, family: Family) -> Option<Turn> {
        let own = |omega: &f64| (omega - v.omega).abs();
        let mut others = self.candidates(v.p, v.q);
        let nearest =
            (0..others.len()).min_by(|&i, &j| own(&others[i]).total_cmp(&own(&others[j])))?;
        others.remove(nearest);
        others
            .into_iter()
            .find_map(|omega| self.double_root(v, family, omega))
    }

    /// Newton's method for roots at −σ + iω and −σ + iω′ at once, in (p, τ, ω, ω′).
    pub(super) fn double_root(&self, start: Vertex, family: Family, omega: f64) -> Option<Turn> {
        let other_family = self.family(start.p, start.q, omega);
        let (mut v, mut w) = (start, Vertex { omega, ..start });
        for _ in 0..MOST_ITERATIONS {
            let scales = self.scales(v);
            let of_other = self.scales(w)[2];
            let (a, b) = (self.local(v), self.local(w));
            let ([re, im], [other_re, other_im]) = (a.rows(), b.rows());
            let first = |row: [f64; 3]| {
                [
                    row[0] * scales[0],
                    row[1] * scales[1],
                    row[2] * scales[2],
                    0.0,
                ]
            };
            let second = |row: [f64; 3]| {
                [
                    row[0] * scales[0],
                    row[1] * scales[1],
                    0.0,
                    row[2] * of_other,
                ]
            };
            let (im, im_value) = match family {
                Family::Pair => (first(im), a.value.im),
                Family::Real { .. } => ([0.0, 0.0, 1.0, 0.0], 0.0),
            };
            let (other_im, other_value) = match other_family {
                Family::Pair => (second(other_im), b.value.im),
                Family::Real { .. } => ([0.0, 0.0, 0.0, 1.0], 0.0),
            };
            let rows = [first(re), im, second(other_re), other_im];
            let right = [-a.value.re, -im_value, -b.value.re, -other_value];
            let step = solve(rows, right)?;
            v.p += step[0] * scales[0];
            v.q += step[1] * scales[1];
            v.omega += step[2] * scales[2];
            w = Vertex {
                omega: w.omega + step[3] * of_other,
                ..v
            };
            if norm(step) < 1e-14 {
                break;
            }
        }
        let near = self.near(start, v) && (v.omega - w.omega).abs() > 1e-7 * self.scales(v)[2];
        let solved = near && self.local(v).vanishes() && self.local(w).vanishes();
        solved.then(|| Turn {
            p: v.p,
            q: v.q,
            before: v.omega,
            after: w.omega,
            next: w,
            family: self.family(w.p, w.q, w.omega),
        })
    }

    /// The point near `v` with a double real root −σ, where the curve of a pair ends on that of a
    /// real root.
    ///
    /// There D = D′ = 0. The boundary of the decaying region goes over from one curve to the other;
    /// the real root that bounds it is the rightmost one, so dD/dλ has the sign of d²D/dλ² along
    /// its curve.
    pub(super) fn end_of_pair(&self, v: Vertex, family: Family, sense: f64) -> Option<Turn> {
        let mut at = Vertex { omega: 0.0, ..v };
        let scales = self.scales(at);
        for _ in 0..MOST_ITERATIONS {
            let here = self.local(at);
            let slope = |dp: f64, dtau: f64| {
                let to = |sign: f64| Vertex {
                    p: at.p + sign * dp,
                    q: at.q + sign * dtau,
                    omega: 0.0,
                };
                0.5 * (self.local(to(1.0)).by_lambda.re - self.local(to(-1.0)).by_lambda.re)
            };
            let h = 1e-6;
            let rows = [
                [here.by_p.re * scales[0], here.by_q.re * scales[1]],
                [slope(h * scales[0], 0.0) / h, slope(0.0, h * scales[1]) / h],
            ];
            let step = solve(rows, [-here.value.re, -here.by_lambda.re])?;
            at.p += step[0] * scales[0];
            at.q += step[1] * scales[1];
            if norm(step) < 1e-14 {
                break;
            }
        }
        let here = self.local(at);
        if !self.near(v, at) || !here.vanishes() {
            return None;
        }
        let slope = here.by_lambda_twice.re.signum();
        let (next, family) = match family {
            Family::Pair => (at, Family::Real { slope }),
            Family::Real { .. } => (self.start_of_pair(at, sense)?, Family::Pair),
        };
        Some(Turn {
            p: at.p,
            q: at.q,
            before: 0.0,
            after: 0.0,
            next,
            family,
        })
    }

    /// The first point of the pair's curve that begins at the double real root `at`, if the
    /// boundary leaves along it.
    fn start_of_pair(&self, at: Vertex, sense: f64) -> Option<Vertex> {
        let omega = FIRST_FREQUENCY / self.plane.unit(at.p, at.q);
        let next = self.correct(Vertex { omega, ..at }, Family::Pair, [0.0, 0.0, 1.0])?;
        let leaves = sense * self.tangent(next, Family::Pair)[2] > 0.0;
        (leaves && self.inside(next)).then_some(next)
    }

    fn near(&self, v: Vertex, w: Vertex) -> bool {
        let scales = self.scales(v);
        hypot((v.p - w.p) / scales[0], (v.q - w.q) / scales[1]) < 1e-2
    }
}
