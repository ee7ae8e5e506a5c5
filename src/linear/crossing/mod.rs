//! Where characteristic roots cross the imaginary axis as the delay grows, in closed form.
//!
//! On λ = iω the letter's Eq. (4), 2 Re(A B*) = |B|², is a quadratic in x = ω². Written in y = x −
//! 1,
//!
//! ```text
//! y² + c y + d = 0,   c = b² + 2 a_n,   d = b (b − 2 a_v),   (1)
//! ```
//!
//! so there are at most two crossing frequencies ω₋ < ω₊, whatever τ is. In y rather than x because
//! B = −y + i b ω at a crossing: the delay depends on y, and this form keeps its relative accuracy
//! where y is small. The letter's Eq. (5) then gives the delays,
//!
//! ```text
//! τ_k = (θ + 2πk)/ω,   k = 0, 1, …,
//! θ = arg[(|A|² − Re A B*) + i (A_r B_i − A_i B_r)] in [0, 2π)   (2)
//! ```
//!
//! With growing τ a pair of roots crosses to the right at every τ_k(ω₊) and to the left at every
//! τ_k(ω₋): the sign of dRe λ/dτ there is that of dF/dx, F(x) being the left side of (1).
//!
//! - `angle`: angles of points, two at a time
//! - `quadratic`: the quadratic (1), its discriminant and its roots

mod angle;
mod quadratic;

use std::f64::consts::TAU;

use wide::f64x2;

use crate::model::Groups;
use angle::phase;
use quadratic::{ROUNDINGS, UNIT_ROUNDOFF, quadratic, roots, without_underflow};
pub(crate) use quadratic::{discriminant, frequency_product};

/// Above this branch number neighbouring delays are closer than their rounding errors: all of them
/// are marginal.
const FINEST_BRANCH: f64 = (1_u64 << 52) as f64;

/// The way in which a pair of roots crosses the imaginary axis as the delay grows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Direction {
    /// Two roots leave the right half-plane.
    Left,
    /// Two roots enter the right half-plane.
    Right,
    /// A double root of F: the pair touches the axis and returns.
    Touch,
}

impl Direction {
    /// The direction of a sign: what is neither −1 nor 1 is a touch.
    pub(super) const fn of_sign(sign: i8) -> Self {
        match sign {
            1 => Self::Right,
            -1 => Self::Left,
            _ => Self::Touch,
        }
    }

    /// −1 to the left, 0 where the pair touches the axis, 1 to the right.
    #[must_use]
    pub const fn sign(self) -> i8 {
        match self {
            Self::Left => -1,
            Self::Touch => 0,
            Self::Right => 1,
        }
    }
}

/// One crossing frequency with all its delays (equation 2 of the module).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crossing {
    /// Crossing frequency ω > 0, in units of √(κ/M).
    pub omega: f64,
    /// Phase θ = ω τ_0 in [0, 2π].
    pub theta: f64,
    /// The first branch k that is a crossing: 1 where θ = 0 exactly (b = 0), else 0.
    pub first_branch: u64,
    /// How the pair moves there.
    pub direction: Direction,
    /// θ/ω.
    first_delay: f64,
    /// 2π/ω.
    period: f64,
    /// Bound on the rounding error of θ/ω.
    phase_error: f64,
    /// Bound on the relative rounding error of ω.
    frequency_error: f64,
}

impl Crossing {
    /// A crossing at ω = `omega` ± `omega_error` with the phase θ = `theta` ± `theta_error`.
    pub(super) fn with_errors(
        omega: f64,
        omega_error: f64,
        theta: f64,
        theta_error: f64,
        direction: Direction,
    ) -> Self {
        let per_omega = 1.0 / omega;
        // If the frequency is unknown, so are all delays.
        let frequency_error = if omega_error < 0.5 * omega {
            omega_error * per_omega / (1.0 - omega_error * per_omega) + 4.0 * UNIT_ROUNDOFF
        } else {
            f64::INFINITY
        };
        Self {
            omega,
            theta,
            first_branch: 0,
            direction,
            first_delay: theta * per_omega,
            period: TAU * per_omega,
            phase_error: (theta_error + 4.0 * UNIT_ROUNDOFF * theta) * per_omega,
            frequency_error,
        }
    }

    /// Whether θ may be 0 or 2π: a pair starts on the axis at τ = 0.
    pub(super) fn starts_at_zero(&self) -> bool {
        let apart = self.first_delay.min((self.period - self.first_delay).abs());
        apart <= self.phase_error + self.frequency_error * self.period
    }

    /// Whether `tau` lies within `part` of a period of a delay of this crossing.
    pub(super) fn near(&self, tau: f64, part: f64) -> bool {
        self.marginal_at(tau, |delay| self.delay_error(delay).max(part * self.period))
    }

    /// Whether `tau` is within the distance of one of the delays that is `allowed` there.
    pub(super) fn marginal_at(&self, tau: f64, allowed: impl Fn(f64) -> f64) -> bool {
        if self.period <= allowed(tau) {
            return true;
        }
        let near = |delay: f64| (tau - delay).abs() <= allowed(delay);
        let next = self.branch_at(tau);
        near(self.delay(next)) || (next > self.first_branch && near(self.delay(next - 1)))
    }

    /// The delay τ_k of branch `k`; 2π/ω from branch to branch.
    #[inline]
    #[must_use]
    pub fn delay(&self, k: u64) -> f64 {
        self.first_delay + self.period * k as f64
    }

    /// 2π/ω, the distance between neighbouring delays.
    #[inline]
    #[must_use]
    pub fn period(&self) -> f64 {
        self.period
    }

    /// A bound on the rounding error of a delay of this crossing near `tau`.
    ///
    /// Large where ω₋ and ω₊ nearly coincide or the gains are tiny: the crossing itself is then
    /// badly conditioned.
    #[inline]
    #[must_use]
    pub fn delay_error(&self, tau: f64) -> f64 {
        self.phase_error + self.frequency_error * tau
    }

    /// The crossing in physical time: the unit of its delays is `time_unit`.
    pub(super) fn scaled(self, time_unit: f64) -> Self {
        Self {
            omega: self.omega / time_unit,
            first_delay: self.first_delay * time_unit,
            period: self.period * time_unit,
            phase_error: self.phase_error * time_unit,
            ..self
        }
    }

    /// The number of crossings at delays smaller than `tau`.
    #[inline]
    #[must_use]
    pub fn count_below(&self, tau: f64) -> u64 {
        self.branch_at(tau) - self.first_branch
    }

    /// The first branch whose delay is at least `tau`.
    #[inline]
    #[must_use]
    pub fn branch_at(&self, tau: f64) -> u64 {
        if self.delay(self.first_branch) >= tau {
            return self.first_branch;
        }
        let estimate = ((tau * self.omega - self.theta) * (1.0 / TAU)).max(0.0);
        if estimate >= FINEST_BRANCH {
            return estimate as u64;
        }
        // The estimate is off by rounding at most; `delay` alone decides, so that every caller
        // agrees.
        let mut k = (estimate as u64).max(self.first_branch);
        while k > self.first_branch && self.delay(k - 1) >= tau {
            k -= 1;
        }
        while self.delay(k) < tau {
            k += 1;
        }
        k
    }
}

/// All crossings of one line: one setting of (b, a_v, a_n), every delay.
///
/// ```
/// use slipmap::linear::Crossings;
/// use slipmap::model::Groups;
///
/// // The letter's Fig. 2(a): velocity control where b = −0.3.
/// let line = Crossings::of(Groups::new(-0.3, -0.33, 0.0));
/// assert_eq!(line.n_unstable(4.15), 0);
/// // Between two crossings of the same pair of roots lies one of its periods 2π/ω.
/// let crossing = line.upper.expect("roots cross the axis");
/// assert_eq!(crossing.delay(1) - crossing.delay(0), crossing.period());
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crossings {
    /// Number of unstable roots at τ = 0⁺.
    pub at_zero_delay: u64,
    /// ω₊, where pairs cross to the right.
    pub upper: Option<Crossing>,
    /// ω₋, where pairs cross to the left.
    pub lower: Option<Crossing>,
    /// The tangency ω₋ = ω₊, where the two cannot be told apart: no crossing, but a touch.
    pub touch: Option<Crossing>,
    /// b = 0: the roots at τ = 0 lie on the imaginary axis.
    pub undamped: bool,
    /// b = 0 without control: the roots lie on the imaginary axis at every delay.
    pub always_marginal: bool,
    /// The unit of time √(M/κ) in which the delays and frequencies are given; 1 for dimensionless
    /// ones.
    pub time_unit: f64,
}

impl Crossings {
    /// The crossings of a line, from the quadratic (1) of the module. Finite groups are assumed;
    /// sizes below 1e-150 are taken for zero.
    #[inline]
    #[must_use]
    pub fn of(groups: Groups) -> Self {
        let groups = Groups::new(
            without_underflow(groups.b),
            without_underflow(groups.a_v),
            without_underflow(groups.a_n),
        );
        let b = groups.b;
        let mut crossings = Self {
            at_zero_delay: unstable_at_zero_delay(groups),
            upper: None,
            lower: None,
            touch: None,
            undamped: b == 0.0,
            always_marginal: b == 0.0 && groups.uncontrolled(),
            time_unit: 1.0,
        };
        if groups.uncontrolled() {
            return crossings;
        }
        let (c, d) = quadratic(groups);
        let discriminant = discriminant(groups);
        // The rounding of the groups themselves counts as well: it matters where c and d cancel.
        let Groups { a_v, a_n, .. } = groups;
        let c_error = ROUNDINGS * UNIT_ROUNDOFF * (b * b + 2.0 * a_n.abs());
        let d_error = ROUNDINGS * UNIT_ROUNDOFF * (b * b + 2.0 * (b * a_v).abs());
        let discriminant_error = 2.0 * c.abs() * c_error + 4.0 * d_error;
        if discriminant.abs() <= discriminant_error {
            let y = f64x2::splat(-0.5 * c);
            let y_error = f64x2::splat(0.5 * discriminant_error.sqrt());
            let x_error = y_error + f64x2::splat(UNIT_ROUNDOFF);
            let arms = Arms::new(groups, (y, y_error), (1.0 + y, x_error));
            crossings.touch = arms.crossing(0, Direction::Touch);
        } else if discriminant > 0.0 {
            let (y, y_error) = roots((c, c_error), d, discriminant.sqrt(), discriminant_error);
            let mut x = (1.0 + y).to_array();
            let mut x_error = (y_error + f64x2::splat(UNIT_ROUNDOFF)).to_array();
            for (small, other) in [(0, 1), (1, 0)] {
                if x[small].abs() < 0.25 && x[other].abs() > 2.0 * x[small].abs() {
                    // Where x is small 1 + y loses digits, even its sign; the product of both zeros
                    // keeps them.
                    x[small] = frequency_product(groups) / x[other];
                    let relative = x_error[other] / x[other].abs() + ROUNDINGS * UNIT_ROUNDOFF;
                    x_error[small] = x[small].abs() * relative;
                }
            }
            let x = (f64x2::from(x), f64x2::from(x_error));
            let arms = Arms::new(groups, (y, y_error), x);
            crossings.upper = arms.crossing(0, Direction::Right);
            crossings.lower = arms.crossing(1, Direction::Left);
        }
        crossings
    }

    /// These crossings in physical time: the dimensionless unit of time is `time_unit` = √(M/κ).
    #[inline]
    #[must_use]
    pub fn in_physical_time(self, time_unit: f64) -> Self {
        let scaled = |crossing: Option<Crossing>| crossing.map(|c| c.scaled(time_unit));
        Self {
            upper: scaled(self.upper),
            lower: scaled(self.lower),
            touch: scaled(self.touch),
            time_unit: self.time_unit * time_unit,
            ..self
        }
    }

    /// The crossings there are, the one to the right first.
    pub fn iter(&self) -> impl Iterator<Item = &Crossing> {
        [&self.upper, &self.lower, &self.touch]
            .into_iter()
            .flatten()
    }
}

/// The number of unstable roots at τ = 0⁺.
///
/// For b ≠ 0 these are the roots of B. For b = 0 the pair ±i moves off the axis with the first
/// order of τ, Re λ ≈ a_n τ/2, or, if a_n = 0, Re λ ≈ a_v τ²/4.
fn unstable_at_zero_delay(groups: Groups) -> u64 {
    let Groups { b, a_v, a_n } = groups;
    let growth = if b != 0.0 {
        -b
    } else if a_n != 0.0 {
        a_n
    } else {
        a_v
    };
    if growth > 0.0 { 2 } else { 0 }
}

/// The numbers of two crossings, computed side by side: the arms ω₊ and ω₋ need the same
/// operations.
struct Arms {
    x: [f64; 2],
    y: [f64; 2],
    undamped: bool,
    omega: [f64; 2],
    theta: [f64; 2],
    first_delay: [f64; 2],
    period: [f64; 2],
    phase_error: [f64; 2],
    frequency_error: [f64; 2],
}

impl Arms {
    /// Equation (2) at x = 1 + y. Where x is not positive the result is meaningless.
    #[inline(always)]
    fn new(groups: Groups, (y, y_error): (f64x2, f64x2), (x, x_error): (f64x2, f64x2)) -> Self {
        let Groups { b, a_v, .. } = groups;
        let omega = x.sqrt();
        let (b_r, b_i) = (-y, b * omega);
        let (a_r, a_i) = (f64x2::splat(groups.feedback(b)), a_v * omega);
        let a_norm_sqr = a_r * a_r + a_i * a_i;
        let sine = a_r * b_i - a_i * b_r;
        let cosine = a_norm_sqr - (a_r * b_r + a_i * b_i);
        let theta = phase(sine, cosine);

        let per_omega = 1.0 / omega;
        let omega_error = 0.5 * x_error * per_omega + 2.0 * UNIT_ROUNDOFF * omega;
        // |A| from below, by its larger part: a bound needs no square root.
        let a_size = a_r.abs().fast_max(a_i.abs());
        let theta_error = (y_error + (b.abs() + 2.0 * a_v.abs()) * omega_error) / a_size
            + f64x2::splat(ROUNDINGS * UNIT_ROUNDOFF);
        let frequency_error = omega_error * per_omega + f64x2::splat(4.0 * UNIT_ROUNDOFF);
        Self {
            x: x.to_array(),
            y: y.to_array(),
            undamped: b == 0.0,
            omega: omega.to_array(),
            theta: theta.to_array(),
            first_delay: (theta * per_omega).to_array(),
            period: (TAU * per_omega).to_array(),
            phase_error: (theta_error * per_omega).to_array(),
            frequency_error: frequency_error.to_array(),
        }
    }

    /// The crossing of one arm, or none where x is not positive.
    #[inline(always)]
    fn crossing(&self, arm: usize, direction: Direction) -> Option<Crossing> {
        (self.x[arm] > 0.0).then(|| Crossing {
            omega: self.omega[arm],
            theta: self.theta[arm],
            first_branch: u64::from(self.undamped && self.y[arm] == 0.0),
            direction,
            first_delay: self.first_delay[arm],
            period: self.period[arm],
            phase_error: self.phase_error[arm],
            frequency_error: self.frequency_error[arm],
        })
    }
}
