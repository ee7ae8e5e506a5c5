//! `slipmap status` of several maps and of folders: a line for each map.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

use crate::maps::scan::scan;
use crate::queue::progress::{Progress, Watched};
use crate::report::numbers::{counted, grouped};
use crate::store::tiles::shards;
use crate::store::{MapFile, StoreError};
use serde::Serialize;
use utoipa::ToSchema;

use super::failure::Failure;
use super::json::{self, Inputs};
use super::say::{self, visible_line};
use super::status::speed;

/// Maps that are looked at a time.
const AT_A_TIME: usize = 8;

/// How far each of several maps is.
#[derive(Serialize, ToSchema)]
pub(super) struct ListAnswer {
    maps: Vec<ListedMap>,
}

/// How far a map is, by the heads of its tile files.
#[derive(Serialize, ToSchema)]
struct ListedMap {
    /// Its file, there or still to come.
    map: String,
    complete: bool,
    /// Whether a run works on it.
    running: bool,
    /// Null where `why` tells why they are not known.
    #[schema(required)]
    cells: Option<u64>,
    /// Null where `why` tells why they are not known.
    #[schema(required)]
    cells_done: Option<u64>,
    /// Of the runs that work on it; null where none does.
    #[schema(required)]
    cells_per_second: Option<f64>,
    /// Until the slowest of them is done; null where that is not known.
    #[schema(required)]
    seconds_left: Option<f64>,
    /// Why nothing is known of it; null for a map that is as it should be.
    #[schema(required)]
    why: Option<String>,
}

/// A map to look at.
struct Asked {
    map: PathBuf,
    /// Whether it was found in a folder. It may have gone since.
    found: bool,
    /// Why it cannot be a map.
    odd: Option<&'static str>,
}

/// A map that was looked at.
struct Looked {
    map: PathBuf,
    progress: Result<Progress, Unknown>,
}

/// Why nothing is known of a map: in a word or two, and in full.
struct Unknown {
    state: &'static str,
    why: String,
}

impl From<StoreError> for Unknown {
    fn from(error: StoreError) -> Self {
        let state = match error {
            StoreError::NotAMap { .. } => "no map",
            StoreError::Io { .. } | StoreError::InUse { .. } => "not read",
            _ => "damaged",
        };
        Self {
            state,
            why: error.to_string(),
        }
    }
}

pub(super) fn main(paths: &[PathBuf], json: bool) -> Result<(), Failure> {
    let mut asked = Vec::new();
    for path in paths {
        refuse_tiles(path)?;
        match path.is_dir() {
            true => asked.extend(maps_in(path)),
            false => asked.push(Asked {
                map: path.clone(),
                found: false,
                odd: None,
            }),
        }
    }
    let maps = look_at_all(&asked)?;
    if json {
        let maps = maps.iter().map(ListedMap::of).collect();
        return json::print(&Inputs::default().and("maps", paths), &ListAnswer { maps });
    }
    if maps.is_empty() {
        let folders: Vec<_> = paths
            .iter()
            .map(|path| path.display().to_string())
            .collect();
        return say::result(format!(
            "no maps in {}; `slipmap run SWEEP.toml -o {}` makes one",
            folders.join(", "),
            paths[0].join("MAP.h5").display()
        ));
    }
    print(&maps)
}

/// Refuses a folder of tiles, or of a shard in it, with the name of its map.
fn refuse_tiles(path: &Path) -> Result<(), Failure> {
    let folders = [Some(path), path.parent()];
    for folder in folders.into_iter().flatten() {
        let name = folder.file_name().and_then(|name| name.to_str());
        let Some(map) = name.and_then(|name| name.strip_suffix(shards::ROOT_ENDING)) else {
            continue;
        };
        let map = folder.with_file_name(map);
        if path.is_dir() && shards::present(&map).is_ok_and(|present| !present.is_empty()) {
            let map = map.display();
            return Err(Failure::bad_input_with_help(
                format!("{} holds tiles of {map}", path.display()),
                format!("`slipmap status {map}` says how far it is"),
            ));
        }
    }
    Ok(())
}

/// The maps below a folder. What is left out is told.
fn maps_in(folder: &Path) -> Vec<Asked> {
    let Ok(root) = folder.canonicalize() else {
        return Vec::new();
    };
    let scanned = scan(&root);
    let shown = folder.display();
    if scanned.folders_skipped > 0 {
        let skipped = counted(scanned.folders_skipped, "folder");
        say::note(format!(
            "{shown}: {skipped} not searched: too deep, or not open to this user"
        ));
    }
    if scanned.links_skipped > 0 {
        let skipped = counted(scanned.links_skipped, "link");
        say::note(format!(
            "{shown}: {skipped} not followed: to folders, elsewhere, or to nothing"
        ));
    }
    if scanned.truncated {
        say::remark(format!(
            "{shown}: there are more maps than these; name folders in it"
        ));
    }
    let inside = |path: &Path| folder.join(path.strip_prefix(&root).unwrap_or(path));
    let asked = scanned.maps.iter().map(|found| Asked {
        map: inside(&found.path),
        found: true,
        odd: found.odd,
    });
    asked.collect()
}

/// Looks at all maps, at several at a time: most of the time goes by waiting for the file system.
fn look_at_all(asked: &[Asked]) -> Result<Vec<Looked>, Failure> {
    let next = AtomicUsize::new(0);
    let work = || {
        let numbers = std::iter::repeat_with(|| next.fetch_add(1, Ordering::Relaxed));
        let ours = numbers.map_while(|n| Some((n, look(asked.get(n)?))));
        ours.collect::<Vec<_>>()
    };
    let mut looked: Vec<_> = std::thread::scope(|scope| {
        let threads: Vec<_> = (0..AT_A_TIME).map(|_| scope.spawn(work)).collect();
        let joined = threads.into_iter().filter_map(|thread| thread.join().ok());
        joined.flatten().collect()
    });
    looked.sort_by_key(|(number, _)| *number);
    let looked = looked
        .into_iter()
        .filter_map(|(_, looked)| looked.transpose());
    looked.collect()
}

/// Looks at a map; none where it has gone since it was found. Only where a name was given that
/// stands for nothing, this fails.
fn look(asked: &Asked) -> Result<Option<Looked>, Failure> {
    let progress = match asked.odd {
        Some(odd) => Err(Unknown {
            state: "no map",
            why: format!("{}: {odd}", asked.map.display()),
        }),
        None => match Watched::new(&asked.map).look() {
            Ok(Some(progress)) => Ok(progress),
            Ok(None) if asked.found => return Ok(None),
            // The error says why there is none.
            Ok(None) => Ok(Progress::of_file(&MapFile::open(&asked.map)?)),
            Err(error) => Err(error.into()),
        },
    };
    Ok(Some(Looked {
        map: asked.map.clone(),
        progress,
    }))
}

impl ListedMap {
    fn of(looked: &Looked) -> Self {
        let progress = looked.progress.as_ref();
        let known = progress.ok();
        Self {
            map: looked.map.to_string_lossy().into_owned(),
            complete: known.is_some_and(|progress| progress.complete),
            running: known.is_some_and(Progress::running),
            cells: known.map(|progress| progress.cells),
            cells_done: known.map(|progress| progress.cells_done),
            cells_per_second: known.and_then(Progress::cells_per_second),
            seconds_left: known.and_then(Progress::seconds_left),
            why: progress.err().map(|unknown| unknown.why.clone()),
        }
    }
}

/// The columns of a line: the map, its state, its cells, and the rate with the time left. Where
/// these are not known, the last says why.
fn columns(looked: &Looked) -> [String; 4] {
    let map = visible_line(&looked.map.to_string_lossy());
    let progress = match &looked.progress {
        Ok(progress) => progress,
        Err(unknown) => {
            let why = visible_line(&unknown.why);
            return [map, unknown.state.into(), String::new(), why];
        }
    };
    let (done, cells) = (grouped(progress.cells_done), grouped(progress.cells));
    let cells = format!("{done} of {cells} ({:.1} %)", progress.percent());
    let speed = speed(progress).unwrap_or_default();
    [map, progress.state().into(), cells, speed]
}

fn print(maps: &[Looked]) -> Result<(), Failure> {
    let rows: Vec<[String; 4]> = maps.iter().map(columns).collect();
    let width = |column: usize| {
        let widths = rows.iter().map(|row| row[column].chars().count());
        widths.max().unwrap_or(0)
    };
    let (name, state, cells) = (width(0), width(1), width(2));
    let mut text = String::new();
    for [map, its_state, its_cells, rest] in &rows {
        let line = match its_cells.is_empty() {
            true => format!("{map:<name$}  {its_state:<state$}  {rest}"),
            false => format!("{map:<name$}  {its_state:<state$}  {its_cells:>cells$}  {rest}"),
        };
        let _ = writeln!(text, "{}", line.trim_end());
    }
    say::text(&text)
}
