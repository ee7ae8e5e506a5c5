//! The scripts that compute a map in shards, without a scheduler: a plain shell's, Kubernetes' and
//! Slurm's, each with the environment that its scheduler gives. `tests/slurm/run.sh` has a real
//! Slurm.
#![cfg(unix)]

use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use crate::program;
use tempfile::TempDir;

const SWEEP: &str = "fields = [\"n_unstable\", \"abscissa\"]\n\n[axes]\nmu_prime = [-0.1, -0.3]\n\
    alpha_n = { from = -3.0, to = 1.0, points = 97 }\ntau = { from = 0.0, to = 9.0, points = 301 }\n";

/// A folder with a sweep, in which scripts run, and another one for the map of a single run.
struct Work(TempDir);

impl Work {
    fn new() -> Self {
        let folder = TempDir::new().expect("a temporary folder");
        std::fs::write(folder.path().join("sweep.toml"), SWEEP).unwrap();
        std::fs::create_dir(folder.path().join("whole")).unwrap();
        Self(folder)
    }

    fn command(&self, program: impl AsRef<std::ffi::OsStr>, arguments: &[&str]) -> Command {
        let program_folder = Path::new(env!("CARGO_BIN_EXE_slipmap")).parent().unwrap();
        let paths = std::env::var_os("PATH").unwrap_or_default();
        let paths = [program_folder.to_owned()]
            .into_iter()
            .chain(std::env::split_paths(&paths));
        let mut command = Command::new(program);
        command
            .args(arguments)
            .current_dir(self.0.path())
            .env("PATH", std::env::join_paths(paths).unwrap())
            .env_remove("SLIPMAP");
        command
    }

    fn run(&self, arguments: &[&str]) -> Output {
        succeed(&mut self.command("slipmap", arguments))
    }

    /// Fails unless `map.h5` is the map that one run makes, but for the time in its history.
    fn check_map(&self) {
        self.run(&["run", "sweep.toml", "-o", "whole/map.h5", "--quiet"]);
        let read = |name: &str| {
            let map = hdf5::File::open(self.0.path().join(name)).unwrap();
            let n_unstable: Vec<u16> = map.dataset("n_unstable").unwrap().read_raw().unwrap();
            let abscissa: Vec<f64> = map.dataset("abscissa").unwrap().read_raw().unwrap();
            let status: Vec<u8> = map.dataset("status").unwrap().read_raw().unwrap();
            let omega: Vec<f64> = map.dataset("boundaries/omega").unwrap().read_raw().unwrap();
            let bits = |values: Vec<f64>| values.into_iter().map(f64::to_bits).collect::<Vec<_>>();
            (n_unstable, bits(abscissa), status, bits(omega))
        };
        assert!(read("map.h5") == read("whole/map.h5"));
        assert!(!self.0.path().join("map.h5.tiles").exists());
    }

    /// The shards that have computed something.
    fn shards(&self) -> Vec<String> {
        let tiles = self.0.path().join("map.h5.tiles");
        let entries = std::fs::read_dir(tiles).expect("tiles");
        let mut names: Vec<String> = entries
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }
}

fn succeed(command: &mut Command) -> Output {
    let output = program::output(command);
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{command:?}: {said}");
    output
}

fn script(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("scripts")
        .join(name)
}

#[test]
fn a_plain_shell_computes_shards_and_merges_them() {
    let work = Work::new();
    let shards = script("shards.sh");
    succeed(&mut work.command(&shards, &["sweep.toml", "map.h5", "5", "2"]));
    work.check_map();
    // Again: nothing is left to do.
    succeed(&mut work.command(&shards, &["sweep.toml", "map.h5", "5", "2"]));
    for arguments in [&["sweep.toml", "map.h5"][..], &["none.toml", "map.h5", "2"]] {
        let refused = program::output(&mut work.command(&shards, arguments));
        assert!(!refused.status.success(), "{arguments:?}");
    }
}

#[test]
fn more_shards_than_open_files_are_merged() {
    let work = Work::new();
    let of = 80;
    for number in 1..=of {
        let shard = format!("{number}/{of}");
        work.run(&["run", "sweep.toml", "-o", "map.h5", "-q", "--shard", &shard]);
    }
    succeed(&mut work.command("sh", &["-c", "ulimit -Sn 40 && slipmap merge map.h5"]));
    work.check_map();
}

#[test]
fn a_merge_without_shards_is_refused() {
    let work = Work::new();
    let refused = program::output(&mut work.command("slipmap", &["merge", "map.h5"]));
    let said = String::from_utf8_lossy(&refused.stderr);
    assert_eq!(refused.status.code(), Some(2), "{said}");
    assert!(said.contains("no shards"), "{said}");
}

/// What the container of a Job runs, taken from its file.
fn kubernetes_shard() -> String {
    let job = std::fs::read_to_string(script("kubernetes/shards.yaml")).unwrap();
    let line = job.lines().find(|line| line.contains("exec slipmap run"));
    let command = line.expect("a command").trim().strip_prefix("- ");
    command.expect("an item of a list").to_owned()
}

#[test]
fn the_pods_of_a_kubernetes_job_compute_shards() {
    let work = Work::new();
    let command = kubernetes_shard();
    for index in 0..3 {
        let mut pod = work.command("/bin/sh", &["-c", &command]);
        pod.env("JOB_COMPLETION_INDEX", index.to_string())
            .envs([("SWEEP", "sweep.toml"), ("MAP", "map.h5")])
            .envs([("SHARDS", "3"), ("THREADS", "1")]);
        succeed(&mut pod);
    }
    assert_eq!(work.shards(), ["1-of-3", "2-of-3", "3-of-3"]);
    work.run(&["merge", "map.h5"]);
    work.check_map();
}

/// A task of a job array, as Slurm runs it.
fn task(work: &Work, id: u32, array: (u32, u32, u32), arguments: &[&str]) -> Output {
    program::output(&mut task_command(work, id, array, arguments))
}

fn task_command(
    work: &Work,
    id: u32,
    (first, step, count): (u32, u32, u32),
    arguments: &[&str],
) -> Command {
    let mut task = work.command(script("slurm/shard.sbatch"), arguments);
    task.env("SLURM_ARRAY_TASK_ID", id.to_string())
        .env("SLURM_ARRAY_TASK_MIN", first.to_string())
        .env("SLURM_ARRAY_TASK_STEP", step.to_string())
        .env("SLURM_ARRAY_TASK_COUNT", count.to_string())
        .env("SLURM_CPUS_PER_TASK", "2");
    task
}

#[test]
fn any_numbers_of_an_array_are_its_shards() {
    for (first, step) in [(0, 1), (1, 1), (7, 3)] {
        let work = Work::new();
        let done = |number: u32| {
            let (array, id) = ((first, step, 3), first + number * step);
            let ended = task(&work, id, array, &["sweep.toml", "map.h5"]);
            assert!(ended.status.success(), "{ended:?}");
        };
        done(0);
        done(2);
        assert_eq!(work.shards(), ["1-of-3", "3-of-3"]);
        done(1);
        let log = std::fs::read_to_string(work.0.path().join("map.h5.2-of-3.log")).unwrap();
        assert!(log.contains("\"threads\":2"), "{log}");
        // The last one has made the map, and one that is run again finds its work done.
        work.check_map();
        done(0);
        work.check_map();
    }
}

/// Shards that end at the same time: one of them makes the map, and none fails.
#[test]
fn one_of_the_last_shards_merges() {
    for _ in 0..3 {
        let work = Work::new();
        let shard = |shard: &str| {
            let run = [
                "run",
                "sweep.toml",
                "-o",
                "map.h5",
                "--and-merge",
                "-q",
                "--threads",
                "1",
            ];
            let mut command = work.command("slipmap", &[&run[..], &["--shard", shard]].concat());
            command
                .stderr(Stdio::piped())
                .stdout(Stdio::piped())
                .spawn()
                .unwrap()
        };
        let all = ["1/4", "2/4", "3/4", "4/4"].map(shard);
        for child in all {
            let ended = child.wait_with_output().unwrap();
            assert!(ended.status.success(), "{}", program::err(&ended));
        }
        work.check_map();
    }
    let refused = Work::new();
    let alone = ["run", "sweep.toml", "--and-merge"];
    let output = program::output(&mut refused.command("slipmap", &alone));
    program::expect(&output, 2, "--shard");
}

#[test]
fn a_task_is_the_shard_of_its_number_where_their_number_is_given() {
    let work = Work::new();
    let ended = task(&work, 3, (3, 1, 1), &["sweep.toml", "map.h5", "4"]);
    assert!(ended.status.success(), "{ended:?}");
    assert_eq!(work.shards(), ["3-of-4"]);
}

#[test]
fn bad_input_of_a_task_is_not_tried_again() {
    let work = Work::new();
    std::fs::write(work.0.path().join("sweep.toml"), "fields = 3\n").unwrap();
    let ended = task(
        &work,
        1,
        (1, 1, 1),
        &["sweep.toml", "map.h5", "2", "refused"],
    );
    assert_eq!(ended.status.code(), Some(2));
    assert!(work.0.path().join("refused").exists());
    let ended = task(&work, 1, (1, 1, 1), &["sweep.toml"]);
    assert_eq!(ended.status.code(), Some(2));
}

/// Exit code 3 says that the work is being done, by whoever holds the lock; Slurm tries again later.
#[test]
fn what_another_run_works_on_has_an_exit_code_of_its_own() {
    let work = Work::new();
    for shard in ["1/2", "2/2"] {
        work.run(&["run", "sweep.toml", "-o", "map.h5", "--shard", shard]);
    }
    let held = |name: &str| {
        let lock = std::fs::File::create(work.0.path().join(name)).unwrap();
        lock.lock().unwrap();
        lock
    };
    let refused = |arguments: &[&str]| {
        let output = program::output(&mut work.command("slipmap", arguments));
        program::expect(&output, 3, "another run is writing");
    };
    let of_shard = held("map.h5.tiles/2-of-2/lock");
    let run = ["run", "sweep.toml", "-o", "map.h5", "--shard", "2/2"];
    refused(&run);
    refused(&[&run[..], &["--fresh"]].concat());
    let scontrol = "#!/bin/sh\necho \"$@\" >requeued\n";
    let path = work.0.path().join("scontrol");
    std::fs::write(&path, scontrol).unwrap();
    std::fs::set_permissions(&path, std::fs::Permissions::from_mode(0o755)).unwrap();
    let mut array = task_command(&work, 2, (1, 1, 2), &["sweep.toml", "map.h5"]);
    let paths = std::env::var("PATH").unwrap();
    let program_folder = Path::new(env!("CARGO_BIN_EXE_slipmap")).parent().unwrap();
    let paths = format!(
        "{}:{}:{paths}",
        work.0.path().display(),
        program_folder.display()
    );
    array.env("PATH", paths).env("SLURM_ARRAY_JOB_ID", "17");
    assert_eq!(program::output(&mut array).status.code(), Some(3));
    let requeued = std::fs::read_to_string(work.0.path().join("requeued")).unwrap();
    assert_eq!(requeued, "requeue 17_2\n");
    drop(of_shard);
    let of_map = held(".map.h5.slipmap-lock");
    refused(&["merge", "map.h5"]);
    drop(of_map);
    work.run(&["merge", "map.h5"]);
    work.check_map();
}
