//! Of the values of a parameter at which a root lies on the line Re λ = −σ, the nearest at which
//! stability is lost.

/// A limit is known to this relative precision, or not known.
const SURE: f64 = 1e-9;

/// One side of a setting.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Side {
    Below,
    Above,
}

impl Side {
    fn sign(self) -> f64 {
        match self {
            Self::Above => 1.0,
            Self::Below => -1.0,
        }
    }
}

/// Where stability is looked for along a parameter.
pub(super) struct Search<'a, S> {
    /// Values at which a root lies on the line.
    pub changes: &'a [f64],
    /// The setting's own value, at which it is stable.
    pub from: f64,
    /// Whether a value is stable; none where a root is on the line within rounding.
    pub stable: S,
    /// Whether the values are right wherever `stable` does not contradict them.
    pub sure: bool,
}

impl<S: Fn(f64) -> Option<bool>> Search<'_, S> {
    /// The nearest change on one side beyond which a setting is not stable, NaN where it is not
    /// known to [`SURE`]. All changes up to `last` are among them.
    pub(super) fn nearest(&self, side: Side, last: f64) -> Option<f64> {
        let sign = side.sign();
        let mut at = self.from;
        loop {
            let farther = |than: f64| {
                let ahead = self.changes.iter().copied();
                let ahead = ahead.filter(|c| sign * (c - than) > 0.0);
                ahead.min_by(|a, b| (sign * a).total_cmp(&(sign * b)))
            };
            let next = farther(at)?;
            let end = farther(next).unwrap_or(last);
            let beyond = if end.is_finite() {
                0.5 * (next + end)
            } else {
                next + sign * (1.0 + next.abs())
            };
            if (self.stable)(beyond) != Some(true) {
                return Some(self.settled(next, at, beyond));
            }
            at = next;
        }
    }

    /// The change near `next`, between `inner`, where a setting is stable, and `beyond`, where it
    /// is not: the count has to say so on either side.
    fn settled(&self, next: f64, inner: f64, beyond: f64) -> f64 {
        let sign = (beyond - inner).signum();
        let step = 0.5 * SURE * next.abs().max((next - self.from).abs());
        let before = |at: f64, by: f64| {
            let value = at - sign * by;
            let passed = sign * (value - inner) <= 0.0;
            (
                value,
                if passed {
                    Some(true)
                } else {
                    (self.stable)(value)
                },
            )
        };
        let after = |at: f64, by: f64| {
            let value = at + sign * by;
            let passed = sign * (value - beyond) >= 0.0;
            (
                value,
                if passed {
                    Some(false)
                } else {
                    (self.stable)(value)
                },
            )
        };
        let holds = |at: f64| match (before(at, step).1, after(at, step).1) {
            (Some(true), Some(false)) => true,
            (Some(false), _) | (_, Some(true)) => false,
            _ => self.sure,
        };
        if holds(next) {
            return next;
        }
        // Rounding has moved it: it is looked for by the count.
        let mut by = step;
        while before(next, by).1 != Some(true) {
            by *= 4.0;
        }
        let mut good = before(next, by).0;
        if sign * (good - inner) < 0.0 {
            good = inner;
        }
        by = step;
        while after(next, by).1 != Some(false) {
            by *= 4.0;
        }
        let mut bad = after(next, by).0;
        if sign * (bad - beyond) > 0.0 {
            bad = beyond;
        }
        let bad = self.bisected(good, bad, 0.25 * step);
        if holds(bad) { bad } else { f64::NAN }
    }

    /// The end of what is known to be stable, to `width`, between a value that is and one that is
    /// not.
    fn bisected(&self, mut good: f64, mut bad: f64, width: f64) -> f64 {
        while (bad - good).abs() > width {
            let middle = 0.5 * (good + bad);
            if middle == good || middle == bad {
                break;
            }
            match (self.stable)(middle) {
                Some(true) => good = middle,
                _ => bad = middle,
            }
        }
        bad
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn nearest(changes: &[f64], limit: f64, doubt: f64, sure: bool) -> Option<f64> {
        let stable = |x: f64| ((x - limit).abs() > doubt).then_some(x < limit);
        let from = 1.0;
        let search = Search {
            changes,
            from,
            stable,
            sure,
        };
        search.nearest(Side::Above, f64::INFINITY)
    }

    #[test]
    fn a_change_that_rounding_moved_is_found_by_the_count() {
        // As it is.
        assert_eq!(nearest(&[2.0, 5.0], 2.0, 0.0, false), Some(2.0));
        // At 1.5 roots only touch the line.
        assert_eq!(nearest(&[1.5, 2.0], 2.0, 0.0, false), Some(2.0));
        for off in [-4e-7, 4e-7] {
            let found = nearest(&[2.0 + off], 2.0, 0.0, false).unwrap();
            assert!((found - 2.0).abs() < 2e-9, "{off}: {found}");
            // Nearer to the start than it is off.
            let near = 1.0 + 1e-7;
            let found = nearest(&[near + off.abs()], near, 0.0, false).unwrap();
            assert!((found - near).abs() < 2e-9, "{off}: {found}");
        }
    }

    #[test]
    fn a_change_in_doubt_is_not_known() {
        assert!(nearest(&[2.0], 2.0, 1e-6, false).unwrap().is_nan());
        assert_eq!(nearest(&[2.0], 2.0, 1e-6, true), Some(2.0));
        assert_eq!(nearest(&[2.0], 2.0, 1e-10, false), Some(2.0));
    }
}
