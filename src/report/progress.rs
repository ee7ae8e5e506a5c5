//! Progress of a sweep: a bar on a terminal, plain lines elsewhere.

use std::cell::Cell;
use std::io::Write;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressState, ProgressStyle};

use super::numbers::{grouped, prefixed, seconds};
use crate::sweep::{Event, Observer};

/// Time between two plain lines.
const BETWEEN_LINES: Duration = Duration::from_secs(10);

/// Shows the events of a sweep on standard error.
pub struct Progress {
    bar: ProgressBar,
    start: Instant,
    cells: Cell<u64>,
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
            start: Instant::now(),
            cells: Cell::new(0),
            done: Cell::new(0),
            last_line: Cell::new(Instant::now()),
            quiet,
        }
    }

    /// Seconds since the start.
    #[must_use]
    pub fn elapsed(&self) -> f64 {
        self.start.elapsed().as_secs_f64()
    }

    /// Takes the bar off the terminal.
    pub fn clear(&self) {
        self.bar.finish_and_clear();
    }

    fn line(&self, text: &str) {
        if self.quiet {
        } else if self.bar.is_hidden() {
            let _ = writeln!(std::io::stderr(), "{text}");
        } else {
            self.bar.println(text);
        }
    }

    fn started(&self, cells: u64, threads: usize) {
        self.cells.set(cells);
        self.bar.set_length(cells);
        self.bar.set_style(style());
        let threads = match threads {
            1 => "1 thread".into(),
            n => format!("{n} threads"),
        };
        self.line(&format!("{} cells on {threads}", grouped(cells)));
    }

    fn advanced(&self, cells: u64) {
        self.done.set(self.done.get() + cells);
        self.bar.inc(cells);
        if self.bar.is_hidden() && self.last_line.get().elapsed() >= BETWEEN_LINES {
            self.last_line.set(Instant::now());
            let rate = self.done.get() as f64 / self.elapsed();
            let left = (self.cells.get() - self.done.get()) as f64 / rate;
            self.line(&format!(
                "{:.1} %, {} cells/s, {} left",
                100.0 * self.done.get() as f64 / self.cells.get() as f64,
                prefixed(rate),
                seconds(left),
            ));
        }
    }
}

fn style() -> ProgressStyle {
    let rate = |state: &ProgressState, out: &mut dyn std::fmt::Write| {
        let _ = write!(out, "{} cells/s", prefixed(state.per_sec()));
    };
    ProgressStyle::with_template("{bar:40} {percent:>3} %  {rate}  {eta} left")
        .unwrap_or_else(|_| ProgressStyle::default_bar())
        .with_key("rate", rate)
}

impl Observer for Progress {
    fn event(&self, event: &Event) {
        match event {
            Event::Started { cells, threads } => self.started(*cells, *threads),
            Event::BoundariesTraced {
                pieces,
                corners,
                planes_left_out,
            } => {
                self.line(&format!(
                    "{} crossing curves, {} corners",
                    grouped(*pieces),
                    grouped(*corners)
                ));
                if *planes_left_out > 0 {
                    self.line(&format!(
                        "warning: no curves in {} planes, where there are too many to trace",
                        grouped(*planes_left_out)
                    ));
                }
            }
            Event::BestFound { planes: 1 } => self.line("the best setting"),
            Event::BestFound { planes } => {
                self.line(&format!("best settings in {} planes", grouped(*planes)));
            }
            Event::TileDone { cells } => self.advanced(*cells),
            Event::Finished => self.clear(),
        }
    }
}
