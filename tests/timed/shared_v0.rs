//! What does not depend on v0 costs a map of many v0 no more than a map of one.

use std::sync::Arc;
use std::time::{Duration, Instant};

use crate::alone;
use slipmap::sweep::Plan;
use slipmap::sweep::events::Attended;
use slipmap::sweep::grid::Grid;

/// How many times each map is computed; the shortest time counts.
const TIMES: usize = 5;
/// The most that eight v0 may cost, in units of a single one.
const MOST: f64 = 1.2;

/// The shortest time in which a map of these v0 is computed on one thread.
fn shortest(v0s: &[f64]) -> Duration {
    let text = format!(
        "fields = [\"n_unstable\", \"abscissa\", \"vc\", \"v_smooth\", \"v_liftoff\"]\n\
         boundaries = false\n[axes]\nv0 = {v0s:?}\nalpha_v = [-0.2]\n\
         tau = {{ from = 0.5, to = 6, points = 60 }}\n\
         [friction]\nlaw = \"weakening\"\nmu0 = 0.5\nv_s = 0.5\n"
    );
    let plan = Arc::new(Plan::new(text.parse().unwrap()).unwrap());
    let times = (0..TIMES).map(|_| {
        let start = Instant::now();
        Grid::compute(&plan, 1, Attended::silently(&Arc::default())).unwrap();
        start.elapsed()
    });
    times.min().unwrap()
}

#[test]
fn eight_v0_cost_what_one_does() {
    let _alone = alone();
    let eight = [0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.35, 0.4];
    let (one, all) = (shortest(&eight[..1]), shortest(&eight));
    let share = all.as_secs_f64() / one.as_secs_f64();
    println!("eight v0 cost {share:.3} times one v0: {all:?}, {one:?}");
    assert!(share <= MOST, "{all:?} for eight v0, {one:?} for one");
}
