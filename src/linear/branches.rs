//! Starting values for characteristic roots from the branches of the complex logarithm.
//!
//! With P = B − A and Q = A the equation D = 0 reads λτ = log(−Q/P) + 2πik. Every root belongs to a
//! branch k. For long delays, or far from the zeros of P and Q, each branch has one root. Newton's
//! method on this equation then starts near its goal, at any delay and with no matrix. Nothing
//! promises that all roots are found: [`super::spectrum`] counts them, and turns to collocation
//! where some are missing.

use std::f64::consts::{PI, TAU};

use num_complex::Complex64;

use super::equation::Equation;
use super::newton::divide;
use super::roots::narrowed;
use crate::model::Groups;
use crate::model::elementary::{arg, exp, ln};
use crate::model::groups::feedback_coefficients;

/// Newton steps on the logarithmic equation before a start is handed over.
const STEPS: u32 = 4;
/// Most branches examined; beyond this the line was set too far left.
const MOST_BRANCHES: usize = 1 << 20;
/// Most branches followed: more roots than that right of the line are not wanted.
const MOST_STARTS: usize = 4096;
/// Where there are more it is worth knowing which to follow, without looking at each.
const FEW: usize = 64;
/// The first of them are followed in any case.
const ALWAYS_FOLLOWED: usize = 4;
/// Parts into which the real axis is cut to find real roots.
const REAL_PARTS: u32 = 12;

/// P and Q of the controlled oscillator, by their coefficients.
pub(super) struct LetterPair {
    p0: f64,
    p1: f64,
    q0: f64,
    q1: f64,
}

impl LetterPair {
    pub(super) fn new(groups: Groups) -> Self {
        let [q0, q1] = feedback_coefficients(groups);
        Self {
            p0: 1.0 - q0,
            p1: groups.b - q1,
            q0,
            q1,
        }
    }

    /// The coefficients of P and of Q, the constants first.
    pub(super) fn coefficients(&self) -> ([f64; 3], [f64; 2]) {
        ([self.p0, self.p1, 1.0], [self.q0, self.q1])
    }

    /// The zeros of P, and those of B.
    pub(super) fn zeros(&self, b: f64) -> impl Iterator<Item = Complex64> {
        let pairs = [(self.p1, self.p0), (b, 1.0)];
        pairs
            .into_iter()
            .flat_map(|(linear, constant)| quadratic_zeros(linear, constant))
    }

    /// P, P′, Q and Q′ at λ.
    #[inline]
    pub(super) fn at(&self, lambda: Complex64) -> [Complex64; 4] {
        [
            lambda * (lambda + self.p1) + self.p0,
            2.0 * lambda + self.p1,
            self.q0 + self.q1 * lambda,
            Complex64::from(self.q1),
        ]
    }
}

/// Writes starting values for the roots with Re λ > `line`, Im λ ≥ 0 to `starts`, replacing what it
/// holds.
///
/// `tau` > 0 in units of √(M/κ). Control must act.
pub(super) fn starting_values(
    equation: impl Equation,
    tau: f64,
    line: f64,
    starts: &mut Vec<Complex64>,
) {
    starts.clear();
    let radius = equation.root_bound(tau, line);
    let branches = Branches {
        pair: equation.pair(),
        tau,
        span: equation.memory_span(tau),
        line,
        kappa: exp(-line * tau),
    };
    let number = branches.number(radius).ceil() + 2.0;
    let number = (number as usize).min(MOST_BRANCHES);
    let bands = (number > FEW).then(|| equation.equal_sizes(tau, line));
    match bands.flatten() {
        Some(ends) => branches.of_bands(number, ends, starts),
        None => branches.one_by_one(number, starts),
    }
    // Roots stay near the zeros of P under weak feedback, near those of B at short delays.
    equation.zeros(starts);
    real_starts(&branches.pair, tau, line, radius, starts);
}

/// The branches of λτ = log(−Q/P) + 2πik, numbered by where they are followed from, half a turn of
/// e^(−λτ) from one to the next.
///
/// A guess says which to follow: roots right of the line belong to branches where feedback is the
/// larger term on the line, and to those next to them.
struct Branches<P> {
    pair: P,
    tau: f64,
    /// How far back in time the equation reaches.
    span: f64,
    line: f64,
    /// κ = e^(−στ) on the line σ.
    kappa: f64,
}

impl<P: Fn(Complex64) -> [Complex64; 4]> Branches<P> {
    fn frequency(&self, j: usize) -> f64 {
        PI * j as f64 / self.span
    }

    /// The number of a branch at the frequency `omega`, not rounded.
    fn number(&self, omega: f64) -> f64 {
        omega * self.span / PI
    }

    /// Whether feedback is the larger term on the line.
    fn inside(&self, omega: f64) -> bool {
        let [p, _, q, _] = (self.pair)(Complex64::new(self.line, omega));
        p.norm_sqr() <= self.kappa * self.kappa * q.norm_sqr()
    }

    /// Follows branch `j`; false where there are starts enough.
    fn follow(&self, j: usize, starts: &mut Vec<Complex64>) -> bool {
        let spans = (self.tau, self.span);
        starts.extend(follow_branch(&self.pair, spans, self.frequency(j)));
        starts.len() < MOST_STARTS
    }

    /// Follows the branches that are wanted among the first `number`, looking at each.
    fn one_by_one(&self, number: usize, starts: &mut Vec<Complex64>) {
        let (mut before, mut here) = (true, true);
        for j in 0..number {
            let after = j < ALWAYS_FOLLOWED || self.inside(self.frequency(j + 1));
            if (before || here || after) && !self.follow(j, starts) {
                break;
            }
            (before, here) = (here, after);
        }
    }

    /// Follows the branches that are wanted among the first `number`. `ends` are the frequencies at
    /// which both terms are equally large; between two of them all branches are wanted, or none.
    fn of_bands(&self, number: usize, mut ends: Vec<f64>, starts: &mut Vec<Complex64>) {
        ends.sort_by(f64::total_cmp);
        ends.push(self.frequency(number));
        // With the first ones `one_by_one` follows the two next to them.
        let (mut from, mut next) = (0.0, ALWAYS_FOLLOWED + 2);
        let mut enough = (0..next).any(|j| !self.follow(j, starts));
        for to in ends {
            if self.inside(0.5 * (from + to)) {
                let [first, last] = [from, to].map(|omega| self.number(omega) as usize);
                let range = next.max(first.saturating_sub(1))..number.min(last + 3);
                next = next.max(range.end);
                enough = enough || range.into_iter().any(|j| !self.follow(j, starts));
            }
            from = to;
        }
    }
}

/// Newton's method on λτ = log(−Q/P) + 2πik from the branch that `omega` belongs to.
fn follow_branch(
    pair: impl Fn(Complex64) -> [Complex64; 4],
    (tau, span): (f64, f64),
    omega: f64,
) -> Option<Complex64> {
    let on_axis = Complex64::new(0.0, omega);
    let [p, _, q, _] = pair(on_axis);
    let mut lambda = Complex64::new(0.5 * ln(q.norm_sqr() / p.norm_sqr()) / span, omega);
    for _ in 0..STEPS {
        let [p, slope, q, q_slope] = pair(lambda);
        let log = -divide(p, q);
        let log = Complex64::new(0.5 * ln(log.norm_sqr()), arg(log));
        let mut mismatch = lambda * tau + log;
        mismatch.im -= TAU * (mismatch.im / TAU).round();
        let derivative = tau + divide(slope, p) - divide(q_slope, q);
        lambda -= divide(mismatch, derivative);
    }
    (lambda.re.is_finite() && lambda.im.is_finite())
        .then(|| Complex64::new(lambda.re, lambda.im.abs()))
}

/// The zeros of λ² + `linear` λ + `constant` in the upper half-plane and on the real axis.
pub(super) fn quadratic_zeros(linear: f64, constant: f64) -> impl Iterator<Item = Complex64> {
    let half = -0.5 * linear;
    let discriminant = half * half - constant;
    let zeros = if discriminant < 0.0 {
        [Some(Complex64::new(half, (-discriminant).sqrt())), None]
    } else {
        // The larger one first, the other from the product.
        let large = half + discriminant.sqrt().copysign(half);
        let small = if large == 0.0 { 0.0 } else { constant / large };
        [large, small].map(|zero| Some(Complex64::from(zero)))
    };
    zeros.into_iter().flatten()
}

/// Starting values for roots that hardly change within the delay: the zeros of D where
/// 1 − E = λτ − (λτ)²/2,
///
/// ```text
/// (1 − a_v τ + Q(0) τ²/2) λ² + (b − Q(0) τ) λ + 1,
/// ```
///
/// With strong gains and a short delay neither the branches nor the parts of the real axis lead to
/// these roots.
pub(super) fn slow_starts(groups: Groups, tau: f64) -> impl Iterator<Item = Complex64> {
    let LetterPair { q0, q1, .. } = LetterPair::new(groups);
    let (leading, linear) = (1.0 - q1 * tau + 0.5 * q0 * tau * tau, groups.b - q0 * tau);
    // Solved for 1/λ, since the leading coefficient may vanish.
    quadratic_zeros(linear, leading)
        .map(|z| divide(Complex64::ONE, z))
        .filter(|z| z.re.is_finite() && z.im.is_finite())
        .map(|z| Complex64::new(z.re, z.im.abs()))
}

/// Halvings of a part of the real axis: Newton's method does the rest.
const HALVINGS: u32 = 8;

/// A start in each part of the real axis right of `line` in which D changes its sign.
fn real_starts(
    pair: impl Fn(Complex64) -> [Complex64; 4],
    tau: f64,
    line: f64,
    radius: f64,
    starts: &mut Vec<Complex64>,
) {
    let value = |s: f64| {
        let [p, _, q, _] = pair(Complex64::from(s));
        p.re + q.re * exp(-s * tau)
    };
    let place = |i: u32| line + (radius + 1e-9 - line) * f64::from(i) / f64::from(REAL_PARTS);
    let mut before = value(place(0));
    for i in 1..=REAL_PARTS {
        let here = value(place(i));
        if (before > 0.0) != (here > 0.0) {
            let mut halvings = 0;
            let enough = |_, _| {
                halvings += 1;
                halvings > HALVINGS
            };
            let like_before = |s| (value(s) > 0.0) == (before > 0.0);
            let (from, to) = narrowed(place(i - 1), place(i), enough, like_before);
            starts.push(Complex64::from(0.5 * (from + to)));
        }
        before = here;
    }
}
