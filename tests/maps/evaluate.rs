//! Fields at any points, against the cells of sweeps.

use std::cell::Cell;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::every_kind::{SWEEPS, plan};
use slipmap::setting::law_kind::LawKind;
use slipmap::setting::{Field, Parameter, Setting};
use slipmap::sweep::cells::buffers::TileBuffers;
use slipmap::sweep::evaluate::{Points, Wanted, evaluate};
use slipmap::sweep::events::{Attended, Event, Observer};
use slipmap::sweep::grid::Grid;
use slipmap::sweep::{Plan, RunError};

/// The bits of all columns from a cell on.
fn bits(cells: &TileBuffers, at: usize, count: usize) -> Vec<Vec<u64>> {
    let mut bits = vec![
        cells.status[at..at + count]
            .iter()
            .map(|&s| u64::from(s))
            .collect(),
    ];
    let counts = cells.n_unstable.iter();
    bits.extend(counts.map(|n| n[at..at + count].iter().map(|&n| u64::from(n)).collect()));
    let kinds = cells.kinds.iter();
    bits.extend(kinds.map(|c| {
        c.cells[at..at + count]
            .iter()
            .map(|&k| u64::from(k))
            .collect()
    }));
    let reals = cells.columns.iter();
    bits.extend(reals.map(|c| {
        c.cells[at..at + count]
            .iter()
            .map(|v| v.to_bits())
            .collect()
    }));
    bits
}

/// Every line of a map, and its delays one by one in another order.
#[test]
fn points_have_the_bits_of_cells() {
    for text in SWEEPS {
        let (plan, never) = (Arc::new(plan(text)), Arc::default());
        let attended = Attended::silently(&never);
        let grid = Grid::compute(&plan, 1, attended).unwrap();
        let mut wanted = Wanted::of(&plan.spec.fields).unwrap();
        wanted.basin = plan.spec.basin.unwrap_or_default();
        assert_eq!(wanted.fields(), plan.spec.fields);
        let along = plan.delays(0..plan.tau_axis.map_or(1, |axis| plan.shape()[axis]));
        let last = plan
            .tau_axis
            .is_none_or(|axis| axis + 1 == plan.shape().len());
        assert!(last, "lines lie together");
        let lines = plan.cells() as usize / along.len();
        let settings: Vec<_> = (0..lines)
            .map(|line| plan.setting(&index(&plan, line * along.len())))
            .collect();
        let points = |delays| -> Vec<Points> {
            let each = settings.iter();
            each.map(|setting| Points { setting, delays }).collect()
        };
        for threads in [1, 2] {
            let found = evaluate(&points(&along), &wanted, threads, attended).unwrap();
            let all = plan.cells() as usize;
            assert_eq!(bits(&found, 0, all), bits(&grid.cells, 0, all), "{text}");
        }
        let backward: Vec<f64> = along.iter().rev().copied().collect();
        let found = evaluate(&points(&backward), &wanted, 2, attended).unwrap();
        for line in 0..lines {
            for i in 0..along.len() {
                let [there, here] = [i, along.len() - 1 - i].map(|i| line * along.len() + i);
                assert_eq!(bits(&found, there, 1), bits(&grid.cells, here, 1), "{text}");
            }
        }
    }
}

/// The index of a cell.
fn index(plan: &Plan, mut number: usize) -> Vec<usize> {
    let mut index: Vec<usize> = Vec::new();
    for length in plan.shape().iter().rev() {
        index.insert(0, number % length);
        number /= length;
    }
    index
}

#[test]
fn an_evaluation_is_stopped_and_refuses_delays() {
    let setting = plan(SWEEPS[1]).setting(&[0, 0]);
    let wanted = Wanted::of(&[Field::NUnstable]).unwrap();
    let stop = Arc::new(AtomicBool::new(false));
    let attended = Attended::silently(&stop);
    let at = |delays: &[f64]| {
        let points = [Points {
            setting: &setting,
            delays,
        }];
        evaluate(&points, &wanted, 2, attended)
    };
    assert!(at(&[]).unwrap().status.is_empty());
    let refused = at(&[1.0, -1.0]).unwrap_err().to_string();
    assert!(refused.contains("tau"), "{refused}");
    stop.store(true, Ordering::Relaxed);
    assert!(matches!(at(&[1.0]), Err(RunError::Interrupted)));
    assert!(Wanted::of(&[Field::all_of_limit().next().unwrap()]).is_err());
}

/// The error of fields that are evaluated at one delay.
fn refusal(fields: &[Field], setting: &Setting, delay: f64) -> String {
    let delays = &[delay];
    let wanted = Wanted::of(fields).unwrap();
    let points = [Points { setting, delays }];
    let refused = evaluate(&points, &wanted, 1, Attended::silently(&Arc::default()));
    let refused = refused.unwrap_err();
    assert!(matches!(refused, RunError::Needs(_)), "{refused}");
    refused.to_string()
}

fn check_refusal(field: Field, setting: &Setting, delay: f64, says: &str) {
    let refused = refusal(&[field], setting, delay);
    assert!(refused.contains(says), "{refused}");
}

/// A setting without its delay.
fn setting(law: Option<&str>, numbers: &[(&'static str, f64)]) -> Setting {
    let law = law.map(|name| LawKind::named(name).unwrap());
    Setting::checked(numbers.iter().copied(), law, &TAU).unwrap()
}

/// What a sweep file refuses at a field is refused at a point in the same words.
#[test]
fn fields_are_refused_where_sweep_files_refuse_them() {
    let block = setting(None, &[("mu_prime", -0.3), ("alpha_v", -0.5)]);
    check_refusal(Field::Outcome, &block, 1.0, "motions stick and slip by it");
    check_refusal(
        Field::Vc,
        &block,
        1.0,
        "the critical velocity depends on the whole",
    );
    check_refusal(
        Field::StiffnessRatio,
        &block,
        1.0,
        "is of the rate-and-state law",
    );
    let coulomb = [
        ("mu0", 0.5),
        ("v0", 0.1),
        ("alpha_v", -0.5),
        ("load_lag", 0.0),
    ];
    let mut law = setting(Some("coulomb"), &coulomb);
    check_refusal(Field::Outcome, &law, 0.0, "tau = 0 is outside its range");
    law.set(Parameter::LoadLag, 0.2);
    check_refusal(Field::Outcome, &law, 1.0, "load_lag is not known");
    law.set(Parameter::LoadLag, 0.0);
    law.set(Parameter::XDot0, 0.2);
    check_refusal(Field::BasinShare, &law, 1.0, "x_dot0 says one start");
    let both = refusal(&[Field::Outcome, Field::SettleTime, Field::Vc], &law, 0.0);
    assert!(
        both.starts_with("settle_time cannot stand beside"),
        "{both}"
    );
    law.set(Parameter::V0, f64::NAN);
    check_refusal(Field::NUnstable, &law, 1.0, "v0 is not given");
    let system = plan(SWEEPS[6]).setting(&[0, 0]);
    check_refusal(
        Field::StabilityRadius,
        &system,
        1.0,
        "it needs the block on its spring",
    );
    check_refusal(
        Field::Vc,
        &system,
        1.0,
        "a system from a file has no motions",
    );
}

const TAU: [Parameter; 1] = [Parameter::Tau];

/// An observer that sets the stop once something is done.
#[derive(Default)]
struct Stopping {
    stop: Arc<AtomicBool>,
    at_once: bool,
    cells: Cell<u64>,
}

impl Observer for Stopping {
    fn event(&self, event: &Event) {
        if let Event::PieceDone { cells } = event {
            self.cells.set(self.cells.get() + cells);
            self.stop.store(self.at_once, Ordering::Relaxed);
        }
    }
}

/// The observer hears of every point, and may stop the evaluation from there.
#[test]
fn an_evaluation_is_observed_and_stopped_on_the_way() {
    let setting = plan(SWEEPS[5]).setting(&[0, 0]);
    let delays: Vec<f64> = (0..40).map(|i| 4.0 + f64::from(i) * 0.01).collect();
    let points = vec![
        Points {
            setting: &setting,
            delays: &delays,
        };
        200
    ];
    for (field, points) in [
        (Field::NUnstable, &points[..3]),
        (Field::Outcome, &points[..]),
    ] {
        let wanted = Wanted::of(&[field]).unwrap();
        for threads in [1, 2] {
            let observer = Stopping {
                at_once: field == Field::Outcome,
                ..Stopping::default()
            };
            let attended = Attended {
                observer: &observer,
                stop: &observer.stop,
            };
            let found = evaluate(points, &wanted, threads, attended);
            let all = 40 * points.len() as u64;
            if observer.at_once {
                assert!(matches!(found, Err(RunError::Interrupted)));
                assert!(observer.cells.get() < all);
            } else {
                assert_eq!(found.unwrap().status.len() as u64, all);
                assert_eq!(observer.cells.get(), all);
            }
        }
    }
}
