//! The response in time of a system from a file: to a disturbance of its state, or of a loop to a
//! step of its reference or of a disturbance.

use super::stability::{Stability, Wanted};
use crate::linear::line::Linear;
use crate::linear::response::{Excited, NoResponse, Response};
use crate::model::stop::Stop;
use crate::setting::no_answer::NoAnswer;
use crate::setting::{Parameter, Setting};

/// Time constants of the decay, or of the growth, that are followed by default.
const DECAYS: f64 = 10.0;
const GROWTHS: f64 = 5.0;
/// Delays that are followed by default where the system neither decays nor grows.
const DELAYS: f64 = 20.0;
/// Delays that are followed at least.
const LEAST_DELAYS: f64 = 4.0;

/// What a response is to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Excitation {
    /// The state at t = 0 is 1; nothing was before.
    Start,
    /// The reference of a loop is 1 from t = 0 on.
    Reference,
    /// The disturbance at the input of the plant is 1 from t = 0 on.
    Disturbance,
}

/// Why there is no response of a setting.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ResponseError {
    /// The setting has no linear model.
    #[error(transparent)]
    NoAnswer(#[from] NoAnswer),
    /// Its model has no response.
    #[error(transparent)]
    NoResponse(#[from] NoResponse),
    /// A step is asked of a system that is no loop.
    #[error("this system has no {0}: only a loop of plant and controller has")]
    NoLoop(&'static str),
}

/// A response in time, with what is known of the system.
#[derive(Debug, Clone)]
pub struct TimeResponse {
    /// Stability at the delay.
    pub stability: Stability,
    /// Until when it was followed.
    pub until: f64,
    /// The response.
    pub response: Response,
}

impl TimeResponse {
    /// The response of a system's setting until the time `until`, by default as long as it takes to
    /// decay, in so many `samples`. Once `stop` is set it comes soon and means nothing.
    ///
    /// # Errors
    /// Where there is no linear model, or no response of it.
    pub fn of(
        setting: &Setting,
        to: Excitation,
        (until, samples): (Option<f64>, usize),
        stop: &Stop,
    ) -> Result<Self, ResponseError> {
        let (linear, time_unit) = setting.answered()?;
        let tau = setting.get(Parameter::Tau);
        let wanted = Wanted {
            roots: 1,
            line: None,
        };
        let stability = Stability::of(&linear, (time_unit, tau), wanted, stop);
        let spectrum = &stability.spectrum;
        // Counts may be open where the rightmost root is certain to decay.
        let decays = spectrum.certified && spectrum.certified_line < 0.0;
        let settles = decays || (stability.stable && !stability.marginal);
        let (excited, settles_at) = excited(setting, &linear, to, tau)?;
        let until = until.unwrap_or_else(|| default_until(&stability, tau));
        let settles_at = settles_at.filter(|_| settles);
        Ok(Self {
            response: excited.response((until, samples), settles_at, stop)?,
            stability,
            until,
        })
    }
}

/// How long a response is followed by default.
fn default_until(stability: &Stability, tau: f64) -> f64 {
    let abscissa = stability.spectrum.abscissa;
    let delays = DELAYS * if tau > 0.0 { tau } else { 1.0 };
    let until = match abscissa {
        decays if decays < 0.0 => DECAYS / -decays,
        grows if grows > 0.0 => GROWTHS / grows,
        _ => delays,
    };
    until.max(LEAST_DELAYS * tau)
}

/// The system with its excitation, and the value at which it settles if it does.
fn excited(
    setting: &Setting,
    linear: &Linear,
    to: Excitation,
    tau: f64,
) -> Result<(Excited, Option<f64>), ResponseError> {
    let system = match (linear, to) {
        (Linear::Matrix(system), Excitation::Start) => {
            let excited = match setting.powers_of_delay()? {
                Some(powers) => Excited::by_start_of_powers(&powers, tau)?,
                None => Excited::by_start_of_matrices(system, 0, tau)?,
            };
            return Ok((excited, Some(0.0)));
        }
        (Linear::General(system), Excitation::Start) => {
            return Ok((Excited::by_start(system, tau)?, Some(0.0)));
        }
        (Linear::General(system), _) => system,
        _ => return Err(ResponseError::NoLoop(named(to))),
    };
    let Some(through) = setting.disturbed_through()? else {
        return Err(ResponseError::NoLoop(named(to)));
    };
    let [p, q] = system.polynomials().map(|of| of.coefficients()[0]);
    if to == Excitation::Reference {
        return Ok((Excited::by_reference(system, tau)?, Some(q / (p + q))));
    }
    let at = through.coefficients()[0] / (p + q);
    Ok((Excited::by_disturbance(system, &through, tau)?, Some(at)))
}

fn named(to: Excitation) -> &'static str {
    match to {
        Excitation::Start => "start",
        Excitation::Reference => "reference",
        Excitation::Disturbance => "disturbance",
    }
}
