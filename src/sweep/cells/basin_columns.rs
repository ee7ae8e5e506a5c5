//! The fields from motions with many starts.

use super::buffers::TileBuffers;
use super::line::SlowLine;
use crate::answers::basin::{BasinProblem, Tally};
use crate::linear::status::{NOT_CONVERGED, OUTSIDE_MODEL};
use crate::model::stop::Stop;
use crate::setting::basin::Basin;
use crate::setting::simulation::Simulation;
use crate::setting::source::{BasinCell, Source};
use crate::setting::spec::SweepSpec;
use crate::setting::values::Setting;
use crate::slip::case::CaseError;
use crate::slip::motion::Motion;

/// Fills the columns of one thread's tiles.
pub(super) struct BasinColumns<'p> {
    basin: &'p Basin,
    simulation: &'p Simulation,
    /// Memory shared by all motions.
    motion: Option<Motion>,
}

/// The result of a cell that cannot be followed.
const UNKNOWN: BasinCell = BasinCell {
    share: 0.0,
    error: 0.0,
    upper: 1.0,
};

impl<'p> BasinColumns<'p> {
    /// The columns of a sweep; none without a field over many starts.
    pub(super) fn new(spec: &'p SweepSpec) -> Option<Self> {
        Some(Self {
            basin: spec.basin.as_ref()?,
            simulation: &spec.simulation,
            motion: None,
        })
    }

    /// Follows the starts of each cell of a line into `buffers`. The status gains [`NOT_CONVERGED`]
    /// where some stay undecided, [`OUTSIDE_MODEL`] where what is read does not go with the sample
    /// time.
    pub(super) fn fill(&mut self, line: &SlowLine, buffers: &mut TileBuffers) {
        line.each(|here| {
            let Some(cell) = self.cell(here.setting, line.stop) else {
                return;
            };
            // The values of the sweep are checked: an error here means that motions cannot be
            // followed.
            let cell = cell.unwrap_or(UNKNOWN);
            if cell.upper > cell.share {
                buffers.status[here.place] |= match here.setting.fits_samples() {
                    true => NOT_CONVERGED,
                    false => OUTSIDE_MODEL,
                };
            }
            buffers.put(here.place, |field| match field.source() {
                Source::Basin(value) => Some(value(&cell)),
                _ => None,
            });
        });
    }

    /// The result of a cell; none after a stop.
    fn cell(&mut self, setting: &Setting, stop: &Stop) -> Option<Result<BasinCell, CaseError>> {
        let asked = match BasinProblem::of(setting, self.simulation, self.basin) {
            Ok(asked) => asked?,
            Err(error) => return Some(Err(error)),
        };
        if let Some(known) = asked.known() {
            return Some(Ok(known));
        }
        let (mut tally, mut follower) = (Tally::default(), asked.follower().heeding(stop));
        for place in asked.places() {
            if stop.is_set() {
                return None;
            }
            tally.count(place, follower.follow(place, &mut self.motion, &mut ()));
        }
        Some(Ok(asked.cell(&tally)))
    }
}
