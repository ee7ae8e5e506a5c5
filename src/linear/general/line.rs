//! All delays of one setting: where roots cross the imaginary axis, which way, and how many are
//! unstable between.
//!
//! ```text
//! F(x) = |P(i√x)|² − |Q(i√x)|²,   x_j = ω_j² its positive zeros                              (3)
//! s_j = ½[sgn F(x_j+) − sgn F(x_j−)],   θ_j = arg(−Q/P) at iω_j in (0, 2π],
//! τ_{j,k} = (θ_j + 2πk)/ω_j                                                                  (4)
//! n(τ) = n(0⁺) + 2 Σ_j s_j #{k ≥ 0: τ_{j,k} < τ}                                             (5)
//! ```
//!
//! (6) and (7) are in [`right_of`](super::right_of). Degenerate cases are answered one by one: a
//! root at 0 for every delay, which a real root may pass once; a zero on the axis that P and Q
//! share; zeros of P + Q on the axis, from which a pair starts at τ = 0.

use std::f64::consts::{PI, TAU};

use super::isolate::MOST;
use super::parts::Angle;
use super::reason::Reason;
use super::right_of::RootCounter;
use super::routh::zeros_on_the_right;
use super::switches::{NearZero, Switch, Switches, each_switch};
use super::system::{Class, System};
use super::turning::Turning;
use super::zeros::Zeros;
use crate::linear::count::MarginalTolerance;
use crate::linear::crossing::{Crossing, Direction};
use crate::linear::equation::Pair;
use crate::linear::newton::divide;

/// Delays tried for a count by (7) of `right_of` where P + Q leaves n(0⁺) open.
const TRIES: usize = 40;
/// An error of a phase that is not worth a slower evaluation, up to the degree of which zeros of F
/// are isolated and above.
const ENOUGH: [f64; 2] = [1e-6, 1e-11];

/// The crossings of a line of delays.
#[derive(Debug, Clone, Default)]
pub struct DelayLine {
    /// Number of unstable roots at τ = 0⁺.
    pub at_zero_delay: u64,
    /// Number of roots with Re λ > 0 at τ = 0 itself.
    pub without_delay: u64,
    /// The crossings and touches, by falling frequency.
    pub crossings: Vec<Crossing>,
    /// What is special about the line, if anything.
    pub reason: Option<Reason>,
    /// Whether at every delay a root lies on the imaginary axis.
    pub always_marginal: bool,
    /// Whether roots lie on the imaginary axis at τ = 0.
    pub marginal_at_zero: bool,
    /// The delay at which a real root passes 0: one more is unstable from there on, or one less.
    pub passage: Option<Passage>,
    /// The delay from which on something near the origin may have happened of which rounding does
    /// not tell.
    pub open_from: f64,
    /// Whether there is no count: infinitely many roots are unstable, or the line is refused.
    pub uncounted: bool,
    /// The unit of time; 1 for dimensionless delays.
    pub time_unit: f64,
}

/// A real root passes 0, where another one rests at every delay.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Passage {
    /// The delay.
    pub tau: f64,
    /// A bound on its error.
    pub error: f64,
    /// +1 into the right half-plane, −1 out of it.
    pub change: i8,
}

impl DelayLine {
    /// The line of `system`.
    #[must_use]
    pub fn of(system: &System) -> Self {
        let mut line = Self::default();
        line.find(system);
        line
    }

    /// Finds what [`DelayLine::of`] finds, in the memory of this line.
    pub fn find(&mut self, system: &System) {
        let unit = system.time_unit();
        if unit == 1.0 {
            self.find_in_unit(system);
        } else {
            self.find_in_unit(&system.in_unit(unit));
            self.scale(unit);
        }
    }

    fn find_in_unit(&mut self, system: &System) {
        self.clear();
        let without_origin = system.without_common_origin();
        let class = system.class();
        self.reason = class.reason();
        self.uncounted = !matches!(
            class,
            Class::Retarded | Class::Neutral { .. } | Class::NeutralLimit
        );
        if self.uncounted {
            self.find_without_delay(system);
            return;
        }
        if class == Class::NeutralLimit {
            self.always_marginal = true;
        }
        if let Some(rest) = without_origin {
            self.find_in_unit(&rest);
            self.rests_at_origin();
            return;
        }
        if system.uncontrolled() {
            self.find_without_delay(system);
            self.at_zero_delay = self.without_delay;
            self.always_marginal = self.marginal_at_zero;
            if self.always_marginal {
                let origin = !system.p.coefficient(0).decided();
                self.reason = Some(if origin {
                    Reason::RootAtOrigin
                } else {
                    Reason::RootOnAxis
                });
            }
            return;
        }
        self.find_crossings(system);
    }

    pub(super) fn clear(&mut self) {
        let mut crossings = std::mem::take(&mut self.crossings);
        crossings.clear();
        *self = Self {
            crossings,
            open_from: f64::INFINITY,
            time_unit: 1.0,
            ..Self::default()
        };
    }

    fn rests_at_origin(&mut self) {
        self.always_marginal = true;
        self.reason = Some(Reason::RootAtOrigin);
    }

    fn find_crossings(&mut self, system: &System) {
        let on_axis = system.on_axis();
        let near = if let Some(feedback) = system.late() {
            let mut switches = Switches::default();
            if !feedback.late_switches(&mut switches) {
                // Too many to be listed: nothing is said but what holds without delay.
                self.find_without_delay(system);
                self.at_zero_delay = self.without_delay;
                self.always_marginal = true;
                return;
            }
            for switch in &switches.list {
                let phase = feedback.late_phase(switch.omega, switch.error);
                self.add_crossing(system, switch, phase);
            }
            switches.near_zero()
        } else {
            let mut modulus = on_axis.modulus();
            if system.class() == Class::NeutralLimit {
                modulus = modulus.without_open_leading();
            }
            let enough = ENOUGH[usize::from(on_axis.degree() > MOST)];
            let near = each_switch(&modulus, Some(&on_axis), |switch| {
                let phase = on_axis.phase(switch.omega, switch.error, enough);
                self.add_crossing(system, &switch, phase);
            });
            let Some(near) = near else {
                self.uncounted = true;
                self.reason = Some(Reason::DegreeUnknown);
                return;
            };
            near
        };
        let origin = !on_axis.on_real_axis().decided();
        if origin {
            self.rests_at_origin();
        } else {
            self.opens_below(near.open_below);
        }
        self.find_start(system, near, origin);
    }

    /// Notes that a pair may cross at some τ ≥ π/ω or so, with a frequency below `omega`: |P(0)| =
    /// |Q(0)| within rounding, without a root at 0.
    pub(super) fn opens_below(&mut self, omega: f64) {
        if omega > 0.0 {
            self.open_from = 0.5 * PI / omega;
        }
    }

    fn add_crossing(&mut self, system: &System, switch: &Switch, phase: Option<Angle>) {
        if switch.sign == 0 && system.has_common_zero(switch.omega, switch.error) {
            self.always_marginal = true;
            self.reason = self.reason.or(Some(Reason::RootOnAxis));
            return;
        }
        self.add(switch, phase);
    }

    /// Adds the crossing at `switch`, `phase` being the argument of −P Q* there.
    pub(super) fn add(&mut self, switch: &Switch, phase: Option<Angle>) {
        let direction = match switch.sign {
            1 => Direction::Right,
            -1 => Direction::Left,
            _ => Direction::Touch,
        };
        let (theta, error) = match phase {
            // θ = arg(−Q/P) = −arg(−P Q*).
            Some(angle) => (turned(-angle.value), angle.error),
            // Nothing is known of the phase: every delay is marginal.
            None => (PI, TAU),
        };
        self.crossings.push(Crossing::with_errors(
            switch.omega,
            switch.error,
            theta,
            error,
            direction,
        ));
    }

    /// Finds n(0⁺), with what zeros of P + Q on the axis or at the origin make of it.
    fn find_start(&mut self, system: &System, near: NearZero, origin: bool) {
        let mut sum = system.without_delay();
        if origin {
            self.find_passage(system, near);
            sum = sum.divided_by_variable();
        }
        let decided = self.count_right(&sum);
        self.at_zero_delay = self.without_delay;
        if let Some(passage) = self.passage {
            if passage.tau.abs() <= passage.error && passage.change > 0 {
                self.at_zero_delay += 1;
            }
            if passage.tau <= passage.error {
                self.passage = None;
            }
        }
        let known = decided && (!self.marginal_at_zero || self.start_on_axis(system, &sum));
        if !known {
            self.start_by_count(RootCounter::new(system).unstable());
        }
    }

    /// Finds where a real root passes 0: at τ* = (p₁ + q₁)/q₀, to the right where F(0⁺) > 0.
    fn find_passage(&mut self, system: &System, near: NearZero) {
        let slope = crate::linear::rounded::Rounded::sum([
            system.p.coefficient(1).value,
            system.q.coefficient(1).value,
        ])
        .plus_error(system.p.coefficient(1).error + system.q.coefficient(1).error);
        let q0 = system.q.coefficient(0);
        let tau = slope.value / q0.value;
        let error = (slope.error + tau.abs() * q0.error) / q0.value.abs();
        let error = error + f64::EPSILON * tau.abs();
        if tau > error && !system.on_axis().modulus().coefficient(1).decided() {
            // F has a double zero at 0, and D a triple one at τ*: a pair comes and goes there, too.
            self.uncounted = true;
            return;
        }
        if let (Some(positive), true) = (near.sign, tau.is_finite()) {
            self.passage = Some(Passage {
                tau,
                error,
                change: if positive { 1 } else { -1 },
            });
        }
    }

    /// Counts the zeros of P + Q right of the axis, and notes whether some may lie on it. False
    /// where that is open.
    fn count_right(&mut self, sum: &super::Polynomial) -> bool {
        if !sum.degree_known() {
            return false;
        }
        if let Some(right) = zeros_on_the_right(sum) {
            self.without_delay = right as u64;
            return true;
        }
        for set in Zeros::of(sum).sets() {
            let (from, to) = set.real_parts();
            if from > 0.0 {
                self.without_delay += set.count() as u64;
            } else if to >= 0.0 {
                self.marginal_at_zero = true;
            }
        }
        true
    }

    fn find_without_delay(&mut self, system: &System) {
        let sum = system.without_delay();
        if !sum.is_zero() {
            self.count_right(&sum);
        }
    }

    /// Adds to n(0⁺) the pairs that start on the axis, from zeros of P + Q at ±iω₀: the crossing
    /// with its phase 2π there tells to which side they go. False where that cannot be told.
    fn start_on_axis(&mut self, system: &System, sum: &super::Polynomial) -> bool {
        for set in Zeros::of(sum).sets() {
            let (from, to) = set.real_parts();
            if from > 0.0 || to < 0.0 || set.middle().im < 0.0 {
                continue;
            }
            let middle = set.middle();
            if set.count() != 1 || middle.im == 0.0 {
                return false;
            }
            let near = |c: &&mut Crossing| {
                (c.omega - middle.im).abs() <= 1e-6 * middle.im && c.starts_at_zero()
            };
            let Some(crossing) = self.crossings.iter_mut().find(near) else {
                return false;
            };
            crossing.first_branch = u64::from(crossing.theta < PI);
            let starts_right = match crossing.direction {
                Direction::Right => true,
                Direction::Left => false,
                Direction::Touch => {
                    let z = num_complex::Complex64::new(0.0, middle.im);
                    let [_, p_slope, q, q_slope] = Pair::at(&system, z);
                    let drift = divide(q, p_slope + q_slope).re;
                    let above = self.modulus_sign_above(system, middle.im);
                    drift * above > 0.0
                }
            };
            if starts_right {
                self.at_zero_delay += 2;
            }
        }
        true
    }

    /// The sign of F right of a touch at `omega`.
    fn modulus_sign_above(&self, system: &System, omega: f64) -> f64 {
        let higher = self
            .crossings
            .iter()
            .filter(|c| c.omega > omega * (1.0 + 1e-9) && c.direction != Direction::Touch)
            .count();
        let far = if system.late().is_some() {
            1.0
        } else {
            let modulus = system.on_axis().modulus();
            modulus.without_open_leading().leading().value
        };
        if higher % 2 == 0 { far } else { -far }
    }

    /// Finds n(0⁺) from (7) of `right_of` at some delay, less what happened up to there.
    pub(super) fn start_by_count(&mut self, unstable: Option<Turning>) {
        let period = self
            .crossings
            .iter()
            .map(Crossing::period)
            .fold(1.0, f64::min);
        let found = unstable.and_then(|turning| {
            (1..=TRIES).find_map(|i| {
                let tau = period * (i as f64 * 0.618_033_988_75 + 0.01);
                let marginal = self.count(tau, MarginalTolerance::default());
                let n = turning.at(tau)?;
                let change = self.change_until(tau);
                let near = self.crossings.iter().any(|c| c.near(tau, 1e-6));
                (!near && marginal.n_unstable < u64::MAX)
                    .then(|| u64::try_from(n as i64 - change).ok())
                    .flatten()
            })
        });
        match found {
            Some(n) => self.at_zero_delay = n,
            None => self.always_marginal = true,
        }
    }
}

/// An angle in [−π, π] as one in (0, 2π].
fn turned(angle: f64) -> f64 {
    if angle > 0.0 { angle } else { angle + TAU }
}
