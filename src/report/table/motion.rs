//! A motion as rows: one for each sample, or for each event.

use std::io::Write;
use std::sync::atomic::{AtomicBool, Ordering};

use super::{About, Column, Table, TableError};
use crate::answers::Trace;
use crate::answers::trace::MODES;
use crate::setting::simulation::{DISTURBED, assumed_start};
use crate::setting::{CaseSpec, Parameter};
use crate::sweep::described::schema::trace;
use crate::sweep::described::trace::{Quantity, TIME};

/// Writes the samples of a motion, one row each: time, `quantities`, and the mode as a word.
/// Returns the number of rows.
///
/// # Errors
/// When the text cannot be written, and once `stop` is set.
pub fn write_samples(
    spec: &CaseSpec,
    trace: &Trace,
    quantities: &[&Quantity],
    comments: bool,
    out: impl Write,
    stop: &AtomicBool,
) -> Result<u64, TableError> {
    let all = || [&TIME].into_iter().chain(quantities.iter().copied());
    let of = |q: &Quantity| Column::of(q.name, q.unit(&spec.units), q.long_name);
    let mode = Column::of(trace::MODE, "", "what the block does from then on");
    let columns: Vec<Column> = all().map(of).chain([mode]).collect();
    let about = comments.then(|| about(spec));
    let mut table = Table::begin(out, about.as_ref(), &columns)?;
    for sample in &trace.samples {
        if stop.load(Ordering::Relaxed) {
            return Err(TableError::Stopped);
        }
        for quantity in all() {
            table.number(quantity.of(sample))?;
        }
        let mode = MODES.iter().find(|(mode, _)| *mode == sample.mode);
        table.text(mode.map_or("", |(_, name)| name))?;
        table.end_row()?;
    }
    table.finish()
}

/// Writes the events of a motion, one row each: time, kind as a word, elongation. Returns the
/// number of rows.
///
/// # Errors
/// When the text cannot be written.
pub fn write_events(
    spec: &CaseSpec,
    trace: &Trace,
    comments: bool,
    out: impl Write,
) -> Result<u64, TableError> {
    let length = spec.units.of([0, 1, 0]);
    let columns = [
        Column::of(trace::TIME, spec.units.time(), "time of the event"),
        Column::of(trace::KIND, "", "what happens"),
        Column::of(trace::ELONGATION, length, "elongation of the spring then"),
    ];
    let about = comments.then(|| about(spec));
    let mut table = Table::begin(out, about.as_ref(), &columns)?;
    for event in &trace.events {
        table.number(event.t)?;
        table.text(event.name())?;
        table.number(event.a)?;
        table.end_row()?;
    }
    table.finish()
}

fn about(spec: &CaseSpec) -> About {
    let setting = &spec.setting;
    let used = |p: &Parameter| setting.uses(*p) && !p.of_start();
    let fixed = Parameter::ALL.into_iter().filter(used);
    let disturbance = if spec.start_assumed { DISTURBED } else { 0.0 };
    let texts = [
        ("title", Some(spec.title.clone())),
        ("friction", setting.law().map(|law| law.name().to_owned())),
        ("start", assumed_start(disturbance)),
    ];
    let fixed = fixed.map(|p| (p.into(), setting.get(p))).collect();
    About::new(texts, fixed, spec.units.clone())
}
