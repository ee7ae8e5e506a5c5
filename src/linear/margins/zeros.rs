//! All zeros of a real function of the frequency in an interval.
//!
//! With m and r the middle and half the width of an interval and K ≥ |f″| on it, there is
//!
//! ```text
//! no zero             where |f(m)| > |f′(m)| r + K r²/2,                                   (1)
//! at most one zero    where |f′(m)| > K r.                                                 (2)
//! ```
//!
//! Intervals of which neither holds are halved. No zero is stepped over, however close its
//! neighbours are: a double zero that cannot be told from two is listed once.

/// Intervals that are looked at before a search is given up: some thousand zeros.
const MOST_INTERVALS: usize = 1 << 17;

/// Steps of Newton's method among values that are 0 within their bound on rounding.
const STEPS_WITHIN_ROUNDING: u32 = 3;

/// A value and a bound on its rounding error.
pub(super) type Bounded = (f64, f64);

/// A function f whose zeros are looked for.
pub trait Wave {
    /// f and f′ at `omega` ≥ 0.
    fn at(&self, omega: f64) -> [Bounded; 2];

    /// f alone.
    fn value(&self, omega: f64) -> Bounded;

    /// K ≥ |f″| up to `omega`.
    fn bend(&self, omega: f64) -> f64;

    /// The ω below which zeros are told apart no better than at it.
    fn finest(&self) -> f64 {
        f64::MIN_POSITIVE
    }
}

/// A search would take too long: there are too many zeros.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct TooMany;

/// The room that searches share.
#[derive(Debug, Default)]
pub(super) struct Intervals(Vec<(f64, f64)>);

/// The sign of f, or none where it is lost in rounding.
fn sign(f: &impl Wave, omega: f64) -> Option<bool> {
    let (value, error) = f.value(omega);
    (value.abs() > error).then_some(value > 0.0)
}

/// The zero between `a` and `b`, at which the signs of f differ; f is monotone between.
fn polish(wave: &impl Wave, (mut a, mut b): (f64, f64), rising: bool) -> f64 {
    let (mut omega, mut within_rounding) = (0.5 * (a + b), 0);
    for _ in 0..200 {
        let [(f, error), (first, _)] = wave.at(omega);
        // The bound on the error is generous: some steps more come nearer to the zero.
        if f.abs() <= error {
            within_rounding += 1;
            if within_rounding > STEPS_WITHIN_ROUNDING {
                break;
            }
        } else if (f > 0.0) == rising {
            b = omega;
        } else {
            a = omega;
        }
        let next = omega - f / first;
        let inside = a < next && next < b;
        let next = if inside { next } else { 0.5 * (a + b) };
        if (next - omega).abs() <= f64::EPSILON * omega {
            return next;
        }
        omega = next;
    }
    omega
}

/// The zero next to `omega`, where f is 0 within rounding, at most `r` away.
fn beside(wave: &impl Wave, omega: f64, r: f64) -> f64 {
    let mut at = omega;
    for _ in 0..STEPS_WITHIN_ROUNDING {
        let [(f, _), (first, _)] = wave.at(at);
        let next = at - f / first;
        if next.is_nan() || (next - omega).abs() > r {
            break;
        }
        at = next;
    }
    at
}

impl Intervals {
    /// Tells `found` all zeros of `f` with `from` ≤ ω ≤ `to`, in no order; one at a place where
    /// two intervals meet may come twice.
    ///
    /// # Errors
    /// When there are too many.
    pub(super) fn zeros(
        &mut self,
        f: &impl Wave,
        (from, to): (f64, f64),
        mut found: impl FnMut(f64),
    ) -> Result<(), TooMany> {
        self.0.clear();
        self.0.push((from, to));
        let mut looked_at = 0;
        while let Some((a, b)) = self.0.pop() {
            looked_at += 1;
            if looked_at > MOST_INTERVALS {
                return Err(TooMany);
            }
            let (m, r) = (0.5 * (a + b), 0.5 * (b - a));
            let [(value, error), (slope, slope_error)] = f.at(m);
            let bend = f.bend(b) * r;
            if value.abs() - error > (slope.abs() + slope_error + 0.5 * bend) * r {
                continue;
            }
            if slope.abs() - slope_error > bend {
                match (sign(f, a), sign(f, b)) {
                    (Some(low), Some(high)) if low == high => {}
                    (Some(_), Some(high)) => found(polish(f, (a, b), high)),
                    (None, _) => found(beside(f, a, r)),
                    (_, None) => found(beside(f, b, r)),
                }
                continue;
            }
            if r <= 4.0 * f64::EPSILON * b.max(f.finest()) {
                found(m);
                continue;
            }
            self.0.push((m, b));
            self.0.push((a, m));
        }
        Ok(())
    }
}
