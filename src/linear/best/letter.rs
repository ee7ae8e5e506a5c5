//! The controlled oscillator over a plane of one of its gains and the delay.

use num_complex::Complex64;

use super::regions::{MOST_STRETCHES, Stretch};
use super::search::{ByParameters, Family, Place};
use crate::linear::Crossings;
use crate::linear::characteristic::Jet;
use crate::linear::equation::Equation;
use crate::linear::gains::{load_gain_breakpoints, velocity_gain_breakpoints};
use crate::linear::sensitivity::Sensitivity;
use crate::model::stop::Stop;
use crate::model::{Control, Dashpots, Groups, Oscillator, SlidingPoint};

/// The gain that is searched; the other one stays as it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SearchedGain {
    /// a_v, velocity control.
    Velocity,
    /// a_n, load control.
    Load,
}

/// The letter's own system; all numbers dimensionless.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Letter {
    /// b, with both dashpots, and the gain that stays fixed, a_n without what a dashpot takes off
    /// it; the searched gain in it is not looked at.
    pub fixed: Groups,
    /// d and g.
    pub dashpots: Dashpots,
    /// Which gain is searched.
    pub gain: SearchedGain,
}

impl Letter {
    /// The family of a block on its spring.
    #[must_use]
    pub fn of(
        oscillator: &Oscillator,
        sliding: SlidingPoint,
        control: Control,
        gain: SearchedGain,
    ) -> Self {
        Self {
            fixed: oscillator.groups_without_coupling(sliding, control),
            dashpots: oscillator.dashpot_ratios(),
            gain,
        }
    }

    /// The groups at a value of the searched gain.
    #[must_use]
    pub fn groups(&self, gain: f64) -> Groups {
        let groups = match self.gain {
            SearchedGain::Velocity => Groups {
                a_v: gain,
                ..self.fixed
            },
            SearchedGain::Load => Groups {
                a_n: gain,
                ..self.fixed
            },
        };
        groups.coupled(self.dashpots.damping)
    }

    /// The part of b that is the slope of friction.
    #[must_use]
    pub(crate) fn slope(&self) -> f64 {
        self.fixed.b - self.dashpots.sum()
    }

    /// The gains at which crossings change their number; see [`crate::linear::gains`].
    #[must_use]
    pub fn changes_of_crossings(&self) -> Vec<f64> {
        let Groups { b, a_v, a_n } = self.fixed;
        let damping = self.dashpots.damping;
        match self.gain {
            SearchedGain::Velocity => velocity_gain_breakpoints(b, a_n, damping),
            SearchedGain::Load => {
                let points = load_gain_breakpoints(b, a_v).into_iter();
                points.map(|a_n| a_n + damping * a_v).collect()
            }
        }
    }
}

impl Family for Letter {
    type Setting = Groups;

    fn setting(&self, place: Place) -> Option<Groups> {
        Some(self.groups(place.p))
    }

    fn delay(&self, place: Place) -> f64 {
        place.q
    }

    fn equation(setting: &Groups) -> impl Equation {
        *setting
    }

    fn derivatives(setting: &Groups, tau: f64, lambda: Complex64) -> [Complex64; 4] {
        let groups = *setting;
        let jet = Jet::at(groups, tau, lambda);
        let third = (3.0 * groups.a_v - jet.feedback * tau) * jet.delayed * (tau * tau);
        [jet.value, jet.first, jet.second, third]
    }

    fn by_parameters(&self, place: Place, lambda: Complex64) -> Option<ByParameters> {
        let Place { p: gain, q: tau } = place;
        let groups = self.groups(gain);
        let jet = Jet::at(groups, tau, lambda);
        let memory = tau * jet.delayed;
        let tau_derivative = -jet.feedback * lambda * jet.delayed;
        let slope_q =
            -jet.delayed * (groups.a_v * lambda + jet.feedback - jet.feedback * lambda * tau);
        let (p, slope_p) = match self.gain {
            SearchedGain::Velocity => {
                let size = groups.b - self.dashpots.damping + lambda;
                (-size * jet.difference, -jet.difference - size * memory)
            }
            SearchedGain::Load => (-jet.difference, -memory),
        };
        Some(ByParameters {
            p,
            q: tau_derivative,
            slope_p,
            slope_q,
        })
    }

    fn gradient(&self, place: Place, lambda: Complex64) -> Option<[f64; 2]> {
        let by = Sensitivity::of(self.groups(place.p), place.q, lambda);
        let by = by.coupled(self.dashpots.damping);
        let by_gain = match self.gain {
            SearchedGain::Velocity => by.a_v,
            SearchedGain::Load => by.a_n,
        };
        Some([by_gain.re, by.tau.re])
    }

    /// The gains at which crossings change their number, and 0, where control may vanish.
    fn breakpoints(&self, _gains: &[f64], _stop: &Stop) -> Vec<f64> {
        let mut points = self.changes_of_crossings();
        points.push(0.0);
        points.retain(|p| p.is_finite());
        points
    }

    /// By the closed form [`Crossings::stable_delays`].
    fn stretches(&self, gain: f64, delays: (f64, f64)) -> Vec<Stretch> {
        let crossings = Crossings::of(self.groups(gain));
        crossings
            .stable_delays()
            .take_while(|interval| interval.from <= delays.1)
            .filter(|interval| interval.to >= delays.0)
            .take(MOST_STRETCHES)
            .filter_map(|interval| {
                let bounds = (
                    crossings.lower.map(|c| (0, c.branch_at(interval.from))),
                    crossings.upper.map(|c| (1, c.branch_at(interval.to))),
                );
                Stretch::cut(gain, (interval.from, interval.to), delays, bounds)
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn derivatives_match_difference_quotients() {
        for gain in [SearchedGain::Velocity, SearchedGain::Load] {
            let family = Letter {
                fixed: Groups::new(-0.4, 0.3, -0.2),
                dashpots: Dashpots {
                    damping: 0.15,
                    viscous: 0.05,
                },
                gain,
            };
            let (place, lambda) = (Place { p: -0.7, q: 2.3 }, Complex64::new(-0.2, 0.8));
            let h = 1e-5;
            let d = |gain: f64, tau: f64, shift: f64| {
                let place = Place {
                    p: place.p + gain,
                    q: place.q + tau,
                };
                Letter::derivatives(&family.groups(place.p), place.q, lambda + shift)
            };
            let quotient =
                |p: [Complex64; 4], q: [Complex64; 4]| [0, 1, 2].map(|i| (p[i] - q[i]) / (2.0 * h));
            let here = d(0.0, 0.0, 0.0);
            let by_lambda = quotient(d(0.0, 0.0, h), d(0.0, 0.0, -h));
            let by_gain = quotient(d(h, 0.0, 0.0), d(-h, 0.0, 0.0));
            let by_tau = quotient(d(0.0, h, 0.0), d(0.0, -h, 0.0));
            let by = family.by_parameters(place, lambda).expect("everywhere");
            for (found, expected) in [
                (here[1], by_lambda[0]),
                (here[2], by_lambda[1]),
                (here[3], by_lambda[2]),
                (by.p, by_gain[0]),
                (by.slope_p, by_gain[1]),
                (by.q, by_tau[0]),
                (by.slope_q, by_tau[1]),
            ] {
                assert!((found - expected).norm() < 1e-8, "{found} {expected}");
            }
        }
    }
}
