//! The response in time of a linear system with one delay, by Taylor series.
//!
//! ```text
//! ẋ = A x + B w(t − τ) + b u,   w = C x + D w(t − τ) + e u,   u = 1 from t = 0 on
//! ```
//!
//! Steps divide the delay, so that what is delayed is, in each step, the polynomial of the step one
//! delay before: the series of x and w then have no other error than their truncation. A motion of
//! the block (`src/slip`) takes steps of its own length between events and looks its past up; here
//! there are no events, several signals, and jumps of w that a past without them does not know.
//!
//! - `form`: a system with its start and its input in this form
//! - `step`: the steps
//! - `measures`: final value, overshoot, times of rise and settling

mod form;
mod measures;
mod step;

pub use form::{Excited, MOST_STEPS, NoResponse};
pub use measures::{Measures, SETTLED};

use step::Steps;

use crate::model::stop::Stop;

/// A response in time.
#[derive(Debug, Clone, PartialEq)]
pub struct Response {
    /// Times, evenly spaced from 0 on.
    pub t: Vec<f64>,
    /// The response at these times, the limit from the right where it jumps.
    pub y: Vec<f64>,
    /// What is read from it.
    pub measures: Measures,
    /// The number of Taylor steps.
    pub steps: usize,
}

impl Excited {
    /// The response until the time `until` > 0, with `samples` ≥ 2 of it. `settles_at` is the value
    /// at which it settles, none where it does not. Once `stop` is set it ends soon and means
    /// nothing.
    ///
    /// # Errors
    /// When it would take too many steps, or grows out of all bounds.
    pub fn response(
        &self,
        (until, samples): (f64, usize),
        settles_at: Option<f64>,
        stop: &Stop,
    ) -> Result<Response, NoResponse> {
        let steps = Steps::new(self, until)?;
        let every = until / (samples.max(2) - 1) as f64;
        let (mut t, mut y) = (Vec::with_capacity(samples), Vec::with_capacity(samples));
        let mut first = Measures::of_final(settles_at);
        steps.each(self, stop, |step| {
            while t.len() < samples.max(2) {
                let at = t.len() as f64 * every;
                if at >= step.until && !step.is_last {
                    break;
                }
                t.push(at);
                y.push(step.value((at - step.from) / step.length));
            }
            first.look(step);
        })?;
        // The band around a final value of 0 is a share of the peak, known only now.
        if settles_at.is_some() {
            let band = first.band();
            steps.each(self, stop, |step| first.look_at_band(step, band))?;
        }
        first.end(until);
        Ok(Response {
            t,
            y,
            measures: first,
            steps: steps.count,
        })
    }
}
