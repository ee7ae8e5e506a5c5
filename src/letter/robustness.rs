//! Critical velocities at finite delays, the rule of thumb on times, and a comparison of both
//! controls.

use super::LetterError;
use super::claim::{Claim, ClaimValue, Verdict};
use super::measures::{Measure, linear_measures};
use super::workshop::{Source, Workshop, column, source};
use crate::critical::{Problem, critical_velocity};
use crate::linear::status::NOT_CONVERGED;
use crate::model::stop::Stop;
use crate::model::{Feedback, FrictionLaw};
use crate::setting::Field;
use crate::slip::cycle::after_release;
use crate::slip::motion::Accuracy;
use crate::store::MapFile;

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

/// v_c at the settings of Fig. 3, with the velocities used there.
#[derive(Debug, Clone, Copy, PartialEq)]
struct AtFig3 {
    vc: [f64; 2],
    v0: [f64; 2],
}

impl AtFig3 {
    fn verdict(&self) -> Verdict {
        let pairs = self.vc.iter().zip(&self.v0);
        let below = pairs.filter(|(vc, v0)| **vc > 0.0 && vc < v0).count();
        Verdict::of_parts(below == 2, below == 1)
    }

    fn claim(&self) -> Claim {
        let because = format!(
            "Stick-slip survives up to {:.6} at Fig. 3(a), where v0 = {}, and up to {:.6} at Fig. \
             3(b), where v0 = {}.",
            self.vc[0], self.v0[0], self.vc[1], self.v0[1],
        );
        let at = (
            "paragraph below Eq. (8)",
            "survives if the applied velocity v0 is below some critical value v_c",
        );
        let how = "Stick-slip under control is followed from low v0 on to the largest one at which \
            it is sustained: where its orbit grazes sliding.";
        let values = ["Fig. 3(a)", "Fig. 3(b)"].into_iter().zip(self.vc);
        let values = values.map(|(name, vc)| {
            let meaning = "critical velocity, √(N0²/(κM))";
            ClaimValue::of(format!("v_c at {name}"), meaning, vc).within(VC_ERROR * vc)
        });
        Claim::new("critical_velocity", at, self.verdict(), because, how)
            .by(values)
            .repeat(
                "slipmap vc --friction weakening --mu0 0.5 --v-s 0.5 --alpha-v=-0.33 --tau 4.15",
            )
            .repeat("slipmap vc --friction weakening --mu0 0.5 --v-s 0.5 --alpha-n=-10 --tau 0.5")
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
    let vc = [
        at(letters(-0.33, 0.0, 4.15, &stop)?),
        at(letters(0.0, -10.0, 0.5, &stop)?),
    ];
    let fig3 = AtFig3 {
        vc,
        v0: [0.35, 0.1],
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
            AtFig3 { vc, v0 }.verdict()
        };
        assert_eq!(of([0.344, 0.02]), Verdict::Confirmed);
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
