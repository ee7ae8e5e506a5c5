//! `slipmap info` for a trace: its case, its contents, and the outcome of the motion.

use std::path::Path;

use crate::answers::trace::EVENTS;
use crate::report::numbers::{grouped, short};
use crate::setting::units::Units;
use crate::slip::outcome::Summary;
use crate::store::TraceFile;
use crate::sweep::described::trace::QUANTITIES;
use serde::Serialize;
use utoipa::ToSchema;

use super::case_facts::CaseFacts;
use super::digits::Digits;
use super::failure::Failure;
use super::info::{origin, tell_text};
use super::json::{self, Inputs, as_object};
use super::motion_text;
use super::say::Rows;

/// The form of the output.
#[derive(Debug, Clone, Copy)]
pub(super) enum Told {
    /// Rows for people.
    Rows,
    /// One JSON object.
    Json,
    /// The case file alone.
    Text,
}

/// What there is to say of a trace.
#[derive(Serialize, ToSchema)]
#[schema(as = TraceFacts)]
pub(super) struct Facts {
    kind: &'static str,
    /// What the trace says of where it comes from, by name.
    #[serde(serialize_with = "as_object")]
    #[schema(value_type = BTreeMap<String, String>)]
    origin: Vec<(&'static str, String)>,
    case: CaseFacts,
    samples: u64,
    /// From the first sample to the last, in time.
    duration: f64,
    fields: Vec<FieldFacts>,
    /// Number of events of each kind, by its name.
    #[serde(serialize_with = "as_object")]
    #[schema(value_type = BTreeMap<String, u64>)]
    events: Vec<(&'static str, u64)>,
    outcome: &'static str,
    #[serde(flatten)]
    numbers: Numbers,
    steps: u64,
}

/// What became of the motion in numbers; null where there is none. Times count from switch-on, but
/// `decided`.
#[derive(Serialize, ToSchema)]
struct Numbers {
    /// When the outcome was known; null where the trace does not tell.
    #[schema(required)]
    decided: Option<f64>,
    /// Until ẋ stays within 1 % of v0; null where it does not come to sliding.
    #[schema(required)]
    settle_time: Option<f64>,
    /// The smallest load since switch-on; null where the motion ended before.
    #[schema(required)]
    n_min: Option<f64>,
    /// The largest force of spring and dashpot since switch-on; null where it grew beyond all
    /// numbers.
    #[schema(required)]
    peak_force: Option<f64>,
    /// How long v or N was at a limit since switch-on; null without limits of actuators.
    #[schema(required)]
    time_at_limit: Option<f64>,
    /// The share of the time since switch-on for which it was; null without limits of actuators.
    #[schema(required)]
    share_at_limit: Option<f64>,
    /// Period of stick-slip; null where it did not end up in that.
    #[schema(required)]
    period: Option<f64>,
    /// Time stuck in one period; null where there is no period.
    #[schema(required)]
    stick_time: Option<f64>,
    /// Time in slip in one period; null where there is no period.
    #[schema(required)]
    slip_time: Option<f64>,
    /// Until the last stick ended; 0 where there is none after switch-on, null where sticks go on
    /// periodically.
    #[schema(required)]
    last_release: Option<f64>,
}

impl From<&Summary> for Numbers {
    fn from(summary: &Summary) -> Self {
        // Avoids −0.
        let told = |value: f64| value.is_finite().then_some(value + 0.0);
        Self {
            decided: told(summary.decided),
            settle_time: told(summary.settle_time),
            n_min: told(summary.n_min),
            peak_force: told(summary.peak),
            time_at_limit: told(summary.time_at_limit),
            share_at_limit: told(summary.share_at_limit),
            period: told(summary.period),
            stick_time: told(summary.stick_time),
            slip_time: told(summary.slip_time),
            last_release: told(summary.last_release),
        }
    }
}

#[derive(Serialize, ToSchema)]
#[schema(as = QuantityFacts)]
struct FieldFacts {
    name: &'static str,
    long_name: &'static str,
    unit: String,
    /// The smallest and the largest value of the samples.
    #[schema(value_type = [f64; 2])]
    range: (f64, f64),
}

pub(super) fn tell(path: &Path, what: Told) -> Result<(), Failure> {
    let file = TraceFile::open(path)?;
    match what {
        Told::Text => tell_text(&file.spec.text),
        Told::Json => json::print(&Inputs::default().and("file", path), &Facts::of(&file)),
        Told::Rows => Facts::of(&file).tell(&file.trace.summary, &file.spec.units),
    }
}

impl Facts {
    fn of(file: &TraceFile) -> Self {
        let trace = &file.trace;
        let of_kind = |(kind, name)| {
            let events = trace.events.iter().filter(|event| event.kind == kind);
            (name, events.count() as u64)
        };
        let summary = &trace.summary;
        let ends = trace.samples.first().zip(trace.samples.last());
        Self {
            kind: "trace",
            origin: origin(|name| file.root_text(name)),
            case: CaseFacts::of(&file.spec),
            samples: trace.samples.len() as u64,
            duration: ends.map_or(0.0, |(first, last)| last.t - first.t),
            fields: fields(file),
            events: EVENTS.into_iter().map(of_kind).collect(),
            outcome: summary.outcome.name(),
            numbers: summary.into(),
            steps: summary.steps,
        }
    }

    fn tell(&self, summary: &Summary, units: &Units) -> Result<(), Failure> {
        let mut rows = Rows::begin();
        let title = |name: &str| name == "title" || name == "friction";
        rows.row("kind", "a trace: one motion, by `slipmap simulate`")?;
        for (name, text) in self.origin.iter().filter(|(name, _)| !title(name)) {
            rows.row(name, text)?;
        }
        self.case.tell(&mut rows)?;
        let (samples, end) = (
            grouped(self.samples),
            self.case.with_unit("time", self.duration),
        );
        rows.row("samples", format!("{samples} over {end}"))?;
        for field in &self.fields {
            rows.row("field", field.text())?;
        }
        for (name, count) in self.events.iter().filter(|(_, count)| *count > 0) {
            rows.row("events", format!("{name:<12} {}", grouped(*count)))?;
        }
        rows.row("outcome", self.outcome)?;
        for (name, value) in motion_text::numbers(summary, units, Digits::default()) {
            rows.row("", format!("{name:<12} {value}"))?;
        }
        rows.row("", format!("{:<12} {}", "steps", grouped(self.steps)))
    }
}

fn fields(file: &TraceFile) -> Vec<FieldFacts> {
    let samples = &file.trace.samples;
    let facts = QUANTITIES.iter().map(|quantity| {
        let values = samples.iter().map(|sample| quantity.of(sample));
        let ends = (f64::INFINITY, f64::NEG_INFINITY);
        FieldFacts {
            name: quantity.name,
            long_name: quantity.long_name,
            unit: quantity.unit(&file.spec.units),
            range: values.fold(ends, |(low, high), v| (low.min(v), high.max(v))),
        }
    });
    facts.collect()
}

impl FieldFacts {
    fn text(&self) -> String {
        let unit = match self.unit.as_str() {
            "1" => String::new(),
            unit => format!(" {unit}"),
        };
        let (low, high) = self.range;
        let (name, what) = (self.name, self.long_name);
        format!("{name:<12} {what}, {} to {}{unit}", short(low), short(high))
    }
}
