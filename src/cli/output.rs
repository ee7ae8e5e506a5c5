//! Common to all commands that write a file: its name, and its provenance.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use crate::maps::assembly::Assembled;
use crate::report::numbers::{grouped, representable};
use crate::report::picture::{self, Picture, PictureError};
use crate::setting::units::Units;
use crate::sweep::Plan;
use crate::sweep::described::root::Provenance;

use super::failure::Failure;
use super::say;
use super::sweep_file::STANDARD_INPUT;
use super::text_output::STANDARD_OUTPUT;

/// Extensions of maps and traces: those of HDF5, and of netCDF, whose readers read the same file.
const ENDINGS: [&str; 3] = ["h5", "hdf5", "nc"];

/// Refuses a name, given by `flag` for a map or a trace (its `kind`), without an extension of HDF5.
/// A name without any extension is refused too: no program would recognise it.
pub(super) fn check_name(flag: &str, path: &Path, kind: &str) -> Result<(), Failure> {
    let shown = format!("{flag}{}", path.display());
    let is_folder = path.as_os_str().as_encoded_bytes().ends_with(b"/");
    if is_folder || path.file_name().is_none() {
        return Err(Failure::bad_input(format!("{shown} does not name a file")));
    }
    let help = format!(
        "name it like NAME.h5, NAME.hdf5 or, for readers of netCDF, NAME.nc; a picture is drawn \
         beside the {kind}, `slipmap export` makes tables of it"
    );
    if path == Path::new(STANDARD_OUTPUT) {
        let message = format!("{shown}: a {kind} is a file, standard output takes none");
        return Err(Failure::bad_input_with_help(message, help));
    }
    let ending = path.extension().map(|e| e.to_string_lossy().to_lowercase());
    let message = match ending.as_deref() {
        Some(ending) if ENDINGS.contains(&ending) => match path.to_str() {
            Some(_) => return Ok(()),
            None => {
                return Err(Failure::bad_input(format!(
                    "{shown} is not UTF-8, and HDF5 does not open files of such names"
                )));
            }
        },
        Some(other) => format!("{shown}: a {kind} is written as HDF5, not as {other}"),
        None => format!("{shown}: a {kind} is written as HDF5, which this name does not tell"),
    };
    Err(Failure::bad_input_with_help(message, help))
}

/// The file to write: `given`, or the name of `input` with .h5 in the current folder. `kind` is map
/// or trace.
pub(super) fn output_path(
    given: Option<&Path>,
    input: &Path,
    kind: &str,
) -> Result<PathBuf, Failure> {
    let path = if let Some(path) = given {
        path.to_owned()
    } else if input == Path::new(STANDARD_INPUT) {
        return Err(Failure::bad_input_with_help(
            "--output is not given, and standard input has no name",
            format!("for example: -o {kind}.h5"),
        ));
    } else {
        let stem = input.file_stem().unwrap_or(input.as_os_str());
        let mut name = stem.to_owned();
        name.push(".h5");
        PathBuf::from(name)
    };
    check_name("--output ", &path, kind)?;
    Ok(path)
}

/// Refuses a name, given by `flag` for a picture, that does not suit a picture, or is the name of
/// `other`, a map or a trace.
pub(super) fn check_picture(flag: &str, name: &Path, other: Option<&Path>) -> Result<(), Failure> {
    let shown = name.display();
    if !picture::is_name(name) {
        return Err(Failure::bad_input_with_help(
            format!("{flag} {shown} is no name for a picture"),
            "name it like fig.png, fig.svg or fig.pdf",
        ));
    }
    if other == Some(name) {
        let message = format!("{flag} {shown} would replace the file of that name");
        return Err(Failure::bad_input(message));
    }
    Ok(())
}

/// Saves the picture that `draw` draws: under the `asked` name, or else `beside`. There it replaces
/// only files of slipmap, and a failure is only a warning; none if nothing is saved.
pub(super) fn save_picture(
    asked: Option<&Path>,
    beside: PathBuf,
    draw: impl Fn(&Path) -> Result<Picture, PictureError>,
) -> Result<Option<PathBuf>, Failure> {
    if let Some(asked) = asked {
        let saved = draw(asked).and_then(Picture::save);
        saved.map_err(|error| Failure::failed(error.to_string()))?;
        return Ok(Some(asked.to_owned()));
    }
    match draw(&beside).and_then(Picture::save_unasked) {
        Ok(()) => Ok(Some(beside)),
        Err(error) => {
            let elsewhere = match error {
                PictureError::OthersWork { .. } => "; --picture draws elsewhere",
                _ => "",
            };
            say::remark(format_args!("warning: no picture: {error}{elsewhere}"));
            Ok(None)
        }
    }
}

/// The provenance of a file made now by `command` from `input`.
pub(super) fn provenance(command: &str, input: &Path) -> Provenance {
    let now = humantime::format_rfc3339_seconds(representable(SystemTime::now()));
    Provenance::here(format!("{now} slipmap {command} {}", input.display()))
}

/// Reports once that numbers have no units. If they have, each is followed by its unit.
pub(super) fn tell_dimensionless(out: &mut impl Write, units: &Units) -> std::io::Result<()> {
    match units.dimensionless() {
        true => writeln!(out, "  {:<16} none: dimensionless", "units"),
        false => Ok(()),
    }
}

/// Tells once that units are assumed, because some numbers have one.
pub(super) fn tell_assumed_units(units: &Units) {
    if let Some(remark) = units.remark() {
        say::note(remark);
    }
}

/// Warns once if a delay is given that has no effect.
pub(super) fn warn_of_idle_delay(idle: bool) {
    if idle {
        say::remark("warning: tau has no effect: both gains, alpha_v and alpha_n, are 0");
    }
}

/// Warns once if the sliding velocity lies beyond a measured friction curve, by this remark.
pub(super) fn warn_beyond_curve(remark: Option<String>) {
    if let Some(remark) = remark {
        say::remark(format_args!("warning: {remark}"));
    }
}

/// Reports on standard error why a map has no curves, where it would have them if asked for.
pub(super) fn tell_no_boundaries(plan: &Plan) {
    if let Some(why) = plan.no_boundaries().filter(|why| why.is_only_unasked()) {
        say::note(format_args!("no boundaries: {why}"));
    }
}

/// Reports on standard error what a map has besides cells.
pub(super) fn tell_assembled(assembled: &Assembled) {
    if assembled.curves > 0 {
        let (curves, corners) = (grouped(assembled.curves), grouped(assembled.corners));
        say::note(format_args!("{curves} crossing curves, {corners} corners"));
    }
    if assembled.planes_left_out > 0 {
        let planes = match assembled.planes_left_out {
            1 => "1 plane".to_owned(),
            planes => format!("{} planes", grouped(planes)),
        };
        say::remark(format_args!(
            "warning: no curves in {planes}, where there are too many to trace"
        ));
    }
    match assembled.best_planes {
        0 => {}
        1 => say::note("the best setting"),
        planes => say::note(format_args!("best settings in {} planes", grouped(planes))),
    }
}
