//! Which cells the pixels along an axis show.

use std::ops::Range;

use crate::model::elementary::ln;

/// The spacing of pixels over an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum Scale {
    /// Evenly.
    #[default]
    Linear,
    /// Evenly in the logarithm.
    Log,
}

/// A stretch of an axis that is divided into pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Stretch {
    /// The value at the outer edge of the first pixel; none: the axis' first value.
    pub from: Option<f64>,
    /// The value at the outer edge of the last pixel; none: the axis' last value.
    pub to: Option<f64>,
    /// The number of pixels.
    pub pixels: usize,
    /// Their spacing.
    pub scale: Scale,
}

/// Pixels along an axis, in the order of the cells.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Pixels {
    /// The cell nearest to the centre of each pixel; never decreasing.
    pub nearest: Vec<u32>,
    /// The cells whose values lie in each pixel, in ranges that follow one another.
    pub inside: Vec<Range<u32>>,
    /// The pixels on the axis; the others are empty.
    pub on_axis: Range<usize>,
    /// Whether the first requested pixel comes last.
    pub flipped: bool,
}

/// A coordinate that increases with the value and in which pixels are evenly spaced.
#[derive(Debug, Clone, Copy)]
enum Coordinate {
    Linear,
    /// The logarithm of positive values.
    Above,
    /// The negative logarithm of the magnitude of negative values.
    Below,
}

impl Coordinate {
    fn of(self, value: f64) -> f64 {
        match self {
            Self::Linear => value,
            Self::Above => ln(value.max(0.0)),
            Self::Below => -ln((-value).max(0.0)),
        }
    }
}

/// Checks that these can be the ends of a window; none stands for an end of the axis.
///
/// # Errors
/// A description of the fault when one of them is not finite.
pub(crate) fn finite(ends: impl IntoIterator<Item = Option<f64>>) -> Result<(), &'static str> {
    match ends.into_iter().flatten().all(f64::is_finite) {
        true => Ok(()),
        false => Err("the ends of a window are finite numbers"),
    }
}

/// The number at the share `part` of the way between two others.
fn between(from: f64, to: f64, part: f64) -> f64 {
    let whole = to - from;
    match whole.is_finite() {
        true => from + whole * part,
        // The difference of two halves of finite numbers is finite.
        false => 2.0 * (from / 2.0 + (to / 2.0 - from / 2.0) * part),
    }
}

impl Stretch {
    /// The ends, in the coordinate of the pixels.
    fn ends(&self, values: &[f64]) -> Result<(Coordinate, f64, f64), String> {
        finite([self.from, self.to])?;
        let (first, last) = (values[0], values[values.len() - 1]);
        let (from, to) = (self.from.unwrap_or(first), self.to.unwrap_or(last));
        if self.scale == Scale::Linear {
            return Ok((Coordinate::Linear, from, to));
        }
        let above = self.from.or(self.to).unwrap_or(first.max(last)) > 0.0;
        let side = |value: &&f64| **value != 0.0 && (**value > 0.0) == above;
        let mut there = values.iter().filter(side);
        let nearest = [there.next(), there.next_back()];
        let end = |given: Option<f64>, whole: f64, replaced: Option<&f64>| match given {
            Some(value) => Some(value),
            None if side(&&whole) => Some(whole),
            None => replaced.copied(),
        };
        let from = end(self.from, first, nearest[0]);
        let to = end(self.to, last, nearest[1].or(nearest[0]));
        let (Some(from), Some(to)) = (from, to) else {
            return Err("a logarithmic axis needs values on one side of 0".into());
        };
        if !side(&&from) || !side(&&to) {
            return Err("a logarithmic window lies on one side of 0".into());
        }
        let coordinate = match above {
            true => Coordinate::Above,
            false => Coordinate::Below,
        };
        Ok((coordinate, coordinate.of(from), coordinate.of(to)))
    }
}

/// The values of an axis in increasing order, whatever their order on the axis.
struct Rising<'a> {
    values: &'a [f64],
    falls: bool,
    coordinate: Coordinate,
}

impl Rising<'_> {
    fn at(&self, place: usize) -> f64 {
        let index = match self.falls {
            true => self.values.len() - 1 - place,
            false => place,
        };
        self.coordinate.of(self.values[index])
    }

    /// How many values come before the first one that is not `below`.
    fn count(&self, below: impl Fn(f64) -> bool) -> usize {
        let (mut low, mut high) = (0, self.values.len());
        while low < high {
            let middle = low.midpoint(high);
            match below(self.at(middle)) {
                true => low = middle + 1,
                false => high = middle,
            }
        }
        low
    }

    fn nearest(&self, to: f64) -> usize {
        let above = self.count(|value| value < to);
        if above == 0 {
            return 0;
        }
        let last = self.values.len() - 1;
        if above > last || to - self.at(above - 1) <= self.at(above) - to {
            return above - 1;
        }
        above
    }

    /// Whether `to` lies on the axis. Each end cell extends beyond its value by half the distance
    /// to its neighbour; a single cell extends everywhere.
    fn holds(&self, to: f64) -> bool {
        let last = self.values.len() - 1;
        if last == 0 {
            return true;
        }
        let beyond = |end: usize, next: usize| {
            let reach = (self.at(next) - self.at(end)).abs() / 2.0;
            (to - self.at(end)).abs() > reach
        };
        let below = to < self.at(0) && beyond(0, 1);
        let above = to > self.at(last) && beyond(last, last - 1);
        !(below || above)
    }

    /// The index of a place.
    fn index(&self, place: usize) -> u32 {
        match self.falls {
            true => (self.values.len() - 1 - place) as u32,
            false => place as u32,
        }
    }

    /// The indices of a stretch of places.
    fn indices(&self, places: Range<usize>) -> Range<u32> {
        let count = self.values.len();
        match self.falls {
            true => (count - places.end) as u32..(count - places.start) as u32,
            false => places.start as u32..places.end as u32,
        }
    }
}

impl Pixels {
    /// The pixels, at least one, of a stretch of an axis with these values.
    ///
    /// # Errors
    /// A description of the fault when there is no such stretch.
    pub(super) fn along(values: &[f64], stretch: &Stretch) -> Result<Self, String> {
        let (coordinate, from, to) = stretch.ends(values)?;
        let rising = Rising {
            values,
            falls: values[0] > values[values.len() - 1],
            coordinate,
        };
        let count = stretch.pixels;
        let at = |part: f64| between(from, to, part / count as f64);
        // The number of values before each edge of a pixel, counted in the direction of the pixels.
        let rises = from <= to;
        let before = |edge: usize| match (rises, edge == count) {
            (true, false) => rising.count(|value| value < at(edge as f64)),
            (true, true) => rising.count(|value| value <= to),
            (false, false) => rising.count(|value| value <= at(edge as f64)),
            (false, true) => rising.count(|value| value < to),
        };
        let edges: Vec<usize> = (0..=count).map(before).collect();
        let centre = |pixel: usize| at(pixel as f64 + 0.5);
        let place = |pixel| rising.index(rising.nearest(centre(pixel)));
        let on_axis =
            |pixel: &usize| edges[*pixel] != edges[pixel + 1] || rising.holds(centre(*pixel));
        let first = (0..count).find(on_axis).unwrap_or(count);
        let behind = (first..count).rfind(on_axis).map_or(first, |last| last + 1);
        let mut pixels = Self {
            nearest: (0..count).map(place).collect(),
            inside: edges
                .windows(2)
                .map(|edge| rising.indices(edge[0].min(edge[1])..edge[0].max(edge[1])))
                .collect(),
            on_axis: first..behind,
            flipped: rises == rising.falls,
        };
        if pixels.flipped {
            pixels.nearest.reverse();
            pixels.inside.reverse();
            pixels.on_axis = count - behind..count - first;
        }
        Ok(pixels)
    }

    /// One pixel that shows one cell.
    pub(super) fn one(cell: usize) -> Self {
        let cell = cell as u32;
        Self {
            nearest: vec![cell],
            inside: std::iter::once(cell..cell + 1).collect(),
            on_axis: 0..1,
            flipped: false,
        }
    }

    /// The number of pixels.
    pub(super) fn len(&self) -> usize {
        self.nearest.len()
    }

    /// Whether some pixel hides cells.
    pub(super) fn is_crowded(&self) -> bool {
        self.inside.iter().any(|inside| inside.len() > 1)
    }

    /// The pixels that show these cells.
    pub(super) fn showing(&self, cells: &Range<u32>) -> Range<usize> {
        let from = self.nearest.partition_point(|&cell| cell < cells.start);
        let to = self.nearest.partition_point(|&cell| cell < cells.end);
        let from = from.max(self.on_axis.start);
        from..to.min(self.on_axis.end).max(from)
    }

    /// The pixels that may contain some of these cells.
    pub(super) fn holding(&self, cells: &Range<u32>) -> Range<usize> {
        let from = (self.inside).partition_point(|inside| inside.end <= cells.start);
        let to = (self.inside).partition_point(|inside| inside.start < cells.end);
        from..to.max(from)
    }

    /// The place of the `number`-th requested pixel.
    pub(super) fn place(&self, number: usize) -> usize {
        match self.flipped {
            true => self.len() - 1 - number,
            false => number,
        }
    }

    /// The chunks of this length that contain cells of these pixels, each with a flag: true if a
    /// pixel shows one of its cells, false if all are hidden. With `hidden`, chunks of the latter
    /// kind are included.
    pub(super) fn chunks(&self, length: usize, hidden: bool) -> Vec<(u32, bool)> {
        let length = length as u32;
        let mut chunks: Vec<(u32, bool)> = Vec::new();
        let mut add = |chunk: u32, shown: bool| match chunks.last_mut() {
            Some((last, was)) if *last == chunk => *was |= shown,
            _ => chunks.push((chunk, shown)),
        };
        for pixel in self.on_axis.clone() {
            let (nearest, inside) = (self.nearest[pixel], &self.inside[pixel]);
            let shown = nearest / length;
            let holds = match hidden && !inside.is_empty() {
                true => inside.start / length..(inside.end - 1) / length + 1,
                false => shown..shown + 1,
            };
            for chunk in holds {
                add(chunk, chunk == shown);
            }
        }
        chunks
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn along(values: &[f64], ends: Option<(f64, f64)>, pixels: usize, scale: Scale) -> Pixels {
        let stretch = Stretch {
            from: ends.map(|ends| ends.0),
            to: ends.map(|ends| ends.1),
            pixels,
            scale,
        };
        Pixels::along(values, &stretch).unwrap()
    }

    /// The pixels by a search through all cells for every pixel.
    fn by_hand(values: &[f64], (from, to): (f64, f64), pixels: usize, scale: Scale) -> Pixels {
        let coordinate = |value: f64| match scale {
            Scale::Linear => value,
            Scale::Log => ln(value),
        };
        let (a, b) = (coordinate(from), coordinate(to));
        let (mut nearest, mut inside) = (Vec::new(), Vec::new());
        for pixel in 0..pixels {
            let at = |part: f64| a + (b - a) * (part / pixels as f64);
            let centre = at(pixel as f64 + 0.5);
            let distance = |i: &usize| (coordinate(values[*i]) - centre).abs();
            let found = (0..values.len()).min_by(|i, j| distance(i).total_cmp(&distance(j)));
            nearest.push(found.unwrap() as u32);
            let (low, high) = (at(pixel as f64), at(pixel as f64 + 1.0));
            let last = pixel + 1 == pixels;
            let within = |i: &u32| {
                let u = coordinate(values[*i as usize]);
                match a <= b {
                    true => u >= low && (u < high || last && u <= high),
                    false => u <= low && (u > high || last && u >= high),
                }
            };
            let cells: Vec<u32> = (0..values.len() as u32).filter(within).collect();
            inside.push(cells);
        }
        let flipped = (a <= b) == (values[0] > values[values.len() - 1]);
        if flipped {
            nearest.reverse();
            inside.reverse();
        }
        let mut end = inside.iter().flatten().next().copied().unwrap_or(0);
        let range = |cells: Vec<u32>| {
            let start = cells.first().copied().unwrap_or(end);
            end = cells.last().map_or(end, |last| last + 1);
            start..end
        };
        let inside: Vec<Range<u32>> = inside.into_iter().map(range).collect();
        // The axis extends half a step beyond the first and the last value.
        let mut sorted: Vec<f64> = values.iter().map(|&value| coordinate(value)).collect();
        sorted.sort_by(f64::total_cmp);
        let last = sorted.len() - 1;
        let low = sorted[0] - (sorted[1] - sorted[0]) / 2.0;
        let high = sorted[last] + (sorted[last] - sorted[last - 1]) / 2.0;
        let centre = |pixel: usize| a + (b - a) * ((pixel as f64 + 0.5) / pixels as f64);
        let on_axis = (0..pixels).filter(|&place| {
            let pixel = if flipped { pixels - 1 - place } else { place };
            !inside[place].is_empty() || (low..=high).contains(&centre(pixel))
        });
        let on_axis: Vec<usize> = on_axis.collect();
        let first = on_axis.first().copied().unwrap_or(pixels);
        Pixels {
            nearest,
            inside,
            on_axis: first..first + on_axis.len(),
            flipped,
        }
    }

    #[test]
    fn every_pixel_is_as_by_hand() {
        let even: Vec<f64> = (0..97).map(|i| 0.3 + f64::from(i) / 96.0).collect();
        let uneven = [0.01, 0.02, 0.5, 0.51, 0.52, 3.0, 3.5, 9.0, 40.0];
        let falling: Vec<f64> = uneven.iter().rev().copied().collect();
        for values in [&even[..], &uneven, &falling] {
            for scale in [Scale::Linear, Scale::Log] {
                for ends in [
                    (0.011, 8.3),
                    (9.0, 0.02),
                    (0.4, 0.55),
                    (3.1, 3.1001),
                    (0.3, 100.0),
                    (1e-4, 1e6),
                    (500.0, 60.0),
                    (1e-5, 1e-4),
                ] {
                    for pixels in [1, 7, 40, 200] {
                        let found = along(values, Some(ends), pixels, scale);
                        let expected = by_hand(values, ends, pixels, scale);
                        assert_eq!(found.nearest, expected.nearest, "{ends:?} {pixels}");
                        let lists = |p: &Pixels| -> Vec<Vec<u32>> {
                            p.inside.iter().map(|r| r.clone().collect()).collect()
                        };
                        assert_eq!(lists(&found), lists(&expected), "{ends:?} {pixels}");
                        assert_eq!(found.flipped, expected.flipped);
                        let empty = |p: &Pixels| p.on_axis.is_empty();
                        match empty(&expected) {
                            true => assert!(empty(&found) && found.chunks(2, true).is_empty()),
                            false => assert_eq!(found.on_axis, expected.on_axis, "{ends:?}"),
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn as_many_pixels_as_cells_show_one_each() {
        let values: Vec<f64> = (0..1000).map(|i| f64::from(i) * 0.1).collect();
        let all = along(&values, None, 1000, Scale::Linear);
        assert!(all.nearest.iter().copied().eq(0..1000));
        assert!(all.inside.iter().zip(0..).all(|(r, i)| *r == (i..i + 1)));
    }

    #[test]
    fn logarithms_stay_on_one_side_of_zero() {
        let values = [-10.0, -1.0, 0.0, 1.0, 10.0, 100.0];
        let upper = along(&values, None, 20, Scale::Log);
        assert_eq!((upper.nearest[0], upper.nearest[19]), (3, 5));
        let lower = along(&values, Some((-10.0, -1.0)), 4, Scale::Log);
        assert_eq!(lower.nearest, [0, 0, 1, 1]);
        for (from, to) in [
            (-1.0, 1.0),
            (0.0, 1.0),
            (f64::NAN, 1.0),
            (1.0, f64::INFINITY),
        ] {
            let stretch = Stretch {
                from: Some(from),
                to: Some(to),
                pixels: 5,
                scale: Scale::Log,
            };
            assert!(Pixels::along(&values, &stretch).is_err());
        }
        let one = along(&[3.0], None, 3, Scale::Linear);
        assert_eq!((one.nearest, one.on_axis), (vec![0, 0, 0], 0..3));
    }

    #[test]
    fn windows_may_be_as_wide_as_numbers_are() {
        let values = [-1.0, 0.0, 1.0, 2.0];
        for ends in [(-1e308, 1.2e308), (1e308, -1.2e308)] {
            let all = along(&values, Some(ends), 4, Scale::Linear);
            // One pixel contains all of them, the others none.
            assert_eq!(all.on_axis.len(), 1, "{all:?}");
            assert_eq!(all.place(all.on_axis.start), 1);
            assert_eq!(all.inside[all.on_axis.start], 0..4);
        }
    }
}
