//! What answers need.

use std::sync::Arc;

use super::access::Access;
use super::room::Room;
use super::work::Work;

/// What all answers share.
#[derive(Debug, Clone)]
pub(super) struct Served {
    /// Who may ask.
    pub access: Arc<Access>,
    /// What computes.
    pub work: Work,
    /// Memory for what is computed.
    pub room: Room,
}
