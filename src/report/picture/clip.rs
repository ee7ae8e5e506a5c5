//! Cuts lines at the edges of an area.

use super::page::Area;
use super::scene::Point;

/// The parts of a polyline within an area.
pub(super) fn within(points: &[Point], area: Area) -> Vec<Vec<Point>> {
    let turned =
        |points: Vec<Point>| -> Vec<Point> { points.into_iter().map(|(x, y)| (y, x)).collect() };
    let level = between(points, area.top, area.bottom).into_iter();
    let upright = level.flat_map(|part| between(&turned(part), area.left, area.right));
    upright.map(turned).collect()
}

/// The parts of a polyline between two heights.
pub(super) fn between(points: &[Point], top: f64, bottom: f64) -> Vec<Vec<Point>> {
    let mut done = Vec::new();
    let mut open: Vec<Point> = Vec::new();
    for pair in points.windows(2) {
        let (a, b) = (pair[0], pair[1]);
        let part = |height: f64| (height - a.1) / (b.1 - a.1);
        let (mut from, mut to) = (0.0, 1.0);
        if a.1 != b.1 {
            let (s, t) = (part(top), part(bottom));
            (from, to) = (f64::max(from, s.min(t)), f64::min(to, s.max(t)));
        }
        let level = a.1 == b.1 && !(top..=bottom).contains(&a.1);
        if level || from >= to {
            done.push(std::mem::take(&mut open));
            continue;
        }
        let on = |part: f64| (a.0 + part * (b.0 - a.0), a.1 + part * (b.1 - a.1));
        if from > 0.0 || open.is_empty() {
            done.push(std::mem::take(&mut open));
            open.push(if from > 0.0 { on(from) } else { a });
        }
        open.push(if to < 1.0 { on(to) } else { b });
        if to < 1.0 {
            done.push(std::mem::take(&mut open));
        }
    }
    done.push(open);
    done.retain(|part| !part.is_empty());
    done
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_ends_at_the_frame() {
        let line = [(0.0, -1.0), (1.0, 1.0), (2.0, 2.0), (3.0, 6.0), (4.0, 2.0)];
        let parts = between(&line, 0.0, 4.0);
        assert_eq!(
            parts,
            [
                vec![(0.5, 0.0), (1.0, 1.0), (2.0, 2.0), (2.5, 4.0)],
                vec![(3.5, 4.0), (4.0, 2.0)]
            ]
        );
        let inside = [(0.0, 1.0), (1.0, 1.0), (2.0, 3.0)];
        assert_eq!(between(&inside, 0.0, 4.0), [inside.to_vec()]);
        assert!(between(&[(0.0, 5.0), (1.0, 5.0)], 0.0, 4.0).is_empty());
    }

    #[test]
    fn a_line_ends_at_all_edges() {
        let area = Area {
            left: 0.0,
            top: 0.0,
            right: 2.0,
            bottom: 2.0,
        };
        let line = [(-1.0, 1.0), (1.0, 1.0), (1.0, 3.0), (3.0, 1.0)];
        let parts = within(&line, area);
        assert_eq!(parts, [[(0.0, 1.0), (1.0, 1.0), (1.0, 2.0)]]);
    }
}
