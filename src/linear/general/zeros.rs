//! All zeros of a real polynomial, each within a disc that is known to hold it.
//!
//! Approximate zeros ξ_i come from Aberth's iteration (1973), started on the circles of the Newton
//! polygon (Bini 1996), so that coefficients may differ by many decades. Smith (1970): the discs
//!
//! ```text
//! |z − ξ_i| ≤ n |F(ξ_i)| / (|c_n| Π_{j≠i} |ξ_i − ξ_j|)                                      (1)
//! ```
//!
//! hold all zeros, and each connected set of them as many as it has discs. Here |F(ξ_i)| includes
//! the rounding of its evaluation and what the errors of the coefficients come to.

use std::f64::consts::TAU;

use num_complex::Complex64;

use super::polynomial::{MOST_DEGREE, Polynomial};
use crate::linear::newton::divide;
use crate::model::elementary::{norm, rough_exp2, rough_log2, sincos};

/// Sweeps of Aberth's iteration; it takes ten or so.
const MOST_SWEEPS: usize = 100;
/// The angle by which starts are turned, so that no symmetry holds them.
const TURNED: f64 = 0.7;
/// An imaginary part below this of the size is taken for 0.
const NEARLY_REAL: f64 = 1e-14;

/// A disc of the complex plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Disc {
    /// The centre, an approximate zero.
    pub centre: Complex64,
    /// The radius; infinite where nothing is known.
    pub radius: f64,
}

/// The zeros of a real polynomial of known degree: as many discs as its degree, their centres
/// symmetric about the real axis.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Zeros {
    discs: [Disc; MOST_DEGREE],
    /// The number of the connected set to which each disc belongs.
    sets: [u8; MOST_DEGREE],
    count: usize,
}

const NOWHERE: Disc = Disc {
    centre: Complex64::ZERO,
    radius: f64::INFINITY,
};

impl Zeros {
    /// The zeros of `of`, whose highest coefficient is certain to differ from 0.
    #[must_use]
    pub(crate) fn of(of: &Polynomial) -> Self {
        let mut at = [Complex64::ZERO; MOST_DEGREE];
        let at = &mut at[..of.degree()];
        Self::approximate(of, at);
        Self::enclosed(at, |at, i| radius(of, at, i))
    }

    /// Discs about the zeros nearly at `at`, made symmetric; `radius` is that of a disc by its
    /// number, by (1).
    pub(super) fn enclosed(
        at: &mut [Complex64],
        radius: impl Fn(&[Complex64], usize) -> f64,
    ) -> Self {
        make_symmetric(at);
        let mut zeros = Self {
            discs: [NOWHERE; MOST_DEGREE],
            sets: [0; MOST_DEGREE],
            count: at.len(),
        };
        for (i, disc) in zeros.discs[..at.len()].iter_mut().enumerate() {
            *disc = Disc {
                centre: at[i],
                radius: radius(at, i),
            };
        }
        zeros.connect();
        zeros
    }

    /// These zeros times a power of two.
    pub(super) fn scaled(mut self, by: f64) -> Self {
        for disc in &mut self.discs[..self.count] {
            disc.centre *= by;
            disc.radius *= by;
        }
        self
    }

    /// Approximate zeros of `of` by Aberth's iteration from the circles of the Newton polygon.
    pub(super) fn approximate(of: &Polynomial, at: &mut [Complex64]) {
        start(of, at);
        iterate(of, at);
    }

    /// The discs.
    #[inline]
    #[must_use]
    pub(crate) fn discs(&self) -> &[Disc] {
        &self.discs[..self.count]
    }

    /// The connected sets, as lists of discs with a mark for those that belong to the set.
    pub(crate) fn sets(&self) -> impl Iterator<Item = Set<'_>> {
        (0..self.count)
            .filter(|&i| usize::from(self.sets[i]) == i)
            .map(|i| Set {
                zeros: self,
                number: i as u8,
            })
    }

    /// Finds which discs touch, directly or through others.
    fn connect(&mut self) {
        for i in 0..self.count {
            self.sets[i] = i as u8;
        }
        for i in 1..self.count {
            for j in 0..i {
                let (a, b) = (self.discs[i], self.discs[j]);
                let apart = norm(a.centre - b.centre) * (1.0 - 4.0 * f64::EPSILON);
                if apart > a.radius + b.radius {
                    continue;
                }
                let (from, to) = (self.sets[i], self.sets[j]);
                let (low, high) = (from.min(to), from.max(to));
                for set in &mut self.sets[..self.count] {
                    if *set == high {
                        *set = low;
                    }
                }
            }
        }
    }
}

/// A connected set of discs: it holds as many zeros as it has discs.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Set<'z> {
    zeros: &'z Zeros,
    number: u8,
}

impl Set<'_> {
    /// The discs of the set.
    pub(crate) fn discs(&self) -> impl Iterator<Item = Disc> + '_ {
        let number = self.number;
        self.zeros
            .discs()
            .iter()
            .zip(&self.zeros.sets)
            .filter(move |(_, set)| **set == number)
            .map(|(disc, _)| *disc)
    }

    /// How many zeros the set holds.
    #[must_use]
    pub(crate) fn count(&self) -> usize {
        self.discs().count()
    }

    /// The part of the real axis that the set covers, the stretch between two of its discs
    /// included; none where it covers none.
    #[must_use]
    pub(crate) fn on_real_axis(&self) -> Option<(f64, f64)> {
        let mut covered: Option<(f64, f64)> = None;
        for disc in self.discs() {
            let high = disc.centre.im.abs();
            if high > disc.radius {
                continue;
            }
            let half = ((disc.radius - high) * (disc.radius + high))
                .max(0.0)
                .sqrt();
            let (from, to) = (disc.centre.re - half, disc.centre.re + half);
            covered = Some(match covered {
                Some((low, top)) => (low.min(from), top.max(to)),
                None => (from, to),
            });
        }
        covered
    }

    /// The interval of real parts that the set covers.
    #[must_use]
    pub(crate) fn real_parts(&self) -> (f64, f64) {
        let ends = |disc: Disc| (disc.centre.re - disc.radius, disc.centre.re + disc.radius);
        self.discs().map(ends).fold(
            (f64::INFINITY, f64::NEG_INFINITY),
            |(low, high), (from, to)| (low.min(from), high.max(to)),
        )
    }

    /// The middle of the centres of the discs.
    #[must_use]
    pub(crate) fn middle(&self) -> Complex64 {
        let sum: Complex64 = self.discs().map(|d| d.centre).sum();
        sum / self.count() as f64
    }
}

/// F, its derivative and Σ |c_k||z|^k at z, all over z^n where |z| > 1, then with the derivative
/// times z: neither overflows.
struct Evaluated {
    value: Complex64,
    slope: Complex64,
    size: f64,
    error: f64,
    outside: bool,
}

#[inline]
fn evaluate(of: &Polynomial, z: Complex64) -> Evaluated {
    let (c, e) = (of.coefficients(), of.errors());
    let mut sum = (Complex64::ZERO, Complex64::ZERO, 0.0, 0.0);
    let outside = z.norm_sqr() > 1.0;
    let step = |(value, slope, size, error): (Complex64, Complex64, f64, f64),
                (c, e): (f64, f64),
                w: Complex64,
                r: f64| {
        (
            value * w + c,
            slope * w + value,
            size * r + c.abs(),
            error * r + e,
        )
    };
    if outside {
        let w = divide(Complex64::new(1.0, 0.0), z);
        let r = norm(w);
        for (&c, &e) in c.iter().zip(e) {
            sum = step(sum, (c, e), w, r);
        }
        // F = zⁿ G(1/z): z F′/zⁿ = n G − w G′.
        let slope = sum.0 * of.degree() as f64 - w * sum.1;
        sum.1 = slope;
    } else {
        let r = norm(z);
        for (&c, &e) in c.iter().zip(e).rev() {
            sum = step(sum, (c, e), z, r);
        }
    }
    Evaluated {
        value: sum.0,
        slope: sum.1,
        size: sum.2,
        error: sum.3,
        outside,
    }
}

/// The rounding error of F in units of Σ |c_k||z|^k.
fn rounding(of: &Polynomial) -> f64 {
    (4.0 * of.degree() as f64 + 4.0) * f64::EPSILON
}

/// The radius of the disc number `i` by (1).
fn radius(of: &Polynomial, at: &[Complex64], i: usize) -> f64 {
    let z = at[i];
    let f = evaluate(of, z);
    let leading = of.leading();
    let above = norm(f.value) + rounding(of) * f.size + f.error;
    let mut radius = at.len() as f64 * above / (leading.value.abs() - leading.error);
    let unit = if f.outside { norm(z) } else { 1.0 };
    for (j, other) in at.iter().enumerate() {
        if j != i {
            radius *= unit / norm(z - other);
        }
    }
    // What rounding does to the bound itself.
    let radius = radius * unit * (1.0 + 64.0 * f64::EPSILON) + f64::EPSILON * norm(z);
    if radius.is_nan() {
        f64::INFINITY
    } else {
        radius
    }
}

/// Aberth's iteration.
fn iterate(of: &Polynomial, at: &mut [Complex64]) {
    let limit = 0.25 * rounding(of);
    let mut settled = [false; MOST_DEGREE];
    for _ in 0..MOST_SWEEPS {
        let mut moving = false;
        for i in 0..at.len() {
            if settled[i] {
                continue;
            }
            let z = at[i];
            let f = evaluate(of, z);
            if norm(f.value) <= limit * f.size {
                settled[i] = true;
                continue;
            }
            let newton = if f.outside {
                z * divide(f.value, f.slope)
            } else {
                divide(f.value, f.slope)
            };
            let pull: Complex64 = at
                .iter()
                .enumerate()
                .filter(|(j, other)| *j != i && **other != z)
                .map(|(_, other)| divide(Complex64::new(1.0, 0.0), z - other))
                .sum();
            let step = divide(newton, 1.0 - newton * pull);
            if !(step.re.is_finite() && step.im.is_finite()) {
                // A zero of the derivative: a little aside it is not.
                at[i] = z * Complex64::new(1.0, 1e-3) + 1e-300;
                moving = true;
                continue;
            }
            at[i] = z - step;
            settled[i] = norm(step) <= f64::EPSILON * norm(z);
            moving = true;
        }
        if !moving {
            return;
        }
    }
}

/// Points on the circles of the Newton polygon, the upper hull of log₂|c_k| over k.
fn start(of: &Polynomial, at: &mut [Complex64]) {
    let c = of.coefficients();
    let n = c.len() - 1;
    let height = |k: usize| {
        if c[k] == 0.0 {
            f64::NEG_INFINITY
        } else {
            rough_log2(c[k].abs())
        }
    };
    let mut from = 0;
    // Zeros at 0 itself.
    while from < n && c[from] == 0.0 {
        at[from] = Complex64::ZERO;
        from += 1;
    }
    while from < n {
        let mut to = n;
        let mut steepest = f64::NEG_INFINITY;
        for k in from + 1..=n {
            let slope = (height(k) - height(from)) / (k - from) as f64;
            if slope >= steepest {
                (to, steepest) = (k, slope);
            }
        }
        let size = rough_exp2(-steepest);
        for (k, z) in at[from..to].iter_mut().enumerate() {
            let turn = k as f64 / (to - from) as f64 + from as f64 / n as f64;
            let (sin, cos) = sincos(TAU * turn + TURNED);
            *z = size * Complex64::new(cos, sin);
        }
        from = to;
    }
}

/// Makes the centres real or pairs of conjugates: the polynomial is real.
fn make_symmetric(at: &mut [Complex64]) {
    for z in at.iter_mut() {
        if z.im.abs() <= NEARLY_REAL * z.re.abs() {
            z.im = 0.0;
        }
    }
    // Those at the steepest angle to the axis first: what is left over lies near to it. The angle,
    // since the zeros of a cluster far away are farther from the axis than pairs near 0.
    let angle = |z: &Complex64| match z.im.abs() {
        0.0 => 0.0,
        im => im / (z.re.abs() + im),
    };
    at.sort_by(|p, q| angle(q).total_cmp(&angle(p)));
    let mut i = 0;
    while i < at.len() && at[i].im != 0.0 {
        let mirrored = at[i].conj();
        let partner = (i + 1..at.len())
            .filter(|&j| at[j].im * at[i].im < 0.0)
            .min_by(|&j, &k| norm(at[j] - mirrored).total_cmp(&norm(at[k] - mirrored)))
            // Two real zeros have imaginary parts by rounding alone: these pair nothing.
            .filter(|&j| norm(at[j] - mirrored) <= at[i].im.abs());
        if let Some(j) = partner {
            let middle = 0.5 * (at[i] + at[j].conj());
            at.swap(i + 1, j);
            (at[i], at[i + 1]) = (middle, middle.conj());
            i += 2;
        } else {
            at[i].im = 0.0;
            i += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two of its real zeros are as near to one another as to the axis of the other: rounding gives
    /// both an imaginary part, of opposite signs.
    #[test]
    fn real_zeros_with_imaginary_parts_by_rounding_are_no_pair() {
        let polynomial = Polynomial::new(&[
            -0.001478057050868198,
            -0.19606071139401846,
            2.8769642378540405,
            -13.187972768143513,
            21.649038098550594,
            -11.551027939842418,
            -0.7657016588038741,
            1.0,
        ])
        .expect("a small degree");
        for disc in Zeros::of(&polynomial).discs() {
            assert!(disc.radius < 1e-10 && disc.centre.im == 0.0, "{disc:?}");
        }
    }
}
