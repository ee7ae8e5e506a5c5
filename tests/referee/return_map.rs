//! Control by the return map, of the referee's own: Φ and Γ by a series of a matrix, the velocity
//! from two readings, one step forward, and the feedback that ends in sliding after two.

use super::block::Block;
use super::setting::Setting;

type Matrix = [[f64; 3]; 3];

/// Halvings of the time for which the series is summed, and its terms.
const HALVINGS: u32 = 10;
const TERMS: u32 = 20;

fn product(a: &Matrix, b: &Matrix) -> Matrix {
    std::array::from_fn(|i| std::array::from_fn(|j| (0..3).map(|k| a[i][k] * b[k][j]).sum()))
}

/// e^(m h).
fn exponential(m: &Matrix, h: f64) -> Matrix {
    let h = h / f64::from(1 << HALVINGS);
    let one: Matrix = std::array::from_fn(|i| std::array::from_fn(|j| f64::from(u8::from(i == j))));
    let (mut sum, mut term) = (one, one);
    for k in 1..TERMS {
        term = product(&term, m).map(|row| row.map(|x| x * h / f64::from(k)));
        for (row, more) in sum.iter_mut().zip(&term) {
            for (x, more) in row.iter_mut().zip(more) {
                *x += more;
            }
        }
    }
    (0..HALVINGS).fold(sum, |e, _| product(&e, &e))
}

/// What the control knows of a block that slides at one v0.
struct Known {
    /// Of (ẋ − v0, a − a*, 1 for a change of the load by 1), after one sample time.
    step: Matrix,
    rest: f64,
}

impl Known {
    fn of(s: &Setting, v0: f64) -> Self {
        let piece = s.friction.piece(v0);
        let (mu, slope) = (
            s.friction.coefficient(piece, v0),
            s.friction.slope(piece, v0),
        );
        let damping = slope * s.load + s.damping + s.viscous;
        let m = s.mass;
        let rates = [
            [-damping / m, s.stiffness / m, -mu / m],
            [-1.0, 0.0, 0.0],
            [0.0; 3],
        ];
        Self {
            step: exponential(&rates, s.sample_time),
            rest: (mu * s.load + s.viscous * v0) / s.stiffness,
        }
    }

    /// The change of the load from the last two readings and the change between them.
    fn load(&self, before: f64, now: f64, then: f64) -> f64 {
        let [[p11, p12, g1], [p21, p22, g2], _] = self.step;
        let (before, now) = (before - self.rest, now - self.rest);
        let speed = (now - p22 * before - g2 * then) / p21;
        let speed = p11 * speed + p12 * before + g1 * then;
        // Twice on from here, without a change of the load.
        let once = [p11 * speed + p12 * now, p21 * speed + p22 * now];
        let twice = [p11 * once[0] + p12 * once[1], p21 * once[0] + p22 * once[1]];
        // ΦΓ δ + Γ δ′ = −twice: Cramer's rule for δ.
        let moved = [p11 * g1 + p12 * g2, p21 * g1 + p22 * g2];
        let determinant = moved[0] * g2 - moved[1] * g1;
        -(twice[0] * g2 - twice[1] * g1) / determinant
    }
}

/// b̃ of a block that slides at v0.
pub(super) fn damping(s: &Setting, v0: f64) -> f64 {
    let slope = s.friction.slope(s.friction.piece(v0), v0);
    (slope * s.load + s.damping + s.viscous) / (s.mass * s.stiffness).sqrt()
}

impl Block {
    /// Reads the elongation, and sets the load.
    pub(super) fn steer(&mut self) {
        let s = &self.setting;
        let t = self.next_reading();
        let mut wanted = 0.0;
        if self.signals.is_empty() {
            self.signals.push(0.0);
        } else {
            let v0 = self.map_of.unwrap_or_else(|| self.unperturbed(t).0);
            let known = Known::of(s, v0);
            let [before, now] = [t - s.sample_time, t].map(|t| self.past.at(t).0);
            wanted = known.load(before, now, self.held);
        }
        self.held = if wanted.abs() <= s.amplitude {
            wanted
        } else {
            0.0
        };
        self.signals.push(self.held);
        self.look_at_limits();
    }
}
