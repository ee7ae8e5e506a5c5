//! The watcher that looks for all streams, as long as there is one.

use std::sync::Arc;
use std::time::{Duration, Instant};

use axum::body::Body;

use super::Jobs;
use super::events::Seen;
use crate::serve::problem::Problem;

/// The time between two looks, and how much longer than a look itself it is at least.
const BETWEEN_LOOKS: Duration = Duration::from_secs(1);
const LONGER_THAN_A_LOOK: u32 = 10;

impl Jobs {
    /// A stream of events for a client that has got the event of the id `last`.
    pub(super) fn stream(self: &Arc<Self>, last: Option<&str>) -> Result<Body, Problem> {
        let watch = || drop(tokio::spawn(Arc::clone(self).watch()));
        self.events.stream(last, watch)
    }

    /// Looks again and again, until nobody streams any more.
    async fn watch(self: Arc<Self>) {
        loop {
            let begun = Instant::now();
            let jobs = self.looking.now().await.ok();
            self.events.looked(Seen {
                jobs: jobs.map(|now| now.fingerprint()),
                maps: Some(self.maps.fingerprint().await),
            });
            let pause = BETWEEN_LOOKS.max(begun.elapsed() * LONGER_THAN_A_LOOK);
            self.events.pause(pause).await;
            if self.events.ends() {
                return;
            }
        }
    }
}
