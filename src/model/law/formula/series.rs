//! The Taylor series of a formula along a motion: that of every node, grown term by term.
//!
//! A power that is not whole has no series at rest. There its terms are left out, on steps so short
//! that they do not matter, and steps grow from there with the distance from rest.

use super::disc::Disc;
use super::{Formula, Node};
use crate::model::ball::Ball;
use crate::model::elementary::{atan, cos, cosh, exp, ln, pow, sin, sinh, tanh};
use crate::model::law::{Series, discs};
use crate::model::series::{Coefficients, MOST_ORDER, PER_NEXT, product, spread};

/// What falls to 0 counts as at rest for a power from here on.
const NEAR_REST: f64 = 1e-10;
/// The shortest step from rest, in the motion's unit of time.
const SHORTEST: f64 = 1e-13;
/// Accelerations below this from rest may be noise; a step lasts some times until it is outgrown.
const NOISE: f64 = 1e-7;
const OUTLASTS: f64 = 8.0;
/// A step of powers changes their arguments by no more than this part of them.
const PART: f64 = 0.7;
/// A divisor above this may be of exponential growth.
const FAR: f64 = 1e6;
/// Steps are shortened by this factor.
const SHORTER: f64 = 0.75;

/// μ_K n with μ_K a formula of |ẋ|.
#[derive(Debug, Clone)]
pub(crate) struct FormulaSeries {
    formula: Formula,
    velocity_unit: f64,
    coefficients: Coefficients,
    /// The series of every node.
    of: Vec<Coefficients>,
    /// What a function needs besides: the cosine of a sine and the like, 1 − tanh², 1 + x² of atan,
    /// the inverse of what is divided by.
    beside: Vec<Coefficients>,
    /// The derivative of a function's argument.
    slope: Vec<Coefficients>,
    /// The powers that are at rest, a bit for each node.
    rest: u64,
}

/// Coefficient `k` ≥ 1 of f with f′ = b a′, where `slope` holds the coefficients of a′.
#[inline(always)]
fn integrated(slope: &Coefficients, b: &Coefficients, k: usize) -> f64 {
    product(slope, b, k - 1) * PER_NEXT[k - 1]
}

/// Σ_{j=1}^{k−1} j a_j b_{k−j}/k.
fn integrated_so_far(a: &Coefficients, b: &Coefficients, k: usize) -> f64 {
    let sum: f64 = (1..k).map(|j| j as f64 * a[j] * b[k - j]).sum();
    sum * PER_NEXT[k - 1]
}

impl FormulaSeries {
    pub(super) fn new(formula: &Formula, velocity_unit: f64) -> Self {
        let zero = [0.0; MOST_ORDER + 1];
        let zeros = vec![zero; formula.nodes.len()];
        Self {
            formula: formula.clone(),
            velocity_unit,
            coefficients: zero,
            beside: zeros.clone(),
            slope: zeros.clone(),
            of: zeros,
            rest: 0,
        }
    }

    /// Fills in the first coefficient of the node at `i`, and of what stands beside it.
    fn begin(&mut self, i: usize, speed: f64) {
        let at = |place: u8| self.of[usize::from(place)][0];
        let (own, beside) = match self.formula.nodes[i] {
            // A block that turns round can be a rounding beyond rest.
            Node::Linear(by, plus) => (by * speed.max(0.0) + plus, 0.0),
            Node::Affine(a, by, plus) => (by * at(a) + plus, 0.0),
            Node::Sum(a, b) => (at(a) + at(b), 0.0),
            Node::Difference(a, b) => (at(a) - at(b), 0.0),
            Node::Product(a, b) => (at(a) * at(b), 0.0),
            Node::Quotient(a, b) => (at(a) / at(b), 1.0 / at(b)),
            Node::Over(number, a) => (number / at(a), 1.0 / at(a)),
            Node::Power(a, exponent) => (pow(at(a), exponent), 0.0),
            Node::Exp(a, by) => (exp(by * at(a)), 0.0),
            Node::Ln(a) => (ln(at(a)), 0.0),
            Node::Sin(a) => (sin(at(a)), cos(at(a))),
            Node::Cos(a) => (cos(at(a)), sin(at(a))),
            Node::Sinh(a) => (sinh(at(a)), cosh(at(a))),
            Node::Cosh(a) => (cosh(at(a)), sinh(at(a))),
            Node::Tanh(a) => {
                let cosh = cosh(at(a));
                (tanh(at(a)), 1.0 / (cosh * cosh))
            }
            Node::Sech(a, _) => (1.0 / cosh(at(a)), 0.0),
            Node::Atan(a) => (atan(at(a)), 1.0 + at(a) * at(a)),
        };
        (self.of[i][0], self.beside[i][0]) = (own, beside);
    }

    /// Fills in coefficient `k` ≥ 1 of the node at `i`, and of what stands beside it.
    #[inline(always)]
    fn grow(&mut self, i: usize, k: usize, speed: f64) {
        let rests = self.rests(i);
        let (before, from) = self.of.split_at_mut(i);
        let (own, beside, slope) = (&mut from[0], &mut self.beside[i], &mut self.slope[i]);
        let at = |place: u8| &before[usize::from(place)];
        let mut steeper = |a: u8| slope[k - 1] = k as f64 * at(a)[k];
        // The sums below leave out what is multiplied by the coefficient looked for.
        own[k] = 0.0;
        own[k] = match self.formula.nodes[i] {
            Node::Linear(by, _) => by * speed,
            Node::Affine(a, by, _) => by * at(a)[k],
            Node::Sum(a, b) => at(a)[k] + at(b)[k],
            Node::Difference(a, b) => at(a)[k] - at(b)[k],
            Node::Product(a, b) => product(at(a), at(b), k),
            // Beyond all numbers a divisor leaves nothing.
            Node::Quotient(..) | Node::Over(..) if beside[0] == 0.0 => 0.0,
            Node::Quotient(a, b) => (at(a)[k] - product(at(b), own, k)) * beside[0],
            Node::Over(_, a) => -product(at(a), own, k) * beside[0],
            Node::Power(..) if rests => 0.0,
            Node::Power(a, exponent) => power(at(a), own, exponent, k),
            Node::Exp(a, by) => {
                slope[k - 1] = by * k as f64 * at(a)[k];
                integrated(slope, own, k)
            }
            Node::Ln(a) => (at(a)[k] - integrated_so_far(own, at(a), k)) / at(a)[0],
            Node::Sin(a) => {
                steeper(a);
                beside[k] = -integrated(slope, own, k);
                integrated(slope, beside, k)
            }
            Node::Cos(a) => {
                steeper(a);
                beside[k] = integrated(slope, own, k);
                -integrated(slope, beside, k)
            }
            Node::Sinh(a) | Node::Cosh(a) => {
                steeper(a);
                beside[k] = integrated(slope, own, k);
                integrated(slope, beside, k)
            }
            Node::Sech(a, tanh) => {
                steeper(a);
                beside[k - 1] = -product(slope, at(tanh), k - 1);
                integrated(beside, own, k)
            }
            Node::Tanh(a) => {
                steeper(a);
                let term = integrated(slope, beside, k);
                own[k] = term;
                beside[k] = -product(own, own, k);
                term
            }
            Node::Atan(a) => {
                beside[k] = product(at(a), at(a), k);
                (at(a)[k] - integrated_so_far(own, beside, k)) / beside[0]
            }
        };
    }

    fn rests(&self, i: usize) -> bool {
        self.rest >> i & 1 == 1
    }

    /// Whether the argument of a power is at rest or comes to it: it is 0, or nearly 0 and falls.
    /// Its first two coefficients are known.
    fn comes_to_rest(&self, argument: u8) -> bool {
        let of = &self.of[usize::from(argument)];
        of[0] <= 0.0 || (of[0] <= NEAR_REST && of[1] < 0.0)
    }

    /// Whether the first coefficients of a function may be small though later ones are not: far out
    /// on an exponential flank.
    fn hides(&self, node: Node, order: f64) -> bool {
        let at = |place: u8| self.of[usize::from(place)][0];
        match node {
            Node::Exp(a, by) => by * at(a) < -order,
            Node::Tanh(a) | Node::Sech(a, _) | Node::Atan(a) => at(a).abs() > order,
            Node::Over(_, a) | Node::Quotient(_, a) => at(a).abs() > FAR && at(a).is_finite(),
            Node::Linear(..) | Node::Affine(..) | Node::Sum(..) | Node::Difference(..) => false,
            Node::Product(..) | Node::Power(..) | Node::Ln(_) | Node::Sin(_) => false,
            Node::Cos(_) | Node::Sinh(_) | Node::Cosh(_) => false,
        }
    }

    /// The longest step, at most `length`, in which no argument of a power comes near to 0, where
    /// the power has no series.
    fn away_from_rest(&self, order: usize, mut length: f64) -> f64 {
        for node in self.formula.nodes.iter() {
            if let Node::Power(a, _) = node {
                let of = &self.of[usize::from(*a)][..=order];
                while of[0] > 0.0 && spread(of, length) > PART * of[0] {
                    length *= SHORTER;
                }
            }
        }
        length
    }

    /// The longest step from or to rest on which terms of powers may be left out. From rest they
    /// must not change friction by more than `error`. Before a stop what they change of the
    /// velocity counts.
    fn at_rest(&self, speed: &[f64], most: f64, error: f64) -> f64 {
        let from = speed[0].abs();
        let mut length = most;
        let shortest = shortest(speed).min(most);
        while length > shortest {
            let off = spread(speed, length);
            let (least, largest) = ((from - off).max(0.0), from + off);
            let around = Ball::between(least * self.velocity_unit, largest * self.velocity_unit);
            let change = 2.0 * self.formula.at(around).error;
            let counts = if from == 0.0 { 1.0 } else { length / most };
            if change * counts <= error {
                return length;
            }
            length *= SHORTER;
        }
        length.max(shortest)
    }
}

/// The shortest step from rest. Just released, a block may seem to be held by the noise of forces;
/// the step outlasts that.
fn shortest(speed: &[f64]) -> f64 {
    match speed {
        [0.0, pull, growth, ..] if pull.abs() < NOISE && pull * growth < 0.0 => {
            SHORTEST.max(OUTLASTS * (pull / growth).abs())
        }
        _ => SHORTEST,
    }
}

/// Coefficient `k` of a to the power `exponent`, of which the smaller ones are known.
fn power(a: &Coefficients, own: &Coefficients, exponent: f64, k: usize) -> f64 {
    let term = |j: usize| (exponent * j as f64 - (k - j) as f64) * a[j] * own[k - j];
    let sum: f64 = (1..=k).map(term).sum();
    sum * PER_NEXT[k - 1] / a[0]
}

impl Series for FormulaSeries {
    fn extend(&mut self, k: usize, speed: f64, load: &Coefficients) -> f64 {
        let speed = speed * self.velocity_unit;
        if k == 0 {
            self.rest = 0;
        }
        for i in 0..self.of.len() {
            if k == 0 {
                self.begin(i, speed);
                continue;
            }
            if let Node::Power(a, _) = self.formula.nodes[i]
                && k == 1
            {
                self.rest |= u64::from(self.comes_to_rest(a)) << i;
            }
            self.grow(i, k, speed);
        }
        let last = self.of.last().map_or(f64::NAN, |of| of[k]);
        // A motion at a speed without friction ends undecided.
        let is_there = k > 0 || last > 0.0;
        self.coefficients[k] = if is_there { last } else { f64::NAN };
        product(&self.coefficients, load, k)
    }

    /// By bounds on discs where a function's first coefficients do not tell how far they hold.
    fn resolved(&self, speed: &[f64], length: f64, error: f64) -> f64 {
        if !length.is_finite() {
            return length;
        }
        if self.rest != 0 {
            return self.at_rest(speed, length, error);
        }
        let order = speed.len() - 1;
        let length = self.away_from_rest(order - 1, length);
        let order = order as f64;
        let mut nodes = self.formula.nodes.iter();
        if !nodes.any(|node| self.hides(*node, order)) {
            return length;
        }
        let largest = |off: f64| {
            let disc = Disc(Ball {
                value: speed[0].abs() * self.velocity_unit,
                error: off * self.velocity_unit,
            });
            let Disc(found) = self.formula.at(disc);
            match found.is_known() {
                true => ln(found.error),
                false => f64::INFINITY,
            }
        };
        discs::resolved(speed, length, ln(error), largest)
    }
}
