//! The factor e^(−στ) of what is fed back, on a vertical line, without cancellation.

use crate::linear::rounded::Rounded;
use crate::model::elementary::expm1;

/// e^(−στ) and what is made of it without cancellation.
#[derive(Debug, Clone, Copy)]
pub(super) struct Decay {
    /// κ = e^(−στ).
    pub kappa: Rounded,
    /// 1 − κ.
    pub lost: Rounded,
}

impl Decay {
    /// On the imaginary axis.
    pub(super) const NONE: Self = Self {
        kappa: Rounded {
            value: 1.0,
            error: 0.0,
        },
        lost: Rounded {
            value: 0.0,
            error: 0.0,
        },
    };

    /// None where κ overflows.
    pub(super) fn new(line: f64, tau: f64) -> Option<Self> {
        if line == 0.0 || tau == 0.0 {
            return Some(Self::NONE);
        }
        let growth = expm1(-line * tau);
        let kappa = growth + 1.0;
        let error = f64::EPSILON * kappa * (1.0 + (line * tau).abs());
        kappa.is_finite().then_some(Self {
            kappa: Rounded {
                value: kappa,
                error: error + f64::EPSILON * kappa,
            },
            lost: Rounded {
                value: -growth,
                error: error.min(2.0 * f64::EPSILON * growth.abs() * (1.0 + (line * tau).abs()))
                    + f64::EPSILON * growth.abs(),
            },
        })
    }
}

/// 1 without error.
const ONE: Rounded = Rounded {
    value: 1.0,
    error: 0.0,
};

/// 1 − Rκ without cancellation: (1 − R) + R(1 − κ).
pub(super) fn remembered(memory: f64, decay: Decay) -> Rounded {
    if memory == 0.0 {
        return ONE;
    }
    Rounded::sum([1.0 - memory, memory * decay.lost.value])
        .plus_error(memory.abs() * decay.lost.error + f64::EPSILON)
}
