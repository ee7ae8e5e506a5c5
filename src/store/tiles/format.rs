//! The layout of a tile file: an index with checksums, then the records of pieces.
//!
//! ```text
//! magic (16) · layout (32) · number of records (8)
//! per record: kind (1), zeros (7), number (8), length (8), SHA-256 of its bytes (32)
//! SHA-256 of everything so far (32)
//! the records' bytes, one after the other
//! ```
//!
//! Numbers are unsigned, little-endian. `layout` is a hash of everything that records which belong
//! together have in common.

use std::io::{self, Write};
use std::ops::Range;

use super::record::{Digest, Record, digest};
use crate::sweep::plan::pieces::Piece;

const MAGIC: [u8; 16] = *b"slipmap tiles 1\n";
/// Bytes before the index entries.
pub(super) const HEAD: usize = MAGIC.len() + size_of::<Digest>() + 8;
const ENTRY: usize = 24 + size_of::<Digest>();

/// A record of a tile file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Entry {
    /// Which piece.
    pub piece: Piece,
    /// The range of its bytes in the file.
    pub at: Range<usize>,
    /// The checksum of its bytes.
    pub digest: Digest,
}

/// Why a file, or a part of it, is not used.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum Damage {
    /// Not what slipmap writes.
    #[error("it is no tile file, or its first bytes are damaged")]
    Foreign,
    /// Of another plan, program or format.
    #[error("it belongs to another sweep, program or format")]
    OtherLayout,
    /// The end is missing.
    #[error("it is cut off")]
    Short,
    /// Checksums differ.
    #[error("its checksums do not fit")]
    Checksum,
}

/// Writes a file of records.
///
/// # Errors
/// Those of `out`.
pub fn write(out: &mut impl Write, layout: &Digest, records: &[Record]) -> io::Result<()> {
    let mut head = Vec::with_capacity(HEAD + records.len() * ENTRY);
    head.extend(MAGIC);
    head.extend(layout);
    head.extend((records.len() as u64).to_le_bytes());
    for record in records {
        let (kind, number) = code(record.piece);
        head.extend([kind, 0, 0, 0, 0, 0, 0, 0]);
        head.extend(number.to_le_bytes());
        head.extend((record.payload.len() as u64).to_le_bytes());
        head.extend(record.digest);
    }
    out.write_all(&head)?;
    out.write_all(&digest(&head))?;
    records.iter().try_for_each(|r| out.write_all(&r.payload))
}

/// The index of a file with these `records`.
#[must_use]
pub(crate) fn entries(records: &[Record]) -> Vec<Entry> {
    let mut end = HEAD + records.len() * ENTRY + size_of::<Digest>();
    let entry = |record: &Record| {
        let start = end;
        end += record.payload.len();
        Entry {
            piece: record.piece,
            at: start..end,
            digest: record.digest,
        }
    };
    records.iter().map(entry).collect()
}

/// The number of bytes before the records, from the first [`HEAD`] bytes; none where these are
/// invalid.
pub(super) fn length_of_head(head: &[u8]) -> Option<usize> {
    let head = head.get(..HEAD)?;
    let count = usize::try_from(number(head, HEAD - 8)).ok()?;
    let entries = count.checked_mul(ENTRY)?;
    entries.checked_add(HEAD + size_of::<Digest>())
}

/// The most bytes before the records of a file of a sweep with so many pieces.
pub(super) fn longest_head(pieces: u64) -> u64 {
    let entries = pieces.saturating_mul(ENTRY as u64);
    entries.saturating_add((HEAD + size_of::<Digest>()) as u64)
}

/// The index of a file's bytes. It does not check the records' own checksums, see [`is_sound`].
///
/// # Errors
/// When the index cannot be trusted.
pub fn index(bytes: &[u8], layout: &Digest) -> Result<Vec<Entry>, Damage> {
    let magic = bytes.first_chunk().ok_or(Damage::Short)?;
    if *magic != MAGIC {
        return Err(Damage::Foreign);
    }
    let head = bytes.get(..HEAD).ok_or(Damage::Short)?;
    let count = usize::try_from(number(head, HEAD - 8)).map_err(|_| Damage::Short)?;
    let end = count.checked_mul(ENTRY).and_then(|n| n.checked_add(HEAD));
    let end = end.ok_or(Damage::Short)?;
    let head = bytes.get(..end).ok_or(Damage::Short)?;
    let stored = bytes[end..].first_chunk().ok_or(Damage::Short)?;
    if digest(head) != *stored {
        return Err(Damage::Checksum);
    }
    if head[MAGIC.len()..HEAD - 8] != *layout {
        return Err(Damage::OtherLayout);
    }
    let mut at = end + stored.len();
    let entry = |bytes: &[u8]| {
        let length = usize::try_from(number(bytes, 16)).map_err(|_| Damage::Short)?;
        let start = at;
        at = at.checked_add(length).ok_or(Damage::Short)?;
        let digest = bytes[24..].first_chunk().ok_or(Damage::Short)?;
        Ok(Entry {
            piece: piece(bytes[0], number(bytes, 8)).ok_or(Damage::Foreign)?,
            at: start..at,
            digest: *digest,
        })
    };
    head[HEAD..].chunks_exact(ENTRY).map(entry).collect()
}

/// Whether a record's bytes are in the file and are those that were written.
#[must_use]
pub fn is_sound(bytes: &[u8], entry: &Entry) -> bool {
    bytes
        .get(entry.at.clone())
        .is_some_and(|payload| digest(payload) == entry.digest)
}

fn number(bytes: &[u8], at: usize) -> u64 {
    let eight = bytes.get(at..).and_then(<[u8]>::first_chunk);
    eight.map_or(0, |eight| u64::from_le_bytes(*eight))
}

fn code(piece: Piece) -> (u8, u64) {
    match piece {
        Piece::Curves(n) => (0, n),
        Piece::Best(n) => (1, n),
        Piece::Tile(n) => (2, n),
    }
}

fn piece(kind: u8, number: u64) -> Option<Piece> {
    match kind {
        0 => Some(Piece::Curves(number)),
        1 => Some(Piece::Best(number)),
        2 => Some(Piece::Tile(number)),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const LAYOUT: Digest = [7; 32];

    fn records() -> Vec<Record> {
        vec![
            Record::new(Piece::Curves(0), vec![1, 2, 3]),
            Record::new(Piece::Tile(41), vec![9; 100]),
            Record::new(Piece::Best(2), Vec::new()),
        ]
    }

    fn written() -> Vec<u8> {
        let mut bytes = Vec::new();
        write(&mut bytes, &LAYOUT, &records()).unwrap();
        bytes
    }

    fn sound(bytes: &[u8]) -> Vec<Record> {
        let entries = index(bytes, &LAYOUT).unwrap_or_default();
        let sound = entries.into_iter().filter(|e| is_sound(bytes, e));
        sound
            .map(|e| Record::new(e.piece, bytes[e.at].to_vec()))
            .collect()
    }

    #[test]
    fn what_is_written_is_read() {
        assert_eq!(sound(&written()), records());
        assert_eq!(index(&written(), &LAYOUT), Ok(entries(&records())));
        assert_eq!(index(&written(), &[8; 32]), Err(Damage::OtherLayout));
        assert_eq!(index(b"", &LAYOUT), Err(Damage::Short));
        assert_eq!(index(&[b'x'; 500], &LAYOUT), Err(Damage::Foreign));
    }

    #[test]
    fn every_flipped_bit_is_seen() {
        let whole = written();
        for bit in 0..whole.len() * 8 {
            let mut bytes = whole.clone();
            bytes[bit / 8] ^= 1 << (bit % 8);
            let read = sound(&bytes);
            assert!(
                read.len() < 3 && read.iter().all(|r| records().contains(r)),
                "bit {bit}"
            );
        }
    }

    #[test]
    fn every_cut_is_seen() {
        let whole = written();
        for length in 0..whole.len() {
            let read = sound(&whole[..length]);
            // The last record has no bytes, so cutting the file does not damage it.
            assert!(
                read.len() < 3 && read.iter().all(|r| records().contains(r)),
                "{length}"
            );
        }
    }

    proptest! {
        #[test]
        fn any_bytes_are_answered(
            bytes in proptest::collection::vec(any::<u8>(), 0..300),
            head in any::<bool>(),
        ) {
            let mut all = if head { MAGIC.to_vec() } else { Vec::new() };
            all.extend(bytes);
            prop_assert!(index(&all, &LAYOUT).is_err());
        }
    }
}
