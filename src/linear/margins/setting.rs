//! A setting whose margins are asked for: the letter's own, or one beyond it.

use super::beyond::Beyond;
use crate::linear::certificate::roots_right_of;
use crate::linear::{Crossings, MarginalTolerance};
use crate::model::stop::Stop;
use crate::model::{Channel, Groups};

/// A setting whose margins are asked for, in dimensionless numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Setting {
    /// b, a_v and a_n.
    pub groups: Groups,
    /// τ ≥ 0, in units of √(M/κ).
    pub tau: f64,
    /// σ ≥ 0, the required decay rate, in units of √(κ/M).
    pub decay: f64,
}

/// A setting with what its feedback has beyond the letter's own, where it has any of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Case {
    pub(super) setting: Setting,
    pub(super) beyond: Option<Beyond>,
    stop: Stop,
}

/// What margins can be asked of.
pub trait AsCase {
    /// The setting, with what its feedback has beyond the letter's own.
    fn case(&self) -> Case;
}

impl AsCase for Case {
    fn case(&self) -> Case {
        self.clone()
    }
}

impl AsCase for Setting {
    fn case(&self) -> Case {
        Case {
            setting: *self,
            beyond: None,
            stop: Stop::default(),
        }
    }
}

impl Setting {
    /// Whether all roots are left of the line, beyond doubt.
    #[must_use]
    pub fn stable(&self) -> bool {
        self.case().stable()
    }

    /// Whether no control acts, whatever its gains and its phase are.
    pub(super) fn idle(&self) -> bool {
        self.groups.uncontrolled() || self.tau == 0.0
    }
}

impl Case {
    /// A setting with memory, latency and lags. Without gains the first two are left aside: there
    /// is nothing to remember and nothing that could be late.
    #[must_use]
    pub fn beyond(setting: Setting, mut beyond: Beyond) -> Self {
        if setting.groups.uncontrolled() {
            beyond.channel = Channel::default();
        }
        Self {
            setting,
            beyond: Some(beyond),
            stop: Stop::default(),
        }
    }

    /// The same, but once `stop` is set margins are told soon, and mean nothing.
    #[must_use]
    pub fn heeding(self, stop: &Stop) -> Self {
        let stop = stop.clone();
        Self { stop, ..self }
    }

    /// Whether nobody waits for the margins any more.
    pub(super) fn stopped(&self) -> bool {
        self.stop.is_set()
    }

    /// Whether the feedback has anything beyond the letter's own.
    #[must_use]
    pub fn is_beyond(&self) -> bool {
        self.beyond.is_some()
    }

    /// Whether all roots are left of the line, beyond doubt.
    #[must_use]
    pub fn stable(&self) -> bool {
        let Setting { groups, tau, .. } = self.setting;
        self.stability_at(groups, tau) == Some(true)
    }

    /// Whether all roots are left of the line with other groups and another delay; none where one
    /// is on it within rounding, and once nobody waits for it.
    pub(super) fn stability_at(&self, groups: Groups, tau: f64) -> Option<bool> {
        if self.stopped() {
            return None;
        }
        let decay = self.setting.decay;
        match &self.beyond {
            Some(beyond) => beyond.stability(groups, tau, decay),
            None => stability(groups, tau, decay),
        }
    }

    /// Whether all roots are left of the line with both gains `factor` times as large; none where
    /// one is on it within rounding.
    pub(super) fn stability_with_gains(&self, factor: f64) -> Option<bool> {
        let Groups { b, a_v, a_n } = self.setting.groups;
        let groups = Groups::new(b, factor * a_v, factor * a_n);
        self.stability_at(groups, self.setting.tau)
    }

    /// Whether all roots are left of the line at the slope `b`; none where one is on it within
    /// rounding.
    pub(super) fn stability_with_slope(&self, b: f64) -> Option<bool> {
        let Setting { groups, tau, .. } = self.setting;
        self.stability_at(Groups { b, ..groups }, tau)
    }
}

/// Whether all roots are left of Re λ = −`decay`; none where one is on that line within rounding.
fn stability(groups: Groups, tau: f64, decay: f64) -> Option<bool> {
    if decay == 0.0 {
        let count = Crossings::of(groups).count(tau, MarginalTolerance::default());
        return (!count.marginal).then_some(count.n_unstable == 0);
    }
    roots_right_of(groups, tau, -decay).map(|roots| roots == 0)
}
