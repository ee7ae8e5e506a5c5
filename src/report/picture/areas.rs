//! Free places for the name of an area between two lines.

use super::near_curves::stepped;
use super::page::Area;
use super::scene::Point;

/// Distance of the places that are tried, in pixels.
const STEP: f64 = 12.0;
/// Distance from a text, relative to its height, beyond which more room does not matter.
const ROOM: f64 = 8.0;

/// The centre of a text of this size (width, height) between two lines with increasing x, as far
/// from the lines as matters; none where it does not fit. Without `lower` or `upper` the area
/// reaches the frame.
pub(super) fn between(
    (lower, upper): (Option<&[Point]>, Option<&[Point]>),
    lines: &[&[Point]],
    (width, height): (f64, f64),
    frame: Area,
) -> Option<Point> {
    let most = ROOM * height;
    let lines: Vec<Vec<Point>> = lines.iter().map(|line| stepped(line)).collect();
    let columns = steps(frame.left + 0.6 * width, frame.right - 0.6 * width);
    let rows = || steps(frame.top + height, frame.bottom - height);
    let places = columns.flat_map(|x| rows().map(move |y| (x, y)));
    let room = |at: &Point| {
        let distances = lines
            .iter()
            .map(|line| distance(*at, line, (width, height)));
        distances.fold(most, f64::min)
    };
    let within = |at: &Point| {
        let ends = [at.0 - 0.5 * width, at.0, at.0 + 0.5 * width];
        // Pixel coordinates increase downwards.
        ends.iter().all(|x| {
            lower.is_none_or(|line| height_at(line, *x).is_some_and(|y| at.1 < y))
                && upper.is_none_or(|line| height_at(line, *x).is_some_and(|y| at.1 > y))
        })
    };
    let middle = 0.5 * (frame.left + frame.right);
    let good = places
        .filter(within)
        .map(|at| (at, room(&at) - 0.01 * (at.0 - middle).abs()))
        .filter(|(at, _)| room(at) > 0.3 * height);
    let best = good.max_by(|a, b| a.1.total_cmp(&b.1))?;
    Some(best.0)
}

fn steps(from: f64, to: f64) -> impl Iterator<Item = f64> {
    let count = ((to - from) / STEP).floor().max(-1.0) + 1.0;
    (0..count as usize).map(move |i| from + STEP * i as f64)
}

/// The distance of a line's points from a box around a place.
fn distance(at: Point, line: &[Point], (width, height): (f64, f64)) -> f64 {
    let away = |p: &Point| {
        let across = ((p.0 - at.0).abs() - 0.5 * width).max(0.0);
        let up = ((p.1 - at.1).abs() - 0.5 * height).max(0.0);
        across.hypot(up)
    };
    line.iter().map(away).fold(f64::INFINITY, f64::min)
}

/// The height of a line at x; none beyond its ends.
fn height_at(line: &[Point], x: f64) -> Option<f64> {
    let after = line.partition_point(|p| p.0 <= x);
    let (a, b) = (line.get(after.checked_sub(1)?)?, line.get(after)?);
    Some(a.1 + (x - a.0) / (b.0 - a.0) * (b.1 - a.1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_lies_between_its_lines() {
        let frame = Area {
            left: 0.0,
            top: 0.0,
            right: 600.0,
            bottom: 400.0,
        };
        let line = |y: f64| {
            (0..=60)
                .map(|i| (10.0 * f64::from(i), y))
                .collect::<Vec<_>>()
        };
        let (low, high) = (line(300.0), line(100.0));
        let lines = [&low[..], &high];
        let size = (120.0, 20.0);
        let place = |areas| between(areas, &lines, size, frame).map(|at| at.1);
        let inside = place((Some(&low[..]), Some(&high[..]))).unwrap();
        assert!((130.0..270.0).contains(&inside));
        assert!(place((None, Some(&low[..]))).unwrap() > 310.0);
        assert!(place((Some(&high[..]), None)).unwrap() < 90.0);
        let near = line(120.0);
        let lines = [&near[..], &high];
        assert_eq!(
            between((Some(&near), Some(&high)), &lines, size, frame),
            None
        );
    }
}
