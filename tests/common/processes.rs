//! The processes of a server, as the system tells of them.

#![allow(dead_code, reason = "no test uses all of it")]

use std::fs;
use std::time::{Duration, Instant};

/// The number behind a name in what the system tells of a process.
fn told(id: u32, name: &str) -> Option<u64> {
    let status = fs::read_to_string(format!("/proc/{id}/status")).ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix(name))?;
    line.split_whitespace().next()?.parse().ok()
}

/// The processes that `parent` has started and that are there.
pub(crate) fn children(parent: u32) -> Vec<u32> {
    let all = fs::read_dir("/proc").unwrap().flatten();
    let ids = all.filter_map(|entry| entry.file_name().to_str()?.parse::<u32>().ok());
    ids.filter(|&id| told(id, "PPid:") == Some(parent.into()))
        .collect()
}

/// The most memory that a process had, MB.
pub(crate) fn peak(id: u32) -> u64 {
    told(id, "VmHWM:").unwrap_or(0) / 1024
}

/// The time that the processors have spent on a process, and the system for it.
pub(crate) fn cpu(id: u32) -> Duration {
    let told = fs::read_to_string(format!("/proc/{id}/stat")).unwrap();
    // The name of a program, in brackets, may have blanks.
    let mut words = told.rsplit_once(") ").unwrap().1.split(' ').skip(11);
    let mut ticks = || words.next().unwrap().parse::<u64>().unwrap();
    Duration::from_millis(10 * (ticks() + ticks()))
}

/// Waits until something is so, for so many seconds.
#[track_caller]
pub(crate) fn until(patience: u64, what: &str, mut is_so: impl FnMut() -> bool) {
    let begun = Instant::now();
    while !is_so() {
        assert!(begun.elapsed() < Duration::from_secs(patience), "{what}");
        std::thread::sleep(Duration::from_millis(10));
    }
}

/// Whether a process is there, and not only still to be asked how it ended.
pub(crate) fn is_there(id: u32) -> bool {
    let status = fs::read_to_string(format!("/proc/{id}/status"));
    status.is_ok_and(|status| !status.contains("State:\tZ"))
}
