//! Readings of a digital loop: what the sensor says of the elongation, and the signal made of it.
//!
//! At t_k = t_on + k h the sensor reads y_k: the elongation with noise, rounded to a multiple of
//! the resolution. With τ = m h and the latency δ = l h the signal held from t_k on is
//!
//! ```text
//! V_k = y_k − y_{k−m} + R V_{k−m},   S_k = V_{k−l}
//! ```
//!
//! Readings are numbered by k, also those before switch-on. The noise of a reading depends on the
//! seed and on k alone, so it is the same whenever the reading is used, on every machine.

use crate::linear::sampled::multiple;
use crate::model::elementary::{ln, normals};
use crate::model::{Channel, Feedback, ModelError, Readings};

/// The most readings that a delay or a latency may span: 8 MB each.
const MOST_READINGS: u64 = 1_000_000;
/// More readings than any motion has.
const LONGEST: i64 = 1 << 60;
/// Memory that has faded to this share of what was fed back is forgotten.
const FADED: f64 = 1e-17;

/// Checks the readings of a feedback, and that its delay and latency are whole multiples of the
/// time between them.
pub(crate) fn check(feedback: &Feedback) -> Result<(), ModelError> {
    let Feedback {
        tau,
        channel: Channel { latency, .. },
        readings,
        ..
    } = *feedback;
    let Readings {
        sample_time,
        noise,
        resolution,
        ..
    } = readings;
    let at_least_0 = "finite and at least 0";
    for (name, value) in [
        ("sample_time", sample_time),
        ("noise", noise),
        ("resolution", resolution),
    ] {
        ModelError::check(name, value, at_least_0, value >= 0.0)?;
    }
    if !readings.acts() {
        for (name, value) in [("noise", noise), ("resolution", resolution)] {
            let allowed = "0 without sample_time: give sample_time (--sample-time) too";
            ModelError::check(name, value, allowed, value == 0.0)?;
        }
        return Ok(());
    }
    if !feedback.is_sampled() {
        return Ok(());
    }
    if feedback.return_map.is_some() {
        return Ok(());
    }
    let times = |time: f64| multiple(time, sample_time);
    let whole = times(tau).is_some_and(|times| times <= MOST_READINGS);
    let allowed = "a whole multiple of sample_time, at least one and at most a million (a longer \
        sample_time has fewer)";
    ModelError::check("tau", tau, allowed, whole)?;
    let whole = latency == 0.0 || times(latency).is_some_and(|times| times <= MOST_READINGS);
    let allowed = "0 or a whole multiple of sample_time, at most a million (a longer \
        sample_time has fewer)";
    ModelError::check("latency", latency, allowed, whole)?;
    Ok(())
}

/// What the sensor says of the elongation `a` in reading `number`.
#[must_use]
pub(super) fn reading(of: &Readings, number: i64, a: f64) -> f64 {
    let noisy = match of.noise > 0.0 {
        true => a + of.noise * gaussian(of.seed, number),
        false => a,
    };
    match of.resolution > 0.0 {
        // Half away from 0.
        true => (noisy / of.resolution).round() * of.resolution,
        false => noisy,
    }
}

/// A number of the standard normal distribution, for reading `number` under this seed.
fn gaussian(seed: u64, number: i64) -> f64 {
    // Each seed has a place of its own in the sequence of a counter.
    let place = mixed(seed).wrapping_add(number.cast_unsigned().wrapping_mul(2));
    let part = |i: u64| (mixed(place.wrapping_add(i)) >> 11) as f64 / (1_u64 << 53) as f64;
    normals([part(0), part(1)])[0]
}

/// A number between 0 and 1 for reading `number` under this seed, all equally likely.
pub(super) fn part(seed: u64, number: i64) -> f64 {
    let bits = mixed(mixed(seed).wrapping_add(number.cast_unsigned()));
    (bits >> 11) as f64 / (1_u64 << 53) as f64
}

/// The bits of a counter, mixed: an output of SplitMix64 (Steele, Lea and Flood 2014).
fn mixed(counter: u64) -> u64 {
    let z = counter.wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// The last readings and signals, for one delay and one latency.
#[derive(Debug, Clone, Default)]
pub(super) struct Sampler {
    of: Readings,
    /// Memory and latency.
    pub(super) channel: Channel,
    /// t_on, the time of reading 0.
    switch_on: f64,
    /// The number of the next reading, and its time.
    number: i64,
    pub(super) next: f64,
    /// y of the last delay, and the place of the next reading.
    readings: Vec<f64>,
    at: usize,
    /// V as far back as it is needed, the place of the next one, and how far behind it are those of
    /// one delay and one latency ago.
    signals: Vec<f64>,
    at_signal: usize,
    delay: usize,
    latency: usize,
}

impl Sampler {
    /// Whether readings are held.
    pub(super) fn acts(&self) -> bool {
        self.of.acts()
    }

    /// Begins anew for a `feedback`, without allocating where there is room. The elongation is
    /// `known` up to `now`. What the loop remembers of the time before `since` counts as 0.
    pub(super) fn restart(
        &mut self,
        feedback: &Feedback,
        switch_on: f64,
        [since, now]: [f64; 2],
        known: impl Fn(f64) -> f64,
    ) {
        self.of = match feedback.is_sampled() {
            true => feedback.readings,
            false => Readings::default(),
        };
        self.channel = feedback.channel;
        self.switch_on = switch_on;
        self.readings.clear();
        self.signals.clear();
        (self.number, self.next) = (0, f64::INFINITY);
        (self.at, self.at_signal) = (0, 0);
        if !(self.acts() && switch_on.is_finite()) {
            return;
        }
        let times = |time: f64| {
            (time / self.of.sample_time)
                .round()
                .min(MOST_READINGS as f64) as usize
        };
        (self.delay, self.latency) = (times(feedback.tau).max(1), times(feedback.channel.latency));
        let kept = match feedback.channel.memory == 0.0 {
            true => self.latency,
            false => self.latency.max(self.delay),
        };
        self.readings.resize(self.delay, 0.0);
        self.signals.resize(kept, 0.0);
        self.number = self.first(since);
        // No signal is made of the first ones: nothing is known one delay before them.
        while self.at < self.delay && self.is_due_before_switch_on(now) {
            let a = known(self.time(self.number));
            self.readings[self.at] = reading(&self.of, self.number, a);
            (self.at, self.number) = (self.at + 1, self.number + 1);
        }
        self.at %= self.delay;
        while self.is_due_before_switch_on(now) {
            let a = known(self.time(self.number));
            self.read(a);
        }
        self.next = self.time(self.number);
    }

    /// The number of the first reading: none before has an effect, or is of the time since `since`.
    fn first(&self, since: f64) -> i64 {
        let (delay, latency) = (self.delay as i64, self.latency as i64);
        let known = ((self.switch_on - since) / self.of.sample_time).floor() as i64;
        -known.clamp(latency, latency + self.remembered()) - delay
    }

    /// How many readings ago what was fed back has faded.
    fn remembered(&self) -> i64 {
        let memory = self.channel.memory.abs();
        if memory == 0.0 {
            return 0;
        }
        let delays = (ln(FADED) / ln(memory)).ceil() as i64;
        delays.saturating_mul(self.delay as i64).min(LONGEST)
    }

    /// The time of reading `number`.
    fn time(&self, number: i64) -> f64 {
        self.switch_on + number as f64 * self.of.sample_time
    }

    /// Whether the next reading is one before switch-on, and not after `now`.
    pub(super) fn is_due_before_switch_on(&self, now: f64) -> bool {
        self.number < 0 && self.time(self.number) <= now
    }

    /// Reads the elongation `a`, which is that of the time of the next reading. Returns the number
    /// of the reading and what it is.
    pub(super) fn sense(&mut self, a: f64) -> (i64, f64) {
        let number = self.number;
        self.number += 1;
        self.next = self.time(self.number);
        (number, reading(&self.of, number, a))
    }

    /// The number of the next reading.
    pub(super) fn number(&self) -> i64 {
        self.number
    }

    /// Reads the elongation `a`, which is that of the time of the next reading. Returns the signal
    /// that is held from then on.
    pub(super) fn read(&mut self, a: f64) -> f64 {
        let (_, now) = self.sense(a);
        let before = std::mem::replace(&mut self.readings[self.at], now);
        self.at = if self.at + 1 < self.delay {
            self.at + 1
        } else {
            0
        };
        let difference = now - before;
        if self.signals.is_empty() {
            return difference;
        }
        let memory = self.channel.memory;
        let remembered = match memory == 0.0 {
            true => 0.0,
            false => memory * self.signals[self.back(self.delay)],
        };
        let signal = difference + remembered;
        let late = match self.latency {
            0 => signal,
            latency => self.signals[self.back(latency)],
        };
        self.signals[self.at_signal] = signal;
        self.at_signal = match self.at_signal + 1 < self.signals.len() {
            true => self.at_signal + 1,
            false => 0,
        };
        late
    }

    /// The place of the signal so many readings back, at most as many as there are.
    fn back(&self, readings: usize) -> usize {
        match self.at_signal.checked_sub(readings) {
            Some(place) => place,
            None => self.at_signal + self.signals.len() - readings,
        }
    }

    /// Becomes a copy of `other` in the memory that it has.
    pub(super) fn copy_from(&mut self, other: &Self) {
        let [mut readings, mut signals] =
            [&mut self.readings, &mut self.signals].map(std::mem::take);
        readings.clone_from(&other.readings);
        signals.clone_from(&other.signals);
        *self = Self {
            readings,
            signals,
            ..*other
        };
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::elementary::power;

    const EXACT: Readings = Readings {
        sample_time: 0.5,
        noise: 0.0,
        resolution: 0.0,
        seed: 7,
    };

    #[test]
    fn readings_are_rounded_half_away_from_zero() {
        let coarse = Readings {
            resolution: 0.25,
            ..EXACT
        };
        for (a, read) in [
            (0.124, 0.0),
            (0.125, 0.25),
            (0.3, 0.25),
            (0.375, 0.5),
            (-0.124, 0.0),
            (-0.125, -0.25),
            (-0.375, -0.5),
            (-7.0, -7.0),
        ] {
            assert_eq!(reading(&coarse, 3, a), read, "{a}");
        }
        assert_eq!(reading(&EXACT, 3, 0.123), 0.123);
    }

    /// Noise comes before rounding: what it lifts over half a step is rounded up.
    #[test]
    fn noise_is_read_before_it_is_rounded() {
        let noisy = Readings {
            noise: 0.1,
            resolution: 0.5,
            ..EXACT
        };
        let unrounded = Readings {
            resolution: 0.0,
            ..noisy
        };
        let mut ways = [0; 2];
        for number in 0..100 {
            let expected = match reading(&unrounded, number, 0.25) >= 0.25 {
                true => 0.5,
                false => 0.0,
            };
            ways[usize::from(expected > 0.0)] += 1;
            assert_eq!(reading(&noisy, number, 0.25), expected);
        }
        assert!(ways[0] > 20 && ways[1] > 20, "{ways:?}");
    }

    /// White and normal, other for each seed: mean, variance, the fourth power, correlations with
    /// the next ones and with other seeds.
    #[test]
    fn noise_is_white_and_normal() {
        let draws = 40_000_i64;
        let n = draws as f64;
        let of = |seed: u64| -> Vec<f64> {
            (-draws / 2..draws / 2).map(|k| gaussian(seed, k)).collect()
        };
        let noise = of(3);
        let mean = |values: &mut dyn Iterator<Item = f64>| values.sum::<f64>() / n;
        // Four standard errors each.
        assert!(mean(&mut noise.iter().copied()).abs() < 4.0 / n.sqrt());
        let square = mean(&mut noise.iter().map(|x| x * x));
        assert!((square - 1.0).abs() < 4.0 * (2.0 / n).sqrt(), "{square}");
        let fourth = mean(&mut noise.iter().map(|x| power(*x, 4)));
        assert!((fourth - 3.0).abs() < 4.0 * (96.0 / n).sqrt(), "{fourth}");
        for lag in 1..6 {
            let products = noise.iter().zip(&noise[lag..]).map(|(x, y)| x * y);
            assert!(
                mean(&mut products.into_iter()).abs() < 4.0 / n.sqrt(),
                "{lag}"
            );
        }
        for seed in [0, 1, 2, 4, u64::MAX] {
            let other = of(seed);
            for lag in 0..3 {
                let products = noise.iter().zip(&other[lag..]).map(|(x, y)| x * y);
                assert!(
                    mean(&mut products.into_iter()).abs() < 4.0 / n.sqrt(),
                    "{seed}"
                );
            }
        }
    }

    /// S_k by the sums of the definition, from readings that are all known: with memory and latency
    /// of any length beside the delay, however long control has been off.
    #[test]
    fn signals_are_those_of_the_definition() {
        let a = |t: f64| (0.7 * t).sin() + 0.1 * t;
        for (delay, latency, memory) in [
            (1, 0, 0.0),
            (3, 0, 0.0),
            (3, 2, 0.0),
            (2, 5, 0.6),
            (5, 2, -0.4),
            (4, 4, 0.3),
            (4, 0, 0.8),
        ] {
            let channel = Channel {
                memory,
                latency: 0.5 * f64::from(latency),
            };
            let feedback = Feedback {
                readings: EXACT,
                ..Feedback::new(1.0, 0.0, 0.5 * f64::from(delay)).through(channel)
            };
            for switch_on in [0.0, 0.2, 7.0, 300.0] {
                let known = |t: f64| a(t.max(0.0));
                let read = |k: i32| known(switch_on + 0.5 * f64::from(k));
                // V is 0 before the start.
                let v = |k: i32| {
                    let (mut sum, mut share, mut k) = (0.0, 1.0, k);
                    while switch_on + 0.5 * f64::from(k) >= 0.0 || k >= -latency {
                        sum += share * (read(k) - read(k - delay));
                        share *= memory;
                        k -= delay;
                    }
                    sum
                };
                let mut sampler = Sampler::default();
                for _ in 0..2 {
                    sampler.restart(&feedback, switch_on, [0.0, 0.0], known);
                    while sampler.is_due_before_switch_on(switch_on) {
                        sampler.read(known(sampler.next));
                    }
                    for k in 0..40 {
                        assert_eq!(sampler.next, switch_on + 0.5 * f64::from(k));
                        let found = sampler.read(known(sampler.next));
                        let off = (found - v(k - latency)).abs();
                        assert!(
                            off < 1e-12,
                            "{delay} {latency} {memory} {switch_on} {k}: {off}"
                        );
                    }
                }
            }
        }
    }
}
