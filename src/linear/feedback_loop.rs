//! The feedback loop about steady sliding, as a system.
//!
//! ```text
//! D = B(1 − R E) − A e^(−λδ)(1 − E),   E = e^(−λτ)                                           (1)
//! B = B₀ L_a L_v L_s,   A = a_n N₀ L_v + a_v V₀ L_a,   L = 1 + Tλ                            (2)
//! B₀ = λ² + bλ + 1,   N₀ = 1,   V₀ = b − d + λ                                               (3)
//! B₀ = (1 + Tλ)(λ² + (d + g)λ + 1) + fλ,   N₀ = 1 + (1 − c)Tλ                                (4)
//! V₀ = f + (λ + g)(1 + Tλ),   f = α − β + αTλ
//! ```
//!
//! The load follows its command with the lag T_a, the pulling velocity with T_v, and the sensor
//! follows the elongation with T_s. Each lag divides the signal by 1 + Tλ. (3) is the letter's
//! friction, with b and a_v of [`crate::model::Groups`], b with both dashpots, and a_n = μ_K α_N/κ
//! itself: the dashpot d beside the spring, which feels the pulling velocity, is in V₀. (4) is
//! friction with a state, with α, β, T and c of [`crate::model::StateGroups`]; g is the dashpot to
//! the ground. Times are in units of √(M/κ).

use num_complex::Complex64;

use super::characteristic::late;
use super::general::{Polynomial, Source, System};
use crate::model::groups::open_loop_coefficients;
use crate::model::{Channel, Dashpots, Groups, Lags, StateGroups};

/// The block on its spring with friction: (3) for the letter's law, (4) for one with a state.
#[derive(Debug, Clone, Copy)]
pub struct Friction {
    /// B₀.
    open: Polynomial,
    /// N₀: the effect of a change of the load on the block.
    load: Polynomial,
    /// V₀: the effect of a change of the pulling velocity.
    velocity: Polynomial,
    /// b of the letter's friction.
    slope: Option<f64>,
    /// d.
    damping: f64,
}

/// A feedback loop, (1) and (2).
#[derive(Debug, Clone, Copy)]
pub struct FeedbackLoop {
    /// B.
    open: Polynomial,
    /// N₀ L_v.
    load: Polynomial,
    /// V₀ L_a.
    velocity: Polynomial,
    /// L_a, L_v and L_a L_v L_s.
    passing: LagPolynomials,
    /// b of the letter's friction.
    slope: Option<f64>,
    damping: f64,
    a_v: f64,
    a_n: f64,
    channel: Channel,
    lags: Lags,
}

/// Lags as polynomials in λ.
#[derive(Debug, Clone, Copy)]
pub(super) struct LagPolynomials {
    /// L_a.
    pub load: Polynomial,
    /// L_v.
    pub velocity: Polynomial,
    /// L_a L_v L_s.
    pub all: Polynomial,
}

impl LagPolynomials {
    pub(super) fn of(lags: &Lags) -> Self {
        let [load, velocity, sensor] = lags.times().map(|time| polynomial(&[1.0, time]));
        Self {
            load,
            velocity,
            all: times(&times(&load, &velocity), &sensor),
        }
    }
}

/// Derivatives of D with respect to the dimensionless groups.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PerGroup {
    /// ∂D/∂b; 0 for friction with a state.
    pub b: Complex64,
    /// ∂D/∂a_v.
    pub a_v: Complex64,
    /// ∂D/∂a_n.
    pub a_n: Complex64,
}

impl PerGroup {
    /// Derivatives that are not known: NaN.
    pub(crate) const UNKNOWN: Self = {
        let unknown = Complex64::new(f64::NAN, f64::NAN);
        Self {
            b: unknown,
            a_v: unknown,
            a_n: unknown,
        }
    };
}

/// Degrees here are at most 6.
const LOW: &str = "a low degree";

/// The polynomial of these coefficients, the constant first.
pub(super) fn polynomial(coefficients: &[f64]) -> Polynomial {
    Polynomial::new(coefficients).expect(LOW)
}

/// The product of two polynomials.
pub(super) fn times(one: &Polynomial, other: &Polynomial) -> Polynomial {
    if other.coefficients() == [1.0] && other.errors() == [0.0] {
        // No lag.
        return *one;
    }
    one.times(other).expect(LOW)
}

impl Friction {
    /// Friction with a state, (4).
    #[must_use]
    pub(crate) fn of_state(groups: StateGroups, dashpots: Dashpots) -> Self {
        let StateGroups {
            direct,
            evolution,
            state_time,
            load_memory,
        } = groups;
        let number = |value: f64| Polynomial::constant(value, 0.0);
        let state = times(&number(state_time), &Polynomial::variable());
        // α − β + αTλ.
        let effect = number(direct).plus(&number(evolution), -1.0);
        let effect = effect.plus(&times(&number(direct), &state), 1.0);
        let moving = times(
            &polynomial(&[dashpots.viscous, 1.0]),
            &number(1.0).plus(&state, 1.0),
        );
        let oscillator = times(
            &polynomial(&open_loop_coefficients(dashpots.sum())),
            &number(1.0).plus(&state, 1.0),
        );
        let kept = number(1.0).plus(&number(load_memory), -1.0);
        Self {
            open: oscillator.plus(&times(&effect, &Polynomial::variable()), 1.0),
            load: number(1.0).plus(&times(&kept, &state), 1.0),
            velocity: effect.plus(&moving, 1.0),
            slope: None,
            damping: dashpots.damping,
        }
    }

    /// The letter's friction, (3), with the dashpot d beside the spring.
    #[must_use]
    pub(crate) fn of_slope(b: f64, damping: f64) -> Self {
        Self {
            open: polynomial(&open_loop_coefficients(b)),
            load: polynomial(&[1.0]),
            velocity: polynomial(&[b - damping, 1.0]),
            slope: Some(b),
            damping,
        }
    }
}

impl FeedbackLoop {
    /// A loop with the gains a_v and a_n, the latter without what a dashpot takes off it.
    #[must_use]
    pub fn new(friction: Friction, a_v: f64, a_n: f64, channel: Channel, lags: Lags) -> Self {
        let passing = LagPolynomials::of(&lags);
        Self {
            open: times(&friction.open, &passing.all),
            load: times(&friction.load, &passing.velocity),
            velocity: times(&friction.velocity, &passing.load),
            passing,
            slope: friction.slope,
            damping: friction.damping,
            a_v,
            a_n,
            channel,
            lags,
        }
    }

    /// The loop of the letter's friction with these groups, of an undamped spring: a damped one has
    /// the same equation where nothing lags.
    #[must_use]
    pub(crate) fn of_letter(groups: Groups, channel: Channel, lags: Lags) -> Self {
        let Groups { b, a_v, a_n } = groups;
        Self::new(Friction::of_slope(b, 0.0), a_v, a_n, channel, lags)
    }

    /// B and A.
    #[must_use]
    pub(crate) fn polynomials(&self) -> [Polynomial; 2] {
        let load = Polynomial::ZERO.plus(&self.load, self.a_n);
        [self.open, load.plus(&self.velocity, self.a_v)]
    }

    /// The system of the loop.
    #[must_use]
    pub fn system(&self) -> System {
        let [open, gain] = self.polynomials();
        let system = System::feedback(open, gain, self.channel);
        match self.slope {
            Some(b) => system.known_by(Source {
                groups: Groups::new(b, self.a_v, self.a_n),
                damping: self.damping,
                lags: self.lags,
            }),
            None => system,
        }
    }

    /// Derivatives of D at λ; `difference` is 1 − E.
    #[must_use]
    pub(crate) fn per_group(&self, lambda: Complex64, difference: Complex64) -> PerGroup {
        let at = |polynomial: &Polynomial| polynomial.value(lambda);
        let Channel { memory, latency } = self.channel;
        let remembered = 1.0 - memory * (1.0 - difference);
        let acting = match latency {
            0.0 => difference,
            latency => difference * late(latency, lambda),
        };
        // ∂B/∂b = λ L_a L_v L_s and ∂V/∂b = L_a.
        let of_slope = || {
            let open = lambda * at(&self.passing.all) * remembered;
            open - self.a_v * at(&self.passing.load) * acting
        };
        PerGroup {
            b: self.slope.map_or(Complex64::ZERO, |_| of_slope()),
            a_v: -at(&self.velocity) * acting,
            a_n: -at(&self.load) * acting,
        }
    }
}
