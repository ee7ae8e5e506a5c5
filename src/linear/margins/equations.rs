//! Where a root lies on the line λ = −σ + iω, as one real equation in ω for each way in which a
//! setting can change.
//!
//! With S = 1 − E = 1 − e^(−λτ) and the loop L = −A S/B, in the symbols of
//! [`characteristic`](crate::linear::characteristic),
//!
//! ```text
//! gains k A:    k A S = B              Im[A S B*] = 0,    k = |B|²/Re[A S B*]               (1)
//! slope b:      N + b M = 0            Im[N M*] = 0,      b = −Re[N M*]/|M|²                (2)
//!               N = λ² + 1 − (a_n + a_v λ) S,  M = λ − a_v S
//! loop e^(iφ) L:  |L| = 1              |A|²|S|² = |B|²,   φ = arg(−1/L)                     (3)
//! ```
//!
//! On the imaginary axis S = 2i e^(−iωτ/2) sin(ωτ/2): (1) loses the factor sin(ωτ/2), at whose
//! zeros no gain acts, and the letter's Eq. (4) gives k.
//!
//! ```text
//! P_r cos(ωτ/2) + P_i sin(ωτ/2) = 0,   P = A B*,   k = |B|²/(2 P_r)                         (4)
//! ```

use num_complex::Complex64;

use super::beyond::Beyond;
use super::enclosure;
use super::setting::Setting;
use super::sum::{Part, Sum, Terms, conjugate, exactly, growth, on_line, one_and};
use crate::linear::certificate::roots_right_of;
use crate::linear::characteristic::{Jet, root_bound};
use crate::linear::feedback_loop::polynomial;
use crate::linear::general::Polynomial;
use crate::linear::real_zeros::RealFunction;
use crate::linear::rounded::Rounded;
use crate::linear::stable_delays::StableInterval;
use crate::linear::{Crossings, MarginalTolerance};
use crate::model::Groups;
use crate::model::elementary::exp;
use crate::model::groups::{feedback, open_loop, open_loop_coefficients};

/// Ranges of what a setting can be: sizes up to these.
#[derive(Debug, Clone, Copy)]
pub struct UpTo {
    /// b, a_v and a_n.
    pub groups: Groups,
    /// The delay τ.
    pub tau: f64,
    /// The latency δ.
    pub latency: f64,
    /// How many times as large as these gains and delay can be.
    pub factor: f64,
}

/// A setting's equations in ω on the line Re λ = −σ, and what is known of the settings around it:
/// those of the letter here, those beyond it in `beyond`.
pub trait OnLine: Clone {
    /// The left side of an equation.
    type Function: RealFunction;

    /// How many steps along a direction are looked at for settings that are not stable.
    const STEPS: u32;

    /// How many times D can be enclosed while the crossings of a setting are found.
    const WORK_OF_CROSSINGS: u32;

    /// What the feedback has beyond the letter's own, if anything.
    fn beyond(&self) -> Option<Beyond>;

    /// Whether all roots are left of the line with these groups and this delay; none where one is
    /// on it within rounding.
    fn stability(&self, groups: Groups, tau: f64) -> Option<bool>;

    /// The interval of delays around `tau` in which sliding is stable with these groups; none where
    /// it is not. And how many frequencies took many digits.
    fn stable_interval_at(&self, groups: Groups, tau: f64) -> (Option<StableInterval>, u32);

    /// The ω beyond which no root lies on the line in these ranges.
    fn highest(&self, up_to: UpTo) -> f64;

    /// The left side of (1), or of (4) on the imaginary axis.
    fn gain(&self) -> Self::Function;

    /// The factor k of the gains that a zero of [`OnLine::gain`] belongs to.
    fn gain_factor(&self, omega: f64) -> f64;

    /// The ω beyond which no root with gains of up to `factor` times as much lies on the line.
    fn gain_bound(&self, factor: f64) -> f64;

    /// The ω beyond which no crossing lies at any factor of the gains.
    fn highest_with_gain(&self) -> f64;

    /// The left side of (2), and the ω beyond which no root of any slope b lies on the line.
    fn slope(&self) -> (Self::Function, f64);

    /// The slope b that a zero of [`OnLine::slope`] belongs to.
    fn slope_at(&self, omega: f64) -> f64;

    /// The left side minus the right side of (3).
    fn unit_loop(&self) -> Self::Function;

    /// −L.
    fn negative_loop(&self, omega: f64) -> Complex64;

    /// The ω beyond which no zero of (3) lies.
    fn unit_loop_bound(&self) -> f64;
}

/// The parts of A B* on the imaginary axis that a_n and a_v are factors of, without lags. The
/// second is (c + λ)(λ² + bλ + 1)* = c + (1 − bc)λ − dλ² + λ³, c = b − d: without the dashpot d its
/// highest real part vanishes, whatever rounding would leave of it.
pub(super) fn loop_parts(b: f64, damping: f64) -> [Polynomial; 2] {
    let moving = match damping {
        0.0 => exactly(b),
        damping => exactly(b).minus(exactly(damping)),
    };
    let square = exactly(b).times(moving);
    let velocity = Polynomial::of(3, |k| match k {
        0 => moving,
        1 => exactly(1.0).minus(square),
        2 => exactly(-damping),
        _ => exactly(1.0),
    });
    [conjugate(&polynomial(&open_loop_coefficients(b))), velocity]
}

impl Setting {
    /// A as a polynomial in λ.
    fn feedback(&self) -> Polynomial {
        let Groups { b, a_v, a_n } = self.groups;
        polynomial(&[a_n]).plus(&polynomial(&[b, 1.0]), a_v)
    }

    /// B as a polynomial in λ.
    fn open_loop(&self) -> Polynomial {
        polynomial(&open_loop_coefficients(self.groups.b))
    }

    /// A polynomial in λ as one in iω, times the conjugate of another.
    fn product(&self, one: &Polynomial, other: &Polynomial) -> Polynomial {
        on_line(-self.decay, one, other)
    }

    /// q = e^(στ), the size of E.
    fn size_of_delayed(&self) -> Rounded {
        growth(self.decay * self.tau)
    }

    fn at(&self, omega: f64) -> Values {
        let lambda = Complex64::new(-self.decay, omega);
        let jet = Jet::at(self.groups, self.tau, lambda);
        Values {
            lambda,
            difference: jet.difference,
            feedback: jet.feedback,
            open_loop: open_loop(self.groups.b, lambda),
        }
    }
}

impl OnLine for Setting {
    type Function = Sum;

    const STEPS: u32 = 48;

    const WORK_OF_CROSSINGS: u32 = 4;

    fn beyond(&self) -> Option<Beyond> {
        None
    }

    fn stability(&self, groups: Groups, tau: f64) -> Option<bool> {
        if self.decay == 0.0 {
            let count = Crossings::of(groups).count(tau, MarginalTolerance::default());
            return (!count.marginal).then_some(count.n_unstable == 0);
        }
        roots_right_of(groups, tau, -self.decay).map(|roots| roots == 0)
    }

    fn stable_interval_at(&self, groups: Groups, tau: f64) -> (Option<StableInterval>, u32) {
        (Crossings::of(groups).stable_interval_at(tau), 0)
    }

    fn highest(&self, up_to: UpTo) -> f64 {
        let Groups { b, a_v, a_n } = up_to.groups;
        let delayed = 1.0 + exp(self.decay * up_to.tau * up_to.factor);
        let control = up_to.factor * delayed * exp(self.decay * up_to.latency);
        enclosure::root_bound(b, a_v, a_n, control) * (1.0 + 1e-12)
    }

    fn gain(&self) -> Sum {
        if self.decay == 0.0 {
            let Groups { b, a_v, a_n } = self.groups;
            let [load, velocity] = loop_parts(b, 0.0);
            let mut terms = Terms::new(Part::Real);
            terms.add(&load, exactly(a_n), 0.5 * self.tau);
            terms.add(&velocity, exactly(a_v), 0.5 * self.tau);
            return terms.sum();
        }
        let product = self.product(&self.feedback(), &self.open_loop());
        let mut terms = Terms::new(Part::Imaginary);
        terms.add(&product, exactly(1.0), 0.0);
        terms.add(&product, self.size_of_delayed().scaled(-1.0), self.tau);
        terms.sum()
    }

    fn gain_factor(&self, omega: f64) -> f64 {
        let at = self.at(omega);
        let product = at.feedback * at.open_loop.conj();
        let size = at.open_loop.norm_sqr();
        if self.decay == 0.0 {
            return size / (2.0 * product.re);
        }
        size / (product * at.difference).re
    }

    /// Im of N M* = u λ* − a_v u S* − w λ* S + a_v w |S|², u = λ² + 1, w = a_n + a_v λ. There u λ*
    /// is iω³ and more, all the rest at most quadratic in ω: Cauchy's bound on the zeros.
    fn slope(&self) -> (Sum, f64) {
        let Groups { a_v, a_n, .. } = self.groups;
        let (tau, q) = (self.tau, self.size_of_delayed());
        let (square, gains) = (polynomial(&[1.0, 0.0, 1.0]), polynomial(&[a_n, a_v]));
        let [own, late] = [square, gains].map(|of| self.product(&of, &Polynomial::variable()));
        let [early, both] = [square, gains].map(|of| of.shifted(-self.decay));
        let mut terms = Terms::new(Part::Imaginary);
        terms.add(&own, exactly(1.0), 0.0);
        terms.add(&late, exactly(-1.0), 0.0);
        terms.add(&late, q, tau);
        terms.add(&early, exactly(-a_v), 0.0);
        terms.add(&early, q.scaled(a_v), -tau);
        terms.add(&both, one_and(q.times(q)).scaled(a_v), 0.0);
        terms.add(&both, q.scaled(-a_v), tau);
        terms.add(&both, q.scaled(-a_v), -tau);
        let sizes = terms.sizes();
        let most = sizes.coefficients()[..3].iter().copied();
        (terms.sum(), 1.0 + most.fold(0.0, f64::max))
    }

    fn slope_at(&self, omega: f64) -> f64 {
        let Groups { a_v, a_n, .. } = self.groups;
        let at = self.at(omega);
        let lambda = at.lambda;
        let n = lambda * lambda + 1.0 - feedback(a_n, a_v, lambda) * at.difference;
        let m = lambda - a_v * at.difference;
        -(n * m.conj()).re / m.norm_sqr()
    }

    fn unit_loop(&self) -> Sum {
        let q = self.size_of_delayed();
        let [fed, own] = [self.feedback(), self.open_loop()].map(|of| self.product(&of, &of));
        let mut terms = Terms::new(Part::Real);
        terms.add(&own, exactly(-1.0), 0.0);
        terms.add(&fed, one_and(q.times(q)), 0.0);
        terms.add(&fed, q.scaled(-2.0), self.tau);
        terms.sum()
    }

    fn negative_loop(&self, omega: f64) -> Complex64 {
        let at = self.at(omega);
        at.feedback * at.difference / at.open_loop
    }

    fn gain_bound(&self, factor: f64) -> f64 {
        let Groups { b, a_v, a_n } = self.groups;
        let groups = Groups::new(b, factor * a_v, factor * a_n);
        root_bound(groups, self.tau, -self.decay)
    }

    fn unit_loop_bound(&self) -> f64 {
        // |B| = |A||S| ≤ |A|(1 + q) is what the bound on roots is made of.
        self.gain_bound(1.0)
    }

    /// On the imaginary axis P_r = c − a_n x has to be positive, c = a_n + a_v b.
    fn highest_with_gain(&self) -> f64 {
        let Groups { b, a_v, a_n } = self.groups;
        let c = feedback(a_n, a_v, b);
        match self.decay {
            0.0 if a_n > 0.0 => (c / a_n).max(0.0).sqrt(),
            0.0 if a_n == 0.0 && c <= 0.0 => 0.0,
            _ => f64::INFINITY,
        }
    }
}

/// What equations are made of at one λ.
struct Values {
    lambda: Complex64,
    /// S.
    difference: Complex64,
    /// A.
    feedback: Complex64,
    /// B.
    open_loop: Complex64,
}
