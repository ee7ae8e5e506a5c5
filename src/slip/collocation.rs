//! A step by collocation: the rates of ẋ and a at Chebyshev's nodes, from the friction law itself,
//! by Picard's iteration.
//!
//! A second method for [`super::motion`], to check the first one. It shares the equations and the
//! events with Taylor's method, and nothing of how a step is made. It uses no coefficients of the
//! law and no radius of convergence, and its steps follow the law's own scale of speed. It is some
//! ten times slower.
//!
//! With M nodes s_i of a step of length h, u̇ and ȧ are the polynomials of degree M − 1 through
//! their values at the nodes, and
//!
//! ```text
//! u(s_i) = u(0) + h Σ_j Q_ij u̇(s_j),     a(s_i) = a(0) + h Σ_j Q_ij ȧ(s_j)
//! ```
//!
//! Source: C. W. Clenshaw and H. J. Norton, Comput. J. 6 (1963) 88.

use crate::model::elementary::{cos, power};
use std::f64::consts::PI;
use std::sync::LazyLock;

use crate::model::series::{Coefficients, MOST_ORDER, PER_NEXT, value};

/// The number of nodes, which is the order of the polynomials of u and a.
pub(super) const NODES: usize = 12;
/// The most iterations of a step, and the change at which they end, relative to the size of the
/// motion.
const MOST_ITERATIONS: u32 = 60;
const AT_REST: f64 = 2e-16;

type Matrix = [[f64; NODES]; NODES];

/// Constants that depend on the nodes alone.
struct Rule {
    /// The nodes, in units of the length of the step.
    nodes: [f64; NODES],
    /// Q: from values at the nodes to integrals from 0 to the nodes.
    integrals: Matrix,
    /// From values at the nodes to coefficients of powers of s/h.
    powers: Matrix,
    /// From values at the nodes to the last two coefficients of Chebyshev's polynomials.
    tail: [[f64; NODES]; 2],
    /// From values at the nodes to all coefficients of Chebyshev's polynomials, and from these to
    /// coefficients of powers of s/h.
    chebyshev: Matrix,
    shifted: Matrix,
}

static RULE: LazyLock<Rule> = LazyLock::new(Rule::new);

impl Rule {
    fn new() -> Self {
        let m = NODES as f64;
        let angle = |i: usize| PI * (i as f64 + 0.5) / m;
        let nodes = std::array::from_fn(|i| 0.5 * (1.0 + cos(angle(i))));
        // Coefficient k of Chebyshev's polynomials, from the value at node i.
        let chebyshev = |k: usize, i: usize| {
            let whole = if k == 0 { 1.0 } else { 2.0 };
            whole / m * cos(k as f64 * angle(i))
        };
        let shifted = shifted_chebyshev();
        let powers: Matrix = std::array::from_fn(|p| {
            std::array::from_fn(|i| (0..NODES).map(|k| shifted[k][p] * chebyshev(k, i)).sum())
        });
        let integrals = std::array::from_fn(|to| {
            let node: f64 = nodes[to];
            std::array::from_fn(|i| {
                let term = |p: usize| powers[p][i] * PER_NEXT[p] * power(node, p as i32 + 1);
                (0..NODES).map(term).sum()
            })
        });
        let tail = [NODES - 2, NODES - 1].map(|k| std::array::from_fn(|i| chebyshev(k, i)));
        Self {
            nodes,
            integrals,
            powers,
            tail,
            chebyshev: std::array::from_fn(|k| std::array::from_fn(|i| chebyshev(k, i))),
            shifted,
        }
    }
}

/// Coefficients of Chebyshev's polynomials on [0, 1]: T₀ = 1, T₁ = 2x − 1, T_{k+1} = 2 (2x − 1) T_k
/// − T_{k−1}.
fn shifted_chebyshev() -> Matrix {
    let mut t = [[0.0; NODES]; NODES];
    t[0][0] = 1.0;
    (t[1][0], t[1][1]) = (-1.0, 2.0);
    for k in 1..NODES - 1 {
        for p in 0..NODES {
            let lower = if p > 0 { 4.0 * t[k][p - 1] } else { 0.0 };
            t[k + 1][p] = lower - 2.0 * t[k][p] - t[k - 1][p];
        }
    }
    t
}

fn dot(row: &[f64; NODES], values: &[f64; NODES]) -> f64 {
    row.iter().zip(values).map(|(r, v)| r * v).sum()
}

/// The last coefficients of a Chebyshev series are dropped below this, relative to the largest
/// value. As powers of s/h they would be rounding a million times as large.
const OF_ROUNDING: f64 = 4.0 * f64::EPSILON;

/// The coefficients of powers of s/h of the polynomial through values at the nodes, without
/// Chebyshev terms that are rounding alone.
fn rounded_off(rule: &Rule, values: &[f64; NODES]) -> [f64; NODES] {
    let size = values.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
    let series = rule.chebyshev.map(|row| dot(&row, values));
    let order = series.iter().rposition(|c| c.abs() > OF_ROUNDING * size);
    let terms = order.map_or(0, |order| order + 1);
    std::array::from_fn(|p| (0..terms).map(|k| rule.shifted[k][p] * series[k]).sum())
}

/// A step that was solved.
#[derive(Debug, Clone, Copy)]
pub(super) struct Solved {
    /// The coefficients of ẋ and of a, of the time since the step's start.
    pub u: Coefficients,
    pub a: Coefficients,
    /// The size of the last terms of Chebyshev's series of the rates, times the length: an estimate
    /// of the error of the polynomials.
    pub rest: f64,
}

/// The step of `length` from ẋ = `u`, a = `a`. `rates` gives u̇ and ȧ from the time since then, ẋ,
/// a and the delayed elongation, whose polynomial is `delayed`. With `rounds_off`, terms that are
/// rounding alone are left out. None where the iteration does not converge.
pub(super) fn solve(
    (u, a): (f64, f64),
    length: f64,
    (delayed, rounds_off): (&[f64], bool),
    rates: impl Fn(f64, f64, f64, f64) -> (f64, f64),
) -> Option<Solved> {
    let rule = &*RULE;
    let past: [f64; NODES] = rule.nodes.map(|node| value(delayed, node * length));
    let (mut at_u, mut at_a) = ([u; NODES], [a; NODES]);
    let (mut rate_u, mut rate_a) = ([0.0; NODES], [0.0; NODES]);
    let scale = 1.0 + u.abs() + a.abs();
    for iteration in 0.. {
        for i in 0..NODES {
            (rate_u[i], rate_a[i]) = rates(rule.nodes[i] * length, at_u[i], at_a[i], past[i]);
        }
        let mut change = 0.0_f64;
        for (i, row) in rule.integrals.iter().enumerate() {
            let next = [
                u + length * dot(row, &rate_u),
                a + length * dot(row, &rate_a),
            ];
            change = change
                .max((next[0] - at_u[i]).abs())
                .max((next[1] - at_a[i]).abs());
            [at_u[i], at_a[i]] = next;
        }
        if change <= AT_REST * scale {
            break;
        }
        if iteration == MOST_ITERATIONS || !change.is_finite() {
            // Rounding can keep the change above AT_REST for ever.
            if change > 64.0 * AT_REST * scale || change.is_nan() {
                return None;
            }
            break;
        }
    }
    Some(solved((u, a), length, (&rate_u, &rate_a), rounds_off))
}

fn solved(
    (u, a): (f64, f64),
    length: f64,
    (rate_u, rate_a): (&[f64; NODES], &[f64; NODES]),
    rounds_off: bool,
) -> Solved {
    let rule = &*RULE;
    let series = |start: f64, rates: &[f64; NODES]| {
        let mut c = [0.0; MOST_ORDER + 1];
        c[0] = start;
        let mut scale = 1.0;
        let powers = match rounds_off {
            true => rounded_off(rule, rates),
            false => std::array::from_fn(|p| dot(&rule.powers[p], rates)),
        };
        for (p, power) in powers.into_iter().enumerate() {
            c[p + 1] = power * PER_NEXT[p] * scale;
            scale /= length;
        }
        c
    };
    let tails = rule
        .tail
        .iter()
        .flat_map(|row| [dot(row, rate_u), dot(row, rate_a)]);
    Solved {
        u: series(u, rate_u),
        a: series(a, rate_a),
        rest: length * tails.map(f64::abs).fold(0.0, f64::max),
    }
}

/// The polynomial over a step of `length` through the values of a function at the nodes, and the
/// size of the last terms of Chebyshev's series.
pub(super) fn fit(length: f64, function: impl Fn(f64) -> f64) -> (Coefficients, f64) {
    let rule = &*RULE;
    let values = rule.nodes.map(|node| function(node * length));
    let mut c = [0.0; MOST_ORDER + 1];
    let mut scale = 1.0;
    for (c, power) in c.iter_mut().zip(rounded_off(rule, &values)) {
        *c = power * scale;
        scale /= length;
    }
    let tails = rule.tail.iter().map(|row| dot(row, &values).abs());
    (c, tails.fold(0.0, f64::max))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_harmonic_oscillation_is_solved() {
        // u̇ = a − d, ȧ = −u with d = 0.3 + 0.1 s.
        let solved = solve((0.2, 0.5), 0.5, (&[0.3, 0.1], false), |_, u, a, d| {
            (a - d, -u)
        })
        .unwrap();
        for s in [0.0, 0.1, 0.37, 0.5_f64] {
            // ä = −(a − d): a = d + A cos s + B sin s, ȧ(0) = 0.1 + B = −0.2.
            let (cos, sin) = (s.cos(), s.sin());
            let a = 0.3 + 0.1 * s + 0.2 * cos - 0.3 * sin;
            let u = -0.1 + 0.2 * sin + 0.3 * cos;
            let off = [value(&solved.a, s) - a, value(&solved.u, s) - u];
            // Powers of s lose five digits of what is known at the nodes.
            assert!(off.iter().all(|off| off.abs() < 1e-10), "{off:?} at {s}");
        }
        assert!(solved.rest < 1e-11, "{:e}", solved.rest);
    }

    /// y′ = −y² from 1 is 1/(1 + s). The rest falls with the length as its order says.
    #[test]
    fn the_rest_falls_with_the_length() {
        let error = |length: f64| {
            let solved = solve((1.0, 0.0), length, (&[0.0], false), |_, u, _, _| {
                (-u * u, 0.0)
            })
            .unwrap();
            let off = (value(&solved.u, length) - 1.0 / (1.0 + length)).abs();
            assert!(
                off <= 10.0 * solved.rest + 1e-15,
                "{length}: {off:e} {:e}",
                solved.rest
            );
            solved.rest
        };
        let order = (error(0.8) / error(0.4)).log2();
        assert!((8.0..14.0).contains(&order), "{order}");
    }

    #[test]
    fn what_does_not_come_to_rest_is_not_solved() {
        assert!(solve((1.0, 0.0), 20.0, (&[0.0], false), |_, u, _, _| (u * u, 0.0)).is_none());
    }
}
