//! Bounds of the slope and the curvature of a friction law over a range of speeds.

use super::friction::{FrictionLaw, Kind};
use super::table::{Piece, Table};
use crate::model::elementary::{exp, power};

/// A generous bound of the rounding of the values computed here, relative to their largest term.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// The least and the greatest value.
type Range = (f64, f64);

fn hull(values: impl IntoIterator<Item = f64>) -> Range {
    let none = (f64::INFINITY, f64::NEG_INFINITY);
    let range = values
        .into_iter()
        .fold(none, |(low, high), v| (low.min(v), high.max(v)));
    let rounding = ROUNDING * range.0.abs().max(range.1.abs());
    (range.0 - rounding, range.1 + rounding)
}

impl FrictionLaw {
    /// Bounds of μ_K′, time/length, over speeds from `from` to `to`, 0 ≤ `from` ≤ `to`.
    #[must_use]
    pub fn slopes_between(&self, from: f64, to: f64) -> (f64, f64) {
        let ends = [from, to].map(|v| self.mu_prime(v));
        match self.kind() {
            Kind::Coulomb { .. } => (0.0, 0.0),
            Kind::Weakening { .. } => hull(ends),
            Kind::Stribeck { v_s, .. } => {
                // Steepest at v_s/√2.
                let steepest = v_s * std::f64::consts::FRAC_1_SQRT_2;
                let inside = (from < steepest && steepest < to).then(|| self.mu_prime(steepest));
                hull(ends.into_iter().chain(inside))
            }
            Kind::Table(table) => {
                let pieces = pieces(table, from, to).map(|(piece, w)| piece_slopes(&piece, w));
                hull(pieces.flat_map(|(low, high)| [low, high]).chain(ends))
            }
        }
    }

    /// Bounds of μ_K″, (time/length)², over speeds from `from` to `to`, 0 ≤ `from` ≤ `to`; infinite
    /// where the slope jumps, at the ends of a table.
    #[must_use]
    pub fn curvatures_between(&self, from: f64, to: f64) -> (f64, f64) {
        match self.kind() {
            Kind::Coulomb { .. } => (0.0, 0.0),
            &Kind::Weakening { mu0, v_s } => {
                hull([from, to].map(|v| 2.0 * mu0 / (v_s * v_s * power(1.0 + v / v_s, 3))))
            }
            &Kind::Stribeck { mu0, v_s, mu_s } => {
                let at =
                    |s: f64| 2.0 * (mu_s - mu0) / (v_s * v_s) * (2.0 * s * s - 1.0) * exp(-s * s);
                // Extreme at rest and at v_s √(3/2).
                let extreme = 1.5_f64.sqrt();
                let (low, high) = (from / v_s, to / v_s);
                let inside = (low < extreme && extreme < high).then(|| at(extreme));
                hull([at(low), at(high)].into_iter().chain(inside))
            }
            Kind::Table(table) => {
                let speeds = table.speeds();
                let ends = [speeds[0], speeds[speeds.len() - 1]];
                let jumps = |end: f64| from <= end && end <= to && table.slope(end) != 0.0;
                if ends.into_iter().any(jumps) {
                    return (f64::NEG_INFINITY, f64::INFINITY);
                }
                let bends = pieces(table, from, to).flat_map(|(piece, w)| piece_bends(&piece, w));
                hull(bends)
            }
        }
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

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn laws() -> [FrictionLaw; 4] {
        let speeds = vec![0.1, 0.3, 0.9, 1.5, 3.0];
        let table = Table::new(speeds, vec![0.8, 0.4, 0.35, 0.5, 0.6]).unwrap();
        [
            FrictionLaw::table(table, 1.0).unwrap(),
            FrictionLaw::coulomb(0.4, 1.0).unwrap(),
            FrictionLaw::weakening(0.5, 0.7, 1.0).unwrap(),
            FrictionLaw::stribeck(0.3, 0.6, 0.9).unwrap(),
        ]
    }

    proptest! {
        /// Slopes at all speeds between two lie within the bounds, and difference quotients of
        /// slopes within those of the curvature.
        #[test]
        fn slopes_and_their_changes_lie_within(from in 0.0..3.5, width in 1e-6..2.0,
                                               parts in prop::array::uniform2(0.0..1.0)) {
            let to = from + width;
            let [v, w] = parts.map(|part: f64| from + part * width);
            for law in laws() {
                let (low, high) = law.slopes_between(from, to);
                let slope = law.mu_prime(v);
                prop_assert!(low <= slope && slope <= high, "{law:?} {v}: {low} {slope} {high}");
                let (least, most) = law.curvatures_between(from, to);
                let change = law.mu_prime(w) - slope;
                let (one, other) = (least * (w - v), most * (w - v));
                let near = 1e-13;
                prop_assert!(v == w || least.is_infinite()
                    || (one.min(other) - near <= change && change <= one.max(other) + near),
                    "{law:?} {v} {w}: {least} {change} {most}");
            }
        }

        /// The bounds are attained, to the resolution of the samples.
        #[test]
        fn bounds_are_no_wider_than_needed(from in 0.0..3.5, width in 1e-3..2.0) {
            for law in laws() {
                let (low, high) = law.slopes_between(from, from + width);
                let slopes = (0..=2000).map(|i| law.mu_prime(from + width * f64::from(i) / 2000.0));
                let (least, most) = hull(slopes);
                // A jump at an end of the table can lie between two samples.
                prop_assert!(low > least - 2e-2 * (most - least) - 1e-9
                    || matches!(law.kind(), Kind::Table(_)), "{law:?} {low} {least}");
                prop_assert!(high < most + 2e-2 * (most - least) + 1e-9
                    || matches!(law.kind(), Kind::Table(_)), "{law:?} {high} {most}");
            }
        }
    }
}
