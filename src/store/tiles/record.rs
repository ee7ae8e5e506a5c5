//! Pieces between the computing threads and the map: bytes with a checksum.

use serde::Serialize;
use serde::de::DeserializeOwned;
use sha2::{Digest as _, Sha256};

use super::super::codec::{Chunk, ChunkCodec, decode_bytes};
use crate::sweep::described::best::BestRow;
use crate::sweep::described::curve_rows::CurveRows;
use crate::sweep::described::summary::CellsSummary;
use crate::sweep::engine::{Computed, Encode};
use crate::sweep::plan::pieces::Piece;

/// SHA-256.
pub type Digest = [u8; 32];

/// A computed piece, encoded as bytes.
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

/// The decoded payload of a record.
pub(crate) enum Content<'a> {
    /// The rows of a plane of curves.
    Curves(Box<CurveRows>),
    /// The row of a plane of best settings.
    Best(BestRow),
    /// A tile.
    Tile(TileContent<'a>),
}

/// The stored contents of a tile.
pub(crate) struct TileContent<'a> {
    /// Summary of the values of its cells.
    pub summary: CellsSummary,
    /// Its compressed chunks, in the order of the map's datasets.
    pub chunks: Vec<&'a [u8]>,
}

impl<'a> Content<'a> {
    /// Reads the payload of a piece; none where it is invalid.
    pub(crate) fn read(piece: Piece, payload: &'a [u8]) -> Option<Self> {
        match piece {
            Piece::Curves(_) => {
                let rows: Box<CurveRows> = whole(payload)?;
                rows.is_consistent().then_some(Self::Curves(rows))
            }
            Piece::Best(_) => whole(payload).map(Self::Best),
            Piece::Tile(_) => TileContent::read(payload).map(Self::Tile),
        }
    }
}

/// Whether bytes are a valid payload of `piece`. For a tile, the last chunk must have
/// `status_cells` statuses.
#[must_use]
pub fn is_readable(piece: Piece, payload: &[u8], status_cells: usize) -> bool {
    match Content::read(piece, payload) {
        Some(Content::Tile(tile)) => {
            let status = tile
                .chunks
                .last()
                .and_then(|c| decode_bytes(c, status_cells));
            status.is_some()
        }
        content => content.is_some(),
    }
}

fn whole<T: DeserializeOwned>(payload: &[u8]) -> Option<T> {
    let (value, rest) = postcard::take_from_bytes(payload).ok()?;
    rest.is_empty().then_some(value)
}

impl<'a> TileContent<'a> {
    /// Reads the summary, then the chunks. The length of each part comes before it.
    fn read(payload: &'a [u8]) -> Option<Self> {
        let (summary, mut payload) = split_part(payload)?;
        let mut chunks = Vec::new();
        while !payload.is_empty() {
            let (chunk, rest) = split_part(payload)?;
            chunks.push(chunk);
            payload = rest;
        }
        let summary: CellsSummary = whole(summary)?;
        let all = summary.fields.len() + 1 == chunks.len();
        all.then_some(Self { summary, chunks })
    }
}

fn split_part(payload: &[u8]) -> Option<(&[u8], &[u8])> {
    let (length, rest) = payload.split_first_chunk()?;
    let length = usize::try_from(u64::from_le_bytes(*length)).ok()?;
    rest.split_at_checked(length)
}

fn put_part(payload: &mut Vec<u8>, part: &[u8]) {
    payload.extend((part.len() as u64).to_le_bytes());
    payload.extend(part);
}

/// Encodes pieces as records; each thread has its own.
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
                put_part(&mut payload, &packed(&CellsSummary::of(buffers)));
                let mut put = |chunk: Chunk| put_part(&mut payload, &chunk);
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
    // Serialisation fails only for sequences of unknown length and custom implementations. Rows
    // have neither.
    postcard::to_stdvec(rows).unwrap_or_default()
}
