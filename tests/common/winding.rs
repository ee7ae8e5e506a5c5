//! An independent count of roots: the argument principle along a vertical line, in small steps.
//!
//! It shares nothing with the crate but the definition of D, written out here once more. D has no
//! poles and, far out right of the line, behaves like (λ − σ)²; so with R beyond every root there,
//!
//! ```text
//! n = (2 arg D(σ + R e^{iφ})|_{φ: 0 → π/2} − 2 arg D(σ + iω)|_{ω: 0 → R}) / 2π.
//! ```
//!
//! Steps are bounded by |D| over a Lipschitz constant of D, so that no turn can be skipped.

use num_complex::Complex64;

/// The number of roots with positive real part, or none where D comes too near to zero on the
/// imaginary axis.
#[allow(dead_code, reason = "not every test binary uses it")]
pub(crate) fn unstable_roots(b: f64, a_v: f64, a_n: f64, tau: f64) -> Option<u64> {
    roots_right_of(b, a_v, a_n, tau, 0.0)
}

/// The number of roots with Re λ > `line`, or none where D comes too near to zero on that line.
pub(crate) fn roots_right_of(b: f64, a_v: f64, a_n: f64, tau: f64, line: f64) -> Option<u64> {
    let kappa = (-line * tau).exp();
    let d = |m: Complex64| {
        let l = m + line;
        // 1 − e^(−z) = 2 e^(−z/2) sinh(z/2): exact where the delay is short.
        let half = 0.5 * tau * l;
        l * l + b * l + 1.0 - (a_n + a_v * (b + l)) * 2.0 * (-half).exp() * half.sinh()
    };
    // |D(σ + μ) − μ²| ≤ linear |μ| + constant for Re μ ≥ 0.
    let linear = (2.0 * line + b).abs() + a_v.abs() * (1.0 + kappa);
    let at_line = (a_n + a_v * (b + line)).abs();
    let constant = (line * line + b * line + 1.0).abs() + at_line * (1.0 + kappa);
    let beyond = 1.0 + 2.0 * (linear + constant.sqrt());
    // |1 − e^(−λτ)| ≤ |λ|τ max(1, κ) as well.
    let difference = |s: f64| (1.0 + kappa).min((line.abs() + s) * tau * kappa.max(1.0));
    let along_line = turn(
        |s| d(Complex64::new(0.0, s)),
        beyond,
        |s| {
            let open_loop = 2.0 * s + (2.0 * line + b).abs();
            open_loop + a_v.abs() * difference(s) + (at_line + a_v.abs() * s) * kappa * tau
        },
    )?;
    // On the arc D/μ² stays within 1 of 1, so its argument needs no tracking.
    let corner = Complex64::new(0.0, beyond);
    let along_arc = std::f64::consts::PI + (d(corner) / (corner * corner)).arg();
    let n = (along_arc - along_line) / std::f64::consts::PI;
    assert!((n - n.round()).abs() < 1e-6, "winding number {n}");
    Some(n.round() as u64)
}

/// Total change of arg f from 0 to `end`; `slope(s)` bounds |f′| on [0, s].
fn turn(f: impl Fn(f64) -> Complex64, end: f64, slope: impl Fn(f64) -> f64) -> Option<f64> {
    let (mut s, mut value, mut total) = (0.0_f64, f(0.0), 0.0);
    while s < end {
        let size = value.norm();
        if size < 1e-7 {
            return None;
        }
        // Over the step the change of f is at most 0.9 of |f|: the argument turns by less than a
        // right angle.
        let guess = (s + 0.9 * size / slope(s)).min(end);
        let step = 0.9 * size / slope(guess);
        let next_s = (s + step).min(end);
        let next = f(next_s);
        total += (next / value).arg();
        (s, value) = (next_s, next);
    }
    Some(total)
}
