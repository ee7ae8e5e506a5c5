//! Computes for requests: for a limited time, and only while a client waits. What is quick does not
//! wait for what is slow.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use axum::http::StatusCode;
use tokio::sync::{OwnedSemaphorePermit, Semaphore, oneshot};
use tokio::time::{Instant, timeout, timeout_at};

use super::problem::Problem;

/// How often it is checked whether the server is to end.
pub(super) const PAUSE: Duration = Duration::from_millis(50);
/// The longest computation.
const LONGEST: Duration = Duration::from_secs(20);
/// What is quick and takes longer than this lets others begin beside it.
const QUICK: Duration = Duration::from_millis(200);
/// The most requests that wait, per thread; more are refused.
const WAITING: usize = 8;
/// How much threads of slow computations stand back, in steps of the system.
#[cfg(target_os = "linux")]
const STEPS_BACK: std::ffi::c_int = 5;

/// How long computations of a kind usually take.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Pace {
    /// Less than what anybody notices.
    Quick,
    /// Up to many seconds.
    Slow,
}

/// The computing threads, and the places of waiting requests: of each pace its own.
#[derive(Debug, Clone)]
pub(super) struct Work {
    quick: Lane,
    slow: Lane,
}

#[derive(Debug, Clone)]
struct Lane {
    pace: Pace,
    threads: Arc<Semaphore>,
    places: Arc<Semaphore>,
}

/// A request whose computation may begin.
#[derive(Debug)]
pub(super) struct Turn {
    pace: Pace,
    thread: OwnedSemaphorePermit,
    place: OwnedSemaphorePermit,
}

/// When dropped, it tells a computation to stop: nobody waits for it any more.
struct Waited(Arc<AtomicBool>);

impl Drop for Waited {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Relaxed);
    }
}

impl Work {
    /// Work on so many threads for each pace.
    pub(super) fn new(threads: usize) -> Self {
        let lane = |pace| Lane {
            pace,
            threads: Arc::new(Semaphore::new(threads)),
            places: Arc::new(Semaphore::new(most(threads))),
        };
        Self {
            quick: lane(Pace::Quick),
            slow: lane(Pace::Slow),
        }
    }

    /// Waits until a computation may begin.
    pub(super) async fn turn(&self, pace: Pace) -> Result<Turn, Problem> {
        let lane = match pace {
            Pace::Quick => &self.quick,
            Pace::Slow => &self.slow,
        };
        let unavailable = |detail: &str| Problem::of(StatusCode::SERVICE_UNAVAILABLE, detail);
        let place = Arc::clone(&lane.places).try_acquire_owned();
        let place = place.map_err(|_| unavailable("too many requests wait for an answer"))?;
        let thread = Arc::clone(&lane.threads).acquire_owned().await;
        let thread = thread.map_err(|_| unavailable("the server ends"))?;
        Ok(Turn {
            pace: lane.pace,
            thread,
            place,
        })
    }
}

/// The most quick computations that may have begun; as many slow ones.
pub(super) const fn most(threads: usize) -> usize {
    (1 + WAITING) * threads
}

impl Turn {
    /// Runs the computation `what`. It must check the flag that it gets, which is set once its
    /// answer is not wanted any more.
    pub(super) async fn run<T: Send + 'static>(
        self,
        what: impl FnOnce(&Arc<AtomicBool>) -> Result<T, Problem> + Send + 'static,
    ) -> Result<T, Problem> {
        let stop = Arc::new(AtomicBool::new(false));
        let _waited = Waited(Arc::clone(&stop));
        let Self {
            pace,
            thread,
            place,
        } = self;
        // The thread of what is slow is taken until it has stopped.
        let (waited_for, kept) = match pace {
            Pace::Quick => (Some(thread), None),
            Pace::Slow => (None, Some(thread)),
        };
        let until = Instant::now() + LONGEST;
        let mut computing = start(pace, move || {
            let done = what(&stop);
            drop((kept, place));
            done
        })?;
        let quick = timeout(QUICK, &mut computing).await;
        drop(waited_for);
        let answer = match quick {
            Ok(answer) => Ok(answer),
            Err(_) => timeout_at(until, computing).await,
        };
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

/// Begins a computation on another thread; its result is sent from there.
fn start<T: Send + 'static>(
    pace: Pace,
    what: impl FnOnce() -> T + Send + 'static,
) -> Result<oneshot::Receiver<T>, Problem> {
    let (sender, receiver) = oneshot::channel();
    // If nobody waits for the result any more, it is dropped.
    let work = move || drop(sender.send(what()));
    match pace {
        Pace::Quick => drop(tokio::task::spawn_blocking(work)),
        // A thread that has stood back cannot step forward, so no other work comes to it.
        Pace::Slow => drop(
            std::thread::Builder::new()
                .spawn(move || {
                    stand_back();
                    work();
                })
                .map_err(|_| {
                    let detail = "the system gives no thread for this now";
                    Problem::of(StatusCode::SERVICE_UNAVAILABLE, detail)
                })?,
        ),
    }
    Ok(receiver)
}

/// Lets other threads go first from now on. If the system refuses, all are equal.
fn stand_back() {
    #[cfg(target_os = "linux")]
    // SAFETY: no memory is passed. On Linux it is about the calling thread alone.
    unsafe {
        libc::nice(STEPS_BACK);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn running<T>(what: impl Future<Output = T>) -> T {
        let runtime = tokio::runtime::Builder::new_multi_thread();
        let runtime = { runtime }.worker_threads(2).enable_all().build();
        runtime.unwrap().block_on(what)
    }

    /// Begins a computation that goes on until its client has gone or `end` is set.
    async fn begin(work: &Work, pace: Pace, end: &Arc<AtomicBool>) -> tokio::task::JoinHandle<()> {
        let (turn, end) = (work.turn(pace).await.unwrap(), Arc::clone(end));
        tokio::spawn(async move {
            let done = turn.run(move |stop| {
                while !stop.load(Ordering::Relaxed) && !end.load(Ordering::Relaxed) {
                    std::thread::sleep(Duration::from_millis(1));
                }
                Ok(())
            });
            drop(done.await);
        })
    }

    #[test]
    fn what_is_quick_does_not_wait_for_what_is_slow() {
        running(async {
            let (work, end) = (Work::new(2), Arc::new(AtomicBool::new(false)));
            let mut slow = Vec::new();
            for _ in 0..2 {
                slow.push(begin(&work, Pace::Slow, &end).await);
            }
            let third = timeout(3 * QUICK, work.turn(Pace::Slow));
            assert!(third.await.is_err(), "there are two threads for those");
            let quick = timeout(QUICK, work.turn(Pace::Quick)).await.unwrap();
            assert_eq!(quick.unwrap().run(|_| Ok(7)).await, Ok(7));
            // The client of one has gone: the next one begins.
            slow.remove(0).abort();
            assert!(timeout(QUICK, work.turn(Pace::Slow)).await.is_ok());
            end.store(true, Ordering::Relaxed);
        });
    }

    #[test]
    fn what_should_be_quick_and_is_not_lets_others_begin() {
        running(async {
            let (work, end) = (Work::new(1), Arc::new(AtomicBool::new(false)));
            let first = begin(&work, Pace::Quick, &end).await;
            assert!(timeout(QUICK / 4, work.turn(Pace::Quick)).await.is_err());
            let next = timeout(10 * QUICK, work.turn(Pace::Quick)).await.unwrap();
            assert_eq!(next.unwrap().run(|_| Ok(7)).await, Ok(7));
            assert!(!first.is_finished());
            end.store(true, Ordering::Relaxed);
        });
    }

    #[test]
    fn who_comes_when_too_many_wait_is_refused() {
        running(async {
            let (work, end) = (Work::new(1), Arc::new(AtomicBool::new(false)));
            let _first = begin(&work, Pace::Slow, &end).await;
            let waiting: Vec<_> = (0..WAITING)
                .map(|_| {
                    let work = work.clone();
                    tokio::spawn(async move { drop(work.turn(Pace::Slow).await) })
                })
                .collect();
            tokio::time::sleep(QUICK).await;
            let refused = work.turn(Pace::Slow).await.unwrap_err();
            assert_eq!(refused.status, 503);
            assert!(work.turn(Pace::Quick).await.is_ok());
            for other in waiting {
                other.abort();
            }
            tokio::time::sleep(QUICK).await;
            assert_eq!(work.slow.places.available_permits(), WAITING);
            end.store(true, Ordering::Relaxed);
        });
    }

    /// The threads of what is slow have the rank that they are to have, and others keep theirs.
    #[cfg(target_os = "linux")]
    #[test]
    fn slow_threads_stand_back() {
        // The rank is the 19th word; the second one, in brackets, may have blanks.
        let rank = || -> i64 {
            let told = std::fs::read_to_string("/proc/thread-self/stat").unwrap();
            let words = told.rsplit_once(") ").unwrap().1;
            words.split(' ').nth(16).unwrap().parse().unwrap()
        };
        let own = rank();
        running(async {
            let work = Work::new(1);
            for (pace, back) in [(Pace::Slow, STEPS_BACK.into()), (Pace::Quick, 0)] {
                let found = work
                    .turn(pace)
                    .await
                    .unwrap()
                    .run(move |_| Ok(rank()))
                    .await;
                assert_eq!(found.unwrap(), (own + back).min(19), "{pace:?}");
            }
        });
        assert_eq!(rank(), own);
    }

    #[test]
    fn a_computation_that_fails_is_told() {
        running(async {
            let work = Work::new(1);
            for pace in [Pace::Quick, Pace::Slow] {
                let turn = work.turn(pace).await.unwrap();
                let failed = turn.run(|_| -> Result<(), Problem> { panic!("as a fault would") });
                assert_eq!(failed.await.unwrap_err().status, 500);
                assert!(timeout(QUICK, work.turn(pace)).await.is_ok());
            }
        });
    }
}
