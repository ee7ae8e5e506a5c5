//! The addresses of requests about jobs.

use std::sync::Arc;

use axum::Json;
use axum::body::Bytes;
use axum::extract::{Extension, State};
use axum::http::header::{CONTENT_TYPE, HeaderMap, LOCATION};
use axum::http::{HeaderName, StatusCode};
use axum::response::{IntoResponse, Response};
use tokio::sync::OwnedSemaphorePermit;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::Jobs;
use super::described::{JobChange, JobEntry, JobList, JobTold, SweepCost};
use super::posted::Posted;
use super::queries::{CostQuery, DropQuery, SubmitQuery};
use super::refusals::{NoJob, NotChanged, NotTaken};
use crate::queue::submit::Options;
use crate::serve::access::Role;
use crate::serve::asked::{Asked, Named, json, said, text};
use crate::serve::problem::{Denied, Problem, Refused};
use crate::serve::room::place;
use crate::serve::served::Served;
use crate::serve::work::Pace;

/// A place among the sweeps that are dealt with.
type Place = OwnedSemaphorePermit;

/// About the bytes of a sweep in the list.
const BYTES_OF_A_JOB: u64 = 512;
/// The id of the last event that a client of a stream got.
const LAST_EVENT: HeaderName = HeaderName::from_static("last-event-id");

/// An example of a sweep, for the description of the interface.
const SWEEP: &str = "title = \"decay rates\"\nfields = [\"n_unstable\", \"abscissa\"]\n\n[axes]\n\
    alpha_v = { from = -1.0, to = 0.2, points = 60 }\n\
    tau = { from = 0.0, to = 12.0, points = 80 }\n\n[fixed]\nmu_prime = -0.3\n";

/// What answers share.
#[derive(Debug, Clone)]
struct Shared {
    jobs: Arc<Jobs>,
    served: Served,
}

/// The routes of all addresses of jobs, of plans and of events.
pub(in crate::serve) fn routes<S>(jobs: Arc<Jobs>, served: &Served) -> OpenApiRouter<S>
where
    S: Clone + Send + Sync + 'static,
{
    let served = served.clone();
    OpenApiRouter::new()
        .routes(routes!(plan))
        .routes(routes!(list, submit))
        .routes(routes!(job, change, take_out))
        .routes(routes!(events))
        .with_state(Shared { jobs, served })
}

impl Shared {
    /// Reads the text of a sweep, and takes its place among those that are dealt with.
    async fn posted(&self, headers: &HeaderMap, body: &Bytes) -> Result<(Posted, Place), Problem> {
        let text = text(headers, body)?;
        let place = place(&self.jobs.reading, "too many sweeps are dealt with already").await?;
        let turn = self.served.work.turn(Pace::Quick).await?;
        Ok((turn.run(move |_| Posted::read(&text)).await?, place))
    }
}

/// What a sweep would cost
///
/// The text is a sweep file that names no other files; an axis has at most 131,072 points.
#[utoipa::path(
    post,
    path = "/api/v1/plan",
    tag = "jobs",
    params(CostQuery),
    request_body(content = String, content_type = "application/toml", example = json!(SWEEP)),
    responses((status = 200, description = "Its cost", body = SweepCost), Denied, Refused),
)]
async fn plan(
    State(shared): State<Shared>,
    query: Asked<CostQuery>,
    headers: HeaderMap,
    body: Bytes,
) -> Result<Json<SweepCost>, Problem> {
    let query = said(query)?;
    let (posted, _place) = shared.posted(&headers, &body).await?;
    let cost = shared.jobs.cost(&shared.served, posted, query.timed);
    Ok(Json(cost.await?))
}

/// Hands in a sweep
///
/// The text is a sweep file of 256 kB at most that names no other files; an axis has at most
/// 131,072 points. A worker, `slipmap work`, computes it; the server starts none.
#[utoipa::path(
    post,
    path = "/api/v1/jobs",
    tag = "jobs",
    params(SubmitQuery),
    request_body(content = String, content_type = "application/toml", example = json!(SWEEP)),
    responses(
        (status = 200, description = "The same sweep is there already", body = JobEntry),
        (status = 201, description = "It was put in", body = JobEntry),
        Denied,
        NotTaken,
    ),
)]
async fn submit(
    State(Shared { jobs, served }): State<Shared>,
    Extension(role): Extension<Role>,
    query: Asked<SubmitQuery>,
    headers: HeaderMap,
    body: Bytes,
) -> Result<Response, Problem> {
    let keep_free = jobs.check(role)?;
    let SubmitQuery { first, hold, name } = said(query)?;
    let shared = Shared { jobs, served };
    let (posted, _place) = shared.posted(&headers, &body).await?;
    let options = Options {
        first,
        hold,
        again: false,
    };
    let (entry, is_new) = shared.jobs.put(posted, name, options, keep_free).await?;
    let status = match is_new {
        true => StatusCode::CREATED,
        false => StatusCode::OK,
    };
    // Relative, so that it holds behind a proxy too. Names of files may have any letters.
    let location = is_new.then(|| [(LOCATION, format!("jobs/{}", entry.facts.name))]);
    Ok((status, location, Json(entry)).into_response())
}

/// The sweeps of the folder
#[utoipa::path(
    get,
    path = "/api/v1/jobs",
    tag = "jobs",
    responses((status = 200, description = "The sweeps", body = JobList), Denied),
)]
async fn list(
    State(Shared { jobs, served }): State<Shared>,
    Extension(role): Extension<Role>,
) -> Result<Response, Problem> {
    let now = jobs.looking.now().await?;
    let bytes = now.jobs.len() as u64 * BYTES_OF_A_JOB;
    let room = served.room.take(bytes).await?;
    let list = JobList {
        attended: now.attended,
        may_change: jobs.may_change(role),
        jobs: now.jobs.iter().map(JobEntry::in_list).collect(),
    };
    Ok(room.send("application/json", serde_json::to_vec(&list)?))
}

/// One sweep, with the end of its log
#[utoipa::path(
    get,
    path = "/api/v1/jobs/{name}",
    tag = "jobs",
    params(("name" = String, Path, description = "as the list has it")),
    responses((status = 200, description = "The sweep", body = JobTold), Denied, NoJob),
)]
async fn job(
    State(Shared { jobs, .. }): State<Shared>,
    Named(name): Named,
) -> Result<Json<JobTold>, Problem> {
    let now = jobs.looking.now().await?;
    Ok(Json(jobs.looking.told(now.job(&name)?).await?))
}

/// Holds a sweep, lets it wait, or puts it first
///
/// A sweep that is put first gets another name.
#[utoipa::path(
    patch,
    path = "/api/v1/jobs/{name}",
    tag = "jobs",
    params(("name" = String, Path, description = "as the list has it")),
    request_body(content = JobChange, content_type = "application/json"),
    responses((status = 200, description = "The sweep", body = JobEntry), Denied, NotChanged),
)]
async fn change(
    State(Shared { jobs, .. }): State<Shared>,
    Extension(role): Extension<Role>,
    Named(name): Named,
    headers: HeaderMap,
    body: Bytes,
) -> Result<Json<JobEntry>, Problem> {
    jobs.check(role)?;
    let to: JobChange = json(&headers, &body)?;
    Ok(Json(jobs.change(&name, to).await?))
}

/// Takes a sweep out; its map stays
#[utoipa::path(
    delete,
    path = "/api/v1/jobs/{name}",
    tag = "jobs",
    params(("name" = String, Path, description = "as the list has it"), DropQuery),
    responses((status = 204, description = "It is out"), Denied, NotChanged),
)]
async fn take_out(
    State(Shared { jobs, .. }): State<Shared>,
    Extension(role): Extension<Role>,
    Named(name): Named,
    query: Asked<DropQuery>,
) -> Result<StatusCode, Problem> {
    jobs.check(role)?;
    jobs.take_out(&name, said(query)?.tiles).await?;
    Ok(StatusCode::NO_CONTENT)
}

/// What has changed, as server-sent events
///
/// The events `jobs` and `maps` tell that the list of that name has changed. Their data is JSON
/// with a `revision`, which grows. A stream begins with both, but for those that the client has
/// by its `Last-Event-ID`. There are 256 streams at most.
#[utoipa::path(
    get,
    path = "/api/v1/events",
    tag = "events",
    responses(
        (status = 200, description = "A stream that does not end", body = String,
            content_type = "text/event-stream"),
        Denied,
    ),
)]
async fn events(
    State(Shared { jobs, .. }): State<Shared>,
    headers: HeaderMap,
) -> Result<Response, Problem> {
    let last = headers.get(LAST_EVENT).and_then(|last| last.to_str().ok());
    let stream = jobs.stream(last)?;
    Ok(([(CONTENT_TYPE, "text/event-stream")], stream).into_response())
}
