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
use crate::setting::quantity::Quantity;
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
pub(crate) fn trace_plane(plan: &Plan, index: &[usize], stop: &Stop) -> BoundaryPlane {
    match plan.boundary_plane {
        Some(plane) => trace_spanned(plan, plane, index, stop),
        None => BoundaryPlane {
            index: index.to_vec(),
            curves: Vec::new(),
        },
    }
}

/// Traces the curves of the plane spanned by the axes `(p, q)` at `index` along the others, whether
/// the plan has them traced or not. If one of the two is the delay, it is q. Curves end where the
/// setting is outside the model's range. Once `stop` is set, the answer comes soon but is
/// meaningless.
pub(crate) fn trace_spanned(
    plan: &Plan,
    (p, q): (usize, usize),
    index: &[usize],
    stop: &Stop,
) -> BoundaryPlane {
    let (setting, axes) = (plan.setting(index), &plan.spec.axes);
    let window = Window {
        p: ends(axes[p].range()),
        q: ends(axes[q].range()),
    };
    let degrees = &plan.spec.degrees_of_stability;
    let letter = traced_by_closed_form(&plan.spec, q);
    let of = [&axes[p].parameter, &axes[q].parameter];
    let curves = match letter {
        true => trace_window(&setting, of[0], &window, degrees, stop),
        false => any_plane::trace_window(&setting, of, &window, degrees, stop),
    };
    BoundaryPlane {
        index: index.to_vec(),
        curves,
    }
}

fn ends((from, to): (f64, f64)) -> std::ops::RangeInclusive<f64> {
    from..=to
}

/// The groups and the unit of time as one parameter changes.
fn groups_along(
    setting: &Setting,
    parameter: &Quantity,
) -> impl Fn(f64) -> Result<(Groups, f64), ModelError> {
    let gain = parameter.known().and_then(searched_gain);
    // No gain changes the block.
    let block = gain.map(|_| Ok((setting.oscillator()?, setting.sliding_point()?)));
    move |p: f64| {
        let Some(block) = &block else {
            let mut setting = setting.clone();
            setting.vary(parameter, p);
            return setting.groups();
        };
        let (oscillator, sliding) = block.as_ref().map_err(ModelError::clone)?;
        let mut control = setting.control();
        match gain {
            Some(SearchedGain::Velocity) => control.alpha_v = p,
            _ => control.alpha_n = p,
        }
        Ok((oscillator.groups(*sliding, control), oscillator.time_unit()))
    }
}

fn trace_window(
    setting: &Setting,
    parameter: &Quantity,
    window: &Window,
    degrees_of_stability: &[f64],
    stop: &Stop,
) -> Vec<DegreeCurves> {
    let groups_at = groups_along(setting, parameter);
    let has_model = |p: f64| groups_at(p).is_ok();
    let parts = split(window, &jumps(setting, parameter));
    let parts: Vec<Window> = match setting.formula() {
        Some(_) => parts.iter().flat_map(|p| within(p, has_model)).collect(),
        // The ranges of other models are intervals, which were checked.
        None => parts,
    };
    // Nothing crosses the imaginary axis where there is no model.
    let valid_groups_at = |p: f64| groups_at(p).unwrap_or((Groups::new(1.0, 0.0, 0.0), 1.0));
    let crossings_at = |p: f64| {
        let (groups, unit) = valid_groups_at(p);
        Crossings::of(groups).in_physical_time(unit)
    };
    let traced = |sigma: f64| {
        let mut curves = Ok(PlaneCurves::default());
        for part in &parts {
            let more = match sigma {
                0.0 => {
                    let scanned =
                        || scan_breakpoints(|p| valid_groups_at(p).0, &part.p, SCAN_STEPS);
                    let breakpoints = breakpoints(setting, parameter).unwrap_or_else(scanned);
                    trace(crossings_at, &breakpoints, part, stop)
                }
                _ => decay::trace(valid_groups_at, sigma, part, stop),
            };
            curves = joined(curves, more);
        }
        DegreeCurves {
            degree_of_stability: sigma,
            curves,
        }
    };
    let degrees = degrees_of_stability.iter().copied();
    std::iter::once(0.0).chain(degrees).map(traced).collect()
}

/// Values of `parameter` at which the number of crossing curves changes; none where they have no
/// closed form.
fn breakpoints(setting: &Setting, parameter: &Quantity) -> Option<Vec<f64>> {
    let gain = parameter.known().and_then(searched_gain)?;
    let (oscillator, sliding) = (setting.oscillator().ok()?, setting.sliding_point().ok()?);
    let family = Letter::of(&oscillator, sliding, setting.control(), gain);
    let points = family.changes_of_crossings().into_iter();
    Some(match gain {
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
pub(super) fn jumps(setting: &Setting, parameter: &Quantity) -> Vec<[f64; 2]> {
    let law = setting.friction_law().ok().flatten();
    let (Some(Parameter::V0), Some(Kind::Table(table))) =
        (parameter.known(), law.as_ref().map(FrictionLaw::kind))
    else {
        return Vec::new();
    };
    let speeds = table.speeds();
    let (first, last) = (speeds[0], speeds[speeds.len() - 1]);
    vec![[first.next_down(), first], [last, last.next_up()]]
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

/// The parts of a window in which the setting at p has a model, as [`SCAN_STEPS`] steps tell. Their
/// ends are exact.
fn within(window: &Window, has_model: impl Fn(f64) -> bool) -> Vec<Window> {
    let (start, end) = (*window.p.start(), *window.p.end());
    let at = |i: usize| match i {
        SCAN_STEPS => end,
        _ => start + (end - start) * i as f64 / SCAN_STEPS as f64,
    };
    let mut parts = Vec::new();
    let mut begun = has_model(start).then_some(start);
    for i in 1..=SCAN_STEPS {
        let (before, here) = (at(i - 1), at(i));
        match (begun, has_model(here)) {
            (None, true) => begun = Some(last_with(&has_model, here, before)),
            (Some(from), false) => {
                parts.push(from..=last_with(&has_model, before, here));
                begun = None;
            }
            _ => {}
        }
    }
    parts.extend(begun.map(|from| from..=end));
    let part = |p| Window {
        p,
        q: window.q.clone(),
    };
    parts.into_iter().map(part).collect()
}

/// The last value with a model between one that has it and one that has not.
fn last_with(has_model: impl Fn(f64) -> bool, mut with: f64, mut without: f64) -> f64 {
    loop {
        let middle = with + 0.5 * (without - with);
        if middle == with || middle == without {
            return with;
        }
        match has_model(middle) {
            true => with = middle,
            false => without = middle,
        }
    }
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

    /// The columns at which the number of unstable roots changes, by the argument principle. It has
    /// to change exactly at the curves of the plane. Where there is no model no curve may be.
    fn changes_at_curves(plan: &Plan) -> Vec<f64> {
        let traced = trace_plane(plan, &plane(plan, 0), &Stop::default());
        let curves = traced.curves[0].curves.as_ref().unwrap();
        let (columns, mut changes) = (&plan.spec.axes[0].values, Vec::new());
        // Where the number of curves changes they end on either side, within rounding.
        let ends = curves.pieces.iter().flat_map(|piece| {
            let ends = [piece.vertices.first(), piece.vertices.last()];
            ends.into_iter().flatten().map(|vertex| vertex.p)
        });
        let ends: Vec<f64> = ends.collect();
        for (i, &p) in columns.iter().enumerate().skip(1).take(columns.len() - 2) {
            if ends.iter().any(|end| (end - p).abs() < 1e-12) {
                continue;
            }
            let at: Vec<f64> = curves
                .pieces
                .iter()
                .flat_map(|piece| piece.vertices.windows(2))
                .filter(|pair| (pair[0].p <= p) != (pair[1].p <= p))
                .map(|pair| {
                    let part = (p - pair[0].p) / (pair[1].p - pair[0].p);
                    pair[0].q + (pair[1].q - pair[0].q) * part
                })
                .collect();
            let Ok((groups, unit)) = plan.setting(&[i, 0]).groups() else {
                assert!(at.is_empty(), "{p}: {at:?}");
                continue;
            };
            let count = |tau: f64| roots_right_of(groups, tau / unit, 0.0);
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
                assert!(curve || below == above, "{p} {pair:?}: {below} {above}");
                if below != above {
                    changes.push(p);
                }
            }
        }
        changes
    }

    #[test]
    fn curves_bound_the_counts_on_both_sides_of_the_ends_of_a_table() {
        let (mut changes, mut beyond) = (0, 0);
        for (speeds, mu_k, alpha_n) in [
            (vec![0.0, 0.8, 1.0], vec![0.9, 0.85, 0.3], 0.9),
            (vec![0.0, 0.5, 2.0], vec![0.8, 0.5, 0.35], 0.7),
            (vec![0.3, 0.5, 2.2], vec![0.8, 0.5, 0.3], -1.3),
            (vec![0.4, 1.1], vec![0.6, 0.9], 1.2),
        ] {
            let found = changes_at_curves(&sweep(&speeds, &mu_k, alpha_n));
            let outside = |v0: &&f64| **v0 < speeds[0] || **v0 > speeds[speeds.len() - 1];
            changes += found.len();
            beyond += found.iter().filter(outside).count();
        }
        assert!(changes > 100 && beyond > 20, "{changes} {beyond}");
    }

    /// Along axes of the law and of the formula alone. The conditions are those of a coefficient
    /// above 0, and are worked out by hand.
    #[test]
    fn curves_end_where_a_formula_has_no_coefficient() {
        const FALLING: &str = "0.4 + sigma*v/v_s";
        const PARTS: &str = "0.5*(v_s - 1)^2 - 0.1 - sigma*v";
        for (axis, fixed, formula, has_model) in [
            (
                "v_s = { from = 0.3, to = 2.3",
                "v0 = 1\n[friction]\nsigma = -0.4",
                FALLING,
                (|p| p > 1.0) as fn(f64) -> bool,
            ),
            (
                "v_s = { from = 0.05, to = 2",
                "v0 = 1\n[friction]\nsigma = 0.05",
                PARTS,
                |p| (p - 1.0).abs() > 0.3_f64.sqrt(),
            ),
            (
                "v0 = { from = 0.1, to = 2.1",
                "[friction]\nsigma = -0.4\nv_s = 1",
                FALLING,
                |p| p < 1.0,
            ),
            (
                "sigma = { from = -1.9, to = 1.9",
                "v0 = 1\n[friction]\nv_s = 1",
                FALLING,
                |p| p > -0.4,
            ),
        ] {
            let text = format!(
                "fields = [\"n_unstable\"]\nboundaries = true\n[axes]\n{axis}, points = 81 }}\n\
                 tau = {{ from = 0.01, to = 20.0, points = 101 }}\n[fixed]\nalpha_n = -3\n\
                 {fixed}\nlaw = \"formula\"\nmu_k = \"{formula}\"\n"
            );
            let plan = Plan::new(text.parse::<SweepSpec>().unwrap()).unwrap();
            let columns = &plan.spec.axes[0].values;
            let changes = changes_at_curves(&plan);
            assert!(changes.iter().all(|p| has_model(*p)), "{axis}");
            let with = columns.iter().filter(|p| has_model(**p)).count();
            let without = columns.len() - with;
            assert!(
                without > 9 && changes.len() > with,
                "{axis} {}",
                changes.len()
            );
        }
    }
}
