//! Pictures of maps and traces.
//!
//! ```text
//! map → [view] what is shown → [boundaries], [heat] or [line]
//!     → [scene] marks in pixels → [render] PNG or SVG
//! ```
//!
//! - `key`: which colour a value of a field has in a heat map; `hatch`: cells that show none
//! - `page`, `panels`, `legend`: where things stand; `scale`, `ticks`: from values to places
//! - `stable_area`, `curve_labels`: the region between curves, and free places on curves
//! - `trace`, `stack`: a motion over time, in panels above one another
//! - `degrees`: dashed curves of degrees of stability
//! - `colour`, `text`, `font`: how things look

mod boundaries;
mod colour;
mod curve_labels;
mod degrees;
mod error;
mod font;
mod hatch;
mod heat;
mod key;
mod legend;
mod line;
mod page;
mod panels;
mod rectangles;
mod render;
mod scale;
mod scene;
mod stable_area;
mod stack;
mod text;
mod ticks;
mod trace;
mod view;

use std::fs;
use std::io::Read;
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};

use crate::report::visible::visible_line;
use crate::store::schema::root;
use crate::store::{MapFile, Output, StoreError, TraceFile};
use crate::sweep::{CaseSpec, Field, Parameter, Trace};
pub use error::PictureError;
use scene::Scene;
use text::Rich;
use view::{MOST_PANELS, View};

/// Widths and heights that make a picture, in pixels.
const SIZES: RangeInclusive<u32> = 300..=5000;
/// Cells read along an axis: more are not seen in a bitmap, and make an SVG file unwieldy.
const MOST_CELLS: usize = 1200;
const MOST_SVG_CELLS: usize = 320;

/// The part of a PNG file in which its signature is looked for.
const BYTES_TO_SIGNATURE: u64 = 512;

/// What kind of picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PictureKind {
    /// The boundaries of stability as curves, one colour per value of the axis outside their plane,
    /// like Fig. 2 of the letter.
    Boundaries,
    /// A heat map of a field, one panel per value of the axis outside the plane.
    Heat,
}

/// How a map is drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct PictureOptions {
    /// The field to show; by default the one that the sweep names for pictures, else the first
    /// held of the regime of v0, the velocity above which sliding is smooth, the critical
    /// velocity, the outcome, the spectral abscissa, the number of unstable roots.
    pub field: Option<Field>,
    /// The kind; by default boundaries where the map holds them for 2 to 12 values of one axis
    /// outside their plane, holds none of the first five and no field is asked for or named,
    /// otherwise a heat map.
    pub kind: Option<PictureKind>,
    /// Values at which axes are held: the nearest on the axis. Several for one axis make as many
    /// panels or colours.
    pub at: Vec<(Parameter, f64)>,
    /// Width and height in pixels, 300 to 5000 each.
    pub size: (u32, u32),
    /// The title; by default the sweep's in pictures of the field that it shows, else what the
    /// field is.
    pub title: Option<String>,
}

impl Default for PictureOptions {
    fn default() -> Self {
        Self {
            field: None,
            kind: None,
            at: Vec::new(),
            size: (1600, 1100),
            title: None,
        }
    }
}

/// A picture that is drawn, and not yet in its file.
#[derive(Debug)]
#[must_use]
pub struct Picture {
    bytes: Vec<u8>,
    path: PathBuf,
}

impl Picture {
    fn of(scene: &Scene, format: &Format, path: &Path) -> Result<Self, PictureError> {
        let bytes = match format {
            Format::Png => render::png(scene),
            Format::Svg => render::svg(scene),
        }?;
        Ok(Self {
            bytes,
            path: path.to_owned(),
        })
    }

    /// The bytes of its file.
    #[must_use]
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// Writes the file. It appears when it is complete; one that is there is replaced.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn save(self) -> Result<(), PictureError> {
        let Self { bytes, path } = self;
        let output = Output::claim(&path)?;
        fs::write(output.part(), bytes).map_err(|source| StoreError::Io {
            action: "write",
            path,
            source,
        })?;
        Ok(output.commit()?)
    }
}

/// Draws a map for the file `path`, PNG or SVG by its extension, and changes no file. The same map
/// and options give the same bytes. Where only one axis has more than one value the picture is a
/// line, whatever the kind.
///
/// # Errors
/// When the options do not fit the map, there is nothing to draw, or the map cannot be read.
pub fn draw(map: &MapFile, path: &Path, options: &PictureOptions) -> Result<Picture, PictureError> {
    let format = Format::of(path)?;
    apart(map.path(), path)?;
    let most = match format {
        Format::Png => MOST_CELLS,
        Format::Svg => MOST_SVG_CELLS,
    };
    Picture::of(&compose(map, options, most)?, &format, path)
}

/// Draws a trace for the file `path`, as [`draw`] does a map: velocities, elongation and the
/// quantity that is controlled over time, and the velocity over the elongation. Of the options the
/// size and the title count; the title is the case's by default.
///
/// # Errors
/// When the name of the file is no picture's, or the size none of a picture.
pub fn draw_trace(
    spec: &CaseSpec,
    trace: &Trace,
    path: &Path,
    options: &PictureOptions,
) -> Result<Picture, PictureError> {
    let format = Format::of(path)?;
    let mut scene = sheet(options)?;
    let title = options.title.as_deref().unwrap_or(&spec.title);
    trace::draw((spec, title), trace, &mut scene);
    Picture::of(&scene, &format, path)
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
    draw_trace(&file.spec, &file.trace, path, options)
}

/// True for a file name that a picture can have.
#[must_use]
pub fn is_name(path: &Path) -> bool {
    Format::of(path).is_ok()
}

/// True if `path` is free, or holds a PNG picture of slipmap's: nobody's work is lost by drawing
/// there unasked.
#[must_use]
pub fn may_replace(path: &Path) -> bool {
    // A pipe would be waited for.
    if !path.metadata().is_ok_and(|m| m.is_file()) {
        return path.symlink_metadata().is_err();
    }
    let Ok(file) = fs::File::open(path) else {
        return false;
    };
    let mut start = Vec::new();
    file.take(BYTES_TO_SIGNATURE)
        .read_to_end(&mut start)
        .is_ok()
        && render::signed(&start)
}

/// Of longer titles no more is drawn.
const LONGEST_TITLE: usize = 400;

enum Format {
    Png,
    Svg,
}

impl Format {
    fn of(path: &Path) -> Result<Self, PictureError> {
        let extension = path.extension().map(|e| e.to_string_lossy().to_lowercase());
        match extension.as_deref() {
            Some("png") => Ok(Self::Png),
            Some("svg") => Ok(Self::Svg),
            _ => Err(PictureError::Extension {
                path: path.to_owned(),
            }),
        }
    }
}

/// The picture is another file than what it shows.
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

/// An empty sheet of the size asked for.
fn sheet(options: &PictureOptions) -> Result<Scene, PictureError> {
    let (width, height) = options.size;
    if !(SIZES.contains(&width) && SIZES.contains(&height)) {
        return Err(PictureError::Size {
            width,
            height,
            allowed: format!("{} to {} pixels", SIZES.start(), SIZES.end()),
        });
    }
    Ok(Scene::new(options.size))
}

fn compose(map: &MapFile, options: &PictureOptions, most: usize) -> Result<Scene, PictureError> {
    let mut scene = sheet(options)?;
    let chosen = options.field.or_else(|| of_sweep(map));
    let field = chosen.unwrap_or_else(|| default_field(map));
    if !map.fields().contains(&field) {
        let held: Vec<&str> = map.fields().iter().map(|f| f.name()).collect();
        return Err(PictureError::NoSuchField {
            field: field.name(),
            held: held.join(", "),
        });
    }
    let view = View::new(map, &options.at)?;
    let Some(y) = view.y else {
        if options.kind == Some(PictureKind::Boundaries) {
            return Err(no_curves("only one axis is left to draw along"));
        }
        let fields = match chosen {
            Some(field) => vec![field],
            None => shown_together(map, &view, field),
        };
        line::draw(map, &view, &fields, options, most, &mut scene)?;
        return Ok(scene);
    };
    let in_plane = view.is_boundary_plane(map);
    let curves = match in_plane {
        true => map.curves_where(|outer| view.shows(map, outer))?,
        false => Vec::new(),
    };
    let fits = view.along.is_some() && view.of <= MOST_PANELS && view.outer_axes(map) == 1;
    let by_default = fits && chosen.is_none() && says_more(map).is_none() && !curves.is_empty();
    match options.kind {
        Some(PictureKind::Boundaries) if !in_plane => {
            return Err(no_curves(match map.boundary_plane() {
                None => "its sweep traced none",
                Some(_) => "they lie in another plane, of whose axes one is held",
            }));
        }
        kind if kind == Some(PictureKind::Boundaries) || (kind.is_none() && by_default) => {
            boundaries::draw(map, &view, y, &curves, options, &mut scene)?;
        }
        _ => heat::draw(map, &view, y, field, &curves, (options, most), &mut scene)?,
    }
    Ok(scene)
}

/// The field that the map's sweep names for its pictures.
fn of_sweep(map: &MapFile) -> Option<Field> {
    let named = map.sweep().ok()?.picture;
    named.filter(|field| map.fields().contains(field))
}

/// A field of the map that says more than where sliding is stable: what v0 is good for,
/// from where sliding is smooth, the critical velocity, what becomes of motions, or the rate at
/// which disturbances decay.
fn says_more(map: &MapFile) -> Option<Field> {
    let more = [
        Field::Regime,
        Field::VSmooth,
        Field::Vc,
        Field::Outcome,
        Field::Abscissa,
    ];
    more.into_iter().find(|field| map.fields().contains(field))
}

/// What says most about the map.
fn default_field(map: &MapFile) -> Field {
    says_more(map)
        .or_else(|| map.stability_field())
        .or_else(|| map.fields().first().copied())
        .unwrap_or(Field::NUnstable)
}

/// The fields that one line picture shows where none is asked for: the default one `field`, and
/// those that it is compared with.
fn shown_together(map: &MapFile, view: &View, field: Field) -> Vec<Field> {
    if view.along.is_some() || !field.of_limit() {
        return vec![field];
    }
    let velocities = Field::LIMIT_VELOCITIES.into_iter();
    let held: Vec<Field> = velocities.filter(|f| map.fields().contains(f)).collect();
    if held.is_empty() { vec![field] } else { held }
}

fn no_curves(why: &'static str) -> PictureError {
    PictureError::NoCurves { why }
}

/// The title of a picture of `field` of a sweep without one.
fn untitled(field: Field) -> &'static str {
    if field.of_limit() {
        "Critical velocity as the delay vanishes"
    } else if field.of_vc() {
        "The critical velocity"
    } else if field.of_motion() {
        "Motions of the block"
    } else {
        "Stability of sliding"
    }
}

/// The title asked for, or that of the map's sweep.
fn title(map: &MapFile, options: &PictureOptions) -> Option<String> {
    let of_sweep = || map.root_text(root::TITLE);
    let title = options.title.clone().or_else(of_sweep);
    let title = title.filter(|title| !title.trim().is_empty())?;
    let cut: String = title.chars().take(LONGEST_TITLE).collect();
    Some(visible_line(&cut))
}

/// The title of a picture of `field`, and notes that name it. The title of a sweep is about the
/// field that it shows unasked: a picture of another one is headed by that.
fn head(map: &MapFile, field: Field, options: &PictureOptions) -> (String, Vec<Rich>) {
    let unit = map.field_unit(field);
    let shown = of_sweep(map).unwrap_or_else(|| default_field(map));
    let note = text::field_note(field, &unit);
    match title(map, options) {
        Some(title) if field != shown && options.title.is_none() => {
            let name = Rich::plain(field.name()).and(&text::suffix(&unit, "  (", ")"));
            let of = Rich::plain(&format!("from: {title}"));
            (capitalised(field.long_name()), vec![name, of])
        }
        title => (title.unwrap_or_else(|| untitled(field).into()), vec![note]),
    }
}

fn capitalised(text: &str) -> String {
    let mut characters = text.chars();
    let first = characters.next().into_iter().flat_map(char::to_uppercase);
    first.chain(characters).collect()
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;
    use std::sync::Arc;

    use super::*;
    use crate::maps::maker::make_in_memory;
    use crate::store::describe::Provenance;
    use crate::sweep::{Plan, SweepSpec};

    const FIG2: &str = "
        title = \"Velocity control\"
        fields = [\"n_unstable\", \"delay_margin\"]
        boundaries = true
        [axes]
        mu_prime = [-0.1, -0.3]
        alpha_v = { from = -1.6, to = 0.4, points = 41 }
        tau = { from = 0.0, to = 12.0, points = 61 }
        [units]
        force = \"N\"
        length = \"m\"
        time = \"s\"";

    struct Case {
        folder: tempfile::TempDir,
        map: MapFile,
    }

    impl Case {
        fn new(sweep: &str) -> Self {
            let folder = tempfile::tempdir().unwrap();
            let path = folder.path().join("map.h5");
            let plan = Plan::new(sweep.parse::<SweepSpec>().unwrap()).unwrap();
            make_in_memory(&Arc::new(plan), &path, 1, &Provenance::default()).unwrap();
            let map = MapFile::open(&path).unwrap();
            Self { folder, map }
        }

        fn path(&self, name: &str) -> PathBuf {
            self.folder.path().join(name)
        }

        fn draw(&self, name: &str, options: &PictureOptions) -> Result<Vec<u8>, PictureError> {
            draw(&self.map, &self.path(name), options)?.save()?;
            Ok(fs::read(self.path(name)).unwrap())
        }
    }

    fn decoded(bytes: &[u8]) -> (u32, u32, Vec<u8>) {
        let mut reader = png::Decoder::new(bytes).read_info().unwrap();
        let mut pixels = vec![0; reader.output_buffer_size()];
        let info = reader.next_frame(&mut pixels).unwrap();
        (info.width, info.height, pixels)
    }

    fn of_kind(kind: PictureKind) -> PictureOptions {
        PictureOptions {
            kind: Some(kind),
            ..PictureOptions::default()
        }
    }

    #[test]
    fn a_png_has_its_size_and_many_colours_and_is_the_same_twice() {
        let case = Case::new(FIG2);
        for kind in [PictureKind::Boundaries, PictureKind::Heat] {
            let bytes = case.draw("map.png", &of_kind(kind)).unwrap();
            let (width, height, pixels) = decoded(&bytes);
            assert_eq!((width, height), (1600, 1100));
            let colours: HashSet<&[u8]> = pixels.chunks_exact(3).collect();
            assert!(colours.len() > 60, "{}", colours.len());
            assert_eq!(case.draw("again.png", &of_kind(kind)).unwrap(), bytes);
        }
        let left: Vec<_> = fs::read_dir(case.folder.path()).unwrap().collect();
        assert_eq!(left.len(), 3, "the map and two pictures: {left:?}");
    }

    #[test]
    fn stable_and_unstable_cells_differ() {
        let case = Case::new(FIG2);
        let options = PictureOptions {
            at: vec![(Parameter::MuPrime, -0.1)],
            ..of_kind(PictureKind::Heat)
        };
        let (width, _, pixels) = decoded(&case.draw("map.png", &options).unwrap());
        let count = |colour: colour::Rgb| {
            let wanted = [colour.0, colour.1, colour.2];
            pixels.chunks_exact(3).filter(|p| *p == wanted).count()
        };
        let area = width as usize * 1100;
        // About a third of the plane is stable.
        assert!(count(colour::STABLE) > area / 10);
        assert!(count(colour::of_count(2.0)) > area / 10);
        // The edges of letters have any grey.
        assert!(count(colour::NO_VALUE) < area / 1000);
    }

    #[test]
    fn an_svg_names_values_axes_and_units() {
        let case = Case::new(FIG2);
        let bytes = case.draw("map.svg", &PictureOptions::default()).unwrap();
        let text = String::from_utf8(bytes).unwrap();
        let labels = [
            "Velocity control",
            "−0.1",
            "−0.3",
            "gain of velocity control",
            "(s⁻¹)",
            "(s)",
        ];
        for label in labels {
            assert!(text.contains(label), "{label}");
        }
        assert!(text.len() < 1_000_000);
    }

    /// The title of a sweep is about the field that it shows.
    #[test]
    fn titles_tell_the_field() {
        let named = FIG2.replace("boundaries = true", "picture = \"delay_margin\"");
        let case = Case::new(&named);
        let text = |field, title: Option<&str>| {
            let options = PictureOptions {
                field,
                title: title.map(str::to_owned),
                ..PictureOptions::default()
            };
            String::from_utf8(case.draw("map.svg", &options).unwrap()).unwrap()
        };
        let unasked = text(None, None);
        assert_eq!(unasked, text(Some(Field::DelayMargin), None));
        assert!(unasked.contains("Velocity control"));
        assert!(unasked.contains("delay_margin: distance in delay"));
        let other = text(Some(Field::NUnstable), None);
        assert!(other.contains("Number of characteristic roots"));
        assert!(other.contains("from: Velocity control"));
        let given = text(Some(Field::NUnstable), Some("My title"));
        assert!(given.contains("My title") && given.contains("n_unstable: number of"));
        assert!(!given.contains("Velocity control"));
    }

    #[test]
    fn every_shape_of_map_is_drawn() {
        for axes in [
            "mu_prime = [-0.5, -0.1]\n tau = [0.0, 1.0, 2.0, 5.0]",
            "mu_prime = [-0.1]\n tau = { from = 0, to = 30, points = 3001 }",
            "mu_prime = [-0.2, -0.1]\n tau = [1.0]",
            "tau = { from = 0.001, to = 1000, points = 31, spacing = \"log\" }\n mu_prime = [-0.2, \
            -0.1]",
            "mu_prime = [0.1, 0.2]\n alpha_n = [-1.0, 0.0]\n alpha_v = [-0.2, -0.1]\n tau = [1.0, \
            2.0]",
        ] {
            let case = Case::new(&format!("[axes]\n{axes}"));
            for name in ["map.png", "map.svg"] {
                case.draw(name, &PictureOptions::default()).unwrap();
            }
        }
    }

    /// Every field as a heat map and along a line, with cells without delay or control among them.
    #[test]
    fn every_field_is_drawn() {
        let linear = || Field::ALL.into_iter().filter(|f| f.of_sliding());
        let names: Vec<String> = linear().map(|f| format!("{:?}", f.name())).collect();
        let case = Case::new(&format!(
            "fields = [{}]\n[axes]\nalpha_n = [-1.5, -1.0, -0.5, 0.0]\ntau = [0.0, 0.3, 0.6, 0.9, \
            6.0]\n[fixed]\nmu_prime = -0.1",
            names.join(", ")
        ));
        let mut pictures = HashSet::new();
        for field in linear() {
            for at in [
                vec![],
                vec![(Parameter::AlphaN, -1.0)],
                vec![(Parameter::AlphaN, 0.0)],
            ] {
                let options = PictureOptions {
                    field: Some(field),
                    at,
                    size: (300, 300),
                    ..PictureOptions::default()
                };
                pictures.insert(case.draw("map.png", &options).unwrap());
            }
        }
        assert!(pictures.len() > 2 * linear().count());
        let bytes = case.draw("map.svg", &PictureOptions::default()).unwrap();
        let text = String::from_utf8(bytes).unwrap();
        assert!(text.contains("spectral abscissa") && text.contains("stable below 0"));
    }

    /// Draws every field as heat maps, and along a line at a value of one axis.
    fn draw_every_field(case: &Case, line: (Parameter, f64)) {
        for &field in case.map.fields() {
            for at in [vec![], vec![line]] {
                let options = PictureOptions {
                    field: Some(field),
                    at,
                    ..PictureOptions::default()
                };
                case.draw("map.png", &options).unwrap();
            }
        }
    }

    #[test]
    fn fields_of_motions_are_drawn() {
        let case = Case::new(
            "fields = [\"outcome\", \"settle_time\", \"n_min\", \"peak_force\"]\n[axes]\na0 = \
            [-0.4, 0.6, 1]\nx_dot0 = [0.1, 0.7]\n\
             [fixed]\nv0 = 0.118\nalpha_n = -7\ntau = 1\n[friction]\nlaw = \"weakening\"\nmu0 = \
             0.5\nv_s = 0.5\n",
        );
        draw_every_field(&case, (Parameter::XDot0, 0.1));
        let bytes = case.draw("map.svg", &PictureOptions::default()).unwrap();
        let text = String::from_utf8(bytes).unwrap();
        for label in ["Motions of the block", "sliding", "stick-slip", "lift-off"] {
            assert!(text.contains(label), "{label}");
        }
    }

    #[test]
    fn fields_of_the_critical_velocity_are_drawn() {
        let case = Case::new(
            "fields = [\"n_unstable\", \"vc\", \"outcome\", \"method\", \"class\", \"windows\", \
            \"v_liftoff\", \"stick_time\", \"vc_lower\", \"vc_upper\", \"v_smooth\"]\n\
             [axes]\nmu_prime_rest = [-1, -0.5]\nalpha_n = [-9, 0, 2]\ntau = [0.4, 1]\n[fixed]\nv0 \
             = 0.1\n\
             [friction]\nlaw = \"weakening\"\nmu0 = 0.5\n",
        );
        draw_every_field(&case, (Parameter::Tau, 1.0));
        let bytes = case.draw("map.svg", &PictureOptions::default()).unwrap();
        let text = String::from_utf8(bytes).unwrap();
        for label in ["The critical velocity", "unstable", "boundary"] {
            assert!(text.contains(label), "{label}");
        }
    }

    #[test]
    fn what_cannot_be_drawn_is_refused_and_leaves_nothing() {
        let case = Case::new(FIG2);
        let default = PictureOptions::default();
        let at = |parameter, value| PictureOptions {
            at: vec![(parameter, value), (Parameter::MuPrime, -0.1)],
            ..default.clone()
        };
        let small = PictureOptions {
            size: (10, 10),
            ..default.clone()
        };
        let held = PictureOptions {
            kind: Some(PictureKind::Boundaries),
            ..at(Parameter::Tau, 3.0)
        };
        for (name, options, says) in [
            ("map.h5", default.clone(), ".png or .svg"),
            ("map", default.clone(), ".png or .svg"),
            ("x.png", at(Parameter::Mass, 1.0), "mass is no axis"),
            (
                "x.png",
                at(Parameter::Tau, 12.5),
                "tau = 12.5 is outside the map: 0 to 12",
            ),
            ("x.png", held, "only one axis is left"),
            ("x.png", small, "outside the range"),
        ] {
            let error = case.draw(name, &options).unwrap_err().to_string();
            assert!(error.contains(says), "{error}");
        }
        assert_eq!(fs::read_dir(case.folder.path()).unwrap().count(), 1);
        let cell = Case::new("[axes]\nmu_prime = [-0.1]\n tau = [1.0]");
        let error = cell.draw("x.png", &default).unwrap_err();
        assert!(matches!(error, PictureError::NothingToDraw));
    }
}
