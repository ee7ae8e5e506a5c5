//! What a digital loop asks of the other parameters: delay and latency are whole multiples of the
//! sample time, and nothing lags.

use super::fields_asked::{FieldsAsked, ReportedAt, Unmet};
use super::parameter::Parameter;
use super::values::Setting;
use crate::linear::sampled::{MOST_SAMPLES, multiple};
use crate::model::ModelError;
use crate::text::Shown;

/// Why readings are not held through lags.
const NO_LAGS: &str = "a held signal through a lag is not known here: give 0, or a latency of \
    whole samples in its place";

/// A parameter that does not go with the sample time, or with its absence.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct NotSampled {
    /// The parameter.
    pub parameter: Parameter,
    value: f64,
    why: Why,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Why {
    /// It is of readings, and there are none.
    NoReadings,
    /// It is a lag.
    Lag,
    /// It is shorter than this sample time.
    Shorter(f64),
    /// It is no whole multiple of this sample time.
    Between(f64),
    /// It has more samples of this time than are counted.
    TooMany(f64),
}

impl NotSampled {
    /// The first parameter that does not go with the sample time; `value` of one that is not known
    /// is NaN. Without gains nothing is read.
    pub(super) fn find(value: impl Fn(Parameter) -> f64) -> Option<Self> {
        let sample_time = value(Parameter::SampleTime);
        let found = |parameter: Parameter, why: Why| {
            Some(Self {
                parameter,
                value: value(parameter),
                why,
            })
        };
        let acts = |parameter: &Parameter| value(*parameter) > 0.0;
        if sample_time == 0.0 {
            let of_readings = Parameter::OF_READINGS.into_iter().find(acts);
            return of_readings.and_then(|parameter| found(parameter, Why::NoReadings));
        }
        if sample_time.is_nan() || !Self::gains_act(&value) {
            return None;
        }
        if let Some(lag) = Parameter::LAGS.into_iter().find(acts) {
            return found(lag, Why::Lag);
        }
        for parameter in [Parameter::Tau, Parameter::Latency] {
            let time = value(parameter);
            let absent = time.is_nan() || (parameter == Parameter::Latency && time == 0.0);
            if !absent && multiple(time, sample_time).is_none() {
                let why = match time / sample_time {
                    samples if samples < 1.0 && parameter == Parameter::Tau => {
                        Why::Shorter(sample_time)
                    }
                    samples if samples > MOST_SAMPLES => Why::TooMany(sample_time),
                    _ => Why::Between(sample_time),
                };
                return found(parameter, why);
            }
        }
        None
    }

    /// A gain that is not known may act.
    fn gains_act(value: &impl Fn(Parameter) -> f64) -> bool {
        let gains = [Parameter::AlphaV, Parameter::AlphaN];
        gains.into_iter().any(|gain| value(gain) != 0.0)
    }

    /// The need that is not met, in the words of files.
    pub(super) fn unmet(&self) -> Unmet {
        let [message, help] = [self.message(Parameter::key), self.help(Parameter::key)];
        ReportedAt::Parameter(self.parameter).refuse(message, help)
    }

    /// The error in words. `name` gives the name of a parameter in the file or on the command line.
    pub(super) fn message(&self, name: fn(Parameter) -> String) -> String {
        let given = format!("{} = {}", name(self.parameter), Shown(self.value));
        let of = |sample_time: f64| {
            let sample_time = Shown(sample_time);
            format!("{} = {sample_time}", name(Parameter::SampleTime))
        };
        match self.why {
            Why::NoReadings => format!("{given} is of readings, and there are none"),
            Why::Lag => format!("{given} does not go with {}", name(Parameter::SampleTime)),
            Why::Shorter(sample_time) => format!("{given} is shorter than {}", of(sample_time)),
            Why::Between(sample_time) => {
                format!("{given} is no whole multiple of {}", of(sample_time))
            }
            Why::TooMany(sample_time) => {
                format!("{given} has more than 1e9 samples of {}", of(sample_time))
            }
        }
    }

    /// A suggestion for the error.
    pub(super) fn help(&self, name: fn(Parameter) -> String) -> String {
        match self.why {
            Why::NoReadings => format!(
                "give {} as well, the time from one reading to the next",
                name(Parameter::SampleTime)
            ),
            Why::Lag => NO_LAGS.into(),
            Why::Shorter(sample_time) => {
                format!("a sample takes its time: {} or more", Shown(sample_time))
            }
            Why::TooMany(_) => format!(
                "give {} = {} or more",
                name(Parameter::SampleTime),
                Shown(self.value / MOST_SAMPLES)
            ),
            Why::Between(sample_time) => {
                let below = (self.value / sample_time).floor() * sample_time;
                let [below, above] = [below, below + sample_time].map(|time| Shown(tidy(time)));
                format!("the nearest ones are {below} and {above}")
            }
        }
    }
}

/// A time without the last digits, which are the rounding of a product and need not be typed.
fn tidy(time: f64) -> f64 {
    format!("{time:.11e}").parse().unwrap_or(time)
}

/// The error of a parameter with one value, or of a delay, that does not go with a sample time of
/// one value. Where that is an axis, it is the status of cells.
pub(super) fn not_sampled(asked: &FieldsAsked) -> Option<Unmet> {
    let value = |p| {
        let mut values = asked.values(p);
        let first = values.next().unwrap_or(f64::NAN);
        if values.next().is_some() {
            f64::NAN
        } else {
            first
        }
    };
    let with_delay = |tau: f64| {
        NotSampled::find(|p| match p {
            Parameter::Tau => tau,
            p => value(p),
        })
    };
    let found = asked.values(Parameter::Tau).find_map(with_delay);
    found.map(|found| found.unmet())
}

impl Setting {
    /// Rounds delay and latency to the nearest whole multiples of the sample time, the delay to at
    /// least one; those that change, with the values before. A delay shorter than a sample stays.
    pub(crate) fn round_to_samples(&mut self) -> Vec<(Parameter, f64)> {
        let sample_time = self.get(Parameter::SampleTime);
        let mut changed = Vec::new();
        for (parameter, least) in [(Parameter::Tau, 1.0), (Parameter::Latency, 0.0)] {
            let value = self.get(parameter);
            let whole = multiple(value, sample_time).is_some() || value == 0.0;
            let samples = value / sample_time;
            if self.feedback().is_sampled() && !whole && (least..MOST_SAMPLES).contains(&samples) {
                let rounded = (value / sample_time).round() * sample_time;
                self.set(parameter, rounded);
                changed.push((parameter, value));
            }
        }
        changed
    }

    /// Refuses a digital loop; `allowed` says what a sample time has to be, and where.
    ///
    /// # Errors
    /// Names the sample time.
    pub fn check_continuous(&self, allowed: &'static str) -> Result<(), ModelError> {
        let (parameter, value) = (Parameter::SampleTime, self.get(Parameter::SampleTime));
        let sampled = self.feedback().is_sampled();
        ModelError::check(parameter.name(), value, allowed, !sampled).map(|_| ())
    }

    /// Whether what does not go with the sample time is a delay between two multiples of it.
    pub(crate) fn is_between_samples(&self) -> bool {
        let found = NotSampled::find(|p| self.get(p));
        found.is_some_and(|found| matches!(found.why, Why::Between(_)))
    }

    /// Whether all parameters go with the sample time, or with its absence.
    pub(crate) fn fits_samples(&self) -> bool {
        NotSampled::find(|p| self.get(p)).is_none()
    }

    /// The message and the help where a parameter does not go with the sample time; none where all
    /// do. `name` gives the name of a parameter.
    pub(crate) fn not_sampled(&self, name: fn(Parameter) -> String) -> Option<(String, String)> {
        let found = NotSampled::find(|p| self.get(p))?;
        Some((found.message(name), found.help(name)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn told(numbers: &[(Parameter, f64)]) -> Option<(String, String)> {
        let mut setting = Setting::new(None);
        setting.set(Parameter::AlphaV, -0.3);
        for (parameter, value) in numbers {
            setting.set(*parameter, *value);
        }
        setting.not_sampled(Parameter::key)
    }

    #[test]
    fn delays_are_rounded_to_samples() {
        let mut setting = Setting::new(None);
        let given = [
            (Parameter::AlphaV, -0.3),
            (Parameter::SampleTime, 0.3),
            (Parameter::Tau, 4.15),
            (Parameter::Latency, 0.1),
        ];
        for (parameter, value) in given {
            setting.set(parameter, value);
        }
        assert!(setting.is_between_samples());
        let changed = [(Parameter::Tau, 4.15), (Parameter::Latency, 0.1)];
        assert_eq!(setting.round_to_samples(), changed);
        let [tau, latency] = [Parameter::Tau, Parameter::Latency].map(|p| setting.get(p));
        assert!((tau - 4.2).abs() < 1e-12 && latency == 0.0);
        assert_eq!(setting.not_sampled(Parameter::key), None);
    }

    #[test]
    fn what_does_not_go_with_the_sample_time_is_told() {
        use Parameter::{AlphaV, Latency, Noise, SampleTime, SensorLag, Tau};
        assert_eq!(told(&[(SampleTime, 0.3), (Tau, 4.2), (Latency, 0.6)]), None);
        assert_eq!(told(&[(AlphaV, 0.0), (SampleTime, 0.3), (Tau, 4.0)]), None);
        for (numbers, message, help) in [
            (
                &[(SampleTime, 0.3), (Tau, 4.0)][..],
                "tau = 4 is no whole multiple of sample_time = 0.3",
                "the nearest ones are 3.9 and 4.2",
            ),
            (
                &[(SampleTime, 5.0), (Tau, 4.0)],
                "tau = 4 is shorter than sample_time = 5",
                "a sample takes its time: 5 or more",
            ),
            (
                &[(SampleTime, 0.5), (Tau, 4.0), (Latency, 0.7)],
                "latency = 0.7 is no whole multiple of sample_time = 0.5",
                "the nearest ones are 0.5 and 1",
            ),
            (
                &[(Noise, 0.1), (Tau, 4.0)],
                "noise = 0.1 is of readings, and there are none",
                "give sample_time as well, the time from one reading to the next",
            ),
            (
                &[(SampleTime, 0.5), (Tau, 4.0), (SensorLag, 0.1)],
                "sensor_lag = 0.1 does not go with sample_time",
                NO_LAGS,
            ),
        ] {
            let (found, suggested) = told(numbers).unwrap();
            assert_eq!(found, message);
            assert_eq!(suggested, help, "{message}");
        }
    }
}
