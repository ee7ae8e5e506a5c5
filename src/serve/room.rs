//! Memory for answers: taken before they are computed, given back when they are sent.

use std::sync::Arc;
use std::time::Duration;

use axum::body::Bytes;
use axum::http::StatusCode;
use axum::http::header::CONTENT_TYPE;
use axum::response::{IntoResponse, Response};
use tokio::sync::{OwnedSemaphorePermit, Semaphore};

use super::problem::Problem;

/// The longest wait for room.
const LONGEST: Duration = Duration::from_secs(10);
/// Answers up to this size need no room: every connection may send one at a time.
const SMALL: u64 = 1 << 16;
/// The unit in which room is counted.
const UNIT: u64 = 1 << 20;

/// Memory that some answers share.
#[derive(Debug, Clone)]
pub(super) struct Room {
    all: Arc<Semaphore>,
    units: u32,
    patience: Duration,
}

impl Room {
    /// Room of `units` megabytes.
    pub(super) fn of(units: u32) -> Self {
        Self {
            all: Arc::new(Semaphore::new(units as usize)),
            units,
            patience: LONGEST,
        }
    }

    /// Waits for `bytes` of room and takes it; at most all of the room.
    pub(super) async fn take(&self, bytes: u64) -> Result<Taken, Problem> {
        let all = Arc::clone(&self.all);
        let room = all.acquire_many_owned(self.needed(bytes));
        match tokio::time::timeout(self.patience, room).await {
            Ok(Ok(room)) => Ok(Taken(room)),
            _ => Err(Problem::of(
                StatusCode::SERVICE_UNAVAILABLE,
                "too many large answers are computed or sent",
            )),
        }
    }

    fn needed(&self, bytes: u64) -> u32 {
        u32::try_from(units(bytes)).map_or(self.units, |n| n.min(self.units))
    }
}

/// A place among so many, once one is free; `full` says what is too much where none is for long.
pub(super) async fn place(
    places: &Arc<Semaphore>,
    full: &str,
) -> Result<OwnedSemaphorePermit, Problem> {
    let place = Arc::clone(places).acquire_owned();
    match tokio::time::timeout(LONGEST, place).await {
        Ok(Ok(place)) => Ok(place),
        _ => Err(Problem::of(StatusCode::SERVICE_UNAVAILABLE, full)),
    }
}

/// The units of room that `bytes` take.
fn units(bytes: u64) -> u64 {
    match bytes {
        0..=SMALL => 0,
        _ => bytes.div_ceil(UNIT),
    }
}

/// Room that is taken.
#[derive(Debug)]
pub(super) struct Taken(OwnedSemaphorePermit);

impl Taken {
    /// The answer for which room was taken. It keeps the room that it needs until it is sent.
    pub(super) fn send(mut self, kind: &'static str, bytes: Vec<u8>) -> Response {
        let kept = units(bytes.len() as u64) as usize;
        let besides = self.0.num_permits().saturating_sub(kept);
        drop(self.0.split(besides));
        let body = Bytes::from_owner(Sent { bytes, _room: self });
        ([(CONTENT_TYPE, kind)], body).into_response()
    }
}

/// An answer that keeps its room until its last byte is sent.
struct Sent {
    bytes: Vec<u8>,
    _room: Taken,
}

impl AsRef<[u8]> for Sent {
    fn as_ref(&self) -> &[u8] {
        &self.bytes
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn room_is_given_back_when_it_is_sent() {
        let runtime = tokio::runtime::Builder::new_current_thread();
        let runtime = { runtime }.enable_time().build();
        runtime.unwrap().block_on(async {
            let patience = Duration::from_millis(20);
            let room = Room {
                patience,
                ..Room::of(8)
            };
            let large = room.take(100 << 20).await.unwrap();
            assert_eq!(room.all.available_permits(), 0);
            let refused = room.take(SMALL + 1).await.unwrap_err();
            assert_eq!(refused.status, 503);
            assert!(room.take(SMALL).await.is_ok(), "small ones need none");
            let response = large.send("text/plain", vec![7; 3 << 20]);
            assert_eq!(room.all.available_permits(), 5);
            drop(response);
            assert_eq!(room.all.available_permits(), 8);
        });
    }
}
