//! The block under a digital loop: readings at t_k = k h, held in between.
//!
//! With S_k = y_{k−l} − y_{k−l−m} + R S_{k−m}, τ = m h and δ = l h, the elongation after each
//! reading follows
//!
//! ```text
//! z^m U(z) + V(z) = 0,   U = z^l p − q,   V = q − R z^l p                                    (1)
//! ```
//!
//! where p = det(z − Φ) belongs to the block without control and q to what is held over h, see
//! `step`. Sliding is stable where all zeros lie within |z| < 1; a zero stands for the root
//! λ = ln z / h.
//!
//! On a circle |z| = r a zero can lie only at an angle at which r^m |U| = |V|. These angles do not
//! depend on the exponent that the angle is multiplied with. Let it grow from 0 to m, r^m held: the
//! number of zeros outside the circle begins with that of the quadratic r^m U + V and changes by a
//! pair wherever z^m turns −V/U at such an angle. That is the letter's own count over the delay,
//! exact in closed form; with a latency once more for the exponent l. Where |V| is the larger one
//! at z = −r, one more zero comes to lie outside with each unit of the exponent.
//!
//! - `circle`: a circle, and where on it two polynomials are of the same size
//! - `gains`: at which gains a loop is stable
//! - `line`: all multiples of h as delays
//! - `margins`: how far a stable loop is from the boundary: in phase, latency and delay
//! - `noise`: what white noise of the readings does to the block and to their mean
//! - `on_circle`: a loop on |z| = 1, with bounds on the sizes of its polynomials
//! - `outside`: how many zeros lie outside a circle
//! - `roots`: the zeros of largest size
//! - `step`: what one sample time does to the block

mod circle;
mod gains;
mod line;
mod margins;
mod noise;
mod on_circle;
mod outside;
mod roots;
mod step;

use crate::model::{Channel, Groups};
pub use gains::GainLine;
pub use line::{SampledLine, multiple, multiples_within};
pub use noise::NoiseResponse;
pub use roots::SampledRoots;
use step::Step;
pub(crate) use step::recursion;

/// The most samples in a delay or a latency.
pub const MOST_SAMPLES: f64 = 1e9;

/// The dimensionless linear model of a digital loop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SampledLoop {
    /// The groups, those of a dashpot beside the spring included.
    pub groups: Groups,
    /// h > 0.
    pub sample_time: f64,
    /// R.
    pub memory: f64,
    /// l, the latency in samples.
    pub late: u64,
    step: Step,
}

impl SampledLoop {
    /// The loop of these groups with the sample time h = `sample_time` > 0, in units of √(M/κ) as
    /// the latency. None where the latency is no multiple of h.
    ///
    /// ```
    /// use slipmap::linear::sampled::SampledLoop;
    /// use slipmap::model::{Channel, Groups};
    ///
    /// // The letter's Fig. 3(a) with 100 readings in a delay.
    /// let groups = Groups::new(-0.3, -0.33, 0.0);
    /// let of_loop = SampledLoop::new(groups, Channel::default(), 0.0415).unwrap();
    /// assert_eq!(of_loop.n_unstable(100), 0);
    /// ```
    #[must_use]
    pub fn new(groups: Groups, channel: Channel, sample_time: f64) -> Option<Self> {
        let late = match channel.latency {
            0.0 => 0,
            latency => multiple(latency, sample_time)?,
        };
        Some(Self {
            groups,
            sample_time,
            memory: channel.memory,
            late,
            step: Step::of(groups, sample_time),
        })
    }

    /// The loop with b larger by `slope`, and both gains `factor` times as large.
    #[must_use]
    pub fn changed(&self, slope: f64, factor: f64) -> Self {
        let groups = Groups {
            b: self.groups.b + slope,
            a_v: factor * self.groups.a_v,
            a_n: factor * self.groups.a_n,
        };
        Self {
            groups,
            step: Step::of(groups, self.sample_time),
            ..*self
        }
    }

    /// The number of zeros with |z| > 1 at the delay of `multiple` ≥ 1 sample times.
    #[must_use]
    pub fn n_unstable(&self, multiple: u64) -> u64 {
        match self.groups.b == 0.0 {
            // Its pair starts on the circle: the line says which way it goes.
            true => self.line(1.0).n_unstable_at(multiple),
            false => self.outside(0.0, multiple),
        }
    }
}
