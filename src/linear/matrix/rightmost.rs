//! The rightmost roots of a system of matrices, with their number counted.
//!
//! Collocation of the delayed signals gives starts, Newton's method on det M makes them sharp. A
//! count right of a line, by the crossings of the shifted system, tells whether one is missing;
//! that is then found by halving, between lines of different counts, and by the frequencies at
//! which the shifted system has a root on its axis.

use std::f64::consts::TAU;

use num_complex::Complex64;

use super::MatrixSystem;
use crate::linear::collocation::{derivative, eigenvalues_of_real};
use crate::linear::count::MarginalTolerance;
use crate::linear::line::Line;
use crate::linear::newton::{Root, divide};
use crate::model::elementary::{exp, ln, norm, sincos};

/// Nodes of collocation, and the most rows of its matrix.
const NODES: usize = 24;
const MOST_OF_COLLOCATION: usize = 160;
/// Steps of Newton's method.
const MOST_STEPS: u32 = 60;
/// How many starts are tried for each root that is wanted.
const STARTS: usize = 6;
/// Halvings between two lines of different counts.
const HALVINGS: u32 = 44;
/// How often roots that are missing are looked for.
const MOST_SEARCHES: usize = 12;
/// How far left of the last root a line is drawn, relative.
const LEFT_OF: f64 = 1e-7;
/// Points of a circle around a root on which others are counted.
const ON_CIRCLE: u32 = 16;
/// The largest |στ| of a line.
const FARTHEST: f64 = 600.0;
/// How near to the line at which roots accumulate they are told from it, in units of 1/τ.
pub(super) const BESIDE: f64 = 1e-9;

impl MatrixSystem {
    /// The root to which Newton's method leads from `start` at the delay `tau`; none where it does
    /// not converge.
    pub(super) fn polish(&self, tau: f64, start: Complex64) -> Option<Root> {
        let root = self.polish_from(tau, start)?;
        if root.lambda.im != 0.0 && root.lambda.im.abs() <= 4.0 * root.error {
            let real = self.polish_from(tau, Complex64::new(root.lambda.re, 0.0));
            let same = |of: &Root| norm(of.lambda - root.lambda) <= 16.0 * root.error;
            return Some(real.filter(same).unwrap_or(root));
        }
        Some(root)
    }

    fn polish_from(&self, tau: f64, start: Complex64) -> Option<Root> {
        let (mut lambda, mut last) = (start, f64::INFINITY);
        for _ in 0..MOST_STEPS {
            let slopes = self.slopes(lambda, delayed(lambda, tau)?)?;
            let slope = slopes.along_lambda - tau * slopes.along_z;
            let step = divide(Complex64::ONE, slope);
            let (size, error) = (norm(step), slopes.rounding / norm(slope));
            if !size.is_finite() {
                return None;
            }
            let small = size <= 1e-6 * norm(lambda) && size >= 0.5 * last;
            if size <= error || size <= f64::EPSILON * norm(lambda) || small {
                return Some(Root {
                    lambda: Complex64::new(lambda.re, lambda.im.abs()),
                    error: error.max(size) + f64::EPSILON * norm(lambda),
                });
            }
            lambda -= step;
            last = size;
        }
        None
    }

    /// The number of roots right of Re λ = `line` at the delay `tau`, by the crossings of the
    /// shifted system; none where it is undecided or infinite.
    pub(super) fn number_right_of(&self, tau: f64, line: f64) -> Option<u64> {
        let delays = self.shifted(line, tau)?.line();
        let count = Line::count(&delays, tau, MarginalTolerance::default())?;
        (!count.marginal).then_some(count.n_unstable)
    }

    /// How many roots lie around `root`, found alone within `near`: the mean of (μ − λ) D′/D on a
    /// circle.
    fn multiplicity(&self, tau: f64, root: &Root, near: f64) -> Option<usize> {
        let mut sum = Complex64::ZERO;
        for i in 0..ON_CIRCLE {
            let (sine, cosine) = sincos(TAU * f64::from(i) / f64::from(ON_CIRCLE));
            let offset = near * Complex64::new(cosine, sine);
            let lambda = root.lambda + offset;
            let slopes = self.slopes(lambda, delayed(lambda, tau)?)?;
            sum += offset * (slopes.along_lambda - tau * slopes.along_z);
        }
        let mean = sum / f64::from(ON_CIRCLE);
        let whole = mean.re.round();
        (norm(mean - whole) < 0.1 && whole >= 1.0).then_some(whole as usize)
    }

    /// Repeats roots that stand for several equal ones.
    fn repeat_roots(&self, tau: f64, found: &mut Vec<Root>) {
        for root in found.clone() {
            let others = found.iter().map(|of| norm(of.lambda - root.lambda));
            let apart = others.filter(|apart| *apart > 0.0);
            let unit = 1e-3 * self.bound();
            let near = 0.25 * apart.fold(unit, f64::min);
            let real = root.lambda.im == 0.0 || root.lambda.im > 2.0 * near;
            if near > 8.0 * root.error && real {
                let number = self.multiplicity(tau, &root, near).unwrap_or(1);
                found.extend((1..number).map(|_| root));
            }
        }
        sort(found);
    }

    /// Approximate roots at the delay `tau` > 0 by collocation of the delayed signals.
    fn collocated(&self, tau: f64) -> Option<Vec<Complex64>> {
        let (n, k) = (self.states(), self.signals());
        let nodes = NODES.min((MOST_OF_COLLOCATION - n) / k.max(1)).max(6);
        let derivatives: Vec<f64> = (0..=nodes)
            .flat_map(|row| (0..=nodes).map(move |column| derivative(nodes, row, column, tau)))
            .collect();
        let of = |row: usize, column: usize| derivatives[row * (nodes + 1) + column];
        // After the states the signals at each node but the first: there they are C x + D w(−τ).
        eigenvalues_of_real(n + nodes * k, |i, j| {
            let place = |index: usize| (1 + (index - n) / k, (index - n) % k);
            match (i < n, j < n) {
                (true, true) => self.a.at(i, j),
                (true, false) => match place(j) {
                    (node, signal) if node == nodes => self.b.at(i, signal),
                    _ => 0.0,
                },
                (false, true) => {
                    let (row, signal) = place(i);
                    of(row, 0) * self.c.at(signal, j)
                }
                (false, false) => {
                    let ((row, signal), (node, other)) = (place(i), place(j));
                    let own = if signal == other { of(row, node) } else { 0.0 };
                    let last = node == nodes;
                    own + if last {
                        of(row, 0) * self.d.at(signal, other)
                    } else {
                        0.0
                    }
                }
            }
        })
    }

    /// The real part at which roots accumulate, −∞ where they do not.
    pub(super) fn essential_abscissa(&self, tau: f64) -> f64 {
        let radius = self.neutral_radius();
        if tau > 0.0 && radius > 0.0 {
            ln(radius) / tau
        } else {
            f64::NEG_INFINITY
        }
    }

    /// The `wanted` rightmost roots, pairs counted once, and whether one may be missing.
    pub(super) fn rightmost(&self, tau: f64, wanted: usize) -> (Vec<Root>, bool) {
        let mut found: Vec<Root> = Vec::new();
        let starts = if tau > 0.0 && self.signals() > 0 {
            self.collocated(tau)
        } else {
            self.without_delay()
        };
        for start in starts
            .unwrap_or_default()
            .into_iter()
            .take(STARTS * (wanted + 1))
        {
            self.add(tau, start, &mut found);
        }
        let all = tau == 0.0 || self.signals() == 0;
        let mut repeated = false;
        for _ in 0..MOST_SEARCHES {
            let line = match found.get(wanted - 1).or(found.last().filter(|_| all)) {
                Some(Root { lambda, error }) => {
                    lambda.re - LEFT_OF * norm(*lambda).max(1.0 / tau.max(1.0)) - 16.0 * error
                }
                None => self.farther_left(tau, &found),
            };
            match self.number_right_of(tau, line) {
                Some(number) if number == number_beyond(&found, line) => {
                    let complete = found.len() >= wanted || all;
                    found.truncate(wanted);
                    return (found, complete);
                }
                Some(_) => {}
                None => return (found, false),
            }
            let before = found.len();
            if !std::mem::replace(&mut repeated, true) {
                self.repeat_roots(tau, &mut found);
                if found.len() > before {
                    continue;
                }
            }
            for start in self.starts_of_missing(tau, line, &found) {
                self.add(tau, start, &mut found);
            }
            if found.len() == before {
                break;
            }
        }
        found.truncate(wanted);
        (found, false)
    }

    /// A line left of all roots that were found.
    fn farther_left(&self, tau: f64, found: &[Root]) -> f64 {
        let unit = 1.0 / tau;
        let last = found.last().map_or(unit, |root| root.lambda.re);
        (last - 2.0 * unit)
            .max(-FARTHEST * unit)
            .max(self.essential_abscissa(tau) + BESIDE * unit)
    }

    /// Adds the root to which `start` leads, if it is a new one; roots are kept by falling real
    /// part.
    fn add(&self, tau: f64, start: Complex64, found: &mut Vec<Root>) {
        let Some(root) = self.polish(tau, start) else {
            return;
        };
        let known = |of: &Root| {
            let apart = 8.0 * (of.error + root.error) + 1e-12 * norm(root.lambda);
            norm(of.lambda - root.lambda) <= apart
        };
        if found.iter().any(known) {
            return;
        }
        found.push(root);
        sort(found);
    }

    /// Starts near the rightmost root right of `line` that is not among those found.
    fn starts_of_missing(&self, tau: f64, line: f64, found: &[Root]) -> Vec<Complex64> {
        let unit = 1.0 / tau.max(f64::MIN_POSITIVE);
        let first = found.first().map_or(line, |root| root.lambda.re.max(line));
        let (mut low, mut width) = (line, unit.min(self.bound()));
        let mut high = first + width;
        while self
            .number_right_of(tau, high)
            .is_none_or(|number| number > 0)
        {
            width *= 2.0;
            high = first + width;
            if !(high * tau).is_finite() || high * tau > FARTHEST || width > 64.0 * self.bound() {
                break;
            }
        }
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            match self.number_right_of(tau, middle) {
                Some(number) if number == number_beyond(found, middle) => high = middle,
                _ => low = middle,
            }
            if high - low <= LEFT_OF * high.abs().max(LEFT_OF * unit) {
                break;
            }
        }
        let middle = 0.5 * (low + high);
        let mut starts = vec![Complex64::new(middle, 0.0)];
        if let Some(on_axis) = self
            .shifted(middle, tau)
            .and_then(|moved| moved.on_axis(&|_| false))
        {
            let at = on_axis.junctions.iter();
            starts.extend(at.map(|of| Complex64::new(middle, of.omega)));
        }
        starts
    }
}

/// Puts roots in order: by falling real part, among equal ones by rising imaginary part.
fn sort(found: &mut [Root]) {
    found.sort_by(|one, other| {
        let by_real = other.lambda.re.total_cmp(&one.lambda.re);
        by_real.then(one.lambda.im.total_cmp(&other.lambda.im))
    });
}

/// The number of the roots found that lie right of `line`.
fn number_beyond(found: &[Root], line: f64) -> u64 {
    let right = found.iter().filter(|root| root.lambda.re > line);
    right.map(Root::count).sum()
}

/// e^(−λτ); none where it overflows.
pub(super) fn delayed(lambda: Complex64, tau: f64) -> Option<Complex64> {
    let size = exp(-lambda.re * tau);
    let (sine, cosine) = sincos(lambda.im * tau);
    size.is_finite()
        .then(|| Complex64::new(size * cosine, -size * sine))
}
