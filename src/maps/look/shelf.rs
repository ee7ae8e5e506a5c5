//! Cells that were read, kept while there is room.

use std::collections::HashMap;
use std::sync::Arc;

use super::cells::AnyCells;

/// The most bytes of cells that are kept.
const MOST_BYTES: usize = 48 << 20;
/// Approximate bytes of an entry besides its cells.
const BESIDES: usize = 400;

/// A plane of a map: its slower and its faster axis, and its place along the others.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(super) struct Plane {
    /// None for a line.
    pub slow: Option<usize>,
    pub fast: usize,
    pub at: Vec<usize>,
}

/// The key of cells: all of a chunk, or its part in a plane.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(super) struct Key {
    pub column: usize,
    /// Number of the chunk.
    pub chunk: u64,
    pub plane: Option<Arc<Plane>>,
}

#[derive(Debug)]
struct Kept {
    cells: AnyCells,
    /// The time of the last access.
    wanted: u64,
    /// For a chunk that was missing: the version of the map at that time.
    missing: Option<u64>,
}

/// The cells that are kept.
#[derive(Debug, Default)]
pub(super) struct Shelf {
    kept: HashMap<Key, Kept>,
    bytes: usize,
}

impl Shelf {
    /// The cells under this key, if they are kept and valid in this version of the map. `now`
    /// counts accesses.
    pub(super) fn get(&mut self, key: &Key, version: u64, now: u64) -> Option<AnyCells> {
        let kept = self.kept.get_mut(key)?;
        if kept.missing.is_some_and(|then| then != version) {
            return None;
        }
        kept.wanted = kept.wanted.max(now);
        Some(kept.cells.clone())
    }

    /// The version at which the chunk of these cells was missing, if it was.
    pub(super) fn is_missing(&self, key: &Key) -> Option<u64> {
        self.kept.get(key)?.missing
    }

    /// Keeps cells if there is room, dropping others that were not accessed for longer.
    pub(super) fn put(&mut self, key: Key, cells: AnyCells, missing: Option<u64>, now: u64) {
        let needed = cells.bytes() + BESIDES;
        if self.bytes + needed > MOST_BYTES {
            self.drop_older(now);
        }
        if self.bytes + needed > MOST_BYTES {
            return;
        }
        self.bytes += needed;
        let kept = Kept {
            cells,
            wanted: now,
            missing,
        };
        if let Some(before) = self.kept.insert(key, kept) {
            self.bytes -= before.cells.bytes() + BESIDES;
        }
    }

    /// Drops the quarter that was not accessed for the longest time; nothing that was accessed at
    /// `now`.
    fn drop_older(&mut self, now: u64) {
        let mut times: Vec<(u64, usize)> = self
            .kept
            .values()
            .map(|kept| (kept.wanted, kept.cells.bytes() + BESIDES))
            .collect();
        times.sort_unstable();
        let mut freed = 0;
        let mut until = 0;
        for (wanted, bytes) in times {
            if freed >= MOST_BYTES / 4 || wanted >= now {
                break;
            }
            freed += bytes;
            until = wanted;
        }
        let bytes = &mut self.bytes;
        self.kept.retain(|_, kept| {
            let stays = kept.wanted > until || kept.wanted >= now;
            if !stays {
                *bytes -= kept.cells.bytes() + BESIDES;
            }
            stays
        });
    }
}

#[cfg(test)]
mod tests {
    use super::super::cells::{Cell, Cells};
    use super::*;

    fn key(chunk: u64) -> Key {
        Key {
            column: 0,
            chunk,
            plane: None,
        }
    }

    #[test]
    fn room_is_kept_for_what_is_wanted_now() {
        let mut shelf = Shelf::default();
        let megabyte = || u8::wrapped(Arc::new(Cells::Each(vec![0; 1 << 20])));
        for chunk in 0..40 {
            shelf.put(key(chunk), megabyte(), None, 1);
        }
        for chunk in 100..140 {
            shelf.put(key(chunk), megabyte(), None, 2);
            assert!(shelf.bytes <= MOST_BYTES);
        }
        assert!((100..140).all(|chunk| shelf.get(&key(chunk), 0, 2).is_some()));
        for chunk in 200..300 {
            shelf.put(key(chunk), megabyte(), None, 2);
        }
        assert!((100..140).all(|chunk| shelf.get(&key(chunk), 0, 2).is_some()));
        assert!(shelf.bytes <= MOST_BYTES);
    }

    #[test]
    fn what_was_missing_is_looked_for_again_once_more_is_there() {
        let mut shelf = Shelf::default();
        let fill = u8::wrapped(Arc::new(Cells::constant(255, 10)));
        shelf.put(key(1), fill, Some(7), 1);
        assert!(shelf.get(&key(1), 7, 1).is_some());
        assert!(shelf.get(&key(1), 8, 1).is_none());
    }
}
