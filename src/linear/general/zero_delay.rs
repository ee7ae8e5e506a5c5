//! How many roots are unstable as the delay goes to 0: n(0⁺) of (5) in [`line`](super::line).

use std::f64::consts::PI;

use num_complex::Complex64;

use super::line::{DelayLine, Passage};
use super::polynomial::Polynomial;
use super::right_of::RootCounter;
use super::routh::zeros_on_the_right;
use super::switches::NearZero;
use super::system::System;
use super::turning::Turning;
use super::zeros::Zeros;
use crate::linear::count::MarginalTolerance;
use crate::linear::crossing::{Crossing, Direction};
use crate::linear::newton::divide;
use crate::linear::rounded::Rounded;

/// Delays tried for a count by (7) of `right_of` where P + Q leaves n(0⁺) open.
const TRIES: usize = 40;

impl DelayLine {
    /// Finds n(0⁺), with what zeros of P + Q on the axis or at the origin make of it. `settled`
    /// where every phase is known to be no 0 that may be 2π.
    pub(super) fn find_start(
        &mut self,
        system: &System,
        near: NearZero,
        (origin, settled): (bool, bool),
    ) {
        let mut sum = system.without_delay();
        let left_out = system.leaves_origin_out();
        if origin || left_out {
            self.find_passage(system, near);
        }
        // Such a system has divided its sum by λ already.
        let passes_at_zero = self.passage.is_some_and(|p| p.tau.abs() <= p.error);
        if (origin && !left_out) || (left_out && passes_at_zero) {
            sum = sum.divided_by_variable();
        }
        let decided = self.count_right(system, &sum);
        self.at_zero_delay = self.without_delay;
        if let Some(passage) = self.passage {
            if passage.tau.abs() <= passage.error && passage.change > 0 {
                self.at_zero_delay += 1;
            }
            if passage.tau <= passage.error {
                self.passage = None;
            }
        }
        let known = decided
            && match self.marginal_at_zero {
                true => self.start_on_axis(system, &sum),
                false => settled,
            };
        if !known {
            self.start_by_count(RootCounter::new(system).unstable());
        }
        self.marginal_at_zero |= left_out && passes_at_zero;
    }

    /// Finds where a real root passes 0: at τ* = (p₁ + q₁)/q₀, to the right where F(0⁺) > 0.
    fn find_passage(&mut self, system: &System, near: NearZero) {
        let slope = Rounded::sum([system.p.coefficient(1).value, system.q.coefficient(1).value])
            .plus_error(system.p.coefficient(1).error + system.q.coefficient(1).error);
        let q0 = system.q.coefficient(0);
        let tau = slope.value / q0.value;
        let error = (slope.error + tau.abs() * q0.error) / q0.value.abs();
        let error = error + f64::EPSILON * tau.abs();
        if tau > error && !system.on_axis().modulus().coefficient(1).decided() {
            // F has a double zero at 0, and D a triple one at τ*: a pair comes and goes there, too.
            self.uncounted = true;
            return;
        }
        if let (Some(positive), true) = (near.sign, tau.is_finite()) {
            self.passage = Some(Passage {
                tau,
                error,
                change: if positive { 1 } else { -1 },
            });
        }
    }

    /// Counts the zeros of P + Q right of the axis, and notes whether some may lie on it. False
    /// where that is open.
    fn count_right(&mut self, system: &System, sum: &Polynomial) -> bool {
        if let Some(right) = system.source.and_then(|s| s.open_loop_unstable()) {
            self.without_delay = right;
            return true;
        }
        if !sum.degree_known() {
            return false;
        }
        if let Some(right) = zeros_on_the_right(sum) {
            self.without_delay = right as u64;
            return true;
        }
        for set in Zeros::of(sum).sets() {
            let (from, to) = set.real_parts();
            if from > 0.0 {
                self.without_delay += set.count() as u64;
            } else if to >= 0.0 {
                self.marginal_at_zero = true;
            }
        }
        true
    }

    pub(super) fn find_without_delay(&mut self, system: &System) {
        let sum = system.without_delay();
        if !sum.is_zero() {
            self.count_right(system, &sum);
        }
    }

    /// Adds to n(0⁺) the pairs that start on the axis, from zeros of P + Q at ±iω₀: the crossing
    /// with its phase 2π there tells to which side they go. False where that cannot be told.
    fn start_on_axis(&mut self, system: &System, sum: &Polynomial) -> bool {
        for set in Zeros::of(sum).sets() {
            let (from, to) = set.real_parts();
            if from > 0.0 || to < 0.0 || set.middle().im < 0.0 {
                continue;
            }
            let middle = set.middle();
            if set.count() != 1 || middle.im == 0.0 {
                return false;
            }
            let near = |c: &&mut Crossing| {
                (c.omega - middle.im).abs() <= 1e-6 * middle.im && c.starts_at_zero()
            };
            let Some(crossing) = self.crossings.iter_mut().find(near) else {
                return false;
            };
            crossing.first_branch = u64::from(crossing.theta < PI);
            let starts_right = match crossing.direction {
                Direction::Right => true,
                Direction::Left => false,
                Direction::Touch => {
                    let z = Complex64::new(0.0, middle.im);
                    let [_, p_slope, q, q_slope] = system.pair(z);
                    let drift = divide(q, p_slope + q_slope).re;
                    let above = self.modulus_sign_above(system, middle.im);
                    drift * above > 0.0
                }
            };
            if starts_right {
                self.at_zero_delay += 2;
            }
        }
        true
    }

    /// The sign of F right of a touch at `omega`.
    fn modulus_sign_above(&self, system: &System, omega: f64) -> f64 {
        let higher = self
            .crossings
            .iter()
            .filter(|c| c.omega > omega * (1.0 + 1e-9) && c.direction != Direction::Touch)
            .count();
        let modulus = system.on_axis().modulus();
        let far = modulus.without_open_leading().leading().value;
        if higher % 2 == 0 { far } else { -far }
    }

    /// Finds n(0⁺) from (7) of `right_of` at some delay, less what happened up to there.
    pub(super) fn start_by_count(&mut self, unstable: Option<Turning>) {
        let period = self
            .crossings
            .iter()
            .map(Crossing::period)
            .fold(1.0, f64::min);
        let found = unstable.and_then(|turning| {
            (1..=TRIES).find_map(|i| {
                let tau = period * (i as f64 * 0.618_033_988_75 + 0.01);
                let marginal = self.count(tau, MarginalTolerance::default());
                let n = turning.at(tau)?;
                let change = self.change_until(tau);
                let near = self.crossings.iter().any(|c| c.near(tau, 1e-6));
                (!near && marginal.n_unstable < u64::MAX)
                    .then(|| u64::try_from(n as i64 - change).ok())
                    .flatten()
            })
        });
        match found {
            Some(n) => self.at_zero_delay = n,
            None => self.always_marginal = true,
        }
    }
}
