//! An expression of a system, as text and in the form for evaluation.

use std::ops::Range;

use crate::linear::general::{MOST_DEGREE, Polynomial};
use crate::setting::expression::{Factor, Stacks, Tape, Written, common, without};
use crate::setting::no_answer::NoAnswer;
use crate::text::toml_reader::SpecError;

/// An expression: a polynomial, or a quotient whose divisor is told apart.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Expression {
    pub text: String,
    /// The polynomial, or the dividend.
    tape: Tape,
    /// The factors of its divisor.
    under: Vec<Divisor>,
    /// By what the equation is multiplied that is not in `under`.
    times: Vec<Divisor>,
}

/// A factor of a divisor, with the text in which it stands.
#[derive(Debug, Clone, PartialEq)]
struct Divisor {
    text: String,
    factor: Factor,
    tape: Tape,
}

/// The value of a tape of the polynomial of this name.
fn value(
    tape: &Tape,
    (polynomial, text): (&'static str, &str),
    values: &[f64],
    stacks: &mut Stacks,
) -> Result<Polynomial, NoAnswer> {
    tape.at(values, stacks).map_err(|place: Range<usize>| {
        let part = text.get(place).unwrap_or(text);
        NoAnswer::Undefined {
            polynomial: polynomial.into(),
            what: format!("`{part}` has no finite value at this setting"),
        }
    })
}

/// The product of two polynomials of whose degrees the reader made sure.
pub(super) fn times(
    first: &Polynomial,
    second: &Polynomial,
    polynomial: &'static str,
) -> Result<Polynomial, NoAnswer> {
    first.times(second).map_err(|_| NoAnswer::Undefined {
        polynomial: polynomial.into(),
        what: format!("its degree is above {MOST_DEGREE} at this setting"),
    })
}

impl Expression {
    /// What is written, with parameters of these names.
    pub(super) fn of(written: &Written, names: &[&str]) -> Result<Self, SpecError> {
        let read = written.read_quotient(names)?;
        let under = read.under.into_iter().map(|factor| Divisor {
            text: written.text.clone(),
            tape: factor.tape(),
            factor,
        });
        Ok(Self {
            text: written.text.clone(),
            tape: read.over,
            under: under.collect(),
            times: Vec::new(),
        })
    }

    /// What is written without s, an entry of a matrix or a gain; one with s in it is told
    /// `with_variable`.
    pub(super) fn number(
        written: &Written,
        names: &[&str],
        with_variable: [&str; 2],
    ) -> Result<Self, SpecError> {
        Ok(Self {
            text: written.text.clone(),
            tape: written.read_without_variable(names, with_variable)?,
            under: Vec::new(),
            times: Vec::new(),
        })
    }

    /// Upper bounds on the degrees of dividend and divisor.
    pub(super) fn degrees(&self) -> [usize; 2] {
        let under = self.under.iter().map(|of| of.factor.degree).sum();
        [self.tape.degree(), under]
    }

    /// An upper bound on its degree in the equation, multiplied by the divisors.
    pub(super) fn degree(&self) -> usize {
        let times = self.times.iter().map(|of| of.factor.degree);
        self.tape.degree() + times.sum::<usize>()
    }

    /// The polynomial, or the dividend.
    pub(super) fn tape(&self) -> &Tape {
        &self.tape
    }

    /// Everything in it that is evaluated.
    pub(super) fn tapes(&self) -> impl Iterator<Item = &Tape> {
        let divisors = self.under.iter().chain(&self.times);
        [&self.tape].into_iter().chain(divisors.map(|of| &of.tape))
    }

    /// The polynomial at these values, which is of the part `polynomial` of a system.
    pub(super) fn at(
        &self,
        polynomial: &'static str,
        values: &[f64],
        stacks: &mut Stacks,
    ) -> Result<Polynomial, NoAnswer> {
        for of in &self.under {
            value(&of.tape, (polynomial, &of.text), values, stacks)?;
        }
        let mut all = value(&self.tape, (polynomial, &self.text), values, stacks)?;
        for of in &self.times {
            let factor = value(&of.tape, (polynomial, &of.text), values, stacks)?;
            all = times(&all, &factor, polynomial)?;
        }
        Ok(all)
    }

    /// Dividend and divisor at these values.
    pub(super) fn quotient_at(
        &self,
        polynomial: &'static str,
        values: &[f64],
        stacks: &mut Stacks,
    ) -> Result<[Polynomial; 2], NoAnswer> {
        let mut divisor = Polynomial::constant(1.0, 0.0);
        for (i, of) in self.under.iter().enumerate() {
            let factor = value(&of.tape, (polynomial, &of.text), values, stacks)?;
            divisor = match i {
                0 => factor,
                _ => times(&divisor, &factor, polynomial)?,
            };
        }
        let dividend = value(&self.tape, (polynomial, &self.text), values, stacks)?;
        Ok([dividend, divisor])
    }
}

/// Multiplies the parts of an equation by the least common multiple of their divisors.
pub(super) fn clear(parts: &mut [Expression], written: &[&Written]) -> Result<(), SpecError> {
    let factors =
        |of: &[Divisor]| -> Vec<Factor> { of.iter().map(|of| of.factor.clone()).collect() };
    let divisors: Vec<Divisor> = parts.iter().flat_map(|part| part.under.clone()).collect();
    let each = parts.iter().map(|part| factors(&part.under));
    let all = each.fold(Vec::new(), |all, some| common(&all, &some));
    for (part, written) in parts.iter_mut().zip(written) {
        let own = factors(&part.under);
        let missing = without(&all, &own).into_iter();
        let missing = missing.filter_map(|of| divisors.iter().find(|known| known.factor == *of));
        part.times = missing.cloned().collect();
        let degree = part.degree();
        if degree > MOST_DEGREE {
            let message = format!(
                "{}: a polynomial of degree {degree} in s once divisors are multiplied out: at \
                 most {MOST_DEGREE} is allowed",
                written.name
            );
            return Err(SpecError::at(written.span.clone(), message));
        }
    }
    Ok(())
}
