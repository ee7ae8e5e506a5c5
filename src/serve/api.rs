//! The addresses of the server, and their answers.

use std::sync::Arc;

use axum::extract::{DefaultBodyLimit, Query, Request, State};
use axum::http::header::{self, HeaderName, HeaderValue};
use axum::http::{StatusCode, Uri};
use axum::middleware::{self, Next};
use axum::response::{IntoResponse, Response};
use axum::routing::get;
use axum::{Extension, Router};
use serde::Deserialize;

use super::access::{Access, Role};
use super::connections;
use super::jobs::{self, Jobs};
use super::maps;
use super::problem::{Problem, nothing_here};
use super::room::Room;
use super::served::Served;
use super::work::Work;
use super::{computed, openapi, page};

/// The most bytes of a request's text: enough for friction laws of some thousand points.
const LONGEST_BODY: usize = 1 << 18;

/// Megabytes for all quick computations and their unsent answers together.
const ROOM: u32 = 128;
/// Megabytes for all slow ones.
const SLOW_ROOM: u32 = 64;

/// What a page may load: its own files, and nothing from elsewhere.
const POLICY: &str = "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' \
    data: blob:; connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

/// The router of all addresses.
pub(super) fn routes(access: Arc<Access>, work: Work, jobs: Jobs) -> Router {
    let served = Served {
        access,
        work,
        room: Room::of(ROOM),
        slow_room: Room::of(SLOW_ROOM),
    };
    let interface = computed::routes()
        .merge(maps::routes(Arc::clone(&jobs.maps)))
        .merge(jobs::routes(Arc::new(jobs), &served));
    let all = openapi::described(interface)
        .route("/", get(front))
        .route("/{asset}", get(page::asset))
        .fallback(nothing)
        .method_not_allowed_fallback(no_such_method);
    all.layer(DefaultBodyLimit::max(LONGEST_BODY))
        .layer(middleware::from_fn(bounded))
        .layer(middleware::from_fn_with_state(served.clone(), guarded))
        .with_state(served)
}

/// Reads the body of a request, unless it is a map, before the request is handled.
async fn bounded(request: Request, next: Next) -> Response {
    match maps::is_visit(request.method(), request.uri()) {
        true => next.run(request).await,
        false => connections::read_body(request, LONGEST_BODY, next).await,
    }
}

/// Refuses requests without access, and adds the restrictions for browsers to every answer.
async fn guarded(State(served): State<Served>, mut request: Request, next: Next) -> Response {
    let (method, headers) = (request.method(), request.headers());
    // The link has the token in its address.
    let linked = link_token(request.uri()).and_then(|token| served.access.role(&token));
    let checked = match (served.access.check_host(headers), linked) {
        (Err(refusal), _) => Err(refusal),
        (Ok(()), Some(role)) => Ok(role),
        (Ok(()), None) => served.access.check(method, headers),
    };
    let mut response = match checked {
        Ok(role) => {
            request.extensions_mut().insert(role);
            connections::is_answered(&request);
            next.run(request).await
        }
        Err(refusal) => {
            let mut response = Problem::from(refusal).into_response();
            // A refused client must not hold a connection.
            let close = HeaderValue::from_static("close");
            response.headers_mut().insert(header::CONNECTION, close);
            response
        }
    };
    let headers = response.headers_mut();
    for (name, value) in [
        (header::CONTENT_SECURITY_POLICY, POLICY),
        (header::X_CONTENT_TYPE_OPTIONS, "nosniff"),
        (header::REFERRER_POLICY, "no-referrer"),
        (header::CACHE_CONTROL, "no-store"),
        (
            HeaderName::from_static("cross-origin-resource-policy"),
            "same-origin",
        ),
        (
            HeaderName::from_static("cross-origin-opener-policy"),
            "same-origin",
        ),
    ] {
        headers.insert(name, HeaderValue::from_static(value));
    }
    response
}

#[derive(Deserialize)]
struct Link {
    token: Option<String>,
}

/// The token in the address of the page.
fn link_token(uri: &Uri) -> Option<String> {
    let link = Query::<Link>::try_from_uri(uri).ok()?;
    link.0.token.filter(|_| uri.path() == "/")
}

/// The page. A token in the address becomes a cookie and is removed from the address. A redirect
/// would not do: without the cookie, if the link was followed from another page.
async fn front(
    State(served): State<Served>,
    Extension(role): Extension<Role>,
    uri: Uri,
) -> Result<Response, Problem> {
    if link_token(&uri).is_none() {
        return Ok(page::front());
    }
    let cookie = HeaderValue::from_str(&served.access.cookie(role));
    let cookie = cookie
        .map_err(|_| Problem::of(StatusCode::INTERNAL_SERVER_ERROR, "the cookie is no header"))?;
    Ok(([(header::SET_COOKIE, cookie)], page::onwards()).into_response())
}

async fn nothing() -> Problem {
    nothing_here()
}

async fn no_such_method() -> Problem {
    let detail = "this address does not answer that method";
    Problem::of(StatusCode::METHOD_NOT_ALLOWED, detail)
}
