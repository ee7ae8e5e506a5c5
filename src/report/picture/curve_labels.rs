//! Places for labels on curves, where they touch no other curve. Where there is none, a label
//! stands away from its curve, with a line that leads to it.

use std::collections::HashMap;

use super::page::Area;
use super::scene::Point;

/// Step along a curve, in pixels.
const STEP: f64 = 5.0;
/// Side of the squares in which points are stored.
const SQUARE: f64 = 40.0;
/// Distance beyond which more room does not matter.
const ENOUGH_ROOM: f64 = 60.0;

/// The curves of one label, in pixels.
pub(super) type Curves = Vec<Vec<Point>>;

/// Distance of a text beside its curve.
const BESIDE: f64 = 9.0;
/// How much room a place on the curve may give up against one beside it, where it is less clear to
/// which curve the text belongs.
const ON_CURVE: f64 = 35.0;
/// How much room a place at the longest curve may give up against one at a tiny lobe.
const LONG_CURVE: f64 = 50.0;
/// A text closer than this to another curve could be taken for the label of that one.
const APART: f64 = 3.0;

/// Distances from its curve at which a text may stand.
const AWAY: [f64; 6] = [50.0, 75.0, 100.0, 130.0, 170.0, 220.0];
/// Number of directions that are tried.
const DIRECTIONS: u32 = 16;
/// The most points of a curve from which a line may lead to a text.
const MOST_ANCHORS: usize = 24;
/// The cost of each pixel of curve that a text hides, in pixels of distance.
const HIDING: f64 = 1.5;
/// Side of the square around the start of a line: with other curves in it, it is unclear which one
/// is meant.
const CLEAR: f64 = 24.0;

/// The place of a text.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Place {
    /// Its centre.
    pub at: Point,
    /// The start of the line that leads to it, if the text stands away from its curve.
    pub from: Option<Point>,
}

/// For each set of curves, the centre of a text of this size on one of them, beside it or away from
/// it; none where there is no room at all.
pub(super) fn places(sets: &[(Curves, (f64, f64))], area: Area) -> Vec<Option<Place>> {
    let points = Points::of(sets);
    let mut taken: Vec<(Point, (f64, f64))> = Vec::new();
    // Short curves have the fewest places, so they choose first.
    let mut order: Vec<usize> = (0..sets.len()).collect();
    let length = |i: &usize| sets[*i].0.iter().map(Vec::len).sum::<usize>();
    order.sort_by_key(length);
    let mut places = vec![None; sets.len()];
    for i in order {
        let (curves, size) = &sets[i];
        let beside = 0.5 * size.0 + BESIDE;
        let longest = curves.iter().map(|c| length_of(c)).fold(1.0, f64::max);
        let candidates = curves.iter().flat_map(|curve| {
            let bonus = LONG_CURVE * length_of(curve) / longest;
            stepped(curve).into_iter().map(move |at| (at, bonus))
        });
        let best = candidates
            .flat_map(|((x, y), bonus)| [0.0, beside, -beside].map(|away| ((x + away, y), bonus)))
            .filter(|&(at, _)| inside(at, *size, area))
            .filter(|&(at, _)| !taken.iter().any(|other| overlap((at, *size), *other)))
            .filter_map(|(at, bonus)| Some((at, bonus + points.room(i, at, *size)?)))
            .fold(None, |best: Option<(Point, f64)>, found| match best {
                Some(best) if best.1 >= found.1 => Some(best),
                _ => Some(found),
            });
        if let Some((at, _)) = best {
            taken.push((at, *size));
            places[i] = Some(Place { at, from: None });
        }
    }
    for (i, (curves, size)) in sets.iter().enumerate() {
        if places[i].is_none() {
            places[i] = led_away(&points, curves, *size, area, &taken);
            taken.extend(places[i].map(|place| (place.at, *size)));
        }
    }
    places
}

/// The nearest place away from a set of curves, for a text that does not fit beside them, where it
/// hides little.
fn led_away(
    points: &Points,
    curves: &Curves,
    size: (f64, f64),
    area: Area,
    taken: &[(Point, (f64, f64))],
) -> Option<Place> {
    let all: Vec<Point> = curves.iter().flat_map(|curve| stepped(curve)).collect();
    let seen = |&(x, y): &Point| {
        (area.left..=area.right).contains(&x) && (area.top..=area.bottom).contains(&y)
    };
    let anchors = all.iter().copied().filter(seen);
    let anchors = anchors.step_by(all.len().div_ceil(MOST_ANCHORS).max(1));
    let free = |at: Point| {
        inside(at, size, area) && !taken.iter().any(|other| overlap((at, size), *other))
    };
    let clear = |from: Point, to: Point| {
        (1..8).map(|i| f64::from(i) / 8.0).all(|part| {
            let on = (
                from.0 + part * (to.0 - from.0),
                from.1 + part * (to.1 - from.1),
            );
            !taken.iter().any(|other| overlap((on, (0.0, 0.0)), *other))
        })
    };
    let mut best: Option<(f64, Place)> = None;
    for from in anchors {
        for (distance, turn) in AWAY
            .iter()
            .flat_map(|d| (0..DIRECTIONS).map(move |t| (d, t)))
        {
            let angle = f64::from(turn) * std::f64::consts::TAU / f64::from(DIRECTIONS);
            let at = (
                from.0 + distance * angle.cos(),
                from.1 + distance * angle.sin(),
            );
            let unclear = points.hidden(from, (CLEAR, CLEAR));
            let cost = distance + HIDING * points.hidden(at, size) + unclear;
            let better = best.is_none_or(|(least, _)| cost < least);
            if better && free(at) && clear(from, at) {
                let from = Some(from);
                best = Some((cost, Place { at, from }));
            }
        }
    }
    best.map(|(_, place)| place)
}

fn inside((x, y): Point, (width, height): (f64, f64), area: Area) -> bool {
    x - 0.6 * width > area.left
        && x + 0.6 * width < area.right
        && y - 0.7 * height > area.top
        && y + 0.7 * height < area.bottom
}

fn overlap(a: (Point, (f64, f64)), b: (Point, (f64, f64))) -> bool {
    (a.0.0 - b.0.0).abs() < 0.55 * (a.1.0 + b.1.0) && (a.0.1 - b.0.1).abs() < 0.55 * (a.1.1 + b.1.1)
}

fn length_of(curve: &[Point]) -> f64 {
    let steps = curve.windows(2);
    steps
        .map(|w| (w[1].0 - w[0].0).hypot(w[1].1 - w[0].1))
        .sum()
}

fn stepped(curve: &[Point]) -> Vec<Point> {
    let mut points = Vec::new();
    for pair in curve.windows(2) {
        let ((x0, y0), (x1, y1)) = (pair[0], pair[1]);
        let steps = ((x1 - x0).hypot(y1 - y0) / STEP).ceil().clamp(1.0, 1e4) as usize;
        points.extend((0..steps).map(|i| {
            let part = i as f64 / steps as f64;
            (x0 + part * (x1 - x0), y0 + part * (y1 - y0))
        }));
    }
    points
}

/// The points of all curves by square, each with the number of its set.
struct Points(HashMap<(i64, i64), Vec<(usize, Point)>>);

impl Points {
    fn of(sets: &[(Curves, (f64, f64))]) -> Self {
        let mut squares: HashMap<_, Vec<_>> = HashMap::new();
        for (i, (curves, _)) in sets.iter().enumerate() {
            for point in curves.iter().flat_map(|curve| stepped(curve)) {
                squares.entry(square(point)).or_default().push((i, point));
            }
        }
        Self(squares)
    }

    /// A score for a text at `at`: its distance from the curves of other sets, up to
    /// [`ENOUGH_ROOM`], plus a bonus for a place on its own curve that hides little of it. None
    /// where another curve is too near, or too much of its own is hidden.
    fn room(&self, own: usize, at: Point, (width, height): (f64, f64)) -> Option<f64> {
        let reach = (0.5 * width + ENOUGH_ROOM, 0.5 * height + ENOUGH_ROOM);
        let (low, high) = (
            square((at.0 - reach.0, at.1 - reach.1)),
            square((at.0 + reach.0, at.1 + reach.1)),
        );
        let (mut room, mut hidden) = (ENOUGH_ROOM, 0.0);
        for column in low.0..=high.0 {
            for row in low.1..=high.1 {
                for &(set, (x, y)) in self.0.get(&(column, row)).into_iter().flatten() {
                    let away = (
                        ((x - at.0).abs() - 0.5 * width).max(0.0),
                        ((y - at.1).abs() - 0.5 * height).max(0.0),
                    );
                    let distance = away.0.hypot(away.1);
                    if set != own {
                        room = f64::min(room, distance);
                    } else if distance == 0.0 {
                        hidden += STEP;
                    }
                }
            }
        }
        let on_curve = hidden > 0.0;
        let least = if on_curve { APART } else { BESIDE + APART };
        let bonus = if on_curve {
            ON_CURVE - 0.1 * hidden
        } else {
            0.0
        };
        (room > least && hidden < 1.4 * width).then_some(room + bonus)
    }
}

impl Points {
    /// The length of all curves that a text hides.
    fn hidden(&self, at: Point, (width, height): (f64, f64)) -> f64 {
        let half = (0.5 * width + APART, 0.5 * height + APART);
        let (low, high) = (
            square((at.0 - half.0, at.1 - half.1)),
            square((at.0 + half.0, at.1 + half.1)),
        );
        let squares = (low.0..=high.0).flat_map(|x| (low.1..=high.1).map(move |y| (x, y)));
        let there = squares.filter_map(|key| self.0.get(&key)).flatten();
        let below = |(x, y): &Point| (x - at.0).abs() <= half.0 && (y - at.1).abs() <= half.1;
        STEP * there.filter(|(_, point)| below(point)).count() as f64
    }
}

fn square((x, y): Point) -> (i64, i64) {
    ((x / SQUARE).floor() as i64, (y / SQUARE).floor() as i64)
}

#[cfg(test)]
mod tests {
    use super::*;

    const AREA: Area = Area {
        left: 0.0,
        top: 0.0,
        right: 400.0,
        bottom: 400.0,
    };

    #[test]
    fn labels_keep_away_from_other_curves_and_each_other() {
        let size = (60.0, 20.0);
        let crossing = [
            (vec![vec![(0.0, 0.0), (400.0, 400.0)]], size),
            (vec![vec![(0.0, 400.0), (400.0, 0.0)]], size),
        ];
        let places = places(&crossing, AREA);
        let (a, b) = (places[0].unwrap().at, places[1].unwrap().at);
        assert!((a.0 - a.1).abs() < 1e-9 && (b.0 + b.1 - 400.0).abs() < 1e-9);
        for place in [a, b] {
            assert!(inside(place, size, AREA));
            assert!((place.0 - 200.0).abs() > 30.0);
        }
    }

    #[test]
    fn without_room_a_line_leads_to_the_label() {
        let size = (60.0, 20.0);
        let close = |y: f64| (vec![vec![(0.0, y), (400.0, y)]], size);
        let places = places(&[close(100.0), close(105.0)], AREA);
        let [Some(a), Some(b)] = places[..] else {
            panic!("{places:?}");
        };
        for (place, y) in [(a, 100.0), (b, 105.0)] {
            assert_eq!(place.from.map(|from| from.1), Some(y));
            assert!(inside(place.at, size, AREA) && (place.at.1 - y).abs() > 10.0);
        }
        assert!(!overlap((a.at, size), (b.at, size)));
        let nowhere = Area {
            right: 50.0,
            ..AREA
        };
        assert_eq!(
            super::places(&[close(100.0), close(105.0)], nowhere),
            [None, None]
        );
    }
}
