//! All latencies at one delay, and the latency margin.
//!
//! ```text
//! F(ω) = |B|²|1 − R E|² − 4|A|² sin²(ωτ/2),     e^(−iωδ) = B(1 − R E)/[A(1 − E)]            (1)
//! n(δ) = n(0) + 2 Σ_j s_j #{k ≥ 0: δ_{j,k} < δ},   δ_{j,k} = (θ_j + 2πk)/ω_j                (2)
//! ```
//!
//! n(0) is the count without latency at the delay τ.

use super::super::line::DelayLine;
use super::super::precise::resolve::Resolver;
use super::super::reason::Reason;
use super::super::right_of::RootCounter;
use super::super::switches::Switches;
use super::super::system::System;
use super::on_line::{Form, OnLine};
use crate::linear::count::MarginalTolerance;

impl DelayLine {
    /// The line of latencies of `system` at the delay `tau` ≥ 0: what the line calls delay is the
    /// latency, counted from 0 whatever latency `system` has itself. None where `system` is not in
    /// feedback form.
    #[must_use]
    pub fn of_latencies(system: &System, tau: f64) -> Option<Self> {
        let mut line = Self::default();
        line.find_latencies(system, tau).then_some(line)
    }

    /// Finds what [`DelayLine::of_latencies`] finds, in the memory of this line; false where there
    /// is none.
    pub(crate) fn find_latencies(&mut self, system: &System, tau: f64) -> bool {
        let (Some(at_once), Some(late)) = (system.with_latency(0.0), system.with_latency(1.0))
        else {
            return false;
        };
        self.find(&at_once);
        let start = self.count(tau, MarginalTolerance::default());
        let open = tau >= self.open_from;
        let Self {
            uncounted,
            always_marginal,
            reason,
            ..
        } = *self;
        self.clear();
        self.uncounted = uncounted && tau > 0.0;
        self.reason = reason;
        self.always_marginal = always_marginal;
        self.without_delay = start.n_unstable;
        self.at_zero_delay = start.n_unstable;
        self.marginal_at_zero = start.marginal;
        if tau == 0.0 || late.uncontrolled() {
            // The latency does not matter.
            self.always_marginal = start.marginal;
        } else if !self.uncounted {
            let settled = self.find_late_crossings(&late, tau);
            if open {
                self.always_marginal = true;
            } else if (start.marginal || !settled) && !self.always_marginal {
                let counter = RootCounter::new(&late);
                self.start_by_count(counter.late_unstable(Form::Latency, tau));
            }
        }
        true
    }

    /// Finds the crossings; false where the phase of one may be 0 as well as 2π.
    fn find_late_crossings(&mut self, late: &System, tau: f64) -> bool {
        let on_line = late.feedback_form().and_then(|f| OnLine::new(f, tau, 0.0));
        let mut switches = Switches::default();
        let found = on_line.as_ref().is_some_and(|on_line| {
            let wave = on_line.wave(Form::Latency);
            wave.switches(on_line.window(), &mut switches).is_ok()
        });
        let Some(on_line) = on_line.filter(|_| found) else {
            // Too many to be listed: nothing is said but what holds without latency.
            self.always_marginal = true;
            self.open_from = 0.0;
            return true;
        };
        if self.reason != Some(Reason::RootAtOrigin) {
            self.opens_below(switches.open_below);
        }
        let (mut resolver, mut settled) = (Resolver::of_latencies(late, tau), true);
        for switch in &switches.list {
            let phase = on_line.phase(Form::Latency, switch.omega, switch.error);
            settled &= self.add_resolved(&mut resolver, switch, phase);
        }
        settled
    }

    /// The first latency at which the number of unstable roots changes along a line of latencies
    /// that begins stable; 0 where it begins unstable, ∞ where nothing changes, NaN where that is
    /// open.
    #[must_use]
    pub(crate) fn latency_margin(&self) -> f64 {
        if self.uncounted {
            return match self.reason {
                Some(Reason::Infinite) => 0.0,
                _ => f64::NAN,
            };
        }
        if self.at_zero_delay > 0 || self.marginal_at_zero {
            return 0.0;
        }
        if self.always_marginal {
            let open = self.open_from == 0.0;
            return if open { f64::NAN } else { 0.0 };
        }
        let first = self.changes().next().map_or(f64::INFINITY, |c| c.tau);
        if first > self.open_from {
            return f64::NAN;
        }
        first
    }
}

impl System {
    /// The latency margin at the delay `tau` ≥ 0: the smallest latency, counted from 0 with
    /// everything else fixed, at which stability is lost. ∞ where there is none, 0 where the system
    /// is unstable or marginal without latency, NaN where that is open; none where the system is
    /// not in feedback form.
    #[must_use]
    pub fn latency_margin(&self, tau: f64) -> Option<f64> {
        DelayLine::of_latencies(self, tau).map(|line| line.latency_margin())
    }
}
