//! Sine and cosine with all digits of a [`Number`].

use std::f64::consts::FRAC_PI_2;

use super::number::Number;

/// π/2.
const QUARTER: Number = Number::of_parts([
    FRAC_PI_2,
    6.123_233_995_736_766e-17,
    -1.497_384_904_859_169_8e-33,
]);
/// Terms of the power series; the next one is less than 2⁻¹⁶⁰ of the first within π/4.
const TERMS: u32 = 18;
/// Turns beyond which the digits of π/2 are too few.
const MOST_QUARTERS: f64 = 1e6;

/// The sine and the cosine of `angle`; none for extreme angles.
pub(super) fn sine_and_cosine(angle: Number) -> Option<[Number; 2]> {
    let quarters = (angle.value() / FRAC_PI_2).round();
    if quarters.is_nan() || quarters.abs() > MOST_QUARTERS {
        return None;
    }
    let rest = angle - QUARTER.times(quarters);
    let square = -(rest * rest);
    // By Horner's scheme from the smallest term: 1 − x²/(k(k + 1)) (1 − …).
    let series = |first: f64| {
        (0..TERMS).rev().fold(Number::ONE, |sum, term| {
            let k = first + 2.0 * f64::from(term);
            Number::ONE + (square * sum).over(k * (k + 1.0))
        })
    };
    let (sine, cosine) = (rest * series(2.0), series(1.0));
    Some(match (quarters as i64).rem_euclid(4) {
        0 => [sine, cosine],
        1 => [cosine, -sine],
        2 => [-sine, -cosine],
        _ => [-cosine, sine],
    })
}

#[cfg(test)]
mod tests {
    use super::super::number::UNIT;
    use super::*;

    /// The double of an angle, and sums of angles, tell all digits.
    #[test]
    fn angles_add_up() {
        let at = |x: Number| sine_and_cosine(x).unwrap();
        for (a, b) in [
            (0.3, 0.4),
            (-2.7, 1.9),
            (30.0, -7.1),
            (1e-20, 4e3),
            (0.785, 0.785),
        ] {
            let (a, b) = (Number::of(a), Number::of(b));
            let ([s, c], [t, d], [u, e]) = (at(a), at(b), at(a + b));
            let size = 64.0 * UNIT * (1.0 + b.value().abs());
            for left in [
                s * s + c * c - Number::ONE,
                s * d + c * t - u,
                c * d - s * t - e,
            ] {
                assert!(left.value().abs() <= size, "{left:?}");
            }
            for (found, known) in [(s, a.value().sin()), (c, a.value().cos())] {
                assert!((found.value() - known).abs() <= 2.0 * f64::EPSILON, "{a:?}");
            }
        }
        assert!(sine_and_cosine(Number::of(1e9)).is_none());
        assert!(sine_and_cosine(Number::of(f64::NAN)).is_none());
    }

    /// sin 1 and cos 1 to 48 digits, computed with mpmath.
    #[test]
    fn known_digits() {
        let [sine, cosine] = sine_and_cosine(Number::ONE).unwrap();
        for (found, known) in [(sine, SINE), (cosine, COSINE)] {
            let left = found - Number::of_parts(known);
            assert!(left.value().abs() < 1e-45, "{left:?}");
        }
    }

    const SINE: [f64; 3] = [
        0.8414709848078965,
        1.776845092935536e-18,
        -1.4730549161871722e-34,
    ];
    const COSINE: [f64; 3] = [
        0.5403023058681398,
        -4.760954612604417e-17,
        -2.7465847695890946e-33,
    ];
}
