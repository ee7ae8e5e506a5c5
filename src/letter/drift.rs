//! Return maps that were reconstructed once, while v0 falls and the slope of friction with it.

use super::LetterError;
use super::claim::{Claim, ClaimValue, Verdict};
use super::return_map::{PLACE, case_of, question};
use super::routes::{AMPLITUDES, DELAYED, MAP, ROUTE, SAMPLE_TIME, lowest_of, routes};
use super::workshop::Workshop;
use crate::explore::comparison::Question;
use crate::model::{MapModel, Record};
use crate::slip::case::{Case, Start};

/// Records of which return maps are reconstructed, in a quick run and otherwise.
const RECORDS: [u32; 2] = [8, 32];
/// A map is made anew at a v0 above that at which the last one loses sliding by this factor.
const EARLIER: f64 = 1.05;
/// The most maps that are made.
const MOST_MAPS: usize = 30;

/// The same block from sliding at `v0`, as far from it as the file says; v0 falls at the same rate.
fn from(case: &Case, v0: f64) -> Case {
    let mut other = case.clone();
    let [first, end] = [case.v0, case.last_v0()];
    other.v0 = v0;
    if let Start::State { x_dot0, .. } = case.start {
        let a0 = other.sliding_elongation();
        let x_dot0 = x_dot0 / first * v0;
        other.start = Start::State { x_dot0, a0 };
    }
    for corner in &mut other.programme.0 {
        corner.at *= (v0 - end) / (first - end);
    }
    other
}

/// What becomes of sliding under maps that were reconstructed once, by amplitude.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Drift {
    /// v0 at first and in the end.
    v0: [f64; 2],
    /// The lowest v0 under an exact map and under delayed feedback.
    exact: [f64; 2],
    delayed: [f64; 2],
    /// The v0 at which each reconstructed map loses sliding.
    lost: [Vec<f64>; 2],
    /// How many maps hold sliding to the end, if one is made anew before the last one loses it.
    made: [Option<usize>; 2],
}

impl Drift {
    pub(super) fn found(shop: &Workshop) -> Result<Self, LetterError> {
        let case = case_of(ROUTE)?;
        let exact = question(case.clone(), &AMPLITUDES, &[SAMPLE_TIME]);
        let reconstructed = reconstructed();
        let records = 0..RECORDS[usize::from(!shop.quick)];
        let once = records.map(|seed| Question {
            seed,
            model: reconstructed,
            ..exact.clone()
        });
        let asked: Vec<_> = std::iter::once(exact.clone()).chain(once).collect();
        let found = routes(shop, &asked)?;
        let (exact, once) = (&found[0], &found[1..]);
        let both = |method| AMPLITUDES.map(|amplitude| lowest_of(exact, method, amplitude));
        let lost = |amplitude| {
            once.iter()
                .map(|of| lowest_of(of, MAP, amplitude))
                .collect()
        };
        let mut made = [None; 2];
        for (made, amplitude) in made.iter_mut().zip(AMPLITUDES) {
            *made = maps_made(shop, &case, amplitude)?;
        }
        Ok(Self {
            v0: [case.v0, case.last_v0()],
            exact: both(MAP),
            delayed: both(DELAYED),
            lost: AMPLITUDES.map(lost),
            made,
        })
    }

    fn verdict(&self) -> Verdict {
        let end = self.v0[1];
        let hold = [self.exact, self.delayed]
            .concat()
            .iter()
            .all(|v0| *v0 == end);
        let all: Vec<_> = self.lost.concat();
        let drift = all.iter().filter(|v0| **v0 > end).count();
        let anew = self.made.iter().all(Option::is_some);
        Verdict::of_parts(
            hold && anew && drift == all.len() && drift > 0,
            hold && 2 * drift > all.len(),
        )
    }

    pub(super) fn claim(&self) -> Claim {
        let [first, end] = self.v0;
        let lost = [0, 1].map(|i| mean(&self.lost[i]).0);
        let made = self
            .made
            .map(|made| made.map_or_else(|| "no number of".to_owned(), |made| made.to_string()));
        let because = format!(
            "A map that is reconstructed once, at v0 = {first}, loses sliding at v0 = {:.4} where \
             the load may change by {} N0, and at {:.4} where it may by {} N0. With a map made \
             anew each time before sliding is lost it is held to {end}, by {} and {} maps. An \
             exact map of the v0 of each reading holds it there too, and so does delayed feedback, \
             which needs no map.",
            lost[0], AMPLITUDES[0], lost[1], AMPLITUDES[1], made[0], made[1],
        );
        let at = (
            PLACE,
            "the reconstruction has to be recalibrated from time to time",
        );
        let how = "The route of the claim before. Maps are fitted to 20 readings near sliding \
            under small pulses of the load, made before the motion; each seed of the pulses makes \
            another one. What drifts here is v0, and with it the slope of friction, not the \
            interface.";
        Claim::new("return_map_drift", at, self.verdict(), because, how)
            .by(self.values())
            .repeat(
                "slipmap compare sweeps/return_map_route.toml --over route --amplitude 0.1,0.5 \
                 --sample-time 0.9 --model reconstructed",
            )
            .repeat(
                "slipmap compare sweeps/return_map_route.toml --over route --amplitude 0.1,0.5 \
                 --sample-time 0.9",
            )
    }

    fn values(&self) -> Vec<ClaimValue> {
        let held = "lowest v0 to which sliding is held, √(N0²/(κM)); 0.01: to the end";
        let mut values = Vec::new();
        for (lost, amplitude) in self.lost.iter().zip(AMPLITUDES) {
            let (mean, error) = mean(lost);
            let name = format!("reconstructed once, {amplitude} N0");
            let meaning = "v0 at which sliding is lost, √(N0²/(κM)): mean over records with its \
                standard error";
            values.push(ClaimValue::of(name, meaning, mean).within(error));
        }
        for (at, amplitude) in AMPLITUDES.into_iter().enumerate() {
            let name = format!("exact map, {amplitude} N0");
            values.push(ClaimValue::of(name, held, self.exact[at]));
            let name = format!("delayed feedback, {amplitude} N0");
            values.push(ClaimValue::of(name, held, self.delayed[at]));
            let made = self.made[at].map_or(f64::NAN, |made| made as f64);
            let meaning = "maps that hold sliding to the end, each made anew 5 % above where the \
                last one would lose it";
            values.push(ClaimValue::of(
                format!("maps, {amplitude} N0"),
                meaning,
                made,
            ));
        }
        values
    }
}

/// A map reconstructed from a record as the program makes one by default.
fn reconstructed() -> MapModel {
    MapModel::Reconstructed(Record {
        readings: Record::READINGS,
        pulse: Record::PULSE,
    })
}

/// How many maps hold sliding to the end of the route, if one is made anew before the last one
/// loses it; none where no number does.
fn maps_made(shop: &Workshop, case: &Case, amplitude: f64) -> Result<Option<usize>, LetterError> {
    let mut v0 = case.v0;
    for made in 1..=MOST_MAPS {
        let asked = Question {
            model: reconstructed(),
            ..question(from(case, v0), &[amplitude], &[SAMPLE_TIME])
        };
        let found = routes(shop, &[asked])?;
        let lowest = lowest_of(&found[0], MAP, amplitude);
        if lowest == case.last_v0() {
            return Ok(Some(made));
        }
        let next = EARLIER * lowest;
        if next.is_nan() || next >= v0 {
            return Ok(None);
        }
        v0 = next;
    }
    Ok(None)
}

/// The mean, with its standard error.
fn mean(values: &[f64]) -> (f64, f64) {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let squares = values.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>();
    (mean, (squares / (n * (n - 1.0))).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_map_has_to_drift_and_others_not() {
        let drift = Drift {
            v0: [0.7, 0.01],
            exact: [0.01; 2],
            delayed: [0.01; 2],
            lost: [vec![0.38, 0.37], vec![0.07, 0.08]],
            made: [Some(4), Some(2)],
        };
        assert_eq!(drift.verdict(), Verdict::Confirmed);
        let some = Drift {
            lost: [vec![0.38, 0.37], vec![0.07, 0.01]],
            ..drift.clone()
        };
        assert_eq!(some.verdict(), Verdict::Refined);
        let exact = Drift {
            exact: [0.2, 0.01],
            ..drift.clone()
        };
        assert_eq!(exact.verdict(), Verdict::Contradicted);
        let none = Drift {
            lost: [vec![0.01; 2], vec![0.01; 2]],
            ..drift
        };
        assert_eq!(none.verdict(), Verdict::Contradicted);
    }
}
