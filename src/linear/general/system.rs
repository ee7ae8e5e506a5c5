//! A system at one setting of its parameters, and to which class it belongs.

use num_complex::Complex64;

use super::composition::Composition;
use super::parts::{Decay, FeedbackForm, late};
use super::polynomial::Polynomial;
use super::precise::source::Source;
use super::reason::Reason;
use super::shifted::Shifted;
use super::zeros::{Disc, Zeros};
use crate::linear::characteristic::{Jet, one_minus_exp};
use crate::linear::rounded::Rounded;
use crate::model::elementary::{exp, ln, pow};
use crate::model::{Channel, ModelError};

/// D(λ) = P(λ) + Q(λ) e^(−λτ) with every parameter but the delay given.
///
/// ```
/// use slipmap::linear::general::{DelayLine, System};
///
/// // s² + 0.1 s + 1 + 0.5 e^(−sτ): an oscillator with delayed restoring force.
/// let system = System::of_coefficients(&[1.0, 0.1, 1.0], &[0.5])?;
/// let line = DelayLine::of(&system);
/// let first = line.stable_intervals().next().expect("it is stable without delay");
/// assert_eq!(first.from, 0.0);
/// // Where it ends, s = iω is a root: |P(iω)| = 0.5.
/// let omega = line.crossings[0].omega;
/// assert!((f64::hypot(1.0 - omega * omega, 0.1 * omega) - 0.5).abs() < 1e-12);
/// # Ok::<(), slipmap::model::ModelError>(())
/// ```
#[derive(Debug, Clone, Copy)]
pub struct System {
    /// P.
    pub(super) p: Polynomial,
    /// Q.
    pub(super) q: Polynomial,
    pub(super) composition: Composition,
    pub(super) source: Option<Source>,
    class: Class,
}

/// The kind of equation that D = 0 is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Class {
    /// deg Q < deg P: finitely many roots right of any line.
    Retarded,
    /// deg Q = deg P with ρ = |q_n/p_n| < 1: roots accumulate at Re λ = ln ρ/τ.
    Neutral {
        /// ρ.
        ratio: f64,
    },
    /// ρ = 1 within rounding, with finitely many unstable roots: they accumulate at the axis.
    NeutralLimit,
    /// ρ > 1, or deg Q > deg P: infinitely many unstable roots at every τ > 0.
    Infinite,
    /// The highest coefficient is within its error of 0.
    DegreeUnknown,
    /// |P| = |Q| on all of the imaginary axis.
    Refused,
}

impl Class {
    /// What a cell of this class has to say about itself.
    #[must_use]
    pub fn reason(self) -> Option<Reason> {
        match self {
            Self::Retarded | Self::Neutral { .. } => None,
            Self::NeutralLimit => Some(Reason::NeutralLimit),
            Self::Infinite => Some(Reason::Infinite),
            Self::DegreeUnknown => Some(Reason::DegreeUnknown),
            Self::Refused => Some(Reason::Refused),
        }
    }
}

impl System {
    /// Whether P and Q are 0 everywhere: then every λ is a root.
    #[must_use]
    pub fn is_zero(&self) -> bool {
        self.p.is_zero() && self.q.is_zero()
    }

    /// The system of these P and Q.
    #[must_use]
    pub fn direct(p: Polynomial, q: Polynomial) -> Self {
        Self::classified(p, q, Composition::Direct)
    }

    /// The system of the open loop B, the feedback A with deg A < deg B, the memory R and the
    /// latency δ: D = B(1 − R E) − A e^(−λδ)(1 − E). Where A is 0 everywhere memory and
    /// latency are ignored: there is nothing to remember and nothing that could be late.
    #[inline]
    #[must_use]
    pub fn feedback(open: Polynomial, gain: Polynomial, channel: Channel) -> Self {
        if gain.is_zero() {
            return Self::classified(open, Polynomial::ZERO, Composition::Direct);
        }
        let p = open.plus(&gain, -1.0);
        let q = if channel.memory == 0.0 {
            gain
        } else {
            gain.plus(&open, -channel.memory)
        };
        let feedback = FeedbackForm {
            open,
            gain,
            channel,
        };
        Self::classified(p, q, feedback.into())
    }

    /// This system, the B and A of which come from the numbers of `source`: what rounding of their
    /// coefficients loses is then taken from there.
    #[inline]
    #[must_use]
    pub fn known_by(mut self, source: Source) -> Self {
        self.source = Some(source);
        self
    }

    /// The system of the coefficients of P and Q, the constants first.
    ///
    /// # Errors
    /// When there are too many.
    pub fn of_coefficients(p: &[f64], q: &[f64]) -> Result<Self, ModelError> {
        Ok(Self::direct(Polynomial::new(p)?, Polynomial::new(q)?))
    }

    #[inline]
    pub(super) fn classified(p: Polynomial, q: Polynomial, composition: Composition) -> Self {
        let mut system = Self {
            p,
            q,
            composition,
            source: None,
            class: Class::Retarded,
        };
        system.class = system.find_class();
        system
    }

    /// The class that the degrees of P and Q and their highest coefficients make.
    pub(super) fn class_by_degrees(&self) -> Class {
        let (n, m) = (self.p.degree(), self.q.degree());
        if !self.p.degree_known() || (m >= n && !self.q.degree_known()) {
            return Class::DegreeUnknown;
        }
        if self.q.is_zero() {
            return if self.p.is_zero() {
                Class::Refused
            } else {
                Class::Retarded
            };
        }
        if self.p.is_zero() || m > n {
            return Class::Infinite;
        }
        if m < n {
            return Class::Retarded;
        }
        let modulus = self.on_axis().modulus();
        if modulus.vanishes() {
            return Class::Refused;
        }
        let ratio = (self.q.leading().value / self.p.leading().value).abs();
        let leading = modulus.coefficient(n);
        if leading.decided() {
            return if ratio < 1.0 {
                Class::Neutral { ratio }
            } else {
                Class::Infinite
            };
        }
        let highest = (0..n).rev().map(|k| modulus.coefficient(k));
        match highest.into_iter().find(|c| c.decided()) {
            Some(c) if c.value < 0.0 => Class::Infinite,
            _ => Class::NeutralLimit,
        }
    }

    /// The coefficients of λ^`degree` in P and in Q.
    #[must_use]
    pub(super) fn coefficients(&self, degree: usize) -> [f64; 2] {
        [&self.p, &self.q].map(|of| of.coefficients().get(degree).copied().unwrap_or(0.0))
    }

    /// The class of the system.
    #[must_use]
    pub fn class(&self) -> Class {
        self.class
    }

    /// Whether there is no feedback at all: then the delay does not matter.
    #[must_use]
    pub fn uncontrolled(&self) -> bool {
        self.q.is_zero()
    }

    /// The real part at which roots accumulate at the delay `tau` > 0: ln ρ/τ, −∞ where deg Q <
    /// deg P.
    #[must_use]
    pub fn essential_abscissa(&self, tau: f64) -> f64 {
        match self.class {
            Class::Neutral { ratio } if tau > 0.0 => ln(ratio) / tau,
            Class::NeutralLimit if tau > 0.0 => 0.0,
            Class::Infinite if tau > 0.0 => f64::INFINITY,
            _ => f64::NEG_INFINITY,
        }
    }

    /// P and Q divided by λ, where both vanish at 0 for certain or within rounding; none where they
    /// do not.
    pub(super) fn without_common_origin(&self) -> Option<Self> {
        let vanish = |p: &Polynomial| !p.coefficient(0).decided();
        if self.q.is_zero() || !(vanish(&self.p) && vanish(&self.q)) {
            return None;
        }
        Some(Self::classified(
            self.p.divided_by_variable(),
            self.q.divided_by_variable(),
            self.composition.divided_by_variable(),
        ))
    }

    /// P + Q: its zeros are the roots without delay; divided by λ where a root at 0 is left out.
    pub(super) fn without_delay(&self) -> Polynomial {
        match self.feedback_form() {
            Some(FeedbackForm { open, channel, .. }) => open.scaled(Rounded {
                value: 1.0 - channel.memory,
                error: 0.5 * f64::EPSILON,
            }),
            None if self.leaves_origin_out() => self.p.plus(&self.q, 1.0).divided_by_variable(),
            None => self.p.plus(&self.q, 1.0),
        }
    }

    /// The frequencies |Im λ| > 0 of the roots without delay, in no order.
    #[must_use]
    pub fn frequencies_without_delay(&self) -> Vec<f64> {
        let zeros = Zeros::of(&self.without_delay().without_open_leading());
        let above = zeros.discs().iter().map(|disc| disc.centre.im);
        above.filter(|&omega| omega > 0.0).collect()
    }

    /// P and Q on the line Re λ = `line`.
    #[inline]
    pub(super) fn on_line(&self, line: f64, decay: Decay) -> Shifted {
        match self.feedback_form() {
            Some(FeedbackForm {
                open,
                gain,
                channel,
            }) => Shifted::of_feedback([open, gain], channel.memory, line, decay),
            None => Shifted::direct([&self.p, &self.q], line, decay),
        }
    }

    /// P and Q on the imaginary axis.
    #[inline]
    pub(super) fn on_axis(&self) -> Shifted {
        self.on_line(0.0, Decay::NONE)
    }

    /// A radius within which every root with Re λ ≥ `line` lies, from the coefficients of P and Q.
    pub(super) fn bound_by_coefficients(&self, tau: f64, line: f64) -> f64 {
        let n = self.p.degree();
        let kappa = exp(-line * tau);
        let size = |p: &Polynomial, k: usize| {
            let c = p.coefficient(k);
            if k <= p.degree() {
                c.value.abs() + c.error
            } else {
                0.0
            }
        };
        let leading = size(&self.p, n) * (1.0 - 2.0 * f64::EPSILON) - kappa * size(&self.q, n);
        if leading.is_nan() || leading <= 0.0 {
            return f64::INFINITY;
        }
        // Rⁿ = Σ r_i Rⁱ has no positive zero beyond 2 max r_i^(1/(n − i)) (Fujiwara).
        let radius = |i: usize| {
            let ratio = (size(&self.p, i) + kappa * size(&self.q, i)) / leading;
            pow(ratio, 1.0 / (n - i) as f64)
        };
        2.0 * (0..n).map(radius).fold(0.0, f64::max)
    }

    /// D, D′ and D″ at λ, with Q as what is fed back.
    #[must_use]
    pub fn jet(&self, tau: f64, lambda: Complex64) -> Jet {
        if self.leaves_origin_out() {
            return self.jet_beside_origin(tau, lambda);
        }
        let difference = one_minus_exp(-tau * lambda);
        let delayed = 1.0 - difference;
        let (kept, fed, part) = match self.feedback_form() {
            // D = (1 − R) B − Q(1 − E): short delays keep their digits.
            Some(FeedbackForm {
                open,
                gain,
                channel: Channel { memory, latency },
            }) => {
                let (b, a) = (open.jet(lambda), late(gain.jet(lambda), *latency, lambda));
                let fed = [0, 1, 2].map(|i| a[i] - memory * b[i]);
                (b.map(|b| b * (1.0 - memory)), fed, -difference)
            }
            None => (self.p.jet(lambda), self.q.jet(lambda), delayed),
        };
        let memory = fed[0] * delayed * tau;
        Jet {
            value: kept[0] + fed[0] * part,
            first: kept[1] + fed[1] * part - memory,
            second: kept[2] + fed[2] * part - 2.0 * tau * fed[1] * delayed + memory * tau,
            delayed,
            difference,
            feedback: fed[0],
        }
    }

    /// A bound on the rounding error of D at λ, to within a small factor.
    #[must_use]
    pub fn rounding(&self, jet: &Jet, tau: f64, lambda: Complex64) -> f64 {
        if self.leaves_origin_out() {
            return self.rounding_beside_origin(jet, tau, lambda);
        }
        let size = lambda.l1_norm();
        let unit = (self.p.degree().max(self.q.degree()) as f64 + 4.0) * f64::EPSILON;
        let part = |p: &Polynomial, by: f64| {
            let (value, error) = p.bounds(size);
            by * (unit * value + error)
        };
        let delayed = jet.delayed.l1_norm();
        // The argument λτ is rounded as well, and with it the phase of E.
        let turned = delayed * size * tau;
        match self.feedback_form() {
            Some(feedback) => {
                let FeedbackForm {
                    open,
                    gain,
                    channel: Channel { memory, .. },
                } = feedback;
                let by = jet.difference.l1_norm() + turned;
                part(gain, by * feedback.late_size(lambda))
                    + part(open, 1.0 - memory + memory.abs() * by)
            }
            None => part(&self.p, 1.0) + part(&self.q, delayed + turned),
        }
    }

    /// Whether P and Q have a zero near iω in common, both within their errors on the axis; `omega`
    /// is known to within `error`.
    pub(super) fn has_common_zero(&self, omega: f64, error: f64) -> bool {
        if !self.on_axis().may_vanish(omega, error) {
            return false;
        }
        let on_axis = |polynomial: &Polynomial| {
            let zeros = Zeros::of(polynomial);
            let near = zeros.discs().iter().copied().filter(|disc| {
                disc.centre.im > 0.0
                    && disc.centre.re.abs() <= disc.radius
                    && (disc.centre.im - omega).abs() <= 1e-6 * omega
            });
            near.min_by(|a, b| {
                let apart = |d: &Disc| (d.centre.im - omega).abs();
                apart(a).total_cmp(&apart(b))
            })
        };
        let [p, q] = self.polynomials();
        match (on_axis(p), on_axis(&q.without_open_leading())) {
            (Some(p), Some(q)) => (p.centre.im - q.centre.im).abs() <= p.radius + q.radius,
            _ => false,
        }
    }
}
