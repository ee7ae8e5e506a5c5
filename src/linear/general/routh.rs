//! Zeros right of the imaginary axis by Routh's array, where none is near to it.

use super::polynomial::{MOST_DEGREE, Polynomial};
use crate::linear::rounded::Rounded;

const COLUMNS: usize = MOST_DEGREE / 2 + 2;
const NOTHING: Rounded = Rounded {
    value: 0.0,
    error: 0.0,
};

/// The number of zeros of `p` with a positive real part, the others having a negative one; none
/// where rounding leaves that open. The highest coefficient is certain to differ from 0.
pub(super) fn zeros_on_the_right(p: &Polynomial) -> Option<usize> {
    let n = p.degree();
    let (mut one, mut other) = ([NOTHING; COLUMNS], [NOTHING; COLUMNS]);
    let (mut upper, mut lower) = (&mut one, &mut other);
    for k in 0..=n {
        let row = if k % 2 == 0 { &mut *upper } else { &mut *lower };
        row[k / 2] = p.coefficient(n - k);
    }
    let mut changes = 0;
    for length in (1..=n).rev() {
        let (a, b) = (upper[0], lower[0]);
        if !b.decided() {
            return None;
        }
        changes += usize::from((a.value > 0.0) != (b.value > 0.0));
        let per_b = 1.0 / b.value;
        let ratio = a.value * per_b;
        // What is left of b after its error.
        let least = b.value.abs() - b.error;
        let ratio_error =
            (a.error + ratio.abs() * b.error) / least + 2.0 * f64::EPSILON * ratio.abs();
        for j in 0..length.div_ceil(2) {
            let (a, b) = (upper[j + 1], lower[j + 1]);
            let part = ratio * b.value;
            let value = a.value - part;
            let error = a.error
                + ratio_error * (b.value.abs() + b.error)
                + ratio.abs() * b.error
                + f64::EPSILON * (part.abs() + value.abs());
            upper[j] = Rounded { value, error };
        }
        upper[length.div_ceil(2)] = NOTHING;
        std::mem::swap(&mut upper, &mut lower);
    }
    Some(changes)
}
