//! An independent count of roots of D(z) = Σ p_k(z) e^(−z t_k): the argument along a rectangle, in
//! steps within which it cannot turn far. It shares nothing with the crate.

#![allow(dead_code, reason = "no test uses all of it")]

use std::f64::consts::PI;

use num_complex::Complex64;

/// Steps after which a walk is given up.
const MOST_STEPS: u32 = 200_000;

/// D by its terms: the coefficients of p_k, the constant first, and t_k ≥ 0. The first one has
/// t = 0 and the highest degree.
#[derive(Debug, Clone)]
pub(crate) struct Walk {
    pub(crate) terms: Vec<(Vec<f64>, f64)>,
}

fn value(p: &[f64], z: Complex64) -> Complex64 {
    p.iter().rev().fold(Complex64::ZERO, |sum, c| sum * z + c)
}

/// Σ |c_k| size^k and the same of the derivative.
fn bounds(p: &[f64], size: f64) -> (f64, f64) {
    let (mut sum, mut slope) = (0.0, 0.0);
    for c in p.iter().rev() {
        slope = slope * size + sum;
        sum = sum * size + c.abs();
    }
    (sum, slope)
}

impl Walk {
    fn at(&self, z: Complex64) -> Complex64 {
        let terms = self.terms.iter();
        terms.map(|(p, t)| value(p, z) * (-z * t).exp()).sum()
    }

    /// A bound on |D′| within `near` of `z`.
    pub(crate) fn slope(&self, z: Complex64, near: f64) -> f64 {
        let of = |(p, t): &(Vec<f64>, f64)| {
            let (size, slope) = bounds(p, z.norm() + near);
            (slope + t * size) * (-(z.re - near) * t).exp()
        };
        self.terms.iter().map(of).sum()
    }

    /// A radius beyond which nothing lies right of `line`; none where there is none, or where it is
    /// too large.
    pub(crate) fn radius(&self, line: f64) -> Option<f64> {
        let (first, _) = self.terms.first()?;
        let n = first.len() - 1;
        let mut radius: f64 = 1.0;
        loop {
            let others: f64 = self.terms[1..]
                .iter()
                .map(|(p, t)| bounds(p, radius).0 * (-line * t).exp())
                .sum();
            let (lower, _) = bounds(&first[..n], radius);
            if first[n].abs() * radius.powi(n as i32) > lower + others {
                return Some(1.1 * radius);
            }
            if radius > 1e4 {
                return None;
            }
            radius *= 1.1;
        }
    }

    /// How many roots lie right of `line`. None where that takes too long, or where a root is too
    /// near to the line.
    pub(crate) fn right_of(&self, line: f64) -> Option<u64> {
        let radius = self.radius(line)?;
        let at = |z| self.at(z);
        // |D′| step ≤ |D|/2; false also where the bound overflows.
        let near = |z, here: Complex64, step| self.slope(z, step) * step <= 0.5 * here.norm();
        zeros_between(line, radius, &at, &near)
    }
}

/// How many zeros of a real function lie right of `line`, all of them within `radius`. `near` says
/// of a point, the value there and a step whether the value changes by half of it at most. None
/// where that takes too long, or where a zero is too near to the line.
pub(crate) fn zeros_between(
    line: f64,
    radius: f64,
    at: &dyn Fn(Complex64) -> Complex64,
    near: &dyn Fn(Complex64, Complex64, f64) -> bool,
) -> Option<u64> {
    let far = radius.max(line + 1.0);
    let corners = [
        Complex64::new(far, 0.0),
        Complex64::new(far, radius),
        Complex64::new(line, radius),
        Complex64::new(line, 0.0),
    ];
    let (mut turned, mut steps) = (0.0, 0);
    for side in corners.windows(2) {
        let (mut z, length) = (side[0], (side[1] - side[0]).norm());
        let direction = (side[1] - side[0]) / length;
        let (mut gone, mut here) = (0.0, at(z));
        let mut step = 0.1 * length;
        while gone < length {
            // The argument turns by 30° at most.
            step *= 2.0;
            while !near(z, here, step) {
                step *= 0.5;
            }
            steps += 1;
            if steps > MOST_STEPS || step < 1e-9 {
                return None;
            }
            gone = (gone + step).min(length);
            z = side[0] + direction * gone;
            let there = at(z);
            turned += (there / here).arg();
            here = there;
        }
    }
    let halves = turned / PI;
    assert!((halves - halves.round()).abs() < 1e-6, "{line} {halves}");
    Some(halves.round() as u64)
}
