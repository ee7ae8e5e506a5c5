//! A law through measured points, as a monotone cubic curve. Its series is one cubic in the speed
//! at a time.
//!
//! At a point of the table the second derivative of μ_K jumps, and with it the fourth derivative of
//! the elongation. At the first and the last point the slope of μ_K jumps, and with it the third
//! derivative. Steps end there. A cubic stays in use until the speed is beyond its end by a little
//! more than noise. So a motion that rests on a point, or grazes it, does not switch back and forth
//! between two cubics: the speed has to come back by more than rounding before the next crossing.
//! The cubics differ by less than the tolerance so near their common end.

use super::{FrictionLaw, Kind, Law, Range, Series, checked_at_rest, hull};
use crate::model::ModelError;
use crate::model::series::{Coefficients, MOST_ORDER, first_zero, product};
use crate::model::table::{Piece, Table};

impl FrictionLaw {
    /// A measured curve.
    ///
    /// # Errors
    /// μ_S must be finite and positive, and at least μ_K(0⁺), the first coefficient of the table.
    pub fn table(table: Table, mu_s: f64) -> Result<Self, ModelError> {
        let mu_s = ModelError::positive("mu_s", mu_s)?;
        checked_at_rest("mu_k", table.mu_k()[0], mu_s)?;
        Ok(Self::new(Kind::Table(table), mu_s))
    }
}

impl Law for Table {
    type Series = TableSeries;

    fn mu_k(&self, speed: f64) -> f64 {
        self.value(speed)
    }

    fn mu_prime(&self, speed: f64) -> f64 {
        self.slope(speed)
    }

    fn last_speed(&self) -> Option<f64> {
        self.speeds().last().copied()
    }

    fn speed_scale(&self, _: f64) -> f64 {
        f64::INFINITY
    }

    fn slopes_between(&self, from: f64, to: f64) -> Range {
        let ends = [from, to].map(|v| self.slope(v));
        let pieces = pieces(self, from, to).map(|(piece, w)| piece_slopes(&piece, w));
        hull(pieces.flat_map(|(low, high)| [low, high]).chain(ends))
    }

    /// Infinite where the slope jumps, at the ends.
    fn curvatures_between(&self, from: f64, to: f64) -> Range {
        let speeds = self.speeds();
        let ends = [speeds[0], speeds[speeds.len() - 1]];
        let jumps = |end: f64| from <= end && end <= to && self.slope(end) != 0.0;
        if ends.into_iter().any(jumps) {
            return (f64::NEG_INFINITY, f64::INFINITY);
        }
        let bends = pieces(self, from, to).flat_map(|(piece, w)| piece_bends(&piece, w));
        hull(bends)
    }

    fn series(&self, velocity_unit: f64) -> TableSeries {
        TableSeries::new(self, velocity_unit)
    }
}

/// The cubics of a table that cover speeds `from` to `to`, each with the range of w covered.
fn pieces(table: &Table, from: f64, to: f64) -> impl Iterator<Item = (Piece, [f64; 2])> + '_ {
    let region = |speed: f64| table.region(speed).unwrap_or_else(|region| region);
    let last = table.speeds().len();
    // A speed on a point belongs to the cubics on both sides.
    (region(from)..=(region(to) + 1).min(last)).filter_map(move |region| {
        let piece = table.piece(region);
        let inside = 0 < region && region < last;
        let start = if region == 0 { 0.0 } else { piece.from };
        let end = match region {
            0 => piece.from,
            _ if inside => piece.from + piece.width,
            _ => f64::INFINITY,
        };
        let (low, high) = (from.max(start), to.min(end));
        let along = |v: f64| (v - piece.from) / piece.width;
        (low <= high).then(|| (piece, [along(low), along(high)]))
    })
}

/// The least and the greatest slope of a cubic for w between `from` and `to`.
fn piece_slopes(piece: &Piece, [from, to]: [f64; 2]) -> Range {
    let [_, c1, c2, c3] = piece.c;
    let at = |w: f64| (c1 + w * (2.0 * c2 + w * 3.0 * c3)) / piece.width;
    let extreme = -c2 / (3.0 * c3);
    let inside = (from < extreme && extreme < to).then(|| at(extreme));
    hull([at(from), at(to)].into_iter().chain(inside))
}

/// The curvatures of a cubic at both ends of a range of w; they are linear between them.
fn piece_bends(piece: &Piece, ends: [f64; 2]) -> [f64; 2] {
    let [_, _, c2, c3] = piece.c;
    ends.map(|w| (2.0 * c2 + 6.0 * c3 * w) / (piece.width * piece.width))
}

/// μ_K n with μ_K = ((c₃ w + c₂) w + c₁) w + c₀, w = (|ẋ| − from)/width.
#[derive(Debug, Clone)]
pub(crate) struct TableSeries {
    table: Table,
    velocity_unit: f64,
    /// The number of points below the cubic in use, and the cubic, with speeds in the motion's
    /// units.
    region: usize,
    piece: Piece,
    w: Coefficients,
    slope: Coefficients,
    bend: Coefficients,
    coefficient: Coefficients,
}

/// Where the speed leaves a cubic.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Crossing {
    /// Time since the start of the step.
    pub s: f64,
    /// The region that it enters.
    pub region: usize,
    /// The lowest derivative of the elongation that jumps.
    pub kink: u32,
}

impl TableSeries {
    /// At the speed 0, with ẋ in units of `velocity_unit`.
    pub(crate) fn new(table: &Table, velocity_unit: f64) -> Self {
        let zero = [0.0; MOST_ORDER + 1];
        let mut series = Self {
            table: table.clone(),
            velocity_unit,
            region: 0,
            piece: table.piece(0),
            w: zero,
            slope: zero,
            bend: zero,
            coefficient: zero,
        };
        series.restart(0.0);
        series
    }

    /// Changes to the cubic of `region`.
    pub(crate) fn enter(&mut self, region: usize) {
        let piece = self.table.piece(region);
        self.region = region;
        self.piece = Piece {
            from: piece.from / self.velocity_unit,
            width: piece.width / self.velocity_unit,
            ..piece
        };
    }

    /// The speed of a point; None where there is no such point, or it is at rest.
    fn knot(&self, point: Option<usize>) -> Option<f64> {
        let speed = *self.table.speeds().get(point?)?;
        (speed > 0.0).then_some(speed / self.velocity_unit)
    }

    /// Where |ẋ|, whose series is `speed`, first leaves the cubic in use within `length`.
    pub(crate) fn crossing(&self, speed: &[f64], length: f64, tolerance: f64) -> Option<Crossing> {
        let last = self.table.speeds().len() - 1;
        let slack = (0.125 * tolerance * self.piece.width).max(noise(speed, length));
        let mut first: Option<Crossing> = None;
        for (side, point) in [(1.0, Some(self.region)), (-1.0, self.region.checked_sub(1))] {
            let Some((knot, point)) = self.knot(point).zip(point) else {
                continue;
            };
            // How far the speed is inside.
            let mut inside = [0.0; MOST_ORDER + 1];
            for (inside, speed) in inside.iter_mut().zip(speed) {
                *inside = -side * speed;
            }
            inside[0] += side * knot + slack;
            let before = first.map_or(length, |crossing| crossing.s);
            if let Some(s) = first_zero(&inside[..speed.len()], before) {
                first = Some(Crossing {
                    s,
                    region: if side > 0.0 { point + 1 } else { point },
                    kink: if point == 0 || point == last { 3 } else { 4 },
                });
            }
        }
        first
    }
}

/// An upper bound of what [`first_zero`] takes for zero.
fn noise(speed: &[f64], length: f64) -> f64 {
    let mut power = 1.0;
    let mut size = 0.0;
    for (k, c) in speed.iter().enumerate() {
        size += (1.0 + k as f64) * c.abs() * power;
        power *= length;
    }
    32.0 * f64::EPSILON * size
}

impl Series for TableSeries {
    #[inline(always)]
    fn extend(&mut self, k: usize, speed: f64, load: &Coefficients) -> f64 {
        let first = |c: f64| if k == 0 { c } else { 0.0 };
        let [c0, c1, c2, c3] = self.piece.c;
        self.w[k] = (speed - first(self.piece.from)) / self.piece.width;
        self.bend[k] = c3 * self.w[k] + first(c2);
        self.slope[k] = product(&self.bend, &self.w, k) + first(c1);
        self.coefficient[k] = product(&self.slope, &self.w, k) + first(c0);
        product(&self.coefficient, load, k)
    }

    fn resolved(&self, _: &[f64], length: f64, _: f64) -> f64 {
        length
    }

    fn value(&self, speed: f64) -> Option<f64> {
        let w = (speed - self.piece.from) / self.piece.width;
        let [c0, c1, c2, c3] = self.piece.c;
        Some(((c3 * w + c2) * w + c1) * w + c0)
    }

    fn restart(&mut self, speed: f64) {
        let region = match self.table.region(speed * self.velocity_unit) {
            Ok(point) => point + 1,
            Err(region) => region,
        };
        self.enter(region);
    }

    fn copy_place(&mut self, other: &Self) {
        (self.region, self.piece) = (other.region, other.piece);
    }
}
