//! The critical velocity v_c: the velocity of the pull below which stick-slip survives.
//!
//! - [`limit`]: Coulomb friction, load control, τ → 0: closed form (the letter's Fig. 4)
//! - `search`: by the first road that leads to it; `one_slip` and `orbit` raise v0 (`climb`) to
//!   where stick-slip ends (`ends`)
//! - [`mod@line`]: along a line of delays, each from its neighbour's orbit
//! - [`follow`]: by simulation, v0 raised step by step
//! - [`switch_on`]: by the other protocol, the windows in which stick-slip survives switching on
//! - [`cycle`]: one slip and one stick

mod answer;
mod beyond;
mod climb;
pub mod cycle;
mod ends;
pub mod follow;
mod hold;
pub mod limit;
pub mod line;
mod one_slip;
mod orbit;
mod pace;
mod problem;
mod raise;
mod search;
mod simulated;
mod sticking;
mod stops;
pub mod switch_on;
mod track;
mod trend;

pub use answer::{Critical, CriticalWindows, End, GRAZE_PRECISION, Method};
pub use problem::Problem;
pub use search::critical_velocity;
pub use simulated::by_simulation;
