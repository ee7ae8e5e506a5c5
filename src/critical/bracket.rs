//! Bounds of the critical velocity where searches disagree, or none came to its end.
//!
//! Stick-slip was seen to persist up to the lowest end that any search came to, and was lost by all
//! of them at the highest one. Where it ends by chance, another search would come to an end beyond
//! these as often as not. So a slow search is added, that holds stick-slip for many cycles at every
//! v0: it comes to a low end, and slower ones to one that is lower by about as much as the slow
//! ones differ. The lower bound is that much lower: all of them came through it. The upper bound
//! goes up from the highest end of slow searches, to a v0 at which stick-slip is lost from every
//! phase of its cycle.

use super::confirmation::{gliding, told};
use super::options::{BracketOptions, RampOptions};
use super::problem::{CriticalVelocity, Problem};
use super::ramp::{self, from_low_velocity};
use super::regime::{Regime, response_at_length};
use super::search::{Chance, Search};
use super::transition::Transition;
use crate::slip::motion::{Accuracy, Event, Motion};

/// An answer, with its bounds: where it is decided, itself; else those that the `searches` give,
/// and `others`, the answers that were come to besides.
///
/// What chance had a part in, or what takes long to show, is decided where slow steps come to it as
/// well.
pub(super) fn bounded(
    problem: &Problem,
    mut critical: CriticalVelocity,
    mut searches: Vec<Search>,
    others: &[CriticalVelocity],
) -> CriticalVelocity {
    if critical.decided {
        let by_itself = critical.bounded_by_itself(problem.v_max());
        let long = problem.slower() > problem.options.bracket.long_sticks;
        let doubtful = |search: &Search| search.ramped.chance != Chance::None || long;
        if others.is_empty() && !searches.iter().any(doubtful) {
            return by_itself;
        }
        let slowly = slow(problem, by_itself.vc_lower);
        let agrees = critical.ends_like(&told(&slowly.ramped, &problem.options.ramp));
        // Sticks that have become too short to be told from none may go on for long.
        let vanished = long && critical.stick_time < problem.options.bracket.short_stick;
        if agrees && !vanished {
            return by_itself;
        }
        critical.decided = false;
        searches.push(slowly);
    } else {
        if searches.is_empty() {
            searches.extend(usual_and_gliding(problem, &critical));
        }
        searches.push(slow(problem, lowest(&searches, &critical, others)));
    }
    between(problem, critical, &searches, others)
}

/// The lowest v0 to which any of the searches or answers came.
fn lowest(searches: &[Search], critical: &CriticalVelocity, others: &[CriticalVelocity]) -> f64 {
    let ends = others.iter().chain([critical]);
    let ends = ends.map(CriticalVelocity::end_of_stick_slip);
    let persist = searches.iter().map(Search::persists);
    // Not those that are NaN.
    ends.chain(persist).fold(f64::INFINITY, f64::min)
}

/// The bounds that searches and answers give.
fn between(
    problem: &Problem,
    critical: CriticalVelocity,
    searches: &[Search],
    others: &[CriticalVelocity],
) -> CriticalVelocity {
    let answers = || others.iter().chain([&critical]);
    let lowest = lowest(searches, &critical, others);
    let lifts_off = |answer: &CriticalVelocity| answer.transition == Transition::LiftOff;
    let lifted = lifts_off(&critical);
    let alike = answers().all(|answer| lifts_off(answer) == lifted)
        && searches.iter().all(|search| search.lifts_off() == lifted);
    // Large steps throw stick-slip beyond the end that it comes to while v0 is raised slowly.
    let step = problem.options.bracket.slow_step;
    let by_slow_steps = || searches.iter().filter(|search| search.step <= step);
    let farthest = by_slow_steps().max_by(|a, b| a.persists().total_cmp(&b.persists()));
    let highest = by_slow_steps().map(Search::lost).fold(lowest, f64::max);
    let [least, of_spread] = problem.options.bracket.below;
    let spread = if lowest > 0.0 {
        highest / lowest - 1.0
    } else {
        0.0
    };
    let below = (of_spread * spread).clamp(least, 0.5);
    let vc_lower = lowest * (1.0 - below);
    let vc_upper = farthest
        .and_then(|search| search.motion.as_ref())
        .filter(|_| alike)
        .and_then(|motion| lost_for_good(problem, motion, highest));
    CriticalVelocity {
        vc_lower,
        vc_upper: vc_upper.unwrap_or(f64::NAN),
        ..critical
    }
}

/// Searches by the usual steps, and gliding to near the end of an answer.
fn usual_and_gliding(problem: &Problem, critical: &CriticalVelocity) -> [Search; 2] {
    let usual = &problem.options.ramp;
    [*usual, gliding(critical, usual)].map(|options| from_low(problem, &options))
}

/// A slow search, from some way below the `lowest` end of others on: below that it would take
/// long, since sticks do.
fn slow(problem: &Problem, lowest: f64) -> Search {
    let usual = &problem.options.ramp;
    let options = &problem.options.bracket;
    let until = RampOptions {
        v_max: options.slow_from * lowest / problem.law.mu_s(),
        ..*usual
    };
    let step = options.slow_step;
    let slow = RampOptions {
        first: step,
        largest: step,
        unseen: step,
        cycles: options.slow_cycles,
        cycles_near_end: options.slow_cycles,
        trials: usual.glide_trials,
        total_steps: options.slow_steps,
        ..*usual
    };
    let below = from_low(problem, &until);
    match below.motion.filter(|_| below.ramped.lost.is_none()) {
        Some(motion) => ramp::from(problem, motion, &slow),
        None => from_low(problem, &slow),
    }
}

fn from_low(problem: &Problem, options: &RampOptions) -> Search {
    from_low_velocity(problem, options, Accuracy::of(options.tolerance))
}

/// The smallest v0 that was tried, from above the end at `from` on, at which the stick-slip of a
/// `motion` is lost from every phase of its cycle; none up to the end of the range.
fn lost_for_good(problem: &Problem, motion: &Motion, from: f64) -> Option<f64> {
    let options = &problem.options.bracket;
    let v_max = problem.v_max();
    let (mut base, mut v0, mut beyond) = (motion.clone(), from, options.above);
    for _ in 0..options.most_above {
        v0 *= 1.0 + beyond;
        if v0 > v_max {
            return None;
        }
        match from_every_phase(problem, &base, v0, options) {
            Beyond::Lost => return Some(v0),
            Beyond::Persists(there) => base = *there,
            Beyond::Unknown => {}
        }
        beyond = (2.0 * beyond).min(options.largest_above);
    }
    None
}

/// What becomes of stick-slip at a v0.
enum Beyond {
    /// It is lost from every phase.
    Lost,
    /// It persists from one.
    Persists(Box<Motion>),
    /// One is not known.
    Unknown,
}

/// What becomes of the stick-slip of `base` at `v0`, from some phases of its cycle.
fn from_every_phase(problem: &Problem, base: &Motion, v0: f64, options: &BracketOptions) -> Beyond {
    let mut start = base.clone();
    let mut trial = base.clone();
    let mut known = true;
    for phase in 0..options.phases {
        trial.copy_from(&start);
        trial.set_v0(v0);
        let regime = response_at_length(problem, &mut trial).regime;
        if regime.persists() {
            return Beyond::Persists(Box::new(trial));
        }
        known &= regime != Regime::Undecided;
        // By chance it may end at its own v0.
        if phase + 1 == options.phases || !part_of_cycle(&mut start, options) {
            break;
        }
    }
    match known {
        true => Beyond::Lost,
        false => Beyond::Unknown,
    }
}

/// Follows a motion to its next release or stop; false where it does not come to one.
fn part_of_cycle(motion: &mut Motion, options: &BracketOptions) -> bool {
    for _ in 0..options.steps_of_cycle {
        match motion.advance(f64::INFINITY) {
            Some(Event::Release | Event::Stick) => return true,
            Some(Event::LiftOff) => return false,
            _ if !motion.u.is_finite() => return false,
            _ => {}
        }
    }
    false
}

#[cfg(test)]
mod tests {
    use super::super::problem::Method;
    use super::super::synthetic::letters;
    use super::*;
    use crate::model::FrictionLaw;

    #[test]
    fn what_is_decided_bounds_itself() {
        let problem = letters(-0.33, 0.0, 4.15);
        let told = |critical| {
            let bounded = bounded(&problem, critical, Vec::new(), &[]);
            [bounded.vc_lower, bounded.vc_upper]
        };
        let of = |vc, transition| CriticalVelocity::nothing(vc, transition, Method::Simulation);
        assert_eq!(told(of(0.3, Transition::Grazing)), [0.3; 2]);
        assert_eq!(told(of(0.0, Transition::Never)), [0.0; 2]);
        let [lower, upper] = told(of(f64::NAN, Transition::Persists));
        assert!(lower == 100.0 && upper.is_nan());
        let lifted = CriticalVelocity::of_lift_off(0.2, Method::Simulation);
        assert_eq!(told(lifted), [0.2; 2]);
        let at_once = CriticalVelocity {
            sustained: false,
            ..lifted
        };
        assert!(told(at_once).iter().all(|bound| bound.is_nan()));
    }

    /// An end that is known to be at 0.344467, told as if it were not decided.
    #[test]
    fn bounds_are_on_both_sides_of_an_end() {
        let problem = letters(-0.33, 0.0, 4.15);
        let open = CriticalVelocity {
            decided: false,
            ..CriticalVelocity::nothing(0.344467, Transition::Grazing, Method::Simulation)
        };
        let found = bounded(&problem, open, Vec::new(), &[]);
        assert!(
            found.vc_lower < 0.344467 && found.vc_lower > 0.33,
            "{found:?}"
        );
        assert!(
            found.vc_upper > 0.344467 && found.vc_upper < 0.36,
            "{found:?}"
        );
        // Another answer, below, counts as well; one by another kind of end leaves it open above.
        let other = CriticalVelocity { vc: 0.3, ..open };
        let both = bounded(&problem, open, Vec::new(), &[other]);
        assert!(both.vc_lower < 0.3 && both.vc_upper > 0.344467, "{both:?}");
        let lifted = CriticalVelocity::of_lift_off(0.34, Method::Simulation);
        assert!(
            bounded(&problem, open, Vec::new(), &[lifted])
                .vc_upper
                .is_nan()
        );
    }

    #[test]
    fn where_there_is_no_stick_slip_there_is_no_upper_bound() {
        let law = FrictionLaw::coulomb(0.5, 1.0).unwrap();
        let problem = super::super::synthetic::problem(law, 0.0, -100.0, 0.05);
        let open = CriticalVelocity {
            decided: false,
            ..CriticalVelocity::nothing(0.0, Transition::Never, Method::Simulation)
        };
        let found = bounded(&problem, open, Vec::new(), &[]);
        assert!(found.vc_lower == 0.0 && found.vc_upper.is_nan());
    }
}
