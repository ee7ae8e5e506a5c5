//! What becomes of uncontrolled stick-slip when control is switched on at a phase of it: followed
//! as it is, for long.

use super::block::{Block, Event, Mode};
use super::setting::Setting;
use super::steps::Pace;

/// What is seen at last.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Fate {
    /// It still sticks in the last quarter of the time.
    Survives,
    /// It does not.
    Ends,
    LiftsOff,
    /// There is no uncontrolled stick-slip.
    NoCycle,
}

/// The times for which uncontrolled slips are waited for, over the time unit.
const WAIT: f64 = 2000.0;
/// The most cycles in a delay.
const MOST_CYCLES: f64 = 1000.0;

/// Switches control on `phase` after a release, modulo the period, and follows the block for so
/// many of its longest times: period and delay. None where a delay has too many cycles.
pub(crate) fn fate(setting: &Setting, pace: Pace, phase: f64, times: f64) -> Option<Fate> {
    let mut block = Block::at_rest_or_sliding(
        Setting {
            switch_on: f64::INFINITY,
            ..setting.clone()
        },
        pace,
        0.0,
        0.999 * setting.friction.mu_s * setting.load / setting.stiffness,
    );
    let longest = setting.tau + WAIT * setting.time();
    to_release(&mut block, longest);
    let Some(period) = to_release(&mut block, longest) else {
        return Some(Fate::NoCycle);
    };
    let cycles = (setting.remembered() / period).ceil();
    if cycles > MOST_CYCLES {
        return None;
    }
    for _ in 0..cycles as usize {
        to_release(&mut block, longest);
    }
    let on = block.t + phase % period;
    while block.t < on {
        block.advance(on);
    }
    block.switch_on();
    Some(after(&mut block, times * (period + setting.tau)))
}

/// To the next release, unless that takes too long; how long it took.
fn to_release(block: &mut Block, longest: f64) -> Option<f64> {
    let start = block.t;
    let stick = 2.0 * block.setting.friction.mu_s * block.setting.load;
    let end = start + longest + stick / (block.setting.stiffness * block.setting.v0);
    while block.t < end {
        if block.advance(end) == Some(Event::Release) {
            return Some(block.t - start);
        }
    }
    None
}

/// Follows a block for a time.
pub(crate) fn after(block: &mut Block, time: f64) -> Fate {
    let start = block.t;
    let mut stuck = start;
    while block.t < start + time {
        if block.advance(start + time) == Some(Event::LiftOff) {
            return Fate::LiftsOff;
        }
        if block.mode == Mode::Stick {
            stuck = block.t;
        }
    }
    match stuck > start + 0.75 * time {
        true => Fate::Survives,
        false => Fate::Ends,
    }
}
