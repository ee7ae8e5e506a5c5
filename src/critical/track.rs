//! The end of an orbit as the start of its neighbour's search, on a line of delays.

use super::climb::{Place, climb, jumps};
use super::ends::{RoadEnd, arrive, verify};
use super::orbit::{At, Orbit};
use super::problem::Problem;
use crate::model::elementary::{exp, ln};

/// An orbit at its end, from which the next cell of a line starts.
#[derive(Debug, Clone)]
pub(super) struct Track {
    road: Orbit,
    at: Place,
    /// The motion at the end of the cell before the last one.
    before: Option<At>,
    /// Delays and ends of the cells before, the last ones.
    ends: Vec<(f64, f64)>,
    /// How it ends.
    ending: Ending,
    /// How far off the end was last expected, relative.
    off: f64,
    /// How far below the expected end the next cell starts at least, relative.
    near: f64,
    /// Cells in a row that ended by the slopes of one before.
    borrowed: u32,
    /// How clearly stick-slip was seen to end where that was looked at last, the delay there, and
    /// the change with the delay's logarithm; NaN where it is not known.
    clear: f64,
    seen_at: f64,
    change: f64,
    /// Ends since then, and the time in slip at that one.
    unseen: u32,
    slip_seen: f64,
    /// Whether it is known that stick-slip leads there.
    pub decided: bool,
    /// Whether stick-slip is of one kind all the way from low velocities.
    pub one_kind: bool,
}

/// How far off an end is taken to be before anything is known.
const FIRST_OFF: f64 = 0.02;

/// How orbits end that can be continued.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Ending {
    Graze,
    Vanish,
    LiftOff,
}

impl Ending {
    fn of(found: &RoadEnd) -> Self {
        match found {
            RoadEnd::LiftOff(_) => Self::LiftOff,
            RoadEnd::Vanish(..) => Self::Vanish,
            _ => Self::Graze,
        }
    }

    /// From how far below the expected end a cell starts, relative: at first, as the transient of a
    /// new start, of a size that is not known yet, can bring about an end too early; and at least,
    /// as gauges have their noise.
    fn nearest(self) -> [f64; 2] {
        match self {
            Self::Graze => [3e-4, 1e-5],
            Self::Vanish => [3e-3, 1e-3],
            Self::LiftOff => [3e-3, 2e-5],
        }
    }
}

/// Why a cell is not come to.
enum Lost {
    /// Its orbit goes on as another one.
    Goes,
    /// Not known.
    Unknown,
}

/// The largest distance from the expected end at which a cell starts, relative.
const FARTHEST: f64 = 0.1;
/// The number of cells in a row that may end by the slopes of one before, and from so far below its
/// end, relative, the next one starts.
const MOST_BORROWED: u32 = 8;
const FOR_SLOPES: f64 = 1e-4;
/// A cell starts so many times further below its end than the transient of the cell before reached.
const ROOM: f64 = 1.5;
/// How much nearer it starts at least.
const NEARER: f64 = 0.5;
/// How many ends there may be in a row of which it is not looked at what comes after them; as well
/// as this they are where they were expected, relative.
const MOST_UNSEEN: u32 = 3;
const AS_EXPECTED: f64 = 3e-5;
/// How well its time in slip has to be that of the one that was looked at, relative.
const SAME_SLIP: f64 = 0.02;
/// How clearly, at least, stick-slip ended before, and how many times the change of that since then
/// has to fit into it.
const CLEAR: f64 = 2e-3;
const CAUTION: f64 = 6.0;
/// The largest change of the delay from one cell to the next where a stick vanishes, relative.
const SMALL_CHANGE: f64 = 0.03;
/// The largest change of the delay from cell to cell, relative.
const LARGEST_CHANGE: f64 = 0.5;
/// No way that is shorter is cut into parts.
const LEAST_CHANGE: f64 = 2e-3;
/// How far from the last end, in its logarithm, the next one is looked for.
const FARTHEST_LOG: f64 = 0.5;
/// The most trials on the way from one cell to the next, and the part of a way that is tried where
/// the whole of it failed.
const MOST_TRIALS: u32 = 8;
const PART: f64 = 0.25;
/// An end so far from where it was expected, relative, is one that changes fast along the line.
const SURPRISE: f64 = 3e-4;
/// Ends that an expectation is made of.
const KNOWN_ENDS: usize = 4;

impl Track {
    /// From the end that was `found` of `problem` at the last place of `road`.
    pub(super) fn new(problem: &Problem, road: Orbit, at: Place, found: &RoadEnd) -> Self {
        let ending = Ending::of(found);
        Self {
            road,
            at,
            before: None,
            ends: found
                .end()
                .map(|end| (problem.tau, end))
                .into_iter()
                .collect(),
            ending,
            off: FIRST_OFF,
            near: ending.nearest()[0],
            borrowed: 0,
            clear: f64::NAN,
            seen_at: f64::NAN,
            change: f64::NAN,
            unseen: 0,
            slip_seen: f64::NAN,
            decided: true,
            one_kind: true,
        }
    }

    /// This end, with what is known of one that was come to from scratch at this delay.
    pub(super) fn like(mut self, other: &Self) -> Self {
        (self.decided, self.one_kind) = (other.decided, other.one_kind);
        self
    }

    /// The end of stick-slip of `problem`, which differs by its delay alone from the one before;
    /// none where the orbit before does not lead to its end. After that the track is of no more
    /// use.
    pub(super) fn next(&mut self, problem: &Problem) -> Option<RoadEnd> {
        let mut trials = MOST_TRIALS;
        self.approach(problem, &mut trials)
    }

    /// The end at the delay of `problem`, by way of delays in between where the whole way is too
    /// far, within so many `trials`.
    fn approach(&mut self, problem: &Problem, trials: &mut u32) -> Option<RoadEnd> {
        let first = self.ending.nearest()[0];
        loop {
            *trials = trials.checked_sub(1)?;
            let from = self.clone();
            let lost = match self.attempt(problem) {
                Ok(found) => return Some(found),
                Err(lost) => lost,
            };
            *self = from;
            if self.near >= first {
                match lost {
                    Lost::Goes => return None,
                    Lost::Unknown => break,
                }
            }
            // It may have been too near.
            self.near = first;
        }
        let last = self.ends.last()?.0;
        if (problem.tau / last - 1.0).abs() < LEAST_CHANGE {
            return None;
        }
        let between = Problem {
            tau: last + PART * (problem.tau - last),
            ..problem.clone()
        };
        self.approach(&between, trials)?;
        self.approach(problem, trials)
    }

    fn attempt(&mut self, problem: &Problem) -> Result<RoadEnd, Lost> {
        let tau = problem.tau;
        let expected = self.expected(tau);
        let ended = self.road.place_kept().clone();
        let (from, nearest) = self.set_out(tau, expected)?;
        let first = *self.road.first_gauges();
        let (climbed, at) = climb(&mut self.road, from, FARTHEST);
        let gauge = at.gap().1;
        let transient = (first[gauge] - from.gauges[gauge]) / at.slopes[gauge] / at.v0;
        self.near = (ROOM * transient)
            .max(nearest[0])
            .min(nearest[1])
            .max(self.ending.nearest()[1]);
        let found = arrive(&mut self.road, climbed, &at);
        let found = self.look(problem, found, (expected, at.period.slip_time()));
        let end = match found {
            RoadEnd::Persists(_) | RoadEnd::Irregular | RoadEnd::Changes(_) => {
                return Err(Lost::Goes);
            }
            _ => found.end().ok_or(Lost::Unknown)?,
        };
        self.off = (end / expected - 1.0).abs();
        self.borrowed = if at.own { 0 } else { self.borrowed + 1 };
        self.at = at;
        self.ending = Ending::of(&found);
        self.before = Some(ended);
        if self.ends.len() == KNOWN_ENDS {
            self.ends.remove(0);
        }
        self.ends.push((tau, end));
        Ok(found)
    }

    /// A first place at the delay `tau`, below the `expected` end; and from how far below its end
    /// the next cell may start, relative: not nearer than the first number, and not farther than
    /// the second, unless something else asks for it.
    fn set_out(&mut self, tau: f64, expected: f64) -> Result<(Place, [f64; 2]), Lost> {
        let last = *self.ends.last().ok_or(Lost::Unknown)?;
        if (tau / last.0 - 1.0).abs() > LARGEST_CHANGE {
            return Err(Lost::Unknown);
        }
        let mut near = (2.0 * self.off).max(self.near).min(FARTHEST);
        if self.before.is_none() {
            // An orbit that has to change starts with a transient, a small one where its past is
            // extrapolated.
            near = (0.15 * (expected / last.1 - 1.0).abs()).clamp(near, FARTHEST);
        }
        let off = match self.borrowed >= MOST_BORROWED {
            true => near.max(FOR_SLOPES),
            false => near,
        };
        let mut nearest = [0.0, NEARER * near];
        for off in [off, 4.0 * off, (30.0 * off).min(FARTHEST), 2.0 * FARTHEST] {
            if let Some(from) = self.start(tau, expected * (1.0 - off)) {
                return Ok((Place { expected, ..from }, nearest));
            }
            nearest = [off, NEARER * 4.0 * off];
        }
        Err(Lost::Unknown)
    }

    /// What an end that was arrived at is, looked at what comes after it unless that can be told
    /// from the ends before. There it was expected at `expected`, and its orbit slips for `slip` in
    /// a period.
    fn look(&mut self, problem: &Problem, end: RoadEnd, (expected, slip): (f64, f64)) -> RoadEnd {
        let as_expected = |end: f64| (end / expected - 1.0).abs() < AS_EXPECTED;
        let alike = Ending::of(&end) == self.ending
            && end.end().is_some_and(as_expected)
            && (slip / self.slip_seen - 1.0).abs() < SAME_SLIP;
        if alike && self.may_be_unseen(problem.tau) {
            self.unseen += 1;
            return end;
        }
        let (seen, clear) = verify(problem, &mut self.road, end);
        self.see(problem.tau, clear);
        self.slip_seen = slip;
        seen
    }

    /// Whether the next end, at `tau`, may be taken for that of stick-slip because it clearly ended
    /// at those before: what the block does beyond them changes smoothly along a line.
    fn may_be_unseen(&self, tau: f64) -> bool {
        if self.unseen == MOST_UNSEEN {
            return false;
        }
        if self.ending == Ending::Vanish {
            // Sticks are as short beyond their end as before it: only a small change says that
            // nothing else becomes of it.
            let near = |last: &(f64, f64)| (tau / last.0 - 1.0).abs() < SMALL_CHANGE;
            return self.clear > 0.0 && self.ends.last().is_some_and(near);
        }
        // Not for NaN.
        let since = ln(tau / self.seen_at).abs();
        self.clear > CLEAR && CAUTION * self.change * since < self.clear
    }

    /// Learns how clearly stick-slip ends at `tau`.
    fn see(&mut self, tau: f64, clear: f64) {
        self.change = ((clear - self.clear) / ln(tau / self.seen_at)).abs();
        (self.clear, self.seen_at, self.unseen) = (clear, tau, 0);
    }

    /// Whether the last end was not where the ends before made it expected.
    pub(super) fn surprised(&self) -> bool {
        self.ends.len() == KNOWN_ENDS && self.off > SURPRISE
    }

    /// Whether it was seen that stick-slip ends where the last cell says.
    pub(super) fn seen(&self) -> bool {
        self.unseen == 0
    }

    /// A first place at another delay.
    fn start(&mut self, tau: f64, v0: f64) -> Option<Place> {
        let last = self.ends.last()?.0;
        let before = match (&self.ends[..], &mut self.before) {
            ([.., one, other], Some(before)) => Some((before, (tau - other.0) / (other.0 - one.0))),
            _ => None,
        };
        let place = self.road.restart(before, (v0, tau), &self.at)?;
        let change = (v0 / self.at.v0 - 1.0).abs().max((tau / last - 1.0).abs());
        (!jumps(&self.at.period, &place.period, change)).then_some(place)
    }

    /// Learns of the cell before, whose end was found otherwise: an end like its own expects the
    /// next one better.
    pub(super) fn recall(&mut self, tau: f64, end: f64) {
        if self.ends.len() < KNOWN_ENDS && self.ends.first().is_some_and(|first| tau < first.0) {
            self.ends.insert(0, (tau, end));
            self.off = self.ending.nearest()[1].max(0.25 * self.off);
        }
    }

    /// The end at `tau`: its logarithm as the polynomial of that of the delay through the last ones
    /// (Neville).
    fn expected(&self, tau: f64) -> f64 {
        let n = self.ends.len();
        let mut logs = [(0.0, 0.0); KNOWN_ENDS];
        for (log, end) in logs.iter_mut().zip(&self.ends) {
            *log = (ln(end.0), ln(end.1));
        }
        let (x, mut p) = (ln(tau), logs.map(|log| log.1));
        for k in 1..n {
            for i in 0..n - k {
                let (low, high) = (logs[i].0, logs[i + k].0);
                p[i] = ((x - high) * p[i] + (low - x) * p[i + 1]) / (low - high);
            }
        }
        // Not far from the last one, whatever the polynomial does.
        let last = logs[n - 1].1;
        exp(p[0].clamp(last - FARTHEST_LOG, last + FARTHEST_LOG))
    }
}
