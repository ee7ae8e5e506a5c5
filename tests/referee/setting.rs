//! What is given of a block and its control.

use super::law::Friction;

/// What is given, in any units that fit together.
#[derive(Debug, Clone)]
pub(crate) struct Setting {
    pub friction: Friction,
    pub mass: f64,
    pub stiffness: f64,
    pub load: f64,
    pub alpha_v: f64,
    pub alpha_n: f64,
    pub tau: f64,
    /// R, the memory of the feedback, and its latency δ.
    pub memory: f64,
    pub latency: f64,
    /// h, the time from reading to reading; 0 without a digital loop.
    pub sample_time: f64,
    /// The largest change of the load under control by the return map; 0 under delayed feedback.
    pub amplitude: f64,
    /// c, the dashpot beside the spring, and c_g, that to the ground.
    pub damping: f64,
    pub viscous: f64,
    /// What v and N are clipped to, from below and from above.
    pub of_v: [f64; 2],
    pub of_load: [f64; 2],
    /// At t = 0, and what becomes of it.
    pub v0: f64,
    pub programme: Vec<Corner>,
    /// When control begins to act; infinite for never.
    pub switch_on: f64,
}

/// From a time on v0 is this; `ramp`: it comes there on a straight line.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Corner {
    pub at: f64,
    pub v0: f64,
    pub ramp: bool,
}

/// No limits.
pub(crate) const FREE: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];

impl Setting {
    /// M = κ = N0 = 1 and the letter's feedback from t = 0 on, with nothing else.
    pub(crate) fn plain(
        friction: Friction,
        (alpha_v, alpha_n): (f64, f64),
        tau: f64,
        v0: f64,
    ) -> Self {
        Self {
            friction,
            mass: 1.0,
            stiffness: 1.0,
            load: 1.0,
            alpha_v,
            alpha_n,
            tau,
            memory: 0.0,
            latency: 0.0,
            sample_time: 0.0,
            amplitude: 0.0,
            damping: 0.0,
            viscous: 0.0,
            of_v: FREE,
            of_load: FREE,
            v0,
            programme: Vec::new(),
            switch_on: 0.0,
        }
    }

    /// The letter's Fig. 3(b).
    pub(crate) fn fig3b() -> Self {
        Self::plain(Friction::of_letter(), (0.0, -10.0), 0.5, 0.1)
    }

    /// v where S is this, beside this v0.
    pub(crate) fn v(&self, v0: f64, signal: f64) -> f64 {
        clip(v0 + self.alpha_v * signal, self.of_v)
    }

    /// N where S is this.
    pub(crate) fn n(&self, signal: f64) -> f64 {
        clip(self.load + self.alpha_n * signal, self.of_load)
    }

    /// √(M/κ).
    pub(crate) fn time(&self) -> f64 {
        (self.mass / self.stiffness).sqrt()
    }

    /// Whether nothing but the elongation is kept from step to step: what is fed back depends on it
    /// now and one delay ago, or is made at readings.
    pub(crate) fn is_plain(&self) -> bool {
        self.is_sampled() || (self.memory == 0.0 && self.latency == 0.0)
    }

    /// Whether the elongation is read at equal times, and what is fed back held in between.
    pub(crate) fn is_sampled(&self) -> bool {
        self.sample_time > 0.0
    }

    /// For how long the past matters to nine digits.
    pub(crate) fn remembered(&self) -> f64 {
        let delays = match self.memory == 0.0 {
            true => 1.0,
            false => 1.0 + (1e-9_f64.ln() / self.memory.abs().ln()).ceil(),
        };
        self.latency + self.tau * delays
    }

    /// What is fed back where the elongation has always grown at v0.
    pub(crate) fn even_signal(&self) -> f64 {
        self.v0 * self.tau / (1.0 - self.memory)
    }
}

fn clip(commanded: f64, [least, most]: [f64; 2]) -> f64 {
    commanded.clamp(least, most)
}
