//! How many zeros of (1) of the room lie outside a circle.

use num_complex::Complex64;

use super::SampledLoop;
use super::circle::{Circle, Junction, turned, value};
use super::on_circle::times;
use super::step::Quadratic;
use crate::linear::real_zeros::{
    At, MOST_STEPS, RealFunction, Search, TooMany, lowest_decided, zeros_from,
};
use crate::linear::rounded::Rounded;
use crate::model::elementary::{arg, exp, sincos};

/// Rounding errors that the sum of a gap gathers.
const ROUNDINGS: f64 = 32.0 * f64::EPSILON;

/// The sizes of z^m U and of V on a circle, the larger factor being 1.
#[derive(Debug, Clone, Copy)]
pub(super) struct Weights {
    of_u: f64,
    of_v: f64,
}

impl Weights {
    /// r^m and 1, or 1 and r^−m.
    pub(super) fn new(growth: f64, multiple: u64) -> Self {
        let growth = growth * multiple as f64;
        match growth <= 0.0 {
            true => Self {
                of_u: exp(growth),
                of_v: 1.0,
            },
            false => Self {
                of_u: 1.0,
                of_v: exp(-growth),
            },
        }
    }
}

/// The weighted sum of two quadratics.
fn sum((c, c_by): (Quadratic, f64), (d, d_by): (Quadratic, f64)) -> Quadratic {
    std::array::from_fn(|k| c_by * c[k] + d_by * d[k])
}

impl SampledLoop {
    /// How many zeros lie outside the circle with ln r = `growth`, at the delay of `multiple`
    /// sample times. Where there are too many angles to look at, the number is too large.
    pub(super) fn outside(&self, growth: f64, multiple: u64) -> u64 {
        let circle = Circle::new(growth);
        let weights = Weights::new(growth, multiple);
        let mut count = self.without_turns(&circle, weights);
        if self.grows_outside(&circle, weights) {
            count += multiple as i64;
        }
        let listed = self.each_junction(&circle, weights, |junction| {
            count += 2 * i64::from(junction.sign) * junction.passed(multiple as f64);
        });
        match listed {
            Ok(()) => count.max(0) as u64,
            Err(TooMany) => u64::MAX,
        }
    }

    /// Whether |V| is larger than r^m |U| at z = −r.
    pub(super) fn grows_outside(&self, circle: &Circle, weights: Weights) -> bool {
        let Weights { of_u, of_v } = weights;
        let [p, q] = [self.step.open, self.step.held].map(|c| circle.opposite(c));
        let sign = if self.late.is_multiple_of(2) {
            1.0
        } else {
            -1.0
        };
        let late = sign * exp(self.late as f64 * circle.growth) * p;
        (of_u * (late - q)).abs() < (of_v * (q - self.memory * late)).abs()
    }

    /// How many zeros r^m U + V has outside: by the same count over the exponent of the latency.
    fn without_turns(&self, circle: &Circle, weights: Weights) -> i64 {
        let Weights { of_u, of_v } = weights;
        let (open, held) = (self.step.open, self.step.held);
        let of_open = of_u - self.memory * of_v;
        let of_held = of_v - of_u;
        if self.late == 0 {
            return circle.outside(sum((open, of_open), (held, of_held))) as i64;
        }
        let late = self.late as f64;
        let of_open = of_open * exp(late * circle.growth);
        let u = open.map(|c| of_open * c);
        let v = held.map(|c| of_held * c);
        let mut count = circle.outside(sum((u, 1.0), (v, 1.0))) as i64;
        if circle.opposite(u).abs() < circle.opposite(v).abs() {
            count += self.late as i64;
        }
        circle.junctions(u, v, |junction| {
            count += 2 * i64::from(junction.sign) * junction.passed(late);
        });
        count
    }

    /// Visits the angles at which r^m |U| = |V|.
    ///
    /// # Errors
    /// When there are too many: with a latency of many samples.
    pub(super) fn each_junction(
        &self,
        circle: &Circle,
        weights: Weights,
        mut visit: impl FnMut(Junction),
    ) -> Result<(), TooMany> {
        let Weights { of_u, of_v } = weights;
        let (open, held) = (self.step.open, self.step.held);
        if self.late == 0 {
            let u = sum((open, of_u), (held, -of_u));
            let v = sum((held, of_v), (open, -self.memory * of_v));
            circle.junctions(u, v, visit);
            return Ok(());
        }
        let gap = Gap::new(self, circle, weights);
        let to = std::f64::consts::PI;
        let Some(here) = lowest_decided(&gap, to) else {
            return Ok(());
        };
        let search = Search { to, precision: 0.0 };
        zeros_from(&gap, here, search, &mut { MOST_STEPS }, |switch| {
            if switch.omega < to {
                let [u, v] = gap.sides(switch.omega);
                let size = u.norm_sqr().sqrt();
                visit(Junction {
                    angle: switch.omega,
                    angle_error: switch.error,
                    phase: turned(arg(-v * u.conj())),
                    phase_error: ROUNDINGS
                        + gap.steepness(switch.omega) * (switch.error + ROUNDINGS) / size,
                    sign: switch.sign,
                });
            }
            true
        })
    }
}

/// |r^m U|² − |V|² as a function of the angle, where there is a latency.
struct Gap<'l> {
    of: &'l SampledLoop,
    circle: Circle,
    weights: Weights,
    /// r^l.
    late_size: f64,
    /// The factors of |p|², |q|² and Re(z^l p q*).
    factors: [f64; 3],
}

impl<'l> Gap<'l> {
    fn new(of: &'l SampledLoop, circle: &Circle, weights: Weights) -> Self {
        let Weights { of_u, of_v } = weights;
        let late_size = exp(of.late as f64 * circle.growth);
        let difference = |memory: f64| (of_u - memory * of_v) * (of_u + memory * of_v);
        Self {
            of,
            circle: *circle,
            weights,
            late_size,
            factors: [
                difference(of.memory) * late_size * late_size,
                difference(1.0),
                -2.0 * (of_u * of_u - of.memory * of_v * of_v) * late_size,
            ],
        }
    }

    /// r^m U and V at an angle.
    fn sides(&self, angle: f64) -> [Complex64; 2] {
        let zeta = self.circle.zeta(angle);
        let [p, q] = [self.of.step.open, self.of.step.held].map(|c| value(c, zeta));
        let (sine, cosine) = sincos(self.of.late as f64 * angle);
        let late = Complex64::new(cosine, sine) * self.late_size * p;
        let Weights { of_u, of_v } = self.weights;
        [(late - q) * of_u, (q - late * self.of.memory) * of_v]
    }

    /// Bounds up to `angle` on |p|, |p′|, |p″| and on those of q, derivatives being those with
    /// respect to the angle.
    fn bounds(&self, angle: f64) -> [[f64; 3]; 2] {
        [self.of.step.open, self.of.step.held].map(|c| self.circle.bounds(c, angle))
    }

    /// A bound on how fast r^m U and V change with the angle, up to it.
    fn steepness(&self, angle: f64) -> f64 {
        let [p, q] = self.bounds(angle);
        let late = self.of.late as f64;
        let Weights { of_u, of_v } = self.weights;
        let of_late = self.late_size * (p[1] + late * p[0]);
        of_u * (of_late + q[1]) + of_v * (q[1] + self.of.memory.abs() * of_late)
    }
}

impl RealFunction for Gap<'_> {
    fn at(&self, angle: f64) -> At {
        let zeta = self.circle.zeta(angle);
        // dζ/dφ = i z.
        let turning = Complex64::i() * (zeta + 1.0);
        let [[p, p_slope], [q, q_slope]] = [self.of.step.open, self.of.step.held].map(|c| {
            let slope = (zeta * (2.0 * c[2]) + c[1]) * turning;
            [value(c, zeta), slope]
        });
        let late = self.of.late as f64;
        let (sine, cosine) = sincos(late * angle);
        let turn = Complex64::new(cosine, sine);
        let both = turn * p * q.conj();
        let slope =
            turn * (p_slope * q.conj() + p * q_slope.conj() + Complex64::i() * late * p * q.conj());
        let [of_p, of_q, of_both] = self.factors;
        let sizes = |c: Complex64, slope: Complex64| 2.0 * (c.conj() * slope).re;
        let value = Rounded::sum([of_p * p.norm_sqr(), of_q * q.norm_sqr(), of_both * both.re]);
        let blur = of_both.abs() * both.norm_sqr().sqrt() * (late * angle).max(1.0);
        At {
            omega: angle,
            value: value.plus_error(ROUNDINGS * blur + self.blur(angle)),
            slope: Rounded::sum([
                of_p * sizes(p, p_slope),
                of_q * sizes(q, q_slope),
                of_both * slope.re,
            ])
            .plus_error(ROUNDINGS * late.max(1.0) * blur),
        }
    }

    fn bend(&self, angle: f64) -> f64 {
        let [p, q] = self.bounds(angle);
        let late = self.of.late as f64;
        let of_square = |c: [f64; 3]| 2.0 * (c[1] * c[1] + c[0] * c[2]);
        let of_both = times(times(p, [1.0, late, late * late]), q)[2];
        let [a, b, c] = self.factors.map(f64::abs);
        a * of_square(p) + b * of_square(q) + c * of_both
    }
}

impl Gap<'_> {
    /// A bound on the rounding of the gap by that of p and q.
    fn blur(&self, angle: f64) -> f64 {
        let [p, q] = self.bounds(angle);
        let [a, b, c] = self.factors.map(f64::abs);
        ROUNDINGS * (a * p[0] * p[0] + b * q[0] * q[0] + c * p[0] * q[0])
    }
}
