//! Control by the return map, after Rozman et al. and Ott, Grebogi and Yorke: what the letter says
//! of it, beside delayed feedback with the same largest change of the load.

use super::LetterError;
use super::claim::{Claim, ClaimValue, Verdict};
use super::workshop::Workshop;
use crate::explore::comparison::{At, Compared, Over, Question, ReachedShare};
use crate::model::MapModel;
use crate::setting::CaseSpec;
use crate::slip::case::Case;

/// The block of Fig. 3(b), by the name of its file.
const FIG3B: (&str, &str) = ("fig3b", include_str!("../../sweeps/fig3b.toml"));

/// The largest changes of the load that are tried, in N0.
const AMPLITUDES: [f64; 8] = [0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.7, 0.9];
/// Those of which all shares are told: one that is small, and half of the load.
const TOLD: [f64; 2] = [0.1, 0.5];
/// Sample times of the return map, in √(M/κ).
const SAMPLE_TIMES: [f64; 5] = [0.3, 0.5, 0.9, 1.0, 1.5];
/// Starts of each kind in a quick run and otherwise, and for how long they are followed.
const STARTS: [u32; 2] = [256, 1024];
const HORIZON: f64 = 200.0;
/// Shares further apart than this many standard errors differ.
const DIFFERENT: f64 = 3.0;

/// Where the letter speaks of the method.
pub(super) const PLACE: &str = "paragraph on the disadvantages of the method of Rozman et al.";

/// The case of a file of `sweeps`.
pub(super) fn case_of((name, text): (&'static str, &str)) -> Result<Case, LetterError> {
    let spec: CaseSpec = text.parse().map_err(LetterError::spec(name))?;
    Ok(spec.case)
}

/// The question about a block, with an exact return map.
pub(super) fn question(case: Case, amplitudes: &[f64], sample_times: &[f64]) -> Question {
    let at = amplitudes.iter().map(|&amplitude| At {
        amplitude,
        slope: 0.0,
        noise: 0.0,
    });
    Question {
        case,
        over: Over::Amplitude,
        at: at.collect(),
        sample_times: sample_times.to_vec(),
        model: MapModel::EXACT,
        starts: STARTS[0],
        seed: 0,
        horizon: HORIZON,
    }
}

/// A share of starts that reach sliding, with its standard error.
type Share = (f64, f64);

/// What a method reaches with one largest change of the load.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Reach {
    /// The time from reading to reading; none for delayed feedback.
    sample_time: Option<f64>,
    /// From starts near sliding, and from stick-slip.
    near: Share,
    stick_slip: Share,
}

/// What all methods reach with one largest change of the load.
#[derive(Debug, Clone, PartialEq)]
struct Allowed {
    amplitude: f64,
    delayed: Reach,
    maps: Vec<Reach>,
}

impl Allowed {
    /// The largest share of a return map.
    fn best(&self, of: fn(&Reach) -> Share) -> Share {
        let all = self.maps.iter().map(of);
        let larger = |one: Share, other: Share| if other.0 > one.0 { other } else { one };
        all.reduce(larger).unwrap_or((f64::NAN, f64::NAN))
    }

    /// The smallest share of a return map from stick-slip.
    fn least_from_stick_slip(&self) -> f64 {
        let all = self.maps.iter().map(|of| of.stick_slip.0);
        all.fold(f64::INFINITY, f64::min)
    }

    /// Whether return maps reach sliding from near it alone.
    fn is_restricted(&self) -> bool {
        self.best(|of| of.stick_slip).0 == 0.0 && self.best(|of| of.near).0 > 0.0
    }

    /// Whether delayed feedback ends stick-slip from every phase.
    fn delayed_ends_all(&self) -> bool {
        self.delayed.stick_slip.0 == 1.0
    }

    /// Whether a return map reaches more than delayed feedback.
    fn map_is_ahead(&self) -> bool {
        let ahead = |of: fn(&Reach) -> Share| {
            let ((map, one), (delayed, other)) = (self.best(of), of(&self.delayed));
            map - delayed > DIFFERENT * (one * one + other * other).sqrt()
        };
        ahead(|of| of.near) || ahead(|of| of.stick_slip)
    }
}

/// Where both methods reach sliding at Fig. 3(b).
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Vicinity(Vec<Allowed>);

impl Vicinity {
    pub(super) fn found(shop: &Workshop) -> Result<Self, LetterError> {
        let mut asked = question(case_of(FIG3B)?, &AMPLITUDES, &SAMPLE_TIMES);
        asked.starts = STARTS[usize::from(!shop.quick)];
        let found = asked.answer(shop.threads, shop.attended)?;
        let of = |method: &Compared, place: usize| {
            let share = |all: &[ReachedShare]| (all[place].share, all[place].error);
            Reach {
                sample_time: method.sample_time,
                near: share(&method.near),
                stick_slip: share(&method.stick_slip),
            }
        };
        let at = |(place, &amplitude): (usize, &f64)| {
            let (delayed, maps) = found.methods.split_first()?;
            Some(Allowed {
                amplitude,
                delayed: of(delayed, place),
                maps: maps.iter().map(|method| of(method, place)).collect(),
            })
        };
        Ok(Self(AMPLITUDES.iter().enumerate().filter_map(at).collect()))
    }

    /// The shares of starts from stick-slip that reach sliding by the best return map.
    pub(super) fn stick_slip_shares(&self) -> impl Iterator<Item = (f64, Share)> {
        let all = self.0.iter();
        all.map(|one| (one.amplitude, one.best(|of| of.stick_slip)))
    }

    /// The changes up to which return maps are restricted to the vicinity, and the next one.
    fn restricted(&self) -> [Option<&Allowed>; 2] {
        let free = self.0.iter().position(|one| !one.is_restricted());
        let free = free.unwrap_or(self.0.len());
        [
            free.checked_sub(1).and_then(|i| self.0.get(i)),
            self.0.get(free),
        ]
    }

    fn verdict(&self) -> Verdict {
        let all = self.0.iter();
        let contrast = |one: &Allowed| one.is_restricted() && one.delayed_ends_all();
        let restricted = self.0.iter().filter(|one| one.is_restricted()).count();
        let ahead = self.0.iter().any(Allowed::map_is_ahead);
        Verdict::of_parts(
            !self.0.is_empty() && all.clone().all(contrast),
            2 * restricted >= self.0.len() && all.clone().any(contrast) && !ahead,
        )
    }

    fn because(&self) -> String {
        let [last, next] = self.restricted();
        let percent = |share: Option<Share>| 100.0 * share.map_or(f64::NAN, |share| share.0);
        let amplitude = |of: Option<&Allowed>| of.map_or(f64::NAN, |one| one.amplitude);
        let ends = self.0.iter().find(|one| one.delayed_ends_all());
        let below = self.0.iter().take_while(|one| !one.delayed_ends_all());
        let below = below
            .map(|one| one.delayed.stick_slip.0)
            .fold(0.0, f64::max);
        format!(
            "Where the load may change by no more than {} N0, no start from stick-slip reaches \
             sliding by a return map, at any of {} sample times, and at most {:.0} % of those \
             near sliding do. With {} N0 {:.0} to {:.1} % of those from stick-slip do too, as the \
             sample time is: they enter the window by chance while the block sticks. Delayed \
             feedback with the same limits of the load ends stick-slip from every phase with {} \
             N0 and more; with less it ends {:.0} % of it, and is restricted as well{}.",
            amplitude(last),
            SAMPLE_TIMES.len(),
            percent(last.map(|one| one.best(|of| of.near))),
            amplitude(next),
            percent(next.map(|one| (one.least_from_stick_slip(), 0.0))),
            percent(next.map(|one| one.best(|of| of.stick_slip))),
            amplitude(ends),
            100.0 * below,
            match self.0.iter().any(Allowed::map_is_ahead) {
                true => "",
                false => ", but nowhere behind a return map",
            },
        )
    }

    fn values(&self) -> Vec<ClaimValue> {
        let [last, next] = self.restricted();
        let of = |one: Option<&Allowed>| one.map_or(f64::NAN, |one| one.amplitude);
        let ends = self.0.iter().position(Allowed::delayed_ends_all);
        let step = |at: usize| {
            at.checked_sub(1)
                .map(|before| self.0[at].amplitude - self.0[before].amplitude)
        };
        let from = ends.map_or(f64::NAN, |at| self.0[at].amplitude);
        let mut values = vec![
            ClaimValue::of(
                "restricted to",
                "largest change of the load up to which no return map ends stick-slip, N0; error: \
                 to the next one tried",
                of(last),
            )
            .within(of(next) - of(last)),
            ClaimValue::of(
                "delayed feedback from",
                "smallest change of the load with which delayed feedback ends stick-slip from \
                 every phase, N0; error: to the one tried before",
                from,
            )
            .within(ends.and_then(step).unwrap_or(f64::NAN)),
        ];
        for one in self.0.iter().filter(|one| TOLD.contains(&one.amplitude)) {
            for reach in std::iter::once(&one.delayed).chain(&one.maps) {
                let (short, method) = match reach.sample_time {
                    None => ("delayed".to_owned(), "delayed feedback"),
                    Some(h) => (format!("h = {h}"), "a return map read with this h"),
                };
                for (start, from, (share, error)) in [
                    ("near", "near sliding", reach.near),
                    ("far", "in stick-slip", reach.stick_slip),
                ] {
                    let name = format!("{start}, {} N0, {short}", one.amplitude);
                    let meaning = format!(
                        "share of starts {from} that come to slide under {method}; standard error"
                    );
                    values.push(ClaimValue::of(name, meaning, share).within(error));
                }
            }
        }
        values
    }

    pub(super) fn claim(&self) -> Claim {
        let at = (
            PLACE,
            "controlling methods à la Ott et al. work only in the vicinity of periodic orbits",
        );
        let how = "The block of Fig. 3(b) from starts in a box around sliding and from stick-slip \
            at a random phase, followed for 200 √(M/κ) under an exact return map that sets the \
            load at equal times, only where its change stays within what is allowed, and under \
            the letter's delayed feedback with the limits N0 ± that change. Sliding: no stop in \
            the last quarter, and ẋ within 0.1 % of v0.";
        Claim::new(
            "return_map_vicinity",
            at,
            self.verdict(),
            self.because(),
            how,
        )
        .by(self.values())
        .repeat(
            "slipmap compare sweeps/fig3b.toml --over amplitude --amplitude \
                 0.05,0.1,0.2,0.3,0.4,0.5,0.7,0.9 --sample-time 0.3,0.5,0.9,1,1.5",
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Shares of delayed feedback and of one return map, near sliding and from stick-slip.
    fn allowed(amplitude: f64, delayed: [f64; 2], map: [f64; 2]) -> Allowed {
        let reach = |sample_time, [near, stick_slip]: [f64; 2]| Reach {
            sample_time,
            near: (near, 0.01),
            stick_slip: (stick_slip, 0.01),
        };
        Allowed {
            amplitude,
            delayed: reach(None, delayed),
            maps: vec![reach(Some(0.5), [0.0; 2]), reach(Some(1.0), map)],
        }
    }

    #[test]
    fn only_from_near_means_not_from_stick_slip() {
        let small = allowed(0.1, [0.3, 0.0], [0.05, 0.0]);
        let middle = allowed(0.4, [1.0, 1.0], [0.5, 0.0]);
        let large = allowed(0.5, [1.0, 1.0], [1.0, 0.9]);
        let of = |all: &[&Allowed]| Vicinity(all.iter().map(|one| (*one).clone()).collect());
        assert_eq!(of(&[&middle]).verdict(), Verdict::Confirmed);
        let all = of(&[&small, &middle, &large]);
        assert_eq!(all.verdict(), Verdict::Refined);
        let restricted = all.restricted().map(|one| one.map(|one| one.amplitude));
        assert_eq!(restricted, [Some(0.4), Some(0.5)]);
        assert_eq!(of(&[&small, &large]).verdict(), Verdict::Contradicted);
        let behind = allowed(0.4, [0.2, 1.0], [0.5, 0.0]);
        assert_eq!(of(&[&small, &behind]).verdict(), Verdict::Contradicted);
        assert_eq!(of(&[]).verdict(), Verdict::Contradicted);
    }
}
