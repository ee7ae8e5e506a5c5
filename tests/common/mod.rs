//! Helpers that several test programs share.

pub mod cases;
pub mod winding;
