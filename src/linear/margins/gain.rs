//! The gain margin of any loop: the factors of its gain at which stability is lost.

use super::limits::Limits;
use super::nearest_change::{Search, Side};
use crate::linear::real_zeros::{RealFunction, TooMany, zeros};

/// How many times as large gains are looked at, where no bound on them is known.
pub(super) const MOST_GAINS: f64 = 1e12;
/// How near to the factor at which roots accumulate the search goes, relatively.
const NEAR_ACCUMULATION: f64 = 1e-10;

/// A loop whose gain may be another one.
pub trait GainLoop {
    /// The left side of the equation at whose zeros a gain puts a root on the line.
    type Function: RealFunction;

    /// Whether no gain acts.
    fn idle(&self) -> bool;

    /// Whether nobody waits for the answer any more.
    fn stopped(&self) -> bool;

    /// The left side of the equation in ω.
    fn left_side(&self) -> Self::Function;

    /// The factor of the gain that a zero belongs to.
    fn factor(&self, omega: f64) -> f64;

    /// The ω beyond which no root with up to `factor` times the gain lies on the line.
    fn bound(&self, factor: f64) -> f64;

    /// The ω beyond which no crossing lies at any factor of the gain.
    fn highest(&self) -> f64;

    /// A factor at which a root comes from infinity.
    fn further(&self) -> Option<f64> {
        None
    }

    /// The factor at which infinitely many roots come to the line.
    fn accumulates_at(&self) -> f64 {
        f64::INFINITY
    }

    /// Whether a real root is looked for besides the zeros.
    fn looks_at_zero(&self) -> bool;

    /// Whether all roots are left of the line with `factor` times the gain; none where one is on it
    /// within rounding.
    fn stable_with(&self, factor: f64) -> Option<bool>;

    /// Whether the zeros are right wherever the count does not contradict them.
    fn sure(&self) -> bool;

    /// The unit of time of ω.
    fn unit(&self) -> f64 {
        1.0
    }
}

/// The gain margin with the frequencies it comes from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GainMargin {
    /// The factors; 0 below where any smaller gain is stable too, infinite above where any larger.
    pub limits: Limits,
    /// ω of the crossing at either of them; NaN where stability is not lost by one.
    pub omegas: [f64; 2],
}

impl GainMargin {
    /// Where it is not known.
    pub(crate) const UNKNOWN: Self = Self {
        limits: Limits::UNDECIDED,
        omegas: [f64::NAN; 2],
    };

    const NONE: Self = Self {
        limits: Limits {
            lower: 0.0,
            upper: f64::INFINITY,
        },
        omegas: [f64::NAN; 2],
    };
}

/// The factors at which a root is on the line, with the frequency of each.
#[derive(Debug, Default)]
pub(super) struct Factors {
    changes: Vec<f64>,
    omegas: Vec<f64>,
}

impl Factors {
    /// The gain margin of a loop, with the frequencies it comes from.
    pub(super) fn gain_margin(&mut self, of: &impl GainLoop) -> GainMargin {
        if of.idle() {
            return GainMargin::NONE;
        }
        let highest = of.highest();
        let last = of.accumulates_at();
        let f = of.left_side();
        // The greatest factor whose crossings are all among those found.
        let mut most = match highest.is_finite() && last == f64::INFINITY {
            true => f64::INFINITY,
            false => 2.0_f64.min(0.5 + 0.5 * last),
        };
        let mut found = GainMargin::UNKNOWN;
        let mut begun = false;
        loop {
            let end = of.bound(most).min(highest);
            if of.stopped() || !end.is_finite() || self.find_factors(of, &f, (end, most)).is_err() {
                return found;
            }
            if last.is_finite() && last - most <= NEAR_ACCUMULATION * last {
                self.add(last, f64::NAN);
            }
            let search = Search {
                changes: &self.changes,
                from: 1.0,
                stable: |factor: f64| of.stable_with(factor),
                sure: of.sure(),
            };
            if !begun {
                begun = true;
                found.limits.lower = search.nearest(Side::Below, 0.0).unwrap_or(0.0);
                found.omegas[0] = self.omega_of(found.limits.lower) / of.unit();
            }
            let above = search.nearest(Side::Above, most);
            // No crossing has a frequency beyond `highest`.
            let at_the_end = last == f64::INFINITY && (end >= highest || most >= MOST_GAINS);
            if above.is_some() || at_the_end {
                found.limits.upper = above.unwrap_or(f64::INFINITY);
                found.omegas[1] = self.omega_of(found.limits.upper) / of.unit();
                return found;
            }
            most = match 4.0 * most < 0.75 * last {
                true => 4.0 * most,
                false => last - 0.125 * (last - most),
            };
        }
    }

    /// Finds all factors up to `most` at which a root is on the line at a frequency up to `end`.
    fn find_factors<L: GainLoop>(
        &mut self,
        of: &L,
        f: &L::Function,
        (end, most): (f64, f64),
    ) -> Result<(), TooMany> {
        self.changes.clear();
        self.omegas.clear();
        let (changes, omegas) = (&mut self.changes, &mut self.omegas);
        let mut keep = |omega, _| {
            let factor = of.factor(omega);
            if factor > 0.0 && factor <= most {
                changes.push(factor);
                omegas.push(omega);
            }
        };
        zeros(f, end, &mut keep)?;
        if of.looks_at_zero() {
            keep(0.0, true);
        }
        if let Some(further) = of.further().filter(|factor| *factor > 0.0) {
            self.add(further, f64::NAN);
        }
        Ok(())
    }

    fn add(&mut self, factor: f64, omega: f64) {
        self.changes.push(factor);
        self.omegas.push(omega);
    }

    /// The frequency of the factor nearest to `limit`; NaN where nothing is lost there.
    fn omega_of(&self, limit: f64) -> f64 {
        if !limit.is_finite() || limit <= 0.0 {
            return f64::NAN;
        }
        let of = self.changes.iter().zip(&self.omegas);
        let nearest = of.min_by(|(a, _), (b, _)| {
            let apart = |factor: &f64| (factor - limit).abs();
            apart(a).total_cmp(&apart(b))
        });
        nearest.map_or(f64::NAN, |(_, omega)| *omega)
    }
}
