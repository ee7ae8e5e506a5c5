//! The fields from motions: the block of every cell is followed to its outcome.

use super::buffers::TileBuffers;
use super::line::{Here, SlowLine};
use crate::linear::status::{NOT_CONVERGED, OUTSIDE_MODEL};
use crate::model::stop::Stop;
use crate::setting::simulation::Simulation;
use crate::setting::source::Source;
use crate::setting::spec::SweepSpec;
use crate::slip::case::{Case, CaseError};
use crate::slip::cycle::NoCycle;
use crate::slip::motion::Motion;
use crate::slip::outcome::{Outcome, Summary};
use crate::slip::sliding::Sliding;

/// Fills the columns of one thread's tiles.
pub(super) struct SlipColumns<'p> {
    simulation: &'p Simulation,
    /// Memory shared by all motions.
    motion: Option<Motion>,
    sliding: KnownSliding,
}

/// Stability of sliding in the cells of the last line. Lines that differ only in the start of the
/// motion share it.
#[derive(Default)]
struct KnownSliding(Vec<Option<Known>>);

/// The spectral abscissa of sliding in one cell, if it is stable there.
#[derive(Clone, Copy)]
struct Known {
    /// Sliding in this cell, and the unit of time.
    of: (Sliding, f64),
    abscissa: Option<f64>,
}

impl<'p> SlipColumns<'p> {
    /// The columns of a sweep; none without a field of motions.
    pub(super) fn new(spec: &'p SweepSpec) -> Option<Self> {
        spec.follows_motions().then(|| Self {
            simulation: &spec.simulation,
            motion: None,
            sliding: KnownSliding::default(),
        })
    }

    /// Follows the motions of a line into `buffers`. The status gains
    /// [`NOT_CONVERGED`] where a motion stays undecided, [`OUTSIDE_MODEL`] where what is read does
    /// not go with the sample time. Motions need a sliding state.
    pub(super) fn fill(&mut self, line: &SlowLine, buffers: &mut TileBuffers) {
        if line.of_letter.is_none() {
            return;
        }
        line.each(|here| {
            let motion = self.motion_at(&here, line.stop);
            if motion.outcome == Outcome::Undecided {
                buffers.status[here.place] |= match here.setting.fits_samples() {
                    true => NOT_CONVERGED,
                    false => OUTSIDE_MODEL,
                };
            }
            buffers.put(here.place, |field| match field.source() {
                Source::Motion(value) | Source::MotionOrCritical(value, _) => Some(value(&motion)),
                _ => None,
            });
        });
    }

    /// The outcome of the motion in a cell.
    fn motion_at(&mut self, here: &Here, stop: &Stop) -> Summary {
        match self.follow(here, stop) {
            Ok(Some(summary)) => summary,
            Err(CaseError::NoCycle(NoCycle::NoStickSlip)) => Summary::without(Outcome::NoCycle),
            // The values of the sweep are checked: an error here means that the motion cannot be
            // followed.
            Ok(None) | Err(_) => Summary::without(Outcome::Undecided),
        }
    }

    fn follow(&mut self, here: &Here, stop: &Stop) -> Result<Option<Summary>, CaseError> {
        let Some(case) = self.simulation.case(here.setting, 0.0)? else {
            return Ok(None);
        };
        let motion = match &mut self.motion {
            Some(motion) => {
                case.restart(motion)?;
                motion
            }
            none => none.insert(case.motion()?),
        };
        motion.heed(stop);
        let abscissa = self.sliding.at(&case, here.i)?;
        Ok(Some(case.follow(motion, abscissa, &mut ())))
    }
}

impl KnownSliding {
    /// The abscissa of the case, the `i`-th of its line.
    fn at(&mut self, case: &Case, i: usize) -> Result<Option<f64>, CaseError> {
        if self.0.len() <= i {
            self.0.resize(i + 1, None);
        }
        let of = (case.sliding()?, case.units().time);
        match self.0[i] {
            Some(known) if known.of == of => Ok(known.abscissa),
            _ => {
                let abscissa = case.stable_abscissa()?;
                self.0[i] = Some(Known { of, abscissa });
                Ok(abscissa)
            }
        }
    }
}
