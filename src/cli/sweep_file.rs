//! Reads sweep files, case files, experiments and tables of friction, with errors that point into
//! them.

use std::io::{self, Read};
use std::path::Path;

use crate::model::Table;
use crate::report::numbers::bytes;
use crate::setting::case_file::{TextKind, is_case_file};
use crate::setting::measured::{CurveOptions, Measured, decoded};
use crate::setting::point_file::{PointOf, PointSpec};
use crate::setting::system::SystemModel;
use crate::setting::table_file::{Inlined, Named, NotInlined};
use crate::setting::{CaseSpec, ExperimentSpec, SweepSpec};
use crate::store::regular::{self, NotRead};
use crate::sweep::Plan;
use crate::text::SpecError;

use super::failure::Failure;
use super::kind::Kind;
use super::output::tell_assumed_units;
use super::say;

/// The most bytes of a sweep or case file. The text goes into maps and, with up to twice as many
/// bytes, into manifests.
const MOST_BYTES: u64 = 16 << 20;

/// Refuses a file at `path` of a kind of text that is not `wanted`, in words.
fn check_kind(
    path: &Path,
    wanted: &str,
    refused: impl Fn(TextKind) -> bool,
) -> Result<(), Failure> {
    match Kind::of(path) {
        Some(kind @ Kind::Text(text)) if refused(text) => {
            let (message, help) = kind.not(path, wanted);
            Err(Failure::bad_input_with_help(message, help))
        }
        _ => Ok(()),
    }
}

/// Whether a text is neither a sweep nor a case.
fn is_another(kind: TextKind) -> bool {
    matches!(kind, TextKind::System | TextKind::Experiment)
}

/// The plan of the sweep file at `path`.
pub(super) fn read_plan(path: &Path) -> Result<Plan, Failure> {
    check_kind(path, "a sweep file, which has [axes]", |kind| {
        kind != TextKind::Sweep
    })?;
    let plan = read_with_table(path, "sweep", |text| {
        text.parse::<SweepSpec>().and_then(Plan::new)
    })?;
    tell_assumed_units(&plan.spec.units);
    Ok(plan)
}

/// The contents of a sweep or case file.
pub(super) enum Described {
    /// A map.
    Sweep(Plan),
    /// One motion.
    Case(CaseSpec),
}

/// Reads the sweep or case file at `path`.
pub(super) fn read_sweep_or_case(path: &Path) -> Result<Described, Failure> {
    check_kind(path, "a sweep or case file", is_another)?;
    let described = read_with_table(path, "sweep", |text| {
        if is_case_file(text) {
            return text.parse().map(Described::Case);
        }
        let plan = text.parse::<SweepSpec>().and_then(Plan::new);
        plan.map(Described::Sweep)
    })?;
    tell_assumed_units(match &described {
        Described::Sweep(plan) => &plan.spec.units,
        Described::Case(case) => &case.units,
    });
    Ok(described)
}

/// The case of the case file at `path`.
pub(super) fn read_case(path: &Path) -> Result<CaseSpec, Failure> {
    check_kind(path, "a case file", is_another)?;
    let case: CaseSpec = read_with_table(path, "case", str::parse)?;
    tell_assumed_units(&case.units);
    Ok(case)
}

/// The experiment of the file at `path`.
pub(super) fn read_experiment(path: &Path) -> Result<ExperimentSpec, Failure> {
    check_kind(path, "an experiment, which has [experiment]", |kind| {
        matches!(kind, TextKind::System | TextKind::Sweep)
    })?;
    let spec: ExperimentSpec = read_with_table(path, "experiment", str::parse)?;
    tell_assumed_units(&spec.units);
    Ok(spec)
}

/// Reads a point from the file at `path`.
pub(super) fn read_setting(path: &Path, of: PointOf) -> Result<PointSpec, Failure> {
    check_kind(path, "a file of a setting", |kind| {
        kind != TextKind::Setting
    })?;
    let point = read_with_table(path, "setting", |text| PointSpec::read(text, of))?;
    tell_assumed_units(&point.units);
    Ok(point)
}

/// Reads a friction curve from the columns of the file at `path`, for a law with this `mu_s`, its
/// default if none is given, and tells what was done with its rows.
pub(super) fn read_table(
    path: &Path,
    options: &CurveOptions,
    mu_s: Option<f64>,
) -> Result<Table, Failure> {
    read_curve_as(path, options, |curve| curve.table_of_law(mu_s))
}

/// Reads the points of a friction curve from the columns of the file at `path`, and tells what was
/// done with its rows.
pub(super) fn read_curve(path: &Path, options: &CurveOptions) -> Result<Measured, Failure> {
    read_curve_as(path, options, |curve| Ok(curve.clone()))
}

fn read_curve_as<T>(
    path: &Path,
    options: &CurveOptions,
    take: impl FnOnce(&Measured) -> Result<T, SpecError>,
) -> Result<T, Failure> {
    let (name, text) = text_of(path, "table", decoded)?;
    let failed = |error| Failure::in_file(error, &name, &text);
    let curve = Measured::read(&text, options).map_err(failed)?;
    let taken = take(&curve).map_err(failed)?;
    for remark in &curve.remarks {
        say::note(format_args!("{name}: {remark}"));
    }
    Ok(taken)
}

/// Reads the system in the file at `path`.
pub(super) fn read_system(path: &Path) -> Result<SystemModel, Failure> {
    let (name, text) = text_of(path, "system", utf_8)?;
    text.parse()
        .map_err(|error| Failure::in_file(error, &name, &text))
}

/// The name that stands for standard input.
pub(super) const STANDARD_INPUT: &str = "-";

/// Reads a file whose friction law may be in another file, with a path relative to the folder of
/// the first.
fn read_with_table<T>(
    path: &Path,
    kind: &str,
    parse: impl FnOnce(&str) -> Result<T, SpecError>,
) -> Result<T, Failure> {
    let (name, text) = text_of(path, kind, utf_8)?;
    let folder = match path == Path::new(STANDARD_INPUT) {
        true => None,
        false => path.parent(),
    };
    let beside = |name: &str, of: Named| {
        let path = folder.map_or_else(|| name.into(), |folder| folder.join(name));
        let read = regular::read(&path, MOST_BYTES);
        match of {
            Named::System => as_text(read, "system", utf_8),
            Named::Table => as_text(read, "table", decoded),
        }
    };
    let inlined = match Inlined::new(&text, beside) {
        Ok(inlined) => inlined,
        Err(NotInlined::Here(error)) => return Err(Failure::in_file(error, &name, &text)),
        Err(NotInlined::There { name, text, error }) => {
            return Err(Failure::in_file(error, &name, &text));
        }
    };
    for remark in &inlined.remarks {
        say::note(remark);
    }
    parse(&inlined.text).map_err(|error| Failure::in_file(inlined.in_original(error), &name, &text))
}

/// How the bytes of a text are read, or why they are none.
type Decoding = fn(Vec<u8>) -> Result<String, String>;

/// The name and the text of a file, or of standard input.
fn text_of(path: &Path, kind: &str, decoding: Decoding) -> Result<(String, String), Failure> {
    if let Some(other @ (Kind::Map | Kind::Trace)) = Kind::of(path) {
        let (message, help) = other.not(path, &format!("a {kind} file"));
        return Err(Failure::bad_input_with_help(message, help));
    }
    let (name, read) = match path == Path::new(STANDARD_INPUT) {
        true => (
            "standard input".to_owned(),
            read_standard_input().map_err(NotRead::Refused),
        ),
        false => (path.display().to_string(), regular::read(path, MOST_BYTES)),
    };
    match as_text(read, kind, decoding) {
        Ok(text) => Ok((name, text)),
        Err(why) => Err(Failure::bad_input(format!("cannot read {name}: {why}"))),
    }
}

/// The bytes read, as text, or why they are no text.
fn as_text(
    read: Result<Vec<u8>, NotRead>,
    kind: &str,
    decoding: Decoding,
) -> Result<String, String> {
    let most = || format!("a {kind} file has {} at most", bytes(MOST_BYTES));
    let read = match read {
        Ok(read) if read.len() as u64 > MOST_BYTES => return Err(most()),
        Ok(read) => read,
        Err(NotRead::Large(_)) => return Err(most()),
        Err(other) => return Err(other.to_string()),
    };
    decoding(read)
}

/// A text that is UTF-8.
fn utf_8(bytes: Vec<u8>) -> Result<String, String> {
    String::from_utf8(bytes).map_err(|_| "it is not UTF-8 text".into())
}

/// Reads standard input, up to one byte more than a file may have.
fn read_standard_input() -> io::Result<Vec<u8>> {
    let mut read = Vec::new();
    let input = std::io::stdin().lock();
    input.take(MOST_BYTES + 1).read_to_end(&mut read)?;
    Ok(read)
}
