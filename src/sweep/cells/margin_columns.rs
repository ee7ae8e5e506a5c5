//! The fields of margins: how far a cell is from the boundary of stability.

use super::buffers::TileBuffers;
use super::line::{Here, SlowLine};
use crate::answers::margins::SettingMargins;
use crate::answers::system_margins::SystemMargins;
use crate::linear::margins::{Limits, LoopMargins, MarginSearch};
use crate::linear::status::NOT_CONVERGED;
use crate::model::stop::Stop;
use crate::setting::field::Field;
use crate::setting::source::{OfMargins, Source};
use crate::setting::system::SystemModel;

/// Fills the columns of one thread's tiles.
pub(super) struct MarginColumns {
    search: MarginSearch,
    wanted: Vec<OfMargins>,
}

/// The margins of a cell; NaN for those that are not requested.
#[derive(Clone, Copy)]
struct Found {
    gain: Limits,
    of_loop: LoopMargins,
    modulus: f64,
    radius: f64,
    /// Whether a search was given up.
    gave_up: bool,
}

/// The margins of unstable sliding: 0, and no factors of the gains.
const UNSTABLE: Found = Found {
    gain: Limits {
        lower: f64::NAN,
        upper: f64::NAN,
    },
    of_loop: LoopMargins {
        phase: 0.0,
        phase_omega: f64::NAN,
        latency: 0.0,
    },
    modulus: 0.0,
    radius: 0.0,
    gave_up: false,
};

impl MarginColumns {
    /// The columns for these fields; none without a margin.
    pub(super) fn new(fields: &[Field]) -> Option<Self> {
        let wanted = fields.iter().filter_map(|field| match field.source() {
            Source::Margins(of) => Some(of),
            _ => None,
        });
        let columns = Self {
            search: MarginSearch::default(),
            wanted: wanted.collect(),
        };
        (!columns.wanted.is_empty()).then_some(columns)
    }

    fn wants(&self, of: OfMargins) -> bool {
        self.wanted.contains(&of)
    }

    /// Computes the cells of a line. The status gains [`NOT_CONVERGED`] where a search was given
    /// up. Beyond the letter's own feedback the latency margin is told with the line itself.
    pub(super) fn fill(&mut self, line: &SlowLine, buffers: &mut TileBuffers) {
        if line.setting.system().is_some() {
            return self.fill_system(line, buffers);
        }
        let Some(letter) = line.of_letter else { return };
        let besides = |of: &OfMargins| *of != OfMargins::Latency;
        if !letter && !self.wanted.iter().any(besides) {
            return;
        }
        line.each(|here| {
            let found = self.at(&here, letter, line.stop);
            if found.gave_up {
                buffers.status[here.place] |= NOT_CONVERGED;
            }
            buffers.put(here.place, |field| match field.source() {
                Source::Margins(OfMargins::Latency) if !letter => None,
                Source::Margins(of) => Some(found.value(of)),
                _ => None,
            });
        });
    }

    /// Computes the cells of a line of a system from a file.
    fn fill_system(&mut self, line: &SlowLine, buffers: &mut TileBuffers) {
        let feedback = line.setting.system().is_some_and(SystemModel::is_feedback);
        // Of B and A the latency margin is told with the line itself.
        let here = |of: &OfMargins| !(feedback && *of == OfMargins::Latency);
        if !self.wanted.iter().any(here) {
            return;
        }
        line.each(|cell| {
            let Some(found) = self.of_system(&cell, line.stop) else {
                // Outside the model's range.
                return buffers.put(cell.place, |field| {
                    matches!(field.source(), Source::Margins(_)).then_some(f64::NAN)
                });
            };
            if found.gave_up {
                buffers.status[cell.place] |= NOT_CONVERGED;
            }
            buffers.put(cell.place, |field| match field.source() {
                Source::Margins(of) if here(&of) => Some(found.value(of)),
                _ => None,
            });
        });
    }

    fn of_system(&mut self, here: &Here, stop: &Stop) -> Option<Found> {
        let around = SystemMargins::of(here.setting, stop).ok().flatten()?;
        let mut found = UNSTABLE;
        if self.wants(OfMargins::Latency) {
            found.of_loop.latency = around.latency().0;
            found.gave_up |= found.of_loop.latency.is_nan();
        }
        if !around.stable() {
            return Some(found);
        }
        if self.wants(OfMargins::GainLower) || self.wants(OfMargins::GainUpper) {
            found.gain = around.gain(&mut self.search).limits;
            found.gave_up |= found.gain.lower.is_nan() || found.gain.upper.is_nan();
        }
        if self.wants(OfMargins::Phase) {
            found.of_loop.phase = around.phase().angle;
            found.gave_up |= found.of_loop.phase.is_nan();
        }
        if self.wants(OfMargins::Modulus) {
            found.modulus = around.modulus().margin;
            found.gave_up |= found.modulus.is_nan();
        }
        Some(found)
    }

    fn at(&mut self, here: &Here, letter: bool, stop: &Stop) -> Found {
        let around = SettingMargins::of(here.setting, 0.0);
        // The line was accepted, so its parameters are within the model's range.
        let Some(around) = around.ok().flatten().filter(SettingMargins::stable) else {
            return UNSTABLE;
        };
        let around = around.heeding(stop);
        let mut found = UNSTABLE;
        if self.wants(OfMargins::GainLower) || self.wants(OfMargins::GainUpper) {
            found.gain = around.gain(&mut self.search);
            found.gave_up |= found.gain.lower.is_nan() || found.gain.upper.is_nan();
        }
        let phase = self.wants(OfMargins::Phase);
        if letter && (phase || self.wants(OfMargins::Latency)) {
            found.of_loop = around.of_loop(&mut self.search);
            found.gave_up |= found.of_loop.phase.is_nan();
        } else if phase {
            found.of_loop.phase = around.phase(&mut self.search);
            found.gave_up |= found.of_loop.phase.is_nan();
        }
        if self.wants(OfMargins::Modulus) {
            found.modulus = around.modulus().margin;
            found.gave_up |= found.modulus.is_nan();
        }
        if self.wants(OfMargins::StabilityRadius) {
            let radius = around.radius();
            found.radius = radius.proved;
            found.gave_up |= !radius.tight;
        }
        found
    }
}

impl Found {
    fn value(&self, of: OfMargins) -> f64 {
        match of {
            OfMargins::GainLower => self.gain.lower,
            OfMargins::GainUpper => self.gain.upper,
            OfMargins::Phase => self.of_loop.phase,
            OfMargins::Latency => self.of_loop.latency,
            OfMargins::Modulus => self.modulus,
            OfMargins::StabilityRadius => self.radius,
        }
    }
}
