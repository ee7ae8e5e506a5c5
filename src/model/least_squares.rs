//! Linear least squares: the numbers whose sum of columns comes closest to another column.
//!
//! The columns are factored as Q R, with Q of orthonormal columns and R upper triangular, by the
//! method of Gram and Schmidt, twice for each column: then Q is orthonormal to rounding (L. Giraud,
//! J. Langou and M. Rozložník, *Comput. Math. Appl.* 50 (2005) 1069).

/// A column is told from those before it where more than this share of it is left.
const TOLD_APART: f64 = 3e-6;

/// Columns in their factors.
#[derive(Debug, Clone)]
pub(crate) struct LeastSquares {
    /// The columns of Q.
    basis: Vec<Vec<f64>>,
    /// The columns of R, to the diagonal.
    factor: Vec<Vec<f64>>,
}

fn dot(one: &[f64], other: &[f64]) -> f64 {
    one.iter().zip(other).map(|(x, y)| x * y).sum()
}

impl LeastSquares {
    /// Of columns of one length; none where one follows from those before it, or is not finite.
    pub(crate) fn of(columns: impl IntoIterator<Item = Vec<f64>>) -> Option<Self> {
        let (mut basis, mut factor) = (Vec::<Vec<f64>>::new(), Vec::new());
        for mut column in columns {
            let whole = dot(&column, &column).sqrt();
            let mut above = vec![0.0; basis.len()];
            for _ in 0..2 {
                for (of, q) in above.iter_mut().zip(&basis) {
                    let along = dot(q, &column);
                    *of += along;
                    for (x, q) in column.iter_mut().zip(q) {
                        *x -= along * q;
                    }
                }
            }
            let left = dot(&column, &column).sqrt();
            if !left.is_finite() || left <= TOLD_APART * whole {
                return None;
            }
            above.push(left);
            factor.push(above);
            basis.push(column.into_iter().map(|x| x / left).collect());
        }
        Some(Self { basis, factor })
    }

    /// The numbers of the columns whose sum comes closest to `right`.
    pub(crate) fn solve(&self, right: &[f64]) -> Vec<f64> {
        self.back(self.basis.iter().map(|q| dot(q, right)).collect())
    }

    /// How far one number of `right`, that of a row, moves the numbers of the solution.
    #[cfg(any(test, feature = "fit"))]
    pub(crate) fn moved_by(&self, row: usize) -> Vec<f64> {
        self.back(self.basis.iter().map(|q| q[row]).collect())
    }

    /// How far it moves its own place in the sum: from 0 to 1.
    #[cfg(any(test, feature = "fit"))]
    pub(crate) fn leverage(&self, row: usize) -> f64 {
        self.basis.iter().map(|q| q[row] * q[row]).sum()
    }

    /// R⁻¹ of numbers.
    fn back(&self, mut numbers: Vec<f64>) -> Vec<f64> {
        for j in (0..numbers.len()).rev() {
            let (diagonal, above) = self.factor[j].split_last().unwrap_or((&1.0, &[]));
            numbers[j] /= diagonal;
            let found = numbers[j];
            for (number, r) in numbers.iter_mut().zip(above) {
                *number -= r * found;
            }
        }
        numbers
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A line through points, by the formulas of sums; an exact solution of columns that are nearly
    /// parallel; what follows from others.
    #[test]
    fn solutions_are_those_of_the_normal_equations() {
        let x = [0.0, 1.0, 2.0, 4.0, 7.0];
        let y = [1.0, 3.5, 4.0, 9.5, 14.0];
        let of = LeastSquares::of([vec![1.0; 5], x.to_vec()]).unwrap();
        let (n, sx, sy) = (5.0, 14.0, 32.0);
        let (sxx, sxy): (f64, f64) = (dot(&x, &x), dot(&x, &y));
        let slope = (n * sxy - sx * sy) / (n * sxx - sx * sx);
        let found = of.solve(&y);
        assert!((found[1] - slope).abs() < 1e-13, "{found:?}");
        assert!((found[0] - (sy - slope * sx) / n).abs() < 1e-13);
        for row in 0..5 {
            let off = x[row] - sx / n;
            let leverage = 1.0 / n + off * off / (sxx - sx * sx / n);
            assert!((of.leverage(row) - leverage).abs() < 1e-14);
            let mut more = y;
            more[row] += 1.0;
            let moved = of.solve(&more)[1] - found[1];
            assert!((of.moved_by(row)[1] - moved).abs() < 1e-13);
        }
        let near: Vec<f64> = x.iter().map(|x| 1.0 + 1e-4 * x).collect();
        let sum: Vec<f64> = near.iter().map(|near| 2.0 - 3.0 * near).collect();
        let of = LeastSquares::of([vec![1.0; 5], near.clone()]).unwrap();
        let found = of.solve(&sum);
        assert!((found[0] - 2.0).abs() < 1e-9 && (found[1] + 3.0).abs() < 1e-9);
        let twice: Vec<f64> = near.iter().map(|near| 1.0 - near).collect();
        assert!(LeastSquares::of([vec![1.0; 5], near.clone(), twice]).is_none());
        assert!(LeastSquares::of([near, vec![f64::NAN; 5]]).is_none());
    }
}
