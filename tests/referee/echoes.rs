//! Kinks of the elongation that are felt one delay later, and then once more as echoes of
//! themselves.

use std::collections::VecDeque;

use super::setting::Setting;

/// Each echo is at least one derivative smoother; later ones are below the order of a step.
const MOST: u32 = 5;
/// Times nearer than this, relative, are one.
const SAME_TIME: f64 = 1e-13;

/// The kinks to come, in the order of their times, with the number of the echo that each is.
#[derive(Debug, Clone, Default)]
pub(crate) struct Echoes(VecDeque<(f64, u32)>);

impl Echoes {
    /// A kink will be felt at time `t`, which is later than all others.
    pub(crate) fn follow(&mut self, t: f64, echo: u32) {
        self.0.push_back((t, echo));
    }

    /// When the next one is felt.
    pub(crate) fn next(&self) -> f64 {
        self.0.front().map_or(f64::INFINITY, |(t, _)| *t)
    }

    /// Those that are felt now have echoes, where control acts.
    pub(crate) fn pass(&mut self, now: f64, setting: &Setting, controlled: bool) {
        let reached = now + SAME_TIME * now.abs().max(setting.time());
        while let Some((t, echo)) = self.0.front().copied().filter(|(t, _)| *t <= reached) {
            self.0.pop_front();
            if controlled && echo < MOST {
                self.follow(t + setting.tau, echo + 1);
            }
        }
    }
}
