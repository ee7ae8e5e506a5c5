//! The end of a branch with history: continuation located an event; here the branch is brought
//! close to it, the event is checked, and the motion beyond it is followed.

use super::after_event::{after_graze, after_stick, sequel};
use super::continuation::{Branch, Point, Releases};
use super::event_functions::Event;
use super::options::Options;
use super::problem::Problem;
use super::return_map::{NoReturn, Period, ReturnMap};
use super::transition::{Ending, Located, Sequel, Undetermined, same_slip};
use super::with_history::WithHistory;
use crate::slip::motion::Motion;

/// Brings the branch from its last point to just below an event that was located.
///
/// # Errors
/// When the event is not there.
pub(super) fn approach<M: ReturnMap>(
    branch: &mut WithHistory<'_, M>,
    located: Located,
    at: &Point,
    options: &Options,
) -> Result<Ending, Undetermined> {
    match located.event {
        Event::Graze(slip) => approach_graze(branch, (located.v0, slip), at, options),
        Event::StickVanishes => approach_stick(branch, located, at, options),
        Event::LiftOff | Event::Reversal | Event::NewStop => {
            Ok(Ending::new(located, at.orbit.period))
        }
    }
}

fn approach_graze<M: ReturnMap>(
    branch: &mut WithHistory<'_, M>,
    (v0, slip): (f64, usize),
    at: &Point,
    options: &Options,
) -> Result<Ending, Undetermined> {
    let options = &options.transition;
    let mut period = at.orbit.period;
    if v0 > at.v0 * (1.0 + options.at_event * options.precision) {
        let below = v0 * (1.0 - options.precision);
        let last = branch.orbit_at(below, Some(&at.orbit.period), f64::INFINITY);
        let last = last.map_err(|_| Undetermined::NotConfirmed)?;
        if !same_slip(&last.period, &at.orbit.period, slip, options) {
            return Err(Undetermined::NotConfirmed);
        }
        branch.accept();
        period = last.period;
    }
    if slip > 0 && !branch.rotate(slip, &period) {
        return Err(Undetermined::NotConfirmed);
    }
    let period = period.rotated(slip);
    if !period.cycles()[0].to_minimum.is_finite() {
        return Err(Undetermined::NotConfirmed);
    }
    Ok(Ending {
        event: Event::Graze(0),
        v0,
        period,
    })
}

fn approach_stick<M: ReturnMap>(
    branch: &mut WithHistory<'_, M>,
    located: Located,
    at: &Point,
    options: &Options,
) -> Result<Ending, Undetermined> {
    let options = &options.transition;
    let below = located.v0 * (1.0 - options.precision);
    let orbit = branch.orbit_at(below, Some(&at.orbit.period), options.checked);
    let orbit = orbit.map_err(|_| Undetermined::NotConfirmed)?;
    if orbit.events.stick_time > options.vanishing_stick {
        return Err(Undetermined::NotConfirmed);
    }
    branch.accept();
    Ok(Ending::new(located, orbit.period))
}

/// What follows the end of a branch. The motion that showed it is left as the one that `branch`
/// tried last.
pub(super) fn verify(
    problem: &Problem,
    branch: &mut WithHistory<'_, Motion>,
    ending: &Ending,
) -> Sequel {
    let options = &problem.options;
    let (v0, period) = (ending.v0, &ending.period);
    let confirmed = match ending.event {
        Event::Graze(_) => attracts_below_graze(branch, v0, period, options),
        Event::StickVanishes => {
            let disturbed = options.transition.disturbed;
            attracts(branch.map().clone(), period, disturbed, options)
        }
        Event::LiftOff => lifts_off(branch, v0, options),
        Event::Reversal | Event::NewStop => true,
    };
    if !confirmed {
        return Sequel::Undetermined(Undetermined::NotConfirmed);
    }
    match ending.event {
        Event::Graze(_) => after_graze(problem, (v0, period.cycles()[0].slip), branch),
        Event::StickVanishes => after_stick(problem, v0, branch),
        Event::LiftOff => Sequel::Ends(1.0),
        Event::Reversal | Event::NewStop => {
            let past = options.transition.past_change;
            sequel(problem, branch.release_at(v0 * (1.0 + past)))
        }
    }
}

/// Whether the orbit just below a graze at `v0` attracts. Beyond a period doubling the orbit of the
/// single period goes on, unstable, to a graze of its own, which is not the end.
fn attracts_below_graze<M: ReturnMap>(
    branch: &mut WithHistory<'_, M>,
    v0: f64,
    period: &Period,
    options: &Options,
) -> bool {
    let checks = &options.transition;
    let below = v0 * (1.0 - checks.below_graze);
    match branch.orbit_at(below, Some(period), checks.at_rest) {
        Ok(orbit) => {
            let map = branch.tried().clone();
            attracts(map, &orbit.period, checks.disturbed_below_graze, options)
        }
        Err(_) => false,
    }
}

/// Whether stick-slip comes back to the orbit of `map` after v0 was lower in one period by the
/// share `disturbed`. Periods alone do not show it: an unstable orbit that is followed closely
/// seems to be at rest as well.
fn attracts<M: ReturnMap>(mut map: M, period: &Period, disturbed: f64, options: &Options) -> bool {
    let checks = &options.transition;
    let v0 = map.v0();
    let stick = period.cycles()[0].stick;
    map.set_v0(v0 * (1.0 - disturbed));
    let mut distances = (0..=checks.periods_back).map_while(|i| {
        let mut first = None;
        for _ in period.cycles() {
            let cycle = map.cycle(None, &options.continuation).ok()?;
            first.get_or_insert(cycle.stick);
        }
        if i == 0 {
            map.set_v0(v0);
        }
        first.map(|first| (first - stick).abs())
    });
    let Some(disturbed) = distances.next() else {
        return false;
    };
    let noise = checks.stick_noise.min(checks.stick_left * stick);
    let mut near = 0;
    for (period, distance) in distances.enumerate() {
        near = match distance < (checks.back * disturbed).max(noise) {
            true => near + 1,
            false => 0,
        };
        if near == checks.near_in_a_row {
            return true;
        }
        if period + 1 == checks.periods_back {
            return distance < (checks.back_at_last * disturbed).max(noise);
        }
    }
    false
}

/// Whether periods just below `v0` do not lift off, and just above it do.
fn lifts_off(branch: &mut impl Branch, v0: f64, options: &Options) -> bool {
    let checks = &options.transition;
    let beside = [1.0 - checks.lift_off, 1.0 + checks.lift_off].map(|share| share * v0);
    let mut lifts = |v0| {
        matches!(
            branch.orbit_at(v0, None, checks.checked),
            Err(NoReturn::LiftOff)
        )
    };
    !lifts(beside[0]) && lifts(beside[1])
}

#[cfg(test)]
mod tests {
    use super::super::continuation::continue_to_event;
    use super::super::synthetic::{Family, LOGISTIC, Synthetic, logistic_pair};
    use super::*;

    fn period(map: &mut Synthetic, slips: usize, options: &Options) -> Period {
        let mut cycles = [super::super::return_map::Cycle::NONE; 4];
        for cycle in &mut cycles[..slips] {
            *cycle = map.cycle(None, &options.continuation).unwrap();
        }
        Period::new(slips, cycles)
    }

    /// The fixed point of the logistic map attracts up to v0 = 3, the orbit of two slips from there
    /// to v0 = 1 + √6.
    #[test]
    fn orbits_attract_until_their_period_doubles() {
        let options = Options::default();
        for (v0, slips, expected) in [
            (2.5, 1, true),
            (2.95, 1, true),
            (3.05, 1, false),
            (3.2, 1, false),
            (3.3, 2, true),
            (3.4, 2, true),
            (3.5, 2, false),
        ] {
            let x = match slips {
                1 => 1.0 - 1.0 / v0,
                _ => logistic_pair(v0),
            };
            let mut map = Synthetic::new(LOGISTIC, v0, x);
            let period = period(&mut map, slips, &options);
            let disturbed = options.transition.disturbed;
            let found = attracts(map, &period, disturbed, &options);
            assert_eq!(found, expected, "{v0} {slips}");
        }
    }

    /// Nordmark's map: an orbit next to the graze attracts where the square root is weak.
    #[test]
    fn a_graze_ends_stick_slip_where_the_orbit_below_attracts() {
        let options = Options::default();
        for (s, expected) in [(1e-4, true), (0.1, false)] {
            let below = 1.0 - options.transition.below_graze;
            let x = 2.0 * s * (s - (s * s + 1.0 - below).sqrt());
            let mut map = Synthetic::new(Family::Nordmark(s), below, x);
            let period = period(&mut map.clone(), 1, &options);
            let mut branch = WithHistory::new(map.clone(), 1, 10.0, &options.continuation);
            assert!(map.cycle(None, &options.continuation).is_ok());
            let found = attracts_below_graze(&mut branch, 1.0, &period, &options);
            assert_eq!(found, expected, "{s}");
        }
    }

    #[test]
    fn lift_off_is_seen_on_both_sides() {
        let options = Options::default();
        for (event, v0, expected) in [
            (Event::LiftOff, 1.0, true),
            (Event::LiftOff, 0.999, false),
            (Event::LiftOff, 1.001, false),
            (Event::Graze(0), 1.0, false),
        ] {
            let map = Synthetic::new(Family::Vanishing(event), 0.99, 0.1);
            let mut branch = WithHistory::new(map, 1, 10.0, &options.continuation);
            assert_eq!(
                lifts_off(&mut branch, v0, &options),
                expected,
                "{event:?} {v0}"
            );
        }
    }

    /// The branch ends just below an event that was located.
    #[test]
    fn events_are_come_near_to() {
        let options = Options::default();
        for event in [Event::Graze(0), Event::StickVanishes] {
            let map = Synthetic::new(Family::Vanishing(event), 0.5, 0.1);
            let mut branch = WithHistory::new(map, 1, 10.0, &options.continuation);
            let first = branch.first_point().unwrap();
            let tuned = &options.continuation;
            let (located, at) = continue_to_event(&mut branch, first, 0.1, tuned);
            let ending = approach(&mut branch, located.unwrap(), &at, &options).unwrap();
            assert_eq!(ending.event, event);
            assert!((ending.v0 - 1.0).abs() < 1e-6);
            let below = ending.v0 - branch.map().v0;
            assert!((0.0..3e-5).contains(&below), "{below}");
            // It does not end at a v0 where no event was located.
            let elsewhere = Located { event, v0: 1.1 };
            let found = approach(&mut branch, elsewhere, &at, &options);
            assert_eq!(found, Err(Undetermined::NotConfirmed));
        }
    }
}
