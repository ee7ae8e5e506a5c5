//! What is answered at which address.

use std::sync::Arc;

use axum::Router;
use axum::body::Bytes;
use axum::extract::{DefaultBodyLimit, Query, Request, State};
use axum::http::header::{self, HeaderName, HeaderValue};
use axum::http::{HeaderMap, Method, StatusCode};
use axum::middleware::{self, Next};
use axum::response::{IntoResponse, Redirect, Response};
use axum::routing::{get, post};
use serde::Deserialize;

use super::access::Access;
use super::maps::{self, Maps};
use super::page;
use super::problem::{Problem, nothing_here};
use super::work::Work;
use crate::explore::{self, Limits};

/// The longest text that is read: friction laws of some thousand points.
const LONGEST_BODY: usize = 1 << 18;

/// What a page may load: its own files, and nothing from elsewhere.
const POLICY: &str = "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' \
    data: blob:; connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

#[derive(Clone)]
struct Served {
    access: Arc<Access>,
    work: Work,
}

impl Served {
    /// The answer to what the text of a request describes.
    async fn answer(
        &self,
        request: explore::Request,
        text: Result<String, Problem>,
    ) -> Result<Response, Problem> {
        let text = text?;
        let limits = Limits::default();
        let computed = self
            .work
            .run(move |stop| explore::answer(request, &text, &limits, stop));
        let kind = [(header::CONTENT_TYPE, request.content_type())];
        Ok((kind, computed.await?).into_response())
    }
}

/// The router of all addresses.
pub(super) fn routes(access: Arc<Access>, work: Work, maps: Arc<Maps>) -> Router {
    let served = Served { access, work };
    let api = Router::new()
        .merge(maps::routes(maps))
        .route("/api/v1/chart", post(chart))
        .route("/api/v1/point", post(point))
        .route("/api/v1/vc", post(vc))
        .route("/api/v1/motion", post(motion))
        .route("/api/v1/law", post(law))
        .route("/api/v1/parameters", get(parameters))
        .route("/", get(front))
        .route("/{asset}", get(page::asset))
        .fallback(nothing)
        .method_not_allowed_fallback(no_such_method);
    api.layer(DefaultBodyLimit::max(LONGEST_BODY))
        .layer(middleware::from_fn_with_state(served.clone(), guarded))
        .with_state(served)
}

/// Refuses who may not ask, and says in every answer what a browser must not do with it.
async fn guarded(State(served): State<Served>, request: Request, next: Next) -> Response {
    let (method, headers) = (request.method(), request.headers());
    let checked = served.access.check_host(headers);
    // The link brings its token itself.
    let checked = match request.uri().path() {
        "/" => checked,
        _ => checked.and_then(|()| served.access.check(method, headers)),
    };
    let mut response = match checked {
        Ok(()) => next.run(request).await,
        Err(refusal) => Problem::from(refusal).into_response(),
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

/// The page. A token in the address becomes a cookie, and leaves the address.
async fn front(
    State(served): State<Served>,
    Query(link): Query<Link>,
    method: Method,
    headers: HeaderMap,
) -> Result<Response, Problem> {
    match link.token {
        Some(token) if served.access.is_token(&token) => {
            let cookie = HeaderValue::from_str(&served.access.cookie());
            let cookie = cookie.map_err(|_| {
                Problem::of(StatusCode::INTERNAL_SERVER_ERROR, "the cookie is no header")
            })?;
            Ok(([(header::SET_COOKIE, cookie)], Redirect::to("/")).into_response())
        }
        _ => {
            served.access.check(&method, &headers)?;
            Ok(page::front())
        }
    }
}

/// The text of a request.
fn text(headers: &HeaderMap, body: &Bytes) -> Result<String, Problem> {
    let kind = headers.get(header::CONTENT_TYPE);
    if kind.is_none_or(|kind| kind.as_bytes() != b"application/toml") {
        let detail = "the request is to be TOML: Content-Type: application/toml";
        return Err(Problem::of(StatusCode::UNSUPPORTED_MEDIA_TYPE, detail));
    }
    let text = std::str::from_utf8(body);
    let text = text.map_err(|_| Problem::of(StatusCode::BAD_REQUEST, "the text is not UTF-8"))?;
    Ok(text.to_owned())
}

/// A sweep of few cells.
async fn chart(
    State(served): State<Served>,
    headers: HeaderMap,
    body: Bytes,
) -> Result<Response, Problem> {
    let text = text(&headers, &body);
    served.answer(explore::Request::Chart, text).await
}

/// Linear stability at a point.
async fn point(
    State(served): State<Served>,
    headers: HeaderMap,
    body: Bytes,
) -> Result<Response, Problem> {
    let text = text(&headers, &body);
    served.answer(explore::Request::Point, text).await
}

/// The critical velocity of a point, by the protocol `follow`.
async fn vc(
    State(served): State<Served>,
    headers: HeaderMap,
    body: Bytes,
) -> Result<Response, Problem> {
    let text = text(&headers, &body);
    served
        .answer(explore::Request::CriticalVelocity, text)
        .await
}

/// The motion of a case.
async fn motion(
    State(served): State<Served>,
    headers: HeaderMap,
    body: Bytes,
) -> Result<Response, Problem> {
    let text = text(&headers, &body);
    served.answer(explore::Request::Motion, text).await
}

/// A friction law as a curve.
async fn law(
    State(served): State<Served>,
    headers: HeaderMap,
    body: Bytes,
) -> Result<Response, Problem> {
    let text = text(&headers, &body);
    served.answer(explore::Request::Law, text).await
}

/// All parameters, friction laws and fields.
async fn parameters(State(served): State<Served>) -> Result<Response, Problem> {
    let asked = explore::Request::Parameters;
    served.answer(asked, Ok(String::new())).await
}

async fn nothing() -> Problem {
    nothing_here()
}

async fn no_such_method() -> Problem {
    let detail = "this address does not answer that method";
    Problem::of(StatusCode::METHOD_NOT_ALLOWED, detail)
}
