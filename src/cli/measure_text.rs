//! The output of `slipmap measure` for people, and what it warns of before it begins.

use std::io::Write;

use crate::answers::measure::Prospect;
use crate::explore::measure::{Foretold, MeasuredV0, Measurement};
use crate::linear::best::SearchedGain;
use crate::report::numbers::{rounded, unit_behind};
use crate::setting::experiment::{Chosen, ExperimentSpec};
use crate::setting::{Parameter, Setting};
use crate::text::Shown;

use super::digits::Digits;
use super::inputs_line;
use super::output::tell_dimensionless;

/// The most v0 that a warning names.
const MOST_NAMED: usize = 8;
/// Differences from the law below this are rounding.
const ROUNDED: f64 = 1e-11;
/// The least width of a column, and the blanks before what is wider.
const WIDTH: usize = 13;
const BETWEEN: usize = 2;

/// What controls: `load`, `velocity` or `both`.
pub(super) fn control(spec: &ExperimentSpec) -> &'static str {
    let gains = spec.setting.control();
    match spec.chosen {
        Chosen::Best(SearchedGain::Load) if gains.alpha_v == 0.0 => "load",
        Chosen::Best(SearchedGain::Velocity) if gains.alpha_n == 0.0 => "velocity",
        Chosen::Best(_) => "both",
        Chosen::Given if gains.alpha_v == 0.0 => "load",
        Chosen::Given if gains.alpha_n == 0.0 => "velocity",
        Chosen::Given => "both",
    }
}

/// What is known before it begins, for v0 that may not settle.
pub(super) fn warnings(foretold: &Foretold) -> Vec<String> {
    let kinds = [
        (
            Prospect::NoSetting,
            "no setting makes sliding stable; only what comes without control is averaged",
        ),
        (
            Prospect::Unstable,
            "sliding is not stable under this setting",
        ),
        (
            Prospect::BelowVc,
            "below v_c of its setting: stick-slip lives beside sliding, and may come instead",
        ),
        (
            Prospect::LiftOff,
            "the way to sliding may lead through a load of 0, where the model ends",
        ),
        (
            Prospect::Unknown,
            "whether stick-slip lives beside sliding is not known",
        ),
    ];
    let told = kinds.into_iter().filter_map(|(prospect, what)| {
        let all = foretold.foreseen().iter();
        let these = all.filter(|of| of.prospect == prospect).map(|of| of.v0);
        let these: Vec<f64> = these.collect();
        (!these.is_empty()).then(|| format!("v0 = {}: {what}", listed(&these)))
    });
    told.collect()
}

fn listed(v0: &[f64]) -> String {
    let few = v0.iter().take(MOST_NAMED).map(|v0| rounded(*v0, 5));
    let few = few.collect::<Vec<_>>().join(", ");
    match v0.len().checked_sub(MOST_NAMED) {
        Some(more @ 1..) => format!("{few} and {more} more"),
        _ => few,
    }
}

/// Writes what was found at every v0, and with which setting.
pub(super) fn print(
    out: &mut impl Write,
    foretold: &Foretold,
    measured: &Measurement,
    digits: Digits,
) -> std::io::Result<()> {
    let spec = foretold.spec();
    writeln!(out, "{}", sentence(spec, measured))?;
    let mut setting: Setting = spec.setting.clone();
    let mut left_out = vec![Parameter::V0];
    if let Chosen::Best(_) = spec.chosen {
        setting.set(Parameter::Tau, f64::NAN);
        left_out.push(Parameter::Tau);
    }
    inputs_line::print(out, &setting, &spec.units, &left_out)?;
    let velocity = unit_behind(&spec.units.of_parameter(Parameter::V0));
    let v0 = format!("v0{velocity}");
    let titles = ["mu_k", "error", "law", "off", "expected", "uncontrolled"];
    let mut table = Table::titled([&*v0].into_iter().chain(titles), "settled");
    for point in &measured.points {
        let number = |value: f64| digits.of(value);
        let cells = [
            number(point.v0),
            number(point.mu_k),
            error(point),
            number(point.law),
            small(point.off),
            small(point.bias()),
            number(point.uncontrolled),
        ];
        table.row(cells, settled(point, measured.repeats));
    }
    table.print(out)?;
    print_bound(out, measured)?;
    if measured.repeats > 1 {
        print_repeats(out, &v0, measured, digits)?;
    }
    print_settings(out, spec, measured, digits)?;
    tell_dimensionless(out, &spec.units)
}

/// Writes how far the repeats of every v0 are from one another, beside what is predicted.
fn print_repeats(
    out: &mut impl Write,
    v0: &str,
    measured: &Measurement,
    digits: Digits,
) -> std::io::Result<()> {
    writeln!(
        out,
        "standard deviation of one of {} repeats",
        measured.repeats
    )?;
    let mut table = Table::titled([v0, "found", "predicted"], "found/predicted");
    for point in &measured.points {
        let predicted = point.predicted.as_ref().map_or(f64::NAN, |of| of.error);
        let cells = [digits.of(point.v0), small(point.scatter), small(predicted)];
        let share = match predicted > 0.0 && point.scatter.is_finite() {
            true => rounded(point.scatter / predicted, 2),
            false => "none".to_owned(),
        };
        table.row(cells, share);
    }
    table.print(out)
}

/// Says what `<=` of an error means, where there is one.
fn print_bound(out: &mut impl Write, measured: &Measurement) -> std::io::Result<()> {
    match measured.points.iter().find_map(bound) {
        Some(bound) => writeln!(
            out,
            "readings have a resolution and no noise: each mean is off by up to half a step, {}, \
             which is no random error, and which no average and no repeat lessens",
            small(bound)
        ),
        None => Ok(()),
    }
}

/// Writes the setting of every v0.
fn print_settings(
    out: &mut impl Write,
    spec: &ExperimentSpec,
    measured: &Measurement,
    digits: Digits,
) -> std::io::Result<()> {
    writeln!(out, "settings, and how long each v0 was held and averaged")?;
    let unit = |p: Parameter| format!("{}{}", p.name(), unit_behind(&spec.units.of_parameter(p)));
    let [v0, alpha_v, alpha_n, tau] = [
        Parameter::V0,
        Parameter::AlphaV,
        Parameter::AlphaN,
        Parameter::Tau,
    ]
    .map(unit);
    let titles = [
        &*v0,
        &*alpha_v,
        &*alpha_n,
        &*tau,
        "spread",
        "relaxation",
        "v_c",
        "wait",
    ];
    let mut table = Table::titled(titles, "average");
    for point in &measured.points {
        let or_none = |value: Option<f64>| value.map_or("none".to_owned(), |of| digits.of(of));
        let cells = [
            digits.of(point.v0),
            or_none(point.alpha_v),
            or_none(point.alpha_n),
            or_none(point.tau),
            or_none(point.spread),
            or_none(point.abscissa.map(|abscissa| -1.0 / abscissa)),
            digits.of(point.vc),
            digits.of(point.wait),
        ];
        table.row(cells, digits.of(point.average));
    }
    table.print(out)
}

/// Rows of cells, with a text behind each.
struct Table(Vec<(Vec<String>, String)>);

impl Table {
    fn titled<'t>(titles: impl IntoIterator<Item = &'t str>, last: &str) -> Self {
        let titles = titles.into_iter().map(str::to_owned).collect();
        Self(vec![(titles, last.to_owned())])
    }

    fn row(&mut self, cells: impl Into<Vec<String>>, last: String) {
        self.0.push((cells.into(), last));
    }

    /// Writes the rows, in columns that are wider than their texts.
    fn print(&self, out: &mut impl Write) -> std::io::Result<()> {
        let width = |column: usize| {
            let cells = self.0.iter().filter_map(|(cells, _)| cells.get(column));
            let longest = cells.map(|cell| cell.chars().count()).max().unwrap_or(0);
            WIDTH.max(longest + BETWEEN)
        };
        let widths: Vec<usize> = (0..self.0[0].0.len()).map(width).collect();
        for (cells, last) in &self.0 {
            for (cell, width) in cells.iter().zip(&widths) {
                write!(out, "{cell:>width$}")?;
            }
            writeln!(out, "  {last}")?;
        }
        Ok(())
    }
}

/// The most by which rounding biases a mean, where it is no random error.
fn bound(point: &MeasuredV0) -> Option<f64> {
    let bound = point.predicted.as_ref()?.rounding_bound;
    Some(bound).filter(|bound| bound.is_finite())
}

/// The error of a mean, a standard error or a bound.
fn error(point: &MeasuredV0) -> String {
    match bound(point) {
        Some(bound) => format!("<= {}", small(bound)),
        None => small(point.mu_k_error),
    }
}

/// A small number beside others: three digits, and 0 for rounding.
fn small(value: f64) -> String {
    match value {
        _ if value.is_nan() => "none".to_owned(),
        _ if value.abs() < ROUNDED => "0".to_owned(),
        _ => rounded(value, 2),
    }
}

fn sentence(spec: &ExperimentSpec, measured: &Measurement) -> String {
    let all = measured.points.len();
    let settled = match measured.settled {
        some if some == all => format!("all {all} v0"),
        some => format!("{some} of {all} v0"),
    };
    let control = match control(spec) {
        "both" => "load and velocity control",
        "velocity" => "velocity control",
        _ => "load control",
    };
    let setting = match spec.chosen {
        Chosen::Given => "with the setting given".to_owned(),
        Chosen::Best(_) => best(measured),
    };
    let repeats = match spec.repeats {
        1 => String::new(),
        repeats => format!(", {} times", Shown(f64::from(repeats))),
    };
    format!("mu_k is measured at {settled} under {control}, {setting}{repeats}")
}

/// Which best setting each v0 has: a robust one, where it stands a spread.
fn best(measured: &Measurement) -> String {
    let count = |of: fn(&&MeasuredV0) -> bool| measured.points.iter().filter(of).count();
    let set = count(|point| point.tau.is_some());
    match count(|point| point.spread.is_some()) {
        _ if set == 0 => "none of which has a setting".to_owned(),
        robust if robust == set => "each with its best robust setting".to_owned(),
        robust => format!("each with its best setting, which is robust at {robust} of {set}"),
    }
}

/// Whether a v0 settled, or why not.
fn settled(point: &MeasuredV0, repeats: u32) -> String {
    let why = match point.unsettled {
        None => return "yes".to_owned(),
        Some("no-setting") => "no: there is no setting",
        Some("stops") => "no: the block stops",
        Some("off") => "no: it is not near v0",
        Some("at-limit") => "no: a limit is reached, which biases the mean",
        Some("lift-off") => "no: the load reaches 0",
        Some("steps") => "no: it takes more steps than `steps` allows",
        Some("drift") => "no: the drift leads out of its range",
        Some(_) => "no: it cannot be followed",
    };
    match repeats {
        1 => why.to_owned(),
        _ => format!("{why} ({} of {repeats} settled)", point.settled_repeats),
    }
}
