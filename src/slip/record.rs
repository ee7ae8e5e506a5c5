//! The recursion of readings, reconstructed from a record near sliding.
//!
//! The block begins in sliding and is disturbed by small known pulses of the load, drawn with the
//! seed of its readings: without them nothing would tell what a load does. Where sliding is not
//! stable the block soon leaves the vicinity in which it is linear, and the record ends there, or
//! at the first stop. Its readings are fitted by least squares to
//!
//! ```text
//! a_{k+1} = t₁ a_k + t₂ a_{k−1} + g₁ δN_k + g₂ δN_{k−1} + const
//! ```

use super::motion::{Accuracy, Event, Motion, Parameters};
use super::return_map::Steering;
use crate::model::least_squares::LeastSquares;
use crate::model::{Record, Recursion};

/// The vicinity: a reading is within this share of v0 √(M/κ) of the first one, that of sliding. The
/// block stops where it swings by v0 √(M/κ).
const VICINITY: f64 = 0.2;
/// So many readings are kept beyond it: with fewer a little noise is much.
const KEPT: usize = 9;
/// What is left of 1 − t₁ − t₂ has to be more than this for a* to be told.
const LEAST_LEFT: f64 = 1e-6;
/// What is drawn for a record is drawn for no motion.
const OF_RECORDS: u64 = 0x7265_636f_7264;

/// Why a record tells no recursion.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum NoRecursion {
    /// The block stopped, or lifted off, before there were enough readings.
    #[error(
        "the block stopped after {0} readings of the record, and the fit needs {least}: a smaller \
         pulse or a shorter sample_time keeps it sliding for longer",
        least = Record::LEAST
    )]
    Stopped(usize),
    /// The fit is singular.
    #[error(
        "the readings of the record do not tell the five numbers of the return map: a larger \
         pulse, a longer record or a finer resolution does"
    )]
    Singular,
}

/// A reading with the change of the load that was set at it.
type Read = [f64; 2];

/// The recursion that a record of a block with these parameters tells.
pub(super) fn reconstructed(
    p: &Parameters,
    accuracy: Accuracy,
    record: Record,
) -> Result<Recursion, NoRecursion> {
    let read = read(p, accuracy, record);
    if read.len() < Record::LEAST as usize {
        return Err(NoRecursion::Stopped(read.len()));
    }
    let recursion = fitted(&read).ok_or(NoRecursion::Singular)?;
    Steering::of(recursion)
        .map(|steering| steering.of)
        .ok_or(NoRecursion::Singular)
}

/// The readings of a record, to where it leaves the vicinity, or stops.
fn read(p: &Parameters, accuracy: Accuracy, record: Record) -> Vec<Read> {
    let mut p = p.clone();
    p.switch_on = 0.0;
    p.feedback.readings.seed ^= OF_RECORDS;
    let horizon = f64::from(record.readings) * p.feedback.readings.sample_time;
    let (v0, rest) = (p.v0, super::return_map::of_law(&p, p.v0, 1.0).rest);
    let mut motion = Motion::new(p, accuracy, v0, rest);
    let mut read = Vec::new();
    while read.len() < record.readings as usize && !motion.is_lost() {
        let last = motion.reads();
        let event = motion.advance(2.0 * horizon);
        if motion.reads() != last {
            read.extend(motion.last_reading());
            let far = |[y, _]: &Read| (y - read[0][0]).abs() > VICINITY * v0;
            if read.len() > KEPT && read.last().is_some_and(far) {
                read.pop();
                break;
            }
        }
        let ends = [Event::Stick, Event::Reversal, Event::LiftOff];
        if event.is_some_and(|event| ends.contains(&event)) {
            break;
        }
    }
    read
}

/// The recursion of least squares; none where a column of it follows from others.
fn fitted(read: &[Read]) -> Option<Recursion> {
    let n = read.len() as f64;
    let mean = read.iter().map(|[y, _]| y).sum::<f64>() / n;
    let column = |of: fn(&[Read], f64) -> f64| -> Vec<f64> {
        let windows = read.windows(3);
        windows.map(|window| of(window, mean)).collect()
    };
    let columns = [
        column(|_, _| 1.0),
        column(|of, mean| of[1][0] - mean),
        column(|of, mean| of[0][0] - mean),
        column(|of, _| of[1][1]),
        column(|of, _| of[0][1]),
    ];
    let numbers = LeastSquares::of(columns)?.solve(&column(|of, mean| of[2][0] - mean));
    let [constant, t1, t2, g1, g2] = numbers.try_into().ok()?;
    let fall = 1.0 - t1 - t2;
    let found = Recursion {
        readings: [t1, t2],
        loads: [g1, g2],
        rest: mean + constant / fall,
    };
    (fall.abs() > LEAST_LEFT && found.rest.is_finite()).then_some(found)
}

#[cfg(test)]
mod tests {
    use super::super::return_map::of_law;
    use super::*;
    use crate::model::{Dashpots, Feedback, FrictionLaw, MapModel, Readings, ReturnMap};

    fn parameters(law: FrictionLaw, record: Record, noise: f64) -> Parameters {
        let mut feedback = Feedback::new(0.0, 1.0, 1.8);
        feedback.readings = Readings {
            sample_time: 0.9,
            noise,
            seed: 3,
            ..Readings::default()
        };
        feedback.return_map = Some(ReturnMap {
            amplitude: 0.5,
            model: MapModel::Reconstructed(record),
        });
        Parameters {
            law,
            velocity_unit: 1.0,
            dashpots: Dashpots {
                damping: 0.05,
                viscous: 0.1,
            },
            feedback,
            v0: 0.3,
            switch_on: 0.0,
        }
    }

    fn off(one: &Recursion, other: &Recursion) -> f64 {
        let numbers = |of: &Recursion| {
            let ([t1, t2], [g1, g2]) = (of.readings, of.loads);
            [t1, t2, g1, g2, of.rest]
        };
        let pairs = numbers(one).into_iter().zip(numbers(other));
        pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    }

    /// A block in slip under Coulomb friction is linear: a record of any length, from the shortest
    /// on, tells the numbers of the law.
    #[test]
    fn a_linear_record_tells_the_numbers_of_the_law() {
        for readings in [Record::LEAST, 12, 60] {
            let record = Record {
                readings,
                pulse: 0.01,
            };
            let p = parameters(FrictionLaw::coulomb(0.4, 1.0).unwrap(), record, 0.0);
            let found = reconstructed(&p, Accuracy::default(), record).unwrap();
            let expected = of_law(&p, p.v0, 1.0);
            assert!(
                off(&found, &expected) < 1e-7,
                "{readings}: {found:?} {expected:?}"
            );
        }
    }

    /// Of friction that weakens a record of any length ends where it is no longer linear, so
    /// its map is right to some digits.
    #[test]
    fn a_record_ends_in_the_vicinity() {
        let law = FrictionLaw::weakening(0.5, 0.5, 1.0).unwrap();
        for (sample_time, v0) in [(0.9, 0.1), (0.5, 0.1)] {
            let made = |readings: u32, seed: u64| {
                let record = Record {
                    readings,
                    pulse: 0.01,
                };
                let mut p = parameters(law.clone(), record, 0.0);
                p.dashpots = Dashpots::default();
                p.v0 = v0;
                p.feedback.readings.sample_time = sample_time;
                p.feedback.readings.seed = seed;
                let read = read(&p, Accuracy::default(), record);
                let expected = of_law(&p, v0, 1.0);
                (read.clone(), off(&fitted(&read).unwrap(), &expected))
            };
            for seed in 0..20 {
                let ((short, error), (long, same)) = (made(20, seed), made(1000, seed));
                assert!(error < 0.1, "{sample_time} {v0} {seed}: {error}");
                let all = long.iter().enumerate();
                for (place, [y, _]) in all.filter(|(place, _)| *place >= KEPT) {
                    assert!((y - long[0][0]).abs() <= VICINITY * v0, "{place}");
                }
                assert!(long.len() < 40 && long.starts_with(&short));
                if short.len() < 20 {
                    assert_eq!((short.len(), error), (long.len(), same));
                }
            }
        }
    }

    /// Of friction that weakens smaller pulses tell more, and noise tells less.
    #[test]
    fn pulses_and_noise_limit_what_a_record_tells() {
        let law = FrictionLaw::weakening(0.5, 0.5, 1.0).unwrap();
        let error = |pulse: f64, noise: f64| {
            let record = Record {
                readings: 12,
                pulse,
            };
            let p = parameters(law.clone(), record, noise);
            let found = reconstructed(&p, Accuracy::default(), record).unwrap();
            off(&found, &of_law(&p, p.v0, 1.0))
        };
        let [large, small] = [error(0.02, 0.0), error(0.002, 0.0)];
        assert!(small < 0.2 * large && small > 1e-6, "{large} {small}");
        assert!(error(0.002, 1e-4) > 10.0 * small);
    }

    #[test]
    fn what_tells_too_little_is_refused() {
        let law = FrictionLaw::weakening(0.5, 0.5, 1.0).unwrap();
        let record = Record {
            readings: 20,
            pulse: 0.3,
        };
        let mut p = parameters(law, record, 0.0);
        p.v0 = 0.02;
        let refused = reconstructed(&p, Accuracy::default(), record).unwrap_err();
        assert!(matches!(refused, NoRecursion::Stopped(1..7)), "{refused:?}");
        let mut p = parameters(FrictionLaw::coulomb(0.4, 1.0).unwrap(), record, 0.0);
        p.feedback.readings.resolution = 10.0;
        let refused = reconstructed(&p, Accuracy::default(), record);
        assert_eq!(refused.unwrap_err(), NoRecursion::Singular);
    }
}
