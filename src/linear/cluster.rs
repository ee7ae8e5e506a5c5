//! Roots so near to one another that rounding of D does not tell them apart: from D with twice the
//! digits.
//!
//! A root of multiplicity m is taken apart by the rounding of the coefficients to a distance of
//! about ε^(1/m), and D is within rounding of 0 all over that disc. Aberth's iteration with as many
//! points as were counted finds the roots of the coefficients as they stand.
//!
//! The error that is told of such a root is estimated from D and its slope at the place found. It
//! is not proved. Counting confirms it: there are as many roots about the cluster as are listed.

use std::f64::consts::TAU;

use num_complex::Complex64;

use super::equation::{Equation, Exact};
use super::newton::{Root, divide};
use crate::model::elementary::{norm, sincos, sqrt};

/// Sweeps of Aberth's iteration.
const MOST_SWEEPS: u32 = 60;
/// The most roots of a cluster.
const MOST: usize = 16;
/// The angle by which starts are turned, so that no symmetry holds them.
const TURNED: f64 = 0.7;
/// Roots farther from the middle than this many times the radius are others.
const FARTHEST: f64 = 64.0;

/// The `number` roots about `cluster`, pairs counted as two but listed once; none where twice the
/// digits do not tell them apart either.
pub(super) fn taken_apart(
    equation: impl Equation,
    tau: f64,
    cluster: &[Root],
    number: u64,
) -> Option<Vec<Root>> {
    let sum: Complex64 = cluster.iter().map(|root| root.lambda).sum();
    let mut middle = sum / cluster.len() as f64;
    let reach = |root: &Root| root.error + norm(root.lambda - middle);
    let radius = cluster.iter().map(reach).fold(0.0, f64::max);
    // About the axis there are the conjugates, too.
    let paired = middle.im > 2.0 * radius;
    let count = if paired { number / 2 } else { number } as usize;
    if count == 0 || count > MOST {
        return None;
    }
    if !paired {
        middle.im = 0.0;
    }
    let mut at = [Complex64::ZERO; MOST];
    let at = &mut at[..count];
    for (i, z) in at.iter_mut().enumerate() {
        let (sin, cos) = sincos(TAU * i as f64 / count as f64 + TURNED);
        *z = middle + radius * Complex64::new(cos, sin);
    }
    iterate(equation, tau, at)?;
    let roots = listed(equation, tau, at)?;
    let near = |root: &Root| norm(root.lambda - middle) <= FARTHEST * radius;
    let found: u64 = roots.iter().map(Root::count).sum();
    (found == number && roots.iter().all(near)).then_some(roots)
}

/// Aberth's iteration; none where D cannot be evaluated with more digits.
fn iterate(equation: impl Equation, tau: f64, at: &mut [Complex64]) -> Option<()> {
    let mut settled = [false; MOST];
    for _ in 0..MOST_SWEEPS {
        for i in 0..at.len() {
            if settled[i] {
                continue;
            }
            let z = at[i];
            let Exact { value, slope, .. } = equation.exact(tau, z)?;
            let newton = divide(value, slope);
            let others = at.iter().enumerate().filter(|(j, _)| *j != i);
            let pull: Complex64 = others
                .map(|(_, other)| divide(Complex64::ONE, z - other))
                .sum();
            let step = divide(newton, 1.0 - newton * pull);
            if !(step.re.is_finite() && step.im.is_finite()) {
                return None;
            }
            at[i] = z - step;
            settled[i] = norm(step) <= f64::EPSILON * norm(z);
        }
        if settled[..at.len()].iter().all(|settled| *settled) {
            break;
        }
    }
    Some(())
}

/// The roots at `at` with their errors, which are not proved, pairs once; none where two of them
/// may be one.
fn listed(equation: impl Equation, tau: f64, at: &[Complex64]) -> Option<Vec<Root>> {
    let mut all = Vec::with_capacity(at.len());
    for &z in at {
        let Exact {
            value,
            slope,
            rounding,
        } = equation.exact(tau, z)?;
        let off = at.len() as f64 * (norm(value) + rounding) / norm(slope);
        all.push((z, off + f64::EPSILON * norm(z)));
    }
    for (i, (z, error)) in all.iter().enumerate() {
        let apart = |(other, off): &(Complex64, f64)| norm(z - other) > 2.0 * (error + off);
        if !all[..i].iter().all(apart) {
            return None;
        }
    }
    let real = |(z, error): &(Complex64, f64)| z.im.abs() <= 4.0 * error;
    let upper = all.iter().filter(|place| place.0.im > 0.0 || real(place));
    let root = |place: &(Complex64, f64)| Root {
        lambda: match real(place) {
            true => Complex64::from(place.0.re),
            false => place.0,
        },
        error: place.1,
    };
    Some(upper.map(root).collect())
}

/// Estimates of the roots next to the root `lambda`, by the cubic that touches D there.
pub(super) fn neighbours(
    equation: impl Equation,
    tau: f64,
    lambda: Complex64,
) -> impl Iterator<Item = Complex64> {
    let jet = equation.jet(tau, lambda);
    let third = equation.third(&jet, tau, lambda);
    // D′ + D″ s/2 + D‴ s²/6 = 0.
    let (half, sixth) = (0.5 * jet.second, third / 6.0);
    let root = sqrt(half * half - 4.0 * sixth * jet.first);
    [half + root, half - root]
        .into_iter()
        .map(move |d| lambda - 2.0 * divide(jet.first, d))
        .filter(|z| z.re.is_finite() && z.im.is_finite())
}
