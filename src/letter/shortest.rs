//! Short delays: the shortest one that velocity control stabilises, and the gain from which load
//! control does as the delay vanishes.

use super::claim::{Claim, ClaimValue, Verdict};
use super::one_variable::minimum;
use crate::linear::Crossings;
use crate::model::Groups;

/// What short delays do.
#[derive(Debug, Clone, PartialEq)]
struct ShortDelays {
    /// Slopes, and the shortest delay that velocity control stabilises at any gain (infinite where
    /// there is none).
    velocity: Vec<(f64, f64)>,
    /// Slopes, delays, and the gain from which load control stabilises, divided by the letter's.
    load: Vec<(f64, f64, f64)>,
}

/// Delays for the limit of load control, in units of √(M/κ), each a tenth of the previous one.
const SHORT: [f64; 4] = [1e-1, 1e-2, 1e-3, 1e-4];
/// Gains tried at each slope, in each of three ranges.
const GAINS: u32 = 20_000;
/// The relative error of the shortest delay: its minimum over the gain is found to the last bits.
const SHORTEST_ERROR: f64 = 1e-9;
/// The slopes at which the gains are tried.
const SHORT_SLOPES: [f64; 9] = [-0.005, -0.02, -0.05, -0.1, -0.2, -0.3, -0.5, -0.7, -1.0];

impl ShortDelays {
    /// The shortest delay that velocity control stabilises at any gain: the shortest one of many
    /// gains, refined. Infinite where there is none.
    fn shortest_at(b: f64) -> f64 {
        // Between these gains there is a lower crossing, at which roots go to the left; outside
        // them there is none.
        let (fold, last) = (0.5 * b - b * b * b / 8.0, 0.5 / b);
        let at = |a_v: f64| {
            let crossings = Crossings::of(Groups::new(b, a_v, 0.0));
            let first = crossings.stable_delays().next();
            first.map_or(f64::INFINITY, |stable| stable.from)
        };
        let share = |i: u32| f64::from(i) / f64::from(GAINS);
        let ranges: [&dyn Fn(f64) -> f64; 3] = [
            &|share| fold + (last - fold) * share,
            &|share| 1e-3 * 1e6_f64.powf(share),
            &|share| -1e-3 * 1e6_f64.powf(share),
        ];
        let shortest = ranges.map(|gain| {
            let within = |share: f64| at(gain(share.clamp(0.0, 1.0)));
            let tried = (0..=GAINS).map(|i| (share(i), within(share(i))));
            let best = tried.min_by(|one, other| one.1.total_cmp(&other.1));
            minimum(within, best.map_or(0.0, |(share, _)| share), share(1))
        });
        shortest.into_iter().fold(f64::INFINITY, f64::min)
    }

    fn found() -> Self {
        let boundary = |b: f64, tau: f64| {
            let stable = |a_n: f64| Crossings::of(Groups::new(b, 0.0, a_n)).n_unstable(tau) == 0;
            let (mut weak, mut strong) = (0.0, 2.0 * b / tau);
            for _ in 0..100 {
                let middle = 0.5 * (weak + strong);
                *(if stable(middle) {
                    &mut strong
                } else {
                    &mut weak
                }) = middle;
            }
            strong * tau / b
        };
        let velocity = SHORT_SLOPES.map(|b| (b, Self::shortest_at(b)));
        let load = SHORT_SLOPES
            .iter()
            .flat_map(|&b| SHORT.map(|tau| (b, tau, boundary(b, tau))));
        Self {
            velocity: velocity.to_vec(),
            load: load.collect(),
        }
    }

    /// The smallest of these delays divided by its slope, |μ′|N0/κ.
    fn least(&self) -> f64 {
        let ratios = self.velocity.iter().map(|(b, tau)| tau / b.abs());
        ratios.fold(f64::INFINITY, f64::min)
    }

    /// At every slope the shortest stabilised delay exceeds |b|: below it no gain stabilises, and
    /// it does not shrink faster than |b|.
    fn velocity_verdict(&self) -> Verdict {
        Verdict::of(!self.velocity.is_empty() && self.least() > 1.0)
    }

    /// The largest distance of the gain from the letter's at a delay.
    fn off(&self, at: f64) -> f64 {
        let there = self.load.iter().filter(|(_, tau, _)| *tau == at);
        there
            .map(|(_, _, ratio)| (ratio - 1.0).abs())
            .fold(0.0, f64::max)
    }

    /// The gain approaches the letter's at least in proportion to the delay.
    fn load_verdict(&self) -> Verdict {
        let off = SHORT.map(|tau| self.off(tau));
        let nearer = off.windows(2).all(|pair| pair[1] < 0.2 * pair[0]);
        let near = off[SHORT.len() - 1] < SHORT[SHORT.len() - 1];
        Verdict::of_parts(
            nearer && near && !self.load.is_empty(),
            near && !self.load.is_empty(),
        )
    }

    fn claims(&self) -> [Claim; 2] {
        let (some, none): (Vec<_>, Vec<_>) =
            self.velocity.iter().partition(|(_, tau)| tau.is_finite());
        let mut because = format!(
            "At {} of {} slopes some gain makes sliding stable, at delays of {:.4} |μ′_K|N0/κ or \
             longer.",
            some.len(),
            self.velocity.len(),
            self.least(),
        );
        if !none.is_empty() {
            let none: Vec<_> = none
                .iter()
                .map(|row: &(f64, f64)| row.0.to_string())
                .collect();
            because += &format!(" No gain does at any delay at μ′_K = {}.", none.join(", "));
        }
        let at = (
            "paragraph of Eq. (8)",
            "pure velocity control … is not able to stabilize unstable continuous sliding states",
        );
        let how = "All stable delays at 60,000 gains of either sign, up to 1,000 √(κ/M), for each \
            slope, and the shortest one refined; beyond α_v = κ/(2μ′N0) no crossing leads back to \
            stability.";
        let shortest = self.velocity.iter().map(|(b, tau)| {
            let meaning = "shortest stable delay at any gain, √(M/κ); none: no gain stabilises";
            ClaimValue::of(format!("shortest at {b}"), meaning, *tau).within(SHORTEST_ERROR * tau)
        });
        let least = "shortest stable delay at any gain and slope, |μ′_K|N0/κ";
        let least = ClaimValue::of("shortest", least, self.least());
        let least = least.within(SHORTEST_ERROR * self.least());
        let velocity = Claim::new("short_velocity", at, self.velocity_verdict(), because, how)
            .by(std::iter::once(least).chain(shortest))
            .from(&["fig2a"])
            .repeat("slipmap point --mu-prime -0.1 --alpha-v=-2 --tau 0.1");
        let last = SHORT[SHORT.len() - 1];
        let because = format!(
            "The gain at which load control begins to stabilise differs from Eq. (8) by a share of \
             {:.1e} at τ = {}, and of {:.1e} at τ = {last}.",
            self.off(SHORT[0]),
            SHORT[0],
            self.off(last),
        );
        let at = (
            "Eq. (8)",
            "the stabilization works if α_N < μ′_K N0/(μ_K τ)",
        );
        let how = "The gain where the exact count of unstable roots becomes 0, by bisection, over \
            that of Eq. (8), for nine slopes at each delay.";
        let off = SHORT.map(|tau| {
            let meaning = "largest relative difference from Eq. (8)";
            let off = ClaimValue::of(format!("off at {tau}"), meaning, self.off(tau));
            off.within(1e-14 / tau)
        });
        let load = Claim::new("short_load", at, self.load_verdict(), because, how)
            .by(off.into_iter().rev())
            .repeat("slipmap point --mu-prime -0.3 --alpha-n=-301 --tau 0.001")
            .repeat("slipmap point --mu-prime -0.3 --alpha-n=-299 --tau 0.001");
        [velocity, load]
    }
}

/// All claims of this file.
pub(super) fn claims() -> [Claim; 2] {
    ShortDelays::found().claims()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The text beside a verdict states what was found.
    #[test]
    fn texts_follow_from_the_numbers() {
        let short = |velocity: &[(f64, f64)]| {
            let (velocity, load) = (velocity.to_vec(), Vec::new());
            ShortDelays { velocity, load }.claims()[0].because.clone()
        };
        let told = short(&[(-0.1, 0.5), (-1.0, f64::INFINITY)]);
        assert!(told.contains("At 1 of 2 slopes"), "{told}");
        assert!(told.contains("delays of 5.0000"), "{told}");
        assert!(told.contains("at any delay at μ′_K = -1."), "{told}");
        assert!(!short(&[(-0.1, 0.5)]).contains("No gain"));
    }

    #[test]
    fn short_delays_are_judged_by_how_they_come_near() {
        let load = |power: i32| {
            let rows = SHORT.map(|tau| (-0.1, tau, 1.0 + 0.5 * tau.powi(power)));
            rows.to_vec()
        };
        let of = |shortest: f64, load: Vec<(f64, f64, f64)>| {
            let velocity = vec![(-0.1, 2.0), (-0.2, shortest)];
            let found = ShortDelays { velocity, load };
            (found.velocity_verdict(), found.load_verdict())
        };
        assert_eq!(of(1.5, load(1)), (Verdict::Confirmed, Verdict::Confirmed));
        assert_eq!(
            of(f64::INFINITY, load(2)),
            (Verdict::Confirmed, Verdict::Confirmed)
        );
        assert_eq!(
            of(0.1, load(0)),
            (Verdict::Contradicted, Verdict::Contradicted)
        );
        let mut uneven = load(2);
        uneven[1].2 = 1.0 + 1e-6;
        assert_eq!(of(1.5, uneven).1, Verdict::Refined);
    }

    /// The shortest stable delays from a program of its own, with gains 10¹⁴ times finer than their
    /// range.
    #[test]
    fn shortest_delays_are_those_of_another_program() {
        for (b, known) in [
            (-0.005, 0.039_999_333_351),
            (-0.1, 0.794_720_947_481),
            (-0.3, 2.267_771_815_994),
            (-0.7, 4.288_662_853_351),
        ] {
            let found = ShortDelays::shortest_at(b);
            let within = SHORTEST_ERROR * known;
            assert!((found - known).abs() < within, "{b}: {found}");
        }
        assert_eq!(ShortDelays::shortest_at(-1.0), f64::INFINITY);
    }
}
