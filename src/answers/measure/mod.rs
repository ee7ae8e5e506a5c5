//! Friction measured through control: under control the block slides at v0, and the mean of κa is
//! μ_K(v0) N0 + c_g v0.
//!
//! - `chosen`: gain and delay of a v0: those of the file, or the best
//! - `foreseen`: what is known of a v0 before it is measured: its setting, v_c, errors
//! - `measured`: the mean of one v0, under control and without
//! - `predicted`: what noise, rounding and drift make of the mean

mod chosen;
mod foreseen;
mod measured;
mod predicted;

pub use foreseen::{Experiment, Foreseen, Prospect};
pub use measured::{Mean, MeasuredPoint, Unsettled};
pub use predicted::Predicted;
