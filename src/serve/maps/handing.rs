//! The request that hands over a map, and what is read of its body.

use std::fs::File;
use std::future::poll_fn;
use std::io::{self, Write};
use std::pin::Pin;
use std::sync::Arc;
use std::time::Duration;

use axum::body::Body;
use axum::extract::State;
use axum::http::header::HeaderMap;
use axum::http::{Method, StatusCode, Uri};
use axum::response::{IntoResponse, Response};
use axum::{Extension, Json};
use hyper::body::Body as Parts;
use serde::{Deserialize, Serialize};
use tokio::time::timeout;
use utoipa::{IntoParams, ToSchema};

use super::file::KIND;
use super::frames::Ask;
use super::readers::Maps;
use super::visiting::Visitor;
use crate::serve::access::Role;
use crate::serve::asked::{Asked, is, said};
use crate::serve::connections::{TO_ASK, closing};
use crate::serve::problem::{Denied, Problem};
use crate::serve::room::place;

/// The most bytes of a map that visits.
const MOST_BYTES: u64 = 64 << 20;
/// The longest time to send a map; no part of it may take longer than a request's body.
const TO_SEND: Duration = Duration::from_secs(600);
/// Bytes that are written at a time.
const PIECE: usize = 1 << 20;
/// The most letters of a map's name.
const LONGEST_NAME: usize = 255;
/// The address at which maps are handed over.
const ADDRESS: &str = "/api/v1/maps";

/// Whether a request hands over a map: its body is longer than that of others.
pub(in crate::serve) fn is_visit(method: &Method, uri: &Uri) -> bool {
    method == Method::POST && uri.path() == ADDRESS
}

/// What is said of a map that visits.
#[derive(Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
pub(super) struct VisitQuery {
    /// What it is called while it is looked at.
    #[param(max_length = 255)]
    name: Option<String>,
}

/// A map that visits.
#[derive(Serialize, ToSchema)]
pub(super) struct Visit {
    /// For all that is asked about it.
    id: String,
}

/// How a map may be refused.
#[derive(utoipa::IntoResponses)]
#[allow(dead_code, reason = "only described")]
enum NotRead {
    /// The body ends too early
    #[response(status = 400, content_type = "application/problem+json")]
    Ended(Problem),
    /// Sent by another page, or with a link for those who look
    #[response(status = 403, content_type = "application/problem+json")]
    NotYours(Problem),
    /// It comes too slowly
    #[response(status = 408, content_type = "application/problem+json")]
    Slow(Problem),
    /// It is too long
    #[response(status = 413, content_type = "application/problem+json")]
    TooLong(Problem),
    /// The request does not say that it is HDF5
    #[response(status = 415, content_type = "application/problem+json")]
    Kind(Problem),
    /// It is damaged or no map, or its name is too long
    #[response(status = 422, content_type = "application/problem+json")]
    Damaged(Problem),
    /// Reading it took too long
    #[response(status = 504, content_type = "application/problem+json")]
    Reading(Problem),
    /// There is no room for it
    #[response(status = 507, content_type = "application/problem+json")]
    NoRoom(Problem),
}

/// Hands over a map to be looked at
///
/// The file, of 64 MiB at most, is in no list and in no folder of maps: it goes when four others
/// have come or the server ends.
#[utoipa::path(
    post,
    path = "/api/v1/maps",
    tag = "maps",
    params(VisitQuery),
    request_body(content = crate::serve::openapi::Encoded, content_type = "application/x-hdf5"),
    responses(
        (status = 201, description = "It can be looked at", body = Visit),
        Denied,
        NotRead,
    ),
)]
pub(super) async fn visit(
    State(maps): State<Arc<Maps>>,
    Extension(role): Extension<Role>,
    query: Asked<VisitQuery>,
    headers: HeaderMap,
    body: Body,
) -> Response {
    let asked = asked(role, query, &headers);
    let visited = match asked {
        Ok(name) => visited(&maps, name, body).await,
        Err(problem) => Err(problem),
    };
    match visited {
        Ok(visit) => (StatusCode::CREATED, Json(visit)).into_response(),
        Err(problem) => closing(problem),
    }
}

/// The name of the map, if it may come.
fn asked(role: Role, query: Asked<VisitQuery>, headers: &HeaderMap) -> Result<String, Problem> {
    if role == Role::Look {
        return Err(Problem::for_others());
    }
    let name = said(query)?.name.unwrap_or_else(|| "a map".into());
    if name.chars().count() > LONGEST_NAME {
        let detail = format!("name: {LONGEST_NAME} letters are the most");
        return Err(Problem::of(StatusCode::UNPROCESSABLE_ENTITY, detail));
    }
    if !is(KIND, headers) {
        let detail = format!("a map is HDF5: Content-Type: {KIND}");
        return Err(Problem::of(StatusCode::UNSUPPORTED_MEDIA_TYPE, detail));
    }
    Ok(name)
}

/// Takes a map in and reads it.
async fn visited(maps: &Maps, name: String, body: Body) -> Result<Visit, Problem> {
    let _door = place(&maps.visiting.doors, "other maps are being sent").await?;
    let (file, path) = maps.visiting.file().map_err(|error| no_room(&error))?;
    let slow = || Problem::of(StatusCode::REQUEST_TIMEOUT, "the map came too slowly");
    timeout(TO_SEND, received(body, file, slow))
        .await
        .map_err(|_| slow())??;
    let visitor = Visitor::of(name, path);
    let read = maps.ask(&visitor.found, &Ask::Description).await;
    read.map_err(
        |problem| match problem.status == StatusCode::BAD_GATEWAY.as_u16() {
            // Nothing stands behind this server that could be at fault.
            true => Problem {
                status: StatusCode::UNPROCESSABLE_ENTITY.as_u16(),
                ..problem
            },
            false => problem,
        },
    )?;
    let id = visitor.found.id.clone();
    maps.visiting.keep(visitor);
    Ok(Visit { id })
}

fn no_room(error: &io::Error) -> Problem {
    let detail = format!("the map cannot be put among the files that do not last: {error}");
    Problem::of(StatusCode::INSUFFICIENT_STORAGE, detail)
}

/// Writes a body to a file, piece by piece.
async fn received(
    mut body: Body,
    mut file: File,
    slow: impl Fn() -> Problem,
) -> Result<(), Problem> {
    let fits = |bytes: u64| {
        if bytes <= MOST_BYTES {
            return Ok(());
        }
        let detail = format!("a map of at most {MOST_BYTES} bytes can visit");
        Err(Problem::of(StatusCode::PAYLOAD_TOO_LARGE, detail))
    };
    fits(body.size_hint().lower())?;
    let (mut taken, mut piece) = (0, Vec::new());
    loop {
        let frame = poll_fn(|context| Pin::new(&mut body).poll_frame(context));
        let Some(frame) = timeout(TO_ASK, frame).await.map_err(|_| slow())? else {
            return written(file, piece).await.map(drop);
        };
        let frame = frame.map_err(|_| {
            let detail = "the map ended before all of it came";
            Problem::of(StatusCode::BAD_REQUEST, detail)
        })?;
        let data = frame.into_data().unwrap_or_default();
        taken += data.len() as u64;
        fits(taken)?;
        piece.extend_from_slice(&data);
        if piece.len() >= PIECE {
            file = written(file, std::mem::take(&mut piece)).await?;
        }
    }
}

async fn written(mut file: File, piece: Vec<u8>) -> Result<File, Problem> {
    let written = tokio::task::spawn_blocking(move || {
        file.write_all(&piece)?;
        Ok(file)
    });
    let written = written.await.map_err(io::Error::other).flatten();
    written.map_err(|error| no_room(&error))
}
