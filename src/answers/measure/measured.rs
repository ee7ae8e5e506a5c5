//! The mean of one v0, under control and without.

use super::foreseen::{Experiment, Foreseen};
use crate::model::stop::Stop;
use crate::model::{Control, ModelError};
use crate::setting::Parameter;
use crate::setting::experiment::Begin;
use crate::setting::simulation::DISTURBED;
use crate::slip::averaging::{Averaged, Cut, Window, average};
use crate::slip::case::{Case, CaseError, Start};
use crate::slip::motion::Motion;
use crate::slip::programme::{Corner, Programme};

/// How far ẋ may be from v0 during the mean, over v0; farther only where noise keeps that up.
const SETTLED: f64 = 1e-3;

/// Why a mean is not one of sliding at v0.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Unsettled {
    /// There is no setting.
    NoSetting,
    /// The block stopped.
    Stops,
    /// ẋ was not near v0.
    Off,
    /// v or N was at a limit of its actuator.
    AtLimit,
    /// N ≤ 0.
    LiftOff,
    /// It takes more steps than are allowed.
    Steps,
    /// The motion could not be followed: it outgrew its past, or friction has no coefficient.
    Lost,
    /// The drift takes v0 out of its range.
    Drift,
}

impl Unsettled {
    /// Its name in answers.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::NoSetting => "no-setting",
            Self::Stops => "stops",
            Self::Off => "off",
            Self::AtLimit => "at-limit",
            Self::LiftOff => "lift-off",
            Self::Steps => "steps",
            Self::Lost => "lost",
            Self::Drift => "drift",
        }
    }
}

/// A mean, as μ_K.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mean {
    /// What was averaged, over the load, less what the dashpot to the ground takes; NaN for
    /// nothing.
    pub mu_k: f64,
    /// Why it is not that of sliding at v0, if it is not.
    pub unsettled: Option<Unsettled>,
}

impl Mean {
    const fn none(why: Unsettled) -> Self {
        Self {
            mu_k: f64::NAN,
            unsettled: Some(why),
        }
    }
}

/// What was found at one v0.
#[derive(Debug, Clone, PartialEq)]
pub struct MeasuredPoint {
    /// The mean over all repeats, unsettled where one of them is.
    pub mean: Mean,
    /// The standard error that is predicted of it; NaN where none is.
    pub error: f64,
    /// The standard deviation between repeats; NaN with fewer than two.
    pub scatter: f64,
    /// How many repeats settled.
    pub settled: u32,
    /// The mean without control, once.
    pub uncontrolled: Mean,
    /// μ_K of the law that was put in.
    pub law: f64,
}

impl Experiment {
    /// Measures the v0 with this `index`, of which and of all others `foreseen` tells what is
    /// known. Once `stop` is set, the answer comes soon but is meaningless.
    ///
    /// # Errors
    /// When a parameter is outside the model's range.
    pub fn measured(
        &self,
        foreseen: &[Foreseen],
        index: usize,
        stop: &Stop,
    ) -> Result<MeasuredPoint, ModelError> {
        let spec = &self.spec;
        let of = &foreseen[index];
        let mut setting = of.setting.clone().unwrap_or_else(|| spec.setting.clone());
        setting.set(Parameter::V0, of.v0);
        let case = spec.simulation.case(&setting, 0.0)?;
        let mut case = case.ok_or_else(|| ModelError::of_law("a friction law"))?;
        case.start = self.start(&case, &foreseen[..index], of.v0);
        let window = of.window(&case);
        let law = case.law.mu_k(of.v0);
        let means = match of.setting {
            Some(_) => self.repeated(&case, of, window, index, stop),
            None => vec![Mean::none(Unsettled::NoSetting)],
        };
        case.feedback.gains = Control::default();
        case.switch_on = f64::INFINITY;
        let uncontrolled = self.one(&case, of, window, None, stop);
        let settled = means.iter().filter(|mean| mean.unsettled.is_none());
        Ok(MeasuredPoint {
            error: of.predicted.error_of(spec.repeats),
            scatter: scatter(&means),
            settled: settled.count() as u32,
            mean: Mean {
                mu_k: average_of(&means),
                unsettled: means.iter().find_map(|mean| mean.unsettled),
            },
            uncontrolled,
            law,
        })
    }

    /// Where the block is at t = 0.
    fn start(&self, case: &Case, before: &[Foreseen], v0: f64) -> Start {
        let slower = match (self.spec.begin, before.last()) {
            (Begin::StickSlip, _) => return Start::AfterRelease,
            (Begin::Step, Some(before)) if before.is_stable() => Some(before.v0),
            _ => None,
        };
        let at = |v0: f64| {
            let case = Case { v0, ..case.clone() };
            case.sliding_elongation()
        };
        Start::State {
            x_dot0: slower.unwrap_or((1.0 + DISTURBED) * v0),
            a0: at(slower.unwrap_or(v0)),
        }
    }

    /// All repeats, each with noise of its own.
    fn repeated(
        &self,
        case: &Case,
        of: &Foreseen,
        window: Window,
        index: usize,
        stop: &Stop,
    ) -> Vec<Mean> {
        let repeats = u64::from(self.spec.repeats);
        let first = self
            .spec
            .simulation
            .seed
            .wrapping_add(index as u64 * repeats);
        let mut case = case.clone();
        let one = |repeat: u64| {
            let seed = first.wrapping_add(repeat);
            case.feedback.readings.seed = seed;
            let mut window = window;
            window.readings.seed = seed;
            self.one(&case, of, window, of.abscissa, stop)
        };
        let repeats = (0..repeats).take_while(|_| !stop.is_set());
        repeats.map(one).collect()
    }

    /// One mean of the motion of `case`.
    fn one(
        &self,
        case: &Case,
        of: &Foreseen,
        window: Window,
        abscissa: Option<f64>,
        stop: &Stop,
    ) -> Mean {
        let mut case = case.clone();
        if self.spec.drift != 0.0 {
            let at = 1.01 * (of.wait + of.average);
            let v0 = of.v0 * (1.0 + self.spec.drift * at);
            let ramp = true;
            case.programme = Programme(vec![Corner { at, v0, ramp }]);
        }
        let motion = begun(&case).map(|motion| motion.heeding(stop.clone()));
        let Ok(mut motion) = motion else {
            return Mean::none(match self.spec.drift != 0.0 {
                true => Unsettled::Drift,
                false => Unsettled::Lost,
            });
        };
        let v0 = of.v0 / case.units().velocity;
        let abscissa = abscissa.map(|abscissa| abscissa * case.units().time);
        let averaged = average(&mut motion, &window, abscissa, case.steps);
        let viscous = case.oscillator.dashpot_ratios().viscous;
        Mean {
            mu_k: match averaged.cut {
                Some(_) => f64::NAN,
                None => averaged.mean - viscous * v0,
            },
            unsettled: unsettled(&averaged, v0),
        }
    }
}

/// The motion of a case at t = 0; near sliding where there is no stick-slip to begin in.
fn begun(case: &Case) -> Result<Motion, CaseError> {
    match case.motion() {
        Err(CaseError::NoCycle(_)) => {
            let sliding = Case {
                start: Start::State {
                    x_dot0: (1.0 + DISTURBED) * case.v0,
                    a0: case.sliding_elongation(),
                },
                ..case.clone()
            };
            sliding.motion()
        }
        other => other,
    }
}

/// Why a mean is not one of sliding at v0, if it is not.
fn unsettled(of: &Averaged, v0: f64) -> Option<Unsettled> {
    match of.cut {
        Some(Cut::LiftOff) => return Some(Unsettled::LiftOff),
        Some(Cut::Steps) => return Some(Unsettled::Steps),
        Some(Cut::Lost) => return Some(Unsettled::Lost),
        None => {}
    }
    let near = of.off <= (SETTLED * v0).max(of.kept_up);
    match (of.stopped, near, of.at_limit) {
        (true, ..) => Some(Unsettled::Stops),
        (_, false, _) => Some(Unsettled::Off),
        (_, _, true) => Some(Unsettled::AtLimit),
        _ => None,
    }
}

fn average_of(means: &[Mean]) -> f64 {
    means.iter().map(|mean| mean.mu_k).sum::<f64>() / means.len() as f64
}

/// The standard deviation of single means.
fn scatter(means: &[Mean]) -> f64 {
    if means.len() < 2 {
        return f64::NAN;
    }
    let middle = average_of(means);
    let square = |mean: &Mean| (mean.mu_k - middle) * (mean.mu_k - middle);
    let sum: f64 = means.iter().map(square).sum();
    (sum / (means.len() - 1) as f64).sqrt()
}
