//! Measures of the robustness of the linear stability under a control.

use super::one_variable::{Integral, integral, minimum};
use crate::linear::Crossings;
use crate::linear::lobes::LobeControl;
use crate::linear::margins::{self, MarginSearch, Setting};
use crate::model::Groups;
use crate::model::known_cases::letter_fig3;

/// A measure of robustness, for both controls.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Measure {
    /// Its name.
    pub name: String,
    /// Its meaning.
    pub meaning: &'static str,
    /// Its values for velocity control and for load control.
    pub velocity: f64,
    pub load: f64,
    /// Whether larger values are more robust.
    pub more: bool,
    /// Its relative error; none of a share of cells.
    pub error: Option<f64>,
}

impl Measure {
    /// Whether load control is the more robust one by this measure.
    pub(super) fn load_wins(&self) -> bool {
        match self.more {
            true => self.load > self.velocity,
            false => self.load < self.velocity,
        }
    }
}

/// Gains of two decades, −0.1 to −10, by the share of the logarithm; delays up to a period of free
/// oscillation.
fn gain_at(share: f64) -> f64 {
    -0.1 * 100.0_f64.powf(share)
}
const DELAYS: (f64, f64) = (0.1, 6.3);

/// Number of gains at which the widest interval is looked for before it is refined.
const GAINS: u32 = 2000;
/// The relative error of the widest interval: its maximum is found to the last bits.
const WIDEST_ERROR: f64 = 1e-9;

/// The parts of the stable intervals inside [`DELAYS`], as ratios of their ends.
fn stable_ratios(groups: Groups) -> impl Iterator<Item = f64> {
    let all = Crossings::of(groups).stable_delays();
    let inside = all.take_while(|one| one.from < DELAYS.1);
    inside
        .map(|one| one.to.min(DELAYS.1) / one.from.max(DELAYS.0))
        .filter(|ratio| *ratio > 1.0)
}

/// The stable share of the plane of the logarithms of gain and delay.
fn stable_share(groups: impl Fn(f64) -> Groups) -> Integral {
    let all = (DELAYS.1 / DELAYS.0).ln();
    let stable = |share: f64| {
        let ratios = stable_ratios(groups(gain_at(share)));
        ratios.map(f64::ln).sum::<f64>() / all
    };
    integral(stable, (0.0, 1.0), 1.0)
}

/// The widest stable interval of delays at any gain, as the ratio of its ends; 1 where there is
/// none.
fn widest(groups: impl Fn(f64) -> Groups) -> f64 {
    let step = 1.0 / f64::from(GAINS);
    let narrowness = |share: f64| {
        let ratios = stable_ratios(groups(gain_at(share.clamp(0.0, 1.0))));
        -ratios.fold(1.0, f64::max)
    };
    let shares = (0..=GAINS).map(|i| step * f64::from(i));
    let values = shares.map(|share| (share, narrowness(share)));
    let best = values.min_by(|one, other| one.1.total_cmp(&other.1));
    -minimum(narrowness, best.map_or(0.0, |(share, _)| share), step)
}

/// Measures of linear stability.
pub(super) fn linear_measures() -> Vec<Measure> {
    let mut measures = vec![Measure {
        name: "steepest slope".into(),
        meaning: "largest |μ′| that can be stabilised, √(κM)/N0; none: there is no limit",
        velocity: -LobeControl::Velocity { damping: 0.0 }.lobe_end(0).b,
        load: f64::INFINITY,
        more: true,
        error: Some(1e-12),
    }];
    for b in [-0.1, -0.3, -0.6] {
        let velocity = |gain| Groups::new(b, gain, 0.0);
        let load = |gain| Groups::new(b, 0.0, gain);
        let shares = [stable_share(velocity), stable_share(load)];
        let errors = shares.map(|share| share.error / share.value);
        measures.push(Measure {
            name: format!("stable share at {b}"),
            meaning: "share of gains and delays, in their logarithms, that is stable",
            velocity: shares[0].value,
            load: shares[1].value,
            more: true,
            error: Some(errors[0].max(errors[1])),
        });
        measures.push(Measure {
            name: format!("stable delays at {b}"),
            meaning: "longest over shortest delay of the widest stable interval",
            velocity: widest(velocity),
            load: widest(load),
            more: true,
            error: Some(WIDEST_ERROR),
        });
    }
    measures.extend(margins_at_fig3());
    for b in [-0.1, -0.3, -0.6] {
        measures.extend(largest_margins(b));
    }
    measures
}

/// The relative error of a margin: its equation is solved to the last bits.
const MARGIN_ERROR: f64 = 1e-9;

/// Margins at the settings of Fig. 3.
fn margins_at_fig3() -> [Measure; 4] {
    let mut searches = MarginSearch::default();
    let of = letter_fig3().map(|case| {
        let setting = Setting {
            groups: case.groups,
            tau: case.tau,
            decay: 0.0,
        };
        let (gain, looped) = (searches.gain(&setting), searches.of_loop(&setting));
        let radius = margins::radius(&setting).proved;
        [
            gain.upper / gain.lower,
            looped.phase,
            looped.latency,
            radius,
        ]
    });
    let meanings = [
        (
            "gain margin",
            "largest over smallest factor of the gain, at Fig. 3",
            MARGIN_ERROR,
        ),
        (
            "phase margin",
            "least phase that makes sliding unstable, rad, at Fig. 3",
            MARGIN_ERROR,
        ),
        (
            "latency margin",
            "largest further latency of the feedback, √(M/κ), at Fig. 3",
            MARGIN_ERROR,
        ),
        (
            "stability radius",
            "relative change of gain, delay and slope, at Fig. 3",
            0.01,
        ),
    ];
    let mut number = 0;
    meanings.map(|(name, meaning, error)| {
        number += 1;
        Measure {
            name: name.into(),
            meaning,
            velocity: of[0][number - 1],
            load: of[1][number - 1],
            more: true,
            error: Some(error),
        }
    })
}

/// Number of gains, and number of delays, at which margins are computed.
const PLACES: u32 = 48;

/// The largest phase margin and the largest latency margin on a grid over the box of gains and
/// delays, at a slope.
fn largest_margins(b: f64) -> [Measure; 2] {
    let mut searches = MarginSearch::default();
    let mut largest = |groups: fn(f64, f64) -> Groups| {
        let (mut phase, mut latency) = (0.0_f64, 0.0_f64);
        for (i, j) in (0..PLACES).flat_map(|i| (0..PLACES).map(move |j| (i, j))) {
            let share = |k: u32| (f64::from(k) + 0.5) / f64::from(PLACES);
            let tau = DELAYS.0 * (DELAYS.1 / DELAYS.0).powf(share(j));
            let setting = Setting {
                groups: groups(b, gain_at(share(i))),
                tau,
                decay: 0.0,
            };
            if setting.stable() {
                let found = searches.of_loop(&setting);
                phase = phase.max(found.phase);
                latency = latency.max(found.latency);
            }
        }
        [phase, latency]
    };
    let velocity = largest(|b, gain| Groups::new(b, gain, 0.0));
    let load = largest(|b, gain| Groups::new(b, 0.0, gain));
    let measure = |name: &str, meaning, number: usize| Measure {
        name: format!("largest {name} margin at {b}"),
        meaning,
        velocity: velocity[number],
        load: load[number],
        more: true,
        error: Some(MARGIN_ERROR),
    };
    let phase = "largest phase margin on a grid of 48 gains and 48 delays, rad";
    let latency = "largest latency margin on a grid of 48 gains and 48 delays, √(M/κ)";
    [measure("phase", phase, 0), measure("latency", latency, 1)]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Margins at Fig. 3 have their known values; those of the boxes are at least as large as the
    /// margins of settings inside.
    #[test]
    fn margins_are_those_of_the_settings() {
        let at = margins_at_fig3();
        let latency = [at[2].velocity, at[2].load];
        assert!((latency[0] - 0.142_666_885_165).abs() < 1e-9, "{latency:?}");
        assert!((latency[1] - 0.280_274_481_666).abs() < 1e-9, "{latency:?}");
        assert!(
            at.iter()
                .all(|measure| measure.velocity > 0.0 && measure.load > 0.0)
        );
        let largest = largest_margins(-0.3);
        assert!(
            largest.iter().all(|m| m.velocity > 0.1 && m.load > 0.1),
            "{largest:?}"
        );
        // At this slope velocity control is never stable.
        assert_eq!(largest_margins(-0.8).map(|m| m.velocity), [0.0; 2]);
    }

    /// Shares by Simpson's rule with panels halved to 1e-13, and the widest intervals by golden
    /// section, from a program of its own.
    #[test]
    fn shares_and_intervals_are_those_of_another_program() {
        for (b, shares, intervals) in [
            (
                -0.1,
                [0.299_309_514, 0.506_588_011],
                [6.161_160_037_468, 17.170_042_526_390],
            ),
            (
                -0.3,
                [0.058_017_732, 0.311_150_239],
                [1.985_550_725_320, 10.945_446_114_945],
            ),
            (
                -0.6,
                [0.001_571_677, 0.193_252_562],
                [1.087_498_964_892, 7.819_518_979_164],
            ),
        ] {
            let velocity = |gain| Groups::new(b, gain, 0.0);
            let load = |gain| Groups::new(b, 0.0, gain);
            let found = [stable_share(velocity), stable_share(load)];
            for (found, known) in found.into_iter().zip(shares) {
                let off = (found.value - known).abs();
                assert!(off < 1e-9 && found.error < 1e-9, "{b}: {found:?}");
            }
            for (found, known) in [widest(velocity), widest(load)].into_iter().zip(intervals) {
                assert!((found - known).abs() < WIDEST_ERROR * known, "{b}: {found}");
            }
        }
    }
}
