//! Problems as answers: what is told of a request that cannot be answered (RFC 9457).

use axum::http::StatusCode;
use axum::http::header::{CONTENT_TYPE, HeaderValue};
use axum::response::{IntoResponse, Response};

use super::access::Refusal;
pub(super) use crate::explore::Problem;

impl Problem {
    /// With any status.
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
                "this server answers as 127.0.0.1, localhost and [::1] only",
            ),
            Refusal::Token => Self {
                help: Some("open the link that slipmap serve has printed".into()),
                ..Self::of(StatusCode::UNAUTHORIZED, "no token, or another one")
            },
            Refusal::Origin => Self::of(StatusCode::FORBIDDEN, "sent by another page"),
        }
    }
}
