//! Motions: the letter's Fig. 3, the fate of stick-slip elsewhere, and basins of attraction.

use super::LetterError;
use super::claim::{Claim, ClaimValue, Verdict};
use super::forces::Decay;
use super::workshop::{Source, Workshop, column, source};
use crate::answers::Trace;
use crate::linear::rightmost::Rightmost;
use crate::linear::{Crossings, MarginalTolerance};
use crate::setting::case_file::CaseSpec;
use crate::setting::{Field, Parameter};
use crate::slip::outcome::Outcome;
use crate::store::MapFile;

const FIG3A: Source = source!("fig3a");
const FIG3B: Source = source!("fig3b");
const AT_FIG3B: Source = source!(
    "velocity_at_fig3b",
    quick: [("points = 111", "points = 23"), ("points = 149", "points = 31")]
);
const LOBE_AT_FIG3B: Source = source!(
    "velocity_at_fig3b_lobe",
    quick: [("points = 61", "points = 31"), ("points = 57", "points = 29")]
);
const BASIN_A: Source = source!(
    "basin_fig3a",
    quick: [("points = 76", "points = 26"), ("points = 81", "points = 27")]
);
const BASIN_B: Source = source!(
    "basin_fig3b",
    quick: [("points = 76", "points = 26"), ("points = 81", "points = 27")]
);

/// The sources of the claims here.
pub(super) const SOURCES: [&Source; 6] = [
    &FIG3A,
    &FIG3B,
    &AT_FIG3B,
    &LOBE_AT_FIG3B,
    &BASIN_A,
    &BASIN_B,
];

/// A panel of Fig. 3.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Motion {
    /// The number of unstable roots, the spectral abscissa, and the bound on roots farther right.
    unstable: u64,
    abscissa: f64,
    margin: f64,
    /// The number of sticks before control begins to act, and the time when the last one after that
    /// ends.
    sticks_before: usize,
    last_release: f64,
    outcome: Outcome,
    n_min: f64,
}

impl Motion {
    fn of(spec: &CaseSpec, trace: &Trace) -> Result<Self, LetterError> {
        let (groups, time_unit) = spec.setting.groups()?;
        let tau = spec.setting.get(Parameter::Tau) / time_unit;
        let count = Crossings::of(groups).count(tau, MarginalTolerance::default());
        let found = Rightmost::at(groups, tau, 1, count);
        let switch_on = spec.case.switch_on;
        let sticks = trace.sticks();
        let summary = &trace.summary;
        Ok(Self {
            unstable: count.n_unstable,
            abscissa: found
                .roots
                .first()
                .map_or(f64::NAN, |root| root.lambda.re / time_unit),
            margin: found.margin,
            sticks_before: sticks.iter().filter(|stick| stick.0 < switch_on).count(),
            last_release: switch_on + summary.last_release,
            outcome: summary.outcome,
            n_min: summary.n_min,
        })
    }

    fn stable(&self) -> bool {
        self.unstable == 0 && self.abscissa < 0.0
    }

    fn turns(&self) -> Verdict {
        Verdict::of(
            self.sticks_before > 1
                && self.outcome == Outcome::Sliding
                && self.last_release.is_finite()
                && self.n_min > 0.0,
        )
    }

    fn claim(&self, name: &'static str, place: &'static str) -> Claim {
        let because = format!(
            "The block sticks {} times before the control begins to act, the last stick ends at t \
             = {:.6}, and the motion is {} in the end. The load stays above {:.4}.",
            self.sticks_before,
            self.last_release,
            self.outcome.name(),
            self.n_min,
        );
        let quotation = "stick-slip oscillations disappear after the control is switched on";
        let how = "The motion of Eqs. (1) and (2), event by event, by Taylor's method with an \
            error of 1e-12 in a step, until the linear count and the decay of what is left decide.";
        let values = [
            ClaimValue::of(
                "last_release",
                "when the last stick ends, √(M/κ)",
                self.last_release,
            )
            .within(1e-8),
            ClaimValue::of(
                "sticks",
                "sticks before the control acts",
                self.sticks_before as f64,
            ),
            ClaimValue::of("n_min", "smallest load since then, N0", self.n_min).within(1e-8),
        ];
        Claim::new(name, (place, quotation), self.turns(), because, how)
            .by(values)
            .from(&[name])
    }
}

/// The verdict on stability of sliding at both panels.
fn stable_there(panels: &[Motion; 2]) -> Verdict {
    Verdict::of(panels.iter().all(Motion::stable))
}

fn stability(panels: &[Motion; 2]) -> Claim {
    let [a, b] = panels;
    let because = format!(
        "No root is unstable at either: disturbances decay at the rates {:.6} and {:.6} √(κ/M).",
        -a.abscissa, -b.abscissa,
    );
    let how = "The exact count, and the rightmost characteristic root with a certificate by the \
        argument principle that none lies farther right.";
    let at = (
        "Fig. 3 and the paragraph below Eq. (8)",
        "We have confirmed our analytical results by numerical simulations",
    );
    let values = [("Fig. 3(a)", a), ("Fig. 3(b)", b)].map(|(name, panel)| {
        let meaning = "largest real part of a characteristic root, √(κ/M)";
        let error = panel.margin * panel.abscissa.abs().max(1.0);
        ClaimValue::of(format!("abscissa at {name}"), meaning, panel.abscissa).within(error)
    });
    Claim::new("fig3_stable", at, stable_there(panels), because, how)
        .by(values)
        .from(&["fig3a", "fig3b"])
        .repeat(
            "slipmap point --friction weakening --mu0 0.5 --v-s 0.5 --v0 0.35 --alpha-v=-0.33 \
             --tau 4.15",
        )
}

/// How many cells of a map have each outcome.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
struct Outcomes([usize; Outcome::ALL.len()]);

impl Outcomes {
    fn of(map: &MapFile) -> Result<Self, LetterError> {
        let mut found = Self::default();
        for number in column(map, Field::Outcome)? {
            found.count(number);
        }
        Ok(found)
    }

    /// The outcomes of the cells in which sliding is stable.
    fn where_stable(map: &MapFile) -> Result<Self, LetterError> {
        let unstable = column(map, Field::NUnstable)?;
        let outcomes = column(map, Field::Outcome)?;
        let mut found = Self::default();
        for (number, _) in outcomes.into_iter().zip(unstable).filter(|of| of.1 == 0.0) {
            found.count(number);
        }
        Ok(found)
    }

    fn count(&mut self, number: f64) {
        if let Some(count) = self.0.get_mut(number as usize) {
            *count += usize::from(number.is_finite());
        }
    }

    fn number(&self, outcome: Outcome) -> usize {
        self.0[outcome as usize]
    }

    fn cells(&self) -> usize {
        self.0.iter().sum()
    }

    fn told(&self) -> String {
        let some = Outcome::ALL.into_iter().filter(|of| self.number(*of) > 0);
        let told = some.map(|of| format!("{} {}", self.number(of), of.name()));
        told.collect::<Vec<_>>().join(", ")
    }
}

/// Velocity control at the velocity of Fig. 3(b).
#[derive(Debug, Clone, Copy, PartialEq)]
struct NotDestroyed {
    /// Over all gains and delays.
    outcomes: Outcomes,
    /// The cells in which sliding is stable. Most of them are in a lobe with a map of its own. Only
    /// there can motions other than exceptional ones end in sliding.
    stable: Outcomes,
}

/// The fewest cells with stable sliding that are required, and the most undecided ones per hundred
/// of them.
const STABLE_CELLS: (usize, usize) = (50, 1);

impl NotDestroyed {
    fn verdict(&self) -> Verdict {
        let (least, undecided) = STABLE_CELLS;
        let of = [self.outcomes, self.stable];
        let slid: usize = of.map(|of| of.number(Outcome::Sliding)).iter().sum();
        let stick_slip = of
            .iter()
            .all(|of| 2 * of.number(Outcome::StickSlip) > of.cells());
        let decided =
            100 * self.stable.number(Outcome::Undecided) <= undecided * self.stable.cells();
        let looked_at = self.stable.cells() >= least && decided;
        // Motions that end in sliding where sliding is unstable, or in few cells, need exceptional
        // settings.
        let some = self.stable.number(Outcome::Sliding);
        Verdict::of_parts(
            looked_at && slid == 0 && stick_slip,
            looked_at && 100 * slid < self.outcomes.cells() && 2 * some < least && stick_slip,
        )
    }

    fn claim(&self) -> Claim {
        let slid = self.outcomes.number(Outcome::Sliding);
        let stable_slid = self.stable.number(Outcome::Sliding);
        let because = format!(
            "Wherever velocity control is switched on at this velocity, {slid} of {} motions come \
             to slide ({}). Of {} motions at settings where sliding is stable, {stable_slid} come \
             to slide ({}).",
            self.outcomes.cells(),
            self.outcomes.told(),
            self.stable.cells(),
            self.stable.told(),
        );
        let at = (
            "paragraph below Eq. (8)",
            "stick-slip motion can not be destroyed by pure velocity control",
        );
        let how = "Motions from uncontrolled stick-slip, control switched on at three phases of \
            it, over gains and delays, and once more over the small lobe of them in which sliding \
            is stable. Where sliding is unstable no motion that is not exceptional can come to \
            rest in it, undecided ones neither.";
        let values = [
            ("sliding", "motions that come to slide", slid),
            (
                "stable",
                "motions where sliding is stable",
                self.stable.cells(),
            ),
            (
                "stable, sliding",
                "those of them that come to slide",
                stable_slid,
            ),
            (
                "stable, undecided",
                "those of them that are undecided",
                self.stable.number(Outcome::Undecided),
            ),
        ];
        Claim::new("velocity_at_fig3b", at, self.verdict(), because, how)
            .by(values.map(|(name, meaning, n)| ClaimValue::of(name, meaning, n as f64)))
            .from(&["velocity_at_fig3b", "velocity_at_fig3b_lobe"])
    }
}

/// The basins at both panels of Fig. 3.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Basins {
    velocity: Outcomes,
    load: Outcomes,
}

/// The share of the window of uncontrolled stick-slip from which a basin counts as quite large.
const QUITE_LARGE: f64 = 0.5;

impl Basins {
    fn share(outcomes: &Outcomes) -> f64 {
        outcomes.number(Outcome::Sliding) as f64 / outcomes.cells() as f64
    }

    fn verdict(&self) -> Verdict {
        let shares = [self.velocity, self.load].map(|of| Self::share(&of));
        Verdict::of_parts(
            shares.iter().all(|share| *share >= QUITE_LARGE),
            shares.iter().any(|share| *share >= QUITE_LARGE),
        )
    }

    fn claim(&self) -> Claim {
        let because = format!(
            "Of all starts in a window that holds the whole cycle of stick-slip, at Fig. 3(a) \
             {:.1} % come to slide ({}), at Fig. 3(b) {:.1} % ({}).",
            100.0 * Self::share(&self.velocity),
            self.velocity.told(),
            100.0 * Self::share(&self.load),
            self.load.told(),
        );
        let at = (
            "paragraph below Eq. (8)",
            "the basin of attraction … can be quite large",
        );
        let how = "The outcome from every elongation and velocity of a grid, control acting from \
            the start; quite large: at least half of the window.";
        let value = |name: &str, of: &Outcomes| {
            let (share, cells) = (Self::share(of), of.cells() as f64);
            // The edge of the basin is one line through the grid.
            let error = match share {
                0.0 | 1.0 => 1.0 / cells,
                _ => 1.0 / cells.sqrt(),
            };
            let meaning = "share of the window from which control ends in sliding; error: of a \
                basin whose edge is as long as one of the window, or of a single cell";
            ClaimValue::of(name, meaning, share).within(error)
        };
        Claim::new("basins", at, self.verdict(), because, how)
            .by([value("basin at Fig. 3(a)", &self.velocity)])
            .by([value("basin at Fig. 3(b)", &self.load)])
            .from(&["basin_fig3a", "basin_fig3b"])
    }
}

/// All claims of this file.
pub(super) fn claims(shop: &mut Workshop) -> Result<Vec<Claim>, LetterError> {
    let [a, b] = [shop.motion(&FIG3A)?, shop.motion(&FIG3B)?];
    let panels = [Motion::of(&a.0, &a.1)?, Motion::of(&b.0, &b.1)?];
    let (spec, trace) = &b;
    let load = spec.case.oscillator.normal_load();
    let forces = Decay::along(trace, load, (panels[1].abscissa, panels[1].margin));
    let basins = Basins {
        velocity: Outcomes::of(&shop.map(&BASIN_A)?)?,
        load: Outcomes::of(&shop.map(&BASIN_B)?)?,
    };
    let (map, lobe) = (shop.map(&AT_FIG3B)?, shop.map(&LOBE_AT_FIG3B)?);
    let mut stable = Outcomes::where_stable(&lobe)?;
    for (all, of) in stable.0.iter_mut().zip(Outcomes::where_stable(&map)?.0) {
        *all += of;
    }
    let not_destroyed = NotDestroyed {
        outcomes: Outcomes::of(&map)?,
        stable,
    };
    Ok(vec![
        panels[0].claim("fig3a", "Fig. 3(a)"),
        panels[1].claim("fig3b", "Fig. 3(b)"),
        stability(&panels),
        forces.claim(),
        basins.claim(),
        not_destroyed.claim(),
    ])
}

#[cfg(test)]
mod tests {
    use super::*;

    const MOTION: Motion = Motion {
        unstable: 0,
        abscissa: -0.1,
        margin: 1e-8,
        sticks_before: 7,
        last_release: 97.0,
        outcome: Outcome::Sliding,
        n_min: 0.5,
    };

    #[test]
    fn a_motion_has_to_stick_before_and_slide_in_the_end() {
        assert_eq!(MOTION.turns(), Verdict::Confirmed);
        let others = [
            Motion {
                sticks_before: 0,
                ..MOTION
            },
            Motion {
                outcome: Outcome::StickSlip,
                ..MOTION
            },
            Motion {
                n_min: 0.0,
                ..MOTION
            },
        ];
        for other in others {
            assert_eq!(other.turns(), Verdict::Contradicted, "{other:?}");
        }
        let unstable = Motion {
            unstable: 2,
            ..MOTION
        };
        assert_eq!(stable_there(&[MOTION; 2]), Verdict::Confirmed);
        assert_eq!(stable_there(&[MOTION, unstable]), Verdict::Contradicted);
    }

    fn outcomes(sliding: usize, stick_slip: usize) -> Outcomes {
        let mut found = Outcomes::default();
        found.0[Outcome::Sliding as usize] = sliding;
        found.0[Outcome::StickSlip as usize] = stick_slip;
        found
    }

    #[test]
    fn no_motion_may_come_to_slide_under_velocity_control() {
        let of = |all: (usize, usize), stable: (usize, usize)| NotDestroyed {
            outcomes: outcomes(all.0, all.1),
            stable: outcomes(stable.0, stable.1),
        };
        let verdict = |all, stable| of(all, stable).verdict();
        assert_eq!(verdict((0, 1000), (0, 200)), Verdict::Confirmed);
        assert_eq!(verdict((3, 1000), (0, 200)), Verdict::Refined);
        assert_eq!(verdict((0, 1000), (3, 200)), Verdict::Refined);
        assert_eq!(verdict((50, 1000), (0, 200)), Verdict::Contradicted);
        assert_eq!(verdict((0, 1000), (60, 140)), Verdict::Contradicted);
        // Nothing is confirmed where sliding is stable in too few cells, or too many are undecided.
        assert_eq!(verdict((0, 1000), (0, 1)), Verdict::Contradicted);
        assert_eq!(verdict((0, 0), (0, 0)), Verdict::Contradicted);
        let mut open = of((0, 1000), (0, 200));
        open.stable.0[Outcome::Undecided as usize] = 3;
        assert_eq!(open.verdict(), Verdict::Contradicted);
    }

    #[test]
    fn basins_are_judged_by_their_shares() {
        let of = |velocity, load| {
            let [velocity, load] = [velocity, load].map(|sliding| outcomes(sliding, 10 - sliding));
            Basins { velocity, load }.verdict()
        };
        assert_eq!(of(10, 6), Verdict::Confirmed);
        assert_eq!(of(10, 4), Verdict::Refined);
        assert_eq!(of(1, 4), Verdict::Contradicted);
    }
}
