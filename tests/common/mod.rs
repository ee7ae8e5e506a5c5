//! Helpers that several test programs share.

pub(crate) mod cases;
pub(crate) mod winding;
