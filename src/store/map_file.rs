//! Reads maps.
//!
//! - `axes`: the axes and the system
//! - `cells`: planes, chunks and single cells

mod axes;
mod cells;

use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

use hdf5::{Dataset, File, Group};

use super::attributes::{one_number, text};
use super::contents_hash::contents_hash;
pub(crate) use super::curve_reader::MapCurve;
use super::error::StoreError;
use super::open;
use super::seal::{self, Seal};
use super::values::whole;
use crate::setting::quantity::Quantity;
use crate::setting::system::SystemModel;
use crate::setting::units::Units;
use crate::setting::{Field, Parameter, SweepSpec};
use crate::sweep::described::schema::{
    self, BEST, BOUNDARIES, DEGREE_OF_STABILITY, PLANE, STATUS, root,
};
use crate::text::SpecError;
use axes::{read_axes, read_system};

pub use axes::MapAxis;
pub use cells::Plane;

/// An open map.
///
/// ```
/// use std::sync::Arc;
/// use slipmap::maps::maker::{Job, make};
/// use slipmap::setting::SweepSpec;
/// use slipmap::store::MapFile;
/// use slipmap::sweep::Plan;
/// use slipmap::sweep::described::root::Provenance;
/// use slipmap::sweep::events::Attended;
///
/// let sweep: SweepSpec = "
/// fields = [\"n_unstable\"]
/// [axes]
/// alpha_v = [-0.33, 0.0]
/// tau = { from = 1.0, to = 5.0, points = 9 }
/// [fixed]
/// mu_prime = -0.3
/// ".parse()?;
/// let folder = tempfile::tempdir()?;
/// let path = folder.path().join("map.h5");
/// let plan = Arc::new(Plan::new(sweep)?);
/// make(&plan, &Job::new(&path, 1, &Provenance::default()), Attended::silently(&Arc::default()))?;
/// let map = MapFile::open(&path)?;
/// assert_eq!(map.cells(), 18);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct MapFile {
    path: PathBuf,
    file: File,
    /// The system whose parameters the axes are, where it is not the letter's.
    system: Option<SystemModel>,
    axes: Vec<MapAxis>,
    fields: Vec<Field>,
}

impl MapFile {
    /// Opens a map for reading.
    ///
    /// # Errors
    /// When the file is missing, is open for writing in another program, is no HDF5 file or no map,
    /// has another format version, or is damaged.
    pub fn open(path: &Path) -> Result<Self, StoreError> {
        let file = open::to_read(path, StoreError::not_a_map);
        let own = !file.as_ref().is_ok_and(is_of_another_version);
        let read = file.and_then(|file| Self::read_file(path, file));
        read.map_err(|error| match error {
            // This version reads what it has sealed, unless that has changed.
            StoreError::NotAMap { path, why } if own && seal::is_there(&path) => {
                StoreError::DamagedMap { path, why }
            }
            other => other,
        })
    }

    /// Opens a map to check it. What cannot be read is compared with its seal, whole, so that a
    /// damaged map of any version is told from what this version does not know.
    ///
    /// # Errors
    /// As for [`open`](Self::open).
    pub fn open_to_check(path: &Path) -> Result<Self, StoreError> {
        Self::open(path).map_err(|error| match error {
            StoreError::NotAMap { path, why } if is_changed(&path) => {
                StoreError::DamagedMap { path, why }
            }
            other => other,
        })
    }

    fn read_file(path: &Path, file: File) -> Result<Self, StoreError> {
        let version: i32 = one_number(&file, root::FORMAT_VERSION).ok_or_else(|| {
            let of_trace = one_number::<i32>(&file, schema::trace::FORMAT_VERSION);
            let why = match of_trace {
                Some(_) => "it is a trace of one motion, made by `slipmap simulate`".to_owned(),
                None => format!("it has no {}", root::FORMAT_VERSION),
            };
            StoreError::not_a_map(path, why)
        })?;
        let (oldest, newest) = (schema::OLDEST_FORMAT_VERSION, schema::FORMAT_VERSION);
        if !(oldest..=newest).contains(&version) {
            let why =
                format!("its format version is {version}, this program reads {oldest} to {newest}");
            return Err(StoreError::not_a_map(path, why));
        }
        let system = read_system(&file, path)?;
        let axes = read_axes(&file, system.as_ref(), path)?;
        let fields = Field::ALL
            .into_iter()
            .filter(|field| file.link_exists(held_name(&file, *field)))
            .collect();
        let map = Self {
            path: path.to_owned(),
            file,
            system,
            axes,
            fields,
        };
        map.check_shapes()?;
        map.check_planes()?;
        Ok(map)
    }

    fn check_shapes(&self) -> Result<(), StoreError> {
        let shape: Vec<usize> = self.axes.iter().map(|a| a.values.len()).collect();
        for name in self.names() {
            let dataset = self.dataset(name)?;
            let found = dataset.shape();
            if found != shape {
                let why = format!("{name} has the shape {found:?}, its axes have {shape:?}");
                return Err(StoreError::not_a_map(&self.path, why));
            }
        }
        Ok(())
    }

    /// Checks that each group of planes names two different axes.
    fn check_planes(&self) -> Result<(), StoreError> {
        let there = |group: &&str| self.file.link_exists(group);
        match [BOUNDARIES, BEST]
            .into_iter()
            .filter(there)
            .find(|group| self.plane_of(group).is_none())
        {
            Some(group) => {
                let why = format!("{group} does not name the axes of its planes");
                Err(StoreError::not_a_map(&self.path, why))
            }
            None => Ok(()),
        }
    }

    /// The map under another name, in messages and pictures: for a file that is one of it for a
    /// moment only.
    #[must_use]
    pub fn known_as(mut self, path: &Path) -> Self {
        path.clone_into(&mut self.path);
        self
    }

    /// Where the map is.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The axes, in the order of the dimensions.
    #[must_use]
    pub fn axes(&self) -> &[MapAxis] {
        &self.axes
    }

    /// The fields that the map holds, besides the status.
    #[must_use]
    pub fn fields(&self) -> &[Field] {
        &self.fields
    }

    /// A field that says where sliding is stable; none where the map holds no such field.
    #[must_use]
    pub fn stability_field(&self) -> Option<Field> {
        let mut fields = self.fields.iter().copied();
        fields.find(|field| field.tells_stable(0.0).is_some())
    }

    /// Number of cells.
    #[must_use]
    pub fn cells(&self) -> u64 {
        self.axes.iter().map(|a| a.values.len() as u64).product()
    }

    /// A text attribute of the root by its name in files; none where it is missing.
    #[must_use]
    pub fn root_text(&self, name: &str) -> Option<String> {
        text(&self.file, name).ok()
    }

    /// The text of the sweep file that made the map; empty where the map lacks it.
    #[must_use]
    pub fn sweep_text(&self) -> String {
        self.root_text(root::SWEEP).unwrap_or_default()
    }

    /// The sweep that made the map, read with the meaning that its text had when it was written.
    ///
    /// # Errors
    /// What [`SweepSpec`] refuses, with the place in [`sweep_text`](Self::sweep_text).
    pub fn sweep(&self) -> Result<SweepSpec, SpecError> {
        let mut spec: SweepSpec = self.sweep_text().parse()?;
        if self.format_version() < schema::DISTURBED_SINCE {
            spec.simulation.disturbance = 0.0;
        }
        Ok(spec)
    }

    /// The units of the sweep's parameters; dimensionless where the sweep cannot be read.
    #[must_use]
    pub fn units(&self) -> Units {
        self.sweep()
            .map_or_else(|_| Units::default(), |spec| spec.units)
    }

    /// The hash of everything besides the cells, computed from the file as it is now.
    pub(super) fn contents_hash(&self, stop: &AtomicBool) -> hdf5::Result<String> {
        contents_hash(&self.file, &self.names().collect::<Vec<_>>(), stop)
    }

    /// Version of the file's layout.
    #[must_use]
    pub fn format_version(&self) -> i32 {
        one_number(&self.file, root::FORMAT_VERSION).unwrap_or(schema::FORMAT_VERSION)
    }

    /// Whether some cells are not computed yet.
    #[must_use]
    pub fn is_partial(&self) -> bool {
        self.cells_missing() > 0
    }

    /// Number of cells that are not computed yet.
    #[must_use]
    pub fn cells_missing(&self) -> u64 {
        one_number(&self.file, root::CELLS_MISSING).unwrap_or(0)
    }

    /// The unit of a field.
    #[must_use]
    pub fn field_unit(&self, field: Field) -> String {
        open::dataset(&self.file, self.name_of(field))
            .and_then(|d| text(&d, "units"))
            .unwrap_or_else(|_| "1".into())
    }

    /// The meaning of a field in this map. An outcome beside critical velocities means something
    /// else.
    #[must_use]
    pub fn long_name(&self, field: Field) -> String {
        open::dataset(&self.file, self.name_of(field))
            .and_then(|d| text(&d, "long_name"))
            .unwrap_or_else(|_| field.long_name().into())
    }

    /// The names of the datasets of cells in this file: those of the fields in order, then the
    /// status.
    pub(crate) fn names(&self) -> impl Iterator<Item = &'static str> {
        let fields = self.fields.iter().map(|&f| self.name_of(f));
        fields.chain([STATUS])
    }

    /// The name of a field's dataset in this file.
    pub(crate) fn name_of(&self, field: Field) -> &'static str {
        held_name(&self.file, field)
    }

    /// The dataset of a field.
    pub(super) fn of_field(&self, field: Field) -> Result<Dataset, StoreError> {
        self.dataset(self.name_of(field))
    }

    /// The system, where it is not the letter's.
    #[must_use]
    pub fn system(&self) -> Option<&SystemModel> {
        self.system.as_ref()
    }

    /// Values of the parameters that are no axes.
    #[must_use]
    pub fn scalars(&self) -> Vec<(Quantity, f64)> {
        let on_axis = |p: &Quantity| self.axes.iter().any(|a| a.parameter == *p);
        let all = match &self.system {
            Some(system) => system.quantities(),
            None => Parameter::ALL.into_iter().map(Quantity::from).collect(),
        };
        all.into_iter()
            .filter(|p| !on_axis(p) && self.file.link_exists(p.name()))
            .filter_map(|p| {
                let dataset = open::dataset(&self.file, p.name()).ok();
                let values = whole::<f64>(&dataset?).ok()?;
                Some((p, *values.first()?))
            })
            .collect()
    }

    /// Bytes of each dataset of cells: (name, uncompressed, on disk).
    ///
    /// # Errors
    /// When a dataset cannot be opened.
    pub fn sizes(&self) -> Result<Vec<(&'static str, u64, u64)>, StoreError> {
        self.names()
            .map(|name| {
                let dataset = self.dataset(name)?;
                let element = dataset.dtype().map_or(0, |t| t.size()) as u64;
                Ok((
                    name,
                    dataset.size() as u64 * element,
                    dataset.storage_size(),
                ))
            })
            .collect()
    }

    pub(super) fn dataset(&self, name: &str) -> Result<Dataset, StoreError> {
        open::dataset(&self.file, name)
            .map_err(StoreError::hdf5(format!("read {name} of"), &self.path))
    }

    /// The axes of the planes in which the map holds crossing curves; none for a map without
    /// curves.
    #[must_use]
    pub fn boundary_plane(&self) -> Option<(usize, usize)> {
        self.plane_of(BOUNDARIES)
    }

    /// A group of the file.
    pub(super) fn group(&self, name: &str) -> hdf5::Result<Group> {
        open::group(&self.file, name)
    }

    /// The two axes that a group names as spanning its planes.
    pub(super) fn plane_of(&self, group: &str) -> Option<(usize, usize)> {
        let plane = text(&*self.group(group).ok()?, PLANE).ok()?;
        let mut axes = plane
            .split_whitespace()
            .map(|name| self.axes.iter().position(|a| a.parameter.name() == name));
        let plane = (axes.next()??, axes.next()??);
        (plane.0 != plane.1).then_some(plane)
    }

    /// The unit of degrees of stability; "1" for a map without any.
    #[must_use]
    pub fn degree_unit(&self) -> String {
        let group = self.group(BOUNDARIES);
        group
            .and_then(|group| open::dataset(&group, DEGREE_OF_STABILITY))
            .and_then(|d| text(&d, "units"))
            .unwrap_or_else(|_| "1".into())
    }
}

/// Whether a map names another version of the program that made it.
fn is_of_another_version(file: &File) -> bool {
    let version = text(file, root::PROGRAM_VERSION);
    version.is_ok_and(|version| version != env!("CARGO_PKG_VERSION"))
}

/// Whether a file has the seal of a map, and its bytes are not those that were sealed.
fn is_changed(path: &Path) -> bool {
    let never = AtomicBool::new(false);
    matches!(seal::check(path, &never), Ok(Seal::Broken))
}

/// The name of a field's dataset in `file`: today's, or else the one in old maps.
fn held_name(file: &Group, field: Field) -> &'static str {
    match file.link_exists(field.name()) {
        true => field.name(),
        false => field.first_name(),
    }
}
