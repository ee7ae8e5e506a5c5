//! The list of maps below a folder, each with what a process of its own told of it.

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant, SystemTime};

use serde_json::{Value, json};
use tokio::sync::{Notify, Semaphore};

use super::frames::{Ask, Kind};
use super::process::{Reader, ReaderCommand, Trouble};
use super::readers::refused;
use super::scan::{Found, Mark, Scanned, scan};

/// Names are looked at again after so long.
const BETWEEN_SCANS: Duration = Duration::from_secs(1);
/// A list waits so long for what is not known yet.
const PATIENCE: Duration = Duration::from_millis(1500);
/// A process that takes longer to tell of a map is ended.
const LONGEST_PROBE: Duration = Duration::from_secs(5);
/// Maps that are asked at a time.
const MOST_PROBES: usize = 2;

/// What was told of a map.
#[derive(Debug, Clone)]
enum Told {
    /// By its process.
    Summary(Value),
    /// Why it cannot be read.
    Damaged(String),
}

#[derive(Debug, Default)]
struct Known {
    scanned: Scanned,
    at: Option<Instant>,
    /// By id, what was there when it was told.
    told: HashMap<String, (Mark, Told)>,
    /// Those that are being asked.
    asked: HashMap<String, Mark>,
}

/// The maps below a folder.
#[derive(Debug)]
pub(super) struct List {
    folder: PathBuf,
    command: ReaderCommand,
    known: Mutex<Known>,
    scanning: tokio::sync::Mutex<()>,
    probes: Arc<Semaphore>,
    news: Notify,
}

impl List {
    pub(super) fn of(folder: &Path, command: ReaderCommand) -> Self {
        Self {
            folder: folder.canonicalize().unwrap_or_else(|_| folder.to_owned()),
            command,
            known: Mutex::default(),
            scanning: tokio::sync::Mutex::default(),
            probes: Arc::new(Semaphore::new(MOST_PROBES)),
            news: Notify::new(),
        }
    }

    fn known(&self) -> MutexGuard<'_, Known> {
        self.known.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Looks at the names below the folder, unless that was just done.
    async fn scan(&self) {
        let _one = self.scanning.lock().await;
        let at = self.known().at;
        if at.is_some_and(|at| at.elapsed() < BETWEEN_SCANS) {
            return;
        }
        let folder = self.folder.clone();
        let scanned = tokio::task::spawn_blocking(move || scan(&folder)).await;
        let mut known = self.known();
        known.scanned = scanned.unwrap_or_default();
        known.at = Some(Instant::now());
        let there: Vec<String> = known.scanned.maps.iter().map(|f| f.id.clone()).collect();
        known.told.retain(|id, _| there.contains(id));
    }

    /// The map of an id.
    pub(super) async fn find(&self, id: &str) -> Option<Found> {
        self.scan().await;
        let known = self.known();
        known
            .scanned
            .maps
            .iter()
            .find(|found| found.id == id)
            .cloned()
    }

    /// All maps, as far as they are known.
    pub(super) async fn json(self: &Arc<Self>) -> Value {
        self.scan().await;
        let until = tokio::time::Instant::now() + PATIENCE;
        loop {
            let news = self.news.notified();
            if self.ask_unknown() == 0 {
                break;
            }
            if tokio::time::timeout_at(until, news).await.is_err() {
                break;
            }
        }
        self.told()
    }

    /// Has processes tell what is not known, or has changed; how many that are.
    fn ask_unknown(self: &Arc<Self>) -> usize {
        let mut known = self.known();
        let Known {
            scanned,
            told,
            asked,
            ..
        } = &mut *known;
        let mut unknown = 0;
        for found in scanned.maps.iter().filter(|found| found.odd.is_none()) {
            let of_now = |mark: &Mark| *mark == found.mark;
            if told.get(&found.id).is_some_and(|(mark, _)| of_now(mark)) {
                continue;
            }
            unknown += usize::from(!told.contains_key(&found.id));
            if !asked.contains_key(&found.id) {
                asked.insert(found.id.clone(), found.mark.clone());
                tokio::spawn(Arc::clone(self).ask_one(found.clone()));
            }
        }
        unknown
    }

    async fn ask_one(self: Arc<Self>, found: Found) {
        let place = Arc::clone(&self.probes).acquire_owned().await;
        let told = self.probe(&found).await;
        drop(place);
        let mut known = self.known();
        known.asked.remove(&found.id);
        known.told.insert(found.id.clone(), (found.mark, told));
        drop(known);
        self.news.notify_waiters();
    }

    async fn probe(&self, found: &Found) -> Told {
        let (command, path) = (self.command.clone(), found.path.clone());
        let started = tokio::task::spawn_blocking(move || Reader::start(&command, &path)).await;
        let Ok(Ok(reader)) = started else {
            return Told::Damaged("the process that reads it could not be started".into());
        };
        let answer = reader.ask(Ask::Summary, LONGEST_PROBE).await;
        drop(tokio::task::spawn_blocking(move || drop(reader)).await);
        match answer {
            Ok(frame) if frame.kind == Kind::Json => match serde_json::from_slice(&frame.bytes) {
                Ok(summary) => Told::Summary(summary),
                Err(error) => Told::Damaged(error.to_string()),
            },
            Ok(frame) => Told::Damaged(refused(&frame).detail),
            Err(Trouble::TooLong) => Told::Damaged("reading it took longer than 5 s".into()),
            Err(_) => Told::Damaged("the process that read it ended".into()),
        }
    }

    fn told(&self) -> Value {
        let known = self.known();
        let maps = known.scanned.maps.iter().map(|found| {
            let told = known.told.get(&found.id).map(|(_, told)| told);
            entry(found, told)
        });
        json!({
            "folder": self.folder.to_string_lossy(),
            "maps": maps.collect::<Vec<_>>(),
            "folders_skipped": known.scanned.folders_skipped,
            "links_skipped": known.scanned.links_skipped,
            "truncated": known.scanned.truncated,
        })
    }
}

/// The state of a map, and why it is damaged where it is.
fn state(found: &Found, told: Option<&Told>) -> (&'static str, Option<String>) {
    if let Some(odd) = found.odd {
        return ("damaged", Some(odd.into()));
    }
    match told {
        None => ("unknown", None),
        Some(Told::Damaged(why)) => ("damaged", Some(why.clone())),
        Some(Told::Summary(summary)) => {
            let complete = summary["cells"] == summary["cells_done"];
            (found.state(complete), None)
        }
    }
}

fn entry(found: &Found, told: Option<&Told>) -> Value {
    let (state, why) = state(found, told);
    let modified = found.modified();
    let age = modified.and_then(|time| SystemTime::now().duration_since(time).ok());
    let since = modified.and_then(|time| time.duration_since(SystemTime::UNIX_EPOCH).ok());
    let mut entry = json!({
        "id": found.id, "name": found.name, "state": state, "why": why,
        "bytes": found.bytes(),
        "modified": since.map(|since| since.as_secs_f64()),
        "age_seconds": age.map(|age| age.as_secs_f64()),
        "title": null, "cells": null, "cells_done": null, "axes": [], "fields": [],
    });
    if let (Some(Told::Summary(Value::Object(summary))), Value::Object(entry)) = (told, &mut entry)
    {
        entry.extend(summary.clone());
    }
    entry
}
