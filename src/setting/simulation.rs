//! How far and how exactly motions are followed, and the motion of a setting: common to sweep and
//! case files.

use std::borrow::Cow;
use std::ops::{Range, RangeInclusive};

use super::parameter::{LARGEST, Parameter};
use super::units::Units;
use super::values::Setting;
use crate::model::{ModelError, Oscillator, ReturnMap};
use crate::slip::case::{Case, Start};
use crate::slip::motion::Accuracy;
use crate::slip::programme::Programme;
use crate::text::Shown;
use crate::text::document::Document;
use crate::text::toml_reader::{Entry, SpecError};

/// Default horizon, from switch-on, in units of √(M/κ).
const HORIZON: f64 = 1000.0;
/// Default limit of the steps of a motion: about a second.
const STEPS: u64 = 1_000_000;
/// The most steps that a file may ask for.
const MOST_STEPS: u64 = 1_000_000_000;
/// Times and lengths that are greater than zero.
pub(super) const POSITIVE: RangeInclusive<f64> = 1.0 / LARGEST..=LARGEST;

/// The parameters that motions do not support.
pub(crate) const NOT_IN_MOTIONS: &[Parameter] = &[
    Parameter::LoadLag,
    Parameter::VelocityLag,
    Parameter::SensorLag,
];

/// The first parameter of a setting that motions do not know, and a message that says so.
pub(super) fn not_in_motions(setting: &Setting) -> Option<(Parameter, String)> {
    let parameter = setting.beyond_letter(NOT_IN_MOTIONS)?;
    let message = format!("{} is not known to motions", parameter.name());
    Some((parameter, message))
}

/// The keys `horizon`, `tolerance`, `steps` and `seed`, of a case file or of the table
/// `[simulation]` of a sweep file.
#[derive(Debug, Clone, PartialEq)]
pub struct Simulation {
    /// The time until which the motion is followed; none for 1000 √(M/κ) after switch-on, or after
    /// the last corner of a programme.
    pub horizon: Option<f64>,
    /// Relative error allowed in a step.
    pub tolerance: f64,
    /// The most steps.
    pub steps: u64,
    /// What the noise of readings is drawn with.
    pub seed: u64,
    /// The share of v0 by which a block is faster than it is pulled at t = 0, if no start is given.
    pub disturbance: f64,
}

/// The disturbance of a motion without a given start: exactly in equilibrium a block would stay
/// there, stable or not.
pub const DISTURBED: f64 = 0.01;

impl Default for Simulation {
    fn default() -> Self {
        Self {
            horizon: None,
            tolerance: Accuracy::default().tolerance,
            steps: STEPS,
            seed: 0,
            disturbance: 0.0,
        }
    }
}

/// A remark on a start that is not given, where sliding is disturbed by this share of v0; none
/// without a disturbance.
#[must_use]
pub(crate) fn assumed_start(disturbance: f64) -> Option<String> {
    (disturbance != 0.0).then(|| {
        format!(
            "none is given: each block begins with x_dot0 = {} v0, {} % faster than it is pulled",
            1.0 + disturbance,
            100.0 * disturbance,
        )
    })
}

impl Simulation {
    /// The keys of a table, of a document of its own or in a sweep file.
    pub(super) fn of(table: &mut Document, units: &Units) -> Self {
        let default = Self::default();
        let tolerance = table.take("tolerance", |entry| entry.number_within(1e-15..=1e-3));
        Self {
            horizon: table.take("horizon", |entry| {
                units.number_within(entry, Parameter::Tau.dimension(), POSITIVE)
            }),
            tolerance: tolerance.unwrap_or(default.tolerance),
            steps: table.take("steps", read_steps).unwrap_or(default.steps),
            seed: table.take("seed", Entry::whole).unwrap_or(default.seed),
            ..default
        }
    }

    /// Its keys and their values, for what a map is known by.
    pub(crate) fn facts(&self) -> impl Iterator<Item = (&str, Cow<'_, [f64]>)> {
        let numbers = vec![
            self.horizon.unwrap_or(0.0),
            self.tolerance,
            self.steps as f64,
        ];
        // Left out where a start is given, and for earlier maps, whose motions began in
        // equilibrium.
        let disturbed = (self.disturbance != 0.0).then(|| vec![self.disturbance]);
        let halves = [self.seed >> 32, self.seed & 0xffff_ffff].map(|half| half as f64);
        let seeded = (self.seed != 0).then(|| halves.to_vec());
        let facts = [
            ("simulation", Some(numbers)),
            ("disturbance", disturbed),
            ("seed", seeded),
        ];
        let given = facts.into_iter();
        given.filter_map(|(name, numbers)| Some((name, numbers?.into())))
    }

    /// A remark on a start that is not given; none where motions are not disturbed.
    #[must_use]
    pub(crate) fn assumed_start(&self) -> Option<String> {
        assumed_start(self.disturbance)
    }

    /// Checks that the horizon, given at `place`, is later than `switch_on`, the value of `name`.
    pub(super) fn check_horizon(
        &self,
        place: Option<&Range<usize>>,
        name: &str,
        switch_on: f64,
    ) -> Result<(), SpecError> {
        match (self.horizon, place) {
            (Some(horizon), Some(place)) if horizon <= switch_on => {
                let message = format!(
                    "horizon: {} is not later than {name}, which is {}",
                    Shown(horizon),
                    Shown(switch_on)
                );
                Err(SpecError::at(place.clone(), message))
            }
            _ => Ok(()),
        }
    }

    /// The horizon that is given, or else that of a motion whose last change is at `begun`.
    pub(super) fn horizon_after(&self, begun: f64, oscillator: &Oscillator) -> f64 {
        let by_default = || begun + HORIZON * oscillator.time_unit();
        self.horizon.unwrap_or_else(by_default)
    }

    /// The motion of `setting`. Control acts from `switch_on` on, unless the setting has a phase of
    /// switch-on. Without a given start, the block slides at v0, faster by the disturbance. None
    /// without a friction law.
    ///
    /// # Errors
    /// When a parameter is outside the model's range.
    pub fn case(&self, setting: &Setting, switch_on: f64) -> Result<Option<Case>, ModelError> {
        self.case_under(setting, switch_on, None)
    }

    /// The motion of `setting` as in [`Simulation::case`], under control by a return map if there
    /// is one.
    pub(crate) fn case_under(
        &self,
        setting: &Setting,
        switch_on: f64,
        return_map: Option<ReturnMap>,
    ) -> Result<Option<Case>, ModelError> {
        setting.check_of_letter(NOT_IN_MOTIONS, "0 where motions are followed")?;
        let Some(law) = setting.friction_law()? else {
            return Ok(None);
        };
        let oscillator = setting.oscillator()?;
        let v0 = setting.get(Parameter::V0);
        let given = |p: Parameter| Some(setting.get(p)).filter(|value| !value.is_nan());
        let phase = given(Parameter::SwitchOnPhase);
        let start = match phase {
            Some(_) => Start::AfterRelease,
            None => Start::State {
                x_dot0: given(Parameter::XDot0).unwrap_or((1.0 + self.disturbance) * v0),
                a0: given(Parameter::A0).unwrap_or_else(|| {
                    let lever = oscillator.normal_load() / oscillator.stiffness();
                    let viscous = setting.get(Parameter::Viscous) / oscillator.stiffness();
                    law.mu_k(v0) * lever + viscous * v0
                }),
            },
        };
        let mut feedback = setting.feedback();
        feedback.readings.seed = self.seed;
        feedback.return_map = return_map;
        // Without control there is nothing to switch on.
        let switch_on = match feedback.acts() {
            true => phase.unwrap_or(switch_on),
            false => f64::INFINITY,
        };
        let begun = if switch_on.is_finite() {
            switch_on
        } else {
            0.0
        };
        let horizon = self.horizon_after(begun, &oscillator);
        Ok(Some(Case {
            oscillator,
            law,
            feedback,
            v0,
            programme: Programme::default(),
            switch_on,
            start,
            horizon,
            steps: self.steps,
            accuracy: Accuracy {
                tolerance: self.tolerance,
                ..Accuracy::default()
            },
        }))
    }
}

fn read_steps(entry: &Entry) -> Result<u64, SpecError> {
    match entry.whole()? {
        steps @ 1..=MOST_STEPS => Ok(steps),
        other => Err(entry.error(format!("{other} is outside its range: 1 to {MOST_STEPS}"))),
    }
}
