//! The log of a run: one JSON object per line, in a file beside the map.

use std::cell::{Cell, RefCell};
use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant, SystemTime};

use serde::{Deserialize, Serialize};

use super::numbers::representable;
use super::progress::Progress;
use crate::store::regular;
use crate::sweep::{Event, Observer, Shard};

/// Time between two lines of progress.
const BETWEEN_LINES: Duration = Duration::from_secs(10);

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

/// Sends events both to the terminal and to the log.
pub struct Both<'a>(pub &'a Progress, pub &'a Log);

impl Observer for Both<'_> {
    fn event(&self, event: &Event) {
        self.0.event(event);
        self.1.event(event);
    }
}
