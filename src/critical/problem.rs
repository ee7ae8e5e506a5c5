//! The question and the answer: a controlled oscillator, and its critical velocity.

use super::options::{Options, RampOptions};
use super::transition::Transition;
use crate::linear::{Count, MarginalTolerance};
use crate::model::law::Kind;
use crate::model::stop::Stop;
use crate::model::{Dashpots, Feedback, FrictionLaw, Groups};
use crate::slip::motion::{Accuracy, Motion, Parameters};
use crate::slip::sliding::Sliding;

/// A controlled oscillator whose critical velocity is asked for, in the units of
/// [`crate::slip::motion`].
#[derive(Debug, Clone, PartialEq)]
pub struct Problem {
    /// The friction law.
    pub law: FrictionLaw,
    /// N0/√(κM), the unit of velocity in which the law's speeds are given.
    pub velocity_unit: f64,
    /// d and g, the dashpots beside the spring and to the ground, in units of √(κM).
    pub dashpots: Dashpots,
    /// The feedback, without lags.
    pub feedback: Feedback,
    /// A flag that ends the search; its answer is then meaningless.
    pub stop: Stop,
    /// The options of the search.
    pub options: Options,
}

impl Problem {
    /// The problem of this law and this feedback where M = κ = N0 = 1, with the options that all
    /// searches have.
    #[must_use]
    pub fn new(law: FrictionLaw, feedback: Feedback) -> Self {
        Self {
            law,
            velocity_unit: 1.0,
            dashpots: Dashpots::default(),
            feedback,
            stop: Stop::default(),
            options: Options::default(),
        }
    }

    /// A motion's parameters at `v0`, with control from `switch_on` on.
    #[must_use]
    pub fn at(&self, v0: f64, switch_on: f64) -> Parameters {
        Parameters {
            law: self.law.clone(),
            velocity_unit: self.velocity_unit,
            dashpots: self.dashpots,
            feedback: self.feedback,
            v0,
            switch_on: match self.feedback.gains.act() {
                true => switch_on,
                false => f64::INFINITY,
            },
        }
    }

    /// A block at rest at `v0`, under control from t = 0 on.
    pub(super) fn at_rest(&self, v0: f64, accuracy: Accuracy) -> Motion {
        Motion::new(self.at(v0, 0.0), accuracy, 0.0, 0.0).heeding(self.stop.clone())
    }

    /// A block under control that is released at t = 0 from a stick without memory at `v0`.
    pub(super) fn released(&self, v0: f64, accuracy: Accuracy) -> Motion {
        let mut motion = self.at_rest(v0, accuracy);
        motion.release_from(self.law.mu_s() - self.dashpots.damping * v0);
        motion
    }

    /// The result of `begin` at the first of the protocol's start velocities at which it has one.
    /// After lift-off only smaller ones are tried, since the smallest v0 of lift-off is asked for.
    /// None is below the smallest v.
    pub(super) fn at_first_start<T>(
        &self,
        mut begin: impl FnMut(f64) -> Result<T, NoStart>,
    ) -> Option<T> {
        let mut lift_off = f64::INFINITY;
        for start in self.options.ramp.starts {
            let v0 = (start * self.law.mu_s()).max(self.feedback.limits.velocity[0]);
            if v0 > lift_off {
                continue;
            }
            match begin(v0) {
                Ok(found) => return Some(found),
                Err(NoStart::LiftOff) => lift_off = v0,
                Err(NoStart::NotSustained) => {}
            }
        }
        None
    }

    /// How many times as long velocity control makes a stick that is much longer than a delay.
    ///
    /// The spring is pulled at ȧ = v0 + α_v S there, which goes to v0/(1 − α_v τ/(1 − R)).
    pub(super) fn slower(&self) -> f64 {
        let Feedback {
            gains,
            tau,
            channel,
            ..
        } = self.feedback;
        let share = gains.alpha_v * tau / (1.0 - channel.memory);
        (1.0 - share).max(1.0)
    }

    /// How long a stick has to last to erase the past. None where no stick erases it: under
    /// velocity control, and with memory.
    pub(super) fn erasing_stick(&self) -> Option<f64> {
        let Feedback {
            gains,
            tau,
            channel,
            ..
        } = self.feedback;
        let erased = gains.alpha_v == 0.0 && (channel.memory == 0.0 || gains.alpha_n == 0.0);
        erased.then_some(match gains.alpha_n == 0.0 {
            true => tau,
            false => tau + channel.latency,
        })
    }

    /// How long to wait for a motion's outcome at `v0`, by these options: transients, many delays,
    /// and many of the longest cycles.
    pub(super) fn patience(&self, v0: f64, options: &RampOptions) -> f64 {
        let longest_cycle = 2.0 * self.law.mu_s() * self.slower() / v0 + 10.0;
        let [always, delays, cycles] = options.patience;
        always + delays * self.feedback.remembered() + cycles * longest_cycle
    }

    /// The largest v0 at which stick-slip is looked for.
    pub(crate) fn v_max(&self) -> f64 {
        let [_, most] = self.feedback.limits.velocity;
        (self.options.ramp.v_max * self.law.mu_s()).min(most)
    }

    /// The groups of linear stability at `v0`.
    #[must_use]
    pub fn groups(&self, v0: f64) -> Groups {
        let speed = v0 * self.velocity_unit;
        let plain = Groups::new(
            self.law.mu_prime(speed) * self.velocity_unit + self.dashpots.sum(),
            self.feedback.gains.alpha_v,
            self.law.mu_k(speed) * self.feedback.gains.alpha_n,
        );
        plain.coupled(self.dashpots.damping)
    }

    /// The number of unstable roots of sliding at `v0`.
    #[must_use]
    pub fn count(&self, v0: f64) -> Count {
        self.sliding(v0).count(MarginalTolerance::default())
    }

    /// Sliding at `v0`.
    #[must_use]
    pub fn sliding(&self, v0: f64) -> Sliding {
        Sliding {
            groups: self.groups(v0),
            tau: self.feedback.tau,
            channel: self.feedback.channel,
            sample_time: self.feedback.readings.sample_time,
        }
    }

    /// The spectral abscissa of sliding at `v0`, if it is stable.
    #[must_use]
    pub fn stable_abscissa(&self, v0: f64) -> Option<f64> {
        let abscissa = self.sliding(v0).stable_abscissa();
        abscissa.filter(|abscissa| *abscissa < 0.0)
    }

    /// Without control, under Coulomb friction, stick-slip persists at every v0: a slip from a =
    /// μ_S goes half round the circle about sliding and comes to a stop at a = 2 μ_K − μ_S, where
    /// the block sticks.
    pub(super) fn persists_without_control(&self) -> bool {
        let mu_s = self.law.mu_s();
        !self.feedback.gains.act()
            && self.dashpots == Dashpots::default()
            && matches!(self.law.kind(), Kind::Coulomb(law) if law.mu0 < mu_s)
    }
}

/// Why a search cannot begin at a start velocity.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum NoStart {
    /// N ≤ 0.
    LiftOff,
    /// Stick-slip is not sustained at the start velocity.
    NotSustained,
}

/// The method that gave a critical velocity.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Method {
    /// The return map without memory, at its graze or at its lift-off.
    GrazeSlip,
    /// The return map with its history, at its graze, at its lift-off or where its stick vanishes.
    GrazeOrbit,
    /// Simulation while v0 is raised, see [`super::by_simulation`].
    Simulation,
}

impl Method {
    /// All methods, in the order of their numbers in a map.
    pub const ALL: [Self; 3] = [Self::GrazeSlip, Self::GrazeOrbit, Self::Simulation];

    /// The name in maps and messages.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::GrazeSlip => "graze-slip",
            Self::GrazeOrbit => "graze-orbit",
            Self::Simulation => "simulation",
        }
    }
}

/// The critical velocity of a problem, in the units of [`crate::slip::motion`]; NaN stands for a
/// number that does not exist.
///
/// ```
/// use slipmap::critical::{Problem, critical_velocity};
/// use slipmap::model::{Feedback, FrictionLaw};
///
/// // The letter's Fig. 3(a).
/// let law = FrictionLaw::weakening(0.5, 0.5, 1.0)?;
/// let found = critical_velocity(&Problem::new(law, Feedback::new(-0.33, 0.0, 4.15)));
/// assert!(found.decided && found.vc_lower <= found.vc && found.vc <= found.vc_upper);
/// # Ok::<(), slipmap::model::ModelError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CriticalVelocity {
    /// The largest v0 at which stick-slip persists; 0 where it never does.
    pub vc: f64,
    /// A lower bound of v_c: stick-slip persisted up to beyond it by every step size that was
    /// tried, and a margin is left for still slower ones. v_c itself where that is decided,
    /// `v_liftoff` where the model ends, the end of the range where stick-slip persists. NaN where
    /// lift-off comes before any stick-slip.
    pub vc_lower: f64,
    /// An upper bound of v_c: of the v0 tried above the ends of slow searches, the smallest at
    /// which stick-slip was lost from every phase of its cycle, or ended by lift-off. v_c or
    /// `v_liftoff` where that is decided. NaN where neither was seen up to the end of the range,
    /// and where slow searches disagree on lift-off.
    pub vc_upper: f64,
    /// How stick-slip ends at v_c.
    pub transition: Transition,
    /// The method that gave the answer.
    pub method: Method,
    /// The smallest v0 at which N ≤ 0 occurs, where lift-off ends stick-slip.
    pub v_liftoff: f64,
    /// Time stuck in a period at v_c.
    pub stick_time: f64,
    /// Time in slip in a period at v_c.
    pub slip_time: f64,
    /// The smallest N at v_c.
    pub n_min: f64,
    /// Whether stick-slip was sustained at any v0 that was tried.
    pub sustained: bool,
    /// Whether the motion beyond v_c is known, and all searches that were made agree.
    pub decided: bool,
}

impl CriticalVelocity {
    /// The v0 at which stick-slip ends, or the model with it; NaN where it persists.
    #[must_use]
    pub fn end_of_stick_slip(&self) -> f64 {
        match self.transition {
            Transition::LiftOff => self.v_liftoff,
            _ => self.vc,
        }
    }

    /// The smallest v0 above which stick-slip is known not to survive; NaN where there is none, or
    /// the model ends there.
    #[must_use]
    pub fn free_above(&self) -> f64 {
        match self.transition {
            Transition::LiftOff => f64::NAN,
            _ => self.vc_upper,
        }
    }

    /// A decided answer bounded by itself, where v0 was searched up to `v_max`.
    pub(super) fn bounded_by_itself(self, v_max: f64) -> Self {
        let end = match self.sustained || self.transition == Transition::Never {
            true => self.end_of_stick_slip(),
            false => f64::NAN,
        };
        let persists = self.transition == Transition::Persists;
        Self {
            vc_lower: if persists { v_max } else { end },
            vc_upper: end,
            ..self
        }
    }

    /// The answer where v0 may not exceed the largest v of `problem`: stick-slip that lasts until
    /// there persists.
    pub(super) fn within_limits(self, problem: &Problem) -> Self {
        let [_, most] = problem.feedback.limits.velocity;
        if most == f64::INFINITY || self.vc_lower.is_nan() || self.vc_lower < most {
            return self;
        }
        Self::nothing(f64::NAN, Transition::Persists, self.method).bounded_by_itself(most)
    }

    /// Whether `other` has the same end of stick-slip: at v_c, or the velocity of lift-off, within
    /// [`GRAZE_PRECISION`].
    ///
    /// Lift-off, persistence and the lack of stick-slip have to be the same in both. The other
    /// kinds of end are not compared: they are told from the last v0 that holds stick-slip alone,
    /// and cycles need not repeat there yet.
    #[must_use]
    pub fn ends_like(&self, other: &Self) -> bool {
        let near =
            |a: f64, b: f64| a.is_nan() && b.is_nan() || (a - b).abs() <= GRAZE_PRECISION * a.abs();
        let apart = |of: Transition| {
            matches!(
                of,
                Transition::LiftOff | Transition::Persists | Transition::Never
            )
        };
        let alike = self.transition == other.transition
            || !apart(self.transition) && !apart(other.transition);
        alike && near(self.vc, other.vc) && near(self.v_liftoff, other.v_liftoff)
    }

    /// The end at `vc`, of which nothing more is known.
    pub(super) fn nothing(vc: f64, transition: Transition, method: Method) -> Self {
        Self {
            vc,
            vc_lower: vc,
            vc_upper: vc,
            transition,
            method,
            v_liftoff: f64::NAN,
            stick_time: f64::NAN,
            slip_time: f64::NAN,
            n_min: f64::NAN,
            sustained: transition != Transition::Never,
            decided: true,
        }
    }

    /// The answer where N ≤ 0 from `v0` on.
    pub(super) fn of_lift_off(v0: f64, method: Method) -> Self {
        Self {
            vc_lower: v0,
            vc_upper: v0,
            v_liftoff: v0,
            n_min: 0.0,
            ..Self::nothing(f64::NAN, Transition::LiftOff, method)
        }
    }
}

/// The critical velocity with all windows of v0 in which stick-slip survives.
#[derive(Debug, Clone, PartialEq)]
pub struct CriticalWindows {
    /// v_c, and how stick-slip ends there.
    pub critical: CriticalVelocity,
    /// The windows of v0 in which stick-slip survives, up to the largest v0 that is tried: from and
    /// to, increasing. The last one may end at v_c, where N ≤ 0 occurs, or with the range.
    pub windows: Vec<[f64; 2]>,
}

/// Two answers for v_c are the same within this, relative: it is known to about this, whatever the
/// method.
pub const GRAZE_PRECISION: f64 = 1e-4;

#[cfg(test)]
mod tests {
    use super::super::synthetic::{letters, problem};
    use super::*;
    use crate::slip::motion::{Event, Mode};

    #[test]
    fn sliding_of_figure_3_is_counted() {
        let figure = letters(-0.33, 0.0, 4.15);
        assert!(figure.count(0.35).stable());
        assert!(
            figure
                .stable_abscissa(0.35)
                .is_some_and(|abscissa| abscissa < 0.0)
        );
        let shorter = letters(-0.33, 0.0, 1.0);
        assert!(!shorter.count(0.35).stable() && shorter.stable_abscissa(0.35).is_none());
        let groups = figure.groups(0.35);
        assert!((groups.a_v + 0.33).abs() < 1e-15 && groups.b < 0.0 && groups.a_n == 0.0);
    }

    #[test]
    fn control_acts_only_where_there_is_a_gain() {
        assert_eq!(letters(-0.33, 0.0, 1.0).at(0.3, 2.0).switch_on, 2.0);
        assert_eq!(letters(0.0, 0.0, 1.0).at(0.3, 2.0).switch_on, f64::INFINITY);
    }

    #[test]
    fn coulomb_friction_without_control_keeps_stick_slip() {
        let coulomb = |mu0: f64, alpha_n: f64| {
            let law = FrictionLaw::coulomb(mu0, 1.0).unwrap();
            problem(law, 0.0, alpha_n, 1.0).persists_without_control()
        };
        assert!(coulomb(0.5, 0.0) && !coulomb(0.5, -0.1) && !coulomb(1.0, 0.0));
        assert!(!letters(0.0, 0.0, 1.0).persists_without_control());
    }

    #[test]
    fn low_velocities_are_waited_for_longer() {
        let problem = letters(-0.33, 0.0, 4.0);
        // 600 and 20 delays, and 30 cycles of 2 μ_S/v0 (1 − α_v τ) and 10.
        assert!(
            (problem.patience(0.1, &problem.options.ramp) - (680.0 + 30.0 * (20.0 * 2.32 + 10.0)))
                .abs()
                < 1e-9
        );
    }

    /// While a block sticks for long its spring is pulled at v0/(1 − α_v τ).
    #[test]
    fn velocity_control_makes_sticks_longer() {
        for (alpha_v, tau, v0) in [(-1.0, 2.0, 1e-3), (-0.33, 4.15, 1e-4)] {
            let problem = letters(alpha_v, 0.0, tau);
            let mut motion = problem.released(v0, Accuracy::of(1e-8));
            while motion.mode() != Mode::Stick {
                motion.advance(f64::INFINITY);
            }
            // Until the slip before has left the delay, and its echoes have faded.
            let until = motion.t + 10.0 * tau;
            while motion.t < until {
                motion.advance(until);
            }
            let stuck = (motion.t, motion.a);
            while motion.advance(f64::INFINITY) != Some(Event::Release) {}
            let pulled = (motion.a - stuck.1) / (motion.t - stuck.0);
            assert!(
                (pulled * problem.slower() / v0 - 1.0).abs() < 0.1,
                "{pulled} {v0}"
            );
        }
        assert_eq!(letters(0.5, 0.0, 1.0).slower(), 1.0);
        assert_eq!(letters(0.0, -3.0, 1.0).slower(), 1.0);
    }

    #[test]
    fn answers_are_compared_at_v_c_or_at_lift_off() {
        let of =
            |vc: f64, transition| CriticalVelocity::nothing(vc, transition, Method::Simulation);
        let graze = of(0.3, Transition::Grazing);
        assert!(graze.ends_like(&of(0.30002, Transition::Fold)));
        assert!(!graze.ends_like(&of(0.3001, Transition::Grazing)));
        assert!(!graze.ends_like(&of(f64::NAN, Transition::Persists)));
        let lifted = CriticalVelocity::of_lift_off(0.2, Method::GrazeOrbit);
        assert!(lifted.ends_like(&CriticalVelocity::of_lift_off(0.20001, Method::Simulation)));
        assert!(!lifted.ends_like(&graze) && !graze.ends_like(&lifted));
        assert_eq!(
            (lifted.end_of_stick_slip(), graze.end_of_stick_slip()),
            (0.2, 0.3)
        );
        let never = of(0.0, Transition::Never);
        assert!(!never.sustained && graze.sustained && never.ends_like(&never));
    }
}
