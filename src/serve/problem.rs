//! What is told of a request that cannot be answered: problem details in JSON (RFC 9457).

use axum::http::StatusCode;
use axum::http::header::{CONTENT_TYPE, HeaderValue};
use axum::response::{IntoResponse, Response};
use serde::Serialize;

use super::access::Refusal;
use crate::explore::chart::ChartError;
use crate::model::ModelError;
use crate::sweep::SpecError;

/// A problem.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(super) struct Problem {
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
    pub(super) fn of(status: StatusCode, detail: impl Into<String>) -> Self {
        Self {
            status: status.as_u16(),
            title: status.canonical_reason().unwrap_or("error"),
            detail: Some(detail.into()),
            help: None,
            span: None,
        }
    }
}

/// What is told where there is nothing.
pub(super) fn nothing_here() -> Problem {
    Problem::of(StatusCode::NOT_FOUND, "there is nothing at this address")
}

impl IntoResponse for Problem {
    fn into_response(self) -> Response {
        let status = StatusCode::from_u16(self.status);
        let status = status.unwrap_or(StatusCode::INTERNAL_SERVER_ERROR);
        let mut response = (status, axum::Json(self)).into_response();
        let kind = HeaderValue::from_static("application/problem+json");
        response.headers_mut().insert(CONTENT_TYPE, kind);
        response
    }
}

impl From<Refusal> for Problem {
    fn from(refusal: Refusal) -> Self {
        match refusal {
            Refusal::Host => Self::of(
                StatusCode::MISDIRECTED_REQUEST,
                "this server answers as 127.0.0.1, localhost and [::1], or its own address, only",
            ),
            Refusal::Token => Self {
                help: Some("open the link that slipmap serve has printed".into()),
                ..Self::of(StatusCode::UNAUTHORIZED, "no token, or another one")
            },
            Refusal::Origin => Self::of(StatusCode::FORBIDDEN, "sent by another page"),
        }
    }
}

impl From<SpecError> for Problem {
    fn from(error: SpecError) -> Self {
        Self {
            help: error.help,
            span: error.span.map(|span| [span.start, span.end]),
            ..Self::of(StatusCode::UNPROCESSABLE_ENTITY, error.message)
        }
    }
}

impl From<ModelError> for Problem {
    fn from(error: ModelError) -> Self {
        Self::of(StatusCode::UNPROCESSABLE_ENTITY, error.to_string())
    }
}

impl From<ChartError> for Problem {
    fn from(error: ChartError) -> Self {
        match error {
            ChartError::Spec(error) => error.into(),
            ChartError::TooManyCells { .. } => Self {
                help: Some("run it: slipmap run SWEEP.toml has no such limit".into()),
                ..Self::of(StatusCode::PAYLOAD_TOO_LARGE, error.to_string())
            },
            ChartError::Stopped => Self::of(StatusCode::SERVICE_UNAVAILABLE, "stopped"),
            ChartError::Failed(why) => Self::of(StatusCode::UNPROCESSABLE_ENTITY, why),
        }
    }
}
