//! Requests about maps, passed to the processes that read them.

use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

use axum::http::StatusCode;
use tokio::sync::Semaphore;

use super::frames::{Ask, Frame, Kind, MOST_PIXELS, Refused, WindowQuery};
use super::list::List;
use super::places::Places;
use super::process::{ReaderCommand, Trouble};
use super::visiting::Visiting;
use crate::explore::motion;
use crate::maps::scan::Found;
use crate::serve::problem::Problem;
use crate::serve::room::{Room, Taken};

/// A process that takes longer is ended.
const PATIENCE: Duration = Duration::from_secs(20);
/// Megabytes for all windows and curves that are requested or being sent.
const ROOM: u32 = 32;
/// The most files that are sent at a time.
const MOST_SENT: usize = 32;
/// Bytes for the curves of a plane, unless there are very many.
const BYTES_OF_CURVES: u64 = 8 << 20;
/// The most bytes of a pixel: a real, its status, its bits, and why it shows no value.
const BYTES_OF_PIXEL: usize = 11;
/// How often a map is opened again after another one has taken its place.
const MOST_OPENED: usize = 3;

/// The maps below a folder.
#[derive(Debug)]
pub(in crate::serve) struct Maps {
    pub(super) list: Arc<List>,
    pub(super) visiting: Visiting,
    places: Arc<Places>,
    room: Room,
    /// Files that are sent.
    pub(super) sending: Arc<Semaphore>,
}

impl Maps {
    /// The maps below `folder`.
    pub(in crate::serve) fn below(folder: &Path, command: ReaderCommand) -> Self {
        Self {
            list: Arc::new(List::of(folder, command.clone())),
            visiting: Visiting::default(),
            places: Places::of(command),
            room: Room::of(ROOM),
            sending: Arc::new(Semaphore::new(MOST_SENT)),
        }
    }

    /// The state of all files, as a number that changes with it.
    pub(in crate::serve) async fn fingerprint(&self) -> u64 {
        self.list.fingerprint().await
    }

    /// The name of a complete map in the folder itself by the hash of its plan, if there is one.
    pub(in crate::serve) async fn of_plan(&self, hash: &str) -> Result<Option<String>, Problem> {
        let found = self.list.of_plan(hash).await;
        found.ok_or_else(|| {
            let detail = "the maps of the folder cannot be read in time";
            Problem::of(StatusCode::SERVICE_UNAVAILABLE, detail)
        })
    }

    /// Lets maps go that only visit: the server ends.
    pub(in crate::serve) fn close(&self) {
        self.visiting.close();
    }

    /// Takes room for the answer about a window, waiting while others are sent.
    pub(super) async fn room(&self, query: &WindowQuery) -> Result<Taken, Problem> {
        let pixels = |asked: Option<usize>| asked.unwrap_or(usize::MAX).min(MOST_PIXELS);
        let height = query.y.as_ref().map_or(1, |_| pixels(query.h));
        let bytes = pixels(query.w) * height * BYTES_OF_PIXEL;
        self.room.take(bytes as u64).await
    }

    /// Takes room for the curves of a plane.
    pub(super) async fn room_for_curves(&self) -> Result<Taken, Problem> {
        self.room.take(BYTES_OF_CURVES).await
    }

    /// Takes room for the motion of a trace.
    pub(super) async fn room_for_motion(&self) -> Result<Taken, Problem> {
        self.room.take(motion::Limits::default().bytes()).await
    }

    /// The answer of the process that reads a map.
    pub(super) async fn ask(&self, found: &Found, ask: &Ask) -> Result<Frame, Problem> {
        if let Some(odd) = found.odd {
            return Err(damaged(odd));
        }
        for _ in 0..MOST_OPENED {
            let used = self.places.reader(&found.path).await.map_err(problem)?;
            let reader = &used.reader;
            let frame = match reader.ask(ask.clone(), PATIENCE).await {
                Ok(frame) => frame,
                Err(trouble) => {
                    if matches!(trouble, Trouble::Ended | Trouble::TooLong) {
                        self.places.forget(reader);
                    }
                    return Err(problem(trouble));
                }
            };
            match frame.kind {
                Kind::OtherMap => self.places.forget(reader),
                Kind::Problem => {
                    let refused = refused(&frame);
                    if refused.status >= 500 {
                        // The file may have been replaced by the next request.
                        self.places.forget(reader);
                    }
                    return Err(refused.into());
                }
                _ => {
                    self.list.was_read(&found.id);
                    return Ok(frame);
                }
            }
        }
        let detail = "the map changes all the time";
        Err(Problem::of(StatusCode::SERVICE_UNAVAILABLE, detail))
    }
}

/// The refusal in an answer.
pub(super) fn refused(frame: &Frame) -> Refused {
    serde_json::from_slice(&frame.bytes).unwrap_or_else(|_| Refused::damaged("it cannot be read"))
}

/// The answer about a map that is not in the list.
pub(super) fn no_map() -> Problem {
    Problem::of(StatusCode::NOT_FOUND, "there is no map of this id")
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
        Trouble::NoPlace => Problem::of(
            StatusCode::SERVICE_UNAVAILABLE,
            "too many other maps are being read",
        ),
        Trouble::LongRequest => Problem::of(StatusCode::URI_TOO_LONG, "the request is too long"),
    }
}

#[cfg(all(test, unix))]
mod tests {
    use std::fs;
    use std::time::Instant;

    use super::super::described::MapEntry;
    use super::super::test_reader::{self, hang};
    use super::*;

    fn running<T>(what: impl Future<Output = T>) -> T {
        let runtime = tokio::runtime::Builder::new_multi_thread();
        let runtime = { runtime }.worker_threads(2).enable_all().build();
        runtime.unwrap().block_on(what)
    }

    async fn entry(maps: &Maps) -> MapEntry {
        maps.list.all().await.maps.remove(0)
    }

    /// A file that could not be read for a while is not listed as damaged, and is listed as a map
    /// again once it can be read.
    #[test]
    fn what_took_too_long_is_forgotten_once_the_map_answers() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.h5");
        fs::write(&path, "held").unwrap();
        let maps = Maps::below(folder.path(), test_reader::command());
        running(async {
            let held = hang(&path);
            let begun = Instant::now();
            while entry(&maps).await.state == "unknown" {
                assert!(begun.elapsed() < Duration::from_secs(20));
            }
            let told = entry(&maps).await;
            assert_eq!(told.state, "unread");
            assert_eq!(told.why.unwrap(), "reading it took longer than 5 s");
            drop(held);
            let found = maps.list.find(&told.id).await.unwrap();
            maps.ask(&found, &Ask::Description).await.unwrap();
            // At once, long before the next try is due.
            assert_eq!(entry(&maps).await.state, "complete");
        });
    }

    /// A request is refused when too many wait, and the process continues.
    #[test]
    fn a_busy_process_is_kept() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.h5");
        fs::write(&path, "held").unwrap();
        let maps = Arc::new(Maps::below(folder.path(), test_reader::command()));
        running(async {
            let id = entry(&maps).await.id;
            let found = maps.list.find(&id).await.unwrap();
            maps.ask(&found, &Ask::Description).await.unwrap();
            let started = test_reader::started(&path);
            let held = hang(&path);
            let asking = (0..20).map(|_| {
                let (maps, found) = (Arc::clone(&maps), found.clone());
                tokio::spawn(async move { maps.ask(&found, &Ask::Description).await })
            });
            let asking: Vec<_> = asking.collect();
            tokio::time::sleep(Duration::from_millis(500)).await;
            let at = "a".repeat(5000);
            let long = Ask::Cell(super::super::frames::CellQuery { at });
            drop(held);
            let mut turned_away = 0;
            for asked in asking {
                turned_away += match asked.await.unwrap() {
                    Ok(_) => 0,
                    Err(problem) => {
                        assert_eq!(problem.status, 503);
                        1
                    }
                };
            }
            assert_eq!(turned_away, 4);
            assert_eq!(maps.ask(&found, &long).await.unwrap_err().status, 414);
            maps.ask(&found, &Ask::Description).await.unwrap();
            assert_eq!(
                test_reader::started(&path),
                started,
                "the process is the same"
            );
        });
    }
}
