//! Why something is not done, and how that is described.

use std::io::ErrorKind;

use axum::http::StatusCode;

use super::Jobs;
use crate::queue::QueueError;
use crate::serve::access::Role;
use crate::serve::problem::Problem;
use crate::store::StoreError;

impl Jobs {
    /// Whether who has this role may hand in sweeps, and change them.
    pub(super) fn may_change(&self, role: Role) -> bool {
        self.submission.keep_free.is_some() && role == Role::Any
    }

    /// The bytes of the disk that stay free, for who may hand in sweeps, and change them.
    pub(super) fn check(&self, role: Role) -> Result<u64, Problem> {
        let forbidden = |detail: &str| Problem::of(StatusCode::FORBIDDEN, detail);
        match (self.submission.keep_free, role) {
            (Some(keep_free), Role::Any) => Ok(keep_free),
            (Some(_), Role::Look) => Err(Problem::for_others()),
            (None, _) => Err(forbidden("this server takes no sweeps, and changes none")
                .help("slipmap serve FOLDER --submit does")),
        }
    }
}

impl From<QueueError> for Problem {
    fn from(error: QueueError) -> Self {
        let status = match &error {
            QueueError::NoSuchJob { .. } => StatusCode::NOT_FOUND,
            QueueError::NotNow { .. } | QueueError::NoNumber { .. } => StatusCode::CONFLICT,
            QueueError::Busy { .. } => StatusCode::SERVICE_UNAVAILABLE,
            QueueError::Store(StoreError::Io { source, .. }) => match source.kind() {
                // Somebody else has moved the file, or put another one in its place.
                ErrorKind::NotFound | ErrorKind::AlreadyExists => StatusCode::CONFLICT,
                ErrorKind::StorageFull | ErrorKind::QuotaExceeded => {
                    StatusCode::INSUFFICIENT_STORAGE
                }
                _ => StatusCode::INTERNAL_SERVER_ERROR,
            },
            QueueError::Store(_) | QueueError::NoProgram { .. } => {
                StatusCode::INTERNAL_SERVER_ERROR
            }
        };
        let near = match &error {
            QueueError::NoSuchJob { near, .. } => near.clone(),
            _ => None,
        };
        Self {
            help: near.map(|near| format!("there is {near}")),
            ..Self::of(status, error.to_string())
        }
    }
}

/// How a sweep may be refused.
#[derive(utoipa::IntoResponses)]
#[allow(dead_code, reason = "only described")]
pub(super) enum NotTaken {
    /// The text is not UTF-8
    #[response(status = 400, content_type = "application/problem+json")]
    Text(Problem),
    /// Without `--submit`, by who may only look, or by another page
    #[response(status = 403, content_type = "application/problem+json")]
    Forbidden(Problem),
    /// No name is left, or something else has taken it
    #[response(status = 409, content_type = "application/problem+json")]
    Conflict(Problem),
    /// The text is too long
    #[response(status = 413, content_type = "application/problem+json")]
    TooLarge(Problem),
    /// The request is not TOML
    #[response(status = 415, content_type = "application/problem+json")]
    Kind(Problem),
    /// The text is not understood, or names a file; the problem may say where
    #[response(status = 422, content_type = "application/problem+json")]
    Unprocessable(Problem),
    /// 1,000 sweeps wait or are held
    #[response(status = 429, content_type = "application/problem+json")]
    TooMany(Problem),
    /// The disk may not have room for its map
    #[response(status = 507, content_type = "application/problem+json")]
    NoRoom(Problem),
}

/// How a change may be refused.
#[derive(utoipa::IntoResponses)]
#[allow(dead_code, reason = "only described")]
pub(super) enum NotChanged {
    /// Without `--submit`, by who may only look, or by another page
    #[response(status = 403, content_type = "application/problem+json")]
    Forbidden(Problem),
    /// There is no sweep of this name
    #[response(status = 404, content_type = "application/problem+json")]
    None(Problem),
    /// Its state does not allow it, or has just changed
    #[response(status = 409, content_type = "application/problem+json")]
    Conflict(Problem),
    /// The change is not JSON
    #[response(status = 415, content_type = "application/problem+json")]
    Kind(Problem),
    /// The change is not understood
    #[response(status = 422, content_type = "application/problem+json")]
    Unprocessable(Problem),
}

/// How a request about a sweep may be refused.
#[derive(utoipa::IntoResponses)]
#[allow(dead_code, reason = "only described")]
pub(super) enum NoJob {
    /// There is no sweep of this name
    #[response(status = 404, content_type = "application/problem+json")]
    None(Problem),
}
