//! Crossing curves of a whole sweep, and those of its degrees of stability: one plane (parameter, delay) for each setting of
//! the other axes.

use super::parameter::{Parameter, Setting};
use super::plan::Plan;
use super::tile::for_each_index;
use crate::linear::Crossings;
use crate::linear::curves::{PlaneCurves, TooManyCurves, Window, scan_breakpoints, trace};
use crate::linear::decay;
use crate::linear::gains::{load_gain_breakpoints, velocity_gain_breakpoints};
use crate::model::{Groups, ModelError};

/// Steps in which breakpoints are looked for along a parameter that is no gain.
const SCAN_STEPS: usize = 4096;

/// The curves of one plane.
#[derive(Debug, Clone)]
pub struct BoundaryPlane {
    /// Index along every axis of the sweep; 0 along the plane's own two.
    pub index: Vec<usize>,
    /// The curves of the boundary of stability, then those of each degree of stability.
    pub curves: Vec<DegreeCurves>,
}

/// The curves of one degree of stability in one plane.
#[derive(Debug, Clone)]
pub struct DegreeCurves {
    /// σ in 1/time: the curves are where a root has Re λ = −σ. 0 for crossings of the imaginary axis.
    pub degree_of_stability: f64,
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
            let parameter = plan.spec.axes[p].parameter;
            let degrees = &plan.spec.degrees_of_stability;
            trace_window(plan.setting(index), parameter, &window, degrees)?
        }
        None => Vec::new(),
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
    degrees_of_stability: &[f64],
) -> Result<Vec<DegreeCurves>, ModelError> {
    let groups_at = |p: f64| {
        let mut setting = setting.clone();
        setting.set(parameter, p);
        setting.groups()
    };
    let (start, time_unit) = groups_at(*window.p.start())?;
    groups_at(*window.p.end())?;
    // Between two valid ends the model stays valid: its ranges are intervals.
    let valid_groups_at = |p: f64| groups_at(p).unwrap_or((Groups::new(1.0, 0.0, 0.0), 1.0));
    let crossings_at = |p: f64| {
        let (groups, unit) = valid_groups_at(p);
        Crossings::of(groups).in_physical_time(unit)
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
        _ => scan_breakpoints(|p| valid_groups_at(p).0, &window.p, SCAN_STEPS),
    };
    let boundary = DegreeCurves {
        degree_of_stability: 0.0,
        curves: trace(crossings_at, &breakpoints, window),
    };
    let degrees = degrees_of_stability.iter().map(|&sigma| DegreeCurves {
        degree_of_stability: sigma,
        curves: decay::trace(valid_groups_at, sigma, window),
    });
    Ok(std::iter::once(boundary).chain(degrees).collect())
}
