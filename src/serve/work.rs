//! Computing for requests: on few threads, for a limited time, and no longer than somebody waits.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use axum::http::StatusCode;
use tokio::sync::Semaphore;

use super::problem::Problem;

/// How often it is looked whether the server is to end.
pub(super) const PAUSE: Duration = Duration::from_millis(50);
/// Nothing is computed for longer.
const LONGEST: Duration = Duration::from_secs(20);
/// Requests that wait for a thread, for each of them; more are turned away.
const WAITING: usize = 8;

/// Threads that compute, and who waits for them.
#[derive(Debug, Clone)]
pub(super) struct Work {
    threads: Arc<Semaphore>,
    places: Arc<Semaphore>,
}

/// Tells a computation to stop when nobody waits for it any more.
struct Waited(Arc<AtomicBool>);

impl Drop for Waited {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Relaxed);
    }
}

impl Work {
    pub(super) fn new(threads: usize) -> Self {
        Self {
            threads: Arc::new(Semaphore::new(threads)),
            places: Arc::new(Semaphore::new((1 + WAITING) * threads)),
        }
    }

    /// Computes `what`, which is to look at the flag: it is set once the answer is not wanted any
    /// more.
    pub(super) async fn run<T: Send + 'static>(
        &self,
        what: impl FnOnce(&Arc<AtomicBool>) -> Result<T, Problem> + Send + 'static,
    ) -> Result<T, Problem> {
        let busy = |_| {
            Problem::of(
                StatusCode::SERVICE_UNAVAILABLE,
                "too many requests wait for an answer",
            )
        };
        let place = self.places.clone().try_acquire_owned().map_err(busy)?;
        let ended = |_| Problem::of(StatusCode::SERVICE_UNAVAILABLE, "the server ends");
        let thread = self.threads.clone().acquire_owned().await.map_err(ended)?;
        let stop = Arc::new(AtomicBool::new(false));
        let waited = Waited(Arc::clone(&stop));
        let computing = tokio::task::spawn_blocking(move || {
            let done = what(&stop);
            drop((thread, place));
            done
        });
        let answer = tokio::time::timeout(LONGEST, computing).await;
        drop(waited);
        match answer {
            Ok(Ok(done)) => done,
            Ok(Err(_)) => Err(Problem::of(
                StatusCode::INTERNAL_SERVER_ERROR,
                "the computation failed; this is a fault of slipmap",
            )),
            Err(_) => Err(Problem::of(
                StatusCode::SERVICE_UNAVAILABLE,
                "it takes longer than 20 s: slipmap run has no such limit",
            )),
        }
    }
}
