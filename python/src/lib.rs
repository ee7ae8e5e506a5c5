//! The private half of the Python package: what its pure Python half calls. Nothing here is said of
//! parameters, fields or laws; names and messages are those of the crate.
//!
//! - `answers`: one setting, with its answer as a dictionary
//! - `arrays`: numbers at many points, as NumPy arrays
//! - `error`: the errors of the package
//! - `friction`: friction laws, their fits and their measured points
//! - `lines`: points in NumPy arrays as lines of delays
//! - `subject`: what is computed: a friction law or a system
//! - `sweeps`: plans, maps and motions
//! - `waiting`: long work on a thread of its own, which heeds signals

// Arguments of functions that Python calls are their own.
#![allow(clippy::needless_pass_by_value)]

mod answers;
mod arrays;
mod error;
mod friction;
mod lines;
mod subject;
mod sweeps;
mod waiting;

use pyo3::prelude::*;

#[pymodule(gil_used = false)]
mod _core {
    #[pymodule_export]
    use super::answers::{answer, catalogue};
    #[pymodule_export]
    use super::arrays::{evaluate, n_unstable};
    #[pymodule_export]
    use super::friction::{fit, law, read_curve};
    #[pymodule_export]
    use super::subject::Subject;
    #[pymodule_export]
    use super::sweeps::{cell, inlined, plan, run, simulate};
    /// The version of slipmap.
    #[allow(non_upper_case_globals)]
    #[pymodule_export]
    const __version__: &str = slipmap::VERSION;
}
