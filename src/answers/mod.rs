//! Answers about one setting, in its own units.
//!
//! - `basin`: the share of starts that end in sliding, with its error: points of a scrambled Sobol
//!   sequence, followed and counted
//! - `best`: best settings in physical units, the ranges searched by default
//! - `best_delay`: the delay at which the best setting over two parameters is best
//! - `best_of_samples`: best settings of a digital loop
//! - `drawn_laws`: the laws that a fit allows, and for which of them a setting is stable
//! - `margins`: margins of a setting, in its own units
//! - `measure`: friction measured through control, at one v0 of an experiment
//! - `reached`: whether a motion reaches sliding by a time
//! - `robust`: the best setting that stands errors of gain, delay and μ′
//! - `robust_to_fit`: the setting that is most robust against the errors of a fit
//! - `search_plane`: what is searched for best settings
//! - `samples`: the samples of a motion, refused or thinned where there are too many
//! - `sobol`: points of a scrambled Sobol sequence; the only file that imports sobol_burley
//! - `system_margins`: margins of a system from a file
//! - `tally`: how many starts had which outcome, and shares of them
//! - `trace`: a motion sampled over time, with its events
//! - `trace_error`: why there is no trace of a motion
//! - `vc`: the critical velocity of a setting by either protocol, the regime of a working velocity,
//!   and the check by simulation

pub mod basin;
pub mod best;
pub mod best_delay;
mod best_of_samples;
pub mod drawn_laws;
pub mod margins;
pub mod measure;
pub mod reached;
mod robust;
pub mod robust_to_fit;
pub mod samples;
pub mod search_plane;
mod sobol;
pub mod system_margins;
mod tally;
pub mod trace;
mod trace_error;
pub mod vc;

pub use trace::Trace;
