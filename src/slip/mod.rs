//! The nonlinear oscillator: stick, slip, lift-off and delayed feedback, with exact events.
//!
//! - [`averaging`]: the mean of the elongation over a time, as a sensor reads it
//! - [`case`]: a motion in physical units, to its outcome
//! - `case_checks`: what a case has to be, and the return map that a record tells it
//! - [`cycle`]: motions that begin in uncontrolled stick-slip
//! - [`forces`]: the forces on the block in a state
//! - [`motion`]: steps from event to event
//! - [`outcome`]: what becomes of a motion
//! - [`programme`]: the pulling velocity in time, in steps and ramps
//! - `sliding`: linear stability of sliding
//! - [`speeds`]: the speeds that a motion reaches
//! - [`step`]: the polynomials of one step
//! - `collocation`: the second integrator: a step from values of the friction law, no series
//! - `graze`: minima of ẋ in a step, and the minimum that a stop cut off
//! - `history`: the elongation over the last delays, and its kinks
//! - `readings`: readings of a digital loop, and the signal made of them
//! - [`record`]: the return map, reconstructed from a record near sliding
//! - `return_map`: control by the return map: the load at each reading
//! - `steady`: when a motion whose readings are held has come to what it goes on as
//! - `watch`: follows a motion until its outcome is known

pub mod averaging;
pub mod case;
mod case_checks;
mod collocation;
pub mod cycle;
pub mod forces;
mod graze;
mod history;
pub mod motion;
pub mod outcome;
pub mod programme;
pub(crate) mod readings;
pub mod record;
mod return_map;
pub mod sliding;
pub mod speeds;
mod steady;
pub mod step;
pub mod watch;
