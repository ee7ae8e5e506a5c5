//! The critical velocities of a line of delays: each end of stick-slip starts from its neighbour's
//! orbit.
//!
//! Such a continuation may go on along a branch of ends that stick-slip raised from low velocities
//! does not come to. So the cells at both ends of a stretch are looked for from scratch, and what
//! is continued from the one has to meet the other; else the stretch is halved. Where a kind of
//! stick-slip ends, so does a stretch, and where ends change fast more cells are looked for from
//! scratch. A line is cut into blocks for that, so that the answer in a cell depends on its block
//! alone.

use super::answer::{Critical, Method};
use super::problem::Problem;
use super::search::from_scratch;
use super::track::Track;

/// Cells of a block; blocks start at multiples of it.
pub const BLOCK: usize = 128;
/// Cells of a stretch, at both ends of which cells are looked for from scratch; and the same where
/// stick-slip of one kind followed that of another on the way to its end, and may end earlier.
const STRETCH: usize = 64;
const SHORT_STRETCH: usize = 16;
/// An end that is not where it was expected is looked for from scratch, unless one was so few cells
/// before.
const SURPRISES: usize = 2;
/// How well a continuation has to meet what was found from scratch, relative; and how well in the
/// time of slip, which tells how many slips a period has.
const MEETS: f64 = 3e-5;
const MEETS_IN_TIME: f64 = 1e-2;

/// The critical velocities of a block of a line: problems that differ by their delay alone, which
/// increases. `stopped` is asked before every visit to a cell; where it came first, some are none
/// and the others are not to be used.
#[must_use]
pub fn critical_velocities(
    problems: &[Problem],
    stopped: impl Fn() -> bool,
) -> Vec<Option<Critical>> {
    let mut block = Block {
        problems,
        found: vec![None; problems.len()],
        stopped: &stopped,
    };
    if let Some(last) = problems.len().checked_sub(1) {
        let track = block.start(0);
        if last > 0 {
            block.start(last);
        }
        block.fill(0, last, track);
    }
    block.found
}

struct Block<'p> {
    problems: &'p [Problem],
    found: Vec<Option<Critical>>,
    stopped: &'p dyn Fn() -> bool,
}

impl Block<'_> {
    /// Looks for a cell from scratch.
    fn start(&mut self, cell: usize) -> Option<Track> {
        if (self.stopped)() {
            return None;
        }
        let (critical, mut track) = from_scratch(&self.problems[cell]);
        let alike = |c: &&Critical| c.end == critical.end && c.method == critical.method;
        for before in (0..cell).rev().take(2) {
            let Some(known) = self.found[before].as_ref().filter(alike) else {
                break;
            };
            if let Some(track) = &mut track {
                track.recall(self.problems[before].tau, known.end_of_stick_slip());
            }
        }
        self.found[cell] = Some(critical);
        track
    }

    /// Fills the cells between two that were found from scratch, the first one with its track; the
    /// track that led to the last one if one did.
    fn fill(&mut self, mut first: usize, last: usize, mut track: Option<Track>) -> Option<Track> {
        while first < last && !(self.stopped)() {
            let one_kind = track.as_ref().is_none_or(|track| track.one_kind);
            let next = first + if one_kind { STRETCH } else { SHORT_STRETCH };
            if next < last {
                let there = self.start(next);
                track = match (self.fill(first, next, track), there) {
                    // It goes on where it is well on its way.
                    (Some(led), Some(there)) => Some(led.like(&there)),
                    (_, there) => there,
                };
                first = next;
                continue;
            }
            let (reached, known) = match &mut track {
                Some(track) => self.advance(first, last, track),
                None => (first, true),
            };
            if reached == last {
                return track;
            }
            if reached > first {
                if !known {
                    let (met, there) = self.meet(reached);
                    if !met {
                        self.halve(first, reached);
                        (first, track) = (reached, there);
                        continue;
                    }
                }
                self.doubt(first, reached);
            }
            // Its kind of stick-slip ends there, or leads no further.
            first = reached + 1;
            if first < last {
                track = self.start(first);
            }
        }
        None
    }

    /// Looks where a continuation that led from one cell to another, but does not meet it, meets
    /// cells in between, and fills what is left.
    fn halve(&mut self, first: usize, last: usize) {
        let middle = usize::midpoint(first, last);
        if middle == first {
            return;
        }
        let (met, there) = self.meet(middle);
        match met {
            true => self.doubt(first, middle),
            false => self.halve(first, middle),
        }
        self.fill(middle, last, there);
    }

    /// What is in doubt at the `last` cell is so on the way to it.
    fn doubt(&mut self, first: usize, last: usize) {
        let decided = self.found[last].is_some_and(|there| there.decided);
        for between in self.found[first + 1..last].iter_mut().flatten() {
            between.decided &= decided;
        }
    }

    /// Looks for a cell from scratch that was continued to: whether that meets, and its track.
    fn meet(&mut self, cell: usize) -> (bool, Option<Track>) {
        let continued = self.found[cell];
        let track = self.start(cell);
        let both = continued.zip(self.found[cell]);
        (both.is_some_and(|(a, b)| meets(&a, &b)), track)
    }

    /// Continues from `first` on; how far it is known to lead, to `last` if it meets what is known
    /// there, and whether that cell was found from scratch.
    fn advance(&mut self, first: usize, last: usize, track: &mut Track) -> (usize, bool) {
        let (mut seen, mut checked) = (first, first);
        for cell in first + 1..=last {
            if (self.stopped)() {
                return (seen, seen == checked);
            }
            let next = track.next(&self.problems[cell]);
            let found = next.and_then(|found| found.told(Method::GrazeOrbit));
            let Some(mut critical) = found else {
                return (seen, seen == checked);
            };
            critical.decided = track.decided;
            if cell == last {
                if self.found[last].is_none_or(|there| !meets(&there, &critical)) {
                    return (seen, seen == checked);
                }
                self.doubt(first, last);
                return (last, true);
            }
            self.found[cell] = Some(critical);
            if track.surprised() && cell >= checked + SURPRISES {
                // Where ends change as fast as that along the line, stick-slip may have another one
                // below.
                if !self.meet(cell).0 {
                    return (seen, seen == checked);
                }
                (checked, seen) = (cell, cell);
            } else if track.seen() {
                seen = cell;
            }
        }
        (last, true)
    }
}

/// Whether two answers are one.
fn meets(a: &Critical, b: &Critical) -> bool {
    let near =
        |within: f64, a: f64, b: f64| a.is_nan() && b.is_nan() || (a - b).abs() <= within * a.abs();
    a.end == b.end
        && a.method == b.method
        && near(MEETS, a.vc, b.vc)
        && near(MEETS, a.v_liftoff, b.v_liftoff)
        && near(MEETS_IN_TIME, a.slip_time, b.slip_time)
}
