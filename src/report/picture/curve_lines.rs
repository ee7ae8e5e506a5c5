//! Exact curves over cells: dark lines with light edges, which are seen on every colour.

use super::chained::chained;
use super::clip;
use super::degrees::Degrees;
use super::key::BOUNDARY_WIDTH;
use super::kinds;
use super::panels::Panel;
use super::scene::{Point, Scene};
use crate::linear::curves::{CurveKind, CurvePiece, StableSide, Vertex};
use crate::meaning::colour::{INK, PAPER};
use crate::store::map_file::MapCurve;

/// Width of curves that bound no stable region, in units of the picture.
pub(super) const OTHER_WIDTH: f64 = 0.9;
/// Width of the light edges on both sides together.
const EDGES: f64 = 2.2;

/// What a line means; lines of one meaning are joined.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Meaning {
    /// A crossing that bounds no stable region.
    Other,
    /// A degree of stability.
    Degree(f64),
    /// The boundary of stability.
    Boundary(CurveKind),
}

/// The curves of a panel.
pub(super) struct Lines<'a> {
    /// The curves.
    pub curves: &'a [&'a MapCurve],
    /// Whether their second parameter lies from left to right.
    pub turned: bool,
    /// Whether those that bound no stable region are drawn as well.
    pub others: bool,
}

impl Lines<'_> {
    /// Draws the lines into a panel.
    pub(super) fn draw(&self, panel: &Panel, degrees: &Degrees, scene: &mut Scene) {
        let lines = self.chains(panel);
        let u = scene.unit();
        for (meaning, points) in &lines {
            match *meaning {
                Meaning::Other => {}
                Meaning::Degree(degree) => degrees.draw_edges(degree, points, PAPER, scene),
                Meaning::Boundary(_) => {
                    scene.path(points.clone(), PAPER, (BOUNDARY_WIDTH + EDGES) * u);
                }
            }
        }
        for (meaning, points) in lines {
            match meaning {
                Meaning::Degree(degree) => degrees.draw(degree, &points, INK, scene),
                Meaning::Boundary(kind) => match kinds::dash(kind) {
                    Some(dash) => scene.dashed(&points, INK, BOUNDARY_WIDTH * u, dash),
                    None => scene.path(points, INK, BOUNDARY_WIDTH * u),
                },
                Meaning::Other => scene.path(points, INK, OTHER_WIDTH * u),
            }
        }
    }

    /// Whole curves with their meanings, the most important last.
    fn chains(&self, panel: &Panel) -> Vec<(Meaning, Vec<Point>)> {
        let mut groups: Vec<(Meaning, Vec<Vec<Point>>)> = Vec::new();
        for curve in self.curves {
            let meaning = meaning(curve);
            if meaning == Meaning::Other && !self.others {
                continue;
            }
            let points = clip::within(&self.traced(panel, &curve.piece), panel.area);
            match groups.iter_mut().find(|group| group.0 == meaning) {
                Some(group) => group.1.extend(points),
                None => groups.push((meaning, points)),
            }
        }
        let rank = |meaning: &Meaning| match meaning {
            Meaning::Other => 0,
            Meaning::Degree(_) => 1,
            Meaning::Boundary(_) => 2,
        };
        groups.sort_by_key(|(meaning, _)| rank(meaning));
        let chains = groups.into_iter().flat_map(|(meaning, pieces)| {
            let chains = chained(pieces).into_iter();
            chains.map(move |chain| (meaning, chain))
        });
        chains.collect()
    }

    fn traced(&self, panel: &Panel, piece: &CurvePiece) -> Vec<Point> {
        let at = |v: &Vertex| match self.turned {
            true => panel.at(v.q, v.p),
            false => panel.at(v.p, v.q),
        };
        piece.vertices.iter().map(at).collect()
    }
}

fn meaning(curve: &MapCurve) -> Meaning {
    match (curve.piece.stable_side, curve.degree_of_stability) {
        (StableSide::Neither, _) => Meaning::Other,
        (_, degree) if degree > 0.0 => Meaning::Degree(degree),
        _ => Meaning::Boundary(curve.piece.kind),
    }
}
