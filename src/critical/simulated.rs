//! What searches by simulation tell, alone and together.

use super::answer::{Critical, End, GRAZE_PRECISION, Method};
use super::follow::{self, Fate, Followed, Pace, Sustained};
use super::problem::Problem;
use crate::slip::motion::Accuracy;
use crate::slip::outcome::Outcome;

/// Error allowed in a step where stick-slip is followed.
pub(super) const FOLLOW_TOLERANCE: f64 = 1e-8;
/// The first step of v0 of a search that confirms another one, and the error allowed in a step of
/// the integrator.
const CONFIRM_FIRST: f64 = 0.2;
const CONFIRM_TOLERANCE: f64 = 1e-10;
/// Relative steps of v0 that glides; and how far below the end, relative, it does no longer.
const GLIDE_STEP: f64 = 0.01;
const APPROACH: f64 = 0.02;
/// The most v0 on the way: more than lead from the lowest to the largest.
const GLIDE_TRIALS: u32 = 3000;

/// v0 glides to near the end of stick-slip that was found: by small steps, without waiting for what
/// it comes to on the way.
pub(super) fn gliding(found: &Critical) -> Pace {
    let end = found.end_of_stick_slip();
    Pace {
        first: GLIDE_STEP,
        largest: GLIDE_STEP,
        unseen: GLIDE_STEP,
        glide: if end.is_nan() {
            f64::INFINITY
        } else {
            end * (1.0 - APPROACH)
        },
        trials: GLIDE_TRIALS,
        ..Pace::default()
    }
}

/// What was `followed` by a `search` at this pace tells. v0 is raised slowly: an end that is
/// another one with other steps of v0, a finer integration, or while v0 glides, is not decided.
/// What ends by chance is where all of these tell the same.
pub(super) fn confirmed(
    followed: &Followed,
    pace: &Pace,
    search: impl Fn(&Pace, f64) -> Followed,
) -> Critical {
    let critical = told(followed);
    let other = Pace {
        first: CONFIRM_FIRST,
        largest: CONFIRM_FIRST,
        ..*pace
    };
    let agrees = |pace: &Pace, tolerance: f64| {
        let again = told(&search(pace, tolerance));
        again.decided && critical.ends_like(&again)
    };
    Critical {
        decided: critical.decided
            && agrees(&other, CONFIRM_TOLERANCE)
            && agrees(&gliding(&critical), FOLLOW_TOLERANCE),
        ..critical
    }
}

/// The critical velocity by simulation alone, whatever the other roads say.
#[must_use]
pub fn by_simulation(problem: &Problem, pace: &Pace, accuracy: Accuracy) -> Critical {
    of_followed(&follow::critical_velocity(problem, pace, accuracy))
}

/// What one search tells. Where irregular stick-slip ends depends on the steps of v0 and on how
/// long each is waited for: one search does not decide it.
fn of_followed(followed: &Followed) -> Critical {
    let irregular = |last: &Sustained| last.fate == Fate::Irregular;
    let by_chance = followed.lost.is_some() && followed.last.as_ref().is_some_and(irregular);
    let critical = told(followed);
    Critical {
        decided: critical.decided && !by_chance && !followed.creeps,
        ..critical
    }
}

/// What a search tells, to be compared with others where it ends by chance.
pub(super) fn told(followed: &Followed) -> Critical {
    let method = Method::Simulation;
    let undecided = |lost: &Sustained| lost.fate == Fate::Lost(Outcome::Undecided);
    // To rounding sticks are lost as well where they only become shorter and shorter.
    let rounding = |last: &Sustained| last.summary.stick_time < VANISHING && !followed.vanish;
    let decided = followed.complete
        && !followed.lost.as_ref().is_some_and(undecided)
        && !followed.last.as_ref().is_some_and(rounding);
    match (followed.last, followed.lost) {
        (_, Some(lost)) if lost.fate == Fate::LiftOff => Critical {
            sustained: followed.last.is_some(),
            decided: followed.complete,
            ..Critical::of_lift_off(lost.v0, method)
        },
        (None, _) => Critical {
            decided,
            ..Critical::nothing(0.0, End::Never, method)
        },
        (Some(last), lost) => {
            let end = end(&last, lost.is_some(), followed.graze_way);
            let longer = if end == End::Grazing {
                last.to_minimum
            } else {
                0.0
            };
            Critical {
                vc: if lost.is_some() { last.v0 } else { f64::NAN },
                // Rounding can leave less than none of a stick that vanishes.
                stick_time: last.summary.stick_time - longer.min(last.summary.stick_time),
                slip_time: last.summary.slip_time + longer,
                n_min: last.summary.n_min,
                decided,
                ..Critical::nothing(f64::NAN, end, method)
            }
        }
    }
}

/// Sticks shorter than this, over √(M/κ), are lost to rounding as v0 grows: what they end in is not
/// told.
const VANISHING: f64 = 1e-6;
/// Depth of a stop, over v0, below which it is a graze.
const GRAZING: f64 = 1e-3;

fn end(last: &Sustained, lost: bool, graze_way: f64) -> End {
    match last.fate {
        _ if !lost => End::Persists,
        Fate::Irregular => End::Irregular,
        // Of doubled stick-slip as well: one of the stops of its period.
        _ if last.depth.abs() < GRAZING * last.v0 || graze_way < GRAZE_PRECISION => End::Grazing,
        _ if last.summary.slips > 1 => End::PeriodDoubling,
        _ => End::Fold,
    }
}
