//! How much memory commands take at most: what `--memory` promises, of maps of many curves and of
//! long delays.
//!
//! `SLIPMAP_MEMORY=all` asks for every command over the shipped sweeps, a map of 10⁹ cells and
//! 4,000 planes of curves as well.

use std::process::{Command, Stdio};
use std::time::Duration;

use crate::limited::{self, End};
use crate::program::{self, Folder, LONGEST, ends_within, expect};

/// The longest that a command takes, the map of 10⁹ cells included.
const PATIENCE: Duration = Duration::from_secs(3600);
/// What a run is allowed here, and what any other command takes at most, in 10⁶ bytes.
const PROMISED: u64 = 500;
/// The flag that allows a run as much.
const ALLOWED: &str = "--memory=500MB";

/// Curves in so many planes, some with too many to trace; few cells.
fn slopes(planes: u32) -> String {
    format!(
        "fields = [\"n_unstable\"]\nboundaries = true\n[axes]\n\
         mu_prime = {{ from = -2.0, to = 0.5, points = {planes} }}\n\
         alpha_v = {{ from = -2.0, to = 2.0, points = 11 }}\n\
         tau = {{ from = 0.1, to = 600.0, points = 3 }}\n[fixed]\nmu_k = 0.5\n"
    )
}

/// Cells of a night.
const BILLION: &str = "fields = [\"n_unstable\"]\n[axes]\n\
    mu_prime = { from = -1.0, to = 0.0, points = 1000 }\n\
    alpha_v = { from = -2.0, to = 2.0, points = 1000 }\n\
    tau = { from = 0.1, to = 10.0, points = 1000 }\n";

/// As many degrees of stability as a sweep may ask for.
const DEGREES: &str = "fields = [\"n_unstable\"]\nboundaries = true\n\
    degree_of_stability = [0.01, 0.02, 0.03, 0.04, 0.05, 0.06, 0.07, 0.08, \
    0.09, 0.1, 0.11, 0.12, 0.13, 0.14, 0.15, 0.16]\n[axes]\n\
    mu_prime = { from = -0.5, to = 0.1, points = 3 }\n\
    alpha_n = { from = -3.0, to = 1.0, points = 41 }\n\
    tau = { from = 0.1, to = 60.0, points = 41 }\n";

/// As many points along an axis as there may be.
const LONG_AXIS: &str = "fields = [\"n_unstable\"]\n[axes]\n\
    tau = { from = 0.1, to = 10.0, points = 10000000 }\n[fixed]\nmu_prime = -0.1\nalpha_v = -0.2\n";

/// Delays of 10⁷ units of time.
const LONG_DELAYS: &str = "fields = [\"vc\"]\n[axes]\nalpha_v = [0.00165272, 0.0016]\ntau = [6280.74, 6281.0]\n\
    [friction]\nlaw = \"coulomb\"\nmu0 = 0.455747\n\
    [fixed]\nalpha_n = 1.00052\nmass = 0.0833612\nstiffness = 258318.0\n";

/// A command's largest resident memory, in 10⁶ bytes. It has to succeed.
#[expect(
    clippy::zombie_processes,
    reason = "wait4 waits, and tells the memory as well"
)]
fn peak(mut command: Command) -> u64 {
    command.stdout(Stdio::null()).stdin(Stdio::null());
    let child = ends_within(&mut command, LONGEST).spawn().unwrap();
    let (end, bytes) = limited::wait(child.id() as libc::pid_t, PATIENCE);
    assert_eq!(end, End::Code(0), "{command:?}");
    bytes / 1_000_000
}

fn write(folder: &Folder, name: &str, text: &str) {
    std::fs::write(folder.path().join(name), text).unwrap();
}

/// Says and holds what a command takes.
fn holds(folder: &Folder, args: &[&str], most: u64) {
    let taken = peak(folder.command(args));
    println!("{taken:>5} MB  slipmap {}", args.join(" "));
    assert!(
        taken <= most,
        "slipmap {args:?}: {taken} MB, at most {most}"
    );
}

/// All that is done with a map.
fn holds_for_readers(folder: &Folder, map: &str, most: u64) {
    holds(folder, &["info", map], most);
    holds(folder, &["verify", map, "--cells", "20"], most);
    let picture = format!("{map}.svg");
    holds(folder, &["plot", map, "-o", &picture], most);
}

#[test]
fn curves_are_read_and_written_plane_by_plane() {
    let folder = Folder::new();
    for (name, planes) in [("few", 8), ("many", 24)] {
        write(&folder, &format!("{name}.toml"), &slopes(planes));
        let map = format!("{name}.h5");
        holds(&folder, &["run", &format!("{name}.toml"), "-q"], 150);
        holds_for_readers(&folder, &map, 110);
    }
    // What info takes is the program's own: it does not grow with the curves.
    let info = |map: &str| peak(folder.command(&["info", map]));
    let (few, many) = (info("few.h5"), info("many.h5"));
    assert!(many <= few + 4, "{few} and {many} MB");
}

#[test]
fn long_delays_are_undecided_rather_than_remembered_at_any_length() {
    let folder = Folder::new();
    write(&folder, "long.toml", LONG_DELAYS);
    holds(
        &folder,
        &["run", "long.toml", "-q", "--threads", "2", ALLOWED],
        PROMISED,
    );
    holds(
        &folder,
        &[
            "vc",
            "--friction",
            "coulomb",
            "--mu0",
            "0.455747",
            "--alpha-v",
            "0.00165272",
            "--alpha-n",
            "1.00052",
            "--tau",
            "6280.74",
            "--mass",
            "0.0833612",
            "--stiffness",
            "258318",
        ],
        250,
    );
}

/// Threads are fewer where so many would take more, and none is refused.
#[test]
fn memory_bounds_the_threads() {
    let folder = Folder::new();
    write(&folder, "long.toml", LONG_DELAYS);
    let refused = folder.run(&["run", "long.toml", "--memory", "100MB"]);
    expect(&refused, 2, "--memory allows 100 MB");
    // As many pieces as threads, and a bound on what each may take.
    write(&folder, "many.toml", &slopes(24));
    let threads = |memory: &str| -> u64 {
        let planned = folder.run(&["plan", "many.toml", "--threads", "25", "--memory", memory]);
        expect(&planned, 0, "memory up to");
        let text = program::out(&planned);
        let told = text.split("time").nth(1).unwrap();
        let words: Vec<&str> = told.split_whitespace().collect();
        let place = words.iter().position(|w| w.starts_with("threads")).unwrap();
        words[place - 1].parse().unwrap()
    };
    let (few, all) = (threads("200MB"), threads("2GB"));
    assert!((1..=4).contains(&few) && all == 25, "{few} {all}");
    for bad in ["0x", "-1", "lots", ""] {
        let refused = folder.run(&["plan", "long.toml", &format!("--memory={bad}")]);
        expect(&refused, 2, "--memory");
    }
}

/// What is allowed by default, from `plan` with its environment and limits.
fn allowed_by_default(folder: &Folder, limit: &str, slurm: &[(&str, &str)]) -> serde_json::Value {
    let script = format!("{limit} exec \"$0\" plan many.toml --threads 25 --json");
    let mut command = Command::new("sh");
    command
        .args(["-c", &script, env!("CARGO_BIN_EXE_slipmap")])
        .current_dir(folder.path())
        .envs(slurm.iter().copied());
    let output = program::output(&mut command);
    expect(&output, 0, "memory_allowed");
    program::json(&output)
}

/// By default a run takes half of the least that is left, and 500 MB where that is less.
#[test]
fn the_default_is_a_share_of_what_is_left() {
    let folder = Folder::new();
    write(&folder, "many.toml", &slopes(24));
    let allowed = |limit: &str, slurm: &[(&str, &str)]| -> u64 {
        let facts = allowed_by_default(&folder, limit, slurm);
        let (memory, allowed) = (&facts["memory"], facts["memory_allowed"].as_u64().unwrap());
        assert!(memory.as_u64().unwrap() <= allowed, "{facts}");
        assert_eq!(facts["inputs"]["memory"], facts["memory_allowed"]);
        allowed / 1_000_000
    };
    let machine = std::fs::read_to_string("/proc/meminfo").unwrap_or_default();
    let available = machine
        .lines()
        .find_map(|line| line.strip_prefix("MemAvailable:"));
    let of_machine = allowed("", &[]);
    if let Some(available) = available {
        let kib: u64 = available.trim_end_matches("kB").trim().parse().unwrap();
        let half = kib * 1024 / 2_000_000;
        let most = (half * 11 / 10).max(PROMISED);
        assert!((PROMISED..=most).contains(&of_machine), "{of_machine} MB");
    }
    let small = [("SLURM_MEM_PER_NODE", "1400")];
    assert_eq!(allowed("", &small), of_machine.min(734));
    let none = [("SLURM_MEM_PER_CPU", "10"), ("SLURM_CPUS_ON_NODE", "2")];
    assert_eq!(allowed("", &none), PROMISED);
    // Of the address space that is left the half is taken, and never more than there is.
    let half = allowed("ulimit -v 1500000;", &[]);
    assert!((PROMISED..=768).contains(&half), "{half} MB");
    let all = allowed("ulimit -v 400000;", &[]);
    assert!((200..=410).contains(&all), "{all} MB");
    // A run keeps to what `plan` says.
    let facts = allowed_by_default(&folder, "", &small);
    let told = facts["memory"].as_u64().unwrap() / 1_000_000;
    let threads = facts["threads"].to_string();
    holds(
        &folder,
        &["run", "many.toml", "-q", "--threads", &threads],
        told,
    );
}

/// The shipped sweeps and two larger ones; some of them unless all are asked for.
fn sweeps(folder: &Folder) -> Vec<String> {
    let all = std::env::var_os("SLIPMAP_MEMORY").is_some();
    let shipped = concat!(env!("CARGO_MANIFEST_DIR"), "/sweeps");
    let mut names = Vec::new();
    for entry in std::fs::read_dir(shipped).unwrap() {
        let path = entry.unwrap().path();
        let Some(name) = path.file_name().and_then(|name| name.to_str()) else {
            continue;
        };
        let Some(stem) = name.strip_suffix(".toml") else {
            continue;
        };
        if all || ["fig2a", "fig4", "robust_load"].contains(&stem) {
            std::fs::copy(&path, folder.path().join(name)).unwrap();
            names.push(stem.to_owned());
        }
    }
    assert!(names.len() >= if all { 15 } else { 3 });
    names.sort();
    write(folder, "degrees.toml", DEGREES);
    names.push("degrees".to_owned());
    if all {
        write(folder, "long_axis.toml", LONG_AXIS);
        write(folder, "slopes.toml", &slopes(4000));
        write(folder, "billion.toml", BILLION);
        names.splice(..0, ["long_axis", "slopes", "billion"].map(str::to_owned));
    }
    names
}

#[test]
fn every_command_keeps_the_promise() {
    let folder = Folder::new();
    for name in sweeps(&folder) {
        let (sweep, map) = (format!("{name}.toml"), format!("{name}.h5"));
        let text = std::fs::read_to_string(folder.path().join(&sweep)).unwrap();
        if !text.contains("[axes]") {
            // One motion.
            let picture = format!("{map}.svg");
            holds(&folder, &["simulate", &sweep, "-o", &map], PROMISED);
            holds(&folder, &["plot", &map, "-o", &picture], PROMISED);
            continue;
        }
        holds(&folder, &["plan", &sweep], PROMISED);
        for shard in ["1/2", "2/2"] {
            let run = ["run", &sweep, "-q", ALLOWED, "--shard", shard];
            holds(&folder, &run, PROMISED);
        }
        holds(&folder, &["status", &map], PROMISED);
        holds(&folder, &["merge", &map], PROMISED);
        holds_for_readers(&folder, &map, PROMISED);
        std::fs::remove_file(folder.path().join(map)).unwrap();
    }
}
