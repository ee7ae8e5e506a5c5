//! A line Re λ = −σ over a plane: Newton's method there, tangents, counts.

use std::f64::consts::TAU;

use num_complex::Complex64;

use crate::linear::curves::{Vertex, Window};
use crate::linear::plane::{Local, Plane};
use crate::model::elementary;

/// Iterations after which Newton's method is given up.
const MOST_ITERATIONS: u32 = 24;
/// Roots farther right of the line than this, in 1/√(M/κ), are others than those on the line.
const BESIDE: f64 = 1e-9;

/// Which root lies on the line along a curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Family {
    /// A complex pair −σ ± iω, ω > 0.
    Pair,
    /// A real root −σ. `slope` is the sign of dD/dλ there, which changes where another real root
    /// joins it.
    Real {
        /// ±1.
        slope: f64,
    },
}

/// A plane and the line on which roots lie.
pub(super) struct DecayPlane<'a, P> {
    /// The characteristic function over it.
    pub plane: &'a P,
    /// The line is Re λ = −σ; 1/time.
    pub sigma: f64,
    /// Whole curves are followed, not only the boundary of the region.
    pub whole: bool,
}

impl<P: Plane> DecayPlane<'_, P> {
    pub(super) fn window(&self) -> &Window {
        self.plane.window()
    }

    pub(super) fn local(&self, v: Vertex) -> Local {
        self.plane.local(v, self.sigma)
    }

    /// The point of the curve that Newton's method reaches from `start` with `row` · (p, q, ω) held
    /// constant.
    pub(super) fn correct(&self, start: Vertex, family: Family, row: [f64; 3]) -> Option<Vertex> {
        let mut v = start;
        let mut last = f64::INFINITY;
        for _ in 0..MOST_ITERATIONS {
            let local = self.local(v);
            let scales = self.scales(v);
            let [re, im] = local.rows();
            let (im, im_value) = match family {
                Family::Pair => (im, local.value.im),
                Family::Real { .. } => ([0.0, 0.0, 1.0], 0.0),
            };
            let scaled = |row: [f64; 3]| [0, 1, 2].map(|i| row[i] * scales[i]);
            let step = solve([re, im, row].map(scaled), [-local.value.re, -im_value, 0.0])?;
            let size = norm(step);
            // At rounding level steps no longer shrink.
            if local.vanishes() && (size >= 0.25 * last || size < 1e-15) {
                return Some(v);
            }
            if !size.is_finite() || size > 1e3 {
                return None;
            }
            last = size;
            v.p += step[0] * scales[0];
            v.q += step[1] * scales[1];
            v.omega += step[2] * scales[2];
        }
        self.local(v).vanishes().then_some(v)
    }

    /// Lengths along (p, q, ω) over which a curve may bend: widths of the window, and changes by
    /// which ωτ makes a turn.
    pub(super) fn scales(&self, v: Vertex) -> [f64; 3] {
        let frequency = v.omega.abs() + 1.0 / self.plane.unit(v.p, v.q);
        let window = self.window();
        let along = |width: f64, delay: bool| match delay {
            true => width.min(4.0 * TAU / frequency),
            false => width,
        };
        let [p, q] = self.plane.delays();
        let delay = self.plane.delay(v.p, v.q);
        [
            along(window.p_width(), p),
            along(window.q_width(), q),
            frequency.min(TAU / delay.max(f64::MIN_POSITIVE)),
        ]
    }

    /// The unit tangent (p, q, ω) of a curve in units of [`DecayPlane::scales`], with the decaying
    /// side on its left where p points right and q up.
    ///
    /// It is the null vector of [`Local::rows`], whose sign is such that Re λ falls to the left.
    pub(super) fn tangent(&self, v: Vertex, family: Family) -> [f64; 3] {
        let d = self.local(v);
        let tangent = match family {
            // The mirror image ω < 0 is the way on through ω = 0.
            Family::Pair => [
                (d.by_q * d.by_lambda.conj()).re,
                -(d.by_p * d.by_lambda.conj()).re,
                (d.by_p.conj() * d.by_q).im,
            ]
            .map(|t| t * v.omega.signum()),
            Family::Real { slope } => [slope * d.by_q.re, -slope * d.by_p.re, 0.0],
        };
        let scales = self.scales(v);
        let scaled = [0, 1, 2].map(|i| tangent[i] / scales[i]);
        let size = norm(scaled);
        scaled.map(|x| x / size)
    }

    /// The number of roots right of the line besides those on it; none where that is undecided.
    pub(super) fn others(&self, v: Vertex) -> Option<u64> {
        self.plane.right_of(v.p, v.q, self.sigma, BESIDE)
    }

    /// Whether all roots lie left of the line; false where that is undecided.
    pub(super) fn decays(&self, p: f64, q: f64) -> bool {
        self.plane.right_of(p, q, self.sigma, 0.0) == Some(0)
    }

    /// Whether `v` is inside the window, to rounding.
    pub(super) fn inside(&self, v: Vertex) -> bool {
        let within = |x: f64, (from, to): (f64, f64)| {
            let slack = 1e-13 * (to - from);
            from - slack <= x && x <= to + slack
        };
        let ends = |range: &std::ops::RangeInclusive<f64>| (*range.start(), *range.end());
        within(v.p, ends(&self.window().p)) && within(v.q, ends(&self.window().q))
    }

    /// The frequencies at which a root can lie on the line at (p, q), the likeliest first.
    pub(super) fn candidates(&self, p: f64, q: f64) -> Vec<f64> {
        let mut all = self.plane.frequencies(p, q, self.sigma);
        all.push(0.0);
        let at = |omega: f64| self.plane.at(p, q, Complex64::new(-self.sigma, omega));
        let residual = |omega: &f64| elementary::norm(at(*omega).value);
        all.sort_by(|a, b| residual(a).total_cmp(&residual(b)));
        all.dedup();
        all
    }

    /// The family of a root with the frequency `omega` at (p, q).
    pub(super) fn family(&self, p: f64, q: f64, omega: f64) -> Family {
        if omega > 0.0 {
            return Family::Pair;
        }
        let at = self.plane.at(p, q, Complex64::new(-self.sigma, 0.0));
        let slope = at.by_lambda.re.signum();
        Family::Real { slope }
    }
}

pub(super) fn norm<const N: usize>(v: [f64; N]) -> f64 {
    v.iter().map(|x| x * x).sum::<f64>().sqrt()
}

pub(super) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

/// The solution of `rows` · x = `right` by Gaussian elimination with pivoting; none where the rows
/// are dependent.
pub(super) fn solve<const N: usize>(
    mut rows: [[f64; N]; N],
    mut right: [f64; N],
) -> Option<[f64; N]> {
    for (row, value) in rows.iter_mut().zip(&mut right) {
        let size = row.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        *row = row.map(|x| x / size);
        *value /= size;
    }
    for column in 0..N {
        let pivot = (column..N).max_by(|&i, &j| {
            let size = |k: usize| rows[k][column].abs();
            size(i).total_cmp(&size(j))
        })?;
        rows.swap(column, pivot);
        right.swap(column, pivot);
        for below in column + 1..N {
            let factor = rows[below][column] / rows[column][column];
            let above = rows[column];
            for (entry, from) in rows[below].iter_mut().zip(above) {
                *entry -= factor * from;
            }
            right[below] -= factor * right[column];
        }
    }
    let mut x = [0.0; N];
    for i in (0..N).rev() {
        let known: f64 = (i + 1..N).map(|k| rows[i][k] * x[k]).sum();
        x[i] = (right[i] - known) / rows[i][i];
    }
    x.iter().all(|v| v.is_finite()).then_some(x)
}
