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
//!            D₀ = u(1 − R E) − w e^(−λδ)(1 − E),   u = (λ² + 1) L,   w = a_n L_v + a_v λ L_a
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

use super::super::equations::{OnLine, UpTo};
use super::super::setting::Setting;
use super::feedback::Beyond;
use super::sum::{Part, Sum, Terms, conjugate};
use crate::linear::characteristic::{late, one_minus_exp};
use crate::linear::feedback_loop::{polynomial, times};
use crate::linear::general::{DelayLine, Polynomial, System};
use crate::linear::rounded::Rounded;
use crate::linear::stable_delays::StableInterval;
use crate::model::Groups;
use crate::model::elementary::exp;

/// A setting with what its feedback has beyond the letter's own.
#[derive(Debug, Clone, Copy)]
pub struct Equations {
    setting: Setting,
    beyond: Beyond,
    /// B and A as polynomials in λ.
    open: Polynomial,
    gain: Polynomial,
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

const fn exactly(value: f64) -> Rounded {
    Rounded { value, error: 0.0 }
}

/// e^x, x being a rounded product.
fn growth(x: f64) -> Rounded {
    let value = exp(x);
    Rounded {
        value,
        error: if x == 0.0 {
            0.0
        } else {
            f64::EPSILON * value * (2.0 + 2.0 * x.abs())
        },
    }
}

fn plus(a: Rounded, b: Rounded) -> Rounded {
    Rounded::sum([a.value, b.value]).plus_error(a.error + b.error)
}

impl Equations {
    pub(in super::super) fn new(setting: &Setting, beyond: &Beyond) -> Self {
        let [open, gain] = beyond.of_groups(setting.groups).polynomials();
        Self {
            setting: *setting,
            beyond: *beyond,
            open,
            gain,
            delayed: growth(setting.decay * setting.tau),
            late: growth(setting.decay * beyond.channel.latency),
        }
    }

    /// A polynomial in λ as one in iω, times the conjugate of another.
    fn product(&self, one: &Polynomial, other: &Polynomial) -> Polynomial {
        let [one, other] = [one, other].map(|p| p.shifted(-self.setting.decay));
        times(&one, &conjugate(&other))
    }

    /// A B*. On the imaginary axis (b + λ)(λ² + bλ + 1)* is b + (1 − b²)λ + λ³: its highest real
    /// part vanishes, whatever rounding would leave of it.
    fn loop_product(&self) -> Polynomial {
        let Setting { groups, decay, .. } = self.setting;
        if decay > 0.0 {
            return self.product(&self.gain, &self.open);
        }
        let Groups { b, a_v, a_n } = groups;
        let lags = self.beyond.lag_polynomials();
        let moving = Polynomial::of(3, |k| match k {
            0 => exactly(b),
            1 => plus(exactly(1.0), exactly(-b).times(exactly(b))),
            2 => exactly(0.0),
            _ => exactly(1.0),
        });
        let load = times(&polynomial(&[1.0, -b, 1.0]), &lags.velocity);
        let velocity = times(&moving, &lags.load);
        let both = Polynomial::ZERO.plus(&load, a_n).plus(&velocity, a_v);
        times(&both, &conjugate(&lags.all))
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
        let Groups { a_v, a_n, .. } = self.setting.groups;
        let lags = self.beyond.lag_polynomials();
        let y = Polynomial::ZERO.plus(&lags.load, a_v);
        let variable = Polynomial::variable();
        [
            times(&polynomial(&[1.0, 0.0, 1.0]), &lags.all),
            times(&variable, &lags.all),
            times(&variable, &y).plus(&lags.velocity, a_n),
            y,
        ]
    }

    /// The left side of (3) without |1 − R E|² Im[u v*], and with it.
    fn slope_terms(&self) -> [Terms; 2] {
        let (tau, latency) = (self.setting.tau, self.beyond.channel.latency);
        let (memory, q, p) = (self.beyond.channel.memory, self.delayed, self.late);
        let square = q.times(q);
        let [u, v, w, y] = self.of_slope();
        let minus = |number: Rounded| number.scaled(-1.0);
        let one_and = |number: Rounded| plus(exactly(1.0), number);
        // (1 − E)(1 − R E*) with its times.
        let mixed = [
            (one_and(square.scaled(memory)), 0.0),
            (minus(q), tau),
            (q.scaled(-memory), -tau),
        ];
        let late = self.product(&w, &v);
        let early = self.product(&u, &y);
        let both = self.product(&w, &y);
        let mut rest = Terms::new(Part::Imaginary);
        for (weight, t) in mixed {
            let weight = minus(weight.times(p));
            rest = rest.plus(&late, weight, latency + t);
            rest = rest.plus(&early, weight, -(latency + t));
        }
        // p² |1 − E|², where cos ωτ is e^(−iωτ) and its conjugate.
        let twice = p.times(p);
        let turned = minus(q.times(twice));
        rest = rest.plus(&both, one_and(square).times(twice), 0.0);
        rest = rest.plus(&both, turned, tau).plus(&both, turned, -tau);
        let own = self.product(&u, &v);
        let kept = one_and(square.scaled(memory * memory));
        let turned = q.scaled(-memory);
        let mut all = rest.clone().plus(&own, kept, 0.0);
        if memory != 0.0 {
            all = all.plus(&own, turned, tau).plus(&own, turned, -tau);
        }
        [rest, all]
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
            let mut terms = Terms::new(Part::Real).plus(&product, exactly(1.0), latency + half);
            if memory != 0.0 {
                terms = terms.plus(&product, exactly(-memory), latency - half);
            }
            return terms.sum();
        }
        let q = self.delayed;
        let constant = plus(exactly(1.0), q.times(q).scaled(memory));
        let mut terms = Terms::new(Part::Imaginary)
            .plus(&product, constant, latency)
            .plus(&product, q.scaled(-1.0), latency + tau);
        if memory != 0.0 {
            terms = terms.plus(&product, q.scaled(-memory), latency - tau);
        }
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
        let negative = Polynomial::of(product.degree() / 2, |k| {
            let c = product.coefficient(2 * k);
            c.scaled(if k % 2 == 0 { -1.0 } else { 1.0 })
        });
        if negative.is_zero() {
            return 0.0;
        }
        let leading = negative.coefficient(negative.degree());
        match leading.decided() && leading.value > 0.0 {
            true => negative.beyond_zeros().sqrt() * (1.0 + 1e-12),
            false => f64::INFINITY,
        }
    }

    /// The left side of (3).
    fn slope(&self) -> Sum {
        let [_, all] = self.slope_terms();
        all.sum()
    }

    fn slope_at(&self, omega: f64) -> f64 {
        let at = self.values(omega);
        let [u, v, w, y] = self.of_slope().map(|p| p.value(at.lambda));
        let constant = u * at.kept - w * at.passed;
        let linear = v * at.kept - y * at.passed;
        -(constant * linear.conj()).re / linear.norm_sqr()
    }

    /// Beyond ω = 1 the highest power outweighs all others where (1 − |R|q)² |L|² ω(ω² + σ² − 1)
    /// does.
    fn slope_bound(&self) -> f64 {
        let kept =
            1.0 - self.beyond.channel.memory.abs() * (self.delayed.value + self.delayed.error);
        if kept.is_nan() || kept <= 0.0 {
            return f64::INFINITY;
        }
        let all = self.beyond.lag_polynomials().all;
        // |L|² is even in ω, and all its powers are positive.
        let lags = self.product(&all, &all);
        let even = Polynomial::of(lags.degree(), |k| exactly(lags.coefficient(k).value.abs()));
        let decay = self.setting.decay;
        let weight = kept * kept * (1.0 - 1e-9);
        let own = polynomial(&[0.0, weight * (decay * decay - 1.0), 0.0, weight]);
        let [rest, _] = self.slope_terms();
        let left = times(&even, &own).plus(&rest.sizes(), -1.0);
        left.beyond_zeros().max(1.0)
    }

    /// |N|² − |M|².
    fn unit_loop(&self) -> Sum {
        let (memory, q) = (self.beyond.channel.memory, self.delayed);
        let square = q.times(q);
        let fed = self.product(&self.gain, &self.gain);
        let fed = fed.scaled(self.late.times(self.late));
        let own = self.product(&self.open, &self.open);
        let tau = self.setting.tau;
        let one_and = |number: Rounded| plus(exactly(1.0), number);
        let kept = one_and(square.scaled(memory * memory));
        let mut terms = Terms::new(Part::Real)
            .plus(&fed, one_and(square), 0.0)
            .plus(&own, kept.scaled(-1.0), 0.0)
            .plus(&fed, q.scaled(-2.0), tau);
        if memory != 0.0 {
            terms = terms.plus(&own, q.scaled(2.0 * memory), tau);
        }
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
