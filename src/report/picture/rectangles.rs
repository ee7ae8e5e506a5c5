//! Joins cells into few rectangles.

use std::collections::HashMap;
use std::hash::Hash;

/// Neighbouring cells with the same key.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Rectangle<K> {
    /// The first row, and the one after the last.
    pub rows: (usize, usize),
    /// The first column, and the one after the last.
    pub columns: (usize, usize),
    /// Their common key.
    pub key: K,
}

/// Joins the cells of rows of this width into rectangles: neighbours with equal keys along rows,
/// then equal stretches of rows.
pub(super) fn rectangles<K: Copy + Ord + Hash>(keys: &[K], width: usize) -> Vec<Rectangle<K>> {
    let width = width.max(1);
    let mut open: HashMap<((usize, usize), K), usize> = HashMap::new();
    let mut done = Vec::new();
    let mut close = |open: &mut HashMap<((usize, usize), K), usize>, end: usize| {
        done.extend(open.drain().map(|((columns, key), start)| Rectangle {
            rows: (start, end),
            columns,
            key,
        }));
    };
    for (r, row) in keys.chunks_exact(width).enumerate() {
        let mut here = HashMap::new();
        for columns in stretches(row) {
            let key = (columns, row[columns.0]);
            here.insert(key, open.remove(&key).unwrap_or(r));
        }
        close(&mut open, r);
        open = here;
    }
    close(&mut open, keys.len() / width);
    // The order of a hash map differs between runs.
    done.sort_unstable();
    done
}

/// Stretches of equal keys as (start, end).
fn stretches<K: PartialEq>(row: &[K]) -> Vec<(usize, usize)> {
    let mut stretches = Vec::new();
    let mut from = 0;
    for to in 1..=row.len() {
        if row.get(to) != Some(&row[from]) {
            stretches.push((from, to));
            from = to;
        }
    }
    stretches
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_that_are_alike_are_joined() {
        let found = rectangles(&['a', 'a', 'b', 'a', 'a', 'c'], 3);
        let of = |rows, columns, key| Rectangle { rows, columns, key };
        assert_eq!(
            found,
            [
                of((0, 1), (2, 3), 'b'),
                of((0, 2), (0, 2), 'a'),
                of((1, 2), (2, 3), 'c')
            ]
        );
        assert!(rectangles::<u8>(&[], 3).is_empty());
    }
}
