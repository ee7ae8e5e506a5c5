//! Draws a complete map beside it and on the terminal, after `run` and `merge`.

use std::io::IsTerminal;
use std::path::Path;

use crate::report::numbers::{rounded, unit_behind};
use crate::report::picture::{self, Named, Picture, PictureError, PictureOptions};
use crate::report::preview::preview;
use crate::setting::Parameter;
use crate::setting::quantity::Quantity;
use crate::store::{MapFile, Output, StoreError};

use super::colours::Colours;
use super::failure::Failure;
use super::signals::Signals;
use super::{plot, say};

/// Columns of the picture on the terminal, no more than any terminal has.
const PREVIEW_WIDTH: usize = 78;
/// The most planes whose best settings are printed; the map has all of them.
const PLANES_TOLD: usize = 8;

/// Reports that a map is already complete. Draws it if an earlier command did not, or if the sweep
/// file now names another field for pictures.
pub(super) fn nothing_to_do(
    path: &Path,
    remark: &str,
    named: Named,
    signals: &Signals,
) -> Result<(), Failure> {
    if lacks_picture(path, named) {
        show(path, named, signals);
    }
    Output::clear_leftovers(path);
    Output::clear_leftovers(&plot::beside(path));
    say::result(format_args!(
        "{} is already complete{remark}",
        path.display()
    ))
}

/// Prints the best setting of every plane, up to a limit.
fn tell_best(map: &MapFile) -> Result<(), StoreError> {
    let Some((gain, tau)) = map.best_plane() else {
        return Ok(());
    };
    // A map without its sweep is a matter for `verify`.
    let Ok(units) = map.sweep().map(|sweep| sweep.units) else {
        return Ok(());
    };
    let with = |parameter: &Quantity, value: f64| {
        let unit = unit_behind(&parameter.unit(&units));
        format!("{} = {}{unit}", parameter.name(), rounded(value, 8))
    };
    let axes = map.axes();
    let outer: Vec<&Quantity> = (0..axes.len())
        .filter(|axis| *axis != gain && *axis != tau)
        .map(|axis| &axes[axis].parameter)
        .collect();
    let all = map.best()?;
    for best in all.iter().take(PLANES_TOLD) {
        let pairs = outer.iter().zip(&best.outer);
        let plane: Vec<String> = pairs.map(|(p, value)| with(p, *value)).collect();
        let place = [
            with(&axes[gain].parameter, best.gain),
            with(&Parameter::Tau.into(), best.tau),
        ];
        let time = unit_behind(&units.time());
        let relaxes = match (best.kind, best.relaxation_time) {
            (None, _) => "not looked for".to_owned(),
            (_, None) => "unstable everywhere".to_owned(),
            (_, Some(relaxation)) => format!(
                "{}: relaxation time {}{time}",
                place.join(", "),
                rounded(relaxation, 8)
            ),
        };
        let plane = match plane.is_empty() {
            true => String::new(),
            false => format!(" at {}", plane.join(", ")),
        };
        say::note(format_args!("best setting{plane}: {relaxes}"));
    }
    if all.len() > PLANES_TOLD {
        let more = all.len() - PLANES_TOLD;
        say::note(format_args!(
            "and those of {more} further planes, in the map"
        ));
    }
    Ok(())
}

/// Whether a map has no picture, an older one than the map, or one of another field than the sweep
/// file names.
fn lacks_picture(map: &Path, named: Named) -> bool {
    let beside = plot::beside(map);
    let written = |path: &Path| path.metadata().and_then(|m| m.modified());
    let other = || {
        let shown = picture::named_in(&beside);
        shown.is_some_and(|shown| match named {
            Named::InMap => false,
            Named::As(field) => shown != field.name(),
            Named::Nothing => !shown.is_empty(),
        })
    };
    match (written(map), written(&beside)) {
        (Ok(map), Ok(picture)) => picture < map || other(),
        (_, picture) => picture.is_err(),
    }
}

/// Draws a complete map beside it and on the terminal. A failure here is only a warning: the map
/// exists.
pub(super) fn show(path: &Path, named: Named, signals: &Signals) {
    let complete = format!("{} is complete, the same command draws it", path.display());
    let map = match signals.or_end(&complete, || MapFile::open(path)) {
        Ok(map) => map,
        Err(error) => return say::remark(format_args!("warning: no picture: {error}")),
    };
    let picture = plot::beside(path);
    Output::clear_leftovers(&picture);
    let options = PictureOptions {
        named,
        ..PictureOptions::default()
    };
    let drawn = signals.or_end(&complete, || picture::draw(&map, &picture, &options));
    match drawn.and_then(Picture::save_unasked) {
        // If standard output is closed, the line about the map has already reported it.
        Ok(()) => drop(say::result(picture.display())),
        Err(PictureError::NothingToDraw) => {}
        Err(error @ PictureError::OthersWork { .. }) => say::remark(format_args!(
            "warning: no picture: {error}; `slipmap plot -o` draws elsewhere"
        )),
        Err(error) => say::remark(format_args!("warning: no picture: {error}")),
    }
    if say::is_quiet() {
        return;
    }
    if let Err(error) = signals.or_end(&complete, || tell_best(&map)) {
        say::remark(format_args!("warning: no best settings: {error}"));
    }
    if !std::io::stderr().is_terminal() {
        return;
    }
    let coloured = Colours::asked().of_terminal();
    match signals.or_end(&complete, || preview(&map, PREVIEW_WIDTH, coloured)) {
        Ok(Some(text)) => say::coloured(text.trim_end_matches('\n')),
        Ok(None) => {}
        Err(error) => say::remark(format_args!("warning: no preview: {error}")),
    }
}
