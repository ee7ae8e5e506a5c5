//! Best settings of a digital loop: over a gain of the block and the multiples of its sample time.

use super::best::{Ranges, Scales, acting, letter, scaled};
use crate::linear::best::{Best, SampledPlane, SearchedGain};
use crate::linear::sampled::{GainLine, SampledLoop, multiples_within};
use crate::model::stop::Stop;
use crate::model::{Feedback, ModelError};
use crate::setting::best_plane::parameter_of;
use crate::setting::no_answer::NoAnswer;
use crate::setting::parameter::Parameter;
use crate::setting::values::Setting;

/// The most samples in the longest delay of a search.
const MOST_SAMPLES: u64 = 20_000;

impl Scales {
    /// The search over the multiples of a sample time.
    pub(super) fn best_of_samples(
        &self,
        setting: &Setting,
        gain: SearchedGain,
        ranges: &Ranges,
        stop: &Stop,
    ) -> Result<Best, NoAnswer> {
        let (parameter, sample_time) = (Parameter::SampleTime, setting.get(Parameter::SampleTime));
        let within = |allowed: &'static str, holds: bool| {
            ModelError::check(parameter.name(), sample_time, allowed, holds)
        };
        let (from, to) = multiples_within(sample_time, ranges.q);
        within(
            "such that a multiple of it is in the range of delays that is searched",
            from <= to,
        )?;
        within(
            "such that the longest delay that is searched has 20000 samples at most",
            to <= MOST_SAMPLES,
        )?;
        let mut first = acting(setting, &parameter_of(gain).into());
        first.set(Parameter::Tau, from as f64 * sample_time);
        first.answered()?;
        let family = letter(setting, gain)?;
        let Feedback {
            channel, readings, ..
        } = setting.feedback().dimensionless(&setting.oscillator()?);
        let at = |gain: f64| SampledLoop::new(family.groups(gain), channel, readings.sample_time);
        let latency = ModelError {
            parameter: parameter.name(),
            value: sample_time,
            allowed: "such that the latency is a multiple of it",
            at_speed: None,
        };
        let without = at(0.0).ok_or_else(|| latency.clone())?;
        let one = at(1.0).ok_or(latency)?;
        let plane = SampledPlane {
            loops: GainLine::through(without, &one),
            gains: scaled(ranges.p, 1.0 / self.p),
            multiples: (from, to),
        };
        Ok(plane.best(stop))
    }
}
