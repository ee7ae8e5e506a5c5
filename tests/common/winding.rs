//! An independent count of unstable roots: the argument principle along the imaginary axis.
//!
//! It shares nothing with the crate but the definition of D, written out here once more. D has no poles and, far out in
//! the right half-plane, behaves like λ²; so with R beyond every root of the right half-plane,
//!
//! ```text
//! n = (2 arg D(R e^{iφ})|_{φ: 0 → π/2} − 2 arg D(iω)|_{ω: 0 → R}) / 2π.
//! ```
//!
//! Steps are bounded by |D| over a Lipschitz constant of D, so that no turn can be skipped.

use num_complex::Complex64;

/// The number of roots with positive real part, or none where D comes too near to zero on the imaginary axis.
pub fn unstable_roots(b: f64, a_v: f64, a_n: f64, tau: f64) -> Option<u64> {
    let d = |l: Complex64| l * l + b * l + 1.0 - (a_n + a_v * (b + l)) * (1.0 - (-l * tau).exp());
    let beyond =
        1.0 + 2.0 * (b.abs() + 2.0 * a_v.abs() + (1.0 + 2.0 * (a_n + a_v * b).abs()).sqrt());
    let along_axis = turn(
        |s| d(Complex64::new(0.0, s)),
        beyond,
        |s| 2.0 * s + b.abs() + 2.0 * a_v.abs() + (a_n.abs() + a_v.abs() * (b.abs() + s)) * tau,
    )?;
    // On the arc D/λ² stays within 1 of 1, so its argument needs no tracking.
    let corner = Complex64::new(0.0, beyond);
    let along_arc = std::f64::consts::PI + (d(corner) / (corner * corner)).arg();
    let n = (along_arc - along_axis) / std::f64::consts::PI;
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
        // Over the step the change of f is at most 0.9 of |f|: the argument turns by less than a right angle.
        let guess = (s + 0.9 * size / slope(s)).min(end);
        let step = 0.9 * size / slope(guess);
        let next_s = (s + step).min(end);
        let next = f(next_s);
        total += (next / value).arg();
        (s, value) = (next_s, next);
    }
    Some(total)
}
