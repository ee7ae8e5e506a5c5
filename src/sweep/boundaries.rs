//! Crossing curves of a whole sweep: one plane (parameter, delay) for each setting of the other axes.

use super::parameter::{Parameter, Setting};
use super::plan::Plan;
use super::tile::for_each_index;
use crate::linear::Crossings;
use crate::linear::curves::{PlaneCurves, TooManyCurves, Window, scan_breakpoints, trace};
use crate::linear::gains::{load_gain_breakpoints, velocity_gain_breakpoints};
use crate::model::{Groups, ModelError};

/// Steps in which breakpoints are looked for along a parameter that is no gain.
const SCAN_STEPS: usize = 4096;

/// The curves of one plane.
#[derive(Debug, Clone)]
pub struct BoundaryPlane {
    /// Index along every axis of the sweep; 0 along the plane's own two.
    pub index: Vec<usize>,
    /// The curves; an error where there are too many.
    pub curves: Result<PlaneCurves, TooManyCurves>,
}

/// The planes of a plan in order, as indices along every axis. Empty where none are traced.
#[must_use]
pub fn planes(plan: &Plan) -> Vec<Vec<usize>> {
    planes_spanned(plan, plan.boundary_plane)
}

/// Every setting of the axes outside a plane, as indices along every axis; none without a plane.
pub(super) fn planes_spanned(plan: &Plan, plane: Option<(usize, usize)>) -> Vec<Vec<usize>> {
    let Some((p, tau)) = plane else {
        return Vec::new();
    };
    let mut extent = plan.shape().to_vec();
    (extent[p], extent[tau]) = (1, 1);
    let mut planes = Vec::new();
    for_each_index(&extent, None, |index| planes.push(index.to_vec()));
    planes
}

/// Traces the curves of one of [`planes`].
///
/// # Errors
/// When a parameter is outside the model's range.
pub fn trace_plane(plan: &Plan, index: &[usize]) -> Result<BoundaryPlane, ModelError> {
    let curves = match plan.boundary_plane {
        Some((p, tau)) => {
            let window = Window {
                p: ends(plan.spec.axes[p].range()),
                tau: ends(plan.spec.axes[tau].range()),
            };
            trace_window(plan.setting(index), plan.spec.axes[p].parameter, &window)?
        }
        None => Ok(PlaneCurves::default()),
    };
    Ok(BoundaryPlane {
        index: index.to_vec(),
        curves,
    })
}

fn ends((from, to): (f64, f64)) -> std::ops::RangeInclusive<f64> {
    from..=to
}

fn trace_window(
    setting: Setting,
    parameter: Parameter,
    window: &Window,
) -> Result<Result<PlaneCurves, TooManyCurves>, ModelError> {
    let groups_at = |p: f64| {
        let mut setting = setting;
        setting.set(parameter, p);
        setting.groups()
    };
    let (start, time_unit) = groups_at(*window.p.start())?;
    groups_at(*window.p.end())?;
    let crossings_at = |p: f64| match groups_at(p) {
        Ok((groups, unit)) => Crossings::of(groups).in_physical_time(unit),
        // Between two valid ends the model stays valid: its ranges are intervals.
        Err(_) => Crossings::of(Groups::new(1.0, 0.0, 0.0)),
    };
    let breakpoints: Vec<f64> = match parameter {
        Parameter::AlphaV => velocity_gain_breakpoints(start.b, start.a_n)
            .into_iter()
            .map(|a_v| a_v / time_unit)
            .collect(),
        Parameter::AlphaN => {
            let to_physical = setting.oscillator()?.stiffness() / setting.sliding_point()?.mu_k;
            load_gain_breakpoints(start.b, start.a_v)
                .into_iter()
                .map(|a_n| a_n * to_physical)
                .collect()
        }
        _ => scan_breakpoints(
            |p| groups_at(p).map_or(Groups::new(1.0, 0.0, 0.0), |(groups, _)| groups),
            &window.p,
            SCAN_STEPS,
        ),
    };
    Ok(trace(crossings_at, &breakpoints, window))
}
