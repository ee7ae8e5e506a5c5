//! Chains of unit masses, fixed at one end, with springs and dampers between them and delayed
//! feedback of the last mass on itself, and an independent count of their roots. It takes D from the
//! recursion over the masses, never from coefficients, and shares nothing with the crate.

use num_complex::Complex64;
use slipmap::linear::general::{Polynomial, System};

use super::walk::zeros_between;

/// D = P + Q e^(−λτ) with d = s² + 2cs + 2k, o = (cs + k)², p₀ = 1, p₁ = d and p_{i+1} = d p_i −
/// o p_{i−1}: P = (s² + cs + k) p_{m−1} − o p_{m−2}, Q = (g + hs) p_{m−1}.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Chain {
    pub(crate) masses: usize,
    pub(crate) spring: f64,
    pub(crate) damper: f64,
    pub(crate) gain: f64,
    pub(crate) rate_gain: f64,
    pub(crate) tau: f64,
}

/// Bounds on the sizes of a function and its first two derivatives within a disc.
type Sizes = [f64; 3];

fn product(a: Sizes, b: Sizes) -> Sizes {
    [
        a[0] * b[0],
        a[1] * b[0] + a[0] * b[1],
        a[2] * b[0] + 2.0 * a[1] * b[1] + a[0] * b[2],
    ]
}

fn sum(a: Sizes, b: Sizes) -> Sizes {
    [0, 1, 2].map(|i| a[i] + b[i])
}

impl Chain {
    /// The same chain with another unit of time, `unit` of the present ones.
    pub(crate) fn in_unit(self, unit: f64) -> Self {
        Self {
            spring: self.spring * unit * unit,
            damper: self.damper * unit,
            gain: self.gain * unit * unit,
            rate_gain: self.rate_gain * unit,
            tau: self.tau / unit,
            ..self
        }
    }

    /// P and Q by sums and products of polynomials, as a file of a system gives them.
    pub(crate) fn polynomials(&self) -> [Polynomial; 2] {
        let low = "a low degree";
        let of = |c: &[f64]| Polynomial::new(c).expect(low);
        let times = |a: &Polynomial, b: &Polynomial| a.times(b).expect(low);
        let (k, c) = (self.spring, self.damper);
        let inner = of(&[2.0 * k, 2.0 * c, 1.0]);
        let between = of(&[k, c]).power(2).expect(low);
        let (mut before, mut last) = (of(&[1.0]), inner);
        for _ in 2..self.masses {
            let next = times(&inner, &last).plus(&times(&between, &before), -1.0);
            (before, last) = (last, next);
        }
        let free = of(&[k, c, 1.0]);
        [
            times(&free, &last).plus(&times(&between, &before), -1.0),
            times(&of(&[self.gain, self.rate_gain]), &last),
        ]
    }

    pub(crate) fn system(&self) -> System {
        let [p, q] = self.polynomials();
        System::direct(p, q)
    }

    /// D and D′ by the recursion.
    fn jet(&self, s: Complex64) -> [Complex64; 2] {
        let (k, c) = (self.spring, self.damper);
        let times = |a: [Complex64; 2], b: [Complex64; 2]| [a[0] * b[0], a[1] * b[0] + a[0] * b[1]];
        let less = |a: [Complex64; 2], b: [Complex64; 2]| [a[0] - b[0], a[1] - b[1]];
        let one = Complex64::ONE;
        let inner = [s * s + 2.0 * (c * s + k), 2.0 * (s + c)];
        let between = [(c * s + k) * (c * s + k), 2.0 * c * (c * s + k)];
        let (mut before, mut last) = ([one, 0.0 * one], inner);
        for _ in 2..self.masses {
            let next = less(times(inner, last), times(between, before));
            (before, last) = (last, next);
        }
        let free = [s * s + c * s + k, 2.0 * s + c];
        let [p, slope] = less(times(free, last), times(between, before));
        let late = (-s * self.tau).exp();
        let fed = [
            (self.gain + self.rate_gain * s) * late,
            (self.rate_gain - self.tau * (self.gain + self.rate_gain * s)) * late,
        ];
        let [q, fed_slope] = times(fed, last);
        [p + q, slope + fed_slope]
    }

    /// A bound on |D″| within `near` of `s`.
    fn bend(&self, s: Complex64, near: f64) -> f64 {
        let (k, c, tau) = (self.spring, self.damper, self.tau);
        let quadratic = |part: f64| {
            let value = (s * s + part * (c * s + k)).norm();
            let slope = (2.0 * s + part * c).norm();
            [value + near * (slope + near), slope + 2.0 * near, 2.0]
        };
        let spring = [(c * s + k).norm() + c * near, c, 0.0];
        let (inner, between) = (quadratic(2.0), product(spring, spring));
        let (mut before, mut last) = ([1.0, 0.0, 0.0], inner);
        for _ in 2..self.masses {
            let next = sum(product(inner, last), product(between, before));
            (before, last) = (last, next);
        }
        let own = sum(product(quadratic(1.0), last), product(between, before));
        let size = (self.gain + self.rate_gain * s).norm() + self.rate_gain.abs() * near;
        let fed = product([size, self.rate_gain.abs(), 0.0], last);
        let late = (-(s.re - near) * tau).exp();
        own[2] + late * (fed[2] + tau * (2.0 * fed[1] + tau * fed[0]))
    }

    /// A radius within which every root with Re λ ≥ `line` lies: |λ|² ≤ 4(c|λ| + k) + (|g| +
    /// |h||λ|) e^(−στ).
    fn radius(&self, line: f64) -> f64 {
        let late = (-line * self.tau).exp();
        let linear = 4.0 * self.damper + self.rate_gain.abs() * late;
        let constant = 4.0 * self.spring + self.gain.abs() * late;
        1.01 * 0.5 * (linear + (linear * linear + 4.0 * constant).sqrt())
    }

    /// How many roots lie right of `line`, by the argument of D; none where one is too near to it.
    /// The spring is about 1 here.
    pub(crate) fn right_of(&self, line: f64) -> Option<u64> {
        let at = |z| self.jet(z)[0];
        let near = |z: Complex64, here: Complex64, step: f64| {
            let slope = self.jet(z)[1].norm() + self.bend(z, step) * step;
            slope * step <= 0.5 * here.norm()
        };
        zeros_between(line, self.radius(line), &at, &near)
    }
}
