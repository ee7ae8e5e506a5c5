//! Plans, maps and motions.

use std::sync::Arc;

use numpy::{IntoPyArray, PyArray1};
use pyo3::exceptions::{PyKeyboardInterrupt, PyMemoryError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList, PyTuple};
use slipmap::answers::trace::TraceError;
use slipmap::explore::motion;
use slipmap::model::stop::Stop;
use slipmap::setting::measured::decoded;
use slipmap::setting::setting_text::setting_text;
use slipmap::setting::table_file::{Inlined, Named, NotInlined};
use slipmap::setting::{CaseSpec, SweepSpec};
use slipmap::sweep::described::root::Provenance;
use slipmap::sweep::described::{Attribute, Value};
use slipmap::sweep::estimate::Costs;
use slipmap::sweep::events::Attended;
use slipmap::sweep::filled::{Filled, Numbers};
use slipmap::sweep::grid::Grid;
use slipmap::sweep::{Memory, Plan};

use crate::error::{input_error, of_input, of_run, of_text};
use crate::waiting::wait;

/// The text in which names of tables and systems are replaced by what they hold, and what is told
/// of that. `read` returns the bytes of the file of a name.
#[pyfunction]
pub(crate) fn inlined(
    py: Python,
    text: &str,
    read: &Bound<PyAny>,
) -> PyResult<(String, Vec<String>)> {
    let mut raised = None;
    let found = Inlined::new(text, |name, of| {
        let bytes = read
            .call1((name,))
            .and_then(|bytes| bytes.extract::<Vec<u8>>());
        match (bytes, of) {
            (Ok(bytes), Named::Table) => decoded(bytes),
            (Ok(bytes), Named::System) => {
                String::from_utf8(bytes).map_err(|_| "it is not UTF-8 text".into())
            }
            (Err(error), _) => {
                let why = error.to_string();
                raised = Some(error);
                Err(why)
            }
        }
    });
    match (found, raised) {
        (_, Some(error)) => Err(error),
        (Ok(found), None) => Ok((found.text, found.remarks)),
        (Err(NotInlined::Here(error)), None) => Err(of_text(py, error, text)),
        (Err(NotInlined::There { name, text, error }), None) => {
            let message = format!("{name}: {}", error.message);
            let span = error.span.map(|span| [span.start, span.end]);
            Err(input_error(py, (message, error.help), &text, span))
        }
    }
}

/// The plan of the sweep in `text`.
fn planned(py: Python, text: &str) -> PyResult<Arc<Plan>> {
    let plan = text.parse::<SweepSpec>().and_then(Plan::new);
    plan.map(Arc::new).map_err(|error| of_text(py, error, text))
}

/// The facts of a sweep, with the seconds that it takes on one thread where it is to be `timed`.
#[pyfunction]
pub(crate) fn plan<'py>(py: Python<'py>, text: &str, timed: bool) -> PyResult<Bound<'py, PyDict>> {
    let plan = planned(py, text)?;
    let (facts, shape) = (PyDict::new(py), PyDict::new(py));
    for axis in &plan.spec.axes {
        shape.set_item(axis.parameter.name(), axis.len())?;
    }
    facts.set_item("shape", shape)?;
    let fields: Vec<&str> = plan.spec.fields.iter().map(|field| field.name()).collect();
    facts.set_item("fields", fields)?;
    facts.set_item("cells", plan.cells())?;
    facts.set_item("pieces", plan.pieces().total())?;
    facts.set_item("bytes", plan.cells() * plan.bytes_per_cell())?;
    let memory = Memory::of(&plan);
    facts.set_item("memory", memory.on(1))?;
    facts.set_item("memory_of_a_thread", memory.per_thread)?;
    facts.set_item("hash", plan.hash())?;
    let seconds = match timed {
        true => {
            let costs = wait(py, None, |stop, _| {
                Costs::of(&plan, |_, _| 0, &Stop::when(stop))
            })?;
            Some(costs.seconds()[1])
        }
        false => None,
    };
    facts.set_item("seconds", seconds)?;
    Ok(facts)
}

/// The text of the setting of one cell of the sweep in `text`: that with these values on its axes.
#[pyfunction]
pub(crate) fn cell(py: Python, text: &str, at: Vec<(String, f64)>) -> PyResult<String> {
    let plan = planned(py, text)?;
    let mut setting = plan.spec.fixed.clone();
    for (name, value) in &at {
        let mut axes = plan.spec.axes.iter().map(|axis| &axis.parameter);
        let axis = axes.find(|of| of.name() == name);
        let axis = axis.ok_or_else(|| of_input(py, format!("{name} is no axis of the map")))?;
        setting.vary(axis, *value);
    }
    Ok(setting_text(&setting, &plan.spec.units, |_| true))
}

/// The map of the sweep in `text`: its dimensions, and its groups with their numbers.
#[pyfunction]
pub(crate) fn run<'py>(
    py: Python<'py>,
    text: &str,
    threads: usize,
    memory: Option<u64>,
    history: String,
    progress: Option<Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyList>> {
    let plan = planned(py, text)?;
    let cells = plan.cells().saturating_mul(plan.bytes_per_cell());
    let needs = Memory::of(&plan);
    let threads = match memory {
        None => Some(threads),
        Some(limit) => needs.threads_within(limit.saturating_sub(cells), threads),
    };
    let useful = usize::try_from(plan.pieces().total()).unwrap_or(usize::MAX);
    let threads = threads.map(|threads| threads.min(useful.max(1)));
    let Some(threads) = threads else {
        let least = needs.on(1).saturating_add(cells);
        let why = format!("this sweep takes up to {least} bytes of memory on one thread");
        return Err(PyMemoryError::new_err(why));
    };
    let found = wait(py, progress.as_ref(), |stop, done| {
        let attended = Attended {
            observer: done,
            stop,
        };
        let grid = Grid::compute(&plan, threads, attended)?;
        Ok(Filled::of_map(grid, &Provenance::here(history)))
    })?;
    let found = found.map_err(|error| of_run(py, error, text))?;
    groups(py, found)
}

/// The motion of the case in `text`, to which the table of its trace may be added: its samples and
/// events.
#[pyfunction]
pub(crate) fn simulate<'py>(
    py: Python<'py>,
    text: &str,
    end: &str,
    history: String,
) -> PyResult<Bound<'py, PyList>> {
    let spec: CaseSpec = text.parse().map_err(|error| of_text(py, error, text))?;
    let spec = match end {
        "" => spec,
        end => format!("{text}{end}")
            .parse()
            .map_err(|_| of_input(py, "until: the case has a table trace, where until belongs"))?,
    };
    let found = wait(py, None, |stop, _| {
        motion::Followed::whole(&spec, &Stop::when(stop))
            .map(|found| Filled::of_trace(&spec, &found.trace, &Provenance::here(history)))
    })?;
    let found = found.map_err(|error| match error {
        TraceError::Stopped => PyKeyboardInterrupt::new_err(()),
        TraceError::TooLong(_) => of_text(py, spec.too_long(error.to_string()), text),
        error => of_input(py, error),
    })?;
    groups(py, found)
}

/// Groups as lists of a name, attributes and variables. A variable is its name, its dimensions, its
/// numbers and its attributes.
fn groups(py: Python<'_>, whole: Filled) -> PyResult<Bound<'_, PyList>> {
    let Filled { described, numbers } = whole;
    let all = PyList::empty(py);
    for (group, columns) in described.groups.iter().zip(numbers) {
        let variables = PyList::empty(py);
        for (variable, column) in group.variables.iter().zip(columns) {
            let dimensions = variable.dimensions.iter();
            let names = dimensions.map(|&place| &*described.dimensions[place].name);
            let names = PyTuple::new(py, names.collect::<Vec<_>>())?;
            let shape: Vec<usize> = variable
                .dimensions
                .iter()
                .map(|&place| described.dimensions[place].length.unwrap_or(0))
                .collect();
            let flat = array(py, column);
            let shaped = flat.call_method1("reshape", (shape,))?;
            let told = attributes(py, &variable.attributes)?;
            variables.append((&variable.name, names, shaped, told))?;
        }
        all.append((group.name, attributes(py, &group.attributes)?, variables))?;
    }
    Ok(all)
}

fn array(py: Python<'_>, numbers: Numbers) -> Bound<'_, PyAny> {
    match numbers {
        Numbers::I8(of) => of.into_pyarray(py).into_any(),
        Numbers::I32(of) => of.into_pyarray(py).into_any(),
        Numbers::I64(of) => of.into_pyarray(py).into_any(),
        Numbers::U8(of) => of.into_pyarray(py).into_any(),
        Numbers::U16(of) => of.into_pyarray(py).into_any(),
        Numbers::F64(of) => of.into_pyarray(py).into_any(),
    }
}

/// Attributes as readers give them: texts and arrays, of one number the number itself. References
/// between variables belong to files.
fn attributes<'py>(py: Python<'py>, all: &[Attribute]) -> PyResult<Bound<'py, PyDict>> {
    let told = PyDict::new(py);
    for Attribute { name, value } in all {
        let array = match value {
            Value::Dimensions => continue,
            Value::Text(text) => {
                told.set_item(name, text)?;
                continue;
            }
            Value::I8(of) => PyArray1::from_slice(py, of).into_any(),
            Value::I32(of) => PyArray1::from_slice(py, of).into_any(),
            Value::U8(of) => PyArray1::from_slice(py, of).into_any(),
            Value::U16(of) => PyArray1::from_slice(py, of).into_any(),
            Value::U32(of) => PyArray1::from_slice(py, of).into_any(),
            Value::U64(of) => PyArray1::from_slice(py, of).into_any(),
            Value::F64(of) => PyArray1::from_slice(py, of).into_any(),
        };
        let one = array.len()? == 1;
        told.set_item(name, if one { array.get_item(0)? } else { array })?;
    }
    Ok(told)
}
