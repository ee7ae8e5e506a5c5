//! The stability of a plane, by its cells and by the curves that bound it.

use super::error::PictureError;
use super::panels::Panel;
use super::stable_area::{intervals, stable_throughout};
use crate::linear::curves::CurvePiece;
use crate::setting::Field;
use crate::store::MapFile;
use crate::store::map_file::Plane;

/// The most cells per axis that are read to learn the stability where no curve lies.
const MOST_CELLS: usize = 600;

/// The stability of a plane in a panel, by its cells and by the curves that bound it.
pub(super) struct Stability<'a> {
    told: Option<(Field, Plane)>,
    panel: &'a Panel,
    bounding: &'a [&'a CurvePiece],
}

impl<'a> Stability<'a> {
    /// The stability of the plane of the axes (y, x) at an index along the others, with the curves
    /// that bound it.
    ///
    /// # Errors
    /// When the map cannot be read.
    pub(super) fn of(
        map: &MapFile,
        (index, axes): (&[usize], (usize, usize)),
        panel: &'a Panel,
        bounding: &'a [&'a CurvePiece],
    ) -> Result<Self, PictureError> {
        let told = match map.stability_field() {
            Some(field) => Some((field, map.plane(field, index, axes, MOST_CELLS)?)),
            None => None,
        };
        Ok(Self {
            told,
            panel,
            bounding,
        })
    }

    /// Whether all delays are stable at `p`, where no curve lies.
    pub(super) fn throughout(&self, p: f64) -> bool {
        let told = self.told.as_ref();
        told.is_some_and(|(field, plane)| stable_throughout(plane, *field, self.bounding, p))
    }

    /// Whether sliding is stable at a place.
    pub(super) fn at(&self, p: f64, q: f64) -> bool {
        let stable = intervals(self.panel, self.bounding, p, |p| self.throughout(p));
        let up = self.panel.up(q);
        stable.iter().any(|&(low, high)| high <= up && up <= low)
    }
}
