//! Measures of the robustness of the linear stability under a control.

use crate::linear::Crossings;
use crate::linear::lobes::LobeControl;
use crate::linear::margins::{self, Margins, Setting};
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
    /// Its relative error.
    pub error: f64,
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

/// Gains over two decades, evenly spaced in the logarithm; delays up to a period of free
/// oscillation.
const GAINS: u32 = 2000;
const DELAYS: (f64, f64) = (0.1, 6.3);

/// At a slope: the stable share of the plane of the logarithms of gain and delay, and the widest
/// stable interval of delays, as the ratio of its ends.
fn stable_share(groups: impl Fn(f64) -> Groups) -> (f64, f64) {
    let all = (DELAYS.1 / DELAYS.0).ln();
    let (mut stable, mut widest) = (0.0, 1.0_f64);
    for i in 0..GAINS {
        let gain = -0.1 * 100.0_f64.powf((f64::from(i) + 0.5) / f64::from(GAINS));
        for interval in Crossings::of(groups(gain)).stable_delays() {
            if interval.from > DELAYS.1 {
                break;
            }
            let (from, to) = (interval.from.max(DELAYS.0), interval.to.min(DELAYS.1));
            stable += (to / from).ln().max(0.0);
            widest = widest.max(to / from);
        }
    }
    (stable / all / f64::from(GAINS), widest)
}

/// Measures of linear stability.
pub(super) fn linear_measures() -> Vec<Measure> {
    let mut measures = vec![Measure {
        name: "steepest slope".into(),
        meaning: "largest |μ′| that can be stabilised, √(κM)/N0; none: there is no limit",
        velocity: -LobeControl::Velocity.lobe_end(0).b,
        load: f64::INFINITY,
        more: true,
        error: 1e-12,
    }];
    for b in [-0.1, -0.3, -0.6] {
        let velocity = stable_share(|gain| Groups::new(b, gain, 0.0));
        let load = stable_share(|gain| Groups::new(b, 0.0, gain));
        measures.push(Measure {
            name: format!("stable share at {b}"),
            meaning: "share of gains and delays, in their logarithms, that is stable",
            velocity: velocity.0,
            load: load.0,
            more: true,
            error: 2.0 / f64::from(GAINS),
        });
        measures.push(Measure {
            name: format!("stable delays at {b}"),
            meaning: "longest over shortest delay of the widest stable interval",
            velocity: velocity.1,
            load: load.1,
            more: true,
            error: 2.0 / f64::from(GAINS),
        });
    }
    measures.extend(margins_at_fig3());
    for b in [-0.1, -0.3, -0.6] {
        measures.extend(largest_margins(b));
    }
    measures
}

/// Margins at the settings of Fig. 3.
fn margins_at_fig3() -> [Measure; 4] {
    let mut searches = Margins::default();
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
            1e-9,
        ),
        (
            "phase margin",
            "least phase that makes sliding unstable, rad, at Fig. 3",
            1e-9,
        ),
        (
            "latency margin",
            "largest further latency of the feedback, √(M/κ), at Fig. 3",
            1e-9,
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
            error,
        }
    })
}

/// Number of gains, and number of delays, at which margins are computed.
const PLACES: u32 = 48;

/// The largest phase margin and the largest latency margin over the box of gains and delays, at a
/// slope.
fn largest_margins(b: f64) -> [Measure; 2] {
    let mut searches = Margins::default();
    let mut largest = |groups: fn(f64, f64) -> Groups| {
        let (mut phase, mut latency) = (0.0_f64, 0.0_f64);
        for (i, j) in (0..PLACES).flat_map(|i| (0..PLACES).map(move |j| (i, j))) {
            let share = |k: u32| (f64::from(k) + 0.5) / f64::from(PLACES);
            let tau = DELAYS.0 * (DELAYS.1 / DELAYS.0).powf(share(j));
            let setting = Setting {
                groups: groups(b, -0.1 * 100.0_f64.powf(share(i))),
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
        error: 1.0 / f64::from(PLACES),
    };
    let latency = "largest latency margin of any gain and delay, √(M/κ)";
    [
        measure(
            "phase",
            "largest phase margin of any gain and delay, rad",
            0,
        ),
        measure("latency", latency, 1),
    ]
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
}
