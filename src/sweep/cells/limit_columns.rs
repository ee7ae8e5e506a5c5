//! The fields of the limit of a short delay: v_c in closed form, and the letter's approximations.

use super::buffers::TileBuffers;
use crate::critical::limit::LimitCell;
use crate::linear::status::OUTSIDE_MODEL;
use crate::setting::parameter::Parameter;
use crate::setting::source::Source;
use crate::sweep::plan::Plan;
use crate::sweep::plan::tile::{Tile, for_each_index, place_of};

/// Computes the cells of `tile`; `strides` are those of `buffers`.
pub(super) fn fill(plan: &Plan, tile: &Tile, strides: &[usize], buffers: &mut TileBuffers) {
    let mut setting = plan.spec.fixed.clone();
    for_each_index(&tile.extent, None, |inside| {
        for (i, axis) in plan.spec.axes.iter().enumerate() {
            setting.vary(&axis.parameter, axis.values[tile.offset[i] + inside[i]]);
        }
        let at = place_of(inside, strides);
        let [gamma, damping_ratio, mu_ratio] = Parameter::OF_LIMIT.map(|p| setting.get(p));
        let Ok(cell) = LimitCell::at(gamma, damping_ratio, mu_ratio) else {
            buffers.status[at] = OUTSIDE_MODEL;
            return;
        };
        buffers.status[at] = 0;
        for column in &mut buffers.columns {
            if let Source::Limit(value) = column.field.source() {
                column.cells[at] = value(&cell);
            }
        }
    });
}
