//! Where characteristic roots cross the imaginary axis as the delay grows, in closed form.
//!
//! On λ = iω the letter's Eq. (4), 2 Re(A B*) = |B|², is a quadratic in x = ω². Written in y = x − 1,
//!
//! ```text
//! y² + c y + d = 0,   c = b² + 2 a_n,   d = b (b − 2 a_v),                                  (1)
//! ```
//!
//! so there are at most two crossing frequencies ω₋ < ω₊, whatever τ is. In y rather than x because B = −y + i b ω at a
//! crossing: the delay depends on y, and this form keeps its relative accuracy where y is small. The letter's Eq. (5)
//! then gives the delays,
//!
//! ```text
//! τ_k = (θ + 2πk)/ω,   θ = arg[(|A|² − Re A B*) + i (A_r B_i − A_i B_r)] in [0, 2π),   k = 0, 1, …       (2)
//! ```
//!
//! With growing τ a pair of roots crosses to the right at every τ_k(ω₊) and to the left at every τ_k(ω₋): the sign of
//! dRe λ/dτ there is that of dF/dx, F(x) being the left side of (1).

use std::f64::consts::TAU;

use crate::model::Groups;

/// Half an ulp of 1, the relative error of one rounded operation.
const UNIT_ROUNDOFF: f64 = f64::EPSILON / 2.0;
/// How many rounding errors the closed form may gather; a generous count of its operations.
const ROUNDINGS: f64 = 16.0;

/// Above this branch number neighbouring delays are closer than their rounding errors: all of them are marginal.
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

/// One crossing frequency with all its delays (equation 2 of the module).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crossing {
    /// Crossing frequency ω > 0, in units of √(κ/M).
    pub omega: f64,
    /// Phase θ = ω τ_0 in [0, 2π].
    pub theta: f64,
    /// The first branch k that is a crossing: 1 where θ = 0 exactly (b = 0), else 0.
    pub first_branch: u64,
    /// What the pair does there.
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
    /// Large where ω₋ and ω₊ nearly coincide or the gains are tiny: the crossing itself is then badly conditioned.
    #[inline]
    #[must_use]
    pub fn delay_error(&self, tau: f64) -> f64 {
        self.phase_error + self.frequency_error * tau
    }

    fn scaled(self, time_unit: f64) -> Self {
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
        // The estimate is off by rounding at most; `delay` alone decides, so that every caller agrees.
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
    /// The unit of time √(M/κ) in which the delays and frequencies are given; 1 for dimensionless ones.
    pub time_unit: f64,
}

impl Crossings {
    /// The crossings of a line, from the quadratic (1) of the module. Finite groups are assumed.
    #[inline]
    #[must_use]
    pub fn of(groups: Groups) -> Self {
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
        let discriminant_error = ROUNDINGS * UNIT_ROUNDOFF * (c * c + 4.0 * d.abs());
        if discriminant.abs() <= discriminant_error {
            let y_error = 0.5 * discriminant_error.sqrt();
            crossings.touch = crossing(groups, -0.5 * c, y_error, None, Direction::Touch);
        } else if discriminant > 0.0 {
            let pair = YPair::solve(c, d, discriminant.sqrt(), discriminant_error);
            let product = frequency_product(groups);
            let (x_upper, x_lower) = (1.0 + pair.upper, 1.0 + pair.lower);
            crossings.upper = crossing(
                groups,
                pair.upper,
                pair.upper_error,
                Some((x_lower, product)),
                Direction::Right,
            );
            crossings.lower = crossing(
                groups,
                pair.lower,
                pair.lower_error,
                Some((x_upper, product)),
                Direction::Left,
            );
        }
        crossings
    }

    /// The same crossings with delays in units of time of which `time_unit` = √(M/κ) makes one dimensionless unit.
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

/// c and d of the quadratic (1) of the module.
#[inline]
fn quadratic(groups: Groups) -> (f64, f64) {
    let Groups { b, a_v, a_n } = groups;
    (b.mul_add(b, 2.0 * a_n), b * (b - 2.0 * a_v))
}

/// The discriminant c² − 4d of (1): two crossing frequencies may exist only where it is positive.
#[inline]
#[must_use]
pub fn discriminant(groups: Groups) -> f64 {
    let (c, d) = quadratic(groups);
    c.mul_add(c, -4.0 * d)
}

/// x₊ x₋ = F(0) = 1 − 2(a_n + b a_v): where it changes sign, ω₋ reaches zero and its delays infinity.
#[inline]
#[must_use]
pub fn frequency_product(groups: Groups) -> f64 {
    let Groups { b, a_v, a_n } = groups;
    (-2.0 * b).mul_add(a_v, 1.0 - 2.0 * a_n)
}

/// The number of unstable roots at τ = 0⁺.
///
/// For b ≠ 0 these are the roots of B. For b = 0 the pair ±i moves off the axis with the first order of τ,
/// Re λ ≈ a_n τ/2, or, if a_n = 0, Re λ ≈ a_v τ²/4.
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

/// Both real roots of (1), without cancellation, and bounds on their errors.
struct YPair {
    upper: f64,
    lower: f64,
    upper_error: f64,
    lower_error: f64,
}

impl YPair {
    #[inline]
    fn solve(c: f64, d: f64, root: f64, discriminant_error: f64) -> Self {
        // The root of larger size first, then the other from the product d.
        let large = -0.5 * (c + root.copysign(c));
        let small = d / large;
        let large_error =
            0.25 * discriminant_error / root + ROUNDINGS * UNIT_ROUNDOFF * large.abs();
        let small_error = small.abs() * (large_error / large.abs() + ROUNDINGS * UNIT_ROUNDOFF);
        if c.is_sign_positive() {
            Self {
                upper: small,
                lower: large,
                upper_error: small_error,
                lower_error: large_error,
            }
        } else {
            Self {
                upper: large,
                lower: small,
                upper_error: large_error,
                lower_error: small_error,
            }
        }
    }
}

/// The crossing at x = 1 + y > 0, or none. `vieta` = (the other x, the product of both) serves where x is small.
#[inline(always)]
fn crossing(
    groups: Groups,
    y: f64,
    y_error: f64,
    vieta: Option<(f64, f64)>,
    direction: Direction,
) -> Option<Crossing> {
    let Groups { b, a_v, a_n } = groups;
    let x = match vieta {
        Some((other, product)) if 1.0 + y < 0.25 && other > 0.25 => product / other,
        _ => 1.0 + y,
    };
    if x.is_nan() || x <= 0.0 {
        return None;
    }
    let omega = x.sqrt();
    let (b_r, b_i) = (-y, b * omega);
    let (a_r, a_i) = (a_v.mul_add(b, a_n), a_v * omega);
    let a_norm_sqr = a_r * a_r + a_i * a_i;
    let sine = a_r * b_i - a_i * b_r;
    let cosine = a_norm_sqr - (a_r * b_r + a_i * b_i);
    let theta = phase(sine, cosine);

    let per_omega = 1.0 / omega;
    let omega_error = 0.5 * y_error * per_omega + 2.0 * UNIT_ROUNDOFF * omega;
    // |A| from below, by its larger part: a bound needs no square root.
    let a_size = a_r.abs().max(a_i.abs());
    let theta_error =
        (y_error + (b.abs() + 2.0 * a_v.abs()) * omega_error) / a_size + ROUNDINGS * UNIT_ROUNDOFF;
    Some(Crossing {
        omega,
        theta,
        first_branch: u64::from(b == 0.0 && y == 0.0),
        direction,
        first_delay: theta * per_omega,
        period: TAU * per_omega,
        phase_error: theta_error * per_omega,
        frequency_error: omega_error * per_omega + 4.0 * UNIT_ROUNDOFF,
    })
}

/// The argument of `cosine` + i `sine` in [0, 2π].
///
/// A phase that is negative by less than rounding comes out as 2π, which is right: the crossing at τ = 0⁻ is none, the one
/// a turn later is. The exact zero comes out as 0.
#[inline]
fn phase(sine: f64, cosine: f64) -> f64 {
    let angle = sine.atan2(cosine);
    if angle < 0.0 { angle + TAU } else { angle }
}
