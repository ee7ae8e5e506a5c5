//! Whether the disk has room for a map.

use std::collections::HashMap;
use std::path::Path;

use crate::maps::cost::MapCost;
use crate::model::stop::Stop;
use crate::sweep::Plan;

/// The bytes of the disk that stay free unless told otherwise, as a flag says them.
pub(crate) const KEEP_FREE: &str = "1GB";

/// The bytes that a map and its tiles take at most at the same time, beside one another: its cells
/// before compression, twice.
pub(crate) fn most_bytes(plan: &Plan) -> u64 {
    plan.cells()
        .saturating_mul(plan.bytes_per_cell())
        .saturating_mul(2)
}

/// The bytes that are free on the disk of a folder; none where the system does not say.
pub(crate) fn free_bytes(folder: &Path) -> Option<u64> {
    #[cfg(unix)]
    {
        let told = rustix::fs::statvfs(folder).ok()?;
        Some(told.f_bavail.saturating_mul(told.f_frsize))
    }
    #[cfg(not(unix))]
    {
        let _ = folder;
        None
    }
}

/// The bytes that sweeps need.
#[derive(Debug, Default)]
pub(crate) struct Needs(HashMap<String, u64>);

impl Needs {
    /// The bytes that a map and its tiles take beside one another, and those that are free without
    /// `kept` ones, where that is not enough. Cells take no more than their numbers; how much less,
    /// a sample tells where that is asked for. It takes some seconds, less once `stop` is set.
    pub(crate) fn lacking(
        &mut self,
        plan: &Plan,
        folder: &Path,
        kept: u64,
        stop: &Stop,
    ) -> Option<(u64, u64)> {
        let free = free_bytes(folder)?.saturating_sub(kept);
        if most_bytes(plan) <= free {
            return None;
        }
        let about = { self.0.entry(plan.hash()) };
        let about = *about.or_insert_with(|| MapCost::of(plan, stop).bytes_on_disk);
        let needed = about.saturating_mul(2);
        (needed > free).then_some((needed, free))
    }
}
