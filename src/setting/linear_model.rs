//! The feedback, the groups and the linear model of a setting.

use super::no_answer::NoAnswer;
use super::parameter::Parameter;
use super::system::{Evaluation, SystemModel};
use super::values::Setting;
use crate::linear::feedback_loop::{FeedbackLoop, Friction};
use crate::linear::general::Class;
use crate::linear::line::Linear;
use crate::linear::sampled::SampledLoop;
use crate::model::{
    ActuatorLimits, Channel, Control, Feedback, Groups, Lags, ModelError, Oscillator, Readings,
};

impl Setting {
    /// Both gains.
    #[inline]
    #[must_use]
    pub fn control(&self) -> Control {
        Control {
            alpha_v: self.get(Parameter::AlphaV),
            alpha_n: self.get(Parameter::AlphaN),
        }
    }

    /// The feedback, in physical units.
    #[must_use]
    pub fn feedback(&self) -> Feedback {
        let [load, velocity, sensor] = Parameter::LAGS.map(|lag| self.get(lag));
        let [v_min, v_max, load_min, load_max] = Parameter::LIMITS.map(|limit| self.get(limit));
        Feedback {
            gains: self.control(),
            tau: self.get(Parameter::Tau),
            channel: Channel {
                memory: self.get(Parameter::Memory),
                latency: self.get(Parameter::Latency),
            },
            lags: Lags {
                load,
                velocity,
                sensor,
            },
            limits: ActuatorLimits {
                velocity: [v_min, v_max],
                load: [load_min, load_max],
            },
            readings: Readings {
                sample_time: self.get(Parameter::SampleTime),
                noise: self.get(Parameter::Noise),
                resolution: self.get(Parameter::Resolution),
                seed: 0,
            },
            return_map: None,
        }
    }

    /// The dimensionless groups and the unit of time √(M/κ).
    ///
    /// # Errors
    /// When a parameter is outside the model's range, and for settings that these groups do not
    /// describe: with memory, latency, lags or a state of friction.
    pub fn groups(&self) -> Result<(Groups, f64), ModelError> {
        self.check_of_letter(
            &Parameter::BEYOND_LETTER,
            "0 in what is known of the letter's own feedback alone",
        )?;
        self.with_groups()
            .map(|(groups, of)| (groups, of.time_unit()))
    }

    /// The dimensionless groups of the block, and the oscillator by which they are measured.
    fn with_groups(&self) -> Result<(Groups, Oscillator), ModelError> {
        let oscillator = self.oscillator()?;
        let groups = oscillator.groups(self.sliding_point()?, self.control());
        Ok((groups, oscillator))
    }

    /// The feedback loop about steady sliding, dimensionless.
    ///
    /// # Errors
    /// When a parameter is outside the model's range.
    pub fn feedback_loop(&self) -> Result<FeedbackLoop, ModelError> {
        self.loop_around(&self.oscillator()?)
    }

    fn loop_around(&self, by: &Oscillator) -> Result<FeedbackLoop, ModelError> {
        let sliding = self.sliding_point()?;
        let Groups { b, a_v, a_n } = by.groups_without_coupling(sliding, self.control());
        let dashpots = by.dashpot_ratios();
        let friction = match self.rate_and_state() {
            Some(law) => Friction::of_state(law.groups(by, self.get(Parameter::V0)), dashpots),
            None => Friction::of_slope(b, dashpots.damping),
        };
        let Feedback { channel, lags, .. } = self.feedback().dimensionless(by);
        Ok(FeedbackLoop::new(friction, a_v, a_n, channel, lags))
    }

    /// Whether the linear model is the same at all delays. It is not where the polynomials of a
    /// system from a file depend on the delay.
    #[must_use]
    pub fn has_lines(&self) -> bool {
        self.system().is_none_or(|model| !model.depends_on_delay())
    }

    /// The linear model and the unit of time √(M/κ).
    ///
    /// ```
    /// use slipmap::model::stop::Stop;
    /// use slipmap::setting::Setting;
    ///
    /// let numbers = [("mu_prime", -0.3), ("alpha_v", -0.33), ("tau", 4.15)];
    /// let (linear, time_unit) = Setting::checked(numbers, None, &[])?.linear()?;
    /// let roots = linear.roots(&Stop::default());
    /// assert_eq!(roots.count(4.15, time_unit).unwrap().n_unstable, 0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// When a parameter is outside the model's range, or an expression has no value.
    pub fn linear(&self) -> Result<(Linear, f64), NoAnswer> {
        self.linear_in(&mut Evaluation::default())
    }

    /// The linear model and the unit of time, where something is known of such a model.
    ///
    /// # Errors
    /// As [`Setting::linear`], and when nothing is known of the model at any delay.
    pub fn answered(&self) -> Result<(Linear, f64), NoAnswer> {
        let found = self.linear()?;
        match &found.0 {
            Linear::General(system) if system.class() == Class::Refused => {
                Err(match system.is_zero() {
                    true => NoAnswer::Zero,
                    false => NoAnswer::Refused,
                })
            }
            _ => Ok(found),
        }
    }

    /// The linear model and the unit of time, where best settings of such a model are searched.
    ///
    /// # Errors
    /// As [`Setting::answered`], and for systems of which no best settings are known.
    pub(crate) fn searched(&self) -> Result<(Linear, f64), NoAnswer> {
        match self.without_curves() {
            Some(of) => Err(NoAnswer::Unsearched(of)),
            None => self.answered(),
        }
    }

    /// What the system is where it has neither crossing curves nor best settings; none where it
    /// has them.
    #[must_use]
    pub(crate) fn without_curves(&self) -> Option<&'static str> {
        let of = self.system().and_then(SystemModel::without_curves)?;
        let of_matrices = matches!(self.linear(), Ok((of @ Linear::Matrix(_), _))
            if of.system().is_some());
        (!of_matrices).then_some(of)
    }

    /// The linear model and the unit of time; the expressions of a system from a file are evaluated
    /// in `scratch`.
    ///
    /// # Errors
    /// As [`Setting::linear`].
    pub fn linear_in(&self, scratch: &mut Evaluation) -> Result<(Linear, f64), NoAnswer> {
        if let Some(system) = self.system_in(scratch) {
            return Ok((system?, 1.0));
        }
        if self.feedback().is_sampled() {
            return self.sampled();
        }
        let (groups, oscillator) = self.with_groups()?;
        let model = match self.is_of_letter() {
            true => Linear::Letter(groups),
            false => Linear::General(Box::new(self.loop_around(&oscillator)?.system())),
        };
        Ok((model, oscillator.time_unit()))
    }

    /// The linear model of a digital loop.
    fn sampled(&self) -> Result<(Linear, f64), NoAnswer> {
        if self.rate_and_state().is_some() {
            return Err(ModelError::of_law("one of the velocity alone, with a sample time").into());
        }
        if let Some(lag) = Parameter::LAGS.into_iter().find(|lag| self.get(*lag) > 0.0) {
            let (parameter, value) = (lag.name(), self.get(lag));
            return Err(NoAnswer::Model(ModelError {
                parameter,
                value,
                allowed: "0 with a sample time",
                at_speed: None,
            }));
        }
        let (groups, oscillator) = self.with_groups()?;
        let Feedback {
            channel, readings, ..
        } = self.feedback().dimensionless(&oscillator);
        let found = SampledLoop::new(groups, channel, readings.sample_time);
        let latency = ModelError {
            parameter: Parameter::Latency.name(),
            value: self.get(Parameter::Latency),
            allowed: "a whole multiple of sample_time",
            at_speed: None,
        };
        let found = found.ok_or(latency)?;
        Ok((Linear::Sampled(found), oscillator.time_unit()))
    }
}

#[cfg(test)]
mod tests {
    use num_complex::Complex64;

    use super::*;
    use crate::linear::sensitivity::Sensitivity;

    fn setting(given: &[(Parameter, f64)]) -> Setting {
        let mut setting = Setting::new(None);
        for (parameter, value) in given {
            setting.set(*parameter, *value);
        }
        setting
    }

    /// For a setting of the letter, both forms are the same equation.
    #[test]
    fn the_loop_of_the_letter_is_the_letters_equation() {
        let given = [
            (Parameter::MuPrime, -0.3),
            (Parameter::AlphaV, 0.4),
            (Parameter::AlphaN, -1.1),
            (Parameter::MuK, 0.6),
            (Parameter::Mass, 2.0),
            (Parameter::Stiffness, 3.0),
            (Parameter::NormalLoad, 1.5),
        ];
        let setting = setting(&given);
        let (Linear::Letter(groups), unit) = setting.linear().unwrap() else {
            panic!("the letter's own")
        };
        let of_loop = setting.feedback_loop().unwrap();
        let tau = 1.7 / unit;
        for lambda in [Complex64::new(0.3, 1.2), Complex64::new(-0.7, 0.4)] {
            let jet = of_loop.system().jet(tau, lambda);
            let letter = crate::linear::characteristic::Jet::at(groups, tau, lambda);
            assert!((jet.value - letter.value).norm() < 1e-13);
            assert!((jet.first - letter.first).norm() < 1e-13);
            let per = of_loop.per_group(lambda, jet.difference);
            let of_letter = Sensitivity::of(groups, tau, lambda);
            for (general, letter) in [
                (per.b, of_letter.b),
                (per.a_v, of_letter.a_v),
                (per.a_n, of_letter.a_n),
            ] {
                assert!((-general / jet.first - letter).norm() < 1e-13);
            }
        }
    }

    /// Checks D against its formula, and its derivatives against difference quotients.
    #[test]
    fn lags_and_memory_are_where_they_belong() {
        let at = |changed: Parameter, by: f64| {
            let mut setting = setting(&[
                (Parameter::MuPrime, -0.3),
                (Parameter::AlphaV, 0.4),
                (Parameter::AlphaN, -1.1),
                (Parameter::Memory, -0.35),
                (Parameter::LoadLag, 0.2),
                (Parameter::VelocityLag, 0.7),
                (Parameter::SensorLag, 0.05),
            ]);
            setting.set(changed, setting.get(changed) + by);
            setting.feedback_loop().unwrap()
        };
        let (tau, lambda) = (1.7, Complex64::new(0.3, 1.2));
        let of_loop = at(Parameter::MuPrime, 0.0);
        let jet = of_loop.system().jet(tau, lambda);
        let delayed = (-lambda * tau).exp();
        let [of_load, of_velocity, of_sensor] = [0.2, 0.7, 0.05].map(|t| 1.0 + t * lambda);
        let open = (lambda * lambda - 0.3 * lambda + 1.0) * of_load * of_velocity * of_sensor;
        let gain = -1.1 * of_velocity + 0.4 * (lambda - 0.3) * of_load;
        let value = open * (1.0 + 0.35 * delayed) - gain * (1.0 - delayed);
        assert!((jet.value - value).norm() < 1e-13);
        let per = of_loop.per_group(lambda, jet.difference);
        for (parameter, derivative) in [
            (Parameter::MuPrime, per.b),
            (Parameter::AlphaV, per.a_v),
            (Parameter::AlphaN, per.a_n),
        ] {
            let value = |by: f64| at(parameter, by).system().jet(tau, lambda).value;
            let numeric = (value(1e-6) - value(-1e-6)) / 2e-6;
            assert!((numeric - derivative).norm() < 1e-8, "{parameter:?}");
        }
    }

    #[test]
    fn without_gains_there_is_nothing_to_remember() {
        let idle = [(Parameter::MuPrime, -0.3), (Parameter::Memory, 0.5)];
        let (model, _) = setting(&idle).linear().unwrap();
        assert!(matches!(model, Linear::Letter(_)));
        let lagging = [(Parameter::MuPrime, -0.3), (Parameter::SensorLag, 0.5)];
        let (model, _) = setting(&lagging).linear().unwrap();
        assert!(matches!(model, Linear::General(system) if system.uncontrolled()));
    }
}
