//! The stable delays or latencies of a line, as answers tell them.

use serde::Serialize;

use crate::linear::general::{DelayLine, System};
use crate::linear::line::Intervals;
use crate::linear::stable_delays::StableInterval;

/// The most stable intervals. Near a tangency there can be millions; the answer says if some are
/// left out.
const MOST_INTERVALS: usize = 100_000;

/// What there is to know of the latencies of the feedback at one delay.
#[derive(Debug, Clone, Default, Serialize)]
#[cfg_attr(feature = "serve", derive(utoipa::ToSchema))]
pub struct Latencies {
    /// All intervals of latencies in which sliding is stable at the point's delay, by shortest
    /// latency; the end of the last one is null where it has none. Null where latency has no
    /// meaning in the system.
    #[cfg_attr(feature = "serve", schema(value_type = Option<Vec<[Option<f64>; 2]>>, required))]
    pub stable_latencies: Option<Vec<[f64; 2]>>,
    /// Some are left out.
    pub stable_latencies_truncated: bool,
    /// The latency margin: ∞ where nothing is lost, NaN where it is not known; none where latency
    /// has no meaning.
    #[serde(skip)]
    pub margin: Option<f64>,
}

impl Latencies {
    /// The latencies at the dimensionless delay `tau`.
    pub(super) fn of(system: &System, (tau, time_unit): (f64, f64)) -> Self {
        let Some(line) = DelayLine::of_latencies(system, tau) else {
            return Self::default();
        };
        let margin = line.latency_margin();
        let line = line.in_physical_time(time_unit);
        let (stable, truncated) = ends(&mut line.stable_intervals());
        Self {
            stable_latencies: Some(stable),
            stable_latencies_truncated: margin.is_nan() || truncated,
            margin: Some(margin * time_unit),
        }
    }
}

/// The ends of stable intervals, and whether some are left out; the last end may be infinite.
pub(super) fn ends(mut intervals: &mut dyn Intervals) -> (Vec<[f64; 2]>, bool) {
    let ends = |s: StableInterval| [s.from, s.to];
    let first = (&mut intervals).take(MOST_INTERVALS).map(ends).collect();
    (first, intervals.next().is_some() || intervals.gave_up())
}
