//! All characteristic roots right of a vertical line, none missed.
//!
//! Starting values come from the branches of the logarithm. Where these do not lead to every root,
//! they come from D at small λτ, or else from collocation with as many nodes as it takes. Each is
//! polished, and duplicates are removed. The number of roots is then compared with the one by the
//! argument principle ([`super::certificate`]).

use num_complex::Complex64;

use super::branches::starting_values;
use super::cluster::{neighbours, taken_apart};
use super::collocation::{MOST_NODES, nodes_for};
use super::equation::Equation;
use super::newton::{Root, polish};
use crate::model::elementary::norm;
use crate::text::Shown;

/// The most attempts at collocation, each with more nodes than the one before.
const COLLOCATIONS: u32 = 3;
/// The largest |στ| at which terms with e^(−στ) neither overflow nor lose all digits.
const FARTHEST_LEFT: f64 = 700.0;

/// Between crowded roots a line is searched down to this relative distance, by at most so many
/// halvings.
const CROWDED: f64 = 1e-12;
const MOST_HALVINGS: u32 = 64;
/// How often a search goes back from a line so far left that rounding tells nothing there.
const MOST_RETREATS: u32 = 8;
/// How near to the line at which roots accumulate they are searched, in units of 1/τ.
const BESIDE_ESSENTIAL: f64 = 1e-6;
/// Within so many times that distance, no more halvings are made towards that line.
const CLOSE: f64 = 16.0;
/// How far from a cluster of nearly equal roots its number may be counted.
const FARTHEST_COUNT: f64 = 0.3;
/// Roots that are followed from one point to the next.
const FOLLOWED: usize = 4;
/// How far left of the rightmost one they are counted, relative.
const LEFT_OF_FOLLOWED: f64 = 1e-6;

/// Finds roots, keeping its memory from one point to the next.
///
/// ```
/// use slipmap::linear::spectrum::RootFinder;
/// use slipmap::model::Groups;
///
/// // Without control the roots are those of λ² + bλ + 1.
/// let abscissa = RootFinder::default().abscissa(Groups::new(-0.3, 0.0, 0.0), 1.0).unwrap();
/// assert!((abscissa - 0.15).abs() < 1e-12);
/// ```
#[derive(Debug, Clone, Default)]
pub struct RootFinder {
    starts: Vec<Complex64>,
    roots: Vec<Root>,
    /// Roots near which those of the next point are looked for.
    followed: Vec<Complex64>,
    /// How often the branches of the logarithm were not enough.
    pub collocations: u64,
    /// Steps of counts that a search has added up, to bound its work.
    pub(in crate::linear) steps: u64,
}

/// Some roots right of the line were not found, or one lies on it.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("not every characteristic root right of {} was found", Shown(*line))]
pub struct Incomplete {
    /// The line.
    pub line: f64,
}

impl RootFinder {
    /// Every root with Re λ > `line` and Im λ ≥ 0: by falling real part, among equal ones by rising
    /// imaginary part. A double root is listed twice.
    ///
    /// `tau` ≥ 0 in units of √(M/κ), `line` in their inverse.
    ///
    /// # Errors
    /// When roots are missing or one lies on the line within rounding.
    pub fn right_of(
        &mut self,
        equation: impl Equation,
        tau: f64,
        line: f64,
    ) -> Result<&[Root], Incomplete> {
        self.roots.clear();
        let incomplete = Incomplete { line };
        if tau == 0.0 || equation.uncontrolled() {
            self.starts.clear();
            let count = equation.without_delay(tau, &mut self.starts);
            self.polish_starts(equation, 0.0, line);
            self.complete(equation, 0.0, count);
            return Ok(&self.roots);
        }
        let count = equation.right_of(tau, line).ok_or(incomplete)?;
        starting_values(equation, tau, line, &mut self.starts);
        self.polish_starts(equation, tau, line);
        if self.complete(equation, tau, count) {
            return Ok(&self.roots);
        }
        self.starts.clear();
        equation.further_starts(tau, line, &mut self.starts);
        self.polish_starts(equation, tau, line);
        if self.complete(equation, tau, count) {
            return Ok(&self.roots);
        }
        let mut nodes = nodes_for(equation.memory_span(tau), equation.root_bound(tau, line))
            .ok_or(incomplete)?;
        self.collocations += 1;
        for _ in 0..COLLOCATIONS {
            self.starts = equation.eigenvalues(tau, nodes).ok_or(incomplete)?;
            self.polish_starts(equation, tau, line);
            if self.complete(equation, tau, count) {
                return Ok(&self.roots);
            }
            nodes += nodes / 2;
            if nodes > MOST_NODES {
                break;
            }
        }
        Err(incomplete)
    }

    /// The rightmost roots, at least `wanted` counted with multiplicity and pairs as two, ordered
    /// as by [`RootFinder::right_of`]; fewer where no more lie right of `leftmost`.
    ///
    /// # Errors
    /// When roots are missing.
    pub fn rightmost(
        &mut self,
        equation: impl Equation,
        tau: f64,
        wanted: u64,
        leftmost: f64,
    ) -> Result<&[Root], Incomplete> {
        let line = line_left_of(equation, tau, wanted, leftmost);
        self.right_of(equation, tau, line)
    }

    /// The real part of the rightmost root. Where the equation has changed little since the last
    /// call, the roots found then lead to it. A count proves that none lies farther right.
    ///
    /// # Errors
    /// When roots are missing.
    pub fn abscissa(&mut self, equation: impl Equation, tau: f64) -> Result<f64, Incomplete> {
        self.abscissa_up_to(equation, tau, f64::INFINITY)
    }

    /// The real part of the rightmost root or, where that is above `bound`, of any root above it:
    /// one that is followed there spares the count.
    ///
    /// # Errors
    /// When roots are missing.
    pub(in crate::linear) fn abscissa_up_to(
        &mut self,
        equation: impl Equation,
        tau: f64,
        bound: f64,
    ) -> Result<f64, Incomplete> {
        if let Some(found) = self.followed_abscissa(equation, tau, bound) {
            return Ok(found);
        }
        self.rightmost(equation, tau, FOLLOWED as u64, f64::NEG_INFINITY)?;
        self.follow();
        let first = self.roots.first().ok_or(Incomplete {
            line: f64::NEG_INFINITY,
        })?;
        Ok(first.lambda.re)
    }

    /// By the roots that are followed; none where they are not the rightmost ones, and none of them
    /// is above `bound`.
    fn followed_abscissa(&mut self, equation: impl Equation, tau: f64, bound: f64) -> Option<f64> {
        if self.followed.is_empty() || tau == 0.0 || equation.uncontrolled() {
            return None;
        }
        self.starts.clone_from(&self.followed);
        self.roots.clear();
        self.polish_starts(equation, tau, f64::NEG_INFINITY);
        self.follow();
        let Root { lambda, error } = *self.roots.first()?;
        if lambda.re - error > bound {
            return Some(lambda.re);
        }
        let line = lambda.re - LEFT_OF_FOLLOWED * (1.0 + lambda.re.abs()) - 16.0 * error;
        let count = equation.right_of(tau, line)?;
        self.roots.retain(|root| root.lambda.re > line);
        self.complete(equation, tau, count).then_some(lambda.re)
    }

    /// The rightmost of the roots found are followed from here on.
    fn follow(&mut self) {
        let rightmost = self.roots.iter().map(|root| root.lambda).take(FOLLOWED);
        self.followed.clear();
        self.followed.extend(rightmost);
    }

    /// Adds the roots to which the starting values lead, without duplicates, in order.
    fn polish_starts(&mut self, equation: impl Equation, tau: f64, line: f64) {
        for i in 0..self.starts.len() {
            let added = self.polish_start(equation, tau, line, self.starts[i]);
            if let Some(root) = added.filter(Root::nearly_multiple) {
                for neighbour in neighbours(equation, tau, root.lambda) {
                    self.polish_start(equation, tau, line, neighbour);
                }
            }
        }
        self.sort();
    }

    fn sort(&mut self) {
        self.roots.sort_by(|p, q| {
            let by_real = q.lambda.re.total_cmp(&p.lambda.re);
            by_real.then(p.lambda.im.total_cmp(&q.lambda.im))
        });
    }

    /// Adds the root to which `start` leads, if it is a new one, and returns it.
    fn polish_start(
        &mut self,
        equation: impl Equation,
        tau: f64,
        line: f64,
        start: Complex64,
    ) -> Option<Root> {
        let root = polish(equation, tau, start)?;
        let known = self.roots.iter().any(|r| {
            let apart = 8.0 * (r.error + root.error) + 1e-12 * (1.0 + norm(root.lambda));
            norm(r.lambda - root.lambda) <= apart
        });
        if known || root.lambda.re <= line {
            return None;
        }
        self.roots.push(root);
        Some(root)
    }

    /// Whether the number of roots found is `count`. Where rounding hardly tells roots apart, their
    /// number is that counted around them.
    fn complete(&mut self, equation: impl Equation, tau: f64, count: u64) -> bool {
        let number = |roots: &[Root]| roots.iter().map(Root::count).sum::<u64>();
        if number(&self.roots) == count {
            return true;
        }
        let cluster: Vec<Root> = self
            .roots
            .iter()
            .copied()
            .filter(Root::nearly_multiple)
            .collect();
        let (Some(first), Some(last)) = (cluster.first(), cluster.last()) else {
            return false;
        };
        let error = cluster.iter().map(|r| r.error).fold(0.0, f64::max);
        let range = (last.lambda.re, first.lambda.re);
        let Some((strip, counted)) = count_between(equation, tau, range, error) else {
            return false;
        };
        let beside = self
            .roots
            .iter()
            .filter(|r| !r.nearly_multiple() && strip.0 < r.lambda.re && r.lambda.re < strip.1);
        let Some(together) = counted.checked_sub(beside.map(Root::count).sum()) else {
            return false;
        };
        if number(&self.roots) + together != count + number(&cluster) {
            return false;
        }
        let extent = norm(first.lambda - last.lambda);
        let place = self
            .roots
            .iter()
            .position(Root::nearly_multiple)
            .unwrap_or(0);
        self.roots.retain(|r| !r.nearly_multiple());
        if let Some(apart) = taken_apart(equation, tau, &cluster, together) {
            self.roots.extend(apart);
        } else {
            for (i, root) in some_of(&cluster, together).enumerate() {
                let error = root.error.max(extent);
                self.roots.insert(place + i, Root { error, ..root });
            }
        }
        self.sort();
        true
    }
}

/// A strip of real parts around a range, as narrow as rounding (`error`) allows, and the number of
/// roots in it.
fn count_between(
    equation: impl Equation,
    tau: f64,
    (from, to): (f64, f64),
    error: f64,
) -> Option<((f64, f64), u64)> {
    let mut near = 16.0 * error;
    while near <= FARTHEST_COUNT {
        let strip = (from - near, to + near);
        let right = equation.right_of(tau, strip.1);
        let left = equation.right_of(tau, strip.0);
        if let (Some(right), Some(left)) = (right, left) {
            return Some((strip, left.checked_sub(right)?));
        }
        near *= 4.0;
    }
    None
}

/// Roots of `cluster` that stand for `number` roots: its own, repeated or cut off, the last one
/// real if that is needed.
fn some_of(cluster: &[Root], number: u64) -> impl Iterator<Item = Root> {
    let mut left = number;
    cluster
        .iter()
        .cycle()
        .map_while(move |root| {
            let mut root = *root;
            if left == 1 {
                root.lambda.im = 0.0;
            }
            left = left.checked_sub(root.count())?;
            Some(root)
        })
        .collect::<Vec<_>>()
        .into_iter()
}

/// A little right of where roots accumulate; −∞ where they do not.
fn beside_essential(equation: impl Equation, tau: f64) -> f64 {
    equation.essential_abscissa(tau) + BESIDE_ESSENTIAL / tau
}

/// A line with at least `wanted` roots to its right and few more; at or a little right of
/// `leftmost` where there are fewer.
fn line_left_of(equation: impl Equation, tau: f64, wanted: u64, leftmost: f64) -> f64 {
    if tau == 0.0 || equation.uncontrolled() {
        return f64::NEG_INFINITY;
    }
    let leftmost = leftmost
        .max(-FARTHEST_LEFT / equation.memory_span(tau))
        .max(beside_essential(equation, tau));
    let accumulating = equation.essential_abscissa(tau).is_finite();
    // The line itself may hit a root; its neighbours then do not.
    let count = |line: f64| {
        [0.0, 1e-3, -1.7e-3]
            .into_iter()
            .map(|shift| line + shift * (1e-3 + line.abs()))
            .find_map(|line| equation.right_of(tau, line).map(|n| (line, n)))
    };
    let (mut left, mut right) = (0.0, equation.root_bound(0.0, 0.0));
    let mut step = 0.5_f64.min(1.0 / tau);
    let (mut enough, mut known, mut retreats) = (None, 0, 0);
    loop {
        match count(left) {
            Some((line, n)) if n >= wanted => {
                enough = Some((line, n));
                break;
            }
            // So far left rounding tells nothing, and nothing is known farther right.
            None if left < 0.0 && known == 0 && retreats < MOST_RETREATS => {
                retreats += 1;
                left = right.min(0.0) + 0.25 * (left - right.min(0.0));
                step = 0.5 * (right.min(0.0) - left);
                continue;
            }
            None if left < 0.0 => break,
            _ if left <= leftmost => break,
            Some((_, n)) => known = n,
            None => {}
        }
        right = left;
        // Near the line at which roots accumulate there are too many right of a line.
        let halfway = 0.5 * (left + leftmost);
        let close = !accumulating || left - leftmost <= CLOSE * BESIDE_ESSENTIAL / tau;
        left = (left - step).max(if close { leftmost } else { halfway });
        step *= 2.0;
    }
    let Some((mut line, mut n)) = enough else {
        return count(right).map_or(right, |(line, _)| line);
    };
    for _ in 0..MOST_HALVINGS {
        if n <= wanted + 2 || right - line <= CROWDED * (1.0 + line.abs()) {
            break;
        }
        match count(0.5 * (line + right)) {
            Some((middle, at_middle)) if at_middle >= wanted => (line, n) = (middle, at_middle),
            Some((middle, _)) => right = middle,
            None => break,
        }
    }
    line
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Groups;

    /// Both ways to starting values lead to the same roots.
    #[test]
    fn branches_and_collocation_agree() {
        let mut finder = RootFinder::default();
        for i in 0..300 {
            let t = f64::from(i);
            let groups = Groups::new(
                (t * 0.7).sin() - 0.7,
                2.0 * (t * 1.3).sin(),
                5.0 * (t * 2.1).sin() - 3.0,
            );
            let tau = 6.0 * (1.01 + (t * 0.37).sin());
            let roots = finder
                .rightmost(groups, tau, 6, f64::NEG_INFINITY)
                .expect("complete")
                .to_vec();
            let radius = roots.iter().map(|r| r.lambda.norm()).fold(1.0, f64::max);
            let nodes = 2 * nodes_for(tau, radius).expect("short delays");
            let eigenvalues = groups.eigenvalues(tau, nodes).expect("converges");
            for root in roots {
                let nearest = |z: &Complex64| (root.lambda - z).norm();
                let nearest = eigenvalues
                    .iter()
                    .map(nearest)
                    .fold(f64::INFINITY, f64::min);
                assert!(nearest < 1e-5, "{groups:?} {tau}: {root:?} {nearest}");
            }
        }
    }

    #[test]
    fn double_roots_stand_twice() {
        let mut finder = RootFinder::default();
        // (λ + 1)², without control.
        let roots = finder
            .right_of(Groups::new(2.0, 0.0, 0.0), 1.0, -3.0)
            .expect("complete");
        assert_eq!(roots.iter().map(Root::count).sum::<u64>(), 2);
    }
}
