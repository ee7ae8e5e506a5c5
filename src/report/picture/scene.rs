//! The contents of a picture, in pixels from its upper left corner, independent of rendering.

use super::options::PictureOptions;
use super::print::Print;
use super::text::Rich;
use crate::meaning::colour::{PAPER, Rgb};

/// A place in pixels: to the right, downwards.
pub(super) type Point = (f64, f64);

/// One drawn element.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Mark {
    /// A filled rectangle.
    Rect {
        /// Upper left corner.
        from: Point,
        /// Lower right corner.
        to: Point,
        /// Colour.
        colour: Rgb,
        /// 0 to 1.
        opacity: f64,
    },
    /// A polyline with round ends.
    Path {
        /// Its points.
        points: Vec<Point>,
        /// Colour.
        colour: Rgb,
        /// Width in pixels.
        width: f64,
    },
    /// The area between two curves over the same places.
    Band {
        /// (x, y of one curve, y of the other), by increasing x.
        slices: Vec<(f64, f64, f64)>,
        /// Colour.
        colour: Rgb,
        /// 0 to 1.
        opacity: f64,
    },
    /// A line of text.
    Text {
        /// Left end of the baseline, before rotation.
        at: Point,
        /// Height of the font in pixels.
        size: f64,
        /// The text, in one font size.
        text: String,
        /// Colour.
        colour: Rgb,
        /// Whether it reads upwards.
        upward: bool,
    },
    /// A grid of cells.
    Cells {
        /// Edges from left to right, one more than there are columns; increasing or decreasing.
        columns: Vec<f64>,
        /// Edges, one more than there are rows.
        rows: Vec<f64>,
        /// Colours, row by row.
        colours: Vec<Rgb>,
    },
}

/// The position of a text relative to its place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Align {
    /// The text starts there.
    Start,
    /// Its middle is there.
    Middle,
    /// It ends there.
    End,
}

/// A picture: marks in the order of drawing.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Scene {
    /// Width and height in pixels.
    pub size: (u32, u32),
    /// How it is printed, if that is known.
    pub print: Option<Print>,
    /// The drawn elements.
    pub marks: Vec<Mark>,
}

impl Scene {
    /// An empty, white picture.
    pub(super) fn new(size: (u32, u32)) -> Self {
        Self {
            size,
            print: None,
            marks: Vec::new(),
        }
    }

    /// An empty, white picture of the size that is asked for.
    pub(super) fn asked(options: &PictureOptions) -> Self {
        Self {
            print: options.print,
            ..Self::new(options.pixels())
        }
    }

    /// An empty, white picture of the same size.
    pub(super) fn like(&self) -> Self {
        Self {
            print: self.print,
            ..Self::new(self.size)
        }
    }

    /// The unit of this picture: 1 for 1600 × 1100 pixels, or by the size of text in print. All
    /// fonts and gaps scale with it.
    pub(super) fn unit(&self) -> f64 {
        if let Some(print) = self.print {
            return print.unit();
        }
        (f64::from(self.size.0) / 1600.0).min(f64::from(self.size.1) / 1100.0)
    }

    /// Adds a filled rectangle.
    pub(super) fn rect(&mut self, from: Point, to: Point, colour: Rgb) {
        self.marks.push(Mark::Rect {
            from,
            to,
            colour,
            opacity: 1.0,
        });
    }

    /// Adds a horizontal or vertical line, sharp to the pixel.
    pub(super) fn ruler(&mut self, from: Point, to: Point, colour: Rgb, width: f64) {
        let half = 0.5 * width;
        let corner = |a: Point, b: Point| (a.0.min(b.0) - half, a.1.min(b.1) - half);
        let (x0, y0) = corner(from, to);
        let far = (from.0.max(to.0) + half, from.1.max(to.1) + half);
        self.rect((x0, y0), far, colour);
    }

    /// Adds the outline of a rectangle.
    pub(super) fn outline(&mut self, from: Point, to: Point, colour: Rgb, width: f64) {
        let (right, left) = ((to.0, from.1), (from.0, to.1));
        for (a, b) in [(from, right), (right, to), (left, to), (from, left)] {
            self.ruler(a, b, colour, width);
        }
    }

    /// Adds a polyline.
    pub(super) fn path(&mut self, points: Vec<Point>, colour: Rgb, width: f64) {
        if points.len() > 1 {
            self.marks.push(Mark::Path {
                points,
                colour,
                width,
            });
        }
    }

    /// Fills the area between two curves over the same places: (x, y of one, y of the other).
    pub(super) fn band(&mut self, slices: Vec<(f64, f64, f64)>, colour: Rgb) {
        self.marks.push(Mark::Band {
            slices,
            colour,
            opacity: 1.0,
        });
    }

    /// Adds a dot.
    pub(super) fn dot(&mut self, (x, y): Point, colour: Rgb, diameter: f64) {
        // A line with round ends that is too short to be visible as a line.
        self.path(vec![(x - 0.1, y), (x + 0.1, y)], colour, diameter);
    }

    /// Adds a ring between two diameters, with paper inside.
    pub(super) fn ring(&mut self, at: Point, colour: Rgb, (outer, inner): (f64, f64)) {
        self.dot(at, colour, outer);
        self.dot(at, PAPER, inner);
    }

    /// Adds a polyline in dashes, about (length, gap) in units of the picture: an open one begins
    /// and ends with a dash, a closed one goes on where it begins.
    pub(super) fn dashed(&mut self, points: &[Point], colour: Rgb, width: f64, dash: (f64, f64)) {
        // A place that is none would have dashes without end.
        if !points.iter().all(|(x, y)| x.is_finite() && y.is_finite()) {
            return;
        }
        let u = self.unit();
        let (lengths, first) = fitting_dashes(points, [dash.0 * u, dash.1 * u]);
        let (mut on, mut left) = (true, first);
        let mut current: Vec<Point> = points.first().copied().into_iter().collect();
        for pair in points.windows(2) {
            let (mut from, to) = (pair[0], pair[1]);
            let mut length = (to.0 - from.0).hypot(to.1 - from.1);
            while length > left {
                let part = left / length;
                from = (
                    from.0 + part * (to.0 - from.0),
                    from.1 + part * (to.1 - from.1),
                );
                length -= left;
                if on {
                    current.push(from);
                    self.path(std::mem::take(&mut current), colour, width);
                } else {
                    current.push(from);
                }
                on = !on;
                left = lengths[usize::from(!on)];
            }
            left -= length;
            if on {
                current.push(to);
            }
        }
        self.path(current, colour, width);
    }

    /// Adds a text whose baseline is at `at`.
    pub(super) fn text(&mut self, at: Point, align: Align, text: &Rich, size: f64, colour: Rgb) {
        let left = at.0 - shift(align, text.width(size));
        for (offset, drop, size, run) in text.placed(size) {
            self.marks.push(Mark::Text {
                at: (left + offset, at.1 + drop),
                size,
                text: run,
                colour,
                upward: false,
            });
        }
    }

    /// Adds a text that reads upwards, with its centre at `at` and its baseline to the right of the
    /// letters.
    pub(super) fn upward_text(&mut self, at: Point, text: &Rich, size: f64, colour: Rgb) {
        let bottom = at.1 + 0.5 * text.width(size);
        for (offset, drop, size, run) in text.placed(size) {
            self.marks.push(Mark::Text {
                at: (at.0 + drop, bottom - offset),
                size,
                text: run,
                colour,
                upward: true,
            });
        }
    }
}

/// Length of a polyline.
pub(super) fn length_of(points: &[Point]) -> f64 {
    let steps = points.windows(2);
    steps
        .map(|w| (w[1].0 - w[0].0).hypot(w[1].1 - w[0].1))
        .sum()
}

/// (length, gap) of dashes that fit into a polyline a whole number of times, and the length of the
/// first one.
fn fitting_dashes(points: &[Point], [dash, gap]: [f64; 2]) -> ([f64; 2], f64) {
    let length = length_of(points);
    let closed = points.len() > 2 && points.first() == points.last();
    // What the gap lacks behind the last dash of an open curve.
    let lacking = if closed { 0.0 } else { gap };
    let times = ((length + lacking) / (dash + gap)).round().max(1.0);
    let by = length / (times * (dash + gap) - lacking);
    let by = if by > 0.0 { by } else { 1.0 };
    let first = if closed { 0.5 * dash } else { dash };
    ([dash * by, gap * by], first * by)
}

fn shift(align: Align, width: f64) -> f64 {
    match align {
        Align::Start => 0.0,
        Align::Middle => 0.5 * width,
        Align::End => width,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn dashes(points: &[Point]) -> Vec<(Point, Point)> {
        let mut scene = Scene::new((1600, 1100));
        scene.dashed(points, PAPER, 1.0, (10.0, 5.0));
        let ends = scene.marks.iter().map(|mark| match mark {
            Mark::Path { points, .. } => (points[0], points[points.len() - 1]),
            other => panic!("{other:?}"),
        });
        ends.collect()
    }

    #[test]
    fn dashes_fit_into_curves() {
        let open = dashes(&[(0.0, 0.0), (104.0, 0.0)]);
        let near = |a: f64, b: f64| (a - b).abs() < 1e-6;
        assert!(open.len() == 7 && open[0].0 == (0.0, 0.0));
        assert!(near(open[6].1.0, 104.0), "{open:?}");
        let closed = dashes(&[(0.0, 0.0), (50.0, 0.0), (50.0, 40.0), (0.0, 0.0)]);
        // The first and the last one are two halves.
        let (first, last) = (closed[0], closed[closed.len() - 1]);
        assert!(first.0 == (0.0, 0.0) && near(last.1.0, 0.0) && near(last.1.1, 0.0));
        let length = |(a, b): (Point, Point)| (b.0 - a.0).hypot(b.1 - a.1);
        assert!(near(length(first), length(last)), "{closed:?}");
        // A curve shorter than a dash is drawn whole.
        assert_eq!(dashes(&[(0.0, 0.0), (3.0, 0.0)]).len(), 1);
    }
}
