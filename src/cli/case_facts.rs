//! The facts of the case of one motion: `plan` prints them before it is simulated, `info` from its
//! trace.

use crate::model::{Control, MapModel, ReturnMap};
use crate::report::numbers::grouped;
use crate::setting::feedback_table::{MODELS, RETURN_MAP};
use crate::setting::{CaseSpec, Parameter};
use crate::slip::case::Start;
use crate::slip::programme::Corner;
use crate::text::Shown;
use serde::Serialize;
use utoipa::ToSchema;

use super::failure::Failure;
use super::json::as_object;
use super::say::Rows;

/// The case of one motion, with everything that its file leaves to defaults.
#[derive(Debug, Serialize, ToSchema)]
pub(super) struct CaseFacts {
    title: String,
    /// Name of the friction law.
    friction: &'static str,
    /// Which gains are not 0: `none`, `velocity`, `load` or `both`; or `return-map`.
    control: &'static str,
    /// Control by the return map; null under delayed feedback.
    #[schema(required)]
    return_map: Option<ReturnMapFacts>,
    /// Parameters by name.
    #[serde(serialize_with = "as_object")]
    #[schema(value_type = BTreeMap<String, f64>)]
    parameters: Vec<(&'static str, f64)>,
    /// Units of the parameters and of time, length, velocity and force, by name; `1` where there
    /// is none.
    #[serde(serialize_with = "as_object")]
    #[schema(value_type = BTreeMap<String, String>)]
    units: Vec<(&'static str, String)>,
    start: StartFacts,
    /// The pulling velocity in time; empty where it stays what it is.
    programme: Vec<CornerFacts>,
    /// When control is switched on; null where it never is, or at a phase of stick-slip.
    #[schema(required)]
    switch_on: Option<f64>,
    /// Until when the outcome is looked for.
    horizon: f64,
    tolerance: f64,
    /// The most steps of the integrator.
    steps: u64,
    /// End of the samples; null where they end when the outcome is known.
    #[schema(required)]
    until: Option<f64>,
}

/// Control by the return map.
#[derive(Debug, Serialize, ToSchema)]
struct ReturnMapFacts {
    /// The largest change of the load.
    amplitude: f64,
    /// `exact` or `reconstructed`.
    model: &'static str,
    /// The most readings of the record; null for the exact model.
    #[schema(required)]
    record: Option<u32>,
    /// The largest pulse of the load in it; null for the exact model.
    #[schema(required)]
    pulse: Option<f64>,
}

impl ReturnMapFacts {
    fn of(control: ReturnMap) -> Self {
        let record = match control.model {
            MapModel::Reconstructed(record) => Some(record),
            MapModel::Law { .. } | MapModel::Known(_) => None,
        };
        Self {
            amplitude: control.amplitude,
            model: MODELS[usize::from(record.is_some())],
            record: record.map(|record| record.readings),
            pulse: record.map(|record| record.pulse),
        }
    }
}

/// A corner of the programme of the pulling velocity.
#[derive(Debug, Serialize, ToSchema)]
struct CornerFacts {
    at: f64,
    v0: f64,
    /// Whether it comes there on a straight line.
    ramp: bool,
}

/// The block at t = 0.
#[derive(Debug, Serialize, ToSchema)]
struct StartFacts {
    x_dot0: f64,
    a0: f64,
    /// The file does not say where it starts: it slides a little faster than it is pulled.
    assumed: bool,
    /// Just released from uncontrolled stick-slip, this long before switch-on; null where it starts
    /// otherwise.
    #[schema(required)]
    switch_on_phase: Option<f64>,
}

impl CaseFacts {
    pub(super) fn of(spec: &CaseSpec) -> Self {
        let (setting, case) = (&spec.setting, &spec.case);
        let used = |p: &Parameter| setting.uses(*p) && !p.of_start();
        let parameters = || Parameter::ALL.into_iter().filter(used);
        let of_parameters = parameters().map(|p| (p.name(), spec.units.of_parameter(p)));
        let quantities = [
            ("time", [0, 0, 1]),
            ("length", [0, 1, 0]),
            ("velocity", [0, 1, -1]),
            ("force", [1, 0, 0]),
        ];
        let of_quantities = quantities.map(|(name, powers)| (name, spec.units.of(powers)));
        let (x_dot0, a0) = case.initial_state();
        let after_release = case.start == Start::AfterRelease;
        let switch_on = Some(case.switch_on).filter(|time| time.is_finite());
        Self {
            title: spec.title.clone(),
            friction: setting.law().map_or("", |law| law.name()),
            control: match case.feedback.return_map {
                Some(_) => RETURN_MAP,
                None => control(setting.control()),
            },
            return_map: case.feedback.return_map.map(ReturnMapFacts::of),
            parameters: parameters().map(|p| (p.name(), setting.get(p))).collect(),
            units: of_parameters.chain(of_quantities).collect(),
            start: StartFacts {
                x_dot0,
                a0,
                assumed: spec.start_assumed,
                switch_on_phase: switch_on.filter(|_| after_release),
            },
            programme: case
                .programme
                .0
                .iter()
                .map(|&Corner { at, v0, ramp }| CornerFacts { at, v0, ramp })
                .collect(),
            switch_on: switch_on.filter(|_| !after_release),
            horizon: case.horizon,
            tolerance: case.accuracy.tolerance,
            steps: case.steps,
            until: spec.until,
        }
    }

    /// End of the samples, if the file gives one.
    pub(super) const fn until(&self) -> Option<f64> {
        self.until
    }

    /// Control by the return map, by the keys that tell it; nothing under delayed feedback.
    pub(super) fn return_map_inputs(&self) -> Vec<(&'static str, String)> {
        let Some(map) = &self.return_map else {
            return Vec::new();
        };
        let record = map.record.map(|record| ("record", record.to_string()));
        let pulse = map.pulse.map(|of| ("pulse", self.with_unit("force", of)));
        let told = [
            ("control", self.control.to_owned()),
            ("amplitude", self.with_unit("force", map.amplitude)),
            ("model", map.model.to_owned()),
        ];
        told.into_iter().chain(record).chain(pulse).collect()
    }

    /// A value with the unit of the quantity `name`.
    pub(super) fn with_unit(&self, name: &str, value: f64) -> String {
        let value = Shown(value);
        let of = self.units.iter().find(|(of, _)| *of == name);
        match of.filter(|(_, unit)| unit != "1") {
            Some((_, unit)) => format!("{value} {unit}"),
            None => value.to_string(),
        }
    }

    /// Rows for people.
    pub(super) fn tell(&self, rows: &mut Rows) -> Result<(), Failure> {
        if !self.title.trim().is_empty() {
            rows.row("title", &self.title)?;
        }
        rows.row("friction", self.friction)?;
        rows.row("control", self.control)?;
        if let Some(map) = &self.return_map {
            let told = format!(
                "{}, model {}",
                self.with_unit("force", map.amplitude),
                map.model
            );
            rows.row("amplitude", told)?;
            if let (Some(record), Some(pulse)) = (map.record, map.pulse) {
                let pulse = self.with_unit("force", pulse);
                let told = format!("{record} readings at most, pulses of up to {pulse}");
                rows.row("record", told)?;
            }
        }
        for (name, value) in &self.parameters {
            rows.row(
                "fixed",
                format!("{name:<12} {}", self.with_unit(name, *value)),
            )?;
        }
        let start = &self.start;
        let state = format!(
            "x_dot0 = {}, a0 = {}",
            self.with_unit("velocity", start.x_dot0),
            self.with_unit("length", start.a0),
        );
        let how = match (start.switch_on_phase, start.assumed) {
            (Some(_), _) => ", just released from uncontrolled stick-slip",
            (None, true) => ", assumed: the file gives no start",
            (None, false) => "",
        };
        rows.row("start", state + how)?;
        if let Some(last) = self.programme.last() {
            let [at, v0] = [("time", last.at), ("velocity", last.v0)]
                .map(|(name, value)| self.with_unit(name, value));
            let entries = match self.programme.len() {
                1 => "1 entry".to_owned(),
                more => format!("{more} entries"),
            };
            rows.row(
                "programme",
                format!("{entries}; v0 = {v0} from t = {at} on"),
            )?;
        }
        rows.row("switch_on", self.switched_on())?;
        let (horizon, steps) = (self.with_unit("time", self.horizon), grouped(self.steps));
        rows.row("horizon", format!("t = {horizon}, {steps} steps at most"))?;
        rows.row("tolerance", format!("{:e}", self.tolerance))
    }

    fn switched_on(&self) -> String {
        match (self.switch_on, self.start.switch_on_phase) {
            (Some(time), _) => format!("t = {}", self.with_unit("time", time)),
            (None, Some(phase)) => {
                let phase = self.with_unit("time", phase);
                format!("{phase} after a release, modulo the period")
            }
            (None, None) => "never".to_owned(),
        }
    }
}

fn control(gains: Control) -> &'static str {
    match (gains.alpha_v != 0.0, gains.alpha_n != 0.0) {
        (false, false) => "none",
        (true, false) => "velocity",
        (false, true) => "load",
        (true, true) => "both",
    }
}
