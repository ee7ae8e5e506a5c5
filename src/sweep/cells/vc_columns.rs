//! The fields of the critical velocity: v_c of every cell, and a second computation for a sample of
//! them.

use std::ops::Range;

use super::buffers::TileBuffers;
use super::line::{Here, SlowLine};
use crate::answers::vc::{self, VcProblem};
use crate::critical::along_delay::BLOCK;
use crate::critical::{CriticalWindows, Problem};
use crate::linear::MarginalTolerance;
use crate::linear::status::{DISAGREE, NOT_CONVERGED, OUTSIDE_MODEL, SAMPLED};
use crate::model::ModelError;
use crate::model::stop::Stop;
use crate::setting::field::Field;
use crate::setting::parameter::Parameter;
use crate::setting::search::{Protocol, Search};
use crate::setting::source::{Source, VcCell};
use crate::setting::spec::SweepSpec;
use crate::slip::case::CaseUnits;
use crate::slip::motion::Integrator;
use crate::sweep::plan::pieces::mixed;

/// Fills the columns of one thread's tiles.
pub(super) struct VcColumns {
    search: Search,
    tolerance: MarginalTolerance,
    with_regime: bool,
    smooth: bool,
    /// The answers of the last line. Lines that differ only in v0 share them.
    known: Vec<Option<Known>>,
}

/// An answer, with its question, and what follows from it whatever v0 is.
struct Known {
    asked: VcProblem,
    phase: f64,
    found: CriticalWindows,
    /// The velocity of smooth sliding, once a cell has asked for it.
    v_smooth: Option<f64>,
    /// Whether simulation disagrees, once a cell of the sample has asked.
    disputed: Option<bool>,
}

impl Known {
    fn new(asked: VcProblem, phase: f64, found: CriticalWindows) -> Self {
        Self {
            asked,
            phase,
            found,
            v_smooth: None,
            disputed: None,
        }
    }

    fn v_smooth(&mut self, asked: &VcProblem, v_max: f64) -> f64 {
        let free = self.found.critical.free_above();
        let smooth = || asked.v_smooth(free, v_max);
        *self.v_smooth.get_or_insert_with(smooth)
    }

    fn disputed(&mut self, asked: &VcProblem) -> bool {
        let critical = &self.found.critical;
        let agrees = || asked.simulation_agrees(critical, Integrator::Taylor);
        let disputed = || agrees() == Some(false);
        *self.disputed.get_or_insert_with(disputed)
    }

    fn is_of(&self, problem: &Problem, units: &CaseUnits, phase: f64) -> bool {
        self.asked.problem == *problem
            && self.asked.units == *units
            && self.phase.to_bits() == phase.to_bits()
    }
}

impl VcColumns {
    /// The columns of a sweep; none without a field of the critical velocity.
    pub(super) fn new(spec: &SweepSpec) -> Option<Self> {
        Some(Self {
            search: spec.critical?,
            tolerance: spec.tolerance,
            with_regime: spec.fields.contains(&Field::Regime),
            smooth: spec.fields.contains(&Field::VSmooth),
            known: Vec::new(),
        })
    }

    /// Computes the critical velocities of a line into `buffers`. The status gains
    /// [`NOT_CONVERGED`] where one stays unknown, [`OUTSIDE_MODEL`], [`SAMPLED`] and [`DISAGREE`].
    pub(super) fn fill(&mut self, line: &SlowLine, buffers: &mut TileBuffers) {
        let count = line.delays.len();
        if self.search.protocol == Protocol::Follow {
            for first in (0..count).step_by(BLOCK) {
                self.find_block(line, first..count.min(first + BLOCK));
            }
        }
        line.each(|here| match self.cell(&here, line.stop) {
            Ok((cell, status)) => {
                buffers.status[here.place] |= status;
                store(&cell, buffers, here.place);
            }
            Err(_) => store_nothing(buffers, here.place),
        });
        if line.stopped() {
            // Answers that a stop cut short mean nothing.
            self.known.clear();
        }
    }

    /// Computes the answers in a block of a line, unless they are known. Blocks start where those
    /// of the whole line do.
    fn find_block(&mut self, line: &SlowLine, block: Range<usize>) {
        if self.known.len() < block.end {
            self.known.resize_with(block.end, || None);
        }
        let mut setting = line.setting.clone();
        let mut cells = Vec::new();
        let mut problems = Vec::new();
        let mut units = None;
        for i in block {
            setting.set(Parameter::Tau, line.delays[i]);
            if let Ok(asked) = VcProblem::of(&setting) {
                cells.push(i);
                units = Some(asked.units);
                problems.push(asked.until(line.stop.clone()).problem);
            }
        }
        let Some(units) = units else { return };
        let phase = setting.get(Parameter::SwitchOnPhase);
        let known = |(i, problem): (&usize, &Problem)| {
            let known = self.known[*i].as_ref();
            known.is_some_and(|k| k.is_of(problem, &units, phase))
        };
        if cells.iter().zip(&problems).all(known) {
            return;
        }
        let found = vc::find_in_line(&problems, &units, || line.stopped());
        for ((i, problem), found) in cells.into_iter().zip(problems).zip(found) {
            let asked = VcProblem { problem, units };
            self.known[i] = found.map(|found| Known::new(asked, phase, found));
        }
    }

    /// The result of a cell, with its status.
    fn cell(&mut self, here: &Here, stop: &Stop) -> Result<(VcCell<'_>, u8), ModelError> {
        let asked = VcProblem::of(here.setting)?.until(stop.clone());
        let protocol = self.search.protocol.at(here.setting);
        let v0 = here.setting.get(Parameter::V0);
        let (tolerance, with_regime, smooth) = (self.tolerance, self.with_regime, self.smooth);
        let sampled = is_sampled(here.number, self.search.verify);
        let phase = here.setting.get(Parameter::SwitchOnPhase);
        let known = self.known(&asked, protocol, phase, here.i);
        let mut status = match known.found.critical.decided {
            true => 0,
            false => NOT_CONVERGED,
        };
        if sampled {
            status |= SAMPLED;
            if known.disputed(&asked) {
                status |= DISAGREE;
            }
        }
        let cell = VcCell {
            v_smooth: match smooth {
                true => known.v_smooth(&asked, protocol.v_max()),
                false => f64::NAN,
            },
            regime: with_regime.then(|| asked.regime_at(v0, protocol, &known.found, tolerance)),
            found: &known.found,
        };
        Ok((cell, status))
    }

    /// The answer for the `i`-th cell of a line.
    fn known(&mut self, asked: &VcProblem, protocol: Protocol, phase: f64, i: usize) -> &mut Known {
        if self.known.len() <= i {
            self.known.resize_with(i + 1, || None);
        }
        let known = &mut self.known[i];
        let of_this = |k: &Known| k.is_of(&asked.problem, &asked.units, phase);
        if known.as_ref().is_some_and(|k| !of_this(k)) {
            *known = None;
        }
        known.get_or_insert_with(|| Known::new(asked.clone(), phase, asked.find(protocol)))
    }
}

fn store(cell: &VcCell, buffers: &mut TileBuffers, place: usize) {
    buffers.put(place, |field| match field.source() {
        Source::Critical(value) | Source::MotionOrCritical(_, value) => Some(value(cell)),
        _ => None,
    });
}

fn store_nothing(buffers: &mut TileBuffers, place: usize) {
    buffers.status[place] |= OUTSIDE_MODEL;
    buffers.put(place, |field| match field.source() {
        Source::Critical(_) | Source::MotionOrCritical(..) => Some(f64::NAN),
        _ => None,
    });
}

/// Whether a cell belongs to the sample of `share` of all cells. This depends on its number alone.
fn is_sampled(number: u64, share: f64) -> bool {
    (mixed(number) >> 11) as f64 * (0.5 * f64::EPSILON) < share
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_have_their_share() {
        for share in [0.0, 0.004, 0.3, 1.0] {
            let sampled = (0..100_000).filter(|&n| is_sampled(n, share)).count() as f64;
            assert!(
                (sampled / 1e5 - share).abs() < 1e-3 + 0.02 * share,
                "{share}: {sampled}"
            );
        }
    }
}
