//! Roots with memory and latency: what maps tell of them holds by a walk of the argument, and where
//! a cell has more to count than is counted for one, it says so.

use std::sync::Arc;

use crate::walk::Walk;
use slipmap::linear::status::{CERTIFIED, DISAGREE, MARGINAL, NOT_CONVERGED};
use slipmap::setting::SweepSpec;
use slipmap::sweep::Plan;
use slipmap::sweep::events::Attended;
use slipmap::sweep::grid::Grid;

/// Gains of velocity control and delays, with the abscissas there.
fn sweep(head: &str, delays: [f64; 2], points: usize) -> Grid {
    let [from, to] = delays;
    let text = format!(
        "fields = [\"abscissa\"]\n[axes]\n\
         alpha_v = {{ from = -1.0, to = 1.0, points = {points} }}\n\
         tau = {{ from = {from:?}, to = {to:?}, points = {points} }}\n[fixed]\n{head}\n"
    );
    let plan = Plan::new(text.parse::<SweepSpec>().unwrap()).unwrap();
    Grid::compute(&Arc::new(plan), 1, Attended::silently(&Arc::default())).unwrap()
}

/// One cell of twenty used to take a minute.
#[test]
fn abscissas_hold_by_a_walk() {
    let (b, memory, latency) = (-0.3, 0.5, 1.0);
    let grid = sweep(
        "mu_prime = -0.3\nmemory = 0.5\nlatency = 1.0",
        [0.5, 18.0],
        12,
    );
    let axes = &grid.plan().spec.axes;
    let abscissas = &grid.cells.columns[0].cells;
    let (mut certified, mut walked) = (0, 0);
    for (i, (&abscissa, &status)) in abscissas.iter().zip(&grid.cells.status).enumerate() {
        let (gain, tau) = (axes[0].values[i / 12], axes[1].values[i % 12]);
        if status & CERTIFIED == 0 {
            assert!(
                status & (MARGINAL | NOT_CONVERGED | DISAGREE) != 0,
                "{gain} {tau} {status}"
            );
            continue;
        }
        certified += 1;
        let (open, fed) = ([1.0, b, 1.0], [gain * b, gain]);
        let times = |p: &[f64], by: f64| p.iter().map(|c| by * c).collect::<Vec<f64>>();
        let walk = Walk {
            terms: vec![
                (open.to_vec(), 0.0),
                (times(&open, -memory), tau),
                (times(&fed, -1.0), latency),
                (fed.to_vec(), latency + tau),
            ],
        };
        let beside = [abscissa + 1e-4, abscissa - 1e-4].map(|line| walk.right_of(line));
        if let [Some(right), Some(left)] = beside {
            assert!(
                right == 0 && left > 0,
                "{gain} {tau}: {abscissa} {beside:?}"
            );
            walked += 1;
        }
    }
    assert!(certified > 130 && walked > 60, "{certified} {walked}");
}

/// Delays and latencies of many periods, where roots crowd: every cell comes to its end, with a
/// number or the reason why there is none, and again with the same one.
#[test]
fn crowded_cells_say_what_they_know() {
    let of = || {
        sweep(
            "mu_prime = -0.3\nmemory = 0.97\nlatency = 30.0",
            [10.0, 1000.0],
            6,
        )
    };
    let (grid, again) = (of().cells, of().cells);
    assert_eq!(grid.status, again.status);
    let bits = |cells: &[f64]| cells.iter().map(|c| c.to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(&grid.columns[0].cells), bits(&again.columns[0].cells));
    for (abscissa, status) in grid.columns[0].cells.iter().zip(&grid.status) {
        let flagged = status & (NOT_CONVERGED | MARGINAL | DISAGREE) != 0;
        assert!(abscissa.is_finite() || flagged, "{abscissa} {status}");
    }
}
