//! The equations of the controlled friction oscillator, and nothing else.
//!
//! Model (the letter's Eqs. 1 and 2):
//!
//! ```text
//! M ẍ = κ a − sgn(ẋ) μ_K(|ẋ|) N           slip
//! ẋ   = 0          while |κ a| < μ_S N    stick
//! ȧ   = v − ẋ
//! v   = v0 + α_v [a(t) − a(t − τ)]        velocity control
//! N   = N0 + α_N [a(t) − a(t − τ)]        load control
//! ```
//!
//! Source: F.-J. Elmer, *Controlling friction* (1997), "the letter" throughout this crate.
//!
//! - `ball`: real numbers with a bound on their error, and intervals
//! - `elementary`: sin, exp and the like, the same bits on every processor; the only file that
//!   imports libm
//! - `error`: errors of parameters out of range, and the format of numbers in messages
//! - `feedback`: the feedback of the elongation: gains, delay, memory, latency, lags, limits
//! - `groups`: b, a_v, a_n: linear stability depends on these and the delay alone; B and A of D
//! - `known_cases`: cases with known answers, for tests and benches alike
//! - `law`: laws of kinetic friction, one file each: value, slope, their bounds, series
//! - `least_squares`: linear least squares, for fits of laws and of return maps
//! - `oscillator`: mass, spring, load, gains → dimensionless groups
//! - `rate_and_state`: rate-and-state friction about steady sliding: its groups, the critical
//!   stiffness
//! - `return_map`: control by the return map, with which the letter compares its own
//! - `series`: polynomials in time, their first zeros
//! - `stop`: a flag that ends computations nobody waits for any more
//! - `table`: a monotone cubic curve through measured points

pub(crate) mod ball;
pub(crate) mod elementary;
mod error;
mod feedback;
pub(crate) mod groups;
pub mod known_cases;
pub mod law;
pub(crate) mod least_squares;
mod oscillator;
pub(crate) mod rate_and_state;
mod return_map;
pub(crate) mod series;
pub mod stop;
pub mod table;

pub use error::ModelError;
pub use feedback::{ActuatorLimits, Channel, Feedback, Lags, Readings};
pub use groups::Groups;
pub use law::FrictionLaw;
pub use oscillator::{Control, Dashpots, Oscillator, SlidingPoint};
pub use rate_and_state::{RateAndState, StateGroups};
pub use return_map::{MapModel, Record, Recursion, ReturnMap};
pub use table::Table;
