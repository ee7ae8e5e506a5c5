//! Any linear system with one delay, and with latency.

use std::cell::OnceCell;

use super::{Intervals, Line, Roots};
use crate::linear::count::{Count, MarginalTolerance};
use crate::linear::crossing::Crossing;
use crate::linear::general::stable::{Change, StableIntervals};
use crate::linear::general::{Class, DelayLine, Reason, RightOf, RootCounter, Spectrum};

/// The roots of a general system.
pub(super) struct GeneralRoots {
    counter: RootCounter,
    line: OnceCell<DelayLine>,
}

impl GeneralRoots {
    /// The roots as `counter` finds them.
    pub(super) fn new(counter: RootCounter) -> Self {
        Self {
            counter,
            line: OnceCell::new(),
        }
    }

    /// All delays, dimensionless, found when they are first asked for.
    fn delays(&self) -> &DelayLine {
        self.line
            .get_or_init(|| DelayLine::of(self.counter.system()))
    }
}

impl Roots for GeneralRoots {
    fn line(&self, time_unit: f64) -> Box<dyn Line> {
        Box::new(self.delays().clone().in_physical_time(time_unit))
    }

    fn count(&self, tau: f64, time_unit: f64) -> Option<Count> {
        Line::count(self.delays(), tau / time_unit, MarginalTolerance::default())
    }

    fn spectrum(&self, tau: f64, wanted: usize) -> Spectrum {
        Spectrum::at(&self.counter, self.delays(), tau, wanted)
    }

    fn right_of(&self, tau: f64, line: f64) -> RightOf {
        match self.counter.system().class() {
            Class::DegreeUnknown | Class::Refused => RightOf::Undecided,
            _ => self.counter.right_of(tau, line),
        }
    }

    fn uncontrolled(&self) -> bool {
        self.counter.system().uncontrolled()
    }
}

impl Line for DelayLine {
    fn time_unit(&self) -> f64 {
        self.time_unit
    }

    /// Without a delay, D is a polynomial and has finitely many roots.
    fn count(&self, tau: f64, tolerance: MarginalTolerance) -> Option<Count> {
        (!self.uncounted || tau == 0.0).then(|| DelayLine::count(self, tau, tolerance))
    }

    fn reason(&self) -> Option<Reason> {
        self.reason
    }

    fn n_at_zero_delay(&self) -> Option<u64> {
        (!self.uncounted).then_some(self.at_zero_delay)
    }

    fn crossings(&self) -> Box<dyn Iterator<Item = &Crossing> + '_> {
        Box::new(self.crossings.iter())
    }

    fn crossings_known(&self) -> bool {
        DelayLine::crossings_known(self)
    }

    fn changes(&self) -> Box<dyn Iterator<Item = Change> + '_> {
        Box::new(DelayLine::changes(self))
    }

    fn stable_intervals(&self) -> Box<dyn Intervals + '_> {
        Box::new(DelayLine::stable_intervals(self))
    }

    /// Where infinitely many roots are unstable at every delay, that never changes.
    fn delay_margin(&self, tau: f64) -> f64 {
        match self.reason {
            Some(Reason::Infinite) if tau > 0.0 => f64::NEG_INFINITY,
            _ => DelayLine::delay_margin(self, tau),
        }
    }
}

impl Intervals for StableIntervals<'_> {
    fn gave_up(&self) -> bool {
        StableIntervals::gave_up(self)
    }
}
