//! Real functions of the frequency in which one delay swings, and all their zeros.
//!
//! ```text
//! f(ω) = u(x) + v(x)(1 − cos ωt) + ω w(x) sin ωt,   x = ω²                                   (1)
//! ```

use super::super::polynomial::Polynomial;
use super::super::switches::Switches;
use super::prepared::Prepared;
use super::window::Window;
use crate::linear::real_zeros::{
    At, MOST_STEPS, RealFunction, Search, Switch, TooMany, lowest_decided, zeros_from,
};
use crate::linear::rounded::Rounded;
use crate::model::elementary::power;

/// The function (1).
#[derive(Debug, Clone, Copy)]
pub(crate) struct Wave {
    /// u, v and w.
    pub parts: [Polynomial; 3],
    /// t ≥ 0.
    pub t: f64,
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
        found: impl FnMut(Switch) -> bool,
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
        zeros_from(&prepared, here, Search { to, precision }, left, found)?;
        Ok(start)
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
        let here = lowest_decided(prepared, window.to).ok_or(TooMany)?;
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
