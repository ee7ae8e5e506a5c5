//! A chart as bytes, see [`super::encoded`].

use serde::Serialize;

use super::chart::{Chart, ChartCurve};
use super::encoded::{Array, Arrays};
use crate::meaning::gap::Rule;
use crate::meaning::shown::{Cells, Column, Shown};
use crate::setting::Field;
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
    /// What its colours mean; none of the status.
    #[serde(skip_serializing_if = "Option::is_none")]
    shown: Option<Shown>,
    /// For each cell 0, or why it shows no value: a number of `shown`.
    #[serde(skip_serializing_if = "Option::is_none")]
    gaps: Option<Array>,
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
    let fields = &plan.spec.fields;
    let (mut kinds, mut reals) = (cells.kinds.iter(), cells.columns.iter());
    let column = |field: &Field| match field.storage() {
        Storage::Count => Column::U16(cells.n_unstable.as_deref().unwrap_or_default()),
        Storage::Kind | Storage::Few => {
            Column::U8(kinds.next().map_or(&[], |column| &column.cells[..]))
        }
        Storage::Real => Column::F64(reals.next().map_or(&[], |column| &column.cells[..])),
    };
    let columns: Vec<Column> = fields.iter().map(column).collect();
    let mut heads = Vec::new();
    for (&field, &values) in fields.iter().zip(&columns) {
        let unit = field.unit(&plan.spec.units);
        let rule = Rule::of(field, fields);
        let why = fields.iter().position(|other| Some(*other) == rule.why());
        let told = Cells {
            field,
            unit: &unit,
            rule,
            values,
            status: &cells.status,
            why: why.map(|place| columns[place]),
        };
        let (shown, gaps) = told.shown(|_| false, |_| false);
        heads.push(FieldHead {
            name: field.name(),
            long_name: field.long_name(),
            kinds: field.kinds(),
            array: match values {
                Column::U16(values) => arrays.push_runs(values),
                Column::U8(values) => arrays.push_runs(values),
                Column::F64(values) => arrays.push_runs(values),
            },
            unit,
            shown: Some(shown),
            gaps: Some(arrays.push_runs(&gaps)),
        });
    }
    heads.push(FieldHead {
        name: "status",
        long_name: "flags of the cell",
        unit: "1".into(),
        kinds: None,
        array: arrays.push_runs(&cells.status),
        shown: None,
        gaps: None,
    });
    heads
}
