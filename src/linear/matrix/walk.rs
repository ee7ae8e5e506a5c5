//! The number of roots right of a line by the argument of det M around a rectangle: it shares
//! nothing with the crossings, and takes longer.

use std::f64::consts::PI;

use num_complex::Complex64;

use super::MatrixSystem;
use super::dense::Matrix;
use super::rightmost::delayed;
use crate::linear::general::RightOf;
use crate::model::elementary::{arg, exp, norm};

/// By how much ln det M may change in a step, by its slope at both ends.
const FARTHEST: f64 = 0.5;
/// Steps after which nothing is said.
const MOST_STEPS: u32 = 100_000;
/// Powers of D that are summed for a bound.
const POWERS: u32 = 2000;

impl MatrixSystem {
    /// How many roots lie right of Re λ = `line` at the delay `tau` ≥ 0, by the argument.
    pub(super) fn walked(&self, tau: f64, line: f64) -> RightOf {
        let number = self.radius(tau, line).and_then(|radius| {
            let far = 1.1 * radius.max(line.abs());
            let corners = [
                Complex64::new(far, 0.0),
                Complex64::new(far, far),
                Complex64::new(line, far),
                Complex64::new(line, 0.0),
            ];
            let mut steps = 0;
            let sides = corners.windows(2);
            let turned: Option<Vec<f64>> = sides
                .map(|side| self.turned(tau, side[0], side[1], &mut steps))
                .collect();
            Some(turned?.iter().sum::<f64>() / PI)
        });
        match number {
            Some(halves) if (halves - halves.round()).abs() < 1e-3 && halves > -0.5 => {
                RightOf::Roots(halves.round() as u64)
            }
            _ => RightOf::Undecided,
        }
    }

    /// By how much the argument of det M grows from one point to another.
    fn turned(&self, tau: f64, from: Complex64, to: Complex64, steps: &mut u32) -> Option<f64> {
        let length = norm(to - from);
        let along = (to - from) / length;
        let at = |gone: f64| {
            let lambda = from + along * gone;
            let slopes = self.slopes(lambda, delayed(lambda, tau)?)?;
            let slope = norm(slopes.along_lambda - tau * slopes.along_z);
            (slopes.rounding < FARTHEST).then_some((slopes.turn, slope))
        };
        let (mut gone, mut turned) = (0.0, 0.0);
        let (mut here, mut slope) = at(0.0)?;
        let mut step: f64 = 0.05 * length;
        while gone < length {
            *steps += 1;
            if *steps > MOST_STEPS {
                return None;
            }
            step = step.min(FARTHEST / slope).min(length - gone);
            let (there, next) = at(gone + step)?;
            if step * next > 2.0 * FARTHEST {
                // The function changes faster there.
                step *= 0.5;
                if step <= 1e-14 * length {
                    return None;
                }
                continue;
            }
            turned += arg(there * here.conj());
            gone += step;
            if length - gone <= 1e-15 * length {
                break;
            }
            (here, slope, step) = (there, next, 2.0 * step);
        }
        Some(turned)
    }

    /// A radius within which every root right of `line` lies: |λ| ≤ ‖A‖ + |z| ‖B‖ ‖(1 − z D)⁻¹‖
    /// ‖C‖. None where there is none.
    fn radius(&self, tau: f64, line: f64) -> Option<f64> {
        let late = exp(-line * tau);
        let size = |of: &Matrix| {
            let row = |i: usize| (0..of.columns()).map(|j| of.at(i, j).abs()).sum();
            (0..of.rows()).map(row).fold(0.0, f64::max)
        };
        let neutral = self.d.mapped(|value| late * value);
        let (mut power, mut sum) = (Matrix::unit(self.signals()), 0.0);
        for _ in 0..POWERS {
            let next = size(&power);
            if next == 0.0 {
                break;
            }
            sum += next;
            power = power.times(&neutral);
        }
        if size(&power) > 1e-6 {
            return None;
        }
        let radius = size(&self.a) + late * size(&self.b) * 2.0 * sum * size(&self.c);
        radius.is_finite().then_some(radius.max(f64::MIN_POSITIVE))
    }
}
