//! Texts: sweep files, case files, columns of a friction law, manifests.

use slipmap::setting::measured::{CurveOptions, Measured};
use slipmap::setting::{CaseSpec, ExperimentSpec, SweepSpec};
use slipmap::store::tiles::Manifest;
use slipmap::sweep::described::root::Provenance;
use slipmap::sweep::{Plan, Shard, Todo};
use slipmap::text::SpecError;

/// Axes of more points than this are passed over: they cost time and nothing else. Long ones stand
/// among the regressions.
const LONG: usize = 20_000;

/// A sweep file, and its plan.
pub(super) fn sweep(data: &[u8]) {
    let Some(text) = short_axes(data) else { return };
    match planned(text) {
        Ok(plan) => look_at(&plan),
        Err(error) => check_error(&error, text),
    }
}

/// A case file with its motion; the same text as an experiment, and as columns of a friction law.
pub(super) fn case(data: &[u8]) {
    let Ok(text) = std::str::from_utf8(data) else {
        return;
    };
    match text.parse::<CaseSpec>() {
        Ok(spec) => {
            assert_eq!(spec.text, text);
            assert!(spec.case.motion().is_ok());
        }
        Err(error) => check_error(&error, text),
    }
    match text.parse::<ExperimentSpec>() {
        Ok(spec) => assert!(!spec.v0.is_empty() && spec.setting.law().is_some()),
        Err(error) => check_error(&error, text),
    }
    let measured = Measured::read(text, &CurveOptions::default());
    match measured.and_then(|curve| curve.table()) {
        Ok(table) => assert_eq!(table.speeds().len(), table.mu_k().len()),
        Err(error) => check_error(&error, text),
    }
}

/// A manifest, what it says differs from its own plan, and the same with the hash that its sweep
/// has.
pub(super) fn manifest(data: &[u8]) {
    let Ok(text) = std::str::from_utf8(data) else {
        return;
    };
    let found = match Manifest::parse(text) {
        Ok(found) => found,
        Err(why) => return assert!(!why.is_empty()),
    };
    if short_axes(found.sweep.as_bytes()).is_none() {
        return;
    }
    let written = serde_json::to_string_pretty(&found).unwrap();
    assert_eq!(Manifest::parse(&written).as_ref(), Ok(&found));
    assert_eq!(Manifest::unseal(&found.sealed()).as_ref(), Ok(&found));
    assert_eq!(found.difference(&found), None);
    let plan = match planned(&found.sweep) {
        Ok(plan) => plan,
        Err(error) => {
            check_error(&error, &found.sweep);
            return assert!(found.read_plan().is_err());
        }
    };
    assert_eq!(found.read_plan().is_ok(), plan.hash() == found.plan_hash);
    let shard = found.shard.parse::<Shard>().unwrap_or(Shard::WHOLE);
    let asked = Manifest::of(&plan, shard, &Provenance::default());
    for (one, other) in [(&found, &asked), (&asked, &found)] {
        match one.difference(other) {
            None => assert_eq!(one.layout(), other.layout()),
            Some(difference) => assert!(!difference.is_empty()),
        }
    }
    let sealed = Manifest {
        plan_hash: plan.hash(),
        ..found
    };
    assert!(sealed.read_plan().is_ok());
}

fn planned(text: &str) -> Result<Plan, SpecError> {
    text.parse::<SweepSpec>().and_then(Plan::new)
}

fn look_at(plan: &Plan) {
    assert!(!plan.tiles.is_empty() && plan.cells() > 0);
    for number in [0, plan.tiles.len() / 2, plan.tiles.len() - 1] {
        let tile = plan.tiles.tile(number);
        assert!(tile.cells() > 0 && tile.cells() <= plan.tiles.tile_cells() as u64);
        assert!(!plan.delays(plan.delay_range(&tile)).is_empty());
        let setting = plan.setting(&tile.offset);
        let _ = (setting.groups(), setting.friction_law());
    }
    assert_eq!(plan.hash().len(), 64);
    assert!(!plan.description().is_empty() && plan.bytes_per_cell() > 0);
    let pieces = plan.pieces();
    for place in [0, pieces.total() / 3, pieces.total() - 1] {
        assert_eq!(pieces.place(pieces.at(place)), Some(place));
    }
    if pieces.total() < 10_000 {
        assert!(Todo::all(plan.pieces()).next().is_some());
    }
}

/// The place is one in the text, and the whole can be shown.
fn check_error(error: &SpecError, text: &str) {
    assert!(!error.message.is_empty());
    let Some(span) = &error.span else { return };
    assert!(text.get(span.clone()).is_some(), "{span:?} of {text:?}");
    // Showing takes longer than reading.
    if text.len().is_multiple_of(64) {
        show(error, span.clone(), text);
    }
}

fn show(error: &SpecError, span: std::ops::Range<usize>, text: &str) {
    use miette::{GraphicalReportHandler, GraphicalTheme, LabeledSpan, MietteDiagnostic, Report};
    let diagnostic =
        MietteDiagnostic::new(error.message.clone()).with_label(LabeledSpan::at(span, "here"));
    let report = Report::new(diagnostic).with_source_code(text.to_owned());
    let mut shown = String::new();
    let handler = GraphicalReportHandler::new_themed(GraphicalTheme::unicode_nocolor());
    handler
        .render_report(&mut shown, report.as_ref())
        .expect("an error can be shown");
    assert!(!shown.is_empty());
}

/// The text, unless it asks for long axes.
fn short_axes(data: &[u8]) -> Option<&str> {
    let text = std::str::from_utf8(data).ok()?;
    let long = text.match_indices("points").any(|(at, key)| {
        let rest = &text[at + key.len()..];
        let value = rest.trim_start_matches(|c: char| !c.is_ascii_digit());
        let digits = value
            .chars()
            .take_while(|c| c.is_ascii_digit() || *c == '_');
        let number: String = digits.filter(char::is_ascii_digit).collect();
        // What is longer than any number that is taken is refused before anything is made of it.
        number
            .parse()
            .is_ok_and(|n: usize| n > LONG && n <= 10_000_000)
    });
    (!long).then_some(text)
}
