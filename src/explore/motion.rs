//! One motion of the block in time.

use serde::Serialize;

use crate::sweep::Trace;
use crate::sweep::cells::trace::TraceEvent;

/// What became of a motion, in the units of its case. NaN and infinity are null in JSON.
#[derive(Debug, Clone, Serialize)]
pub struct MotionSummary {
    /// How it ended up.
    pub outcome: &'static str,
    /// When that was known.
    pub decided: f64,
    /// From switch-on until ẋ stays within 1 % of v0.
    pub settle_time: f64,
    /// The smallest load since switch-on.
    pub n_min: f64,
    /// The largest spring force since switch-on.
    pub peak_force: f64,
    /// Period of stick-slip.
    pub period: f64,
    /// Time stuck in one period.
    pub stick_time: f64,
    /// Time in slip in one period.
    pub slip_time: f64,
    /// When the last stick ended.
    pub last_release: f64,
    /// Steps taken.
    pub steps: u64,
    /// All events.
    pub events: Vec<MotionEvent>,
}

/// An event of a motion.
#[derive(Debug, Clone, Serialize)]
pub struct MotionEvent {
    /// When.
    pub t: f64,
    /// What.
    pub kind: &'static str,
    /// The elongation of the spring then.
    pub a: f64,
}

impl MotionSummary {
    /// Of a trace.
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
            // Not −0.
            n_min: summary.n_min + 0.0,
            peak_force: summary.peak,
            period: summary.period,
            stick_time: summary.stick_time,
            slip_time: summary.slip_time,
            last_release: summary.last_release,
            steps: summary.steps,
            events: trace.events.iter().map(event).collect(),
        }
    }
}
