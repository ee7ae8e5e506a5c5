//! The answers of searches by simulation, alone and together.

use super::options::RampOptions;
use super::problem::{CriticalVelocity, GRAZE_PRECISION, Method, Problem};
use super::ramp::from_low_velocity;
use super::regime::{Regime, Response};
use super::search::{Chance, Ramped, Search};
use super::transition::Transition;
use crate::slip::motion::Accuracy;

/// The critical velocity by simulation alone, whatever continuation says.
#[must_use]
pub fn by_simulation(
    problem: &Problem,
    options: &RampOptions,
    accuracy: Accuracy,
) -> CriticalVelocity {
    let ramped = from_low_velocity(problem, options, accuracy).ramped;
    // The end of irregular stick-slip depends on the steps of v0 and on the time for which each v0
    // is held, so one search does not decide it.
    let irregular = |last: &Response| last.regime == Regime::Irregular;
    let by_chance = ramped.lost.is_some() && ramped.last.as_ref().is_some_and(irregular);
    let critical = told(&ramped, options);
    CriticalVelocity {
        decided: critical.decided && !by_chance && ramped.chance != Chance::AtEnd,
        ..critical
    }
    .within_limits(problem)
}

/// Options with which v0 glides to near the end of stick-slip that was `found`: by small steps,
/// without waiting for the outcome at each.
pub(super) fn gliding(found: &CriticalVelocity, options: &RampOptions) -> RampOptions {
    let end = found.end_of_stick_slip();
    RampOptions {
        first: options.glide_step,
        largest: options.glide_step,
        unseen: options.glide_step,
        glide: if end.is_nan() {
            f64::INFINITY
        } else {
            end * (1.0 - options.glide_end)
        },
        trials: options.glide_trials,
        total_steps: options.glide_steps,
        ..*options
    }
}

/// The answer of the `first` search, made with `options`, and all searches made. It is decided only
/// if two more searches agree: one with other steps of v0 and a finer integration, and one in which
/// v0 glides. `usual` are the options without those special to this search.
pub(super) fn confirmed(
    first: Search,
    options: &RampOptions,
    usual: &RampOptions,
    search: impl Fn(&RampOptions, f64) -> Search,
) -> (CriticalVelocity, Vec<Search>) {
    let critical = told(&first.ramped, usual);
    let other = RampOptions {
        first: options.confirm_first,
        largest: options.confirm_first,
        ..*options
    };
    let glide = gliding(&critical, usual);
    let mut decided = critical.decided;
    let others = [
        (other, options.confirm_tolerance),
        (glide, options.tolerance),
    ];
    let mut searches = vec![first];
    for (options, tolerance) in others {
        let again = search(&options, tolerance);
        let tells = told(&again.ramped, usual);
        decided &= tells.decided && critical.ends_like(&tells);
        searches.push(again);
    }
    let critical = CriticalVelocity {
        decided,
        ..critical
    };
    (critical, searches)
}

/// The answer of a search. Where stick-slip ends by chance, it has to be compared with others.
pub(super) fn told(ramped: &Ramped, options: &RampOptions) -> CriticalVelocity {
    let method = Method::Simulation;
    let undecided = |lost: &Response| lost.regime == Regime::Undecided;
    // Sticks that only become shorter and shorter are lost to rounding as well.
    let short = |last: &Response| last.summary.stick_time < options.vanishing_stick;
    let rounding = |last: &Response| short(last) && !ramped.vanish;
    let decided = ramped.complete
        && !ramped.lost.as_ref().is_some_and(undecided)
        && !ramped.last.as_ref().is_some_and(rounding);
    match (ramped.last, ramped.lost) {
        (_, Some(lost)) if lost.regime == Regime::LiftOff => CriticalVelocity {
            sustained: ramped.last.is_some(),
            decided: ramped.complete,
            ..CriticalVelocity::of_lift_off(lost.v0, method)
        },
        (None, _) => CriticalVelocity {
            decided,
            ..CriticalVelocity::nothing(0.0, Transition::Never, method)
        },
        (Some(last), lost) => {
            let transition = match lost {
                Some(_) => transition(&last, ramped.graze_step, options),
                None => Transition::Persists,
            };
            let longer = match transition {
                Transition::Grazing => last.to_minimum,
                _ => 0.0,
            };
            CriticalVelocity {
                vc: if lost.is_some() { last.v0 } else { f64::NAN },
                vc_lower: last.v0,
                vc_upper: lost.map_or(f64::NAN, |lost| lost.v0),
                // With rounding the time of a stick that vanishes could become negative.
                stick_time: last.summary.stick_time - longer.min(last.summary.stick_time),
                slip_time: last.summary.slip_time + longer,
                n_min: last.summary.n_min,
                decided,
                ..CriticalVelocity::nothing(f64::NAN, transition, method)
            }
        }
    }
}

/// How stick-slip ends, from the last response before it is lost.
fn transition(last: &Response, graze_step: f64, options: &RampOptions) -> Transition {
    match last.regime {
        Regime::Irregular => Transition::Irregular,
        // Also of doubled stick-slip: one of the stops of its period grazes.
        _ if last.depth.abs() < options.grazing * last.v0 || graze_step < GRAZE_PRECISION => {
            Transition::Grazing
        }
        _ if last.summary.slips > 1 => Transition::PeriodDoubling,
        _ => Transition::Fold,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::slip::outcome::{Outcome, Summary};

    fn response(v0: f64, regime: Regime) -> Response {
        Response {
            v0,
            regime,
            summary: Summary {
                stick_time: 2.0,
                slip_time: 3.0,
                n_min: 0.5,
                slips: 1,
                ..Summary::without(Outcome::StickSlip)
            },
            to_minimum: 0.25,
            depth: 0.1 * v0,
        }
    }

    fn ramped(last: Option<Response>, lost: Option<Response>) -> Ramped {
        Ramped {
            last,
            lost,
            complete: true,
            chance: Chance::None,
            vanish: false,
            graze_step: f64::INFINITY,
        }
    }

    fn answer(ramped: &Ramped) -> CriticalVelocity {
        told(ramped, &RampOptions::default())
    }

    #[test]
    fn how_stick_slip_ends_is_told_from_its_last_response() {
        let lost = Some(response(0.401, Regime::Slips));
        let fold = answer(&ramped(Some(response(0.4, Regime::Periodic)), lost));
        assert_eq!((fold.vc, fold.transition), (0.4, Transition::Fold));
        assert_eq!(
            (fold.stick_time, fold.slip_time, fold.n_min),
            (2.0, 3.0, 0.5)
        );
        assert!(fold.decided && fold.sustained);

        let mut shallow = response(0.4, Regime::Periodic);
        shallow.depth = 1e-4 * shallow.v0;
        let graze = answer(&ramped(Some(shallow), lost));
        assert_eq!(graze.transition, Transition::Grazing);
        assert_eq!((graze.stick_time, graze.slip_time), (1.75, 3.25));
        let predicted = Ramped {
            graze_step: 1e-5,
            ..ramped(Some(response(0.4, Regime::Periodic)), lost)
        };
        assert_eq!(answer(&predicted).transition, Transition::Grazing);

        let mut doubled = response(0.4, Regime::Periodic);
        doubled.summary.slips = 2;
        let doubled = answer(&ramped(Some(doubled), lost));
        assert_eq!(doubled.transition, Transition::PeriodDoubling);
        let irregular = answer(&ramped(Some(response(0.4, Regime::Irregular)), lost));
        assert_eq!(irregular.transition, Transition::Irregular);
    }

    #[test]
    fn what_is_not_lost_persists_and_what_is_not_there_never_was() {
        let persists = answer(&ramped(Some(response(100.0, Regime::Periodic)), None));
        assert_eq!(persists.transition, Transition::Persists);
        assert!(persists.vc.is_nan() && persists.decided);
        let never = answer(&ramped(None, Some(response(1e-6, Regime::Slips))));
        assert_eq!((never.vc, never.transition), (0.0, Transition::Never));
        let lifted = answer(&ramped(None, Some(response(0.2, Regime::LiftOff))));
        assert_eq!(
            (lifted.v_liftoff, lifted.transition),
            (0.2, Transition::LiftOff)
        );
        assert!(!lifted.sustained);
    }

    #[test]
    fn what_is_lost_to_rounding_or_to_a_limit_is_not_decided() {
        let lost = Some(response(0.401, Regime::Slips));
        let mut short = response(0.4, Regime::Periodic);
        short.summary.stick_time = 1e-7;
        assert!(!answer(&ramped(Some(short), lost)).decided);
        let vanish = Ramped {
            vanish: true,
            ..ramped(Some(short), lost)
        };
        assert!(answer(&vanish).decided);
        let unknown = Some(response(0.401, Regime::Undecided));
        assert!(!answer(&ramped(Some(response(0.4, Regime::Periodic)), unknown)).decided);
        let cut_off = Ramped {
            complete: false,
            ..ramped(Some(response(0.4, Regime::Periodic)), lost)
        };
        assert!(!answer(&cut_off).decided);
    }

    /// Another first step, a finer integration and a glide have to come to the same end.
    #[test]
    fn an_end_is_confirmed_by_three_searches() {
        let usual = RampOptions::default();
        let at = |v0: f64| {
            let lost = response(v0 * 1.001, Regime::Slips);
            ramped(Some(response(v0, Regime::Periodic)), Some(lost))
        };
        let confirm = |other: f64, glided: f64| {
            let without_motion = |ramped| Search {
                ramped,
                motion: None,
                step: usual.largest,
            };
            let search = |options: &RampOptions, tolerance: f64| {
                if options.glide > 0.0 {
                    assert!((options.glide / 0.4 - 0.98).abs() < 1e-12);
                    return without_motion(at(glided));
                }
                assert_eq!((options.first, tolerance), (0.2, 1e-10));
                without_motion(at(other))
            };
            let first = without_motion(at(0.4));
            let (found, searches) = confirmed(first, &usual, &usual, search);
            let ends = searches.iter().map(|search| search.ramped.last.unwrap().v0);
            assert_eq!(ends.collect::<Vec<_>>(), [0.4, other, glided]);
            found.decided
        };
        assert!(confirm(0.40001, 0.39999));
        assert!(!confirm(0.41, 0.4) && !confirm(0.4, 0.41));
    }

    #[test]
    fn v0_glides_to_any_height_where_there_is_no_end() {
        let usual = RampOptions::default();
        let persists = answer(&ramped(Some(response(100.0, Regime::Periodic)), None));
        assert_eq!(gliding(&persists, &usual).glide, f64::INFINITY);
    }
}
