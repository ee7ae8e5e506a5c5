//! Reads traces: the case, the samples, the events, the outcome of the motion.

use std::path::{Path, PathBuf};

use hdf5::{File, Group};

use super::attributes::{one_number, text};
use super::error::StoreError;
use super::open;
use super::values::{Number, whole};
use crate::answers::Trace;
use crate::answers::trace::{EVENTS, MODES, MOST_SAMPLES, Sample, TraceEvent};
use crate::setting::{CaseSpec, Parameter};
use crate::slip::case::Case;
use crate::slip::forces::{Forces, State};
use crate::slip::outcome::{Outcome, Summary};
use crate::sweep::described::schema::{self, trace};
use crate::sweep::described::trace::{QUANTITIES, TIME};

/// A trace, read into memory as a whole.
#[derive(Debug)]
pub struct TraceFile {
    path: PathBuf,
    file: File,
    /// The case, from its text in the file.
    pub spec: CaseSpec,
    /// Samples, events and the outcome of the motion, as stored. The number of slips in a period is
    /// not stored, and is 0.
    pub trace: Trace,
}

/// What a trace says besides its samples and events.
#[derive(Debug)]
pub(crate) struct TraceHead {
    /// The case, from its text in the file.
    pub spec: CaseSpec,
    /// Number of samples.
    pub samples: u64,
    /// The time of the last one.
    pub until: f64,
    /// How the motion ended up.
    pub outcome: Outcome,
    /// The version of the program that made it.
    pub program_version: Option<String>,
}

impl TraceHead {
    /// Reads the head of the trace at `path`.
    ///
    /// # Errors
    /// As [`TraceFile::open`].
    pub(crate) fn read(path: &Path) -> Result<Self, StoreError> {
        let (file, spec) = opened(path)?;
        let read = || -> hdf5::Result<_> {
            let times = column::<f64>(&file, TIME.name, None)?;
            let until = *times.last().ok_or(NO_SAMPLES)?;
            Ok((times.len() as u64, until, outcome(&file)?))
        };
        let read = read().map_err(|why| StoreError::not_a_trace(path, why.to_string()));
        let (samples, until, outcome) = read?;
        Ok(Self {
            spec,
            samples,
            until,
            outcome,
            program_version: text(&file, schema::root::PROGRAM_VERSION).ok(),
        })
    }
}

/// The file of the trace at `path`, and its case.
fn opened(path: &Path) -> Result<(File, CaseSpec), StoreError> {
    let file = open::to_read(path, StoreError::not_a_trace)?;
    let spec = case_text(&file, path)?.parse::<CaseSpec>();
    let spec = spec.map_err(|error| {
        let why = format!("its case cannot be read: {}", error.message);
        StoreError::not_a_trace(path, why)
    })?;
    Ok((file, spec))
}

/// Why a file without samples is no trace.
const NO_SAMPLES: &str = "it has no samples";

/// Whether the file at `path` can be opened and is marked as a trace, of any version.
#[must_use]
pub(crate) fn is_trace(path: &Path) -> bool {
    let file = open::to_read(path, StoreError::not_a_trace);
    file.is_ok_and(|file| one_number::<i32>(&file, trace::FORMAT_VERSION).is_some())
}

/// The text of the case of the trace at `path`.
///
/// # Errors
/// When there is no file, or it is no trace, or one of another format version.
pub(crate) fn case_of(path: &Path) -> Result<String, StoreError> {
    case_text(&open::to_read(path, StoreError::not_a_trace)?, path)
}

fn case_text(file: &File, path: &Path) -> Result<String, StoreError> {
    let missing = |name: &str| StoreError::not_a_trace(path, format!("it has no {name}"));
    match one_number::<i32>(file, trace::FORMAT_VERSION) {
        Some(schema::OLDEST_TRACE_FORMAT_VERSION..=schema::TRACE_FORMAT_VERSION) => {
            text(file, trace::CASE).map_err(|_| missing(trace::CASE))
        }
        Some(other) => {
            let (oldest, newest) = (
                schema::OLDEST_TRACE_FORMAT_VERSION,
                schema::TRACE_FORMAT_VERSION,
            );
            let why =
                format!("its format version is {other}, this program reads {oldest} to {newest}");
            Err(StoreError::not_a_trace(path, why))
        }
        None => Err(missing(trace::FORMAT_VERSION)),
    }
}

impl TraceFile {
    /// Reads the trace at `path`.
    ///
    /// # Errors
    /// When there is no file, or it is no trace, of another format version, or damaged.
    pub fn open(path: &Path) -> Result<Self, StoreError> {
        let (file, spec) = opened(path)?;
        let read = || -> hdf5::Result<Trace> {
            Ok(Trace {
                samples: samples(&file, &spec.case)?,
                events: events(&file)?,
                summary: summary(&file, spec.case.switch_on)?,
            })
        };
        let trace = read().map_err(|why| StoreError::not_a_trace(path, why.to_string()))?;
        Ok(Self {
            path: path.to_owned(),
            file,
            spec,
            trace,
        })
    }

    /// Where it is.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// A text attribute of the root, see [`schema::root`]; none where it is missing.
    #[must_use]
    pub(crate) fn root_text(&self, name: &str) -> Option<String> {
        text(&self.file, name).ok()
    }

    /// A numeric attribute of the root; none where it is missing.
    #[must_use]
    pub(crate) fn root_number(&self, name: &str) -> Option<f64> {
        one_number(&self.file, name)
    }

    /// The stored value of a parameter; none where it is missing.
    #[must_use]
    pub fn parameter(&self, parameter: Parameter) -> Option<f64> {
        let dataset = open::dataset(&self.file, parameter.name()).ok()?;
        match whole::<f64>(&dataset).ok()?[..] {
            [value] => Some(value),
            _ => None,
        }
    }
}

/// A column of a group. It must have `rows` values, where that is given.
fn column<T: Number>(of: &Group, name: &str, rows: Option<usize>) -> hdf5::Result<Vec<T>> {
    let damaged = |why: hdf5::Error| format!("its {name} cannot be read: {why}");
    let values = open::dataset(of, name).and_then(|dataset| match dataset.shape()[..] {
        [length] if length <= MOST_SAMPLES => whole::<T>(&dataset),
        [length] => Err(format!("it has {length} values, {MOST_SAMPLES} are the most").into()),
        _ => Err("it has other than one dimension".into()),
    });
    let values = values.map_err(damaged)?;
    match rows {
        Some(rows) if rows != values.len() => {
            Err(format!("it has {} values of {name} for {rows} times", values.len()).into())
        }
        _ => Ok(values),
    }
}

/// The kind that a number stands for in a column of kinds.
fn named<T: Copy>(all: &[(T, &str)], number: u8) -> hdf5::Result<T> {
    let known = all.get(usize::from(number)).map(|(value, _)| *value);
    known.ok_or_else(|| format!("it has a kind of number {number}, which there is not").into())
}

fn samples(file: &File, case: &Case) -> hdf5::Result<Vec<Sample>> {
    let times = column::<f64>(file, TIME.name, None)?;
    if times.is_empty() {
        return Err(NO_SAMPLES.into());
    }
    let rows = Some(times.len());
    let modes = column::<u8>(file, trace::MODE, rows)?;
    let [x, x_dot, a, v, n, pulling, friction] = QUANTITIES.map(|of| of.name);
    let reals = |name| column::<f64>(file, name, rows);
    let (x, x_dot, a, v, n) = (reals(x)?, reals(x_dot)?, reals(a)?, reals(v)?, reals(n)?);
    let forces = match [pulling, friction]
        .iter()
        .any(|name| file.link_exists(name))
    {
        true => Some((reals(pulling)?, reals(friction)?)),
        false => None,
    };
    let sample = |(i, t): (usize, f64)| {
        let state = State {
            mode: named(&MODES, modes[i])?,
            x_dot: x_dot[i],
            a: a[i],
            v: v[i],
            n: n[i],
        };
        // An older trace does not hold the forces; they follow from the rest.
        let forces = match &forces {
            Some((pulling, friction)) => Forces {
                pulling: pulling[i],
                friction: friction[i],
            },
            None => case.forces(state),
        };
        Ok(Sample::in_state(t, x[i], state, forces))
    };
    times.into_iter().enumerate().map(sample).collect()
}

fn events(file: &File) -> hdf5::Result<Vec<TraceEvent>> {
    let group = open::group(file, trace::EVENT)?;
    let times = column::<f64>(&group, trace::TIME, None)?;
    let kinds = column::<u8>(&group, trace::KIND, Some(times.len()))?;
    let elongations = column::<f64>(&group, trace::ELONGATION, Some(times.len()))?;
    let event = |((t, kind), a): ((f64, u8), f64)| {
        let kind = named(&EVENTS, kind)?;
        Ok(TraceEvent { t, kind, a })
    };
    times
        .into_iter()
        .zip(kinds)
        .zip(elongations)
        .map(event)
        .collect()
}

fn outcome(file: &File) -> hdf5::Result<Outcome> {
    let name = text(file, trace::OUTCOME)?;
    let mut all = Outcome::ALL.into_iter();
    let found = all.find(|outcome| outcome.name() == name);
    found.ok_or_else(|| "its outcome is none that there is".into())
}

fn summary(file: &File, switch_on: f64) -> hdf5::Result<Summary> {
    let outcome = outcome(file)?;
    let steps = one_number::<u64>(file, trace::STEPS).ok_or("it has no steps")?;
    let number = |name: &str| one_number::<f64>(file, name).unwrap_or(f64::NAN);
    let mut summary = Summary::of_numbers(outcome, steps, number);
    let version = one_number::<i32>(file, trace::FORMAT_VERSION);
    if version.is_some_and(|version| version < schema::RELEASED_SINCE_SWITCH_ON) {
        summary.last_release = Summary::released_after(outcome, summary.last_release, switch_on);
    }
    Ok(summary)
}
