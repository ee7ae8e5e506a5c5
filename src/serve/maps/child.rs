//! A process that reads one map for the server. A damaged file can end it, but not the server.

use std::io::{BufRead, Write};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use super::frames::{Ask, Frame, Kind, Refused, Request, fits};
use super::{answers, description, traces};
use crate::maps::look::Look;
use crate::store::{StoreError, trace_reader};

/// The most bytes of a request.
const LONGEST_REQUEST: u64 = 1 << 16;

/// What a file is.
enum Contents {
    Map(Look),
    Trace(Box<traces::Opened>),
}

/// The map, or the trace, opened by the first request.
struct Opened {
    path: PathBuf,
    contents: OnceLock<Result<Contents, Refused>>,
    /// Only one window is encoded at a time.
    one: Mutex<()>,
}

/// Answers requests, one per line, until the input ends.
///
/// # Errors
/// When a line cannot be read, or is no request.
pub fn read_map<W: Write + Send + 'static>(
    path: &Path,
    requests: impl BufRead,
    answers: W,
) -> std::io::Result<()> {
    let opened = Arc::new(Opened {
        path: path.to_owned(),
        contents: OnceLock::new(),
        one: Mutex::default(),
    });
    let answers = Arc::new(Mutex::new(answers));
    let mut requests = requests;
    loop {
        let mut line = String::new();
        let mut limited = std::io::Read::take(&mut requests, LONGEST_REQUEST);
        if limited.read_line(&mut line)? == 0 {
            return Ok(());
        }
        let request: Request = serde_json::from_str(&line)?;
        let (opened, answers) = (Arc::clone(&opened), Arc::clone(&answers));
        std::thread::spawn(move || {
            let answered = catch_unwind(AssertUnwindSafe(|| opened.answer(&request.ask)));
            let answered = answered.unwrap_or_else(|_| {
                Err(Refused {
                    status: 500,
                    detail: "the map could not be read; this is a fault of slipmap".into(),
                })
            });
            let (frame, more) = answered.and_then(fitting).unwrap_or_else(|refused| {
                let kind = Kind::Problem;
                let bytes = serde_json::to_vec(&refused).unwrap_or_default();
                (Frame { kind, bytes }, Vec::new())
            });
            let mut out = answers.lock().unwrap_or_else(PoisonError::into_inner);
            // If nobody reads the answers, the requests end too.
            drop(frame.write(&more, request.number, &mut *out));
        });
    }
}

impl Opened {
    fn contents(&self) -> Result<&Contents, Refused> {
        let open = || match Look::open(&self.path) {
            Err(StoreError::NotAMap { .. }) if trace_reader::is_trace(&self.path) => {
                let opened = traces::Opened::of(&self.path);
                opened.map(|trace| Contents::Trace(Box::new(trace)))
            }
            opened => opened.map(Contents::Map),
        };
        let open = || open().map_err(|error| refused(&error));
        self.contents
            .get_or_init(open)
            .as_ref()
            .map_err(Clone::clone)
    }

    /// An answer, in two parts.
    fn answer(&self, ask: &Ask) -> Result<(Frame, Vec<u8>), Refused> {
        let contents = self.contents()?;
        let is_there = match contents {
            Contents::Map(look) => look.refresh().is_ok(),
            Contents::Trace(trace) => trace.is_there(),
        };
        if !is_there {
            return Ok((frame(Kind::OtherMap, Vec::new()), Vec::new()));
        }
        match contents {
            Contents::Map(look) => of_map(look, &self.path, ask, &self.one),
            Contents::Trace(trace) => Ok((of_trace(trace, ask, &self.one)?, Vec::new())),
        }
    }
}

/// An answer about the map at `path`, in two parts. `one` is locked while a window is encoded.
fn of_map(
    look: &Look,
    path: &Path,
    ask: &Ask,
    one: &Mutex<()>,
) -> Result<(Frame, Vec<u8>), Refused> {
    let answer = match ask {
        Ask::Summary => json(&description::summary(look, path))?,
        Ask::Description => json(&description::description(look))?,
        Ask::Cell(query) => json(&answers::cell(look, query)?)?,
        Ask::Sweep => frame(Kind::Text, description::sweep(look).into_bytes()),
        Ask::Curves(query) => frame(Kind::Bytes, answers::curves(look, query)?),
        Ask::Window(query) => {
            let [head, arrays] = answers::window(look, query, one)?;
            return Ok((frame(Kind::Bytes, head), arrays));
        }
        Ask::Motion => return Err(Refused::asked("it is a map: it has cells, and no motion")),
    };
    Ok((answer, Vec::new()))
}

/// An answer about a trace. `one` is locked while its samples are read, which may be many.
fn of_trace(trace: &traces::Opened, ask: &Ask, one: &Mutex<()>) -> Result<Frame, Refused> {
    Ok(match ask {
        Ask::Summary => json(&trace.summary())?,
        Ask::Description => json(&trace.description())?,
        Ask::Sweep => frame(Kind::Text, trace.case().into_bytes()),
        Ask::Motion => {
            let _one = one.lock().unwrap_or_else(PoisonError::into_inner);
            frame(Kind::Bytes, trace.motion()?)
        }
        Ask::Cell(_) | Ask::Curves(_) | Ask::Window(_) => {
            return Err(Refused::asked(
                "it is a trace: it has a motion, and no cells",
            ));
        }
    })
}

/// Checks that an answer is short enough to send.
fn fitting((frame, more): (Frame, Vec<u8>)) -> Result<(Frame, Vec<u8>), Refused> {
    fits(frame.bytes.len() + more.len())?;
    Ok((frame, more))
}

fn frame(kind: Kind, bytes: Vec<u8>) -> Frame {
    Frame { kind, bytes }
}

fn json(value: &impl serde::Serialize) -> Result<Frame, Refused> {
    let bytes = serde_json::to_vec(value).map_err(Refused::damaged)?;
    Ok(frame(Kind::Json, bytes))
}

/// Why a map cannot be opened, without naming its folders.
fn refused(error: &StoreError) -> Refused {
    Refused::damaged(match error {
        StoreError::NotAMap { why, .. } => format!("it is not a map of slipmap: {why}"),
        StoreError::NotATrace { why, .. } => format!("it is a damaged trace of slipmap: {why}"),
        StoreError::InUse { .. } => {
            return Refused::for_now("another program has it open for writing");
        }
        StoreError::Io { action, source, .. } => {
            return Refused::for_now(format!("cannot {action} it: {source}"));
        }
        StoreError::Hdf5 { action, cause, .. } => format!("cannot {action} it: {cause}"),
        StoreError::Manifest { why, .. } => format!("the manifest of its tiles is damaged: {why}"),
        StoreError::OtherTiles { difference, .. } => {
            format!("its tiles are of something else: {difference}")
        }
        StoreError::DamagedMap { why, .. } => {
            format!("it is a damaged map: its bytes have changed, {why}")
        }
        StoreError::DamagedFile { .. } => "it is a damaged HDF5 file".into(),
        StoreError::Foreign { .. } => "something that is not slipmap's is among its tiles".into(),
        other => other.to_string(),
    })
}
