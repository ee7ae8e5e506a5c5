//! Requests about a point or a plane that are answered at once: plain data in, plain data out. The
//! command line, the server and the page without a server share them.
//!
//! - [`chart`]: cells and curves of a sweep, computed into memory within limits; [`chart_bytes`]:
//!   the same as bytes, laid out as in [`encoded`]
//! - [`point`]: linear stability at a point of the block or of a system from a file, with its
//!   roots: [`stability`] of its linear model; [`stable_line`]: its stable delays and latencies;
//!   [`along_delay`]: over its delays
//! - [`margin_kind`]: whether a distance to a change of stability is finite, infinite or unknown
//! - [`margins`]: how far a point is from the boundary of stability; [`margin_range`]: the ends
//!   of margins; [`margin_crossings`]: the frequencies that they come from
//! - [`vc`]: the critical velocity at a point
//! - [`basin`]: the share of starts from which control ends in sliding
//! - [`comparison`]: control by the return map beside delayed feedback; [`route`]: how low v0 may
//!   become under either
//! - [`best`]: the settings of fastest decay, with all about the recommended one; [`robust`]: what
//!   it is to stand; [`best_answer`]: the same as plain data
//! - [`measure`]: an experiment that measures friction through control, at all of its v0
//! - [`loop_response`]: the loop of a point over the frequency
//! - [`motion`]: one motion in time; [`motion_bytes`]: the same as bytes
//! - [`response`]: the response of a system in time
//! - [`law`]: a friction law as a curve
//! - [`given_setting`]: what a file says of a setting
//! - [`known`]: all parameters, friction laws and fields; [`systems`]: the systems in the place of
//!   the block
//! - [`mod@answer`]: all of these by the names of requests; [`problem`]: the reply where there is
//!   no answer
//!
//! Numbers that are missing or not known are NaN; these and infinities are `null` in JSON.
//!
//! - `answer`: every request by its name, with its answer as bytes: common to the server and the
//!   page without one
//! - `wasm`: the same as a WebAssembly module without imports

pub mod along_delay;
pub mod answer;
pub mod basin;
pub mod best;
pub mod best_answer;
pub mod chart;
pub mod chart_bytes;
pub mod comparison;
pub mod encoded;
pub mod given_setting;
pub mod known;
pub mod law;
pub mod loop_response;
pub mod margin_crossings;
pub mod margin_kind;
pub mod margin_range;
pub mod margins;
pub mod measure;
pub mod motion;
pub mod motion_bytes;
pub mod point;
pub mod problem;
pub mod response;
pub mod robust;
pub mod route;
pub mod stability;
pub mod stable_line;
pub mod systems;
pub mod vc;
#[cfg(all(feature = "wasm", target_family = "wasm"))]
pub mod wasm;

pub use answer::{Asked, Limits, Request, answer};
pub use problem::Problem;
