//! What is asked of slipmap at a point or in a plane, and answered at once: plain data in, plain
//! data out. The command line, the server and a page without a server share it.
//!
//! - [`chart`]: cells and curves of a sweep, computed into memory within limits; [`chart_bytes`]:
//!   the same as bytes, laid out as in [`encoded`]
//! - [`point`]: linear stability at a point, with its roots
//! - [`vc`]: the critical velocity at a point
//! - [`motion`]: one motion in time
//!
//! Numbers that there are not are `null` in JSON, infinities among them.

pub mod chart;
pub mod chart_bytes;
pub mod encoded;
pub mod motion;
pub mod point;
pub mod vc;

/// A number that JSON can tell.
fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}
