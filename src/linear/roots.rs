//! A bracketing root finder for the scalar conditions of this module.

/// The root of `f` in [`lo`, `hi`], where f(lo) and f(hi) differ in sign, to the last bit that
/// bisection resolves.
///
/// Bisection: every use here evaluates a smooth closed form a few dozen times in all, and this
/// cannot fail.
pub(super) fn bisect(mut lo: f64, mut hi: f64, f: impl Fn(f64) -> f64) -> f64 {
    let sign_lo = f(lo) > 0.0;
    loop {
        let mid = 0.5 * (lo + hi);
        if mid <= lo.min(hi) || mid >= lo.max(hi) {
            return mid;
        }
        if (f(mid) > 0.0) == sign_lo {
            lo = mid;
        } else {
            hi = mid;
        }
    }
}
