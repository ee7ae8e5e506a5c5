//! Bounds on the memory of a run, from the plan alone. `--memory` chooses the number of threads by
//! them.

use super::Plan;
use crate::setting::parameter::Parameter;
use crate::setting::source::Cost;
use crate::setting::values::Setting;
use crate::slip::motion::{BYTES_OF_A_STEP, MOST_KEPT};

/// Bytes of the program, the HDF5 library, the tiles that wait to be saved, and a picture.
const BASE: u64 = 90 << 20;
/// Bytes of a piece in the lists of finished pieces and of their places.
const PER_PIECE: u64 = 128;
/// Bytes of a plane of best settings until the map is written.
const PER_BEST: u64 = 64;
/// Copies of the values of an axis: in the plan, in the map that is read back, and in transit.
const COPIES_OF_AXES: u64 = 4;
/// Bytes of stack and scratch of a thread.
const PER_THREAD: u64 = 2 << 20;
/// Copies of a tile per thread: as numbers, compressed, and waiting for the disk.
const COPIES_OF_TILES: u64 = 4;
/// Bytes of a plane with the most curves that are traced, with its copies in transit; and of each
/// further degree of stability, for which only the curves that bound a region are traced.
const PLANE_OF_CURVES: u64 = 24 << 20;
const CURVES_OF_A_DEGREE: u64 = 1 << 20;
/// Histories of motions that a thread keeps at once: for outcomes, and for critical velocities.
const PASTS_OF_OUTCOMES: u64 = 1;
const PASTS_OF_CRITICAL: u64 = 13;
/// An upper bound on the average number of steps per unit of time √(M/κ), and the fewest steps
/// kept, for a short delay.
const STEPS_PER_TIME: f64 = 16.0;
const STEPS_AT_LEAST: f64 = 4096.0;

/// The memory of a run, in bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Memory {
    /// Independent of the number of threads.
    pub shared: u64,
    /// In addition, for each thread.
    pub per_thread: u64,
}

impl Memory {
    /// The most memory that a run of `plan` takes.
    #[must_use]
    pub fn of(plan: &Plan) -> Self {
        let pieces = plan.pieces();
        let axes: u64 = plan.shape().iter().map(|&n| n as u64).sum();
        let shared = BASE
            + PER_PIECE * pieces.total()
            + PER_BEST * pieces.best
            + COPIES_OF_AXES * axes * size_of::<f64>() as u64;
        let tile = plan.tiles.tile_cells() as u64 * plan.bytes_per_cell();
        let degrees = plan.spec.degrees_of_stability.len() as u64;
        let curves = match pieces.curves {
            0 => 0,
            _ => PLANE_OF_CURVES + CURVES_OF_A_DEGREE * degrees,
        };
        let per_thread = PER_THREAD + COPIES_OF_TILES * tile + curves + pasts(plan);
        Self { shared, per_thread }
    }

    /// The most bytes that a run on `threads` threads takes.
    #[must_use]
    pub fn on(&self, threads: usize) -> u64 {
        self.shared + self.per_thread * threads as u64
    }

    /// The most threads, up to `asked`, that stay within `limit` bytes; none where one thread does
    /// not.
    #[must_use]
    pub fn threads_within(&self, limit: u64, asked: usize) -> Option<usize> {
        let fitting = limit.checked_sub(self.shared)? / self.per_thread;
        let threads = usize::try_from(fitting).unwrap_or(usize::MAX).min(asked);
        (threads > 0).then_some(threads)
    }
}

/// Bytes of the histories of motions in one thread.
fn pasts(plan: &Plan) -> u64 {
    let count = match plan.spec.cost() {
        Cost::Critical => PASTS_OF_CRITICAL,
        Cost::Followed | Cost::FollowedOften => PASTS_OF_OUTCOMES,
        Cost::Counted | Cost::Rooted | Cost::Searched | Cost::Proved => return 0,
    };
    count * past(longest_delay(plan))
}

/// Bytes of the history of a motion with this delay and latency, both in units of √(M/κ).
fn past([delay, latency]: [f64; 2]) -> u64 {
    // Two delays are kept. A deque may reserve more than it holds.
    let kept = |delay: f64| {
        let steps = 2.0 * delay * STEPS_PER_TIME + STEPS_AT_LEAST;
        let steps = (steps.min(MOST_KEPT as f64) as u64).next_power_of_two();
        steps * BYTES_OF_A_STEP as u64
    };
    match latency > 0.0 {
        // With a latency, kinks come back after the delay and after the latency.
        true => 2 * kept(f64::INFINITY),
        false => kept(delay),
    }
}

/// The delay of a setting, lengthened for the memory of the feedback, and the latency, both in
/// units of √(M/κ).
fn delay(setting: &Setting) -> [f64; 2] {
    let unit = setting.oscillator().map_or(1.0, |o| o.time_unit());
    let share = 1.0 - setting.get(Parameter::Memory).abs();
    let delay = setting.get(Parameter::Tau) / unit / share;
    [delay, setting.get(Parameter::Latency) / unit]
}

/// The most bytes that following one motion of a setting takes.
#[must_use]
pub(crate) fn of_motion(setting: &Setting) -> u64 {
    PASTS_OF_OUTCOMES * past(delay(setting))
}

/// The most bytes that the search for the critical velocity of a setting takes.
#[must_use]
pub(crate) fn of_critical_velocity(setting: &Setting) -> u64 {
    PASTS_OF_CRITICAL * past(delay(setting))
}

/// The longest delay and the longest latency of a sweep, in units of √(M/κ).
fn longest_delay(plan: &Plan) -> [f64; 2] {
    let (mut longest, mut others) = (plan.spec.fixed.clone(), plan.spec.fixed.clone());
    for axis in &plan.spec.axes {
        let (from, to) = axis.range();
        // The smaller the mass and the larger the stiffness, the shorter the unit of time.
        let (at, other) = match axis.parameter.known() {
            Some(Parameter::Mass) => (from, to),
            _ => (to, from),
        };
        longest.vary(&axis.parameter, at);
        others.vary(&axis.parameter, other);
    }
    let (one, other) = (delay(&longest), delay(&others));
    [one[0].max(other[0]), one[1].max(other[1])]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::setting::SweepSpec;

    fn memory(field: &str, fixed: &str, tau: f64) -> Memory {
        let text = format!(
            "fields = [\"{field}\"]\n[axes]\nalpha_v = [-0.1, -0.2]\ntau = [1.0, {tau:?}]\n\
             mass = [0.01, 1.0]\n[friction]\nlaw = \"coulomb\"\nmu0 = 0.5\n[fixed]\n{fixed}\n"
        );
        Memory::of(&Plan::new(text.parse::<SweepSpec>().unwrap()).unwrap())
    }

    #[test]
    fn threads_are_fitted_to_the_limit() {
        let m = Memory {
            shared: 100,
            per_thread: 30,
        };
        assert_eq!(m.threads_within(129, 4), None);
        assert_eq!(m.threads_within(99, 4), None);
        assert_eq!(m.threads_within(130, 4), Some(1));
        assert_eq!(m.threads_within(1000, 4), Some(4));
        assert!(m.on(m.threads_within(200, 9).unwrap()) <= 200);
    }

    /// Memory grows with a longer delay, a smaller mass and more histories, up to the most that a
    /// motion keeps.
    #[test]
    fn pasts_grow_with_the_delay_up_to_what_is_kept() {
        let past = (MOST_KEPT * BYTES_OF_A_STEP) as u64;
        let (short, long) = (
            memory("outcome", "v0 = 0.3", 2.0),
            memory("outcome", "v0 = 0.3", 1e9),
        );
        assert!(short.per_thread < long.per_thread);
        assert!(long.per_thread - PER_THREAD >= past);
        let critical = memory("vc", "", 1e9);
        assert!(critical.per_thread >= PASTS_OF_CRITICAL * past);
        assert!(critical.on(2) < 500 << 20, "{critical:?}");
    }
}
