//! A chart as bytes, see [`super::encoded`].

use serde::Serialize;

use super::chart::{Chart, ChartCurve};
use super::encoded::{Array, Arrays};
use crate::setting::field::Storage;

/// What a chart says before its numbers.
#[derive(Debug, Serialize)]
#[cfg_attr(feature = "serve", derive(utoipa::ToSchema))]
pub struct ChartHead {
    /// Its axes, the slowest one first.
    axes: Vec<AxisHead>,
    /// Its fields, with an array of all cells each, and its status.
    fields: Vec<FieldHead>,
    /// Its curves, with an array of the first and the second coordinate by turns.
    curves: Vec<CurveHead>,
    /// How long it took to compute, in milliseconds; none where there is no clock.
    #[cfg_attr(feature = "serve", schema(required))]
    milliseconds: Option<f64>,
}

#[derive(Debug, Serialize)]
#[cfg_attr(feature = "serve", derive(utoipa::ToSchema))]
struct AxisHead {
    name: String,
    long_name: String,
    symbol: String,
    unit: String,
    values: Array,
}

#[derive(Debug, Serialize)]
#[cfg_attr(feature = "serve", derive(utoipa::ToSchema))]
struct FieldHead {
    name: &'static str,
    long_name: &'static str,
    unit: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    kinds: Option<Vec<&'static str>>,
    #[serde(flatten)]
    array: Array,
}

/// What the head says of a curve.
#[derive(Debug, Serialize)]
#[cfg_attr(feature = "serve", derive(utoipa::ToSchema))]
pub struct CurveHead {
    /// σ: roots on the curve have Re λ = −σ.
    degree_of_stability: f64,
    /// Where a pair crosses with growing delay: −1 to the left, 0 it touches, 1 to the right.
    direction: i8,
    /// On which side sliding is stable: −1 at shorter delays, 0 on neither, 1 at longer ones.
    stable_side: i8,
    /// The coordinates, the first and the second one by turns.
    #[serde(flatten)]
    array: Array,
}

impl CurveHead {
    /// The head of a curve, whose vertices are added to the arrays.
    #[must_use]
    pub fn of(curve: &ChartCurve, arrays: &mut Arrays) -> Self {
        Self {
            degree_of_stability: curve.degree_of_stability,
            direction: curve.direction,
            stable_side: curve.stable_side,
            array: arrays.push(curve.vertices.iter().flatten().copied()),
        }
    }
}

/// The bytes of a chart; `milliseconds` is the time of its computation, if known.
///
/// # Errors
/// When its head cannot be written as JSON.
pub fn encoded(chart: &Chart, milliseconds: Option<f64>) -> Result<Vec<u8>, serde_json::Error> {
    let plan = chart.grid.plan();
    let units = &plan.spec.units;
    let mut arrays = Arrays::default();
    let head = ChartHead {
        axes: (plan.spec.axes.iter())
            .map(|axis| AxisHead {
                name: axis.parameter.name().into(),
                long_name: axis.parameter.long_name().into(),
                symbol: axis.parameter.symbol().into(),
                unit: axis.parameter.unit(units),
                values: arrays.push(axis.values.iter().copied()),
            })
            .collect(),
        fields: fields(chart, &mut arrays),
        curves: (chart.curves.iter())
            .map(|curve| CurveHead::of(curve, &mut arrays))
            .collect(),
        milliseconds,
    };
    arrays.behind(&head)
}

/// The fields of a chart, then its status.
fn fields(chart: &Chart, arrays: &mut Arrays) -> Vec<FieldHead> {
    let (plan, cells) = (chart.grid.plan(), &chart.grid.cells);
    let (mut kinds, mut columns) = (cells.kinds.iter(), cells.columns.iter());
    let mut heads = Vec::new();
    for &field in &plan.spec.fields {
        let array = match field.storage() {
            Storage::Count => arrays.push_runs(cells.n_unstable.as_deref().unwrap_or_default()),
            Storage::Kind | Storage::Few => {
                arrays.push_runs(kinds.next().map_or(&[], |column| &column.cells[..]))
            }
            Storage::Real => {
                let column = columns.next().into_iter().flat_map(|column| &column.cells);
                arrays.push(column.copied())
            }
        };
        heads.push(FieldHead {
            name: field.name(),
            long_name: field.long_name(),
            unit: field.unit(&plan.spec.units),
            kinds: field.kinds(),
            array,
        });
    }
    heads.push(FieldHead {
        name: "status",
        long_name: "flags of the cell",
        unit: "1".into(),
        kinds: None,
        array: arrays.push_runs(&cells.status),
    });
    heads
}
