//! Where a root lies on the line λ = −σ + iω, beyond the letter's own feedback, as one real
//! equation in ω for each way in which a setting can change.
//!
//! With E = q e^(−iωτ), q = e^(στ), and e^(−λδ) = p e^(−iωδ), p = e^(σδ),
//!
//! ```text
//! D = M − kN,   M = B(1 − R E),   N = A e^(−λδ)(1 − E)
//! gains k:   Im[N M*] = 0,   k = |M|²/Re[N M*]                                              (1)
//!            N M* = p A B* e^(−iωδ)[1 + Rq² − q e^(−iωτ) − Rq e^(iωτ)]                      (2)
//! slope b:   D = D₀ + b D₁,   Im[D₀ D₁*] = 0,   b = −Re[D₀ D₁*]/|D₁|²                       (3)
//!            D₀ = u(1 − R E) − w e^(−λδ)(1 − E),   u = (λ² + 1) L,   w = a_n L_v + a_v (λ − d) L_a
//!            D₁ = v(1 − R E) − y e^(−λδ)(1 − E),   v = λ L,          y = a_v L_a
//! loop e^(iφ) N/M:   |N|² = |M|²,   φ = −arg(N/M)                                           (4)
//! ```
//!
//! with L = L_a L_v L_s. On the imaginary axis (1) loses the factor sin(ωτ/2), at whose zeros no
//! gain acts:
//!
//! ```text
//! Re[A B* (e^(−iω(δ + τ/2)) − R e^(−iω(δ − τ/2)))] = 0                                      (5)
//! ```
//!
//! In (3) |1 − R E|² Im[u v*] = |1 − R E|² |L|² ω(ω² + σ² − 1) has the highest power of ω.

use num_complex::Complex64;

use super::super::equations::{OnLine, UpTo, loop_parts};
use super::super::setting::Setting;
use super::super::sum::{Part, Sum, Terms, conjugate, exactly, growth, on_line, one_and};
use super::feedback::Beyond;
use crate::linear::characteristic::{late, one_minus_exp};
use crate::linear::feedback_loop::{LagPolynomials, polynomial, times};
use crate::linear::general::{DelayLine, Polynomial, System, beyond_positive};
use crate::linear::rounded::Rounded;
use crate::linear::stable_delays::StableInterval;
use crate::model::Groups;

/// A setting with what its feedback has beyond the letter's own.
#[derive(Debug, Clone, Copy)]
pub struct Equations {
    setting: Setting,
    beyond: Beyond,
    /// B and A as polynomials in λ.
    open: Polynomial,
    gain: Polynomial,
    lags: LagPolynomials,
    /// q and p.
    delayed: Rounded,
    late: Rounded,
}

/// What equations are made of at one λ.
struct Values {
    lambda: Complex64,
    /// M.
    open: Complex64,
    /// N.
    acting: Complex64,
    /// 1 − R E, and e^(−λδ)(1 − E).
    kept: Complex64,
    passed: Complex64,
}

impl Equations {
    pub(in super::super) fn new(setting: &Setting, beyond: &Beyond) -> Self {
        let [open, gain] = beyond.of_groups(setting.groups).polynomials();
        Self {
            setting: *setting,
            beyond: *beyond,
            open,
            gain,
            lags: beyond.lag_polynomials(),
            delayed: growth(setting.decay * setting.tau),
            late: growth(setting.decay * beyond.channel.latency),
        }
    }

    /// A polynomial in λ as one in iω, times the conjugate of another.
    fn product(&self, one: &Polynomial, other: &Polynomial) -> Polynomial {
        on_line(-self.setting.decay, one, other)
    }

    /// A B*.
    fn loop_product(&self) -> Polynomial {
        let Setting { groups, decay, .. } = self.setting;
        if decay > 0.0 {
            return self.product(&self.gain, &self.open);
        }
        let [load, velocity] = loop_parts(groups.b, self.beyond.damping);
        let load = times(&load, &self.lags.velocity);
        let velocity = times(&velocity, &self.lags.load);
        let both = Polynomial::ZERO.plus(&load, self.beyond.load_gain(groups));
        let both = both.plus(&velocity, groups.a_v);
        times(&both, &conjugate(&self.lags.all))
    }

    fn values(&self, omega: f64) -> Values {
        let lambda = Complex64::new(-self.setting.decay, omega);
        let difference = one_minus_exp(-self.setting.tau * lambda);
        let memory = self.beyond.channel.memory;
        let kept = 1.0 - memory + memory * difference;
        let passed = late(self.beyond.channel.latency, lambda) * difference;
        Values {
            lambda,
            open: self.open.value(lambda) * kept,
            acting: self.gain.value(lambda) * passed,
            kept,
            passed,
        }
    }

    /// u, v, w and y of (3).
    fn of_slope(&self) -> [Polynomial; 4] {
        let groups = self.setting.groups;
        let y = Polynomial::ZERO.plus(&self.lags.load, groups.a_v);
        let variable = Polynomial::variable();
        let moving = polynomial(&[-self.beyond.damping, 1.0]);
        [
            times(&polynomial(&[1.0, 0.0, 1.0]), &self.lags.all),
            times(&variable, &self.lags.all),
            times(&moving, &y).plus(&self.lags.velocity, self.beyond.load_gain(groups)),
            y,
        ]
    }

    /// The left side of (3) without |1 − R E|² Im[u v*].
    fn rest_of_slope(&self, [u, v, w, y]: &[Polynomial; 4]) -> Terms {
        let (tau, latency) = (self.setting.tau, self.beyond.channel.latency);
        let (memory, q, p) = (self.beyond.channel.memory, self.delayed, self.late);
        let square = q.times(q);
        let minus = |number: Rounded| number.scaled(-1.0);
        // (1 − E)(1 − R E*) with its times.
        let mixed = [
            (one_and(square.scaled(memory)), 0.0),
            (minus(q), tau),
            (q.scaled(-memory), -tau),
        ];
        let late = self.product(w, v);
        let early = self.product(u, y);
        let both = self.product(w, y);
        let mut rest = Terms::new(Part::Imaginary);
        for (weight, t) in mixed {
            let weight = minus(weight.times(p));
            rest.add(&late, weight, latency + t);
            rest.add(&early, weight, -(latency + t));
        }
        // p² |1 − E|², where cos ωτ is e^(−iωτ) and its conjugate.
        let twice = p.times(p);
        let turned = minus(q.times(twice));
        rest.add(&both, one_and(square).times(twice), 0.0);
        rest.add(&both, turned, tau);
        rest.add(&both, turned, -tau);
        rest
    }

    /// The ω beyond which no root of any slope lies on the line, where all of (3) but
    /// |1 − R E|² Im[u v*] is at most `rest`.
    ///
    /// Beyond ω = 1 the highest power outweighs all others where (1 − |R|q)² |L|² ω(ω² + σ² − 1)
    /// does.
    fn slope_bound(&self, rest: &Polynomial) -> f64 {
        let kept =
            1.0 - self.beyond.channel.memory.abs() * (self.delayed.value + self.delayed.error);
        if kept.is_nan() || kept <= 0.0 {
            return f64::INFINITY;
        }
        let all = &self.lags.all;
        // |L|² is even in ω, and all its powers are positive.
        let lags = self.product(all, all);
        let even = Polynomial::of(lags.degree(), |k| exactly(lags.coefficient(k).value.abs()));
        let decay = self.setting.decay;
        let weight = kept * kept * (1.0 - 1e-9);
        let own = polynomial(&[0.0, weight * (decay * decay - 1.0), 0.0, weight]);
        let left = times(&even, &own).plus(rest, -1.0);
        left.beyond_zeros().max(1.0)
    }

    fn system(&self, factor: f64) -> System {
        let gain = Polynomial::ZERO.plus(&self.gain, factor);
        System::feedback(self.open, gain, self.beyond.channel)
    }
}

impl OnLine for Equations {
    type Function = Sum;

    /// The count takes ten times as long as for the letter.
    const STEPS: u32 = 12;

    const WORK_OF_CROSSINGS: u32 = 16;

    fn beyond(&self) -> Option<Beyond> {
        Some(self.beyond)
    }

    fn stability(&self, groups: Groups, tau: f64) -> Option<bool> {
        self.beyond.stability(groups, tau, self.setting.decay)
    }

    fn stable_interval_at(&self, groups: Groups, tau: f64) -> (Option<StableInterval>, u32) {
        let line = DelayLine::of(&self.beyond.of_groups(groups).system());
        (line.stable_interval_at(tau), line.resolved)
    }

    fn highest(&self, up_to: UpTo) -> f64 {
        self.beyond.highest(up_to, self.setting.decay)
    }

    /// The left side of (1), or of (5) on the imaginary axis.
    fn gain(&self) -> Sum {
        let (tau, latency) = (self.setting.tau, self.beyond.channel.latency);
        let product = self.loop_product();
        let memory = self.beyond.channel.memory;
        if self.setting.decay == 0.0 {
            let half = 0.5 * tau;
            let mut terms = Terms::new(Part::Real);
            terms.add(&product, exactly(1.0), latency + half);
            terms.add(&product, exactly(-memory), latency - half);
            return terms.sum();
        }
        let q = self.delayed;
        let constant = one_and(q.times(q).scaled(memory));
        let mut terms = Terms::new(Part::Imaginary);
        terms.add(&product, constant, latency);
        terms.add(&product, q.scaled(-1.0), latency + tau);
        terms.add(&product, q.scaled(-memory), latency - tau);
        terms.sum()
    }

    fn gain_factor(&self, omega: f64) -> f64 {
        let at = self.values(omega);
        let factor = at.open.norm_sqr() / (at.acting * at.open.conj()).re;
        // Where nothing acts no gain does anything.
        if factor.is_finite() { factor } else { f64::NAN }
    }

    fn gain_bound(&self, factor: f64) -> f64 {
        if factor == f64::INFINITY {
            return factor;
        }
        let Setting { tau, decay, .. } = self.setting;
        let highest = self.system(factor).highest_on_line(tau, -decay);
        highest.map_or(f64::INFINITY, |omega| omega * (1.0 + 1e-9))
    }

    /// On the imaginary axis without latency kA/B = (1 − R E)/(1 − E) lies on Re = (1 + R)/2, so
    /// that Re[A B*] has to be positive.
    fn highest_with_gain(&self) -> f64 {
        if self.setting.decay > 0.0 || self.beyond.channel.latency > 0.0 {
            return f64::INFINITY;
        }
        let product = self.loop_product();
        beyond_positive(&Polynomial::of(product.degree() / 2, |k| {
            let c = product.coefficient(2 * k);
            c.scaled(if k % 2 == 0 { 1.0 } else { -1.0 })
        }))
    }

    /// The left side of (3).
    fn slope(&self) -> (Sum, f64) {
        let (tau, memory, q) = (self.setting.tau, self.beyond.channel.memory, self.delayed);
        let of_slope = self.of_slope();
        let own = self.product(&of_slope[0], &of_slope[1]);
        let mut terms = self.rest_of_slope(&of_slope);
        let bound = self.slope_bound(&terms.sizes());
        terms.add(&own, one_and(q.times(q).scaled(memory * memory)), 0.0);
        terms.add(&own, q.scaled(-memory), tau);
        terms.add(&own, q.scaled(-memory), -tau);
        (terms.sum(), bound)
    }

    fn slope_at(&self, omega: f64) -> f64 {
        let at = self.values(omega);
        let [u, v, w, y] = self.of_slope().map(|p| p.value(at.lambda));
        let constant = u * at.kept - w * at.passed;
        let linear = v * at.kept - y * at.passed;
        -(constant * linear.conj()).re / linear.norm_sqr()
    }

    /// |N|² − |M|².
    fn unit_loop(&self) -> Sum {
        let (memory, q) = (self.beyond.channel.memory, self.delayed);
        let square = q.times(q);
        let fed = self.product(&self.gain, &self.gain);
        let fed = fed.scaled(self.late.times(self.late));
        let own = self.product(&self.open, &self.open);
        let tau = self.setting.tau;
        let kept = one_and(square.scaled(memory * memory));
        let mut terms = Terms::new(Part::Real);
        terms.add(&fed, one_and(square), 0.0);
        terms.add(&own, kept.scaled(-1.0), 0.0);
        terms.add(&fed, q.scaled(-2.0), tau);
        terms.add(&own, q.scaled(2.0 * memory), tau);
        terms.sum()
    }

    fn negative_loop(&self, omega: f64) -> Complex64 {
        let at = self.values(omega);
        at.acting / at.open
    }

    fn unit_loop_bound(&self) -> f64 {
        self.gain_bound(1.0)
    }
}
