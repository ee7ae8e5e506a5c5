//! Sweeps computed into memory, against the closed form cell by cell, and against the map of the
//! same sweep.

#[path = "common/map.rs"]
mod map;

use std::sync::Arc;

use slipmap::linear::Crossings;
use slipmap::store::MapFile;
use slipmap::sweep::grid::Grid;
use slipmap::sweep::{Field, Plan, SweepSpec};

const SWEEP: &str = "fields = [\"n_unstable\", \"abscissa\"]\nboundaries = true\nbest = true\n[axes]\n\
    mu_prime = [-0.1, -0.3]\nalpha_n = { from = -3.0, to = 1.0, points = 61 }\n\
    tau = { from = 0.1, to = 9.0, points = 431 }\n";

#[test]
fn every_cell_has_its_place() {
    let spec: SweepSpec = SWEEP.parse().unwrap();
    let plan = Arc::new(Plan::new(spec).unwrap());
    assert!(plan.tiles.len() > 1, "several tiles");
    let grid = Grid::compute(&plan, 2).unwrap();
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
    let grid = Grid::compute(&plan, 1).unwrap();
    let abscissa = &grid.cells.columns[0];
    assert_eq!(abscissa.field, Field::Abscissa);
    let lengths = [61, 431];
    for i in 0..2 {
        let plane = map
            .plane(Field::Abscissa, &[i, 0, 0], (1, 2), usize::MAX)
            .unwrap();
        let there = &abscissa.cells[i * lengths[0] * lengths[1]..];
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
