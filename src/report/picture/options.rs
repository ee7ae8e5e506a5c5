//! The options of a picture.

use std::ops::RangeInclusive;

use super::error::PictureError;
use super::print::Print;
use super::text::Rich;
use crate::meaning::gradient::ColourMap;
use crate::setting::Field;
use crate::setting::quantity::Quantity;

/// Allowed widths and heights of a picture, in pixels.
const SIZES: RangeInclusive<u32> = 300..=5000;

/// The kind of a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PictureKind {
    /// The boundaries of stability as curves, one colour per value of the axis outside their plane,
    /// like Fig. 2 of the letter.
    Boundaries,
    /// A heat map of a field, one panel per value of the axis outside the plane.
    Heat,
}

/// Where the default field of pictures of a map comes from: the `picture` key of a sweep file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Named {
    /// The sweep in the map.
    InMap,
    /// A sweep file that may have changed since, which names this field.
    As(Field),
    /// A sweep file without this key.
    Nothing,
}

impl From<Option<Field>> for Named {
    fn from(key: Option<Field>) -> Self {
        key.map_or(Self::Nothing, Self::As)
    }
}

/// The options for drawing a map.
#[derive(Debug, Clone, PartialEq)]
pub struct PictureOptions {
    /// The field to show. By default the one that the sweep names for pictures, else the first that
    /// the map has of: the regime of v0, the velocity above which sliding is smooth, the critical
    /// velocity, the outcome, the spectral abscissa, the number of unstable roots.
    pub field: Option<Field>,
    /// Where the field comes from if `field` is none.
    pub named: Named,
    /// The kind. By default boundaries, if the map has them for 2 to 12 values of one axis outside
    /// their plane, has none of the first five fields above, and no field is requested or named;
    /// otherwise a heat map.
    pub kind: Option<PictureKind>,
    /// Values at which axes are held, each replaced by the nearest one on its axis. Several values
    /// of one axis make several panels or colours.
    pub at: Vec<(Quantity, f64)>,
    /// Width and height in pixels, 300 to 5000 each.
    pub size: (u32, u32),
    /// How it is printed, in the shape of `size`, which says nothing else then. By default it has
    /// as many pixels as `size` says, and its text grows with them.
    pub print: Option<Print>,
    /// The title; none if it is empty. By default the sweep's, for pictures of the field that it
    /// shows, else the meaning of the field.
    pub title: Option<String>,
    /// When a motion begins and ends that is shown; by default all of it.
    pub time: [Option<f64>; 2],
    /// Whether the lines below the title are left out: what is shown, and at which values.
    pub no_subtitle: bool,
    /// The ends (low, high) of the scale of values, in the units of the map. By default they follow
    /// from the values. Values beyond them have their own colours.
    pub range: Option<(f64, f64)>,
    /// The colours of values; by default those of the field.
    pub colour_map: Option<ColourMap>,
    /// Whether the scale of values is logarithmic in any case.
    pub log: bool,
    /// Whether the explanation of colours and lines is left out.
    pub no_legend: bool,
}

impl Default for PictureOptions {
    fn default() -> Self {
        Self {
            field: None,
            named: Named::InMap,
            kind: None,
            at: Vec::new(),
            size: (1600, 1100),
            print: None,
            title: None,
            time: [None, None],
            no_subtitle: false,
            range: None,
            colour_map: None,
            log: false,
            no_legend: false,
        }
    }
}

impl PictureOptions {
    /// Refuses options that suit no map.
    pub(super) fn check(&self) -> Result<(), PictureError> {
        for (width, height) in [self.size, self.pixels()] {
            if !(SIZES.contains(&width) && SIZES.contains(&height)) {
                return Err(PictureError::Size {
                    width,
                    height,
                    allowed: format!("{} to {} pixels", SIZES.start(), SIZES.end()),
                });
            }
        }
        match self.range {
            Some((low, high)) if !(low.is_finite() && high.is_finite() && low < high) => {
                Err(PictureError::Range { low, high })
            }
            Some((low, _)) if self.log && low <= 0.0 => Err(PictureError::LogRange { low }),
            _ => Ok(()),
        }
    }

    /// Refuses options about a scale of values, for pictures without such a scale.
    pub(super) fn about_values(&self, why: &'static str) -> Result<(), PictureError> {
        let asked = [
            (self.range.is_some(), "--range"),
            (self.colour_map.is_some(), "--colour-map"),
            (self.log, "--log"),
        ];
        match asked.into_iter().find(|(asked, _)| *asked) {
            Some((_, option)) => Err(PictureError::NotForThis { option, why }),
            None => Ok(()),
        }
    }

    /// Width and height in pixels.
    pub(super) fn pixels(&self) -> (u32, u32) {
        self.print
            .map_or(self.size, |print| print.pixels(self.size))
    }

    /// Whether no title is wanted.
    pub(super) fn untitled(&self) -> bool {
        self.title
            .as_deref()
            .is_some_and(|title| title.trim().is_empty())
    }

    /// The lines below a title, where they are wanted.
    pub(super) fn subtitle(&self, notes: Vec<Rich>) -> Vec<Rich> {
        if self.no_subtitle { Vec::new() } else { notes }
    }

    /// The requested part of a map, apart from its style, in words.
    pub(super) fn asked(&self) -> String {
        let field = self.field.map(|field| format!(" field={}", field.name()));
        let kind = self.kind.map(|kind| match kind {
            PictureKind::Boundaries => " kind=boundaries".to_owned(),
            PictureKind::Heat => " kind=heat".to_owned(),
        });
        let at = self.at.iter();
        let at = at.map(|(parameter, value)| format!(" {}={value}", parameter.name()));
        field.into_iter().chain(kind).chain(at).collect()
    }
}
