//! The fixed point that iterates of the return map converge to, estimated from the event functions
//! of the last three periods.

use super::event_functions::EventFunctions;
use super::options::ContinuationOptions;

/// The event functions of the last three periods, the oldest first.
#[derive(Debug, Clone, Copy)]
pub(super) struct Iterates([EventFunctions; 3]);

impl Iterates {
    /// The iterates before the first period.
    pub(super) const NONE: Self = Self([EventFunctions::UNKNOWN; 3]);

    /// Whether no period was added yet.
    pub(super) fn none_yet(&self) -> bool {
        self.0[2].load.is_nan()
    }

    /// Adds the event functions of one more period.
    pub(super) fn push(&mut self, events: EventFunctions) {
        self.0 = [self.0[1], self.0[2], events];
    }

    /// Whether there are three periods, and they repeat to `settled`, relative, at `v0`.
    pub(super) fn settled(&self, settled: f64, v0: f64, options: &ContinuationOptions) -> bool {
        let [first, second, third] = self.0.map(|events| events.each());
        let mut all = first.iter().zip(&second).zip(&third);
        !self.0[0].load.is_nan()
            && all.all(|((first, second), third)| {
                let noise = EventFunctions::noise(first.0, options.noise, v0);
                at_rest([first.1, second.1, third.1], settled, noise, options)
            })
    }

    /// The limits to which the event functions converge.
    pub(super) fn limits(&self, options: &ContinuationOptions) -> EventFunctions {
        let [first, second, third] = &self.0;
        let before = second.with(first, |second, first| second - first);
        let last = third.with(second, |third, second| third - second);
        let correction = last.with(&before, |last, before| correction(last, before, options));
        third.with(&correction, |third, correction| third + correction)
    }
}

/// Whether a number has come to rest in three periods. The last two have to differ by no more than
/// `settled`, relative, and by less than the first two, since the orbit may be unstable otherwise.
/// The latter is not required where a rough orbit is enough. Differences of at most `noise`, and
/// numbers that a period does not have, count as at rest.
fn at_rest(
    [first, second, third]: [f64; 3],
    settled: f64,
    noise: f64,
    options: &ContinuationOptions,
) -> bool {
    let (before, last) = ((second - first).abs(), (third - second).abs());
    let falls = settled > options.settled
        || last <= options.contraction * before
        || last <= options.noise * third.abs();
    third.is_nan() || last <= noise || last <= settled * third.abs() && falls
}

/// How far the limit of a sequence lies beyond its last member, by its last two differences
/// (Aitken's Δ²): a geometric sequence of ratio q goes on by Δ q/(1 − q).
fn correction(last: f64, before: f64, options: &ContinuationOptions) -> f64 {
    let ratio = last / before;
    if ratio.abs() < options.aitken_ratio {
        last * ratio / (1.0 - ratio)
    } else {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One number that converges, or does not, by `ratio` from one period to the next, about 1.
    fn sequence(ratio: f64, periods: i32) -> Iterates {
        let mut iterates = Iterates::NONE;
        for period in 0..periods {
            iterates.push(EventFunctions {
                load: 1.0 + 1e-3 * ratio.powi(period),
                stick_time: 2.0,
                ..EventFunctions::UNKNOWN
            });
        }
        iterates
    }

    #[test]
    fn three_periods_are_needed() {
        let options = ContinuationOptions::default();
        assert!(Iterates::NONE.none_yet() && !sequence(0.1, 1).none_yet());
        assert!(!sequence(0.1, 2).settled(0.05, 1.0, &options));
        assert!(sequence(0.1, 3).settled(0.05, 1.0, &options));
    }

    #[test]
    fn the_limit_of_a_geometric_sequence_is_exact() {
        let options = ContinuationOptions::default();
        for ratio in [0.6, -0.6, 0.01] {
            let found = sequence(ratio, 3).limits(&options);
            assert!((found.load - 1.0).abs() < 1e-12, "{ratio} {found:?}");
            assert_eq!(found.stick_time, 2.0);
            assert!(found.dip.is_nan());
        }
        // The ratio is too large to extrapolate: the last one as it is.
        assert_eq!(sequence(0.8, 3).limits(&options).load, 1.0 + 1e-3 * 0.64);
    }

    #[test]
    fn an_unstable_fixed_point_is_not_one_to_settle_to() {
        let options = ContinuationOptions::default();
        let settled = |ratio| sequence(ratio, 3).settled(0.01, 1.0, &options);
        assert!(settled(0.7) && settled(-0.7));
        assert!(!settled(0.9) && !settled(-1.1) && !settled(1.3));
        // A rough orbit need not be shown to attract.
        assert!(sequence(1.3, 3).settled(0.2, 1.0, &options));
    }

    #[test]
    fn what_is_noise_does_not_count() {
        let options = ContinuationOptions::default();
        let mut iterates = Iterates::NONE;
        for dip in [1e-9, 3e-9, -2e-9] {
            iterates.push(EventFunctions {
                load: 1.0,
                dip,
                ..EventFunctions::UNKNOWN
            });
        }
        assert!(iterates.settled(0.01, 0.1, &options));
        assert!(!iterates.settled(0.01, 1e-3, &options));
    }
}
