//! Pieces on their way from the computing threads to the map: bytes, with a checksum.

use serde::Serialize;
use serde::de::DeserializeOwned;
use sha2::{Digest as _, Sha256};

use super::super::best_writer::BestRow;
use super::super::codec::{Chunk, ChunkCodec, decode_bytes};
use super::super::curve_rows::CurveRows;
use crate::sweep::engine::{Computed, Encode};
use crate::sweep::plan::pieces::Piece;

/// SHA-256.
pub type Digest = [u8; 32];

/// A computed piece as bytes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Record {
    /// Which piece.
    pub piece: Piece,
    /// Its bytes, as the encoder wrote them.
    pub payload: Vec<u8>,
    /// Their checksum.
    pub digest: Digest,
}

impl Record {
    pub(super) fn new(piece: Piece, payload: Vec<u8>) -> Self {
        Self {
            piece,
            digest: digest(&payload),
            payload,
        }
    }
}

/// The checksum of bytes.
pub(super) fn digest(bytes: &[u8]) -> Digest {
    Sha256::digest(bytes).into()
}

/// What a payload holds.
pub(crate) enum Content<'a> {
    /// The rows of a plane of curves.
    Curves(Box<CurveRows>),
    /// The row of a plane of best settings.
    Best(BestRow),
    /// The compressed chunks of a tile, in the order of the map's datasets.
    Tile(Vec<&'a [u8]>),
}

impl<'a> Content<'a> {
    /// Reads the payload of a piece; none where it is not what it should be.
    pub(crate) fn read(piece: Piece, payload: &'a [u8]) -> Option<Self> {
        match piece {
            Piece::Curves(_) => {
                let rows: Box<CurveRows> = whole(payload)?;
                rows.is_consistent().then_some(Self::Curves(rows))
            }
            Piece::Best(_) => whole(payload).map(Self::Best),
            Piece::Tile(_) => chunks(payload).map(Self::Tile),
        }
    }
}

/// Whether bytes are the payload of such a piece; of a tile, whose chunks have `status_cells`
/// statuses in the last one.
#[must_use]
pub fn is_readable(piece: Piece, payload: &[u8], status_cells: usize) -> bool {
    match Content::read(piece, payload) {
        Some(Content::Tile(chunks)) => {
            let status = chunks.last().and_then(|c| decode_bytes(c, status_cells));
            status.is_some()
        }
        content => content.is_some(),
    }
}

fn whole<T: DeserializeOwned>(payload: &[u8]) -> Option<T> {
    let (value, rest) = postcard::take_from_bytes(payload).ok()?;
    rest.is_empty().then_some(value)
}

/// Chunks one after the other, each after its length.
fn chunks(mut payload: &[u8]) -> Option<Vec<&[u8]>> {
    let mut chunks = Vec::new();
    while !payload.is_empty() {
        let (length, rest) = payload.split_first_chunk()?;
        let length = usize::try_from(u64::from_le_bytes(*length)).ok()?;
        let (chunk, rest) = rest.split_at_checked(length)?;
        chunks.push(chunk);
        payload = rest;
    }
    Some(chunks)
}

fn put_chunk(payload: &mut Vec<u8>, chunk: &Chunk) {
    payload.extend((chunk.len() as u64).to_le_bytes());
    payload.extend(&**chunk);
}

/// Turns pieces into records, one per thread.
#[derive(Default)]
pub struct RecordEncoder {
    codec: ChunkCodec,
}

impl Encode for RecordEncoder {
    type Encoded = Record;

    fn encode(&mut self, piece: Piece, computed: Computed) -> Record {
        let payload = match computed {
            Computed::Curves(plane) => packed(&CurveRows::of(plane)),
            Computed::Best(found) => packed(&BestRow::of(found)),
            Computed::Tile(buffers) => {
                let mut payload = Vec::new();
                let mut put = |chunk: Chunk| put_chunk(&mut payload, &chunk);
                if let Some(n) = &buffers.n_unstable {
                    put(self.codec.encode(n));
                }
                for column in &buffers.kinds {
                    put(self.codec.encode(&column.cells));
                }
                for column in &buffers.columns {
                    put(self.codec.encode(&column.cells));
                }
                put(self.codec.encode(&buffers.status));
                payload
            }
        };
        Record::new(piece, payload)
    }
}

fn packed(rows: &impl Serialize) -> Vec<u8> {
    // Only sequences of unknown length and failing implementations are refused, and there are none.
    postcard::to_stdvec(rows).unwrap_or_default()
}
