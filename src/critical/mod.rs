//! The critical velocity v_c: the velocity of the pull below which stick-slip survives.
//!
//! - [`limit`]: Coulomb friction, load control, τ → 0: closed form (the letter's Fig. 4)
//! - `search`: by the first road that leads to it; `one_slip` and `orbit` raise v0 (`climb`) to
//!   where stick-slip ends (`ends`)
//! - [`mod@line`]: along a line of delays, each from its neighbour's orbit
//! - [`follow`]: by simulation, v0 raised step by step
//! - [`switch_on`]: by the other protocol, the windows in which stick-slip survives switching on
//! - [`cycle`]: one slip and one stick

mod beyond;
mod climb;
pub mod cycle;
mod ends;
pub mod follow;
pub mod limit;
pub mod line;
mod one_slip;
mod orbit;
mod search;
mod sticking;
mod stops;
pub mod switch_on;
mod track;
mod trend;

use crate::linear::rightmost::Rightmost;
use crate::linear::{Count, Crossings, MarginalTolerance};
use crate::model::friction::Kind;
use crate::model::{FrictionLaw, Groups};
use crate::slip::motion::{Accuracy, Parameters};
use crate::slip::outcome::Outcome;
use cycle::Period;
use ends::Found;
use follow::{Fate, Followed, Pace, Sustained};

/// A controlled oscillator whose critical velocity is asked for, in the units of
/// [`crate::slip::motion`].
#[derive(Debug, Clone, PartialEq)]
pub struct Problem {
    /// The friction law.
    pub law: FrictionLaw,
    /// N0/√(κM), the unit of velocity in which the law's speeds are given.
    pub velocity_unit: f64,
    /// α_v √(M/κ).
    pub alpha_v: f64,
    /// α_N/κ.
    pub alpha_n: f64,
    /// τ √(κ/M).
    pub tau: f64,
}

impl Problem {
    /// A motion's parameters at `v0`, with control from `switch_on` on.
    #[must_use]
    pub fn at(&self, v0: f64, switch_on: f64) -> Parameters {
        let controlled = self.alpha_v != 0.0 || self.alpha_n != 0.0;
        Parameters {
            law: self.law.clone(),
            velocity_unit: self.velocity_unit,
            alpha_v: self.alpha_v,
            alpha_n: self.alpha_n,
            tau: self.tau,
            v0,
            switch_on: if controlled { switch_on } else { f64::INFINITY },
        }
    }

    /// How long to wait for a motion's outcome at `v0`: transients, many delays, and thirty of the
    /// longest cycles.
    fn patience(&self, v0: f64) -> f64 {
        let longest_cycle = 2.0 * self.law.mu_s() / v0 + 10.0;
        600.0 + 20.0 * self.tau + 30.0 * longest_cycle
    }

    /// The groups of linear stability at `v0`.
    #[must_use]
    pub fn groups(&self, v0: f64) -> Groups {
        let speed = v0 * self.velocity_unit;
        Groups::new(
            self.law.mu_prime(speed) * self.velocity_unit,
            self.alpha_v,
            self.law.mu_k(speed) * self.alpha_n,
        )
    }

    /// The number of unstable roots of sliding at `v0`.
    #[must_use]
    pub fn count(&self, v0: f64) -> Count {
        Crossings::of(self.groups(v0)).count(self.tau, MarginalTolerance::default())
    }

    /// The spectral abscissa of sliding at `v0`, if it is stable.
    #[must_use]
    pub fn stable_abscissa(&self, v0: f64) -> Option<f64> {
        let count = self.count(v0);
        if !count.stable() {
            return None;
        }
        let rightmost = Rightmost::at(self.groups(v0), self.tau, 1, count);
        let root = rightmost.roots.first().filter(|_| rightmost.certified);
        root.map(|root| root.lambda.re)
            .filter(|abscissa| *abscissa < 0.0)
    }
}

/// How stick-slip ends at v_c.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum End {
    /// The slip grazes ẋ = ẍ = 0 at its end.
    Grazing,
    /// The orbit vanishes or loses its stability while its stops are still crossings of ẋ = 0.
    Fold,
    /// The last stick-slip has more than one slip in a period: one period has doubled before.
    PeriodDoubling,
    /// The last stick-slip does not repeat.
    Irregular,
    /// N ≤ 0 on the way: the model ends at `v_liftoff`, and there is no v_c.
    LiftOff,
    /// It survives up to the largest v0 that was tried.
    Persists,
    /// No stick-slip is sustained at any v0 that was tried: v_c = 0.
    Never,
    /// It does not survive switching on above v_c, whatever it becomes: by the protocol
    /// [`switch_on`] no more is known.
    Lost,
}

impl End {
    /// All.
    pub const ALL: [Self; 8] = [
        Self::Grazing,
        Self::Fold,
        Self::PeriodDoubling,
        Self::Irregular,
        Self::LiftOff,
        Self::Persists,
        Self::Never,
        Self::Lost,
    ];

    /// The name in maps and messages.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Grazing => "grazing",
            Self::Fold => "fold",
            Self::PeriodDoubling => "period-doubling",
            Self::Irregular => "irregular",
            Self::LiftOff => "lift-off",
            Self::Persists => "persists",
            Self::Never => "never",
            Self::Lost => "lost",
        }
    }
}

/// What gave a critical velocity.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Method {
    /// One slip without memory, at its graze or at its lift-off.
    GrazeSlip,
    /// The orbit, at its graze, at its lift-off or where its stick vanishes.
    GrazeOrbit,
    /// Simulation, see [`follow`].
    Simulation,
}

impl Method {
    /// All, in the order of their numbers in a map.
    pub const ALL: [Self; 3] = [Self::GrazeSlip, Self::GrazeOrbit, Self::Simulation];

    /// The name in maps and messages.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::GrazeSlip => "graze-slip",
            Self::GrazeOrbit => "graze-orbit",
            Self::Simulation => "simulation",
        }
    }
}

/// The critical velocity of a problem, in the units of [`crate::slip::motion`]; NaN for what there
/// is not.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Critical {
    /// The largest v0 at which stick-slip persists; 0 where it never does.
    pub vc: f64,
    /// How it ends there.
    pub end: End,
    /// What gave the answer.
    pub method: Method,
    /// The smallest v0 at which N ≤ 0 occurs, where that ends stick-slip.
    pub v_liftoff: f64,
    /// Time stuck in a period at v_c.
    pub stick_time: f64,
    /// Time in slip in a period at v_c.
    pub slip_time: f64,
    /// The smallest N at v_c.
    pub n_min: f64,
    /// Whether stick-slip was sustained at any v0 that was tried.
    pub sustained: bool,
    /// Whether it is known what becomes of the motion beyond v_c.
    pub decided: bool,
}

impl Critical {
    /// The v0 at which stick-slip ends, or the model with it; NaN where it persists.
    #[must_use]
    pub fn end_of_stick_slip(&self) -> f64 {
        match self.end {
            End::LiftOff => self.v_liftoff,
            _ => self.vc,
        }
    }

    /// Whether `other` says the same of the end of stick-slip: at v_c, or the velocity of lift-off,
    /// within [`GRAZE_PRECISION`].
    ///
    /// Both have to lift off, to persist or never to be stick-slip; by which of the other ends it
    /// is lost is told from the last v0 that holds it alone, whose cycles need not have come to
    /// repeat, so that is not compared.
    #[must_use]
    pub fn ends_like(&self, other: &Self) -> bool {
        let near =
            |a: f64, b: f64| a.is_nan() && b.is_nan() || (a - b).abs() <= GRAZE_PRECISION * a.abs();
        let apart = |end: End| matches!(end, End::LiftOff | End::Persists | End::Never);
        let alike = self.end == other.end || !apart(self.end) && !apart(other.end);
        alike && near(self.vc, other.vc) && near(self.v_liftoff, other.v_liftoff)
    }
}

/// The critical velocity with all windows of v0 in which stick-slip survives.
#[derive(Debug, Clone, PartialEq)]
pub struct CriticalWindows {
    /// v_c and what there is at it.
    pub critical: Critical,
    /// Where stick-slip survives, up to the largest v0 at which it is looked for: v0 from and to,
    /// increasing. The last one may end at v_c, where N ≤ 0 occurs, or with the range.
    pub windows: Vec<[f64; 2]>,
}

/// v_c by a graze is known to about this, relative.
pub const GRAZE_PRECISION: f64 = 1e-4;
/// Error allowed in a step on the way to a graze.
const GRAZE_TOLERANCE: f64 = 1e-6;
/// Error allowed in a step where stick-slip is followed.
const FOLLOW_TOLERANCE: f64 = 1e-8;

/// The largest v0 at which stick-slip of `problem` persists while v0 is raised from low values:
/// protocol `follow`.
#[must_use]
pub fn critical_velocity(problem: &Problem) -> Critical {
    search::from_scratch(problem).0
}

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
fn gliding(found: &Critical) -> Pace {
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
fn confirmed(
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

/// What an end that was found by `method` tells; none where it does not.
fn of_found(found: &Found, method: Method) -> Option<Critical> {
    match found {
        Found::Graze(v0, period) => Some(of_orbit((*v0, End::Grazing), period, method)),
        Found::Vanish(v0, period) => Some(of_orbit((*v0, End::Fold), period, method)),
        Found::LiftOff(v0) => Some(of_lift_off(*v0, method)),
        Found::Changes(_) | Found::Persists(_) | Found::Irregular | Found::Unclear => None,
    }
}

/// Without control, under Coulomb friction, stick-slip persists at every v0: a slip from a = μ_S
/// goes half round the circle about sliding and comes to a stop at a = 2 μ_K − μ_S, where the block
/// sticks.
fn persists_without_control(problem: &Problem) -> bool {
    let uncontrolled = problem.alpha_v == 0.0 && problem.alpha_n == 0.0;
    let mu_s = problem.law.mu_s();
    uncontrolled && matches!(problem.law.kind(), Kind::Coulomb { mu0 } if *mu0 < mu_s)
}

fn of_orbit((vc, end): (f64, End), period: &Period, method: Method) -> Critical {
    // At the graze itself, that of the first slip, it lasts until the minimum of ẋ.
    let longer = match end {
        End::Grazing => period.cycles()[0].to_minimum.min(period.stick_time()),
        _ => 0.0,
    };
    Critical {
        stick_time: period.stick_time() - longer,
        slip_time: period.slip_time() + longer,
        n_min: period.n_min(),
        ..nothing(vc, end, method)
    }
}

fn of_lift_off(v0: f64, method: Method) -> Critical {
    Critical {
        v_liftoff: v0,
        n_min: 0.0,
        ..nothing(f64::NAN, End::LiftOff, method)
    }
}

fn nothing(vc: f64, end: End, method: Method) -> Critical {
    Critical {
        vc,
        end,
        method,
        v_liftoff: f64::NAN,
        stick_time: f64::NAN,
        slip_time: f64::NAN,
        n_min: f64::NAN,
        sustained: end != End::Never,
        decided: true,
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
fn told(followed: &Followed) -> Critical {
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
            ..of_lift_off(lost.v0, method)
        },
        (None, _) => Critical {
            decided,
            ..nothing(0.0, End::Never, method)
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
                ..nothing(f64::NAN, end, method)
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
