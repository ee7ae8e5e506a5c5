//! Friction laws, their fits and their measured points.

use numpy::{PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use slipmap::fit::{LAWS, Wanted, fit as fitted};
use slipmap::model::ModelError;
use slipmap::setting::measured::{
    Columns, CurveOptions, Direction, Measured, MeasuredPoint, SpeedUnit, Spoken, decoded,
};
use slipmap::setting::setting_text::setting_text;
use slipmap::setting::units::Units;
use slipmap::setting::{Parameter, Setting};
use slipmap::text::SpecError;

use crate::error::{input_error, of_input, of_text};
use crate::subject::Subject;
use crate::waiting::wait;

/// Two columns of numbers.
type Two<'py> = (Bound<'py, PyArray1<f64>>, Bound<'py, PyArray1<f64>>);

/// μ_K and μ_K′ of a friction law at some speeds.
#[pyfunction]
pub(crate) fn law<'py>(
    py: Python<'py>,
    subject: &Subject,
    speeds: PyReadonlyArray1<f64>,
) -> PyResult<Two<'py>> {
    let refused = |error: ModelError| of_input(py, error);
    let mut setting = subject.setting().clone();
    let (mut mu_k, mut slope) = (Vec::new(), Vec::new());
    let law = setting.friction_law().map_err(refused)?;
    for speed in speeds.as_array() {
        let speed = speed.abs();
        let at = match &law {
            _ if speed.is_nan() => [f64::NAN; 2],
            Some(law) => [law.mu_k(speed), law.mu_prime(speed)],
            None => {
                setting.set(Parameter::V0, speed);
                let at = setting.sliding_point().map_err(refused)?;
                [at.mu_k, at.mu_prime]
            }
        };
        mu_k.push(at[0]);
        slope.push(at[1]);
    }
    Ok((PyArray1::from_vec(py, mu_k), PyArray1::from_vec(py, slope)))
}

/// The text of a setting with the friction law that was fitted to points, its name, and the laws
/// that were compared, the best one first.
#[pyfunction]
pub(crate) fn fit<'py>(
    py: Python<'py>,
    speeds: PyReadonlyArray1<f64>,
    mu_k: PyReadonlyArray1<f64>,
    v0: f64,
    law: Option<&str>,
    mu_s: Option<f64>,
) -> PyResult<Bound<'py, PyDict>> {
    let law = law.map(|law| {
        let found = LAWS.into_iter().find(|of| *of == law);
        found.ok_or_else(|| {
            let error = SpecError::whole(format!("no law of the name \"{law}\" is fitted"));
            of_text(py, error.help(format!("known: {}", LAWS.join(", "))), "")
        })
    });
    let law = law.transpose()?;
    let mut setting = Setting::new(None);
    setting.set(Parameter::Tau, 0.0);
    for (parameter, value) in [(Parameter::V0, Some(v0)), (Parameter::MuS, mu_s)] {
        if let Some(value) = value {
            let checked = parameter.check(value);
            setting.set(parameter, checked.map_err(|error| of_input(py, error))?);
        }
    }
    let text: String = speeds
        .as_array()
        .iter()
        .zip(mu_k.as_array())
        .map(|(v, mu)| format!("{v:?} {mu:?}\n"))
        .collect();
    let curve = Measured::read(&text, &CurveOptions::default());
    let curve = curve.map_err(|error| of_text(py, error, &text))?;
    let found = wait(py, None, |_, _| {
        fitted(&curve.points, Wanted { law, mu_s }, setting)
    })?;
    let found = found
        .map_err(|why| input_error(py, (why.to_string(), Some(why.help().to_owned())), "", None))?;
    let all = PyDict::new(py);
    let text = setting_text(
        &found.setting,
        &Units::default(),
        Parameter::of_friction_law,
    );
    // The law alone: other parameters are given with it later.
    let law = text.find("[friction]").map_or(&*text, |at| &text[at..]);
    all.set_item("toml", law)?;
    all.set_item("law", found.law)?;
    all.set_item("noise", found.noise)?;
    let laws = found
        .contenders
        .iter()
        .map(|of| (of.law, of.parameters, of.bic));
    all.set_item("laws", laws.collect::<Vec<_>>())?;
    if let Ok(Some(of)) = found.setting.fitted_sliding() {
        all.set_item("mu_k", of.at.mu_k)?;
        all.set_item("mu_k_error", of.mu_k_error)?;
        all.set_item("mu_prime", of.at.mu_prime)?;
        all.set_item("mu_prime_error", of.mu_prime_error)?;
    }
    Ok(all)
}

/// The speeds and coefficients of a measured curve, as instruments write it, and what is told of
/// it.
#[pyfunction]
pub(crate) fn read_curve<'py>(
    py: Python<'py>,
    bytes: Vec<u8>,
    columns: Option<&str>,
    normal_load: Option<f64>,
    speed_unit: Option<&str>,
    units: Option<&str>,
) -> PyResult<(Two<'py>, Vec<String>)> {
    let refused = |why: String| of_input(py, why);
    let text = decoded(bytes).map_err(refused)?;
    let options = CurveOptions {
        columns: columns
            .map(Columns::read)
            .transpose()
            .map_err(refused)?
            .unwrap_or_default(),
        normal_load,
        speed_unit: speed_unit
            .map(SpeedUnit::read)
            .transpose()
            .map_err(refused)?,
        units: units
            .map(Units::read)
            .transpose()
            .map_err(refused)?
            .unwrap_or_default(),
        spoken: Spoken::Keys,
    };
    let curve = Measured::read(&text, &options).map_err(|error| of_text(py, error, &text))?;
    let column = |value: fn(&MeasuredPoint) -> f64| {
        let values = curve.points.iter().map(value);
        PyArray1::from_vec(py, values.collect())
    };
    let signed = |point: &MeasuredPoint| match point.direction {
        Direction::Backward => -point.speed,
        Direction::Forward => point.speed,
    };
    let remarks = curve.remarks.iter().map(ToString::to_string).collect();
    Ok(((column(signed), column(|point| point.mu_k)), remarks))
}
