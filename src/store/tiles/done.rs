//! How much of a shard is computed.

use std::path::Path;

use super::shards;
use crate::sweep::plan::Plan;
use crate::sweep::plan::pieces::{Piece, Shard};

/// How much of a shard is computed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ShardDone {
    /// Which one.
    pub shard: Shard,
    /// Whether a run works on it at this moment.
    pub running: bool,
    /// Cells of the shard.
    pub cells: u64,
    /// Cells that are computed.
    pub cells_done: u64,
    /// Pieces of the shard.
    pub pieces: u64,
    /// Pieces that are computed.
    pub pieces_done: u64,
}

impl ShardDone {
    /// Nothing yet of a shard of `plan`, whose folder is `folder`.
    pub(super) fn nothing(plan: &Plan, shard: Shard, folder: &Path) -> Self {
        let pieces = plan.pieces();
        let places = (0..pieces.total()).filter(|&place| shard.holds(place));
        Self {
            shard,
            running: shards::is_running(folder),
            cells: places.map(|place| plan.cells_of(pieces.at(place))).sum(),
            cells_done: 0,
            pieces: shard.count(pieces.total()),
            pieces_done: 0,
        }
    }

    /// Counts a piece that is computed, if it is one of the shard's.
    pub(super) fn add(&mut self, plan: &Plan, piece: Piece) {
        let place = plan.pieces().place(piece);
        if place.is_some_and(|place| self.shard.holds(place)) {
            self.pieces_done += 1;
            self.cells_done += plan.cells_of(piece);
        }
    }
}
