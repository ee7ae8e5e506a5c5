//! The attributes of a file: who made it, the sweep or the case, the friction law.

use super::schema::{self, root, trace as names};
use super::{Attribute, attribute};
use crate::answers::trace::Trace;
use crate::setting::case_file::CaseSpec;
use crate::setting::law_kind::LawKind;
use crate::setting::search::LIMIT;
use crate::setting::values::Setting;
use crate::slip::case::Case;
use crate::sweep::plan::Plan;

/// Who made a file, for its root attributes.
#[derive(Debug, Clone, Default)]
pub struct Provenance {
    /// Version of the program.
    pub program_version: String,
    /// Git revision of the program.
    pub git_revision: String,
    /// When and by which command; the one thing in a map that differs from run to run.
    pub history: String,
}

impl Provenance {
    /// This library, with the history of a file.
    #[must_use]
    pub fn here(history: String) -> Self {
        Self {
            program_version: crate::VERSION.into(),
            git_revision: crate::REVISION.into(),
            history,
        }
    }
}

/// The attributes of every file: title and who made it.
fn of_file(title: &str, provenance: &Provenance) -> Vec<Attribute> {
    let version = &*provenance.program_version;
    vec![
        attribute("Conventions", schema::CONVENTIONS),
        attribute(root::TITLE, title),
        attribute(root::SOURCE, format!("slipmap {version}")),
        attribute(root::HISTORY, &*provenance.history),
        attribute("references", "F.-J. Elmer, Controlling friction (1997)"),
        attribute(root::PROGRAM_VERSION, version),
        attribute(root::GIT_REVISION, &*provenance.git_revision),
    ]
}

/// The attributes of a map.
pub(super) fn of_map(plan: &Plan, provenance: &Provenance) -> Vec<Attribute> {
    let spec = &plan.spec;
    let names: Vec<&str> = spec.axes.iter().map(|axis| axis.parameter.name()).collect();
    let mut attributes = of_file(&spec.title, provenance);
    attributes.extend([
        attribute(root::FORMAT_VERSION, [schema::FORMAT_VERSION]),
        attribute(root::AXES, names.join(" ")),
        attribute(root::PLAN_HASH, plan.hash()),
        attribute(root::SWEEP, &*spec.text),
    ]);
    let disturbance = spec.simulation.disturbance;
    if disturbance != 0.0 {
        attributes.push(attribute(root::DISTURBANCE, [disturbance]));
    }
    attributes.push(attribute(root::MARGINAL_TOLERANCE, [spec.tolerance.0]));
    if spec.limit {
        attributes.push(attribute(root::PROTOCOL, LIMIT));
    }
    attributes.extend(friction(&spec.fixed));
    attributes
}

/// What the scalar coordinates leave out: the system, and the friction law with its table.
fn friction(setting: &Setting) -> Vec<Attribute> {
    let mut attributes = Vec::new();
    if let Some(system) = setting.system() {
        attributes.push(attribute(root::SYSTEM, system.to_toml()));
    }
    if let Some(law) = setting.law() {
        attributes.push(attribute(root::FRICTION_LAW, law.name()));
    }
    if let Some(LawKind::Table(table)) = setting.law() {
        attributes.push(attribute(root::FRICTION_SPEEDS, table.speeds()));
        attributes.push(attribute(root::FRICTION_MU_K, table.mu_k()));
    }
    if let Some(formula) = setting.formula() {
        attributes.push(attribute(root::FRICTION_FORMULA, formula.text()));
    }
    attributes
}

/// The attributes of the root that describe a case, besides its parameters, by name.
#[must_use]
pub(crate) fn numbers_of_case(case: &Case) -> [(&'static str, f64); 5] {
    let (x_dot0, a0) = case.initial_state();
    [
        ("x_dot0", x_dot0),
        ("a0", a0),
        ("switch_on", case.switch_on),
        ("horizon", case.horizon),
        ("tolerance", case.accuracy.tolerance),
    ]
}

/// The attributes of a trace.
pub(super) fn of_trace(spec: &CaseSpec, found: &Trace, provenance: &Provenance) -> Vec<Attribute> {
    let summary = &found.summary;
    let numbers = |numbers: &[(&'static str, f64)]| -> Vec<Attribute> {
        let each = numbers.iter();
        each.map(|&(name, value)| attribute(name, [value]))
            .collect()
    };
    let mut attributes = of_file(&spec.title, provenance);
    attributes.extend([
        attribute(names::FORMAT_VERSION, [schema::TRACE_FORMAT_VERSION]),
        attribute(names::CASE, &*spec.text),
    ]);
    attributes.extend(friction(&spec.setting));
    attributes.extend(numbers(&numbers_of_case(&spec.case)));
    attributes.push(attribute(names::OUTCOME, summary.outcome.name()));
    attributes.extend(numbers(&summary.numbers()));
    attributes.push(attribute(names::STEPS, [summary.steps]));
    attributes
}
