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

pub mod elementary;
mod error;
pub mod friction;
mod friction_ranges;
mod groups;
pub mod known_cases;
mod oscillator;
pub mod table;

pub use error::{ModelError, Shown};
pub use friction::FrictionLaw;
pub use groups::Groups;
pub use oscillator::{Control, Oscillator, SlidingPoint};
pub use table::Table;
