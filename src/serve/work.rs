//! Computes for requests: on few threads, for a limited time, and only while a client waits.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use axum::http::StatusCode;
use tokio::sync::Semaphore;

use super::problem::Problem;

/// How often it is checked whether the server is to end.
pub(super) const PAUSE: Duration = Duration::from_millis(50);
/// The longest computation.
const LONGEST: Duration = Duration::from_secs(20);
/// The most requests that wait, per thread; more are refused.
const WAITING: usize = 8;

/// The computing threads, and the places of waiting requests.
#[derive(Debug, Clone)]
pub(super) struct Work {
    threads: Arc<Semaphore>,
    places: Arc<Semaphore>,
}

/// When dropped, it tells a computation to stop: nobody waits for it any more.
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

    /// Runs the computation `what`. It must check the flag that it gets, which is set once its
    /// answer is not wanted any more.
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
