//! Settings of fastest decay of a system from a file: over the delay and one other parameter.

use std::cell::RefCell;
use std::f64::consts::TAU;

use super::best::Ranges;
use crate::linear::best::{self, Best, General, Search};
use crate::linear::general::{Class, System};
use crate::model::stop::Stop;
use crate::sweep::input::parameter::Parameter;
use crate::sweep::input::system::{Evaluation, SystemModel, Undefined};

/// Delays searched unless others are asked for: so many periods of the slowest swing without delay.
const PERIODS: f64 = 4.0;
/// A parameter without bounds is searched so far on either side of 0, over its default or 1.
const FARTHEST: f64 = 4.0;
/// How near to ±1 the memory is searched.
const MOST_MEMORY: f64 = 0.95;

/// The parameter that is searched beside the delay.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Searched {
    /// One of the system's own, by its index.
    Own(usize),
    /// R; of the feedback form alone.
    Memory,
    /// δ; of the feedback form alone.
    Latency,
}

impl Searched {
    /// Gives it a value.
    pub fn set(self, at: &mut Evaluation, value: f64) {
        match self {
            Self::Own(index) => at.own[index] = value,
            Self::Memory => at.channel.memory = value,
            Self::Latency => at.channel.latency = value,
        }
    }
}

/// Why nothing is searched.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum NotSearched {
    /// An expression has no value at the middle of the ranges.
    #[error(transparent)]
    Undefined(#[from] Undefined),
    /// Nothing can be said of any delay.
    #[error("this system is not answered: |P| = |Q| on all of the imaginary axis")]
    Refused,
    /// There is no equation.
    #[error("this system is not answered: P and Q are both 0")]
    Zero,
}

/// The ranges that are searched where none are given. Delays: up to four periods of the slowest
/// swing that the system has without delay at the setting `at`, or up to 8π where nothing swings.
/// The parameter: its own range, where that has ends; else up to 4 max(1, |default|) on either side
/// of 0, as far as the range goes.
#[must_use]
pub fn default_ranges(model: &SystemModel, at: &Evaluation, searched: Searched) -> Ranges {
    let mut at = at.clone();
    at.tau = 0.0;
    let frequency = model.at(&mut at).ok().and_then(|system| slowest(&system));
    let longest = PERIODS * TAU / frequency.unwrap_or(1.0);
    let gain = match searched {
        Searched::Own(index) => {
            let own = &model.parameters[index];
            let far = FARTHEST * own.default.abs().max(1.0);
            match own.ends() {
                (Some(low), Some(high)) => (low, high),
                (Some(low), None) => (low, far.max(low + far)),
                (None, Some(high)) => ((-far).min(high - far), high),
                (None, None) => (-far, far),
            }
        }
        Searched::Memory => (-MOST_MEMORY, MOST_MEMORY),
        Searched::Latency => (0.0, longest),
    };
    Ranges {
        gain,
        tau: (0.0, longest),
    }
}

/// The lowest frequency at which the system swings without delay.
fn slowest(system: &System) -> Option<f64> {
    let frequencies = system.frequencies_without_delay().into_iter();
    frequencies.min_by(f64::total_cmp)
}

/// The settings of fastest decay for every stable region within `ranges`. The range `gain` is that
/// of `searched`; everything else is as in `at`.
///
/// # Errors
/// Where the system has no value in the middle of the ranges, or is one that is refused.
pub fn best_of_system(
    model: &SystemModel,
    at: &Evaluation,
    searched: Searched,
    ranges: &Ranges,
) -> Result<Best, NotSearched> {
    let moved = RefCell::new(at.clone());
    let system_at = |value: f64, tau: f64| {
        let mut moved = moved.borrow_mut();
        searched.set(&mut moved, value);
        moved.tau = tau;
        model.at(&mut moved)
    };
    let middle = |(from, to): (f64, f64)| 0.5 * (from + to);
    let in_the_middle = system_at(middle(ranges.gain), middle(ranges.tau))?;
    if in_the_middle.class() == Class::Refused {
        return Err(match in_the_middle.is_zero() {
            true => NotSearched::Zero,
            false => NotSearched::Refused,
        });
    }
    let known = |value: f64, tau: f64| system_at(value, tau).ok();
    let search = Search {
        family: General {
            system_at: &known,
            lines: !model.depends_on_delay(),
            width: ranges.gain.1 - ranges.gain.0,
        },
        gains: ranges.gain,
        delays: ranges.tau,
    };
    Ok(best::best(&search, &Stop::default()))
}

/// The parameter of that name which may be searched beside the delay.
#[must_use]
pub fn searched_of(model: &SystemModel, name: &str) -> Option<Searched> {
    if let Some(index) = model.index_of(name) {
        return Some(Searched::Own(index));
    }
    let known = Parameter::from_name(name).filter(|_| model.is_feedback());
    match known {
        Some(Parameter::Memory) => Some(Searched::Memory),
        Some(Parameter::Latency) => Some(Searched::Latency),
        _ => None,
    }
}
