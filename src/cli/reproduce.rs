//! `slipmap reproduce`: the letter computed again, claim by claim, as a page of HTML and as JSON.

use std::cell::RefCell;
use std::path::{Path, PathBuf};

use crate::letter::{
    GENERATOR, GENERATOR_OF_COMPARE, LetterError, Reproduction, Verdict, Workshop, reproduce,
};
use crate::report::progress::Progress;
use crate::store::{Output, regular};
use crate::sweep::events::Attended;
use crate::sweep::{Event, Observer};

use super::failure::Failure;
use super::json::{self, AnswerSchema, Inputs};
use super::output::provenance;
use super::run::{default_threads, parse_threads};
use super::say;
use super::signals::Signals;

/// The default page.
const PAGE: &str = "letter.html";
/// The first bytes of a page, which name its generator.
const HEAD: u64 = 1024;

#[derive(Debug, clap::Args)]
#[command(
    after_help = "Takes up to ten minutes on two cores, a minute with --quick. Each claim of \
the letter comes with its place, what
is found instead, the verdict (confirmed, refined, contradicted), how it was \
computed, the command that repeats it, and
the map or trace behind it.

Example: slipmap reproduce --quick -o letter.html --keep letter"
)]
pub(super) struct Args {
    /// Coarser maps, in a minute
    #[arg(long)]
    quick: bool,
    /// The page to write [default: letter.html, in the current folder; with --json: none]
    #[arg(short, long, value_name = "PAGE.html")]
    output: Option<PathBuf>,
    /// Keep maps, traces, pictures and the files they were made from in this folder
    #[arg(long, value_name = "FOLDER")]
    keep: Option<PathBuf>,
    /// Threads to compute on [default: as many as the machine offers]
    #[arg(long, value_name = "N", value_parser = parse_threads)]
    threads: Option<usize>,
    /// One JSON object on standard output
    #[arg(long)]
    json: bool,
}

/// Shows a bar for each sweep.
struct Bars(RefCell<Progress>);

impl Observer for Bars {
    fn event(&self, event: &Event) {
        if matches!(event, Event::Started { .. }) {
            self.0.replace(Progress::new(say::is_quiet()));
        }
        self.0.borrow().event(event);
    }
}

/// Runs the subcommand.
pub(super) fn main(args: &Args) -> Result<(), Failure> {
    let signals = Signals::catch()?;
    let page = page(args)?;
    // Claimed before the computation, so that a name that cannot be written fails at once.
    let output = page.map(Output::claim).transpose()?;
    let folder = Folder::of(args.keep.as_deref())?;
    let bars = Bars(RefCell::new(Progress::new(true)));
    let made = provenance("reproduce", Path::new(PAGE));
    let told = |step: &str| say::note(step);
    let attended = Attended {
        observer: &bars,
        stop: &signals.stop,
    };
    let threads = args.threads.unwrap_or_else(default_threads);
    let (path, kept) = (folder.path(), args.keep.is_some());
    let workshop = Workshop::new(path, kept, args.quick, threads, &made, attended, &told);
    let found = reproduce(workshop).map_err(|error| {
        bars.0.borrow().clear();
        failure(error, args, &signals)
    })?;
    if let Some(output) = output {
        let (version, revision) = (&made.program_version, &made.git_revision);
        let (time, _) = made.history.split_once(' ').unwrap_or_default();
        let by = format!("slipmap {version} ({revision}), {time}");
        output.fill(found.page(&by, args.quick))?;
    }
    if args.json {
        let inputs = Inputs::default().and("quick", args.quick);
        let inputs = inputs.and("output", page).and("keep", &args.keep);
        return json::print(&inputs, &found);
    }
    tell(&found, page)
}

/// The schema of its JSON.
pub(super) fn described() -> AnswerSchema {
    AnswerSchema::of("reproduce").or::<Reproduction>()
}

/// Prints every claim on a line: its verdict, its name, and its most telling value.
fn tell(found: &Reproduction, page: Option<&Path>) -> Result<(), Failure> {
    for claim in &found.claims {
        let value = claim.values.first();
        let value = value.map(|value| format!("{}: {}", value.name, value.shown()));
        say::result(format_args!(
            "{:<12} {:<18} {}",
            claim.verdict.name(),
            claim.name,
            value.unwrap_or_default()
        ))?;
    }
    let counts = [Verdict::Confirmed, Verdict::Refined, Verdict::Contradicted];
    let counts = counts.map(|verdict| format!("{} {}", found.with(verdict), verdict.name()));
    say::result(format_args!(
        "{} claims: {}",
        found.claims.len(),
        counts.join(", ")
    ))?;
    page.map_or(Ok(()), |page| say::result(page.display()))
}

/// Where maps are made: a folder that is kept, or one that is removed at the end.
enum Folder<'a> {
    Kept(&'a Path),
    Gone(tempfile::TempDir),
}

impl<'a> Folder<'a> {
    fn of(kept: Option<&'a Path>) -> Result<Self, Failure> {
        let Some(path) = kept else {
            let folder = tempfile::tempdir().map_err(|error| {
                Failure::failed(format!("no temporary folder can be made: {error}"))
            })?;
            return Ok(Self::Gone(folder));
        };
        if path.is_dir() {
            return Ok(Self::Kept(path));
        }
        std::fs::create_dir(path).map_err(|error| {
            let shown = path.display();
            let message = format!("--keep {shown}: the folder cannot be made: {error}");
            Failure::bad_input_with_help(message, "its parent has to be a folder")
        })?;
        Ok(Self::Kept(path))
    }

    fn path(&self) -> &Path {
        match self {
            Self::Kept(path) => path,
            Self::Gone(folder) => folder.path(),
        }
    }
}

/// The page to write, if any. Its name must be that of a page, and it may replace only an earlier
/// page.
fn page(args: &Args) -> Result<Option<&Path>, Failure> {
    let path = match &args.output {
        None if args.json => return Ok(None),
        None => Path::new(PAGE),
        Some(path) => path,
    };
    page_named(path).map(Some)
}

/// The page of this name, which may replace only an earlier page.
pub(super) fn page_named(path: &Path) -> Result<&Path, Failure> {
    let shown = path.display();
    let extension = path.extension().map(|e| e.to_string_lossy().to_lowercase());
    if !matches!(extension.as_deref(), Some("html" | "htm")) {
        return Err(Failure::bad_input_with_help(
            format!("--output {shown} is no name for a page"),
            "name it like letter.html; --json prints JSON on standard output",
        ));
    }
    let folder = path
        .parent()
        .filter(|folder| !folder.as_os_str().is_empty());
    if let Some(folder) = folder.filter(|folder| !folder.is_dir()) {
        let folder = folder.display();
        return Err(Failure::bad_input(format!(
            "--output {shown}: {folder} is no folder"
        )));
    }
    if path.symlink_metadata().is_ok() && !is_page(path) {
        return Err(Failure::bad_input_with_help(
            format!("{shown} is already there, and no page of slipmap"),
            "it is left as it is; remove it first, or write elsewhere with -o",
        ));
    }
    Ok(path)
}

/// Whether a file is an earlier page.
fn is_page(path: &Path) -> bool {
    let head = regular::head(path, HEAD);
    head.is_ok_and(|head| {
        let head = String::from_utf8_lossy(&head);
        [GENERATOR, GENERATOR_OF_COMPARE]
            .iter()
            .any(|generator| head.contains(generator))
    })
}

fn failure(error: LetterError, args: &Args, signals: &Signals) -> Failure {
    match error {
        LetterError::Stopped => signals.interrupted(match &args.keep {
            None => "nothing is written".to_owned(),
            Some(folder) => format!(
                "no page is written; what is computed is kept in {}, the same command goes on \
                 from there",
                folder.display()
            ),
        }),
        error @ LetterError::Foreign { .. } => Failure::bad_input_with_help(
            error.to_string(),
            "it is left as it is; --keep names another folder",
        ),
        LetterError::Store(error) => error.into(),
        LetterError::Run(crate::sweep::RunError::Sink(error)) => error.into(),
        error => Failure::failed(error.to_string()),
    }
}
