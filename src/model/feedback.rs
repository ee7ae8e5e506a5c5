//! The feedback of the elongation: gains, delay, memory, latency, lags and limits of actuators.
//!
//! ```text
//! S(t) = a(t) − a(t − τ) + R S(t − τ)
//! v = v0 + α_v S(t − δ),   N = N0 + α_N S(t − δ)
//! ```
//!
//! The letter's own has R = δ = 0. Memory is that of extended time-delay autosynchronization
//! (Socolar, Sukow and Gauthier, Phys. Rev. E 50, 3245, 1994). A lag T divides what passes through
//! it by 1 + Tλ. Limits clip v and N as they are commanded, before a lag.

use super::oscillator::{Control, Oscillator};
use super::return_map::ReturnMap;

/// What happens to the signal between the sensor and the gains.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Channel {
    /// R, the memory, −1 < R < 1.
    pub memory: f64,
    /// δ ≥ 0, the latency, in the unit of the delay.
    pub latency: f64,
}

impl Channel {
    /// Whether there is memory or latency.
    #[must_use]
    pub fn acts(&self) -> bool {
        self.memory != 0.0 || self.latency != 0.0
    }
}

/// Lags of first order, at least 0, in the unit of the delay.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Lags {
    /// T_a, of the load behind its command.
    pub load: f64,
    /// T_v, of the pulling velocity behind its command.
    pub velocity: f64,
    /// T_s, of the sensor behind the elongation.
    pub sensor: f64,
}

impl Lags {
    /// T_a, T_v and T_s.
    #[must_use]
    pub fn times(&self) -> [f64; 3] {
        [self.load, self.velocity, self.sensor]
    }
}

/// Readings of a digital loop: taken at equal times, and held in between. Times are in the unit of
/// the delay, elongations in that of a.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Readings {
    /// h ≥ 0, the time from one reading to the next; 0 for feedback without interruption. Delay
    /// and latency are multiples of it.
    pub sample_time: f64,
    /// The standard deviation of the noise of a reading, 0 or more; white, and drawn once for each
    /// reading.
    pub noise: f64,
    /// The step of the sensor, 0 or more: readings are rounded to its multiples, half away from 0.
    pub resolution: f64,
    /// What the noise is drawn with.
    pub seed: u64,
}

impl Readings {
    /// Whether readings are held.
    #[must_use]
    pub fn acts(&self) -> bool {
        self.sample_time > 0.0
    }
}

/// Limits of the actuators: v and N stay within them, whatever is commanded.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ActuatorLimits {
    /// The smallest and the largest v, infinite for none; v0 is between them.
    pub velocity: [f64; 2],
    /// The smallest N, 0 for none, and the largest one; N0 is between them. With a smallest load
    /// above 0 nothing lifts off.
    pub load: [f64; 2],
}

impl Default for ActuatorLimits {
    fn default() -> Self {
        Self {
            velocity: [f64::NEG_INFINITY, f64::INFINITY],
            load: [0.0, f64::INFINITY],
        }
    }
}

impl ActuatorLimits {
    /// Whether there are any.
    #[must_use]
    pub fn act(&self) -> bool {
        *self != Self::default()
    }

    /// Whether there is a smallest load: then nothing lifts off.
    pub(crate) fn holds_load(&self) -> bool {
        self.load[0] > 0.0
    }

    /// N where `commanded` is asked for; a smallest load of 0 leaves it as it is.
    pub(crate) fn load_of(&self, commanded: f64) -> f64 {
        match self.load {
            [least, _] if self.holds_load() && commanded < least => least,
            [_, most] if commanded > most => most,
            _ => commanded,
        }
    }

    /// v where `commanded` is asked for.
    pub(crate) fn velocity_of(&self, commanded: f64) -> f64 {
        match self.velocity {
            [least, _] if commanded < least => least,
            [_, most] if commanded > most => most,
            _ => commanded,
        }
    }
}

/// Delayed feedback of the elongation: α_v in 1/time, α_N in force/length, and times; or all of it
/// in the units of an oscillator, see [`Feedback::dimensionless`].
///
/// ```
/// use slipmap::model::{Channel, Feedback, Oscillator};
///
/// // Velocity control with a delay of 2 s, of which half of what was fed back is remembered.
/// let feedback = Feedback::new(-0.6, 0.0, 2.0).through(Channel { memory: 0.5, latency: 0.0 });
/// let block = Oscillator::new(2.0, 8.0, 10.0)?;
/// let dimensionless = feedback.dimensionless(&block);
/// assert_eq!((dimensionless.gains.alpha_v, dimensionless.tau), (-0.3, 4.0));
/// # Ok::<(), slipmap::model::ModelError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Feedback {
    /// α_v and α_N.
    pub gains: Control,
    /// τ ≥ 0, the delay; greater than 0 where a gain acts.
    pub tau: f64,
    /// Memory and latency; without effect where no gain acts.
    pub channel: Channel,
    /// Lags of actuators and sensor.
    pub lags: Lags,
    /// Limits of the actuators, in the units of v0 and N0.
    pub limits: ActuatorLimits,
    /// How the elongation is read; without effect where no control acts.
    pub readings: Readings,
    /// Control by the return map, in the place of the delayed feedback: with readings, without
    /// gains, memory, latency and limits.
    pub return_map: Option<ReturnMap>,
}

impl Feedback {
    /// The letter's own feedback, with these gains and this delay.
    #[must_use]
    pub fn new(alpha_v: f64, alpha_n: f64, tau: f64) -> Self {
        Self {
            gains: Control { alpha_v, alpha_n },
            tau,
            ..Self::default()
        }
    }

    /// This feedback through a channel with memory and latency.
    #[must_use]
    pub fn through(self, channel: Channel) -> Self {
        Self { channel, ..self }
    }

    /// Whether a gain acts, or control by the return map.
    #[must_use]
    pub fn acts(&self) -> bool {
        self.gains.act() || self.return_map.is_some()
    }

    /// Whether memory or latency have an effect: the signal then depends on more of the past than
    /// one delay.
    #[must_use]
    pub fn echoes(&self) -> bool {
        self.gains.act() && self.channel.acts()
    }

    /// Whether readings are held, and used.
    #[must_use]
    pub fn is_sampled(&self) -> bool {
        self.acts() && self.readings.acts()
    }

    /// How long it remembers: τ/(1 − |R|) + δ, which is one delay without memory and latency, and
    /// where no gain acts.
    #[must_use]
    pub fn remembered(&self) -> f64 {
        if !self.echoes() {
            return self.tau;
        }
        let Channel { memory, latency } = self.channel;
        self.tau / (1.0 - memory.abs()) + latency
    }

    /// This feedback in the units of `oscillator`: times in √(M/κ), α_v in its inverse, α_N in
    /// κ, limits in N0/√(κM) and N0.
    #[must_use]
    pub fn dimensionless(&self, oscillator: &Oscillator) -> Self {
        let unit = oscillator.time_unit();
        let force = oscillator.normal_load();
        let velocity_unit = oscillator.velocity_unit();
        let length = force / oscillator.stiffness();
        let Lags {
            load,
            velocity,
            sensor,
        } = self.lags;
        Self {
            gains: Control {
                alpha_v: self.gains.alpha_v * unit,
                alpha_n: self.gains.alpha_n / oscillator.stiffness(),
            },
            tau: self.tau / unit,
            channel: Channel {
                memory: self.channel.memory,
                latency: self.channel.latency / unit,
            },
            lags: Lags {
                load: load / unit,
                velocity: velocity / unit,
                sensor: sensor / unit,
            },
            limits: ActuatorLimits {
                velocity: self.limits.velocity.map(|v| v / velocity_unit),
                load: self.limits.load.map(|n| n / force),
            },
            readings: Readings {
                sample_time: self.readings.sample_time / unit,
                noise: self.readings.noise / length,
                resolution: self.readings.resolution / length,
                seed: self.readings.seed,
            },
            return_map: self.return_map.map(|of| of.over(force)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn memory_and_latency_lengthen_the_past_where_a_gain_acts() {
        let channel = Channel {
            memory: -0.5,
            latency: 0.25,
        };
        assert_eq!(Feedback::new(-0.3, 0.0, 2.0).remembered(), 2.0);
        let through = |alpha_v| Feedback::new(alpha_v, 0.0, 2.0).through(channel);
        assert_eq!(through(-0.3).remembered(), 4.25);
        assert_eq!(through(0.0).remembered(), 2.0);
    }

    #[test]
    fn times_are_measured_by_the_oscillator() {
        let oscillator = Oscillator::new(8.0, 2.0, 5.0).unwrap();
        let physical = Feedback {
            lags: Lags {
                load: 2.0,
                velocity: 4.0,
                sensor: 6.0,
            },
            ..Feedback::new(0.5, -3.0, 8.0).through(Channel {
                memory: 0.1,
                latency: 10.0,
            })
        };
        let found = physical.dimensionless(&oscillator);
        assert_eq!((found.gains.alpha_v, found.gains.alpha_n), (1.0, -1.5));
        assert_eq!((found.tau, found.channel.latency), (4.0, 5.0));
        assert_eq!(found.lags.times(), [1.0, 2.0, 3.0]);
        assert_eq!(found.channel.memory, 0.1);
    }
}
