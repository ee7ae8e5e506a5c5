//! Boundaries other than pairs of roots on the axis: dashed, and named in the legend.

use super::legend::Swatch;
use super::text::Rich;
use crate::linear::curves::{CurveKind, CurvePiece};
use crate::meaning::colour::Rgb;

/// Dashes (length, gap) of a boundary; none for a solid line.
pub(super) fn dash(kind: CurveKind) -> Option<(f64, f64)> {
    match kind {
        CurveKind::Pair => None,
        CurveKind::RealRoot => Some((14.0, 5.0)),
        CurveKind::LeadingCoefficient => Some((4.0, 5.0)),
    }
}

/// Entries of a legend for the kinds that occur.
pub(super) fn entries<'a>(
    pieces: &(impl Iterator<Item = &'a CurvePiece> + Clone),
    colour: Rgb,
    width: f64,
) -> Vec<(Swatch, Rich)> {
    let of = |kind: CurveKind| {
        let words = match kind {
            CurveKind::Pair => return None,
            CurveKind::RealRoot => "root at the origin",
            CurveKind::LeadingCoefficient => "leading coefficient",
        };
        let there = pieces.clone().any(|piece| piece.kind == kind);
        let swatch = Swatch::Dashed(colour, width, dash(kind)?);
        there.then(|| (swatch, Rich::plain(words)))
    };
    CurveKind::ALL.into_iter().filter_map(of).collect()
}
