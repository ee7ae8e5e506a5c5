//! Crossings of an oscillator near its resonance, in the distance y = ω² − ω₀² from there: nothing
//! cancels, so that y keeps all digits of f64 however small it is. The crate works in ω instead.
//!
//! ```text
//! B = (−y + ibω) L,   F = (1 + R)|B|² − 2 Re(𝒜 B*),   −Q/P = (𝒜 − R B)/(𝒜 − B)
//! ```

use std::f64::consts::TAU;
use std::sync::LazyLock;

use num_complex::Complex64;

/// The controlled oscillator, dimensionless.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Oscillator {
    pub b: f64,
    pub a_v: f64,
    pub a_n: f64,
    pub memory: f64,
    /// T_a, T_v and T_s.
    pub lags: [f64; 3],
    pub latency: f64,
}

/// A crossing frequency, the phase in (0, 2π] and the way of the pair.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Crossing {
    pub omega: f64,
    pub theta: f64,
    pub sign: i64,
}

/// All crossings of a line, and the count as the delay goes to 0.
#[derive(Debug, Clone)]
pub(crate) struct Line {
    pub at_zero_delay: i64,
    pub crossings: Vec<Crossing>,
}

impl Line {
    /// n(τ), and the distance to the nearest change.
    pub(crate) fn count(&self, tau: f64) -> (i64, f64) {
        let (mut n, mut nearest) = (self.at_zero_delay, f64::INFINITY);
        for Crossing { omega, theta, sign } in &self.crossings {
            let passed = (tau * omega - theta) / TAU;
            n += 2 * sign * (passed.ceil().max(0.0) as i64);
            let branch = passed.round().max(0.0);
            nearest = nearest.min((tau - (theta + TAU * branch) / omega).abs());
        }
        (n, nearest)
    }
}

/// Places in the order of y > −1, denser by size where y is not small.
fn places() -> Vec<f64> {
    let small = (-75 * 8..-2 * 8).map(|k| 10_f64.powf(f64::from(k) / 8.0));
    let large = (0..480).map(|k| 0.01 * 1.02_f64.powi(k));
    let above: Vec<f64> = small.chain(large).collect();
    let below = above.iter().rev().map(|y| -y).filter(|y| *y > -0.9999);
    below.chain([0.0]).chain(above.iter().copied()).collect()
}

impl Oscillator {
    /// 𝒜 L* and |L|² at y.
    fn fed(&self, omega: f64) -> (Complex64, f64) {
        let at = |lag: f64| Complex64::new(1.0, lag * omega);
        let [load, velocity, sensor] = self.lags.map(at);
        let gain = self.a_n * velocity + self.a_v * Complex64::new(self.b, omega) * load;
        let late = match self.latency {
            0.0 => Complex64::ONE,
            latency => Complex64::cis(-omega * latency),
        };
        let all = load * velocity * sensor;
        (gain * late * all.conj(), all.norm_sqr())
    }

    /// F, and how large its terms are.
    fn modulus(&self, y: f64) -> (f64, f64) {
        let x = 1.0 + y;
        let omega = x.sqrt();
        let (g, l) = self.fed(omega);
        let terms = [
            (1.0 + self.memory) * l * (y * y + self.b * self.b * x),
            2.0 * g.re * y,
            -2.0 * g.im * self.b * omega,
        ];
        let size: f64 = terms.iter().map(|t| t.abs()).sum();
        (terms.iter().sum(), size)
    }

    fn theta(&self, y: f64) -> f64 {
        let omega = (1.0 + y).sqrt();
        let (g, l) = self.fed(omega);
        let own = l * (y * y + self.b * self.b * (1.0 + y));
        let along = -g.re * y + g.im * self.b * omega;
        let re = g.norm_sqr() / l + self.memory * own - (1.0 + self.memory) * along;
        let im = (1.0 - self.memory) * (g.im * y + g.re * self.b * omega);
        let angle = im.atan2(re);
        if angle > 0.0 { angle } else { angle + TAU }
    }

    /// The zero between two places with different signs.
    fn zero(&self, mut low: f64, mut high: f64) -> f64 {
        let rises = self.modulus(high).0 > 0.0;
        for _ in 0..400 {
            // By size, where both are of one sign.
            let middle = if low * high > 0.0 {
                low.signum() * (low * high).sqrt()
            } else {
                0.5 * (low + high)
            };
            if middle == low || middle == high {
                break;
            }
            match (self.modulus(middle).0 > 0.0) == rises {
                true => high = middle,
                false => low = middle,
            }
        }
        high
    }

    /// The place nearest to 0 of |F| between two others.
    fn lowest(&self, [mut low, _, mut high]: [f64; 3]) -> f64 {
        for _ in 0..120 {
            let (a, b) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
            match self.modulus(a).0.abs() < self.modulus(b).0.abs() {
                true => high = b,
                false => low = a,
            }
            if (self.modulus(a).0 > 0.0) != (self.modulus(high).0 > 0.0) {
                return a;
            }
        }
        0.5 * (low + high)
    }

    /// The crossings; none where two of them are too near to one another to tell, b being known to
    /// its own digits only.
    pub(crate) fn line(&self) -> Option<Line> {
        static PLACES: LazyLock<Vec<f64>> = LazyLock::new(places);
        let places = &*PLACES;
        let values: Vec<f64> = places.iter().map(|y| self.modulus(*y).0).collect();
        assert!(*values.last().unwrap() > 0.0, "beyond all zeros: {self:?}");
        let mut zeros = Vec::new();
        for i in 0..places.len() - 1 {
            let same = |j: usize| (values[j] > 0.0) == (values[i] > 0.0);
            if !same(i + 1) {
                zeros.push(self.zero(places[i], places[i + 1]));
            } else if i > 0 && same(i - 1) {
                let near = values[i].abs();
                if near > values[i - 1].abs() || near > values[i + 1].abs() {
                    continue;
                }
                let between = self.lowest([places[i - 1], places[i], places[i + 1]]);
                let (value, size) = self.modulus(between);
                if value.abs() < 1e-9 * size {
                    return None;
                }
                if (value > 0.0) != (values[i] > 0.0) {
                    zeros.push(self.zero(places[i - 1], between));
                    zeros.push(self.zero(between, places[i + 1]));
                }
            }
        }
        zeros.sort_by(|a, b| b.total_cmp(a));
        let crossings = zeros.iter().enumerate().map(|(i, &y)| Crossing {
            omega: (1.0 + y).sqrt(),
            theta: self.theta(y),
            sign: if i % 2 == 0 { 1 } else { -1 },
        });
        Some(Line {
            at_zero_delay: if self.b < 0.0 { 2 } else { 0 },
            crossings: crossings.collect(),
        })
    }
}

/// P = s² + c₁s + c₀ and Q = q₀ + q₁s.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Weak {
    pub p: [f64; 2],
    pub q: [f64; 2],
}

impl Weak {
    /// The crossings from y² + ey + (e c₀ − q₀²) = 0, e = c₁² − q₁²; none where two of them are too
    /// near to one another.
    pub(crate) fn line(&self) -> Option<Line> {
        let ([c0, c1], [q0, q1]) = (self.p, self.q);
        let e = (c1 - q1) * (c1 + q1);
        let terms = [0.25 * e * e, -e * c0, q0 * q0];
        let size: f64 = terms.iter().map(|t| t.abs()).sum();
        let discriminant: f64 = terms.iter().sum();
        if discriminant.abs() < 1e-9 * size {
            return None;
        }
        let mut line = Line {
            at_zero_delay: if c1 + q1 < 0.0 { 2 } else { 0 },
            crossings: Vec::new(),
        };
        if discriminant < 0.0 {
            return Some(line);
        }
        let root = discriminant.sqrt();
        let large = -0.5 * e - root.copysign(e);
        let small = (e * c0 - q0 * q0) / large;
        for (sign, y) in [(1, large.max(small)), (-1, large.min(small))] {
            let x = c0 + y;
            if x <= 0.0 {
                continue;
            }
            let omega = x.sqrt();
            let angle = (omega * (q0 * c1 + q1 * y)).atan2(q0 * y - q1 * c1 * x);
            line.crossings.push(Crossing {
                omega,
                theta: if angle > 0.0 { angle } else { angle + TAU },
                sign,
            });
        }
        Some(line)
    }
}
