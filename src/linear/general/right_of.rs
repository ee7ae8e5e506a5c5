//! How many roots lie right of a vertical line: the argument principle in closed form, for any
//! degree.
//!
//! ```text
//! p = P(σ + iω),  q = κ Q(σ + iω),  F_σ(x) = |p|² − |q|²,  x = ω²                            (6)
//! N_σ = n_P + ν₀ + 2 Σ_j s_j m_j,   m_j = round[(φ_j − ψ_j + ω_j τ)/2π]                      (7)
//! ```
//!
//! n_P is the number of zeros of P right of the line, φ and ψ are the arguments of p and q,
//! continuous in ω, ω_j the frequencies at which F_σ changes its sign and s_j = ±1 that change.
//! ν₀ = 0 where |p(0)| > |q(0)|, else [ψ(0) − φ(0)]/π. Between the ω_j one term dominates, and the
//! argument of D keeps within a right angle of its argument: no turn is stepped over.
//!
//! Only whole turns come from the zeros r of P and Q, arg = Σ arctan[(ω − Im r)/(σ − Re r)]; the
//! fraction comes from P and Q themselves. Equations are numbered through the room: (3) to (5) are
//! in [`line`](super::line), (8) is in `shifted`.

use std::f64::consts::{PI, TAU};

use num_complex::Complex64;

use super::at_origin::AtOrigin;
use super::composition::Composition;
use super::latency::{Budget, Form, MOST_STEPS_OF_A_CELL};
use super::parts::{Angle, Decay};
use super::polynomial::{MOST_DEGREE, Polynomial};
use super::shifted::Shifted;
use super::switches::{Switches, each_switch};
use super::system::{Class, System};
use super::turning::{NoNumber, RightOf, Turn, Turning, WholeTurns};
use super::zeros::Zeros;
use crate::linear::real_zeros::Switch;
use crate::model::elementary::atan2;
use crate::model::stop::Stop;

/// How far the two ways to an argument may differ before neither is trusted.
pub(super) const SAME_TURN: f64 = 1.0;
/// An error of a phase that is not worth a slower evaluation.
const ENOUGH: f64 = 1e-4;

/// Counts roots of one system at any delay right of any line.
#[derive(Debug, Clone)]
pub struct RootCounter {
    system: System,
    p: Factors,
    q: Factors,
    stop: Stop,
    pub(super) budget: Budget,
}

/// A polynomial, given by its zeros.
#[derive(Debug, Clone, Copy)]
pub(super) struct Factors {
    zeros: [Complex64; MOST_DEGREE],
    count: usize,
    positive: bool,
}

impl Factors {
    fn of(polynomial: &Polynomial) -> Self {
        let mut factors = Self {
            zeros: [Complex64::ZERO; MOST_DEGREE],
            count: polynomial.degree(),
            positive: polynomial.leading().value > 0.0,
        };
        for (zero, disc) in factors.zeros.iter_mut().zip(Zeros::of(polynomial).discs()) {
            *zero = disc.centre;
        }
        factors
    }

    fn zeros(&self) -> &[Complex64] {
        &self.zeros[..self.count]
    }

    /// How many zeros lie right of `line`.
    pub(super) fn right_of(&self, line: f64) -> usize {
        self.zeros().iter().filter(|r| r.re > line).count()
    }

    /// The argument at σ itself, in units of π: 0 or 1.
    fn half_turns_at_zero(&self, line: f64) -> i64 {
        let beyond = |r: &&Complex64| r.im == 0.0 && r.re > line;
        let odd = self.zeros().iter().filter(beyond).count() % 2 == 1;
        i64::from(self.positive == odd)
    }

    /// The argument at σ + iω, continuous in ω ≥ 0.
    pub(super) fn argument(&self, line: f64, omega: f64) -> f64 {
        let mut turned = Turned::NOT;
        self.turn(line, omega, 1.0, &mut turned);
        PI * self.half_turns_at_zero(line) as f64 + turned.angle()
    }

    /// Turns `turned` by the argument at σ + iω less that at σ, times `sign` = ±1.
    #[inline]
    fn turn(&self, line: f64, omega: f64, sign: f64, turned: &mut Turned) {
        for r in self.zeros() {
            // A zero on the line itself counts as left of it.
            let aside = line - r.re;
            let along = if aside < 0.0 { -sign } else { sign };
            turned.by(aside.abs(), along * (omega - r.im));
        }
    }
}

/// A sum of angles as a direction and whole turns.
#[derive(Debug, Clone, Copy)]
struct Turned {
    re: f64,
    im: f64,
    turns: f64,
}

impl Turned {
    const NOT: Self = Self {
        re: 1.0,
        im: 0.0,
        turns: 0.0,
    };

    /// Adds the angle of `re` + i `im`, which is no more than a right one: `re` ≥ 0.
    #[inline(always)]
    fn by(&mut self, re: f64, im: f64) {
        if re == 0.0 && im == 0.0 {
            return;
        }
        let next = (self.re * re - self.im * im, self.re * im + self.im * re);
        // By the sign of zeros as well, as the arctangent has it: zeros on the line turn by half a
        // turn exactly.
        let [below, then_below] = [self.im, next.1].map(f64::is_sign_negative);
        if im > 0.0 && !below && then_below {
            self.turns += 1.0;
        } else if im < 0.0 && below && !then_below {
            self.turns -= 1.0;
        }
        (self.re, self.im) = next;
        let size = self.re.abs() + self.im.abs();
        if !(1e-100..1e100).contains(&size) {
            self.re /= size;
            self.im /= size;
        }
    }

    fn angle(&self) -> f64 {
        atan2(self.im, self.re) + TAU * self.turns
    }
}

impl RootCounter {
    /// A counter for `system`, whose degree is known.
    #[must_use]
    pub fn new(system: &System) -> Self {
        let [p, q] = system.polynomials();
        Self {
            system: *system,
            p: Factors::of(p),
            q: Factors::of(&q.without_open_leading()),
            stop: Stop::default(),
            budget: Budget::default(),
        }
    }

    /// This counter with the work of a cell bounded where there is latency, by a number of steps:
    /// once these are taken every number of roots is undecided, until [`RootCounter::begin`].
    #[must_use]
    pub(crate) fn bounded(self) -> Self {
        self.allowing(MOST_STEPS_OF_A_CELL)
    }

    /// This counter with the work of a cell bounded by `most` steps, see [`RootCounter::bounded`].
    #[must_use]
    pub(in crate::linear) fn allowing(self, most: u64) -> Self {
        let budget = Budget::of(most);
        Self { budget, ..self }
    }

    /// Begins another cell, see [`RootCounter::bounded`].
    pub(crate) fn begin(&self) {
        self.budget.renew();
    }

    /// Whether the work of this cell has come to its bound.
    #[must_use]
    pub(crate) fn is_spent(&self) -> bool {
        self.budget.is_spent()
    }

    /// The steps that all counts took.
    pub(in crate::linear) fn steps(&self) -> u64 {
        self.budget.spent()
    }

    /// This counter, to which every number of roots is undecided once `stop` is set.
    #[must_use]
    pub(crate) fn heeding(self, stop: &Stop) -> Self {
        let stop = stop.clone();
        Self { stop, ..self }
    }

    /// The counter of the same system with times in units of `unit`, a power of two; with the same
    /// stop, and as bounded as this one.
    #[must_use]
    pub(crate) fn in_unit(&self, unit: f64) -> Self {
        Self {
            stop: self.stop.clone(),
            budget: self.budget.clone(),
            ..Self::new(&self.system.in_unit(unit))
        }
    }

    /// The number of roots with Re λ > `line` at the delay `tau` ≥ 0. Real roots count once, pairs
    /// twice.
    #[must_use]
    pub fn right_of(&self, tau: f64, line: f64) -> RightOf {
        if self.stop.is_set() {
            return RightOf::Undecided;
        }
        if tau == 0.0 || self.system.uncontrolled() {
            return self.without_delay(tau, line);
        }
        if let Composition::Late(feedback) = &self.system.composition {
            return self.late_right_of(feedback, tau, line);
        }
        let mut turned = WholeTurns::at(tau);
        let found = self.on_line(tau, line, |turn| turned.add(&turn));
        let without_turns = found.and_then(|(without_turns, at_origin)| {
            let left_out = match at_origin {
                Some(at) => at.counted(tau).ok_or(NoNumber::Undecided)?,
                None => i64::from(self.system.leaves_origin_out() && line < 0.0),
            };
            Ok(without_turns - left_out)
        });
        turned.right_of(without_turns)
    }

    /// Equation (7) on the imaginary axis, for every delay τ > 0; none where it cannot be had at
    /// any.
    #[must_use]
    pub fn unstable(&self) -> Option<Turning> {
        if self.system.latency() > 0.0 {
            return self.late_unstable(Form::Delay, 0.0);
        }
        let mut turns = Vec::with_capacity(self.system.p.degree());
        let found = self.on_line(0.0, 0.0, |turn| {
            turns.push(turn);
            true
        });
        let (without_turns, at_origin) = found.ok()?;
        Some(Turning {
            without_turns,
            turns,
            at_origin,
        })
    }

    /// The system itself.
    #[must_use]
    pub fn system(&self) -> &System {
        &self.system
    }

    /// B and A by their zeros, of a system with latency.
    pub(super) fn late_factors(&self) -> (&Factors, &Factors) {
        (&self.p, &self.q)
    }

    /// The frequencies above 0 at which a root can lie on `line` at the delay `tau`, the largest
    /// first, each with the sign with which it counts in (7).
    pub(super) fn frequencies(&self, tau: f64, line: f64) -> Vec<(f64, i8)> {
        let mut switches = Switches::default();
        self.system.switches_on(tau, line, &mut switches);
        switches.list.iter().map(|s| (s.omega, s.sign)).collect()
    }

    /// The zeros of P, with latency those of B.
    pub(super) fn zeros_of_p(&self) -> &[Complex64] {
        self.p.zeros()
    }

    fn without_delay(&self, tau: f64, line: f64) -> RightOf {
        let sum = if tau == 0.0 {
            self.system.without_delay()
        } else {
            self.system.p
        };
        if !sum.degree_known() {
            return RightOf::Undecided;
        }
        let mut right = 0;
        for set in Zeros::of(&sum).sets() {
            let (from, to) = set.real_parts();
            if from > line {
                right += set.count() as u64;
            } else if to > line {
                return RightOf::Undecided;
            }
        }
        RightOf::Roots(right)
    }

    /// Returns n_P + ν₀ of (7), and passes each turn of (7) to `each`, which says whether the next
    /// one matters.
    fn on_line(
        &self,
        tau: f64,
        line: f64,
        mut each: impl FnMut(Turn) -> bool,
    ) -> Result<(i64, Option<AtOrigin>), NoNumber> {
        let open = NoNumber::Undecided;
        let system = &self.system;
        match system.class() {
            Class::DegreeUnknown | Class::Refused => return Err(open),
            Class::Infinite => return Err(NoNumber::Infinite),
            _ => {}
        }
        let on_line = system.on_line(line, Decay::new(line, tau).ok_or(open)?);
        let through_origin = line == 0.0 && system.leaves_origin_out();
        if !through_origin && !on_line.on_real_axis().decided() {
            return Err(open);
        }
        let mut modulus = on_line.modulus();
        if system.class() == Class::NeutralLimit && line == 0.0 {
            modulus = modulus.without_open_leading();
        }
        // κ² is beyond all numbers before κ is.
        if !modulus.leading().decided() || !modulus.is_finite() {
            return Err(open);
        }
        if modulus.leading().value < 0.0 {
            return Err(NoNumber::Infinite);
        }
        let mut going_on = true;
        let found = each_switch(&modulus, Some(&on_line), |switch| {
            going_on = going_on && self.turn(&on_line, line, &switch).is_some_and(&mut each);
        });
        if !going_on || found.is_none() {
            return Err(open);
        }
        let constant = modulus.coefficient(0);
        let mut without_turns = self.p.right_of(line) as i64;
        // Where that is open though D(σ) is not, |p| = |q| without a root: then ν₀ = 0.
        let near = found.and_then(|near| near.sign);
        let at_origin = match through_origin {
            true => Some(system.at_origin(near.ok_or(open)?)),
            false => None,
        };
        let fed = match through_origin {
            true => near == Some(false),
            false => constant.decided() && constant.value < 0.0,
        };
        if fed {
            without_turns += self.q.half_turns_at_zero(line) - self.p.half_turns_at_zero(line);
        }
        Ok((without_turns, at_origin))
    }

    fn turn(&self, on_line: &Shifted, line: f64, switch: &Switch) -> Option<Turn> {
        let Angle { value, error } = on_line.phase(switch.omega, switch.error, ENOUGH)?;
        // The argument of −P Q* is half a turn from that of P Q*.
        let fraction = value + PI;
        let phase = fraction + TAU * self.whole_turns(line, switch.omega, value)?;
        Some(Turn {
            omega: switch.omega,
            omega_error: switch.error,
            sign: f64::from(switch.sign),
            phase,
            phase_error: error + 4.0 * f64::EPSILON * phase.abs(),
        })
    }

    /// The whole turns by which φ − ψ at `omega` is ahead of `angle` + π, the argument of −P Q*
    /// being `angle`; none where the zeros of P and Q tell too little.
    fn whole_turns(&self, line: f64, omega: f64, angle: f64) -> Option<f64> {
        let mut turned = Turned::NOT;
        self.p.turn(line, omega, 1.0, &mut turned);
        self.q.turn(line, omega, -1.0, &mut turned);
        let half_turns = self.p.half_turns_at_zero(line) - self.q.half_turns_at_zero(line);
        let rough = PI * half_turns as f64 + turned.angle();
        let ahead = rough - (angle + PI);
        let turns = (ahead / TAU).round();
        ((ahead - TAU * turns).abs() < SAME_TURN).then_some(turns)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linear::feedback_loop::FeedbackLoop;
    use crate::linear::general::Polynomial;
    use crate::model::{Channel, Groups, Lags};

    /// The damped root −0.223 of a weak control is right of the line, however large e^(στ) is.
    #[test]
    fn numbers_beyond_all_decide_nothing() {
        let lags = Lags {
            load: 0.2,
            velocity: 0.2,
            sensor: 0.0,
        };
        let groups = Groups::new(4.7, -0.4, 0.0);
        let counter =
            RootCounter::new(&FeedbackLoop::of_letter(groups, Channel::default(), lags).system());
        for tau in [2.0, 300.0, 700.0, 768.4, 900.0, 1600.0] {
            let found = counter.right_of(tau, -0.48);
            assert_ne!(found, RightOf::Roots(0), "{tau}");
        }
        assert_eq!(counter.right_of(0.1, -0.2), RightOf::Roots(0));
    }

    /// Right angles one way and back, in every order of signs: the sum is known without rounding.
    #[test]
    fn right_angles_add_up() {
        for pattern in 0..1_u32 << 8 {
            let (mut turned, mut sum) = (Turned::NOT, 0.0);
            for bit in 0..8 {
                let sign = if pattern >> bit & 1 == 1 { 1.0 } else { -1.0 };
                turned.by(0.0, sign * 0.7);
                sum += sign * 0.5 * PI;
                assert!((turned.angle() - sum).abs() < 1e-12, "{pattern:b} {bit}");
            }
        }
    }

    /// In another unit of time, too, counts end with their bound and with the stop.
    #[test]
    fn bounds_and_stops_hold_in_every_unit() {
        let open = Polynomial::new(&[1e8, 2e3, 1.0]).unwrap();
        let gain = Polynomial::new(&[1e7]).unwrap();
        let system = System::feedback(
            open,
            gain,
            Channel {
                memory: 0.5,
                latency: 1e-4,
            },
        );
        let unit = system.time_unit();
        assert_ne!(unit, 1.0);
        let count = |counter: &RootCounter| counter.in_unit(unit).right_of(3e-4 / unit, 0.0);
        let free = RootCounter::new(&system);
        assert!(matches!(count(&free), RightOf::Roots(_)));
        assert_eq!(count(&free.allowing(1)), RightOf::Undecided);
        let stop = std::sync::Arc::new(std::sync::atomic::AtomicBool::new(true));
        let stopped = RootCounter::new(&system).heeding(&Stop::when(&stop));
        assert_eq!(count(&stopped), RightOf::Undecided);
    }
}
