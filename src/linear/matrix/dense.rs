//! Real matrices by rows, with the few operations that the room needs.

/// A real matrix.
#[derive(Debug, Clone, PartialEq)]
pub struct Matrix {
    rows: usize,
    columns: usize,
    values: Vec<f64>,
}

impl Matrix {
    /// The matrix of these numbers, row by row.
    ///
    /// # Panics
    /// When there are not `rows` times `columns` of them.
    #[must_use]
    pub fn new(rows: usize, columns: usize, values: Vec<f64>) -> Self {
        assert_eq!(values.len(), rows * columns, "numbers of a matrix");
        Self {
            rows,
            columns,
            values,
        }
    }

    /// The matrix of the numbers that `entry` gives for a row and a column.
    pub(super) fn of(rows: usize, columns: usize, entry: impl Fn(usize, usize) -> f64) -> Self {
        let places = (0..rows).flat_map(|i| (0..columns).map(move |j| (i, j)));
        Self::new(rows, columns, places.map(|(i, j)| entry(i, j)).collect())
    }

    /// A matrix of zeros.
    pub(super) fn zeros(rows: usize, columns: usize) -> Self {
        Self::new(rows, columns, vec![0.0; rows * columns])
    }

    /// The unit matrix.
    pub(super) fn unit(size: usize) -> Self {
        Self::of(size, size, |i, j| if i == j { 1.0 } else { 0.0 })
    }

    /// The number of rows.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// The number of columns.
    #[must_use]
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// The number in a row and a column.
    #[inline]
    #[must_use]
    pub fn at(&self, row: usize, column: usize) -> f64 {
        self.values[row * self.columns + column]
    }

    #[inline]
    pub(super) fn set(&mut self, row: usize, column: usize, value: f64) {
        self.values[row * self.columns + column] = value;
    }

    /// Whether all numbers are 0.
    pub(super) fn is_zero(&self) -> bool {
        self.values.iter().all(|value| *value == 0.0)
    }

    /// Whether all numbers are finite.
    pub(super) fn is_finite(&self) -> bool {
        self.values.iter().all(|value| value.is_finite())
    }

    /// The matrix with `change` of each number.
    pub(super) fn mapped(&self, change: impl Fn(f64) -> f64) -> Self {
        let values = self.values.iter().map(|value| change(*value)).collect();
        Self { values, ..*self }
    }

    /// This matrix plus `by` times `other`, which is of its size.
    pub(super) fn plus(&self, other: &Self, by: f64) -> Self {
        Self::of(self.rows, self.columns, |i, j| {
            self.at(i, j) + by * other.at(i, j)
        })
    }

    /// The product with `other`, which has as many rows as this one has columns.
    pub(super) fn times(&self, other: &Self) -> Self {
        Self::of(self.rows, other.columns, |i, j| {
            (0..self.columns)
                .map(|k| self.at(i, k) * other.at(k, j))
                .sum()
        })
    }

    /// The Kronecker product with the unit matrix of `size` on the right.
    pub(super) fn beside_unit(&self, size: usize) -> Self {
        Self::of(self.rows * size, self.columns * size, |i, j| {
            let same = i % size == j % size;
            if same {
                self.at(i / size, j / size)
            } else {
                0.0
            }
        })
    }

    /// The Kronecker product with the unit matrix of `size` on the left.
    pub(super) fn in_unit(&self, size: usize) -> Self {
        let (rows, columns) = (self.rows, self.columns);
        Self::of(rows * size, columns * size, |i, j| {
            let same = i / rows == j / columns;
            if same {
                self.at(i % rows, j % columns)
            } else {
                0.0
            }
        })
    }

    /// U and V with U V = this matrix within rounding, U having as few columns as that takes.
    ///
    /// Elimination with complete pivoting: a matrix with one row or column has exact factors.
    pub(super) fn factors(&self) -> (Self, Self) {
        let (mut left, mut size) = (self.clone(), self.mapped(f64::abs));
        let (mut columns, mut rows): (Vec<Vec<f64>>, Vec<Vec<f64>>) = (Vec::new(), Vec::new());
        let rounding = 16.0 * (self.rows + self.columns) as f64 * f64::EPSILON;
        while rows.len() < self.rows.min(self.columns) {
            let places = (0..self.values.len())
                .filter(|&i| left.values[i].abs() > rounding * size.values[i]);
            let largest =
                places.max_by(|&i, &j| left.values[i].abs().total_cmp(&left.values[j].abs()));
            let Some(pivot) = largest else {
                break;
            };
            let (row, column) = (pivot / self.columns, pivot % self.columns);
            let per_pivot = 1.0 / left.values[pivot];
            let u: Vec<f64> = (0..self.rows)
                .map(|i| {
                    if i == row {
                        1.0
                    } else {
                        left.at(i, column) * per_pivot
                    }
                })
                .collect();
            let v: Vec<f64> = (0..self.columns).map(|j| left.at(row, j)).collect();
            for (i, u) in u.iter().enumerate() {
                for (j, v) in v.iter().enumerate() {
                    let cross = i == row || j == column;
                    let rest = if cross { 0.0 } else { left.at(i, j) - u * v };
                    left.set(i, j, rest);
                    size.set(i, j, size.at(i, j) + (u * v).abs());
                }
            }
            columns.push(u);
            rows.push(v);
        }
        let rank = rows.len();
        (
            Self::of(self.rows, rank, |i, k| columns[k][i]),
            Self::of(rank, self.columns, |k, j| rows[k][j]),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn factors_have_the_rank_and_the_product() {
        let u = Matrix::new(4, 2, vec![1.0, 0.3, -2.0, 0.7, 0.1, 5.0, 3.0, -1.0]);
        let v = Matrix::new(2, 4, vec![0.2, 4.0, -1.0, 0.5, 3.0, 0.1, 0.7, -2.0]);
        let product = u.times(&v);
        let (left, right) = product.factors();
        assert_eq!(left.columns(), 2);
        let rest = left.times(&right).plus(&product, -1.0);
        assert!(rest.values.iter().all(|r| r.abs() < 1e-14), "{rest:?}");
        assert_eq!(Matrix::zeros(3, 3).factors().0.columns(), 0);
    }

    #[test]
    fn one_row_is_its_own_factor() {
        let row = Matrix::new(3, 3, vec![0.0, 0.0, 0.0, 0.1, 0.2, 0.3, 0.0, 0.0, 0.0]);
        let (left, right) = row.factors();
        assert_eq!(left, Matrix::new(3, 1, vec![0.0, 1.0, 0.0]));
        assert_eq!(right, Matrix::new(1, 3, vec![0.1, 0.2, 0.3]));
    }
}
