//! Products of numbers with bounds on their errors, sums of them, and products of polynomials on
//! the imaginary axis.

use super::polynomial::Polynomial;
use crate::linear::rounded::Rounded;

/// The product with its error; a product with an exact 0 or ±1 has no error of its own.
pub(in crate::linear) fn product(a: Rounded, b: Rounded) -> Rounded {
    let value = a.value * b.value;
    let exact = a.value.abs() == 1.0 || b.value.abs() == 1.0;
    let rounding = if exact { 0.0 } else { f64::EPSILON };
    Rounded {
        value,
        error: rounding * value.abs()
            + a.value.abs() * b.error
            + b.value.abs() * a.error
            + a.error * b.error,
    }
}

/// Σ a b of all pairs; without rounding where only one of the products is not 0.
pub(super) fn sum_of_products(terms: impl Iterator<Item = (Rounded, Rounded)>) -> Rounded {
    let (mut sum, mut size, mut error, mut nonzero) = (0.0, 0.0, 0.0, 0.0);
    for (a, b) in terms {
        let term = product(a, b);
        sum += term.value;
        size += term.value.abs();
        error += term.error;
        nonzero += f64::from(u8::from(term.value != 0.0));
    }
    Rounded {
        value: sum,
        error: error + (nonzero - 1.0_f64).max(0.0) * 0.5 * f64::EPSILON * size,
    }
}

impl Polynomial {
    /// |self(iω)|² as a polynomial in x = ω².
    #[must_use]
    pub(super) fn square(&self) -> Self {
        Self::of(self.degree(), |k| {
            let middle = self.coefficient(k);
            let mut sum = product(middle, middle);
            let (mut size, mut terms) = (sum.value, f64::from(u8::from(sum.value != 0.0)));
            let mut factor = -2.0;
            for i in 1..=k.min(self.degree() - k) {
                let term = product(self.coefficient(k - i), self.coefficient(k + i));
                sum.value += factor * term.value;
                sum.error += 2.0 * term.error;
                size += 2.0 * term.value.abs();
                terms += f64::from(u8::from(term.value != 0.0));
                factor = -factor;
            }
            sum.plus_error((terms - 1.0_f64).max(0.0) * 0.5 * f64::EPSILON * size)
        })
    }

    /// The real part of the product with the conjugate of `other` on the imaginary axis: a
    /// polynomial in x = ω² with Re[self(iω) other(iω)*] as its value.
    #[must_use]
    pub(super) fn real_product(&self, other: &Self) -> Self {
        let degree = usize::midpoint(self.degree(), other.degree());
        Self::of(degree, |k| {
            let from = (2 * k).saturating_sub(other.degree());
            let terms = (from..=(2 * k).min(self.degree())).map(|i| {
                // i^i (−i)^(2k − i) = i^(2i − 2k): real.
                let mut own = self.coefficient(i);
                if (i + k) % 2 == 1 {
                    own.value = -own.value;
                }
                (own, other.coefficient(2 * k - i))
            });
            sum_of_products(terms)
        })
    }

    /// The imaginary part of the product with the conjugate of `other` on the imaginary axis: a
    /// polynomial in x = ω² with Im[self(iω) other(iω)*]/ω as its value.
    #[must_use]
    pub(super) fn imaginary_product(&self, other: &Self) -> Self {
        let Some(degree) = (self.degree() + other.degree()).checked_sub(1) else {
            return Self::ZERO;
        };
        Self::of(degree / 2, |k| {
            let order = 2 * k + 1;
            let from = order.saturating_sub(other.degree());
            let terms = (from..=order.min(self.degree())).map(|i| {
                // i^i (−i)^(2k + 1 − i) = i · i^(2i − 2k − 2).
                let mut own = self.coefficient(i);
                if (i + k) % 2 == 0 {
                    own.value = -own.value;
                }
                (own, other.coefficient(order - i))
            });
            sum_of_products(terms)
        })
    }
}
