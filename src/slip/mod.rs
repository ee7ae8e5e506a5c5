//! The nonlinear oscillator: stick, slip, lift-off and delayed feedback, with exact events.
//!
//! - [`case`]: a motion in physical units, to its outcome
//! - [`cycle`]: motions that begin in uncontrolled stick-slip
//! - [`motion`]: steps from event to event
//! - [`outcome`]: what becomes of a motion
//! - [`step`]: the polynomials of one step
//! - [`series`]: polynomials in time, their first zeros
//! - [`stop`]: a flag that ends motions

pub mod case;
mod collocation;
pub mod cycle;
mod friction_series;
mod graze;
mod history;
pub mod motion;
pub mod outcome;
pub mod series;
pub mod step;
pub mod stop;
mod table_series;
pub mod watch;
