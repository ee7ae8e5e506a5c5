//! The monotone cubic through measured points (PCHIP, Fritsch and Butland 1984, with the
//! three-point slopes at the ends).

/// A curve through points; constant below the first and beyond the last one.
#[derive(Debug, Clone)]
pub(crate) struct Curve {
    pub x: Vec<f64>,
    pub y: Vec<f64>,
    slopes: Vec<f64>,
}

impl Curve {
    /// Through two points or more, `x` increasing.
    pub(crate) fn through(x: &[f64], y: &[f64]) -> Self {
        let widths: Vec<f64> = x.windows(2).map(|w| w[1] - w[0]).collect();
        let rises = y.windows(2).zip(&widths);
        let secants: Vec<f64> = rises.map(|(w, h)| (w[1] - w[0]) / h).collect();
        Self {
            x: x.to_vec(),
            y: y.to_vec(),
            slopes: slopes(&widths, &secants),
        }
    }

    /// Piece 0 lies below the first point, piece i between points i − 1 and i, the last one beyond.
    pub(crate) fn piece(&self, x: f64) -> usize {
        self.x.iter().take_while(|knot| **knot <= x).count()
    }

    /// From where to where a piece holds.
    pub(crate) fn bounds(&self, piece: usize) -> (f64, f64) {
        let from = match piece {
            0 => f64::NEG_INFINITY,
            i => self.x[i - 1],
        };
        (from, self.x.get(piece).copied().unwrap_or(f64::INFINITY))
    }

    /// The value by a piece.
    pub(crate) fn value(&self, piece: usize, x: f64) -> f64 {
        let Some((i, h, q)) = self.inside(piece, x) else {
            return self.end(piece);
        };
        let p = 1.0 - q;
        self.y[i] * (1.0 + 2.0 * q) * p * p
            + self.y[i + 1] * (1.0 + 2.0 * p) * q * q
            + h * q * p * (self.slopes[i] * p - self.slopes[i + 1] * q)
    }

    /// Its slope.
    pub(crate) fn slope(&self, piece: usize, x: f64) -> f64 {
        let Some((i, h, q)) = self.inside(piece, x) else {
            return 0.0;
        };
        let p = 1.0 - q;
        6.0 * q * p * (self.y[i + 1] - self.y[i]) / h
            + self.slopes[i] * p * (1.0 - 3.0 * q)
            + self.slopes[i + 1] * q * (1.0 - 3.0 * p)
    }

    /// The point before, the width and the place in it, from 0 to 1; none outside of the points.
    fn inside(&self, piece: usize, x: f64) -> Option<(usize, f64, f64)> {
        if piece == 0 || piece == self.x.len() {
            return None;
        }
        let h = self.x[piece] - self.x[piece - 1];
        Some((piece - 1, h, (x - self.x[piece - 1]) / h))
    }

    fn end(&self, piece: usize) -> f64 {
        self.y[piece.saturating_sub(1)]
    }
}

/// The slopes at the points: weighted harmonic means of the secants beside them, 0 where these
/// differ in sign.
fn slopes(widths: &[f64], secants: &[f64]) -> Vec<f64> {
    let last = widths.len() - 1;
    if last == 0 {
        return vec![secants[0]; 2];
    }
    let mut slopes = vec![end_slope((widths[0], widths[1]), (secants[0], secants[1]))];
    for i in 1..=last {
        let (before, after) = (secants[i - 1], secants[i]);
        let (left, right) = (
            2.0 * widths[i] + widths[i - 1],
            widths[i] + 2.0 * widths[i - 1],
        );
        slopes.push(match before * after > 0.0 {
            true => (left + right) / (left / before + right / after),
            false => 0.0,
        });
    }
    slopes.push(end_slope(
        (widths[last], widths[last - 1]),
        (secants[last], secants[last - 1]),
    ));
    slopes
}

/// The slope of a parabola through the outermost three points, held back where it would not be
/// monotone.
fn end_slope((outer, inner): (f64, f64), (at, next): (f64, f64)) -> f64 {
    let slope = ((2.0 * outer + inner) * at - outer * next) / (outer + inner);
    if slope * at <= 0.0 {
        0.0
    } else if at * next <= 0.0 && slope.abs() > 3.0 * at.abs() {
        3.0 * at
    } else {
        slope
    }
}
