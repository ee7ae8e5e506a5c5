//! The share of starts from which control ends in sliding, at a point of parameter space.

use std::convert::Infallible;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use serde::Serialize;

use crate::answers::basin::{BasinProblem, Place, Region, STUDENT_95, Tally};
use crate::setting::Setting;
use crate::setting::basin::{Basin, SCRAMBLINGS};
use crate::setting::simulation::Simulation;
use crate::setting::units::Units;
use crate::slip::outcome::Outcome;
use crate::slip::speeds::Speeds;
use crate::sweep::engine::{RunError, each};
use crate::text::SpecError;

/// The error of a setting without a friction law.
pub(crate) fn no_law() -> SpecError {
    SpecError::whole("a share of starts needs a friction law: motions stick and slip by it")
}

/// The outcomes of all starts.
#[derive(Debug, Clone)]
pub struct Followed {
    basin: Basin,
    asked: BasinProblem,
    outcomes: Vec<Outcome>,
    speeds: Speeds,
}

impl Followed {
    /// Follows the starts of a setting on `threads` threads. The result does not depend on their
    /// number. `stop` is checked between starts.
    ///
    /// # Errors
    /// When the setting has no friction law, a value is out of range, the delay is too long, the
    /// threads cannot be started, or it is stopped.
    pub fn of(
        setting: &Setting,
        simulation: &Simulation,
        basin: &Basin,
        (threads, stop): (usize, &Arc<AtomicBool>),
    ) -> Result<Self, RunError<Infallible>> {
        let asked = BasinProblem::of(setting, simulation, basin)?.ok_or_else(no_law)?;
        let begin = || (asked.follower(), None);
        let places: Vec<Place> = asked.places().collect();
        let unit = asked.velocity_unit();
        let followed = each(places, threads, begin, |(follower, motion), place| {
            let mut speeds = Speeds::default();
            let outcome = match stop.load(Ordering::Relaxed) {
                true => Outcome::Undecided,
                false => follower.follow(place, motion, &mut speeds),
            };
            (outcome, speeds)
        })?;
        if stop.load(Ordering::Relaxed) {
            return Err(RunError::Interrupted);
        }
        let speeds = followed.iter().map(|(_, speeds)| speeds.times(unit));
        Ok(Self {
            basin: *basin,
            asked,
            speeds: speeds.fold(Speeds::default(), Speeds::and),
            outcomes: followed.into_iter().map(|(outcome, _)| outcome).collect(),
        })
    }

    /// A remark on motions that went beyond the points of the measured friction law of `setting`.
    #[must_use]
    pub fn beyond_curve(&self, setting: &Setting, units: &Units) -> Option<String> {
        setting.motion_beyond_curve(self.speeds, units)
    }

    /// The region of the starts.
    #[must_use]
    pub fn region(&self) -> Region {
        self.asked.region()
    }

    /// Every start, as ẋ and elongation or as the phase of switch-on and 0, with its outcome.
    pub fn starts(&self) -> impl Iterator<Item = (Place, [f64; 2], Outcome)> {
        let places = self.asked.places().zip(&self.outcomes);
        places.map(|(place, outcome)| (place, self.asked.start(place), *outcome))
    }
}

/// The share of starts from which control ends in sliding, in units of the setting.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(feature = "serve", derive(utoipa::ToSchema))]
pub struct BasinShare {
    /// The share of those that are known to slide; null where there is no uncontrolled stick-slip
    /// to switch on in.
    #[cfg_attr(feature = "serve", schema(value_type = Option<f64>, required))]
    pub basin_share: f64,
    /// The standard error of it and of `basin_share_upper`, from the spread between scramblings:
    /// 3.1 starts of all at least where fewer than five differ from the others. 0 where sliding is
    /// linearly unstable, null where the share is.
    #[cfg_attr(feature = "serve", schema(value_type = Option<f64>, required))]
    pub basin_share_error: f64,
    /// The share if all undecided starts ended in sliding; null where the share is.
    #[cfg_attr(feature = "serve", schema(value_type = Option<f64>, required))]
    pub basin_share_upper: f64,
    /// In which the share lies with 95 % confidence, undecided starts taken either way; null where
    /// the share is.
    #[cfg_attr(feature = "serve", schema(required))]
    pub interval: Option<[f64; 2]>,
    /// Whether sliding is linearly unstable: then none but exceptional starts end in it, and the
    /// share is 0.
    pub linearly_unstable: bool,
    /// Which starts there are: `state` or `phase`.
    pub over: &'static str,
    /// How many were followed.
    pub starts: u32,
    /// Independent scramblings of their sequence, each with as many.
    pub scramblings: u32,
    /// Velocities at t = 0, from and to; null over phases.
    #[cfg_attr(feature = "serve", schema(required))]
    pub x_dot0: Option<[f64; 2]>,
    /// Elongations at t = 0 and before, from and to; null over phases.
    #[cfg_attr(feature = "serve", schema(required))]
    pub a0: Option<[f64; 2]>,
    /// The period of the uncontrolled cycle; null over states.
    #[cfg_attr(feature = "serve", schema(required))]
    pub period: Option<f64>,
    /// Time after switch-on until which motions were followed.
    pub horizon: f64,
    /// Shares of all outcomes.
    pub outcomes: Vec<OutcomeShare>,
}

/// The share of starts that came to an outcome.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(feature = "serve", derive(utoipa::ToSchema))]
pub struct OutcomeShare {
    /// The outcome.
    pub outcome: &'static str,
    /// How many starts came to it.
    pub starts: u32,
    /// Their share of all.
    pub share: f64,
    /// Its standard error.
    pub error: f64,
}

impl BasinShare {
    /// The share, from starts that were followed.
    #[must_use]
    pub fn of(followed: &Followed) -> Self {
        let mut tally = Tally::default();
        for (place, outcome) in followed.asked.places().zip(&followed.outcomes) {
            tally.count(place, *outcome);
        }
        let cell = followed.asked.cell(&tally);
        let half = STUDENT_95 * cell.error;
        let share_of = |outcome: Outcome| {
            let share = tally.share(&[outcome]);
            OutcomeShare {
                outcome: outcome.name(),
                starts: tally.starts(outcome),
                share: share.share,
                error: share.error,
            }
        };
        let outcomes = Outcome::ALL.into_iter();
        let outcomes = outcomes.filter(|of| *of != Outcome::NoCycle && !cell.share.is_nan());
        let (x_dot0, a0, period) = match followed.region() {
            Region::State { x_dot0, a0 } => (Some(x_dot0), Some(a0), None),
            Region::Phase { period } => (None, None, Some(period)),
            Region::None => (None, None, None),
        };
        Self {
            basin_share: cell.share,
            basin_share_error: cell.error,
            basin_share_upper: cell.upper,
            interval: (!cell.share.is_nan())
                .then(|| [(cell.share - half).max(0.0), (cell.upper + half).min(1.0)]),
            linearly_unstable: followed.asked.unstable(),
            over: followed.basin.over.name(),
            starts: followed.outcomes.len() as u32,
            scramblings: SCRAMBLINGS,
            x_dot0,
            a0,
            period,
            horizon: followed.asked.horizon(),
            outcomes: outcomes.map(share_of).collect(),
        }
    }
}
