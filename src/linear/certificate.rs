//! How many characteristic roots lie right of a vertical line: the argument principle, evaluated in closed form.
//!
//! With P = B − A and Q = A the characteristic function is D = P + Q e^(−λτ). On the line λ = σ + iω, with κ = e^(−στ),
//!
//! ```text
//! P = c − ω² + i p ω,        c = P(σ),  p = P′(σ)
//! Q = q₀ + i q₁ ω,           q₀ = Q(σ), q₁ = a_v
//! F(x) = |P|² − κ²|Q|² = x² + 2βx + γ,   x = ω²                                             (1)
//! ```
//!
//! F has at most two zeros ω₋ < ω₊, so the line falls into at most three stretches on which either P or κQ e^(−iωτ) is
//! the larger of the two. There arg D stays within a right angle of the argument of the larger term, which is known in
//! closed form: arg P and arg Q keep to one half-plane each. No turn can be skipped, because none is stepped over. Where
//! the stretches meet, both readings of arg D differ by a whole number of turns,
//!
//! ```text
//! m(ω) = round[(arg P − arg Q + ωτ)/2π],                                                    (2)
//! ```
//!
//! and D, which behaves like λ² far out and has no poles, has to the right of the line
//!
//! ```text
//! n = 1 − [arg P(∞) − arg D(0)]/π + 2m(ω₊) − 2m(ω₋)                                         (3)
//! ```
//!
//! roots, the term m(ω₋) being absent where κQ is the larger one at ω = 0. The count needs ω± only to the accuracy at which
//! (2) rounds: it is undecided only where a root lies within rounding of the line. Nothing here is shared with the tracker,
//! the spectrum or the crossing delays.

use std::f64::consts::{PI, TAU};

use crate::model::Groups;

/// Rounding errors that an expression here may gather, each of ε/2 of its largest term.
const ROUNDINGS: f64 = 8.0 * f64::EPSILON;

/// The number of roots with Re λ > `line`, or none where a root is too near to the line to tell.
///
/// `tau` ≥ 0 in units of √(M/κ), `line` in their inverse. Real roots count once, complex pairs twice. Also none where
/// e^(−στ) overflows.
#[must_use]
pub fn roots_right_of(groups: Groups, tau: f64, line: f64) -> Option<u64> {
    Line::new(groups, tau, line)?.roots_to_the_right()
}

/// A number and a bound on its rounding error.
#[derive(Clone, Copy)]
struct Rounded {
    value: f64,
    error: f64,
}

impl Rounded {
    /// The sum of `terms`.
    #[inline(always)]
    fn sum<const N: usize>(terms: [f64; N]) -> Self {
        let (mut value, mut size) = (0.0, 0.0);
        for term in terms {
            value += term;
            size += term.abs();
        }
        Self {
            value,
            error: ROUNDINGS * size,
        }
    }

    fn plus_error(self, error: f64) -> Self {
        Self {
            error: self.error + error,
            ..self
        }
    }

    /// The sign is beyond doubt.
    fn decided(self) -> bool {
        self.value.abs() > self.error
    }
}

/// D on a vertical line, in the symbols of the module.
struct Line {
    tau: f64,
    c: Rounded,
    p: Rounded,
    q0: Rounded,
    q1: f64,
    /// D(σ) = c + κ q₀ and its mirror c − κ q₀; their product is γ.
    sum: Rounded,
    mirror: Rounded,
    beta: Rounded,
}

impl Line {
    fn new(groups: Groups, tau: f64, line: f64) -> Option<Self> {
        let Groups { b, a_v, a_n } = groups;
        let decay = (-line * tau).exp_m1();
        let kappa = decay + 1.0;
        if !kappa.is_finite() {
            return None;
        }
        let q0 = Rounded::sum([a_n, a_v * b, a_v * line]);
        let open_loop = Rounded::sum([line * line, b * line, 1.0]);
        let c = Rounded::sum([line * line, b * line, 1.0, -a_n, -a_v * b, -a_v * line]);
        let p = Rounded::sum([2.0 * line, b, -a_v]);
        let kappa_error = ROUNDINGS * kappa * (1.0 + (line * tau).abs());
        // D(σ) = B − A(1 − κ): exact where στ is small.
        let fed_back = q0.value * decay;
        let sum = Rounded::sum([open_loop.value, fed_back])
            .plus_error(open_loop.error + q0.error * decay.abs() + q0.value.abs() * kappa_error);
        let echoed = kappa * q0.value;
        let mirror = Rounded::sum([c.value, -echoed])
            .plus_error(c.error + kappa * q0.error + q0.value.abs() * kappa_error);
        let delayed_slope = kappa * a_v;
        let beta = Rounded::sum([
            0.5 * p.value * p.value,
            -c.value,
            -0.5 * delayed_slope * delayed_slope,
        ]);
        let beta = beta.plus_error(
            p.value.abs() * p.error + c.error + delayed_slope.abs() * a_v.abs() * kappa_error,
        );
        Some(Self {
            tau,
            c,
            p,
            q0,
            q1: a_v,
            sum,
            mirror,
            beta,
        })
    }

    fn roots_to_the_right(&self) -> Option<u64> {
        if !self.sum.decided() {
            return None;
        }
        let (beta, gamma) = (self.beta, self.gamma());
        let discriminant = Rounded {
            value: beta.value * beta.value - gamma.value,
            error: 2.0 * beta.value.abs() * beta.error
                + gamma.error
                + ROUNDINGS * (beta.value * beta.value + gamma.value.abs()),
        };
        if gamma.value > 0.0 && gamma.decided() {
            if beta.value >= 0.0 && beta.decided() || discriminant.value < -discriminant.error {
                return self.polynomial_alone();
            }
            if !discriminant.decided() {
                // ω₋ and ω₊ coincide to rounding: whatever turns there are on the way up, there are on the way down.
                let error = beta.error + (2.0 * discriminant.error).sqrt();
                self.turns(-beta.value, error)?;
                return self.polynomial_alone();
            }
        }
        let root = discriminant.value.max(0.0).sqrt();
        let root_error = if root > 0.0 {
            discriminant.error / root
        } else {
            discriminant.error.sqrt()
        };
        let rounding = ROUNDINGS * (beta.value.abs() + root);
        let upper_error = beta.error + root_error + rounding;
        let upper = if beta.value <= 0.0 {
            root - beta.value
        } else {
            -gamma.value / (beta.value + root)
        };
        if upper <= 0.0 {
            return None;
        }
        let up = self.turns(upper, upper_error)?;
        if gamma.value > 0.0 || !gamma.decided() {
            let lower = (gamma.value / upper).max(0.0);
            let lower_error = gamma.error / upper + lower * upper_error / upper;
            let down = self.turns(lower, lower_error)?;
            self.total(self.argument_at_zero(self.c.value, self.p.value), up - down)
        } else {
            self.total(self.argument_at_zero(self.q0.value, self.q1), up)
        }
    }

    fn gamma(&self) -> Rounded {
        let (sum, mirror) = (self.sum, self.mirror);
        let value = sum.value * mirror.value;
        Rounded {
            value,
            error: sum.value.abs() * mirror.error
                + mirror.value.abs() * sum.error
                + ROUNDINGS * value.abs(),
        }
    }

    /// Equation (3) where P is larger than κQ all along the line: the zeros of P decide.
    fn polynomial_alone(&self) -> Option<u64> {
        if !self.c.decided() || (self.c.value > 0.0 && !self.p.decided()) {
            return None;
        }
        self.total(self.argument_at_zero(self.c.value, self.p.value), 0.0)
    }

    /// The argument just above ω = 0 of `real` + iω · `slope`.
    fn argument_at_zero(&self, real: f64, slope: f64) -> f64 {
        if real > 0.0 {
            0.0
        } else if slope < 0.0 {
            -PI
        } else {
            PI
        }
    }

    /// Equation (3); `turns` = m(ω₊) − m(ω₋).
    fn total(&self, argument_at_zero: f64, turns: f64) -> Option<u64> {
        let argument_far_out = if self.p.value < 0.0 { -PI } else { PI };
        let n = 1.0 - (argument_far_out - argument_at_zero) / PI + 2.0 * turns;
        (n >= 0.0).then_some(n.round() as u64)
    }

    /// Equation (2) at ω² = `x`, known within `error`; none where it might round either way.
    fn turns(&self, x: f64, error: f64) -> Option<f64> {
        let omega = x.max(0.0).sqrt();
        let omega_error = error / omega.max(error.sqrt()) + ROUNDINGS * omega;
        let (p_re, p_im) = (self.c.value - x, self.p.value * omega);
        let (q_re, q_im) = (self.q0.value, self.q1 * omega);
        // + 0.0: a negative zero would choose the wrong side of the cut.
        let p_argument = (p_im + 0.0).atan2(p_re);
        let q_argument = (q_im + 0.0).atan2(q_re);
        let phase = p_argument - q_argument + omega * self.tau;
        let p_size = p_re.abs().max(p_im.abs());
        let q_size = q_re.abs().max(q_im.abs());
        let p_error =
            self.c.error + error + self.p.error * omega + self.p.value.abs() * omega_error;
        let q_error = self.q0.error + self.q1.abs() * omega_error;
        let phase_error = omega_error * self.tau
            + p_error / p_size
            + q_error / q_size
            + ROUNDINGS * (TAU + omega * self.tau);
        let turns = phase / TAU;
        let whole = turns.round();
        let to_half = 0.5 - (turns - whole).abs();
        // NaN is undecided as well.
        (to_half * TAU > phase_error).then_some(whole)
    }
}
