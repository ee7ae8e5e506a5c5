//! Any system with one delay as a loop whose margins are asked for.
//!
//! With U and V of [`general`](crate::linear::general), D = U + k V:
//!
//! ```text
//! gain k:   Im[V U*] = 0,   k = −|U|²/Re[V U*]                                              (1)
//! ```
//!
//! on λ = σ + iω. ω = 0 is among the zeros: there a real root passes the line. A neutral system of
//! P and Q loses its stability at the latest where |k q_n/p_n| e^(−στ) = 1.

use num_complex::Complex64;

use super::form::{Form, Sides};
use super::gain::{GainLoop, MOST_GAINS};
use super::sum::Part;
use super::turns::{PhaseMargin, omega_at};
use crate::linear::MarginalTolerance;
use crate::linear::general::{Class, DelayLine, RightOf, RootCounter, System, without_idle_zeros};
use crate::linear::newton::divide;
use crate::linear::real_zeros::zeros;
use crate::model::elementary::norm;
use crate::model::stop::Stop;

/// How much the factor of a crossing may differ from 1 for the crossing of a system that is on the
/// boundary itself.
const ON_THE_BOUNDARY: f64 = 1e-5;
/// Factors up to which the crossing of a system on the boundary is looked for.
const NEARBY: f64 = 1.25;

/// A system at one delay as a loop, on the line Re λ = σ.
///
/// ```
/// use slipmap::linear::general::System;
/// use slipmap::linear::margins::{MarginSearch, SystemLoop};
///
/// // s + 0.5 e^(−s): an integrator with the gain 0.5 and the delay 1.
/// let system = System::of_coefficients(&[0.0, 1.0], &[0.5])?;
/// let of = SystemLoop::new(&system, 1.0).expect("a loop");
/// let gain = MarginSearch::default().gain_margin(&of);
/// assert!((gain.limits.upper - std::f64::consts::PI).abs() < 1e-12);
/// # Ok::<(), slipmap::model::ModelError>(())
/// ```
#[derive(Debug, Clone)]
pub struct SystemLoop {
    /// The system, in a unit of time in which it is of the order of 1, and that unit.
    pub(super) system: System,
    pub(super) unit: f64,
    /// The delay in that unit.
    pub(super) tau: f64,
    pub(super) line: f64,
    pub(super) sides: Sides,
    /// Im[V U*], on the imaginary axis without what has the sign of no factor.
    turned: Form,
    stop: Stop,
}

impl SystemLoop {
    /// The loop of `system` at the delay `tau` ≥ 0; none where a root at 0 at every delay is left
    /// out of it, and where its degree is not known.
    #[must_use]
    pub fn new(system: &System, tau: f64) -> Option<Self> {
        Self::on_line(system, tau, 0.0)
    }

    /// The loop of `system` at the delay `tau` on the line Re λ = `line`; none as for
    /// [`SystemLoop::new`].
    pub(crate) fn on_line(system: &System, tau: f64, line: f64) -> Option<Self> {
        if matches!(system.class(), Class::DegreeUnknown | Class::Refused) {
            return None;
        }
        let unit = system.time_unit();
        let system = match unit {
            1.0 => *system,
            unit => system.in_unit(unit),
        };
        let (tau, line) = (tau / unit, line * unit);
        let of = system.loop_sides(tau)?;
        let sides = Sides::new(&of, tau, line);
        let turned = match line == 0.0 {
            true => {
                let (rest, is_real) = without_idle_zeros(of, tau);
                let part = if is_real { Part::Real } else { Part::Imaginary };
                Sides::new(&rest, tau, line).both(part)
            }
            false => sides.both(Part::Imaginary),
        };
        Some(Self {
            system,
            unit,
            tau,
            line,
            sides,
            turned,
            stop: Stop::default(),
        })
    }

    /// This loop; once `stop` is set, its margins are told soon, and mean nothing.
    #[must_use]
    pub fn heeding(mut self, stop: &Stop) -> Self {
        self.stop = stop.clone();
        self
    }

    /// Whether nothing is fed back, whatever the gain is.
    #[must_use]
    pub fn idle(&self) -> bool {
        let differences = self.system.is_of_differences();
        self.system.uncontrolled() || (differences && self.tau == 0.0)
    }

    /// The ω beyond which |L| < 1/`factor`.
    pub(super) fn within(&self, factor: f64) -> f64 {
        self.system.loop_bound(factor, self.tau, self.line)
    }

    /// How many times as large gains are looked at where no loss is found; infinite where all are.
    #[must_use]
    pub fn most_gains(&self) -> f64 {
        match self.idle() || self.highest().is_finite() {
            true => f64::INFINITY,
            false => MOST_GAINS,
        }
    }

    /// The loop L = V/U at λ = σ + iω, ω > 0.
    #[must_use]
    pub fn value(&self, omega: f64) -> Complex64 {
        let [own, fed] = self.sides.at(omega * self.unit);
        divide(fed, own)
    }

    /// Frequencies at which L changes: the sizes of the zeros of the polynomials of U and V but 0,
    /// 1/τ, and that beyond which |L| < 1.
    #[must_use]
    pub fn frequencies(&self) -> Vec<f64> {
        let sides = self.system.loop_sides(self.tau).into_iter().flatten();
        let zeros = sides.flat_map(|side| side.zeros());
        let mut all: Vec<f64> = zeros
            .map(norm)
            .chain([1.0 / self.tau, self.within(1.0)])
            .collect();
        all.retain(|omega| *omega > 0.0 && omega.is_finite());
        all.iter().map(|omega| omega / self.unit).collect()
    }

    /// Whether no delay and no latency acts.
    pub(super) fn undelayed(&self) -> bool {
        self.tau == 0.0 && self.system.latency() == 0.0
    }

    /// The phase margin: the least angle of either sign by which L may turn. It is the angle at the
    /// crossings of the line of what is late in V alone: the delay of P and Q, else the latency.
    #[must_use]
    pub fn phase(&self) -> PhaseMargin {
        if self.idle() {
            return PhaseMargin::ENDLESS;
        }
        let (line, late) = self.late_line();
        if !line.crossings_known() {
            return PhaseMargin::UNKNOWN;
        }
        let found = PhaseMargin::of(line.crossings.iter(), late);
        PhaseMargin {
            omega: found.omega / self.unit,
            ..found
        }
    }

    /// The latency margin, with ω of the crossing there: the largest latency of V up to which the
    /// loop is stable, counted from none with all else as it is. P and Q have none of their own:
    /// there it is the largest further delay. Infinite where no latency matters, 0 where the loop
    /// is not stable without latency, NaN where it is not known.
    #[must_use]
    pub fn latency(&self) -> (f64, f64) {
        if self.idle() {
            let margin = if self.stable() { f64::INFINITY } else { 0.0 };
            return (margin, f64::NAN);
        }
        let (line, late) = self.late_line();
        let (margin, at) = match self.system.is_of_differences() {
            true => (line.latency_margin(), line.latency_margin()),
            false if !self.stable() => (0.0, f64::NAN),
            false => line
                .stable_interval_at(late)
                .map_or((f64::NAN, f64::NAN), |found| (found.to - late, found.to)),
        };
        let omega = omega_at(line.crossings.iter(), at);
        (margin * self.unit, omega / self.unit)
    }

    /// The line of delays of P and Q, that of latencies of B and A at this delay; and the delay, or
    /// the latency, of this loop.
    fn late_line(&self) -> (DelayLine, f64) {
        let of_latencies = DelayLine::of_latencies(&self.system, self.tau);
        match of_latencies.filter(|_| self.system.is_of_differences()) {
            Some(line) => (line, self.system.latency()),
            None => (DelayLine::of(&self.system), self.tau),
        }
    }

    /// Whether all roots are left of the line, beyond doubt.
    #[must_use]
    pub fn stable(&self) -> bool {
        self.stable_with(1.0) == Some(true)
    }

    /// The ω ≥ 0 at which a root is on the line, of a loop that is on the boundary of stability;
    /// none where there is none within rounding.
    pub(crate) fn crossing(&self) -> Option<f64> {
        let mut nearest = (ON_THE_BOUNDARY, None);
        let end = self.bound(NEARBY).min(self.highest());
        if !end.is_finite() {
            return None;
        }
        let mut keep = |omega: f64| {
            let apart = (self.factor(omega) - 1.0).abs();
            if apart < nearest.0 {
                nearest = (apart, Some(omega / self.unit));
            }
        };
        keep(0.0);
        zeros(&self.left_side(), end, |omega, _| keep(omega)).ok()?;
        nearest.1
    }
}

impl GainLoop for SystemLoop {
    type Function = Form;

    fn idle(&self) -> bool {
        Self::idle(self)
    }

    fn stopped(&self) -> bool {
        self.stop.is_set()
    }

    fn left_side(&self) -> Form {
        self.turned
    }

    fn factor(&self, omega: f64) -> f64 {
        let [own, fed] = self.sides.at(omega);
        let factor = -own.norm_sqr() / (fed * own.conj()).re;
        if factor.is_finite() { factor } else { f64::NAN }
    }

    fn bound(&self, factor: f64) -> f64 {
        match factor < f64::INFINITY {
            true => self.system.gain_bound(factor, self.tau, self.line),
            false => f64::INFINITY,
        }
    }

    fn highest(&self) -> f64 {
        match self.line == 0.0 {
            true => self.system.highest_with_gain(self.tau),
            false => f64::INFINITY,
        }
    }

    /// Without delay a root comes from infinity where the highest power of U + k V vanishes.
    fn further(&self) -> Option<f64> {
        let ratio = self.system.loop_at_infinity();
        (self.undelayed() && ratio != 0.0).then(|| -1.0 / ratio)
    }

    fn accumulates_at(&self) -> f64 {
        match self.undelayed() {
            true => f64::INFINITY,
            false => self.system.accumulates_at(self.tau, self.line),
        }
    }

    fn looks_at_zero(&self) -> bool {
        true
    }

    fn stable_with(&self, factor: f64) -> Option<bool> {
        if self.stop.is_set() {
            return None;
        }
        let system = self.system.with_gain(factor);
        if !system.is_counted(self.tau) {
            return None;
        }
        if self.line != 0.0 {
            return match RootCounter::new(&system).right_of(self.tau, self.line) {
                RightOf::Roots(roots) => Some(roots == 0),
                RightOf::Infinite => Some(false),
                RightOf::Undecided => None,
            };
        }
        let count = DelayLine::of(&system).count(self.tau, MarginalTolerance::default());
        (!count.marginal).then_some(count.n_unstable == 0)
    }

    fn sure(&self) -> bool {
        self.line == 0.0
    }

    fn unit(&self) -> f64 {
        self.unit
    }
}
