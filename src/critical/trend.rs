//! What stick-slip at one v0 and at the next one tell: whether it is of one kind, and where it is
//! expected to end.

use super::climb::thrown;
use super::pace::Sustained;

/// Whether a relative `step` of v0 threw the motion from one kind of periodic stick-slip to
/// another: the mean cycle or the mean slip of its period changed by more than such a step
/// explains.
pub(super) fn jumps(last: &Sustained, there: &Sustained, step: f64) -> bool {
    let mean = |s: &Sustained| {
        let slips = f64::from(s.summary.slips.max(1));
        [s.summary.period / slips, s.summary.slip_time / slips]
    };
    thrown(mean(last), mean(there), step)
}

/// The relative way within which sticks that become shorter vanish.
const SOON: f64 = 1e-2;

/// Whether sticks, from one v0 to the next, become shorter such that none is left soon.
pub(super) fn vanishes(before: &Sustained, last: &Sustained) -> bool {
    let loss = (before.summary.stick_time - last.summary.stick_time) / (last.v0 - before.v0);
    loss > 0.0 && last.summary.stick_time / loss < SOON * last.v0
}

/// The relative way to where the first of the depth of the stops, the smallest load and the sticks
/// is expected to vanish.
pub(super) fn expected_way(before: Option<Sustained>, last: &Sustained) -> f64 {
    ways(before, last).into_iter().fold(f64::INFINITY, f64::min)
}

/// The relative ways to where the depth of the stops, the smallest load and the sticks are expected
/// to vanish.
pub(super) fn ways(before: Option<Sustained>, last: &Sustained) -> [f64; 3] {
    let Some(before) = before.filter(|before| before.alike(last)) else {
        return [f64::INFINITY; 3];
    };
    let run = last.v0 - before.v0;
    let gauges = [
        (before.depth, last.depth),
        (-before.summary.n_min, -last.summary.n_min),
        (-before.summary.stick_time, -last.summary.stick_time),
    ];
    gauges.map(|(before, last_one)| {
        let slope = (last_one - before) / run;
        match slope > 0.0 {
            true => -last_one / slope / last.v0,
            false => f64::INFINITY,
        }
    })
}
