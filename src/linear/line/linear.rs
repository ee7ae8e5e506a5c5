//! The kinds of linear models, told apart here and nowhere else above the kernels of cells.

use super::Roots;
use super::general::GeneralRoots;
use super::letter::LetterRoots;
use crate::linear::feedback_loop::FeedbackLoop;
use crate::linear::general::{RootCounter, System};
use crate::linear::matrix::{MatrixRoots, MatrixSystem};
use crate::linear::sampled::{SampledLoop, SampledRoots};
use crate::model::stop::Stop;
use crate::model::{Channel, Groups, Lags};

/// A linear model, dimensionless.
///
/// ```
/// use slipmap::linear::line::Linear;
/// use slipmap::model::stop::Stop;
/// use slipmap::model::{Channel, Groups};
///
/// // Feedback that is late by 0.2.
/// let late = Channel { memory: 0.0, latency: 0.2 };
/// let linear = Linear::of_feedback(Groups::new(-0.3, -0.33, 0.0), late);
/// assert_eq!(linear.roots(&Stop::default()).count(4.0, 1.0).unwrap().n_unstable, 0);
/// ```
#[derive(Debug, Clone)]
pub enum Linear {
    /// The letter's own: without memory, latency and lags.
    Letter(Groups),
    /// Any other that acts at all times.
    General(Box<System>),
    /// One that is read from time to time.
    Sampled(SampledLoop),
    /// One that is given as matrices; where P and Q say it all as well, answers are of them.
    Matrix(Box<MatrixSystem>),
}

impl Linear {
    /// The letter's own model, or one with memory and latency where a gain makes them act.
    #[must_use]
    pub fn of_feedback(groups: Groups, channel: Channel) -> Self {
        if !channel.acts() || groups.uncontrolled() {
            return Self::Letter(groups);
        }
        let of_loop = FeedbackLoop::of_letter(groups, channel, Lags::default());
        Self::General(Box::new(of_loop.system()))
    }

    /// The system; the letter's own in feedback form, none of a sampled one or of
    /// matrices that are no P and Q.
    #[must_use]
    pub fn system(&self) -> Option<System> {
        match self {
            Self::Letter(groups) => {
                let of = FeedbackLoop::of_letter(*groups, Channel::default(), Lags::default());
                Some(of.system())
            }
            Self::General(system) => Some(**system),
            Self::Sampled(_) => None,
            Self::Matrix(of) => of.expanded(),
        }
    }

    /// This model as P and Q where it is one of matrices of which they say all, this model itself
    /// elsewhere.
    #[must_use]
    pub(crate) fn settled(self) -> Self {
        match &self {
            Self::Matrix(of) => match of.as_polynomials() {
                Some(system) => Self::General(Box::new(system)),
                None => self,
            },
            _ => self,
        }
    }

    /// Its roots, found within a bound of work. Once `stop` is set, answers come soon but are
    /// meaningless.
    #[must_use]
    pub fn roots(&self, stop: &Stop) -> Box<dyn Roots> {
        self.roots_by(|system| RootCounter::new(system).bounded().heeding(stop))
    }

    /// Its roots without a bound of work, for a second opinion on what was found within one.
    #[must_use]
    pub fn roots_at_any_cost(&self) -> Box<dyn Roots> {
        self.roots_by(RootCounter::new)
    }

    fn roots_by(&self, counter: impl Fn(&System) -> RootCounter) -> Box<dyn Roots> {
        match self {
            Self::Letter(groups) => Box::new(LetterRoots::new(*groups)),
            Self::General(system) => Box::new(GeneralRoots::new(counter(system))),
            Self::Sampled(of) => Box::new(SampledRoots::new(*of)),
            Self::Matrix(of) => match of.as_polynomials() {
                Some(system) => Box::new(GeneralRoots::new(counter(&system))),
                None => Box::new(MatrixRoots::new((**of).clone())),
            },
        }
    }
}
