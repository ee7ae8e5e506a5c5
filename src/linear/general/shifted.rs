//! D on a vertical line, without latency.
//!
//! ```text
//! p = P(σ + iω),  q = κ Q(σ + iω),  F_σ(x) = |p|² − |q|²,  x = ω²,  κ = e^(−στ)               (6)
//! F_σ = (1 − κ²R²)|B|² − 2(1 − κ²R) Re(A B*) + (1 − κ²)|A|²;  σ = 0: (1 + R)|B|² − 2 Re(A B*)  (8)
//! ```
//!
//! (8) is (6) in feedback form, on the imaginary axis divided by 1 − R: nothing is subtracted from
//! itself. (3) to (5) are in [`line`](super::line), (7) is in [`right_of`](super::right_of).

use super::parts::{Angle, Decay, remembered};
use super::polynomial::{At, Polynomial};
use crate::linear::rounded::Rounded;
use crate::model::elementary::norm;

/// P and Q, or B and A in feedback form, as polynomials in λ − σ.
#[derive(Debug, Clone, Copy)]
pub(super) struct Shifted {
    /// P, or B.
    first: Polynomial,
    /// Q, or A.
    second: Polynomial,
    /// R in feedback form.
    memory: Option<f64>,
    on_axis: bool,
    decay: Decay,
}

impl Shifted {
    /// The polynomials of P and Q in λ − σ.
    #[inline]
    pub(super) fn direct([p, q]: [&Polynomial; 2], line: f64, decay: Decay) -> Self {
        Self {
            first: p.shifted(line),
            second: q.shifted(line),
            memory: None,
            on_axis: line == 0.0,
            decay,
        }
    }

    /// The polynomials of B and A in λ − σ, with the memory R.
    #[inline]
    pub(super) fn of_feedback(
        [open, gain]: [&Polynomial; 2],
        memory: f64,
        line: f64,
        decay: Decay,
    ) -> Self {
        Self {
            memory: Some(memory),
            ..Self::direct([open, gain], line, decay)
        }
    }

    /// D(σ), of which sign and rounding matter.
    #[inline]
    pub(super) fn on_real_axis(&self) -> Rounded {
        let [first, second] = self.constants();
        if let Some(memory) = self.memory {
            // B(1 − Rκ) − A(1 − κ).
            return first
                .times(remembered(memory, self.decay))
                .minus(second.times(self.decay.lost));
        }
        let echo = second.times(self.decay.kappa);
        Rounded::sum([first.value, echo.value]).plus_error(first.error + echo.error)
    }

    #[inline(always)]
    fn constants(&self) -> [Rounded; 2] {
        [self.first.coefficient(0), self.second.coefficient(0)]
    }

    /// p(0) − q(0): F_σ(0) is D(σ) times this.
    fn mirror(&self) -> Rounded {
        let [first, second] = self.constants();
        let kappa = self.decay.kappa;
        if let Some(memory) = self.memory {
            // B(1 + Rκ) − A(1 + κ).
            let whole =
                |by: f64| Rounded::sum([1.0, by * kappa.value]).plus_error(by.abs() * kappa.error);
            return first.times(whole(memory)).minus(second.times(whole(1.0)));
        }
        first.minus(second.times(kappa))
    }

    /// F_σ, a polynomial in x; on the imaginary axis it may be divided by a positive constant.
    pub(super) fn modulus(&self) -> Polynomial {
        let sum = if self.on_axis && self.memory.is_some() {
            self.first.coefficient(0)
        } else {
            self.on_real_axis()
        };
        // The product keeps its sign where a root is near σ, the difference of squares does not.
        self.by_squares().with_constant(sum.times(self.mirror()))
    }

    fn by_squares(&self) -> Polynomial {
        let kappa = self.decay.kappa;
        let (first, second) = (&self.first, &self.second);
        let own = first.square();
        let Some(memory) = self.memory else {
            let echo = second.square();
            return if self.on_axis {
                own.plus(&echo, -1.0)
            } else {
                own.plus(&echo.scaled(kappa.times(kappa)), -1.0)
            };
        };
        let both = second.real_product(first);
        if self.on_axis {
            let own = if memory == 0.0 {
                own
            } else {
                own.scaled(Rounded {
                    value: 1.0 + memory,
                    error: f64::EPSILON,
                })
            };
            return own.plus(&both, -2.0);
        }
        let [outer, middle, lost] = self.off_axis(memory);
        let sum = if memory == 0.0 {
            own
        } else {
            own.scaled(outer)
        };
        sum.plus(&both.scaled(middle), -2.0)
            .plus(&second.square().scaled(lost), 1.0)
    }

    /// 1 − κ²R², 1 − κ²R and 1 − κ² of (8).
    fn off_axis(&self, memory: f64) -> [Rounded; 3] {
        let Decay { kappa, lost } = self.decay;
        let square = kappa.times(kappa);
        // 1 − κ² = (1 − κ)(1 + κ).
        let lost = lost.times(Rounded::sum([1.0, kappa.value]).plus_error(kappa.error));
        let outer = remembered(memory, self.decay).times(
            Rounded::sum([1.0, memory * kappa.value]).plus_error(memory.abs() * kappa.error),
        );
        let middle = Rounded::sum([lost.value, square.value * (1.0 - memory)])
            .plus_error(lost.error + square.error * (1.0 - memory));
        [outer, middle, lost]
    }

    /// The larger degree of both.
    #[inline]
    pub(super) fn degree(&self) -> usize {
        self.first.degree().max(self.second.degree())
    }

    /// P and Q, or B and A, as polynomials in λ − σ.
    pub(super) fn polynomials(&self) -> [&Polynomial; 2] {
        [&self.first, &self.second]
    }

    /// The factors in F of |p|², of 2 Re(p q*) and of |q|², p and q being those of
    /// [`Shifted::polynomials`].
    pub(super) fn factors(&self) -> [Rounded; 3] {
        let number = |value: f64| Rounded { value, error: 0.0 };
        let kappa = self.decay.kappa;
        match self.memory {
            None if self.on_axis => [1.0, 0.0, -1.0].map(number),
            None => [number(1.0), number(0.0), kappa.times(kappa).scaled(-1.0)],
            Some(memory) if self.on_axis => {
                let rounding = if memory == 0.0 { 0.0 } else { f64::EPSILON };
                [
                    number(1.0 + memory).plus_error(rounding),
                    number(-1.0),
                    number(0.0),
                ]
            }
            Some(memory) => {
                let [outer, middle, lost] = self.off_axis(memory);
                [outer, middle.scaled(-1.0), lost]
            }
        }
    }

    /// The argument α of −P Q* at σ + iω and a bound on its error, `omega` being known to within
    /// `error`: none where nothing is known of it. An angle with an error above `enough` is worth a
    /// slower evaluation.
    ///
    /// D vanishes there where |P| = κ|Q| and α + ωτ is a multiple of 2π.
    #[inline(always)]
    pub(super) fn phase(&self, omega: f64, error: f64, enough: f64) -> Option<Angle> {
        let first = self.first.on_axis(omega, error);
        let second = self.second.on_axis(omega, error);
        let angle = self.angle(first, second);
        match angle {
            Some(angle) if angle.error <= enough => Some(angle),
            _ => self.phase_exactly(omega, error).or(angle),
        }
    }

    /// The phase of [`Shifted::phase`], as narrow as the errors of the coefficients allow.
    #[cold]
    fn phase_exactly(&self, omega: f64, error: f64) -> Option<Angle> {
        let [first, second] = self
            .polynomials()
            .map(|of| of.on_axis_exactly(omega, error));
        self.angle(first, second)
    }

    #[inline(always)]
    fn angle(&self, first: At, second: At) -> Option<Angle> {
        match self.memory {
            Some(memory) => Angle::of_feedback(first, second, memory),
            None => Angle::of_pair(first, second),
        }
    }

    /// Whether P and Q may both vanish at iω, `omega` being known to within `error`.
    pub(super) fn may_vanish(&self, omega: f64, error: f64) -> bool {
        let values = self.polynomials();
        let at = values.map(|of| of.on_axis_exactly(omega, error));
        at.iter().all(|at| norm(at.value) <= at.error)
    }
}
