//! From the pieces of a sweep to its map.

use std::sync::atomic::{AtomicBool, Ordering};

use crate::store::StoreError;
use crate::store::best_writer::BestRow;
use crate::store::describe::Provenance;
use crate::store::map_writer::MapWriter;
use crate::store::output::Output;
use crate::store::source::Source;
use crate::store::tiles::record::Content;
use crate::sweep::cells::boundaries::plane;
use crate::sweep::plan::Plan;
use crate::sweep::plan::pieces::Piece;

/// What to do where pieces are missing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Missing {
    /// Write no map.
    Refuse,
    /// Leave fill values, and say so in the map.
    Leave,
}

/// What a map was put together from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Assembled {
    /// Crossing curves and those of degrees of stability.
    pub curves: u64,
    /// Where they meet.
    pub corners: u64,
    /// Planes that lack curves because too many cross them.
    pub planes_left_out: u64,
    /// Planes with best settings.
    pub best_planes: u64,
    /// Pieces that are not there.
    pub pieces_missing: u64,
    /// Cells that are not there.
    pub cells_missing: u64,
}

/// Writes the map of `plan` from the pieces that `source` gives, in the order of their numbers:
/// equal pieces make equal files.
///
/// # Errors
/// When it is to stop, when a piece is damaged, when one is missing and has to be there, or when
/// the system or the library refuses; nothing then stands under the map's name that was not there
/// before.
pub fn assemble(
    plan: &Plan,
    output: Output,
    provenance: &Provenance,
    source: &mut dyn Source,
    missing: Missing,
    stop: &AtomicBool,
) -> Result<Assembled, StoreError> {
    let mut writer = MapWriter::create(plan, output, provenance)?;
    let mut assembled = Assembled::default();
    let pieces = plan.pieces();
    for piece in (0..pieces.total()).map(|place| pieces.at(place)) {
        if stop.load(Ordering::Relaxed) {
            return Err(StoreError::Stopped);
        }
        let Some(payload) = source.read(piece)? else {
            assembled.pieces_missing += 1;
            assembled.cells_missing += plan.cells_of(piece);
            if let Piece::Best(_) = piece {
                writer.put_best(&BestRow::of(None));
            }
            continue;
        };
        let damaged = || StoreError::DamagedPiece { piece };
        match (piece, Content::read(piece, &payload).ok_or_else(damaged)?) {
            (Piece::Curves(number), Content::Curves(rows)) => {
                assembled.curves += rows.curves() as u64;
                assembled.corners += rows.corners() as u64;
                assembled.planes_left_out += u64::from(rows.left_out);
                writer.put_curves(&plane(plan, number), &rows)?;
            }
            (Piece::Best(_), Content::Best(row)) => writer.put_best(&row),
            (Piece::Tile(number), Content::Tile(content)) => {
                if content.chunks.len() != writer.chunks_of_tile() {
                    return Err(damaged());
                }
                writer.put_tile(&plan.tiles.tile(number as usize), &content)?;
            }
            _ => return Err(damaged()),
        }
    }
    assembled.best_planes = plan.best_planes();
    if assembled.pieces_missing > 0 {
        if missing == Missing::Refuse {
            return Err(StoreError::Incomplete {
                pieces: assembled.pieces_missing,
                of: pieces.total(),
            });
        }
        writer.put_missing(assembled.cells_missing)?;
    }
    writer.finish(stop)?;
    Ok(assembled)
}
