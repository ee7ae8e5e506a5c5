//! The nonlinear oscillator: stick, slip, lift-off and delayed feedback, with exact events.
//!
//! - [`motion`]: steps from event to event
//! - [`series`]: polynomials in time, their first zeros

mod friction_series;
mod history;
pub mod motion;
pub mod series;
