//! How far counting and storing are from the limits of the machine. Run with `cargo bench --bench
//! throughput`.
//!
//! 1. Counting a 1000×1000×1000 grid into reused tile buffers, against filling the same buffers
//!    with a constant (they fit a processor's cache), and against filling memory beyond the cache
//!    with as many bytes.
//! 2. The same on one thread and on all.
//! 3. A whole `run` of a 10⁹-cell count map, against writing the same bytes uncompressed to the
//!    same disk, both synced.
//!
//! 4. Tiles on disk, checked and put together, against pieces in memory: for the count map and for
//!    a map of decay rates.
//!
//! Alternatives take turns, and medians are printed: machines drift. `SLIPMAP_BENCH_CELLS=100`
//! makes a 100³ grid.

use std::fs::File;
use std::io::Write;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::time::Instant;

use slipmap::maps::maker::{Job, make, make_in_memory};
use slipmap::model::stop::Stop;
use slipmap::setting::SweepSpec;
use slipmap::sweep::Plan;
use slipmap::sweep::described::root::Provenance;
use slipmap::sweep::engine::{TileBuffers, Worker};
use slipmap::sweep::events::Attended;

const ROUNDS: usize = 5;

fn plan(points: usize) -> Plan {
    let text = format!(
        "boundaries = false\n[axes]\nmu_prime = {{ from = -1.0, to = 0.2, points = {points} }}\n\
         alpha_n = {{ from = -3.0, to = 1.0, points = {points} }}\n\
         tau = {{ from = 0.01, to = 12.0, points = {points} }}\n[fixed]\nalpha_v = -0.1\n"
    );
    let spec: SweepSpec = text.parse().expect("the sweep is valid");
    Plan::new(spec).expect("the plan is valid")
}

/// Decay rates in a plane of three times as many points each way, which takes some seconds.
fn decay_plan(points: usize) -> Plan {
    let points = 3 * points.max(1);
    let text = format!(
        "fields = [\"abscissa\", \"frequency\"]\nboundaries = false\n[axes]\n\
         alpha_n = {{ from = -3.0, to = 1.0, points = {points} }}\n\
         tau = {{ from = 0.01, to = 12.0, points = {points} }}\n[fixed]\nmu_prime = -0.3\n"
    );
    let spec: SweepSpec = text.parse().expect("the sweep is valid");
    Plan::new(spec).expect("the plan is valid")
}

/// Seconds to visit all tiles on `threads` threads, each with buffers of its own.
fn over_tiles<W>(
    plan: &Plan,
    threads: usize,
    worker: impl Fn() -> W + Sync,
    visit: impl Fn(&mut W, usize) + Sync,
) -> f64 {
    let next = AtomicUsize::new(0);
    let start = Instant::now();
    std::thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                let mut worker = worker();
                loop {
                    let number = next.fetch_add(1, Ordering::Relaxed);
                    if number >= plan.tiles.len() {
                        break;
                    }
                    visit(&mut worker, number);
                }
            });
        }
    });
    start.elapsed().as_secs_f64()
}

fn count(plan: &Plan, threads: usize) -> f64 {
    over_tiles(
        plan,
        threads,
        || Worker::new(plan),
        |worker, number| {
            worker.compute(&plan.tiles.tile(number), &Stop::default());
            std::hint::black_box(&worker.buffers);
        },
    )
}

fn fill(plan: &Plan, threads: usize) -> f64 {
    over_tiles(
        plan,
        threads,
        || TileBuffers::new(plan),
        |buffers, number| {
            if let Some(n) = &mut buffers.n_unstable {
                n.fill(number as u16);
            }
            buffers.status.fill(number as u8);
            std::hint::black_box(&buffers);
        },
    )
}

/// Seconds to fill as many bytes as the map has, over and over in memory that no cache holds.
fn fill_memory(plan: &Plan, threads: usize) -> f64 {
    const BYTES: usize = 256 << 20;
    let mut blocks = vec![vec![1_u8; BYTES]; threads];
    let bytes = (plan.cells() * plan.bytes_per_cell()) as usize / threads;
    let start = Instant::now();
    std::thread::scope(|scope| {
        for block in &mut blocks {
            scope.spawn(move || {
                for (round, from) in (0..bytes).step_by(BYTES).enumerate() {
                    block[..BYTES.min(bytes - from)].fill(round as u8);
                    std::hint::black_box(&block);
                }
            });
        }
    });
    start.elapsed().as_secs_f64()
}

/// Seconds of a whole run, with tiles on disk until the map is put together.
fn store(plan: &Arc<Plan>, folder: &Path, threads: usize) -> f64 {
    let provenance = Provenance::default();
    let map = folder.join("map.h5");
    let job = Job::new(&map, threads, &provenance);
    let stop = Arc::new(AtomicBool::new(false));
    let start = Instant::now();
    make(plan, &job, Attended::silently(&stop)).expect("the sweep runs");
    start.elapsed().as_secs_f64()
}

/// Seconds of the same with the pieces in memory: what tiles, their checksums and resuming cost is
/// the difference.
fn store_from_memory(plan: &Arc<Plan>, folder: &Path, threads: usize) -> f64 {
    let map = folder.join("map.h5");
    let start = Instant::now();
    make_in_memory(plan, &map, threads, &Provenance::default()).expect("the sweep runs");
    start.elapsed().as_secs_f64()
}

fn write_raw(plan: &Plan, folder: &Path) -> f64 {
    let bytes = plan.cells() * plan.bytes_per_cell();
    let block = vec![2_u8; 4 << 20];
    let start = Instant::now();
    let mut file = File::create(folder.join("raw")).expect("the folder is writable");
    let mut left = bytes as usize;
    while left > 0 {
        let part = left.min(block.len());
        file.write_all(&block[..part]).expect("the disk takes it");
        left -= part;
    }
    file.sync_all().expect("the disk syncs");
    start.elapsed().as_secs_f64()
}

fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

/// Medians of the two, and of their ratio round by round.
fn against(a: impl Fn() -> f64, b: impl Fn() -> f64) -> (f64, f64, f64) {
    let pairs: Vec<(f64, f64)> = (0..ROUNDS).map(|_| (a(), b())).collect();
    let each = |f: fn(&(f64, f64)) -> f64| median(pairs.iter().map(f).collect());
    (each(|p| p.0), each(|p| p.1), each(|p| p.0 / p.1))
}

fn main() {
    let points = std::env::var("SLIPMAP_BENCH_CELLS")
        .ok()
        .and_then(|n| n.parse().ok())
        .unwrap_or(1000);
    let all = std::thread::available_parallelism().map_or(1, usize::from);
    let plan = Arc::new(plan(points));
    println!("{points}³ cells, {all} threads, medians of {ROUNDS} rounds");
    for threads in if all > 1 { vec![1, all] } else { vec![1] } {
        let (counted, filled, ratio) = against(|| count(&plan, threads), || fill(&plan, threads));
        println!(
            "count against fill, {threads} threads: {counted:.3} s / {filled:.3} s = {ratio:.2}"
        );
        let (counted, filled, ratio) =
            against(|| count(&plan, threads), || fill_memory(&plan, threads));
        println!(
            "count against memory beyond the cache, {threads} threads: {counted:.3} s / {filled:.3} s = {ratio:.2}"
        );
    }
    if all > 1 {
        let (one, many, ratio) = against(|| count(&plan, 1), || count(&plan, all));
        println!("count, 1 thread against {all}: {one:.3} s / {many:.3} s = {ratio:.2}");
        let folder = tempfile::tempdir_in(".").expect("the folder is writable");
        let (one, many, ratio) = against(
            || store(&plan, folder.path(), 1),
            || store(&plan, folder.path(), all),
        );
        println!("run, 1 thread against {all}: {one:.3} s / {many:.3} s = {ratio:.2}");
    }
    let folder = tempfile::tempdir_in(".").expect("the folder is writable");
    let (stored, raw, ratio) = against(
        || store(&plan, folder.path(), all),
        || write_raw(&plan, folder.path()),
    );
    let decay = Arc::new(decay_plan(points));
    for (name, plan) in [("count map", &plan), ("decay-rate map", &decay)] {
        let (on_disk, in_memory, ratio) = against(
            || store(plan, folder.path(), all),
            || store_from_memory(plan, folder.path(), all),
        );
        println!(
            "tiles on disk against in memory, {name}: {on_disk:.3} s / {in_memory:.3} s = {ratio:.3}"
        );
    }
    println!("run against raw write, {all} threads: {stored:.3} s / {raw:.3} s = {ratio:.2}");
}
