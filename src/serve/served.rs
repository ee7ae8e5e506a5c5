//! The state that all answers share.

use std::sync::Arc;

use super::access::Access;
use super::room::Room;
use super::work::Work;

/// The state that all answers share.
#[derive(Debug, Clone)]
pub(super) struct Served {
    /// Who may use the server.
    pub access: Arc<Access>,
    /// The computing threads.
    pub work: Work,
    /// Memory for quick answers.
    pub room: Room,
    /// Memory for slow answers.
    pub slow_room: Room,
}
