//! Linear stability of sliding under the feedback of a motion.

use crate::linear::feedback_loop::FeedbackLoop;
use crate::linear::general::{DelayLine, RootCounter, Spectrum, System};
use crate::linear::rightmost::Rightmost;
use crate::linear::{Count, Crossings, MarginalTolerance};
use crate::model::{Channel, Groups, Lags};

/// Sliding at one velocity, dimensionless as a motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sliding {
    /// The groups of the letter's Eq. (3).
    pub groups: Groups,
    /// τ √(κ/M).
    pub tau: f64,
    /// Memory and latency of the feedback.
    pub channel: Channel,
}

impl Sliding {
    /// The number of unstable roots. Where it is not known the count is marginal.
    #[must_use]
    pub fn count(&self, tolerance: MarginalTolerance) -> Count {
        match self.general() {
            None => Crossings::of(self.groups).count(self.tau, tolerance),
            Some(system) => count_on(&DelayLine::of(&system), self.tau, tolerance),
        }
    }

    /// The spectral abscissa, in units of √(κ/M), if it is known and all roots are stable.
    #[must_use]
    pub fn stable_abscissa(&self) -> Option<f64> {
        let Some(system) = self.general() else {
            let count = self.count(MarginalTolerance::default());
            if !count.stable() {
                return None;
            }
            let rightmost = Rightmost::at(self.groups, self.tau, 1, count);
            let root = rightmost.roots.first().filter(|_| rightmost.certified);
            return root.map(|root| root.lambda.re);
        };
        let line = DelayLine::of(&system);
        if !count_on(&line, self.tau, MarginalTolerance::default()).stable() {
            return None;
        }
        let spectrum = Spectrum::at(&RootCounter::new(&system).bounded(), &line, self.tau, 1);
        Some(spectrum.abscissa).filter(|abscissa| spectrum.certified && *abscissa < 0.0)
    }

    /// The general system B(1 − RE) − A e^(−λδ)(1 − E); None where the feedback is the letter's
    /// own.
    fn general(&self) -> Option<System> {
        if !self.channel.acts() || self.groups.uncontrolled() {
            return None;
        }
        Some(FeedbackLoop::of_letter(self.groups, self.channel, Lags::default()).system())
    }
}

fn count_on(line: &DelayLine, tau: f64, tolerance: MarginalTolerance) -> Count {
    match line.uncounted {
        true => Count {
            n_unstable: 0,
            marginal: true,
        },
        false => line.count(tau, tolerance),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The least load gain that gives stable delays is −(1 + R)(b²/2 − b) for b < 0; with memory
    /// and latency velocity control works at b = −1.
    #[test]
    fn memory_and_latency_are_counted() {
        let least = |memory: f64| -1.5 * (1.0 + memory);
        for memory in [-0.3, 0.0, 0.5] {
            for (share, expected) in [(0.98, false), (1.05, true)] {
                let found = (1..2000).any(|i| {
                    let sliding = Sliding {
                        groups: Groups::new(-1.0, 0.0, share * least(memory)),
                        tau: 0.003 * f64::from(i),
                        channel: Channel {
                            memory,
                            latency: 0.0,
                        },
                    };
                    sliding.count(MarginalTolerance::default()).stable()
                });
                assert_eq!(found, expected, "{memory} {share}");
            }
        }
        let sliding = |b: f64, a_v: f64, tau: f64, memory: f64, latency: f64| Sliding {
            groups: Groups::new(b, a_v, 0.0),
            tau,
            channel: Channel { memory, latency },
        };
        // Stable for 1.63070 < τ < 4.57172.
        let late = |tau: f64| sliding(-1.0, -0.7, tau, 0.8, 0.7);
        assert!(late(3.0).stable_abscissa().is_some());
        assert!(late(1.6).stable_abscissa().is_none());
        // Without gains the memory has no effect.
        let idle = sliding(0.5, 0.0, 2.0, 0.8, 0.7);
        let plain = sliding(0.5, 0.0, 2.0, 0.0, 0.0);
        assert_eq!(idle.stable_abscissa(), plain.stable_abscissa());
    }
}
