//! The fields of the critical velocity: every cell's v_c is looked for, and a sample of them a
//! second time.

use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};

use super::buffers::TileBuffers;
use super::vc::{self, class_at};
use crate::critical::line::BLOCK;
use crate::critical::{CriticalWindows, Problem};
use crate::linear::MarginalTolerance;
use crate::linear::status::{DISAGREE, NOT_CONVERGED, SAMPLED};
use crate::model::ModelError;
use crate::slip::case::CaseUnits;
use crate::slip::motion::Integrator;
use crate::sweep::input::field::Field;
use crate::sweep::input::parameter::Parameter;
use crate::sweep::input::search::{Protocol, Search};
use crate::sweep::input::setting::Setting;
use crate::sweep::input::source::{Source, VcCell};
use crate::sweep::input::spec::SweepSpec;
use crate::sweep::plan::pieces::mixed;

/// Fills the columns of one thread's tiles.
pub(super) struct VcColumns {
    search: Search,
    tolerance: MarginalTolerance,
    classed: bool,
    smooth: bool,
    /// The answers of the line looked at last. Lines that differ in nothing but v0 share them.
    known: Vec<Option<Known>>,
}

/// An answer, and to what.
struct Known {
    problem: Problem,
    units: CaseUnits,
    phase: f64,
    found: CriticalWindows,
}

impl Known {
    fn is_of(&self, problem: &Problem, units: &CaseUnits, phase: f64) -> bool {
        self.problem == *problem && self.units == *units && self.phase.to_bits() == phase.to_bits()
    }
}

/// Where a line of cells is.
#[derive(Clone, Copy)]
pub(super) struct Cells {
    /// In the buffers: the first cell, and the distance from cell to cell.
    pub at: usize,
    pub stride: usize,
    /// In the whole map, all cells counted row by row: likewise.
    pub first: u64,
    pub step: u64,
}

impl VcColumns {
    /// For the fields of a sweep; none where none of them is of the critical velocity.
    pub(super) fn new(spec: &SweepSpec) -> Option<Self> {
        Some(Self {
            search: spec.critical?,
            tolerance: spec.tolerance,
            classed: spec.fields.contains(&Field::Class),
            smooth: spec.fields.contains(&Field::VSmooth),
            known: Vec::new(),
        })
    }

    /// Looks for the critical velocities of a line at `setting` and at `delays`, into `buffers`.
    /// The status gains [`NOT_CONVERGED`] where it stays unknown, [`SAMPLED`] and [`DISAGREE`].
    /// After `stop` is set nothing more is looked for.
    pub(super) fn fill(
        &mut self,
        setting: &Setting,
        delays: &[f64],
        buffers: &mut TileBuffers,
        cells: Cells,
        stop: &AtomicBool,
    ) {
        let mut setting = setting.clone();
        if self.search.protocol == Protocol::Follow {
            for first in (0..delays.len()).step_by(BLOCK) {
                let block = first..delays.len().min(first + BLOCK);
                self.find_block(&mut setting, delays, block, stop);
            }
        }
        for (i, tau) in delays.iter().enumerate() {
            if stop.load(Ordering::Relaxed) {
                return;
            }
            setting.set(Parameter::Tau, *tau);
            let place = cells.at + i * cells.stride;
            let number = cells.first + i as u64 * cells.step;
            match self.cell(&setting, i, number) {
                Ok((cell, status)) => {
                    buffers.status[place] |= status;
                    store(&cell, buffers, place);
                }
                // The sweep's values were checked: what is refused here is beyond what can be
                // followed.
                Err(_) => store_nothing(buffers, place),
            }
        }
    }

    /// Looks for the answers in a block of a line, which starts where blocks of the whole line do,
    /// unless they are known.
    fn find_block(
        &mut self,
        setting: &mut Setting,
        delays: &[f64],
        block: Range<usize>,
        stop: &AtomicBool,
    ) {
        if self.known.len() < block.end {
            self.known.resize_with(block.end, || None);
        }
        let mut cells = Vec::new();
        let mut problems = Vec::new();
        let mut units = None;
        for i in block {
            setting.set(Parameter::Tau, delays[i]);
            if let Ok((problem, own)) = vc::problem(setting) {
                cells.push(i);
                problems.push(problem);
                units = Some(own);
            }
        }
        let Some(units) = units else { return };
        let phase = setting.get(Parameter::SwitchOnPhase);
        let known = |(i, problem): (&usize, &Problem)| {
            self.known[*i]
                .as_ref()
                .is_some_and(|k| k.is_of(problem, &units, phase))
        };
        if cells.iter().zip(&problems).all(known) {
            return;
        }
        let found = vc::find_in_line(&problems, &units, || stop.load(Ordering::Relaxed));
        for ((i, problem), found) in cells.into_iter().zip(problems).zip(found) {
            self.known[i] = found.map(|found| Known {
                problem,
                units,
                phase,
                found,
            });
        }
    }

    /// The cell at `setting`, the `i`-th of its line and the `number`-th of the map, with its
    /// status.
    fn cell(
        &mut self,
        setting: &Setting,
        i: usize,
        number: u64,
    ) -> Result<(VcCell<'_>, u8), ModelError> {
        let (problem, units) = vc::problem(setting)?;
        let protocol = self.search.protocol.at(setting);
        let v0 = setting.get(Parameter::V0);
        let (tolerance, classed, smooth) = (self.tolerance, self.classed, self.smooth);
        let sampled = is_sampled(number, self.search.verify);
        let at = (&problem, &units);
        let found = self.found(at, protocol, setting.get(Parameter::SwitchOnPhase), i);
        let vc = found.critical.vc;
        let mut status = if found.critical.decided {
            0
        } else {
            NOT_CONVERGED
        };
        if sampled {
            status |= SAMPLED;
            let critical = &found.critical;
            let agrees = vc::simulation_agrees(&problem, &units, critical, Integrator::Taylor);
            if agrees == Some(false) {
                status |= DISAGREE;
            }
        }
        let cell = VcCell {
            class: classed.then(|| class_at(v0, at, (protocol, found), tolerance)),
            v_smooth: match smooth {
                true => vc::v_smooth(at, vc, protocol.v_max()),
                false => f64::NAN,
            },
            found,
        };
        Ok((cell, status))
    }

    /// The answer to a problem, the `i`-th of its line.
    fn found(
        &mut self,
        (problem, units): (&Problem, &CaseUnits),
        protocol: Protocol,
        phase: f64,
        i: usize,
    ) -> &CriticalWindows {
        if self.known.len() <= i {
            self.known.resize_with(i + 1, || None);
        }
        let known = &mut self.known[i];
        if known
            .as_ref()
            .is_some_and(|k| !k.is_of(problem, units, phase))
        {
            *known = None;
        }
        let known = known.get_or_insert_with(|| Known {
            problem: problem.clone(),
            units: *units,
            phase,
            found: vc::find_in(problem, units, protocol),
        });
        &known.found
    }
}

fn store(cell: &VcCell, buffers: &mut TileBuffers, place: usize) {
    buffers.put(place, |field| match field.source() {
        Source::Critical(value) | Source::MotionOrCritical(_, value) => Some(value(cell)),
        _ => None,
    });
}

fn store_nothing(buffers: &mut TileBuffers, place: usize) {
    buffers.status[place] |= NOT_CONVERGED;
    buffers.put(place, |field| match field.source() {
        Source::Critical(_) | Source::MotionOrCritical(..) => Some(f64::NAN),
        _ => None,
    });
}

/// Whether a cell belongs to the sample of `share` of all cells: by its number alone.
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
