//! What finding roots needs of a system with latency.

use num_complex::Complex64;

use super::super::parts::{FeedbackForm, exponential, late};
use super::super::polynomial::Polynomial;
use crate::linear::collocation::{Late, late_eigenvalues};
use crate::model::elementary::{exp, pow};

impl FeedbackForm {
    /// How much larger than A the fed back A e^(−λδ) is at λ, with what rounding of λδ adds.
    pub(in super::super) fn late_size(&self, lambda: Complex64) -> f64 {
        if self.channel.latency == 0.0 {
            return 1.0;
        }
        exp(-lambda.re * self.channel.latency) * (1.0 + self.channel.latency * lambda.l1_norm())
    }

    /// 𝒫, 𝒫′, 𝒬 and 𝒬′ of (1) in [`on_line`](super::on_line).
    pub(in super::super) fn pair(&self, lambda: Complex64) -> [Complex64; 4] {
        let [open, open_slope, _] = self.open.jet(lambda);
        let [fed, fed_slope, _] = late(self.gain.jet(lambda), self.channel.latency, lambda);
        [
            open - fed,
            open_slope - fed_slope,
            fed - self.channel.memory * open,
            fed_slope - self.channel.memory * open_slope,
        ]
    }

    /// 𝒫‴ and the first three derivatives of 𝒬.
    pub(in super::super) fn thirds(&self, lambda: Complex64) -> [Complex64; 4] {
        let (b, a) = (self.open.jet(lambda), self.gain.jet(lambda));
        let third = |p: &Polynomial| p.derivative().jet(lambda)[2];
        let (b_third, a_third) = (third(&self.open), third(&self.gain));
        let delta = self.channel.latency;
        let fed = late(a, delta, lambda);
        let fed_third = (a_third - delta * (3.0 * a[2] - delta * (3.0 * a[1] - delta * a[0])))
            * exponential(-delta * lambda);
        [
            b_third - fed_third,
            fed[1] - self.channel.memory * b[1],
            fed[2] - self.channel.memory * b[2],
            fed_third - self.channel.memory * b_third,
        ]
    }

    /// A radius within which every root with Re λ ≥ `line` lies: there
    /// (1 − |R|κ)|B| ≤ e^(−σδ)(1 + κ)|A|.
    pub(in super::super) fn late_root_bound(&self, tau: f64, line: f64) -> f64 {
        let kappa = exp(-line * tau);
        let kept = 1.0 - self.channel.memory.abs() * kappa * (1.0 + 4.0 * f64::EPSILON);
        let factor = exp(-line * self.channel.latency) * (1.0 + kappa) / kept;
        let n = self.open.degree();
        let size = |p: &Polynomial, k: usize| {
            let c = p.coefficient(k);
            if k <= p.degree() {
                c.value.abs() + c.error
            } else {
                0.0
            }
        };
        let leading = self.open.leading();
        let leading = leading.value.abs() - leading.error;
        if kept.is_nan() || kept <= 0.0 || leading <= 0.0 || !factor.is_finite() {
            return f64::INFINITY;
        }
        let radius = |k: usize| {
            let ratio = (size(&self.open, k) + factor * size(&self.gain, k)) / leading;
            pow(ratio, 1.0 / (n - k) as f64)
        };
        2.0 * (1.0 + 1e-12) * (0..n).map(radius).fold(0.0, f64::max)
    }

    /// D where both exponentials are parabolas:
    /// B(1 − R) + R B(λτ − λ²τ²/2) − A(λτ − λ²(τ²/2 + τδ)).
    pub(in super::super) fn slow(&self, tau: f64) -> Option<Polynomial> {
        let parabola = |bend: f64| Polynomial::new(&[0.0, tau, -bend]).ok();
        let half = 0.5 * tau * tau;
        let own = self.open.times(&parabola(half)?).ok()?;
        let fed = self
            .gain
            .times(&parabola(half + tau * self.channel.latency)?)
            .ok()?;
        let kept = self.open.plus(&self.open, -self.channel.memory);
        Some(kept.plus(&own, self.channel.memory).plus(&fed, -1.0))
    }

    /// Approximate roots by collocation of what is fed back, A x, over the time τ + δ.
    pub(in super::super) fn eigenvalues(&self, tau: f64, nodes: usize) -> Option<Vec<Complex64>> {
        late_eigenvalues(
            &Late {
                open: self.open.coefficients(),
                gain: self.gain.coefficients(),
                channel: self.channel,
                tau,
            },
            nodes,
        )
    }
}
