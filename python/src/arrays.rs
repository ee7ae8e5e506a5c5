//! Numbers at many points, as NumPy arrays.

use std::sync::atomic::{AtomicBool, Ordering};

use numpy::{PyArray1, PyReadonlyArrayDyn, PyUntypedArrayMethods};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyFloat, PyInt};
use slipmap::linear::status::SATURATED;
use slipmap::model::stop::Stop;
use slipmap::setting::field::{Field, Storage, fields_meant};
use slipmap::setting::{Parameter, Setting};
use slipmap::sweep::engine::{FEW_FILL, N_UNSTABLE_FILL, STATUS_FILL, TileBuffers, each};
use slipmap::sweep::evaluate::{Points, Wanted, evaluate as computed};
use slipmap::sweep::events::Attended;
use slipmap::text::SpecError;

use crate::error::{of_input, of_run, of_text};
use crate::lines::{Lines, Varied};
use crate::subject::Subject;
use crate::waiting::wait;

/// The most points at which numbers of a formula are tried together.
const TRIED: usize = 1000;

/// A setting with own numbers of the first point at which they can stand together.
fn first_that_fits(
    subject: &Subject,
    numbers: &[(&str, f64)],
    own: &[&Varied],
    optional: &[Parameter],
) -> Result<Setting, SpecError> {
    let at = |place: usize| {
        let of_own = own.iter().map(|of| (of.of.name(), of.any(place)));
        let all: Vec<(&str, f64)> = numbers.iter().copied().chain(of_own).collect();
        subject.at(&all, optional)
    };
    let first = at(0);
    if first.is_ok() {
        return first;
    }
    (1..TRIED)
        .find_map(|place| at(place).ok())
        .map_or(first, Ok)
}

/// Points: a setting, and what varies of it over a shape.
struct Asked {
    setting: Setting,
    varied: Vec<Varied>,
    shape: Vec<usize>,
}

impl Asked {
    /// Reads numbers and arrays of one shape by the names of parameters.
    fn read(subject: &Subject, at: &Bound<PyDict>, open: &[Parameter]) -> PyResult<Self> {
        let py = at.py();
        let (mut numbers, mut varied) = (Vec::new(), Vec::new());
        let mut names = Vec::with_capacity(at.len());
        for (name, value) in at.iter() {
            names.push((name.extract::<String>()?, value));
        }
        let mut shape = Vec::new();
        for (name, value) in &names {
            // First: some versions of NumPy turn an array of one number into a number.
            if value.is_instance_of::<PyFloat>() || value.is_instance_of::<PyInt>() {
                numbers.push((&**name, value.extract()?));
                continue;
            }
            let array: PyReadonlyArrayDyn<f64> = value
                .extract()
                .map_err(|_| PyTypeError::new_err(format!("{name} is no number")))?;
            shape = array.shape().to_vec();
            let Some(of) = subject.quantity(name) else {
                numbers.push((name, f64::NAN));
                continue;
            };
            let of = Varied::of(of, array.as_array());
            for value in of.known() {
                of.of.check(value).map_err(|why| of_input(py, why))?;
            }
            varied.push(of);
        }
        let known = varied.iter().filter_map(|of: &Varied| of.of.known());
        let optional: Vec<Parameter> = known.chain(open.iter().copied()).collect();
        // What only a system or a formula has is needed: a number of each that can stand together.
        let own: Vec<&Varied> = varied.iter().filter(|of| of.of.known().is_none()).collect();
        let setting = match own.is_empty() {
            true => subject.at(&numbers, &optional),
            false => first_that_fits(subject, &numbers, &own, &optional),
        };
        Ok(Self {
            setting: setting.map_err(|error| of_text(py, error, ""))?,
            varied,
            shape,
        })
    }

    fn lines(&self) -> Lines {
        Lines::of(&self.setting, &self.varied, &self.shape)
    }
}

/// The number of unstable roots at points, flat; −1 where it is infinite or not known.
#[pyfunction]
pub(crate) fn n_unstable<'py>(
    subject: &Subject,
    at: &Bound<'py, PyDict>,
    threads: usize,
) -> PyResult<Bound<'py, PyAny>> {
    let py = at.py();
    let asked = Asked::read(subject, at, &[])?;
    if asked.varied.is_empty() {
        let count = counter(&asked.setting)(asked.setting.get(Parameter::Tau));
        return Ok(count.into_pyobject(py)?.into_any());
    }
    let lines = asked.lines();
    let mut counts = vec![-1_i64; asked.shape.iter().product()];
    let increasing = |line: &[f64]| line.is_sorted_by(|one, next| one < next);
    let by_line = lines.length > 1 && (0..lines.first.len()).all(|at| increasing(lines.delays(at)));
    if by_line {
        count_by_line(py, &lines, threads, &mut counts)?;
    } else {
        let found = wait(py, None, |stop, _| {
            let places = (0..lines.first.len()).collect();
            each(
                places,
                threads,
                || (),
                |(), at| count_line(&lines, at, stop),
            )
        })?;
        let found = found.map_err(|error| of_run(py, error, ""))?;
        for (first, of_line) in lines.first.iter().zip(found) {
            for (place, count) in lines.along.iter().zip(of_line) {
                counts[first + place] = count;
            }
        }
    }
    Ok(PyArray1::from_vec(py, counts).into_any())
}

/// Counts at the delays of a line, in any order; none once `stop` is set.
fn count_line(lines: &Lines, at: usize, stop: &AtomicBool) -> Vec<i64> {
    if stop.load(Ordering::Relaxed) {
        return Vec::new();
    }
    let count = counter(&lines.settings[at].0);
    lines.delays(at).iter().map(|&delay| count(delay)).collect()
}

/// Counts along lines of increasing delays. A map holds counts up to 65534.
fn count_by_line(py: Python, lines: &Lines, threads: usize, counts: &mut [i64]) -> PyResult<()> {
    let wanted = Wanted::of(&[Field::NUnstable]).map_err(|e| of_text(py, e, ""))?;
    let found = cells(py, lines, &wanted, threads)?;
    let numbers = found.n_unstable.as_deref().unwrap_or_default();
    for (line, first) in lines.first.iter().enumerate() {
        let known = line * lines.length..(line + 1) * lines.length;
        let (numbers, status) = (&numbers[known.clone()], &found.status[known]);
        for (at, place) in lines.along.iter().enumerate() {
            counts[first + place] = match numbers[at] {
                N_UNSTABLE_FILL => -1,
                _ if status[at] & SATURATED != 0 => {
                    counter(&lines.settings[line].0)(lines.delays(line)[at])
                }
                number => i64::from(number),
            };
        }
    }
    Ok(())
}

/// Counts the unstable roots of a setting at any delay; −1 where it is infinite or not known.
fn counter(setting: &Setting) -> Box<dyn Fn(f64) -> i64> {
    if !setting.has_lines() {
        // Its polynomials depend on the delay.
        let setting = setting.clone();
        return Box::new(move |tau| count_at(setting.clone(), tau));
    }
    let Ok((model, time_unit)) = setting.answered() else {
        return Box::new(|_| -1);
    };
    let line = model.roots(&Stop::default()).line(time_unit);
    Box::new(move |tau| match tau >= 0.0 {
        true => line.n_unstable(tau).map_or(-1, |n| n as i64),
        false => -1,
    })
}

/// Counts the unstable roots of a setting at this delay; −1 where it is infinite or not known.
fn count_at(mut setting: Setting, tau: f64) -> i64 {
    setting.set(Parameter::Tau, tau);
    let model = setting.answered().ok().filter(|_| tau >= 0.0);
    let count = model.and_then(|(model, unit)| model.roots(&Stop::default()).count(tau, unit));
    count.map_or(-1, |count| count.n_unstable as i64)
}

/// Fields and the status at points, flat, by their names; NaN and fill values where there is none.
#[pyfunction]
pub(crate) fn evaluate<'py>(
    subject: &Subject,
    fields: Vec<String>,
    at: &Bound<'py, PyDict>,
    threads: usize,
) -> PyResult<Bound<'py, PyDict>> {
    let py = at.py();
    let named = |name: &String| {
        let unknown = || SpecError::whole(format!("unknown field \"{name}\""));
        let found = Field::from_name(name);
        found.ok_or_else(|| of_text(py, unknown().help(fields_meant(name)), ""))
    };
    let fields: Vec<Field> = fields.iter().map(named).collect::<PyResult<_>>()?;
    let wanted = Wanted::of(&fields).map_err(|error| of_text(py, error, ""))?;
    // A critical velocity is that of no velocity of the pull.
    let of_vc = wanted.fields().iter().all(|field| field.of_vc());
    let open: &[Parameter] = if of_vc { &[Parameter::V0] } else { &[] };
    let asked = Asked::read(subject, at, open)?;
    let lines = asked.lines();
    let found = cells(py, &lines, &wanted, threads)?;
    let all: usize = asked.shape.iter().product();
    let out = PyDict::new(py);
    let place = Places { lines: &lines, all };
    let (mut kinds, mut reals) = (found.kinds.into_iter(), found.columns.into_iter());
    let mut counts = found.n_unstable;
    for field in wanted.fields() {
        let cells = match field.storage() {
            Storage::Count => {
                let column = counts.take().unwrap_or_default();
                place.put(py, column, N_UNSTABLE_FILL).into_any()
            }
            Storage::Real => {
                let column = reals.next().map(|column| column.cells);
                place
                    .put(py, column.unwrap_or_default(), f64::NAN)
                    .into_any()
            }
            Storage::Kind | Storage::Few => {
                let column = kinds.next().map(|column| column.cells);
                place
                    .put(py, column.unwrap_or_default(), FEW_FILL)
                    .into_any()
            }
        };
        let unit = field.unit(subject.units());
        out.set_item(field.name(), (cells, field.long_name(), unit))?;
    }
    let status = place.put(py, found.status, STATUS_FILL);
    out.set_item("status", (status, "status of the cell", "1"))?;
    Ok(out)
}

/// Where the cells of lines stand among the points.
struct Places<'l> {
    lines: &'l Lines,
    all: usize,
}

impl Places<'_> {
    /// A column of lines in the order of the points.
    fn put<'py, T: numpy::Element + Copy>(
        &self,
        py: Python<'py>,
        column: Vec<T>,
        fill: T,
    ) -> Bound<'py, PyArray1<T>> {
        let Lines {
            first,
            along,
            length,
            ..
        } = self.lines;
        let in_order = |places: &[usize], step: usize| {
            let mut expected = (0..).step_by(step.max(1));
            places.iter().all(|place| expected.next() == Some(*place))
        };
        let known = !self.lines.some_unknown;
        if known && column.len() == self.all && in_order(along, 1) && in_order(first, *length) {
            return PyArray1::from_vec(py, column);
        }
        let mut points = vec![fill; self.all];
        for (line, first) in first.iter().enumerate() {
            let cells = &column[line * length..][..*length];
            let delays = self.lines.delays(line);
            for ((place, cell), delay) in along.iter().zip(cells).zip(delays) {
                if !delay.is_nan() {
                    points[first + place] = *cell;
                }
            }
        }
        PyArray1::from_vec(py, points)
    }
}

/// The cells of lines, one line after the other.
fn cells(py: Python, lines: &Lines, wanted: &Wanted, threads: usize) -> PyResult<TileBuffers> {
    let points = lines.settings.iter().enumerate();
    let points: Vec<Points> = points
        .map(|(line, (setting, _))| Points {
            setting,
            delays: lines.computed(line),
        })
        .collect();
    let found = wait(py, None, |stop, _| {
        computed(&points, wanted, threads, Attended::silently(stop))
    })?;
    found.map_err(|error| of_run(py, error, ""))
}
