//! The errors of the package.

use std::convert::Infallible;
use std::fmt::Display;

use pyo3::exceptions::{PyKeyboardInterrupt, PyMemoryError, PyRuntimeError};
use pyo3::prelude::*;
use slipmap::explore::Problem;
use slipmap::sweep::RunError;
use slipmap::text::SpecError;

/// `slipmap.InputError` with a message, advice, and the bytes of `text` that it is about.
pub(crate) fn input_error(
    py: Python,
    (message, help): (String, Option<String>),
    text: &str,
    span: Option<[usize; 2]>,
) -> PyErr {
    // Python counts characters.
    let place = |at: usize| text.get(..at).map_or(0, |before| before.chars().count());
    let span = span.map(|[from, to]| (place(from), place(to)));
    let made = py
        .import("slipmap._error")
        .and_then(|module| module.getattr("InputError"))
        .and_then(|error| error.call1((message, help, text, span)));
    made.map_or_else(|error| error, PyErr::from_value)
}

/// An error of a text, at its place.
pub(crate) fn of_text(py: Python, error: SpecError, text: &str) -> PyErr {
    let span = error.span.map(|span| [span.start, span.end]);
    input_error(py, (error.message, error.help), text, span)
}

/// An error without a place.
pub(crate) fn of_input(py: Python, error: impl Display) -> PyErr {
    input_error(py, (error.to_string(), None), "", None)
}

/// The problem of a request in `text`.
pub(crate) fn of_problem(py: Python, problem: Problem, text: &str) -> PyErr {
    let message = problem.detail.unwrap_or_else(|| problem.title.to_owned());
    input_error(py, (message, problem.help), text, problem.span)
}

/// Why a sweep ended.
pub(crate) fn of_run(py: Python, error: RunError<Infallible>, text: &str) -> PyErr {
    match error {
        RunError::Interrupted => PyKeyboardInterrupt::new_err(()),
        RunError::Memory { .. } => PyMemoryError::new_err(error.to_string()),
        RunError::Needs(error) => of_text(py, error, text),
        RunError::Model(error) => of_input(py, error),
        RunError::Threads { .. } | RunError::ThreadLost => {
            PyRuntimeError::new_err(error.to_string())
        }
        RunError::Sink(never) => match never {},
    }
}
