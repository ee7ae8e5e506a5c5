//! The end of an orbit as the start of its neighbour's search, on a line of delays.

use super::Problem;
use super::climb::{Place, climb};
use super::ends::{Found, finish};
use super::orbit::{At, Orbit};

/// An orbit at its end, from which the next cell of a line starts.
#[derive(Debug, Clone)]
pub(super) struct Track {
    road: Orbit,
    at: Place,
    /// The motion at the end of the cell before the last one.
    before: Option<At>,
    /// Delays and ends of the cells before, the last ones.
    ends: Vec<(f64, f64)>,
    /// Whether it ends by lift-off.
    lifts: bool,
    /// How far off the end was last expected, relative.
    off: f64,
    /// Whether it is known that stick-slip leads there.
    pub decided: bool,
}

/// How far off an end is taken to be before anything is known.
const FIRST_OFF: f64 = 0.02;
/// The least and the largest distance from the expected end at which a cell starts, relative.
const NEAREST: f64 = 3e-4;
const FARTHEST: f64 = 0.1;
/// The least one from lift-off, which the transient of a new start can bring about too early.
const NEAREST_LIFT: f64 = 3e-3;
/// The largest change of the delay from cell to cell, relative.
const LARGEST_CHANGE: f64 = 0.5;
/// How far from the last end, in its logarithm, the next one is looked for.
const FARTHEST_LOG: f64 = 0.5;
/// The most trials on the way from one cell to the next, and the part of a way that is tried where the whole of it failed.
const MOST_TRIALS: u32 = 8;
const PART: f64 = 0.25;
/// Ends that an expectation is made of.
const KNOWN_ENDS: usize = 3;

impl Track {
    /// From the end that was `found` of `problem` at the last place of `road`.
    pub fn new(problem: &Problem, road: Orbit, at: Place, found: &Found) -> Self {
        Self {
            road,
            at,
            before: None,
            ends: found
                .end()
                .map(|end| (problem.tau, end))
                .into_iter()
                .collect(),
            lifts: matches!(found, Found::LiftOff(..)),
            off: FIRST_OFF,
            decided: true,
        }
    }

    /// The end of stick-slip of `problem`, which differs by its delay alone from the one before; none where the orbit before
    /// does not lead to its end. After that the track is of no more use.
    pub fn next(&mut self, problem: &Problem) -> Option<Found> {
        let mut trials = MOST_TRIALS;
        self.approach(problem, &mut trials)
    }

    /// The same, by way of delays in between where the whole way is too far, within so many `trials`.
    fn approach(&mut self, problem: &Problem, trials: &mut u32) -> Option<Found> {
        *trials = trials.checked_sub(1)?;
        let from = self.clone();
        if let Some(found) = self.attempt(problem) {
            return Some(found);
        }
        *self = from;
        let last = self.ends.last()?.0;
        let between = Problem {
            tau: last + PART * (problem.tau - last),
            ..problem.clone()
        };
        self.approach(&between, trials)?;
        self.approach(problem, trials)
    }

    fn attempt(&mut self, problem: &Problem) -> Option<Found> {
        let last = *self.ends.last()?;
        if (problem.tau / last.0 - 1.0).abs() > LARGEST_CHANGE {
            return None;
        }
        let expected = self.expected(problem.tau);
        let nearest = if self.lifts { NEAREST_LIFT } else { NEAREST };
        // An orbit that has to change starts with a transient, a small one where its past is extrapolated.
        let change = (expected / last.1 - 1.0).abs();
        let transient = if self.before.is_some() { 0.01 } else { 0.15 };
        let off = (2.0 * self.off)
            .max(transient * change)
            .clamp(nearest, FARTHEST);
        let ended = self.road.place_kept().clone();
        let offs = [off, 4.0 * off, 2.0 * FARTHEST].into_iter();
        let from = offs
            .map(|off| expected * (1.0 - off))
            .find_map(|v0| self.start(problem.tau, v0))?;
        let (climbed, at) = climb(&mut self.road, from, FARTHEST);
        let found = finish(problem, &mut self.road, climbed, &at);
        let end = found.end()?;
        self.off = (end / expected - 1.0).abs();
        self.at = at;
        self.lifts = matches!(found, Found::LiftOff(..));
        self.before = Some(ended);
        if self.ends.len() == KNOWN_ENDS {
            self.ends.remove(0);
        }
        self.ends.push((problem.tau, end));
        Some(found)
    }

    /// A first place at another delay.
    fn start(&mut self, tau: f64, v0: f64) -> Option<Place> {
        let [.., one, other] = self.ends[..] else {
            return self.road.restart(None, (v0, tau), &self.at);
        };
        let share = (tau - other.0) / (other.0 - one.0);
        let before = self.before.as_mut().map(|before| (before, share));
        self.road.restart(before, (v0, tau), &self.at)
    }

    /// Learns of the cell before, whose end was found otherwise: an end like its own expects the next one better.
    pub fn recall(&mut self, tau: f64, end: f64) {
        if self.ends.len() < KNOWN_ENDS && self.ends.first().is_some_and(|first| tau < first.0) {
            self.ends.insert(0, (tau, end));
            self.off = NEAREST.max(0.25 * self.off);
        }
    }

    /// The end at `tau`: its logarithm as the polynomial of that of the delay through the last ones (Neville).
    fn expected(&self, tau: f64) -> f64 {
        let n = self.ends.len();
        let mut logs = [(0.0, 0.0); KNOWN_ENDS];
        for (log, end) in logs.iter_mut().zip(&self.ends) {
            *log = (end.0.ln(), end.1.ln());
        }
        let (x, mut p) = (tau.ln(), logs.map(|log| log.1));
        for k in 1..n {
            for i in 0..n - k {
                let (low, high) = (logs[i].0, logs[i + k].0);
                p[i] = ((x - high) * p[i] + (low - x) * p[i + 1]) / (low - high);
            }
        }
        // Not far from the last one, whatever the polynomial does.
        let last = logs[n - 1].1;
        p[0].clamp(last - FARTHEST_LOG, last + FARTHEST_LOG).exp()
    }
}
