//! Best settings of a whole sweep, plane by plane.

use super::boundaries::plane_spanned;
use crate::answers::best::{BestSettings, Ranges, best_settings};
use crate::answers::search_plane::SearchPlane;
use crate::model::stop::Stop;
use crate::sweep::plan::Plan;

/// The place of the `number`-th plane of best settings, as indices along every axis.
#[must_use]
pub fn best_plane(plan: &Plan, number: u64) -> Vec<usize> {
    plane_spanned(plan, plan.best_plane(), number)
}

/// The best settings of a plan in the plane at `index`; none where a parameter is outside the
/// model's range. Once `stop` is set, the answer comes soon but is meaningless.
#[must_use]
pub fn best_of_plane(plan: &Plan, index: &[usize], stop: &Stop) -> Option<BestSettings> {
    let (p, tau) = plan.best_plane()?;
    let axes = &plan.spec.axes;
    let ranges = Ranges {
        p: axes[p].range(),
        q: axes[tau].range(),
    };
    let plane = SearchPlane::with_delay(&axes[p].parameter);
    best_settings(&plan.setting(index), &plane, &ranges, stop).ok()
}
