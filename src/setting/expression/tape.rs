//! An expression as a list of operations on two stacks, one of numbers and one of polynomials in s.
//! It is evaluated at every setting, without allocations once the stacks have grown.

use std::ops::Range;

use crate::linear::general::Polynomial;
use crate::model::ball::Ball;

/// A function of numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::setting) enum Function {
    Sqrt,
    Exp,
    Ln,
    Sin,
    Cos,
    Sinh,
    Cosh,
    Tanh,
    Atan,
}

impl Function {
    /// All of them, by name; `log` is a second name of `ln`.
    pub(in crate::setting) const NAMED: [(&str, Self); 10] = [
        ("sqrt", Self::Sqrt),
        ("exp", Self::Exp),
        ("ln", Self::Ln),
        ("log", Self::Ln),
        ("sin", Self::Sin),
        ("cos", Self::Cos),
        ("sinh", Self::Sinh),
        ("cosh", Self::Cosh),
        ("tanh", Self::Tanh),
        ("atan", Self::Atan),
    ];

    fn of(self, x: Ball) -> Ball {
        match self {
            Self::Sqrt => x.sqrt(),
            Self::Exp => x.exp(),
            Self::Ln => x.ln(),
            Self::Sin => x.sin(),
            Self::Cos => x.cos(),
            Self::Sinh => x.sinh(),
            Self::Cosh => x.cosh(),
            Self::Tanh => x.tanh(),
            Self::Atan => x.atan(),
        }
    }
}

/// One operation. Operands are popped from the stacks and the result is pushed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::setting) enum Op {
    /// A literal number.
    Number(f64),
    /// π.
    Pi,
    /// The value of a name, by index.
    Value(u8),
    Add,
    Subtract,
    Multiply,
    Divide,
    Negate,
    Power(i32),
    /// A power whose exponent is no whole number that is written out.
    Raise,
    Apply(Function),
    Smaller,
    Larger,
    /// s.
    Variable,
    /// Turns a number into a polynomial.
    Lift,
    AddPolynomials,
    SubtractPolynomials,
    MultiplyPolynomials,
    /// A polynomial times a number.
    Scale,
    /// A polynomial over a number.
    ScaleDown,
    NegatePolynomial,
    PowerOfPolynomial(u32),
    /// A polynomial that divides, and so is not 0 at all s.
    Divisor,
}

impl Op {
    /// How many operands it takes.
    pub(super) fn operands(self) -> usize {
        match self {
            Self::Number(_) | Self::Pi | Self::Value(_) | Self::Variable => 0,
            Self::Negate | Self::Power(_) | Self::Apply(_) | Self::Lift => 1,
            Self::NegatePolynomial | Self::PowerOfPolynomial(_) | Self::Divisor => 1,
            Self::Add | Self::Subtract | Self::Multiply | Self::Divide | Self::Raise => 2,
            Self::Smaller | Self::Larger | Self::AddPolynomials | Self::SubtractPolynomials => 2,
            Self::MultiplyPolynomials | Self::Scale | Self::ScaleDown => 2,
        }
    }

    /// Whether its result is a number, not a polynomial.
    pub(super) fn makes_number(self) -> bool {
        let of_two = matches!(
            self,
            Self::Add | Self::Subtract | Self::Multiply | Self::Divide
        );
        let of_one = matches!(self, Self::Negate | Self::Power(_) | Self::Apply(_));
        let alone = matches!(self, Self::Number(_) | Self::Pi | Self::Value(_));
        of_two || of_one || alone || matches!(self, Self::Raise | Self::Smaller | Self::Larger)
    }
}

/// An expression that is a polynomial in s, with the place of every operation.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::setting) struct Tape {
    ops: Vec<Op>,
    places: Vec<Range<usize>>,
    /// An upper bound on the degree of the polynomial.
    degree: usize,
}

/// π, and what is missing in its double.
const PI: Ball = Ball {
    value: std::f64::consts::PI,
    error: 1.3e-16,
};

/// The stacks of an evaluation, for reuse.
#[derive(Debug, Clone, Default)]
pub(in crate::setting) struct Stacks {
    numbers: Vec<Ball>,
    polynomials: Vec<Polynomial>,
}

impl Stacks {
    fn number(&mut self) -> Ball {
        self.numbers.pop().unwrap_or(Ball::exact(0.0))
    }

    fn polynomial(&mut self) -> Polynomial {
        self.polynomials.pop().unwrap_or(Polynomial::ZERO)
    }

    fn two(&mut self, of: impl Fn(Ball, Ball) -> Ball) {
        let (second, first) = (self.number(), self.number());
        self.numbers.push(of(first, second));
    }

    fn one(&mut self, of: impl Fn(Ball) -> Ball) {
        let first = self.number();
        self.numbers.push(of(first));
    }

    /// False where a product has too large a degree, which the reader rules out.
    fn two_polynomials(
        &mut self,
        of: impl Fn(&Polynomial, &Polynomial) -> Option<Polynomial>,
    ) -> bool {
        let (second, first) = (self.polynomial(), self.polynomial());
        let result = of(&first, &second);
        self.polynomials.extend(result);
        result.is_some()
    }

    fn scale(&mut self, by: Ball) -> bool {
        let polynomial = self.polynomial();
        let scaled = polynomial.times(&Polynomial::constant(by.value, by.error));
        let is_known = scaled.is_ok();
        self.polynomials.extend(scaled);
        is_known
    }

    /// Applies an operation; false where its result is not defined.
    fn apply(&mut self, op: Op, values: &[f64]) -> bool {
        match op {
            Op::Number(value) => self.numbers.push(Ball::exact(value)),
            Op::Pi => self.numbers.push(PI),
            Op::Value(index) => self.numbers.push(Ball::exact(values[usize::from(index)])),
            Op::Add => self.two(Ball::plus),
            Op::Subtract => self.two(Ball::minus),
            Op::Multiply => self.two(Ball::times),
            Op::Divide => self.two(Ball::over),
            Op::Smaller => self.two(Ball::smaller),
            Op::Larger => self.two(Ball::larger),
            Op::Negate => self.one(Ball::negated),
            Op::Power(exponent) => self.one(|x| x.power(exponent)),
            Op::Raise => self.two(Ball::raised),
            Op::Apply(function) => self.one(|x| function.of(x)),
            Op::Variable => self.polynomials.push(Polynomial::variable()),
            Op::Lift => {
                let Ball { value, error } = self.number();
                self.polynomials.push(Polynomial::constant(value, error));
            }
            Op::AddPolynomials => return self.two_polynomials(|a, b| Some(a.plus(b, 1.0))),
            Op::SubtractPolynomials => return self.two_polynomials(|a, b| Some(a.plus(b, -1.0))),
            Op::MultiplyPolynomials => return self.two_polynomials(|a, b| a.times(b).ok()),
            Op::Scale => {
                let by = self.number();
                return self.scale(by);
            }
            Op::ScaleDown => {
                let by = Ball::exact(1.0).over(self.number());
                return by.is_known() && self.scale(by);
            }
            Op::NegatePolynomial => {
                let polynomial = self.polynomial();
                self.polynomials
                    .push(Polynomial::ZERO.plus(&polynomial, -1.0));
            }
            Op::PowerOfPolynomial(exponent) => {
                let power = self.polynomial().power(exponent);
                let is_known = power.is_ok();
                self.polynomials.extend(power);
                return is_known;
            }
            Op::Divisor => return self.polynomials.last().is_some_and(|of| !may_vanish(of)),
        }
        self.numbers.last().is_none_or(|number| number.is_known())
    }
}

/// Whether no coefficient is certain to differ from 0.
fn may_vanish(of: &Polynomial) -> bool {
    let mut each = of.coefficients().iter().zip(of.errors());
    each.all(|(value, error)| value.abs() <= *error)
}

impl Tape {
    /// Operations that leave one polynomial, each with its place.
    pub(in crate::setting) fn new(ops: Vec<(Op, Range<usize>)>, degree: usize) -> Self {
        let (ops, places) = ops.into_iter().unzip();
        Self {
            ops,
            places,
            degree,
        }
    }

    /// The operations, in their order.
    pub(in crate::setting) fn ops(&self) -> &[Op] {
        &self.ops
    }

    /// An upper bound on the degree.
    pub(in crate::setting) fn degree(&self) -> usize {
        self.degree
    }

    /// Whether the expression contains the value with this index.
    pub(in crate::setting) fn uses(&self, index: usize) -> bool {
        self.ops
            .iter()
            .any(|op| matches!(op, Op::Value(i) if usize::from(*i) == index))
    }

    /// The polynomial at these values.
    ///
    /// # Errors
    /// The place of an undefined operation, such as 1/0.
    pub(in crate::setting) fn at(
        &self,
        values: &[f64],
        stacks: &mut Stacks,
    ) -> Result<Polynomial, Range<usize>> {
        stacks.numbers.clear();
        stacks.polynomials.clear();
        for (op, place) in self.ops.iter().zip(&self.places) {
            if !stacks.apply(*op, values) {
                return Err(place.clone());
            }
        }
        let result = stacks.polynomial();
        let mut numbers = result.coefficients().iter().chain(result.errors());
        match (numbers.all(|c| c.is_finite()), self.places.as_slice()) {
            (true, _) => Ok(result),
            (false, []) => Err(0..0),
            (false, [first, .., last]) => Err(first.start.min(last.start)..last.end),
            (false, [only]) => Err(only.clone()),
        }
    }
}
