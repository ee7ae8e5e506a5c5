//! The reply to a request that cannot be answered: problem details (RFC 9457).

use std::convert::Infallible;

use serde::Serialize;

use crate::answers::trace::TraceError;
use crate::model::ModelError;
use crate::setting::no_answer::NoAnswer;
use crate::sweep::engine::RunError;
use crate::text::SpecError;

/// Why there is no answer; determines the HTTP status and its usual title.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Why {
    /// The request is not understood, or cannot be computed.
    Unprocessable,
    /// It exceeds the limits.
    TooLarge,
    /// The client has gone, or too many requests wait.
    Unavailable,
    /// A fault of the program.
    Fault,
}

impl Why {
    const fn status(self) -> (u16, &'static str) {
        match self {
            Self::Unprocessable => (422, "Unprocessable Entity"),
            Self::TooLarge => (413, "Payload Too Large"),
            Self::Unavailable => (503, "Service Unavailable"),
            Self::Fault => (500, "Internal Server Error"),
        }
    }
}

/// A problem.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "serve", derive(utoipa::ToSchema))]
pub struct Problem {
    /// The status of the answer.
    pub status: u16,
    /// The same in words.
    pub title: &'static str,
    /// What is wrong here.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub detail: Option<String>,
    /// What could be done.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub help: Option<String>,
    /// The bytes of the request's text that it is about: from and to.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub span: Option<[usize; 2]>,
}

impl Problem {
    /// A problem with this detail.
    #[must_use]
    pub fn new(why: Why, detail: impl Into<String>) -> Self {
        let (status, title) = why.status();
        Self {
            status,
            title,
            detail: Some(detail.into()),
            help: None,
            span: None,
        }
    }

    /// The same problem with a suggestion.
    #[must_use]
    pub fn help(self, help: impl Into<String>) -> Self {
        Self {
            help: Some(help.into()),
            ..self
        }
    }

    /// The problem of a computation that was stopped.
    #[must_use]
    pub fn stopped() -> Self {
        Self::new(Why::Unavailable, "stopped")
    }
}

impl From<SpecError> for Problem {
    fn from(error: SpecError) -> Self {
        Self {
            help: error.help,
            span: error.span.map(|span| [span.start, span.end]),
            ..Self::new(Why::Unprocessable, error.message)
        }
    }
}

impl From<ModelError> for Problem {
    fn from(error: ModelError) -> Self {
        Self::new(Why::Unprocessable, error.to_string())
    }
}

impl From<NoAnswer> for Problem {
    fn from(error: NoAnswer) -> Self {
        Self::new(Why::Unprocessable, error.to_string())
    }
}

impl From<RunError<Infallible>> for Problem {
    fn from(error: RunError<Infallible>) -> Self {
        match error {
            RunError::Interrupted => Self::stopped(),
            RunError::Memory { .. } => {
                Self::new(Why::Unprocessable, "there is no memory for its cells")
            }
            other => Self::new(Why::Unprocessable, other.to_string()),
        }
    }
}

impl From<TraceError> for Problem {
    fn from(error: TraceError) -> Self {
        let text = error.to_string();
        match error {
            TraceError::Stopped => Self::stopped(),
            TraceError::TooManyEvents(_) | TraceError::TooManySteps(_) => {
                Self::new(Why::TooLarge, text)
                    .help("run it: slipmap simulate CASE.toml has no such limit")
            }
            TraceError::Case(_)
            | TraceError::TooLong(_)
            | TraceError::OutgrowsPast
            | TraceError::NoFriction(_) => Self::new(Why::Unprocessable, text),
        }
    }
}

impl From<serde_json::Error> for Problem {
    fn from(error: serde_json::Error) -> Self {
        Self::new(Why::Fault, error.to_string())
    }
}
