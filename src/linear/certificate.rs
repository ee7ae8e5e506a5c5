//! How many characteristic roots lie right of a vertical line: the argument principle, evaluated in closed form.
//!
//! With P = B − A and Q = A the characteristic function is D = P + Q e^(−λτ). On the line λ = σ + iω, with κ = e^(−στ),
//!
//! ```text
//! P = c − ω² + i p ω,        c = P(σ),  p = P′(σ)
//! Q = q₀ + i q₁ ω,           q₀ = Q(σ), q₁ = a_v
//! F(x) = |P|² − κ²|Q|² = x² + 2βx + γ,   x = ω²                                             (1)
//!      = y² + 2hy + 2hc − κ²q₀²,         y = x − c = −Re P,   h = (p² − κ²q₁²)/2
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

use std::f64::consts::TAU;

use crate::model::Groups;

/// Rounding errors that an expression here may gather, each of ε/2 of its largest term.
const ROUNDINGS: f64 = 8.0 * f64::EPSILON;

/// The number of roots with Re λ > `line`, or none where a root is too near to the line to tell.
///
/// `tau` ≥ 0 in units of √(M/κ), `line` in their inverse. Real roots count once, complex pairs twice. Also none where
/// e^(−στ) overflows.
#[inline]
#[must_use]
pub fn roots_right_of(groups: Groups, tau: f64, line: f64) -> Option<u64> {
    Line::new(groups, tau, line)?.turning()?.count(tau)
}

/// The number of roots right of the imaginary axis, at any delay of a line: there κ = 1 and only (2) depends on the delay.
#[derive(Debug, Clone, Copy)]
pub struct UnstableCount(Option<Turning>);

impl UnstableCount {
    /// For the line of `groups`.
    #[must_use]
    pub fn new(groups: Groups) -> Self {
        let line = Line::new(groups, 0.0, 0.0);
        Self(line.and_then(|line| line.turning()))
    }

    /// As [`roots_right_of`] zero at the delay `tau`.
    #[inline]
    #[must_use]
    pub fn at(&self, tau: f64) -> Option<u64> {
        self.0.as_ref()?.count(tau)
    }
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

/// Equation (3) with what does not depend on the delay, κ given, worked out.
#[derive(Debug, Clone, Copy)]
struct Turning {
    /// 1 − [arg P(∞) − arg D(0)]/π.
    without_turns: f64,
    up: Option<Switch>,
    down: Option<Switch>,
}

/// A place ω where the larger one of P and κQ changes.
#[derive(Debug, Clone, Copy)]
struct Switch {
    omega: f64,
    omega_error: f64,
    /// arg P − arg Q.
    phase: f64,
    phase_error: f64,
}

impl Line {
    #[inline(always)]
    fn new(groups: Groups, tau: f64, line: f64) -> Option<Self> {
        let Groups { b, a_v, a_n } = groups;
        // Without feedback the delay does not matter.
        let tau = if groups.uncontrolled() { 0.0 } else { tau };
        let decay = (-line * tau).exp_m1();
        let kappa = decay + 1.0;
        if !kappa.is_finite() {
            return None;
        }
        let q0 = Rounded::sum([a_n, a_v * b, a_v * line]);
        let open_loop = Rounded::sum([line * line, b * line, 1.0]);
        let c = Rounded::sum([open_loop.value, -q0.value]).plus_error(open_loop.error + q0.error);
        let p = Rounded::sum([2.0 * line, b, -a_v]);
        let kappa_error = ROUNDINGS * kappa * (1.0 + (line * tau).abs());
        // D(σ) = B − A(1 − κ): exact where στ is small.
        let fed_back = q0.value * decay;
        let sum = Rounded::sum([open_loop.value, fed_back])
            .plus_error(open_loop.error + q0.error * decay.abs() + q0.value.abs() * kappa_error);
        let echo = Rounded {
            value: kappa * q0.value,
            error: kappa * q0.error + q0.value.abs() * kappa_error,
        };
        let mirror = Rounded::sum([c.value, -echo.value]).plus_error(c.error + echo.error);
        let delayed_slope = kappa * a_v;
        let h = Rounded::sum([
            0.5 * p.value * p.value,
            -0.5 * delayed_slope * delayed_slope,
        ]);
        let h =
            h.plus_error(p.value.abs() * p.error + delayed_slope.abs() * a_v.abs() * kappa_error);
        Some(Self {
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
        let beta =
            Rounded::sum([self.h.value, -self.c.value]).plus_error(self.h.error + self.c.error);
        let gamma = self.gamma();
        let discriminant = self.discriminant();
        if gamma.value > gamma.error {
            if beta.value > beta.error || discriminant.value < -discriminant.error {
                return self.polynomial_alone();
            }
            if !discriminant.decided() {
                return self.nearly_touching(discriminant.error);
            }
        }
        let root = discriminant.value.max(discriminant.error).sqrt();
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
        let lower = (gamma.value * per_upper).max(0.0);
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

    /// ω₋ and ω₊ coincide to rounding: whatever turns there are on the way up, there are on the way down. They cancel, but
    /// for a delay at which it is in doubt which they are.
    fn nearly_touching(&self, discriminant_error: f64) -> Option<Turning> {
        let y = Rounded {
            value: -self.h.value,
            error: self.h.error + (2.0 * discriminant_error).sqrt(),
        };
        let x = Rounded::sum([self.c.value, y.value]).plus_error(self.c.error + y.error);
        let both = Some(self.switch(x, y));
        Some(Turning {
            up: both,
            down: both,
            ..self.polynomial_alone()?
        })
    }

    /// y at ω₊ and ω₋ without cancellation, `root` being the square root of the discriminant: the larger one first, the
    /// other from their product.
    #[inline(always)]
    fn real_parts(&self, root: Rounded) -> [Rounded; 2] {
        let (c, h, echo) = (self.c, self.h, self.echo);
        let large = -(h.value + root.value.copysign(h.value));
        let large_error = h.error + root.error + ROUNDINGS * large.abs();
        let per_large = 1.0 / large.abs();
        let terms = [2.0 * h.value * c.value, -echo.value * echo.value];
        let product = Rounded::sum(terms).plus_error(
            2.0 * (h.value.abs() * c.error
                + h.error * c.value.abs()
                + echo.value.abs() * echo.error),
        );
        let small = Rounded {
            value: product.value / large,
            error: (product.error + product.value.abs() * large_error * per_large) * per_large,
        };
        let large = Rounded {
            value: large,
            error: large_error,
        };
        if h.value < 0.0 {
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

    #[inline(always)]
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

    /// 1 − [arg P(∞) − arg D(0)]/π, where just above ω = 0 D has the argument of `real` + iω · `slope`.
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
        let omega = x.value.max(0.0).sqrt();
        let omega_error = if omega > 0.0 {
            (x.error / omega).min(x.error.sqrt()) + ROUNDINGS * omega
        } else {
            x.error.sqrt()
        };
        let (p_re, p_im) = (-y.value, self.p.value * omega);
        let (q_re, q_im) = (self.q0.value, self.q1 * omega);
        // + 0.0: a negative zero would choose the wrong side of the cut.
        let phase = (p_im + 0.0).atan2(p_re) - (q_im + 0.0).atan2(q_re);
        let p_size = p_re.abs().max(p_im.abs());
        let q_size = q_re.abs().max(q_im.abs());
        let p_error = y.error + self.p.error * omega + self.p.value.abs() * omega_error;
        let q_error = self.q0.error + self.q1.abs() * omega_error;
        Switch {
            omega,
            omega_error,
            phase,
            phase_error: p_error / p_size + q_error / q_size + ROUNDINGS * TAU,
        }
    }
}

/// ω₊² from (1), `root` being the square root of the discriminant; none where it is not positive.
#[inline(always)]
fn upper_zero(beta: Rounded, gamma: Rounded, root: Rounded) -> Option<Rounded> {
    let value = if beta.value <= 0.0 {
        root.value - beta.value
    } else {
        -gamma.value / (beta.value + root.value)
    };
    (value > 0.0).then_some(Rounded {
        value,
        error: beta.error + root.error + ROUNDINGS * (beta.value.abs() + root.value),
    })
}

impl Switch {
    /// Equation (2); none where it might round either way.
    #[inline(always)]
    fn turns(&self, tau: f64) -> Option<f64> {
        let angle = self.omega * tau;
        let turns = (self.phase + angle) * (1.0 / TAU);
        let whole = turns.round_ties_even();
        let error = self.phase_error + self.omega_error * tau + ROUNDINGS * angle;
        // NaN is undecided as well.
        ((0.5 - (turns - whole).abs()) * TAU > error).then_some(whole)
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
