//! What is answered at which address.

use std::sync::Arc;
use std::time::Instant;

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
use super::connections;
use super::maps::{self, Maps};
use super::page;
use super::problem::{Problem, nothing_here};
use super::work::Work;
use crate::explore::chart::{Chart, Limits};
use crate::explore::chart_bytes;
use crate::explore::point::Point;
use crate::explore::vc::CriticalVelocity;
use crate::model::ModelError;
use crate::sweep::Setting;
use crate::sweep::input::point_file::{PointOf, PointSpec};
use crate::sweep::input::search::Protocol;

/// The longest text that is read: friction laws of some thousand points.
const LONGEST_BODY: usize = 1 << 18;
/// Roots of a point.
const ROOTS: u8 = 16;

/// What a page may load: its own files, and nothing from elsewhere.
const POLICY: &str = "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' \
    data: blob:; connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

#[derive(Clone)]
struct Served {
    access: Arc<Access>,
    work: Work,
}

impl Served {
    /// What `answer` says of the point that the text of a request describes.
    async fn at_point<T: Send + 'static>(
        &self,
        headers: &HeaderMap,
        body: &Bytes,
        of: PointOf,
        answer: impl FnOnce(&Setting) -> Result<T, ModelError> + Send + 'static,
    ) -> Result<axum::Json<T>, Problem> {
        let text = text(headers, body)?;
        let computed = self.work.run(move |_| {
            let spec = PointSpec::read(&text, of)?;
            Ok(answer(&spec.setting)?)
        });
        computed.await.map(axum::Json)
    }
}

/// The router of all addresses.
pub(super) fn routes(access: Arc<Access>, work: Work, maps: Arc<Maps>) -> Router {
    let served = Served { access, work };
    let api = Router::new()
        .merge(maps::routes(maps))
        .route("/api/v1/chart", post(chart_of))
        .route("/api/v1/point", post(point))
        .route("/api/v1/vc", post(vc))
        .route("/", get(front))
        .route("/{asset}", get(page::asset))
        .fallback(nothing)
        .method_not_allowed_fallback(no_such_method);
    api.layer(DefaultBodyLimit::max(LONGEST_BODY))
        .layer(middleware::from_fn(|request, next| {
            connections::read_body(request, LONGEST_BODY, next)
        }))
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
        Err(refusal) => {
            let mut response = Problem::from(refusal).into_response();
            // Who is refused holds no connection.
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

/// A sweep of few cells, as [`chart_bytes`] describes.
async fn chart_of(
    State(served): State<Served>,
    headers: HeaderMap,
    body: Bytes,
) -> Result<Response, Problem> {
    let text = text(&headers, &body)?;
    let computed = served.work.run(move |stop| {
        let begun = Instant::now();
        let chart = Chart::of(&text, Limits::default(), stop)?;
        let took = begun.elapsed().as_secs_f64() * 1e3;
        chart_bytes::encoded(&chart, took)
            .map_err(|error| Problem::of(StatusCode::INTERNAL_SERVER_ERROR, error.to_string()))
    });
    let bytes = computed.await?;
    let kind = [(header::CONTENT_TYPE, "application/octet-stream")];
    Ok((kind, bytes).into_response())
}

/// Linear stability at a point.
async fn point(
    State(served): State<Served>,
    headers: HeaderMap,
    body: Bytes,
) -> Result<axum::Json<Point>, Problem> {
    let at = |setting: &Setting| Point::at(setting, ROOTS);
    served.at_point(&headers, &body, PointOf::Sliding, at).await
}

/// The critical velocity of a point, by the protocol `follow`.
async fn vc(
    State(served): State<Served>,
    headers: HeaderMap,
    body: Bytes,
) -> Result<axum::Json<CriticalVelocity>, Problem> {
    let of = |setting: &Setting| CriticalVelocity::of(setting, Protocol::Follow);
    served
        .at_point(&headers, &body, PointOf::CriticalVelocity, of)
        .await
}

async fn nothing() -> Problem {
    nothing_here()
}

async fn no_such_method() -> Problem {
    let detail = "this address does not answer that method";
    Problem::of(StatusCode::METHOD_NOT_ALLOWED, detail)
}
