//! The uncontrolled cycle of stick and slip, and motions that begin in it: control is switched on
//! at one of its phases.
//!
//! Every release from uncontrolled stick has the same state, (ẋ, a) = (0, μ_S − d v0) in the units
//! of [`super::motion`], and without control the future depends on nothing else. So if the block
//! sticks once more, its motion is periodic, and its past over one delay is known at every phase.
//! With a memory of the feedback the cycles count as having always gone on.
//!
//! Whether it sticks again is known before its path in the plane of u = ẋ and a has gone round
//! once. Paths do not cross. In slip forwards the maxima of u are above v0 and its minima below,
//! whatever the friction law: ü = v0 − u where u̇ = 0. In slip backwards a grows all the time, so
//! the block comes to rest again, at some a ≥ −μ_S. Two things keep it from sticking:
//!
//! - *u has a minimum above 0 in slip forwards.* The path from the release to there, the line
//!   μ_K(u) = a from there to u = 0 and the axis u = 0 up to a = μ_S enclose a region. The line and
//!   the axis are crossed inwards only, so the block never leaves it, and does not come to rest
//!   again.
//! - *It slides back and comes to rest at a > μ_S*, so that it slips forwards at once. Its path and
//!   the axis u = 0 from a = μ_S to there enclose all states in which the block sticks. The axis is
//!   crossed outwards only, so it stays outside.
//!
//! Else it sticks: where it stops at |a| ≤ μ_S, forwards or after it has slid back. A stuck block
//! is always released forwards, at a = μ_S, since a grows while it sticks.

use std::f64::consts::TAU;

use crate::model::elementary::ln;
use crate::model::{Channel, Feedback};

use super::motion::{Accuracy, Event, Mode, Motion, Parameters};

/// The longest slip that is followed, in units of √(M/κ).
const LONGEST_SLIP: f64 = 1000.0 * TAU;
/// The most steps of one cycle.
const MOST_STEPS: u32 = 100_000;
/// The most cycles in one delay.
const MOST_CYCLES: f64 = 1e4;
/// Within this distance from sliding at v0, relative, the block counts as sliding.
const SLIDING: f64 = 1e-9;

/// How long the block slips and sticks in one cycle, in units of √(M/κ).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct UncontrolledCycle {
    /// From release to stick, with any slip backwards before the stick.
    pub slip_time: f64,
    /// From stop to release.
    pub stick_time: f64,
}

impl UncontrolledCycle {
    /// The period.
    #[must_use]
    pub fn period(&self) -> f64 {
        self.slip_time + self.stick_time
    }
}

/// Why there is no motion from a phase of the uncontrolled cycle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NoCycle {
    /// Released once, the uncontrolled block does not stick again, or has not done so after 1000
    /// periods of free oscillation.
    NoStickSlip,
    /// One delay has more than 10⁴ cycles, or two delays have more steps than a history keeps.
    LongDelay,
}

/// A motion in uncontrolled stick-slip that was just released: at t = 0 it has ẋ = 0, a = μ_S and
/// begins to slip, after cycles that reach back at least one delay. Control acts from t = `phase`
/// on, or never where both gains are 0; `phase` ≥ 0 is taken modulo the period.
/// `parameters.switch_on` is ignored.
///
/// At phase 0 control acts on a block that already slips. Were it still stuck, the jump of v could
/// hold it.
///
/// # Errors
/// See [`NoCycle`].
pub fn after_release(
    parameters: &Parameters,
    accuracy: Accuracy,
    phase: f64,
) -> Result<(Motion, UncontrolledCycle), NoCycle> {
    let mut motion = Motion::new(parameters.clone(), accuracy, 0.0, 0.0);
    let cycle = restart_after_release(&mut motion, parameters, accuracy, phase)?;
    Ok((motion, cycle))
}

/// Begins the same motion as [`after_release`] in the memory of another motion. After an error that
/// motion is meaningless.
///
/// # Errors
/// See [`NoCycle`].
pub(crate) fn restart_after_release(
    motion: &mut Motion,
    parameters: &Parameters,
    accuracy: Accuracy,
    phase: f64,
) -> Result<UncontrolledCycle, NoCycle> {
    let mut uncontrolled = Parameters {
        switch_on: f64::INFINITY,
        ..parameters.clone()
    };
    let is_sampled = parameters.feedback.is_sampled();
    if is_sampled {
        // The history keeps the whole cycle, from which the readings before the release are taken.
        uncontrolled.feedback = Feedback::new(0.0, 0.0, f64::MAX);
    }
    // The block sticks at the limit and is released at once.
    let released = Motion::release_elongation(parameters);
    motion.restart(uncontrolled, accuracy, 0.0, released);
    if motion.advance(LONGEST_SLIP) != Some(Event::Release) {
        return Err(NoCycle::NoStickSlip);
    }
    let cycle = follow_cycle(motion).ok_or(NoCycle::NoStickSlip)?;
    let phase = if parameters.feedback.acts() {
        phase.rem_euclid(cycle.period())
    } else {
        f64::INFINITY
    };
    let before = ((known_before(parameters, accuracy) - phase) / cycle.period()).floor();
    if before > MOST_CYCLES {
        return Err(NoCycle::LongDelay);
    }
    if is_sampled {
        motion.sample_cycle(parameters, phase, cycle.period());
        return Ok(cycle);
    }
    let mut followed = 0.0;
    while followed < before {
        let cycle = follow_cycle(motion);
        if motion.is_lost() {
            return Err(NoCycle::LongDelay);
        }
        cycle.ok_or(NoCycle::NoStickSlip)?;
        followed += 1.0;
    }
    motion.begin_here(phase);
    Ok(cycle)
}

/// How long before switch-on the cycles have to be known: a delay, a latency, and as many more
/// delays as the memory needs to fall below the tolerance.
fn known_before(parameters: &Parameters, accuracy: Accuracy) -> f64 {
    let Feedback { tau, channel, .. } = parameters.feedback;
    let Channel { memory, latency } = channel;
    if !parameters.feedback.echoes() {
        return tau;
    }
    let remembered = match memory == 0.0 {
        true => 0.0,
        false => (ln(accuracy.tolerance) / ln(memory.abs())).ceil(),
    };
    latency + tau * (1.0 + remembered)
}

/// Follows an uncontrolled block that was just released to its next release. None where it does not
/// stick again.
fn follow_cycle(motion: &mut Motion) -> Option<UncontrolledCycle> {
    let start = motion.t;
    let p = motion.parameters();
    let (v0, horizon) = (p.v0, start + LONGEST_SLIP + 2.0 * p.law.mu_s() / p.v0);
    let (mut stick_time, mut overtook) = (0.0, false);
    for _ in 0..MOST_STEPS {
        let (from, mode) = (motion.t, motion.mode());
        let event = motion.advance(horizon);
        match mode {
            Mode::Stick => {
                stick_time += motion.t - from;
                if event == Some(Event::Release) {
                    let slip_time = motion.t - start - stick_time;
                    return Some(UncontrolledCycle {
                        slip_time,
                        stick_time,
                    });
                }
            }
            Mode::Forwards => {
                let (speed, acceleration) = motion.last_step().start();
                overtook |= speed > v0;
                let past_minimum = overtook && speed < v0 && acceleration > 0.0;
                if past_minimum || slides(motion) {
                    return None;
                }
            }
            // The path has gone round once.
            Mode::Backwards if motion.mode() == Mode::Forwards => return None,
            Mode::Backwards => {}
        }
        if motion.t >= horizon || motion.is_lost() {
            return None;
        }
    }
    None
}

fn slides(motion: &Motion) -> bool {
    let p = motion.parameters();
    let (off, stretch) = (motion.u - p.v0, motion.a - motion.sliding_elongation());
    off.abs() <= SLIDING * p.v0 && stretch.abs() <= SLIDING * p.law.mu_s()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Dashpots, FrictionLaw};

    fn parameters(law: FrictionLaw, v0: f64, tau: f64) -> Parameters {
        Parameters {
            law,
            velocity_unit: 1.0,
            dashpots: Dashpots::default(),
            feedback: Feedback::new(-0.33, 0.0, tau),
            v0,
            switch_on: 0.0,
        }
    }

    fn weakening() -> FrictionLaw {
        FrictionLaw::weakening(0.5, 0.5, 1.0).unwrap()
    }

    #[test]
    fn the_cycles_of_the_letters_figure_3() {
        for (v0, slip, stick) in [
            (0.35, 3.97549563, 4.92001175),
            (0.1, 3.44600138, 15.85555061),
        ] {
            for tau in [0.5, 4.15, 100.0] {
                let p = parameters(weakening(), v0, tau);
                let (motion, cycle) = after_release(&p, Accuracy::default(), 0.0).unwrap();
                assert!((cycle.slip_time - slip).abs() < 1e-8, "{cycle:?}");
                assert!((cycle.stick_time - stick).abs() < 1e-8, "{cycle:?}");
                assert_eq!((motion.t, motion.u), (0.0, 0.0));
                assert!((motion.a - 1.0).abs() < 1e-12);
                assert_eq!(motion.mode(), Mode::Forwards);
            }
        }
    }

    /// The phase counts modulo the period, and the motion until switch-on is the cycle itself.
    #[test]
    fn control_is_switched_on_at_the_phase() {
        let p = parameters(weakening(), 0.35, 30.0);
        let period = 3.97549563 + 4.92001175;
        for (phase, wrapped) in [(0.7, 0.7), (6.0, 6.0), (3.0 * period + 0.7, 0.7)] {
            let (mut motion, cycle) = after_release(&p, Accuracy::default(), phase).unwrap();
            assert!((motion.parameters().switch_on - wrapped).abs() < 1e-7);
            let mut stopped = None;
            while motion.t < motion.parameters().switch_on {
                if motion.advance(100.0) == Some(Event::Stick) {
                    stopped = Some(motion.t);
                }
            }
            if phase > cycle.slip_time && wrapped > cycle.slip_time {
                assert!((stopped.unwrap() - cycle.slip_time).abs() < 1e-11);
            }
            // One delay ago the elongation was that of three or four cycles earlier.
            motion.advance(100.0);
            let step = motion.last_step();
            let seen = step.state(0.0).1 - step.fed_back(0.0);
            let ago = (wrapped - 30.0).rem_euclid(cycle.period());
            let (mut free, _) = after_release(&p, Accuracy::default(), 2.0 * period).unwrap();
            free.restart(
                Parameters {
                    switch_on: f64::INFINITY,
                    ..p.clone()
                },
                Accuracy::default(),
                0.0,
                1.0,
            );
            while free.t < ago {
                free.advance(ago);
            }
            assert!((seen - free.a).abs() < 1e-9, "{seen} {}", free.a);
        }
    }

    #[test]
    fn delays_of_too_many_cycles_are_refused() {
        // Where friction never grows with the speed the block always sticks again.
        let flat = parameters(FrictionLaw::stribeck(0.3, 0.05, 1.0).unwrap(), 0.4, 1.0);
        let (_, cycle) = after_release(&flat, Accuracy::default(), 0.3).unwrap();
        assert!(cycle.stick_time > 0.1, "{cycle:?}");
        let long = parameters(weakening(), 0.35, 1e12);
        let refused = after_release(&long, Accuracy::default(), 0.0).unwrap_err();
        assert_eq!(refused, NoCycle::LongDelay);
    }
}
