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
use super::trig_polynomial::{self, Polynomial, TrigPolynomial};
use super::zeros::Wave;
use crate::linear::certificate::roots_right_of;
use crate::linear::characteristic::{Jet, root_bound};
use crate::linear::stable_delays::StableInterval;
use crate::linear::{Crossings, MarginalTolerance};
use crate::model::Groups;
use crate::model::elementary::exp;
use crate::model::groups::{feedback, open_loop};

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
    type Function: Wave;

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

    /// The left side of (2).
    fn slope(&self) -> Self::Function;

    /// The slope b that a zero of [`OnLine::slope`] belongs to.
    fn slope_at(&self, omega: f64) -> f64;

    /// The ω beyond which no root of any slope b lies on the line.
    fn slope_bound(&self) -> f64;

    /// The left side minus the right side of (3).
    fn unit_loop(&self) -> Self::Function;

    /// −L.
    fn negative_loop(&self, omega: f64) -> Complex64;

    /// The ω beyond which no zero of (3) lies.
    fn unit_loop_bound(&self) -> f64;
}

/// A polynomial in ω with complex coefficients.
#[derive(Debug, Clone, Copy)]
struct Complex {
    re: Polynomial,
    im: Polynomial,
}

impl Complex {
    fn of<const N: usize>(re: [f64; N], im: [f64; N]) -> Self {
        Self {
            re: Polynomial::of(re),
            im: Polynomial::of(im),
        }
    }

    /// The conjugate for real ω.
    fn conjugate(self) -> Self {
        Self {
            im: Polynomial::default().plus(self.im, -1.0),
            ..self
        }
    }

    fn times(self, other: Self) -> Self {
        Self {
            re: self.re.times(other.re).plus(self.im.times(other.im), -1.0),
            im: self.re.times(other.im).plus(self.im.times(other.re), 1.0),
        }
    }
}

impl Setting {
    /// λ.
    fn lambda(&self) -> Complex {
        Complex::of([-self.decay, 0.0], [0.0, 1.0])
    }

    /// A.
    fn feedback(&self) -> Complex {
        let Groups { b, a_v, a_n } = self.groups;
        Complex::of([feedback(a_n, a_v, b - self.decay), 0.0], [0.0, a_v])
    }

    /// B.
    fn open_loop(&self) -> Complex {
        let (b, s) = (self.groups.b, self.decay);
        Complex::of([1.0 + s * (s - b), 0.0, -1.0], [0.0, b - 2.0 * s, 0.0])
    }

    /// e^(στ), the size of E.
    fn size_of_delayed(&self) -> f64 {
        exp(self.decay * self.tau)
    }

    /// The left side of (2).
    fn slope_equation(&self) -> TrigPolynomial {
        let Groups { a_v, a_n, .. } = self.groups;
        let (s, q) = (self.decay, self.size_of_delayed());
        let lambda = self.lambda();
        let square = Complex::of([1.0 + s * s, 0.0, -1.0], [0.0, -2.0 * s, 0.0]);
        let gains = Complex::of([a_n - a_v * s, 0.0], [0.0, a_v]);
        // N M* = u λ* − a_v u S* − w λ* S + a_v w |S|².
        let free = square.times(lambda.conjugate());
        let mixed = gains.times(lambda.conjugate());
        let [u, w] = [square, gains];
        let scaled = |polynomial: Polynomial, by: f64| Polynomial::default().plus(polynomial, by);
        // Im[z S] = z_i (1 − q cos) + z_r q sin, Im[z S*] = z_i (1 − q cos) − z_r q sin.
        let even = scaled(u.im, -a_v).plus(mixed.im, -1.0);
        let square_of_s = scaled(w.im, a_v);
        TrigPolynomial {
            free: free.im.plus(even, 1.0).plus(square_of_s, 1.0 + q * q),
            cosine: scaled(even, -q).plus(square_of_s, -2.0 * q),
            sine: scaled(u.re, a_v * q).plus(mixed.re, -q),
            t: self.tau,
        }
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
    type Function = trig_polynomial::Jet;

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

    fn gain(&self) -> trig_polynomial::Jet {
        let product = self.feedback().times(self.open_loop().conjugate());
        if self.decay == 0.0 {
            let on_axis = TrigPolynomial {
                free: Polynomial::default(),
                cosine: product.re,
                sine: product.im,
                t: 0.5 * self.tau,
            };
            return on_axis.jet();
        }
        let q = self.size_of_delayed();
        // S = 1 − q cos ωτ + i q sin ωτ.
        let f = TrigPolynomial {
            free: product.im,
            cosine: Polynomial::default().plus(product.im, -q),
            sine: Polynomial::default().plus(product.re, q),
            t: self.tau,
        };
        f.jet()
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

    fn slope(&self) -> trig_polynomial::Jet {
        self.slope_equation().jet()
    }

    fn slope_at(&self, omega: f64) -> f64 {
        let Groups { a_v, a_n, .. } = self.groups;
        let at = self.at(omega);
        let lambda = at.lambda;
        let n = lambda * lambda + 1.0 - feedback(a_n, a_v, lambda) * at.difference;
        let m = lambda - a_v * at.difference;
        -(n * m.conj()).re / m.norm_sqr()
    }

    fn unit_loop(&self) -> trig_polynomial::Jet {
        let q = self.size_of_delayed();
        let size = |z: Complex| z.re.times(z.re).plus(z.im.times(z.im), 1.0);
        let feedback = size(self.feedback());
        let open = size(self.open_loop());
        let none = Polynomial::default();
        let f = TrigPolynomial {
            free: none.plus(open, -1.0).plus(feedback, 1.0 + q * q),
            cosine: none.plus(feedback, -2.0 * q),
            sine: none,
            t: self.tau,
        };
        f.jet()
    }

    fn negative_loop(&self, omega: f64) -> Complex64 {
        let at = self.at(omega);
        at.feedback * at.difference / at.open_loop
    }

    /// In (2) |uλ* + …| is ω³ and more, all the rest at most quadratic in ω.
    fn slope_bound(&self) -> f64 {
        let f = self.slope_equation();
        let rest = |i: usize| {
            let waves = f.cosine.0[i].abs() + f.sine.0[i].abs();
            waves + if i < 3 { f.free.0[i].abs() } else { 0.0 }
        };
        // f = ∓ω³ + lower powers: Cauchy's bound on the zeros.
        debug_assert_eq!((f.cosine.0[3], f.sine.0[3], f.free.0[4]), (0.0, 0.0, 0.0));
        1.0 + (0..3).map(rest).fold(0.0, f64::max) / f.free.0[3].abs()
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
