//! The stable region between crossing curves, as exact as the curves are.

use super::panels::Panel;
use crate::linear::curves::{CurvePiece, StableSide, Vertex};
use crate::meaning::scale::ends;
use crate::setting::Field;
use crate::store::map_file::Plane;

/// Slices of a region: (x, y of its lower end, y of its upper end) in pixels, by increasing x.
pub(super) type Region = Vec<(f64, f64, f64)>;

/// The stable regions of one plane within a panel, cut into parts that are a single interval at
/// every x.
///
/// `pieces` are the curves that bound the stable region. `without_crossing` says whether sliding is
/// stable at a value of the panel's x axis where no piece lies.
pub(super) fn regions(
    panel: &Panel,
    pieces: &[&CurvePiece],
    without_crossing: impl Fn(f64) -> bool,
) -> Vec<Region> {
    let columns = panel.area.width().ceil().max(1.0) as usize;
    let mut open: Vec<Region> = Vec::new();
    let mut done = Vec::new();
    for column in 0..=columns {
        let part = column as f64 / columns as f64;
        let (x, p) = (
            panel.area.left + part * panel.area.width(),
            panel.x.value(part),
        );
        let intervals = intervals(panel, pieces, p, &without_crossing);
        let before = std::mem::take(&mut open);
        let mut before = before.into_iter().peekable();
        for interval in intervals {
            // A region that ends below this interval does not continue.
            while let Some(region) = before.next_if(|region| ends_below(region, interval)) {
                done.push(region);
            }
            let overlapping = before.next_if(|region| !ends_above(region, interval));
            let mut region = overlapping.unwrap_or_default();
            region.push((x, interval.0, interval.1));
            open.push(region);
        }
        done.extend(before);
    }
    done.append(&mut open);
    done.retain(|region| region.len() > 1);
    done
}

/// Whether the last slice of the region lies below the interval; pixel coordinates increase
/// downwards.
fn ends_below(region: &Region, interval: (f64, f64)) -> bool {
    region.last().is_none_or(|&(_, _, high)| high > interval.0)
}

/// Whether the last slice of the region lies above the interval.
fn ends_above(region: &Region, interval: (f64, f64)) -> bool {
    region.last().is_none_or(|&(_, low, _)| low < interval.1)
}

/// The stable intervals of delay at the parameter `p`, as (lower, upper) pixels.
pub(super) fn intervals(
    panel: &Panel,
    pieces: &[&CurvePiece],
    p: f64,
    without_crossing: impl Fn(f64) -> bool,
) -> Vec<(f64, f64)> {
    let p = before_end(p, panel.x.ends());
    let mut crossings: Vec<(f64, StableSide)> = pieces
        .iter()
        .filter_map(|piece| Some((delay_at(&piece.vertices, p)?, piece.stable_side)))
        .collect();
    crossings.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (bottom, top) = (panel.area.bottom, panel.area.top);
    if crossings.is_empty() {
        return Vec::from_iter(without_crossing(p).then_some((bottom, top)));
    }
    let mut start = matches!(crossings[0].1, StableSide::Shorter).then_some(bottom);
    let mut intervals = Vec::new();
    for (tau, side) in crossings {
        let here = panel.up(tau).clamp(top, bottom);
        match side {
            StableSide::Longer => start = start.or(Some(here)),
            StableSide::Shorter => intervals.extend(start.take().map(|from| (from, here))),
            // Lines of constant p bound no interval.
            StableSide::Neither | StableSide::Below | StableSide::Above => {}
        }
    }
    intervals.extend(start.map(|from| (from, top)));
    intervals
}

/// Whether the column of cells nearest to `p` is stable, by the majority of its cells: the nearest
/// of those that none of the `pieces` crosses, if there is one.
pub(super) fn stable_throughout(
    plane: &Plane,
    field: Field,
    pieces: &[&CurvePiece],
    p: f64,
) -> bool {
    let reach = ends(&plane.columns);
    let crossed = |at: f64| {
        let (at, mut pieces) = (before_end(at, reach), pieces.iter());
        pieces.any(|piece| delay_at(&piece.vertices, at).is_some())
    };
    let columns = plane.columns.iter().enumerate();
    let by_distance = |a: &(usize, &f64), b: &(usize, &f64)| {
        let far = |(_, at): &(usize, &f64)| (crossed(**at), (**at - p).abs());
        far(a).0.cmp(&far(b).0).then(far(a).1.total_cmp(&far(b).1))
    };
    let Some((column, _)) = columns.min_by(by_distance) else {
        return false;
    };
    let cells = plane.cells.iter().skip(column).step_by(plane.columns.len());
    let stable = cells
        .filter(|&&v| field.tells_stable(v) == Some(true))
        .count();
    2 * stable > plane.rows.len()
}

/// Relative distance from the end of an axis at which a curve is read there.
const END: f64 = 1e-9;

/// The value at which a curve is read for `p`: itself but at the larger end of its axis, which the
/// curve excludes.
pub(super) fn before_end(p: f64, (one, other): (f64, f64)) -> f64 {
    let (from, to) = (one.min(other), one.max(other));
    p.min((to - END * (to - from)).min(to.next_down()))
}

/// The delay of a curve at `p`; none beyond its ends. Between its folds a curve is a function of p.
pub(super) fn delay_at(vertices: &[Vertex], p: f64) -> Option<f64> {
    let first = vertices.first()?.p;
    let last = vertices.last()?.p;
    let (low, high) = (first.min(last), first.max(last));
    // Half-open: where two pieces meet, only one of them counts.
    if !(low <= p && p < high) {
        return None;
    }
    let rising = first < last;
    let after = vertices.partition_point(|v| if rising { v.p <= p } else { v.p > p });
    let (a, b) = (vertices.get(after.checked_sub(1)?)?, vertices.get(after)?);
    let part = if a.p == b.p {
        0.0
    } else {
        (p - a.p) / (b.p - a.p)
    };
    Some(a.q + part * (b.q - a.q))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linear::Direction;
    use crate::linear::curves::CurveKind;
    use crate::meaning::scale::Scale;
    use crate::report::picture::page::Area;

    fn panel() -> Panel {
        Panel {
            area: Area {
                left: 0.0,
                top: 0.0,
                right: 100.0,
                bottom: 100.0,
            },
            x: Scale::linear(0.0, 1.0),
            y: Scale::linear(0.0, 1.0),
        }
    }

    fn piece(side: StableSide, from: (f64, f64), to: (f64, f64)) -> CurvePiece {
        let vertex = |(p, q)| Vertex { p, q, omega: 1.0 };
        CurvePiece {
            kind: CurveKind::Pair,
            branch: 0,
            direction: Direction::Right,
            stable_side: side,
            vertices: vec![vertex(from), vertex(to)],
        }
    }

    #[test]
    fn a_lens_between_two_curves() {
        let lower = piece(StableSide::Longer, (0.25, 0.5), (0.75, 0.2));
        let upper = piece(StableSide::Shorter, (0.75, 0.8), (0.25, 0.5));
        let regions = regions(&panel(), &[&upper, &lower], |_| false);
        assert_eq!(regions.len(), 1);
        let (x, low, high) = regions[0][25];
        assert_eq!(x, 50.0);
        assert!((low - 65.0).abs() < 1e-9 && (high - 35.0).abs() < 1e-9);
    }

    /// The nearest column that a curve crosses says nothing about places beside the curve.
    #[test]
    fn columns_beside_curves_tell() {
        let plane = Plane {
            rows: vec![0.0, 1.0],
            columns: vec![0.0, 0.5, 1.0],
            cells: vec![0.0, 0.0, 2.0, 0.0, 0.0, 2.0],
        };
        let curve = piece(StableSide::Longer, (0.0, 0.5), (0.6, 0.5));
        let at = |p| stable_throughout(&plane, Field::NUnstable, &[&curve], p);
        assert!(!at(0.65));
        assert!(stable_throughout(&plane, Field::NUnstable, &[], 0.65));
    }

    /// A curve that ends with the axis bounds the last slice too, and crosses the last column.
    #[test]
    fn curves_that_end_with_the_axis_reach_the_frame() {
        let lower = piece(StableSide::Longer, (0.0, 0.2), (1.0, 0.2));
        let upper = piece(StableSide::Shorter, (0.0, 0.6), (1.0, 0.6));
        for without_crossing in [false, true] {
            let regions = regions(&panel(), &[&upper, &lower], |_| without_crossing);
            assert_eq!(regions.len(), 1);
            let (x, low, high) = regions[0].last().unwrap();
            assert_eq!(*x, 100.0);
            assert!(
                (low - 80.0).abs() < 1e-6 && (high - 40.0).abs() < 1e-6,
                "{low} {high}"
            );
        }
        let plane = Plane {
            rows: vec![0.0, 1.0],
            columns: vec![0.0, 1.0],
            cells: vec![2.0, 0.0, 2.0, 0.0],
        };
        let curve = piece(StableSide::Longer, (0.5, 0.5), (1.0, 0.5));
        assert!(!stable_throughout(&plane, Field::NUnstable, &[&curve], 0.9));
    }

    #[test]
    fn open_ends_reach_the_frame() {
        let upper = piece(StableSide::Shorter, (0.0, 0.4), (0.5, 0.4));
        let regions = regions(&panel(), &[&upper], |p| p > 0.8);
        assert_eq!(regions.len(), 2);
        assert_eq!(regions[0][3], (3.0, 100.0, 60.0));
        assert_eq!(regions[1].last(), Some(&(100.0, 100.0, 0.0)));
    }
}
