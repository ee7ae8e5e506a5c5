//! What feedback has beyond the letter's own, and which settings of it are stable.

use num_complex::Complex64;

use crate::linear::MarginalTolerance;
use crate::linear::characteristic::one_minus_exp;
use crate::linear::general::{DelayLine, Polynomial, RightOf, RootCounter, Source, System};
use crate::linear::stable_delays::StableInterval;
use crate::model::Groups;
use crate::model::elementary::ln;

/// What feedback has beyond the letter's own, in dimensionless numbers: (1) and (2) of `beyond`.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Beyond {
    /// R, the memory, between −1 and 1.
    pub memory: f64,
    /// δ ≥ 0, the latency, in units of √(M/κ).
    pub latency: f64,
    /// T_a ≥ 0, the lag of the load behind its command, in units of √(M/κ).
    pub load_lag: f64,
    /// T_v ≥ 0, the lag of the pulling velocity behind its command, in units of √(M/κ).
    pub velocity_lag: f64,
    /// T_s ≥ 0, the lag of the sensor behind the elongation, in units of √(M/κ).
    pub sensor_lag: f64,
}

/// Degrees here are 5 at the most.
const LOW: &str = "a low degree";

pub(super) fn polynomial(coefficients: &[f64]) -> Polynomial {
    Polynomial::new(coefficients).expect(LOW)
}

pub(super) fn times(one: &Polynomial, other: &Polynomial) -> Polynomial {
    one.times(other).expect(LOW)
}

/// The lags as polynomials in λ.
#[derive(Debug, Clone, Copy)]
pub(super) struct Lags {
    /// L_a.
    pub load: Polynomial,
    /// L_v.
    pub velocity: Polynomial,
    /// L_a L_v L_s.
    pub all: Polynomial,
}

impl Beyond {
    pub(super) fn lags(&self) -> Lags {
        let [load, velocity, sensor] = [self.load_lag, self.velocity_lag, self.sensor_lag]
            .map(|time| polynomial(&[1.0, time]));
        Lags {
            load,
            velocity,
            all: times(&times(&load, &velocity), &sensor),
        }
    }

    /// B and A.
    pub(super) fn polynomials(&self, groups: Groups) -> [Polynomial; 2] {
        let Groups { b, a_v, a_n } = groups;
        let lags = self.lags();
        let load = Polynomial::ZERO.plus(&lags.velocity, a_n);
        let velocity = times(&polynomial(&[b, 1.0]), &lags.load);
        [
            times(&polynomial(&[1.0, b, 1.0]), &lags.all),
            load.plus(&velocity, a_v),
        ]
    }

    /// The system (1) of `beyond`.
    #[must_use]
    pub fn system(&self, groups: Groups) -> System {
        let [open, gain] = self.polynomials(groups);
        let lags = [self.load_lag, self.velocity_lag, self.sensor_lag];
        System::feedback(open, gain, self.memory, self.latency).known_by(Source { groups, lags })
    }

    /// Whether all roots are left of Re λ = −`decay` at the delay `tau`; none where one is on that
    /// line within rounding. On the imaginary axis the answer comes from the crossings, as in maps.
    pub(in super::super) fn stability(&self, groups: Groups, tau: f64, decay: f64) -> Option<bool> {
        let system = self.system(groups);
        if decay == 0.0 {
            let line = DelayLine::of(&system);
            let count = line.count(tau, MarginalTolerance::default());
            let known = !line.uncounted && !count.marginal;
            return known.then_some(count.n_unstable == 0);
        }
        match RootCounter::new(&system).right_of(tau, -decay) {
            RightOf::Roots(roots) => Some(roots == 0),
            RightOf::Infinite => Some(false),
            RightOf::Undecided => None,
        }
    }

    /// The interval of delays around `tau` in which sliding is stable; none where it is not. And
    /// how many frequencies took many digits.
    pub(in super::super) fn stable_interval_at(
        &self,
        groups: Groups,
        tau: f64,
    ) -> (Option<StableInterval>, u32) {
        let line = DelayLine::of(&self.system(groups));
        (line.stable_interval_at(tau), line.resolved)
    }

    /// The delay at which infinitely many roots come to the line Re λ = −`decay`: ln(1/|R|)/σ.
    pub(in super::super) fn last_delay(&self, decay: f64) -> f64 {
        match self.memory {
            0.0 => f64::INFINITY,
            memory => -ln(memory.abs()) / decay,
        }
    }

    /// e^(−λδ).
    pub(super) fn late(&self, lambda: Complex64) -> Complex64 {
        1.0 - one_minus_exp(-self.latency * lambda)
    }
}
