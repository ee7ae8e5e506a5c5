//! Critical velocities at finite delays, the rule of thumb on times, and a comparison of both
//! controls.

use super::LetterError;
use super::claim::{Claim, ClaimValue, Verdict};
use super::measures::{Measure, linear_measures};
use super::workshop::{Source, Workshop, column, source};
use crate::critical::switch_on::{Phase, Scan, Trials};
use crate::critical::{Problem, critical_velocity};
use crate::linear::status::NOT_CONVERGED;
use crate::model::stop::Stop;
use crate::model::{Feedback, FrictionLaw};
use crate::setting::Field;
use crate::slip::cycle::after_release;
use crate::slip::motion::Accuracy;
use crate::store::MapFile;
use crate::sweep::engine::each_attended;

const SMOOTH: Source = source!(
    "velocity_smooth",
    quick: [("points = 13", "points = 7"), ("points = 17", "points = 9")]
);
/// Only the slope at rest of the letter's law, of the three in the sweep.
const VELOCITY: Source = source!(
    "robust_velocity",
    always: [("[-0.5, -1.0, -2.0]", "[-1.0]")],
    quick: [("points = 31", "points = 11")]
);
const LOAD: Source = source!(
    "robust_load",
    always: [("[-0.5, -1.0, -2.0]", "[-1.0]")],
    quick: [("points = 31", "points = 11")]
);

/// The sources of the claims here.
pub(super) const SOURCES: [&Source; 3] = [&SMOOTH, &VELOCITY, &LOAD];

/// The error of an edge of survival: as far as intervals are halved.
const EDGE: f64 = 1e-6;
/// The relative error of v_c, that of an end found from a neighbour's orbit.
const VC_ERROR: f64 = 1e-4;

/// The letter's friction law under control.
fn letters(alpha_v: f64, alpha_n: f64, tau: f64, stop: &Stop) -> Result<Problem, LetterError> {
    let law = FrictionLaw::weakening(0.5, 0.5, 1.0)?;
    Ok(Problem {
        stop: stop.clone(),
        ..Problem::new(law, Feedback::new(alpha_v, alpha_n, tau))
    })
}

/// The time that the letter's block sticks without control, divided by the time that it slips.
fn stick_over_slip(v0: f64) -> Result<f64, LetterError> {
    let problem = letters(0.0, 0.0, 0.0, &Stop::default())?;
    let cycle = after_release(&problem.at(v0, 0.0), Accuracy::default(), 0.0);
    Ok(cycle.map_or(f64::NAN, |(_, cycle)| cycle.stick_time / cycle.slip_time))
}

/// The v0 at which stick-slip is tried that control meets at Fig. 3(a) when the block stops, and
/// how many.
const SWITCHED_ON: (f64, f64, u32) = (0.2, 0.36, 41);
/// Halvings of the intervals between them in which its fate changes.
const HALVINGS: u32 = 14;

/// The v0 at which the fate of stick-slip changes that control meets at Fig. 3(a) when the block
/// stops: lost first, then back, then lost, and so on.
fn edges_switched_on(shop: &Workshop, problem: &Problem) -> Result<Vec<f64>, LetterError> {
    let survives = |v0: f64| {
        let free = problem.at(v0, f64::INFINITY);
        let cycle = after_release(&free, Accuracy::default(), 0.0);
        cycle.is_ok_and(|(_, cycle)| {
            let steps = Scan::default().steps;
            let stop = Phase::After(cycle.slip_time);
            let mut trials = Trials::new(problem, stop, Accuracy::default(), steps);
            trials.at(v0).persists()
        })
    };
    let (from, to, number) = SWITCHED_ON;
    let step = (to - from) / f64::from(number - 1);
    let tried: Vec<f64> = (0..number).map(|i| from + step * f64::from(i)).collect();
    let fates = each_attended(
        &tried,
        shop.threads,
        shop.attended,
        |_| 1,
        |v0, stop| {
            let survives = survives(*v0);
            (!stop.is_set()).then_some(survives)
        },
    )?;
    let pairs = tried.windows(2).zip(fates.windows(2));
    let changes = pairs.filter(|(_, fates)| fates[0] != fates[1]);
    let edge = |(v0, fates): (&[f64], &[bool])| {
        let halved = (0..HALVINGS).fold([v0[0], v0[1]], |[below, above], _| {
            let middle = 0.5 * (below + above);
            match survives(middle) == fates[0] {
                true => [middle, above],
                false => [below, middle],
            }
        });
        0.5 * (halved[0] + halved[1])
    };
    let edges = changes.map(edge).collect();
    match shop.stop().is_set() {
        true => Err(LetterError::Stopped),
        false => Ok(edges),
    }
}

/// v_c at the settings of Fig. 3, with the velocities used there.
#[derive(Debug, Clone, PartialEq)]
struct AtFig3 {
    vc: [f64; 2],
    v0: [f64; 2],
    /// Where the fate of stick-slip changes that control meets when the block stops.
    edges: Vec<f64>,
}

impl AtFig3 {
    fn verdict(&self) -> Verdict {
        let pairs = self.vc.iter().zip(&self.v0);
        let below = pairs.filter(|(vc, v0)| **vc > 0.0 && vc < v0).count();
        // Survival that comes back has no single velocity below which it is.
        Verdict::of_parts(below == 2 && self.edges.len() == 1, below >= 1)
    }

    /// What becomes of stick-slip that control meets when the block stops.
    fn told_edges(&self) -> String {
        let [lost, back, last] = self.edges[..] else {
            return String::new();
        };
        format!(
            " Such stick-slip need not come about when control is switched on: at Fig. 3(a), when \
             the block has just stopped, it survives up to {lost:.5}, is lost above, survives \
             again from {back:.5} on and is lost for good at {last:.5}. Survival is re-entrant \
             there, and no single v_c parts the velocities.",
        )
    }

    fn claim(&self) -> Claim {
        let because = format!(
            "Stick-slip survives up to {:.6} at Fig. 3(a), where v0 = {}, and up to {:.6} at Fig. \
             3(b), where v0 = {}.",
            self.vc[0], self.v0[0], self.vc[1], self.v0[1],
        ) + &self.told_edges();
        let at = (
            "paragraph below Eq. (8)",
            "survives if the applied velocity v0 is below some critical value v_c",
        );
        let how = "Stick-slip under control is followed from low v0 on to the largest one at which \
            it is sustained: where its orbit grazes sliding. At Fig. 3(a) stick-slip without \
            control is also tried at 41 v0 from 0.2 to 0.36, with control switched on when the \
            block stops, and changes of its fate are refined; the last command does so at one time \
            after a release, shortly before the stop.";
        let values = ["Fig. 3(a)", "Fig. 3(b)"].into_iter().zip(self.vc);
        let values = values.map(|(name, vc)| {
            let meaning = "critical velocity, √(N0²/(κM))";
            ClaimValue::of(format!("v_c at {name}"), meaning, vc).within(VC_ERROR * vc)
        });
        let edges = self.edges.iter().enumerate().map(|(i, edge)| {
            let meaning = match i % 2 {
                0 => {
                    "v0 above which stick-slip is lost where control is switched on as the block \
                      stops, Fig. 3(a)"
                }
                _ => "v0 above which it survives again",
            };
            ClaimValue::of(format!("switched on, edge {}", i + 1), meaning, *edge).within(EDGE)
        });
        Claim::new("critical_velocity", at, self.verdict(), because, how)
            .by(values)
            .by(edges)
            .repeat(
                "slipmap vc --friction weakening --mu0 0.5 --v-s 0.5 --alpha-v=-0.33 --tau 4.15",
            )
            .repeat("slipmap vc --friction weakening --mu0 0.5 --v-s 0.5 --alpha-n=-10 --tau 0.5")
            .repeat(
                "slipmap vc --friction weakening --mu0 0.5 --v-s 0.5 --alpha-v=-0.33 --tau 4.15 \
                 --protocol switch-on --phase 3.85",
            )
    }
}

/// Numbers within this factor, √10, are of the same order.
const SAME_ORDER: f64 = 3.162_277_660_168_379_5;

/// Stick time divided by slip time of the uncontrolled block.
#[derive(Debug, Clone, Copy, PartialEq)]
struct RuleOfThumb {
    /// The lowest velocity that velocity control makes smooth, with its gain and delay.
    lowest: f64,
    at: (f64, f64),
    /// The ratio at this velocity, at the velocity that load control makes smooth in the setting of
    /// Fig. 3(b), and at Fig. 3(a) and (b).
    velocity: f64,
    load: f64,
    fig3: [f64; 2],
}

impl RuleOfThumb {
    /// Velocity control needs stick times of at most the order of slip times, load control does
    /// not.
    fn verdict(&self) -> Verdict {
        let short = self.velocity.max(self.fig3[0]);
        Verdict::of_parts(
            short <= SAME_ORDER && self.load > SAME_ORDER,
            short <= SAME_ORDER * SAME_ORDER && self.load > short,
        )
    }

    fn claim(&self) -> Claim {
        let because = format!(
            "The lowest velocity that velocity control makes smooth is {:.5} (α_v = {:.3}, τ = \
             {:.3}); there the uncontrolled block sticks {:.3} times as long as it slips. Load \
             control smooths velocities at which that is {:.1}.",
            self.lowest, self.at.0, self.at.1, self.velocity, self.load,
        );
        let at = (
            "paragraph below Eq. (8)",
            "the sticking time has to be of the same order or less than the slipping time",
        );
        let how = "v_smooth, above which sliding is stable and free of stick-slip, over gains and \
            delays; the stick and the slip of the uncontrolled cycle at the lowest one. Of the \
            same order: within a factor of √10.";
        let meaning = "stick time over slip time without control";
        Claim::new("rule_of_thumb", at, self.verdict(), because, how)
            .by([
                ClaimValue::of("at the lowest smooth velocity", meaning, self.velocity)
                    .within(10.0 * VC_ERROR * self.velocity),
                ClaimValue::of("at Fig. 3(a)", meaning, self.fig3[0]).within(1e-9),
                ClaimValue::of("at Fig. 3(b), load control", meaning, self.fig3[1]).within(1e-9),
                ClaimValue::of("at v_c of Fig. 3(b)", meaning, self.load)
                    .within(10.0 * VC_ERROR * self.load),
                ClaimValue::of(
                    "lowest",
                    "lowest smooth velocity of the map, √(N0²/(κM))",
                    self.lowest,
                )
                .within(VC_ERROR * self.lowest),
            ])
            .from(&["velocity_smooth"])
    }
}

/// The comparison of both controls.
#[derive(Debug, Clone, PartialEq)]
struct LessRobust {
    measures: Vec<Measure>,
}

impl LessRobust {
    fn ahead(&self) -> usize {
        self.measures.iter().filter(|m| m.load_wins()).count()
    }

    fn verdict(&self) -> Verdict {
        let of = self.measures.len();
        Verdict::of_parts(self.ahead() == of && of > 0, 2 * self.ahead() > of)
    }

    fn claim(&self) -> Claim {
        let others = self.measures.iter().filter(|m| !m.load_wins());
        let others: Vec<_> = others.map(|m| m.name.as_str()).collect();
        let but = match others.is_empty() {
            true => String::new(),
            false => format!("; not by: {}", others.join(", ")),
        };
        let because = format!(
            "Load control is the more robust one by {} of {} measures{but}.",
            self.ahead(),
            self.measures.len(),
        );
        let at = (
            "paragraph below Eq. (8), and the last but one",
            "velocity control is less robust than load control",
        );
        let how = "Measures of one kind for both controls: slopes that can be stabilised, shares \
            of two decades of the gain and of delays of 0.1 to 6.3 √(M/κ) that are stable, or \
            stable and free of stick-slip, the widest stable interval of delays, the lowest smooth \
            velocity; margins of the settings of Fig. 3, and the largest ones of gains and delays \
            at a slope.";
        let ahead = "measures by which load control is more robust";
        let ahead = ClaimValue::of("measures", ahead, self.ahead() as f64);
        let values = self.measures.iter().flat_map(|m| {
            let better = match m.more {
                true => "more is more robust",
                false => "less is more robust",
            };
            [("velocity", m.velocity), ("load", m.load)].map(|(control, value)| {
                let meaning = format!("{}, {control} control; {better}", m.meaning);
                let told = ClaimValue::of(format!("{}: {control}", m.name), meaning, value);
                match m.error {
                    Some(error) => told.within(error * value.abs()),
                    None => told,
                }
            })
        });
        Claim::new("less_robust", at, self.verdict(), because, how)
            .by([ahead])
            .by(values)
            .from(&["robust_velocity", "robust_load", "velocity_smooth"])
    }
}

/// v_smooth of a cell, NaN where undecided, with its gain and delay.
type Smooth = (f64, (f64, f64));

/// The cells of a map.
fn smooth(map: &MapFile) -> Result<Vec<Smooth>, LetterError> {
    let axes = map.axes();
    let of = axes.len();
    let (gains, delays) = (&axes[of - 2].values, &axes[of - 1].values);
    let status = map.status_plane(&vec![0; of], (of - 2, of - 1), usize::MAX)?;
    let cells = column(map, Field::VSmooth)?.into_iter().zip(status);
    let places = gains
        .iter()
        .flat_map(|gain| delays.iter().map(move |tau| (*gain, *tau)));
    let decided = |(value, status): (f64, u8)| match status & NOT_CONVERGED {
        0 => value,
        _ => f64::NAN,
    };
    Ok(cells.map(decided).zip(places).collect())
}

/// The share of cells that are smooth at a velocity.
fn share(cells: &[Smooth], v0: f64) -> f64 {
    cells.iter().filter(|(smooth, _)| *smooth <= v0).count() as f64 / cells.len() as f64
}

/// The cell with the lowest v_smooth.
fn lowest(cells: &[Smooth]) -> Smooth {
    let none = (f64::INFINITY, (f64::NAN, f64::NAN));
    cells
        .iter()
        .copied()
        .fold(none, |one, other| match other.0 < one.0 {
            true => other,
            false => one,
        })
}

/// All claims of this file.
pub(super) fn claims(shop: &mut Workshop) -> Result<Vec<Claim>, LetterError> {
    shop.step("critical velocities at Fig. 3")?;
    let stop = shop.stop();
    let at = |problem: Problem| {
        let found = critical_velocity(&problem);
        if found.decided { found.vc } else { f64::NAN }
    };
    let at_fig3a = letters(-0.33, 0.0, 4.15, &stop)?;
    let edges = edges_switched_on(shop, &at_fig3a)?;
    let vc = [at(at_fig3a), at(letters(0.0, -10.0, 0.5, &stop)?)];
    let fig3 = AtFig3 {
        vc,
        v0: [0.35, 0.1],
        edges,
    };
    let around = smooth(&shop.map(&SMOOTH)?)?;
    let (slowest, place) = lowest(&around);
    let rule = RuleOfThumb {
        lowest: slowest,
        at: place,
        velocity: stick_over_slip(slowest)?,
        load: stick_over_slip(vc[1])?,
        fig3: [stick_over_slip(fig3.v0[0])?, stick_over_slip(fig3.v0[1])?],
    };
    let load = smooth(&shop.map(&LOAD)?)?;
    let velocity = smooth(&shop.map(&VELOCITY)?)?;
    let mut measures = linear_measures();
    measures.push(Measure {
        name: "lowest smooth velocity".into(),
        meaning: "lowest velocity that a gain and a delay make smooth, √(N0²/(κM))",
        velocity: slowest.min(lowest(&velocity).0),
        load: lowest(&load).0,
        more: false,
        error: Some(VC_ERROR),
    });
    for v0 in [0.2, 0.35, 0.5, 1.0, 2.0] {
        measures.push(Measure {
            name: format!("smooth share at {v0}"),
            meaning: "share of the maps' gains and delays that make this velocity smooth",
            velocity: share(&velocity, v0),
            load: share(&load, v0),
            more: true,
            error: None,
        });
    }
    Ok(vec![
        fig3.claim(),
        LessRobust { measures }.claim(),
        rule.claim(),
    ])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_velocities_of_fig_3_have_to_lie_above() {
        let of = |vc: [f64; 2]| {
            let v0 = [0.35, 0.1];
            let edges = vec![vc[0]];
            AtFig3 { vc, v0, edges }.verdict()
        };
        assert_eq!(of([0.344, 0.02]), Verdict::Confirmed);
        let re_entrant = AtFig3 {
            vc: [0.344, 0.02],
            v0: [0.35, 0.1],
            edges: vec![0.27, 0.28, 0.344],
        };
        assert_eq!(re_entrant.verdict(), Verdict::Refined);
        assert_eq!(of([0.36, 0.02]), Verdict::Refined);
        assert_eq!(of([0.36, 0.2]), Verdict::Contradicted);
        assert_eq!(of([f64::NAN, 0.0]), Verdict::Contradicted);
    }

    #[test]
    fn the_rule_has_to_tell_both_controls_apart() {
        let of = |velocity, load| {
            let rule = RuleOfThumb {
                lowest: 0.22,
                at: (-0.38, 4.25),
                velocity,
                load,
                fig3: [1.2, 4.6],
            };
            rule.verdict()
        };
        assert_eq!(of(2.0, 20.0), Verdict::Confirmed);
        assert_eq!(of(5.0, 20.0), Verdict::Refined);
        assert_eq!(of(2.0, 2.5), Verdict::Refined);
        assert_eq!(of(15.0, 20.0), Verdict::Contradicted);
    }

    #[test]
    fn robustness_is_judged_by_all_measures() {
        let measure = |velocity, load, more| Measure {
            name: String::new(),
            meaning: "",
            velocity,
            load,
            more,
            error: None,
        };
        let of = |measures: &[Measure]| {
            let measures = measures.to_vec();
            LessRobust { measures }.verdict()
        };
        let (ahead, behind) = (measure(1.0, 2.0, true), measure(1.0, 2.0, false));
        assert_eq!(of(std::slice::from_ref(&ahead)), Verdict::Confirmed);
        assert_eq!(
            of(&[ahead.clone(), ahead.clone(), behind.clone()]),
            Verdict::Refined
        );
        assert_eq!(of(&[ahead, behind]), Verdict::Contradicted);
        assert_eq!(of(&[]), Verdict::Contradicted);
    }

    #[test]
    fn cells_that_are_not_decided_are_not_smooth() {
        let cells = [0.1, f64::NAN, 0.3, f64::INFINITY].map(|v| (v, (-1.0, v)));
        assert_eq!((share(&cells, 0.2), share(&cells, 0.3)), (0.25, 0.5));
        assert_eq!(lowest(&cells).0, 0.1);
    }
}
