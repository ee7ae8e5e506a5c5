//! The letter's own model: crossings in closed form, roots by the letter's equation.

use super::{Intervals, Line, Roots};
use crate::linear::certificate::roots_right_of;
use crate::linear::count::{Count, MarginalTolerance};
use crate::linear::crossing::{Crossing, Crossings};
use crate::linear::general::stable::{Change, Changes};
use crate::linear::general::{RightOf, Spectrum};
use crate::linear::rightmost::Rightmost;
use crate::linear::stable_delays::StableDelays;
use crate::model::Groups;

/// The letter's roots.
pub(super) struct LetterRoots {
    groups: Groups,
    crossings: Crossings,
}

impl LetterRoots {
    pub(super) fn new(groups: Groups) -> Self {
        Self {
            groups,
            crossings: Crossings::of(groups),
        }
    }
}

impl Roots for LetterRoots {
    fn line(&self, time_unit: f64) -> Box<dyn Line> {
        Box::new(self.crossings.in_physical_time(time_unit))
    }

    fn count(&self, tau: f64, time_unit: f64) -> Option<Count> {
        let crossings = self.crossings.in_physical_time(time_unit);
        Some(crossings.count(tau, MarginalTolerance::default()))
    }

    fn spectrum(&self, tau: f64, wanted: usize) -> Spectrum {
        let count = self.crossings.count(tau, MarginalTolerance::default());
        let found = Rightmost::at(self.groups, tau, wanted, count);
        Spectrum {
            count: Some(count),
            abscissa: found.roots.first().map_or(f64::NAN, |root| root.lambda.re),
            roots: found.roots,
            essential_abscissa: f64::NEG_INFINITY,
            margin: found.margin,
            certified: found.certified,
            reason: None,
            missing: found.missing,
        }
    }

    fn right_of(&self, tau: f64, line: f64) -> RightOf {
        roots_right_of(self.groups, tau, line).map_or(RightOf::Undecided, RightOf::Roots)
    }

    fn uncontrolled(&self) -> bool {
        self.groups.uncontrolled()
    }
}

impl Line for Crossings {
    fn time_unit(&self) -> f64 {
        self.time_unit
    }

    fn count(&self, tau: f64, tolerance: MarginalTolerance) -> Option<Count> {
        Some(Crossings::count(self, tau, tolerance))
    }

    fn n_unstable(&self, tau: f64) -> Option<u64> {
        Some(Crossings::n_unstable(self, tau))
    }

    fn n_at_zero_delay(&self) -> Option<u64> {
        Some(self.at_zero_delay)
    }

    fn crossings(&self) -> Box<dyn Iterator<Item = &Crossing> + '_> {
        Box::new(self.iter())
    }

    fn changes(&self) -> Box<dyn Iterator<Item = Change> + '_> {
        Box::new(Changes::from(self.iter(), None))
    }

    fn stable_intervals(&self) -> Box<dyn Intervals + '_> {
        Box::new(self.stable_delays())
    }

    fn delay_margin(&self, tau: f64) -> f64 {
        Crossings::delay_margin(self, tau)
    }
}

impl Intervals for StableDelays {}
