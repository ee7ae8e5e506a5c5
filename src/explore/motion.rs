//! One motion of the block in time.

use serde::Serialize;

use crate::answers::Trace;
use crate::answers::samples::Most;
use crate::answers::trace::Sample;
use crate::answers::trace::{MOST_SAMPLES, TraceError, TraceEvent};
use crate::model::stop::Stop;
use crate::setting::CaseSpec;
use crate::slip::speeds::Speeds;

/// Limits of a motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Limits {
    /// The most samples, beyond which they are thinned; and the most events.
    pub samples: usize,
    /// The most steps.
    pub steps: u64,
}

impl Default for Limits {
    /// Limits that keep a motion within a few seconds.
    fn default() -> Self {
        Self {
            samples: 20_000,
            steps: 1_000_000,
        }
    }
}

impl Limits {
    /// An upper bound on the bytes of samples and events, and of the answer.
    #[must_use]
    pub const fn bytes(&self) -> u64 {
        (4 * self.samples * size_of::<Sample>()) as u64
    }
}

/// A motion that was followed, now or before it was stored.
#[derive(Debug, Clone)]
pub struct Followed {
    /// Its case.
    pub spec: CaseSpec,
    /// Its samples and events.
    pub trace: Trace,
    /// The speeds that the block reached, in units of the case.
    speeds: Speeds,
}

impl Followed {
    /// Follows a case; `stop` is checked at every step.
    ///
    /// # Errors
    /// When it exceeds the limits, or is stopped.
    pub fn of(case: &CaseSpec, limits: Limits, stop: &Stop) -> Result<Self, TraceError> {
        let mut spec = case.clone();
        let asked = spec.case.steps;
        spec.case.steps = asked.min(limits.steps);
        let followed = Trace::with_speeds(&spec, Most::Thinned(limits.samples), stop);
        let (trace, speeds) = followed.map_err(|error| match error {
            TraceError::TooLong(most) => TraceError::TooManyEvents(most),
            other => other,
        })?;
        if trace.summary.steps >= limits.steps && asked > limits.steps {
            return Err(TraceError::TooManySteps(limits.steps));
        }
        Ok(Self {
            spec,
            trace,
            speeds,
        })
    }

    /// Follows a case to the end of its trace, whatever that takes; `stop` is checked at every
    /// step.
    ///
    /// # Errors
    /// As [`Trace::of`].
    pub fn whole(case: &CaseSpec, stop: &Stop) -> Result<Self, TraceError> {
        let most = Most::Refused(MOST_SAMPLES);
        let (trace, speeds) = Trace::with_speeds(case, most, stop)?;
        Ok(Self {
            spec: case.clone(),
            trace,
            speeds,
        })
    }

    /// A motion that is stored, with its samples thinned beyond the limit; its speeds are those of
    /// the samples.
    #[must_use]
    pub fn stored(spec: CaseSpec, trace: Trace, limits: Limits) -> Self {
        let mut speeds = Speeds::default();
        for speed in trace.samples.iter().map(|sample| sample.x_dot.abs()) {
            speeds = speeds.and(Speeds {
                least: speed,
                most: speed,
            });
        }
        Self {
            spec,
            trace: trace.thinned(limits.samples),
            speeds,
        }
    }

    /// A remark on a block that went beyond the points of a measured friction law.
    #[must_use]
    pub(crate) fn beyond_curve(&self) -> Option<String> {
        let CaseSpec { setting, units, .. } = &self.spec;
        setting.motion_beyond_curve(self.speeds, units)
    }
}

/// What became of a motion, in the units of its case. NaN and infinity are null in JSON.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(feature = "serve", derive(utoipa::ToSchema))]
pub struct MotionSummary {
    /// How it ended up.
    pub outcome: &'static str,
    /// When that was known.
    pub decided: f64,
    /// From switch-on until ẋ stays within 1 % of v0; null where it does not come to sliding.
    #[cfg_attr(feature = "serve", schema(value_type = Option<f64>, required))]
    pub settle_time: f64,
    /// The smallest load since switch-on; null where the motion ended before.
    #[cfg_attr(feature = "serve", schema(value_type = Option<f64>, required))]
    pub n_min: f64,
    /// The largest force of spring and dashpot since switch-on; null where it grew beyond all
    /// numbers.
    #[cfg_attr(feature = "serve", schema(value_type = Option<f64>, required))]
    pub peak_force: f64,
    /// How long v or N was at a limit since switch-on; null without limits of actuators.
    #[cfg_attr(feature = "serve", schema(value_type = Option<f64>, required))]
    pub time_at_limit: f64,
    /// The share of the time since switch-on for which it was; null without limits of actuators.
    #[cfg_attr(feature = "serve", schema(value_type = Option<f64>, required))]
    pub share_at_limit: f64,
    /// Period of stick-slip; null where it did not end up in that.
    #[cfg_attr(feature = "serve", schema(value_type = Option<f64>, required))]
    pub period: f64,
    /// Time stuck in one period; null where there is no period.
    #[cfg_attr(feature = "serve", schema(value_type = Option<f64>, required))]
    pub stick_time: f64,
    /// Time in slip in one period; null where there is no period.
    #[cfg_attr(feature = "serve", schema(value_type = Option<f64>, required))]
    pub slip_time: f64,
    /// From switch-on until the last stick ended; 0 where there is none after switch-on, null where
    /// sticks go on periodically.
    #[cfg_attr(feature = "serve", schema(value_type = Option<f64>, required))]
    pub last_release: f64,
    /// Steps taken.
    pub steps: u64,
    /// All events.
    pub events: Vec<MotionEvent>,
}

/// An event of a motion.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(feature = "serve", derive(utoipa::ToSchema))]
pub struct MotionEvent {
    /// When.
    pub t: f64,
    /// What.
    pub kind: &'static str,
    /// The elongation of the spring then.
    pub a: f64,
}

impl MotionSummary {
    /// The summary of a trace.
    #[must_use]
    pub fn of(trace: &Trace) -> Self {
        let summary = &trace.summary;
        let event = |e: &TraceEvent| MotionEvent {
            t: e.t,
            kind: e.name(),
            a: e.a,
        };
        Self {
            outcome: summary.outcome.name(),
            decided: summary.decided,
            settle_time: summary.settle_time,
            // Avoids −0.
            n_min: summary.n_min + 0.0,
            peak_force: summary.peak,
            time_at_limit: summary.time_at_limit,
            share_at_limit: summary.share_at_limit,
            period: summary.period,
            stick_time: summary.stick_time,
            slip_time: summary.slip_time,
            last_release: summary.last_release,
            steps: summary.steps,
            events: trace.events.iter().map(event).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FIG3A: &str = include_str!("../../sweeps/fig3a.toml");

    fn followed(text: &str, limits: Limits) -> Result<Followed, TraceError> {
        Followed::of(&text.parse().unwrap(), limits, &Stop::default())
    }

    #[test]
    fn a_long_motion_is_thinned() {
        let limits = Limits {
            samples: 1000,
            ..Limits::default()
        };
        let found = followed(FIG3A, limits).unwrap();
        assert!((500..=1000).contains(&found.trace.samples.len()));
        assert_eq!(MotionSummary::of(&found.trace).outcome, "sliding");
        let few = Limits {
            samples: 10,
            ..limits
        };
        let refused = followed(FIG3A, few).unwrap_err();
        assert_eq!(refused, TraceError::TooManyEvents(10));
    }

    /// A case that asks for few steps gets them; one that needs more than the limit is refused.
    #[test]
    fn steps_have_an_end() {
        let limits = Limits {
            steps: 200,
            ..Limits::default()
        };
        let refused = followed(FIG3A, limits).unwrap_err();
        assert_eq!(refused, TraceError::TooManySteps(200));
        let few = followed(&format!("steps = 100\n{FIG3A}"), limits).unwrap();
        assert_eq!(MotionSummary::of(&few.trace).outcome, "undecided");
    }
}
