//! What a file says of a setting, as plain data: for a page that takes it over.

use std::collections::BTreeMap;

use serde::Serialize;

use super::problem::{Problem, Why};
use crate::setting::axis::Axis;
use crate::setting::case_file::{TextKind, kind_of_text};
use crate::setting::law_kind::LawKind;
use crate::setting::point_file::{PointOf, PointSpec};
use crate::setting::units::Units;
use crate::setting::{CaseSpec, Parameter, Setting, SweepSpec};
use crate::slip::case::{Case, Start};

/// What a sweep file, a case file or a setting says.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "serve", derive(utoipa::ToSchema))]
pub struct GivenSetting {
    /// The title; empty where there is none.
    pub title: String,
    /// Parameters with their values, but for those along axes.
    pub values: BTreeMap<String, f64>,
    /// The friction law; null without one.
    #[cfg_attr(feature = "serve", schema(required))]
    pub law: Option<&'static str>,
    /// The expression of the law `formula`; null of another one.
    #[cfg_attr(feature = "serve", schema(required))]
    pub formula: Option<String>,
    /// Speeds and coefficients of the law `table`; empty of another one.
    pub points: Vec<[f64; 2]>,
    /// Units of force, length and time; null where none are given.
    #[cfg_attr(feature = "serve", schema(required))]
    pub units: Option<[String; 3]>,
    /// The axes of a sweep, but for those of one value.
    pub axes: Vec<GivenAxis>,
    /// The fields of a sweep.
    pub fields: Vec<&'static str>,
    /// Keys of a case that are not among these: when control begins.
    pub left_out: Vec<&'static str>,
}

/// An axis of a sweep.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "serve", derive(utoipa::ToSchema))]
pub struct GivenAxis {
    /// The parameter along it.
    pub name: String,
    /// Its smallest value.
    pub from: f64,
    /// Its largest value.
    pub to: f64,
    /// A value in the middle.
    pub middle: f64,
    /// Whether its values have equal ratios.
    pub log: bool,
}

/// How far ratios of values with equal ratios may be off.
const ROUNDING: f64 = 1e-6;

impl GivenAxis {
    fn of(axis: &Axis) -> Self {
        let values = &axis.values;
        let (first, last) = (values[0], values[values.len() - 1]);
        let equal = |step: fn(f64, f64) -> f64| {
            let steps = values.windows(2).map(|pair| step(pair[0], pair[1]));
            let all: Vec<f64> = steps.collect();
            all.iter()
                .all(|of| (of - all[0]).abs() <= ROUNDING * all[0].abs())
        };
        Self {
            name: axis.parameter.name().to_owned(),
            from: first.min(last),
            to: first.max(last),
            middle: values[values.len() / 2],
            log: first * last > 0.0 && equal(|a, b| b / a) && !equal(|a, b| b - a),
        }
    }
}

impl GivenSetting {
    /// Reads a sweep file, a case file or a setting.
    ///
    /// # Errors
    /// When the text is none of them, or of a system from a file.
    pub fn read(text: &str, most_points: u64) -> Result<Self, Problem> {
        let given = match kind_of_text(text) {
            Some(TextKind::System) => return Err(of_system()),
            Some(TextKind::Sweep) => Self::of_sweep(&SweepSpec::read(text, most_points)?),
            Some(TextKind::Case) => {
                let case: CaseSpec = text.parse()?;
                let given = Self::of(&case.setting, &case.units, &case.title);
                given.map(|given| Self {
                    left_out: switched_later(&case.case),
                    ..given
                })
            }
            Some(TextKind::Setting | TextKind::Experiment) | None => {
                let point = PointSpec::read(text, PointOf::Sliding)?;
                Self::of(&point.setting, &point.units, "")
            }
        };
        given.ok_or_else(of_system)
    }

    fn of_sweep(sweep: &SweepSpec) -> Option<Self> {
        let long = sweep.axes.iter().filter(|axis| axis.len() > 1);
        let axes: Vec<GivenAxis> = long.map(GivenAxis::of).collect();
        let mut given = Self::of(&sweep.fixed, &sweep.units, &sweep.title)?;
        for axis in sweep.axes.iter().filter(|axis| axis.len() == 1) {
            let value = (axis.parameter.name().to_owned(), axis.values[0]);
            given.values.extend([value]);
        }
        given
            .values
            .retain(|name, _| axes.iter().all(|axis| axis.name != *name));
        let fields = sweep.fields.iter().map(|field| field.name());
        Some(Self {
            axes,
            fields: fields.collect(),
            ..given
        })
    }

    /// What a setting says; none of a system from a file.
    fn of(setting: &Setting, units: &Units, title: &str) -> Option<Self> {
        if setting.system().is_some() {
            return None;
        }
        let known = Parameter::ALL.into_iter().filter(|p| setting.uses(*p));
        let known = known.map(|p| (p.name().to_owned(), setting.get(p)));
        let own = setting.own().map(|(own, value)| (own.name.clone(), value));
        let points = match setting.law() {
            Some(LawKind::Table(table)) => {
                let pairs = table.speeds().iter().zip(table.mu_k());
                pairs.map(|(&v, &mu)| [v, mu]).collect()
            }
            _ => Vec::new(),
        };
        Some(Self {
            title: title.to_owned(),
            values: known.chain(own).filter(|(_, x)| !x.is_nan()).collect(),
            law: setting.law().map(LawKind::name),
            formula: setting.formula().map(|of| of.text().to_owned()),
            points,
            units: units.force_length_time.clone(),
            axes: Vec::new(),
            fields: Vec::new(),
            left_out: Vec::new(),
        })
    }
}

/// The key that says when control begins, if that is later than t = 0.
fn switched_later(case: &Case) -> Vec<&'static str> {
    match case.start {
        Start::AfterRelease => vec!["switch_on_phase"],
        Start::State { .. } if case.switch_on > 0.0 => vec!["switch_on"],
        Start::State { .. } => Vec::new(),
    }
}

fn of_system() -> Problem {
    let detail = "this is about a system from a file; only the block is taken over from files";
    Problem::new(Why::Unprocessable, detail)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<GivenSetting, Problem> {
        GivenSetting::read(text, 1000)
    }

    #[test]
    fn files_of_all_kinds_are_told() {
        let sweep = read(
            "title = \"t\"\nfields = [\"n_unstable\", \"vc\"]\n[axes]\nmu_prime_rest = [-0.5]\n\
             alpha_n = { from = 0.1, to = 10.0, points = 5, spacing = \"log\" }\n\
             tau = { from = 0.5, to = 12.0, points = 5 }\n[fixed]\nv0 = 0.2\n\
             [friction]\nlaw = \"weakening\"\nmu0 = 0.5\n",
        );
        let sweep = sweep.unwrap();
        assert_eq!((sweep.law, &*sweep.title), (Some("weakening"), "t"));
        let told: Vec<_> = sweep
            .axes
            .iter()
            .map(|a| (&*a.name, a.from, a.to, a.log))
            .collect();
        assert_eq!(
            told,
            [("alpha_n", 0.1, 10.0, true), ("tau", 0.5, 12.0, false)]
        );
        assert_eq!(
            (sweep.values["mu_prime_rest"], sweep.values["v0"]),
            (-0.5, 0.2)
        );
        assert!(!sweep.values.contains_key("tau"));
        assert_eq!(sweep.fields, ["n_unstable", "vc"]);
        let case = read(
            "switch_on = 70.0\n[fixed]\nv0 = 0.35\ntau = 4.15\n[friction]\nlaw = \"table\"\n\
             speeds = [0.0, 1.0]\nmu_k = [0.5, 0.25]\n[start]\nx_dot0 = 0.3\n[units]\n\
             force = \"N\"\nlength = \"m\"\ntime = \"s\"\n",
        );
        let case = case.unwrap();
        assert_eq!(case.left_out, ["switch_on"]);
        assert_eq!(case.points, [[0.0, 0.5], [1.0, 0.25]]);
        assert_eq!((case.values["x_dot0"], case.values["v0"]), (0.3, 0.35));
        assert_eq!(case.units.unwrap()[1], "m");
        let point = read("[fixed]\nmu_prime = -0.3\nalpha_v = -0.33\ntau = 4.15\n").unwrap();
        assert_eq!((point.law, point.values["mu_prime"]), (None, -0.3));
        let formula = read(
            "[fixed]\nv0 = 0.2\ntau = 1\n[friction]\nlaw = \"formula\"\n\
             mu_k = \"c*exp(-v)\"\nc = 0.4\n",
        );
        let formula = formula.unwrap();
        assert_eq!(formula.formula.as_deref(), Some("c*exp(-v)"));
        assert_eq!(formula.values["c"], 0.4);
    }

    #[test]
    fn mistakes_have_their_place() {
        let wrong = read("[fixed]\nmu_prime = -0.3\nalpha_w = 1\ntau = 1\n").unwrap_err();
        assert!(wrong.span.is_some() && wrong.detail.unwrap().contains("alpha_w"));
        assert!(read("rate = 1\n").is_err());
        let system = "system = \"turning\"\n[fixed]\ntau = 1\n";
        assert!(read(system).unwrap_err().detail.unwrap().contains("system"));
    }
}
