//! What requests carry: texts, queries, and names in addresses.

use std::error::Error;

use axum::body::Bytes;
use axum::extract::rejection::QueryRejection;
use axum::extract::{FromRequestParts, Path, Query};
use axum::http::StatusCode;
use axum::http::header::{CONTENT_TYPE, HeaderMap};
use axum::http::request::Parts;

use super::problem::{Problem, nothing_here};

/// A name in an address.
pub(super) struct Named(pub String);

impl<S: Send + Sync> FromRequestParts<S> for Named {
    type Rejection = Problem;

    async fn from_request_parts(parts: &mut Parts, state: &S) -> Result<Self, Problem> {
        let name = Path::from_request_parts(parts, state).await;
        let Path(name) = name.map_err(|_| nothing_here())?;
        Ok(Self(name))
    }
}

/// A query, or why it is none.
pub(super) type Asked<T> = Result<Query<T>, QueryRejection>;

/// The contents of a query.
pub(super) fn said<T>(query: Asked<T>) -> Result<T, Problem> {
    let said = query.map_err(|rejected| {
        // What its source says, without the names of a library.
        let why = rejected
            .source()
            .map_or_else(|| rejected.body_text(), ToString::to_string);
        Problem::of(
            StatusCode::UNPROCESSABLE_ENTITY,
            format!("the query: {why}"),
        )
    });
    Ok(said?.0)
}

/// Whether a request says that its body is of this kind, and of no other.
pub(super) fn is(kind: &str, headers: &HeaderMap) -> bool {
    let mut kinds = headers.get_all(CONTENT_TYPE).iter();
    let said = kinds.next().filter(|_| kinds.next().is_none());
    let said = said.and_then(|said| said.to_str().ok());
    // A semicolon is followed by a charset, and TOML and JSON have only one.
    let said = said.and_then(|said| said.split(';').next()).map(str::trim);
    said.is_some_and(|said| said.eq_ignore_ascii_case(kind))
}

/// The text of a request.
pub(super) fn text(headers: &HeaderMap, body: &Bytes) -> Result<String, Problem> {
    if !is("application/toml", headers) {
        return Err(Problem::no_toml());
    }
    let text = std::str::from_utf8(body);
    Ok(text.map_err(|_| Problem::no_text())?.to_owned())
}

/// What the JSON of a request says.
pub(super) fn json<T: serde::de::DeserializeOwned>(
    headers: &HeaderMap,
    body: &Bytes,
) -> Result<T, Problem> {
    if !is("application/json", headers) {
        let detail = "the request is to be JSON: Content-Type: application/json";
        return Err(Problem::of(StatusCode::UNSUPPORTED_MEDIA_TYPE, detail));
    }
    let read = serde_json::from_slice(body);
    read.map_err(|error| Problem::of(StatusCode::UNPROCESSABLE_ENTITY, error.to_string()))
}
