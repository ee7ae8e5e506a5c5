//! Coulomb friction under load control in the limit of a vanishing delay: the letter's Fig. 4.

use super::LetterError;
use super::claim::{Claim, ClaimValue, Verdict};
use super::workshop::{Source, Workshop, column, source};
use crate::critical::limit::{CoulombLimit, LimitCell};
use crate::critical::{Problem, critical_velocity};
use crate::linear::Crossings;
use crate::model::stop::Stop;
use crate::model::{Feedback, FrictionLaw, Groups};
use crate::setting::Field;

const FIG4: Source = source!("fig4");

/// The sources of the claims here.
pub(super) const SOURCES: [&Source; 1] = [&FIG4];

/// μ_K/μ_S of Fig. 4.
const RATIO: f64 = 0.5;
/// Delays approaching the limit, in units of √(M/κ).
const DELAYS: [f64; 3] = [0.02, 0.01, 0.005];
/// The values of γ.
const GAMMAS: [f64; 6] = [0.05, 0.15, 0.3, 0.55, 0.7, 0.85];

/// The oscillator of Fig. 4 at a delay, with M = κ = N0 = μ_S = 1, so that ṽ = 1/2.
fn coulomb(gamma: f64, tau: f64, stop: &Stop) -> Result<Problem, LetterError> {
    let feedback = Feedback::new(0.0, -2.0 * gamma / (RATIO * tau), tau);
    Ok(Problem {
        stop: stop.clone(),
        ..Problem::new(FrictionLaw::coulomb(RATIO, 1.0)?, feedback)
    })
}

/// v_c/ṽ by the closed form, and by motions at decreasing delays.
#[derive(Debug, Clone, PartialEq)]
struct Limit {
    /// γ, v_c/ṽ at each delay, and the closed form.
    rows: Vec<(f64, [f64; DELAYS.len()], f64)>,
}

impl Limit {
    fn found(stop: &Stop) -> Result<Self, LetterError> {
        let row = |gamma: f64| -> Result<_, LetterError> {
            let mut at = [f64::NAN; DELAYS.len()];
            for (at, tau) in at.iter_mut().zip(DELAYS) {
                let found = critical_velocity(&coulomb(gamma, tau, stop)?);
                *at = if found.decided {
                    found.vc / 0.5
                } else {
                    f64::NAN
                };
            }
            Ok((gamma, at, CoulombLimit::at(gamma, RATIO)?.vc_over_vtilde))
        };
        Ok(Self {
            rows: GAMMAS.into_iter().map(row).collect::<Result<_, _>>()?,
        })
    }

    /// The largest error of v_c extrapolated from the last two delays, against the closed form.
    fn off(&self) -> f64 {
        let rows = self.rows.iter();
        let off = rows.map(|(_, at, exact)| (2.0 * at[2] - at[1] - exact).abs());
        off.fold(0.0, worst)
    }

    /// The largest error of v_c at the last delay, divided by this delay.
    fn rate(&self) -> f64 {
        let rows = self.rows.iter();
        let off = rows.map(|(_, at, exact)| (at[2] - exact).abs() / DELAYS[2]);
        off.fold(0.0, worst)
    }

    fn verdict(&self) -> Verdict {
        Verdict::of_parts(
            self.off() < 1e-4 && !self.rows.is_empty(),
            self.rate() < 1.0 && !self.rows.is_empty(),
        )
    }

    fn claim(&self, map: &Cells) -> Claim {
        let because = format!(
            "Motions at finite delays come to the closed form within {:.1e} ṽ as τ → 0, in \
             proportion to τ (by at most {:.3} ṽ per √(M/κ)).",
            self.off(),
            self.rate(),
        );
        let at = (
            "Fig. 4",
            "The lower solid curve is v_c for τ → 0 and Coulomb's law",
        );
        let how = "ẋ(T) = ẍ(T) = 0 is one scalar equation for T, from which v_c follows. Beside it \
            v_c of the full Eqs. (1) and (2) by following orbits of stick-slip to where they \
            graze, at three delays, and what it comes to as these vanish.";
        let off = "largest difference of both as τ → 0, ṽ";
        let values = self.rows.iter().map(|(gamma, _, exact)| {
            let meaning = "critical velocity, ṽ";
            ClaimValue::of(format!("v_c at γ = {gamma}"), meaning, *exact).within(1e-12 * exact)
        });
        let cells = ClaimValue::of("cells", "cells of the map with v_c", map.vc.len() as f64);
        Claim::new("fig4", at, self.verdict(), because, how)
            .by([ClaimValue::of("off", off, self.off())])
            .by(values)
            .by([cells])
            .from(&["fig4"])
            .repeat("slipmap vc --protocol limit --gamma 0.25 --mu-ratio 0.5")
    }
}

/// The larger number; NaN if one is NaN.
fn worst(one: f64, other: f64) -> f64 {
    if one > other || one.is_nan() {
        one
    } else {
        other
    }
}

/// An approximation of v_c near an end of γ: its relative errors, in order towards the end.
#[derive(Debug, Clone, PartialEq)]
struct Approximation {
    errors: Vec<(f64, f64)>,
    /// The range of γ on the map in which the approximation is good to 10 %; none if there is none.
    good: Option<(f64, f64)>,
}

const WEAK: [f64; 5] = [1e-1, 1e-2, 1e-4, 1e-6, 1e-8];
const STRONG: [f64; 5] = [0.9, 0.99, 0.999, 0.9999, 0.99999];

impl Approximation {
    fn found(
        gammas: [f64; 5],
        of: fn(&LimitCell) -> f64,
        map: &Cells,
    ) -> Result<Self, LetterError> {
        let error = |gamma: f64| -> Result<f64, LetterError> {
            let cell = LimitCell::at(gamma, 0.0, RATIO)?;
            Ok(cell.error(of(&cell)))
        };
        let errors = gammas.into_iter().map(|gamma| Ok((gamma, error(gamma)?)));
        let mut good = None;
        for &gamma in &map.gamma {
            if error(gamma)?.abs() < 0.1 {
                good = Some((good.map_or(gamma, |(from, _)| from), gamma));
            }
        }
        Ok(Self {
            errors: errors.collect::<Result<_, LetterError>>()?,
            good,
        })
    }

    fn last(&self) -> f64 {
        self.errors
            .last()
            .map_or(f64::NAN, |(_, error)| error.abs())
    }

    /// The approximation becomes exact: its error vanishes towards the end.
    fn verdict(&self) -> Verdict {
        let pairs = self.errors.windows(2);
        let falls = pairs.clone().all(|pair| pair[1].1.abs() < pair[0].1.abs());
        Verdict::of_parts(falls && self.last() < 1e-3, self.last() < 0.05)
    }

    fn claim(&self, name: &'static str, quotation: &'static str, end: &str) -> Claim {
        let good = self.good.map_or_else(String::new, |(from, to)| {
            format!("; on the curve of Fig. 4 it is below 10 % from γ = {from} to {to}")
        });
        let because = format!(
            "Its relative error falls to {:.1e} towards γ → {end}{good}.",
            self.last(),
        );
        let how = "The approximation over the closed form, less 1, ever nearer to the end of γ.";
        let errors = self.errors.iter().rev().map(|(gamma, error)| {
            ClaimValue::of(
                format!("error at γ = {gamma}"),
                "relative error of v_c",
                *error,
            )
            .within(1e-11 + 1e-12 / (1.0 - gamma))
        });
        let at = ("paragraph of Eq. (10)", quotation);
        Claim::new(name, at, self.verdict(), because, how)
            .by(errors)
            .from(&["fig4"])
    }
}

/// The map of Fig. 4.
#[derive(Debug, Clone, PartialEq)]
struct Cells {
    gamma: Vec<f64>,
    vc: Vec<f64>,
    liftoff: Vec<f64>,
}

/// v0 at which the block lifts off, divided by v_c.
#[derive(Debug, Clone, PartialEq)]
struct LiftOff {
    /// The smallest ratio on the curves of Fig. 4, and the smallest one at all settings.
    on_curve: f64,
    anywhere: f64,
    looked_at: usize,
}

impl LiftOff {
    fn found(map: &Cells) -> Result<Self, LetterError> {
        let pairs = map.liftoff.iter().zip(&map.vc);
        let mut found = Self {
            on_curve: pairs
                .map(|(off, vc)| off / vc)
                .fold(f64::INFINITY, f64::min),
            anywhere: f64::INFINITY,
            looked_at: 0,
        };
        for i in 1..200 {
            for j in 1..100 {
                let (gamma, ratio) = (f64::from(i) / 200.0, f64::from(j) / 100.0);
                let limit = CoulombLimit::at(gamma, ratio)?;
                let over = limit.liftoff_over_vtilde / limit.vc_over_vtilde;
                found.anywhere = found.anywhere.min(over);
                found.looked_at += 1;
            }
        }
        Ok(found)
    }

    fn verdict(&self) -> Verdict {
        Verdict::of_parts(
            self.on_curve > 1.0 && self.anywhere > 1.0,
            self.on_curve > 1.0,
        )
    }

    fn claim(&self) -> Claim {
        let because = format!(
            "On the curves of Fig. 4 lift-off lies at {:.4} v_c or above, at {} other γ and \
             μ_K/μ_S at {:.4} v_c or above.",
            self.on_curve, self.looked_at, self.anywhere,
        );
        let at = ("Fig. 4", "the lift-off curve is always above v_c");
        let how = "N0/(−α_N τ) over the closed form of v_c, in every cell of the map and on a grid \
            of γ and μ_K/μ_S.";
        let least = "smallest lift-off velocity over v_c";
        Claim::new("lift_off", at, self.verdict(), because, how)
            .by([ClaimValue::of("on the curves", least, self.on_curve).within(1e-11)])
            .by([ClaimValue::of("anywhere", least, self.anywhere).within(1e-11)])
            .from(&["fig4"])
    }
}

/// Beyond critical damping.
#[derive(Debug, Clone, PartialEq)]
struct Overdamped {
    /// γ, and v_c/ṽ by the closed form.
    limit: Vec<(f64, f64)>,
    /// γ, τ, and v_c by motions; NaN where undecided.
    motions: Vec<(f64, f64, f64)>,
    /// The closed form just before γ = 1.
    before: f64,
    /// The most unstable roots of sliding with Coulomb friction and a negative load gain.
    unstable: u64,
}

impl Overdamped {
    fn found(stop: &Stop) -> Result<Self, LetterError> {
        let gammas = [1.0, 1.5, 3.0];
        let limit = gammas.into_iter().map(|gamma| {
            Ok::<_, LetterError>((gamma, CoulombLimit::at(gamma, RATIO)?.vc_over_vtilde))
        });
        let mut motions = Vec::new();
        for (gamma, tau) in gammas.into_iter().flat_map(|g| [(g, 0.1), (g, 0.02)]) {
            let found = critical_velocity(&coulomb(gamma, tau, stop)?);
            let vc = if found.decided { found.vc } else { f64::NAN };
            motions.push((gamma, tau, vc));
        }
        let gains = [0.01, 0.1, 1.0, 10.0, 100.0];
        let count = |a_n: f64| Crossings::of(Groups::new(0.0, 0.0, -a_n)).n_unstable(1e-3);
        Ok(Self {
            limit: limit.collect::<Result<_, _>>()?,
            motions,
            before: CoulombLimit::at(0.999, RATIO)?.vc_over_vtilde,
            unstable: gains.into_iter().map(count).max().unwrap_or(0),
        })
    }

    fn vanishes(&self) -> Verdict {
        let limit = self.limit.iter().all(|(_, vc)| *vc == 0.0);
        let motions = self.motions.iter().all(|(_, _, vc)| *vc == 0.0);
        let before = self.before > 0.0;
        Verdict::of_parts(limit && motions && before, limit && before)
    }

    /// At some finite delay, too, stick-slip ends at every velocity.
    fn arbitrarily_small(&self) -> Verdict {
        Verdict::of(self.motions.iter().any(|(_, _, vc)| *vc == 0.0))
    }

    fn stable(&self) -> Verdict {
        Verdict::of(self.unstable == 0)
    }

    fn claims(&self) -> [Claim; 3] {
        let at = (
            "paragraph of Eq. (10)",
            "The continuous sliding state is stable for α_N < 0.",
        );
        let because = format!(
            "{} roots are unstable at five negative gains with a short delay.",
            self.unstable
        );
        let how = "The exact count for Coulomb friction at τ = 0.001 √(M/κ).";
        let unstable = ClaimValue::of("unstable", "the most unstable roots", self.unstable as f64);
        let stable = Claim::new("coulomb_stable", at, self.stable(), because, how)
            .by([unstable])
            .repeat("slipmap point --mu-prime 0 --mu-k 0.5 --alpha-n=-100 --tau 0.001");
        let largest = self.motions.iter().map(|(_, _, vc)| *vc).fold(0.0, worst);
        let because = format!(
            "v_c is {largest} at γ = 1, 1.5 and 3, by the closed form and by motions at delays of \
             0.1 and 0.02 √(M/κ); at γ = 0.999 it is still {:.2e} ṽ.",
            self.before,
        );
        let at = (
            "paragraph of Eq. (10)",
            "stick-slip motion disappears even for infinitesimal small v0, i.e., v_c = 0",
        );
        let how = "The closed form from γ = 1 on, and searches for stick-slip at falling v0 with \
            the full Eqs. (1) and (2).";
        let vc = ClaimValue::of("vc", "largest v_c from γ = 1 on, √(N0²/(κM))", largest);
        let vc = vc.within(0.0).beside(0.0);
        let before = ClaimValue::of("before", "v_c/ṽ at γ = 0.999", self.before);
        let vanishes = Claim::new("overdamped", at, self.vanishes(), because, how)
            .by([vc, before.within(1e-9 * self.before)])
            .from(&["fig4"])
            .repeat("slipmap vc --protocol limit --gamma 1 --mu-ratio 0.5");
        let none = self.motions.iter().filter(|(_, _, vc)| *vc == 0.0).count();
        let because = format!(
            "No stick-slip is left at any velocity at {none} of {} settings of load control.",
            self.motions.len(),
        );
        let at = (
            "paragraph of Eq. (9)",
            "possible to turn stick-slip motion into continuous sliding for arbitrary small values \
             of v0",
        );
        let how = "v_c of Coulomb friction under load control at finite delays, γ = 1, 1.5 and 3: \
            the largest v0 at which stick-slip is sustained, 0 where it never is.";
        let none = ClaimValue::of("settings", "settings with v_c = 0", none as f64);
        let small = Claim::new(
            "arbitrarily_small",
            at,
            self.arbitrarily_small(),
            because,
            how,
        )
        .by([none])
        .repeat("slipmap vc --friction coulomb --mu0 0.5 --alpha-n=-60 --tau 0.1");
        [small, stable, vanishes]
    }
}

/// All claims of this file.
pub(super) fn claims(shop: &mut Workshop) -> Result<Vec<Claim>, LetterError> {
    let map = shop.map(&FIG4)?;
    let cells = Cells {
        gamma: map
            .axes()
            .first()
            .map_or(Vec::new(), |axis| axis.values.clone()),
        vc: column(&map, Field::VcOverVtilde)?,
        liftoff: column(&map, Field::LiftoffOverVtilde)?,
    };
    shop.step("critical velocities as the delay vanishes")?;
    let (limit, overdamped) = (
        Limit::found(&shop.stop())?,
        Overdamped::found(&shop.stop())?,
    );
    let weak = Approximation::found(WEAK, |cell| cell.weak, &cells)?;
    let strong = Approximation::found(STRONG, |cell| cell.strong, &cells)?;
    let [small, stable, vanishes] = overdamped.claims();
    Ok(vec![
        small,
        stable,
        vanishes,
        limit.claim(&cells),
        weak.claim("weak_control", "α_N → 0: v_c = ṽ/2√(πγ)", "0"),
        strong.claim("strong_control", "v_c = ṽ γ⁻¹ exp(−1 − πγ/√(1−γ²))", "1"),
        LiftOff::found(&cells)?.claim(),
    ])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_limit_has_to_be_met_as_the_delay_vanishes() {
        let of = |at: [f64; 3]| {
            let rows = vec![(0.3, at, 0.5)];
            Limit { rows }.verdict()
        };
        assert_eq!(of([0.502, 0.501, 0.5005]), Verdict::Confirmed);
        assert_eq!(of([0.502, 0.501, 0.5015]), Verdict::Refined);
        assert_eq!(of([0.6; 3]), Verdict::Contradicted);
        assert_eq!(of([0.502, 0.501, f64::NAN]), Verdict::Contradicted);
    }

    #[test]
    fn approximations_have_to_become_exact() {
        let of = |errors: [f64; 3]| {
            let errors = std::iter::zip([0.1, 0.01, 1e-4], errors).collect();
            let good = None;
            Approximation { errors, good }.verdict()
        };
        assert_eq!(of([0.1, -0.01, 1e-4]), Verdict::Confirmed);
        assert_eq!(of([0.1, 0.02, 0.02]), Verdict::Refined);
        assert_eq!(of([0.1, 0.1, 0.1]), Verdict::Contradicted);
    }

    #[test]
    fn lift_off_has_to_lie_above() {
        let of = |on_curve, anywhere| {
            let looked_at = 7;
            LiftOff {
                on_curve,
                anywhere,
                looked_at,
            }
            .verdict()
        };
        assert_eq!(of(1.2, 1.01), Verdict::Confirmed);
        assert_eq!(of(1.2, 0.99), Verdict::Refined);
        assert_eq!(of(0.9, 0.9), Verdict::Contradicted);
    }

    #[test]
    fn nothing_may_be_left_beyond_critical_damping() {
        let found = Overdamped {
            limit: vec![(1.0, 0.0)],
            motions: vec![(1.0, 0.1, 0.0)],
            before: 1e-9,
            unstable: 0,
        };
        let verdicts = |f: &Overdamped| [f.vanishes(), f.arbitrarily_small(), f.stable()];
        assert_eq!(verdicts(&found), [Verdict::Confirmed; 3]);
        let mut other = found.clone();
        other.motions[0].2 = f64::NAN;
        assert_eq!(other.vanishes(), Verdict::Refined);
        other.limit[0].1 = 0.1;
        other.unstable = 2;
        assert_eq!(verdicts(&other), [Verdict::Contradicted; 3]);
    }
}
