//! Products of numbers with bounds on their errors, and sums of them.

use crate::linear::rounded::Rounded;

/// The product with its error; that with an exact 0 or ±1 has none of its own.
pub(super) fn product(a: Rounded, b: Rounded) -> Rounded {
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

/// Σ a b; without rounding where only one of the products is not 0.
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
