//! A system as a loop: D = U + k V, k = 1, where the gain k of the feedback may be another one.
//!
//! ```text
//! P and Q:            U = P            V = Q e^(−λτ)                                         (11)
//! B and A:            U = B(1 − R E)   V = −A e^(−λδ)(1 − E),   E = e^(−λτ)
//! ```
//!
//! Both sides are of the form Z e^(−λt)(1 − r E).

use num_complex::Complex64;

use super::composition::Composition;
use super::latency::beyond_zeros;
use super::parts::{Decay, FeedbackForm};
use super::polynomial::Polynomial;
use super::system::{Class, System};
use super::zeros::Zeros;
use crate::model::elementary::exp;

/// One side of a loop, Z e^(−λt)(1 − r E).
#[derive(Debug, Clone, Copy)]
pub(in crate::linear) struct LoopSide {
    /// Z.
    pub polynomial: Polynomial,
    /// t.
    pub late: f64,
    /// r.
    pub memory: f64,
}

impl LoopSide {
    /// The zeros of Z, approximately; those that are not known at all are left out.
    pub(in crate::linear) fn zeros(&self) -> Vec<Complex64> {
        let zeros = Zeros::of(&self.polynomial.without_open_leading());
        zeros.discs().iter().map(|disc| disc.centre).collect()
    }

    /// This side without its zeros at λ = 0, each for certain or within rounding, and how many they
    /// are.
    fn without_origin(mut self) -> (Self, usize) {
        let mut zeros = 0;
        while !self.polynomial.is_zero() && !self.polynomial.coefficient(0).decided() {
            self.polynomial = self.polynomial.divided_by_variable();
            zeros += 1;
        }
        (self, zeros)
    }
}

/// Sides U₁ and V₁ on the imaginary axis with Im[V U*] = g(ω) Re[V₁ U₁*], or g(ω) Im[V₁ U₁*], where
/// the zeros of g are those of V, at which no gain acts, and ω = 0.
pub(in crate::linear) fn without_idle_zeros(
    sides: [LoopSide; 2],
    tau: f64,
) -> ([LoopSide; 2], bool) {
    let [own, mut fed] = sides;
    let mut quarters = 0;
    if fed.memory == 1.0 {
        // 1 − E = 2i sin(ωτ/2) e^(−iωτ/2).
        (fed.memory, fed.late) = (0.0, fed.late + 0.5 * tau);
        quarters = 1;
    }
    let (own, of_own) = own.without_origin();
    let (fed, of_fed) = fed.without_origin();
    ([own, fed], (quarters + of_own + of_fed) % 2 == 1)
}

impl System {
    /// U and V of (11) at the delay `tau`; none where a root at 0 at every delay is left out: at
    /// another gain there is none.
    pub(in crate::linear) fn loop_sides(&self, tau: f64) -> Option<[LoopSide; 2]> {
        let side = |polynomial: Polynomial, late: f64, memory: f64| LoopSide {
            polynomial,
            late,
            memory,
        };
        match &self.composition {
            Composition::BesideOrigin => None,
            Composition::Direct => Some([side(self.p, 0.0, 0.0), side(self.q, tau, 0.0)]),
            Composition::Feedback(of) | Composition::Late(of) => Some([
                side(of.open, 0.0, of.channel.memory),
                side(
                    Polynomial::ZERO.plus(&of.gain, -1.0),
                    of.channel.latency,
                    1.0,
                ),
            ]),
        }
    }

    /// This system with `factor` times the gain.
    pub(in crate::linear) fn with_gain(&self, factor: f64) -> Self {
        let scaled = |of: &Polynomial| Polynomial::ZERO.plus(of, factor);
        match self.feedback_form() {
            Some(FeedbackForm {
                open,
                gain,
                channel,
            }) => Self::feedback(*open, scaled(gain), *channel),
            None => Self::classified(self.p, scaled(&self.q), self.composition),
        }
    }

    /// The ω beyond which |U| > `factor` |V| on Re λ = `line` at the delay `tau`; infinite where
    /// there is none.
    pub(in crate::linear) fn loop_bound(&self, factor: f64, tau: f64, line: f64) -> f64 {
        let of = self.with_gain(factor);
        let highest = match of.feedback_form() {
            Some(_) => of.highest_on_line(tau, line),
            None => Decay::new(line, tau).and_then(|decay| {
                let modulus = of.on_line(line, decay).modulus();
                beyond(&modulus)
            }),
        };
        highest.map_or(f64::INFINITY, |omega| omega * (1.0 + 1e-9))
    }

    /// The ω beyond which no root with up to `factor` times the gain lies on Re λ = `line` at the
    /// delay `tau`; infinite where there is none. Of B and A without latency it is the last zero of
    /// (8) in [`shifted`](super::shifted), which falls below 0 with the gain wherever it can.
    pub(in crate::linear) fn gain_bound(&self, factor: f64, tau: f64, line: f64) -> f64 {
        if self.latency() > 0.0 || line != 0.0 {
            return self.loop_bound(factor, tau, line);
        }
        let modulus = self.with_gain(factor).on_axis().modulus();
        beyond(&modulus).map_or(f64::INFINITY, |omega| omega * (1.0 + 1e-9))
    }

    /// Without delay and latency, the ω beyond which |U + V| > `least` |U|; infinite where there is
    /// none.
    pub(in crate::linear) fn undelayed_bound(&self, least: f64) -> f64 {
        let whole = Self::direct(
            self.p.plus(&self.q, 1.0),
            Polynomial::ZERO.plus(&self.p, least),
        );
        beyond(&whole.on_axis().modulus()).unwrap_or(f64::INFINITY)
    }

    /// q_n/p_n, what V/U comes to in size beyond all frequencies on the imaginary axis; 0 where Q
    /// is of a lower degree, infinite where it is of a higher one.
    pub(in crate::linear) fn loop_at_infinity(&self) -> f64 {
        let (n, m) = (self.p.degree(), self.q.degree());
        match m.cmp(&n) {
            _ if self.feedback_form().is_some() || self.q.is_zero() => 0.0,
            std::cmp::Ordering::Less => 0.0,
            std::cmp::Ordering::Equal => self.q.leading().value / self.p.leading().value,
            std::cmp::Ordering::Greater => f64::INFINITY,
        }
    }

    /// Whether the number of unstable roots is told at the delay `tau`.
    pub(in crate::linear) fn is_counted(&self, tau: f64) -> bool {
        match self.class() {
            Class::Retarded | Class::Neutral { .. } | Class::NeutralLimit => true,
            Class::Infinite => tau == 0.0,
            Class::DegreeUnknown | Class::Refused => false,
        }
    }

    /// The factor of V at which roots accumulate on Re λ = `line` at the delay `tau` > 0; infinite
    /// where they do at none.
    pub(in crate::linear) fn accumulates_at(&self, tau: f64, line: f64) -> f64 {
        exp(line * tau) / self.loop_at_infinity().abs()
    }
}

impl System {
    /// Whether the system is of B and A: what is fed back is a difference in time.
    pub(in crate::linear) fn is_of_differences(&self) -> bool {
        self.feedback_form().is_some()
    }

    /// On the imaginary axis, the ω beyond which no factor of V puts a root on the axis at the
    /// delay `tau`; infinite where there is none, and where that is not known.
    ///
    /// Without delay these are the zeros of a polynomial. Without latency k A/B = (1 − R E)/(1 − E)
    /// lies on Re = (1 + R)/2, so that Re[A B*] has to be positive.
    pub(in crate::linear) fn highest_with_gain(&self, tau: f64) -> f64 {
        if self.latency() > 0.0 {
            return f64::INFINITY;
        }
        if let Some(FeedbackForm { open, gain, .. }) = self.feedback_form() {
            return beyond_positive(&gain.real_product(open));
        }
        if tau > 0.0 {
            return f64::INFINITY;
        }
        let turned = self.q.imaginary_product(&self.p).without_open_leading();
        beyond(&Polynomial::ZERO.plus(&turned, turned.leading().value.signum()))
            .unwrap_or(f64::INFINITY)
    }
}

/// A frequency beyond which a polynomial in x = ω² is nowhere positive; infinite where that is not
/// known.
pub(in crate::linear) fn beyond_positive(product: &Polynomial) -> f64 {
    let negative = Polynomial::ZERO.plus(product, -1.0);
    if negative.is_zero() {
        return 0.0;
    }
    match negative.leading().decided() && negative.leading().value > 0.0 {
        true => beyond_zeros(&negative),
        false => f64::INFINITY,
    }
}

/// A frequency beyond which a polynomial in x = ω² is positive.
fn beyond(modulus: &Polynomial) -> Option<f64> {
    let known = modulus.without_open_leading();
    (known.is_zero() || known.leading().value > 0.0).then(|| match known.degree() {
        0 => 0.0,
        _ => beyond_zeros(&known),
    })
}
