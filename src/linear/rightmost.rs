//! The rightmost roots at one point, with the certificate that a map's cell there has.

use super::count::Count;
use super::equation::Equation;
use super::newton::Root;
use super::spectrum::{Incomplete, RootFinder};
use super::status::{CERTIFIED, DISAGREE, MARGINAL, MOST_COUNTED, NOT_CONVERGED};
use super::track::RootTracker;

/// The rightmost roots of a point. Dimensionless.
#[derive(Debug, Clone)]
pub struct Rightmost {
    /// By falling real part, pairs counted once. Fewer than asked for where there are no more:
    /// without control or delay.
    pub roots: Vec<Root>,
    /// No root lies right of Re λ + margin·max(1, |Re λ|), λ being the first of `roots`; NaN where
    /// nothing converged.
    pub margin: f64,
    /// Whether the argument principle confirms that, and the number of unstable roots.
    pub certified: bool,
    /// The line right of which roots are missing, if any are.
    pub missing: Option<Incomplete>,
}

impl Rightmost {
    /// The `wanted` rightmost roots, at least one, at the delay `tau` ≥ 0; `count` is that of the
    /// closed form there.
    #[must_use]
    pub fn at(equation: impl Equation, tau: f64, wanted: usize, count: Count) -> Self {
        let counted = count.n_unstable.min(u64::from(MOST_COUNTED));
        let mut status = if count.marginal { MARGINAL } else { 0 };
        let (mut first, mut margin) = (None, f64::NAN);
        let mut tracker = RootTracker::new(1);
        let (counts, flags) = ([counted as u16], std::slice::from_mut(&mut status));
        tracker.follow(equation, (&[tau], 1.0), 0, &counts, flags, |_, cell| {
            first = cell.roots.first().copied();
            margin = cell.margin;
        });
        let wanted = wanted.max(1);
        let mut finder = RootFinder::default();
        equation.begin();
        // A pair is two roots.
        let found = finder.rightmost(equation, tau, 2 * wanted as u64, f64::NEG_INFINITY);
        let (roots, missing) = match found {
            Ok(roots) => (roots[..roots.len().min(wanted)].to_vec(), None),
            Err(error) => (first.into_iter().collect(), Some(error)),
        };
        let agree = match (first, roots.first()) {
            (Some(tracked), Some(found)) => {
                let scale = tracked.lambda.re.abs().max(1.0);
                (tracked.lambda.re - found.lambda.re).abs() <= margin * scale
            }
            _ => false,
        };
        let flags = status & (CERTIFIED | DISAGREE | NOT_CONVERGED);
        Self {
            roots,
            margin,
            certified: flags == CERTIFIED && agree && missing.is_none(),
            missing,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linear::{Crossings, MarginalTolerance};
    use crate::model::Groups;
    use crate::model::known_cases;

    fn at(groups: Groups, tau: f64, wanted: usize) -> Rightmost {
        let count = Crossings::of(groups).count(tau, MarginalTolerance::default());
        Rightmost::at(groups, tau, wanted, count)
    }

    #[test]
    fn as_many_as_asked_for_and_certified() {
        let case = known_cases::beyond_the_letters_limit();
        for wanted in [1, 4, 20, 64] {
            let found = at(case.groups, case.tau, wanted);
            assert!(found.certified && found.missing.is_none());
            assert_eq!(found.roots.len(), wanted);
            assert!((found.roots[0].lambda.re + 0.0075).abs() < 1e-4);
            let falls = |w: &[Root]| w[0].lambda.re >= w[1].lambda.re;
            assert!(found.roots.windows(2).all(falls));
        }
    }

    #[test]
    fn without_control_or_delay_there_is_one_pair() {
        for (groups, tau) in [
            (Groups::new(-0.3, 0.0, 0.0), 2.0),
            (Groups::new(-0.3, 0.4, -1.0), 0.0),
        ] {
            let found = at(groups, tau, 20);
            assert!(found.certified && found.roots.len() == 1, "{found:?}");
            assert!((found.roots[0].lambda.re - 0.15).abs() < 1e-14);
        }
    }

    /// The gains that make `mu` a double root at a delay: D = D′ = 0 is linear in them.
    fn with_double_root(b: f64, tau: f64, mu: f64) -> Groups {
        let delayed = (-mu * tau).exp();
        let difference = -(-mu * tau).exp_m1();
        let feedback = (mu * (mu + b) + 1.0) / difference;
        let a_v = (2.0 * mu + b - feedback * tau * delayed) / difference;
        Groups::new(b, a_v, feedback - a_v * (b + mu))
    }

    /// Rounded gains leave two roots within 1e-6 of one another, or a pair as near.
    #[test]
    fn the_abscissa_is_known_at_double_real_roots() {
        let mut tried = 0;
        for i in 0..3000 {
            let t = f64::from(i);
            let b = 1.2 * (t * 0.73).sin();
            let tau = 5.0 * (1.02 + (t * 1.37).sin());
            let mu = -0.3 + 1.5 * (t * 2.11).sin();
            let groups = with_double_root(b, tau, mu);
            if groups.a_v.abs().max(groups.a_n.abs()) > 50.0 || mu.abs() < 1e-3 {
                continue;
            }
            tried += 1;
            let found = at(groups, tau, 4);
            let (Some(first), None) = (found.roots.first(), found.missing) else {
                panic!("{groups:?} {tau} {mu}: {found:?}");
            };
            let near = |r: &Root| (r.lambda - mu).norm() < 1e-5 * (1.0 + mu.abs());
            let twice: u64 = found
                .roots
                .iter()
                .filter(|r| near(r))
                .map(Root::count)
                .sum();
            // Where it is cut off, four others lie right of it.
            let cut_off = found.roots.len() == 4 && found.roots[3].lambda.re > mu - 1e-5;
            assert!(
                first.lambda.re >= mu - 1e-5 && (twice >= 2 || cut_off),
                "{groups:?} {tau} {mu}: {found:?}"
            );
        }
        assert!(tried > 1000, "{tried}");
    }

    /// Some have other roots of the same real part beside the double one.
    #[test]
    fn the_abscissa_is_known_where_a_pair_lies_above_a_double_real_root() {
        let mut tried = 0;
        for i in 0..400 {
            let t = f64::from(i);
            let b = 1.2 * (t * 0.73).sin();
            let tau = 3.0 * (1.05 + (t * 1.37).sin());
            // How far right of the double root the rightmost pair is.
            let gap = |mu: f64| {
                let roots = at(with_double_root(b, tau, mu), tau, 6).roots;
                let pair = roots.iter().find(|r| r.lambda.im > 0.1);
                pair.map_or(f64::NAN, |r| r.lambda.re - mu)
            };
            for j in 0..40 {
                let (from, to) = (-2.0 + 0.05 * f64::from(j), -1.95 + 0.05 * f64::from(j));
                let changes = gap(from) * gap(to) < 0.0;
                if !changes {
                    continue;
                }
                let mu = crate::linear::roots::bisect(from, to, gap);
                let found = at(with_double_root(b, tau, mu), tau, 4);
                if gap(mu).abs() > 1e-6 {
                    // The pair became another one.
                    continue;
                }
                tried += 1;
                assert!(
                    found.missing.is_none() && found.roots[0].lambda.re >= mu - 1e-5,
                    "{b} {tau} {mu}: {found:?}"
                );
            }
        }
        assert!(tried > 100, "{tried}");
    }
}
