//! D on a vertical line in its two forms, with either delay as the one that swings.
//!
//! With κ = e^(−στ), E = κ e^(−iωτ) and 𝒜 = A e^(−λδ) at λ = σ + iω
//!
//! ```text
//! D = 𝒫 + 𝒬 E       𝒫 = B − 𝒜           𝒬 = 𝒜 − R B                                         (1)
//! D = 𝒫 + 𝒬 e^(−λδ)   𝒫 = B(1 − R E)     𝒬 = −A(1 − E)                                       (2)
//!
//! (1):  |𝒫|² − κ²|𝒬|² = (1 − κ²R²)|B|² − 2(1 − κ²R) Re[𝒜 B*] + (1 − κ²)|𝒜|²                   (3)
//! (2):  |𝒫|² − |𝒬 e^(−σδ)|² = (1 − Rκ)²|B|² − (1 − κ)²|𝒜|² + 2κ(R|B|² − |𝒜|²)(1 − cos ωτ)      (4)
//! ```
//!
//! (3) swings with δ and holds for every τ on the imaginary axis, (4) the other way round. On that
//! axis (3) is divided by 1 − R. Both vanish only where B/𝒜 lies on a circle about the real axis,
//!
//! ```text
//! |B/𝒜 − 1| = κ|1 − R B/𝒜|:   |B/𝒜| is between (1 + κ)/(1 + Rκ) and |1 − κ|/(1 − Rκ)         (5)
//! ```
//!
//! and are positive where |B/𝒜| is larger than that.

use num_complex::Complex64;

use super::super::parts::{Angle, Decay, FeedbackForm, remembered};
use super::super::polynomial::{At, Polynomial};
use super::wave::Wave;
use super::window::{Window, before_zeros, beyond_zeros};
use crate::linear::characteristic::one_minus_exp;
use crate::linear::rounded::Rounded;
use crate::model::Channel;
use crate::model::elementary::sincos;

/// Which of the two delays turns the feedback term in the argument principle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Form {
    /// (1) of `on_line`: the delay τ turns, the latency is inside 𝒫 and 𝒬.
    Delay,
    /// (2) of `on_line`: the latency δ turns, the delay is inside 𝒫 and 𝒬.
    Latency,
}

/// B and A on one line at one delay and latency.
#[derive(Debug, Clone, Copy)]
pub(in super::super) struct OnLine {
    /// B(σ + z).
    pub open: Polynomial,
    /// e^(−σδ) A(σ + z).
    pub gain: Polynomial,
    /// |B|², and |𝒜|² in `fed`.
    own: Polynomial,
    fed: Polynomial,
    /// R and δ.
    pub channel: Channel,
    pub line: f64,
    pub tau: f64,
    /// κ.
    pub decay: Decay,
}

const fn exactly(value: f64) -> Rounded {
    Rounded { value, error: 0.0 }
}

fn plus(a: Rounded, b: Rounded) -> Rounded {
    Rounded::sum([a.value, b.value]).plus_error(a.error + b.error)
}

impl OnLine {
    /// B and A on the line Re λ = `line` at the delay `tau`; none where e^(−στ) or e^(−σδ)
    /// overflows.
    pub(in super::super) fn new(feedback: &FeedbackForm, tau: f64, line: f64) -> Option<Self> {
        let late = Decay::new(line, feedback.channel.latency)?;
        let open = feedback.open.shifted(line);
        let mut gain = feedback.gain.shifted(line);
        if line != 0.0 {
            gain = gain.scaled(late.kappa);
        }
        Some(Self {
            own: open.real_product(&open),
            fed: gain.real_product(&gain),
            open,
            gain,
            channel: feedback.channel,
            line,
            tau,
            decay: Decay::new(line, tau)?,
        })
    }

    fn on_axis(&self) -> bool {
        self.line == 0.0
    }

    /// Whether the line lies right of the one at which roots accumulate; none where that is open.
    pub(in super::super) fn right_of_essential(&self) -> Option<bool> {
        let kept = remembered(self.channel.memory.abs(), self.decay);
        kept.decided().then_some(kept.value > 0.0)
    }

    /// 1 + factor κ.
    fn one_and(&self, factor: f64) -> Rounded {
        let kappa = self.decay.kappa;
        Rounded::sum([1.0, factor * kappa.value]).plus_error(factor.abs() * kappa.error)
    }

    /// Where (3) and (4) can vanish, right of the line at which roots accumulate.
    pub(in super::super) fn window(&self) -> Window {
        let (own, fed) = (&self.own, &self.fed);
        // The ends of (5) as numerators and denominators.
        let ends = [
            (self.one_and(1.0), self.one_and(self.channel.memory)),
            (self.decay.lost, remembered(self.channel.memory, self.decay)),
        ];
        let [plus, minus] = ends.map(|(above, below)| (above.value / below.value).abs());
        let [outer, inner] = if plus >= minus { [0, 1] } else { [1, 0] };
        let apart = |end: usize| {
            let (above, below) = ends[end];
            own.scaled(below.times(below))
                .plus(&fed.scaled(above.times(above)), -1.0)
        };
        let outside = apart(outer);
        let to = beyond_zeros(&outside);
        // Up to there |B/𝒜| is beyond the same end as at ω = 0.
        let constant = outside.coefficient(0);
        let from = if constant.decided() && constant.value > 0.0 {
            before_zeros(&outside)
        } else {
            let inside = apart(inner);
            let constant = inside.coefficient(0);
            if constant.decided() && constant.value < 0.0 {
                before_zeros(&inside.scaled(exactly(-1.0)))
            } else {
                0.0
            }
        };
        Window { from, to }
    }

    /// |B|² − |𝒜|² with factors: where one or the other is larger.
    pub(in super::super) fn difference(&self, open: f64, gain: f64) -> Polynomial {
        let own = self.own.scaled(exactly(open));
        own.plus(&self.fed.scaled(exactly(gain)), -1.0)
    }

    /// D(σ) = B(1 − Rκ) − 𝒜(1 − κ).
    pub(in super::super) fn on_real_axis(&self) -> Rounded {
        let (open, gain) = (self.open.coefficient(0), self.gain.coefficient(0));
        let own = open.times(remembered(self.channel.memory, self.decay));
        if self.on_axis() {
            return own;
        }
        own.minus(gain.times(self.decay.lost))
    }

    /// The function (3) or (4), whichever belongs to `form`.
    pub(in super::super) fn wave(&self, form: Form) -> Wave {
        match form {
            Form::Delay => self.wave_of_latency(),
            Form::Latency => self.wave_of_delay(),
        }
    }

    /// The function (3), which swings with the latency.
    fn wave_of_latency(&self) -> Wave {
        let (own, fed) = (&self.own, &self.fed);
        let along = self.gain.real_product(&self.open);
        let across = self.gain.imaginary_product(&self.open);
        let (open, gain) = (self.open.coefficient(0), self.gain.coefficient(0));
        let (twice, u, sum, mirror);
        if self.on_axis() {
            let memory = Rounded::sum([1.0, self.channel.memory]);
            twice = exactly(2.0);
            u = own.scaled(memory).plus(&along, -2.0);
            sum = open;
            mirror = open.times(memory).minus(gain.scaled(2.0));
        } else {
            let Decay { kappa, lost } = self.decay;
            let square = kappa.times(kappa);
            // 1 − κ² and 1 − κ²R without cancellation.
            let lost = lost.times(self.one_and(1.0));
            let middle = plus(lost, square.scaled(1.0 - self.channel.memory));
            let outer = remembered(self.channel.memory, self.decay)
                .times(self.one_and(self.channel.memory));
            twice = middle.scaled(2.0);
            u = own
                .scaled(outer)
                .plus(&along.scaled(twice), -1.0)
                .plus(&fed.scaled(lost), 1.0);
            sum = self.on_real_axis();
            mirror = open
                .times(self.one_and(self.channel.memory))
                .minus(gain.times(self.one_and(1.0)));
        }
        Wave {
            // The product keeps its sign where a root is near σ.
            parts: [
                u.with_constant(sum.times(mirror)),
                along.scaled(twice),
                across.scaled(twice.scaled(-1.0)),
            ],
            t: self.channel.latency,
        }
    }

    /// The function (4), which swings with the delay.
    fn wave_of_delay(&self) -> Wave {
        let (own, fed) = (&self.own, &self.fed);
        let kept = remembered(self.channel.memory, self.decay);
        let mut u = own.scaled(kept.times(kept));
        if !self.on_axis() {
            let lost = self.decay.lost;
            u = u.plus(&fed.scaled(lost.times(lost)), -1.0);
            let mirror = plus(
                self.open.coefficient(0).times(kept),
                self.gain.coefficient(0).times(lost),
            );
            u = u.with_constant(self.on_real_axis().times(mirror));
        }
        let twice = self.decay.kappa.scaled(2.0);
        let swing = own.scaled(exactly(self.channel.memory)).plus(fed, -1.0);
        Wave {
            parts: [u, swing.scaled(twice), Polynomial::ZERO],
            t: self.tau,
        }
    }

    /// B and 𝒜 at `omega`, known to within `error`.
    pub(in super::super) fn at(&self, omega: f64, error: f64) -> (At, At) {
        let open = self.open.on_axis(omega, error);
        let gain = self.gain.on_axis(omega, error);
        let angle = omega * self.channel.latency;
        let (sin, cos) = sincos(angle);
        let size = gain.value.norm_sqr().sqrt();
        let turned = size * (2.0 * f64::EPSILON * (angle + 2.0) + self.channel.latency * error);
        let late = At {
            value: gain.value * Complex64::new(cos, -sin),
            error: gain.error + turned,
        };
        (open, late)
    }

    /// The argument of −𝒫 𝒬* at `omega`, known to within `error`: none where nothing is known of
    /// it.
    pub(in super::super) fn phase(&self, form: Form, omega: f64, error: f64) -> Option<Angle> {
        match form {
            Form::Delay => {
                let (open, late) = self.at(omega, error);
                Angle::of_feedback(open, late, self.channel.memory)
            }
            Form::Latency => {
                let product = self.echoes(omega);
                let open = self.open.on_axis(omega, error);
                let gain = self.gain.on_axis(omega, error);
                let turned = self.decay.kappa.value
                    * (f64::EPSILON * (omega * self.tau + 2.0) + self.tau * error);
                let relative = |value: Complex64, error: f64| {
                    error / (value.norm_sqr().sqrt() - error).max(0.0)
                };
                let [kept, lost] = product;
                let error = 2.0
                    * (relative(open.value, open.error)
                        + relative(gain.value, gain.error)
                        + relative(kept, self.channel.memory.abs() * turned + f64::EPSILON)
                        + relative(lost, turned + f64::EPSILON * lost.l1_norm()))
                    + 8.0 * f64::EPSILON;
                let value = open.value * kept * (gain.value * lost).conj();
                (error < 1.0).then(|| Angle {
                    value: crate::model::elementary::arg(value),
                    error,
                })
            }
        }
    }

    /// 1 − R E and 1 − E.
    pub(in super::super) fn echoes(&self, omega: f64) -> [Complex64; 2] {
        let lost = one_minus_exp(Complex64::new(-self.line * self.tau, -omega * self.tau));
        [1.0 - self.channel.memory + self.channel.memory * lost, lost]
    }
}
