//! Pictures of maps, traces and points.
//!
//! ```text
//! map → [view] what is shown → [boundaries], [heat] or [line]
//!     → [scene] marks in pixels → [render] PNG or SVG → [pdf]
//! ```
//!
//! - `options`, `choice`: what is requested, and what is shown by default; `file`: formats
//! - `key`: what stands beside a heat map; `paint`: colours as requested; `hatch`: lines over cells
//!   without a value; `fitted`, `divisions`: cells along exact boundaries. What colours and words
//!   there are is in `src/meaning`
//! - `page`, `panels`, `inset`, `legend`: layout; `value_scale`: from values to places; `clip`,
//!   `areas`, `off_scale`: lines at edges, names and values beyond
//! - `stability`, `stable_area`, `stable_line`: of a plane, the region between its curves, and
//!   where a line crosses them;
//!   `label`, `curve_labels`, `near_curves`: labels of curves, free places beside curves, and their
//!   points by place
//! - `fit`: a friction law among the points to which it was fitted
//! - `trace`, `strips`, `stack`, `span`: a motion over time, in panels above one another, or a part
//!   of it; `close_up`: its switch-on, enlarged
//! - `response`: the response of a system in time
//! - `roots`: the characteristic roots of a point, and its line of delays
//! - `speed`: delays that are periods, shown as speeds
//! - `curve_lines`: exact curves over cells; `chained`: their pieces in one; `degrees`: dashed
//!   curves of degrees of stability; `symbols`: places with a meaning
//! - `text`, `font`: styles; `letters`: where texts and lines are
//! - `boundaries`: the boundaries of stability in one plane, with a colour for each value of the
//!   axis outside it
//! - `compared`: shares of starts that reach sliding, by two methods of control
//! - `error`: why a picture could not be drawn
//! - `heat`: heat maps of a field
//! - `inputs`: what a setting is, among the notes of its picture
//! - `kinds`: boundaries other than pairs of roots on the axis
//! - `loops`: the loop of a point: in the complex plane, and over the frequency
//! - `line`: fields along the only remaining axis: one at several values of another axis, or
//!   several together
//! - `pdf`: from SVG to PDF; the only file that imports svg2pdf
//! - `print`: how wide, how fine, and how large in print
//! - `rectangles`: joins cells into few rectangles
//! - `render`: from a scene to the bytes of a PNG or SVG file
//! - `scene`: the contents of a picture, in pixels from its upper left corner, independent of
//!   rendering
//! - `thinned`: curves of many points, reduced to what is seen of them
//! - `traced`: the curves of the planes that are shown, of the map or traced from its sweep
//! - `told_apart`, `uncrossed`: tests: colours under three kinds of colour blindness, and texts off
//!   lines in all shipped pictures
//! - `view`: the part of a map that is shown

mod areas;
mod boundaries;
mod chained;
mod choice;
mod clip;
mod close_up;
mod compared;
mod curve_labels;
mod curve_lines;
mod degrees;
mod divisions;
mod error;
mod file;
#[cfg(feature = "fit")]
mod fit;
mod fitted;
mod font;
mod hatch;
mod heat;
mod inputs;
mod inset;
mod key;
mod kinds;
mod label;
mod legend;
mod letters;
mod line;
mod loops;
mod near_curves;
mod off_scale;
mod options;
mod page;
mod paint;
mod panels;
mod pdf;
mod print;
mod rectangles;
mod render;
mod response;
mod roots;
mod scene;
mod span;
mod speed;
mod stability;
mod stable_area;
mod stable_line;
mod stack;
mod strips;
mod symbols;
mod text;
mod thinned;
mod trace;
mod traced;
mod value_scale;
mod view;

#[cfg(test)]
mod tests;
#[cfg(test)]
mod told_apart;
#[cfg(test)]
mod uncrossed;

use std::path::Path;

use crate::answers::Trace;
pub use crate::meaning::gradient::ColourMap;
use crate::report::visible::visible_line;
use crate::setting::CaseSpec;
use crate::store::{MapFile, TraceFile};
use choice::Choice;
pub use compared::ComparedPicture;
pub use error::PictureError;
use file::{Format, Origin};
pub use file::{Picture, is_name, named_in};
#[cfg(feature = "fit")]
pub use fit::FitPicture;
pub use loops::{LoopKind, LoopPicture};
pub use options::{Named, PictureKind, PictureOptions};
pub use print::Print;
pub use response::ResponsePicture;
pub use roots::PointPicture;
use scene::Scene;
use traced::Curves;
use view::{MOST_PANELS, View};

/// Draws a map for the file `path`, PNG, SVG or PDF by its extension, without writing any file. The
/// same map and options give the same bytes. If only one axis has more than one value, the picture
/// is a line, whatever the kind.
///
/// # Errors
/// When the options do not fit the map, there is nothing to draw, or the map cannot be read.
pub fn draw(map: &MapFile, path: &Path, options: &PictureOptions) -> Result<Picture, PictureError> {
    let format = Format::of(path)?;
    apart(map.path(), path)?;
    options.check()?;
    let scene = compose(map, options, format.most_cells())?;
    let origin = Origin {
        of: named(map.path()) + &options.asked(),
        named: choice::named(map, options).map_or("", |field| field.name()),
    };
    Picture::of(&scene, format, path, origin)
}

/// Draws the trace of the file `of` for the file `path`, as [`draw`] does a map: velocities,
/// elongation, forces and the controlled quantity over time, and the velocity over the elongation.
/// Of the options those about the sheet and its title are used; the default title is the case's.
///
/// # Errors
/// When the name of the file is not that of a picture, or options have no meaning for a trace.
pub fn draw_trace(
    spec: &CaseSpec,
    trace: &Trace,
    of: &Path,
    path: &Path,
    options: &PictureOptions,
) -> Result<Picture, PictureError> {
    let format = Format::of(path)?;
    options.check()?;
    options.about_values("a trace has no scale of values")?;
    let mut scene = Scene::asked(options);
    trace::draw(spec, options, trace, &mut scene)?;
    let origin = Origin {
        of: named(of) + " motion",
        named: "",
    };
    Picture::of(&scene, format, path, origin)
}

/// [`draw_trace`] of a trace in a file.
///
/// # Errors
/// As there, and when the picture would replace the trace.
pub fn draw_trace_file(
    file: &TraceFile,
    path: &Path,
    options: &PictureOptions,
) -> Result<Picture, PictureError> {
    apart(file.path(), path)?;
    draw_trace(&file.spec, &file.trace, file.path(), path, options)
}

/// Draws a point for the file `path`, as [`draw`] does a map: its characteristic roots in the
/// complex plane, and the number of unstable ones and the stable delays of its line.
///
/// # Errors
/// When the name of the file is not that of a picture.
pub fn draw_point(picture: &PointPicture, path: &Path) -> Result<Picture, PictureError> {
    let format = Format::of(path)?;
    let mut scene = Scene::new(PictureOptions::default().size);
    roots::draw(picture, &mut scene);
    let origin = Origin {
        of: "the characteristic roots of a point".to_owned(),
        named: "",
    };
    Picture::of(&scene, format, path, origin)
}

/// Draws the response of a system in time for the file `path`, as [`draw`] does a map.
///
/// # Errors
/// When the name of the file is not that of a picture.
pub fn draw_response(picture: &ResponsePicture, path: &Path) -> Result<Picture, PictureError> {
    let format = Format::of(path)?;
    let mut scene = Scene::new(PictureOptions::default().size);
    response::draw(picture, &mut scene);
    let origin = Origin {
        of: "the response of a system in time".to_owned(),
        named: "",
    };
    Picture::of(&scene, format, path, origin)
}

/// Draws the loop of a point for the file `path`, as [`draw`] does a map.
///
/// # Errors
/// When the name of the file is not that of a picture.
pub fn draw_loop(picture: &LoopPicture, path: &Path) -> Result<Picture, PictureError> {
    let format = Format::of(path)?;
    let mut scene = Scene::new(PictureOptions::default().size);
    loops::draw(picture, &mut scene);
    let origin = Origin {
        of: "the loop of a point".to_owned(),
        named: "",
    };
    Picture::of(&scene, format, path, origin)
}

/// Draws a comparison of methods of control for the file `path`, as [`draw`] does a map.
///
/// # Errors
/// When the name of the file is not that of a picture.
pub fn draw_compared(picture: &ComparedPicture, path: &Path) -> Result<Picture, PictureError> {
    let format = Format::of(path)?;
    let mut scene = Scene::new(PictureOptions::default().size);
    compared::draw(picture, &mut scene);
    let origin = Origin {
        of: "a comparison of methods of control".to_owned(),
        named: "",
    };
    Picture::of(&scene, format, path, origin)
}

/// Draws a fit for the file `path`, as [`draw`] does a map: the points, the law, and what the
/// points leave open of it.
///
/// # Errors
/// When the name of the file is not that of a picture.
#[cfg(feature = "fit")]
pub fn draw_fit(picture: &FitPicture, path: &Path) -> Result<Picture, PictureError> {
    let format = Format::of(path)?;
    let mut scene = Scene::new(PictureOptions::default().size);
    fit::draw(picture, &mut scene);
    let origin = Origin {
        of: "a fit of friction".to_owned(),
        named: "",
    };
    Picture::of(&scene, format, path, origin)
}

/// The name of a file, without its folder.
fn named(path: &Path) -> String {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    visible_line(&name)
}

/// Checks that the picture is not the file that it shows.
fn apart(shown: &Path, picture: &Path) -> Result<(), PictureError> {
    let same = match (shown.canonicalize(), picture.canonicalize()) {
        (Ok(shown), Ok(picture)) => shown == picture,
        _ => shown == picture,
    };
    let path = picture.to_owned();
    if same {
        Err(PictureError::OverMap { path })
    } else {
        Ok(())
    }
}

fn compose(map: &MapFile, options: &PictureOptions, most: usize) -> Result<Scene, PictureError> {
    let choice = Choice::of(map, options)?;
    let field = choice.field;
    let view = View::new(map, &options.at)?;
    let mut scene = Scene::asked(options);
    let Some(y) = view.y else {
        if options.kind == Some(PictureKind::Boundaries) {
            return Err(no_curves("only one axis is left to draw along"));
        }
        let fields = choice.shown_together(map, view.along.is_some());
        line::draw(map, &view, &fields, options, most, &mut scene)?;
        return Ok(scene);
    };
    let curves = Curves::of(map, &view)?;
    let fits = view.along.is_some() && view.of <= MOST_PANELS && view.outer_axes(map) == 1;
    let held = curves.stored && !curves.turned && !curves.list.is_empty();
    let by_default = fits && held && choice.leaves_curves(map);
    let over_speed = curves
        .turned
        .then_some("over a speed they are drawn over the cells alone");
    if options.kind == Some(PictureKind::Boundaries)
        && let Some(why) = over_speed.or(curves.none).or(curves.missing)
    {
        return Err(no_curves(why));
    }
    match options.kind {
        kind if kind == Some(PictureKind::Boundaries) || (kind.is_none() && by_default) => {
            options.about_values("curves have no scale of values")?;
            boundaries::draw(map, &view, y, &curves.list, options, &mut scene)?;
        }
        _ => heat::draw(map, &view, y, field, &curves, (options, most), &mut scene)?,
    }
    Ok(scene)
}

fn no_curves(why: &'static str) -> PictureError {
    PictureError::NoCurves { why }
}
