//! Continuation along a line of delays: each search starts from the orbit of its neighbour.
//!
//! Such a continuation may follow a branch of ends that stick-slip never reaches when v0 is raised
//! from low velocities. So the cells at both ends of a segment are searched from scratch, and the
//! continuation from one has to meet the other; else the segment is halved. It is also halved where
//! the kinds of stick-slip on the way from low velocities differ between its two ends. An event
//! that is passed at both ends may then be the end of stick-slip in between. A segment ends where a
//! kind of stick-slip ends. Where ends change fast, more cells are searched from scratch. A line is
//! cut into blocks, so that the answer in a cell depends on its block alone.

use super::delay_step::Neighbour;
use super::follow::from_scratch;
use super::options::AlongDelayOptions;
use super::problem::{CriticalVelocity, Method, Problem};

/// Cells of a block; blocks start at multiples of it.
pub const BLOCK: usize = 128;

/// The critical velocities of a block of a line: `problems` differ by their delay alone, which
/// increases. `stopped` is called before every visit to a cell. Once it returns true, some answers
/// are None and the others must not be used.
#[must_use]
pub fn critical_velocities(
    problems: &[Problem],
    stopped: impl Fn() -> bool,
) -> Vec<Option<CriticalVelocity>> {
    let mut block = Block {
        problems,
        found: vec![None; problems.len()],
        scratch: vec![false; problems.len()],
        ways: vec![None; problems.len()],
        stopped: &stopped,
    };
    if let Some(last) = problems.len().checked_sub(1) {
        let neighbour = block.start(0);
        if last > 0 {
            block.start(last);
        }
        block.fill(0, last, neighbour);
        block.settle();
    }
    let told = problems.iter().zip(block.found);
    told.map(|(problem, found)| found.map(|found| found.within_limits(problem)))
        .collect()
}

struct Block<'p> {
    problems: &'p [Problem],
    found: Vec<Option<CriticalVelocity>>,
    /// Which cells were searched from scratch.
    scratch: Vec<bool>,
    /// The kinds of stick-slip on the way to the end, for cells that were searched from scratch and
    /// from which continuation can start.
    ways: Vec<Option<Vec<usize>>>,
    stopped: &'p dyn Fn() -> bool,
}

impl<'p> Block<'p> {
    /// The options of the first problem, which hold for all.
    fn options(&self) -> &'p AlongDelayOptions {
        &self.problems[0].options.along_delay
    }

    /// Searches a cell from scratch.
    fn start(&mut self, cell: usize) -> Option<Neighbour<'p>> {
        if (self.stopped)() {
            return None;
        }
        let (critical, mut neighbour) = from_scratch(&self.problems[cell]);
        let alike = |c: &&CriticalVelocity| {
            c.transition == critical.transition && c.method == critical.method
        };
        for before in (0..cell).rev().take(2) {
            let Some(known) = self.found[before].as_ref().filter(alike) else {
                break;
            };
            if let Some(neighbour) = &mut neighbour {
                neighbour.recall(
                    self.problems[before].feedback.tau,
                    known.end_of_stick_slip(),
                );
            }
        }
        self.found[cell] = Some(critical);
        self.scratch[cell] = true;
        self.ways[cell] = neighbour.as_ref().map(|neighbour| neighbour.way.clone());
        neighbour
    }

    /// Searches from scratch the cells that were reached by continuation and are not decided.
    fn settle(&mut self) {
        for cell in 0..self.found.len() {
            let open = self.found[cell].is_some_and(|found| !found.decided);
            if open && !self.scratch[cell] {
                self.start(cell);
            }
        }
    }

    /// Fills the cells between two that were searched from scratch, by continuation from
    /// `neighbour` at the first one. Returns the neighbour at the last one, if continuation led
    /// there.
    fn fill(
        &mut self,
        mut first: usize,
        last: usize,
        mut neighbour: Option<Neighbour<'p>>,
    ) -> Option<Neighbour<'p>> {
        while first < last && !(self.stopped)() {
            let next = first + self.segment(first, last);
            if next < last {
                let there = self.start(next);
                neighbour = match (self.fill(first, next, neighbour), there) {
                    // Continuation goes on from the neighbour that already knows the ends before.
                    (Some(led), Some(there)) => Some(led.like(&there)),
                    (_, there) => there,
                };
                first = next;
                continue;
            }
            let (reached, known) = match &mut neighbour {
                Some(neighbour) => self.advance(first, last, neighbour),
                None => (first, true),
            };
            if reached == last {
                return neighbour;
            }
            if reached > first {
                if !known {
                    let (met, there) = self.meet(reached);
                    if !met {
                        self.halve(first, reached);
                        (first, neighbour) = (reached, there);
                        continue;
                    }
                }
                self.doubt(first, reached);
            }
            // Its kind of stick-slip ends there, or continuation fails.
            first = reached + 1;
            if first < last {
                neighbour = self.start(first);
            }
        }
        None
    }

    /// The length of a segment from `first` on, towards `last`.
    fn segment(&self, first: usize, last: usize) -> usize {
        let options = self.options();
        let longest = match &self.ways[first] {
            Some(way) if way.len() > 1 => options.short_segment,
            _ => options.segment,
        };
        match self.ways[first] == self.ways[last] {
            true => longest,
            // The kinds change somewhere in between, and ends may appear or vanish there.
            false => longest.min((last - first).div_ceil(2)),
        }
    }

    /// Finds by halving up to which cell a continuation is right that does not meet the `last` one.
    /// Fills the rest.
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

    /// Cells on the way to the `last` one are not decided where that one is not.
    fn doubt(&mut self, first: usize, last: usize) {
        let decided = self.found[last].is_some_and(|there| there.decided);
        for between in self.found[first + 1..last].iter_mut().flatten() {
            between.decided &= decided;
        }
    }

    /// Searches a cell from scratch that was reached by continuation. Returns whether the two
    /// answers meet, and the neighbour from there.
    fn meet(&mut self, cell: usize) -> (bool, Option<Neighbour<'p>>) {
        let continued = self.found[cell];
        let neighbour = self.start(cell);
        let both = continued.zip(self.found[cell]);
        (
            both.is_some_and(|(a, b)| meets(&a, &b, self.options())),
            neighbour,
        )
    }

    /// Continues from `first` on. Returns the last cell whose end is known, and whether that cell
    /// was searched from scratch. It is `last` if the continuation meets the end known there.
    fn advance(
        &mut self,
        first: usize,
        last: usize,
        neighbour: &mut Neighbour<'p>,
    ) -> (usize, bool) {
        let (mut seen, mut checked) = (first, first);
        for cell in first + 1..=last {
            if (self.stopped)() {
                return (seen, seen == checked);
            }
            let next = neighbour.next(&self.problems[cell]);
            let found = next.map(|ending| ending.critical_velocity(Method::GrazeOrbit));
            let Some(mut critical) = found else {
                return (seen, seen == checked);
            };
            if self.jumps(cell, &critical) {
                return (seen, seen == checked);
            }
            critical.decided = neighbour.decided;
            if cell == last {
                if self.found[last].is_none_or(|there| !meets(&there, &critical, self.options())) {
                    return (seen, seen == checked);
                }
                self.doubt(first, last);
                return (last, true);
            }
            self.found[cell] = Some(critical);
            self.scratch[cell] = false;
            if neighbour.surprised() && cell >= checked + self.options().surprises {
                // Where ends change that fast along the line, stick-slip may end earlier.
                if !self.meet(cell).0 {
                    return (seen, seen == checked);
                }
                (checked, seen) = (cell, cell);
            } else if neighbour.seen() {
                seen = cell;
            }
        }
        (last, true)
    }

    /// Whether the slip at the end `there` differs from that of the cell before by so much that the
    /// continuation has changed its branch. Cells from here on are then searched from scratch.
    fn jumps(&self, cell: usize, there: &CriticalVelocity) -> bool {
        let change = |from: f64, to: f64| (to / from - 1.0).abs();
        let expected = change(
            self.problems[cell - 1].feedback.tau,
            self.problems[cell].feedback.tau,
        );
        let before = self.found[cell - 1].map_or(f64::NAN, |before| before.slip_time);
        // False for NaN: a lift-off has no such time.
        change(before, there.slip_time) > self.options().jump_of_slip + expected
    }
}

/// Whether two answers agree.
fn meets(a: &CriticalVelocity, b: &CriticalVelocity, options: &AlongDelayOptions) -> bool {
    let near =
        |within: f64, a: f64, b: f64| a.is_nan() && b.is_nan() || (a - b).abs() <= within * a.abs();
    a.transition == b.transition
        && a.method == b.method
        && near(options.meets, a.vc, b.vc)
        && near(options.meets, a.v_liftoff, b.v_liftoff)
        && near(options.meets_in_time, a.slip_time, b.slip_time)
}

#[cfg(test)]
mod tests {
    use super::super::synthetic::{letters, problem};
    use super::super::work;
    use super::*;
    use crate::model::FrictionLaw;
    use std::cell::Cell;

    fn line(from: f64, to: f64, cells: usize) -> Vec<Problem> {
        let tau = |i: usize| from + (to - from) * i as f64 / (cells - 1) as f64;
        (0..cells).map(|i| letters(-0.33, 0.0, tau(i))).collect()
    }

    #[test]
    fn a_line_is_what_its_cells_are_from_scratch_for_less_work() {
        let problems = line(4.0, 4.2, 41);
        let (found, along) = work::of(|| critical_velocities(&problems, || false));
        let scratch = || {
            problems
                .iter()
                .map(|one| from_scratch(one).0)
                .collect::<Vec<_>>()
        };
        let (scratch, alone) = work::of(scratch);
        for (one, other) in found.iter().zip(&scratch) {
            let one = one.unwrap();
            assert_eq!(one.transition, other.transition);
            assert!((one.vc / other.vc - 1.0).abs() < 1e-4, "{one:?} {other:?}");
        }
        assert!(3 * along.trials < alone.trials, "{along:?} {alone:?}");
        assert!(3 * along.steps < alone.steps, "{along:?} {alone:?}");
    }

    /// From τ = 4.214 to 4.272 stick-slip ends by a graze at 0.234. At other delays it passes that
    /// graze on its way to another one, at 0.34 to 0.39.
    #[test]
    fn an_end_that_opens_below_for_a_few_cells_is_found() {
        let law = FrictionLaw::weakening(0.5, 0.4288, 1.0).unwrap();
        let taus = [4.14, 4.16, 4.18, 4.2, 4.22, 4.24, 4.26, 4.34, 4.36];
        let problems = taus.map(|tau| problem(law.clone(), -0.3888, 0.0, tau));
        let found = critical_velocities(&problems, || false).into_iter();
        let low = found.map(|one| one.is_some_and(|one| one.decided && one.vc < 0.24));
        let known = taus.map(|tau| (4.22..4.27).contains(&tau));
        assert_eq!(low.collect::<Vec<_>>(), known);
    }

    #[test]
    fn a_line_that_is_stopped_has_cells_without_an_answer() {
        let problems = line(4.0, 4.2, 5);
        let visits = Cell::new(0);
        let found = critical_velocities(&problems, || {
            visits.set(visits.get() + 1);
            visits.get() > 2
        });
        assert!(found[0].is_some() && found[4].is_some());
        assert!(found[1..4].iter().all(Option::is_none));
        assert!(critical_velocities(&[], || false).is_empty());
        let one = critical_velocities(&problems[..1], || false);
        assert!(one.len() == 1 && one[0].is_some());
    }

    #[test]
    fn answers_meet_in_velocity_and_in_slip_time() {
        let options = AlongDelayOptions::default();
        let one = from_scratch(&letters(-0.33, 0.0, 4.15)).0;
        let other = |vc: f64, slip_time: f64| CriticalVelocity {
            vc: one.vc * vc,
            slip_time: one.slip_time * slip_time,
            ..one
        };
        assert!(meets(&one, &other(1.00002, 1.005), &options));
        assert!(!meets(&one, &other(1.00004, 1.0), &options));
        assert!(!meets(&one, &other(1.0, 1.02), &options));
    }

    #[test]
    fn a_branch_that_gets_to_another_slip_jumps() {
        let problems = line(4.1, 4.11, 2);
        let one = from_scratch(&problems[0]).0;
        let block = Block {
            problems: &problems,
            found: vec![Some(one), None],
            scratch: vec![true, false],
            ways: vec![None; 2],
            stopped: &|| false,
        };
        let jumps = |change: f64| {
            let slip_time = one.slip_time * change;
            block.jumps(1, &CriticalVelocity { slip_time, ..one })
        };
        assert!(jumps(0.9) && jumps(1.06));
        assert!(!jumps(0.97) && !jumps(1.03) && !jumps(f64::NAN));
    }

    #[test]
    fn what_is_in_doubt_at_the_end_is_so_on_the_way_until_it_is_looked_for() {
        let problems = line(4.1, 4.2, 3);
        let decided = Some(from_scratch(&problems[0]).0);
        let open = decided.map(|found| CriticalVelocity {
            decided: false,
            ..found
        });
        let mut block = Block {
            problems: &problems,
            found: vec![decided, decided, open],
            scratch: vec![true, false, true],
            ways: vec![None; 3],
            stopped: &|| false,
        };
        block.doubt(0, 2);
        let told = |block: &Block| [0, 1, 2].map(|cell| block.found[cell].unwrap().decided);
        assert_eq!(told(&block), [true, false, false]);
        // That is not its last word.
        block.settle();
        assert_eq!(told(&block), [true, true, false]);
        let [settled, scratch] = [block.found[1].unwrap(), from_scratch(&problems[1]).0];
        assert_eq!(settled.vc, scratch.vc);
    }
}
