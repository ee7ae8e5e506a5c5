//! Fields at any points, against the cells of sweeps.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::every_kind::{SWEEPS, plan};
use slipmap::setting::Field;
use slipmap::sweep::cells::buffers::TileBuffers;
use slipmap::sweep::evaluate::{Points, Wanted, evaluate};
use slipmap::sweep::events::Attended;
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
