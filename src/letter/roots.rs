//! Characteristic roots: sliding without control, their number and bounds, crossings, decay.

use num_complex::Complex64;

use super::LetterError;
use super::claim::{Claim, ClaimValue, Verdict};
use super::workshop::Workshop;
use crate::answers::best::{best_settings, default_ranges};
use crate::answers::search_plane::SearchPlane;
use crate::linear::best::SearchedGain;
use crate::linear::certificate::UnstableCount;
use crate::linear::characteristic::{characteristic, unstable_root_bound};
use crate::linear::newton::Root;
use crate::linear::spectrum::RootFinder;
use crate::linear::{Crossings, MarginalTolerance};
use crate::model::Groups;
use crate::setting::best_plane::parameter_of;
use crate::setting::{Parameter, Setting};

/// Numbers of settings for the claims on unstable roots, points of a Halton sequence, which fills
/// the box evenly; the second number is for a quick run.
const SETTINGS: [u32; 2] = [20_000, 2_000];

/// Setting number `i`, a point of the Halton sequence: b, a_v, a_n, τ.
fn place(i: u32) -> Place {
    let share = |base: u32| {
        let (mut left, mut unit, mut share) = (i + 1, 1.0, 0.0);
        while left > 0 {
            unit /= f64::from(base);
            share += unit * f64::from(left % base);
            left /= base;
        }
        share
    };
    let between = |base: u32, from: f64, to: f64| from + (to - from) * share(base);
    (
        Groups::new(
            between(2, -2.0, 0.5),
            between(3, -2.0, 2.0),
            between(5, -5.0, 3.0),
        ),
        between(7, 0.05, 15.0),
    )
}

/// The results for those settings.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct UnstableRoots {
    settings: u32,
    /// Number of settings at which the exact count, the argument principle and the roots found
    /// agree.
    agree: u32,
    /// The largest number of unstable roots.
    most: u64,
    /// The largest |λ| of an unstable root over its bound.
    nearest: f64,
    /// The number of crossings, and the largest |D(iω)| at one, divided by the magnitude of its
    /// terms.
    crossings: u32,
    residual: f64,
    /// The settings with the largest number, the nearest root and the largest residual.
    most_at: Option<Place>,
    nearest_at: Option<Place>,
    residual_at: Option<Place>,
}

/// Groups and delay of a setting.
type Place = (Groups, f64);

/// The command that prints the characteristic roots of a setting.
fn command(at: Option<Place>, roots: u64) -> Option<String> {
    let (Groups { b, a_v, a_n }, tau) = at?;
    Some(format!(
        "slipmap point --mu-prime={b} --alpha-v={a_v} --alpha-n={a_n} --tau {tau} --roots {roots}"
    ))
}

impl UnstableRoots {
    fn found(settings: u32) -> Self {
        let mut found = Self::default();
        let mut finder = RootFinder::default();
        for (groups, tau) in (0..settings).map(place) {
            let crossings = Crossings::of(groups);
            if crossings.marginal(tau, MarginalTolerance::default()) {
                continue;
            }
            found.settings += 1;
            let count = crossings.n_unstable(tau);
            let roots = finder.right_of(groups, tau, 0.0).unwrap_or_default();
            let listed: u64 = roots.iter().map(Root::count).sum();
            let counted = UnstableCount::new(groups).at(tau);
            found.agree += u32::from(listed == count && counted == Some(count));
            if count > found.most {
                (found.most, found.most_at) = (count, Some((groups, tau)));
            }
            let bound = unstable_root_bound(groups);
            let largest = roots.iter().map(|root| root.lambda.norm() / bound);
            let nearest = largest.fold(0.0, f64::max);
            if nearest > found.nearest {
                (found.nearest, found.nearest_at) = (nearest, Some((groups, tau)));
            }
            for crossing in crossings.iter() {
                let lambda = Complex64::new(0.0, crossing.omega);
                let delay = crossing.delay(crossing.first_branch);
                let off = characteristic(groups, delay, lambda);
                let residual = off.norm() / unstable_root_bound(groups).powi(2);
                found.crossings += 1;
                if residual >= found.residual {
                    (found.residual, found.residual_at) = (residual, Some((groups, delay)));
                }
            }
        }
        found
    }

    fn finite(&self) -> Verdict {
        Verdict::of_parts(
            self.agree == self.settings && self.settings > 0,
            100 * self.agree > 99 * self.settings,
        )
    }

    fn bounded(&self) -> Verdict {
        Verdict::of(self.most > 0 && self.nearest <= 1.0)
    }

    fn on_the_axis(&self) -> Verdict {
        Verdict::of(self.crossings > 0 && self.residual < 1e-9)
    }

    fn claims(&self) -> [Claim; 3] {
        let at = "paragraph of Eq. (3)";
        let because = format!(
            "At {} of {} settings the exact count, the argument principle and a list of the roots \
             agree; there are {} unstable roots at most.",
            self.agree, self.settings, self.most,
        );
        let how = "Settings spread evenly over b, a_v, a_n and τ. The count is that of the closed \
            form; the argument principle and the search for roots share nothing with it.";
        let quotation = "the number of solutions with positive real part is finite";
        let agree = ClaimValue::of(
            "agree",
            "settings at which all three agree",
            f64::from(self.agree),
        );
        let most = ClaimValue::of("most", "the most unstable roots", self.most as f64);
        let finite = Claim::new("finite", (at, quotation), self.finite(), because, how)
            .by([agree, most])
            .repeat_some(command(self.most_at, self.most));
        let because = format!(
            "No unstable root lies outside |λ|² ≤ (|b| + 2|a_v|)|λ| + 1 + 2|b a_v + a_n|; the \
             nearest one comes to {:.4} of it.",
            self.nearest,
        );
        let how = "Every unstable root at those settings, over the radius of the disc that bounds \
            all with Re λ ≥ 0 at every delay.";
        let quotation = "one can give upper limits of the real part and the imaginary part";
        let nearest = "largest |λ| of an unstable root over its bound";
        let bounds = Claim::new("root_bounds", (at, quotation), self.bounded(), because, how)
            .by([ClaimValue::of("nearest", nearest, self.nearest).within(1e-9)])
            .repeat_some(command(self.nearest_at, 8));
        let because = format!(
            "At {} crossings by Eqs. (4) and (5), D(iω) is 0 up to {:.1e} of its terms.",
            self.crossings, self.residual,
        );
        let how = "The crossing frequencies of those settings from Eq. (4), a quadratic in ω², \
            their delays from Eq. (5), put into Eq. (3).";
        let at = (
            "Eqs. (4), (5)",
            "can be calculated analytically in parametric form",
        );
        let residual = "largest |D(iω)| over the size of its terms";
        let crossings = Claim::new("crossings", at, self.on_the_axis(), because, how)
            .by([ClaimValue::of("residual", residual, self.residual)])
            .repeat_some(command(self.residual_at, 8));
        [finite, bounds, crossings]
    }
}

/// Sliding without control: unstable roots for decreasing and for increasing friction laws.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Uncontrolled {
    weakening: u64,
    strengthening: u64,
}

impl Uncontrolled {
    fn found() -> Self {
        let count = |b: f64| Crossings::of(Groups::new(b, 0.0, 0.0)).n_unstable(1.0);
        let slopes = [0.01, 0.1, 1.0, 10.0];
        let least = slopes.map(|b| count(-b)).into_iter().min();
        Self {
            weakening: least.unwrap_or(0),
            strengthening: slopes.map(count).into_iter().max().unwrap_or(0),
        }
    }

    fn verdict(self) -> Verdict {
        Verdict::of(self.weakening > 0 && self.strengthening == 0)
    }

    fn claim(self) -> Claim {
        let because = format!(
            "{} roots are unstable where friction weakens with velocity, {} where it strengthens.",
            self.weakening, self.strengthening,
        );
        let at = (
            "introduction, third paragraph",
            "It is unstable for velocity-weakening friction laws",
        );
        let how = "The exact count at four slopes of either sign.";
        let count = ClaimValue::of("weakening", "unstable roots, μ′ < 0", self.weakening as f64);
        Claim::new("uncontrolled", at, self.verdict(), because, how)
            .by([count])
            .repeat("slipmap point --mu-prime -0.1")
    }
}

/// The fastest decay in each stable region, by delay.
#[derive(Debug, Clone, PartialEq)]
struct Relaxation {
    lines: Vec<Line>,
}

/// The regions of one sign of the gain at one slope: delay and relaxation time of each best
/// setting.
#[derive(Debug, Clone, PartialEq)]
struct Line {
    what: &'static str,
    mu_prime: f64,
    best: Vec<(f64, f64)>,
}

impl Relaxation {
    fn found(shop: &Workshop) -> Result<Self, LetterError> {
        let mut lines = Vec::new();
        for (gain, slopes) in [
            (SearchedGain::Velocity, [-0.05, -0.1, -0.2, -0.3]),
            (SearchedGain::Load, [-0.1, -0.2, -0.3, -0.5]),
        ] {
            for mu_prime in slopes {
                let control = names(gain)[0].0;
                shop.step(&format!("the fastest decay under {control} at {mu_prime}"))?;
                let mut setting = Setting::new(None);
                setting.set(Parameter::MuPrime, mu_prime);
                let plane = SearchPlane::with_delay(parameter_of(gain));
                let ranges = default_ranges(&setting, &plane)?;
                let found = best_settings(&setting, &plane, &ranges, &shop.stop())
                    .map_err(crate::model::ModelError::from)?;
                for (what, positive) in names(gain) {
                    let same = found.regions.iter().map(|region| &region.best);
                    let same = same.filter(|best| (best.p > 0.0) == positive);
                    let best = same.filter_map(|best| Some((best.q, best.relaxation_time()?)));
                    let mut best: Vec<_> = best.collect();
                    best.sort_by(|one, other| one.0.total_cmp(&other.0));
                    if best.len() > 1 {
                        lines.push(Line {
                            what,
                            mu_prime,
                            best,
                        });
                    }
                }
            }
        }
        Ok(Self { lines })
    }

    /// Whether relaxation is slower in each region at longer delays than in the previous one, or at
    /// least than in the first.
    fn verdict(&self) -> Verdict {
        let slower = |line: &Line| line.best.windows(2).all(|pair| pair[1].1 > pair[0].1);
        let first = |line: &Line| {
            let mut times = line.best.iter().map(|best| best.1);
            let fastest = times.next().unwrap_or(f64::NAN);
            times.all(|time| time > fastest)
        };
        Verdict::of_parts(
            !self.lines.is_empty() && self.lines.iter().all(slower),
            !self.lines.is_empty() && self.lines.iter().all(first),
        )
    }

    fn claim(&self) -> Claim {
        let regions: usize = self.lines.iter().map(|line| line.best.len()).sum();
        let pairs = self.lines.iter().flat_map(|line| line.best.windows(2));
        let factors = pairs.map(|pair| pair[1].1 / pair[0].1);
        let least = factors.clone().fold(f64::INFINITY, f64::min);
        let because = format!(
            "In {regions} stable regions of {} lines, from one region to the next at longer delays \
             the shortest relaxation time grows by a factor of {least:.3} to {:.1}.",
            self.lines.len(),
            factors.fold(0.0, f64::max),
        );
        let at = (
            "paragraph of Fig. 2",
            "larger time scales on which the system relaxes into the continuous sliding state",
        );
        let how = "The setting of fastest decay in every stable region up to four periods of free \
            oscillation, refined to a multiple root and certified by the argument principle; \
            regions of either sign of the gain by themselves.";
        let values = self.lines.iter().flat_map(|line| {
            line.best.iter().enumerate().map(|(i, (tau, time))| {
                let name = format!("{} {}: region {}", line.what, line.mu_prime, i + 1);
                let meaning = format!("shortest relaxation time, √(M/κ), at τ = {tau:.6}");
                ClaimValue::of(name, meaning, *time).within(1e-8 * time)
            })
        });
        let factor = "least factor from one region to the next";
        Claim::new("larger_delays", at, self.verdict(), because, how)
            .by([ClaimValue::of("factor", factor, least).within(2e-8 * least)])
            .by(values)
            .repeat("slipmap best --mu-prime -0.1 --control velocity")
            .repeat("slipmap best --mu-prime -0.1 --control load")
    }
}

/// Names of the signs of the gain, and whether each is positive.
fn names(gain: SearchedGain) -> [(&'static str, bool); 2] {
    match gain {
        SearchedGain::Velocity => [
            ("velocity control", false),
            ("velocity control, α_v > 0", true),
        ],
        SearchedGain::Load => [("load control", false), ("load control, α_N > 0", true)],
    }
}

/// All claims of this file.
pub(super) fn claims(shop: &mut Workshop) -> Result<Vec<Claim>, LetterError> {
    shop.step("characteristic roots")?;
    let mut claims = vec![Uncontrolled::found().claim()];
    claims.extend(UnstableRoots::found(SETTINGS[usize::from(shop.quick)]).claims());
    claims.push(Relaxation::found(shop)?.claim());
    Ok(claims)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_are_judged_by_three_counts_a_bound_and_the_axis() {
        let found = UnstableRoots::found(300);
        let verdicts = |f: &UnstableRoots| [f.finite(), f.bounded(), f.on_the_axis()];
        assert_eq!(verdicts(&found), [Verdict::Confirmed; 3], "{found:?}");
        assert!(found.most >= 4 && found.nearest > 0.5, "{found:?}");
        let other = UnstableRoots {
            agree: found.agree / 2,
            nearest: 1.01,
            residual: 1e-3,
            ..found
        };
        assert_eq!(verdicts(&other), [Verdict::Contradicted; 3]);
        assert_eq!(UnstableRoots::default().finite(), Verdict::Contradicted);
    }

    #[test]
    fn sliding_without_control_is_judged_by_both_signs() {
        let found = Uncontrolled::found();
        assert_eq!(found.verdict(), Verdict::Confirmed);
        let stable = Uncontrolled {
            weakening: 0,
            ..found
        };
        assert_eq!(stable.verdict(), Verdict::Contradicted);
    }

    #[test]
    fn longer_delays_have_to_relax_more_slowly() {
        let of = |times: [f64; 3]| {
            let best = std::iter::zip([1.0, 2.0, 3.0], times).collect();
            let line = Line {
                what: "",
                mu_prime: -0.1,
                best,
            };
            Relaxation { lines: vec![line] }.verdict()
        };
        assert_eq!(of([1.0, 2.0, 3.0]), Verdict::Confirmed);
        assert_eq!(of([1.0, 3.0, 2.0]), Verdict::Refined);
        assert_eq!(of([2.0, 1.0, 3.0]), Verdict::Contradicted);
    }
}
