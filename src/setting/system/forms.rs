//! The forms in which a file gives its system: P and Q, B and A, matrices, powers of e^(−sτ), or
//! a loop of plant and controller.

use std::ops::Range;

use super::closed_loop::{CONTROLLER, DELAY, PID, PLANT, WrittenLoop};
use super::expressed::{Expression, clear};
use super::matrices::{Matrices, WrittenFeedback, WrittenMatrix};
use super::{Form, IGNORED_ROOTS};
use crate::setting::expression::Written;
use crate::text::document::Document;
use crate::text::toml_reader::{Entry, SpecError};

const POLYNOMIALS: [&str; 4] = ["P", "Q", "B", "A"];
const MATRICES: [&str; 3] = ["A0", "A1", "E1"];
const FEEDBACK: &str = "feedback";
const POWERS: &str = "D";
/// The most polynomials of D.
pub(in crate::setting) const MOST_POWERS: usize = 9;

/// What a system without an equation is told.
const FORMS: &str = "either P and Q, or the open loop B and the feedback A: expressions in s or \
    lists of coefficients; or matrices A0 and A1, or D = [p0, p1, p2], or plant and controller";

/// The keys of the forms, as written in a text.
pub(super) struct WrittenForm {
    polynomials: [Option<Written>; 4],
    matrices: [Option<WrittenMatrix>; 3],
    feedback: Option<WrittenFeedback>,
    powers: Option<Vec<Written>>,
    closed_loop: WrittenLoop,
}

/// The two parts of an equation.
fn equation(written: [&Written; 2], names: &[&str]) -> Result<[Expression; 2], SpecError> {
    let [first, second] = written;
    let mut parts = [
        Expression::of(first, names)?,
        Expression::of(second, names)?,
    ];
    clear(&mut parts, &written)?;
    Ok(parts)
}

impl WrittenForm {
    /// Takes the keys of all forms from the document of the text `whole`.
    pub(super) fn take(document: &mut Document, whole: &str) -> Self {
        let mut read = |name| document.take(name, |entry| Written::polynomial(name, entry, whole));
        let polynomials = POLYNOMIALS.map(&mut read);
        let mut read = |name| document.take(name, |entry| WrittenMatrix::of(name, entry, whole));
        let matrices = MATRICES.map(&mut read);
        Self {
            polynomials,
            matrices,
            feedback: document.take(FEEDBACK, |entry| WrittenFeedback::of(entry, whole)),
            powers: document.take(POWERS, |entry| read_powers(entry, whole)),
            closed_loop: WrittenLoop::take(document, whole),
        }
    }

    /// Whether it is of matrices, or of powers.
    fn is_beyond_polynomials(&self) -> bool {
        let matrices = self.matrices.iter().any(Option::is_some);
        matrices || self.feedback.is_some() || self.powers.as_ref().is_some_and(|of| of.len() > 2)
    }

    /// The names that parameters cannot have beside these keys.
    pub(super) fn reserved(&self) -> Vec<&'static str> {
        let matrices = self.matrices.iter().flatten().map(|of| of.name);
        let feedback = self.feedback.iter().flat_map(|_| ["B", "K", "C"]);
        matrices.chain(feedback).collect()
    }

    /// The form that is given, with parameters of these `names`. What is missing is told at
    /// `place`, what is too much at its key in the document.
    pub(super) fn read(
        &self,
        names: &[&str],
        document: &Document,
        place: Option<&Range<usize>>,
    ) -> Result<Form, SpecError> {
        let missing = |message: &str| SpecError {
            span: place.cloned(),
            ..SpecError::whole(message).help(FORMS)
        };
        self.check_one(document)?;
        let [p, q, open, gain] = &self.polynomials;
        if let (Some(p), Some(q)) = (p, q) {
            return Ok(Form::Direct(equation([p, q], names)?));
        }
        if let (Some(open), Some(gain)) = (open, gain) {
            let parts = equation([open, gain], names)?;
            check_degrees(&parts, &gain.span)?;
            return Ok(Form::Feedback(parts));
        }
        if let Some(powers) = &self.powers {
            return of_powers(powers, names);
        }
        if let Some(closed_loop) = self.closed_loop.read(names, document)? {
            return Ok(Form::Loop(Box::new(closed_loop)));
        }
        let [a0, a1, e1] = &self.matrices;
        match (a0, a1, e1, &self.feedback) {
            (Some(a0), Some(a1), e1, None) => {
                let matrices = Matrices::whole(a0, a1, e1.as_ref(), names)?;
                Ok(Form::Matrices(Box::new(matrices)))
            }
            (Some(a0), None, None, Some(feedback)) => {
                let matrices = Matrices::fed_back(a0, feedback, names)?;
                Ok(Form::Matrices(Box::new(matrices)))
            }
            _ => {
                let given = document.keys().map(|(key, _)| key);
                let given: Vec<&str> = given.filter(|key| group(key).is_some()).collect();
                Err(match given[..] {
                    [] => missing("a system needs its polynomials or matrices"),
                    [one] => missing(&format!("{one} alone makes no system")),
                    _ => missing(&format!("{} alone make no system", given.join(" and "))),
                })
            }
        }
    }

    /// Checks that the keys are of one form.
    fn check_one(&self, document: &Document) -> Result<(), SpecError> {
        let mut given = document.keys().filter(|(key, _)| group(key).is_some());
        let Some((first, _)) = given.next() else {
            return Ok(());
        };
        let other = given.rfind(|(key, _)| group(key) != group(first));
        let both = |one: &str, other: &str, place: &Range<usize>| {
            let message = format!("{one} is of one form, {other} of another: not both");
            Err(SpecError::at(place.clone(), message).help(FORMS))
        };
        if let Some((key, place)) = other {
            return both(first, key, place);
        }
        let place = |key: &str| document.keys().find(|(of, _)| *of == key);
        let [_, a1, e1] = &self.matrices;
        if let (Some((_, place)), true) = (place(FEEDBACK), a1.is_some() || e1.is_some()) {
            return both(if a1.is_some() { "A1" } else { "E1" }, FEEDBACK, place);
        }
        match place(IGNORED_ROOTS) {
            Some((_, place)) if self.is_beyond_polynomials() => {
                let message = format!("{IGNORED_ROOTS} is for P and Q, or B and A");
                Err(SpecError::at(place.clone(), message).help("leave it out"))
            }
            _ => Ok(()),
        }
    }
}

/// The number of the form of which `key` is one; none of other keys.
fn group(key: &str) -> Option<usize> {
    match key {
        "P" | "Q" => Some(0),
        "B" | "A" => Some(1),
        POWERS => Some(2),
        FEEDBACK => Some(3),
        PLANT | CONTROLLER | PID | DELAY => Some(4),
        key => MATRICES.contains(&key).then_some(3),
    }
}

fn read_powers(entry: &Entry, whole: &str) -> Result<Vec<Written>, SpecError> {
    if !entry.is_array() {
        let what = "an array of polynomials, such as [\"s + 1\", \"k\", 0.5]";
        return Err(entry.expected(what));
    }
    let each = entry.array()?;
    if !(2..=MOST_POWERS).contains(&each.len()) {
        let message = format!("2 to {MOST_POWERS} polynomials, not {}", each.len());
        return Err(entry
            .error(message)
            .help("D = p0 + p1 exp(-s tau) + p2 exp(-2 s tau) + ..."));
    }
    let each = each.iter().enumerate();
    each.map(|(k, of)| Written::term(&format!("{POWERS}[{k}]"), of, whole))
        .collect()
}

fn of_powers(powers: &[Written], names: &[&str]) -> Result<Form, SpecError> {
    let read = powers.iter().map(|of| Expression::of(of, names));
    let mut read = read.collect::<Result<Vec<_>, _>>()?;
    let each: Vec<&Written> = powers.iter().collect();
    clear(&mut read, &each)?;
    for (of, written) in read.iter().zip(powers) {
        let (m, n) = (of.degree(), read[0].degree());
        if m > n {
            let message = format!("{}: its degree is {m} and that of D[0] {n}", written.name);
            return Err(SpecError::at(written.span.clone(), message)
                .help("the first polynomial has the highest degree, or one of the highest"));
        }
    }
    Ok(match <[Expression; 2]>::try_from(read) {
        Ok(two) => Form::Direct(two),
        Err(more) => Form::Powers(more),
    })
}

fn check_degrees([open, gain]: &[Expression; 2], place: &Range<usize>) -> Result<(), SpecError> {
    let (m, n) = (gain.degree(), open.degree());
    if m < n {
        return Ok(());
    }
    let message = format!("A: its degree is {m} and that of B {n}: A must have the smaller one");
    Err(SpecError::at(place.clone(), message).help("write the system as P and Q"))
}
