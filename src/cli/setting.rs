//! A setting from a file instead of flags, `--setting SETTING.toml`; and files of settings for
//! later commands.

use std::path::{Path, PathBuf};

use crate::setting::Setting;
use crate::setting::point_file::{PointOf, PointSpec};
use crate::setting::setting_text::setting_text;
use crate::setting::units::Units;
use crate::store::{Output, regular};

use super::failure::Failure;
use super::output::{warn_beyond_curve, warn_of_idle_delay};
use super::sweep_file::read_setting;

/// The first words of a file of a setting.
const HEAD: &str = "# A setting by slipmap";

#[derive(Debug, clap::Args)]
pub(super) struct SettingArgs {
    /// Take everything from this file, as `slipmap fit --save` or `slipmap best --save` writes
    /// it
    #[arg(long, value_name = "SETTING.toml", conflicts_with = "map")]
    setting: Option<PathBuf>,
}

impl SettingArgs {
    /// Whether a file is given.
    pub(super) fn is_given(&self) -> bool {
        self.setting.is_some()
    }

    /// The path of the file.
    pub(super) fn path(&self) -> Option<&Path> {
        self.setting.as_deref()
    }

    /// The point in the file; none without a file.
    pub(super) fn point(&self, of: PointOf) -> Result<Option<PointSpec>, Failure> {
        let Some(path) = &self.setting else {
            return Ok(None);
        };
        let point = read_setting(path, of)?;
        warn_of_idle_delay(point.setting.has_idle_delay());
        if of == PointOf::Sliding {
            warn_beyond_curve(point.setting.curve_remark(&point.units));
        }
        Ok(Some(point))
    }
}

/// An error if `path` has a file that slipmap did not write, which must not be replaced.
pub(super) fn check_save(path: &Path) -> Result<(), Failure> {
    let name = path.display();
    if path.extension().is_none_or(|extension| extension != "toml") {
        return Err(Failure::bad_input_with_help(
            format!("--save {name} is no name for a setting"),
            "name it like setting.toml",
        ));
    }
    if path.symlink_metadata().is_err() {
        return Ok(());
    }
    let head = regular::head(path, HEAD.len() as u64);
    let by_slipmap = head.is_ok_and(|head| head == HEAD.as_bytes());
    match by_slipmap {
        true => Ok(()),
        false => Err(Failure::bad_input_with_help(
            format!("--save {name} is there and not by slipmap"),
            "it is left as it is; remove it first, or write elsewhere",
        )),
    }
}

/// Writes a setting, completely or not at all.
pub(super) fn save(setting: &Setting, units: &Units, path: &Path) -> Result<(), Failure> {
    let takers = match setting.law() {
        Some(_) => "point, margins, best, vc, basin and simulate take it with --setting",
        None => "point, margins and best take it with --setting",
    };
    let text = setting_text(setting, units, |_| true);
    let text = format!("{HEAD}; {takers}\n\n{text}");
    Ok(Output::claim(path)?.fill(text)?)
}
