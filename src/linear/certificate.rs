//! How many characteristic roots lie right of a vertical line: the argument principle, evaluated in
//! closed form.
//!
//! With P = B − A and Q = A the characteristic function is D = P + Q e^(−λτ). On the line λ = σ +
//! iω, with κ = e^(−στ),
//!
//! ```text
//! P = c − ω² + i p ω,        c = P(σ),  p = P′(σ)
//! Q = q₀ + i q₁ ω,           q₀ = Q(σ), q₁ = a_v
//! F(x) = |P|² − κ²|Q|² = x² + 2βx + γ,   x = ω²                                             (1)
//!      = y² + 2hy + 2hc − κ²q₀²,         y = x − c = −Re P,   h = (p² − κ²q₁²)/2
//! ```
//!
//! F has at most two zeros ω₋ < ω₊, so the line falls into at most three stretches on which either
//! P or κQ e^(−iωτ) is the larger of the two. There arg D stays within a right angle of the
//! argument of the larger term, which is known in closed form: arg P and arg Q keep to one
//! half-plane each. No turn can be skipped, because none is stepped over. Where the stretches meet,
//! both readings of arg D differ by a whole number of turns,
//!
//! ```text
//! m(ω) = round[(arg P − arg Q + ωτ)/2π],                                                    (2)
//! −P Q* = (y q₀ − p q₁ x) − i ω (r q₀ + (x − s) q₁),      s = B(σ),  r = B′(σ)              (3)
//! ```
//!
//! and D, which behaves like λ² far out and has no poles, has to the right of the line
//!
//! ```text
//! n = 1 − [arg P(∞) − arg D(0)]/π + 2m(ω₊) − 2m(ω₋)                                         (4)
//! ```
//!
//! roots, the term m(ω₋) being absent where κQ is the larger one at ω = 0. The count needs ω± only
//! to the accuracy at which (2) rounds: it is undecided only where a root lies within rounding of
//! the line. Nothing here is shared with the tracker, the spectrum or the crossing delays.
//!
//! Strong gains with a short delay make P and κQ large and nearly opposite, and D is their small
//! sum. So wherever the two cancel they are expressed by B, which has no gains, and by κ − 1. Then
//! (2) rounds by the small angle of (3).

use std::f64::consts::TAU;

use super::rounded::{ROUNDINGS, Rounded, larger};
use crate::model::Groups;
use crate::model::elementary::{atan2, expm1};

/// The number of roots with Re λ > `line`, or none where a root is too near to the line to tell.
///
/// `tau` ≥ 0 in units of √(M/κ), `line` in their inverse. Real roots count once, complex pairs
/// twice. Also none where e^(−στ) overflows.
#[inline]
#[must_use]
pub fn roots_right_of(groups: Groups, tau: f64, line: f64) -> Option<u64> {
    VerticalLine::new(groups, tau, line)?.turning()?.count(tau)
}

/// The number of roots right of the imaginary axis, at any delay of a line: there κ = 1 and only
/// (2) depends on the delay.
#[derive(Debug, Clone, Copy)]
pub struct UnstableCount(Option<Turning>);

impl UnstableCount {
    /// For the line of `groups`.
    #[must_use]
    pub fn new(groups: Groups) -> Self {
        let line = VerticalLine::new(groups, 0.0, 0.0);
        Self(line.and_then(|line| line.turning()))
    }

    /// The number of roots right of 0 at the delay `tau`, see [`roots_right_of`].
    #[inline]
    #[must_use]
    pub fn at(&self, tau: f64) -> Option<u64> {
        self.0.as_ref()?.count(tau)
    }
}

/// D on a vertical line, in the symbols of the module.
struct VerticalLine {
    s: Rounded,
    r: Rounded,
    c: Rounded,
    p: Rounded,
    q0: Rounded,
    q1: f64,
    /// D(σ) = c + κ q₀ and its mirror c − κ q₀; their product is γ.
    sum: Rounded,
    mirror: Rounded,
    h: Rounded,
    /// κ q₀.
    echo: Rounded,
}

/// Equation (4) with all terms evaluated that do not depend on the delay at given κ.
#[derive(Debug, Clone, Copy)]
struct Turning {
    /// 1 − [arg P(∞) − arg D(0)]/π.
    without_turns: f64,
    up: Option<Switch>,
    down: Option<Switch>,
}

/// A frequency ω at which the larger one of P and κQ changes.
#[derive(Debug, Clone, Copy)]
struct Switch {
    omega: Rounded,
    /// The argument of (3), in [−π, π].
    phase: Rounded,
    /// How many turns arg P − arg Q + π is ahead of it.
    ahead: f64,
}

impl VerticalLine {
    #[inline(always)]
    fn new(groups: Groups, tau: f64, line: f64) -> Option<Self> {
        let Groups { b, a_v, a_n } = groups;
        // Without feedback the delay does not matter.
        let tau = if groups.uncontrolled() { 0.0 } else { tau };
        let decay = expm1(-line * tau);
        let kappa = decay + 1.0;
        if !kappa.is_finite() {
            return None;
        }
        let q0 = Rounded::sum([a_n, a_v * b, a_v * line]);
        let s = Rounded::sum([line * line, b * line, 1.0]);
        let r = Rounded::sum([2.0 * line, b]);
        let c = s.minus(q0);
        let p = Rounded::sum([2.0 * line, b, -a_v]);
        let exponent_error = ROUNDINGS * kappa * (line * tau).abs();
        let kappa_error = ROUNDINGS * kappa + exponent_error;
        let decay_error = ROUNDINGS * decay.abs() + exponent_error;
        // D(σ) = B − A(1 − κ): exact where στ is small.
        let sum = Rounded::sum([s.value, q0.value * decay])
            .plus_error(s.error + q0.error * decay.abs() + q0.value.abs() * decay_error);
        let echo = Rounded {
            value: kappa * q0.value,
            error: kappa * q0.error + q0.value.abs() * kappa_error,
        };
        let mirror = c.minus(echo);
        // h = (p + κq₁)(p − κq₁)/2.
        let ahead =
            Rounded::sum([r.value, a_v * decay]).plus_error(r.error + a_v.abs() * decay_error);
        let behind = Rounded::sum([r.value, -a_v * (1.0 + kappa)])
            .plus_error(r.error + a_v.abs() * kappa_error);
        let h = ahead.times(behind).scaled(0.5);
        Some(Self {
            s,
            r,
            c,
            p,
            q0,
            q1: a_v,
            sum,
            mirror,
            h,
            echo,
        })
    }

    /// Where the stretches meet; none where a real root is too near to the line.
    #[inline(always)]
    fn turning(&self) -> Option<Turning> {
        if !self.sum.decided() {
            return None;
        }
        let beta = self.h.minus(self.c);
        let gamma = self.sum.times(self.mirror);
        let discriminant = self.discriminant();
        if gamma.value > gamma.error {
            if beta.value > beta.error || discriminant.value < -discriminant.error {
                return self.polynomial_alone();
            }
            if !discriminant.decided() {
                return self.nearly_touching(discriminant.error);
            }
        }
        let root = larger(discriminant.value, discriminant.error).sqrt();
        let root = Rounded {
            value: root,
            error: discriminant.error / root,
        };
        let [y_upper, y_lower] = self.real_parts(root);
        let upper = upper_zero(beta, gamma, root)?;
        let up = Some(self.switch(upper, y_upper));
        if gamma.value < -gamma.error {
            return Some(Turning {
                without_turns: self.without_turns(self.q0.value, self.q1),
                up,
                down: None,
            });
        }
        let per_upper = 1.0 / upper.value;
        let lower = larger(gamma.value * per_upper, 0.0);
        let lower = Rounded {
            value: lower,
            error: (gamma.error + lower * upper.error) * per_upper,
        };
        Some(Turning {
            without_turns: self.without_turns(self.c.value, self.p.value),
            up,
            down: Some(self.switch(lower, y_lower)),
        })
    }

    /// ω₋ and ω₊ coincide to rounding, so their turns cancel. Only at a delay at which (2) may
    /// round either way is the count undecided.
    fn nearly_touching(&self, discriminant_error: f64) -> Option<Turning> {
        let y = Rounded {
            value: -self.h.value,
            error: self.h.error + (2.0 * discriminant_error).sqrt(),
        };
        let x = self.c.minus(y.scaled(-1.0));
        let both = Some(self.switch(x, y));
        Some(Turning {
            up: both,
            down: both,
            ..self.polynomial_alone()?
        })
    }

    /// y at ω₊ and ω₋ without cancellation, `root` being the square root of the discriminant: the
    /// larger one first, the other from their product.
    #[inline(always)]
    fn real_parts(&self, root: Rounded) -> [Rounded; 2] {
        let (c, h, echo) = (self.c, self.h, self.echo);
        let large = -(h.value + root.value.copysign(h.value));
        let large_error = h.error + root.error + ROUNDINGS * large.abs();
        let per_large = 1.0 / large;
        let terms = [2.0 * h.value * c.value, -echo.value * echo.value];
        let product = Rounded::sum(terms).plus_error(
            2.0 * (h.value.abs() * c.error
                + h.error * c.value.abs()
                + echo.value.abs() * echo.error),
        );
        let small = Rounded {
            value: product.value * per_large,
            error: (product.error + (product.value * large_error * per_large).abs())
                * per_large.abs(),
        };
        let large = Rounded {
            value: large,
            error: large_error,
        };
        // By the sign bit, which `copysign` copied: h may be −0.
        if h.value.is_sign_negative() {
            [large, small]
        } else {
            [small, large]
        }
    }

    /// β² − γ, in the form without their cancellation: h² − 2hc + κ²q₀².
    #[inline(always)]
    fn discriminant(&self) -> Rounded {
        let (c, h, echo) = (self.c, self.h, self.echo);
        let terms = [
            h.value * h.value,
            -2.0 * h.value * c.value,
            echo.value * echo.value,
        ];
        Rounded::sum(terms).plus_error(
            2.0 * h.error * (h.value.abs() + c.value.abs())
                + 2.0 * h.value.abs() * c.error
                + 2.0 * echo.value.abs() * echo.error,
        )
    }

    /// Where P is larger than κQ all along the line: the zeros of P decide.
    fn polynomial_alone(&self) -> Option<Turning> {
        if !self.c.decided() || (self.c.value > 0.0 && !self.p.decided()) {
            return None;
        }
        Some(Turning {
            without_turns: self.without_turns(self.c.value, self.p.value),
            up: None,
            down: None,
        })
    }

    /// 1 − [arg P(∞) − arg D(0)]/π, where just above ω = 0 D has the argument of `real` + iω ·
    /// `slope`.
    #[inline(always)]
    fn without_turns(&self, real: f64, slope: f64) -> f64 {
        let far_out = if self.p.value < 0.0 { -1.0 } else { 1.0 };
        let at_zero = match (real > 0.0, slope < 0.0) {
            (true, _) => 0.0,
            (false, true) => -1.0,
            (false, false) => 1.0,
        };
        1.0 - (far_out - at_zero)
    }

    /// The place ω² = `x`, where Re P = −`y`.
    #[inline(always)]
    fn switch(&self, x: Rounded, y: Rounded) -> Switch {
        let omega = x.root();
        let (p, q0, q1) = (self.p, self.q0, self.q1);
        let p_im = p.value * omega.value;
        let q_im = q1 * omega.value;
        let per_p = 1.0 / larger(y.value.abs(), p_im.abs());
        let per_q = 1.0 / larger(q0.value.abs(), q_im.abs());
        let slope = self.slope(x, y);
        // Over the sizes of P and Q, so that their product neither overflows nor is below 1.
        let sine = -(slope.value * per_q) * (omega.value * per_p);
        let cosine = (y.value * per_p) * (q0.value * per_q) - (p_im * per_p) * (q_im * per_q);
        let phase = atan2(sine, cosine);
        let sine_error = (slope.error * per_q) * (omega.value * per_p)
            + (slope.value.abs() * per_q) * (omega.error * per_p);
        let cosine_error = (y.error + p.error * omega.value + p.value.abs() * omega.error) * per_p
            + (q0.error + q1.abs() * omega.error) * per_q;
        Switch {
            omega,
            phase: Rounded {
                value: phase,
                error: sine_error + sine.abs() * cosine_error + 4.0 * ROUNDINGS * phase.abs(),
            },
            ahead: nearest(self.middle() + 0.5 - phase * (1.0 / TAU)),
        }
    }

    /// r q₀ + (x − s) q₁ of (3).
    #[inline(always)]
    fn slope(&self, x: Rounded, y: Rounded) -> Rounded {
        let (r, q0, q1) = (self.r, self.q0, self.q1);
        // x − s = y − q₀: the terms of one cancel where the gains are strong, those of the other
        // where they are weak.
        let shifted = if q0.value.abs() < self.s.value.abs() {
            y.minus(q0)
        } else {
            x.minus(self.s)
        };
        Rounded::sum([r.value * q0.value, shifted.value * q1]).plus_error(
            r.value.abs() * q0.error + r.error * q0.value.abs() + shifted.error * q1.abs(),
        )
    }

    /// A place within half a turn of arg P − arg Q, in turns: arg P keeps to a half-plane, arg Q to
    /// a quadrant.
    #[inline(always)]
    fn middle(&self) -> f64 {
        let half = if self.p.value < 0.0 { -0.25 } else { 0.25 };
        let quadrant = if self.q0.value < 0.0 { 0.375 } else { 0.125 };
        half - quadrant * if self.q1 < 0.0 { -1.0 } else { 1.0 }
    }
}

/// The integer nearest to `x` > −1.5.
#[inline(always)]
fn nearest(x: f64) -> f64 {
    f64::from((x + 1.5) as i32 - 1)
}

/// ω₊² from (1), `root` being the square root of the discriminant; none where it is not positive.
#[inline(always)]
fn upper_zero(beta: Rounded, gamma: Rounded, root: Rounded) -> Option<Rounded> {
    let error = beta.error + root.error + ROUNDINGS * (beta.value.abs() + root.value);
    let (value, error) = if beta.value <= 0.0 {
        (root.value - beta.value, error)
    } else {
        let per_lower = 1.0 / (beta.value + root.value);
        let value = -gamma.value * per_lower;
        (value, (gamma.error + value * error) * per_lower)
    };
    (value > 0.0).then_some(Rounded { value, error })
}

impl Switch {
    /// Equation (2); none where it might round either way.
    #[inline(always)]
    fn turns(&self, tau: f64) -> Option<f64> {
        let angle = self.omega.value * tau;
        let turns = (self.phase.value + angle) * (1.0 / TAU);
        let error = self.phase.error + self.omega.error * tau + ROUNDINGS * angle;
        let whole = turns as i64 as f64;
        let part = turns - whole;
        let floor = if part < 0.0 { whole - 1.0 } else { whole };
        // NaN is undecided as well, and so are values too large for an integer.
        let (low, high) = (part.abs(), 1.0 - part.abs());
        let apart = if low < high { low } else { high };
        (apart * TAU > error).then_some(floor + self.ahead)
    }
}

impl Turning {
    #[inline(always)]
    fn count(&self, tau: f64) -> Option<u64> {
        let turns = |switch: &Option<Switch>| match switch {
            Some(switch) => switch.turns(tau),
            None => Some(0.0),
        };
        let n = self.without_turns + 2.0 * (turns(&self.up)? - turns(&self.down)?);
        (n >= 0.0).then_some(n as u64)
    }
}
