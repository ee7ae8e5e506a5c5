//! The addresses of requests about maps.

use std::sync::Arc;

use axum::extract::State;
use axum::http::StatusCode;
use axum::http::header::CONTENT_TYPE;
use axum::response::{IntoResponse, Response};
use serde_json::Value;
use utoipa::OpenApi;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::described::{AnyDescription, CurvesHead, MapCell, MapDescription, MapList, WindowHead};
use super::file;
use super::frames::{Ask, CellQuery, CurvesQuery, Frame, Kind, ScaleName, WindowQuery};
use super::handing;
use super::readers::{Maps, no_map};
use crate::maps::look::finite;
use crate::maps::scan::Found;
use crate::serve::asked::{Asked, Named, said};
use crate::serve::openapi::Encoded;
use crate::serve::problem::{Denied, Problem};

/// The routes of all addresses below `/api/v1/maps`.
pub(in crate::serve) fn routes<S>(maps: Arc<Maps>) -> OpenApiRouter<S>
where
    S: Clone + Send + Sync + 'static,
{
    OpenApiRouter::with_openapi(Schemas::openapi())
        .routes(routes!(list, handing::visit))
        .routes(routes!(description))
        .routes(routes!(window))
        .routes(routes!(curves))
        .routes(routes!(cell))
        .routes(routes!(sweep))
        .routes(routes!(motion))
        .routes(routes!(file::file))
        .with_state(maps)
}

/// What heads say before numbers.
#[derive(OpenApi)]
#[openapi(components(schemas(WindowHead, CurvesHead, ScaleName)))]
struct Schemas;

/// How requests about a map may be refused besides.
#[derive(utoipa::IntoResponses)]
#[allow(dead_code, reason = "only described")]
enum NoMap {
    /// There is no map of this id
    #[response(status = 404, content_type = "application/problem+json")]
    None(Problem),
    /// The map lacks what was requested
    #[response(status = 422, content_type = "application/problem+json")]
    Unprocessable(Problem),
    /// The map cannot be read
    #[response(status = 502, content_type = "application/problem+json")]
    Damaged(Problem),
    /// Reading it took too long
    #[response(status = 504, content_type = "application/problem+json")]
    TooLong(Problem),
}

const ENCODED: &str = "application/octet-stream";

async fn found(maps: &Maps, id: &str) -> Result<Found, Problem> {
    match maps.visiting.find(id) {
        Some(visitor) => Ok(visitor),
        None => maps.list.find(id).await.ok_or_else(no_map),
    }
}

fn answered(frame: Frame) -> Response {
    let kind = match frame.kind {
        Kind::Text => "text/plain; charset=utf-8",
        Kind::Json => "application/json",
        _ => ENCODED,
    };
    ([(CONTENT_TYPE, kind)], frame.bytes).into_response()
}

async fn asked(maps: &Maps, id: &str, ask: Ask) -> Result<Response, Problem> {
    let found = found(maps, id).await?;
    Ok(answered(maps.ask(&found, &ask).await?))
}

/// The maps and traces below the folder
#[utoipa::path(
    get,
    path = "/api/v1/maps",
    tag = "maps",
    responses(
        (status = 200, description = "The maps", body = MapList),
        Denied,
    ),
)]
async fn list(State(maps): State<Arc<Maps>>) -> axum::Json<MapList> {
    axum::Json(maps.list.all().await)
}

/// Description of a map, without its cells, or of a trace
#[utoipa::path(
    get,
    path = "/api/v1/maps/{id}",
    tag = "maps",
    params(("id" = String, Path, description = "as the list has it")),
    responses(
        (status = 200, description = "The map", body = AnyDescription),
        Denied,
        NoMap,
    ),
)]
async fn description(
    State(maps): State<Arc<Maps>>,
    Named(id): Named,
) -> Result<axum::Json<MapDescription<Value>>, Problem> {
    let found = found(&maps, &id).await?;
    let frame = maps.ask(&found, &Ask::Description).await?;
    let told: Value = serde_json::from_slice(&frame.bytes)
        .map_err(|error| Problem::of(StatusCode::BAD_GATEWAY, error.to_string()))?;
    let complete = told["cells"] == told["cells_done"];
    let state = found.state(complete);
    let Found { id, name, .. } = found;
    Ok(axum::Json(MapDescription {
        id,
        name,
        state,
        told,
    }))
}

/// Cells in a plane, as pixels
#[utoipa::path(
    get,
    path = "/api/v1/maps/{id}/window",
    tag = "maps",
    params(("id" = String, Path, description = "as the list has it"), WindowQuery),
    responses(
        (status = 200, description = "A head (`WindowHead`) and arrays", body = Encoded,
            content_type = "application/octet-stream"),
        Denied,
        NoMap,
    ),
)]
async fn window(
    State(maps): State<Arc<Maps>>,
    Named(id): Named,
    query: Asked<WindowQuery>,
) -> Result<Response, Problem> {
    let query = said(query)?;
    // Checked here, because JSON would lose infinities and NaN on the way to the process.
    finite([query.x0, query.x1, query.y0, query.y1])
        .map_err(|detail| Problem::of(StatusCode::UNPROCESSABLE_ENTITY, detail))?;
    let found = found(&maps, &id).await?;
    let room = maps.room(&query).await?;
    let Frame { bytes, .. } = maps.ask(&found, &Ask::Window(query)).await?;
    Ok(room.send(ENCODED, bytes))
}

/// The curves in a plane
#[utoipa::path(
    get,
    path = "/api/v1/maps/{id}/curves",
    tag = "maps",
    params(("id" = String, Path, description = "as the list has it"), CurvesQuery),
    responses(
        (status = 200, description = "A head (`CurvesHead`) and arrays", body = Encoded,
            content_type = "application/octet-stream"),
        Denied,
        NoMap,
    ),
)]
async fn curves(
    State(maps): State<Arc<Maps>>,
    Named(id): Named,
    query: Asked<CurvesQuery>,
) -> Result<Response, Problem> {
    let query = said(query)?;
    let found = found(&maps, &id).await?;
    let room = maps.room_for_curves().await?;
    let frame = maps.ask(&found, &Ask::Curves(query)).await?;
    Ok(room.send(ENCODED, frame.bytes))
}

/// One cell
#[utoipa::path(
    get,
    path = "/api/v1/maps/{id}/cell",
    tag = "maps",
    params(("id" = String, Path, description = "as the list has it"), CellQuery),
    responses(
        (status = 200, description = "The cell", body = MapCell),
        Denied,
        NoMap,
    ),
)]
async fn cell(
    State(maps): State<Arc<Maps>>,
    Named(id): Named,
    query: Asked<CellQuery>,
) -> Result<Response, Problem> {
    asked(&maps, &id, Ask::Cell(said(query)?)).await
}

/// The sweep file's text; of a trace that of its case
#[utoipa::path(
    get,
    path = "/api/v1/maps/{id}/sweep",
    tag = "maps",
    params(("id" = String, Path, description = "as the list has it")),
    responses(
        (status = 200, description = "The text", body = String,
            content_type = "text/plain; charset=utf-8"),
        Denied,
        NoMap,
    ),
)]
async fn sweep(State(maps): State<Arc<Maps>>, Named(id): Named) -> Result<Response, Problem> {
    asked(&maps, &id, Ask::Sweep).await
}

/// The motion of a trace
///
/// Of more than 20,000 samples every second one is left out until they are fewer, but for those at
/// events. The answer is a head (`MotionHead`) and arrays, see the description of this interface.
#[utoipa::path(
    get,
    path = "/api/v1/maps/{id}/motion",
    tag = "maps",
    params(("id" = String, Path, description = "as the list has it")),
    responses(
        (status = 200, description = "A motion", body = Encoded,
            content_type = "application/octet-stream"),
        Denied,
        NoMap,
    ),
)]
async fn motion(State(maps): State<Arc<Maps>>, Named(id): Named) -> Result<Response, Problem> {
    let found = found(&maps, &id).await?;
    let room = maps.room_for_motion().await?;
    let frame = maps.ask(&found, &Ask::Motion).await?;
    Ok(room.send(ENCODED, frame.bytes))
}
