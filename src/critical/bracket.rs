//! The critical velocity where searches disagree or do not come to an end, and its bounds.
//!
//! Where stick-slip ends by chance, it ends at a lower v0 the longer it is held at each. So two
//! slow searches are added; the second holds each v0 longer than the first. Where they agree, their
//! end is v_c, that of v0 raised slowly. Else they bound it. The lower bound lies below the ends of
//! all searches, by as much as the slow ones differ. The upper bound is searched upwards from the
//! highest end of the slow ones: it is a v0 at which stick-slip is lost from every phase of its
//! cycle.

use super::confirmation::{gliding, told};
use super::options::{BracketOptions, Options, RampOptions};
use super::problem::{CriticalVelocity, Problem};
use super::ramp::{self, from_low_velocity};
use super::regime::{Followed, Observation, Regime, Simulated};
use super::search::{Chance, Search};
use super::transition::Transition;
use crate::slip::motion::Accuracy;

/// An answer with its bounds. A decided answer bounds itself. Else the bounds come from two slow
/// searches, from the `searches` made before and from the answers `others`.
///
/// Where chance had a part in a search, sticks are long or there are other answers, it stays
/// decided only if a slow search agrees with it; an end of irregular stick-slip, or one whose
/// sticks have vanished, only if two slow searches agree. Elsewhere it stays decided, an end of
/// irregular stick-slip too.
pub(super) fn bounded(
    problem: &Problem,
    critical: CriticalVelocity,
    mut searches: Vec<Search>,
    others: &[CriticalVelocity],
) -> CriticalVelocity {
    if critical.decided {
        let by_itself = critical.bounded_by_itself(problem.v_max());
        let long = long_sticks(problem);
        let doubtful = |search: &Search| search.ramped.chance != Chance::None || long;
        if others.is_empty() && !searches.iter().any(doubtful) {
            return by_itself;
        }
        let first = slow(problem, by_itself.vc_lower, Held::Long);
        let irregular = critical.transition == Transition::Irregular;
        let agrees = critical.ends_like(&told_slowly(problem, &first));
        if agrees && !irregular && !vanished(problem, &critical) {
            return by_itself;
        }
        return by_slow_searches(problem, critical, first, &searches, others);
    }
    if searches.is_empty() {
        searches.extend(usual_and_gliding(problem, &critical));
    }
    let first = slow(problem, lowest(&searches, &critical, others), Held::Long);
    by_slow_searches(problem, critical, first, &searches, others)
}

/// Whether velocity control makes sticks so long that searches may not wait for their outcome.
fn long_sticks(problem: &Problem) -> bool {
    problem.slower() > problem.options.bracket.long_sticks
}

/// Whether the sticks at an end are too short to be told from none. Where velocity control makes
/// sticks long, such short ones may still go on for long.
fn vanished(problem: &Problem, end: &CriticalVelocity) -> bool {
    long_sticks(problem) && end.stick_time < problem.options.bracket.short_stick
}

/// The answer of a slow search.
fn told_slowly(problem: &Problem, search: &Search) -> CriticalVelocity {
    told(&search.ramped, &problem.options.ramp)
}

/// The lowest v0 up to which stick-slip persists by any of the searches or answers.
fn lowest(searches: &[Search], critical: &CriticalVelocity, others: &[CriticalVelocity]) -> f64 {
    let ends = others.iter().chain([critical]);
    let ends = ends.map(CriticalVelocity::end_of_stick_slip);
    let persist = searches.iter().map(Search::persists);
    // The minimum ignores NaN.
    ends.chain(persist).fold(f64::INFINITY, f64::min)
}

/// The answer of the `first` slow search and a slower one, where `critical` is not certain.
fn by_slow_searches(
    problem: &Problem,
    critical: CriticalVelocity,
    first: Search,
    searches: &[Search],
    others: &[CriticalVelocity],
) -> CriticalVelocity {
    let lowest = lowest(searches, &critical, others).min(first.persists());
    let slower = slow(problem, lowest, Held::Longer);
    let [tells, again] = [&first, &slower].map(|search| told_slowly(problem, search));
    let agree = tells.decided && again.decided && again.ends_like(&tells);
    if agree && !vanished(problem, &again) {
        return again.bounded_by_itself(problem.v_max());
    }
    let critical = CriticalVelocity {
        decided: false,
        ..match [&slower, &first].map(|search| search.ramped.complete) {
            [true, _] => again,
            [false, true] => tells,
            [false, false] => critical,
        }
    };
    between(problem, critical, &[first, slower], searches, lowest)
}

/// The bounds from two slow searches and from the other searches, whose lowest end is `lowest`.
fn between(
    problem: &Problem,
    critical: CriticalVelocity,
    slow: &[Search; 2],
    searches: &[Search],
    lowest: f64,
) -> CriticalVelocity {
    let low = slow[0].persists().min(slow[1].persists());
    let high = slow[0].lost().max(slow[1].lost());
    let lowest = lowest.min(low);
    let spread = if low > 0.0 { high / low - 1.0 } else { 0.0 };
    let [least, of_spread] = problem.options.bracket.below;
    let below = (of_spread * spread).max(least);
    let below = below.min(problem.options.bracket.farthest_below);
    let alike = slow[0].lifts_off() == slow[1].lifts_off();
    // Motions of large steps are left out: those steps throw stick-slip beyond its end.
    let small = problem.options.bracket.slow_steps[0];
    let by_small_steps = searches.iter().filter(|search| search.step <= small);
    let motions = slow.iter().chain(by_small_steps);
    let motions = motions.filter_map(|search| search.motion.clone());
    let mut blocks: Vec<_> = motions
        .map(|motion| Simulated { problem, motion })
        .collect();
    let vc_upper = match alike {
        true => lost_for_good(&mut blocks, high, problem.v_max(), &problem.options),
        false => None,
    };
    CriticalVelocity {
        vc_lower: lowest * (1.0 - below),
        vc_upper: vc_upper.unwrap_or(f64::NAN),
        ..critical
    }
}

/// Two searches: by the usual steps, and with v0 gliding to near the end of an answer.
fn usual_and_gliding(problem: &Problem, critical: &CriticalVelocity) -> [Search; 2] {
    let usual = &problem.options.ramp;
    [*usual, gliding(critical, usual)].map(|options| from_low(problem, &options))
}

/// How long a slow search holds stick-slip at each v0.
#[derive(Clone, Copy)]
enum Held {
    Long,
    Longer,
}

/// The options of a slow search.
fn slow_options(options: &Options, held: Held) -> RampOptions {
    let (usual, bracket) = (&options.ramp, &options.bracket);
    let (step, longer) = match held {
        Held::Long => (bracket.slow_steps[0], 1.0),
        Held::Longer => (bracket.slow_steps[1], bracket.held_longer),
    };
    let cycles = bracket.slow_cycles.map(|cycles| longer * cycles);
    RampOptions {
        first: step,
        largest: step,
        unseen: step,
        cycles,
        cycles_near_end: cycles,
        cycles_at_length: cycles,
        patience: usual.patience.map(|time| longer * time),
        steps: (longer * usual.steps as f64) as u64,
        trials: usual.glide_trials,
        total_steps: bracket.steps,
        ..*usual
    }
}

/// A slow search that begins well below the `lowest` end of the others. From still lower velocities
/// it would take long, because sticks are long there.
fn slow(problem: &Problem, lowest: f64, held: Held) -> Search {
    let until = RampOptions {
        v_max: problem.options.bracket.slow_from * lowest / problem.law.mu_s(),
        ..problem.options.ramp
    };
    let slow = slow_options(&problem.options, held);
    let below = from_low(problem, &until);
    match below.motion.filter(|_| below.ramped.lost.is_none()) {
        Some(motion) => ramp::from(problem, motion, &slow),
        None => from_low(problem, &slow),
    }
}

fn from_low(problem: &Problem, options: &RampOptions) -> Search {
    from_low_velocity(problem, options, Accuracy::of(options.tolerance))
}

/// The smallest v0 tried above the end `from` at which the stick-slip of all blocks is lost from
/// every phase of its cycle. None where there is none up to `v_max`, or there is no block. The
/// blocks are left in their last states.
fn lost_for_good<F: Followed>(
    blocks: &mut [F],
    from: f64,
    v_max: f64,
    options: &Options,
) -> Option<f64> {
    if blocks.is_empty() {
        return None;
    }
    let bracket = &options.bracket;
    let held = slow_options(options, Held::Long);
    let (mut v0, mut beyond) = (from, bracket.above);
    for _ in 0..bracket.most_above {
        v0 *= 1.0 + beyond;
        if v0 > v_max {
            return None;
        }
        let mut lost = true;
        for block in &mut *blocks {
            match from_every_phase(block, v0, &held, bracket) {
                Beyond::Lost => {}
                Beyond::Persists(there) => {
                    *block = *there;
                    lost = false;
                    break;
                }
                Beyond::Unknown => lost = false,
            }
        }
        if lost {
            return Some(v0);
        }
        beyond = (2.0 * beyond).min(bracket.largest_above);
    }
    None
}

/// What stick-slip does at a v0 above its end.
enum Beyond<F> {
    /// Stick-slip is lost from every phase tried.
    Lost,
    /// Stick-slip persists from at least one phase.
    Persists(Box<F>),
    /// The outcome from at least one phase is not known.
    Unknown,
}

/// What the stick-slip of a block does at `v0`, from several phases of its cycle.
fn from_every_phase<F: Followed>(
    block: &F,
    v0: f64,
    held: &RampOptions,
    options: &BracketOptions,
) -> Beyond<F> {
    let mut start = block.clone();
    let mut trial = block.clone();
    let mut known = true;
    for phase in 0..options.phases {
        trial.copy_from(&start);
        let regime = trial
            .response_at(v0, &Observation::at_length(held, 0.0))
            .regime;
        if regime.persists() {
            return Beyond::Persists(Box::new(trial));
        }
        known &= regime != Regime::Undecided;
        // Irregular stick-slip can end by chance at the v0 of the block itself.
        if phase + 1 == options.phases || !start.next_phase(options.steps_of_cycle) {
            break;
        }
    }
    match known {
        true => Beyond::Lost,
        false => Beyond::Unknown,
    }
}

#[cfg(test)]
mod tests {
    use super::super::problem::Method;
    use super::super::synthetic::{Family, LOGISTIC, Synthetic, letters, problem};
    use super::super::transition::Transition;
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

    /// The chaos of the logistic map is lost at v0 = 4, from every phase; the orbit of the
    /// saddle-node is lost at v0 = 1.
    #[test]
    fn what_is_lost_for_good_is_so_just_beyond_its_end() {
        let options = Options {
            bracket: BracketOptions {
                above: 1e-3,
                ..BracketOptions::default()
            },
            ..Options::default()
        };
        let lost = |blocks: &mut [Synthetic], from: f64, v_max: f64| {
            lost_for_good(blocks, from, v_max, &options)
        };
        let chaos = Synthetic::new(LOGISTIC, 3.9, 0.4);
        // By steps of 1e-3, 2e-3, …: the first beyond 4 is 3.9 · 1.001 · 1.002 · … · 1.016.
        let steps = [1.0, 2.0, 4.0, 8.0, 16.0].map(|step| 1.0 + 1e-3 * step);
        let expected: f64 = steps.iter().product::<f64>() * 3.9;
        let found = lost(&mut [chaos.clone()], 3.9, 10.0).unwrap();
        assert!((found / expected - 1.0).abs() < 1e-12 && found > 4.0);
        assert_eq!(lost(&mut [chaos.clone()], 3.9, 3.95), None);
        assert_eq!(lost(&mut [], 3.9, 10.0), None);
        // Stick-slip that goes on from any one of the blocks is not lost.
        let fold = Synthetic::new(Family::SaddleNode, 0.99, 0.1);
        let alone = lost(&mut [fold.clone()], 0.999, 10.0).unwrap();
        assert!(alone > 1.0 && alone < 1.003, "{alone}");
        let both = lost(&mut [fold, chaos], 0.999, 10.0).unwrap();
        assert!(both > 4.0 && both < 5.3, "{both}");
    }

    /// Two slow searches that agree decide v_c, whatever fast ones said.
    #[test]
    fn slow_searches_that_agree_decide() {
        let problem = letters(-0.33, 0.0, 4.15);
        let open = CriticalVelocity {
            decided: false,
            ..CriticalVelocity::nothing(0.5, Transition::Irregular, Method::Simulation)
        };
        let found = bounded(&problem, open, Vec::new(), &[]);
        assert!(
            found.decided && (found.vc / 0.344467 - 1.0).abs() < 1e-5,
            "{found:?}"
        );
        assert_eq!([found.vc_lower, found.vc_upper], [found.vc; 2]);
        assert_eq!(found.transition, Transition::Grazing);
    }

    /// Two slow searches that differ bound v_c. Below, the margin grows with the spread of their
    /// ends.
    #[test]
    fn slow_searches_that_differ_bound() {
        let problem = letters(-0.33, 0.0, 4.15);
        let [near, far] = [Held::Long, Held::Longer].map(|held| slow(&problem, 0.3, held));
        let open = CriticalVelocity {
            decided: false,
            ..CriticalVelocity::nothing(0.344467, Transition::Grazing, Method::Simulation)
        };
        let bounds = |lowest: f64, first: f64| {
            let mut first_search = near.clone();
            let last = first_search.ramped.last.as_mut().unwrap();
            last.v0 = first;
            between(&problem, open, &[first_search, far.clone()], &[], lowest)
        };
        let alike = bounds(1.0, near.persists());
        assert!((alike.vc_lower / 0.344467 - 0.95).abs() < 1e-4, "{alike:?}");
        assert!(
            (alike.vc_upper / 0.344467 - 1.025).abs() < 1e-3,
            "{alike:?}"
        );
        // An end that is lower by a tenth lowers the bound by as much again.
        let spread = bounds(1.0, 0.9 * near.persists());
        let below = 0.9 * (2.0 - 1.0 / 0.9);
        assert!(
            (spread.vc_lower / 0.344467 - below).abs() < 1e-4,
            "{spread:?}"
        );
        let other = bounds(0.2, near.persists());
        assert!((other.vc_lower / 0.2 - 0.95).abs() < 1e-12, "{other:?}");
    }

    #[test]
    fn where_there_is_no_stick_slip_there_are_no_bounds_but_0() {
        let law = FrictionLaw::coulomb(0.5, 1.0).unwrap();
        let problem = problem(law, 0.0, -100.0, 0.05);
        let open = CriticalVelocity {
            decided: false,
            ..CriticalVelocity::nothing(0.0, Transition::Never, Method::Simulation)
        };
        let never = bounded(&problem, open, Vec::new(), &[]);
        assert!(never.decided && [never.vc_lower, never.vc_upper] == [0.0; 2]);
        let [first, slower] = [Held::Long, Held::Longer].map(|held| slow(&problem, 0.0, held));
        let found = between(&problem, open, &[first, slower], &[], 0.0);
        assert!(found.vc_lower == 0.0 && found.vc_upper.is_nan());
    }
}
