//! The arguments for a point of sliding: flags, a map's cell, or a file of a setting.

use std::path::Path;

use crate::setting::Parameter;
use crate::setting::point_file::PointOf;
use crate::setting::units::Units;

use super::asked::Asked;
use super::cell::{CellArgs, alone};
use super::failure::Failure;
use super::parameters::ParameterArgs;
use super::sets::SetArgs;
use super::setting::SettingArgs;

#[derive(Debug, clap::Args)]
pub(super) struct PointArgs {
    #[command(flatten)]
    parameters: ParameterArgs,
    #[command(flatten)]
    cell: CellArgs,
    #[command(flatten)]
    file: SettingArgs,
}

impl PointArgs {
    /// The map whose cell is requested.
    pub(super) fn map(&self) -> Option<&Path> {
        self.cell.map.as_deref()
    }

    /// The cell of a map, if the map is of a system from a file.
    pub(super) fn cell_of_system(&self) -> Result<Option<Asked>, Failure> {
        let (Some(setting), Some(map)) = (self.cell.of_system()?, self.map()) else {
            return Ok(None);
        };
        alone("--map", self.parameters.any_but(&[]))?;
        let map = map.display().to_string();
        Ok(Some(Asked::of_system(setting, "map", map)))
    }

    /// The values of parameters that a system or a formula names.
    pub(super) fn sets(&self) -> &SetArgs {
        self.parameters.sets()
    }

    /// The value of the flag of a parameter.
    pub(super) fn given(&self, parameter: Parameter) -> Option<f64> {
        self.parameters.given(parameter)
    }

    /// The units of all numbers.
    pub(super) fn units(&self) -> Units {
        self.parameters.units()
    }

    /// Checks that beside the flag `with`, which gives the rest, there are only the flags of the
    /// parameters `but`, and units.
    pub(super) fn check_alone(&self, with: &str, but: &[Parameter]) -> Result<(), Failure> {
        let others = self.cell.map.is_some() || self.file.is_given();
        alone(with, others || self.parameters.any_but_units(but))?;
        self.parameters.refuse_units()
    }

    /// The setting of the block, from a file, a map or flags.
    pub(super) fn read(&self) -> Result<Asked, Failure> {
        let given = self.parameters.any_but(&[]) || self.sets().any();
        let block = |setting, units| Asked {
            setting,
            units,
            named: None,
        };
        if let Some(point) = self.file.point(PointOf::Sliding)? {
            alone("--setting", given)?;
            return Ok(block(point.setting, point.units));
        }
        if let Some(point) = self.cell.point(PointOf::Sliding)? {
            alone("--map", given)?;
            return Ok(block(point.setting, point.units));
        }
        Ok(block(self.parameters.setting()?, self.parameters.units()))
    }
}
