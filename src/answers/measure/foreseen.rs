//! What is known of a v0 before it is measured: its setting, whether stick-slip lives beside it,
//! how long it takes, and the errors to expect.

use std::sync::OnceLock;

use super::predicted::Predicted;
use crate::answers::best::{Ranges, default_ranges, robust_setting};
use crate::answers::vc::VcProblem;
use crate::critical::CriticalWindows;
use crate::linear::MarginalTolerance;
use crate::linear::best::SearchedGain;
use crate::model::ModelError;
use crate::model::stop::Stop;
use crate::setting::best_plane::parameter_of;
use crate::setting::experiment::{Chosen, ExperimentSpec};
use crate::setting::no_answer::NoAnswer;
use crate::setting::quantity::Quantity;
use crate::setting::regime_at_v0::RegimeAtV0;
use crate::setting::search::Protocol;
use crate::setting::{Parameter, Setting};
use crate::slip::averaging::Window;
use crate::slip::case::Case;

/// The part of them by which gain, delay and μ′ may be off at a robust setting, the first one
/// first. The more a setting stands, the lower its v_c.
const SPREADS: [f64; 4] = [0.05, 0.1, 0.2, 0.3];
/// Smaller parts, where no setting stands the first one.
const SMALLER: [f64; 2] = [0.01, 0.002];
/// How long is waited, in relaxation times: e⁻²⁵ = 1.4e-11, with room for double and triple roots.
const WAIT: f64 = 25.0;
/// And in delays.
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
    critical: OnceLock<Option<CriticalWindows>>,
}

/// A setting that may be taken, with what speaks for it.
struct Candidate {
    setting: Setting,
    spread: Option<f64>,
    abscissa: Option<f64>,
    prospect: Prospect,
    vc: f64,
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

    /// The setting of the file.
    fn given(&self, setting: Setting, v0: f64, stop: &Stop) -> Result<Candidate, NoAnswer> {
        let abscissa = self.abscissa(&setting)?;
        let mut prospect = Prospect::Unstable;
        let problem = problem(&setting, stop);
        let critical = self.critical.get_or_init(|| {
            let problem = problem.as_ref();
            problem.map(|problem| problem.find(Protocol::Follow))
        });
        if abscissa.is_some() {
            prospect = prospect_of(v0, problem.as_ref(), critical.as_ref());
        }
        Ok(Candidate {
            setting,
            spread: None,
            abscissa,
            prospect,
            vc: vc_of(critical.as_ref()),
        })
    }

    /// The best robust setting at v0 that has no stick-slip beside it; else the first robust one,
    /// or the one of fastest decay; none where no setting makes sliding stable.
    fn best(
        &self,
        setting: &Setting,
        gain: SearchedGain,
        v0: f64,
        stop: &Stop,
    ) -> Result<Option<Candidate>, NoAnswer> {
        let searched = continuous(setting);
        let quantity = Quantity::Known(parameter_of(gain));
        let ranges = default_ranges(&searched, &quantity)?;
        let robust = |spread: f64| robust_setting(&searched, gain, &ranges, [spread; 3], stop);
        let mut first = None;
        for spread in SPREADS {
            let (_, Some(found)) = robust(spread)? else {
                break;
            };
            let place = (found.robust.gain, found.robust.tau);
            let candidate = self.candidate(setting, gain, place, v0, stop)?;
            let candidate = candidate.map(|of| Candidate {
                spread: Some(spread),
                ..of
            });
            match candidate {
                Some(found) if found.prospect == Prospect::Safe => return Ok(Some(found)),
                found => first = first.or(found),
            }
        }
        if first.is_some() || stop.is_set() {
            return Ok(first);
        }
        self.less_robust(setting, gain, (&searched, &ranges), v0, stop)
    }

    /// The setting that stands a smaller part, or else the one of fastest decay.
    fn less_robust(
        &self,
        setting: &Setting,
        gain: SearchedGain,
        (searched, ranges): (&Setting, &Ranges),
        v0: f64,
        stop: &Stop,
    ) -> Result<Option<Candidate>, NoAnswer> {
        let mut fastest = None;
        for spread in SMALLER {
            let (best, robust) = robust_setting(searched, gain, ranges, [spread; 3], stop)?;
            fastest = Some((best.overall.gain, best.overall.tau));
            if best.overall.relaxation_time().is_none() {
                return Ok(None);
            }
            let Some(found) = robust else { continue };
            let place = (found.robust.gain, found.robust.tau);
            if let Some(found) = self.candidate(setting, gain, place, v0, stop)? {
                return Ok(Some(Candidate {
                    spread: Some(spread),
                    ..found
                }));
            }
        }
        match fastest {
            Some(place) => self.candidate(setting, gain, place, v0, stop),
            None => Ok(None),
        }
    }

    /// A gain and a delay at v0, the delay rounded to readings; none where sliding is not stable
    /// then.
    fn candidate(
        &self,
        setting: &Setting,
        gain: SearchedGain,
        (alpha, tau): (f64, f64),
        v0: f64,
        stop: &Stop,
    ) -> Result<Option<Candidate>, NoAnswer> {
        let mut setting = setting.clone();
        setting.set(parameter_of(gain), alpha);
        setting.set(Parameter::Tau, tau.max(setting.get(Parameter::SampleTime)));
        setting.round_to_samples();
        let Some(abscissa) = self.abscissa(&setting)? else {
            return Ok(None);
        };
        let problem = problem(&setting, stop);
        let critical = problem.as_ref().map(|of| of.find(Protocol::Follow));
        Ok(Some(Candidate {
            prospect: prospect_of(v0, problem.as_ref(), critical.as_ref()),
            vc: vc_of(critical.as_ref()),
            setting,
            spread: None,
            abscissa: Some(abscissa),
        }))
    }

    /// The abscissa of sliding, where it is stable.
    fn abscissa(&self, setting: &Setting) -> Result<Option<f64>, ModelError> {
        let Some(case) = self.spec.simulation.case(setting, 0.0)? else {
            return Ok(None);
        };
        let slowest = case.sliding()?.slowest();
        Ok(slowest.map(|abscissa| abscissa / case.units().time))
    }
}

/// Nothing is predicted.
const UNKNOWN: Predicted = Predicted {
    error: f64::NAN,
    rounding: f64::NAN,
    bias_of_noise: f64::NAN,
    bias_of_drift: f64::NAN,
};

/// A setting without readings: to the first order in it a sample time is a latency of its half.
fn continuous(setting: &Setting) -> Setting {
    let mut continuous = setting.clone();
    let half = 0.5 * setting.get(Parameter::SampleTime);
    continuous.set(Parameter::Latency, setting.get(Parameter::Latency) + half);
    for exact in [
        Parameter::SampleTime,
        Parameter::Noise,
        Parameter::Resolution,
    ] {
        continuous.set(exact, 0.0);
    }
    continuous
}

/// The search for v_c of a setting; none where there is no such search.
fn problem(setting: &Setting, stop: &Stop) -> Option<VcProblem> {
    let problem = VcProblem::of(&continuous(setting)).ok()?;
    Some(problem.until(stop.clone()))
}

fn prospect_of(
    v0: f64,
    problem: Option<&VcProblem>,
    critical: Option<&CriticalWindows>,
) -> Prospect {
    let (Some(problem), Some(critical)) = (problem, critical) else {
        return Prospect::Unknown;
    };
    match problem.regime_at(v0, Protocol::Follow, critical, MarginalTolerance::default()) {
        RegimeAtV0::Stable => Prospect::Safe,
        RegimeAtV0::Bistable => Prospect::BelowVc,
        RegimeAtV0::LiftOff => Prospect::LiftOff,
        RegimeAtV0::Unstable | RegimeAtV0::Undecided => Prospect::Unknown,
    }
}

fn vc_of(critical: Option<&CriticalWindows>) -> f64 {
    critical.map_or(f64::NAN, |found| found.critical.vc)
}
