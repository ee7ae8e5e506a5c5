//! Divisors with s in them: the factors over which a part of an expression stands.
//!
//! A part is a polynomial over factors. A sum stands over the factors of its terms, each as often
//! as in the term that has it most often; factors are the same where they are written alike.
//! Nothing is cancelled.

use std::ops::Range;

use super::part::{Misread, Part, Read, check_degree, product};
use super::tape::{Op, Tape};

/// The most operations of an expression whose terms were brought over one divisor.
const MOST_OPS: usize = 1 << 17;

/// A factor of a divisor, a polynomial in s that is no product.
#[derive(Debug, Clone)]
pub(in crate::setting) struct Factor {
    pub ops: Vec<(Op, Range<usize>)>,
    pub degree: usize,
}

impl PartialEq for Factor {
    /// Whether both are written alike, wherever they stand.
    fn eq(&self, other: &Self) -> bool {
        let (own, others) = (self.ops.iter(), other.ops.iter());
        own.map(|(op, _)| op).eq(others.map(|(op, _)| op))
    }
}

/// A quotient of polynomials in s.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::setting) struct Quotient {
    /// The dividend.
    pub over: Tape,
    /// The factors of the divisor.
    pub under: Vec<Factor>,
}

impl Factor {
    /// For evaluation; it has no value where it is 0 at all s.
    pub(in crate::setting) fn tape(&self) -> Tape {
        let mut ops = self.ops.clone();
        let from = ops.iter().map(|(_, place)| place.start).min();
        let until = ops.iter().map(|(_, place)| place.end).max();
        ops.push((Op::Divisor, from.unwrap_or(0)..until.unwrap_or(0)));
        Tape::new(ops, self.degree)
    }
}

/// The factors of `all` that are left when those of `some` are taken away.
pub(in crate::setting) fn without<'f>(all: &'f [Factor], some: &[Factor]) -> Vec<&'f Factor> {
    let mut some: Vec<&Factor> = some.iter().collect();
    let mut left = all.iter().collect::<Vec<_>>();
    left.retain(|factor| match some.iter().position(|of| of == factor) {
        Some(place) => {
            some.swap_remove(place);
            false
        }
        None => true,
    });
    left
}

/// The least common multiple of two divisors.
pub(in crate::setting) fn common(first: &[Factor], second: &[Factor]) -> Vec<Factor> {
    let missing = without(second, first).into_iter().cloned();
    first.iter().cloned().chain(missing).collect()
}

/// Both parts over the least common multiple of their divisors.
pub(super) fn over_one_divisor(first: Part, second: Part) -> Read<[Part; 2]> {
    if first.under.is_empty() && second.under.is_empty() {
        return Ok([first, second]);
    }
    let all = common(&first.under, &second.under);
    let extended = |mut part: Part| -> Read<Part> {
        let place = part.place.clone();
        let missing = without(&all, &part.under);
        let missing: Vec<Factor> = missing.into_iter().cloned().collect();
        part.under.clear();
        for factor in missing {
            let factor = Part {
                degree: Some(factor.degree),
                ops: factor.ops,
                ..Part::of(Op::Variable, None, place.clone())
            };
            part = product(part, factor.divisor())?;
            part.place = place.clone();
        }
        if part.ops.len() > MOST_OPS {
            let message = "too long once its divisors are multiplied out";
            return Err(Misread::at(place, message)
                .help("write the terms over one divisor, or the product itself"));
        }
        part.under.clone_from(&all);
        Ok(part)
    };
    let degree = all.iter().map(|factor| factor.degree).sum();
    check_degree(degree, &(first.place.start..second.place.end))?;
    Ok([extended(first)?, extended(second)?])
}

/// The quotient of two parts, of which the second has s in it.
pub(super) fn quotient(first: Part, second: &Part) -> Read<Part> {
    let place = first.place.start..second.place.end;
    let mut over = first.lifted().0;
    // A divisor of a divisor multiplies.
    for factor in &second.under {
        let factor = Part {
            ops: factor.ops.clone(),
            degree: Some(factor.degree),
            ..Part::of(Op::Variable, None, second.place.clone())
        };
        over = product(over, factor.divisor())?;
    }
    over = divided_by_factors(over, &second.ops);
    check_degree(over.divisor_degree(), &place)?;
    over.place = place;
    Ok(over)
}

/// A part over the factors of the polynomial that these operations make.
fn divided_by_factors(mut part: Part, ops: &[(Op, Range<usize>)]) -> Part {
    let Some(((last, place), before)) = ops.split_last() else {
        return part;
    };
    let number = |ops: &[(Op, Range<usize>)]| Part {
        ops: ops.to_vec(),
        ..Part::of(Op::Pi, None, place.clone())
    };
    match last {
        Op::MultiplyPolynomials => {
            let (first, second) = before.split_at(before.len() - operand(before));
            let part = divided_by_factors(part, first);
            divided_by_factors(part, second)
        }
        Op::PowerOfPolynomial(n) => (0..*n).fold(part, |part, _| divided_by_factors(part, before)),
        Op::Scale | Op::ScaleDown => {
            let (mut of, mut by) = before.split_at(before.len() - operand(before));
            if !by.last().is_some_and(|(op, _)| op.makes_number()) {
                (of, by) = (by, of);
            }
            let inverse = if *last == Op::Scale {
                Op::ScaleDown
            } else {
                Op::Scale
            };
            let degree = part.degree;
            divided_by_factors(part.with(number(by), inverse, degree), of)
        }
        Op::Lift if matches!(before, [(Op::Number(1.0), _)]) => part,
        Op::Lift => {
            let degree = part.degree;
            part.with(number(before), Op::ScaleDown, degree)
        }
        Op::NegatePolynomial => {
            let degree = part.degree;
            divided_by_factors(part.then(Op::NegatePolynomial, degree), before)
        }
        _ => {
            part.under.push(Factor {
                ops: ops.to_vec(),
                degree: degree(ops),
            });
            part
        }
    }
}

/// How many of these operations make the last operand.
fn operand(ops: &[(Op, Range<usize>)]) -> usize {
    let mut wanted = 1;
    for (count, (op, _)) in ops.iter().rev().enumerate() {
        wanted = wanted - 1 + op.operands();
        if wanted == 0 {
            return count + 1;
        }
    }
    ops.len()
}

/// The degree of the polynomial that these operations make.
fn degree(ops: &[(Op, Range<usize>)]) -> usize {
    let mut degrees: Vec<usize> = Vec::new();
    for (op, _) in ops {
        match op {
            Op::Variable => degrees.push(1),
            Op::Lift => degrees.push(0),
            Op::AddPolynomials | Op::SubtractPolynomials | Op::MultiplyPolynomials => {
                let second = degrees.pop().unwrap_or(0);
                if let Some(first) = degrees.last_mut() {
                    *first = match op {
                        Op::MultiplyPolynomials => *first + second,
                        _ => second.max(*first),
                    };
                }
            }
            Op::PowerOfPolynomial(n) => {
                if let Some(degree) = degrees.last_mut() {
                    *degree *= *n as usize;
                }
            }
            _ => {}
        }
    }
    degrees.pop().unwrap_or(0)
}
