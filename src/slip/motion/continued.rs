//! A motion that goes on from others: a copy of one, or the extrapolation of two.

use super::held::Held;
use super::{Mode, Motion, Stretch};

impl Motion {
    /// Becomes a copy of `other`, a motion with the same law and accuracy, in the memory that it
    /// has.
    pub fn copy_from(&mut self, other: &Self) {
        self.parameters.clone_from(&other.parameters);
        self.history.copy_from(&other.history);
        self.signal.copy_from(&other.signal);
        self.sampled.copy_from(&other.sampled);
        self.friction.copy_place(&other.friction);
        self.mode = other.mode;
        (self.t, self.u, self.a) = (other.t, other.u, other.a);
        (self.kink, self.signal_kink) = (other.kink, other.signal_kink);
        self.even_since = other.even_since;
        self.held = other.held;
        (self.slope, self.corner) = (other.slope, other.corner);
        self.course.clone_from(&other.course);
        self.step.clone_from(&other.step);
    }

    /// Becomes a block that is released at t = 0, at `v0` and with the delay `tau`. Its past is
    /// that of `last` plus `share` of the difference between the pasts of `last` and `before`, two
    /// motions of the same law, gains and accuracy at their release. `stretches` are corresponding
    /// slips and sticks, the last one first; they are repeated backwards.
    ///
    /// `tau` must be less than twice the delays of both, since their pasts are known for two
    /// delays. False where the past has no room; the motion is then meaningless.
    pub fn extrapolate(
        &mut self,
        (last, before): (&mut Self, &mut Self),
        share: f64,
        (v0, tau): (f64, f64),
        stretches: &[Stretch],
    ) -> bool {
        self.parameters.clone_from(&last.parameters);
        (self.parameters.v0, self.parameters.feedback.tau) = (v0, tau);
        let pasts = (&mut last.history, &mut before.history);
        let mut has_room = self
            .history
            .extrapolate(pasts, share, 1.01 * tau, stretches);
        if self.parameters.feedback.channel.latency > 0.0 {
            let pasts = (&mut last.signal, &mut before.signal);
            let span = 1.01 * self.parameters.feedback.channel.latency;
            has_room &= self.signal.extrapolate(pasts, share, span, stretches);
        }
        self.friction.restart(0.0);
        self.mode = Mode::Forwards;
        self.a = last.a + share * (last.a - before.a);
        (self.t, self.u) = (0.0, 0.0);
        (self.kink, self.signal_kink) = (self.kink_of_jump(), 0);
        self.even_since = f64::INFINITY;
        self.held = Held::default();
        has_room
    }
}
