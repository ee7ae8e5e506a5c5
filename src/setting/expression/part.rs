//! Parts of an expression, and the operations on them.

use std::ops::Range;

use super::fraction::{self, Factor, over_one_divisor};
use super::tape::Op;
use crate::linear::general::polynomial::MOST_DEGREE;

/// The largest exponent of a number.
pub(in crate::setting) const LARGEST_EXPONENT: f64 = 64.0;

/// Why an expression was not understood, and where in it.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::setting) struct Misread {
    /// The bytes of the expression in question; empty at its end.
    pub place: Range<usize>,
    pub message: String,
    pub help: Option<String>,
    /// Whether no other reading of the text is possible.
    pub certain: bool,
}

impl Misread {
    pub(in crate::setting) fn at(place: Range<usize>, message: impl Into<String>) -> Self {
        Self {
            place,
            message: message.into(),
            help: None,
            certain: true,
        }
    }

    pub(in crate::setting) fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }
}

pub(in crate::setting) type Read<T> = Result<T, Misread>;

/// A part of an expression.
#[derive(Debug, Clone)]
pub(super) struct Part {
    pub ops: Vec<(Op, Range<usize>)>,
    /// The largest degree in s; none for a part without s.
    pub degree: Option<usize>,
    pub place: Range<usize>,
    /// Its value, for a literal number.
    pub number: Option<f64>,
    /// What it is divided by, where that has s in it.
    pub under: Vec<Factor>,
}

impl Part {
    pub(super) fn of(op: Op, degree: Option<usize>, place: Range<usize>) -> Self {
        Self {
            ops: vec![(op, place.clone())],
            degree,
            place,
            number: None,
            under: Vec::new(),
        }
    }

    /// The degree of what it is divided by.
    pub(super) fn divisor_degree(&self) -> usize {
        self.under.iter().map(|factor| factor.degree).sum()
    }

    /// The part as a polynomial, with its degree, even without s.
    pub(super) fn lifted(mut self) -> (Self, usize) {
        if let Some(degree) = self.degree {
            return (self, degree);
        }
        self.ops.push((Op::Lift, self.place.clone()));
        self.degree = Some(0);
        (self, 0)
    }

    /// Appends `other` and an operation on both; the result stands over the divisor of this part.
    pub(super) fn with(mut self, other: Self, op: Op, degree: Option<usize>) -> Self {
        self.ops.extend(other.ops);
        self.place = self.place.start..other.place.end;
        self.ops.push((op, self.place.clone()));
        self.degree = degree;
        self.number = None;
        self
    }

    /// Appends an operation on this part alone, with a result of `degree`.
    pub(super) fn then(mut self, op: Op, degree: Option<usize>) -> Self {
        self.ops.push((op, self.place.clone()));
        self.degree = degree;
        self
    }

    /// Appends that this polynomial, a factor of a divisor, must not be 0.
    pub(super) fn divisor(self) -> Self {
        let degree = self.degree;
        self.then(Op::Divisor, degree)
    }
}

pub(super) fn sum(first: Part, second: Part, [numbers, polynomials]: [Op; 2]) -> Read<Part> {
    if first.degree.is_none() && second.degree.is_none() {
        return Ok(first.with(second, numbers, None));
    }
    let [first, second] = over_one_divisor(first, second)?;
    let ((first, m), (second, n)) = (first.lifted(), second.lifted());
    Ok(first.with(second, polynomials, Some(m.max(n))))
}

pub(super) fn product(mut first: Part, mut second: Part) -> Read<Part> {
    first.under.append(&mut second.under);
    let place = first.place.start..second.place.end;
    check_degree(first.divisor_degree(), &place)?;
    match (first.degree, second.degree) {
        (None, None) => Ok(first.with(second, Op::Multiply, None)),
        (Some(n), None) | (None, Some(n)) => Ok(first.with(second, Op::Scale, Some(n))),
        (Some(m), Some(n)) => {
            check_degree(m + n, &place)?;
            Ok(first.with(second, Op::MultiplyPolynomials, Some(m + n)))
        }
    }
}

pub(super) fn quotient(first: Part, second: Part) -> Read<Part> {
    match (first.degree, second.degree) {
        (_, Some(_)) => fraction::quotient(first, &second),
        (None, None) => Ok(first.with(second, Op::Divide, None)),
        (degree, None) => Ok(first.with(second, Op::ScaleDown, degree)),
    }
}

pub(super) fn power(base: Part, exponent: Part) -> Read<Part> {
    let Some(n) = exponent.number.filter(|n| n.trunc() == *n) else {
        return match (base.degree, exponent.degree) {
            (None, None) => Ok(base.with(exponent, Op::Raise, None)),
            (_, Some(_)) => Err(Misread::at(exponent.place, "an exponent with s in it")
                .help("exponents are of parameters alone")),
            (Some(_), None) => Err(Misread::at(
                exponent.place,
                "an exponent of what has s in it must be a whole number, as in s^2",
            )),
        };
    };
    let place = exponent.place.clone();
    if n.abs() > LARGEST_EXPONENT {
        let message = format!("the exponent {n} is too large: at most {LARGEST_EXPONENT}");
        return Err(Misread::at(place, message));
    }
    let (whole, until) = (n as i32, exponent.place.end);
    let mut powered = match base.degree {
        None => base.then(Op::Power(whole), None),
        Some(degree) => {
            let (times, place) = (whole.unsigned_abs(), base.place.start..until);
            let degree = degree * times as usize;
            check_degree(degree.max(base.divisor_degree() * times as usize), &place)?;
            let (under, count) = (base.under.clone(), times as usize * base.under.len());
            let mut base = base;
            base.under = under.into_iter().cycle().take(count).collect();
            let powered = base.then(Op::PowerOfPolynomial(times), Some(degree));
            if n < 0.0 {
                let one = Part::of(Op::Number(1.0), None, place);
                return fraction::quotient(one, &powered);
            }
            powered
        }
    };
    powered.place.end = until;
    powered.number = None;
    if let Some((_, place)) = powered.ops.last_mut() {
        place.end = until;
    }
    Ok(powered)
}

pub(super) fn check_degree(degree: usize, place: &Range<usize>) -> Read<()> {
    if degree <= MOST_DEGREE {
        return Ok(());
    }
    let message = format!("a polynomial of degree {degree} in s: at most {MOST_DEGREE} is allowed");
    Err(Misread::at(place.clone(), message))
}

pub(super) fn negated(part: Part) -> Part {
    let (op, degree, number) = match part.degree {
        None => (Op::Negate, None, part.number.map(|n| -n)),
        degree => (Op::NegatePolynomial, degree, None),
    };
    let mut part = part.then(op, degree);
    part.number = number;
    part
}
