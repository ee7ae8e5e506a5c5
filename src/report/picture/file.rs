//! The file of a picture: its format, from its name, and whether it may replace another picture.

use std::io::BufReader;
use std::path::{Path, PathBuf};

use super::error::PictureError;
use super::pdf;
use super::render;
use super::scene::Scene;
use crate::report::visible::visible_line;
use crate::store::{Output, regular};

/// The most cells per axis: more would not show in a bitmap, and would make files of shapes too
/// large.
const MOST_CELLS: usize = 1200;
const MOST_SHAPES: usize = 320;

/// A picture that is drawn but not yet written to its file.
#[derive(Debug)]
#[must_use]
pub struct Picture {
    bytes: Vec<u8>,
    path: PathBuf,
    origin: Origin,
}

/// The origin of a picture, as stored in a PNG file.
#[derive(Debug)]
pub(super) struct Origin {
    /// What the picture shows, in one line.
    pub of: String,
    /// The name of the field that the sweep named for pictures; empty for none.
    pub named: &'static str,
}

impl Picture {
    /// Renders a scene for the file `path`.
    pub(super) fn of(
        scene: &Scene,
        format: Format,
        path: &Path,
        origin: Origin,
    ) -> Result<Self, PictureError> {
        let bytes = match format {
            Format::Png => png(scene, &origin),
            Format::Svg => render::svg(scene, scene.print),
            Format::Pdf => pdf::of_svg(&render::svg(scene, None)?, scene.print),
        }?;
        Ok(Self {
            bytes,
            path: path.to_owned(),
            origin,
        })
    }

    /// The bytes of its file.
    #[must_use]
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// Writes the file. It appears only when it is complete, and replaces an existing one.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn save(self) -> Result<(), PictureError> {
        let Self { bytes, path, .. } = self;
        Ok(Output::claim(&path)?.fill(bytes)?)
    }

    /// Writes the file under a name that the user did not choose. It replaces only an earlier
    /// picture of the same map and field, so that no other work is lost.
    ///
    /// # Errors
    /// When something else is there, or the file cannot be written.
    pub fn save_unasked(self) -> Result<(), PictureError> {
        match others_work(&self.path, &self.origin.of) {
            Some(holds) => Err(PictureError::OthersWork {
                path: self.path,
                holds,
            }),
            None => self.save(),
        }
    }
}

/// A description of the file at `path`, unless it is a picture of this origin.
fn others_work(path: &Path, origin: &str) -> Option<String> {
    let foreign = || Some("not by slipmap".to_owned());
    if path.symlink_metadata().is_err() {
        return None;
    }
    match texts(path) {
        Some(texts) if texts.of == origin => None,
        Some(texts) => Some(format!("a picture of {}", visible_line(&texts.of))),
        None => foreign(),
    }
}

/// The field that the sweep named for the PNG picture at `path` when it was drawn; empty where it
/// named none. None where there is no picture by slipmap.
#[must_use]
pub fn named_in(path: &Path) -> Option<String> {
    texts(path).map(|texts| texts.named)
}

/// The picture as a PNG file with its origin.
fn png(scene: &Scene, origin: &Origin) -> Result<Vec<u8>, PictureError> {
    let texts = [SIGNATURE, (OF, origin.of.as_str()), (NAMED, origin.named)];
    render::png(scene, &texts)
}

/// The texts in a PNG file: who drew it, what it shows, and which field the sweep named.
const SIGNATURE: (&str, &str) = ("Software", "slipmap");
const OF: &str = "Source";
const NAMED: &str = "Comment";

/// The contents of these texts.
struct Texts {
    of: String,
    named: String,
}

/// The texts of a picture by slipmap; none where there is none at `path`.
fn texts(path: &Path) -> Option<Texts> {
    let file = BufReader::new(regular::open(path).ok()?);
    let reader = png::Decoder::new(file).read_info().ok()?;
    let texts = &reader.info().utf8_text;
    let text = |keyword: &str| {
        let found = texts.iter().find(|text| text.keyword == keyword)?;
        found.get_text().ok()
    };
    let own = text(SIGNATURE.0).as_deref() == Some(SIGNATURE.1);
    own.then_some(())?;
    Some(Texts {
        of: text(OF)?,
        named: text(NAMED)?,
    })
}

/// True for a file name that a picture can have.
#[must_use]
pub fn is_name(path: &Path) -> bool {
    Format::of(path).is_ok()
}

/// The format of a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Format {
    Png,
    Svg,
    Pdf,
}

impl Format {
    /// The format for the name of a file.
    pub(super) fn of(path: &Path) -> Result<Self, PictureError> {
        let extension = path.extension().map(|e| e.to_string_lossy().to_lowercase());
        match extension.as_deref() {
            Some("png") => Ok(Self::Png),
            Some("svg") => Ok(Self::Svg),
            Some("pdf") => Ok(Self::Pdf),
            _ => Err(PictureError::Extension {
                path: path.to_owned(),
            }),
        }
    }

    /// The most cells per axis that are drawn.
    pub(super) fn most_cells(self) -> usize {
        match self {
            Self::Png => MOST_CELLS,
            Self::Svg | Self::Pdf => MOST_SHAPES,
        }
    }
}
