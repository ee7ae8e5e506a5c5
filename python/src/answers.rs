//! One setting, with its answer as a dictionary.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use pyo3::exceptions::PyKeyError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use pythonize::{depythonize, pythonize};
use serde::{Deserialize, Serialize};
use slipmap::answers::best::{Ranges, default_ranges, longest_delay};
use slipmap::answers::search_plane::SearchPlane;
use slipmap::explore::basin::{BasinShare, Followed};
use slipmap::explore::best::{Control, Recommended, Searched};
use slipmap::explore::best_answer::BestSetting;
use slipmap::explore::known::Known;
use slipmap::explore::margins::Margins;
use slipmap::explore::point::Point;
use slipmap::explore::problem::{Problem, Why};
use slipmap::explore::robust::Spread;
use slipmap::explore::stability::Wanted;
use slipmap::explore::vc::CriticalVelocity;
use slipmap::model::stop::Stop;
use slipmap::setting::basin::{Basin, Over};
use slipmap::setting::command::{command_at, command_line, point_command, vc_command};
use slipmap::setting::law_kind::LawKind;
use slipmap::setting::point_file::{PointOf, PointSpec};
use slipmap::setting::quantity::Quantity;
use slipmap::setting::setting_text::{of_point, setting_text};
use slipmap::setting::simulation::Simulation;
use slipmap::setting::system::shipped;
use slipmap::setting::{Parameter, Setting};
use slipmap::text::SpecError;

use crate::error::{of_input, of_problem, of_run, of_text};
use crate::waiting::wait;

/// What is asked of a setting beside its text.
#[derive(Debug, Clone, Deserialize)]
#[serde(default)]
struct Options {
    /// How many roots of a point are told.
    roots: u8,
    /// The decay rate that margins are asked for.
    decay: f64,
    /// The parameter that is searched beside the delay, or two of them.
    search: Vec<String>,
    /// Ranges of the search by names.
    ranges: BTreeMap<String, (f64, f64)>,
    /// What a setting is to stand, in the words of the flag.
    robust: Option<String>,
    /// What the starts of a share are.
    over: String,
    /// How many starts.
    starts: u64,
    /// How many threads.
    threads: usize,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            roots: 16,
            decay: 0.0,
            search: vec![Parameter::AlphaV.name().to_owned()],
            ranges: BTreeMap::new(),
            robust: None,
            over: Over::State.name().to_owned(),
            starts: 4096,
            threads: 1,
        }
    }
}

/// An answer with the command that gives the same, none where flags cannot say it, and the text of
/// its setting.
fn told(
    py: Python,
    answer: &impl Serialize,
    command: Option<String>,
    toml: String,
    warning: Option<String>,
) -> PyResult<Py<PyAny>> {
    let whole = PyDict::new(py);
    whole.set_item("answer", pythonize(py, answer)?)?;
    whole.set_item("command", command)?;
    whole.set_item("toml", toml)?;
    whole.set_item("warning", warning)?;
    Ok(whole.into_any().unbind())
}

/// The answer to a question of this kind about the setting in `text`.
#[pyfunction]
pub(crate) fn answer(
    py: Python,
    kind: &str,
    text: &str,
    options: &Bound<PyAny>,
) -> PyResult<Py<PyAny>> {
    let options: Options = depythonize(options)?;
    let of = match kind {
        "vc" => PointOf::CriticalVelocity,
        "best" => PointOf::SlidingAtAnyDelay,
        _ => PointOf::Sliding,
    };
    let read = PointSpec::read(text, of);
    let spec = read.map_err(|error| of_text(py, error, text))?;
    match kind {
        "point" => point(py, &spec, &options, text),
        "margins" => margins(py, &spec, &options, text),
        "vc" => vc(py, &spec, text),
        "best" => best(py, spec, &options, text),
        "basin" => basin(py, &spec, &options, text),
        _ => Err(PyKeyError::new_err(kind.to_owned())),
    }
}

/// Work that heeds a stop, on a thread of its own.
fn heeding<T: Send>(py: Python, work: impl FnOnce(&Stop) -> T + Send) -> PyResult<T> {
    wait(py, None, |stop: &Arc<AtomicBool>, _| {
        work(&Stop::when(stop))
    })
}

fn whole(spec: &PointSpec) -> String {
    setting_text(&spec.setting, &spec.units, |_| true)
}

fn point(py: Python, spec: &PointSpec, options: &Options, text: &str) -> PyResult<Py<PyAny>> {
    let roots = options.roots;
    if !(1..=64).contains(&roots) {
        return Err(of_input(py, "roots: expected a whole number from 1 to 64"));
    }
    let wanted = Wanted { roots, line: None };
    let found = heeding(py, |stop| Point::at(&spec.setting, wanted, stop))?;
    let found = found.map_err(|why| of_problem(py, why.into(), text))?;
    let command = point_command(&spec.setting).map(|command| format!("{command} --roots={roots}"));
    let warning = spec.setting.curve_remark(&spec.units);
    told(py, &found, command, whole(spec), warning)
}

fn margins(py: Python, spec: &PointSpec, options: &Options, text: &str) -> PyResult<Py<PyAny>> {
    let decay = options.decay;
    if !(0.0..=1e12).contains(&decay) {
        let why = "decay: expected a number of 0 or more, at most 1e12";
        return Err(of_input(py, why));
    }
    let found = heeding(py, |stop| Margins::at(&spec.setting, decay, stop))?;
    let found = found.map_err(|why| of_problem(py, why.into(), text))?;
    let unknown = || {
        let (detail, help) = if spec.setting.system().is_some() {
            let why = "decay: margins of a system from a file are those of stability alone";
            (why.to_owned(), "leave decay out")
        } else {
            let law = spec.setting.law().map_or("", LawKind::name);
            (
                format!("margins of the {law} law are not known: it has a state"),
                "point() gives its delay margin and latency margin",
            )
        };
        let problem = Problem::new(Why::Unprocessable, detail);
        of_problem(py, problem.help(help), text)
    };
    let found = found.ok_or_else(unknown)?;
    let command = command_at("margins", &spec.setting);
    let command = command.map(|command| match decay {
        0.0 => command,
        decay => format!("{command} --decay={decay}"),
    });
    let warning = spec.setting.curve_remark(&spec.units);
    told(py, &found, command, whole(spec), warning)
}

fn vc(py: Python, spec: &PointSpec, text: &str) -> PyResult<Py<PyAny>> {
    let (setting, protocol) = (&spec.setting, spec.protocol);
    let found = heeding(py, |stop| CriticalVelocity::of(setting, protocol, stop))?;
    let found = found.map_err(|error| of_problem(py, error.into(), text))?;
    let warning = found.beyond_curve(setting, &spec.units);
    told(
        py,
        &found,
        vc_command(setting, protocol),
        text.to_owned(),
        warning,
    )
}

fn best(py: Python, spec: PointSpec, options: &Options, text: &str) -> PyResult<Py<PyAny>> {
    let PointSpec {
        mut setting, units, ..
    } = spec;

    let of = plane(&setting, &options.search).map_err(|error| of_text(py, error, text))?;
    let system = setting.system().is_some();
    let robust = options.robust.as_deref().map(Spread::read).transpose();
    let robust = robust.map_err(|why| of_input(py, format!("robust: {why}")))?;
    if robust.is_some() && (system || setting.rate_and_state().is_some()) {
        let why = "robust settings are known of a block under a law of the velocity alone";
        return Err(of_input(py, why));
    }
    let delay_given = !of.has_delay() && !setting.get(Parameter::Tau).is_nan();
    for open in [&of.p, &of.q] {
        setting.vary(open, open.default_value().unwrap_or(f64::NAN));
    }
    setting
        .sliding_point()
        .map_err(|error| of_problem(py, error.into(), text))?;
    let mut ranges = default_ranges(&setting, &of).map_err(|e| of_problem(py, e.into(), text))?;
    let mut delays = (0.0, longest_delay(&setting));
    for (name, (from, to)) in &options.ranges {
        let within = range((&mut ranges, &mut delays), &of, name, (*from, *to));
        within.map_err(|error| of_text(py, error, text))?;
    }
    let delays = (!of.has_delay() && !delay_given).then_some(delays);
    let asked = Searched {
        setting,
        units,
        of,
        ranges,
        delays,
        robust,
    };
    let found = heeding(py, |stop| Recommended::of(asked, stop))?;
    let found = found.map_err(|why| of_problem(py, why.into(), text))?;
    let toml = setting_text(&found.setting, &found.units, |_| true);
    let said =
        |p: Parameter| found.searched.p != p && p != Parameter::Tau && of_point(&found.setting, p);
    let control = match Control::of(&found.searched.p) {
        Control::Velocity => "velocity",
        Control::Load => "load",
    };
    let command = command_line("best", &found.setting, said).filter(|_| !system);
    let flags: String = options
        .ranges
        .iter()
        .map(|(name, (from, to))| {
            let flag = if name == "tau" { "tau" } else { "alpha" };
            format!(" --{flag}-from={from} --{flag}-to={to}")
        })
        .chain(
            options
                .robust
                .iter()
                .map(|robust| format!(" --robust={robust}")),
        )
        .collect();
    let command = command.map(|line| format!("{line} --control={control}{flags}"));
    told(py, &BestSetting::of(&found), command, toml, None)
}

/// The plane of the parameters of these names.
fn plane(setting: &Setting, names: &[String]) -> Result<SearchPlane, SpecError> {
    match names {
        [one] => Ok(SearchPlane::with_delay(searched(setting, one)?)),
        [one, other] if one != other && setting.system().is_some() => Ok(SearchPlane {
            p: searched(setting, one)?,
            q: searched(setting, other)?,
        }),
        _ => {
            let message = "search: expected a parameter, or two different ones of a system";
            Err(SpecError::whole(message).help("search=\"k_p\" or search=(\"k_p\", \"k_d\")"))
        }
    }
}

/// The parameter of this name.
fn searched(setting: &Setting, name: &str) -> Result<Quantity, SpecError> {
    let mut all = match setting.system() {
        Some(model) => model.quantities(),
        None => vec![Parameter::AlphaV.into(), Parameter::AlphaN.into()],
    };
    all.retain(|of| *of != Parameter::Tau);
    let names: Vec<&str> = all.iter().map(Quantity::name).collect();
    let unknown = || {
        SpecError::whole(format!("search: {name} is no parameter that is searched"))
            .help(format!("one of {}", names.join(", ")))
    };
    all.iter()
        .find(|of| of.name() == name)
        .cloned()
        .ok_or_else(unknown)
}

/// Puts the range of a parameter in the place of that by default.
fn range(
    (ranges, delays): (&mut Ranges, &mut (f64, f64)),
    of: &SearchPlane,
    name: &str,
    (from, to): (f64, f64),
) -> Result<(), SpecError> {
    let tau = Quantity::from(Parameter::Tau);
    let (quantity, range) = match name {
        _ if name == of.p.name() => (&of.p, &mut ranges.p),
        _ if name == of.q.name() => (&of.q, &mut ranges.q),
        _ if name == tau.name() => (&tau, delays),
        _ => {
            let message = format!("ranges: {name} is not searched");
            let searched = format!("{} and {} are", of.p.name(), of.q.name());
            return Err(SpecError::whole(message).help(searched));
        }
    };
    for end in [from, to] {
        quantity.check(end).map_err(SpecError::whole)?;
    }
    if from > to {
        return Err(SpecError::whole(format!(
            "ranges: {name} from {from} is above {to}"
        )));
    }
    *range = (from, to);
    Ok(())
}

fn basin(py: Python, spec: &PointSpec, options: &Options, text: &str) -> PyResult<Py<PyAny>> {
    let setting = &spec.setting;
    let mut asked = Basin {
        starts: Basin::check_starts(options.starts)
            .map_err(|why| of_input(py, format!("starts: {why}")))?,
        ..Basin::default()
    };
    let over = Over::ALL.into_iter().find(|of| of.name() == options.over);
    asked.over = over.ok_or_else(|| {
        let names = Over::ALL.map(Over::name).join(" nor ");
        of_input(py, format!("over: {} is neither {names}", options.over))
    })?;
    let refused = |error| of_run(py, error, text);
    if asked.over == Over::State {
        let model = |error: slipmap::model::ModelError| refused(error.into());
        asked.x_dot0 = Some(asked.velocities(setting).map_err(model)?);
        asked.a0 = Some(asked.elongations(setting).map_err(model)?);
    }
    let followed = wait(py, None, |stop, _| {
        let simulation = Simulation::default();
        Followed::of(setting, &simulation, &asked, (options.threads, stop))
    })?;
    let followed = followed.map_err(refused)?;
    let command = command_line("basin", setting, |p| of_point(setting, p));
    let command = command.map(|line| {
        let (over, starts) = (asked.over.name(), asked.starts);
        format!("{line} --over={over} --starts={starts}")
    });
    let warning = followed.beyond_curve(setting, &spec.units);
    told(
        py,
        &BasinShare::of(&followed),
        command,
        whole(spec),
        warning,
    )
}

/// The rows of a table of names: `parameters`, `fields`, `laws` or `systems`.
#[pyfunction]
pub(crate) fn catalogue(py: Python, kind: &str) -> PyResult<Py<PyAny>> {
    let known = Known::all();
    let rows = match kind {
        "parameters" => pythonize(py, &known.parameters)?,
        "fields" => pythonize(py, &known.fields)?,
        "laws" => pythonize(py, &known.laws)?,
        "systems" => systems(py)?.into_any(),
        _ => {
            let error = SpecError::whole(format!("there is no catalogue of {kind}"));
            let known = "parameters, fields, laws and systems have one";
            return Err(of_text(py, error.help(known), ""));
        }
    };
    Ok(rows.unbind())
}

/// The systems that are part of slipmap.
fn systems(py: Python<'_>) -> PyResult<Bound<'_, PyList>> {
    let rows = PyList::empty(py);
    for (name, _) in shipped::SHIPPED {
        let Some(model) = shipped::system(name) else {
            continue;
        };
        let row = PyDict::new(py);
        row.set_item("name", name)?;
        row.set_item("title", &model.title)?;
        let own = PyList::empty(py);
        for of in model.quantities() {
            let about = PyDict::new(py);
            about.set_item("name", of.name())?;
            about.set_item("long_name", of.long_name())?;
            about.set_item("default", of.default_value())?;
            about.set_item("range", of.range())?;
            own.append(about)?;
        }
        row.set_item("parameters", own)?;
        rows.append(row)?;
    }
    Ok(rows)
}
