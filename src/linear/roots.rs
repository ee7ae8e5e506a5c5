//! Bisection, to find where scalar conditions change, and golden sections, to find where a function
//! is smallest. Every use evaluates a function a few dozen times in all, and neither can fail.

/// The root of `f` in [`lo`, `hi`], where f(lo) and f(hi) differ in sign, to the last bit that
/// bisection resolves.
pub(crate) fn bisect(lo: f64, hi: f64, f: impl Fn(f64) -> f64) -> f64 {
    let sign_lo = f(lo) > 0.0;
    let (lo, hi) = narrowed(lo, hi, |_, _| false, |x| (f(x) > 0.0) == sign_lo);
    0.5 * (lo + hi)
}

/// Encloses a change of the condition `like_from`, which holds at `from` and not at `to`. Returns
/// two numbers around it that are near `enough`, or have none in between.
pub(crate) fn narrowed(
    mut from: f64,
    mut to: f64,
    mut enough: impl FnMut(f64, f64) -> bool,
    like_from: impl Fn(f64) -> bool,
) -> (f64, f64) {
    loop {
        let middle = 0.5 * (from + to);
        if enough(from, to) || middle <= from.min(to) || middle >= from.max(to) {
            return (from, to);
        }
        if like_from(middle) {
            from = middle;
        } else {
            to = middle;
        }
    }
}

/// A local minimum of `f` in [`low`, `high`] after so many golden sections: where it is, and the
/// value there.
pub(crate) fn golden_section(
    (mut low, mut high): (f64, f64),
    sections: u32,
    f: impl FnMut(f64) -> f64,
) -> (f64, f64) {
    let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
    let mut f = f;
    let mut at = |x: f64| (x, f(x));
    let mut left = at(high - golden * (high - low));
    let mut right = at(low + golden * (high - low));
    for _ in 0..sections {
        if left.1 <= right.1 {
            high = low + golden * (high - low);
            right = left;
            left = at(high - golden * (high - low));
        } else {
            low = high - golden * (high - low);
            left = right;
            right = at(low + golden * (high - low));
        }
    }
    if left.1 <= right.1 { left } else { right }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn golden_sections_come_to_a_minimum() {
        let (at, value) = golden_section((-1.0, 4.0), 60, |x| (x - 0.3).abs() - 2.0);
        assert!(
            (at - 0.3).abs() < 1e-11 && (value + 2.0).abs() < 1e-11,
            "{at} {value}"
        );
        // The function falls to the end of the range.
        let (at, _) = golden_section((0.0, 1.0), 40, |x| -x);
        assert!((at - 1.0).abs() < 1e-8, "{at}");
    }
}
