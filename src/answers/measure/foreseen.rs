//! What is known of a v0 before it is measured: its setting, whether stick-slip lives beside it,
//! how long it takes, and the errors to expect.

use std::sync::OnceLock;

use super::predicted::Predicted;
use crate::critical::CriticalWindows;
use crate::model::ModelError;
use crate::model::stop::Stop;
use crate::setting::experiment::{Chosen, ExperimentSpec};
use crate::setting::no_answer::NoAnswer;
use crate::setting::{Parameter, Setting};
use crate::slip::averaging::Window;
use crate::slip::case::Case;

/// How long is waited, in relaxation times: e⁻²⁵ = 1.4e-11, with room for double and triple roots.
const WAIT: f64 = 25.0;
/// How long is waited beside that, in delays.
const DELAYS: f64 = 2.0;
/// How long is averaged, in relaxation times.
const AVERAGE: f64 = 100.0;

/// What a v0 promises.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Prospect {
    /// Sliding is stable, and stick-slip does not live beside it.
    Safe,
    /// Sliding is stable, and stick-slip lives beside it.
    BelowVc,
    /// Sliding is stable, but the way to it may lead through N ≤ 0.
    LiftOff,
    /// Sliding is stable; whether stick-slip lives beside it is not known.
    Unknown,
    /// Sliding is not stable under the setting that is given.
    Unstable,
    /// No setting makes sliding stable.
    NoSetting,
}

impl Prospect {
    /// Its name in answers.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Safe => "safe",
            Self::BelowVc => "below-vc",
            Self::LiftOff => "lift-off",
            Self::Unknown => "unknown",
            Self::Unstable => "unstable",
            Self::NoSetting => "no-setting",
        }
    }
}

/// What is known of a v0 before it is measured.
#[derive(Debug, Clone, PartialEq)]
pub struct Foreseen {
    /// The pulling velocity.
    pub v0: f64,
    /// What it promises.
    pub prospect: Prospect,
    /// Gain and delay with all else; none without a setting.
    pub setting: Option<Setting>,
    /// What part of them gain, delay and μ′ may be off; none where the setting is given, or is that
    /// of fastest decay.
    pub spread: Option<f64>,
    /// The abscissa of sliding, in 1/time; none where it is not stable.
    pub abscissa: Option<f64>,
    /// v_c of the setting; NaN where it is not known.
    pub vc: f64,
    /// How long v0 is held before the mean begins.
    pub wait: f64,
    /// How long the elongation is averaged.
    pub average: f64,
    /// The errors to expect of one mean; NaN where sliding is not stable.
    pub predicted: Predicted,
}

impl Foreseen {
    /// Whether sliding is stable there.
    #[must_use]
    pub fn is_stable(&self) -> bool {
        self.abscissa.is_some()
    }

    /// The time of the mean, and the sensor, in the units of a motion of `case`.
    pub(super) fn window(&self, case: &Case) -> Window {
        let unit = case.units().time;
        Window {
            from: self.wait / unit,
            to: (self.wait + self.average) / unit,
            readings: case.feedback.dimensionless(&case.oscillator).readings,
        }
    }
}

/// An experiment, with what is common to all of its v0.
#[derive(Debug)]
pub struct Experiment {
    /// What is asked.
    pub spec: ExperimentSpec,
    /// v_c of a given setting, which is that of every v0.
    pub(super) critical: OnceLock<Option<CriticalWindows>>,
}

impl Experiment {
    /// The experiment of a file.
    #[must_use]
    pub fn new(spec: ExperimentSpec) -> Self {
        Self {
            spec,
            critical: OnceLock::new(),
        }
    }

    /// What is known of `v0` before it is measured. Once `stop` is set, the answer comes soon but
    /// is meaningless.
    ///
    /// # Errors
    /// When a parameter is outside the model's range.
    pub fn foreseen(&self, v0: f64, stop: &Stop) -> Result<Foreseen, NoAnswer> {
        let mut setting = self.spec.setting.clone();
        setting.set(Parameter::V0, v0);
        let candidate = match self.spec.chosen {
            Chosen::Given => Some(self.given(setting, v0, stop)?),
            // A slope that is too steep to be searched has no setting; other v0 may have one.
            Chosen::Best(gain) => self.best(&setting, gain, v0, stop).unwrap_or(None),
        };
        let unit = self.spec.setting.oscillator()?.time_unit();
        let Some(candidate) = candidate else {
            return Ok(Foreseen {
                v0,
                prospect: Prospect::NoSetting,
                setting: None,
                spread: None,
                abscissa: None,
                vc: f64::NAN,
                wait: self.spec.wait.unwrap_or(WAIT * unit),
                average: self.spec.average.unwrap_or(AVERAGE * unit),
                predicted: UNKNOWN,
            });
        };
        let relaxation = candidate.abscissa.map_or(unit, |abscissa| -1.0 / abscissa);
        let tau = candidate.setting.get(Parameter::Tau);
        let wait = WAIT * relaxation + DELAYS * tau;
        let mut foreseen = Foreseen {
            v0,
            prospect: candidate.prospect,
            spread: candidate.spread,
            abscissa: candidate.abscissa,
            vc: candidate.vc,
            wait: self.spec.wait.unwrap_or(wait),
            average: self.spec.average.unwrap_or(AVERAGE * relaxation),
            predicted: UNKNOWN,
            setting: Some(candidate.setting),
        };
        if let (Some(abscissa), Some(case)) = (foreseen.abscissa, self.case(&foreseen, 0)?) {
            let window = foreseen.window(&case);
            foreseen.predicted = Predicted::of(&case, &window, abscissa, self.spec.drift);
        }
        Ok(foreseen)
    }

    /// The motion of sliding at the v0 of `foreseen` under its setting, without drift; none without
    /// a setting.
    pub(super) fn case(&self, foreseen: &Foreseen, seed: u64) -> Result<Option<Case>, ModelError> {
        let Some(setting) = &foreseen.setting else {
            return Ok(None);
        };
        let case = self.spec.simulation.case(setting, 0.0)?;
        Ok(case.map(|mut case| {
            case.feedback.readings.seed = seed;
            case
        }))
    }
}

/// Nothing is predicted.
const UNKNOWN: Predicted = Predicted {
    error: f64::NAN,
    rounding: f64::NAN,
    rounding_bound: f64::NAN,
    bias_of_noise: f64::NAN,
    bias_of_drift: f64::NAN,
};
