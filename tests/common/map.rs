//! Maps for tests that look at what they hold.

use std::path::Path;
use std::sync::Arc;

use slipmap::store::map_maker::make_in_memory;
use slipmap::store::map_writer::Provenance;
use slipmap::sweep::Plan;

/// Computes the map of a plan.
pub fn write(plan: &Plan, threads: usize, path: &Path) {
    make_in_memory(
        &Arc::new(plan.clone()),
        path,
        threads,
        &Provenance::default(),
    )
    .unwrap();
}
