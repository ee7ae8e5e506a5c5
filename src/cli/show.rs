//! A complete map is drawn beside it, and on the terminal: after `run` and `merge`.

use std::io::IsTerminal;
use std::path::Path;

use slipmap::report::picture::{self, Named, Picture, PictureError, PictureOptions};
use slipmap::report::preview::preview;
use slipmap::store::MapFile;

use super::colours::Colours;
use super::failure::Failure;
use super::signals::Signals;
use super::{plot, say};

/// Columns of the picture on the terminal: as many as every terminal has.
const PREVIEW_WIDTH: usize = 78;

/// Says that a map is complete, and draws it where an earlier command did not come to that, or
/// where the sweep file names another field for pictures by now.
pub(super) fn nothing_to_do(
    path: &Path,
    remark: &str,
    named: Named,
    signals: &Signals,
) -> Result<(), Failure> {
    if lacks_picture(path, named) {
        show(path, named, signals);
    }
    say::result(format_args!(
        "{} is already complete{remark}",
        path.display()
    ))
}

/// Whether there is no picture beside a map, or one of what was there before, or of another field
/// than the sweep file names.
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

/// Draws a complete map beside it, and on the terminal. What fails here is a warning: the map is
/// there.
pub(super) fn show(path: &Path, named: Named, signals: &Signals) {
    let complete = format!("{} is complete, the same command draws it", path.display());
    let map = match signals.or_end(&complete, || MapFile::open(path)) {
        Ok(map) => map,
        Err(error) => return say::remark(format_args!("warning: no picture: {error}")),
    };
    let picture = plot::beside(path);
    let options = PictureOptions {
        named,
        ..PictureOptions::default()
    };
    let drawn = signals.or_end(&complete, || picture::draw(&map, &picture, &options));
    match drawn.and_then(Picture::save_unasked) {
        // Where standard output takes no more, the line about the map has said so.
        Ok(()) => drop(say::result(picture.display())),
        Err(PictureError::NothingToDraw) => {}
        Err(error @ PictureError::OthersWork { .. }) => say::remark(format_args!(
            "warning: no picture: {error}; `slipmap plot -o` draws elsewhere"
        )),
        Err(error) => say::remark(format_args!("warning: no picture: {error}")),
    }
    if say::is_quiet() || !std::io::stderr().is_terminal() {
        return;
    }
    let coloured = Colours::asked().of_terminal();
    match signals.or_end(&complete, || preview(&map, PREVIEW_WIDTH, coloured)) {
        Ok(Some(text)) => say::coloured(text.trim_end_matches('\n')),
        Ok(None) => {}
        Err(error) => say::remark(format_args!("warning: no preview: {error}")),
    }
}
