//! How a picture is asked for.

use std::ops::RangeInclusive;

use super::error::PictureError;
use super::gradient::ColourMap;
use crate::sweep::Field;
use crate::sweep::input::quantity::Quantity;

/// Widths and heights that make a picture, in pixels.
const SIZES: RangeInclusive<u32> = 300..=5000;

/// What kind of picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PictureKind {
    /// The boundaries of stability as curves, one colour per value of the axis outside their plane,
    /// like Fig. 2 of the letter.
    Boundaries,
    /// A heat map of a field, one panel per value of the axis outside the plane.
    Heat,
}

/// What names the field that pictures of a map show unasked: the `picture` key of a sweep file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Named {
    /// That of the sweep in the map.
    InMap,
    /// This one, in a sweep file that may have changed since.
    As(Field),
    /// Nothing: that file has no such key.
    Nothing,
}

impl From<Option<Field>> for Named {
    fn from(key: Option<Field>) -> Self {
        key.map_or(Self::Nothing, Self::As)
    }
}

/// How a map is drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct PictureOptions {
    /// The field to show; by default the one that the sweep names for pictures, else the first
    /// held of the regime of v0, the velocity above which sliding is smooth, the critical
    /// velocity, the outcome, the spectral abscissa, the number of unstable roots.
    pub field: Option<Field>,
    /// What names the field of pictures where `field` does not.
    pub named: Named,
    /// The kind; by default boundaries where the map holds them for 2 to 12 values of one axis
    /// outside their plane, holds none of the first five and no field is asked for or named,
    /// otherwise a heat map.
    pub kind: Option<PictureKind>,
    /// Values at which axes are held: the nearest on the axis. Several for one axis make as many
    /// panels or colours.
    pub at: Vec<(Quantity, f64)>,
    /// Width and height in pixels, 300 to 5000 each.
    pub size: (u32, u32),
    /// The title; by default the sweep's in pictures of the field that it shows, else what the
    /// field is.
    pub title: Option<String>,
    /// The ends (low, high) of the scale of values, in the units of the map; by default they
    /// follow from the values. What lies beyond has colours of its own.
    pub range: Option<(f64, f64)>,
    /// The colours of values; by default those that the field goes with.
    pub colour_map: Option<ColourMap>,
    /// The scale of values is logarithmic, whatever it would be by default.
    pub log: bool,
    /// What colours and lines mean is left out.
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
            title: None,
            range: None,
            colour_map: None,
            log: false,
            no_legend: false,
        }
    }
}

impl PictureOptions {
    /// Refuses what makes no picture of any map.
    pub(super) fn check(&self) -> Result<(), PictureError> {
        let (width, height) = self.size;
        if !(SIZES.contains(&width) && SIZES.contains(&height)) {
            return Err(PictureError::Size {
                width,
                height,
                allowed: format!("{} to {} pixels", SIZES.start(), SIZES.end()),
            });
        }
        match self.range {
            Some((low, high)) if !(low.is_finite() && high.is_finite() && low < high) => {
                Err(PictureError::Range { low, high })
            }
            Some((low, _)) if self.log && low <= 0.0 => Err(PictureError::LogRange { low }),
            _ => Ok(()),
        }
    }

    /// Refuses options about a scale of values for pictures that have no such scale.
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

    /// Which part of a map is asked for, apart from how it looks, in words.
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
