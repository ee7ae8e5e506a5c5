//! Roots at 0 at every delay that do not belong to a system: D/λ^m in the place of D.
//!
//! Powers of λ that P and Q share are divided out. Where P(0) + Q(0) = 0 besides, D(0) = 0 at every
//! delay, and D/λ is no quasi-polynomial: with P = p₀ + λ P₁ and Q = −p₀ + λ Q₁
//!
//! ```text
//! D/λ = P₁ + Q₁ e^(−λτ) + p₀ τ φ(λτ),   φ(z) = (1 − e^(−z))/z                                (9)
//! ```
//!
//! Crossings are those of D; counts and roots are those of (9).

use num_complex::Complex64;

use super::composition::Composition;
use super::parts::FeedbackForm;
use super::polynomial::Polynomial;
use super::system::System;
use crate::linear::characteristic::{Jet, one_minus_exp};
use crate::linear::rounded::Rounded;
use crate::model::elementary::norm;

/// Below this size of z, φ is summed as a series.
const SMALL: f64 = 1.0;
/// Terms of that series: what is left out is below 1/23!.
const TERMS: i32 = 22;

/// Why roots at 0 cannot be left out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum OriginError {
    /// There are only so many at every delay.
    Fewer(usize),
    /// The last of them comes from a feedback with latency, where this is not known.
    Late,
}

/// What decides on which side of 0 a real root of (9) lies.
#[derive(Debug, Clone, Copy)]
pub(super) struct AtOrigin {
    /// P′(0) + Q′(0).
    slope: Rounded,
    /// Q(0).
    fed: Rounded,
    /// The sign at 0 of the larger of P and Q right of 0.
    sign: f64,
}

impl AtOrigin {
    /// What the root at 0 adds to (7) on the imaginary axis at the delay `tau`: there arg D begins
    /// with a right angle, to one side or the other. None where a second root is at 0.
    pub(super) fn counted(self, tau: f64) -> Option<i64> {
        let slope = self.slope.minus(self.fed.scaled(tau));
        slope
            .decided()
            .then_some(i64::from(slope.value * self.sign < 0.0))
    }
}

/// φ and its first three derivatives.
fn phi(z: Complex64) -> [Complex64; 4] {
    if norm(z) >= SMALL {
        let lost = one_minus_exp(-z);
        let late = 1.0 - lost;
        let value = lost / z;
        let first = (late - value) / z;
        let second = (-late - 2.0 * first) / z;
        return [value, first, second, (late - 3.0 * second) / z];
    }
    let (mut at, mut factor) = ([Complex64::ZERO; 4], 1.0);
    let mut coefficients = [0.0; TERMS as usize];
    for (k, c) in coefficients.iter_mut().enumerate() {
        factor /= (k + 1) as f64;
        *c = if k % 2 == 0 { factor } else { -factor };
    }
    for c in coefficients.into_iter().rev() {
        at[3] = at[3] * z + 3.0 * at[2];
        at[2] = at[2] * z + 2.0 * at[1];
        at[1] = at[1] * z + at[0];
        at[0] = at[0] * z + c;
    }
    at
}

impl System {
    /// This system without `wanted` of the roots at 0 that it has at every delay, each for certain
    /// or within rounding.
    ///
    /// ```
    /// use slipmap::linear::general::{DelayLine, System};
    ///
    /// // s + 2(1 − e^(−sτ))/s, times s.
    /// let times_s = System::of_coefficients(&[2.0, 0.0, 1.0], &[-2.0])?;
    /// let line = DelayLine::of(&times_s.without_roots_at_zero(1).expect("it has one"));
    /// // It is stable up to τ = π/2, where ±2i are roots.
    /// let first = line.stable_intervals().next().expect("stable at short delays");
    /// assert!((first.to - 0.5 * std::f64::consts::PI).abs() < 1e-12);
    /// # Ok::<(), slipmap::model::ModelError>(())
    /// ```
    ///
    /// # Errors
    /// Where there are fewer, with their number.
    pub fn without_roots_at_zero(&self, wanted: usize) -> Result<Self, OriginError> {
        let (mut rest, mut found) = (*self, 0);
        while found < wanted
            && let Some(divided) = rest.without_shared_zero()
        {
            (rest, found) = (divided, found + 1);
        }
        if found == wanted || self.is_zero() {
            return Ok(rest);
        }
        let [p, q] = [&rest.p, &rest.q].map(|of| of.coefficient(0));
        let sum = Rounded::sum([p.value, q.value]).plus_error(p.error + q.error);
        if sum.decided() || !q.decided() {
            return Err(OriginError::Fewer(found));
        }
        if found + 1 < wanted {
            return Err(OriginError::Fewer(found + 1));
        }
        if rest.latency() > 0.0 {
            return Err(OriginError::Late);
        }
        Ok(Self::classified(rest.p, rest.q, Composition::BesideOrigin))
    }

    /// P and Q divided by λ, where both vanish at 0 for certain or within rounding.
    fn without_shared_zero(&self) -> Option<Self> {
        let vanish = |of: &Polynomial| !of.coefficient(0).decided();
        let divided = |of: &Polynomial| of.divided_by_variable();
        if self.is_zero() {
            return None;
        }
        match self.feedback_form() {
            Some(FeedbackForm {
                open,
                gain,
                channel,
            }) if vanish(open) && vanish(gain) => {
                Some(Self::feedback(divided(open), divided(gain), *channel))
            }
            None if vanish(&self.p) && vanish(&self.q) => {
                Some(Self::direct(divided(&self.p), divided(&self.q)))
            }
            _ => None,
        }
    }

    /// Whether one root at 0 at every delay is left out, by (9).
    #[inline]
    pub(super) fn leaves_origin_out(&self) -> bool {
        matches!(self.composition, Composition::BesideOrigin)
    }

    /// What (7) needs at 0 on the imaginary axis; `positive` tells whether |P| > |Q| right of 0.
    pub(super) fn at_origin(&self, positive: bool) -> AtOrigin {
        let [p, q] = [&self.p, &self.q];
        let slope = [p.coefficient(1), q.coefficient(1)];
        let of_larger = if positive { p } else { q };
        AtOrigin {
            slope: Rounded::sum(slope.map(|of| of.value))
                .plus_error(slope[0].error + slope[1].error),
            fed: q.coefficient(0),
            sign: of_larger.coefficient(0).value,
        }
    }

    /// (9) with its first two derivatives.
    pub(super) fn jet_beside_origin(&self, tau: f64, lambda: Complex64) -> Jet {
        let difference = one_minus_exp(-tau * lambda);
        let delayed = 1.0 - difference;
        let [p, q] = [&self.p, &self.q].map(|of| of.divided_by_variable().jet(lambda));
        let by = -tau * self.q.coefficient(0).value;
        let [value, first, second, _] = phi(tau * lambda);
        let memory = tau * q[0] * delayed;
        Jet {
            value: p[0] + q[0] * delayed + by * value,
            first: p[1] + q[1] * delayed - memory + by * tau * first,
            second: p[2]
                + (q[2] - 2.0 * tau * q[1]) * delayed
                + tau * memory
                + by * tau * tau * second,
            delayed,
            difference,
            feedback: q[0],
        }
    }

    /// A bound on the rounding error of (9), to within a small factor.
    pub(super) fn rounding_beside_origin(&self, jet: &Jet, tau: f64, lambda: Complex64) -> f64 {
        let size = lambda.l1_norm();
        let unit = (self.p.degree().max(self.q.degree()) as f64 + 4.0) * f64::EPSILON;
        let part = |of: &Polynomial, by: f64| {
            let (value, error) = of.divided_by_variable().bounds(size);
            by * (unit * value + error)
        };
        let delayed = jet.delayed.l1_norm();
        let fed = self.q.coefficient(0);
        let phi = norm(phi(tau * lambda)[0]);
        let of_phi = f64::EPSILON * (8.0 * phi + 4.0 * delayed);
        part(&self.p, 1.0)
            + part(&self.q, delayed * (1.0 + size * tau))
            + tau * (fed.value.abs() * of_phi + fed.error * phi)
    }

    /// A rough third derivative of (9).
    pub(super) fn third_beside_origin(&self, jet: &Jet, tau: f64, lambda: Complex64) -> Complex64 {
        let [p, q] = [&self.p, &self.q].map(Polynomial::divided_by_variable);
        let [value, slope, bend] = q.jet(lambda);
        let by = -tau * tau * tau * tau * self.q.coefficient(0).value;
        let turned = tau * (3.0 * slope - tau * value) - 3.0 * bend;
        p.derivative().jet(lambda)[2] + tau * jet.delayed * turned + by * phi(tau * lambda)[3]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The series and the closed form meet; its derivatives are those of difference quotients.
    #[test]
    fn phi_is_one_function_on_both_sides_of_its_circle() {
        for angle in 0..12 {
            let direction = Complex64::from_polar(1.0, 0.5 * f64::from(angle));
            let [inside, outside] = [SMALL * 0.999_999, SMALL * 1.000_001].map(|r| r * direction);
            let (near, far) = (phi(inside), phi(outside));
            for k in 0..3 {
                let quotient = (far[k] - near[k]) / (outside - inside);
                let slope = 0.5 * (near[k + 1] + far[k + 1]);
                assert!((quotient - slope).norm() < 1e-8, "{k} {quotient} {slope}");
            }
        }
        let value = |z: f64| (1.0 - (-z).exp()) / z;
        assert!((phi(0.5.into())[0].re - value(0.5)).abs() < 1e-15);
        assert!((phi(3.0.into())[0].re - value(3.0)).abs() < 1e-15);
    }

    #[test]
    fn roots_at_zero_are_those_that_there_are() {
        let of = |p: &[f64], q: &[f64]| System::of_coefficients(p, q).unwrap();
        let left_out = |system: &System, m: usize| system.without_roots_at_zero(m).map(|_| ());
        let one = of(&[2.0, 0.0, 1.0], &[-2.0]);
        assert_eq!(left_out(&one, 1), Ok(()));
        assert_eq!(left_out(&one, 2), Err(OriginError::Fewer(1)));
        let three = of(&[0.0, 0.0, 2.0, 0.0, 1.0], &[0.0, 0.0, -2.0]);
        assert_eq!(left_out(&three, 3), Ok(()));
        assert_eq!(left_out(&three, 4), Err(OriginError::Fewer(3)));
        let none = of(&[2.0, 0.0, 1.0], &[-1.0]);
        assert_eq!(left_out(&none, 0), Ok(()));
        assert_eq!(left_out(&none, 1), Err(OriginError::Fewer(0)));
        let undelayed = of(&[0.0, 0.0, 1.0], &[]);
        assert_eq!(left_out(&undelayed, 2), Ok(()));
        assert_eq!(left_out(&undelayed, 3), Err(OriginError::Fewer(2)));
    }
}
