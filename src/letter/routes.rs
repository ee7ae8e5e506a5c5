//! The route to sliding below the velocity where it becomes unstable: v0 lowered slowly under a
//! return map that follows it.

use super::LetterError;
use super::claim::{Claim, ClaimValue, Verdict};
use super::return_map::{PLACE, Vicinity, case_of, question};
use super::workshop::Workshop;
use crate::explore::comparison::Question;
use crate::explore::route::{Held, Route};
use crate::linear::MarginalTolerance;
use crate::slip::case::Case;
use crate::slip::programme::Programme;
use crate::sweep::engine::each_attended;

/// The block of Fig. 3(b) with a dashpot, which slides stably at large v0, by the name of its file.
pub(super) const ROUTE: (&str, &str) = (
    "return_map_route",
    include_str!("../../sweeps/return_map_route.toml"),
);

/// The largest changes of the load, N0: a small one, and half of the load.
pub(super) const AMPLITUDES: [f64; 2] = [0.1, 0.5];
/// The sample time of the return map in √(M/κ), and one that is too short.
pub(super) const SAMPLE_TIME: f64 = 0.9;
const TOO_SHORT: f64 = 0.5;
/// Times in which v0 falls, besides that of the file, √(M/κ).
const TIMES: [f64; 4] = [30.0, 100.0, 300.0, 1000.0];
/// Halvings of an interval of v0: to the last bits.
const HALVINGS: u32 = 60;

/// The routes of questions, on all threads.
pub(super) fn routes(shop: &Workshop, asked: &[Question]) -> Result<Vec<Route>, LetterError> {
    let found = each_attended(
        asked,
        shop.threads,
        shop.attended,
        |_| 1,
        |question, stop| question.route(stop).transpose(),
    )?;
    let found: Result<_, _> = found.into_iter().collect();
    found.map_err(LetterError::case)
}

/// The lowest v0 of a method on a route: where it loses sliding, or the end; NaN where not known.
fn lowest(route: &Route, of: &Held) -> f64 {
    match of.held {
        Some(true) => route.v0[1],
        Some(false) => of.lost_at.unwrap_or(f64::NAN),
        None => f64::NAN,
    }
}

/// The lowest v0 of the method with this name, sample time and amplitude.
pub(super) fn lowest_of(
    route: &Route,
    (method, sample_time): (&str, Option<f64>),
    amplitude: f64,
) -> f64 {
    let same = |held: &&Held| {
        held.method == method
            && held.sample_time == sample_time
            && held.amplitude.is_none_or(|own| own == amplitude)
    };
    let found = route.methods.iter().find(same);
    found.map_or(f64::NAN, |held| lowest(route, held))
}

const NONE: (&str, Option<f64>) = ("none", None);
pub(super) const DELAYED: (&str, Option<f64>) = ("delayed-feedback", None);
pub(super) const MAP: (&str, Option<f64>) = ("return-map", Some(SAMPLE_TIME));

/// The v0 below which sliding is unstable without control.
fn stable_above(case: &Case) -> Result<f64, LetterError> {
    let free = Case {
        switch_on: f64::INFINITY,
        programme: Programme::default(),
        ..case.clone()
    };
    let (mut below, mut above) = (case.last_v0(), case.v0);
    for _ in 0..HALVINGS {
        let v0 = 0.5 * (below + above);
        let free = Case { v0, ..free.clone() };
        match free.sliding()?.count(MarginalTolerance::default()) {
            count if count.n_unstable > 0 => below = v0,
            _ => above = v0,
        }
    }
    Ok(0.5 * (below + above))
}

/// The route: v0 lowered slowly from stable sliding under an exact return map.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Slowly {
    /// v0 at first, where sliding becomes unstable, and in the end.
    v0: [f64; 3],
    /// The lowest v0 without control; and by amplitude under delayed feedback, under the return
    /// map, and under one whose readings follow too fast.
    none: f64,
    delayed: [f64; 2],
    map: [f64; 2],
    too_short: [f64; 2],
    /// Times in which v0 falls, with the lowest v0 under the return map with the small amplitude.
    times: Vec<(f64, f64)>,
    /// By amplitude the share of starts from the stick-slip of Fig. 3(b) that reach sliding by the
    /// best return map, with its standard error.
    from_stick_slip: [(f64, f64); 2],
}

impl Slowly {
    pub(super) fn found(shop: &Workshop, near: &Vicinity) -> Result<Self, LetterError> {
        let case = case_of(ROUTE)?;
        let whole = question(case.clone(), &AMPLITUDES, &[TOO_SHORT, SAMPLE_TIME]);
        let mut asked = vec![whole];
        for time in TIMES {
            let mut faster = case.clone();
            for corner in &mut faster.programme.0 {
                corner.at = time;
            }
            asked.push(question(faster, &AMPLITUDES[..1], &[SAMPLE_TIME]));
        }
        let found = routes(shop, &asked)?;
        let whole = &found[0];
        let both = |method| AMPLITUDES.map(|amplitude| lowest_of(whole, method, amplitude));
        let times = found.iter().skip(1).chain(std::iter::once(whole));
        let of_time = |route: &Route| (route.until, lowest_of(route, MAP, AMPLITUDES[0]));
        let share = |amplitude: f64| {
            let mut all = near.stick_slip_shares().filter(|(at, _)| *at == amplitude);
            all.next().map_or((f64::NAN, f64::NAN), |(_, share)| share)
        };
        Ok(Self {
            v0: [case.v0, stable_above(&case)?, case.last_v0()],
            none: lowest_of(whole, NONE, 0.0),
            delayed: both(DELAYED),
            map: both(MAP),
            too_short: both(("return-map", Some(TOO_SHORT))),
            times: times.map(of_time).collect(),
            from_stick_slip: AMPLITUDES.map(share),
        })
    }

    /// Whether the route leads below where sliding becomes unstable, where it is slow.
    fn leads_there(&self) -> bool {
        let [_, unstable, end] = self.v0;
        let fast = self.times.first().is_some_and(|(_, lowest)| *lowest > end);
        self.map[0] == end && self.none < unstable && self.none > end && fast
    }

    fn verdict(&self) -> Verdict {
        let [small, large] = self.from_stick_slip.map(|(share, _)| share == 0.0);
        let leads = self.leads_there();
        Verdict::of_parts(leads && small && large, leads && small)
    }

    pub(super) fn claim(&self) -> Claim {
        let [first, unstable, end] = self.v0;
        let share = self.from_stick_slip.map(|(share, _)| 100.0 * share);
        let (fast, slow) = (self.times.first(), self.times.iter().find(|of| of.1 == end));
        let because = format!(
            "Begun at v0 = {first} in stable sliding, an exact return map read every \
             {SAMPLE_TIME} √(M/κ) holds sliding to v0 = {end} with changes of the load of no more \
             than {} N0; without control it is lost at {:.4}, below {unstable:.4} where it becomes \
             unstable. It has to be slow: in {:.0} √(M/κ) it is lost at {:.4}, in {:.0} it is \
             not. With so small a change {:.1} % of starts from the regular stick-slip of Fig. \
             3(b) reach sliding, so there the route is needed; with {} N0 {:.1} % do, without a \
             route and without erratic stick-slip. Delayed feedback holds sliding on the same \
             route.",
            AMPLITUDES[0],
            self.none,
            fast.map_or(f64::NAN, |of| of.0),
            fast.map_or(f64::NAN, |of| of.1),
            slow.map_or(f64::NAN, |of| of.0),
            share[0],
            AMPLITUDES[1],
            share[1],
        );
        let at = (
            PLACE,
            "works only if one starts at a large stage velocity … and then slowly decreases the \
             velocity",
        );
        let how = "The block of Fig. 3(b) with a damping ratio of 0.1, since without it no sliding \
            is stable: v0 falls on a straight line, and the first stop is looked for. Regular \
            stick-slip as in the claim before; without control it repeats in this model, so none \
            is erratic.";
        Claim::new("return_map_route", at, self.verdict(), because, how)
            .by(self.values())
            .repeat(
                "slipmap compare sweeps/return_map_route.toml --over route --amplitude 0.1,0.5 \
                 --sample-time 0.5,0.9",
            )
    }

    fn values(&self) -> Vec<ClaimValue> {
        let is = "lowest v0 to which sliding is held, √(N0²/(κM)); 0.01: to the end";
        let end = self.v0[2];
        let held = |name: String, meaning: &str, v0: f64| {
            let told = ClaimValue::of(name, meaning, v0);
            if v0 == end { told } else { told.within(LOST) }
        };
        let mut values = Vec::new();
        for (method, of) in [
            ("return map", self.map),
            ("return map, h = 0.5", self.too_short),
            ("delayed feedback", self.delayed),
        ] {
            let all = AMPLITUDES.into_iter().zip(of);
            values.extend(all.map(|(at, v0)| held(format!("{method}, {at} N0"), is, v0)));
        }
        values.push(held("without control".to_owned(), is, self.none));
        let from = "v0 above which sliding is stable without control, √(N0²/(κM))";
        values.push(ClaimValue::of("stable above", from, self.v0[1]).within(1e-12));
        for (time, lowest) in &self.times {
            let name = format!("return map, 0.1 N0, in {time}");
            let meaning = "the same where v0 falls from 0.7 to 0.01 in so many √(M/κ)";
            values.push(held(name, meaning, *lowest));
        }
        for (amplitude, (share, error)) in AMPLITUDES.into_iter().zip(self.from_stick_slip) {
            let name = format!("from stick-slip, {amplitude} N0");
            let meaning = "share of starts that reach sliding by the best return map at Fig. \
                3(b); standard error";
            values.push(ClaimValue::of(name, meaning, share).within(error));
        }
        values
    }
}

/// How far off the v0 of a loss is: errors of the motion grow with the disturbance that ends it.
const LOST: f64 = 1e-6;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_route_has_to_lead_there_slowly_and_be_the_only_way() {
        let route = Slowly {
            v0: [0.7, 0.6, 0.01],
            none: 0.5,
            delayed: [0.01; 2],
            map: [0.01; 2],
            too_short: [0.5, 0.01],
            times: vec![(30.0, 0.07), (3000.0, 0.01)],
            from_stick_slip: [(0.0, 0.01); 2],
        };
        assert_eq!(route.verdict(), Verdict::Confirmed);
        let by_chance = Slowly {
            from_stick_slip: [(0.0, 0.01), (0.9, 0.01)],
            ..route.clone()
        };
        assert_eq!(by_chance.verdict(), Verdict::Refined);
        let lost = Slowly {
            map: [0.3, 0.01],
            ..route.clone()
        };
        assert_eq!(lost.verdict(), Verdict::Contradicted);
        let fast = Slowly {
            times: vec![(30.0, 0.01), (3000.0, 0.01)],
            ..route
        };
        assert_eq!(fast.verdict(), Verdict::Contradicted);
    }

    /// μ_K′(v0) + c = 0 for the letter's law: (1 + 2 v0)² = 5, the golden section.
    #[test]
    fn sliding_is_stable_above_the_golden_section() {
        let found = stable_above(&case_of(ROUTE).unwrap()).unwrap();
        assert!(
            (found - 0.5 * (5.0_f64.sqrt() - 1.0)).abs() < 1e-12,
            "{found}"
        );
    }
}
