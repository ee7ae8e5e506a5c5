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

use super::super::polynomial::Polynomial;
use super::super::switches::{Switch, Switches, direction};
use super::prepared::{At, Prepared};
use super::window::Window;
use crate::linear::rounded::Rounded;
use crate::model::elementary::power;

/// Steps after which the zeros are too many to be listed.
pub(super) const MOST_STEPS: u64 = 1 << 17;
/// A step is at most this many times as long as the step before: the bound M belongs to its end.
const GROWTH: f64 = 2.0;
/// The part of the way to the last zero that is tried as the first step.
const FIRST_STEP: f64 = 1.0 / 16.0;
/// Steps shorter than this part of ω lead nowhere.
const SHORTEST_STEP: f64 = 1e-13;
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

/// The zeros are too many to be listed, or their number is open.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct TooMany;

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

    /// Goes over a stretch on which the sign of f is lost.
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
    /// The frequency below which there may be zeros that are not told.
    pub open_below: f64,
}

impl Wave {
    /// Tells `found` the positive zeros in the window by rising frequency, each to `precision`,
    /// relative, or to rounding where that is 0; f must be positive beyond it. f(0) is taken for 0
    /// where it may be 0. `found` ends the search by returning false. `left` is how many steps may
    /// be taken, less by those that were.
    ///
    /// # Errors
    /// When there are too many, or `found` ended it.
    pub(crate) fn zeros(
        &self,
        window: Window,
        (precision, left): (f64, &mut u64),
        mut found: impl FnMut(Switch) -> bool,
    ) -> Result<Start, TooMany> {
        let Window { from, to } = window;
        if to == 0.0 || (from >= to && self.parts[0].coefficient(0).value > 0.0) {
            return Ok(Start {
                positive: Some(true),
                open_below: 0.0,
            });
        }
        let prepared = Prepared::new(&self.parts, self.t);
        let (here, start) = self.start(&prepared, window)?;
        let mut way = Way {
            prepared: &prepared,
            here,
            step: 0.5 * FIRST_STEP * (to - here.omega),
            to,
            precision,
        };
        while *left > 0 {
            if way.here.omega >= to {
                return Ok(start);
            }
            *left -= 1;
            if let Some(switch) = way.go()
                && !found(switch)
            {
                return Err(TooMany);
            }
        }
        Err(TooMany)
    }

    /// Lists all positive zeros in the window by falling frequency; see [`Wave::zeros`].
    pub(crate) fn switches(&self, window: Window, switches: &mut Switches) -> Result<(), TooMany> {
        switches.list.clear();
        let start = self.zeros(window, (0.0, &mut { MOST_STEPS }), |switch| {
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
