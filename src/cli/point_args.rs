//! A point at which sliding is asked for: by flags, of a map's cell, or from a file of a setting.

use std::path::Path;

use slipmap::sweep::Setting;
use slipmap::sweep::input::point_file::PointOf;
use slipmap::sweep::input::units::Units;

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
    /// The map whose cell is asked for.
    pub(super) fn map(&self) -> Option<&Path> {
        self.cell.map.as_deref()
    }

    /// The setting, from a map or from flags, and its units.
    pub(super) fn read(&self) -> Result<(Setting, Units), Failure> {
        let given = self.parameters.any_given();
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
