//! `slipmap plan` for a case file: what `simulate` would do with it, without following the motion.

use std::path::{Path, PathBuf};

use crate::answers::trace::MOST_SAMPLES;
use crate::report::numbers::{bytes, grouped};
use crate::setting::CaseSpec;
use crate::setting::case_file::Sampling;
use crate::sweep::described::trace::BYTES_OF_A_SAMPLE;
use serde::Serialize;
use utoipa::ToSchema;

use super::case_facts::CaseFacts;
use super::failure::Failure;
use super::json::{self, Inputs};
use super::output::output_path;
use super::plot;
use super::say::Rows;
use super::sweep_file::STANDARD_INPUT;

/// What there is to say of a case.
#[derive(Serialize, ToSchema)]
#[schema(as = PlannedCase)]
pub(super) struct Facts {
    kind: &'static str,
    case: CaseFacts,
    /// Samples in each step of the integrator; null where they have an interval.
    #[schema(required)]
    samples_per_step: Option<u32>,
    /// Time between samples; null where they follow the steps.
    #[schema(required)]
    interval: Option<f64>,
    /// Samples of the trace, without those at events; null where only the motion tells.
    #[schema(required)]
    samples: Option<u64>,
    /// Bytes of so many samples before compression; null where only the motion tells.
    #[schema(required)]
    bytes: Option<u64>,
    /// The trace that `simulate` writes by default; null for a case from standard input.
    #[schema(required)]
    trace: Option<String>,
    /// The picture that it draws by default; null for a case from standard input.
    #[schema(required)]
    picture: Option<String>,
}

pub(super) fn tell(path: &Path, spec: &CaseSpec, json: bool) -> Result<(), Failure> {
    let facts = Facts::of(path, spec)?;
    match json {
        true => json::print(&Inputs::default().and("case", path), &facts),
        false => facts.tell(),
    }
}

impl Facts {
    fn of(path: &Path, spec: &CaseSpec) -> Result<Self, Failure> {
        let (samples_per_step, interval) = match spec.sampling {
            Sampling::PerStep(samples) => (Some(samples), None),
            Sampling::Interval(interval) => (None, Some(interval)),
        };
        let samples = spec
            .until
            .zip(interval)
            .map(|(end, each)| multiples(end, each));
        if let Some(samples) = samples.filter(|&samples| samples > MOST_SAMPLES as u64) {
            let (samples, most) = (grouped(samples), grouped(MOST_SAMPLES as u64));
            let message = format!("the trace would have {samples} samples, {most} are the most");
            let name = path.display().to_string();
            return Err(Failure::in_file(spec.too_long(message), &name, &spec.text));
        }
        let trace = match path == Path::new(STANDARD_INPUT) {
            true => None,
            false => Some(output_path(None, path, "trace")?),
        };
        let shown = |path: &PathBuf| path.display().to_string();
        Ok(Self {
            kind: "case",
            case: CaseFacts::of(spec),
            samples_per_step,
            interval,
            samples,
            bytes: samples.map(|samples| samples * BYTES_OF_A_SAMPLE),
            picture: trace.as_deref().map(plot::beside).as_ref().map(shown),
            trace: trace.as_ref().map(shown),
        })
    }

    fn tell(&self) -> Result<(), Failure> {
        let mut rows = Rows::begin();
        rows.row(
            "kind",
            "a case: one motion, which `slipmap simulate` follows",
        )?;
        self.case.tell(&mut rows)?;
        rows.row("samples", self.sampled())?;
        if let Some(size) = self.bytes {
            rows.row("bytes", format!("{} before compression", bytes(size)))?;
        }
        for (name, file) in [("trace", &self.trace), ("picture", &self.picture)] {
            if let Some(file) = file {
                rows.row(name, file)?;
            }
        }
        Ok(())
    }

    /// The number, density and end of the samples, in words.
    fn sampled(&self) -> String {
        let time = |value: f64| self.case.with_unit("time", value);
        let dense = match (self.interval, self.samples_per_step) {
            (Some(interval), _) => format!("one every {}", time(interval)),
            (None, samples) => format!("{} in each step", samples.unwrap_or(0)),
        };
        let until = match self.case.until() {
            Some(until) => format!("until t = {}", time(until)),
            None => "until the outcome is known".to_owned(),
        };
        let count = self.samples.map_or_else(String::new, |n| grouped(n) + ", ");
        format!("{count}{dense}, {until}; one more at each event")
    }
}

/// Number of multiples of `each` from 0 to `end`.
fn multiples(end: f64, each: f64) -> u64 {
    (end / each).floor() as u64 + 1
}
