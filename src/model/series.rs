//! Polynomials in the time since the start of a step: Taylor series of a solution, cut off.

/// Highest order of a series.
pub(crate) const MOST_ORDER: usize = 20;

/// Coefficients c₀ … c_N of Σ c_k s^k; those beyond the order in use mean nothing.
pub(crate) type Coefficients = [f64; MOST_ORDER + 1];

/// 1/(k + 1).
pub(crate) const PER_NEXT: Coefficients = {
    let mut inverse = [1.0; MOST_ORDER + 1];
    let mut k = 1;
    while k <= MOST_ORDER {
        inverse[k] = 1.0 / (k + 1) as f64;
        k += 1;
    }
    inverse
};

/// Binomial coefficients: row m, column j hold j + m over j; zero where j + m > [`MOST_ORDER`].
const BINOMIAL: [Coefficients; MOST_ORDER + 1] = {
    let mut rows = [[0.0; MOST_ORDER + 1]; MOST_ORDER + 1];
    rows[0] = [1.0; MOST_ORDER + 1];
    let mut m = 1;
    while m <= MOST_ORDER {
        rows[m][0] = 1.0;
        let mut j = 1;
        while j + m <= MOST_ORDER {
            rows[m][j] = rows[m][j - 1] + rows[m - 1][j];
            j += 1;
        }
        m += 1;
    }
    rows
};

/// Σ f(c_k) s^k, by Horner's scheme for every fourth power: a quarter as long a chain of
/// operations.
#[inline(always)]
fn sum(c: &[f64], s: f64, f: impl Fn(f64) -> f64) -> f64 {
    let square = s * s;
    let fourth = square * square;
    let fours = c.chunks_exact(4);
    let mut sums = [0.0; 4];
    for (sum, c) in sums.iter_mut().zip(fours.remainder()) {
        *sum = f(*c);
    }
    for four in fours.rev() {
        for (sum, c) in sums.iter_mut().zip(four) {
            *sum = *sum * fourth + f(*c);
        }
    }
    (sums[0] + s * sums[1]) + square * (sums[2] + s * sums[3])
}

/// Σ c_k s^k.
#[inline]
#[must_use]
pub(crate) fn value(c: &[f64], s: f64) -> f64 {
    sum(c, s, |c| c)
}

/// Σ |c_k| s^k.
#[inline]
fn size(c: &[f64], s: f64) -> f64 {
    sum(c, s, f64::abs)
}

/// An upper bound of the distance of a polynomial from c₀ on [0, `end`].
#[inline]
#[must_use]
pub(crate) fn spread(c: &[f64], end: f64) -> f64 {
    end * size(&c[1..], end)
}

/// Value and derivative.
#[inline]
fn value_and_slope(c: &[f64], s: f64) -> (f64, f64) {
    let (mut value, mut slope) = (0.0, 0.0);
    for c in c.iter().rev() {
        slope = slope * s + value;
        value = value * s + c;
    }
    (value, slope)
}

/// The coefficients about s = `by` of the polynomial `c`, see [`shift`].
#[inline]
#[must_use]
pub(crate) fn shifted(c: &[f64], by: f64) -> Coefficients {
    let mut about = [0.0; MOST_ORDER + 1];
    shift(c, by, &mut about);
    about
}

/// Writes the coefficients about s = `by` of the polynomial `c` to `about`:
/// Σ_m (j + m over j) c_{j+m} by^m, and zero beyond.
///
/// Horner's scheme takes as many operations, but each waits for the one before.
#[inline]
pub(crate) fn shift(c: &[f64], by: f64, about: &mut Coefficients) {
    let (low, high) = about.split_at_mut(c.len());
    low.copy_from_slice(c);
    high.fill(0.0);
    let mut power = 1.0;
    for (m, row) in BINOMIAL.iter().enumerate().take(c.len()).skip(1) {
        power *= by;
        let terms = row.iter().zip(&c[m..]);
        for (sum, (binomial, c)) in low.iter_mut().zip(terms) {
            *sum += power * (binomial * c);
        }
    }
}

/// Coefficient k of the product of `p` and `q`. The sum runs from the middle to both ends, so that
/// the coefficients found last are needed last.
#[inline(always)]
#[must_use]
pub(crate) fn product(p: &Coefficients, q: &Coefficients, k: usize) -> f64 {
    let k = k.min(MOST_ORDER);
    let middle = k / 2;
    let (mut low, mut high) = (0.0, 0.0);
    for i in 0..=middle {
        low += p[middle - i] * q[k - middle + i];
    }
    for i in middle + 1..=k {
        high += p[i] * q[k - i];
    }
    low + high
}

/// The coefficients of the derivative of `c`, times `factor`.
#[must_use]
pub(crate) fn derivative(c: &[f64], factor: f64) -> Coefficients {
    let mut slope = [0.0; MOST_ORDER + 1];
    for (k, (slope, c)) in slope.iter_mut().zip(&c[1..]).enumerate() {
        *slope = factor * (k + 1) as f64 * c;
    }
    slope
}

/// The first zero in (0, `end`] of a polynomial that is positive just after 0; none if it stays
/// positive.
///
/// No zero is stepped over: a parabola below the polynomial bounds how far it stays positive. Near
/// a simple zero the steps are Newton's; a minimum within rounding of zero counts as one. Zeros at
/// s = 0 itself are divided out.
#[must_use]
pub(crate) fn first_zero(c: &[f64], end: f64) -> Option<f64> {
    let multiplicity = c.iter().position(|&c| c != 0.0)?;
    let c = &c[multiplicity..];
    // The rest of the series cannot outweigh its first term.
    if c[0] > 0.0 && c[0] > spread(c, end) {
        return None;
    }
    let (mut bend, mut rounding) = (0.0, c[0].abs());
    let mut power = 1.0;
    for (k, c) in c.iter().enumerate().skip(1) {
        let k = k as f64;
        let before = c.abs() * power;
        power *= end;
        bend += k * (k - 1.0) * before;
        rounding += (1.0 + k) * c.abs() * power;
    }
    bend /= end;
    if !bend.is_finite() {
        return None;
    }
    rounding *= 4.0 * f64::EPSILON;
    let mut s = 0.0;
    loop {
        let (value, slope) = value_and_slope(c, s);
        if value <= rounding {
            // One more step of Newton's method, where there is a slope to follow.
            let correction = value / slope;
            let polished = if slope < 0.0 && correction.abs() < 1e-6 * end {
                s - correction
            } else {
                s
            };
            return Some(polished.clamp(0.0, end));
        }
        // The first zero of value + slope δ − bend δ²/2, without cancellation.
        let root = (slope * slope + 2.0 * bend * value).sqrt();
        let step = if slope < 0.0 {
            2.0 * value / (root - slope)
        } else if bend > 0.0 {
            (slope + root) / bend
        } else {
            f64::INFINITY
        };
        s += step.max(f64::EPSILON * end);
        // Also for NaN.
        if !s.is_finite() || s > end {
            return None;
        }
    }
}

/// The largest value on [0, `end`], or `known` if that is larger.
///
/// Extrema are looked for in eighths of the range; a step of an integrator holds one at most.
#[must_use]
pub(crate) fn largest(c: &[f64], end: f64, known: f64) -> f64 {
    let Some((first, rest)) = c.split_first() else {
        return known;
    };
    if first + spread(c, end) <= known {
        return known;
    }
    let mut found = known.max(*first).max(value(c, end));
    let slopes = derivative(c, 1.0);
    let slopes = &slopes[..rest.len()];
    // Where the slope cannot change its sign, the largest value is at an end.
    let alone = |c: &[f64]| c.len() < 2 || c[0].abs() >= spread(c, end);
    if alone(slopes) {
        return found;
    }
    let bends = derivative(slopes, 1.0);
    let bends = &bends[..slopes.len() - 1];
    // Where the slope is monotone, its signs at the ends show whether there is a maximum.
    let parts = if alone(bends) { 1 } else { 8 };
    let at = |i: u32| end * f64::from(i) / f64::from(parts);
    let mut from = slopes[0];
    for i in 0..parts {
        let to = value(slopes, at(i + 1));
        if from > 0.0 && to <= 0.0 {
            found = found.max(value(c, top(slopes, bends, (at(i), at(i + 1)))));
        }
        from = to;
    }
    found
}

/// Where the slope changes its sign, by Newton's method kept between `from`, where it is positive,
/// and `to`.
fn top(slopes: &[f64], bends: &[f64], (mut from, mut to): (f64, f64)) -> f64 {
    let near = 1e-9 * (to - from);
    let mut s = 0.5 * (from + to);
    // A maximum is flat: half the digits of its place give all digits of its value.
    for _ in 0..30 {
        let slope = value(slopes, s);
        match slope > 0.0 {
            true => from = s,
            false => to = s,
        }
        let newton = s - slope / value(bends, s);
        let next = match newton > from && newton < to {
            true => newton,
            false => 0.5 * (from + to),
        };
        if (next - s).abs() <= near {
            return next;
        }
        s = next;
    }
    s
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn grazes_are_told_apart() {
        // (s − 1)² ± 1e-9.
        assert_eq!(first_zero(&[1.0 + 1e-9, -2.0, 1.0], 3.0), None);
        let zero = first_zero(&[1.0 - 1e-9, -2.0, 1.0], 3.0).expect("crosses twice");
        assert!((zero - (1.0 - 1e-9_f64.sqrt())).abs() < 1e-10, "{zero}");
        let touch = first_zero(&[1.0, -2.0, 1.0], 3.0).expect("touches");
        assert!((touch - 1.0).abs() < 1e-6);
    }

    #[test]
    fn a_zero_at_the_start_is_divided_out() {
        // s (1 − s)(2 − s).
        let zero = first_zero(&[0.0, 2.0, -3.0, 1.0], 5.0).expect("at one");
        assert!((zero - 1.0).abs() < 1e-15);
        assert_eq!(first_zero(&[0.0, 0.0, 1.0], 5.0), None);
        assert_eq!(first_zero(&[1.0], f64::INFINITY), None);
    }

    #[test]
    fn the_largest_value_may_stand_where_it_is_looked_for() {
        // s (1 − s), largest at the fourth eighth.
        assert!((largest(&[0.0, 1.0, -1.0], 1.0, 0.0) - 0.25).abs() < 1e-15);
    }

    proptest! {
        /// The first zero of a polynomial made from its zeros is found.
        #[test]
        fn the_first_zero_is_found(
            zeros in prop::collection::vec(0.05..3.0_f64, 1..7),
            end in 0.5..2.0_f64,
        ) {
            let mut c = vec![1.0];
            for zero in &zeros {
                let mut next = vec![0.0; c.len() + 1];
                for (k, c) in c.iter().enumerate() {
                    next[k] += c;
                    next[k + 1] -= c / zero;
                }
                c = next;
            }
            let first = zeros.iter().copied().fold(f64::INFINITY, f64::min);
            match first_zero(&c, end) {
                Some(s) => prop_assert!(
                    (s - first).abs() < 1e-3 && value(&c, s).abs() < 1e-11,
                    "{s} {first}"
                ),
                None => prop_assert!(first > end - 1e-3),
            }
        }

        #[test]
        fn products_are_those_of_the_polynomials(
            p in prop::collection::vec(-1.0..1.0_f64, 9),
            q in prop::collection::vec(-1.0..1.0_f64, 9),
            s in -0.5..0.5_f64,
        ) {
            let (mut long_p, mut long_q) = ([0.0; MOST_ORDER + 1], [0.0; MOST_ORDER + 1]);
            long_p[..9].copy_from_slice(&p);
            long_q[..9].copy_from_slice(&q);
            let c: Vec<_> = (0..17).map(|k| product(&long_p, &long_q, k)).collect();
            prop_assert!((value(&c, s) - value(&p, s) * value(&q, s)).abs() < 1e-13);
        }

        #[test]
        fn shifting_changes_nothing(
            c in prop::collection::vec(-1.0..1.0_f64, 1..20),
            by in -0.5..0.5_f64,
            s in -0.5..0.5_f64,
        ) {
            prop_assert!((value(&shifted(&c, by), s) - value(&c, s + by)).abs() < 1e-12);
        }
    }
}
