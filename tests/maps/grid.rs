//! Sweeps computed into memory, against the closed form cell by cell, and against the map of the
//! same sweep.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::map;
use slipmap::linear::Crossings;
use slipmap::setting::{Field, SweepSpec};
use slipmap::store::MapFile;
use slipmap::sweep::events::Attended;
use slipmap::sweep::grid::Grid;
use slipmap::sweep::{Event, Observer, Plan, RunError};

const SWEEP: &str = "fields = [\"n_unstable\", \"abscissa\"]\nboundaries = true\nbest = true\n[axes]\n\
    mu_prime = [-0.1, -0.3]\nalpha_n = { from = -3.0, to = 1.0, points = 61 }\n\
    tau = { from = 0.1, to = 9.0, points = 431 }\n";

#[test]
fn every_cell_has_its_place() {
    let spec: SweepSpec = SWEEP.parse().unwrap();
    let plan = Arc::new(Plan::new(spec).unwrap());
    assert!(plan.tiles.len() > 1, "several tiles");
    let grid = Grid::compute(&plan, 2, Attended::silently(&Arc::default())).unwrap();
    let counts = grid.cells.n_unstable.as_deref().unwrap();
    let axes = &plan.spec.axes;
    let mut at = 0;
    for i in 0..axes[0].len() {
        for j in 0..axes[1].len() {
            let (groups, _) = plan.setting(&[i, j, 0]).groups().unwrap();
            let crossings = Crossings::of(groups);
            for &tau in &axes[2].values {
                assert_eq!(
                    u64::from(counts[at]),
                    crossings.n_unstable(tau),
                    "{i} {j} {tau}"
                );
                at += 1;
            }
        }
    }
    assert_eq!(at, counts.len());
}

#[test]
fn it_holds_what_the_map_holds() {
    let spec: SweepSpec = SWEEP.parse().unwrap();
    let plan = Arc::new(Plan::new(spec).unwrap());
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("map.h5");
    map::write(&plan, 2, &path);
    let map = MapFile::open(&path).unwrap();
    let grid = Grid::compute(&plan, 1, Attended::silently(&Arc::default())).unwrap();
    let abscissa = &grid.cells.columns[0];
    assert_eq!(abscissa.field, Field::Abscissa);
    let cells = 61 * 431;
    assert_eq!(abscissa.cells.len(), 2 * cells);
    for i in 0..2 {
        let plane = map
            .plane(Field::Abscissa, &[i, 0, 0], (1, 2), usize::MAX)
            .unwrap();
        let there = &abscissa.cells[i * cells..][..cells];
        assert_eq!(plane.cells.len(), cells);
        for (cell, there) in plane.cells.iter().zip(there) {
            assert_eq!(cell.to_bits(), there.to_bits());
        }
    }
    let curves: usize = (grid.curves.iter().flat_map(|plane| &plane.curves))
        .map(|degree| degree.curves.as_ref().unwrap().pieces.len())
        .sum();
    assert_eq!(curves, map.curves_where(|_| true).unwrap().len());
    let best = map.best().unwrap();
    for (there, found) in best.iter().zip(&grid.best) {
        assert_eq!(there.abscissa, found.as_ref().unwrap().overall.abscissa);
    }
    assert_eq!(best.len(), grid.best.len());
}

/// Lines that several tiles hold parts of, with the delay in the middle of three axes, kinds and
/// statuses.
#[test]
fn lines_in_pieces_and_kinds_have_their_place() {
    let text = "fields = [\"outcome\", \"n_min\"]\n[axes]\nalpha_v = [-0.33, 0.0]\n\
        tau = { from = 0.1, to = 9.0, points = 7 }\nx_dot0 = [0.0, 0.2, 0.35]\n[fixed]\nv0 = 0.35\n\
        [friction]\nlaw = \"weakening\"\nmu0 = 0.5\nv_s = 0.5\nmu_s = 1.0\n";
    let spec: SweepSpec = text.parse().unwrap();
    let whole = Arc::new(Plan::new(spec.clone()).unwrap());
    let pieces = Arc::new(Plan::with_tiles_of(4, spec).unwrap());
    assert!(pieces.tiles.len() > 6 && pieces.tiles.tile_shape()[1] < 7);
    let [whole, pieces] = [whole, pieces]
        .map(|plan| Grid::compute(&plan, 2, Attended::silently(&Arc::default())).unwrap());
    assert_eq!(whole.cells.status, pieces.cells.status);
    assert_eq!(whole.cells.kinds[0].cells, pieces.cells.kinds[0].cells);
    let [a, b] = [&whole, &pieces].map(|grid| &grid.cells.columns[0].cells);
    assert!(a.iter().zip(b).all(|(a, b)| a.to_bits() == b.to_bits()));
    // What becomes of one motion, followed alone.
    for index in [[0, 2, 1], [1, 5, 2], [0, 6, 0]] {
        let setting = whole.plan().setting(&index);
        let case = whole
            .plan()
            .spec
            .simulation
            .case(&setting, 0.0)
            .unwrap()
            .unwrap();
        let abscissa = case.stable_abscissa().unwrap();
        let alone = case.follow(&mut case.motion().unwrap(), abscissa, &mut ());
        let at = (index[0] * 7 + index[1]) * 3 + index[2];
        assert_eq!(
            whole.cells.kinds[0].cells[at], alone.outcome as u8,
            "{index:?}"
        );
    }
}

#[test]
fn what_does_not_fit_into_memory_is_refused() {
    // Some systems promise any memory, and end whoever takes it.
    if Vec::<u8>::new().try_reserve_exact(900_000_000_000).is_ok() {
        return;
    }
    let text = "[axes]\nalpha_v = { from = -1.0, to = 1.0, points = 30000 }\n\
        tau = { from = 0.1, to = 9.0, points = 10000000 }\n[fixed]\nmu_prime = -0.3\n";
    let plan = Plan::new(text.parse().unwrap()).unwrap();
    let refused =
        Grid::compute(&Arc::new(plan), 1, Attended::silently(&Arc::default())).unwrap_err();
    assert!(
        refused.to_string().contains("do not fit into memory"),
        "{refused}"
    );
}

/// Every thread count gives the same events and heeds a stop.
#[test]
fn it_is_observed_and_stopped() {
    #[derive(Default)]
    struct Counted(std::cell::Cell<u64>);
    impl Observer for Counted {
        fn event(&self, event: &Event) {
            if let Event::PieceDone { cells } = event {
                self.0.set(self.0.get() + cells);
            }
        }
    }
    let plan = Arc::new(Plan::new(SWEEP.parse::<SweepSpec>().unwrap()).unwrap());
    for threads in [1, 2] {
        let (observer, stop) = (Counted::default(), Arc::new(AtomicBool::new(false)));
        let attended = Attended {
            observer: &observer,
            stop: &stop,
        };
        Grid::compute(&plan, threads, attended).unwrap();
        assert_eq!(observer.0.get(), plan.cells(), "{threads} threads");
        stop.store(true, Ordering::Relaxed);
        let stopped = Grid::compute(&plan, threads, attended).unwrap_err();
        assert!(matches!(stopped, RunError::Interrupted), "{stopped}");
    }
}
