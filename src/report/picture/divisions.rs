//! The parts into which curves divide a plane: stable and unstable, or by the number of unstable
//! roots. A plane is upright here: the delay, or q, goes up.

use super::page::Area;
use super::panels::Panel;
use super::stable_area::{before_end, delay_at, intervals};
use crate::linear::curves::{CurveKind, CurvePiece, Vertex};
use crate::meaning::scale::{Scale, ends};
use crate::report::known::Known;
use crate::store::map_file::Plane;

/// Relative distance within which a curve reaches the lowest q.
const END: f64 = 1e-9;
/// The part of a plane of which nothing is known.
pub(super) const UNKNOWN_PART: i64 = i64::MIN;

/// A division of a plane into parts with numbers.
pub(super) trait Division {
    /// The parts of places along q at a value of p.
    fn along(&self, p: f64, qs: &[f64]) -> Vec<i64>;

    /// The value of all places in a part; none where the cells in it tell.
    fn value(&self, part: i64) -> Option<f64>;
}

/// The stable places of a plane, part 1, between its boundaries.
pub(super) struct Sides<'a> {
    pieces: &'a [&'a CurvePiece],
    /// A panel on which intervals are measured.
    panel: Panel,
    without_crossing: &'a dyn Fn(f64) -> bool,
}

impl<'a> Sides<'a> {
    /// The places between the `pieces` that bound the stable region, over these values of p and q.
    /// `without_crossing` says whether the plane is stable at a value of p where no piece lies.
    pub(super) fn of(
        pieces: &'a [&'a CurvePiece],
        (ps, qs): (&[f64], &[f64]),
        without_crossing: &'a dyn Fn(f64) -> bool,
    ) -> Self {
        let ((from, to), (low, high)) = (ends(ps), ends(qs));
        let area = Area {
            left: 0.0,
            top: 0.0,
            right: 1.0,
            bottom: 1.0,
        };
        Self {
            pieces,
            panel: Panel {
                area,
                x: Scale::linear(from, to),
                y: Scale::linear(low, high),
            },
            without_crossing,
        }
    }
}

impl Division for Sides<'_> {
    fn along(&self, p: f64, qs: &[f64]) -> Vec<i64> {
        let p = p.max(self.panel.x.ends().0);
        let stable = intervals(&self.panel, self.pieces, p, self.without_crossing);
        let holds = |y: f64| stable.iter().any(|&(low, high)| high <= y && y <= low);
        qs.iter()
            .map(|&q| i64::from(holds(self.panel.up(q))))
            .collect()
    }

    fn value(&self, _: i64) -> Option<f64> {
        None
    }
}

/// The numbers of unstable roots of a plane, between all its crossing curves.
pub(super) struct Counts<'a> {
    pieces: &'a [&'a CurvePiece],
    /// The smallest and the largest p.
    reach: (f64, f64),
    /// The values of p of the cells, increasing, with how many roots there are at the lowest q.
    lowest: Vec<(f64, i64)>,
    /// The values of p where a curve comes to the lowest q, increasing, with how many roots more
    /// there are at larger p.
    arrivals: Vec<(f64, i64)>,
}

impl<'a> Counts<'a> {
    /// The counts of the cells of an upright plane, between all curves of the plane.
    pub(super) fn of(pieces: &'a [&'a CurvePiece], known: &Known) -> Self {
        let (from, to) = ends(&known.plane.rows);
        let near = |v: &Vertex| (v.q - from).abs() <= END * (to - from);
        let mut arrivals: Vec<(f64, i64)> = pieces
            .iter()
            .filter_map(|piece| arrival(piece, near))
            .collect();
        arrivals.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut counts = Self {
            pieces,
            reach: ends(&known.plane.columns),
            lowest: Vec::new(),
            arrivals,
        };
        let columns = known.plane.columns.iter().enumerate();
        let lowest = columns.map(|(column, &p)| (p, counts.told(known, column, p)));
        let mut lowest: Vec<(f64, i64)> = lowest.collect();
        lowest.sort_by(|a, b| a.0.total_cmp(&b.0));
        counts.lowest = lowest;
        counts
    }

    /// How many roots come to the right half-plane as q grows, beside the q where they do,
    /// increasing; none where a curve says nothing about that.
    fn changes(&self, p: f64) -> Option<Vec<(f64, i64)>> {
        // Cells may be thinned out: curves go on beyond the last of those that are known.
        let p = match p == self.reach.1 {
            true => before_end(p, self.reach),
            false => p,
        };
        let mut changes = Vec::new();
        for piece in self.pieces {
            if let Some(q) = delay_at(&piece.vertices, p) {
                changes.push((q, entering(piece)?));
            }
        }
        changes.sort_by(|a, b| a.0.total_cmp(&b.0));
        Some(changes)
    }

    /// How many roots the cells of a column say that there are at the lowest q.
    fn told(&self, known: &Known, column: usize, p: f64) -> i64 {
        let Some(changes) = self.changes(p) else {
            return UNKNOWN_PART;
        };
        let width = known.plane.columns.len();
        let rows = known.plane.rows.iter().enumerate();
        let cells = rows.map(|(row, &q)| (q, row * width + column));
        let known_cells = cells.filter(|(_, cell)| known.gaps[*cell].is_none());
        let below =
            known_cells.map(|(q, cell)| known.plane.cells[cell] as i64 - up_to(&changes, q));
        most_frequent(below.collect()).unwrap_or(UNKNOWN_PART)
    }

    /// How many roots there are at the lowest q: what both neighbouring columns say, by way of the
    /// curves that come to it between them; none where they disagree.
    fn at_lowest(&self, p: f64) -> Option<i64> {
        let after = self.lowest.partition_point(|(of, _)| *of <= p);
        let left = self.lowest.get(after.saturating_sub(1))?;
        let right = self.lowest.get(after).unwrap_or(left);
        let between = |from: f64, to: f64| {
            let there = self.arrivals.iter();
            let there = there.filter(|(at, _)| from < *at && *at <= to);
            there.map(|(_, roots)| roots).sum::<i64>()
        };
        if left.1 == UNKNOWN_PART || left.1 + between(left.0, right.0) != right.1 {
            return None;
        }
        Some(left.1 + between(left.0, p))
    }
}

/// How many roots come to the right half-plane where a piece is crossed; none where it says nothing
/// about that.
fn entering(piece: &CurvePiece) -> Option<i64> {
    let roots = match piece.kind {
        CurveKind::Pair => 2,
        CurveKind::RealRoot => 1,
        CurveKind::LeadingCoefficient => return None,
    };
    Some(roots * i64::from(piece.direction.sign()))
}

/// Where a piece comes to the lowest q, and how many roots more there are at larger p then: below
/// a piece they are fewer by those that enter at it.
fn arrival(piece: &CurvePiece, lowest: impl Fn(&Vertex) -> bool) -> Option<(f64, i64)> {
    let (first, last) = (piece.vertices.first()?, piece.vertices.last()?);
    let (at, other) = match (lowest(first), lowest(last)) {
        (true, false) => (first, last),
        (false, true) => (last, first),
        _ => return None,
    };
    let roots = entering(piece)?;
    // The direction is that of growing p where p is the same all along.
    let grows = other.p <= at.p;
    Some((at.p, if grows { roots } else { -roots }))
}

/// The number of roots that came up to a q.
fn up_to(changes: &[(f64, i64)], q: f64) -> i64 {
    let below = changes.partition_point(|(at, _)| *at < q);
    changes[..below].iter().map(|(_, roots)| roots).sum()
}

/// The most frequent of some numbers.
fn most_frequent(mut numbers: Vec<i64>) -> Option<i64> {
    numbers.sort_unstable();
    let groups = numbers.chunk_by(|a, b| a == b);
    groups.max_by_key(|group| group.len()).map(|group| group[0])
}

impl Division for Counts<'_> {
    fn along(&self, p: f64, qs: &[f64]) -> Vec<i64> {
        let least = self.at_lowest(p).zip(self.changes(p));
        let Some((least, changes)) = least else {
            return vec![UNKNOWN_PART; qs.len()];
        };
        qs.iter().map(|&q| least + up_to(&changes, q)).collect()
    }

    fn value(&self, part: i64) -> Option<f64> {
        (part >= 0).then_some(part as f64)
    }
}

/// A plane with its rows as columns.
pub(super) fn turned(known: &Known) -> Known {
    let Plane {
        rows,
        columns,
        cells,
    } = &known.plane;
    let places = (0..columns.len()).flat_map(|c| (0..rows.len()).map(move |r| (r, c)));
    let order: Vec<usize> = places.map(|(r, c)| r * columns.len() + c).collect();
    Known {
        gaps: order.iter().map(|&cell| known.gaps[cell]).collect(),
        plane: Plane {
            cells: order.iter().map(|&cell| cells[cell]).collect(),
            rows: columns.clone(),
            columns: rows.clone(),
        },
    }
}
