//! The critical velocity in the units of a setting.

use super::parameter::{Parameter, Setting};
use crate::critical::switch_on::{self, Phase, Scan, Windows};
use crate::critical::{Critical, Problem, critical_velocity};
use crate::model::ModelError;
use crate::slip::case::CaseUnits;
use crate::slip::motion::Accuracy;

/// What is asked of a setting: its problem in the units of a motion, and those units.
///
/// # Errors
/// When the setting has no friction law, or a value is out of the model's range: a gain needs a delay τ > 0.
pub fn problem(setting: &Setting) -> Result<(Problem, CaseUnits), ModelError> {
    let oscillator = setting.oscillator()?;
    let units = CaseUnits::of(&oscillator);
    let Some(law) = setting.friction_law()? else {
        return Err(ModelError {
            parameter: "friction",
            value: f64::NAN,
            allowed: "a friction law",
        });
    };
    let control = setting.control();
    let tau = setting.get(Parameter::Tau);
    let controlled = control.alpha_v != 0.0 || control.alpha_n != 0.0;
    ModelError::check(
        "tau",
        tau,
        "greater than 0 where a gain acts",
        tau > 0.0 || !controlled,
    )?;
    let problem = Problem {
        law,
        velocity_unit: units.velocity,
        alpha_v: control.alpha_v * units.time,
        alpha_n: control.alpha_n / oscillator.stiffness(),
        tau: tau / units.time,
    };
    Ok((problem, units))
}

/// The critical velocity of a setting by the protocol `follow`, in its units; its v0 means nothing.
///
/// # Errors
/// See [`problem`].
pub fn follow(setting: &Setting) -> Result<Critical, ModelError> {
    let (problem, units) = problem(setting)?;
    Ok(in_units(&critical_velocity(&problem), &units))
}

/// `found` in physical units.
#[must_use]
pub fn in_units(found: &Critical, units: &CaseUnits) -> Critical {
    Critical {
        vc: found.vc * units.velocity,
        v_liftoff: found.v_liftoff * units.velocity,
        stick_time: found.stick_time * units.time,
        slip_time: found.slip_time * units.time,
        n_min: found.n_min * units.force,
        ..*found
    }
}

/// The windows of v0 in which stick-slip of a setting survives switching on, in its units; `phase` too is in its units.
///
/// # Errors
/// See [`problem`].
pub fn switch_on(setting: &Setting, phase: Phase, scan: &Scan) -> Result<Windows, ModelError> {
    let (problem, units) = problem(setting)?;
    let phase = match phase {
        Phase::After(time) => Phase::After(time / units.time),
        worst => worst,
    };
    let accuracy = Accuracy {
        tolerance: 1e-9,
        ..Accuracy::default()
    };
    let mut found = switch_on::windows(&problem, phase, scan, accuracy);
    for edge in found.survives.iter_mut().flatten() {
        *edge *= units.velocity;
    }
    found.v_liftoff = found.v_liftoff.map(|v| v * units.velocity);
    Ok(found)
}
