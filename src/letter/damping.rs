//! Velocity control of a damped spring: where its negative gains end, and positive gains at short
//! delays, which the letter's undamped spring does not have.

use super::LetterError;
use super::claim::{Claim, ClaimValue, Verdict};
use super::one_variable::minimum;
use super::workshop::{Source, Workshop, planes, source};
use crate::answers::margins::SettingMargins;
use crate::linear::Crossings;
use crate::linear::lobes::{LobeControl, has_stable_delay};
use crate::linear::margins::MarginSearch;
use crate::model::Groups;
use crate::setting::{Field, Parameter, Setting};

const LOBES: Source = source!("velocity_damped");
const SHORT: Source = source!("velocity_damped_short");

/// The sources of the claims here.
pub(super) const SOURCES: [&Source; 2] = [&LOBES, &SHORT];

/// Damping ratios ζ of the spring for which the end of negative gains is told.
const DAMPING_RATIOS: [f64; 7] = [0.0, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5];
/// The damping ratio of the shipped sweeps.
const OF_SWEEPS: f64 = 0.1;
/// The error of a tangency: its condition is solved to the last bits.
const TANGENCY_ERROR: f64 = 1e-12;
/// How far on both sides of an end its lobe is looked for, and in how many negative gains around
/// that of the end.
const BESIDE: f64 = 1e-3;
const GAINS: u32 = 2001;
/// Half the range of those gains, relative.
const AROUND: f64 = 0.05;

/// Where velocity control of negative gain ends at one damping ratio.
#[derive(Debug, Clone, Copy, PartialEq)]
struct DampedEnd {
    damping_ratio: f64,
    /// The slope there, √(κM)/N0.
    end: f64,
    /// Whether a delay is stable right before it, and whether one is right beyond.
    before: bool,
    beyond: bool,
}

impl DampedEnd {
    fn at(damping_ratio: f64) -> Self {
        let damping = 2.0 * damping_ratio;
        let end = LobeControl::Velocity { damping }.lobe_end(0);
        let slope = end.b - damping;
        let stable = |slope: f64| {
            (0..GAINS).any(|i| {
                let share = 2.0 * f64::from(i) / f64::from(GAINS - 1) - 1.0;
                let gain = end.gain * (1.0 + AROUND * share);
                has_stable_delay(groups(slope, damping, gain))
            })
        };
        Self {
            damping_ratio,
            end: slope,
            before: stable(slope + BESIDE),
            beyond: stable(slope - BESIDE),
        }
    }
}

/// Where negative gains end, and what the maps of a damped spring say.
#[derive(Debug, Clone, PartialEq)]
struct Ends {
    ends: Vec<DampedEnd>,
    /// Slopes of the map at [`OF_SWEEPS`], and how many stable cells each has.
    cells: Vec<(f64, usize)>,
}

impl Ends {
    /// The steepest slope of the map with stable cells.
    fn seen(&self) -> f64 {
        let stable = self.cells.iter().filter(|(_, cells)| *cells > 0);
        stable.map(|(slope, _)| *slope).fold(0.0, f64::min)
    }

    /// The end without a dashpot, and that of the map.
    fn known(&self) -> [f64; 2] {
        [0.0, OF_SWEEPS].map(|ratio| {
            let found = self.ends.iter().find(|end| end.damping_ratio == ratio);
            found.map_or(f64::NAN, |found| found.end)
        })
    }

    /// The letter's statement is of an undamped spring: dashpots move its end.
    fn verdict(&self) -> Verdict {
        let [undamped, damped] = self.known();
        let farther = self.ends.windows(2).all(|pair| pair[1].end < pair[0].end);
        let sharp = self.ends.iter().all(|end| end.before && !end.beyond);
        let seen = damped < self.seen() && self.seen() < undamped;
        Verdict::of_parts(false, farther && sharp && seen)
    }

    fn claim(&self) -> Claim {
        let [undamped, damped] = self.known();
        let sharp = self.ends.iter().filter(|end| end.before && !end.beyond);
        let because = format!(
            "That is of an undamped spring. A dashpot beside it with ζ = {OF_SWEEPS} moves the end \
             of the negative gains from {undamped:.10} to {damped:.10} √(κM)/N0; a dashpot to the \
             ground moves it by 2ζ_g. A lobe is there right before the end and not right beyond \
             it at {} of {} damping ratios. The map of ζ = {OF_SWEEPS} has stable cells down to \
             {}.",
            sharp.count(),
            self.ends.len(),
            self.seen(),
        );
        let at = (
            "paragraph of Fig. 2",
            "it disappears if μ′_K(v0) N0 ≲ −0.68 √(κM)",
        );
        let how = "With d = 2ζ the slope b + d and the load gain −d a_v stand in the letter's own \
            equation. Its first lobe of negative gains shrinks to a point where both arms of the \
            fold have the same slope.";
        // The end of the map first.
        let (of_map, others): (Vec<&DampedEnd>, Vec<_>) = self
            .ends
            .iter()
            .partition(|end| end.damping_ratio == OF_SWEEPS);
        let ends = of_map.into_iter().chain(others).map(|end| {
            let meaning = "slope at which negative gains end, √(κM)/N0";
            let name = format!("end at zeta {}", end.damping_ratio);
            ClaimValue::of(name, meaning, end.end).within(TANGENCY_ERROR)
        });
        Claim::new("velocity_limit_damped", at, self.verdict(), because, how)
            .by(ends)
            .from(&["velocity_damped"])
    }
}

/// Positive gains of short delays at one slope of a damped spring.
#[derive(Debug, Clone, Copy, PartialEq)]
struct ShortAt {
    slope: f64,
    /// Stable cells of the map, with a dashpot.
    cells: usize,
    /// Whether any gain tried at [`TRIED_DELAY`] is stable without a dashpot.
    undamped: bool,
    /// The longest delay with a stable positive gain.
    longest: f64,
    /// The largest latency margin at [`TRIED_DELAY`], and its bound d²/(4|b|) − τ/2 for small d.
    latency: f64,
    bound: f64,
}

/// The delay at which gains are tried.
const TRIED_DELAY: f64 = 2e-3;
/// The number of gains tried, evenly spaced in k = α_v τ between 0 and 1.
const TRIED: u32 = 4000;
/// The relative precision of the longest delay.
const PRECISION: f64 = 1e-9;

impl ShortAt {
    fn found(slope: f64, cells: usize) -> Result<Self, LetterError> {
        let damping = 2.0 * OF_SWEEPS;
        let mut search = MarginSearch::default();
        let mut latency_at = |k: f64| -> Result<f64, LetterError> {
            let margins = SettingMargins::of(&setting(slope, damping, k / TRIED_DELAY)?, 0.0)?;
            let stable = margins.filter(SettingMargins::stable);
            Ok(stable.map_or(0.0, |margins| margins.latency(&mut search)))
        };
        // Where latency costs least lies near the middle of 1 − d/|b| < k < 1.
        let best = 1.0 - 0.5 * damping / slope.abs();
        let around = (-50..=50).map(|i| best + f64::from(i) / 100.0 * damping / slope.abs());
        let mut latency = 0.0_f64;
        for k in around {
            latency = latency.max(latency_at(k)?);
        }
        Ok(Self {
            slope,
            cells,
            undamped: stable_undamped(slope),
            longest: longest(slope, damping),
            latency,
            bound: damping * damping / (4.0 * slope.abs()) - 0.5 * TRIED_DELAY,
        })
    }

    /// Only the dashpot makes sliding stable there, for some latency.
    fn holds(&self) -> bool {
        self.cells > 0 && !self.undamped && self.latency > 0.0 && self.longest > TRIED_DELAY
    }
}

/// A block with a dashpot beside its spring, M = κ = N0 = 1.
fn setting(slope: f64, damping: f64, gain: f64) -> Result<Setting, LetterError> {
    let numbers = [
        (Parameter::MuPrime, slope),
        (Parameter::Damping, damping),
        (Parameter::AlphaV, gain),
        (Parameter::Tau, TRIED_DELAY),
    ];
    let named = numbers.map(|(parameter, value)| (parameter.name(), value));
    Setting::checked(named, None, &[]).map_err(LetterError::spec(SHORT.name))
}

/// The groups of velocity control at a slope, with a dashpot beside the spring.
fn groups(slope: f64, damping: f64, gain: f64) -> Groups {
    Groups::new(slope + damping, gain, 0.0).coupled(damping)
}

/// Whether any positive gain with α_v τ < 1 is stable at [`TRIED_DELAY`] without a dashpot.
fn stable_undamped(slope: f64) -> bool {
    (1..TRIED).any(|i| {
        let gain = f64::from(i) / f64::from(TRIED) / TRIED_DELAY;
        Crossings::of(groups(slope, 0.0, gain)).n_unstable(TRIED_DELAY) == 0
    })
}

/// The longest delay with a stable positive gain: up to it the first stable interval of some gain
/// reaches, counted from the delay 0.
fn longest(slope: f64, damping: f64) -> f64 {
    let reach = |gain: f64| {
        let crossings = Crossings::of(groups(slope, damping, gain));
        let short = crossings.stable_delays().next();
        short
            .filter(|stable| stable.from * gain < 1.0)
            .map_or(0.0, |stable| stable.to)
    };
    // The gain that reaches farthest, in its logarithm: searched coarsely, then refined.
    let exponent = |i: u32| 0.01 * f64::from(i);
    let of = |x: f64| -reach(x.exp());
    let tried = (0..900).map(|i| (exponent(i), of(exponent(i))));
    let best = tried.min_by(|one, other| one.1.total_cmp(&other.1));
    -minimum(of, best.map_or(0.0, |(x, _)| x), 0.01)
}

/// The claim about positive gains, of these slopes.
fn short_claim(slopes: &[ShortAt]) -> Claim {
    let holds = !slopes.is_empty() && slopes.iter().all(ShortAt::holds);
    let near = slopes
        .iter()
        .all(|at| (at.latency / at.bound - 1.0).abs() < 0.5);
    let told: Vec<_> = slopes
        .iter()
        .map(|at| format!("{:.4} at {}", at.longest, at.slope))
        .collect();
    let because = format!(
        "So it is without a dashpot. With ζ = {OF_SWEEPS} positive gains at short delays stabilise \
         every slope of the map, also beyond the end of the negative ones; the longest such delays \
         are {} √(M/κ). The latency they allow at τ = {TRIED_DELAY} is {} d²/(4|b|) − τ/2, which \
         it tends to for small d.",
        told.join(", "),
        match near {
            true => "within a half of",
            false => "not near",
        },
    );
    let at = (
        "paragraph of Fig. 2",
        "it disappears if μ′_K(v0) N0 ≲ −0.68 √(κM)",
    );
    let how = "As the delay vanishes, ȧ = (v0 − ẋ)/(1 − k) with k = α_v τ: the gain amplifies the \
        dashpot, and sliding is stable for 1 − d/|b| < k < 1. Exact counts and latency margins, at \
        the slopes of a map.";
    let values = slopes.iter().flat_map(|at| {
        let slope = at.slope;
        let longest = "longest delay with a stable positive gain, √(M/κ)";
        let latency = "largest latency that sliding survives at the shortest delay tried, √(M/κ)";
        [
            ClaimValue::of(format!("longest delay at {slope}"), longest, at.longest)
                .within(PRECISION * at.longest),
            ClaimValue::of(format!("latency at {slope}"), latency, at.latency),
        ]
    });
    let verdict = Verdict::of_parts(false, holds && near);
    Claim::new("damped_short_delays", at, verdict, because, how)
        .by(values)
        .from(&["velocity_damped_short"])
}

/// Slopes of the map of a source, and how many stable cells each has.
fn stable_cells(shop: &mut Workshop, source: &Source) -> Result<Vec<(f64, usize)>, LetterError> {
    let planes = planes(&shop.map(source)?, Field::NUnstable)?;
    let cells = planes.into_iter().filter_map(|(outer, plane)| {
        let stable = plane.cells.iter().filter(|n| **n == 0.0).count();
        outer.first().map(|(_, slope)| (*slope, stable))
    });
    Ok(cells.collect())
}

/// All claims of this file.
pub(super) fn claims(shop: &mut Workshop) -> Result<Vec<Claim>, LetterError> {
    let ends = Ends {
        ends: DAMPING_RATIOS.map(DampedEnd::at).to_vec(),
        cells: stable_cells(shop, &LOBES)?,
    };
    let cells = stable_cells(shop, &SHORT)?;
    let short = cells.into_iter().map(|(slope, n)| ShortAt::found(slope, n));
    let short = short.collect::<Result<Vec<_>, _>>()?;
    Ok(vec![ends.claim(), short_claim(&short)])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ends(cells: &[(f64, usize)]) -> Ends {
        Ends {
            ends: DAMPING_RATIOS.map(DampedEnd::at).to_vec(),
            cells: cells.to_vec(),
        }
    }

    /// Ends by another program's direct search.
    #[test]
    fn a_damped_spring_moves_the_end() {
        let found = ends(&[(-0.7, 9), (-0.86, 3)]);
        let expected = [
            -0.7256359396031,
            -0.7401182341093,
            -0.7546997851432,
            -0.7990305787274,
            -0.8748052757453,
            -1.032886766507,
            -1.547254441942,
        ];
        for (end, expected) in found.ends.iter().zip(expected) {
            assert!((end.end - expected).abs() < 1e-11, "{end:?}");
            assert!(end.before && !end.beyond, "{end:?}");
        }
        assert_eq!(found.verdict(), Verdict::Refined);
        assert!(found.claim().because.contains("down to -0.86"));
        assert_eq!(
            ends(&[(-0.7, 9), (-0.86, 0)]).verdict(),
            Verdict::Contradicted
        );
        assert_eq!(ends(&[(-0.88, 1)]).verdict(), Verdict::Contradicted);
    }

    /// The longest delays by the argument of D along a contour: it has no turn at 0.0235 and at
    /// 0.32, and one at 0.0239 and at 0.33.
    #[test]
    fn short_delays_end_where_the_argument_turns() {
        assert!((longest(-0.8848, 0.2) - 0.023661).abs() < 2e-6);
        assert!((longest(-1.5573, 1.0) - 0.326392).abs() < 2e-6);
        let found = ShortAt::found(-0.8848, 7).unwrap();
        assert!(found.holds(), "{found:?}");
        assert!((found.latency / found.bound - 1.0).abs() < 0.5, "{found:?}");
        assert_eq!(short_claim(&[found]).verdict, Verdict::Refined);
        let none = ShortAt { cells: 0, ..found };
        assert_eq!(short_claim(&[found, none]).verdict, Verdict::Contradicted);
    }
}
