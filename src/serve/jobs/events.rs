//! What has changed, as streams of server-sent events.

use std::io;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use axum::body::{Body, Bytes};
use axum::http::StatusCode;
use tokio::sync::{Notify, OwnedSemaphorePermit, Semaphore, watch};
use tokio::time::timeout;

use crate::serve::access::random;
use crate::serve::problem::Problem;
use crate::serve::streamed::{Part, streamed};

/// The most streams.
const MOST_STREAMS: usize = 256;
/// The time after which something is sent though nothing has changed: a client that has gone is
/// noticed by it.
const HEARTBEAT: Duration = Duration::from_secs(5);
/// What a stream begins with: the milliseconds after which a broken one is asked for again.
const BEGIN: &str = "retry: 2000\n\n";
const STILL_THERE: &[u8] = b": nothing new\n\n";

/// How often the jobs and the maps have changed, as far as it was seen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
struct Revisions {
    jobs: u64,
    maps: u64,
}

/// The state of the jobs and of the maps, as numbers that change with it; none where it could not
/// be looked at.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Seen {
    pub jobs: Option<u64>,
    pub maps: Option<u64>,
}

/// The streams, and what is sent to them.
#[derive(Debug)]
pub(super) struct Events {
    /// Tells the events of this server from those of another one at the same address.
    server: String,
    revisions: watch::Sender<Revisions>,
    streams: Arc<Semaphore>,
    /// Whether somebody looks for them.
    watched: Mutex<bool>,
    seen: Mutex<Seen>,
    soon: Notify,
}

impl Events {
    /// # Errors
    /// When the system gives no random numbers.
    pub(super) fn new() -> io::Result<Self> {
        Ok(Self {
            server: random(4)?,
            revisions: watch::Sender::new(Revisions { jobs: 1, maps: 1 }),
            streams: Arc::new(Semaphore::new(MOST_STREAMS)),
            watched: Mutex::default(),
            seen: Mutex::default(),
            soon: Notify::new(),
        })
    }

    /// The revisions that a client has, by the id of the last event that it got.
    fn known(&self, last: &str) -> Option<Revisions> {
        let rest = last.strip_prefix(&self.server)?.strip_prefix('-')?;
        let (jobs, maps) = rest.split_once('-')?;
        let (jobs, maps) = (jobs.parse().ok()?, maps.parse().ok()?);
        Some(Revisions { jobs, maps })
    }

    /// A stream for a client that has got the event of the id `last`. Where nobody looks yet,
    /// `watch` begins to.
    pub(super) fn stream(&self, last: Option<&str>, watch: impl FnOnce()) -> Result<Body, Problem> {
        let mut watched = self.watched.lock().unwrap_or_else(PoisonError::into_inner);
        let place = Arc::clone(&self.streams).try_acquire_owned();
        let place = place.map_err(|_| {
            let detail = format!("{MOST_STREAMS} clients are told what changes already");
            Problem::of(StatusCode::SERVICE_UNAVAILABLE, detail)
        })?;
        if !*watched {
            *watched = true;
            watch();
        }
        drop(watched);
        let stream = Stream {
            server: self.server.clone(),
            begun: false,
            sent: last.and_then(|last| self.known(last)).unwrap_or_default(),
            revisions: self.revisions.subscribe(),
            _place: place,
        };
        Ok(streamed(stream, Stream::next))
    }

    /// Whether nobody streams any more; then the watcher ends.
    pub(super) fn ends(&self) -> bool {
        let mut watched = self.watched.lock().unwrap_or_else(PoisonError::into_inner);
        *watched = self.streams.available_permits() < MOST_STREAMS;
        !*watched
    }

    /// Has the watcher look now.
    pub(super) fn look_soon(&self) {
        self.soon.notify_one();
    }

    /// Waits until the watcher is to look, for this time at most.
    pub(super) async fn pause(&self, most: Duration) {
        // When it is woken, somebody has just changed something.
        drop(timeout(most, self.soon.notified()).await);
    }

    /// Tells all streams what has changed. What cannot be looked at now has not.
    pub(super) fn looked(&self, now: Seen) {
        let mut seen = self.seen.lock().unwrap_or_else(PoisonError::into_inner);
        let changed = |now: Option<u64>, before: Option<u64>| now.is_some() && now != before;
        let new_jobs = changed(now.jobs, seen.jobs);
        let new_maps = changed(now.maps, seen.maps);
        *seen = Seen {
            jobs: now.jobs.or(seen.jobs),
            maps: now.maps.or(seen.maps),
        };
        self.revisions.send_if_modified(|revisions| {
            revisions.jobs += u64::from(new_jobs);
            revisions.maps += u64::from(new_maps);
            new_jobs || new_maps
        });
    }
}

/// One stream.
struct Stream {
    server: String,
    begun: bool,
    /// What its client has.
    sent: Revisions,
    revisions: watch::Receiver<Revisions>,
    _place: OwnedSemaphorePermit,
}

impl Stream {
    /// What is sent next, once there is something.
    async fn next(mut self) -> Part<Self> {
        loop {
            let now = *self.revisions.borrow_and_update();
            let news = self.news(now);
            if !news.is_empty() {
                return Ok(Some((news.into(), self)));
            }
            match timeout(HEARTBEAT, self.revisions.changed()).await {
                Ok(Ok(())) => {}
                Ok(Err(_)) => return Ok(None),
                Err(_) => return Ok(Some((Bytes::from_static(STILL_THERE), self))),
            }
        }
    }

    /// What the client does not have yet, as text.
    fn news(&mut self, now: Revisions) -> String {
        let mut text = String::new();
        if !self.begun {
            self.begun = true;
            text += BEGIN;
        }
        if self.sent.jobs != now.jobs {
            self.sent.jobs = now.jobs;
            text += &self.event("jobs", now.jobs);
        }
        if self.sent.maps != now.maps {
            self.sent.maps = now.maps;
            text += &self.event("maps", now.maps);
        }
        text
    }

    /// An event. Its id tells all that the client has after it.
    fn event(&self, of: &str, revision: u64) -> String {
        let Revisions { jobs, maps } = self.sent;
        let id = format!("{}-{jobs}-{maps}", self.server);
        format!("event: {of}\nid: {id}\ndata: {{\"revision\":{revision}}}\n\n")
    }
}
