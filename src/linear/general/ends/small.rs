//! A few equations in a few unknowns: their values, derivatives by differences, linear systems.

/// Steps of difference quotients, over max(1, |y|).
const DIFFERENCE: f64 = 1e-5;
/// The most unknowns: b, g, τ, δ, two frequencies and four multipliers.
pub(super) const MOST: usize = 10;

/// Values of all unknowns, or of equations; as many as count.
#[derive(Clone, Copy)]
pub(super) struct Values {
    pub of: [f64; MOST],
    pub count: usize,
}

impl Values {
    pub(super) const NONE: Self = Self {
        of: [0.0; MOST],
        count: 0,
    };

    pub(super) fn push(&mut self, value: f64) {
        self.of[self.count] = value;
        self.count += 1;
    }

    pub(super) fn all(&self) -> &[f64] {
        &self.of[..self.count]
    }
}

/// The derivatives of `of` with respect to each of `y`, by central differences.
pub(super) fn differences(of: &dyn Fn(&[f64]) -> Values, y: &[f64]) -> [Values; MOST] {
    let mut slopes = [Values::NONE; MOST];
    let mut moved = [0.0; MOST];
    moved[..y.len()].copy_from_slice(y);
    for (i, slope) in slopes.iter_mut().enumerate().take(y.len()) {
        let h = DIFFERENCE * y[i].abs().max(1.0);
        let mut at = |x: f64| {
            moved[i] = x;
            of(&moved[..y.len()])
        };
        let (above, below) = (at(y[i] + h), at(y[i] - h));
        moved[i] = y[i];
        for (a, b) in above.all().iter().zip(below.all()) {
            slope.push((a - b) / (2.0 * h));
        }
    }
    slopes
}

/// The solution x of Σ x_i `columns`_i = `right`, by Gaussian elimination with pivoting; none where
/// the columns are dependent.
pub(super) fn solve(columns: &[Values], right: &[f64]) -> Option<[f64; MOST]> {
    let n = columns.len();
    let mut rows = [[0.0; MOST + 1]; MOST];
    for (i, row) in rows.iter_mut().enumerate().take(n) {
        for (j, column) in columns.iter().enumerate() {
            row[j] = column.of[i];
        }
        row[n] = right[i];
    }
    for k in 0..n {
        let size = |i: &usize| rows[*i][k].abs();
        let pivot = (k..n).max_by(|i, j| size(i).total_cmp(&size(j)))?;
        rows.swap(k, pivot);
        let above = rows[k];
        for row in &mut rows[k + 1..n] {
            let factor = row[k] / above[k];
            for (entry, from) in row.iter_mut().zip(above).skip(k) {
                *entry -= factor * from;
            }
        }
    }
    let mut x = [0.0; MOST];
    for i in (0..n).rev() {
        let known: f64 = (i + 1..n).map(|j| rows[i][j] * x[j]).sum();
        x[i] = (rows[i][n] - known) / rows[i][i];
    }
    x[..n].iter().all(|v| v.is_finite()).then_some(x)
}
