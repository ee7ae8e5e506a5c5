//! Tile files: their index, their records, and what is in these once the checksums fit.

use sha2::{Digest, Sha256};
use slipmap::store::tiles::format::{index, is_sound};
use slipmap::store::tiles::record::is_readable;
use slipmap::sweep::{Piece, Pieces};

const LAYOUT: [u8; 32] = [7; 32];
/// Statuses in the tiles.
const CELLS: usize = 4096;

/// The first byte says how the others are meant.
pub(super) fn tiles(data: &[u8]) {
    let Some((&how, rest)) = data.split_first() else {
        return;
    };
    match how % 5 {
        0 => file(rest),
        1 => file(&sealed(rest)),
        2 => payload(Piece::Curves(0), rest),
        3 => payload(Piece::Best(0), rest),
        _ => payload(Piece::Tile(0), rest),
    }
}

fn payload(piece: Piece, bytes: &[u8]) {
    let _ = is_readable(piece, bytes, CELLS);
}

/// A file, as readers of tiles take it.
fn file(bytes: &[u8]) {
    let pieces = Pieces {
        curves: 3,
        best: 2,
        tiles: 100,
    };
    let Ok(entries) = index(bytes, &LAYOUT) else {
        return;
    };
    for entry in entries {
        let known = pieces.place(entry.piece).is_some();
        if is_sound(bytes, &entry) && known {
            payload(entry.piece, &bytes[entry.at]);
        }
    }
}

/// A file whose checksums fit whatever `plan` says: a byte with the number of records, three for
/// each of them (kind, number, what is said of its length), and their bytes.
fn sealed(plan: &[u8]) -> Vec<u8> {
    let (&count, rest) = plan.split_first().unwrap_or((&0, &[]));
    let count = usize::from(count % 8).min(rest.len() / 3);
    let (records, payloads) = rest.split_at(3 * count);
    let share = payloads.len() / count.max(1);
    let mut file = b"slipmap tiles 1\n".to_vec();
    file.extend(LAYOUT);
    file.extend((count as u64).to_le_bytes());
    for (i, record) in records.chunks_exact(3).enumerate() {
        let payload = &payloads[i * share..(i + 1) * share];
        file.extend([record[0] % 4, 0, 0, 0, 0, 0, 0, 0]);
        file.extend(u64::from(record[1]).to_le_bytes());
        let length = share as u64;
        let told = match record[2] {
            1 => length + 1,
            2 => u64::MAX,
            3 => u64::MAX - length,
            4 => 1 << 63,
            5 => length.saturating_sub(1),
            6 => 1 << 40,
            _ => length,
        };
        file.extend(told.to_le_bytes());
        file.extend(digest(payload));
    }
    file.extend(digest(&file.clone()));
    file.extend(payloads);
    file
}

fn digest(bytes: &[u8]) -> [u8; 32] {
    Sha256::digest(bytes).into()
}
