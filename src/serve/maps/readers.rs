//! Which processes read maps: few at a time, those that were asked last.

use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use axum::http::StatusCode;
use tokio::sync::{OwnedSemaphorePermit, Semaphore};

use super::frames::{Ask, Frame, Kind, MOST_PIXELS, Refused, WindowQuery};
use super::list::List;
use super::process::{Reader, ReaderCommand, Trouble};
use super::scan::Found;
use crate::serve::problem::Problem;

/// Maps that are read at a time.
const MOST_READERS: usize = 2;
/// A process that takes longer is ended.
const PATIENCE: Duration = Duration::from_secs(20);
/// Megabytes of windows that are asked for or sent at a time.
const ROOM: u32 = 32;
/// Room is waited for so long.
const FOR_ROOM: Duration = Duration::from_secs(10);
/// Bytes of a pixel at most: a real, its status, and its bits.
const BYTES_OF_PIXEL: usize = 10;
/// How often a map is opened anew that is another one by now.
const MOST_OPENED: usize = 3;

/// The maps below a folder.
#[derive(Debug)]
pub(in crate::serve) struct Maps {
    pub(super) list: Arc<List>,
    command: ReaderCommand,
    /// The one that was asked last comes last.
    readers: Mutex<Vec<(PathBuf, Arc<Reader>)>>,
    /// Megabytes that answers may take.
    room: Arc<Semaphore>,
}

impl Maps {
    /// Those below `folder`.
    pub(in crate::serve) fn below(folder: &Path, command: ReaderCommand) -> Self {
        Self {
            list: Arc::new(List::of(folder, command.clone())),
            command,
            readers: Mutex::default(),
            room: Arc::new(Semaphore::new(ROOM as usize)),
        }
    }

    /// Room for the answer about a window; it is waited for while others are sent.
    pub(super) async fn room(&self, query: &WindowQuery) -> Result<OwnedSemaphorePermit, Problem> {
        let pixels = |asked: Option<usize>| asked.unwrap_or(usize::MAX).min(MOST_PIXELS);
        let height = query.y.as_ref().map_or(1, |_| pixels(query.h));
        let bytes = pixels(query.w) * height * BYTES_OF_PIXEL;
        let needed = (1 + (bytes >> 20) as u32).min(ROOM);
        let room = Arc::clone(&self.room).acquire_many_owned(needed);
        match tokio::time::timeout(FOR_ROOM, room).await {
            Ok(Ok(room)) => Ok(room),
            _ => Err(problem(Trouble::Busy)),
        }
    }

    /// What the process that reads a map answers.
    pub(super) async fn ask(&self, found: &Found, ask: &Ask) -> Result<Frame, Problem> {
        if let Some(odd) = found.odd {
            return Err(damaged(odd));
        }
        for _ in 0..MOST_OPENED {
            let reader = self.reader(&found.path).map_err(problem)?;
            let frame = match reader.ask(ask.clone(), PATIENCE).await {
                Ok(frame) => frame,
                Err(trouble) => {
                    self.forget(&reader);
                    return Err(problem(trouble));
                }
            };
            match frame.kind {
                Kind::OtherMap => self.forget(&reader),
                Kind::Problem => {
                    let refused = refused(&frame);
                    if refused.status >= 500 {
                        // The file may be another one the next time.
                        self.forget(&reader);
                    }
                    return Err(refused.into());
                }
                _ => return Ok(frame),
            }
        }
        let detail = "the map changes all the time";
        Err(Problem::of(StatusCode::SERVICE_UNAVAILABLE, detail))
    }

    /// The process that reads the map at `path`.
    fn reader(&self, path: &Path) -> Result<Arc<Reader>, Trouble> {
        let mut readers = self.readers.lock().unwrap_or_else(PoisonError::into_inner);
        readers.retain(|(_, reader)| !reader.has_ended());
        if let Some(place) = readers.iter().position(|(of, _)| of == path) {
            let known = readers.remove(place);
            let reader = Arc::clone(&known.1);
            readers.push(known);
            return Ok(reader);
        }
        if readers.len() >= MOST_READERS {
            readers.remove(0);
        }
        let reader = Arc::new(Reader::start(&self.command, path)?);
        readers.push((path.to_owned(), Arc::clone(&reader)));
        Ok(reader)
    }

    fn forget(&self, reader: &Arc<Reader>) {
        let mut readers = self.readers.lock().unwrap_or_else(PoisonError::into_inner);
        readers.retain(|(_, other)| !Arc::ptr_eq(other, reader));
    }
}

/// What a process says why it does not answer.
pub(super) fn refused(frame: &Frame) -> Refused {
    serde_json::from_slice(&frame.bytes).unwrap_or_else(|_| Refused::damaged("it cannot be read"))
}

fn damaged(why: &str) -> Problem {
    Problem::of(
        StatusCode::BAD_GATEWAY,
        format!("the map cannot be read: {why}"),
    )
}

impl From<Refused> for Problem {
    fn from(refused: Refused) -> Self {
        match StatusCode::from_u16(refused.status) {
            Ok(StatusCode::BAD_GATEWAY) => damaged(&refused.detail),
            Ok(status) => Self::of(status, refused.detail),
            Err(_) => Self::of(StatusCode::INTERNAL_SERVER_ERROR, refused.detail),
        }
    }
}

fn problem(trouble: Trouble) -> Problem {
    match trouble {
        Trouble::NotStarted => Problem::of(
            StatusCode::SERVICE_UNAVAILABLE,
            "the process that reads maps could not be started",
        ),
        Trouble::Ended => damaged("the process that read it ended; the file may be damaged"),
        Trouble::TooLong => Problem::of(
            StatusCode::GATEWAY_TIMEOUT,
            "the process that read the map took too long and was ended",
        ),
        Trouble::Busy => Problem::of(
            StatusCode::SERVICE_UNAVAILABLE,
            "too many requests wait for this map",
        ),
        Trouble::LongRequest => Problem::of(StatusCode::URI_TOO_LONG, "the request is too long"),
    }
}
