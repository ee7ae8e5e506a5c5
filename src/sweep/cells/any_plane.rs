//! Curves of a plane of any two parameters of any system.

use super::boundaries::{DegreeCurves, joined, jumps, split};
use crate::linear::curves::{PlaneCurves, Window};
use crate::linear::general::curves::trace;
use crate::linear::general::{SystemPlane, SystemSetting};
use crate::model::stop::Stop;
use crate::setting::parameter::Parameter;
use crate::setting::quantity::Quantity;
use crate::setting::values::Setting;

/// Traces the curves of the plane of the two parameters `of`. Once `stop` is set, the answer comes
/// soon but is meaningless. Curves end where the setting has no model.
pub(super) fn trace_window(
    setting: &Setting,
    of: [&Quantity; 2],
    window: &Window,
    degrees_of_stability: &[f64],
    stop: &Stop,
) -> Vec<DegreeCurves> {
    let at = |p: f64, q: f64| {
        let mut setting = setting.clone();
        setting.vary(of[0], p);
        setting.vary(of[1], q);
        let (model, unit) = setting.linear().ok()?;
        Some(SystemSetting {
            system: model.system()?,
            tau: setting.get(Parameter::Tau),
            unit,
        })
    };
    let jumps = jumps(setting, of[0]);
    let delays = of.map(|of| *of == Parameter::Tau || *of == Parameter::Latency);
    let has_lines = *of[1] == Parameter::Tau && setting.has_lines();
    let traced = |sigma: f64| {
        let mut curves = Ok(PlaneCurves::default());
        for part in split(window, &jumps) {
            let plane = match has_lines {
                true => SystemPlane::of_lines(&at, &part),
                false => SystemPlane::new(&at, &part, delays),
            };
            curves = joined(curves, trace(&plane.heeding(stop), sigma));
        }
        DegreeCurves {
            degree_of_stability: sigma,
            curves,
        }
    };
    let degrees = degrees_of_stability.iter().copied();
    std::iter::once(0.0).chain(degrees).map(traced).collect()
}
