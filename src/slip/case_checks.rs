//! What a case has to be for a motion, and the return map that a record tells it.

use super::case::{Case, CaseError};
use super::motion::Parameters;
use super::readings;
use super::record::reconstructed;
use super::return_map::sample_times;
use crate::model::{
    ActuatorLimits, Channel, Control, Feedback, MapModel, ModelError, ReturnMap, SlidingPoint,
};

impl Case {
    /// Checks all that does not need a motion of its own.
    pub(super) fn check(&self) -> Result<(), ModelError> {
        ModelError::positive("v0", self.v0)?;
        let Feedback {
            gains,
            tau,
            channel: Channel { memory, latency },
            ..
        } = self.feedback;
        let (x_dot0, a0) = self.initial_state();
        for (name, value) in [
            ("alpha_v", gains.alpha_v),
            ("alpha_n", gains.alpha_n),
            ("x_dot0", x_dot0),
            ("a0", a0),
        ] {
            ModelError::check(name, value, "finite", value.is_finite())?;
        }
        let delayed = tau.is_finite() && (tau > 0.0 || (!gains.act() && tau >= 0.0));
        ModelError::check(
            "tau",
            tau,
            "finite and greater than 0 under control",
            delayed,
        )?;
        let within = memory.abs() < 1.0;
        ModelError::check("memory", memory, "greater than -1 and less than 1", within)?;
        let known = latency.is_finite() && latency >= 0.0;
        ModelError::check("latency", latency, "finite and at least 0", known)?;
        self.check_readings()?;
        let ActuatorLimits { velocity, load } = self.feedback.limits;
        let n0 = self.oscillator.normal_load();
        for (name, value, [least, most]) in [("v0", self.v0, velocity), ("normal_load", n0, load)] {
            let within = least < value && value < most;
            ModelError::check(name, value, "within the limits of its actuator", within)?;
        }
        self.programme
            .check(velocity)
            .map_err(|wrong| wrong.error)?;
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

    /// Checks how the elongation is read.
    ///
    /// # Errors
    /// When a value is out of its range, or a delay no whole multiple of the sample time.
    pub(crate) fn check_readings(&self) -> Result<(), ModelError> {
        readings::check(&self.feedback)
    }

    /// The parameters, with a return map that is known where a record is to tell it.
    pub(super) fn steered(&self, mut p: Parameters) -> Result<Parameters, CaseError> {
        let Some(of) = &mut p.feedback.return_map else {
            return Ok(p);
        };
        self.check_return_map()?;
        if let MapModel::Reconstructed(record) = of.model {
            let found = reconstructed(&p, self.accuracy, record)?;
            let known = MapModel::Known(found);
            p.feedback.return_map = p
                .feedback
                .return_map
                .map(|of| ReturnMap { model: known, ..of });
        }
        Ok(p)
    }

    /// Checks control by the return map: its loads, what does not go with it, and that readings
    /// tell the velocity.
    fn check_return_map(&self) -> Result<(), CaseError> {
        let Some(ReturnMap { amplitude, model }) = self.feedback.return_map else {
            return Ok(());
        };
        let n0 = self.oscillator.normal_load();
        let pulse = match model {
            MapModel::Reconstructed(record) => record.pulse,
            _ => amplitude,
        };
        for (name, load) in [("amplitude", amplitude), ("pulse", pulse)] {
            let allowed = "greater than 0 and less than normal_load";
            ModelError::check(name, load, allowed, 0.0 < load && load < n0)?;
        }
        let Feedback {
            gains,
            channel,
            limits,
            ..
        } = self.feedback;
        let beside = [
            ("alpha_v", gains.alpha_v, 0.0),
            ("alpha_n", gains.alpha_n, 0.0),
            ("memory", channel.memory, 0.0),
            ("latency", channel.latency, 0.0),
            ("load_min", limits.load[0], 0.0),
            ("load_max", limits.load[1], f64::INFINITY),
        ];
        let given = beside
            .into_iter()
            .find(|(_, value, absent)| value != absent);
        if let Some((name, value, _)) = given {
            return Err(CaseError::BesideReturnMap { name, value });
        }
        self.check_sample_time()
    }

    /// Checks that readings tell the velocity at every v0 of the programme's corners.
    fn check_sample_time(&self) -> Result<(), CaseError> {
        let given = self.feedback.readings.sample_time;
        ModelError::positive("sample_time", given)?;
        let unit = self.units().time;
        let mut told = [0.0_f64, f64::INFINITY];
        let corners = self.programme.0.iter().map(|corner| corner.v0);
        for v0 in std::iter::once(self.v0).chain(corners) {
            let sliding = SlidingPoint::of_law(&self.law, v0)?;
            let groups = self.oscillator.groups(sliding, Control::default());
            let [shortest, longest] = sample_times(groups.b);
            told = [told[0].max(shortest * unit), told[1].min(longest * unit)];
        }
        match told[0] <= given && given <= told[1] {
            true => Ok(()),
            false => Err(CaseError::SampleTime { given, told }),
        }
    }
}
