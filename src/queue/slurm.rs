//! Sweeps as job arrays of Slurm: submitted, found again and cancelled by their names, so that
//! nothing has to be remembered of them.

use std::ffi::{OsStr, OsString};
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

use sha2::{Digest, Sha256};

use super::attempt::End;
use super::folder::{Folder, Place};
use super::logs::{last_lines, logs, newest};
use super::name::Name;
use crate::maps::maker;
use crate::store::StoreError;
use crate::sweep::Plan;
use crate::text::in_hexadecimal;

/// The script of one shard, which `scripts/slurm` has too.
const SCRIPT: &str = include_str!("shard.sbatch");
/// Digits in the name of an array that tell its plan and its folder.
const DIGITS: usize = 16;
/// The most lines that are told of what a task said.
const LAST_LINES: usize = 30;

/// How sweeps are handed to Slurm.
#[derive(Debug, Clone)]
pub(crate) struct Slurm {
    /// The program that computes shards, for all machines.
    pub program: PathBuf,
    /// Shards of a sweep.
    pub shards: u32,
    /// Sweeps at a time.
    pub at_once: usize,
    /// Options of sbatch.
    pub options: Vec<OsString>,
    /// The time between two looks at an array.
    pub every: Duration,
}

/// An array that waits or runs.
#[derive(Debug)]
pub(super) struct Array {
    name: String,
    files: Files,
    plan_hash: String,
    every: Duration,
    looked: Instant,
    stopped: bool,
    was_there: bool,
}

/// The files of an array, with absolute names: its tasks begin in other folders.
#[derive(Debug)]
struct Files {
    program: PathBuf,
    sweep: PathBuf,
    map: PathBuf,
    /// What its tasks say goes to files of this name, with the number of the task and `.log`.
    said: PathBuf,
    /// A file that a task makes if the sweep cannot be computed as it is.
    refused: PathBuf,
}

/// The name of the array of a sweep. That of another plan under the same name of a job, or of
/// another folder, is another.
fn array_name(job: &Name, plan_hash: &str, map: &Path) -> String {
    let letter = |c: char| if c.is_ascii_alphanumeric() { c } else { '-' };
    let job: String = job.to_string().chars().map(letter).collect();
    let of = [plan_hash.as_bytes(), map.as_os_str().as_encoded_bytes()].concat();
    let digest = in_hexadecimal(&Sha256::digest(of));
    format!("slipmap-{job}-{}", &digest[..DIGITS])
}

/// A text as one word of the shell.
fn quoted(text: &OsStr) -> io::Result<String> {
    let odd = || io::Error::new(io::ErrorKind::InvalidInput, "a name is not UTF-8");
    let text = text.to_str().ok_or_else(odd)?;
    Ok(format!("'{}'", text.replace('\'', "'\\''")))
}

impl Files {
    fn of(folder: &Folder, job: &Name, program: &Path) -> io::Result<Self> {
        let absolute = |path: &Path| std::path::absolute(path);
        let beside = |behind: &str| folder.path().join(job.file(".", behind));
        Ok(Self {
            program: absolute(program)?,
            sweep: absolute(&folder.file(Place::Queue, job))?,
            map: absolute(&folder.map(job))?,
            said: absolute(&beside(".slurm-"))?,
            refused: absolute(&beside(".slurm-refused"))?,
        })
    }

    /// The script, with its arguments put in: one that comes by standard input is given none.
    fn script(&self, shards: u32) -> io::Result<String> {
        let (head, rest) = SCRIPT.split_at(SCRIPT.find("set -uo pipefail").unwrap_or(0));
        let paths = [&self.program, &self.sweep, &self.map, &self.refused];
        let [program, sweep, map, refused] = paths.map(|path| quoted(path.as_os_str()));
        let (program, sweep, map, refused) = (program?, sweep?, map?, refused?);
        Ok(format!(
            "{head}SLIPMAP={program}\nset -- {sweep} {map} {shards} {refused}\n{rest}"
        ))
    }

    /// The end of what the task said that said something last.
    fn last_said(&self) -> String {
        let newest = newest(logs(&self.said));
        newest.map_or_else(String::new, |log| last_lines(&log, LAST_LINES))
    }

    /// Removes what an array leaves beside its map.
    fn clear(&self) {
        for path in logs(&self.said).iter().chain([&self.refused]) {
            // What cannot be removed is in nobody's way.
            let _ = fs::remove_file(path);
        }
    }
}

impl Array {
    /// Its name.
    pub(super) fn name(&self) -> &str {
        &self.name
    }

    /// Whether an earlier worker had submitted it.
    pub(super) fn was_there(&self) -> bool {
        self.was_there
    }

    /// Cancels it: its tasks stop in order.
    pub(super) fn stop(&mut self) {
        if !self.stopped {
            let mut command = Command::new("scancel");
            let done = command
                .arg("--name")
                .arg(&self.name)
                .stdin(Stdio::null())
                .output();
            self.stopped = done.is_ok_and(|output| output.status.success());
        }
    }

    /// How it has ended; none while some of it waits or runs.
    ///
    /// # Errors
    /// When Slurm does not say, as while its controller is down.
    pub(super) fn look(&mut self) -> Result<Option<End>, StoreError> {
        if self.looked.elapsed() < self.every {
            return Ok(None);
        }
        self.looked = Instant::now();
        let is_there = is_there(&self.name).map_err(StoreError::io("ask", Path::new("squeue")))?;
        match is_there {
            true => Ok(None),
            false => self.end().map(Some),
        }
    }

    fn end(&self) -> Result<End, StoreError> {
        let files = &self.files;
        let said = files.last_said();
        let end = if maker::is_complete(&files.map, Some(&self.plan_hash))? {
            End::Done(format!("{} is complete", files.map.display()))
        } else if files.refused.exists() {
            End::BadInput(said)
        } else if self.stopped {
            End::Stopped { at_once: true }
        } else {
            End::Broke(format!("{said}\nno task of {} is left", self.name))
        };
        files.clear();
        Ok(end)
    }
}

/// What a command of Slurm said, or why it failed.
fn said(output: &Output, command: &str) -> io::Result<String> {
    if output.status.success() {
        return Ok(String::from_utf8_lossy(&output.stdout).trim().to_owned());
    }
    let why = String::from_utf8_lossy(&output.stderr);
    Err(io::Error::other(format!("{command}: {}", why.trim())))
}

/// Whether some of the tasks of an array wait or run.
fn is_there(name: &str) -> io::Result<bool> {
    let mut command = Command::new("squeue");
    command.args(["--noheader", "--format=%j", "--name", name]);
    let listed = said(&command.stdin(Stdio::null()).output()?, "squeue")?;
    Ok(listed.lines().any(|line| line.trim() == name))
}

impl Slurm {
    /// Submits the array of a job, unless it is there: a worker may have died after it had.
    ///
    /// # Errors
    /// When there is no Slurm, or it refuses.
    pub(super) fn begin(&self, folder: &Folder, job: &Name, plan: &Plan) -> io::Result<Array> {
        let plan_hash = plan.hash();
        let files = Files::of(folder, job, &self.program)?;
        let name = array_name(job, &plan_hash, &files.map);
        let array = Array {
            was_there: is_there(&name)?,
            name,
            files,
            plan_hash,
            every: self.every,
            looked: Instant::now(),
            stopped: false,
        };
        if !array.was_there {
            array.files.clear();
            self.submit(&array)?;
        }
        Ok(array)
    }

    fn submit(&self, array: &Array) -> io::Result<()> {
        let mut output = array.files.said.as_os_str().to_owned();
        output.push("%a.log");
        let mut command = Command::new("sbatch");
        command.arg("--parsable").args(&self.options);
        command.arg(format!("--job-name={}", array.name));
        command.arg(format!("--array=1-{}", self.shards));
        command.arg("--output").arg(output);
        command
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped());
        let script = array.files.script(self.shards)?;
        let mut child = command.spawn()?;
        if let Some(mut input) = child.stdin.take() {
            // Where it does not read, it says why.
            let _ = input.write_all(script.as_bytes());
        }
        said(&child.wait_with_output()?, "sbatch").map(drop)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scripts_have_their_arguments_behind_the_options_of_sbatch() {
        let files = Files {
            program: "/bin/slipmap".into(),
            sweep: "/a b/it's.toml".into(),
            map: "/a b/m.h5".into(),
            said: "/a b/.m-".into(),
            refused: "/a b/.r".into(),
        };
        let script = files.script(7).unwrap();
        let arguments =
            "\nSLIPMAP='/bin/slipmap'\nset -- '/a b/it'\\''s.toml' '/a b/m.h5' 7 '/a b/.r'\n";
        let at = script.find(arguments).unwrap();
        let last = script.rfind("\n#SBATCH").unwrap();
        assert!(script.starts_with("#!/usr/bin/env bash\n") && last < at);
        assert!(script.find("sweep=$1").unwrap() > at);
        // The shell takes it for what it is.
        let line = "printf '%s|' \"$@\"";
        let arguments = arguments.lines().last().unwrap();
        let told = Command::new("sh")
            .args(["-c", &format!("{arguments}\n{line}")])
            .output()
            .unwrap();
        assert_eq!(told.stdout, b"/a b/it's.toml|/a b/m.h5|7|/a b/.r|");
    }

    #[test]
    fn arrays_are_named_by_job_plan_and_folder() {
        let name = |job: &str, plan: &str, map: &str| {
            array_name(&Name::of_stem(job), plan, Path::new(map))
        };
        let one = name("100000-fig,2 a", "0123", "/maps/100000-a.h5");
        assert!(
            one.starts_with("slipmap-100000-fig-2-a-") && one.len() == 39,
            "{one}"
        );
        assert_eq!(one, name("100000-fig,2 a", "0123", "/maps/100000-a.h5"));
        assert_ne!(one, name("100000-fig,2 a", "0124", "/maps/100000-a.h5"));
        assert_ne!(one, name("100000-fig,2 a", "0123", "/other/100000-a.h5"));
    }
}
