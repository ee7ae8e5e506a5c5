//! The fields of the limit of a short delay: v_c in closed form, and the letter's approximations of
//! it.

use super::buffers::TileBuffers;
use crate::critical::limit::{CoulombLimit, strong, weak};
use crate::linear::status::NOT_CONVERGED;
use crate::model::ModelError;
use crate::sweep::input::field::Field;
use crate::sweep::input::limit_field::LimitField;
use crate::sweep::input::parameter::Parameter;
use crate::sweep::plan::Plan;
use crate::sweep::plan::tile::{Tile, for_each_index};

/// All fields at one γ and μ_K/μ_S.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LimitCell {
    exact: CoulombLimit,
    weak: f64,
    strong: f64,
}

impl LimitCell {
    /// At γ > 0 and μ_K/μ_S in (0, 1].
    ///
    /// # Errors
    /// As [`CoulombLimit::at`].
    pub fn at(gamma: f64, mu_ratio: f64) -> Result<Self, ModelError> {
        Ok(Self {
            exact: CoulombLimit::at(gamma, mu_ratio)?,
            weak: weak(gamma),
            strong: strong(gamma),
        })
    }

    /// The value of a field; infinite or NaN as [`LimitField::comment`] says.
    #[must_use]
    pub fn value(&self, field: LimitField) -> f64 {
        let vc = self.exact.vc_over_vtilde;
        let error = |approximation: f64| match vc {
            0.0 => f64::NAN,
            vc => approximation / vc - 1.0,
        };
        match field {
            LimitField::VcOverVtilde => vc,
            LimitField::Omega0T => self.exact.omega0_t,
            LimitField::LiftoffOverVtilde => self.exact.liftoff_over_vtilde,
            LimitField::VcWeakControl => self.weak,
            LimitField::VcStrongControl => self.strong,
            LimitField::WeakControlError => error(self.weak),
            LimitField::StrongControlError => error(self.strong),
        }
    }
}

/// Computes the cells of `tile`, whose places in `buffers` go by `strides`.
pub(super) fn fill(plan: &Plan, tile: &Tile, strides: &[usize], buffers: &mut TileBuffers) {
    let mut setting = plan.spec.fixed.clone();
    for_each_index(&tile.extent, None, |inside| {
        let mut at = 0;
        for (i, axis) in plan.spec.axes.iter().enumerate() {
            setting.set(axis.parameter, axis.values[tile.offset[i] + inside[i]]);
            at += inside[i] * strides[i];
        }
        let [gamma, mu_ratio] = Parameter::LIMIT.map(|p| setting.get(p));
        let Ok(cell) = LimitCell::at(gamma, mu_ratio) else {
            buffers.status[at] = NOT_CONVERGED;
            return;
        };
        buffers.status[at] = 0;
        for column in &mut buffers.columns {
            if let Field::Limit(field) = column.field {
                column.cells[at] = cell.value(field);
            }
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_are_relative_and_have_no_value_without_control_of_stick_slip() {
        let at = |gamma: f64| LimitCell::at(gamma, 0.5).unwrap();
        let cell = at(0.25);
        let [vc, weak, error] = [
            LimitField::VcOverVtilde,
            LimitField::VcWeakControl,
            LimitField::WeakControlError,
        ]
        .map(|f| cell.value(f));
        assert!((vc * (1.0 + error) / weak - 1.0).abs() < 1e-14);
        let beyond = at(1.5);
        assert!(beyond.value(LimitField::StrongControlError).is_nan());
        assert_eq!(beyond.value(LimitField::Omega0T), f64::INFINITY);
    }
}
