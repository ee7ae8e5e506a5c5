//! The server's side of a process that reads a map.

use std::collections::{HashMap, HashSet};
use std::io::{BufReader, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use tokio::sync::{Notify, OwnedSemaphorePermit, oneshot};

use super::frames::{Ask, Frame, Request};

/// The most requests that wait for one process. A pipe has room for them, so writing never blocks.
const MOST_WAITING: usize = 16;
/// The longest request.
const LONGEST_REQUEST: usize = 3000;

/// How to start a process that reads a map: a program and its arguments, followed by the path.
#[derive(Debug, Clone)]
pub struct ReaderCommand {
    /// The program.
    pub program: std::path::PathBuf,
    /// The arguments.
    pub arguments: Vec<String>,
}

/// The place of a process. It stays taken until the system has ended the process, even if that
/// takes long.
#[derive(Debug)]
pub(super) struct Place {
    permit: Option<OwnedSemaphorePermit>,
    path: PathBuf,
    held: Held,
    freed: Arc<Notify>,
}

/// The files of the processes that the system has not ended yet.
#[derive(Debug, Clone, Default)]
pub(super) struct Held(Arc<Mutex<HashSet<PathBuf>>>);

impl Held {
    /// A place for a process that reads `path`; none while there is still one. A file on which
    /// processes hang must not take the places of others. Waiting requests are signalled when the
    /// place is free.
    pub(super) fn place(
        &self,
        path: &Path,
        permit: OwnedSemaphorePermit,
        freed: &Arc<Notify>,
    ) -> Option<Place> {
        let first = locked(&self.0).insert(path.to_owned());
        first.then(|| Place {
            permit: Some(permit),
            path: path.to_owned(),
            held: self.clone(),
            freed: Arc::clone(freed),
        })
    }
}

impl Drop for Place {
    fn drop(&mut self) {
        locked(&self.held.0).remove(&self.path);
        self.permit.take();
        self.freed.notify_waiters();
    }
}

/// Why there is no answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Trouble {
    /// The process could not be started.
    NotStarted,
    /// It ended before it answered.
    Ended,
    /// It took too long and was ended.
    TooLong,
    /// Too many requests wait already.
    Busy,
    /// Every place for a process is taken by other maps.
    NoPlace,
    /// The request is too long.
    LongRequest,
}

#[derive(Debug, Default)]
struct Waiting {
    answers: HashMap<u64, oneshot::Sender<Frame>>,
    number: u64,
    ended: bool,
}

/// A process, until a thread waits for its end.
type Running = Arc<Mutex<Option<Child>>>;

/// A process that reads a map. It ends when this is dropped.
#[derive(Debug)]
pub(super) struct Reader {
    child: Running,
    requests: Mutex<ChildStdin>,
    waiting: Arc<Mutex<Waiting>>,
}

fn locked<T>(of: &Mutex<T>) -> MutexGuard<'_, T> {
    of.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Reader {
    /// Starts a process for the map at `path`; the system may take long for this.
    pub(super) fn start(
        command: &ReaderCommand,
        path: &Path,
        place: Place,
    ) -> Result<Self, Trouble> {
        let mut child = Command::new(&command.program)
            .args(&command.arguments)
            .arg(path)
            // The GNU library would keep freed memory, separately for each thread.
            .envs([
                ("MALLOC_ARENA_MAX", "2"),
                ("MALLOC_MMAP_THRESHOLD_", "4194304"),
            ])
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .map_err(|_| Trouble::NotStarted)?;
        let (Some(requests), Some(answers)) = (child.stdin.take(), child.stdout.take()) else {
            return Err(Trouble::NotStarted);
        };
        let child = Arc::new(Mutex::new(Some(child)));
        let waiting = Arc::new(Mutex::new(Waiting::default()));
        let reader = Self {
            child: Arc::clone(&child),
            requests: Mutex::new(requests),
            waiting,
        };
        let (of_thread, waiting) = (Arc::clone(&child), Arc::clone(&reader.waiting));
        // If no thread can be started, the process is waited for here and keeps its place until
        // then.
        let place = Arc::new(Mutex::new(Some(place)));
        let kept = Arc::clone(&place);
        let listening = std::thread::Builder::new().stack_size(1 << 17);
        let listening = listening.spawn(move || {
            listen(answers, &waiting);
            wait_for(&of_thread);
            drop(locked(&kept).take());
        });
        if listening.is_err() {
            wait_for(&child);
            return Err(Trouble::NotStarted);
        }
        Ok(reader)
    }

    /// Whether the process has ended.
    pub(super) fn has_ended(&self) -> bool {
        locked(&self.waiting).ended
    }

    /// Tells the process to end. The listening thread waits until it has.
    fn end(&self) {
        if let Some(child) = &mut *locked(&self.child) {
            drop(child.kill());
        }
    }

    /// Asks the process. If it does not answer within `patience`, it is ended.
    pub(super) async fn ask(&self, ask: Ask, patience: Duration) -> Result<Frame, Trouble> {
        let answer = self.send(ask)?;
        match tokio::time::timeout(patience, answer).await {
            Ok(Ok(frame)) => Ok(frame),
            Ok(Err(_)) => Err(Trouble::Ended),
            Err(_) => {
                self.end();
                Err(Trouble::TooLong)
            }
        }
    }

    fn send(&self, ask: Ask) -> Result<oneshot::Receiver<Frame>, Trouble> {
        let (sender, receiver) = oneshot::channel();
        let number = {
            let mut waiting = locked(&self.waiting);
            if waiting.ended {
                return Err(Trouble::Ended);
            }
            if waiting.answers.len() >= MOST_WAITING {
                return Err(Trouble::Busy);
            }
            waiting.number += 1;
            let number = waiting.number;
            waiting.answers.insert(number, sender);
            number
        };
        let line = serde_json::to_string(&Request { number, ask }).unwrap_or_default() + "\n";
        let forget = |trouble| {
            locked(&self.waiting).answers.remove(&number);
            Err(trouble)
        };
        if line.len() > LONGEST_REQUEST {
            return forget(Trouble::LongRequest);
        }
        match locked(&self.requests).write_all(line.as_bytes()) {
            Ok(()) => Ok(receiver),
            Err(_) => forget(Trouble::Ended),
        }
    }
}

impl Drop for Reader {
    fn drop(&mut self) {
        self.end();
    }
}

/// Waits, without holding a lock, until a process that sends no more has ended.
fn wait_for(child: &Running) {
    let child = locked(child).take();
    if let Some(mut child) = child {
        drop(child.kill());
        drop(child.wait());
    }
}

/// Passes answers to those who wait for them, until there are no more.
fn listen(answers: ChildStdout, waiting: &Mutex<Waiting>) {
    let mut answers = BufReader::with_capacity(1 << 16, answers);
    while let Ok((number, frame)) = Frame::read(&mut answers) {
        if let Some(asker) = locked(waiting).answers.remove(&number) {
            // If nobody waits any more, the answer is dropped.
            drop(asker.send(frame));
        }
    }
    let mut waiting = locked(waiting);
    waiting.ended = true;
    waiting.answers.clear();
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_has_one_place_until_its_process_has_ended() {
        let (places, freed) = (Arc::new(tokio::sync::Semaphore::new(2)), Arc::default());
        let (held, path) = (Held::default(), Path::new("map.h5"));
        let permit = || Arc::clone(&places).try_acquire_owned().unwrap();
        let first = held.place(path, permit(), &freed);
        assert!(first.is_some());
        assert!(held.place(path, permit(), &freed).is_none());
        assert_eq!(places.available_permits(), 1, "the other one is given back");
        assert!(
            held.place(Path::new("other.h5"), permit(), &freed)
                .is_some()
        );
        drop(first);
        assert!(held.place(path, permit(), &freed).is_some());
        assert_eq!(places.available_permits(), 2);
    }
}
