//! One step of continuation in the delay: the end of a branch at one delay as the start of the
//! search at the next.
//!
//! The ends at the last four delays predict the next one. The pasts at the last two, both taken
//! just below their ends, predict the orbit just below the next end. From there v0 is raised by the
//! same continuation as in a search from scratch, without its check by a finer integration.

use super::continuation::{Point, continue_to_event, is_jump};
use super::end_of_branch::{approach, verify};
use super::event_functions::Event;
use super::options::AlongDelayOptions;
use super::problem::Problem;
use super::transition::{Ending, Sequel, Undetermined};
use super::with_history::{Released, WithHistory};
use crate::model::Feedback;
use crate::model::elementary::{exp, ln};
use crate::slip::motion::Motion;

/// The end of a branch, from which the next cell of a line starts.
#[derive(Debug, Clone)]
pub(super) struct Neighbour<'o> {
    options: &'o AlongDelayOptions,
    branch: WithHistory<'o, Motion>,
    at: Point,
    /// The state at the end of the branch in the cell before the last one.
    before: Option<Released<Motion>>,
    /// Delays and ends of the last cells.
    ends: Vec<(f64, f64)>,
    /// How the branch ends.
    event: Event,
    /// The error of the last prediction of an end, relative.
    off: f64,
    /// The least distance of the next start below its predicted end, relative.
    near: f64,
    /// Cells in a row whose ends were located with slopes of a cell before.
    borrowed: u32,
    /// The lowest minimum of ẋ over v0 beyond the end of the last cell that was followed beyond its
    /// end, the delay there, and its change with the logarithm of the delay; NaN where not known.
    clear: f64,
    seen_at: f64,
    change: f64,
    /// The number of ends since then, and the time in slip of a period at that cell.
    unseen: u32,
    slip_seen: f64,
    /// Whether it is known that stick-slip comes to this end.
    pub decided: bool,
    /// The kinds of stick-slip on the way from low velocities, by their slips in a period.
    pub way: Vec<usize>,
}

/// The number of ends that a prediction is made of.
const KNOWN_ENDS: usize = 4;

/// How far below the predicted end a cell starts, relative: at first, and at least.
fn nearest(event: Event, options: &AlongDelayOptions) -> [f64; 2] {
    match event {
        Event::LiftOff => [options.lift_off_first, options.lift_off_least],
        Event::Graze(_) => [options.graze_first, options.graze_least],
        Event::StickVanishes | Event::Reversal | Event::NewStop => {
            [options.vanish_first, options.vanish_least]
        }
    }
}

/// The point a cell starts from, and bounds for the start of the next cell.
struct Start {
    from: Point,
    /// The least and the largest distance below its end at which the next cell starts, relative.
    /// Larger errors of predictions override the latter.
    next_within: [f64; 2],
}

impl<'o> Neighbour<'o> {
    /// The neighbour for an `ending` of `problem` that follows the last point of `branch`.
    pub(super) fn new(
        problem: &'o Problem,
        branch: WithHistory<'o, Motion>,
        at: Point,
        ending: &Ending,
    ) -> Self {
        let options = &problem.options.along_delay;
        Self {
            options,
            branch,
            at,
            before: None,
            ends: vec![(problem.feedback.tau, ending.v0)],
            event: ending.event,
            off: options.first_off,
            near: nearest(ending.event, options)[0],
            borrowed: 0,
            clear: f64::NAN,
            seen_at: f64::NAN,
            change: f64::NAN,
            unseen: 0,
            slip_seen: f64::NAN,
            decided: true,
            way: Vec::new(),
        }
    }

    /// This neighbour with the knowledge of `other`, which was searched from scratch at the same
    /// cell.
    pub(super) fn like(mut self, other: &Self) -> Self {
        self.decided = other.decided;
        self.way.clone_from(&other.way);
        self
    }

    /// The end of stick-slip of `problem`, which differs from the last one by its delay alone. None
    /// where the branch does not lead to it; this neighbour must not be used again then.
    pub(super) fn next(&mut self, problem: &Problem) -> Option<Ending> {
        let mut trials = self.options.most_trials;
        self.approach(problem, &mut trials)
    }

    /// The end at the delay of `problem`, within the number of `trials` left. Where the whole way
    /// is too far, it goes by delays in between.
    fn approach(&mut self, problem: &Problem, trials: &mut u32) -> Option<Ending> {
        let first = nearest(self.event, self.options)[0];
        loop {
            *trials = trials.checked_sub(1)?;
            let from = self.clone();
            let sequel = match self.attempt(problem) {
                Ok(ending) => return Some(ending),
                Err(sequel) => sequel,
            };
            *self = from;
            if self.near >= first {
                match sequel {
                    Sequel::Undetermined(_) => break,
                    _ => return None,
                }
            }
            // The start may have been too near its end.
            self.near = first;
        }
        let last = self.ends.last()?.0;
        if (problem.feedback.tau / last - 1.0).abs() < self.options.least_change {
            return None;
        }
        let between = Problem {
            feedback: Feedback {
                tau: last + self.options.part * (problem.feedback.tau - last),
                ..problem.feedback
            },
            ..problem.clone()
        };
        self.approach(&between, trials)?;
        self.approach(problem, trials)
    }

    /// The end at the delay of `problem`, or what follows instead.
    fn attempt(&mut self, problem: &Problem) -> Result<Ending, Sequel> {
        let (tau, options) = (problem.feedback.tau, self.options);
        let predicted = self.predicted(tau);
        let ended = self.branch.accepted().clone();
        let Start { from, next_within } =
            self.set_out(tau, predicted).map_err(Sequel::Undetermined)?;
        let first = *self.branch.first_events();
        let continuation = &problem.options.continuation;
        let (located, at) =
            continue_to_event(&mut self.branch, from, options.farthest, continuation);
        let event = at.predict().event;
        let start = from.orbit.events.of(event);
        let transient = (first.of(event) - start) / at.slopes.of(event) / at.v0;
        self.near = (options.room * transient)
            .max(next_within[0])
            .min(next_within[1])
            .max(nearest(self.event, options)[1]);
        let ending = located
            .and_then(|located| approach(&mut self.branch, located, &at, &problem.options))
            .map_err(Sequel::Undetermined)?;
        match self.look(problem, &ending, predicted, at.orbit.period.slip_time()) {
            Sequel::Ends(_) => {}
            other => return Err(other),
        }
        self.off = (ending.v0 / predicted - 1.0).abs();
        self.borrowed = if at.own_slopes { 0 } else { self.borrowed + 1 };
        self.at = at;
        self.event = ending.event;
        self.before = Some(ended);
        if self.ends.len() == KNOWN_ENDS {
            self.ends.remove(0);
        }
        self.ends.push((tau, ending.v0));
        Ok(ending)
    }

    /// A first point at the delay `tau`, below the `predicted` end.
    fn set_out(&mut self, tau: f64, predicted: f64) -> Result<Start, Undetermined> {
        let options = self.options;
        let last = *self.ends.last().ok_or(Undetermined::NotSustained)?;
        if (tau / last.0 - 1.0).abs() > options.largest_change {
            return Err(Undetermined::OutsideDomain);
        }
        let mut near = (2.0 * self.off).max(self.near).min(options.farthest);
        if self.before.is_none() {
            // Without a second past a changed orbit starts with a larger transient.
            let change = (predicted / last.1 - 1.0).abs();
            near = (options.off_by_change * change).clamp(near, options.farthest);
        }
        let off = match self.borrowed >= options.most_borrowed {
            true => near.max(options.for_slopes),
            false => near,
        };
        let mut next_within = [0.0, options.nearer * near];
        let [farther, far] = options.farther.map(|factor| factor * off);
        let farthest = options.farthest_of_all * options.farthest;
        for off in [off, farther, far.min(options.farthest), farthest] {
            if let Some(from) = self.start(tau, predicted * (1.0 - off)) {
                let from = Point { predicted, ..from };
                return Ok(Start { from, next_within });
            }
            next_within = [off, options.nearer * options.farther[0] * off];
        }
        Err(Undetermined::NotSustained)
    }

    /// What follows an ending: by the ends before if these suffice, else by following the motion
    /// beyond it. The end was `predicted`, and its orbit slips for the time `slip` in a period.
    fn look(&mut self, problem: &Problem, ending: &Ending, predicted: f64, slip: f64) -> Sequel {
        if !ending.event.may_end() {
            return Sequel::Periodic(self.at.orbit.period.cycles().len());
        }
        let alike = ending.event == self.event
            && (ending.v0 / predicted - 1.0).abs() < self.options.as_expected
            && (slip / self.slip_seen - 1.0).abs() < self.options.same_slip;
        if alike && self.may_be_unseen(problem.feedback.tau) {
            self.unseen += 1;
            return Sequel::Ends(self.clear);
        }
        let seen = verify(problem, &mut self.branch, ending);
        if let Sequel::Ends(clear) = seen {
            self.see(problem.feedback.tau, clear);
            self.slip_seen = slip;
        }
        seen
    }

    /// Whether the next end, at `tau`, may be accepted without following the motion beyond it.
    /// Motions beyond the ends before were clear of a stop, and change smoothly along a line.
    fn may_be_unseen(&self, tau: f64) -> bool {
        let options = self.options;
        if self.unseen == options.most_unseen {
            return false;
        }
        if self.event == Event::StickVanishes {
            // Beyond a stick that vanishes no minimum of ẋ shows how clear the end is, so only a
            // small change of the delay is trusted.
            let near = |last: &(f64, f64)| (tau / last.0 - 1.0).abs() < options.small_change;
            return self.clear > 0.0 && self.ends.last().is_some_and(near);
        }
        // False for NaN.
        let since = ln(tau / self.seen_at).abs();
        self.clear > options.clear && options.caution * self.change * since < self.clear
    }

    /// Notes how clearly stick-slip ends at `tau`.
    fn see(&mut self, tau: f64, clear: f64) {
        self.change = ((clear - self.clear) / ln(tau / self.seen_at)).abs();
        (self.clear, self.seen_at, self.unseen) = (clear, tau, 0);
    }

    /// Whether the last end was far from where the ends before predicted it.
    pub(super) fn surprised(&self) -> bool {
        self.ends.len() == KNOWN_ENDS && self.off > self.options.surprise
    }

    /// Whether the motion beyond the last end was followed.
    pub(super) fn seen(&self) -> bool {
        self.unseen == 0
    }

    /// A first point at another delay.
    fn start(&mut self, tau: f64, v0: f64) -> Option<Point> {
        let last = self.ends.last()?.0;
        let before = match (&self.ends[..], &mut self.before) {
            ([.., one, other], Some(before)) => Some((before, (tau - other.0) / (other.0 - one.0))),
            _ => None,
        };
        let point = self.branch.restart(before, (v0, tau), &self.at)?;
        let change = (v0 / self.at.v0 - 1.0).abs().max((tau / last - 1.0).abs());
        let (here, there) = (&self.at.orbit.period, &point.orbit.period);
        (!is_jump(here, there, change, self.branch.options())).then_some(point)
    }

    /// Adds the end of an earlier cell that was found in another way: it makes the next prediction
    /// better.
    pub(super) fn recall(&mut self, tau: f64, end: f64) {
        if self.ends.len() < KNOWN_ENDS && self.ends.first().is_some_and(|first| tau < first.0) {
            self.ends.insert(0, (tau, end));
            let least = nearest(self.event, self.options)[1];
            self.off = least.max(self.options.recalled * self.off);
        }
    }

    /// The predicted end at `tau`: a polynomial through the logarithms of the last delays and ends
    /// (Neville).
    fn predicted(&self, tau: f64) -> f64 {
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
        // Limited, since a polynomial may extrapolate wildly.
        let (last, farthest) = (logs[n - 1].1, self.options.farthest_log);
        exp(p[0].clamp(last - farthest, last + farthest))
    }
}

#[cfg(test)]
mod tests {
    use super::super::follow::from_scratch;
    use super::super::synthetic::letters;
    use super::*;

    fn neighbour(problem: &Problem) -> Neighbour<'_> {
        from_scratch(problem).1.unwrap()
    }

    /// The letter's Fig. 3(a), and delays nearby.
    #[test]
    fn each_delay_starts_from_the_one_before() {
        let problems = [4.15, 4.16, 4.17, 4.18, 4.2].map(|tau| letters(-0.33, 0.0, tau));
        let mut neighbour = neighbour(&problems[0]);
        for problem in &problems[1..] {
            let found = neighbour.next(problem).unwrap();
            let scratch = from_scratch(problem).0.vc;
            assert!(
                (found.v0 / scratch - 1.0).abs() < 3e-5,
                "{found:?} {scratch}"
            );
            assert_eq!(found.event, Event::Graze(0));
        }
        assert_eq!(neighbour.ends.len(), KNOWN_ENDS);
    }

    /// A power law is a line in logarithms; four ends give a cubic.
    #[test]
    fn ends_are_predicted_by_a_polynomial_of_logarithms() {
        let problem = letters(-0.33, 0.0, 4.15);
        let mut neighbour = neighbour(&problem);
        neighbour.ends = vec![(1.0, 0.5), (1.1, 0.5 * 1.1 * 1.1), (1.2, 0.5 * 1.2 * 1.2)];
        assert!((neighbour.predicted(1.3) - 0.5 * 1.3 * 1.3).abs() < 1e-12);
        let cubic = |tau: f64| 0.3 * (0.2 * tau.ln().powi(3) - tau.ln()).exp();
        neighbour.ends = [1.0, 1.2, 1.5, 1.6].map(|tau| (tau, cubic(tau))).to_vec();
        assert!((neighbour.predicted(1.7) / cubic(1.7) - 1.0).abs() < 1e-12);
        // The distance from the last one is limited.
        neighbour.ends = vec![(1.0, 0.1), (1.01, 0.5)];
        assert!((neighbour.predicted(2.0) - 0.5 * 0.5_f64.exp()).abs() < 1e-12);
    }

    #[test]
    fn what_follows_is_looked_at_unless_it_was_clear() {
        let problem = letters(-0.33, 0.0, 4.15);
        let mut neighbour = neighbour(&problem);
        assert!(!neighbour.may_be_unseen(4.16));
        neighbour.see(4.0, 0.3);
        assert!(
            !neighbour.may_be_unseen(4.01),
            "how it changes is not known"
        );
        neighbour.see(4.05, 0.31);
        assert!(neighbour.may_be_unseen(4.1) && neighbour.seen());
        // It may have changed by a sixth of itself.
        assert!(!neighbour.may_be_unseen(5.5));
        neighbour.unseen = neighbour.options.most_unseen;
        assert!(!neighbour.may_be_unseen(4.1) && !neighbour.seen());
        neighbour.unseen = 0;
        neighbour.clear = 1e-3;
        assert!(!neighbour.may_be_unseen(4.1));
        // Where a stick vanishes only a small change of the delay is allowed.
        neighbour.event = Event::StickVanishes;
        assert!(neighbour.may_be_unseen(4.2) && !neighbour.may_be_unseen(4.4));
    }

    #[test]
    fn no_start_is_far_away() {
        let problem = letters(-0.33, 0.0, 4.15);
        let mut neighbour = neighbour(&problem);
        assert!(neighbour.set_out(7.0, 0.3).is_err());
        assert!(neighbour.next(&letters(-0.33, 0.0, 9.0)).is_none());
    }

    #[test]
    fn an_end_before_the_first_one_is_recalled() {
        let problem = letters(-0.33, 0.0, 4.15);
        let mut neighbour = neighbour(&problem);
        neighbour.recall(4.2, 0.4);
        assert_eq!(neighbour.ends.len(), 1);
        neighbour.recall(4.1, 0.34);
        assert_eq!(neighbour.ends[0], (4.1, 0.34));
        assert!((neighbour.off - 0.25 * 0.02).abs() < 1e-15);
        assert!(!neighbour.surprised());
    }
}
