//! Friction laws fitted to measured points, with what the noise of the points leaves open of them.
//!
//! ```text
//! minimise over the parameters p   Σ (μ_i − μ_K(v_i; p))² / s_i²                            (1)
//! ```
//!
//! - `candidate`: the laws that are fitted: their parameters, and where a search for them starts
//! - `choice`: which law points are described by best
//! - `error`: why points determine no law
//! - `least_squares`: the minimum of (1), and the covariance of the parameters there
//! - `rounding`: numbers without the digits that the noise leaves open
//! - `weights`: the s_i of points

mod candidate;
mod choice;
mod error;
mod least_squares;
mod rounding;
mod weights;

pub use candidate::LAWS;
pub use choice::{Band, Contender, FittedLaw, Wanted, fit};
pub use error::FitError;
