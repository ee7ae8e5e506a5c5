//! A motion in physical units: its initial value problem, and its summary.

use super::cycle::{NoCycle, UncontrolledCycle, after_release, restart_after_release};
use super::motion::{Accuracy, Motion, Parameters};
use super::outcome::{Limits, Observer, Summary};
use super::programme::Programme;
use super::record::NoRecursion;
use super::return_map::Controller;
use super::sliding::Sliding;
use super::watch::{REPEATED, follow};
use crate::model::{Control, Feedback, FrictionLaw, ModelError, Oscillator, SlidingPoint};
use crate::text::Shown;

/// An initial value problem of the letter's Eqs. (1) and (2), in physical units.
///
/// ```
/// use slipmap::model::{Feedback, FrictionLaw, Oscillator};
/// use slipmap::slip::case::{Case, Start};
/// use slipmap::slip::motion::Accuracy;
/// use slipmap::slip::outcome::Outcome;
/// use slipmap::slip::programme::Programme;
///
/// // The letter's Fig. 3(a): control is switched on at t = 40 and ends stick-slip.
/// let case = Case {
///     oscillator: Oscillator::default(),
///     law: FrictionLaw::weakening(0.5, 0.5, 1.0)?,
///     feedback: Feedback::new(-0.33, 0.0, 4.15),
///     v0: 0.35,
///     programme: Programme::default(),
///     switch_on: 40.0,
///     start: Start::State { x_dot0: 0.0, a0: 0.0 },
///     horizon: 4000.0,
///     steps: 1_000_000,
///     accuracy: Accuracy::default(),
/// };
/// let summary = case.run(&mut ())?;
/// assert_eq!(summary.outcome, Outcome::Sliding);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Case {
    /// Mass, stiffness, load.
    pub oscillator: Oscillator,
    /// The friction law.
    pub law: FrictionLaw,
    /// The feedback, without lags.
    pub feedback: Feedback,
    /// Pulling velocity, at t = 0 where it follows a programme.
    pub v0: f64,
    /// The pulling velocity in time; without corners it stays what it is.
    pub programme: Programme,
    /// When control is switched on; +∞ for never. Without gains it never is.
    pub switch_on: f64,
    /// The block at t = 0 and before.
    pub start: Start,
    /// The time until which the motion is followed.
    pub horizon: f64,
    /// The most steps.
    pub steps: u64,
    /// The integrator and its tolerance.
    pub accuracy: Accuracy,
}

/// The block at t = 0, and its elongation before.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Start {
    /// Any state.
    State {
        /// ẋ at t = 0.
        x_dot0: f64,
        /// Elongation at t = 0 and before.
        a0: f64,
    },
    /// Just released from stick, after uncontrolled stick-slip. `switch_on` is then a phase: it
    /// counts modulo the period.
    AfterRelease,
}

/// Why a case has no motion.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum CaseError {
    /// A value is out of range.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// It has no uncontrolled cycle to start from.
    #[error("{}", match .0 {
        NoCycle::NoStickSlip => "switch_on_phase needs stick-slip without control, and there is \
            none at this v0",
        NoCycle::LongDelay => "switch_on_phase: tau is longer than 10000 cycles of stick-slip, or \
            than the past that is kept",
    })]
    NoCycle(NoCycle),
    /// Readings at such times do not tell the velocity to control by the return map.
    #[error(
        "sample_time = {}: such readings do not tell the velocity, which control by the \
         return map needs; those from {} to {} do",
        Shown(*.given), Shown(.told[0]), Shown(.told[1])
    )]
    SampleTime {
        /// The time that is given.
        given: f64,
        /// The shortest and the longest time that tells it, at every v0.
        told: [f64; 2],
    },
    /// What is fed back, or limits it, beside control by the return map.
    #[error("{name} = {} does not go with control by the return map", Shown(*.value))]
    BesideReturnMap {
        /// The name of the parameter.
        name: &'static str,
        /// Its value.
        value: f64,
    },
    /// A record does not tell the return map.
    #[error("record: {0}")]
    NoRecursion(#[from] NoRecursion),
}

/// The units in which a [`Motion`] computes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CaseUnits {
    /// √(M/κ).
    pub time: f64,
    /// N0/κ.
    pub length: f64,
    /// N0/√(κM).
    pub velocity: f64,
    /// N0.
    pub force: f64,
}

impl CaseUnits {
    /// The units of an oscillator.
    #[must_use]
    pub fn of(oscillator: &Oscillator) -> Self {
        let force = oscillator.normal_load();
        Self {
            time: oscillator.time_unit(),
            length: force / oscillator.stiffness(),
            velocity: oscillator.velocity_unit(),
            force,
        }
    }
}

impl Case {
    /// The units of its motion.
    #[must_use]
    pub fn units(&self) -> CaseUnits {
        CaseUnits::of(&self.oscillator)
    }

    /// The elongation of sliding at v0 under the load N0.
    #[must_use]
    pub(crate) fn sliding_elongation(&self) -> f64 {
        let friction = self.law.mu_k(self.v0) * self.oscillator.normal_load();
        let viscous = self.oscillator.dashpots().viscous * self.v0;
        (friction + viscous) / self.oscillator.stiffness()
    }

    /// The block at t = 0.
    ///
    /// # Errors
    /// When a value is not finite or out of its range, or there is no uncontrolled cycle to start
    /// from.
    pub fn motion(&self) -> Result<Motion, CaseError> {
        self.check()?;
        let p = self.steered(self.parameters())?;
        let mut motion = match self.start {
            Start::State { x_dot0, a0 } => {
                let (u, a) = self.dimensionless(x_dot0, a0);
                Motion::new(p, self.accuracy, u, a)
            }
            Start::AfterRelease => {
                after_release(&p, self.accuracy, p.switch_on)
                    .map_err(CaseError::NoCycle)?
                    .0
            }
        };
        self.programme(&mut motion);
        Ok(motion)
    }

    /// Sets `motion`, which is at its start, on the programme.
    fn programme(&self, motion: &mut Motion) {
        let units = self.units();
        motion.follow_programme(self.programme.over(units.time, units.velocity));
    }

    /// The pulling velocity in the end, after the programme.
    #[must_use]
    pub fn last_v0(&self) -> f64 {
        self.programme.last().map_or(self.v0, |corner| corner.v0)
    }

    /// Begins the motion of this case, as [`Case::motion`] does, in the memory of another motion.
    /// After an error that motion is meaningless.
    ///
    /// # Errors
    /// As [`Case::motion`].
    pub fn restart(&self, motion: &mut Motion) -> Result<(), CaseError> {
        self.check()?;
        let p = self.steered(self.parameters())?;
        match self.start {
            Start::State { x_dot0, a0 } => {
                let (u, a) = self.dimensionless(x_dot0, a0);
                motion.restart(p, self.accuracy, u, a);
            }
            Start::AfterRelease => {
                restart_after_release(motion, &p, self.accuracy, p.switch_on)
                    .map_err(CaseError::NoCycle)?;
            }
        }
        self.programme(motion);
        Ok(())
    }

    /// The times of the uncontrolled cycle of stick and slip of this setting, whatever the start.
    ///
    /// # Errors
    /// As [`Case::motion`] where that starts after a release.
    pub fn uncontrolled_cycle(&self) -> Result<UncontrolledCycle, CaseError> {
        self.check()?;
        let (_, cycle) =
            after_release(&self.parameters(), self.accuracy, 0.0).map_err(CaseError::NoCycle)?;
        let unit = self.units().time;
        Ok(UncontrolledCycle {
            slip_time: cycle.slip_time * unit,
            stick_time: cycle.stick_time * unit,
        })
    }

    /// ẋ and the elongation at t = 0.
    #[must_use]
    pub fn initial_state(&self) -> (f64, f64) {
        match self.start {
            Start::State { x_dot0, a0 } => (x_dot0, a0),
            Start::AfterRelease => {
                let released = Motion::release_elongation(&self.parameters());
                (0.0, released * self.units().length)
            }
        }
    }

    fn dimensionless(&self, x_dot: f64, a: f64) -> (f64, f64) {
        let units = self.units();
        (x_dot / units.velocity, a / units.length)
    }

    fn parameters(&self) -> Parameters {
        let units = self.units();
        let mut feedback = self.feedback.dimensionless(&self.oscillator);
        if feedback.return_map.is_some() {
            // What is held is the change of the load itself; it depends on two readings.
            feedback.gains.alpha_n = 1.0;
            feedback.tau = 2.0 * feedback.readings.sample_time;
        }
        Parameters {
            law: self.law.clone(),
            velocity_unit: units.velocity,
            dashpots: self.oscillator.dashpot_ratios(),
            feedback,
            v0: self.v0 / units.velocity,
            switch_on: match self.feedback.acts() {
                true => self.switch_on / units.time,
                false => f64::INFINITY,
            },
        }
    }

    /// Sliding at the last v0 under the control that acts in the end, in the units of a motion.
    ///
    /// # Errors
    /// When v0 is out of range.
    pub fn sliding(&self) -> Result<Sliding, ModelError> {
        let control = if self.switch_on.is_finite() {
            self.feedback.gains
        } else {
            Control::default()
        };
        let sliding = SlidingPoint::of_law(&self.law, self.last_v0())?;
        let Feedback {
            tau,
            channel,
            readings,
            ..
        } = self.feedback.dimensionless(&self.oscillator);
        Ok(Sliding {
            groups: self.oscillator.groups(sliding, control),
            tau,
            channel,
            sample_time: readings.sample_time,
        })
    }

    /// The spectral abscissa of sliding at the last v0 under the control that acts in the end, in
    /// 1/time. None unless sliding is known to be stable.
    ///
    /// # Errors
    /// When v0 is out of range.
    pub fn stable_abscissa(&self) -> Result<Option<f64>, ModelError> {
        let unit = self.oscillator.time_unit();
        if self.feedback.return_map.is_some() {
            let known = self.steered(self.parameters()).ok();
            let last = self.last_v0() / self.units().velocity;
            let found = known.and_then(|p| Controller::of(&p)?.stable_abscissa(&p, last));
            return Ok(found.map(|abscissa| abscissa / unit));
        }
        let sliding = self.sliding()?;
        Ok(sliding.stable_abscissa().map(|abscissa| abscissa / unit))
    }

    /// Follows the motion to its outcome. Times, lengths and forces of the summary are physical.
    ///
    /// # Errors
    /// As [`Case::motion`].
    pub fn run(&self, observer: &mut impl Observer) -> Result<Summary, CaseError> {
        let mut motion = self.motion()?;
        Ok(self.follow(&mut motion, self.stable_abscissa()?, observer))
    }

    /// Follows `motion`, which is at the start of this case, as [`Case::run`] does.
    /// `stable_abscissa` is the answer of [`Case::stable_abscissa`].
    pub fn follow(
        &self,
        motion: &mut Motion,
        stable_abscissa: Option<f64>,
        observer: &mut impl Observer,
    ) -> Summary {
        let units = self.units();
        let limits = Limits {
            horizon: self.horizon / units.time,
            steps: self.steps,
            stable_abscissa: stable_abscissa.map(|s| s * units.time),
            repeated: REPEATED,
            cycles: usize::MAX,
        };
        let Summary {
            outcome,
            decided,
            settle_time,
            n_min,
            peak,
            time_at_limit,
            share_at_limit,
            period,
            stick_time,
            slip_time,
            last_release,
            slips,
            steps,
        } = follow(motion, &limits, observer);
        Summary {
            outcome,
            decided: decided * units.time,
            settle_time: settle_time * units.time,
            n_min: n_min * units.force,
            peak: peak * units.force,
            time_at_limit: time_at_limit * units.time,
            share_at_limit,
            period: period * units.time,
            stick_time: stick_time * units.time,
            slip_time: slip_time * units.time,
            last_release: last_release * units.time,
            slips,
            steps,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Readings;
    use crate::slip::outcome::Outcome;

    fn fig3a(mass: f64, stiffness: f64, load: f64) -> Case {
        let oscillator = Oscillator::new(mass, stiffness, load).unwrap();
        let units = CaseUnits {
            time: (mass / stiffness).sqrt(),
            length: load / stiffness,
            velocity: load / (mass * stiffness).sqrt(),
            force: load,
        };
        let law = FrictionLaw::weakening(0.5, 0.5 * units.velocity, 1.0).unwrap();
        let v0 = 0.35 * units.velocity;
        let a0 = law.mu_k(v0) * units.length;
        Case {
            oscillator,
            law,
            feedback: Feedback::new(-0.33 / units.time, 0.0, 4.15 * units.time),
            v0,
            programme: Programme::default(),
            switch_on: 70.0 * units.time,
            start: Start::State {
                x_dot0: 1.01 * v0,
                a0,
            },
            horizon: 1000.0 * units.time,
            steps: 1_000_000,
            accuracy: Accuracy::default(),
        }
    }

    #[test]
    fn units_scale_out() {
        let plain = fig3a(1.0, 1.0, 1.0).run(&mut ()).unwrap();
        let case = fig3a(2.0, 7.0, 3.0);
        let scaled = case.run(&mut ()).unwrap();
        assert_eq!(
            (plain.outcome, scaled.outcome),
            (Outcome::Sliding, Outcome::Sliding)
        );
        let unit = case.units().time;
        assert!((scaled.last_release / unit - plain.last_release).abs() < 1e-9);
        assert!((scaled.peak / 3.0 - plain.peak).abs() < 1e-9);
        assert!((plain.last_release - 27.029009396).abs() < 1e-8);
    }

    /// Fig. 3(a) read so many times in a delay.
    fn held(times: f64, readings: Readings) -> Case {
        let mut case = fig3a(2.0, 7.0, 3.0);
        case.feedback.readings = Readings {
            sample_time: case.feedback.tau / times,
            ..readings
        };
        case
    }

    #[test]
    fn times_have_to_be_whole_multiples_of_the_sample_time() {
        let exact = Readings::default();
        assert!(held(12.0, exact).motion().is_ok());
        for (times, name) in [(12.5, "tau"), (0.9, "tau"), (2e6, "tau")] {
            let error = held(times, exact).motion().unwrap_err().to_string();
            let says = error.starts_with(name) && error.contains("whole multiple of sample_time");
            assert!(says, "{error}");
        }
        let mut late = held(12.0, exact);
        late.feedback.channel.latency = 2.5 * late.feedback.readings.sample_time;
        let error = late.motion().unwrap_err().to_string();
        assert!(error.starts_with("latency"), "{error}");
        late.feedback.channel.latency = 2.0 * late.feedback.readings.sample_time;
        assert!(late.motion().is_ok());
        let noise = Readings {
            noise: 0.1,
            ..exact
        };
        let mut noisy = held(12.0, noise);
        assert!(noisy.motion().is_ok());
        noisy.feedback.readings.sample_time = 0.0;
        let error = noisy.motion().unwrap_err().to_string();
        assert!(error.contains("--sample-time"), "{error}");
        noisy.feedback.readings.sample_time = -1.0;
        let error = noisy.motion().unwrap_err().to_string();
        assert!(error.starts_with("sample_time"), "{error}");
    }

    /// Without gains nothing reads, so readings that fit nothing have no effect.
    #[test]
    fn without_gains_readings_have_no_effect() {
        let mut case = held(
            12.3,
            Readings {
                noise: 0.1,
                ..Readings::default()
            },
        );
        case.feedback.gains = Control::default();
        let mut plain = case.clone();
        plain.feedback.readings = Readings::default();
        let [one, other] = [case, plain].map(|case| case.run(&mut ()).unwrap());
        assert_eq!((one.outcome, one.decided), (other.outcome, other.decided));
    }

    #[test]
    fn values_out_of_range_are_named() {
        let case = fig3a(1.0, 1.0, 1.0);
        for (case, name) in [
            (
                Case {
                    feedback: Feedback::new(-0.33, 0.0, 0.0),
                    ..case.clone()
                },
                "tau",
            ),
            (
                Case {
                    v0: -1.0,
                    ..case.clone()
                },
                "v0",
            ),
            (
                Case {
                    start: Start::State {
                        x_dot0: f64::NAN,
                        a0: 0.0,
                    },
                    ..case.clone()
                },
                "x_dot0",
            ),
            (
                Case {
                    horizon: 0.0,
                    ..case.clone()
                },
                "horizon",
            ),
            (
                Case {
                    switch_on: f64::NAN,
                    ..case.clone()
                },
                "switch_on",
            ),
        ] {
            assert!(case.run(&mut ()).unwrap_err().to_string().contains(name));
        }
    }
}
