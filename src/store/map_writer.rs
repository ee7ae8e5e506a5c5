//! Writes a map from its pieces.

use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

use hdf5::plist::file_access::LibraryVersion;
use hdf5::plist::file_create::{AttrCreationOrder, LinkCreationOrder};
use hdf5::{Dataset, File};
use hdf5_sys::h5d::H5Dwrite_chunk;
use hdf5_sys::h5p::H5P_DEFAULT;
use sha2::{Digest, Sha256};

use super::attributes::{put_numbers, put_text};
use super::best_writer::BestWriter;
use super::boundary_writer::BoundaryWriter;
use super::contents_hash::contents_hash;
use super::error::StoreError;
use super::netcdf::Dimensions;
use super::output::Output;
use super::seal;
use super::soundness::as_written;
use super::tiles::record::TileContent;
use super::variables::{Layout, create, describe, put_all, put_fill};
use crate::sweep::Plan;
use crate::sweep::described::best::BestRow;
use crate::sweep::described::curve_rows::CurveRows;
use crate::sweep::described::curves::outer_values;
use crate::sweep::described::root::Provenance;
use crate::sweep::described::schema::{self, BEST, BOUNDARIES, root};
use crate::sweep::described::summary::{CellsSummary, FieldSummary};
use crate::sweep::described::{Described, Variable};
use crate::sweep::plan::tile::Tile;
use crate::text::in_hexadecimal;

/// A map that is being written. [`MapWriter::finish`] gives it its final name; dropped before that,
/// it is removed.
pub struct MapWriter<'p> {
    plan: &'p Plan,
    // Before `output`: the file is closed before its temporary name is removed.
    file: File,
    dimensions: Dimensions,
    boundaries: Option<BoundaryWriter>,
    best: Option<BestWriter>,
    /// The datasets of cells, in the order in which encoders give their chunks.
    cells: Vec<Cells>,
    /// Summary of the values written so far.
    summary: CellsSummary,
    output: Output,
}

/// A dataset of cells, and the hash of its chunks so far.
struct Cells {
    dataset: Dataset,
    variable: Variable,
    chunks: Sha256,
}

impl Cells {
    fn of(dataset: Dataset, variable: Variable) -> Self {
        Self {
            dataset,
            variable,
            chunks: Sha256::new(),
        }
    }

    /// Writes the fill value of integers.
    fn put_fill(&self) -> hdf5::Result<()> {
        let Variable { element, fill, .. } = self.variable;
        fill.map_or(Ok(()), |fill| put_fill(&self.dataset, element, fill))
    }
}

impl<'p> MapWriter<'p> {
    /// Creates the file under its temporary name, with everything but the cells.
    ///
    /// # Errors
    /// When the system or the library refuses.
    pub fn create(
        plan: &'p Plan,
        output: Output,
        provenance: &Provenance,
    ) -> Result<Self, StoreError> {
        let failed = |error| StoreError::hdf5("write", output.path())(error);
        let file = create_file(output.part()).map_err(failed)?;
        let mut dimensions = Dimensions::default();
        let (cells, boundaries, best) =
            fill_file(&file, plan, provenance, &mut dimensions).map_err(failed)?;
        Ok(Self {
            plan,
            file,
            dimensions,
            boundaries,
            best,
            cells,
            summary: CellsSummary::default(),
            output,
        })
    }

    /// Appends the curves of the plane at `index`. Planes must come in order.
    pub(crate) fn put_curves(
        &mut self,
        index: &[usize],
        rows: &CurveRows,
    ) -> Result<(), StoreError> {
        let Some(writer) = &mut self.boundaries else {
            return Ok(());
        };
        let outer = outer_values(self.plan, index);
        let appended = writer.append(rows, &outer);
        appended.map_err(StoreError::hdf5("write", self.output.path()))
    }

    /// Appends the best setting of a plane. Planes must come in order.
    pub(crate) fn put_best(&mut self, row: &BestRow) {
        if let Some(best) = &mut self.best {
            best.append(row);
        }
    }

    /// Writes the compressed chunks of a tile. Tiles must come in order.
    pub(crate) fn put_tile(
        &mut self,
        tile: &Tile,
        content: &TileContent,
    ) -> Result<(), StoreError> {
        self.summary.add(&content.summary);
        let offset: Vec<u64> = tile.offset.iter().map(|&o| o as u64).collect();
        for (variable, chunk) in self.cells.iter_mut().zip(&content.chunks) {
            variable.chunks.update(chunk);
            write_chunk(&variable.dataset, &offset, chunk)
                .map_err(StoreError::hdf5("write", self.output.path()))?;
        }
        Ok(())
    }

    /// How many chunks a tile has.
    pub(crate) fn chunks_of_tile(&self) -> usize {
        self.cells.len()
    }

    /// Records how many cells the map lacks.
    pub(crate) fn put_missing(&self, cells: u64) -> Result<(), StoreError> {
        let put = put_numbers(&self.file, root::CELLS_MISSING, &[cells]);
        put.map_err(StoreError::hdf5("write", self.output.path()))
    }

    /// Writes the summaries of the cells, and fill values for integers where a value is missing.
    fn put_summary(&mut self) -> hdf5::Result<()> {
        let cells = self.plan.cells();
        let fields = &self.plan.spec.fields;
        self.summary
            .fields
            .resize(fields.len(), FieldSummary::default());
        let told = self.cells.iter().zip(fields).zip(&self.summary.fields);
        for ((variable, field), summary) in told {
            put_all(
                &variable.dataset,
                &summary.attributes(field.storage(), cells),
            )?;
            if summary.missing(cells) > 0 {
                variable.put_fill()?;
            }
        }
        let (Some(status), counts) = (self.cells.last(), &self.summary.status) else {
            return Ok(());
        };
        put_all(&status.dataset, &counts.attributes(cells))?;
        match counts.computed < cells {
            true => status.put_fill(),
            false => Ok(()),
        }
    }

    /// Closes the file, reads it back to see that it holds what was written, makes it durable and
    /// gives it its final name.
    ///
    /// # Errors
    /// When `stop` is set, or the system or the library refuses. The final name then has what it
    /// had before.
    pub fn finish(mut self, stop: &AtomicBool) -> Result<(), StoreError> {
        let path = self.output.path().to_owned();
        let mut close = || -> hdf5::Result<()> {
            self.put_summary()?;
            for variable in &self.cells {
                let digest = in_hexadecimal(&variable.chunks.clone().finalize());
                put_text(&variable.dataset, schema::CHUNKS_SHA256, &digest)?;
            }
            if let Some(boundaries) = &mut self.boundaries {
                boundaries.finish(&self.dimensions)?;
            }
            if let Some(best) = &self.best {
                best.finish()?;
            }
            self.dimensions.finish()?;
            self.file.flush()?;
            let cells = self.cells.iter().map(|cells| &*cells.variable.name);
            let cells: Vec<&str> = cells.collect();
            let hash = contents_hash(&self.file, &cells, stop)?;
            put_text(&self.file, schema::CONTENTS_SHA256, &hash)?;
            self.file.flush()
        };
        let closed = close();
        if stop.load(Ordering::Relaxed) {
            return Err(StoreError::Stopped);
        }
        closed.map_err(StoreError::hdf5("write", &path))?;
        // Drop all handles, so that the file is closed before it is renamed.
        drop((self.cells, self.boundaries, self.best, self.dimensions));
        self.file
            .close()
            .map_err(StoreError::hdf5("close", &path))?;
        let sound = as_written(self.output.part(), self.plan, stop);
        if stop.load(Ordering::Relaxed) {
            return Err(StoreError::Stopped);
        }
        sound.map_err(|why| StoreError::Unsound {
            path: path.clone(),
            why,
        })?;
        let sealed = seal::put(self.output.part(), stop);
        if stop.load(Ordering::Relaxed) {
            return Err(StoreError::Stopped);
        }
        sealed.map_err(StoreError::io("write", &path))?;
        self.output.commit()
    }
}

/// A new file that keeps the order of attributes and links. Nothing may stand at `path`.
///
/// There is no sieve buffer, so each write of values is a write by the system, whose errors are
/// reported at once. A buffer is written when its dataset is closed, and an error is then silently
/// lost.
pub(super) fn create_file(path: &Path) -> hdf5::Result<File> {
    hdf5::FileBuilder::new()
        .with_fapl(|fapl| {
            // From version 1.10 on, object headers and chunk indexes have checksums.
            let version = LibraryVersion::V110;
            fapl.sieve_buf_size(0).libver_bounds(version, version)
        })
        .with_fcpl(|fcpl| {
            fcpl.obj_track_times(false)
                .attr_creation_order(AttrCreationOrder::Indexed)
                .link_creation_order(LinkCreationOrder::Indexed)
        })
        .create_excl(path)
}

type Contents = (Vec<Cells>, Option<BoundaryWriter>, Option<BestWriter>);

fn fill_file(
    file: &File,
    plan: &Plan,
    provenance: &Provenance,
    dimensions: &mut Dimensions,
) -> hdf5::Result<Contents> {
    let described = Described::of_map(plan, provenance);
    let root = described.root();
    put_all(file, &root.attributes)?;
    let layout = Layout {
        shape: plan.shape().into(),
        chunk: Some(plan.tiles.tile_shape().to_vec()),
        shuffle_bytes: false,
    };
    let mut cells = Vec::new();
    for variable in &root.variables {
        let dataset = create(file, variable, &layout)?;
        describe(&dataset, variable, dimensions)?;
        if variable.values.is_none() {
            cells.push(Cells::of(dataset, variable.clone()));
        }
    }
    let boundaries = described
        .group(BOUNDARIES)
        .map(|about| BoundaryWriter::create(file, &described, about, plan, dimensions))
        .transpose()?;
    let best = described
        .group(BEST)
        .map(|about| BestWriter::create(file, &described, about, dimensions))
        .transpose()?;
    Ok((cells, boundaries, best))
}

/// Hands a whole compressed chunk to the library.
fn write_chunk(dataset: &Dataset, offset: &[u64], chunk: &[u8]) -> hdf5::Result<()> {
    let written = hdf5::sync::sync(|| {
        // SAFETY: the dataset is open, `offset` has one entry per dimension of it and lies on a
        // chunk's first cell, and the pointer and length are those of a live slice.
        unsafe {
            H5Dwrite_chunk(
                dataset.id(),
                H5P_DEFAULT,
                0,
                offset.as_ptr(),
                chunk.len(),
                chunk.as_ptr().cast(),
            )
        }
    });
    if written < 0 {
        Err(hdf5::Error::query()?)
    } else {
        Ok(())
    }
}
