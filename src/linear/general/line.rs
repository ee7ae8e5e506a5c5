//! All delays of one setting: where roots cross the imaginary axis, which way, and how many are
//! unstable between.
//!
//! ```text
//! F(x) = |P(i√x)|² − |Q(i√x)|²,   x_j = ω_j² its positive zeros                              (3)
//! s_j = ½[sgn F(x_j+) − sgn F(x_j−)],   θ_j = arg(−Q/P) at iω_j in (0, 2π],
//! τ_{j,k} = (θ_j + 2πk)/ω_j                                                                  (4)
//! n(τ) = n(0⁺) + 2 Σ_j s_j #{k ≥ 0: τ_{j,k} < τ}                                             (5)
//! ```
//!
//! n(0⁺) is found in `zero_delay`; (6) and (7) are in `right_of`. Degenerate
//! cases are answered one by one: a root at 0 for every delay, which a real root may pass once; a
//! zero on the axis that P and Q share; zeros of P + Q on the axis, from which a pair starts at τ =
//! 0.

use std::f64::consts::{PI, TAU};

use super::parts::Angle;
use super::precise::resolve::{Resolver, blurred, is_not_0};
use super::reason::Reason;
use super::system::{Class, System};
use crate::linear::crossing::{Crossing, Direction};
use crate::linear::real_zeros::Switch;

/// The crossings of a line of delays.
#[derive(Debug, Clone, Default)]
pub struct DelayLine {
    /// Number of unstable roots at τ = 0⁺.
    pub at_zero_delay: u64,
    /// Number of roots with Re λ > 0 at τ = 0 itself.
    pub without_delay: u64,
    /// The crossings and touches, by falling frequency.
    pub crossings: Vec<Crossing>,
    /// What is special about the line, if anything.
    pub reason: Option<Reason>,
    /// Whether at every delay a root lies on the imaginary axis.
    pub always_marginal: bool,
    /// Whether roots lie on the imaginary axis at τ = 0.
    pub marginal_at_zero: bool,
    /// The delay at which a real root passes 0: one more is unstable from there on, or one less.
    pub passage: Option<Passage>,
    /// The delay from which on something near the origin may have happened of which rounding does
    /// not tell.
    pub open_from: f64,
    /// Whether there is no count: infinitely many roots are unstable, or the line is refused.
    pub uncounted: bool,
    /// The unit of time; 1 for dimensionless delays.
    pub time_unit: f64,
    /// How many frequencies were computed with many digits, which takes hundreds of times as long.
    pub resolved: u32,
}

/// A real root passes 0, where another one rests at every delay.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Passage {
    /// The delay.
    pub tau: f64,
    /// A bound on its error.
    pub error: f64,
    /// +1 into the right half-plane, −1 out of it.
    pub change: i8,
}

impl DelayLine {
    /// The line of `system`.
    #[must_use]
    pub fn of(system: &System) -> Self {
        let mut line = Self::default();
        line.find(system);
        line
    }

    /// Finds what [`DelayLine::of`] finds, in the memory of this line.
    pub fn find(&mut self, system: &System) {
        let unit = system.time_unit();
        if unit == 1.0 {
            self.find_in_unit(system);
        } else {
            self.find_in_unit(&system.in_unit(unit));
            self.scale(unit);
        }
    }

    fn find_in_unit(&mut self, system: &System) {
        self.clear();
        let without_origin = system.without_common_origin();
        let class = system.class();
        self.reason = class.reason();
        self.uncounted = !matches!(
            class,
            Class::Retarded | Class::Neutral { .. } | Class::NeutralLimit
        );
        if self.uncounted {
            self.find_without_delay(system);
            return;
        }
        if class == Class::NeutralLimit {
            self.always_marginal = true;
        }
        if let Some(rest) = without_origin {
            self.find_in_unit(&rest);
            self.rests_at_origin();
            return;
        }
        if system.uncontrolled() {
            self.find_without_delay(system);
            self.at_zero_delay = self.without_delay;
            self.always_marginal = self.marginal_at_zero;
            if self.always_marginal {
                let origin = !system.p.coefficient(0).decided();
                self.reason = Some(if origin {
                    Reason::RootAtOrigin
                } else {
                    Reason::RootOnAxis
                });
            }
            return;
        }
        self.find_crossings(system);
    }

    /// Whether all crossings are known. What is always marginal for no reason is a line with too
    /// many crossings to list, or without a count to begin with.
    #[must_use]
    pub(in crate::linear) fn crossings_known(&self) -> bool {
        !self.uncounted && (!self.always_marginal || self.reason.is_some())
    }

    pub(super) fn clear(&mut self) {
        let mut crossings = std::mem::take(&mut self.crossings);
        crossings.clear();
        *self = Self {
            crossings,
            open_from: f64::INFINITY,
            time_unit: 1.0,
            ..Self::default()
        };
    }

    fn rests_at_origin(&mut self) {
        self.always_marginal = true;
        self.reason = Some(Reason::RootAtOrigin);
    }

    fn find_crossings(&mut self, system: &System) {
        let on_axis = system.on_axis();
        let (mut resolver, mut settled) = (Resolver::new(system), true);
        let near = system.each_on_axis(&on_axis, |switch, phase| {
            settled &= self.add_crossing(&mut resolver, switch, phase);
        });
        let near = match near {
            Ok(near) => near,
            Err(None) => {
                // Too many to be listed: nothing is said but what holds without delay.
                self.find_without_delay(system);
                self.at_zero_delay = self.without_delay;
                self.always_marginal = true;
                return;
            }
            Err(reason) => {
                self.uncounted = true;
                self.reason = reason;
                return;
            }
        };
        let origin = !on_axis.on_real_axis().decided();
        if system.leaves_origin_out() {
            // Near 0 only a real root passes, which the start of the line finds.
        } else if origin {
            self.rests_at_origin();
        } else {
            self.opens_below(near.open_below);
        }
        self.find_start(system, near, (origin, settled));
    }

    /// Notes that a pair may cross at some τ ≥ π/ω or so, with a frequency below `omega`: |P(0)| =
    /// |Q(0)| within rounding, without a root at 0.
    pub(super) fn opens_below(&mut self, omega: f64) {
        if omega > 0.0 {
            self.open_from = 0.5 * PI / omega;
        }
    }

    /// Adds what is at `switch`; false where the phase there may be 0 as well as 2π.
    fn add_crossing(
        &mut self,
        resolver: &mut Resolver,
        switch: &Switch,
        phase: Option<Angle>,
    ) -> bool {
        let system = resolver.system();
        if switch.sign == 0 && system.has_common_zero(switch.omega, switch.error) {
            self.always_marginal = true;
            self.reason = self.reason.or(Some(Reason::RootOnAxis));
            return true;
        }
        self.add_resolved(resolver, switch, phase)
    }

    /// Adds the crossings at `switch`, with more digits where f64 blurs them; false where the phase
    /// may still be 0 as well as 2π.
    pub(super) fn add_resolved(
        &mut self,
        resolver: &mut Resolver,
        switch: &Switch,
        phase: Option<Angle>,
    ) -> bool {
        let blurred = blurred(resolver.system(), switch, phase.as_ref());
        self.resolved += u32::from(blurred);
        if blurred && let Some(resolved) = resolver.resolve(switch) {
            // Where only the coefficients are uncertain, P Q* itself may tell its argument better.
            let own = phase.filter(|of| switch.simple && is_not_0(of, switch));
            let mut settled = true;
            for found in resolved.iter().flatten() {
                let sharper = own.filter(|own| own.error < found.phase.error);
                settled &= found.decided || sharper.is_some();
                self.add(&found.switch, sharper.or(Some(found.phase)));
            }
            return settled;
        }
        let crossing = self.add(switch, phase);
        !(blurred && crossing.starts_at_zero())
    }

    /// Adds the crossing at `switch`, `phase` being the argument of −P Q* there.
    fn add(&mut self, switch: &Switch, phase: Option<Angle>) -> Crossing {
        let direction = Direction::of_sign(switch.sign);
        let (theta, error) = if let Some(angle) = phase {
            // θ = arg(−Q/P) = −arg(−P Q*).
            (turned(-angle.value), angle.error)
        } else {
            // Nothing is known of the phase: every delay is marginal.
            self.always_marginal = true;
            (PI, TAU)
        };
        let Switch {
            omega,
            error: omega_error,
            ..
        } = *switch;
        let crossing = Crossing::with_errors(omega, omega_error, theta, error, direction);
        self.crossings.push(crossing);
        crossing
    }
}

/// An angle in [−π, π] as one in (0, 2π].
fn turned(angle: f64) -> f64 {
    if angle > 0.0 { angle } else { angle + TAU }
}
