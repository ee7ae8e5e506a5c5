//! How a command fails: the message for the user, and the exit code.

use std::path::Path;
use std::process::ExitCode;

use crate::model::ModelError;
use crate::queue::QueueError;
use crate::setting::no_answer::NoAnswer;
use crate::store::StoreError;
use crate::text::Shown;
use crate::text::SpecError;
use miette::{LabeledSpan, MietteDiagnostic, NamedSource, Report};

use super::excerpt::excerpt;
use super::kind::Kind;
use super::say::{self, shortened, visible, visible_line};

/// Why a command did not complete.
pub(super) enum Failure {
    /// Exit code 1: it could not be done.
    Failed(Report),
    /// Exit code 2: the input is invalid.
    BadInput(Report),
    /// Exit code 3: another run works on this map.
    Busy(Report),
    /// Exit code 0: the reader of the output has gone.
    ReaderGone,
    /// Exit code 129, 130 or 143: a signal.
    Interrupted {
        /// What the command leaves behind.
        message: String,
        /// The exit code.
        code: u8,
    },
}

impl Failure {
    /// A failure, in words.
    pub(super) fn failed(message: impl Into<String>) -> Self {
        Self::Failed(Report::new(shown(message)))
    }

    /// A failure with advice.
    pub(super) fn failed_with_help(message: impl Into<String>, help: impl Into<String>) -> Self {
        Self::Failed(Report::new(shown(message).with_help(visible(&help.into()))))
    }

    /// Bad input, in words.
    pub(super) fn bad_input(message: impl Into<String>) -> Self {
        Self::BadInput(Report::new(shown(message)))
    }

    /// Bad input with advice.
    pub(super) fn bad_input_with_help(message: impl Into<String>, help: impl Into<String>) -> Self {
        Self::BadInput(Report::new(shown(message).with_help(visible(&help.into()))))
    }

    /// A flag with a value that its parameter does not allow.
    pub(super) fn out_of_range(flag: &str, error: &ModelError) -> Self {
        Self::bad_input(format!(
            "{flag} {} is outside its range: {}",
            Shown(error.value),
            error.allowed
        ))
    }

    /// Bad input without a place.
    pub(super) fn of_input(error: SpecError) -> Self {
        let diagnostic = shown(error.message);
        Self::BadInput(Report::new(match error.help {
            Some(help) => diagnostic.with_help(visible(&help)),
            None => diagnostic,
        }))
    }

    /// Bad input at a place of a file.
    pub(super) fn in_file(error: SpecError, name: &str, text: &str) -> Self {
        let name = visible_line(name);
        let mut diagnostic = shown(error.message);
        if let Some(help) = error.help {
            diagnostic = diagnostic.with_help(visible(&help));
        }
        let Some(span) = error.span else {
            diagnostic.message = format!("{name}: {}", diagnostic.message);
            return Self::BadInput(Report::new(diagnostic));
        };
        let (text, span) = excerpt(text, span);
        let text = &*text;
        // Line ends of a text from Windows are not spelled out.
        let shown = |text: &str| visible(&text.replace("\r\n", "\n"));
        let place = |at: usize| text.get(..at).map_or(0, |before| shown(before).len());
        let span = place(span.start)..place(span.end);
        let diagnostic = diagnostic.with_label(LabeledSpan::at(span, "here"));
        let source = NamedSource::new(name, shown(text));
        Self::BadInput(Report::new(diagnostic).with_source_code(source))
    }

    /// Prints the failure to standard error and gives the exit code.
    pub(super) fn report(self) -> ExitCode {
        let (report, code) = match self {
            Self::Interrupted { message, code } => {
                say::remark(message);
                return ExitCode::from(code);
            }
            Self::ReaderGone => return ExitCode::SUCCESS,
            Self::Failed(report) => (report, 1),
            Self::BadInput(report) => (report, 2),
            Self::Busy(report) => (report, 3),
        };
        say::coloured(format_args!("{report:?}"));
        ExitCode::from(code)
    }
}

/// A message, which may quote a file.
fn shown(message: impl Into<String>) -> MietteDiagnostic {
    MietteDiagnostic::new(visible(&shortened(&message.into())))
}

impl From<StoreError> for Failure {
    fn from(error: StoreError) -> Self {
        if let StoreError::NotAMap { path, .. } | StoreError::NotATrace { path, .. } = &error
            && let Some(kind @ Kind::Text(_)) = Kind::of(path)
        {
            let (message, help) = kind.not(path, "a map or a trace");
            return Self::bad_input_with_help(message, help);
        }
        let mut diagnostic = shown(error.to_string());
        let help = match error {
            StoreError::OtherTiles { .. } => {
                Some("--fresh starts over, dropping the tiles; -o writes elsewhere")
            }
            StoreError::Manifest { .. } => Some(
                "the `slipmap run` that began these tiles writes it anew and goes on; --fresh \
                 starts over, dropping them; -o writes elsewhere",
            ),
            StoreError::Locked { .. } => {
                Some("`slipmap status MAP.h5` says how far it is; once it has ended, try again")
            }
            _ => None,
        };
        if let Some(help) = help {
            diagnostic = diagnostic.with_help(help);
        }
        let report = Report::new(diagnostic);
        match error {
            StoreError::Locked { .. } => Self::Busy(report),
            StoreError::OtherTiles { .. }
            | StoreError::Manifest { .. }
            | StoreError::Foreign { .. }
            | StoreError::NotAMap { .. }
            | StoreError::NotATrace { .. }
            | StoreError::Io { action: "open", .. } => Self::BadInput(report),
            _ => Self::Failed(report),
        }
    }
}

impl From<QueueError> for Failure {
    fn from(error: QueueError) -> Self {
        let message = error.to_string();
        match error {
            QueueError::Store(error) => error.into(),
            QueueError::NoSuchJob { near, .. } => match near {
                Some(near) => Self::bad_input_with_help(message, format!("did you mean {near}?")),
                None => Self::bad_input_with_help(message, "`slipmap jobs FOLDER` lists them"),
            },
            QueueError::NotNow { .. } => Self::bad_input(message),
            QueueError::NoNumber { .. } => Self::bad_input_with_help(
                message,
                "rename files of the queue, or begin another folder",
            ),
            QueueError::Busy { .. } => Self::failed(message),
            QueueError::NoProgram { path, .. } => {
                let help = match path == Path::new("sbatch") {
                    true => "this is no machine from which Slurm takes jobs",
                    false => "where it was replaced, start the worker again",
                };
                Self::failed_with_help(message, help)
            }
        }
    }
}

impl From<ModelError> for Failure {
    fn from(error: ModelError) -> Self {
        Self::bad_input(error.to_string())
    }
}

impl From<NoAnswer> for Failure {
    fn from(error: NoAnswer) -> Self {
        Self::bad_input(error.to_string())
    }
}

impl From<std::io::Error> for Failure {
    fn from(error: std::io::Error) -> Self {
        if error.kind() == std::io::ErrorKind::BrokenPipe {
            return Self::ReaderGone;
        }
        let message = format!("cannot write to standard output: {error}");
        Self::Failed(Report::new(MietteDiagnostic::new(message)))
    }
}
