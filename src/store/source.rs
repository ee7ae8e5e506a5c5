//! Where the pieces of a map come from.

use std::collections::BTreeMap;

use super::error::StoreError;
use super::tiles::{Record, RecordEncoder};
use crate::sweep::engine::Sink;
use crate::sweep::plan::pieces::Piece;

/// A source of pieces, as the bytes of their records.
pub trait Source {
    /// The bytes of a piece; none where the source lacks it.
    ///
    /// # Errors
    /// When the bytes cannot be read, or are not those that were written.
    fn read(&mut self, piece: Piece) -> Result<Option<Vec<u8>>, StoreError>;
}

/// Several sources as one: the first one with a piece gives it.
impl<S: Source> Source for Vec<S> {
    fn read(&mut self, piece: Piece) -> Result<Option<Vec<u8>>, StoreError> {
        for source in self {
            if let Some(payload) = source.read(piece)? {
                return Ok(Some(payload));
            }
        }
        Ok(None)
    }
}

/// Pieces in memory, for maps so small that a lost computation does not matter.
#[derive(Debug, Default)]
pub struct InMemory(BTreeMap<Piece, Vec<u8>>);

impl Sink for InMemory {
    type Encoder = RecordEncoder;
    type Error = StoreError;

    fn encoder(&self) -> RecordEncoder {
        RecordEncoder::default()
    }

    fn write(&mut self, piece: Piece, record: Record) -> Result<(), StoreError> {
        self.0.insert(piece, record.payload);
        Ok(())
    }
}

impl Source for InMemory {
    fn read(&mut self, piece: Piece) -> Result<Option<Vec<u8>>, StoreError> {
        Ok(self.0.remove(&piece))
    }
}
