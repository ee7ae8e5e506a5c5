//! The end of stick-slip of one problem, by the first of the roads that leads to it.

use super::answer::{Critical, End, Method};
use super::beyond::{Beyond, PRECISION, kind};
use super::climb::{GRAZE_TOLERANCE, LARGEST_STEP, Place, Road, climb_finely, jumps};
use super::ends::{CHANGED, FIRST_STEP, MOST_KINDS, RoadEnd, finish};
use super::follow::{self, Fate, Pace};
use super::one_slip::by_one_slip;
use super::orbit::Orbit;
use super::problem::Problem;
use super::simulated::{FOLLOW_TOLERANCE, confirmed, gliding, told};
use super::track::Track;
use crate::slip::motion::{Accuracy, Motion};

/// The largest v0 at which stick-slip of `problem` persists while v0 is raised from low values:
/// protocol `follow`.
#[must_use]
pub fn critical_velocity(problem: &Problem) -> Critical {
    from_scratch(problem).0
}

/// The first one where stick-slip goes on past the graze that was expected.
const LAST_STEP: f64 = 2.0 * PRECISION;

/// The critical velocity, and what a neighbour may start from.
pub(super) fn from_scratch(problem: &Problem) -> (Critical, Option<Track>) {
    if problem.persists_without_control() {
        let critical = Critical::nothing(f64::NAN, End::Persists, Method::Simulation);
        return (critical, None);
    }
    let accuracy = Accuracy::of(GRAZE_TOLERANCE);
    let one_slip = by_one_slip(problem, accuracy);
    if let Some(critical) = one_slip.and_then(|found| found.told(Method::GrazeSlip)) {
        return match ends_below_the_start(problem, &critical) && starts_above(problem, accuracy) {
            true => (simulated(problem), None),
            false => (critical, None),
        };
    }
    let Some((road, place)) = Orbit::sustained(problem, accuracy) else {
        return (simulated(problem), None);
    };
    let mut kinds = Kinds {
        problem,
        crossing: CROSSINGS[0],
        entry: None,
    };
    let (mut critical, mut track) = kinds.follow(road, place, LARGEST_STEP).end(problem);
    if let Some(entry) = kinds.entry.take()
        && critical.decided
    {
        let again = kinds.again((*entry).clone());
        let glided = kinds.glide(*entry, &critical);
        critical.decided = critical.ends_like(&again) && critical.ends_like(&glided);
    }
    if let Some(track) = &mut track {
        track.decided = critical.decided;
    }
    (critical, track)
}

/// Whether stick-slip of one slip ends below the velocity from which v0 is raised at first.
fn ends_below_the_start(problem: &Problem, critical: &Critical) -> bool {
    critical.vc < follow::STARTS[0] * problem.law.mu_s()
}

/// Whether there is stick-slip at the velocity that comes next then.
fn starts_above(problem: &Problem, accuracy: Accuracy) -> bool {
    let v0 = follow::STARTS[1] * problem.law.mu_s();
    let mut motion = follow::start_sticking(problem, v0, accuracy);
    matches!(
        kind(problem, &mut motion),
        Beyond::Persists(_) | Beyond::Irregular
    )
}

/// Relative steps of v0 through irregular stick-slip: where it leads should not depend on them.
const CROSSINGS: [f64; 2] = [0.1, 0.03];
/// The last ones: what ends by chance is known to this.
const LAST_CROSSING: f64 = 2e-5;

/// Where one kind of stick-slip after the other leads.
enum Reached {
    /// To the end of an orbit.
    End(Critical, Box<Track>),
    /// To an end by chance.
    Lost(Critical),
    /// To stick-slip from which simulation has to go on, by this step of v0 at first, relative.
    /// Motions at less and less high v0, each for the case that the one before is not sustained.
    Motion(Vec<Motion>, f64),
}

impl Reached {
    /// The end of stick-slip, and what a neighbour may start from.
    fn end(self, problem: &Problem) -> (Critical, Option<Track>) {
        match self {
            Self::End(critical, track) => (critical, Some(*track)),
            Self::Lost(critical) => (critical, None),
            Self::Motion(motions, step) => (simulated_from(problem, motions, step), None),
        }
    }
}

/// What follows a kind of stick-slip as v0 grows.
enum Next {
    /// One with so many slips in a period.
    Periodic(Motion, usize),
    Irregular(Motion),
    /// Stick-slip was lost, by this relative step of v0.
    Ends(f64),
    Unknown,
}

impl Next {
    /// What is seen of a motion after a relative `step` of v0.
    fn of(motion: Motion, beyond: Beyond, step: f64) -> Self {
        match beyond {
            Beyond::Persists(slips) => Self::Periodic(motion, slips),
            Beyond::Irregular => Self::Irregular(motion),
            Beyond::Ends(_) => Self::Ends(step),
            Beyond::Unknown => Self::Unknown,
        }
    }
}

/// One kind of stick-slip after the other.
struct Kinds<'p> {
    problem: &'p Problem,
    /// The largest step through irregular stick-slip.
    crossing: f64,
    /// Where irregular stick-slip was come to first.
    entry: Option<Box<Motion>>,
}

impl Kinds<'_> {
    /// From a place of an orbit on, by this relative `step` of v0 at first.
    fn follow(&mut self, mut road: Orbit, mut place: Place, mut step: f64) -> Reached {
        for kind in 0..MOST_KINDS {
            let start = road.motion().clone();
            let (climbed, at) = climb_finely(&mut road, place, step);
            let found = finish(self.problem, &mut road, climbed, &at);
            let next = match found {
                RoadEnd::Persists(slips) => Next::Periodic(road.tried().clone(), slips),
                RoadEnd::Irregular => Next::Irregular(road.tried().clone()),
                RoadEnd::Changes(v0) => match changed(self.problem, &mut road, v0) {
                    // Nothing is left of it.
                    Next::Ends(_) => {
                        return self.end(road, at, &RoadEnd::Vanish(v0, at.period), kind);
                    }
                    next => next,
                },
                RoadEnd::Unclear => recognised(self.problem, &road, &at),
                RoadEnd::Graze(..) | RoadEnd::Vanish(..) | RoadEnd::LiftOff(..) => {
                    return self.end(road, at, &found, kind);
                }
            };
            let from = |road: &Orbit| [road.motion().clone(), start.clone()].to_vec();
            let next = match next {
                Next::Irregular(motion) => self.cross(motion),
                Next::Periodic(motion, slips) => Ok((motion, slips)),
                Next::Ends(step) => return Reached::Motion(from(&road), step),
                Next::Unknown => return Reached::Motion(from(&road), FIRST_STEP),
            };
            let (motion, slips) = match next {
                Ok(next) => next,
                Err(critical) => return Reached::Lost(critical),
            };
            let before = std::mem::replace(&mut road, Orbit::of(motion, slips));
            let Some(first) = road.first_place() else {
                return Reached::Motion(from(&before), FIRST_STEP);
            };
            step = match jumps(&at.period, &first.period, 0.0) {
                true => FIRST_STEP,
                false => LAST_STEP,
            };
            place = first;
        }
        Reached::Motion(vec![road.motion().clone()], FIRST_STEP)
    }

    /// The end that the last kind of stick-slip has, after so many others.
    fn end(&self, road: Orbit, at: Place, found: &RoadEnd, others: usize) -> Reached {
        match found.told(Method::GrazeOrbit) {
            Some(critical) => {
                let mut track = Track::new(self.problem, road, at, found);
                track.one_kind = others == 0 && self.entry.is_none();
                Reached::End(critical, Box::new(track))
            }
            None => Reached::Motion(vec![road.motion().clone()], FIRST_STEP),
        }
    }

    /// Through irregular stick-slip, to where it repeats again; else to its end.
    fn cross(&mut self, mut motion: Motion) -> Result<(Motion, usize), Critical> {
        if self.entry.is_none() {
            self.entry = Some(Box::new(motion.clone()));
        }
        let v0 = motion.parameters().v0;
        let pace = Pace {
            first: self.crossing,
            largest: self.crossing,
            unseen: self.crossing,
            last: LAST_CROSSING,
            until_periodic: true,
            ..Pace::default()
        };
        let followed = follow::carry(self.problem, &mut motion, &pace);
        match followed.last {
            Some(last) if last.fate == Fate::Periodic => Ok((motion, last.summary.slips as usize)),
            Some(_) => Err(told(&followed)),
            // It was lost where it was come to.
            None => Err(Critical {
                decided: false,
                ..Critical::nothing(v0, End::Irregular, Method::Simulation)
            }),
        }
    }

    /// Once more from the first irregular stick-slip on, with other steps.
    fn again(&mut self, entry: Motion) -> Critical {
        self.crossing = CROSSINGS[1];
        let (motion, slips) = match self.cross(entry) {
            Ok(periodic) => periodic,
            Err(critical) => return critical,
        };
        let mut road = Orbit::of(motion, slips);
        let reached = match road.first_place() {
            Some(place) => self.follow(road, place, FIRST_STEP),
            None => Reached::Motion(vec![road.motion().clone()], FIRST_STEP),
        };
        reached.end(self.problem).0
    }

    /// Once more from the first irregular stick-slip on, while v0 glides to near the end that was
    /// `found`.
    fn glide(&mut self, mut entry: Motion, found: &Critical) -> Critical {
        let pace = gliding(found);
        let v_max = pace.v_max.min(pace.glide / self.problem.law.mu_s());
        if entry.parameters().v0 < pace.glide {
            let followed = follow::carry(self.problem, &mut entry, &Pace { v_max, ..pace });
            if followed.lost.is_some() || followed.last.is_none() || !followed.complete {
                return told(&followed);
            }
        }
        self.again(entry)
    }
}

/// How far beyond its last place a kind of stick-slip that was lost from sight is looked for,
/// relative: as far as it is still the same.
const NEXT: [f64; 4] = [1e-4, 1e-3, 5e-3, 2e-2];

/// What became of stick-slip beyond where it was last.
fn recognised(problem: &Problem, road: &Orbit, at: &Place) -> Next {
    let mut motion = road.motion().clone();
    let from = motion.parameters().v0;
    let mut next = Next::Unknown;
    for beyond in NEXT {
        let v0 = from * (1.0 + beyond);
        motion.set_v0(v0);
        let kind = kind(problem, &mut motion);
        let same = kind == Beyond::Persists(at.period.cycles().len());
        next = Next::of(motion.clone(), kind, beyond);
        if !same {
            break;
        }
    }
    next
}

/// What becomes of stick-slip beyond `v0`, where it is known to become of another kind.
fn changed(problem: &Problem, road: &mut Orbit, v0: f64) -> Next {
    let mut motion = road.place(v0 * (1.0 + CHANGED)).clone();
    let beyond = kind(problem, &mut motion);
    Next::of(motion, beyond, CHANGED)
}

/// By simulation from the first of some motions in stick-slip on that is sustained, v0 raised by a
/// relative `step` at first; from low velocities where none is.
fn simulated_from(problem: &Problem, motions: Vec<Motion>, step: f64) -> Critical {
    for motion in motions {
        let search = |pace: &Pace, tolerance: f64| {
            let mut motion = motion.clone();
            motion.refine(Accuracy::of(tolerance));
            let first = step * pace.first;
            follow::from(problem, motion, &Pace { first, ..*pace })
        };
        let patient = Pace {
            patient: true,
            ..Pace::default()
        };
        let followed = search(&patient, FOLLOW_TOLERANCE);
        if followed.last.is_some() {
            return confirmed(&followed, &patient, search);
        }
    }
    simulated(problem)
}

/// By simulation from low velocities on.
fn simulated(problem: &Problem) -> Critical {
    let search = |pace: &Pace, tolerance: f64| {
        follow::critical_velocity(problem, pace, Accuracy::of(tolerance))
    };
    let pace = Pace::default();
    confirmed(&search(&pace, FOLLOW_TOLERANCE), &pace, search)
}
