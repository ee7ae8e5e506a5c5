//! Real functions of the frequency in which one delay swings, and all their zeros.
//!
//! ```text
//! f(ω) = u(x) + v(x)(1 − cos ωt) + ω w(x) sin ωt,   x = ω²                                   (1)
//! ```
//!
//! The zeros are found by going along ω in steps that nothing can be hidden in. With M ≥ |f″| from
//! absolute coefficients up to the end of a step h from ω, there is
//!
//! ```text
//! no zero             where |f| − h max(0, −sgn(f) f′) − M h²/2 > 0,                         (2)
//! at most one zero    where |f′| > M h.                                                      (3)
//! ```
//!
//! The longer of the two steps is taken: one evaluation a step. Where both come to nothing the sign
//! of f is lost in rounding, as at a touch. Such a stretch is told as it is, with the signs of f on
//! both sides.

use super::super::polynomial::{MOST_DEGREE, Polynomial};
use super::super::switches::{Switch, Switches, direction};
use crate::linear::rounded::Rounded;
use crate::model::elementary::{power, rough_root, sincos};

/// Steps after which the zeros are too many to be listed.
const MOST_STEPS: usize = 1 << 17;
/// Rounded operations behind each value, in units of ε of its terms.
const ROUNDINGS: f64 = 4.0;
/// A step is never more than so many times as long as the one before it: the bound M belongs to its
/// end.
const GROWTH: f64 = 2.0;
/// Part of the way to the last zero that the first step is tried with.
const FIRST_STEP: f64 = 1.0 / 16.0;
/// Steps shorter than this part of ω lead nowhere.
const SHORTEST_STEP: f64 = 1e-13;
/// What rounding of the length of a step itself may add to it.
const A_LITTLE_LESS: f64 = 1.0 - 1e-9;
/// Steps of Newton's method, with halvings between, until a zero is polished.
const MOST_POLISHINGS: usize = 100;
/// Nearer to the largest zero of a polynomial in steps of this factor.
const NEARER: f64 = 0.7;
/// Halvings of ω from the last zero down until the sign of f near 0 is known.
const MOST_HALVINGS: i32 = 60;

/// The function (1).
#[derive(Debug, Clone, Copy)]
pub(crate) struct Wave {
    /// u, v and w.
    pub parts: [Polynomial; 3],
    /// t ≥ 0.
    pub t: f64,
}

/// A range of frequencies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Window {
    pub from: f64,
    pub to: f64,
}

/// The zeros are too many to be listed, or their number is open.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct TooMany;

const VALUES: usize = 6;
const ERRORS: usize = 5;
const BENDS: usize = 2;
const LENGTH: usize = MOST_DEGREE + 1;

/// The coefficients of all that is evaluated at one frequency, side by side.
struct Prepared {
    /// u, v, w; u′/ω, v′/ω and (ωw)′.
    values: [[f64; VALUES]; LENGTH],
    /// Bounds on the errors of u, v and w; the even and the odd part of one on the error of f′.
    errors: [[f64; ERRORS]; LENGTH],
    /// The even and the odd part of M.
    bends: [[f64; BENDS]; LENGTH],
    length: usize,
    t: f64,
}

/// f and f′ at one frequency with bounds on their errors.
#[derive(Debug, Clone, Copy)]
struct At {
    omega: f64,
    value: Rounded,
    slope: Rounded,
}

impl At {
    /// The sign of f, or none where it is lost.
    #[inline]
    fn sign(&self) -> Option<bool> {
        self.value.decided().then_some(self.value.value > 0.0)
    }
}

#[inline]
fn horner<const N: usize>(coefficients: &[[f64; N]], x: f64) -> [f64; N] {
    let mut sum = [0.0; N];
    for c in coefficients.iter().rev() {
        for (sum, c) in sum.iter_mut().zip(c) {
            *sum = *sum * x + c;
        }
    }
    sum
}

impl Prepared {
    fn new(wave: &Wave) -> Self {
        let degree = wave.parts.iter().map(Polynomial::degree).max().unwrap_or(0);
        let mut prepared = Self {
            values: [[0.0; VALUES]; LENGTH],
            errors: [[0.0; ERRORS]; LENGTH],
            bends: [[0.0; BENDS]; LENGTH],
            length: degree + 1,
            t: wave.t,
        };
        let t = wave.t;
        let unit = (ROUNDINGS + 2.0 * degree as f64) * f64::EPSILON;
        let coefficient = |part: usize, k: usize| match k {
            k if k <= degree => wave.parts[part].coefficient(k),
            _ => Rounded {
                value: 0.0,
                error: 0.0,
            },
        };
        for k in 0..=degree {
            let [u, v, w] = [0, 1, 2].map(|part| coefficient(part, k));
            let [next_u, next_v, next_w] = [0, 1, 2].map(|part| coefficient(part, k + 1));
            let (even, odd) = (2.0 * (k + 1) as f64, (2 * k + 1) as f64);
            prepared.values[k] = [
                u.value,
                v.value,
                w.value,
                even * next_u.value,
                even * next_v.value,
                odd * w.value,
            ];
            let error = |c: Rounded| c.error + unit * c.value.abs();
            let size = |c: Rounded| c.error + c.value.abs();
            prepared.errors[k] = [
                error(u),
                error(v),
                error(w),
                t * error(v) + odd * error(w),
                even * (error(next_u) + 2.0 * error(next_v)) + t * error(w),
            ];
            prepared.bends[k] = [
                // Of (u + v) − v cos ωt.
                even * odd
                    * ((next_u.value + next_v.value).abs()
                        + next_u.error
                        + next_v.error
                        + size(next_v))
                    + t * (t * size(v) + 2.0 * odd * size(w)),
                2.0 * even * t * size(next_v) + even * (odd + 2.0) * size(next_w) + t * t * size(w),
            ];
        }
        prepared
    }

    #[inline]
    fn at(&self, omega: f64) -> At {
        let x = omega * omega;
        let [u, v, w, u_slope, v_slope, w_slope] = horner(&self.values[..self.length], x);
        let errors = horner(&self.errors[..self.length], x);
        let angle = omega * self.t;
        let (half_sin, half_cos) = sincos(0.5 * angle);
        let (versine, sin) = (2.0 * half_sin * half_sin, 2.0 * half_sin * half_cos);
        let cos = 1.0 - versine;
        let value = u + v * versine + omega * w * sin;
        let slope = omega * (u_slope + v_slope * versine)
            + (v * self.t + w_slope) * sin
            + omega * w * self.t * cos;
        // The angle is rounded as well.
        let turned = f64::EPSILON * angle;
        let error = errors[0]
            + errors[1] * versine
            + omega * errors[2] * sin.abs()
            + turned * (v.abs() * sin.abs() + omega * w.abs() * cos.abs());
        let slope_error = errors[3] + omega * errors[4] + turned * self.bend(omega);
        At {
            omega,
            value: Rounded { value, error },
            slope: Rounded {
                value: slope,
                error: slope_error,
            },
        }
    }

    /// M up to `omega`.
    #[inline]
    fn bend(&self, omega: f64) -> f64 {
        let [even, odd] = horner(&self.bends[..self.length], omega * omega);
        even + omega * odd
    }

    /// A step from `from` within which f has one zero at most, no longer than `longest`, and
    /// whether it can have one.
    #[inline]
    fn step(&self, from: &At, longest: f64) -> (f64, bool) {
        let bend = self.bend(from.omega + longest);
        let left = from.value.value.abs() - from.value.error;
        let falling = -from
            .slope
            .value
            .copysign(from.slope.value * from.value.value);
        let falling = falling + from.slope.error;
        let root = (falling * falling + 2.0 * bend * left).sqrt();
        let clear = if falling > 0.0 {
            2.0 * left / (falling + root)
        } else {
            (root - falling) / bend
        };
        let monotone = (from.slope.value.abs() - from.slope.error) / bend;
        if clear >= monotone {
            (A_LITTLE_LESS * clear, false)
        } else {
            (A_LITTLE_LESS * monotone, true)
        }
    }

    /// The zero between `from` and `to`, at which the signs of f differ, f being monotone between;
    /// with a bound on its error.
    fn polish(&self, from: &At, to: &At, precision: f64) -> (f64, f64) {
        let rising = to.value.value > 0.0;
        let (mut low, mut high) = (from.omega, to.omega);
        let start = if from.value.value.abs() < to.value.value.abs() {
            from
        } else {
            to
        };
        let mut at = *start;
        let mut last = f64::INFINITY;
        for _ in 0..MOST_POLISHINGS {
            let newton = at.omega - at.value.value / at.slope.value;
            let step = (newton - at.omega).abs();
            let inside = low < newton && newton < high && step < 0.5 * last;
            if inside && step <= precision.max(4.0 * f64::EPSILON) * at.omega {
                break;
            }
            let next = if inside { newton } else { 0.5 * (low + high) };
            last = if inside { step } else { high - low };
            if next <= low || next >= high {
                break;
            }
            at = self.at(next);
            if (at.value.value > 0.0) == rising {
                high = next;
            } else {
                low = next;
            }
            if !at.value.decided() {
                break;
            }
        }
        (at.omega, self.error(&at, (from.omega, to.omega)))
    }

    /// How far the zero in the range of a monotone f can be from where `at` is.
    fn error(&self, at: &At, (from, to): (f64, f64)) -> f64 {
        let above = at.value.value.abs() + at.value.error;
        let slope = at.slope.value.abs() - at.slope.error;
        let near = 2.0 * above / slope;
        // With |f′| at least half of what it is here, the zero is no farther than that.
        let error = if near > 0.0 && self.bend(at.omega + near) * near <= 0.5 * slope {
            near
        } else {
            (to - at.omega).max(at.omega - from)
        };
        error + f64::EPSILON * at.omega
    }
}

/// A part of the way from one known sign of f to the next.
struct Way<'p> {
    prepared: &'p Prepared,
    /// The last place with a known sign.
    here: At,
    step: f64,
    to: f64,
    precision: f64,
}

impl Way<'_> {
    /// Goes one step on; the switch that lies in it, if one does.
    fn go(&mut self) -> Option<Switch> {
        let from = self.here;
        let longest = GROWTH * self.step;
        let (step, monotone) = self.prepared.step(&from, longest);
        let step = step.min(longest);
        if step < SHORTEST_STEP * from.omega {
            return self.leap(&from);
        }
        for part in [1.0, 0.9, 0.77, 0.6, 0.4] {
            let omega = from.omega + part * step;
            let there = self.prepared.at(omega);
            let Some(sign) = there.sign() else { continue };
            self.here = there;
            self.step = part * step;
            let before = from.value.value > 0.0;
            if sign == before {
                return None;
            }
            if monotone {
                let (omega, error) = self.prepared.polish(&from, &there, self.precision);
                return Some(Switch {
                    omega,
                    error,
                    sign: direction(before, sign),
                    simple: true,
                });
            }
            return Some(between(&from, &there));
        }
        self.leap(&from)
    }

    /// Over a stretch on which the sign of f is lost.
    fn leap(&mut self, from: &At) -> Option<Switch> {
        let mut step = SHORTEST_STEP * from.omega.max(1e-3 * self.to);
        loop {
            let there = self.prepared.at(from.omega + step);
            if there.value.decided() {
                self.here = there;
                self.step = step;
                return Some(between(from, &there));
            }
            if there.omega > self.to {
                // Beyond the last zero: its sign is that of the highest coefficient.
                self.here = there;
                self.step = step;
                let mut end = there;
                end.value.value = 1.0;
                return Some(between(from, &end));
            }
            step *= 1.5;
        }
    }
}

/// All that may lie between two places with known signs of f, as one switch.
fn between(from: &At, to: &At) -> Switch {
    let omega = 0.5 * (from.omega + to.omega);
    Switch {
        omega,
        error: 0.5 * (to.omega - from.omega) + f64::EPSILON * omega,
        sign: direction(from.value.value > 0.0, to.value.value > 0.0),
        simple: false,
    }
}

/// What is known of f near 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Start {
    /// The sign of f right of 0; none where it is open.
    pub positive: Option<bool>,
    /// Below this frequency there may be zeros that are not told.
    pub open_below: f64,
}

impl Wave {
    /// Tells `found` the positive zeros in the window by rising frequency, each to `precision`,
    /// relative, or to rounding where that is 0; f must be positive beyond it. f(0) is taken for 0
    /// where it may be 0. `found` ends the search by returning false.
    ///
    /// # Errors
    /// When there are too many, or `found` ended it.
    pub(crate) fn zeros(
        &self,
        window: Window,
        precision: f64,
        mut found: impl FnMut(Switch) -> bool,
    ) -> Result<Start, TooMany> {
        let Window { from, to } = window;
        if to == 0.0 || (from >= to && self.parts[0].coefficient(0).value > 0.0) {
            return Ok(Start {
                positive: Some(true),
                open_below: 0.0,
            });
        }
        let prepared = Prepared::new(self);
        let (here, start) = self.start(&prepared, window)?;
        let mut way = Way {
            prepared: &prepared,
            here,
            step: 0.5 * FIRST_STEP * (to - here.omega),
            to,
            precision,
        };
        for _ in 0..MOST_STEPS {
            if way.here.omega >= to {
                return Ok(start);
            }
            if let Some(switch) = way.go()
                && !found(switch)
            {
                return Err(TooMany);
            }
        }
        Err(TooMany)
    }

    /// As [`Wave::zeros`], all of them in a list by falling frequency.
    pub(crate) fn switches(&self, window: Window, switches: &mut Switches) -> Result<(), TooMany> {
        switches.list.clear();
        let start = self.zeros(window, 0.0, |switch| {
            switches.list.push(switch);
            true
        })?;
        switches.list.reverse();
        switches.at_zero = start.positive;
        switches.open_below = start.open_below;
        Ok(())
    }

    /// The first place with a known sign: 0 itself, or the lowest one found.
    fn start(&self, prepared: &Prepared, window: Window) -> Result<(At, Start), TooMany> {
        let constant = self.parts[0].coefficient(0);
        if constant.decided() {
            let start = Start {
                positive: Some(constant.value > 0.0),
                open_below: 0.0,
            };
            let first = prepared.at(window.from);
            if window.from > 0.0 && first.sign() == start.positive {
                return Ok((first, start));
            }
            let mut here = prepared.at(0.0);
            here.value = constant;
            return Ok((here, start));
        }
        // f = f(0) + c ω² to third order.
        let curvature = self.curvature();
        let lowest = (0..=MOST_HALVINGS)
            .rev()
            .map(|halvings| prepared.at(window.to * power(0.5, halvings)))
            .find(|here| here.value.decided());
        let here = lowest.ok_or(TooMany)?;
        let third = self.third(here.omega);
        let size = curvature.value.abs() - curvature.error;
        let parabola = size > 0.0 && third * here.omega <= 3.0 * size;
        let same = (curvature.value > 0.0) == (here.value.value > 0.0);
        let start = Start {
            positive: (parabola && same).then_some(curvature.value > 0.0),
            // An exact 0 with a parabola from there has no zeros but itself.
            open_below: if parabola && same && constant.value == 0.0 && constant.error == 0.0 {
                0.0
            } else {
                here.omega
            },
        };
        Ok((here, start))
    }

    /// f″(0)/2 = u₁ + v₀ t²/2 + w₀ t.
    fn curvature(&self) -> Rounded {
        let [u, v, w] = self.parts;
        let (first, v, w) = (u.coefficient(1), v.coefficient(0), w.coefficient(0));
        let half = 0.5 * self.t * self.t;
        Rounded::sum([first.value, half * v.value, self.t * w.value])
            .plus_error(first.error + half * v.error + self.t * w.error)
    }

    /// A bound on |f‴| up to `omega`.
    fn third(&self, omega: f64) -> f64 {
        let t = self.t;
        // The derivative of order m of |c| ωⁿ.
        let derivative = |part: usize, shift: usize, m: u32| -> f64 {
            let polynomial = &self.parts[part];
            (0..=polynomial.degree())
                .map(|k| {
                    let n = (2 * k + shift) as u32;
                    if n < m {
                        return 0.0;
                    }
                    let c = polynomial.coefficient(k);
                    let falling: f64 = (0..m).map(|i| f64::from(n - i)).product();
                    falling * (c.value.abs() + c.error) * power(omega, (n - m) as i32)
                })
                .sum()
        };
        let wave = |part: usize, shift: usize| -> f64 {
            // By Leibniz' rule, with 1 − cos ≤ 2.
            2.0 * derivative(part, shift, 3)
                + 3.0 * t * derivative(part, shift, 2)
                + 3.0 * t * t * derivative(part, shift, 1)
                + t * t * t * derivative(part, shift, 0)
        };
        derivative(0, 0, 3) + wave(1, 0) + wave(2, 1)
    }
}

/// A frequency below which `f`, a polynomial in x = ω² that is positive at 0, has no zero; a good
/// one.
pub(crate) fn before_zeros(f: &Polynomial) -> f64 {
    let n = f.degree();
    1.0 / beyond_zeros(&Polynomial::of(n, |k| f.coefficient(n - k)))
}

/// A frequency beyond which `f`, a polynomial in x = ω² with a positive highest coefficient, has no
/// zero; a good one.
pub(crate) fn beyond_zeros(f: &Polynomial) -> f64 {
    let n = f.degree();
    let leading = f.leading().value - f.leading().error;
    // Kioustelidis: twice the largest (−c_k/c_n)^(1/(n − k)).
    let bound = (0..n)
        .map(|k| (k, f.coefficient(k)))
        .map(|(k, c)| (n - k, c.error - c.value))
        .filter(|(_, c)| *c > 0.0)
        .map(|(order, c)| rough_root(c / leading, order))
        .fold(0.0, f64::max);
    if bound == 0.0 {
        return 0.0;
    }
    let mut lowest = [0.0; LENGTH];
    for (k, lowest) in lowest[..=n].iter_mut().enumerate() {
        *lowest = f.coefficient(k).value - f.coefficient(k).error;
    }
    let mut x = 2.0 * bound * (1.0 + 1e-6);
    for _ in 0..MOST_HALVINGS {
        if !positive_beyond(&lowest[..=n], NEARER * x) {
            break;
        }
        x *= NEARER;
    }
    x.sqrt() * (1.0 + 1e-12)
}

/// By Budan's theorem a polynomial has no zero beyond `x` where all its Taylor coefficients are
/// positive there.
fn positive_beyond(coefficients: &[f64], x: f64) -> bool {
    let mut taylor = [0.0; LENGTH];
    let n = coefficients.len() - 1;
    taylor[..=n].copy_from_slice(coefficients);
    // Rounding is far less than this part of the sizes.
    let size = coefficients
        .iter()
        .rev()
        .fold(0.0, |sum, c| sum * x + c.abs());
    for low in 0..=n {
        for k in (low..n).rev() {
            taylor[k] += x * taylor[k + 1];
        }
        // Times xᵏ all of them are of one size.
        if taylor[low] * power(x, low as i32) <= 1e-12 * size {
            return false;
        }
    }
    true
}
