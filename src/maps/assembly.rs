//! Assembles a map from the pieces of a sweep.

use std::sync::atomic::{AtomicBool, Ordering};

use crate::store::StoreError;
use crate::store::map_writer::MapWriter;
use crate::store::output::Output;
use crate::store::source::Source;
use crate::store::tiles::record::Content;
use crate::sweep::cells::boundaries::plane;
use crate::sweep::described::best::BestRow;
use crate::sweep::described::root::Provenance;
use crate::sweep::plan::Plan;
use crate::sweep::plan::pieces::Piece;

/// What to do when pieces are missing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Missing {
    /// Write no map.
    Refuse,
    /// Write fill values, and record in the map how many cells are missing.
    Leave,
}

/// What a map was assembled from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Assembled {
    /// Number of crossing curves and of curves of degrees of stability.
    pub curves: u64,
    /// Number of corners, where two curves meet.
    pub corners: u64,
    /// Planes of which some curves are left out, because too many cross them.
    pub planes_left_out: u64,
    /// Planes with best settings.
    pub best_planes: u64,
    /// Number of missing pieces.
    pub pieces_missing: u64,
    /// Number of missing cells.
    pub cells_missing: u64,
}

/// Writes the map of `plan` from the pieces of `source`, in the order of their numbers. Equal
/// pieces make equal files.
///
/// # Errors
/// When it is stopped, a piece is damaged, a piece is missing and `missing` refuses that, or the
/// system or the library refuses. The map's name then has what it had before.
pub(crate) fn assemble(
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
