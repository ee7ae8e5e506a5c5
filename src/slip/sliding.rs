//! Linear stability of sliding under the feedback of a motion.

use crate::linear::line::{Linear, Roots};
use crate::linear::sampled::SampledLoop;
use crate::linear::{Count, MarginalTolerance};
use crate::model::stop::Stop;
use crate::model::{Channel, Groups};

/// Roots that are asked for where one alone is not told apart from others.
const MORE: usize = 4;

/// Sliding at one velocity, dimensionless as a motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sliding {
    /// The groups of the letter's Eq. (3).
    pub groups: Groups,
    /// τ √(κ/M).
    pub tau: f64,
    /// Memory and latency of the feedback.
    pub channel: Channel,
    /// h √(κ/M), the time from reading to reading; 0 without.
    pub sample_time: f64,
}

impl Sliding {
    /// The number of unstable roots. Where it is not known the count is marginal.
    #[must_use]
    pub fn count(&self, tolerance: MarginalTolerance) -> Count {
        let roots = self.roots();
        let count = roots.and_then(|roots| roots.line(1.0).count(self.tau, tolerance));
        count.unwrap_or(Count {
            n_unstable: 0,
            marginal: true,
        })
    }

    /// The spectral abscissa, in units of √(κ/M), if it is known and all roots are stable.
    #[must_use]
    pub(crate) fn stable_abscissa(&self) -> Option<f64> {
        let roots = self.roots()?;
        let count = roots
            .line(1.0)
            .count(self.tau, MarginalTolerance::default());
        if !count.is_some_and(|count| count.stable()) {
            return None;
        }
        let found = roots.spectrum(self.tau, 1);
        Some(found.abscissa).filter(|abscissa| found.certified && *abscissa < 0.0)
    }

    /// The spectral abscissa as far as it is known where all roots are stable, if not certified;
    /// none where they are not, or are not counted.
    pub(crate) fn slowest(&self) -> Option<f64> {
        if let Some(certified) = self.stable_abscissa() {
            return Some(certified);
        }
        let count = self.count(MarginalTolerance::default());
        let found = self.roots()?.spectrum(self.tau, MORE);
        Some(found.abscissa).filter(|abscissa| count.stable() && *abscissa < 0.0)
    }

    /// The roots; none where the latency is no multiple of the sample time.
    fn roots(&self) -> Option<Box<dyn Roots>> {
        let linear = match self.sample_time > 0.0 && !self.groups.uncontrolled() {
            true => {
                let of_loop = SampledLoop::new(self.groups, self.channel, self.sample_time);
                Linear::Sampled(of_loop?)
            }
            false => Linear::of_feedback(self.groups, self.channel),
        };
        Some(linear.roots(&Stop::default()))
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
                        sample_time: 0.0,
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
            sample_time: 0.0,
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
