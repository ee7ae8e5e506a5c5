//! D on the line Re λ = −σ over a plane (p, τ), and Newton's method there.

use num_complex::Complex64;

use crate::linear::certificate::roots_right_of;
use crate::linear::characteristic::Jet;
use crate::linear::curves::{Vertex, Window};
use crate::model::Groups;
use crate::model::elementary::{self, exp, power};

/// Iterations after which Newton's method is given up.
const MOST_ITERATIONS: u32 = 24;
/// A vertex has |D| within this many of its rounding bounds.
const ROUNDINGS: f64 = 64.0;
/// Step of the central difference in p, over the width of the window.
const DIFFERENCE: f64 = 1e-6;
/// Distance right of the line, in 1/√(M/κ), from which a root counts as another one than those on
/// the line.
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

/// What a plane is made of.
pub(super) struct DecayPlane<'a> {
    /// Groups and time unit at a value of the parameter inside the window.
    pub groups_at: &'a dyn Fn(f64) -> (Groups, f64),
    /// σ > 0, 1/time.
    pub sigma: f64,
    pub window: &'a Window,
}

/// D and its derivatives at one point, in the units of the plane.
pub(super) struct Local {
    pub value: Complex64,
    /// ∂D/∂λ.
    pub by_lambda: Complex64,
    /// ∂²D/∂λ².
    pub by_lambda_twice: Complex64,
    /// ∂D/∂p.
    pub by_p: Complex64,
    /// ∂D/∂τ.
    pub by_tau: Complex64,
    /// Bound on the rounding error of `value`.
    rounding: f64,
}

impl Local {
    pub(super) fn vanishes(&self) -> bool {
        elementary::norm(self.value) <= ROUNDINGS * self.rounding
    }

    /// The rows of Re D and Im D over (p, τ, ω).
    pub(super) fn rows(&self) -> [[f64; 3]; 2] {
        let by_omega = Complex64::i() * self.by_lambda;
        [
            [self.by_p.re, self.by_tau.re, by_omega.re],
            [self.by_p.im, self.by_tau.im, by_omega.im],
        ]
    }
}

impl DecayPlane<'_> {
    /// `p`, or the end of the window beyond which the model may not be valid.
    fn clamped(&self, p: f64) -> f64 {
        p.clamp(*self.window.p.start(), *self.window.p.end())
    }

    pub(super) fn groups(&self, p: f64) -> (Groups, f64) {
        (self.groups_at)(self.clamped(p))
    }

    fn jet(&self, p: f64, tau: f64, omega: f64) -> (Jet, f64, f64) {
        let (groups, unit) = self.groups(p);
        let lambda = Complex64::new(-self.sigma, omega) * unit;
        let jet = Jet::at(groups, tau / unit, lambda);
        (jet, jet.rounding(groups, tau / unit, lambda), unit)
    }

    /// D and its derivatives at `v`. Beyond the window, where the model may not be valid, D is
    /// continued linearly in p.
    pub(super) fn local(&self, v: Vertex) -> Local {
        let (jet, rounding, unit) = self.jet(v.p, v.tau, v.omega);
        let h = DIFFERENCE * self.window.p_width();
        let here = self.clamped(v.p);
        let (below, above) = (self.clamped(here - h), self.clamped(here + h));
        let [low, high] = [below, above].map(|p| self.jet(p, v.tau, v.omega).0.value);
        let by_p = (high - low) / (above - below).max(f64::MIN_POSITIVE);
        let lambda = Complex64::new(-self.sigma, v.omega);
        Local {
            value: jet.value + by_p * (v.p - here),
            by_lambda: jet.first * unit,
            by_lambda_twice: jet.second * (unit * unit),
            by_p,
            by_tau: -jet.feedback * lambda * jet.delayed,
            rounding,
        }
    }

    /// The point of the curve that Newton's method reaches from `start` with `row` · (p, τ, ω) kept
    /// as it is.
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
            v.tau += step[1] * scales[1];
            v.omega += step[2] * scales[2];
        }
        self.local(v).vanishes().then_some(v)
    }

    /// Lengths along (p, τ, ω) over which a curve may bend: widths of the window, and what makes a
    /// turn of ωτ.
    pub(super) fn scales(&self, v: Vertex) -> [f64; 3] {
        let unit = self.groups(v.p).1;
        let frequency = v.omega.abs() + 1.0 / unit;
        let turn = std::f64::consts::TAU;
        [
            self.window.p_width(),
            self.window.tau_width().min(4.0 * turn / frequency),
            frequency.min(turn / v.tau.max(f64::MIN_POSITIVE)),
        ]
    }

    /// The unit tangent (p, τ, ω) of a curve in units of [`DecayPlane::scales`], with the decaying
    /// side on its left where p points right and τ up.
    ///
    /// It is the null vector of [`Local::rows`], whose sign is such that Re λ falls to the left.
    pub(super) fn tangent(&self, v: Vertex, family: Family) -> [f64; 3] {
        let d = self.local(v);
        let tangent = match family {
            // The mirror image ω < 0 is the way on through ω = 0.
            Family::Pair => [
                (d.by_tau * d.by_lambda.conj()).re,
                -(d.by_p * d.by_lambda.conj()).re,
                (d.by_p.conj() * d.by_tau).im,
            ]
            .map(|t| t * v.omega.signum()),
            Family::Real { slope } => [slope * d.by_tau.re, -slope * d.by_p.re, 0.0],
        };
        let scales = self.scales(v);
        let scaled = [0, 1, 2].map(|i| tangent[i] / scales[i]);
        let size = norm(scaled);
        scaled.map(|x| x / size)
    }

    /// The number of roots right of the line besides those on it; none where that is undecided.
    pub(super) fn others(&self, v: Vertex) -> Option<u64> {
        let (groups, unit) = self.groups(v.p);
        roots_right_of(groups, v.tau / unit, -self.sigma * unit + BESIDE)
    }

    /// All roots lie left of the line; false where that is undecided.
    pub(super) fn decays(&self, p: f64, tau: f64) -> bool {
        let (groups, unit) = self.groups(p);
        roots_right_of(groups, tau / unit, -self.sigma * unit) == Some(0)
    }

    /// Inside the window, to rounding.
    pub(super) fn inside(&self, v: Vertex) -> bool {
        let within = |x: f64, (from, to): (f64, f64)| {
            let slack = 1e-13 * (to - from);
            from - slack <= x && x <= to + slack
        };
        let ends = |range: &std::ops::RangeInclusive<f64>| (*range.start(), *range.end());
        within(v.p, ends(&self.window.p)) && within(v.tau, ends(&self.window.tau))
    }

    /// The frequencies ω₋ ≤ ω₊ at which a root may lie on the line: the zeros of |P|² − κ²|Q|²,
    /// with D = P + Q e^(−λτ) and κ = e^(στ), a quadratic in ω². |P| < κ|Q| between them; none
    /// where that holds nowhere, ω₋ = 0 where it holds at ω = 0.
    pub(super) fn band(&self, p: f64, tau: f64) -> Option<(f64, f64)> {
        let (Groups { b, a_v, a_n }, unit) = self.groups(p);
        let line = -self.sigma * unit;
        let kappa = exp(self.sigma * tau);
        let q0 = a_n + a_v * (b + line);
        let c = line * line + b * line + 1.0 - q0;
        let damping = 2.0 * line + b - a_v;
        let half = 0.5 * (damping * damping - power(kappa * a_v, 2)) - c;
        let product = (c - kappa * q0) * (c + kappa * q0);
        let root = (half * half - product).sqrt();
        let upper = if half <= 0.0 {
            root - half
        } else {
            -product / (half + root)
        };
        // NaN: no frequency.
        (upper > 0.0).then(|| {
            let lower = (product / upper).max(0.0);
            (lower.sqrt() / unit, upper.sqrt() / unit)
        })
    }

    /// The frequencies, at most three, at which a root can lie on the line at (p, τ).
    pub(super) fn candidates(&self, p: f64, tau: f64) -> Vec<f64> {
        let band = self.band(p, tau).map(|(lower, upper)| [lower, upper]);
        let mut all: Vec<f64> = band.into_iter().flatten().chain([0.0]).collect();
        let residual = |omega: &f64| elementary::norm(self.jet(p, tau, *omega).0.value);
        all.sort_by(|a, b| residual(a).total_cmp(&residual(b)));
        all.dedup();
        all
    }

    /// The family of a root with the frequency `omega` at (p, τ).
    pub(super) fn family(&self, p: f64, tau: f64, omega: f64) -> Family {
        if omega > 0.0 {
            return Family::Pair;
        }
        let slope = self.jet(p, tau, 0.0).0.first.re.signum();
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
