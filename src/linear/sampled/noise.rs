//! What white noise of the readings does to a stable loop: exact, to the first order in the noise.
//!
//! With y = a + n, every n is an impulse: g_j is the answer of the j-th reading after it, itself
//! included, C_j = g_0 + … + g_j, and C goes to 1, since a loop that feeds differences back knows
//! no constant. The mean of K readings of a loop that has long run has the variance
//!
//! ```text
//! σ²/K² (Σ_{0 ≤ j < K} C_j² + Σ_{p ≥ 1} (C_{K−1+p} − C_{p−1})²)
//! ```
//!
//! where the first sum is of noise within the mean, the second of noise before it. Means over the
//! time are sums over impulses of integrals over each time from reading to reading.

use super::SampledLoop;
use super::step::Rows;

/// The most readings for which an impulse is followed.
const MOST: usize = 4_000_000;
/// An impulse is followed until it has decayed by this many e-foldings.
const FOLDS: f64 = 30.0;
/// Panels of Simpson's rule from reading to reading.
const PANELS: u32 = 64;
/// The last node of it.
const LAST: u32 = 2 * PANELS;

/// The answer of a loop to white noise of its readings with a standard deviation of 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NoiseResponse {
    /// The standard deviation of the mean of the readings.
    pub of_mean: f64,
    /// ⟨u²⟩, the mean square of the deviation of ẋ from v0, over the time.
    pub u_square: f64,
    /// ⟨u S⟩, over the time.
    pub u_signal: f64,
}

impl SampledLoop {
    /// The answer to white noise at the delay of `multiple` ≥ 1 sample times, with a mean of
    /// `samples` ≥ 1 readings. `abscissa` < 0 is that of the slowest root, in the unit of time of
    /// the loop. None where the loop remembers more readings than are followed.
    ///
    /// ```
    /// use slipmap::linear::sampled::SampledLoop;
    /// use slipmap::model::{Channel, Groups};
    ///
    /// let groups = Groups::new(-0.694, 0.0, -4.17);
    /// let of_loop = SampledLoop::new(groups, Channel::default(), 0.05).unwrap();
    /// let noise = of_loop.noise(10, 100_000, -0.2).unwrap();
    /// // Long means are as good as those of readings without a loop.
    /// assert!((noise.of_mean * 100_000_f64.sqrt() - 1.0).abs() < 1e-3);
    /// ```
    #[must_use]
    pub fn noise(&self, multiple: u64, samples: u64, abscissa: f64) -> Option<NoiseResponse> {
        let impulse = self.impulse(multiple, abscissa)?;
        Some(NoiseResponse {
            of_mean: of_mean(&impulse.sums, samples),
            u_square: impulse.u_square,
            u_signal: impulse.u_signal,
        })
    }

    /// Follows an impulse of the readings until it has decayed.
    fn impulse(&self, multiple: u64, abscissa: f64) -> Option<Impulse> {
        let (delay, late) = (usize::try_from(multiple).ok()?, self.late as usize);
        let decay = -abscissa * self.sample_time;
        let fading = (FOLDS / decay).ceil();
        let remembered = delay.checked_add(late)?;
        if !(fading < MOST as f64 && remembered < MOST) {
            return None;
        }
        let steps = fading as usize + 4 * remembered;
        let Means { square, mean, end } = self.means();
        let (mut u, mut a) = (0.0, 0.0);
        let (mut signals, mut readings) = (vec![0.0; steps], vec![0.0; steps]);
        let mut found = Impulse {
            sums: Vec::with_capacity(steps),
            u_square: 0.0,
            u_signal: 0.0,
        };
        let mut sum = 0.0;
        for k in 0..steps {
            let ago = |of: &[f64], by: usize| k.checked_sub(by).map_or(0.0, |at| of[at]);
            readings[k] = if k == 0 { 1.0 } else { a };
            sum += readings[k];
            found.sums.push(sum);
            signals[k] = readings[k] - ago(&readings, delay) + self.memory * ago(&signals, delay);
            let state = [u, a, ago(&signals, late)];
            let times = |row: &[f64; 3]| row[0] * state[0] + row[1] * state[1] + row[2] * state[2];
            found.u_square += (0..3).map(|i| state[i] * times(&square[i])).sum::<f64>();
            found.u_signal += times(&mean) * state[2];
            (u, a) = (times(&end.u), times(&end.a));
        }
        Some(found)
    }

    /// The means over the time from one reading to the next, and its end.
    fn means(&self) -> Means {
        let mut of = Means {
            square: [[0.0; 3]; 3],
            mean: [0.0; 3],
            end: Rows::after(self.groups, self.sample_time),
        };
        for node in 0..=LAST {
            let part = f64::from(node) / f64::from(LAST);
            let row = Rows::after(self.groups, part * self.sample_time).u;
            let weight = match node {
                0 | LAST => 1.0,
                node if node % 2 == 1 => 4.0,
                _ => 2.0,
            };
            let weight = weight / f64::from(6 * PANELS);
            for i in 0..3 {
                of.mean[i] += weight * row[i];
                for j in 0..3 {
                    of.square[i][j] += weight * row[i] * row[j];
                }
            }
        }
        of
    }
}

/// Means over the time from one reading to the next: of u² as a form of (u, a, S), and of u.
struct Means {
    square: [[f64; 3]; 3],
    mean: [f64; 3],
    /// What that time makes of (u, a, S).
    end: Rows,
}

/// The answer to one impulse.
struct Impulse {
    /// C_j, until they stay what they are.
    sums: Vec<f64>,
    u_square: f64,
    u_signal: f64,
}

/// The standard deviation of the mean of so many readings.
fn of_mean(sums: &[f64], samples: u64) -> f64 {
    let last = sums.last().copied().unwrap_or(1.0);
    let known = sums.len() as u64;
    let at = |j: u64| sums.get(j as usize).copied().unwrap_or(last);
    let square = |x: f64| x * x;
    let within: f64 = (0..samples.min(known)).map(|j| square(at(j))).sum();
    let settled = samples.saturating_sub(known) as f64 * last * last;
    let before = (0..known).map(|p| square(at(p.saturating_add(samples)) - at(p)));
    (within + settled + before.sum::<f64>()).sqrt() / samples as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Channel, Groups};

    /// A loop with memory and latency, velocity and load control.
    fn of_loop(memory: f64, latency: f64) -> SampledLoop {
        let channel = Channel { memory, latency };
        SampledLoop::new(Groups::new(-0.3, -0.1, -1.2), channel, 0.1).unwrap()
    }

    /// The energies of a stationary motion: 0 = ⟨u u̇⟩ + ⟨a ȧ⟩ and so on, by which ⟨u²⟩ and ⟨u S⟩
    /// belong together under load control: b⟨u²⟩ = −a_n⟨u S⟩.
    #[test]
    fn energy_is_conserved_on_average() {
        for (b, a_n, h) in [(-0.6, -3.0, 0.05), (-0.3, -1.2, 0.2), (0.4, -0.7, 0.1)] {
            let groups = Groups::new(b, 0.0, a_n);
            let of_loop = SampledLoop::new(groups, Channel::default(), h).unwrap();
            let m = (0.6 / h).round() as u64;
            assert_eq!(of_loop.n_unstable(m), 0);
            let noise = of_loop.noise(m, 1000, -0.05).unwrap();
            let off = b * noise.u_square + a_n * noise.u_signal;
            assert!(off.abs() < 1e-9 * noise.u_square, "{b} {a_n} {h} {off}");
        }
    }

    /// Without gains the mean is that of white noise, whatever its length.
    #[test]
    fn without_feedback_the_mean_is_of_white_noise() {
        let free = SampledLoop::new(Groups::new(0.5, 0.0, 0.0), Channel::default(), 0.1).unwrap();
        for samples in [1, 7, 100_000_000] {
            let noise = free.noise(3, samples, -0.25).unwrap();
            let expected = 1.0 / (samples as f64).sqrt();
            assert!((noise.of_mean / expected - 1.0).abs() < 1e-12, "{samples}");
            assert_eq!((noise.u_square, noise.u_signal), (0.0, 0.0));
        }
    }

    /// Against the loop with noise drawn at random, step by step.
    #[test]
    fn variances_are_those_of_a_loop_with_random_noise() {
        let (of_loop, delay, late, samples) = (of_loop(0.3, 0.2), 6, 2, 64);
        assert_eq!(of_loop.n_unstable(delay as u64), 0);
        let noise = of_loop.noise(delay as u64, samples, -0.05).unwrap();
        let mut seed = 1_u64;
        let mut even = || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (seed >> 11) as f64 / (1_u64 << 53) as f64
        };
        // Twelve even numbers together have the variance 1.
        let mut draw = || (0..12).map(|_| even()).sum::<f64>() - 6.0;
        let end = Rows::after(of_loop.groups, of_loop.sample_time);
        let halfway = Rows::after(of_loop.groups, 0.5 * of_loop.sample_time);
        let (mut u, mut a, mut y, mut v) = (0.0, 0.0, vec![], vec![]);
        let (mut squares, mut means, mut sum) = (0.0, 0.0, 0.0);
        let count = 200_000;
        for k in 0..count {
            let ago = |of: &[f64], by: usize| of.len().checked_sub(by).map_or(0.0, |at| of[at]);
            let reading = a + draw();
            let signal = reading - ago(&y, delay) + 0.3 * ago(&v, delay);
            y.push(reading);
            v.push(signal);
            let held = ago(&v, late + 1);
            let state = [u, a, held];
            let times = |row: [f64; 3]| (0..3).map(|i| row[i] * state[i]).sum::<f64>();
            let middle = times(halfway.u);
            let next = times(end.u);
            squares += (u * u + 4.0 * middle * middle + next * next) / 6.0;
            (u, a) = (next, times(end.a));
            sum += reading;
            if (k + 1) % samples == 0 {
                means += (sum / samples as f64) * (sum / samples as f64);
                sum = 0.0;
            }
        }
        let u_square = squares / count as f64;
        assert!(
            (u_square / noise.u_square - 1.0).abs() < 0.03,
            "{u_square} {noise:?}"
        );
        let of_mean = (means / (count / samples) as f64).sqrt();
        assert!(
            (of_mean / noise.of_mean - 1.0).abs() < 0.06,
            "{of_mean} {noise:?}"
        );
    }
}
