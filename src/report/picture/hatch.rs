//! The hatching over cells that show no value.

use super::rectangles::{Rectangle, rectangles};
use super::scene::{Point, Scene};
use crate::meaning::colour;
use crate::meaning::gap::{Gap, Run};

/// Distance between the lines, and their width, in units of the picture.
const SPACING: f64 = 12.0;
const WIDTH: f64 = 1.8;

/// Draws the lines over cells between these edges.
pub(super) fn draw(columns: &[f64], rows: &[f64], gaps: &[Option<Gap>], scene: &mut Scene) {
    let hatched = |gap: &Option<Gap>| gap.filter(|gap| !gap.lines().is_empty());
    if !gaps.iter().any(|gap| hatched(gap).is_some()) {
        return;
    }
    let keys: Vec<Option<Gap>> = gaps.iter().map(hatched).collect();
    for Rectangle {
        rows: (top, bottom),
        columns: (from, to),
        key,
    } in rectangles(&keys, columns.len().saturating_sub(1))
    {
        if let Some(gap) = key {
            fill(
                (columns[from], rows[top]),
                (columns[to], rows[bottom]),
                gap,
                scene,
            );
        }
    }
}

/// Draws the lines over a rectangle between two of its corners: at least one in each direction,
/// however small it is.
pub(super) fn fill(a: Point, b: Point, gap: Gap, scene: &mut Scene) {
    let (near, far) = ((a.0.min(b.0), a.1.min(b.1)), (a.0.max(b.0), a.1.max(b.1)));
    let u = scene.unit();
    for &run in gap.lines() {
        for line in lines(near, far, run, SPACING * u) {
            match run {
                Run::Rising | Run::Falling => {
                    scene.path(line.to_vec(), colour::HATCH, WIDTH * u);
                }
                Run::Upright | Run::Level => {
                    scene.ruler(line[0], line[1], colour::HATCH, WIDTH * u);
                }
            }
        }
    }
}

/// The lines in one direction in a rectangle. They meet those of neighbouring rectangles.
fn lines(near: Point, far: Point, run: Run, spacing: f64) -> Vec<[Point; 2]> {
    // The coordinate that is constant along a line, and its range over the rectangle.
    let (least, most) = match run {
        Run::Rising => (near.0 + near.1, far.0 + far.1),
        Run::Falling => (near.0 - far.1, far.0 - near.1),
        Run::Upright => (near.0, far.0),
        Run::Level => (near.1, far.1),
    };
    let line = |c: f64| match run {
        Run::Rising => {
            let (from, to) = (near.0.max(c - far.1), far.0.min(c - near.1));
            [(from, c - from), (to, c - to)]
        }
        Run::Falling => {
            let (from, to) = (near.0.max(c + near.1), far.0.min(c + far.1));
            [(from, from - c), (to, to - c)]
        }
        Run::Upright => [(c, near.1), (c, far.1)],
        Run::Level => [(near.0, c), (far.0, c)],
    };
    let (first, last) = ((least / spacing).ceil(), (most / spacing).floor());
    if first > last {
        return vec![line(0.5 * (least + most))];
    }
    let count = (last - first) as usize;
    (0..=count)
        .map(|i| line((first + i as f64) * spacing))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::picture::scene::Mark;

    #[test]
    fn lines_stay_within_and_meet_those_of_the_neighbour() {
        for run in [Run::Rising, Run::Falling, Run::Upright] {
            let (near, middle, far) = ((3.0, 5.0), (40.0, 50.0), (77.0, 50.0));
            let left = lines(near, middle, run, 12.0);
            let right = lines((40.0, 5.0), far, run, 12.0);
            assert!(left.len() >= 3, "{run:?}");
            for [a, b] in left.iter().chain(&right) {
                for (x, y) in [a, b] {
                    assert!((3.0..=77.0).contains(x) && (5.0..=50.0).contains(y));
                }
            }
            let leaves = left.iter().filter(|[_, b]| b.0 == 40.0);
            for [_, b] in leaves.filter(|_| run != Run::Upright) {
                let met = right.iter().any(|[a, _]| (a.1 - b.1).abs() < 1e-9);
                assert!(met, "{run:?} {b:?}");
            }
        }
    }

    #[test]
    fn the_smallest_cell_has_a_line() {
        let mut scene = Scene::new((1600, 1100));
        let gaps = [None, Some(Gap::NotConverged), Some(Gap::LiftsOff)];
        draw(&[10.0, 10.1, 10.2, 10.3], &[20.0, 20.1], &gaps, &mut scene);
        assert!(matches!(scene.marks[..], [Mark::Path { .. }]));
    }
}
