//! The gain and the delay under which a v0 is measured: those of the file, or the best.

use super::foreseen::{Experiment, Prospect};
use crate::answers::best::{best_settings, default_ranges};
use crate::answers::robust::{RobustSearch, RobustSetting};
use crate::answers::search_plane::SearchPlane;
use crate::answers::vc::VcProblem;
use crate::critical::CriticalWindows;
use crate::linear::MarginalTolerance;
use crate::linear::best::SearchedGain;
use crate::linear::line::Linear;
use crate::linear::sampled::multiple;
use crate::model::ModelError;
use crate::model::stop::Stop;
use crate::setting::best_plane::parameter_of;
use crate::setting::no_answer::NoAnswer;
use crate::setting::regime_at_v0::RegimeAtV0;
use crate::setting::search::Protocol;
use crate::setting::{Parameter, Setting};

/// The part of them by which gain, delay and μ′ may be off at a robust setting, the first one
/// first. The more a setting stands, the lower its v_c.
const SPREADS: [f64; 4] = [0.05, 0.1, 0.2, 0.3];
/// Smaller parts, where no setting stands the first one.
const SMALLER: [f64; 2] = [0.01, 0.002];
/// A setting that may be taken, with what speaks for it.
pub(super) struct Candidate {
    pub setting: Setting,
    pub spread: Option<f64>,
    pub abscissa: Option<f64>,
    pub prospect: Prospect,
    pub vc: f64,
}

impl Candidate {
    /// The candidate with the spread that it stands: of a digital loop only where sliding stays
    /// stable with gain and slope changed by it.
    fn standing(self, spread: f64) -> Self {
        let stands = match (self.setting.linear(), self.setting.oscillator()) {
            (Ok((Linear::Sampled(of), unit)), Ok(oscillator)) => {
                let multiple = multiple(self.setting.get(Parameter::Tau), of.sample_time * unit);
                let slope = of.groups.b - oscillator.dashpot_ratios().sum();
                let changes = [-spread, spread].into_iter();
                let mut corners = changes.flat_map(|by| [[by, spread], [by, -spread]]);
                multiple.is_some_and(|multiple| {
                    corners.all(|[of_slope, of_gain]| {
                        let changed = of.changed(of_slope * slope, 1.0 + of_gain);
                        changed.n_unstable(multiple) == 0
                    })
                })
            }
            _ => true,
        };
        Self {
            spread: stands.then_some(spread),
            ..self
        }
    }
}

impl Experiment {
    /// The setting of the file.
    pub(super) fn given(
        &self,
        setting: Setting,
        v0: f64,
        stop: &Stop,
    ) -> Result<Candidate, NoAnswer> {
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
    pub(super) fn best(
        &self,
        setting: &Setting,
        gain: SearchedGain,
        v0: f64,
        stop: &Stop,
    ) -> Result<Option<Candidate>, NoAnswer> {
        check_latency(setting)?;
        let searched = continuous(setting);
        let plane = SearchPlane::with_delay(parameter_of(gain));
        let ranges = default_ranges(&searched, &plane)?;
        let search = RobustSearch::of(&searched, gain, &ranges, stop)?;
        let mut first = None;
        for spread in SPREADS {
            let Some(found) = search.standing([spread; 3], stop) else {
                break;
            };
            match self.robust(setting, gain, &found, v0, stop)? {
                Some(found) if found.prospect == Prospect::Safe => return Ok(Some(found)),
                found => first = first.or(found),
            }
        }
        if first.is_some() || stop.is_set() {
            return Ok(first);
        }
        let less = self.less_robust(setting, gain, &search, v0, stop)?;
        match less {
            None if setting.get(Parameter::SampleTime) > 0.0 && !stop.is_set() => {
                self.fastest_of_samples(setting, gain, v0, stop)
            }
            less => Ok(less),
        }
    }

    /// The setting of fastest decay of the digital loop itself, where it is stable.
    fn fastest_of_samples(
        &self,
        setting: &Setting,
        gain: SearchedGain,
        v0: f64,
        stop: &Stop,
    ) -> Result<Option<Candidate>, NoAnswer> {
        let plane = SearchPlane::with_delay(parameter_of(gain));
        let ranges = default_ranges(setting, &plane)?;
        let best = best_settings(setting, &plane, &ranges, stop)?.overall;
        match best.relaxation_time() {
            Some(_) => self.candidate(setting, gain, (best.p, best.q), v0, stop),
            None => Ok(None),
        }
    }

    /// The setting that stands a smaller part, or else the one of fastest decay.
    fn less_robust(
        &self,
        setting: &Setting,
        gain: SearchedGain,
        search: &RobustSearch,
        v0: f64,
        stop: &Stop,
    ) -> Result<Option<Candidate>, NoAnswer> {
        let fastest = search.best().overall;
        if fastest.relaxation_time().is_none() {
            return Ok(None);
        }
        for spread in SMALLER {
            let Some(found) = search.standing([spread; 3], stop) else {
                continue;
            };
            if let Some(found) = self.robust(setting, gain, &found, v0, stop)? {
                return Ok(Some(found));
            }
        }
        self.candidate(setting, gain, (fastest.p, fastest.q), v0, stop)
    }

    /// A robust setting at v0 with the spread that it stands; none where sliding is not stable with
    /// its delay rounded to readings.
    fn robust(
        &self,
        setting: &Setting,
        gain: SearchedGain,
        found: &RobustSetting,
        v0: f64,
        stop: &Stop,
    ) -> Result<Option<Candidate>, NoAnswer> {
        let place = (found.robust.gain, found.robust.tau);
        let candidate = self.candidate(setting, gain, place, v0, stop)?;
        Ok(candidate.map(|of| of.standing(found.spread[0])))
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

/// Checks that the latency is a whole multiple of the sample time, where there is one.
fn check_latency(setting: &Setting) -> Result<(), ModelError> {
    let [latency, sample_time] =
        [Parameter::Latency, Parameter::SampleTime].map(|p| setting.get(p));
    let whole = latency == 0.0 || sample_time == 0.0 || multiple(latency, sample_time).is_some();
    let allowed = "0 or a whole multiple of sample_time";
    ModelError::check(Parameter::Latency.name(), latency, allowed, whole).map(|_| ())
}

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
