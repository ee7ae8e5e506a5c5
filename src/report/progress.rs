//! Progress of a sweep: a bar on a terminal, plain lines elsewhere.

use std::cell::Cell;
use std::io::Write;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressState, ProgressStyle};

use super::log::Log;
use super::numbers::{grouped, prefixed, seconds};
use super::visible::visible_line;
use crate::sweep::{Event, Observer};

/// Time between two plain lines.
const BETWEEN_LINES: Duration = Duration::from_secs(10);

/// Shows the events of a sweep on standard error.
pub struct Progress {
    bar: ProgressBar,
    /// The time when computing began.
    start: Cell<Instant>,
    cells: Cell<u64>,
    /// Cells that were left at the start.
    left: Cell<u64>,
    done: Cell<u64>,
    last_line: Cell<Instant>,
    quiet: bool,
}

impl Progress {
    /// Progress on standard error; `quiet` shows nothing.
    #[must_use]
    pub fn new(quiet: bool) -> Self {
        let bar = if quiet {
            ProgressBar::hidden()
        } else {
            ProgressBar::new(0)
        };
        Self {
            bar,
            start: Cell::new(Instant::now()),
            cells: Cell::new(0),
            left: Cell::new(0),
            done: Cell::new(0),
            last_line: Cell::new(Instant::now()),
            quiet,
        }
    }

    /// Seconds since the computing began.
    #[must_use]
    pub fn elapsed(&self) -> f64 {
        self.start.get().elapsed().as_secs_f64()
    }

    /// Cells that this run has computed.
    #[must_use]
    pub fn computed(&self) -> u64 {
        self.done.get()
    }

    /// Removes the bar from the terminal.
    pub fn clear(&self) {
        self.bar.finish_and_clear();
    }

    fn line(&self, text: &str) {
        let text = visible_line(text);
        if self.quiet {
        } else if self.bar.is_hidden() {
            let _ = writeln!(std::io::stderr(), "{text}");
        } else {
            self.bar.println(text);
        }
    }

    fn started(&self, cells: u64, left: u64, threads: usize) {
        self.cells.set(cells);
        self.left.set(left);
        self.done.set(0);
        self.start.set(Instant::now());
        self.bar.set_length(cells);
        self.bar.set_style(style());
        self.bar.set_position(cells - left);
        self.bar.reset_eta();
        let threads = match threads {
            1 => "1 thread".into(),
            n => format!("{n} threads"),
        };
        let cells_told = grouped(cells);
        self.line(&match left == cells {
            true => format!("{cells_told} cells on {threads}"),
            false => format!("{cells_told} cells, {} left, on {threads}", grouped(left)),
        });
    }

    fn advanced(&self, cells: u64) {
        self.done.set(self.done.get() + cells);
        self.bar.inc(cells);
        if self.bar.is_hidden() && self.last_line.get().elapsed() >= BETWEEN_LINES {
            self.last_line.set(Instant::now());
            let rate = self.done.get() as f64 / self.start.get().elapsed().as_secs_f64();
            let left = self.left.get().saturating_sub(self.done.get());
            self.line(&told(self.cells.get(), left, rate));
        }
    }
}

/// How far a run is that computes `rate` cells in a second.
fn told(cells: u64, left: u64, rate: f64) -> String {
    let share = 100.0 * (1.0 - left as f64 / cells.max(1) as f64);
    // Pieces without cells come first.
    match rate > 0.0 {
        true => {
            let time = seconds(left as f64 / rate);
            format!("{share:.1} %, {} cells/s, {time} left", prefixed(rate))
        }
        false => format!("{share:.1} %, time left unknown"),
    }
}

fn style() -> ProgressStyle {
    let left = |state: &ProgressState, out: &mut dyn std::fmt::Write| {
        let _ = write!(out, "{}", seconds(state.eta().as_secs_f64()));
    };
    let rate = |state: &ProgressState, out: &mut dyn std::fmt::Write| {
        let _ = write!(out, "{} cells/s", prefixed(state.per_sec()));
    };
    ProgressStyle::with_template("{bar:40} {percent:>3} %  {rate}  {time} left")
        .unwrap_or_else(|_| ProgressStyle::default_bar())
        .with_key("rate", rate)
        .with_key("time", left)
}

impl Observer for Progress {
    fn event(&self, event: &Event) {
        match event {
            Event::Damaged { file, why } => self.line(&format!(
                "warning: {}: {why}; what of it is lost is made again",
                file.display()
            )),
            Event::Started {
                cells,
                left,
                threads,
            } => self.started(*cells, *left, *threads),
            Event::PieceDone { cells } => self.advanced(*cells),
            Event::Finished => self.clear(),
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
