//! The arguments for a point of sliding: flags, a map's cell, or a file of a setting.

use std::path::Path;

use slipmap::sweep::input::point_file::PointOf;
use slipmap::sweep::input::units::Units;
use slipmap::sweep::{Parameter, Setting};

use super::cell::{CellArgs, alone};
use super::failure::Failure;
use super::parameters::ParameterArgs;
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

    /// The setting of the cell of a map, if the map is of a system from a file.
    pub(super) fn cell_of_system(&self) -> Result<Option<Setting>, Failure> {
        let setting = self.cell.of_system()?;
        if setting.is_some() {
            alone("--map", self.parameters.any_but(&[]))?;
        }
        Ok(setting)
    }

    /// The value of the flag of a parameter.
    pub(super) fn given(&self, parameter: Parameter) -> Option<f64> {
        self.parameters.given(parameter)
    }

    /// Checks that beside the flag `with`, which gives the rest, there are only the flags of the
    /// parameters `but`.
    pub(super) fn check_alone(&self, with: &str, but: &[Parameter]) -> Result<(), Failure> {
        let others = self.cell.map.is_some() || self.file.is_given();
        alone(with, others || self.parameters.any_but(but))
    }

    /// The setting, from a file, a map or flags, and its units.
    pub(super) fn read(&self) -> Result<(Setting, Units), Failure> {
        let given = self.parameters.any_but(&[]);
        if let Some(point) = self.file.point(PointOf::Sliding)? {
            alone("--setting", given)?;
            return Ok((point.setting, point.units));
        }
        if let Some(point) = self.cell.point(PointOf::Sliding)? {
            alone("--map", given)?;
            return Ok((point.setting, point.units));
        }
        Ok((self.parameters.setting()?, self.parameters.units()))
    }
}
