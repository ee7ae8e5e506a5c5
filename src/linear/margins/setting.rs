//! A setting whose margins are asked for: the letter's own, or one beyond it.

use super::beyond::{Beyond, Equations};
use super::equations::OnLine;
use super::gain::GainLoop;
use super::modulus::Modulus;
use super::of_system::SystemLoop;
use crate::model::elementary::ln;
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

/// A setting with the equations of its feedback.
#[derive(Debug, Clone)]
pub struct Case<L = Equations> {
    pub(super) setting: Setting,
    pub(super) on_line: L,
    stop: Stop,
}

/// What margins can be asked of.
pub trait AsCase {
    /// The equations of the feedback.
    type OnLine: OnLine;

    /// The setting with these equations.
    fn case(&self) -> Case<Self::OnLine>;
}

impl<L: OnLine> AsCase for Case<L> {
    type OnLine = L;

    fn case(&self) -> Self {
        self.clone()
    }
}

impl AsCase for Setting {
    type OnLine = Self;

    fn case(&self) -> Case<Self> {
        Case {
            setting: *self,
            on_line: *self,
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
    /// A setting with memory, latency, lags and a damped spring. Without gains the first two are
    /// left aside: there is nothing to remember and nothing that could be late.
    #[must_use]
    pub fn beyond(setting: Setting, mut beyond: Beyond) -> Self {
        if setting.groups.uncontrolled() {
            beyond.channel = Channel::default();
        }
        Self {
            setting,
            on_line: Equations::new(&setting, &beyond),
            stop: Stop::default(),
        }
    }
}

impl<L: OnLine> Case<L> {
    /// Once `stop` is set, margins are told soon, and mean nothing.
    pub(crate) fn heed(&mut self, stop: &Stop) {
        self.stop = stop.clone();
    }

    /// How near the loop comes to −1 on the line Re λ = −σ.
    pub(crate) fn modulus(&self) -> Modulus {
        let Setting { groups, tau, decay } = self.setting;
        let beyond = self.on_line.beyond().unwrap_or_default();
        let of = SystemLoop::on_line(&beyond.of_groups(groups).system(), tau, -decay);
        of.map_or(Modulus::UNKNOWN, |of| of.heeding(&self.stop).modulus())
    }

    /// Whether nobody waits for the margins any more.
    pub(super) fn stopped(&self) -> bool {
        self.stop.is_set()
    }

    /// Memory and latency.
    pub(super) fn channel(&self) -> Channel {
        self.on_line.beyond().unwrap_or_default().channel
    }

    /// The delay at which infinitely many roots come to the line Re λ = −σ: ln(1/|R|)/σ.
    pub(super) fn last_delay(&self) -> f64 {
        match self.channel().memory {
            0.0 => f64::INFINITY,
            memory => -ln(memory.abs()) / self.setting.decay,
        }
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
        self.on_line.stability(groups, tau)
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

impl<L: OnLine> GainLoop for Case<L> {
    type Function = L::Function;

    fn idle(&self) -> bool {
        self.setting.idle()
    }

    fn stopped(&self) -> bool {
        Self::stopped(self)
    }

    fn left_side(&self) -> L::Function {
        self.on_line.gain()
    }

    fn factor(&self, omega: f64) -> f64 {
        self.on_line.gain_factor(omega)
    }

    fn bound(&self, factor: f64) -> f64 {
        self.on_line.gain_bound(factor)
    }

    fn highest(&self) -> f64 {
        self.on_line.highest_with_gain()
    }

    /// On the imaginary axis there is none: without motion nothing is fed back.
    fn looks_at_zero(&self) -> bool {
        self.setting.decay > 0.0
    }

    fn stable_with(&self, factor: f64) -> Option<bool> {
        self.stability_with_gains(factor)
    }

    fn sure(&self) -> bool {
        self.setting.decay == 0.0
    }
}
