//! The nonlinear oscillator: stick, slip, lift-off and delayed feedback, with exact events.
//!
//! - [`case`]: a motion in physical units, to its outcome
//! - [`cycle`]: motions that begin in uncontrolled stick-slip
//! - [`motion`]: steps from event to event
//! - [`outcome`]: what becomes of a motion
//! - [`sliding`]: linear stability of sliding
//! - [`step`]: the polynomials of one step
//! - [`series`]: polynomials in time, their first zeros
//! - `collocation`: the second integrator: a step from values of the friction law, no series
//! - `friction_series`: the friction force of each law as a polynomial in time
//! - `graze`: minima of ẋ in a step, and the minimum that a stop cut off
//! - `history`: the elongation over the last delays, and its kinks
//! - `table_series`: the friction force of a table, cubic by cubic, and where the speed leaves one
//! - `watch`: follows a motion until its outcome is known

pub mod case;
mod collocation;
pub mod cycle;
mod friction_series;
mod graze;
mod history;
pub mod motion;
pub mod outcome;
pub mod series;
pub mod sliding;
pub mod step;
mod table_series;
pub mod watch;
