//! What a map costs, from a timed sample of the pieces of its plan.

use crate::model::stop::Stop;
use crate::store::tiles::RecordEncoder;
use crate::sweep::engine::{Computed, Encode};
use crate::sweep::estimate::Costs;
use crate::sweep::{Piece, Plan};

/// Measured bytes of a map besides its numbers: of the file, of each dataset of cells or axis, of
/// each chunk in an index, and of the group of curves.
const WITHOUT_CELLS: f64 = 8e3;
const OF_A_DATASET: f64 = 1.2e3;
const OF_A_CHUNK: f64 = 40.0;
const WITHOUT_CURVES: f64 = 25e3;

/// What a map costs.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct MapCost {
    /// Seconds on one thread: at least, about and at most.
    seconds: [f64; 3],
    /// About the bytes of the map on disk.
    pub bytes_on_disk: u64,
    /// How many tiles were timed, wholly or in part.
    pub tiles_timed: usize,
    /// How many cells were timed.
    pub cells_timed: u64,
}

impl MapCost {
    /// The cost of the map of a plan. Once `stop` is set, the answer comes soon but is meaningless.
    pub(crate) fn of(plan: &Plan, stop: &Stop) -> Self {
        let mut encoder = RecordEncoder::default();
        let stored =
            |piece: Piece, computed: Computed<'_>| encoder.encode(piece, computed).payload.len();
        let costs = Costs::of(plan, stored, stop);
        Self {
            seconds: costs.seconds(),
            bytes_on_disk: bytes_on_disk(&costs, plan),
            tiles_timed: costs.tiles_timed,
            cells_timed: costs.cells_timed,
        }
    }

    /// Seconds on so many threads: at least, about and at most.
    pub(crate) fn seconds_on(&self, threads: usize) -> [f64; 3] {
        self.seconds.map(|seconds| seconds / threads as f64)
    }
}

/// Approximate bytes of the map: its cells, its curves, and their description.
fn bytes_on_disk(of: &Costs, plan: &Plan) -> u64 {
    let datasets = (plan.spec.fields.len() + plan.spec.axes.len() + 1) as f64;
    let chunks = plan.tiles.len() as f64 * (plan.spec.fields.len() + 1) as f64;
    let described = WITHOUT_CELLS + datasets * OF_A_DATASET + chunks * OF_A_CHUNK;
    let curves = match plan.boundary_planes() {
        0 => 0.0,
        _ => WITHOUT_CURVES + of.bytes_of_curves.total(),
    };
    (described + curves + of.bytes.total()) as u64
}
