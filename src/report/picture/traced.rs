//! The curves of the planes that a picture shows: those of the map or, where it holds none of such
//! planes, traced from its sweep, which gives the same curves every time.

use super::view::View;
use crate::model::stop::Stop;
use crate::setting::Parameter;
use crate::setting::axis::spans_curves;
use crate::store::curve_reader::curves_of;
use crate::store::map_file::MapCurve;
use crate::store::{MapFile, StoreError};
use crate::sweep::Plan;
use crate::sweep::cells::boundaries::trace_spanned;
use crate::sweep::described::curve_rows::CurveRows;
use crate::sweep::described::schema::root;

/// The curves of a picture.
#[derive(Debug, Default)]
pub(super) struct Curves {
    /// The curves of all panels.
    pub list: Vec<MapCurve>,
    /// Whether their second parameter lies from left to right.
    pub turned: bool,
    /// Whether they are from the map.
    pub stored: bool,
    /// Why there are none, where they could not be had.
    pub none: Option<&'static str>,
    /// Why those of some panels are missing.
    pub missing: Option<&'static str>,
}

impl Curves {
    /// The curves of the planes that `view` shows.
    ///
    /// # Errors
    /// When the curves of the map cannot be read.
    pub(super) fn of(map: &MapFile, view: &View) -> Result<Self, StoreError> {
        if view.is_boundary_plane(map) {
            return Ok(Self {
                list: map.curves_where(|outer| view.shows(map, outer))?,
                turned: view.is_turned(map),
                stored: true,
                ..Self::default()
            });
        }
        Ok(match plan(map, view) {
            Ok((plan, turned)) => Self::traced(map, view, &plan, turned),
            Err(why) => Self {
                none: Some(why),
                ..Self::default()
            },
        })
    }

    fn traced(map: &MapFile, view: &View, plan: &Plan, turned: bool) -> Self {
        let Some(plane) = plane(view, turned) else {
            return Self::default();
        };
        let mut curves = Self {
            turned,
            ..Self::default()
        };
        for panel in &view.panels {
            let traced = trace_spanned(plan, plane, panel, &Stop::default());
            let rows = CurveRows::of(&traced);
            if rows.left_out {
                curves.missing = Some("there are too many to trace");
            }
            let outer = view.outer_values(map, panel).into_iter();
            let outer: Vec<Vec<f64>> = outer.map(|value| vec![value; rows.curves()]).collect();
            curves
                .list
                .extend(curves_of(&rows, &outer).into_iter().flatten());
        }
        curves
    }
}

/// The curves of the planes that `view` shows between these (from, to) of its axes from left to
/// right and from bottom to top, traced for that part alone, so that small things in it are as
/// exact as large ones; none where they cannot be traced.
pub(super) fn within(map: &MapFile, view: &View, [x, y]: [(f64, f64); 2]) -> Option<Vec<MapCurve>> {
    let (plan, turned) = plan(map, view).ok()?;
    let mut spec = plan.spec;
    for (axis, (from, to)) in [(view.x, x), (view.y?, y)] {
        spec.axes[axis].values = vec![from.min(to), from.max(to)];
    }
    let part = Plan::new(spec).ok()?;
    let curves = Curves::traced(map, view, &part, turned);
    curves.missing.is_none().then_some(curves.list)
}

/// The axes (p, q) of the plane that is shown, the delay second.
fn plane(view: &View, turned: bool) -> Option<(usize, usize)> {
    let y = view.y?;
    Some(if turned { (y, view.x) } else { (view.x, y) })
}

/// The plan from which curves are traced, and whether the second parameter of the plane lies from
/// left to right; else why none are.
fn plan(map: &MapFile, view: &View) -> Result<(Plan, bool), &'static str> {
    let plan = map.sweep().and_then(Plan::new);
    let own = |plan: &Plan| map.root_text(root::PLAN_HASH).as_deref() == Some(&plan.hash());
    let Some(plan) = plan.ok().filter(own) else {
        return Err("its sweep cannot be read");
    };
    if plan.spec.boundaries == Some(false) {
        return Err("its sweep has boundaries = false");
    }
    if !plan.spec.has_sliding() {
        return Err("it is not about sliding at a velocity");
    }
    let turned = map.axes()[view.x].parameter == Parameter::Tau;
    let axes = plane(view, turned).map(|(p, q)| [&plan.spec.axes[p], &plan.spec.axes[q]]);
    match axes.is_some_and(|axes| axes.into_iter().all(spans_curves)) {
        true => Ok((plan, turned)),
        false => Err("linear stability does not depend on both axes"),
    }
}
