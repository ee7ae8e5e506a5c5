//! Numbers with a bound on their rounding error.

/// Rounding errors that an expression here may gather, each of ε/2 of its largest term.
pub(super) const ROUNDINGS: f64 = 8.0 * f64::EPSILON;

/// A number and a bound on its rounding error.
#[derive(Debug, Clone, Copy)]
pub(super) struct Rounded {
    pub value: f64,
    pub error: f64,
}

impl Rounded {
    /// The sum of `terms`.
    #[inline(always)]
    pub(super) fn sum<const N: usize>(terms: [f64; N]) -> Self {
        let (mut value, mut size) = (0.0, 0.0);
        for term in terms {
            value += term;
            size += term.abs();
        }
        Self {
            value,
            error: ROUNDINGS * size,
        }
    }

    #[inline(always)]
    pub(super) fn plus_error(self, error: f64) -> Self {
        Self {
            error: self.error + error,
            ..self
        }
    }

    /// The product with `by`, whose own error is negligible.
    #[inline(always)]
    pub(super) fn scaled(self, by: f64) -> Self {
        Self {
            value: by * self.value,
            error: by.abs() * self.error,
        }
    }

    #[inline(always)]
    pub(super) fn minus(self, other: Self) -> Self {
        Self::sum([self.value, -other.value]).plus_error(self.error + other.error)
    }

    #[inline(always)]
    pub(super) fn times(self, other: Self) -> Self {
        let value = self.value * other.value;
        let error = self.value.abs() * other.error + other.value.abs() * self.error;
        Self {
            value,
            error: error + ROUNDINGS * value.abs(),
        }
    }

    /// Whether the sign is beyond doubt.
    #[inline(always)]
    pub(super) fn decided(self) -> bool {
        self.value.abs() > self.error
    }

    /// The square root, or 0 where the number is negative.
    #[inline(always)]
    pub(super) fn root(self) -> Self {
        let root = larger(self.value, 0.0).sqrt();
        let error = if self.value > self.error {
            self.error / root
        } else {
            self.error.sqrt()
        };
        Self {
            value: root,
            error: error + ROUNDINGS * root,
        }
    }
}

/// `f64::max` without its care for NaN, which costs time.
#[inline(always)]
pub(super) fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}
