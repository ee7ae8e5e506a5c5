//! Crossing curves of a whole sweep, and the curves of its degrees of stability: one plane of two
//! axes for each setting of the others.
//!
//! In planes of the letter's own system with the delay, the curves have a closed form. For other
//! systems and other parameters they are followed step by step.

use super::any_plane;
use crate::linear::Crossings;
use crate::linear::best::{Letter, SearchedGain};
use crate::linear::curves::{PlaneCurves, TooManyCurves, Window, scan_breakpoints, trace};
use crate::linear::decay;
use crate::model::law::{FrictionLaw, Kind};
use crate::model::stop::Stop;
use crate::model::{Groups, ModelError};
use crate::setting::best_plane::searched_gain;
use crate::setting::parameter::Parameter;
use crate::setting::values::Setting;
use crate::sweep::plan::Plan;
use crate::sweep::plan::planes_of_curves::traced_by_closed_form;
use crate::sweep::plan::tile::index_of;

/// Steps of the search for breakpoints along a parameter that is no gain.
const SCAN_STEPS: usize = 4096;

/// The curves of one plane.
#[derive(Debug, Clone, Default)]
pub struct BoundaryPlane {
    /// Index along every axis of the sweep; 0 along the plane's own two.
    pub index: Vec<usize>,
    /// The curves of the boundary of stability, then those of each degree of stability.
    pub curves: Vec<DegreeCurves>,
}

/// The curves of one degree of stability in one plane.
#[derive(Debug, Clone)]
pub struct DegreeCurves {
    /// σ in 1/time: on the curves a root has Re λ = −σ. 0 for crossings of the imaginary axis.
    pub degree_of_stability: f64,
    /// The curves; an error where there are too many.
    pub curves: Result<PlaneCurves, TooManyCurves>,
}

/// The place of the `number`-th plane of curves, as indices along every axis; 0 along its own two.
#[must_use]
pub fn plane(plan: &Plan, number: u64) -> Vec<usize> {
    plane_spanned(plan, plan.boundary_plane, number)
}

/// The `number`-th setting of the axes outside a plane, the last one fastest, as indices along
/// every axis.
pub(super) fn plane_spanned(plan: &Plan, plane: Option<(usize, usize)>, number: u64) -> Vec<usize> {
    let mut shape = plan.shape().to_vec();
    if let Some((p, tau)) = plane {
        (shape[p], shape[tau]) = (1, 1);
    }
    index_of(number, &shape)
}

/// Traces the curves of the [`plane`] at `index`. Once `stop` is set, the answer comes soon but is
/// meaningless.
///
/// # Errors
/// When a parameter is outside the model's range.
pub(crate) fn trace_plane(
    plan: &Plan,
    index: &[usize],
    stop: &Stop,
) -> Result<BoundaryPlane, ModelError> {
    match plan.boundary_plane {
        Some(plane) => trace_spanned(plan, plane, index, stop),
        None => Ok(BoundaryPlane {
            index: index.to_vec(),
            curves: Vec::new(),
        }),
    }
}

/// Traces the curves of the plane spanned by the axes `(p, q)` at `index` along the others, whether
/// the plan has them traced or not. If one of the two is the delay, it is q. Once `stop` is set,
/// the answer comes soon but is meaningless.
///
/// # Errors
/// When a parameter is outside the model's range.
pub(crate) fn trace_spanned(
    plan: &Plan,
    (p, q): (usize, usize),
    index: &[usize],
    stop: &Stop,
) -> Result<BoundaryPlane, ModelError> {
    let (setting, axes) = (plan.setting(index), &plan.spec.axes);
    let window = Window {
        p: ends(axes[p].range()),
        q: ends(axes[q].range()),
    };
    let degrees = &plan.spec.degrees_of_stability;
    let letter = traced_by_closed_form(&plan.spec, q);
    let curves = if let Some(p) = axes[p].parameter.known().filter(|_| letter) {
        trace_window(&setting, p, &window, degrees, stop)?
    } else {
        let of = [&axes[p].parameter, &axes[q].parameter];
        any_plane::trace_window(&setting, of, &window, degrees, stop)?
    };
    Ok(BoundaryPlane {
        index: index.to_vec(),
        curves,
    })
}

fn ends((from, to): (f64, f64)) -> std::ops::RangeInclusive<f64> {
    from..=to
}

/// The groups and the unit of time as one parameter changes.
fn groups_along(
    setting: &Setting,
    parameter: Parameter,
) -> Result<impl Fn(f64) -> Result<(Groups, f64), ModelError>, ModelError> {
    let gain = searched_gain(parameter);
    // No gain changes the block.
    let block = match gain {
        Some(_) => Some((setting.oscillator()?, setting.sliding_point()?)),
        None => None,
    };
    Ok(move |p: f64| {
        let Some((oscillator, sliding)) = block else {
            let mut setting = setting.clone();
            setting.set(parameter, p);
            return setting.groups();
        };
        let mut control = setting.control();
        match gain {
            Some(SearchedGain::Velocity) => control.alpha_v = p,
            _ => control.alpha_n = p,
        }
        Ok((oscillator.groups(sliding, control), oscillator.time_unit()))
    })
}

fn trace_window(
    setting: &Setting,
    parameter: Parameter,
    window: &Window,
    degrees_of_stability: &[f64],
    stop: &Stop,
) -> Result<Vec<DegreeCurves>, ModelError> {
    let groups_at = groups_along(setting, parameter)?;
    groups_at(*window.p.start())?;
    groups_at(*window.p.end())?;
    // The model's ranges are intervals, so it is valid between two valid ends.
    let valid_groups_at = |p: f64| groups_at(p).unwrap_or((Groups::new(1.0, 0.0, 0.0), 1.0));
    let crossings_at = |p: f64| {
        let (groups, unit) = valid_groups_at(p);
        Crossings::of(groups).in_physical_time(unit)
    };
    let traced = |sigma: f64| -> Result<DegreeCurves, ModelError> {
        let mut curves = Ok(PlaneCurves::default());
        for part in split(window, &jumps(setting, parameter)?) {
            let more = match sigma {
                0.0 => {
                    let scanned =
                        || scan_breakpoints(|p| valid_groups_at(p).0, &part.p, SCAN_STEPS);
                    let breakpoints = breakpoints(setting, parameter, scanned)?;
                    trace(crossings_at, &breakpoints, &part, stop)
                }
                _ => decay::trace(valid_groups_at, sigma, &part, stop),
            };
            curves = joined(curves, more);
        }
        Ok(DegreeCurves {
            degree_of_stability: sigma,
            curves,
        })
    };
    let degrees = degrees_of_stability.iter().copied();
    std::iter::once(0.0).chain(degrees).map(traced).collect()
}

/// Values of `parameter` at which the number of crossing curves changes. They are `scanned` for
/// where they have no closed form.
fn breakpoints(
    setting: &Setting,
    parameter: Parameter,
    scanned: impl Fn() -> Vec<f64>,
) -> Result<Vec<f64>, ModelError> {
    let Some(gain) = searched_gain(parameter) else {
        return Ok(scanned());
    };
    let (oscillator, sliding) = (setting.oscillator()?, setting.sliding_point()?);
    let family = Letter::of(&oscillator, sliding, setting.control(), gain);
    let points = family.changes_of_crossings().into_iter();
    Ok(match gain {
        SearchedGain::Velocity => points.map(|a_v| a_v / oscillator.time_unit()).collect(),
        SearchedGain::Load => {
            let to_physical = oscillator.stiffness() / sliding.mu_k;
            points.map(|a_n| a_n * to_physical).collect()
        }
    })
}

/// For each jump of the groups, the last value of `parameter` below it and the first one above it.
/// The slope of a table jumps at its first and at its last speed, which themselves belong to the
/// curve between them.
pub(super) fn jumps(setting: &Setting, parameter: Parameter) -> Result<Vec<[f64; 2]>, ModelError> {
    let law = setting.friction_law()?;
    let (Parameter::V0, Some(Kind::Table(table))) =
        (parameter, law.as_ref().map(FrictionLaw::kind))
    else {
        return Ok(Vec::new());
    };
    let speeds = table.speeds();
    let (first, last) = (speeds[0], speeds[speeds.len() - 1]);
    Ok(vec![[first.next_down(), first], [last, last.next_up()]])
}

/// The parts of a window between jumps. Nothing crosses the imaginary axis at a jump itself, so no
/// curve runs along it.
pub(super) fn split(window: &Window, jumps: &[[f64; 2]]) -> Vec<Window> {
    let (mut start, end) = (*window.p.start(), *window.p.end());
    let mut parts = Vec::new();
    for &[below, above] in jumps {
        if start < below && above < end {
            parts.push(start..=below);
            start = above;
        }
    }
    parts.push(start..=end);
    let part = |p| Window {
        p,
        q: window.q.clone(),
    };
    parts.into_iter().map(part).collect()
}

pub(super) fn joined(
    curves: Result<PlaneCurves, TooManyCurves>,
    more: Result<PlaneCurves, TooManyCurves>,
) -> Result<PlaneCurves, TooManyCurves> {
    let (mut curves, more) = (curves?, more?);
    curves.pieces.extend(more.pieces);
    curves.corners.extend(more.corners);
    Ok(curves)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linear::certificate::roots_right_of;
    use crate::setting::SweepSpec;

    fn sweep(speeds: &[f64], mu_k: &[f64], alpha_n: f64) -> Plan {
        let text = format!(
            "fields = [\"n_unstable\"]\nboundaries = true\n[axes]\n\
             v0 = {{ from = 0.02, to = 3.0, points = 61 }}\n\
             tau = {{ from = 0.01, to = 20.0, points = 101 }}\n\
             [friction]\nlaw = \"table\"\nspeeds = {speeds:?}\nmu_k = {mu_k:?}\n\
             [fixed]\nalpha_n = {alpha_n:?}\n"
        );
        Plan::new(text.parse::<SweepSpec>().unwrap()).unwrap()
    }

    /// Along every column of the plane, the number of unstable roots by the argument principle
    /// changes exactly at the curves.
    #[test]
    fn curves_bound_the_counts_on_both_sides_of_the_ends_of_a_table() {
        let (mut changes, mut beyond) = (0, 0);
        for (speeds, mu_k, alpha_n) in [
            (vec![0.0, 0.8, 1.0], vec![0.9, 0.85, 0.3], 0.9),
            (vec![0.0, 0.5, 2.0], vec![0.8, 0.5, 0.35], 0.7),
            (vec![0.3, 0.5, 2.2], vec![0.8, 0.5, 0.3], -1.3),
            (vec![0.4, 1.1], vec![0.6, 0.9], 1.2),
        ] {
            let plan = sweep(&speeds, &mu_k, alpha_n);
            let traced = trace_plane(&plan, &plane(&plan, 0), &Stop::default()).unwrap();
            let curves = traced.curves[0].curves.as_ref().unwrap();
            let columns = plan.spec.axes[0].values.iter().enumerate();
            for (i, &v0) in columns.filter(|(i, _)| (1..60).contains(i)) {
                // The curves in this column.
                let mut at: Vec<f64> = Vec::new();
                for piece in &curves.pieces {
                    for pair in piece.vertices.windows(2) {
                        let (p, q) = (pair[0], pair[1]);
                        if (p.p <= v0) != (q.p <= v0) {
                            at.push(p.q + (q.q - p.q) * (v0 - p.p) / (q.p - p.p));
                        }
                    }
                }
                let count = |tau: f64| {
                    let (groups, unit) = plan.setting(&[i, 0]).groups().unwrap();
                    roots_right_of(groups, tau / unit, 0.0)
                };
                for pair in plan.spec.axes[1].values.windows(2) {
                    // Polylines are exact at their vertices only.
                    let near = |edge: f64| at.iter().any(|tau| (tau - edge).abs() < 0.02);
                    if near(pair[0]) || near(pair[1]) {
                        continue;
                    }
                    let (Some(below), Some(above)) = (count(pair[0]), count(pair[1])) else {
                        continue;
                    };
                    let curve = at.iter().any(|tau| pair[0] < *tau && *tau < pair[1]);
                    assert!(
                        curve || below == above,
                        "{speeds:?} v0 {v0} {pair:?}: {below} {above}"
                    );
                    changes += u32::from(below != above);
                    let outside = v0 < speeds[0] || v0 > speeds[speeds.len() - 1];
                    beyond += u32::from(outside && below != above);
                }
            }
        }
        assert!(changes > 100 && beyond > 20, "{changes} {beyond}");
    }
}
