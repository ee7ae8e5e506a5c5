//! An expression of a system, as text and in the form for evaluation.

use std::ops::Range;

use crate::linear::general::Polynomial;
use crate::setting::expression::{Stacks, Tape};
use crate::setting::no_answer::NoAnswer;

#[derive(Debug, Clone, PartialEq)]
pub(super) struct Expression {
    pub text: String,
    pub tape: Tape,
}

impl Expression {
    /// The polynomial at these values, which is of the part `polynomial` of a system.
    pub(super) fn at(
        &self,
        polynomial: &'static str,
        values: &[f64],
        stacks: &mut Stacks,
    ) -> Result<Polynomial, NoAnswer> {
        self.tape.at(values, stacks).map_err(|place: Range<usize>| {
            let part = self.text.get(place).unwrap_or(&self.text);
            NoAnswer::Undefined {
                polynomial,
                what: format!("`{part}` has no finite value at this setting"),
            }
        })
    }
}
