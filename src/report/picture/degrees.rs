//! Curves of degrees of stability: dashed, with shorter dashes for larger σ.

use super::legend::Swatch;
use super::scene::{Point, Scene};
use super::text::{Rich, number, suffix};
use crate::meaning::colour::Rgb;
use crate::store::MapFile;
use crate::store::map_file::MapCurve;

/// Width of the curves, in units of the picture.
pub(super) const WIDTH: f64 = 1.6;
/// Length of the longest dashes, in units of the picture, and the factor for each further degree.
const LONGEST: f64 = 16.0;
const SHRINKING: f64 = 0.5;
const SHORTEST: f64 = 0.5;
/// Gap after a dash.
const GAP: f64 = 6.0;
/// Width of the light edges on both sides together.
const EDGES: f64 = 1.4;

/// The degrees of stability above zero of some curves, increasing.
pub(super) struct Degrees {
    values: Vec<f64>,
    unit: String,
}

impl Degrees {
    pub(super) fn of(map: &MapFile, curves: &[MapCurve]) -> Self {
        let mut values: Vec<f64> = curves.iter().map(|c| c.degree_of_stability).collect();
        values.retain(|&sigma| sigma > 0.0);
        values.sort_by(f64::total_cmp);
        values.dedup();
        Self {
            values,
            unit: map.degree_unit(),
        }
    }

    /// The degrees, increasing.
    pub(super) fn values(&self) -> &[f64] {
        &self.values
    }

    /// Entries of a legend, one for each degree.
    pub(super) fn entries(&self, colour: Rgb) -> Vec<(Swatch, Rich)> {
        let unit = suffix(&self.unit, " ", "");
        let entry = |(i, sigma): (usize, &f64)| {
            let text = Rich::plain(&format!("σ = {}{unit}", number(*sigma)));
            (Swatch::Dashed(colour, WIDTH, dash(i)), text)
        };
        self.values.iter().enumerate().map(entry).collect()
    }

    /// Draws the curve of one of the degrees.
    pub(super) fn draw(&self, degree: f64, points: &[Point], colour: Rgb, scene: &mut Scene) {
        self.draw_dashes(degree, points, (colour, WIDTH), scene);
    }

    /// Draws what is seen of light edges on both sides of its dashes, which come on top.
    pub(super) fn draw_edges(&self, degree: f64, points: &[Point], light: Rgb, scene: &mut Scene) {
        self.draw_dashes(degree, points, (light, WIDTH + EDGES), scene);
    }

    fn draw_dashes(
        &self,
        degree: f64,
        points: &[Point],
        (colour, width): (Rgb, f64),
        scene: &mut Scene,
    ) {
        let place = self.values.partition_point(|&sigma| sigma < degree);
        scene.dashed(points, colour, width * scene.unit(), dash(place));
    }
}

/// (length of a dash, length of the gap) of the `i`-th degree, in units of the picture.
fn dash(i: usize) -> (f64, f64) {
    let length = LONGEST * SHRINKING.powi(i.min(16) as i32);
    (length.max(SHORTEST), GAP)
}
