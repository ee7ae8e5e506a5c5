//! Which powers of λ a determinant can have by the zeros of its matrix alone.

/// What stands for an entry that is 0.
const NONE: i64 = 1 << 32;

/// The least and the largest power of λ in a determinant of `size` rows of which `entry` says what
/// is in a row and a column: whether a number other than 0, and whether λ; none where it vanishes.
pub(super) fn powers(
    size: usize,
    entry: impl Fn(usize, usize) -> (bool, bool),
) -> Option<[usize; 2]> {
    let least = least_sum(size, |i, j| match entry(i, j) {
        (true, _) => 0,
        (false, true) => 1,
        _ => NONE,
    });
    let others = least_sum(size, |i, j| match entry(i, j) {
        (_, true) => 0,
        (true, false) => 1,
        _ => NONE,
    });
    let some = least < NONE && others < NONE;
    some.then(|| [least as usize, size - others as usize])
}

/// The least sum of one cost of each row and each column (the Hungarian method, Kuhn 1955).
fn least_sum(size: usize, cost: impl Fn(usize, usize) -> i64) -> i64 {
    // The row of each column; row and column 0 are none.
    let (mut rows, mut of_rows) = (vec![0; size + 1], vec![0_i64; size + 1]);
    let mut of_columns = vec![0_i64; size + 1];
    for row in 1..=size {
        rows[0] = row;
        let (mut nearest, mut before) = (vec![i64::MAX; size + 1], vec![0; size + 1]);
        let (mut seen, mut column) = (vec![false; size + 1], 0);
        while rows[column] != 0 {
            seen[column] = true;
            let (from, mut step, mut next) = (rows[column], i64::MAX, 0);
            for j in (1..=size).filter(|&j| !seen[j]) {
                let left = cost(from - 1, j - 1) - of_rows[from] - of_columns[j];
                if left < nearest[j] {
                    (nearest[j], before[j]) = (left, column);
                }
                if nearest[j] < step {
                    (step, next) = (nearest[j], j);
                }
            }
            for j in 0..=size {
                if seen[j] {
                    of_rows[rows[j]] += step;
                    of_columns[j] -= step;
                } else if j > 0 {
                    nearest[j] -= step;
                }
            }
            column = next;
        }
        while column != 0 {
            rows[column] = rows[before[column]];
            column = before[column];
        }
    }
    (1..=size).map(|j| cost(rows[j] - 1, j - 1)).sum()
}
