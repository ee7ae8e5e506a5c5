//! Real functions on the line λ = −σ + iω that are polynomials in ω, sin tω and cos tω, and all
//! their zeros in an interval.
//!
//! ```text
//! f(ω) = p(ω) + c(ω) cos tω + s(ω) sin tω                                                  (1)
//! f′(ω) = p′ + (c′ + t s) cos tω + (s′ − t c) sin tω                                       (2)
//! ```
//!
//! With m and r the middle and half the width of an interval and K ≥ |f″| on it, there is
//!
//! ```text
//! no zero             where |f(m)| > |f′(m)| r + K r²/2,                                   (3)
//! at most one zero    where |f′(m)| > K r.                                                 (4)
//! ```
//!
//! Intervals of which neither holds are halved. No zero is stepped over, however close its
//! neighbours are: a double zero that cannot be told from two is listed once.

use crate::model::elementary::sincos;

/// Coefficients of a polynomial, from the constant on: no equation here has more of them.
const LENGTH: usize = 5;

/// Intervals that are looked at before a search is given up: some thousand zeros.
const MOST_INTERVALS: usize = 1 << 17;

/// Steps of Newton's method among values that are 0 within their bound on rounding.
const STEPS_WITHIN_ROUNDING: u32 = 3;

/// A polynomial in ω.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Polynomial(pub [f64; LENGTH]);

impl Polynomial {
    /// The polynomial with these first coefficients.
    pub(super) fn of<const N: usize>(coefficients: [f64; N]) -> Self {
        let mut all = [0.0; LENGTH];
        all[..N].copy_from_slice(&coefficients);
        Self(all)
    }

    #[inline]
    fn at(&self, omega: f64) -> f64 {
        self.0.iter().rev().fold(0.0, |sum, c| sum * omega + c)
    }

    /// A bound on its size up to `omega` ≥ 0.
    #[inline]
    fn bound(&self, omega: f64) -> f64 {
        self.0
            .iter()
            .rev()
            .fold(0.0, |sum, c| sum * omega + c.abs())
    }

    fn derivative(&self) -> Self {
        let mut of = [0.0; LENGTH];
        for (i, c) in self.0.iter().enumerate().skip(1) {
            of[i - 1] = i as f64 * c;
        }
        Self(of)
    }

    pub(super) fn plus(self, other: Self, times: f64) -> Self {
        let mut sum = self.0;
        for (s, o) in sum.iter_mut().zip(other.0) {
            *s += times * o;
        }
        Self(sum)
    }

    /// The product; its degree must fit.
    pub(super) fn times(self, other: Self) -> Self {
        let mut product = [0.0; LENGTH];
        for (i, a) in self.0.into_iter().enumerate() {
            for (j, b) in other.0.into_iter().enumerate() {
                debug_assert!(i + j < LENGTH || a * b == 0.0);
                if i + j < LENGTH {
                    product[i + j] += a * b;
                }
            }
        }
        Self(product)
    }
}

/// A function (1).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct TrigPolynomial {
    /// p.
    pub free: Polynomial,
    /// c.
    pub cosine: Polynomial,
    /// s.
    pub sine: Polynomial,
    /// t > 0.
    pub t: f64,
}

/// A value and a bound on its rounding error.
type Bounded = (f64, f64);

impl TrigPolynomial {
    /// (2).
    fn derivative(&self) -> Self {
        let Self {
            free,
            cosine,
            sine,
            t,
        } = *self;
        Self {
            free: free.derivative(),
            cosine: cosine.derivative().plus(sine, t),
            sine: sine.derivative().plus(cosine, -t),
            t,
        }
    }

    /// The value at `omega`, with sin tω and cos tω given.
    #[inline]
    fn at(&self, omega: f64, (sin, cos): (f64, f64)) -> Bounded {
        let value = self.free.at(omega) + self.cosine.at(omega) * cos + self.sine.at(omega) * sin;
        let waves = self.cosine.bound(omega) + self.sine.bound(omega);
        // The angle tω is rounded as well.
        let error = 16.0 * (self.free.bound(omega) + waves) + self.t * omega * waves;
        (value, f64::EPSILON * error)
    }

    /// A bound on its size up to `omega` ≥ 0.
    #[inline]
    fn bound(&self, omega: f64) -> f64 {
        self.free.bound(omega) + self.cosine.bound(omega) + self.sine.bound(omega)
    }
}

/// A search would take too long: there are too many zeros.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct TooMany;

/// The room that searches share.
#[derive(Debug, Default)]
pub(super) struct Intervals(Vec<(f64, f64)>);

/// A function with two derivatives.
struct Jet {
    f: TrigPolynomial,
    first: TrigPolynomial,
    second: TrigPolynomial,
}

impl Jet {
    #[inline]
    fn at(&self, omega: f64) -> [Bounded; 2] {
        let waves = sincos(self.f.t * omega);
        [self.f.at(omega, waves), self.first.at(omega, waves)]
    }

    /// The sign of f, or none where it is lost in rounding.
    fn sign(&self, omega: f64) -> Option<bool> {
        let (value, error) = self.f.at(omega, sincos(self.f.t * omega));
        (value.abs() > error).then_some(value > 0.0)
    }

    /// The zero between `a` and `b`, at which the signs of f differ; f is monotone between.
    fn polish(&self, (mut a, mut b): (f64, f64), rising: bool) -> f64 {
        let (mut omega, mut within_rounding) = (0.5 * (a + b), 0);
        for _ in 0..200 {
            let [(f, error), (first, _)] = self.at(omega);
            // The bound on the error is generous: some steps more come nearer to the zero.
            if f.abs() <= error {
                within_rounding += 1;
                if within_rounding > STEPS_WITHIN_ROUNDING {
                    break;
                }
            } else if (f > 0.0) == rising {
                b = omega;
            } else {
                a = omega;
            }
            let next = omega - f / first;
            let inside = a < next && next < b;
            let next = if inside { next } else { 0.5 * (a + b) };
            if (next - omega).abs() <= f64::EPSILON * omega {
                return next;
            }
            omega = next;
        }
        omega
    }
}

impl Jet {
    /// The zero next to `omega`, where f is 0 within rounding, at most `r` away.
    fn beside(&self, omega: f64, r: f64) -> f64 {
        let mut at = omega;
        for _ in 0..STEPS_WITHIN_ROUNDING {
            let [(f, _), (first, _)] = self.at(at);
            let next = at - f / first;
            if next.is_nan() || (next - omega).abs() > r {
                break;
            }
            at = next;
        }
        at
    }
}

impl Intervals {
    /// Tells `found` all zeros of `f` with `from` ≤ ω ≤ `to`, in no order; one at a place where
    /// two intervals meet may come twice.
    ///
    /// # Errors
    /// When there are too many.
    pub(super) fn zeros(
        &mut self,
        f: TrigPolynomial,
        (from, to): (f64, f64),
        mut found: impl FnMut(f64),
    ) -> Result<(), TooMany> {
        let first = f.derivative();
        let second = first.derivative();
        let jet = Jet { f, first, second };
        self.0.clear();
        self.0.push((from, to));
        let mut looked_at = 0;
        while let Some((a, b)) = self.0.pop() {
            looked_at += 1;
            if looked_at > MOST_INTERVALS {
                return Err(TooMany);
            }
            let (m, r) = (0.5 * (a + b), 0.5 * (b - a));
            let [(value, error), (slope, slope_error)] = jet.at(m);
            let bend = jet.second.bound(b) * r;
            if value.abs() - error > (slope.abs() + slope_error + 0.5 * bend) * r {
                continue;
            }
            if slope.abs() - slope_error > bend {
                match (jet.sign(a), jet.sign(b)) {
                    (Some(low), Some(high)) if low == high => {}
                    (Some(_), Some(high)) => found(jet.polish((a, b), high)),
                    (None, _) => found(jet.beside(a, r)),
                    (_, None) => found(jet.beside(b, r)),
                }
                continue;
            }
            if r <= 4.0 * f64::EPSILON * b.max(f64::MIN_POSITIVE) {
                found(m);
                continue;
            }
            self.0.push((m, b));
            self.0.push((a, m));
        }
        Ok(())
    }
}
