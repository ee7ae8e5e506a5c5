//! Writes a map from its pieces.

use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

use hdf5::plist::file_access::LibraryVersion;
use hdf5::plist::file_create::{AttrCreationOrder, LinkCreationOrder};
use hdf5::{Dataset, File, Group, H5Type};
use hdf5_sys::h5d::H5Dwrite_chunk;
use hdf5_sys::h5p::H5P_DEFAULT;
use sha2::{Digest, Sha256};

use super::attributes::{put_flags, put_numbers, put_text};
use super::best_writer::{BestRow, BestWriter};
use super::boundary_writer::BoundaryWriter;
use super::codec::DEFLATE_LEVEL;
use super::contents_hash::contents_hash;
use super::curve_rows::{CurveRows, outer_values};
use super::error::StoreError;
use super::netcdf::{DimensionId, Dimensions, named};
use super::output::Output;
use super::schema::{self, STATUS, root};
use super::seal;
use super::soundness::as_written;
use crate::critical::switch_on::Phase;
use crate::linear::status::FLAGS;
use crate::sweep::engine::{FEW_FILL, N_UNSTABLE_FILL, STATUS_FILL};
use crate::sweep::input::field::Storage;
use crate::sweep::input::law_kind::LawKind;
use crate::sweep::input::search::LIMIT;
use crate::sweep::input::search::{Protocol, Search};
use crate::sweep::input::units::Units;
use crate::sweep::plan::in_hexadecimal;
use crate::sweep::plan::tile::Tile;
use crate::sweep::{Field, Parameter, Plan, Setting};

/// Who made a map, for its root attributes.
#[derive(Debug, Clone, Default)]
pub struct Provenance {
    /// Version of the program.
    pub program_version: String,
    /// Git revision of the program.
    pub git_revision: String,
    /// When and by which command; the one thing in a map that differs from run to run.
    pub history: String,
}

/// A map on its way to disk: under its final name after [`MapWriter::finish`], gone if dropped
/// before.
pub struct MapWriter<'p> {
    plan: &'p Plan,
    // Before `output`: the file is closed before its temporary name is removed.
    file: File,
    dimensions: Dimensions,
    boundaries: Option<BoundaryWriter>,
    best: Option<BestWriter>,
    /// The datasets of cells, in the order in which encoders give their chunks.
    cells: Vec<Cells>,
    output: Output,
}

/// A dataset of cells, and the hash of its chunks so far.
struct Cells {
    dataset: Dataset,
    chunks: Sha256,
}

impl Cells {
    fn of(dataset: Dataset) -> Self {
        Self {
            dataset,
            chunks: Sha256::new(),
        }
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
        let (datasets, boundaries, best) =
            fill_file(&file, plan, provenance, &mut dimensions).map_err(failed)?;
        Ok(Self {
            plan,
            file,
            dimensions,
            boundaries,
            best,
            cells: datasets.into_iter().map(Cells::of).collect(),
            output,
        })
    }

    /// Appends the curves of the plane at `index`. Planes come in their order.
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

    /// Appends the best setting of a plane. Planes come in their order.
    pub(crate) fn put_best(&mut self, row: &BestRow) {
        if let Some(best) = &mut self.best {
            best.append(row);
        }
    }

    /// Puts the compressed chunks of a tile, in the order of the datasets. Tiles come in their
    /// order.
    pub(crate) fn put_tile(&mut self, tile: &Tile, chunks: &[&[u8]]) -> Result<(), StoreError> {
        let offset: Vec<u64> = tile.offset.iter().map(|&o| o as u64).collect();
        for (variable, chunk) in self.cells.iter_mut().zip(chunks) {
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

    /// Says how many cells the map lacks.
    pub(crate) fn put_missing(&self, cells: u64) -> Result<(), StoreError> {
        put_numbers(&self.file, root::CELLS_MISSING, &[cells])
            .map_err(StoreError::hdf5("write", self.output.path()))
    }

    /// Closes the file, reads it back to see that it holds what was written, makes it durable and
    /// gives it its final name.
    ///
    /// # Errors
    /// When it is to stop, or the system or the library refuses; nothing then stands under the
    /// final name that was not there before.
    pub fn finish(mut self, stop: &AtomicBool) -> Result<(), StoreError> {
        let path = self.output.path().to_owned();
        let mut close = || -> hdf5::Result<()> {
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
            let fields = self.plan.spec.fields.iter().map(|field| field.name());
            let cells: Vec<&str> = fields.chain([STATUS]).collect();
            let hash = contents_hash(&self.file, &cells, stop)?;
            put_text(&self.file, schema::CONTENTS_SHA256, &hash)?;
            self.file.flush()
        };
        let closed = close();
        if stop.load(Ordering::Relaxed) {
            return Err(StoreError::Stopped);
        }
        closed.map_err(StoreError::hdf5("write", &path))?;
        // All handles, so that the file is closed before it is renamed.
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

/// A new file, with all orders kept. Nothing may stand at `path`.
///
/// Without a sieve buffer every write of values is one of the system's, whose errors are told at
/// once: what a buffer holds when its dataset is closed is lost without a word where the system
/// refuses it.
pub(super) fn create_file(path: &Path) -> hdf5::Result<File> {
    hdf5::FileBuilder::new()
        .with_fapl(|fapl| {
            // Object headers and indexes of chunks have checksums from 1.10 on.
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

type Contents = (Vec<Dataset>, Option<BoundaryWriter>, Option<BestWriter>);

fn fill_file(
    file: &File,
    plan: &Plan,
    provenance: &Provenance,
    dimensions: &mut Dimensions,
) -> hdf5::Result<Contents> {
    put_root(file, plan, provenance)?;
    let axes = plan
        .spec
        .axes
        .iter()
        .map(|axis| {
            let dataset = named(file.new_dataset_builder())
                .with_data(&axis.values)
                .create(axis.parameter.name())?;
            describe_parameter(&dataset, axis.parameter, &plan.spec.units)?;
            dimensions.add(dataset, None)
        })
        .collect::<hdf5::Result<Vec<_>>>()?;
    let spec = &plan.spec;
    let scalars = put_scalars(file, &spec.fixed, &spec.units, |p| {
        spec.uses(p) && spec.axes.iter().all(|axis| axis.parameter != p)
    })?;
    let mut variables = Variables {
        file,
        plan,
        dimensions,
        axes: axes.clone(),
        scalars,
    };
    let mut datasets = Vec::new();
    for &field in &plan.spec.fields {
        datasets.push(variables.field(field)?);
    }
    datasets.push(variables.status()?);
    let boundaries = plan
        .boundary_plane
        .map(|plane| BoundaryWriter::create(file, dimensions, plan, plane))
        .transpose()?;
    let best = plan
        .best_plane()
        .map(|plane| BestWriter::create(file, dimensions, &axes, plan, plane))
        .transpose()?;
    Ok((datasets, boundaries, best))
}

/// The root attributes of every file: title and who made it.
pub(super) fn put_provenance(
    file: &File,
    title: &str,
    provenance: &Provenance,
) -> hdf5::Result<()> {
    put_text(file, "Conventions", schema::CONVENTIONS)?;
    put_text(file, root::TITLE, title)?;
    let source = format!("slipmap {}", provenance.program_version);
    put_text(file, root::SOURCE, &source)?;
    put_text(file, root::HISTORY, &provenance.history)?;
    put_text(
        file,
        "references",
        "F.-J. Elmer, Controlling friction (1997)",
    )?;
    put_text(file, root::PROGRAM_VERSION, &provenance.program_version)?;
    put_text(file, root::GIT_REVISION, &provenance.git_revision)
}

fn put_root(file: &File, plan: &Plan, provenance: &Provenance) -> hdf5::Result<()> {
    let names: Vec<&str> = plan.spec.axes.iter().map(|a| a.parameter.name()).collect();
    put_provenance(file, &plan.spec.title, provenance)?;
    put_numbers(file, root::FORMAT_VERSION, &[schema::FORMAT_VERSION])?;
    put_text(file, root::AXES, &names.join(" "))?;
    put_text(file, root::PLAN_HASH, &plan.hash())?;
    put_text(file, root::SWEEP, &plan.spec.text)?;
    put_numbers(file, root::MARGINAL_TOLERANCE, &[plan.spec.tolerance.0])?;
    if plan.spec.limit {
        put_text(file, root::PROTOCOL, LIMIT)?;
    }
    put_friction(file, &plan.spec.fixed)
}

/// What the scalar coordinates leave open of the friction law, if there is one.
pub(super) fn put_friction(file: &File, setting: &Setting) -> hdf5::Result<()> {
    let Some(law) = setting.law() else {
        return Ok(());
    };
    put_text(file, root::FRICTION_LAW, law.name())?;
    if let LawKind::Table(table) = law {
        put_numbers(file, root::FRICTION_SPEEDS, table.speeds())?;
        put_numbers(file, root::FRICTION_MU_K, table.mu_k())?;
    }
    Ok(())
}

/// The values in `setting` of the parameters that are `scalar`, as scalar coordinates. Returns
/// their names.
pub(super) fn put_scalars(
    file: &File,
    setting: &Setting,
    units: &Units,
    scalar: impl Fn(Parameter) -> bool,
) -> hdf5::Result<String> {
    let mut names = Vec::new();
    for parameter in Parameter::ALL.into_iter().filter(|&p| scalar(p)) {
        let dataset = named(file.new_dataset_builder())
            .empty::<f64>()
            .create(parameter.name())?;
        dataset.write_scalar(&setting.get(parameter))?;
        describe_parameter(&dataset, parameter, units)?;
        names.push(parameter.name());
    }
    Ok(names.join(" "))
}

pub(super) fn describe_parameter(
    dataset: &Dataset,
    parameter: Parameter,
    units: &Units,
) -> hdf5::Result<()> {
    put_text(dataset, "long_name", parameter.long_name())?;
    put_text(dataset, "units", &units.of_parameter(parameter))
}

/// How critical velocities were looked for.
fn put_search(dataset: &Dataset, search: &Search) -> hdf5::Result<()> {
    let protocol = search.protocol;
    put_text(dataset, schema::vc::PROTOCOL, protocol.name())?;
    if let Protocol::SwitchOn(Phase::Worst(phases)) = protocol {
        put_numbers(dataset, schema::vc::PHASES, &[phases])?;
    }
    put_numbers(dataset, schema::vc::V_MAX, &[protocol.v_max()])?;
    let unit = "mu_s * normal_load / sqrt(stiffness * mass)";
    put_text(dataset, schema::vc::V_MAX_UNIT, unit)?;
    put_numbers(dataset, schema::vc::PRECISION, &[protocol.precision()])
}

/// Creates the datasets of the cells.
struct Variables<'a> {
    file: &'a Group,
    plan: &'a Plan,
    dimensions: &'a mut Dimensions,
    axes: Vec<DimensionId>,
    scalars: String,
}

impl Variables<'_> {
    fn field(&mut self, field: Field) -> hdf5::Result<Dataset> {
        let dataset = match field.storage() {
            Storage::Count => self.variable(field.name(), N_UNSTABLE_FILL)?,
            Storage::Kind | Storage::Few => self.variable(field.name(), FEW_FILL)?,
            Storage::Real => self.variable(field.name(), f64::NAN)?,
        };
        let spec = &self.plan.spec;
        let (long_name, comment) = match spec.critical {
            Some(_) => field.described_at_vc(),
            None => (field.long_name(), field.comment()),
        };
        match field.kinds() {
            Some(kinds) => put_flags(&dataset, long_name, &kinds)?,
            None => put_text(&dataset, "long_name", long_name)?,
        }
        put_text(&dataset, "units", &field.unit(&spec.units))?;
        if let Some(comment) = comment {
            put_text(&dataset, "comment", comment)?;
        }
        if let Some(search) = spec.critical.filter(|_| !field.of_sliding()) {
            put_search(&dataset, &search)?;
        }
        put_text(&dataset, "ancillary_variables", STATUS)?;
        Ok(dataset)
    }

    fn status(&mut self) -> hdf5::Result<Dataset> {
        let dataset = self.variable(STATUS, STATUS_FILL)?;
        put_text(&dataset, "long_name", "status of the cell")?;
        put_text(&dataset, "units", "1")?;
        put_numbers(&dataset, "flag_masks", &FLAGS.map(|(mask, _)| mask))?;
        put_text(
            &dataset,
            "flag_meanings",
            &FLAGS.map(|(_, name)| name).join(" "),
        )?;
        Ok(dataset)
    }

    fn variable<T>(&mut self, name: &str, fill: T) -> hdf5::Result<Dataset>
    where
        T: H5Type + Copy + Into<hdf5::types::OwnedDynValue>,
    {
        let mut builder = named(self.file.new_dataset_builder());
        if size_of::<T>() > 1 {
            builder = builder.shuffle();
        }
        let dataset = builder
            .deflate(DEFLATE_LEVEL)
            .fill_value(fill)
            .empty::<T>()
            .shape(self.plan.shape())
            .chunk(self.plan.tiles.tile_shape())
            .create(name)?;
        put_numbers(&dataset, "_FillValue", &[fill])?;
        if !self.scalars.is_empty() {
            put_text(&dataset, "coordinates", &self.scalars)?;
        }
        self.dimensions.attach(&dataset, &self.axes)?;
        Ok(dataset)
    }
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
