//! The same bytes on unlike processors: what the C library has for this one, for others, and other
//! processors altogether.
//!
//! `scripts/unlike.sh` asks the same of the shipped sweeps as they are, and of an aarch64 program.
#![cfg(all(target_os = "linux", target_arch = "x86_64", target_env = "gnu"))]

use std::path::Path;
use std::process::{Command, Output};

use crate::map;
use crate::program::{self, Folder, err, expect};

/// Takes the C library's variants for AVX2 and FMA away, by its old names of them and its new ones.
const TUNABLES: (&str, &str) = (
    "GLIBC_TUNABLES",
    "glibc.cpu.hwcaps=-AVX2_Usable,-FMA_Usable,-AVX2,-FMA,-FMA4,-AVX512F",
);
/// Set where the test below asks itself for the C library's bits.
const ASKED: &str = "SLIPMAP_ASK_C_LIBRARY";
/// At most so many points along each axis of a shipped sweep.
const MOST_POINTS: usize = 2;

/// The bits of sines and exponentials of the C library.
#[allow(clippy::disallowed_methods, reason = "it is what it asks for")]
fn of_c_library() -> u64 {
    (0..20_000)
        .map(|i| std::hint::black_box(f64::from(i) * 1e-3))
        .map(|x| x.sin().to_bits().rotate_left(7) ^ (-x).exp().to_bits())
        .fold(0, |all: u64, bits| all.rotate_left(1).wrapping_add(bits))
}

/// Without this the comparison below would compare like with like.
#[test]
fn the_c_library_itself_depends_on_the_processor() {
    let name = "unlike::the_c_library_itself_depends_on_the_processor";
    let bits = format!("bits {:x}", of_c_library());
    if std::env::var_os(ASKED).is_some() {
        println!("{bits}");
        return;
    }
    let ask = |variable: Option<(&str, &str)>| {
        let mut command = Command::new(std::env::current_exe().unwrap());
        command
            .args(["--exact", name, "--nocapture"])
            .env(ASKED, "1");
        command.envs(variable);
        let output = command.output().unwrap();
        expect(&output, 0, "bits ");
        program::out(&output).contains(&bits)
    };
    assert!(ask(None));
    if std::is_x86_feature_detected!("fma") && std::is_x86_feature_detected!("avx2") {
        assert!(!ask(Some(TUNABLES)), "{TUNABLES:?} changes nothing");
    }
}

/// A shipped sweep or case, smaller.
fn shrunk(path: &Path) -> String {
    let text = std::fs::read_to_string(path).unwrap();
    let line = |line: &str| {
        let Some((before, after)) = line.split_once("points = ") else {
            return line.to_owned();
        };
        let digits = after.find(|c: char| !c.is_ascii_digit()).unwrap();
        let points: usize = after[..digits].parse().unwrap();
        format!(
            "{before}points = {}{}",
            points.min(MOST_POINTS),
            &after[digits..]
        )
    };
    text.lines().map(line).collect::<Vec<_>>().join("\n")
}

#[track_caller]
fn succeed(output: &Output) {
    assert!(output.status.success(), "{}", err(output));
}

#[test]
fn maps_and_traces_do_not_depend_on_the_c_library() {
    let mut compared = 0;
    let entries = std::fs::read_dir("sweeps").unwrap();
    let paths = entries.map(|entry| entry.unwrap().path());
    let mut paths: Vec<_> = paths.filter(|path| path.is_file()).collect();
    paths.sort();
    for path in &paths {
        let text = shrunk(path);
        let verb = if text.contains("[axes]") {
            "run"
        } else {
            "simulate"
        };
        let folder = Folder::with(&[("case.toml", &text)]);
        let run = |output: &str, variable: Option<(&str, &str)>| {
            let mut command = folder.command(&[verb, "case.toml", "-o", output]);
            succeed(&command.envs(variable).output().unwrap());
            map::datasets(&folder.path().join(output))
        };
        let (here, elsewhere) = (run("here.h5", None), run("elsewhere.h5", Some(TUNABLES)));
        assert!(here.keys().eq(elsewhere.keys()), "{path:?}");
        for (name, bytes) in &here {
            assert!(*bytes == elsewhere[name], "{path:?}: {name}");
            compared += bytes.len();
        }
    }
    assert!(paths.len() > 10 && compared > 100_000, "{compared} bytes");
}
