//! A law that is a formula in the speed.
//!
//! A formula is a list of nodes, each the speed or an operation on nodes before it; the last one is
//! μ_K. The same list gives the value, slope and curvature at a speed, their bounds over an
//! interval, and the series along a motion with bounds on discs.
//!
//! - `builder`: makes a formula, with all that does not depend on the speed worked out
//! - `disc`: complex numbers within a radius of a real one
//! - `number`: what a formula is evaluated with
//! - `series`: its Taylor series along a motion

mod builder;
mod disc;
mod number;
mod series;

use std::sync::Arc;

pub(crate) use builder::{Builder, Operand};
use number::{Jet, Number};
pub(crate) use series::FormulaSeries;

use super::{FrictionLaw, Kind, Law, Range, checked_at_rest};
use crate::model::ModelError;
use crate::model::ball::Ball;
use crate::model::elementary::pow;
use crate::model::series::{Coefficients, MOST_ORDER};

/// The most nodes of a formula.
pub(crate) const MOST_NODES: usize = 64;
/// The parts of an interval on which bounds are taken.
const PARTS: u32 = 64;
/// What coefficients are allowed to be, for a message.
const POSITIVE: &str = "finite and greater than 0 at every speed";
const FINITE: &str = "finite at every speed above 0";
/// The terms of a formula's series in the speed that tell its scale.
const OF_SCALE: usize = 8;

/// A node of a formula. Operands are the places of nodes before it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Node {
    /// The speed v ≥ 0 times the first number, plus the second.
    Linear(f64, f64),
    /// A node times the first number, plus the second.
    Affine(u8, f64, f64),
    Sum(u8, u8),
    Difference(u8, u8),
    Product(u8, u8),
    Quotient(u8, u8),
    /// A number over a node.
    Over(f64, u8),
    /// A power with an exponent that is not whole: whole ones are products.
    Power(u8, f64),
    /// e to a node times a number.
    Exp(u8, f64),
    Ln(u8),
    Sin(u8),
    Cos(u8),
    Sinh(u8),
    Cosh(u8),
    Tanh(u8),
    /// 1/cosh of a node, of which the other is tanh.
    Sech(u8, u8),
    Atan(u8),
}

/// A formula with the values of its parameters.
#[derive(Debug, Clone, PartialEq)]
pub struct Formula {
    nodes: Arc<[Node]>,
}

impl Node {
    /// The nodes on which it operates.
    fn operands(self) -> [Option<u8>; 2] {
        match self {
            Self::Linear(..) => [None, None],
            Self::Sum(a, b) | Self::Difference(a, b) | Self::Product(a, b) => [Some(a), Some(b)],
            Self::Quotient(a, b) | Self::Sech(a, b) => [Some(a), Some(b)],
            Self::Affine(a, ..) | Self::Over(_, a) | Self::Power(a, _) => [Some(a), None],
            Self::Exp(a, _) | Self::Ln(a) | Self::Sin(a) | Self::Cos(a) => [Some(a), None],
            Self::Sinh(a) | Self::Cosh(a) | Self::Tanh(a) | Self::Atan(a) => [Some(a), None],
        }
    }

    /// This operation on nodes at other places.
    fn moved(self, to: impl Fn(u8) -> u8) -> Self {
        match self {
            Self::Linear(..) => self,
            Self::Affine(a, by, plus) => Self::Affine(to(a), by, plus),
            Self::Sum(a, b) => Self::Sum(to(a), to(b)),
            Self::Difference(a, b) => Self::Difference(to(a), to(b)),
            Self::Product(a, b) => Self::Product(to(a), to(b)),
            Self::Quotient(a, b) => Self::Quotient(to(a), to(b)),
            Self::Over(number, a) => Self::Over(number, to(a)),
            Self::Power(a, exponent) => Self::Power(to(a), exponent),
            Self::Exp(a, by) => Self::Exp(to(a), by),
            Self::Ln(a) => Self::Ln(to(a)),
            Self::Sin(a) => Self::Sin(to(a)),
            Self::Cos(a) => Self::Cos(to(a)),
            Self::Sinh(a) => Self::Sinh(to(a)),
            Self::Cosh(a) => Self::Cosh(to(a)),
            Self::Tanh(a) => Self::Tanh(to(a)),
            Self::Sech(a, b) => Self::Sech(to(a), to(b)),
            Self::Atan(a) => Self::Atan(to(a)),
        }
    }
}

fn affine<T: Number>(of: T, by: f64, plus: f64) -> T {
    of.times(T::of(by)).plus(T::of(plus))
}

impl Formula {
    /// Its value at a speed.
    fn at<T: Number>(&self, speed: T) -> T {
        let mut values = [T::of(0.0); MOST_NODES];
        let mut last = T::of(0.0);
        for (i, node) in self.nodes.iter().enumerate().take(MOST_NODES) {
            let of = |place: u8| values[usize::from(place)];
            last = match *node {
                Node::Linear(by, plus) => affine(speed, by, plus),
                Node::Affine(a, by, plus) => affine(of(a), by, plus),
                Node::Sum(a, b) => of(a).plus(of(b)),
                Node::Difference(a, b) => of(a).minus(of(b)),
                Node::Product(a, b) => of(a).times(of(b)),
                Node::Quotient(a, b) => of(a).over(of(b)),
                Node::Over(number, a) => T::of(number).over(of(a)),
                Node::Power(a, exponent) => of(a).power(exponent),
                Node::Exp(a, by) => of(a).times(T::of(by)).exp(),
                Node::Ln(a) => of(a).ln(),
                Node::Sin(a) => of(a).sin(),
                Node::Cos(a) => of(a).cos(),
                Node::Sinh(a) => of(a).sinh(),
                Node::Cosh(a) => of(a).cosh(),
                Node::Tanh(a) => of(a).tanh(),
                Node::Sech(a, _) => of(a).sech(),
                Node::Atan(a) => of(a).atan(),
            };
            values[i] = last;
        }
        last
    }

    /// Bounds of what `of` takes from value, slope and curvature, over speeds from `from` to `to`;
    /// infinite where there are none.
    fn between(&self, from: f64, to: f64, of: impl Fn(&Jet<Ball>) -> Ball) -> Range {
        let part = |i: u32| from + (to - from) * f64::from(i) / f64::from(PARTS);
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for i in 0..PARTS {
            let found = of(&self.at(Jet::speed(Ball::between(part(i), part(i + 1)))));
            if !found.is_known() {
                return (f64::NEG_INFINITY, f64::INFINITY);
            }
            low = low.min(found.value - found.error);
            high = high.max(found.value + found.error);
        }
        (low, high)
    }

    /// How far the series in the speed about `speed` holds, by its coefficients.
    fn radius(&self, speed: f64) -> f64 {
        let mut load = [0.0; MOST_ORDER + 1];
        load[0] = 1.0;
        let mut series = FormulaSeries::new(self, 1.0);
        let term = |k: usize, series: &mut FormulaSeries, load: &Coefficients| {
            let of_speed = [speed, 1.0].get(k).copied().unwrap_or(0.0);
            super::Series::extend(series, k, of_speed, load)
        };
        (0..=OF_SCALE)
            .map(|k| (k, term(k, &mut series, &load).abs()))
            .skip(2)
            .map(|(k, size)| pow(size, -1.0 / k as f64))
            .fold(f64::INFINITY, f64::min)
    }
}

/// A law that is a formula in the speed.
#[derive(Debug, Clone, PartialEq)]
pub struct ByFormula {
    formula: Formula,
}

impl FrictionLaw {
    /// μ_K(v) by a formula in the speed v ≥ 0, which is analytic at speeds above 0.
    ///
    /// # Errors
    /// μ_S must be finite and positive, and μ_K(0⁺) finite, positive and at most μ_S.
    pub fn formula(formula: Formula, mu_s: f64) -> Result<Self, ModelError> {
        let mu_s = ModelError::positive("mu_s", mu_s)?;
        let law = Self::new(Kind::Formula(ByFormula { formula }), mu_s);
        let at_rest = law.posed_at(0.0)?;
        // What is μ_S at rest may be computed a rounding above it.
        checked_at_rest("mu_k", at_rest * (1.0 - 4.0 * f64::EPSILON), mu_s)?;
        Ok(law)
    }

    /// μ_K at this speed, where a formula need not have one.
    ///
    /// # Errors
    /// It must be finite and positive.
    pub(crate) fn posed_at(&self, speed: f64) -> Result<f64, ModelError> {
        let mu_k = self.mu_k(speed);
        let checked = ModelError::check("mu_k", mu_k, POSITIVE, mu_k > 0.0);
        checked.map_err(|error| error.at_speed(speed))
    }

    /// μ_K′ at a speed above 0, where a formula need not have one.
    ///
    /// # Errors
    /// It must be finite.
    pub(crate) fn slope_at(&self, speed: f64) -> Result<f64, ModelError> {
        let checked = ModelError::check("mu_prime", self.mu_prime(speed), FINITE, true);
        checked.map_err(|error| error.at_speed(speed))
    }
}

impl Law for ByFormula {
    type Series = FormulaSeries;

    fn mu_k(&self, speed: f64) -> f64 {
        self.formula.at(speed)
    }

    fn mu_prime(&self, speed: f64) -> f64 {
        self.formula.at(Jet::speed(speed)).slope
    }

    /// By the coefficients of its series here and at lower speeds: what the law does there does not
    /// show here.
    fn speed_scale(&self, speed: f64) -> f64 {
        const LEAST: f64 = 1e-9;
        let below = [1.0, 0.75, 0.5, 0.25, 0.0].map(|part| part * speed);
        let reach = below.map(|v| self.formula.radius(v.max(LEAST)) + (speed - v));
        reach.into_iter().fold(f64::INFINITY, f64::min)
    }

    fn least_speed(&self) -> f64 {
        0.0
    }

    fn slopes_between(&self, from: f64, to: f64) -> Range {
        self.formula.between(from, to, |jet| jet.slope)
    }

    fn curvatures_between(&self, from: f64, to: f64) -> Range {
        self.formula.between(from, to, |jet| jet.bend)
    }

    fn series(&self, velocity_unit: f64) -> FormulaSeries {
        FormulaSeries::new(&self.formula, velocity_unit)
    }
}
