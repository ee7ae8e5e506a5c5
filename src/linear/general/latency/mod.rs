//! Feedback that comes late: D = B(1 − R E) − A e^(−λδ)(1 − E), with two delays.
//!
//! On the imaginary axis either delay is a line while the other one is fixed. Crossings follow from
//! (4) and (5) of [`general::line`](super::line) as without latency, but |P|² − |Q|² swings with
//! the delay that is fixed, and its zeros are found along ω.
//!
//! - [`budget`]: how much counting may still be done for a cell
//! - [`wave`]: functions that swing with one delay, and all their zeros
//! - [`prepared`]: such a function and its slope at one frequency, with bounds
//! - [`window`]: where zeros of a polynomial can be
//! - [`on_line`]: D on a vertical line in its two forms
//! - [`sum`]: the argument of a sum of two terms along a line
//! - [`count`]: how many roots lie right of a line, in either form
//! - [`line`]: all latencies at one delay; the latency margin
//! - [`roots`]: D and its derivatives, where roots can be, and starts for them

mod budget;
mod count;
mod line;
mod on_line;
mod prepared;
mod roots;
mod sum;
mod wave;
mod window;

use super::parts::{Angle, FeedbackForm};
use super::switches::Switches;
use super::system::{Class, System};
pub(super) use budget::{Budget, MOST_STEPS_OF_A_CELL};
use on_line::OnLine;
pub(super) use window::beyond_zeros;

pub use on_line::Form;

impl System {
    /// A frequency beyond which no root lies on Re λ = `line` at the delay `tau` ≥ 0, for these
    /// gains and smaller ones. None where roots accumulate there or right of it, and for systems
    /// that are not in feedback form.
    pub(in crate::linear) fn highest_on_line(&self, tau: f64, line: f64) -> Option<f64> {
        let on_line = OnLine::new(self.feedback_form()?, tau, line)?;
        let apart = on_line.right_of_essential()?;
        apart.then(|| on_line.window().to)
    }
}

impl FeedbackForm {
    /// The class with latency, by B and R alone: only without latency do P and Q have degrees.
    pub(super) fn late_class(&self) -> Class {
        if !self.open.degree_known() {
            return Class::DegreeUnknown;
        }
        let ratio = self.channel.memory.abs();
        if self.open.is_zero() || ratio == 1.0 || self.gain.degree() >= self.open.degree() {
            return Class::Refused;
        }
        match ratio {
            0.0 => Class::Retarded,
            ratio if ratio < 1.0 => Class::Neutral { ratio },
            _ => Class::Infinite,
        }
    }

    /// This feedback with B and A divided by λ.
    pub(super) fn divided_by_variable(&self) -> Self {
        Self {
            open: self.open.divided_by_variable(),
            gain: self.gain.divided_by_variable(),
            ..*self
        }
    }

    /// Finds where (3) of [`on_line`] changes its sign on any line at the delay `tau`; false where
    /// that is open.
    pub(super) fn switches_on(&self, tau: f64, line: f64, switches: &mut Switches) -> bool {
        let Some(on_line) = OnLine::new(self, tau, line) else {
            return false;
        };
        let wave = on_line.wave(Form::Delay);
        wave.switches(on_line.window(), switches).is_ok()
    }

    /// The argument of −P Q* at iω, P and Q being 𝒫 and 𝒬 of (1) in [`on_line`].
    pub(super) fn late_phase(&self, omega: f64, error: f64) -> Option<Angle> {
        OnLine::new(self, 0.0, 0.0)?.phase(Form::Delay, omega, error)
    }
}
