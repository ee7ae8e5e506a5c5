//! The log of a run: one JSON object per line, in a file beside the map.

use std::cell::{Cell, RefCell};
use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant, SystemTime};

use serde::{Deserialize, Serialize};

use super::numbers::representable;
use crate::store::regular;
use crate::sweep::{Event, Observer, Shard};

/// Time between two lines of progress.
const BETWEEN_LINES: Duration = Duration::from_secs(10);

/// The end of a log that tells the start of a run, but where hundreds of files were damaged.
const USUAL_END: u64 = 64 << 10;
/// The most bytes of a log that are read.
const MOST_OF_LOG: u64 = 64 << 20;

/// One line.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LogLine {
    /// When, RFC 3339 in UTC.
    pub time: String,
    /// What happened.
    #[serde(flatten)]
    pub entry: Entry,
}

/// The contents of a line.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "event", rename_all = "snake_case")]
pub enum Entry {
    /// A run starts.
    Started {
        /// The shard, I/N.
        shard: String,
        /// Version of the program.
        program_version: String,
        /// Its process.
        process: u32,
        /// Threads that compute.
        threads: usize,
        /// Cells of the map.
        cells: u64,
        /// Cells that this run has to compute.
        cells_left: u64,
    },
    /// A file of tiles was damaged.
    Damaged {
        /// The file.
        file: String,
        /// What is wrong.
        why: String,
    },
    /// Cells are computed.
    Progress {
        /// Cells that this run has computed so far.
        cells_computed: u64,
        /// Cells that the run has still to compute.
        cells_left: u64,
        /// Average since the start of the run.
        cells_per_second: f64,
    },
    /// Everything that this run had to do is computed.
    Finished {
        /// How many cells that were.
        cells_computed: u64,
        /// How long it took.
        seconds: f64,
    },
    /// The run ended before it was finished.
    Ended {
        /// Why.
        why: String,
        /// How many cells it had computed.
        cells_computed: u64,
    },
}

/// Writes the log of one run. A log that cannot be written does not stop the run.
pub struct Log {
    file: RefCell<Option<File>>,
    shard: Shard,
    start: Cell<Instant>,
    last_line: Cell<Instant>,
    computed: Cell<u64>,
    left: Cell<u64>,
    begun: Cell<bool>,
}

/// The log of a shard of `map`.
#[must_use]
pub fn path(map: &Path, shard: Shard) -> PathBuf {
    let mut name = map.file_name().unwrap_or_default().to_owned();
    if !shard.is_whole() {
        let (number, of) = shard.numbers();
        name.push(format!(".{number}-of-{of}"));
    }
    name.push(".log");
    map.with_file_name(name)
}

/// The start of the last run that a log tells of, and the number of cells that it had to compute;
/// none where no line tells.
pub(crate) fn last_start(log: &Path) -> Option<(SystemTime, u64)> {
    // A file of another kind may be one long line.
    let mut ends = [USUAL_END, MOST_OF_LOG].into_iter();
    ends.find_map(|most| start_in(&regular::end(log, most).ok()?))
}

/// The start of the last run in the lines of the end of a log, which may be cut off in the first of
/// them.
fn start_in(lines: &[u8]) -> Option<(SystemTime, u64)> {
    let mut found = None;
    for line in lines.split(|&byte| byte == b'\n') {
        let Ok(LogLine { time, entry }) = serde_json::from_slice(line) else {
            continue;
        };
        let Ok(time) = humantime::parse_rfc3339(&time) else {
            continue;
        };
        match entry {
            Entry::Started { cells_left, .. } => found = Some((time, cells_left)),
            // Its run started before the lines.
            Entry::Progress {
                cells_computed,
                cells_left,
                cells_per_second,
            } if found.is_none() => {
                let seconds = cells_computed as f64 / cells_per_second;
                let elapsed = Duration::try_from_secs_f64(seconds).ok();
                let start = elapsed.and_then(|elapsed| time.checked_sub(elapsed));
                found = start.map(|start| (start, cells_computed.saturating_add(cells_left)));
            }
            _ => {}
        }
    }
    found
}

impl Log {
    /// A log beside `map`; an existing one is appended to.
    #[must_use]
    pub fn beside(map: &Path, shard: Shard) -> Self {
        let path = path(map, shard);
        Self {
            // A link or a folder with this name is left alone.
            file: RefCell::new(regular::append(&path).ok()),
            shard,
            start: Cell::new(Instant::now()),
            last_line: Cell::new(Instant::now()),
            computed: Cell::new(0),
            left: Cell::new(0),
            begun: Cell::new(false),
        }
    }

    /// Records that the run ended before it was finished.
    pub fn ended(&self, why: &str) {
        // A run that was refused at the start is not logged.
        if !self.begun.get() {
            return;
        }
        self.put(Entry::Ended {
            why: why.to_owned(),
            cells_computed: self.computed.get(),
        });
    }

    fn put(&self, entry: Entry) {
        let line = LogLine {
            time: humantime::format_rfc3339_millis(representable(SystemTime::now())).to_string(),
            entry,
        };
        let mut file = self.file.borrow_mut();
        let text = serde_json::to_string(&line).unwrap_or_default();
        // One write per line, so that two runs do not mix their lines.
        let written = file
            .as_mut()
            .map(|file| file.write_all(format!("{text}\n").as_bytes()));
        if let Some(Err(_)) = written {
            *file = None;
        }
    }

    fn advanced(&self, cells: u64) {
        self.computed.set(self.computed.get() + cells);
        if self.last_line.get().elapsed() < BETWEEN_LINES {
            return;
        }
        self.last_line.set(Instant::now());
        let computed = self.computed.get();
        self.put(Entry::Progress {
            cells_computed: computed,
            cells_left: self.left.get().saturating_sub(computed),
            cells_per_second: computed as f64 / self.start.get().elapsed().as_secs_f64(),
        });
    }
}

impl Observer for Log {
    fn event(&self, event: &Event) {
        match event {
            Event::Damaged { file, why } => self.put(Entry::Damaged {
                file: file.display().to_string(),
                why: why.clone(),
            }),
            Event::Started {
                cells,
                left,
                threads,
            } => {
                self.begun.set(true);
                self.start.set(Instant::now());
                self.computed.set(0);
                self.left.set(*left);
                self.put(Entry::Started {
                    shard: self.shard.to_string(),
                    program_version: crate::VERSION.to_owned(),
                    process: std::process::id(),
                    threads: *threads,
                    cells: *cells,
                    cells_left: *left,
                });
            }
            Event::PieceDone { cells } => self.advanced(*cells),
            Event::Finished => self.put(Entry::Finished {
                cells_computed: self.computed.get(),
                seconds: self.start.get().elapsed().as_secs_f64(),
            }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Lines of a run that started at the second `start` after 12:00 and had 1000 cells to compute.
    fn run(start: u32, lines: u32) -> String {
        let time = |second: u32| format!("2026-01-01T12:{:02}:{:02}Z", second / 60, second % 60);
        let mut text = format!(
            "{{\"time\":\"{}\",\"event\":\"started\",\"shard\":\"1/1\",\"program_version\":\"0\",\
             \"process\":1,\"threads\":1,\"cells\":2000,\"cells_left\":1000}}\n",
            time(start)
        );
        for line in 1..=lines {
            let (time, computed) = (time(start + 10 * line), 5 * line);
            text += &format!(
                "{{\"time\":\"{time}\",\"event\":\"progress\",\"cells_computed\":{computed},\
                 \"cells_left\":{},\"cells_per_second\":0.5}}\n",
                1000 - computed
            );
        }
        text
    }

    #[test]
    fn the_last_start_is_found_in_any_end_of_a_log() {
        let noon = humantime::parse_rfc3339("2026-01-01T12:00:00Z").unwrap();
        let after = |seconds: u64| Some((noon + Duration::from_secs(seconds), 1000));
        let (first, last) = (run(0, 9), run(200, 20));
        let both = format!("{first}{last}");
        for cut in 0..both.len() {
            let end = &both.as_bytes()[cut..];
            // Lines that end before the cut tell nothing.
            let told = match both[cut..].matches('\n').count() {
                0 => unreachable!(),
                1 if !both[cut..].starts_with('{') => None,
                _ => after(200),
            };
            assert_eq!(start_in(end), told, "{cut}");
        }
        assert_eq!(start_in(first.as_bytes()), after(0));
        assert_eq!(start_in(b"\xff\n\n{}\n"), None);
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("map.h5.log");
        assert_eq!(last_start(&path), None);
        // Nothing but the beginning of a long log tells.
        let other = "\u{e9}".repeat(USUAL_END as usize);
        std::fs::write(&path, format!("{}{other}\n", run(7, 0))).unwrap();
        assert_eq!(last_start(&path), after(7));
    }
}
