//! The minimum of the sum of weighted squares, by the method of Levenberg and Marquardt, and the
//! covariance of the parameters there.
//!
//! ```text
//! r_i = (μ_K(v_i; p) − μ_i)/s_i,   J = ∂r/∂p,   H = J (JᵀJ)⁻¹ Jᵀ
//! C = (JᵀJ)⁻¹ Jᵀ diag(r_i² w_i) J (JᵀJ)⁻¹,   w_i = ½ (1/(1 − H_ii) + 1/(1 − H_ii)²)        (2)
//! ```
//!
//! C holds whatever the variances of the points are, of which the s_i may tell nothing. w_i is the
//! mean of two corrections for the number of points, HC2 and HC3 of J. G. MacKinnon and H. White,
//! *Some heteroskedasticity-consistent covariance matrix estimators with improved finite sample
//! properties*, J. Econometrics 29 (1985) 305: alone, the one makes errors a little too small and
//! the other a little too large.

use levenberg_marquardt::{LeastSquaresProblem, LevenbergMarquardt};
use nalgebra::storage::Owned;
use nalgebra::{DMatrix, DVector, Dyn};

use super::candidate::{Candidate, Seen};
use crate::model::least_squares::LeastSquares;

/// The size of residuals where values make no law: the search turns back.
const NO_LAW: f64 = 1e6;
/// Steps of difference quotients, relative to a number.
const STEP: f64 = 1e-6;
/// Steps of Gauss and Newton after the search, which stops as soon as the sum hardly falls.
const POLISH: usize = 4;
/// The most points by which starts are compared.
const AT_FIRST: usize = 1000;
/// Where less than this is left of 1 − H_ii, a point alone determines a number, and nothing tells
/// the error of that.
const LEAST_LEFT: f64 = 0.02;

/// The points with their weights.
#[derive(Debug, Clone, Copy)]
pub(super) struct Weighted<'p> {
    pub seen: Seen<'p>,
    /// s_i.
    pub deviations: &'p [f64],
}

/// The numbers of a law at the minimum.
#[derive(Debug, Clone)]
pub(super) struct Minimum {
    pub values: Vec<f64>,
    /// Σ r_i².
    pub sum: f64,
}

struct Problem<'p> {
    candidate: &'p Candidate,
    points: Weighted<'p>,
    values: DVector<f64>,
}

impl Problem<'_> {
    fn at(&self, values: &DVector<f64>) -> Option<DVector<f64>> {
        let curve = self.candidate.curve(values.as_slice())?;
        let Seen { speeds, mu_k } = self.points.seen;
        let all = speeds.iter().zip(mu_k).zip(self.points.deviations);
        let residuals = all.map(|((&v, &mu), s)| (curve.value(v) - mu) / s);
        Some(DVector::from_iterator(speeds.len(), residuals))
    }

    /// A central difference quotient for each number, one of one side at the end of its range.
    fn slopes(&self) -> Option<DMatrix<f64>> {
        let columns: Option<Vec<DVector<f64>>> = (0..self.values.len())
            .map(|i| {
                let step = STEP * self.values[i].abs().max(STEP);
                let moved = |by: f64| {
                    let mut values = self.values.clone();
                    values[i] += by;
                    self.at(&values)
                };
                Some(match (moved(-step), moved(step)) {
                    (Some(below), Some(above)) => (above - below) / (2.0 * step),
                    (None, Some(above)) => (above - moved(0.0)?) / step,
                    (Some(below), None) => (moved(0.0)? - below) / step,
                    (None, None) => return None,
                })
            })
            .collect();
        Some(DMatrix::from_columns(&columns?))
    }
}

impl LeastSquaresProblem<f64, Dyn, Dyn> for Problem<'_> {
    type ResidualStorage = Owned<f64, Dyn>;
    type JacobianStorage = Owned<f64, Dyn, Dyn>;
    type ParameterStorage = Owned<f64, Dyn>;

    fn set_params(&mut self, values: &DVector<f64>) {
        self.values.copy_from(values);
    }

    fn params(&self) -> DVector<f64> {
        self.values.clone()
    }

    fn residuals(&self) -> Option<DVector<f64>> {
        let beyond = || DVector::repeat(self.points.seen.speeds.len(), NO_LAW);
        Some(self.at(&self.values).unwrap_or_else(beyond))
    }

    fn jacobian(&self) -> Option<DMatrix<f64>> {
        self.slopes()
    }
}

impl Minimum {
    /// The lowest minimum that is found from the starts of a candidate; none where the search does
    /// not end in one. Of many points some are enough to find which start is best.
    pub(super) fn of(candidate: &Candidate, points: Weighted) -> Option<Self> {
        let starts = candidate.starts(points.seen);
        let every = points.seen.speeds.len().div_ceil(AT_FIRST);
        if every == 1 {
            return Self::lowest(candidate, points, &starts);
        }
        let some = |of: &[f64]| -> Vec<f64> { of.iter().copied().step_by(every).collect() };
        let [speeds, mu_k, deviations] =
            [points.seen.speeds, points.seen.mu_k, points.deviations].map(some);
        let some = Weighted {
            seen: Seen {
                speeds: &speeds,
                mu_k: &mu_k,
            },
            deviations: &deviations,
        };
        let best = Self::lowest(candidate, some, &starts);
        let starts = best.map_or(starts, |best| vec![best.values]);
        Self::lowest(candidate, points, &starts)
    }

    fn lowest(candidate: &Candidate, points: Weighted, starts: &[Vec<f64>]) -> Option<Self> {
        let found = starts.iter().cloned();
        let found = found.filter_map(|start| Self::from(candidate, points, start));
        found.min_by(|one, other| one.sum.total_cmp(&other.sum))
    }

    fn from(candidate: &Candidate, points: Weighted, start: Vec<f64>) -> Option<Self> {
        let problem = Problem {
            candidate,
            points,
            values: DVector::from_vec(start),
        };
        problem.at(&problem.values)?;
        let (mut problem, report) = LevenbergMarquardt::new().minimize(problem);
        if !report.termination.was_successful() {
            return None;
        }
        let mut residuals = problem.at(&problem.values)?;
        for _ in 0..POLISH {
            let slopes = problem.slopes()?;
            let Some(of) = linear(&slopes) else { break };
            let step = DVector::from_vec(of.solve(residuals.as_slice()));
            let values = &problem.values - step;
            let better = problem
                .at(&values)
                .filter(|r| r.norm_squared() <= residuals.norm_squared());
            let Some(better) = better else { break };
            (problem.values, residuals) = (values, better);
        }
        Some(Self {
            values: problem.values.as_slice().to_vec(),
            sum: residuals.norm_squared(),
        })
    }

    /// The covariance C of (2); none where the points do not determine the numbers.
    pub(super) fn covariance(
        &self,
        candidate: &Candidate,
        points: Weighted,
    ) -> Option<DMatrix<f64>> {
        let problem = Problem {
            candidate,
            points,
            values: DVector::from_column_slice(&self.values),
        };
        let (residuals, slopes) = (problem.at(&problem.values)?, problem.slopes()?);
        let of = linear(&slopes)?;
        let mut covariance = DMatrix::zeros(slopes.ncols(), slopes.ncols());
        for (i, residual) in residuals.iter().enumerate() {
            let left = 1.0 - of.leverage(i);
            if left < LEAST_LEFT {
                return None;
            }
            let grown = 0.5 * (1.0 / left + 1.0 / (left * left));
            // A column of (JᵀJ)⁻¹ Jᵀ.
            let moved = DVector::from_vec(of.moved_by(i)) * *residual;
            covariance.ger(grown, &moved, &moved, 1.0);
        }
        Some(covariance)
    }
}

/// The linear problem of columns.
fn linear(slopes: &DMatrix<f64>) -> Option<LeastSquares> {
    let columns = slopes.column_iter();
    LeastSquares::of(columns.map(|column| column.iter().copied().collect()))
}
