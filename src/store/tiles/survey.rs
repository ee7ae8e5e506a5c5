//! Surveys the tiles beside a map, without claiming or changing anything.

use std::path::{Path, PathBuf};

use super::super::error::StoreError;
use super::done::ShardDone;
use super::folder::{is_tile_file, listed};
use super::manifest::{self, Manifest};
use super::reader::Checked;
use super::record::Content;
use super::shards;
use crate::sweep::described::summary::StatusCounts;
use crate::sweep::plan::Plan;
use crate::sweep::plan::pieces::{Piece, Pieces, Shard};

/// The contents of the tiles of all shards of a map.
#[derive(Debug)]
pub struct Survey {
    /// The plan they are of.
    pub plan: Plan,
    /// Each shard.
    pub shards: Vec<ShardSurvey>,
    /// Counts of the statuses of the cells; cells in several shards count once.
    pub statuses: StatusCounts,
    /// Pieces that some shard holds.
    pub pieces_done: u64,
    /// Cells that some shard holds.
    pub cells_done: u64,
}

/// The contents of the tiles of one shard.
#[derive(Debug)]
pub struct ShardSurvey {
    /// How much of it is computed.
    pub done: ShardDone,
    /// Damaged files; the next run computes their pieces again.
    pub damaged: Vec<PathBuf>,
}

/// The pieces found so far while files are read.
struct Seen {
    pieces: Pieces,
    /// By place.
    anywhere: Vec<bool>,
    here: Vec<bool>,
}

impl Survey {
    /// Looks at the tiles beside `map`; none where there are none.
    ///
    /// # Errors
    /// When a manifest is damaged, shards belong to different sweeps, or the system
    /// refuses.
    pub fn of(map: &Path) -> Result<Option<Self>, StoreError> {
        let present = shards::begun(map)?;
        if present.is_empty() {
            return Ok(None);
        }
        let folders: Vec<PathBuf> = present.iter().map(|(_, path)| path.clone()).collect();
        let (manifest, plan) = shards::plan(&folders)?;
        let pieces = plan.pieces();
        let mut survey = Self {
            plan,
            shards: Vec::new(),
            statuses: StatusCounts::default(),
            pieces_done: 0,
            cells_done: 0,
        };
        let mut seen = Seen {
            pieces,
            anywhere: vec![false; pieces.total() as usize],
            here: Vec::new(),
        };
        for (shard, path) in present {
            survey.add_shard(shard, &path, &manifest, &mut seen)?;
        }
        Ok(Some(survey))
    }

    fn add_shard(
        &mut self,
        shard: Shard,
        path: &Path,
        expected: &Manifest,
        seen: &mut Seen,
    ) -> Result<(), StoreError> {
        let (expected, sound) = shards::expected_in(path, expected)?;
        let broken = path.join(manifest::NAME);
        let mut found = ShardSurvey {
            done: ShardDone::nothing(&self.plan, shard, path),
            damaged: (!sound).then_some(broken).into_iter().collect(),
        };
        seen.here = vec![false; seen.pieces.total() as usize];
        for file in listed(path, is_tile_file)? {
            self.add_file(&file, &expected, &mut found, seen)?;
        }
        self.shards.push(found);
        Ok(())
    }

    fn add_file(
        &mut self,
        file: &Path,
        manifest: &Manifest,
        found: &mut ShardSurvey,
        seen: &mut Seen,
    ) -> Result<(), StoreError> {
        let Some(checked) = Checked::read(file, &manifest.layout(), seen.pieces)? else {
            return Ok(());
        };
        if checked.fault.is_some() {
            found.damaged.push(file.to_owned());
        }
        for entry in checked.sound {
            let Some(place) = seen.pieces.place(entry.piece) else {
                continue;
            };
            let (cells, place) = (self.plan.cells_of(entry.piece), place as usize);
            if !std::mem::replace(&mut seen.here[place], true) {
                found.done.add(&self.plan, entry.piece);
            }
            if !std::mem::replace(&mut seen.anywhere[place], true) {
                self.pieces_done += 1;
                self.cells_done += cells;
                self.count_flags(entry.piece, &checked.bytes[entry.at]);
            }
        }
        Ok(())
    }

    fn count_flags(&mut self, piece: Piece, payload: &[u8]) {
        if let Some(Content::Tile(tile)) = Content::read(piece, payload) {
            self.statuses.add(&tile.summary.status);
        }
    }
}
