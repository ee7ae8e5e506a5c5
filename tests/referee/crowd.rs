//! Many questions over threads: what agrees is counted, what does not is printed.

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

use super::against::Verdict;

/// How many verdicts there were of each kind.
#[derive(Debug, Default)]
pub(crate) struct Tally {
    /// Questions, and things compared in them.
    pub asked: usize,
    pub compared: usize,
    /// The referee's answer hangs on its steps, all or in part.
    pub knife_edges: usize,
    pub undecided: usize,
    /// How to ask again where answers differ.
    pub differ: Vec<String>,
}

impl Tally {
    fn add(&mut self, verdict: Verdict) {
        self.asked += 1;
        match verdict {
            Verdict::Agree(n) => self.compared += n,
            Verdict::KnifeEdge(n) => {
                self.compared += n;
                self.knife_edges += 1;
            }
            Verdict::Undecided => self.undecided += 1,
            Verdict::Differ(how) => {
                println!("{how}\n");
                self.differ.push(how);
            }
        }
    }

    fn tell(&self, what: &str, total: usize) {
        let differ = self.differ.len();
        println!(
            "{what}: {} of {total} asked, {} compared, {} on a knife edge, {} undecided, \
             {differ} differ",
            self.asked, self.compared, self.knife_edges, self.undecided
        );
    }
}

/// Puts the questions 0 to `total` − 1, and says how far it is ten times.
pub(crate) fn ask(what: &str, total: usize, question: impl Fn(usize) -> Verdict + Sync) -> Tally {
    let tally = Mutex::new(Tally::default());
    let next = AtomicUsize::new(0);
    let work = || {
        loop {
            let number = next.fetch_add(1, Ordering::Relaxed);
            if number >= total {
                return;
            }
            let verdict = question(number);
            let mut tally = tally.lock().expect("no thread has panicked");
            tally.add(verdict);
            if tally.asked % total.div_ceil(10) == 0 {
                tally.tell(what, total);
            }
        }
    };
    thread::scope(|scope| {
        for _ in 0..thread::available_parallelism().map_or(1, usize::from) {
            scope.spawn(work);
        }
    });
    let tally = tally.into_inner().expect("no thread has panicked");
    tally.tell(what, total);
    tally
}
