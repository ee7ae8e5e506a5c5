//! Steps of a motion by collocation: how long they are, and what the rates are there.

use super::{Mode, Motion};
use crate::model::Dashpots;
use crate::model::law::{Series, with_series};
use crate::slip::collocation::solve;
use crate::slip::step::Control;

/// The longest step, in units of √(M/κ) and of the time in which rates change by a factor of e.
const LONGEST: f64 = 0.5;
/// The change of speed in a step, in units of the law's own scale of speed.
const SHARE: f64 = 0.25;
/// Steps that are not solved to the tolerance are shortened by this factor, at most so many times.
const SHORTER: f64 = 0.5;
const MOST_TIMES: u32 = 40;

impl Motion {
    /// Solves the next step, no longer than `limit`, and fills its polynomials. Returns its length.
    /// The delayed polynomial has to be filled before.
    pub(super) fn collocate(&mut self, controlled: bool, limit: f64) -> f64 {
        let control = self.control(controlled);
        self.step.pull = control.pull();
        let load = control.load + control.alpha_n * self.step.fed_back_at_start(self.a);
        let mut length = self.step_of_scale(control, load).min(limit);
        let reads = self.parameters.feedback.echoes();
        for _ in 0..MOST_TIMES {
            let fits = !reads || self.fit_past(length, controlled);
            if self.solve_step(control, length) && fits {
                break;
            }
            length *= SHORTER;
        }
        length
    }

    /// The length of a step in which the law, the spring and the control change little.
    fn step_of_scale(&self, control: Control, load: f64) -> f64 {
        let p = &self.parameters;
        let speed = self.u.abs() * p.velocity_unit;
        let gains = control.alpha_v.abs() + control.alpha_n.abs();
        if self.mode == Mode::Stick {
            return LONGEST / (1.0 + gains);
        }
        let slope = p.law.mu_prime(speed).abs() * p.velocity_unit * load.abs();
        let force =
            self.a.abs() + p.law.mu_s() * (load.abs() + gains * LONGEST) + p.v0.abs() * LONGEST;
        let dashpots = p.dashpots.sum();
        let force = force + dashpots * (self.u.abs() + p.v0.abs() + gains * self.a.abs());
        let slope = slope + dashpots;
        let scale = p.law.speed_scale(speed) / p.velocity_unit;
        (LONGEST / (1.0 + gains + slope)).min(SHARE * scale / force)
    }

    /// Whether a step of this length is solved to the tolerance.
    fn solve_step(&mut self, control: Control, length: f64) -> bool {
        let direction = match self.mode {
            Mode::Stick => 0.0,
            Mode::Forwards => 1.0,
            Mode::Backwards => -1.0,
        };
        let (order, late) = (self.order, self.step.is_late);
        let rates = |s: f64, u: f64, a: f64, past: f64| {
            let difference = if late { past } else { a - past };
            let pull = control.v0 + control.slope * s + control.alpha_v * difference;
            let load = control.load + control.alpha_n * difference;
            if direction == 0.0 {
                (0.0, pull)
            } else {
                let friction = self.friction_at(direction * u) * load;
                let Dashpots { damping, viscous } = control.dashpots;
                let force = a + damping * (pull - u);
                (force - viscous * u - direction * friction, pull - u)
            }
        };
        let past = match late {
            true => &self.step.late,
            false => &self.step.delayed,
        };
        let past = (&past[..=order], self.parameters.feedback.echoes());
        let Some(solved) = solve((self.u, self.a), length, past, rates) else {
            // A law without a value ends the motion, unless a shorter step is solved.
            self.step.u.fill(f64::NAN);
            return false;
        };
        let size = self.a.abs().max(self.u.abs()).max(self.parameters.v0);
        let step = &mut self.step;
        (step.order, step.u, step.a) = (order, solved.u, solved.a);
        step.fill_forces(control);
        solved.rest <= self.tolerance * size
    }

    /// μ_K at a speed in the motion's units, a little below 0 as well.
    fn friction_at(&self, speed: f64) -> f64 {
        let p = &self.parameters;
        let by_piece = with_series!(&self.friction, series => series.value(speed));
        by_piece.unwrap_or_else(|| {
            let speed = (speed * p.velocity_unit).max(p.law.least_speed());
            p.law.mu_k(speed)
        })
    }
}
