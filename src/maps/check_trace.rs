//! Checks whether a trace follows from its case: computes the motion again and compares it bit by
//! bit.

use super::check::Program;
use crate::answers::Trace;
use crate::answers::trace::{Sample, TraceEvent};
use crate::setting::Parameter;
use crate::store::TraceFile;
use crate::sweep::described::root::numbers_of_case;
use crate::sweep::described::schema::{root, trace};
use crate::sweep::described::trace::{QUANTITIES, TIME};

/// The largest difference allowed if another revision of the program computed the values, as a
/// share of the largest one of their kind. The same revision gives the same bits.
const OF_REVISIONS: f64 = 1e-6;

/// The result of checking a trace.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct TraceReport {
    /// Everything that is wrong, in words; empty for a sound trace.
    pub faults: Vec<String>,
    /// Other remarks.
    pub remarks: Vec<String>,
    /// Number of samples of the motion computed again.
    pub samples: u64,
    /// How many of them equal those of the trace, bit by bit.
    pub samples_equal: u64,
    /// Number of events of the motion computed again.
    pub events: u64,
    /// How many of them equal those of the trace, bit by bit.
    pub events_equal: u64,
}

/// Computes the motion of a trace again and compares it with everything stored in the trace.
#[must_use]
pub(crate) fn check_trace(file: &TraceFile, program: Program) -> TraceReport {
    let mut report = TraceReport::default();
    check_parameters(file, &mut report);
    let again = match Trace::of(&file.spec) {
        Ok(again) => again,
        Err(error) => {
            let fault = format!("its motion cannot be computed again: {error}");
            report.faults.push(fault);
            return report;
        }
    };
    let by = |name, this| file.root_text(name).as_deref() == Some(this);
    let own =
        by(root::PROGRAM_VERSION, program.version) && by(root::GIT_REVISION, program.revision);
    let room = if own { 0.0 } else { OF_REVISIONS };
    if !own {
        let remark = "another revision of slipmap computed it: values may differ by rounding";
        report.remarks.push(remark.to_owned());
    }
    compare_samples(&file.trace.samples, &again.samples, room, &mut report);
    compare_events(&file.trace.events, &again.events, room, &mut report);
    compare_outcomes(&file.trace, &again, room, &mut report);
    report
}

/// Checks the parameters and other attributes of the case in the file against its text.
fn check_parameters(file: &TraceFile, report: &mut TraceReport) {
    let setting = &file.spec.setting;
    let held = |p: &Parameter| setting.uses(*p) && !p.of_start();
    let parameters = Parameter::ALL.into_iter().filter(held);
    let parameters = parameters.map(|p| (p.name(), file.parameter(p), setting.get(p)));
    let numbers = numbers_of_case(&file.spec.case);
    let numbers = numbers.map(|(name, value)| (name, file.root_number(name), value));
    for (name, found, expected) in parameters.chain(numbers) {
        let fault = match found {
            Some(found) if found.to_bits() == expected.to_bits() => continue,
            Some(found) => format!("{name} is {found}, in its case {expected}"),
            None => format!("{name} is missing"),
        };
        report.faults.push(fault);
    }
}

/// Whether two values are equal, or differ by less than `room`.
fn same(found: f64, expected: f64, room: f64) -> bool {
    found.to_bits() == expected.to_bits() || (found - expected).abs() < room
}

/// The values of a quantity in the file, and the values computed again.
struct Compared<'a> {
    name: &'static str,
    found: Vec<f64>,
    expected: Vec<f64>,
    times: &'a [f64],
}

impl Compared<'_> {
    /// The places where they differ. Differences by more than the share `room` of the largest value
    /// are a fault.
    fn differences(&self, of: &str, room: f64, report: &mut TraceReport) -> Vec<usize> {
        let largest = self
            .expected
            .iter()
            .fold(0.0, |most: f64, v| most.max(v.abs()));
        let pairs = || self.found.iter().zip(&self.expected).enumerate();
        let differ = |room: f64| pairs().filter(move |(_, (f, e))| !same(**f, **e, room));
        let mut far = differ(room * largest);
        if let Some((first, (found, expected))) = far.next() {
            let (name, count) = (self.name, far.count() + 1);
            report.faults.push(format!(
                "{name} comes out differently in {count} of {} {of}, first at t = {}: {expected} \
                 for {found}",
                self.found.len(),
                self.times[first]
            ));
        }
        differ(0.0).map(|(place, _)| place).collect()
    }
}

/// Checks that there are equally many of both.
fn as_many(of: &str, found: usize, expected: usize, report: &mut TraceReport) {
    if found != expected {
        let fault = format!("it has {found} {of}, its motion has {expected}");
        report.faults.push(fault);
    }
}

/// How many of `count` places are equal in everything compared.
fn equal(count: usize, differences: &[Vec<usize>]) -> u64 {
    let mut differ: Vec<usize> = differences.concat();
    differ.sort_unstable();
    differ.dedup();
    (count - differ.len()) as u64
}

fn compare_samples(found: &[Sample], expected: &[Sample], room: f64, report: &mut TraceReport) {
    as_many("samples", found.len(), expected.len(), report);
    let count = found.len().min(expected.len());
    let times: Vec<f64> = expected.iter().map(|s| s.t).collect();
    let mut differences = Vec::new();
    for quantity in [&TIME].into_iter().chain(&QUANTITIES) {
        let of = |samples: &[Sample]| samples[..count].iter().map(|s| quantity.of(s)).collect();
        let compared = Compared {
            name: quantity.name,
            found: of(found),
            expected: of(expected),
            times: &times,
        };
        differences.push(compared.differences("samples", room, report));
    }
    let modes = (0..count).filter(|&i| found[i].mode != expected[i].mode);
    let modes: Vec<usize> = modes.collect();
    if let Some(&first) = modes.first() {
        let (n, t) = (modes.len(), times[first]);
        let fault =
            format!("mode comes out differently in {n} of {count} samples, first at t = {t}");
        report.faults.push(fault);
    }
    differences.push(modes);
    report.samples = expected.len() as u64;
    report.samples_equal = equal(count, &differences);
}

fn compare_events(
    found: &[TraceEvent],
    expected: &[TraceEvent],
    room: f64,
    report: &mut TraceReport,
) {
    as_many("events", found.len(), expected.len(), report);
    let count = found.len().min(expected.len());
    let times: Vec<f64> = expected.iter().map(|e| e.t).collect();
    let mut differences = Vec::new();
    for (name, elongation) in [(trace::TIME, false), (trace::ELONGATION, true)] {
        let value = |e: &TraceEvent| if elongation { e.a } else { e.t };
        let of = |events: &[TraceEvent]| events[..count].iter().map(value).collect();
        let compared = Compared {
            name,
            found: of(found),
            expected: of(expected),
            times: &times,
        };
        differences.push(compared.differences("events", room, report));
    }
    let kinds = (0..count).filter(|&i| found[i].kind != expected[i].kind);
    let kinds: Vec<usize> = kinds.collect();
    if let Some(&first) = kinds.first() {
        let (t, found, again) = (times[first], found[first].name(), expected[first].name());
        let fault = format!("the event at t = {t} is called {found}, again it is {again}");
        report.faults.push(fault);
    }
    differences.push(kinds);
    report.events = expected.len() as u64;
    report.events_equal = equal(count, &differences);
}

fn compare_outcomes(found: &Trace, expected: &Trace, room: f64, report: &mut TraceReport) {
    let (found, expected) = (&found.summary, &expected.summary);
    if found.outcome != expected.outcome {
        let (name, again) = (found.outcome.name(), expected.outcome.name());
        let fault = format!("its outcome is {name}, again it is {again}");
        report.faults.push(fault);
    }
    for ((name, value), (_, again)) in found.numbers().into_iter().zip(expected.numbers()) {
        let both_none = value.is_nan() && again.is_nan();
        if !both_none && !same(value, again, room * again.abs()) {
            let fault = format!("its {name} is {value}, again it is {again}");
            report.faults.push(fault);
        }
    }
    if found.steps != expected.steps && room == 0.0 {
        let (steps, again) = (found.steps, expected.steps);
        let fault = format!("it took {steps} steps, again it takes {again}");
        report.faults.push(fault);
    }
}
