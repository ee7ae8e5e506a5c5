//! A chart as bytes: its shape in JSON, then its numbers.
//!
//! ```text
//! length of the JSON, u32 | JSON | padding to a multiple of 8 | arrays, each padded likewise
//! ```
//!
//! All numbers are little-endian, as browsers' typed arrays are on every machine that runs one. The
//! JSON names each array with its type, its offset behind the padding and its length.

use serde::Serialize;

use crate::explore::chart::Chart;
use crate::sweep::input::field::Storage;

/// Arrays begin at multiples of this.
const ALIGNED: usize = 8;

#[derive(Debug, Serialize)]
struct Head {
    axes: Vec<AxisHead>,
    fields: Vec<FieldHead>,
    curves: Vec<CurveHead>,
    /// How long it took to compute, in milliseconds.
    milliseconds: f64,
}

#[derive(Debug, Serialize)]
struct AxisHead {
    name: &'static str,
    long_name: &'static str,
    symbol: &'static str,
    unit: String,
    values: Vec<f64>,
}

#[derive(Debug, Serialize)]
struct FieldHead {
    name: &'static str,
    long_name: &'static str,
    unit: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    kinds: Option<Vec<&'static str>>,
    #[serde(flatten)]
    array: Array,
}

#[derive(Debug, Serialize)]
struct CurveHead {
    degree_of_stability: f64,
    direction: i8,
    stable_side: i8,
    #[serde(flatten)]
    array: Array,
}

/// Where numbers are.
#[derive(Debug, Serialize)]
struct Array {
    #[serde(rename = "type")]
    kind: &'static str,
    offset: usize,
    length: usize,
}

/// The arrays, one behind the other.
#[derive(Default)]
struct Arrays(Vec<u8>);

impl Arrays {
    fn push<const N: usize>(
        &mut self,
        kind: &'static str,
        numbers: impl Iterator<Item = [u8; N]>,
    ) -> Array {
        let offset = self.0.len();
        self.0.extend(numbers.flatten());
        let length = (self.0.len() - offset) / N;
        self.0.resize(self.0.len().next_multiple_of(ALIGNED), 0);
        Array {
            kind,
            offset,
            length,
        }
    }
}

/// The bytes of a chart that took so long to compute.
pub(super) fn encoded(chart: &Chart, milliseconds: f64) -> Result<Vec<u8>, serde_json::Error> {
    let plan = chart.grid.plan();
    let units = &plan.spec.units;
    let mut arrays = Arrays::default();
    let head = Head {
        axes: (plan.spec.axes.iter())
            .map(|axis| AxisHead {
                name: axis.parameter.name(),
                long_name: axis.parameter.long_name(),
                symbol: axis.parameter.symbol(),
                unit: units.of_parameter(axis.parameter),
                values: axis.values.clone(),
            })
            .collect(),
        fields: fields(chart, &mut arrays),
        curves: (chart.curves.iter())
            .map(|curve| CurveHead {
                degree_of_stability: curve.degree_of_stability,
                direction: curve.direction,
                stable_side: curve.stable_side,
                array: arrays.push(
                    "f64",
                    curve.vertices.iter().flatten().map(|x| x.to_le_bytes()),
                ),
            })
            .collect(),
        milliseconds,
    };
    let head = serde_json::to_vec(&head)?;
    let begun = (4 + head.len()).next_multiple_of(ALIGNED);
    let mut bytes = Vec::with_capacity(begun + arrays.0.len());
    bytes.extend((head.len() as u32).to_le_bytes());
    bytes.extend(head);
    bytes.resize(begun, 0);
    bytes.extend(arrays.0);
    Ok(bytes)
}

/// The fields of a chart, then its status.
fn fields(chart: &Chart, arrays: &mut Arrays) -> Vec<FieldHead> {
    let (plan, cells) = (chart.grid.plan(), &chart.grid.cells);
    let (mut kinds, mut columns) = (cells.kinds.iter(), cells.columns.iter());
    let mut heads = Vec::new();
    for &field in &plan.spec.fields {
        let array = match field.storage() {
            Storage::Count => {
                let counts = cells.n_unstable.iter().flatten();
                arrays.push("u16", counts.map(|n| n.to_le_bytes()))
            }
            Storage::Kind | Storage::Few => {
                let column = kinds.next().into_iter().flat_map(|column| &column.cells);
                arrays.push("u8", column.map(|kind| [*kind]))
            }
            Storage::Real => {
                let column = columns.next().into_iter().flat_map(|column| &column.cells);
                arrays.push("f64", column.map(|value| value.to_le_bytes()))
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
        array: arrays.push("u8", cells.status.iter().map(|status| [*status])),
    });
    heads
}
