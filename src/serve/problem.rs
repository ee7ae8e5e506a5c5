//! Problems as answers: the reply to a request that cannot be answered (RFC 9457).

use axum::http::StatusCode;
use axum::http::header::{CONTENT_TYPE, HeaderValue, RETRY_AFTER};
use axum::response::{IntoResponse, Response};

use super::access::Refusal;
pub(super) use crate::explore::Problem;

/// Seconds after which a request that cannot be answered now may be repeated.
const SOON: &str = "2";

impl Problem {
    /// A problem with any status.
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

impl Problem {
    /// The problem of a request that is not TOML but should be.
    pub(super) fn no_toml() -> Self {
        let detail = "the request is to be TOML: Content-Type: application/toml";
        Self::of(StatusCode::UNSUPPORTED_MEDIA_TYPE, detail)
    }

    /// The problem of a request by those who may only look.
    pub(super) fn for_others() -> Self {
        Self {
            help: Some("slipmap serve has printed another link, for who may do that".into()),
            ..Self::of(StatusCode::FORBIDDEN, "this link is for those who look")
        }
    }

    /// The problem of a request that is not text but should be.
    pub(super) fn no_text() -> Self {
        Self::of(StatusCode::BAD_REQUEST, "the text is not UTF-8")
    }
}

/// How any request may be refused, for the description of the interface.
#[derive(utoipa::IntoResponses)]
#[allow(dead_code, reason = "only described")]
pub(super) enum Denied {
    /// No token, or another one
    #[response(status = 401, content_type = "application/problem+json")]
    Token(Problem),
    /// For another host
    #[response(status = 421, content_type = "application/problem+json")]
    Host(Problem),
    /// Too many wait, or it takes too long
    #[response(status = 503, content_type = "application/problem+json")]
    Unavailable(Problem),
}

/// How requests with a text may be refused besides.
#[derive(utoipa::IntoResponses)]
#[allow(dead_code, reason = "only described")]
pub(super) enum Refused {
    /// The text is not UTF-8
    #[response(status = 400, content_type = "application/problem+json")]
    Text(Problem),
    /// Sent by another page
    #[response(status = 403, content_type = "application/problem+json")]
    Origin(Problem),
    /// It asks for more than is computed at once, or the text is too long
    #[response(status = 413, content_type = "application/problem+json")]
    TooLarge(Problem),
    /// The request is not TOML
    #[response(status = 415, content_type = "application/problem+json")]
    Kind(Problem),
    /// The text is not understood, or out of range; the problem may say where
    #[response(status = 422, content_type = "application/problem+json")]
    Unprocessable(Problem),
}

/// The answer for an address without a resource.
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
        if status == StatusCode::SERVICE_UNAVAILABLE {
            let soon = HeaderValue::from_static(SOON);
            response.headers_mut().insert(RETRY_AFTER, soon);
        }
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
