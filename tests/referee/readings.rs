//! A block whose elongation is read at equal times from switch-on: what is fed back is worked out
//! at each reading from the past of the elongation, and held until the next.

use super::block::Block;

impl Block {
    /// How many readings a time has.
    fn readings_in(&self, time: f64) -> usize {
        (time / self.setting.sample_time).round() as usize
    }

    /// How many readings there have been since switch-on.
    fn taken(&self) -> usize {
        self.signals
            .len()
            .saturating_sub(self.readings_in(self.setting.tau))
    }

    /// The time of the next reading; infinite without readings.
    pub(super) fn next_reading(&self) -> f64 {
        let s = &self.setting;
        match (s.is_sampled(), self.signals.is_empty()) {
            (false, _) => f64::INFINITY,
            (true, true) => s.switch_on,
            (true, false) => s.switch_on + self.taken() as f64 * s.sample_time,
        }
    }

    /// Times nearer than this are one.
    pub(super) fn nearly(&self) -> f64 {
        1e-13 * self.t.max(self.setting.time())
    }

    /// V at a time before switch-on; 0 before t = 0.
    fn before(&self, t: f64) -> f64 {
        let s = &self.setting;
        if t < 0.0 {
            return 0.0;
        }
        let difference = self.past.at(t).0 - self.past.at(t - s.tau).0;
        match s.memory == 0.0 {
            true => difference,
            false => difference + s.memory * self.before(t - s.tau),
        }
    }

    /// Reads the elongation.
    pub(super) fn read(&mut self) {
        if self.setting.amplitude > 0.0 {
            self.steer();
            return;
        }
        let (s, t) = (&self.setting, self.next_reading());
        if self.signals.is_empty() {
            let in_delay = self.readings_in(s.tau);
            let ago = |number: usize| (in_delay - number) as f64 * s.sample_time + s.latency;
            let signals = (0..in_delay).map(|number| self.before(t - ago(number)));
            self.signals = signals.collect();
        }
        let then = t - s.latency;
        let difference = self.past.at(then).0 - self.past.at(then - s.tau).0;
        let one_delay_ago = self.signals[self.taken()];
        self.held = difference + s.memory * one_delay_ago;
        self.signals.push(self.held);
        self.look_at_limits();
    }
}
