//! Bisection, to find where scalar conditions change. Every use evaluates a smooth closed form a
//! few dozen times in all, and bisection cannot fail.

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
