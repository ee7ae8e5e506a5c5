//! Curves of many points, reduced to what is seen of them.

use super::scene::Point;

/// A curve with increasing x, reduced to the visible points: the first, the extremes and the last
/// of each column of pixels.
pub(super) fn by_columns(points: impl Iterator<Item = Point>) -> Vec<Point> {
    let mut kept = Vec::new();
    let mut column: Vec<Point> = Vec::new();
    for point in points {
        let new = column
            .first()
            .is_some_and(|p| p.0.floor() != point.0.floor());
        if new {
            close_column(&mut column, &mut kept);
        }
        column.push(point);
    }
    close_column(&mut column, &mut kept);
    kept
}

fn close_column(column: &mut Vec<Point>, kept: &mut Vec<Point>) {
    if column.len() <= 4 {
        kept.append(column);
        return;
    }
    let by_height = |&a: &usize, &b: &usize| column[a].1.total_cmp(&column[b].1);
    let top = (0..column.len()).min_by(by_height).unwrap_or(0);
    let bottom = (0..column.len()).max_by(by_height).unwrap_or(0);
    let mut places = [0, top.min(bottom), top.max(bottom), column.len() - 1].to_vec();
    places.dedup();
    kept.extend(places.into_iter().map(|i| column[i]));
    column.clear();
}

/// Points at least a third of a pixel apart, and the last one.
pub(super) fn apart(points: impl Iterator<Item = Point>) -> Vec<Point> {
    let mut kept: Vec<Point> = Vec::new();
    let mut last = None;
    for point in points {
        let near = |p: &Point| (p.0 - point.0).hypot(p.1 - point.1) < 1.0 / 3.0;
        last = kept.last().is_some_and(near).then_some(point);
        if last.is_none() {
            kept.push(point);
        }
    }
    kept.extend(last);
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thinning_keeps_ends_and_extremes() {
        let points = (0..=10_000).map(|i| {
            let x = f64::from(i) / 1000.0;
            (x, (f64::from(i) * 0.37).sin() * 40.0)
        });
        let all: Vec<Point> = points.collect();
        let kept = by_columns(all.iter().copied());
        assert!(kept.len() <= 44 && kept.windows(2).all(|w| w[0].0 < w[1].0));
        assert_eq!((kept[0], kept.last()), (all[0], all.last()));
        let highest = |points: &[Point]| points.iter().map(|p| p.1).fold(0.0, f64::max);
        assert_eq!(highest(&kept), highest(&all));
        let kept = apart((0..1000).map(|i| (f64::from(i) / 1000.0, 0.0)));
        assert!(kept.len() <= 5 && kept.last() == Some(&(0.999, 0.0)));
    }
}
