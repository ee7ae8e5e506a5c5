//! The fields from characteristic roots: from the dimensionless roots of a cell to physical values.

use num_complex::Complex64;

use super::buffers::Column;
use super::line::Places;
use crate::linear::equation::Equation;
use crate::linear::general::rightmost::scaled_margin;
use crate::linear::sensitivity::Sensitivity;
use crate::linear::track::{Cell, RootTracker};
use crate::model::Groups;
use crate::setting::field::Field;
use crate::setting::source::{OfRoots, Slope, Source};

/// A line of cells, or a part of it.
pub(super) struct Line<'a, E, S> {
    pub equation: E,
    /// The sensitivity of a root at a delay, of the equation.
    pub sensitivity: S,
    /// The unit of time of the equation.
    pub time_unit: f64,
    /// That unit in the one to which margins refer, √(M/κ) or a system's own.
    pub unit: f64,
    /// The derivative of each group with respect to its parameter: b per μ_K′, a_v per α_v, a_n
    /// per α_N.
    pub per_parameter: Groups,
    /// The delays, increasing, in the units of the sweep.
    pub delays: &'a [f64],
    /// The index of the first delay on the whole line.
    pub first: usize,
}

/// Fills the columns of one thread's tiles.
pub(super) struct RootColumns {
    tracker: RootTracker,
    sensitive: bool,
}

impl RootColumns {
    /// The columns for these fields; none if no field needs roots.
    pub(super) fn new(fields: &[Field]) -> Option<Self> {
        let wanted = fields.iter().map(|f| f.roots_needed()).max()?;
        let slope = |f: &Field| matches!(f.source(), Source::Roots(OfRoots::Derivative(_)));
        (wanted > 0).then(|| Self {
            tracker: RootTracker::new(wanted),
            sensitive: fields.iter().any(slope),
        })
    }

    /// Whether derivatives of the abscissa are requested.
    pub(super) fn sensitive(&self) -> bool {
        self.sensitive
    }

    /// Computes the cells of a line into `columns`, at `places`.
    ///
    /// `counts` are the numbers of unstable roots. The flags of root tracking are added to
    /// `status`.
    pub(super) fn fill<E: Equation>(
        &mut self,
        line: &Line<E, impl Fn(f64, Complex64) -> Sensitivity>,
        counts: &[u16],
        status: &mut [u8],
        columns: &mut [Column],
        places: Places,
    ) {
        let sensitive = self.sensitive;
        let delays = (line.delays, line.time_unit);
        let visit = |i: usize, cell: Cell| {
            let slopes = match cell.roots.first() {
                Some(root) if sensitive => {
                    let tau = line.delays[i] / line.time_unit;
                    slopes(line, &(line.sensitivity)(tau, root.lambda))
                }
                _ => [f64::NAN; 4],
            };
            // Without control or delay there is only one pair. Otherwise a missing root was not
            // found.
            let beyond = if line.equation.uncontrolled() || line.delays[i] == 0.0 {
                f64::NEG_INFINITY
            } else {
                f64::NAN
            };
            for column in columns.iter_mut() {
                let units = (line.time_unit, line.unit);
                let value = value(column.field, &cell, &slopes, units, beyond);
                if let Some(value) = value {
                    column.cells[places.of(i)] = value;
                }
            }
        };
        let first = line.first;
        self.tracker
            .follow(line.equation, delays, first, counts, status, visit);
    }
}

/// The value of a field in a cell, in units of the sweep; none for fields that do not come from
/// roots.
///
/// NaN where nothing converged. A root after the last one has the real part `beyond`.
#[inline]
fn value(
    field: Field,
    cell: &Cell,
    slopes: &[f64; 4],
    (time_unit, unit): (f64, f64),
    beyond: f64,
) -> Option<f64> {
    let converged = !cell.roots.is_empty();
    let real_part = |rank: usize| match cell.roots.get(rank) {
        Some(root) => root.lambda.re / time_unit,
        None if converged => beyond,
        None => f64::NAN,
    };
    let Source::Roots(wanted) = field.source() else {
        return None;
    };
    Some(match wanted {
        OfRoots::RealPart(rank) => real_part(rank),
        OfRoots::Frequency(rank) => match cell.roots.get(rank) {
            Some(root) => root.lambda.im / time_unit,
            None => f64::NAN,
        },
        OfRoots::RelaxationTime if !converged => f64::NAN,
        OfRoots::RelaxationTime => relaxation_time(real_part(0)),
        // Of a digital loop alone.
        OfRoots::SpectralRadius => f64::NAN,
        OfRoots::Derivative(slope) => slopes[slope as usize],
        OfRoots::CertificateMargin => match cell.roots.first() {
            Some(root) => scaled_margin(cell.margin, root.lambda.re, 1.0 / unit),
            None => cell.margin,
        },
    })
}

/// The time in which a disturbance decays by a factor e: −1/`abscissa`, +∞ where it does not decay.
#[must_use]
pub fn relaxation_time(abscissa: f64) -> f64 {
    if abscissa < 0.0 {
        -1.0 / abscissa
    } else {
        f64::INFINITY
    }
}

/// The derivatives of the abscissa in units of the sweep, in the order of [`Slope`]. The abscissa
/// is Re λ/T with T = √(M/κ); the chain rule goes over τ/T and the groups, each proportional to its
/// parameter.
#[inline]
fn slopes<E, S>(line: &Line<E, S>, sensitivity: &Sensitivity) -> [f64; 4] {
    let (unit, per) = (line.time_unit, line.per_parameter);
    let mut slopes = [0.0; 4];
    for (slope, derivative) in [
        (Slope::Tau, sensitivity.tau.re / unit),
        (Slope::AlphaV, sensitivity.a_v.re * per.a_v),
        (Slope::AlphaN, sensitivity.a_n.re * per.a_n),
        (Slope::MuPrime, sensitivity.b.re * per.b),
    ] {
        slopes[slope as usize] = derivative / unit;
    }
    slopes
}
