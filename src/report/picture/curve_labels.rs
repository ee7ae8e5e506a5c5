//! Places for labels beside curves, where they touch no curve at all. Where there is none, a label
//! stands away from its curve, with a line that leads to it and crosses nothing.

use super::clip;
use super::near_curves::{Points, STEP, Size, stepped};
use super::page::Area;
use super::scene::{Point, length_of};

/// Distance of a text from its curve, as a share of its height.
const BESIDE: f64 = 0.45;
/// How much room a place at the longest curve may give up against one at a tiny lobe.
const LONG_CURVE: f64 = 50.0;
/// How much room a place at a level stretch may give up against one at an upright stretch.
const LEVEL: f64 = 12.0;

/// Distances from its curve at which a text with a line may stand, in heights of the text.
const AWAY: [f64; 8] = [1.6, 2.2, 3.0, 4.0, 5.5, 7.5, 10.0, 13.0];
/// Number of directions that are tried.
const DIRECTIONS: u32 = 24;
/// The most points of a curve from which a line may lead to a text.
const MOST_ANCHORS: usize = 48;
/// Distance of a line from the curve at which it starts, for which that curve is near.
const START: f64 = 2.5 * STEP;
/// The least angle between a line and the curve at which it starts, as a sine.
const STEEP: f64 = 0.5;

/// The curves of one label, in pixels.
pub(super) type Curves = Vec<Vec<Point>>;

/// The place of a text.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Place {
    /// Its centre.
    pub at: Point,
    /// The ends of the line between its curve and it, if the text stands away from its curve.
    pub line: Option<[Point; 2]>,
}

/// For each set of curves, the centre of a text of this size beside one of them or away from it;
/// none where there is no room at all. `u`: the unit of the picture, on whose multiples nothing
/// depends.
pub(super) fn places(sets: &[(Curves, Size)], area: Area, u: f64) -> Vec<Option<Place>> {
    let in_units = |(curves, (width, height)): &(Curves, Size)| {
        let curve = |curve: &Vec<Point>| curve.iter().map(|p| (p.0 / u, p.1 / u)).collect();
        let curves: Curves = curves.iter().map(curve).collect();
        (curves, (width / u, height / u))
    };
    let sets: Vec<(Curves, Size)> = sets.iter().map(in_units).collect();
    let area = Area {
        left: area.left / u,
        top: area.top / u,
        right: area.right / u,
        bottom: area.bottom / u,
    };
    let in_pixels = |p: Point| (p.0 * u, p.1 * u);
    let pixels = |place: Place| Place {
        at: in_pixels(place.at),
        line: place.line.map(|line| line.map(in_pixels)),
    };
    let places = places_in_units(&sets, area).into_iter();
    places.map(|place| place.map(pixels)).collect()
}

fn places_in_units(sets: &[(Curves, Size)], area: Area) -> Vec<Option<Place>> {
    let mut found = Search {
        points: Points::of(sets.iter().map(|(curves, _)| &curves[..])),
        taken: Vec::new(),
        lines: Vec::new(),
        area,
    };
    // Short curves have the fewest places, so they choose first.
    let mut order: Vec<usize> = (0..sets.len()).collect();
    let length = |i: &usize| sets[*i].0.iter().map(|c| length_of(c)).sum::<f64>();
    order.sort_by(|a, b| length(a).total_cmp(&length(b)));
    let mut places = vec![None; sets.len()];
    for &i in &order {
        places[i] = found.beside(i, &sets[i]);
        found.take(places[i], sets[i].1);
    }
    for i in order {
        if places[i].is_none() {
            places[i] = found.led_away(i, &sets[i]);
            found.take(places[i], sets[i].1);
        }
    }
    places
}

/// What is known while places are sought.
struct Search {
    points: Points,
    /// Texts that have a place, with their sizes.
    taken: Vec<(Point, Size)>,
    /// Lines that lead to them.
    lines: Vec<[Point; 2]>,
    area: Area,
}

impl Search {
    fn take(&mut self, place: Option<Place>, size: Size) {
        self.taken.extend(place.map(|place| (place.at, size)));
        self.lines.extend(place.and_then(|place| place.line));
    }

    /// The best place that touches its curve's neighbourhood and nothing else.
    fn beside(&self, own: usize, (curves, size): &(Curves, Size)) -> Option<Place> {
        let longest = curves.iter().map(|c| length_of(c)).fold(1.0, f64::max);
        let mut best: Option<(f64, Point)> = None;
        for curve in curves {
            let bonus = LONG_CURVE * length_of(curve) / longest;
            for pair in stepped(curve).windows(2) {
                for (at, level) in touching(pair[0], pair[1], *size) {
                    if !self.free(at, *size) {
                        continue;
                    }
                    let Some(room) = self.points.room(own, at, *size) else {
                        continue;
                    };
                    let score = room + bonus + LEVEL * level;
                    if best.is_none_or(|(most, _)| score > most) {
                        best = Some((score, at));
                    }
                }
            }
        }
        best.map(|(_, at)| Place { at, line: None })
    }

    /// The nearest place away from the curves, with a line that crosses nothing.
    fn led_away(&self, own: usize, (curves, size): &(Curves, Size)) -> Option<Place> {
        let mut best: Option<(f64, Place)> = None;
        for (from, tangent) in anchors(curves, self.area) {
            for turn in 0..DIRECTIONS {
                let angle = f64::from(turn) * std::f64::consts::TAU / f64::from(DIRECTIONS);
                let (sin, cos) = angle.sin_cos();
                if (tangent.0 * sin - tangent.1 * cos).abs() < STEEP {
                    continue;
                }
                for away in AWAY {
                    // From the curve to the edge of the text.
                    let edge = edge_of(*size, (cos, sin));
                    let (line, all) = (away * size.1, away * size.1 + edge);
                    if best.is_some_and(|(least, _)| least <= all) {
                        break;
                    }
                    let at = (from.0 + all * cos, from.1 + all * sin);
                    let to = (from.0 + line * cos, from.1 + line * sin);
                    if self.free(at, *size)
                        && self.points.is_clear(at, *size)
                        && self.leads(own, from, to)
                    {
                        let line = Some([from, to]);
                        best = Some((all, Place { at, line }));
                        break;
                    }
                }
            }
        }
        best.map(|(_, place)| place)
    }

    /// Whether a text here stays inside and off other texts and their lines.
    fn free(&self, at: Point, size: Size) -> bool {
        let apart = |line: &[Point; 2]| !meets(line, at, size);
        inside(at, size, self.area)
            && !self.taken.iter().any(|other| overlap((at, size), *other))
            && self.lines.iter().all(apart)
    }

    /// Whether a line crosses no curve beyond its start, no text and no other line.
    fn leads(&self, own: usize, from: Point, to: Point) -> bool {
        let length = (to.0 - from.0).hypot(to.1 - from.1);
        let steps = (length / STEP).ceil().max(1.0) as usize;
        let on = |i: usize| {
            let part = i as f64 / steps as f64;
            (
                from.0 + part * (to.0 - from.0),
                from.1 + part * (to.1 - from.1),
            )
        };
        let clear = (0..=steps).all(|i| {
            let begins = i as f64 * STEP <= START;
            !self.points.is_near(on(i), STEP, begins.then_some(own))
        });
        let line = [from, to];
        let apart = |&(at, size): &(Point, Size)| !meets(&line, at, size);
        clear && self.taken.iter().all(apart) && !self.lines.iter().any(|other| cross(other, &line))
    }
}

/// Centres of a text of this size on both sides of a stretch of a curve, as near as it may be, and
/// how level the stretch is, 0 to 1.
fn touching(from: Point, to: Point, size: Size) -> Vec<(Point, f64)> {
    let (across, down) = (to.0 - from.0, to.1 - from.1);
    let length = across.hypot(down);
    if length == 0.0 {
        return Vec::new();
    }
    let (along, normal) = (
        (across / length, down / length),
        (-down / length, across / length),
    );
    // How far the box reaches against the normal.
    let reach = 0.5 * (size.0 * normal.0.abs() + size.1 * normal.1.abs());
    let away = reach + BESIDE * size.1;
    let middle = (0.5 * (from.0 + to.0), 0.5 * (from.1 + to.1));
    [away, -away]
        .map(|away| {
            let at = (middle.0 + away * normal.0, middle.1 + away * normal.1);
            (at, along.0.abs())
        })
        .to_vec()
}

/// Places on curves from which a line may lead, inside `area`, with the curves' directions there.
fn anchors(curves: &Curves, area: Area) -> Vec<(Point, Point)> {
    let mut all = Vec::new();
    for curve in curves {
        for pair in stepped(curve).windows(2) {
            let ((x0, y0), (x1, y1)) = (pair[0], pair[1]);
            let length = (x1 - x0).hypot(y1 - y0);
            let inside =
                (area.left..=area.right).contains(&x0) && (area.top..=area.bottom).contains(&y0);
            if inside && length > 0.0 {
                all.push(((x0, y0), ((x1 - x0) / length, (y1 - y0) / length)));
            }
        }
    }
    let every = all.len().div_ceil(MOST_ANCHORS).max(1);
    all.into_iter().step_by(every).collect()
}

/// Distance from the centre of a box to its edge in a direction.
fn edge_of((width, height): Size, (cos, sin): (f64, f64)) -> f64 {
    let across = 0.5 * width / cos.abs().max(f64::MIN_POSITIVE);
    let up = 0.5 * height / sin.abs().max(f64::MIN_POSITIVE);
    // A little short of the letters.
    across.min(up) + 0.25 * height
}

/// The box of a text with a little room around it.
fn roomy((x, y): Point, (width, height): Size) -> Area {
    let room = 0.2 * height;
    Area {
        left: x - 0.5 * width - room,
        top: y - 0.5 * height - room,
        right: x + 0.5 * width + room,
        bottom: y + 0.5 * height + room,
    }
}

fn inside(at: Point, size: Size, area: Area) -> bool {
    let text = roomy(at, size);
    text.left > area.left
        && text.right < area.right
        && text.top > area.top
        && text.bottom < area.bottom
}

fn overlap(a: (Point, Size), b: (Point, Size)) -> bool {
    roomy(a.0, a.1).overlaps(&roomy(b.0, b.1))
}

/// Whether a line meets the box of a text.
fn meets(line: &[Point; 2], at: Point, size: Size) -> bool {
    let area = roomy(at, size);
    !clip::within(line, area).is_empty()
}

/// Whether a line crosses any stretch of another one.
pub(super) fn cross_any(line: &[Point; 2], path: &[Point]) -> bool {
    let mut stretches = path.windows(2);
    stretches.any(|pair| cross(line, &[pair[0], pair[1]]))
}

fn cross([a, b]: &[Point; 2], [c, d]: &[Point; 2]) -> bool {
    let side = |p: &Point, q: &Point, r: &Point| {
        ((q.0 - p.0) * (r.1 - p.1) - (q.1 - p.1) * (r.0 - p.0)).signum()
    };
    side(a, b, c) != side(a, b, d) && side(c, d, a) != side(c, d, b)
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
    const SIZE: Size = (60.0, 20.0);

    /// Whether a straight line meets the box of a text.
    fn meets_box(line: [Point; 2], (x, y): Point) -> bool {
        (0..=4000).map(|i| f64::from(i) / 4000.0).any(|part| {
            let on = |a: f64, b: f64| a + part * (b - a);
            let at = (on(line[0].0, line[1].0), on(line[0].1, line[1].1));
            (at.0 - x).abs() < 0.5 * SIZE.0 && (at.1 - y).abs() < 0.5 * SIZE.1
        })
    }

    #[test]
    fn labels_stand_beside_their_own_curve_and_touch_none() {
        let lines = [[(0.0, 0.0), (400.0, 400.0)], [(0.0, 400.0), (400.0, 0.0)]];
        let crossing = lines.map(|line| (vec![line.to_vec()], SIZE));
        let places = places(&crossing, AREA, 1.0);
        for (i, place) in places.iter().enumerate() {
            let Place { at, line } = place.unwrap();
            assert_eq!(line, None);
            assert!(inside(at, SIZE, AREA));
            assert!(lines.iter().all(|line| !meets_box(*line, at)));
            // Distance from a diagonal, times the root of 2.
            let away = [(at.0 - at.1).abs(), (at.0 + at.1 - 400.0).abs()];
            assert!(away[i] < away[1 - i], "{away:?}");
        }
    }

    #[test]
    fn without_room_a_line_leads_to_the_label() {
        let close = |y: f64| (vec![vec![(0.0, y), (400.0, y)]], SIZE);
        let places = places(&[close(100.0), close(112.0)], AREA, 1.0);
        let [Some(a), Some(b)] = places[..] else {
            panic!("{places:?}");
        };
        // Each can stand on its own side.
        assert!(a.at.1 < 100.0 && b.at.1 > 112.0);
        assert!(!overlap((a.at, SIZE), (b.at, SIZE)));
        let three = [close(100.0), close(112.0), close(124.0)];
        let places = super::places(&three, AREA, 1.0);
        assert_eq!(places[1], None, "its line would cross another curve");
        let lone = vec![vec![(190.0, 200.0), (210.0, 200.0)]];
        let level = |y: f64, from: f64, to: f64| vec![(from, y), (to, y)];
        let walls = vec![
            level(212.0, 0.0, 400.0),
            level(188.0, 0.0, 185.0),
            level(188.0, 215.0, 400.0),
        ];
        let Some(Place { at, line }) = super::places(&[(lone, SIZE), (walls, SIZE)], AREA, 1.0)[0]
        else {
            panic!("there is a way through the gap");
        };
        let [from, to] = line.unwrap();
        assert!(from.1 == 200.0 && (185.0..=215.0).contains(&from.0));
        assert!(to.1 < 188.0 && at.1 < to.1 && inside(at, SIZE, AREA));
        let nowhere = Area {
            right: 50.0,
            ..AREA
        };
        assert_eq!(super::places(&three, nowhere, 1.0), [None, None, None]);
    }
}
