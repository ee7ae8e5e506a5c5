//! Short chunks, which are inflated once if several have equal bytes.

use std::collections::HashMap;
use std::sync::Arc;

use super::cells::{AnyCells, Cell, Cells};
use crate::store::chunk_layout::ChunkLayout;

/// Chunks of fewer bytes than this are remembered.
const SHORT: usize = 2048;
/// The most chunks that are remembered.
const MOST: usize = 64;

/// The stored bytes, with everything that determines what they inflate to.
#[derive(Debug, PartialEq, Eq, Hash)]
pub(super) struct Stored {
    cells: usize,
    element: usize,
    deflated: bool,
    shuffled: bool,
    bytes: Vec<u8>,
}

/// Chunks as runs, by their stored bytes.
#[derive(Debug, Default)]
pub(super) struct Short(HashMap<Stored, AnyCells>);

impl Short {
    /// The key by which a chunk is remembered; none where the chunk is too long.
    pub(super) fn key(layout: &ChunkLayout, stored: &[u8]) -> Option<Stored> {
        (stored.len() < SHORT).then(|| Stored {
            cells: layout.cells(),
            element: layout.element,
            deflated: layout.deflated,
            shuffled: layout.shuffled,
            bytes: stored.to_vec(),
        })
    }

    /// The cells of a remembered chunk.
    pub(super) fn get<T: Cell>(&self, key: &Stored) -> Option<Cells<T>> {
        T::unwrapped(self.0.get(key)?)?.copied_runs()
    }

    /// Remembers the cells of a chunk, if they are stored as runs.
    pub(super) fn put<T: Cell>(&mut self, key: Stored, cells: &Cells<T>) {
        if let Some(runs) = cells.copied_runs().filter(|_| self.0.len() < MOST) {
            self.0.insert(key, T::wrapped(Arc::new(runs)));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_same_bytes_are_another_chunk_in_another_layout() {
        let layout = ChunkLayout {
            shape: vec![100],
            chunk: vec![8],
            element: 2,
            deflated: true,
            shuffled: true,
        };
        let others = [
            ChunkLayout {
                chunk: vec![9],
                ..layout.clone()
            },
            ChunkLayout {
                element: 1,
                ..layout.clone()
            },
            ChunkLayout {
                deflated: false,
                ..layout.clone()
            },
            ChunkLayout {
                shuffled: false,
                ..layout.clone()
            },
        ];
        let mut short = Short::default();
        let key = |layout: &ChunkLayout| Short::key(layout, b"stored").unwrap();
        short.put(key(&layout), &Cells::constant(7_u16, 8));
        let same = ChunkLayout {
            shape: vec![200],
            ..layout.clone()
        };
        assert_eq!(short.get(&key(&same)), Some(Cells::constant(7_u16, 8)));
        for other in others {
            assert_eq!(short.get::<u16>(&key(&other)), None, "{other:?}");
        }
        assert!(Short::key(&layout, &[0; SHORT]).is_none());
        let noise = Cells::Each((0..8).collect::<Vec<u16>>());
        let key = Short::key(&layout, b"other").unwrap();
        short.put(key, &noise);
        assert_eq!(short.0.len(), 1);
    }
}
