//! The columns of a map, its fields and the status, chunk by chunk as stored in the file.

use super::chunk_layout::ChunkLayout;
use super::error::StoreError;
use super::map_file::MapFile;
use super::values::{Chunks, is_of};
use crate::setting::field::Storage;
use crate::sweep::described::schema::STATUS;
use crate::sweep::plan::MOST_TILES;

/// The columns of a map, each open: the fields in the order of [`MapFile::fields`], then the
/// status.
#[derive(Debug)]
pub(crate) struct FileColumns {
    map: MapFile,
    columns: Vec<Chunks>,
}

impl FileColumns {
    /// Opens all columns.
    ///
    /// # Errors
    /// When one is not stored as slipmap stores columns.
    pub(crate) fn of(map: MapFile) -> Result<Self, StoreError> {
        let fields = map.fields().iter();
        let columns = fields.map(|&field| (map.name_of(field), field.storage()));
        let open = |(name, storage): (&str, Storage)| {
            let dataset = map.dataset(name)?;
            let kind = dataset.dtype();
            let as_expected = match storage {
                Storage::Count => is_of::<u16>(&kind),
                Storage::Kind | Storage::Few => is_of::<u8>(&kind),
                Storage::Real => is_of::<f64>(&kind),
            };
            if !as_expected {
                let why = format!("the values of {name} are of another type");
                return Err(StoreError::not_a_map(map.path(), why));
            }
            let chunks = Chunks::of(&dataset).map_err(StoreError::hdf5("read", map.path()))?;
            let odd = |why: String| StoreError::not_a_map(map.path(), why);
            let chunks = chunks.ok_or_else(|| odd(format!("{name} is not stored in chunks")))?;
            match chunks.layout().chunks() {
                ..=MOST_TILES => Ok(chunks),
                count => Err(odd(format!(
                    "{name} is stored in {count} chunks, and slipmap writes {MOST_TILES} at most"
                ))),
            }
        };
        let columns: Result<_, _> = columns.chain([(STATUS, Storage::Kind)]).map(open).collect();
        Ok(Self {
            columns: columns?,
            map,
        })
    }

    /// The map that the columns belong to.
    #[must_use]
    pub(crate) fn map(&self) -> &MapFile {
        &self.map
    }

    /// How a column is stored; none where there is no such column.
    #[must_use]
    pub(crate) fn layout(&self, column: usize) -> Option<&ChunkLayout> {
        self.columns.get(column).map(Chunks::layout)
    }

    /// The stored bytes of the chunk of a column whose first cell is at `offset`; none where the
    /// file has no such chunk.
    ///
    /// # Errors
    /// When the chunk cannot be read.
    pub(crate) fn stored(
        &self,
        column: usize,
        offset: &[usize],
    ) -> Result<Option<Vec<u8>>, StoreError> {
        match self.columns.get(column) {
            Some(chunks) => {
                let stored = chunks.stored(offset);
                stored.map_err(StoreError::hdf5("read", self.map.path()))
            }
            None => Ok(None),
        }
    }
}
