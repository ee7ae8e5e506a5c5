//! Workers, runs and commands of a queue that are killed, or whose calls of the system fail: nothing
//! that was acknowledged is lost, and every map is what a run alone makes.
//!
//! `SLIPMAP_QUEUE_KILLS=1000` kills more often than the 25 times of the suite.

#![allow(clippy::too_many_lines, reason = "a test tells one story")]

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::Output;
use std::time::{Duration, Instant};

use crate::alone;
use crate::chance::{Chance, asked};
use crate::interposer::interposed;
use crate::map::datasets;
use crate::program::{Folder, Started, ends_within, err, expect, json, out, signal};
use crate::queue_files::left;

/// Sweeps of some pieces, a second or so of work each in all.
fn sweep(number: usize) -> String {
    format!(
        "fields = [\"n_unstable\", \"abscissa\"]\n[axes]\nmu_prime = [-0.5, -0.2]\n\
         alpha_n = {{ from = -3.0, to = 1.0, points = {} }}\n\
         tau = {{ from = 0.05, to = 9.0, points = 400 }}\n",
        41 + number
    )
}

/// A sweep that cannot be computed.
const BAD: &str = "fields = [\"n_unstable\"]\n[axes]\nalpha_w = [1.0]\n";

/// The runs that are there, by the map that they make: their processes.
fn runs(folder: &Path) -> BTreeMap<String, Vec<u32>> {
    let mut found: BTreeMap<String, Vec<u32>> = BTreeMap::new();
    for entry in fs::read_dir("/proc").unwrap().flatten() {
        let Some(id) = entry
            .file_name()
            .to_str()
            .and_then(|name| name.parse().ok())
        else {
            continue;
        };
        let line = fs::read(entry.path().join("cmdline")).unwrap_or_default();
        let line = String::from_utf8_lossy(&line).into_owned();
        let words: Vec<&str> = line.split('\0').collect();
        let here = fs::read_link(entry.path().join("cwd")).is_ok_and(|cwd| cwd == folder);
        if here && words.get(1) == Some(&"run") {
            let map = words.iter().skip_while(|word| **word != "-o").nth(1);
            found
                .entry((*map.unwrap()).to_owned())
                .or_default()
                .push(id);
        }
    }
    found
}

/// What happens to the queue, one thing after the other.
struct Story {
    folder: Folder,
    chance: Chance,
    workers: Vec<Started>,
    /// Sweeps that are still to be submitted, and the jobs of those that were.
    to_come: Vec<usize>,
    acknowledged: BTreeMap<usize, String>,
    kills: u64,
}

impl Story {
    fn worker(&self) -> Started {
        let mut command =
            self.folder
                .command(&["work", "q", "--threads", "1", "--first-pause", "0", "-q"]);
        Started::within(&mut command, 1800)
    }

    /// Kills a worker or a run.
    fn kill(&mut self) {
        self.kills += 1;
        let runs: Vec<u32> = runs(self.folder.path()).into_values().flatten().collect();
        if !runs.is_empty() && self.chance.below(2) == 0 {
            let which = self.chance.below(runs.len() as u64) as usize;
            // It may just have ended.
            let _ = std::panic::catch_unwind(|| signal(runs[which], "-KILL"));
            return;
        }
        let which = self.chance.below(self.workers.len() as u64) as usize;
        self.workers[which].signal("-KILL");
        self.workers[which].wait();
        self.workers[which] = self.worker();
    }

    /// Submits the next sweep; half of the commands are killed and said again.
    fn submit(&mut self) {
        let Some(number) = self.to_come.pop() else {
            return;
        };
        let file = format!("s{number}.toml");
        fs::write(self.folder.path().join(&file), sweep(number)).unwrap();
        let args = ["submit", &file, "--to", "q"];
        if self.chance.below(2) == 0 {
            let mut child = self.folder.start(&args);
            std::thread::sleep(Duration::from_micros(self.chance.below(20_000)));
            if child.goes_on() {
                child.signal("-KILL");
                self.kills += 1;
            }
            let ended = child.ended();
            if !ended.status.success() {
                self.to_come.push(number);
                return;
            }
            self.was_submitted(number, &ended);
            return;
        }
        let ended = self.folder.run(&args);
        expect(&ended, 0, "");
        self.was_submitted(number, &ended);
    }

    fn was_submitted(&mut self, number: usize, said: &Output) {
        let name = out(said).split(':').next().unwrap().to_owned();
        assert!(name.ends_with(&format!("-s{number}")), "{name}");
        assert!(
            !self.acknowledged.values().any(|other| *other == name),
            "{name}"
        );
        self.acknowledged.insert(number, name);
    }

    /// A third process holds, releases, puts first, or renames by hand.
    fn rename(&mut self) {
        let told = json(&self.folder.run(&["jobs", "q", "--json"]));
        let all = told["jobs"].as_array().unwrap();
        let open: Vec<_> = all
            .iter()
            .filter(|job| job["state"] != "done" && job["state"] != "failed")
            .collect();
        if open.is_empty() {
            return;
        }
        let job = open[self.chance.below(open.len() as u64) as usize];
        let name = job["name"].as_str().unwrap().to_owned();
        match (job["state"].as_str().unwrap(), self.chance.below(3)) {
            ("held", _) => drop(self.folder.run(&["jobs", "release", &name, "--in", "q"])),
            (_, 0) => drop(self.folder.run(&["jobs", "hold", &name, "--in", "q"])),
            (_, 1) => drop(self.folder.run(&["jobs", "first", &name, "--in", "q"])),
            _ => {
                let word = name.rsplit('-').next().unwrap();
                let to = format!("{}-{word}.toml", 200_000 + self.chance.below(100_000));
                let queue = self.folder.path().join("q/queue");
                // It may just be done.
                let _ = fs::rename(queue.join(format!("{name}.toml")), queue.join(to));
            }
        }
    }

    /// No map is made by two runs.
    fn look(&self) {
        for (map, processes) in runs(self.folder.path()) {
            assert!(processes.len() < 2, "{map}: {processes:?}");
        }
    }
}

#[test]
fn a_queue_outlasts_kills_of_all_that_work_on_it() {
    let _alone = alone();
    let kills = asked("SLIPMAP_QUEUE_KILLS", 25);
    let sweeps = if kills > 100 { 40 } else { 5 };
    let mut story = Story {
        folder: Folder::new(),
        chance: Chance(asked("SLIPMAP_SEED", 41)),
        workers: Vec::new(),
        to_come: (0..sweeps).rev().collect(),
        acknowledged: BTreeMap::new(),
        kills: 0,
    };
    let path = story.folder.path().canonicalize().unwrap();
    expect(&story.folder.run(&["submit", "--help"]), 0, "Usage");
    for worker in [story.worker(), story.worker()] {
        story.workers.push(worker);
    }
    let bad = sweeps / 4;
    for number in 0..bad {
        let queue = path.join("q/queue");
        crate::processes::until(30, "a queue", || queue.is_dir());
        fs::write(queue.join(format!("3{number:05}-bad.toml")), BAD).unwrap();
    }
    let begun = Instant::now();
    while story.kills < kills || !story.to_come.is_empty() {
        assert!(
            begun.elapsed() < Duration::from_secs(1700),
            "{} kills",
            story.kills
        );
        match story.chance.below(10) {
            0..4 => story.kill(),
            4..7 => story.submit(),
            7..9 => story.rename(),
            _ => {}
        }
        let pause = Duration::from_millis(story.chance.below(700));
        let rested = Instant::now();
        while rested.elapsed() < pause {
            story.look();
            std::thread::sleep(Duration::from_millis(20));
        }
        // New work, so that there is always some.
        if story.to_come.is_empty() && story.kills < kills && story.acknowledged.len() < 400 {
            story.to_come.push(story.acknowledged.len());
        }
    }
    for worker in &mut story.workers {
        worker.signal("-KILL");
        worker.wait();
    }
    // Their runs save what they have and end; until then nobody else may take what they work on.
    crate::processes::until(60, "all runs end", || runs(&path).is_empty());
    let folder = &story.folder;
    for name in fs::read_dir(path.join("q/held")).unwrap() {
        let name = name.unwrap().file_name().into_string().unwrap();
        expect(
            &folder.run(&["jobs", "release", &name, "--in", "q"]),
            0,
            "waits",
        );
    }
    let ended = folder.run(&["work", "q", "--until-empty", "--first-pause", "0", "-q"]);
    assert!(
        matches!(ended.status.code(), Some(0 | 1)),
        "{}",
        err(&ended)
    );
    check(folder, &story.acknowledged, bad);
    println!(
        "{} kills, {} sweeps in {:?}",
        story.kills,
        story.acknowledged.len(),
        begun.elapsed()
    );
}

/// Every sweep that was acknowledged is done, with the datasets of a run alone, and nothing is left.
fn check(folder: &Folder, acknowledged: &BTreeMap<usize, String>, bad: usize) {
    let told = json(&folder.run(&["jobs", "q", "--json"]));
    let mut states: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
    for job in told["jobs"].as_array().unwrap() {
        let names = states.entry(job["state"].as_str().unwrap()).or_default();
        names.push(job["name"].as_str().unwrap());
    }
    assert_eq!(
        states.keys().copied().collect::<Vec<_>>(),
        ["done", "failed"],
        "{states:?}"
    );
    assert_eq!(states["failed"].len(), bad, "{states:?}");
    for number in acknowledged.keys() {
        let word = format!("-s{number}");
        let file = format!("s{number}.toml");
        expect(&folder.run(&["run", &file, "-q"]), 0, "");
        let alone = datasets(&folder.path().join(format!("s{number}.h5")));
        // One that got another name after its map was complete, before its file was gone, is made
        // once more.
        let made: Vec<_> = states["done"]
            .iter()
            .filter(|name| name.ends_with(&word))
            .collect();
        assert!(!made.is_empty(), "{word}: {states:?}");
        for name in made {
            assert!(
                datasets(&folder.path().join(format!("q/{name}.h5"))) == alone,
                "{name}"
            );
        }
    }
    let again = states["done"].len() - acknowledged.len();
    println!("{again} maps were made again under another name");
    assert!(again <= 3 + acknowledged.len() / 10, "{states:?}");
    let beside: Vec<String> = fs::read_dir(folder.path().join("q"))
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .filter(|name| name.contains("tiles") || name.starts_with('.'))
        .collect();
    // Tiles of a run that was killed, of a sweep that then went on under another name: nobody's, and
    // in nobody's way.
    println!("left beside the maps: {beside:?}");
    assert!(beside.len() <= 3 + acknowledged.len() / 20, "{beside:?}");
    assert_eq!(left(folder), [""; 0]);
}

/// Runs a command whose call with this number fails; it is ended after some seconds.
fn faulty(folder: &Folder, args: &[&str], at: u64, kind: &str) -> Output {
    let mut command = interposed(folder, args);
    command
        .env("FAULTS_AT", at.to_string())
        .env("FAULTS_KIND", kind);
    ends_within(&mut command, 4);
    crate::program::output(&mut command)
}

/// The calls of the system that a command makes.
fn calls(folder: &Folder, args: &[&str]) -> u64 {
    let counted = tempfile::tempdir().unwrap();
    let count = counted.path().join("count");
    let mut command = interposed(folder, args);
    expect(
        &crate::program::output(command.env("FAULTS_COUNT", &count)),
        0,
        "",
    );
    fs::read_to_string(&count).unwrap().trim().parse().unwrap()
}

const SUBMIT: [&str; 4] = ["submit", "s.toml", "--to", "q"];
const WORK: [&str; 6] = ["work", "q", "--until-empty", "--threads", "1", "-q"];

fn with_sweep() -> Folder {
    Folder::with(&[("s.toml", &sweep(0))])
}

/// Submitting fails at each of its calls: what was acknowledged is there, and nothing half written.
#[test]
fn every_fault_of_submitting_loses_nothing() {
    let _alone = alone();
    let total = calls(&with_sweep(), &SUBMIT);
    assert!(total > 8, "{total}");
    for kind in ["kill", "eio", "enospc", "eintr"] {
        for at in 1..=total {
            let folder = with_sweep();
            let done = faulty(&folder, &SUBMIT, at, kind);
            let what = format!("{kind} at {at}: {}{}", out(&done), err(&done));
            let queue = folder.path().join("q/queue/100000-s.toml");
            if done.status.success() {
                assert!(out(&done).contains("100000-s: waits"), "{what}");
            }
            match fs::read_to_string(&queue) {
                Ok(text) => assert_eq!(text, sweep(0), "{what}"),
                Err(_) => assert!(!done.status.success(), "{what}"),
            }
            expect(&folder.run(&SUBMIT), 0, "100000-s: ");
            let told = json(&folder.run(&["jobs", "q", "--json"]));
            assert_eq!(told["jobs"].as_array().unwrap().len(), 1, "{what}");
            assert_eq!(left(&folder), ["100000-s.toml"], "{what}");
        }
    }
    println!("{} faults", 4 * total);
}

/// A worker, or its run, fails at some of its calls: the next worker makes the map.
#[test]
fn faults_of_working_lose_nothing() {
    let _alone = alone();
    let original = with_sweep();
    expect(&original.run(&["run", "s.toml", "-q"]), 0, "");
    let alone = datasets(&original.path().join("s.h5"));
    expect(&original.run(&SUBMIT), 0, "waits");
    // The run that it starts counts by itself, and has more.
    let total = calls(&original, &WORK) + 12;
    println!("{total} calls");
    let all = std::env::var("SLIPMAP_FAULTS").is_ok_and(|asked| asked == "all");
    for (kind, step) in [("kill", 2), ("eio", 9), ("enospc", 9), ("eintr", 9)] {
        for at in (1..=total).step_by(if all { 1 } else { step }) {
            let folder = with_sweep();
            expect(&folder.run(&SUBMIT), 0, "waits");
            let done = faulty(&folder, &WORK, at, kind);
            let what = format!("{kind} at {at}: {}{}", out(&done), err(&done));
            let again = folder.run(&["work", "q", "--until-empty", "-q", "--first-pause", "0"]);
            assert!(again.status.success(), "{what}: {}", err(&again));
            let map = folder.path().join("q/100000-s.h5");
            assert!(datasets(&map) == alone, "{what}");
            assert_eq!(left(&folder), [""; 0], "{what}");
        }
    }
}

/// The median time of a command, of five runs, each after some preparation.
fn median(folder: &Folder, args: &[&str], prepare: impl Fn()) -> Duration {
    let timed = |_| {
        prepare();
        let begun = Instant::now();
        expect(&folder.run(args), 0, "");
        begun.elapsed()
    };
    let mut times: Vec<Duration> = (0..5).map(timed).collect();
    times.sort_unstable();
    times[2]
}

/// A worker takes hardly longer than the runs that it starts, and long queues are listed at once.
#[test]
fn a_queue_takes_no_time() {
    let _alone = alone();
    let small = sweep(0).replace("points = 400", "points = 40");
    let folder = Folder::with(&[("s.toml", &small)]);
    let remove = |name: &str| {
        let _ = fs::remove_file(folder.path().join(name));
    };
    let run = median(&folder, &["run", "s.toml", "-q"], || remove("s.h5"));
    let work = median(&folder, &["work", "q", "--until-empty", "-q"], || {
        expect(
            &folder.run(&["submit", "s.toml", "--to", "q", "--again"]),
            0,
            "waits",
        );
    });
    let queue = folder.path().join("q/queue");
    for number in 0..1000 {
        fs::write(queue.join(format!("2{number:05}-s.toml")), sweep(number)).unwrap();
    }
    let listed = median(&folder, &["jobs", "q", "--json"], || {});
    println!("run {run:?}, work {work:?}; 1000 sweeps listed in {listed:?}");
    // Asked for are 0.1 s and 50 ms on a machine that does nothing else.
    assert!(
        work < run + Duration::from_millis(400),
        "{work:?} after {run:?}"
    );
    assert!(listed < Duration::from_millis(400), "{listed:?}");
}
