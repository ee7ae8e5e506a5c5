//! A motion in physical units: what is given, and what comes out.

use super::motion::{Accuracy, Motion, Parameters};
use super::outcome::{Limits, Observer, REPEATED, Summary, follow};
use crate::linear::rightmost::Rightmost;
use crate::linear::{Crossings, MarginalTolerance};
use crate::model::{Control, FrictionLaw, ModelError, Oscillator, SlidingPoint};

/// An initial value problem of the letter's Eqs. (1) and (2), in physical units.
#[derive(Debug, Clone, PartialEq)]
pub struct Case {
    /// Mass, stiffness, load.
    pub oscillator: Oscillator,
    /// The friction law.
    pub law: FrictionLaw,
    /// The gains.
    pub control: Control,
    /// Delay; greater than 0 where control acts.
    pub tau: f64,
    /// Pulling velocity.
    pub v0: f64,
    /// When control is switched on; +∞ for never. Without gains it never is.
    pub switch_on: f64,
    /// ẋ at t = 0.
    pub x_dot0: f64,
    /// Elongation at t = 0 and before.
    pub a0: f64,
    /// Until when to follow the motion.
    pub horizon: f64,
    /// The most steps.
    pub steps: u64,
    /// How exactly.
    pub accuracy: Accuracy,
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

impl Case {
    /// The units of its motion.
    #[must_use]
    pub fn units(&self) -> CaseUnits {
        let time = self.oscillator.time_unit();
        let force = self.oscillator.normal_load();
        let length = force / self.oscillator.stiffness();
        CaseUnits {
            time,
            length,
            velocity: length / time,
            force,
        }
    }

    /// The block at t = 0.
    ///
    /// # Errors
    /// When a value is not finite or out of its range.
    pub fn motion(&self) -> Result<Motion, ModelError> {
        self.check()?;
        let units = self.units();
        let parameters = Parameters {
            law: self.law.clone(),
            velocity_unit: units.velocity,
            alpha_v: self.control.alpha_v * units.time,
            alpha_n: self.control.alpha_n / self.oscillator.stiffness(),
            tau: self.tau / units.time,
            v0: self.v0 / units.velocity,
            switch_on: if self.control == Control::default() {
                f64::INFINITY
            } else {
                self.switch_on / units.time
            },
        };
        Ok(Motion::new(
            parameters,
            self.accuracy,
            self.x_dot0 / units.velocity,
            self.a0 / units.length,
        ))
    }

    fn check(&self) -> Result<(), ModelError> {
        ModelError::positive("v0", self.v0)?;
        let uncontrolled = self.control == Control::default();
        for (name, value) in [
            ("alpha_v", self.control.alpha_v),
            ("alpha_n", self.control.alpha_n),
            ("x_dot0", self.x_dot0),
            ("a0", self.a0),
        ] {
            ModelError::check(name, value, "finite", value.is_finite())?;
        }
        let tau = self.tau;
        let delayed = tau.is_finite() && (tau > 0.0 || (uncontrolled && tau >= 0.0));
        ModelError::check(
            "tau",
            tau,
            "finite and greater than 0 under control",
            delayed,
        )?;
        let switch_on = self.switch_on;
        if switch_on != f64::INFINITY {
            ModelError::check("switch_on", switch_on, "at least 0", switch_on >= 0.0)?;
        }
        ModelError::positive("horizon", self.horizon)?;
        let tolerance = self.accuracy.tolerance;
        let range = (1e-15..=1e-3).contains(&tolerance);
        ModelError::check("tolerance", tolerance, "between 1e-15 and 1e-3", range)?;
        Ok(())
    }

    /// Re λ of the rightmost root of sliding under the control that acts in the end, in 1/time, if it is stable.
    ///
    /// # Errors
    /// When v0 is out of range.
    pub fn stable_abscissa(&self) -> Result<Option<f64>, ModelError> {
        let control = if self.switch_on.is_finite() {
            self.control
        } else {
            Control::default()
        };
        let sliding = SlidingPoint::of_law(&self.law, self.v0)?;
        let groups = self.oscillator.groups(sliding, control);
        let unit = self.oscillator.time_unit();
        let tau = self.tau / unit;
        let count = Crossings::of(groups).count(tau, MarginalTolerance::default());
        let rightmost = Rightmost::at(groups, tau, 1, count);
        let stable = rightmost
            .roots
            .first()
            .filter(|_| count.stable() && rightmost.certified);
        Ok(stable.map(|root| root.lambda.re / unit))
    }

    /// Follows the motion to its outcome. Times, lengths and forces of the summary are physical.
    ///
    /// # Errors
    /// When a value is not finite or out of its range.
    pub fn run(&self, observer: &mut impl Observer) -> Result<Summary, ModelError> {
        let mut motion = self.motion()?;
        let units = self.units();
        let limits = Limits {
            horizon: self.horizon / units.time,
            steps: self.steps,
            stable_abscissa: self.stable_abscissa()?.map(|s| s * units.time),
            repeated: REPEATED,
        };
        let found = follow(&mut motion, &limits, observer);
        Ok(Summary {
            decided: found.decided * units.time,
            settle_time: found.settle_time * units.time,
            n_min: found.n_min * units.force,
            peak: found.peak * units.force,
            period: found.period * units.time,
            stick_time: found.stick_time * units.time,
            slip_time: found.slip_time * units.time,
            last_release: found.last_release * units.time,
            ..found
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
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
            control: Control {
                alpha_v: -0.33 / units.time,
                alpha_n: 0.0,
            },
            tau: 4.15 * units.time,
            v0,
            switch_on: 70.0 * units.time,
            x_dot0: 1.01 * v0,
            a0,
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
        assert!((plain.last_release - 97.029009396).abs() < 1e-8);
    }

    #[test]
    fn values_out_of_range_are_named() {
        let case = fig3a(1.0, 1.0, 1.0);
        for (case, name) in [
            (
                Case {
                    tau: 0.0,
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
                    x_dot0: f64::NAN,
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
