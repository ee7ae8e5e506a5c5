//! The source of the cells of a displayed map: its file or, if there is no complete one, the tiles
//! of its run.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant, SystemTime};

use crate::setting::Field;
use crate::setting::field::Storage;
use crate::store::chunk_layout::ChunkLayout;
use crate::store::columns::FileColumns;
use crate::store::map_file::MapAxis;
use crate::store::stamp::Stamp;
use crate::store::tiles::GrowingMap;
use crate::store::{MapFile, StoreError};
use crate::sweep::Plan;
use crate::sweep::engine::{FEW_FILL, N_UNSTABLE_FILL, STATUS_FILL};

/// The time between checks whether a map has been replaced.
const BETWEEN_LOOKS: Duration = Duration::from_millis(500);
/// The time between checks for new tiles.
const BETWEEN_REFRESHES: Duration = Duration::from_secs(2);

/// The facts about a map that do not change while it is displayed.
#[derive(Debug, Clone)]
pub(crate) struct Facts {
    /// Its axes.
    pub axes: Vec<MapAxis>,
    /// Its fields.
    pub fields: Vec<Field>,
    /// The sweep of the map; none where its text cannot be read or does not fit the map.
    pub plan: Option<Plan>,
    /// How its columns are stored: the fields, then the status.
    pub layouts: Vec<ChunkLayout>,
}

impl Facts {
    /// Number of cells.
    #[must_use]
    pub(crate) fn cells(&self) -> u64 {
        self.axes
            .iter()
            .map(|axis| axis.values.len() as u64)
            .product()
    }

    /// The column of a field.
    #[must_use]
    pub(crate) fn column(&self, field: Field) -> Option<usize> {
        self.fields.iter().position(|held| *held == field)
    }

    /// The column of the status.
    #[must_use]
    pub(crate) fn status(&self) -> usize {
        self.fields.len()
    }

    /// The bits of cells of a column that are not computed yet.
    #[must_use]
    pub(crate) fn fill(&self, column: usize) -> u64 {
        match self.fields.get(column).map(|field| field.storage()) {
            Some(Storage::Count) => N_UNSTABLE_FILL.into(),
            Some(Storage::Kind | Storage::Few) => FEW_FILL.into(),
            Some(Storage::Real) => f64::NAN.to_bits(),
            None => STATUS_FILL.into(),
        }
    }
}

/// The cells of a map.
#[derive(Debug)]
pub(super) enum Cells {
    File(Box<FileColumns>),
    Growing(Box<GrowingMap>),
}

/// A map, as far as it is computed.
#[derive(Debug)]
pub(super) struct Source {
    path: PathBuf,
    pub cells: Cells,
    stamp: Option<Stamp>,
    looked: Instant,
    refreshed: Instant,
    /// A number that changes when tiles are added.
    pub version: u64,
    /// Number of computed cells.
    pub cells_done: u64,
}

/// The result of a check whether a map is unchanged.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Still {
    Same,
    /// Cells have been added.
    Grown,
    /// The map is gone or another one has taken its place; it must be opened again.
    Gone,
}

impl Source {
    /// Opens the map at `path`.
    ///
    /// # Errors
    /// When there is none, or it is damaged.
    pub(super) fn open(path: &Path) -> Result<(Self, Facts), StoreError> {
        let stamp = Stamp::of(path);
        let held = stamp.is_some().then(|| MapFile::open(path)).transpose()?;
        let growing = match held.as_ref().is_none_or(MapFile::is_partial) {
            true => GrowingMap::of(path)?,
            false => None,
        };
        let (cells, facts, cells_done) = if let Some(growing) = growing {
            let facts = facts_of_tiles(&growing);
            let (_, done) = growing.done();
            (Cells::Growing(Box::new(growing)), facts, done)
        } else {
            let map = held.map_or_else(|| MapFile::open(path), Ok)?;
            let done = map.cells() - map.cells_missing().min(map.cells());
            let columns = FileColumns::of(map)?;
            let facts = facts_of_file(&columns);
            (Cells::File(Box::new(columns)), facts, done)
        };
        let now = Instant::now();
        let source = Self {
            path: path.to_owned(),
            version: version_of(stamp, &cells),
            cells,
            stamp,
            looked: now,
            refreshed: now,
            cells_done,
        };
        Ok((source, facts))
    }

    /// Checks whether the map is unchanged.
    pub(super) fn look(&mut self) -> Still {
        let now = Instant::now();
        if now - self.looked < BETWEEN_LOOKS {
            return Still::Same;
        }
        self.looked = now;
        if Stamp::of(&self.path) != self.stamp {
            return Still::Gone;
        }
        let Cells::Growing(growing) = &mut self.cells else {
            return Still::Same;
        };
        if now - self.refreshed < BETWEEN_REFRESHES {
            return Still::Same;
        }
        self.refreshed = now;
        if !growing.refresh(&self.path).unwrap_or(false) {
            return Still::Gone;
        }
        let (_, done) = growing.done();
        let version = version_of(self.stamp, &self.cells);
        if version == self.version {
            return Still::Same;
        }
        (self.version, self.cells_done) = (version, done);
        Still::Grown
    }

    /// The stored bytes of a chunk; none where it is not computed yet.
    pub(super) fn stored(
        &mut self,
        column: usize,
        offset: &[usize],
    ) -> Result<Option<Vec<u8>>, StoreError> {
        match &mut self.cells {
            Cells::File(columns) => columns.stored(column, offset),
            Cells::Growing(growing) => growing.stored(column, offset),
        }
    }
}

/// A number that changes whenever tiles were added or the file was written.
fn version_of(stamp: Option<Stamp>, cells: &Cells) -> u64 {
    match cells {
        Cells::Growing(growing) => growing.done().0,
        Cells::File(_) => {
            let since = |time: SystemTime| time.duration_since(SystemTime::UNIX_EPOCH).ok();
            let modified = stamp.and_then(|stamp| since(stamp.modified?));
            // Microseconds are exact as a JavaScript number.
            modified.map_or(0, |time| time.as_micros() as u64)
        }
    }
}

fn facts_of_tiles(growing: &GrowingMap) -> Facts {
    let plan = growing.plan();
    let units = &plan.spec.units;
    let axes = plan.spec.axes.iter().map(|axis| MapAxis {
        parameter: axis.parameter.clone(),
        values: axis.values.clone(),
        unit: axis.parameter.unit(units),
    });
    Facts {
        axes: axes.collect(),
        fields: plan.spec.fields.clone(),
        layouts: (0..=plan.spec.fields.len())
            .filter_map(|column| growing.layout(column))
            .collect(),
        plan: Some(plan.clone()),
    }
}

fn facts_of_file(columns: &FileColumns) -> Facts {
    let map = columns.map();
    let axes = map.axes().to_vec();
    let plan = map.sweep().and_then(Plan::new).ok();
    let plan = plan.filter(|plan| {
        let told = plan.spec.axes.iter();
        let told = told.map(|axis| (&axis.parameter, &axis.values));
        told.eq(axes.iter().map(|axis| (&axis.parameter, &axis.values)))
    });
    Facts {
        fields: map.fields().to_vec(),
        layouts: (0..=map.fields().len())
            .filter_map(|column| columns.layout(column).cloned())
            .collect(),
        axes,
        plan,
    }
}
