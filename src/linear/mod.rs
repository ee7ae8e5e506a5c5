//! Linear stability of continuous sliding.
//!
//! Everything here works on the dimensionless [`Groups`](crate::model::Groups) and on delays in
//! units of √(M/κ).
//!
//! - [`characteristic`]: D(λ) of the letter's Eq. (3) and a bound on its unstable roots
//! - `crossing`: frequencies and delays at which roots cross the imaginary axis (the letter's
//!   Eqs. 4 and 5)
//! - `count`: the exact number of unstable roots at a delay
//! - [`stable_delays`]: all delay intervals on which sliding is stable
//! - [`row`]: counts and margins at many delays of one line
//! - [`status`]: the status bits of a cell
//! - [`gains`]: the crossing curve with one gain given and the other solved for
//! - [`curves`]: crossing curves in a plane of a parameter and the delay, cut at their corners
//! - [`decay`]: curves of a given degree of stability in such a plane: where max Re λ = −σ
//! - `plane`: a characteristic function over a plane, for code that follows curves
//! - [`lobes`]: where the stable regions of pure control end
//! - [`best`]: the settings of fastest decay, for every stable region
//! - [`margins`]: how far a setting is from the boundary of stability, in every direction
//! - `branches`: starting values for roots from the branches of the logarithm
//! - `certificate`: the number of roots right of any vertical line: argument principle in closed
//!   form
//! - `cluster`: roots that rounding does not tell apart, with twice the digits
//! - `collocation`: roots as eigenvalues; the only file that imports faer
//! - `controlled`: the controlled oscillator as an `equation`
//! - `double`: numbers of twice the digits
//! - `equation`: a characteristic equation, with all that is needed to find and follow its roots
//! - `feedback_loop`: the feedback loop about steady sliding, as a system
//! - `general`: any linear system with one delay
//! - `line`: linear models, and what is told of each whatever its kind
//! - [`matrix`]: systems that are given as matrices, of any rank
//! - `newton`: polishing of a root (Halley's method) and its error
//! - `real_zeros`: all zeros of a real function of the frequency
//! - [`response`]: the response of a system in time
//! - `rightmost`: the rightmost roots at one point, with the certificate that a map's cell has
//! - `roots`: bisection, golden sections
//! - `rounded`: numbers with a bound on their rounding error
//! - [`sampled`]: the block under a digital loop
//! - `sensitivity`: derivatives of a root with respect to the groups and the delay
//! - `spectrum`: all roots right of a line, none missed
//! - `stretch`: the curves between two breakpoints of the parameter
//! - `track`: the rightmost roots along a line of delays, cell by cell, with their certificate

pub mod best;
mod branches;
pub mod certificate;
pub mod characteristic;
mod cluster;
pub(crate) mod collocation;
mod controlled;
pub(crate) mod count;
pub(crate) mod crossing;
pub mod curves;
pub mod decay;
mod double;
pub mod equation;
pub mod feedback_loop;
pub mod gains;
pub mod general;
pub mod line;
pub mod lobes;
pub mod margins;
pub mod matrix;
pub mod newton;
pub mod plane;
mod real_zeros;
pub mod response;
pub mod rightmost;
pub(crate) mod roots;
mod rounded;
pub mod row;
pub mod sampled;
pub(crate) mod sensitivity;
pub mod spectrum;
pub mod stable_delays;
pub mod status;
mod stretch;
pub mod track;

pub use count::{Count, MarginalTolerance};
pub use crossing::{Crossing, Crossings, Direction};
