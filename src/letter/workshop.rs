//! Maps and traces behind claims: computed into files of a folder, drawn, and read.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use serde::Serialize;
use utoipa::ToSchema;

use super::LetterError;
use super::kept_picture::{is_kept, marked};
use crate::answers::Trace;
use crate::answers::samples::Most;
use crate::answers::trace::MOST_SAMPLES;
use crate::maps::maker::{self, Job};
use crate::model::stop::Stop;
use crate::report::picture::{self, PictureOptions};
use crate::setting::case_file::is_case_file;
use crate::setting::quantity::Quantity;
use crate::setting::{CaseSpec, Field, SweepSpec};
use crate::store::map_file::Plane;
use crate::store::tiles::shards;
use crate::store::trace_reader::case_of;
use crate::store::{MapFile, Output, regular, trace_file};
use crate::sweep::Plan;
use crate::sweep::described::root::Provenance;
use crate::sweep::described::schema::root;
use crate::sweep::events::Attended;

/// The sweep or case behind a claim.
#[derive(Debug, Clone, Copy)]
pub(super) struct Source {
    /// The name of its file in `sweeps`.
    pub name: &'static str,
    /// The text of that file.
    pub text: &'static str,
    /// Replacements in the text, because the whole would take too long for a page.
    pub always: &'static [(&'static str, &'static str)],
    /// Further replacements in a quick run.
    pub quick: &'static [(&'static str, &'static str)],
}

impl Source {
    /// The text after replacements.
    pub(super) fn text(&self, quick: bool) -> String {
        let replaced = self.always.iter();
        let replaced = replaced.chain(self.quick.iter().filter(|_| quick));
        replaced.fold(self.text.to_owned(), |text, (from, to)| {
            text.replace(from, to)
        })
    }
}

/// The source `sweeps/NAME.toml`, with replacements in its text.
macro_rules! source {
    ($name:literal) => {
        source!($name, always: [], quick: [])
    };
    ($name:literal, quick: [$($quick:expr),*]) => {
        source!($name, always: [], quick: [$($quick),*])
    };
    ($name:literal, always: [$($always:expr),*], quick: [$($quick:expr),*]) => {
        $crate::letter::workshop::Source {
            name: $name,
            text: include_str!(concat!("../../sweeps/", $name, ".toml")),
            always: &[$($always),*],
            quick: &[$($quick),*],
        }
    };
}
pub(super) use source;

/// A map or a trace behind claims.
#[derive(Debug, Clone, PartialEq, Serialize, ToSchema)]
pub(crate) struct Figure {
    /// Its name.
    pub name: &'static str,
    /// What it shows.
    pub title: String,
    /// The command that makes it.
    pub command: String,
    /// The sweep or case file that it was made from.
    pub source: String,
    /// Whether that is `sweeps/NAME.toml` as it stands.
    pub shipped: bool,
    /// Its map or trace; null where that is not kept.
    #[schema(required)]
    pub file: Option<String>,
    /// Its picture, SVG.
    #[serde(skip)]
    pub svg: String,
}

/// The settings and results of a reproduction of the letter.
pub(crate) struct Workshop<'a> {
    /// The folder in which maps, traces, sweeps and pictures are made.
    pub folder: &'a Path,
    /// Whether the folder is kept.
    pub kept: bool,
    /// Whether to use coarser maps: about a minute on two cores.
    pub quick: bool,
    /// Number of computing threads.
    pub threads: usize,
    /// Who makes the maps.
    pub provenance: &'a Provenance,
    /// Who observes the run, and what stops it.
    pub attended: Attended<'a>,
    /// Receives a message for each step.
    pub tell: &'a dyn Fn(&str),
    /// The maps and traces made so far, by name.
    pub(super) made: BTreeMap<&'static str, Figure>,
}

/// What was made of a source.
struct Made<'p> {
    title: String,
    /// The sweep or the case.
    text: String,
    /// The command that makes it.
    command: &'static str,
    /// The picture, as SVG.
    picture: &'p [u8],
}

impl<'a> Workshop<'a> {
    /// A workshop in a folder, with nothing made yet.
    #[must_use]
    pub(crate) fn new(
        folder: &'a Path,
        kept: bool,
        quick: bool,
        threads: usize,
        provenance: &'a Provenance,
        attended: Attended<'a>,
        tell: &'a dyn Fn(&str),
    ) -> Self {
        Self {
            folder,
            kept,
            quick,
            threads,
            provenance,
            attended,
            tell,
            made: BTreeMap::new(),
        }
    }

    /// A flag that ends motions and searches when the run ends.
    pub(super) fn stop(&self) -> Stop {
        Stop::when(self.attended.stop)
    }

    /// Reports a step, unless the run is stopped.
    pub(super) fn step(&self, what: &str) -> Result<(), LetterError> {
        if self.stop().is_set() {
            return Err(LetterError::Stopped);
        }
        (self.tell)(what);
        Ok(())
    }

    /// The map of a sweep, computed and drawn.
    pub(super) fn map(&mut self, source: &Source) -> Result<MapFile, LetterError> {
        self.step(&format!("the map {}", source.name))?;
        let text = source.text(self.quick);
        let path = self.written(source, &text)?;
        let spec: SweepSpec = text.parse().map_err(LetterError::spec(source.name))?;
        let title = spec.title.clone();
        let plan = Plan::new(spec).map_err(LetterError::spec(source.name))?;
        if !self.is_finished(&path, &plan)? {
            let job = Job::new(&path, self.threads, self.provenance);
            maker::make(&Arc::new(plan), &job, self.attended)?;
        }
        let map = MapFile::open(&path)?;
        let options = PictureOptions::default();
        let drawn = picture::draw(&map, &path.with_extension("svg"), &options)?;
        let made = Made {
            title,
            text,
            command: "run",
            picture: drawn.bytes(),
        };
        self.keep(source, made)?;
        Ok(map)
    }

    /// Whether the whole map of a plan, from this very program, stands at `path` with nothing left
    /// to do. What another version has computed is computed again.
    fn is_finished(&self, path: &Path, plan: &Plan) -> Result<bool, LetterError> {
        if !there(path) || !shards::present(path)?.is_empty() {
            return Ok(false);
        }
        let map = MapFile::open(path)?;
        let (hash, by) = (plan.hash(), self.provenance);
        let facts = [
            (root::PLAN_HASH, &hash),
            (root::SWEEP, &plan.spec.text),
            (root::PROGRAM_VERSION, &by.program_version),
            (root::GIT_REVISION, &by.git_revision),
        ];
        let told = |(name, value): (&str, &String)| map.root_text(name).as_ref() == Some(value);
        Ok(!map.is_partial() && facts.into_iter().all(told))
    }

    /// The motion of a case, computed and drawn.
    pub(super) fn motion(&mut self, source: &Source) -> Result<(CaseSpec, Trace), LetterError> {
        self.step(&format!("the motion {}", source.name))?;
        let text = source.text(self.quick);
        let path = self.written(source, &text)?;
        let spec: CaseSpec = text.parse().map_err(LetterError::spec(source.name))?;
        let most = Most::Refused(MOST_SAMPLES);
        let trace = Trace::within(&spec, most, &self.stop())?;
        if self.kept {
            trace_file::write(&spec, &trace, Output::claim(&path)?, self.provenance)?;
        }
        let options = PictureOptions::default();
        let picture = path.with_extension("svg");
        let drawn = picture::draw_trace(&spec, &trace, &path, &picture, &options)?;
        let made = Made {
            title: spec.title.clone(),
            text,
            command: "simulate",
            picture: drawn.bytes(),
        };
        self.keep(source, made)?;
        Ok((spec, trace))
    }

    /// The path of the file of a source, and whether the file already exists.
    ///
    /// # Errors
    /// When another file has this name, or the name of its map, trace or picture.
    fn place(&self, source: &Source) -> Result<(PathBuf, bool), LetterError> {
        let path = self.folder.join(format!("{}.toml", source.name));
        let text = source.text(self.quick);
        let there_now = regular::read(&path, text.len() as u64);
        let same = there_now.is_ok_and(|bytes| bytes == text.as_bytes());
        let [data, picture] = ["h5", "svg"].map(|extension| path.with_extension(extension));
        let foreign = match there(&data) {
            // What is written first is there first.
            _ if !same => [path.clone(), data, picture].into_iter().find(|p| there(p)),
            true if !is_of(&data, source.name, &text)? => Some(data),
            _ => Some(picture).filter(|p| there(p) && !is_kept(p, source.name)),
        };
        match foreign {
            Some(path) => Err(LetterError::Foreign { path }),
            None => Ok((path, same)),
        }
    }

    /// Checks that files can be made from all these sources.
    ///
    /// # Errors
    /// When a name is taken by another file.
    pub(super) fn look(&self, sources: &[&Source]) -> Result<(), LetterError> {
        let mut places = sources.iter().map(|source| self.place(source));
        places.try_for_each(|place| place.map(drop))
    }

    /// Writes the text of a source into the folder. Returns the path of its map or trace.
    fn written(&self, source: &Source, text: &str) -> Result<PathBuf, LetterError> {
        let (path, same) = self.place(source)?;
        if !same {
            put(&path, text.as_bytes())?;
        }
        Ok(path.with_extension("h5"))
    }

    /// Records a finished map or trace.
    fn keep(
        &mut self,
        source: &Source,
        Made {
            title,
            text,
            command,
            picture,
        }: Made,
    ) -> Result<(), LetterError> {
        let svg = String::from_utf8_lossy(picture).into_owned();
        let shipped = text == source.text;
        let (name, folder) = (source.name, self.folder.display());
        let file = match () {
            () if shipped => format!("sweeps/{name}.toml"),
            () if self.kept => format!("{folder}/{name}.toml"),
            () => format!("{name}.toml"),
        };
        if self.kept {
            let path = self.folder.join(format!("{name}.svg"));
            let bytes = marked(picture, name);
            match there(&path) {
                true if holds(&path, &bytes) => {}
                true if holds(&path, &bytes) => {}
                true if !is_kept(&path, name) => return Err(LetterError::Foreign { path }),
                _ => put(&path, &bytes)?,
            }
        }
        let figure = Figure {
            name,
            title,
            command: format!("slipmap {command} {file}"),
            source: text,
            shipped,
            file: self.kept.then(|| format!("{folder}/{name}.h5")),
            svg,
        };
        self.made.insert(name, figure);
        Ok(())
    }
}

/// Whether anything has this name.
fn there(path: &Path) -> bool {
    path.symlink_metadata().is_ok()
}

/// Whether a file is the map or the trace of a sweep or case.
fn is_of(path: &Path, name: &'static str, text: &str) -> Result<bool, LetterError> {
    if is_case_file(text) {
        return Ok(case_of(path).is_ok_and(|case| case == text));
    }
    let spec = text.parse().map_err(LetterError::spec(name))?;
    let hash = Plan::new(spec).map_err(LetterError::spec(name))?.hash();
    let map = MapFile::open(path);
    Ok(map.is_ok_and(|map| map.root_text(root::PLAN_HASH) == Some(hash)))
}

/// Writes a whole file.
fn put(path: &Path, bytes: &[u8]) -> Result<(), LetterError> {
    let output = Output::claim(path)?;
    std::fs::write(output.part(), bytes).map_err(LetterError::io("write", path))?;
    Ok(output.commit()?)
}

/// Whether a file holds just these bytes.
fn holds(path: &Path, bytes: &[u8]) -> bool {
    let found = regular::read(path, bytes.len() as u64);
    found.is_ok_and(|found| found == bytes)
}

/// The values of the axes before a plane.
type Place = Vec<(Quantity, f64)>;

/// The planes of a field over the last two axes of a map, with the values of the axes before them.
pub(super) fn planes(map: &MapFile, field: Field) -> Result<Vec<(Place, Plane)>, LetterError> {
    let axes = map.axes();
    let of = axes.len();
    let plane = (of.saturating_sub(2), of - 1);
    let outer = &axes[..plane.0];
    let mut found = Vec::new();
    for number in 0..outer.iter().map(|axis| axis.values.len()).product() {
        let (mut index, mut left) = (vec![0; of], number);
        for (place, axis) in index.iter_mut().zip(outer).rev() {
            *place = left % axis.values.len();
            left /= axis.values.len();
        }
        let values = index.iter().zip(outer);
        let values = values.map(|(&i, axis)| (axis.parameter.clone(), axis.values[i]));
        found.push((
            values.collect(),
            map.plane(field, &index, plane, usize::MAX)?,
        ));
    }
    Ok(found)
}

/// All cells of a field in the order of the axes.
pub(super) fn column(map: &MapFile, field: Field) -> Result<Vec<f64>, LetterError> {
    let planes = planes(map, field)?;
    Ok(planes.into_iter().flat_map(|(_, p)| p.cells).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::letter::{limits, motions, robustness, short_delay, stability};

    /// The replaced text occurs in each source, and the result is a sweep or a case.
    #[test]
    fn every_source_is_read_in_full_and_quick() {
        let sources = [
            &stability::SOURCES[..],
            &limits::SOURCES,
            &motions::SOURCES,
            &robustness::SOURCES,
            &short_delay::SOURCES,
        ];
        let mut replaced = 0;
        for source in sources.concat() {
            for (from, _) in source.always.iter().chain(source.quick) {
                assert!(source.text.contains(from), "{}: {from}", source.name);
                replaced += 1;
            }
            for quick in [false, true] {
                let text = source.text(quick);
                match is_case_file(&text) {
                    true => drop(text.parse::<CaseSpec>().unwrap()),
                    false => drop(text.parse::<SweepSpec>().unwrap()),
                }
            }
        }
        assert!(replaced > 10, "{replaced}");
    }
}
