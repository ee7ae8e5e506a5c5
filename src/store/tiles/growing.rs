//! A map that is still being computed, read from its tiles so far. No file is written for it, and
//! no tile is read twice.

use std::path::{Path, PathBuf};

use super::super::chunk_layout::ChunkLayout;
use super::super::curve_reader::{MapCurve, curves_of};
use super::super::error::StoreError;
use super::super::source::Source;
use super::super::stamp::Stamp;
use super::done::ShardDone;
use super::manifest::{self, Manifest};
use super::reader::TileReader;
use super::record::Content;
use super::shards;
use crate::sweep::cells::boundaries::plane;
use crate::sweep::described::curves::outer_values;
use crate::sweep::plan::Plan;
use crate::sweep::plan::pieces::{Piece, Shard};
use crate::sweep::plan::tile::place_of;

/// The tiles of a map as chunks of its columns: the fields of the plan, then the status.
#[derive(Debug)]
pub struct GrowingMap {
    plan: Plan,
    manifest: Manifest,
    folders: Vec<(Shard, PathBuf)>,
    readers: Vec<TileReader>,
    stamps: Vec<Option<Stamp>>,
}

/// The stamp of a folder's manifest, which changes when its tiles are of another sweep.
fn stamp(folder: &Path) -> Option<Stamp> {
    Stamp::of(&folder.join(manifest::NAME))
}

impl GrowingMap {
    /// The tiles beside `map`; none where there are none.
    ///
    /// # Errors
    /// When no manifest is sound, the tile shape is not that of this program, or the system
    /// refuses.
    pub fn of(map: &Path) -> Result<Option<Self>, StoreError> {
        let present = shards::begun(map)?;
        if present.is_empty() {
            return Ok(None);
        }
        let folders: Vec<PathBuf> = present.iter().map(|(_, path)| path.clone()).collect();
        let stamps = folders.iter().map(|folder| stamp(folder)).collect();
        let (manifest, plan) = shards::plan(&folders)?;
        if manifest.tile_shape != plan.tiles.tile_shape() {
            return Err(StoreError::OtherTiles {
                path: shards::root(map),
                difference: "another program cut them".into(),
            });
        }
        let (layout, pieces) = (manifest.layout(), plan.pieces());
        let readers = folders
            .iter()
            .map(|folder| TileReader::of_heads(folder, layout, pieces))
            .collect::<Result<_, _>>()?;
        Ok(Some(Self {
            plan,
            manifest,
            folders: present,
            readers,
            stamps,
        }))
    }

    /// Reads the heads of new tile files. False where the folders have changed: the map is complete
    /// now, or was begun anew.
    ///
    /// # Errors
    /// When the system refuses.
    pub(crate) fn refresh(&mut self, map: &Path) -> Result<bool, StoreError> {
        let present = shards::begun(map)?;
        let stamps = self.folders.iter().map(|(_, folder)| stamp(folder));
        if present != self.folders || !stamps.eq(self.stamps.iter().copied()) {
            return Ok(false);
        }
        self.readers.iter_mut().try_for_each(TileReader::add_new)?;
        Ok(true)
    }

    /// The plan of the tiles.
    #[must_use]
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// The manifest of the tiles.
    #[must_use]
    pub(crate) fn manifest(&self) -> &Manifest {
        &self.manifest
    }

    /// The number of finished pieces, and the number of cells in them.
    #[must_use]
    pub fn done(&self) -> (u64, u64) {
        let mut done: Vec<Piece> = self.readers.iter().flat_map(TileReader::done).collect();
        done.sort_unstable();
        done.dedup();
        let cells = done.iter().map(|&piece| self.plan.cells_of(piece)).sum();
        (done.len() as u64, cells)
    }

    /// How much of each shard is computed. A piece whose bytes were damaged after they were written
    /// counts as computed: only [`Survey`](super::Survey) reads them all.
    #[must_use]
    pub(crate) fn shards(&self) -> Vec<ShardDone> {
        let of = |((shard, folder), reader): (&(Shard, PathBuf), &TileReader)| {
            let mut done = ShardDone::nothing(&self.plan, *shard, folder);
            reader.done().for_each(|piece| done.add(&self.plan, piece));
            done
        };
        self.folders.iter().zip(&self.readers).map(of).collect()
    }

    /// Refuses shards of several sweeps.
    ///
    /// # Errors
    /// Where there are such, or the system refuses.
    pub(crate) fn refuse_mixed(&self) -> Result<(), StoreError> {
        for (_, folder) in &self.folders {
            shards::expected_in(folder, &self.manifest)?;
        }
        Ok(())
    }

    /// How a column is stored; none where there is no such column.
    #[must_use]
    pub fn layout(&self, column: usize) -> Option<ChunkLayout> {
        let fields = &self.plan.spec.fields;
        let element = match column.cmp(&fields.len()) {
            std::cmp::Ordering::Less => fields[column].bytes(),
            std::cmp::Ordering::Equal => size_of::<u8>(),
            std::cmp::Ordering::Greater => return None,
        };
        Some(ChunkLayout {
            shape: self.plan.shape().to_vec(),
            chunk: self.plan.tiles.tile_shape().to_vec(),
            element,
            deflated: true,
            shuffled: element > 1,
        })
    }

    /// The bytes of the chunk of a column whose first cell is at `offset`; none where it is not
    /// computed yet.
    ///
    /// # Errors
    /// When they are damaged or cannot be read.
    pub fn stored(
        &mut self,
        column: usize,
        offset: &[usize],
    ) -> Result<Option<Vec<u8>>, StoreError> {
        let tiles = &self.plan.tiles;
        let mut number = 0;
        for ((&at, &length), &whole) in offset.iter().zip(tiles.tile_shape()).zip(tiles.shape()) {
            number = number * whole.div_ceil(length) + at / length;
        }
        let piece = Piece::Tile(number as u64);
        let Some(payload) = self.readers.read(piece)? else {
            return Ok(None);
        };
        let columns = self.plan.spec.fields.len() + 1;
        match Content::read(piece, &payload) {
            Some(Content::Tile(tile)) if tile.chunks.len() == columns => {
                Ok(tile.chunks.get(column).map(|chunk| chunk.to_vec()))
            }
            _ => Err(StoreError::DamagedPiece { piece }),
        }
    }

    /// The curves of the plane at `index`, one index per axis; none where they are not computed
    /// yet, or the map has no curves.
    ///
    /// # Errors
    /// As [`GrowingMap::stored`].
    pub fn curves(&mut self, index: &[usize]) -> Result<Vec<MapCurve>, StoreError> {
        let Some((p, tau)) = self.plan.boundary_plane else {
            return Ok(Vec::new());
        };
        let mut shape = self.plan.shape().to_vec();
        let mut at = index.to_vec();
        (shape[p], shape[tau], at[p], at[tau]) = (1, 1, 0, 0);
        let strides = crate::sweep::plan::tile::memory_strides(&shape);
        let number = place_of(&at, &strides) as u64;
        let piece = Piece::Curves(number);
        let Some(payload) = self.readers.read(piece)? else {
            return Ok(Vec::new());
        };
        let damaged = || StoreError::DamagedPiece { piece };
        let Some(Content::Curves(rows)) = Content::read(piece, &payload) else {
            return Err(damaged());
        };
        let outer = outer_values(&self.plan, &plane(&self.plan, number));
        let outer: Vec<Vec<f64>> = outer.iter().map(|&v| vec![v; rows.curves()]).collect();
        curves_of(&rows, &outer).ok_or_else(damaged)
    }
}
