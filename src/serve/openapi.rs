//! The description of the interface, `/api/v1/openapi.json`.

use axum::Router;
use axum::http::header::CONTENT_TYPE;
use axum::routing::get;
use utoipa::openapi::OpenApi as Document;
use utoipa::openapi::security::{ApiKey, ApiKeyValue, HttpAuthScheme, HttpBuilder, SecurityScheme};
use utoipa::{Modify, OpenApi};
use utoipa_axum::router::OpenApiRouter;

use super::problem::Problem;
use super::served::Served;
use crate::explore::chart_bytes::ChartHead;
use crate::explore::motion_bytes::MotionHead;

/// The address of the description.
const ADDRESS: &str = "/api/v1/openapi.json";

/// What is said of the interface as a whole.
#[derive(OpenApi)]
#[openapi(
    info(
        title = "slipmap",
        description = "What the page of `slipmap serve` asks.\n\n\
            Requests that compute are texts as in sweep and case files, `application/toml`. \
            Missing numbers and infinities are null. What cannot be answered is \
            a problem, `application/problem+json`.\n\n\
            Answers with many numbers are bytes: the length of a head as u32, the head in JSON, \
            padding to a multiple of 8, then arrays, each padded likewise; all numbers \
            little-endian. The head names each array with its type, its offset behind the padding \
            and its length. Where equal numbers stand in a row an array may be stored as `runs`: \
            so many numbers, padded, and behind them as many u32, the places where each run ends."
    ),
    components(schemas(Problem, ChartHead, MotionHead)),
    tags(
        (name = "computed", description = "Computed now"),
        (name = "maps", description = "From the maps below a folder"),
        (name = "jobs", description = "Sweeps that wait for a worker, with `--submit`"),
        (name = "events", description = "What has changed"),
    ),
    security(("bearer" = []), ("cookie" = [])),
    modifiers(&Keys),
)]
struct Interface;

/// Bytes as the description says, whatever is in them.
#[derive(utoipa::ToSchema)]
#[schema(value_type = String, format = Binary)]
#[allow(dead_code, reason = "only described")]
pub(super) struct Encoded(Vec<u8>);

/// How requests carry the token.
struct Keys;

impl Modify for Keys {
    fn modify(&self, document: &mut Document) {
        let components = document.components.get_or_insert_default();
        let bearer = HttpBuilder::new().scheme(HttpAuthScheme::Bearer).build();
        components.add_security_scheme("bearer", SecurityScheme::Http(bearer));
        let about = "the link that is printed sets it; its name ends with the port";
        let cookie = ApiKey::Cookie(ApiKeyValue::with_description("slipmap-PORT", about));
        components.add_security_scheme("cookie", SecurityScheme::ApiKey(cookie));
    }
}

/// The router of `routes`, with the address of their description.
pub(super) fn described(routes: OpenApiRouter<Served>) -> Router<Served> {
    let whole = OpenApiRouter::with_openapi(Interface::openapi()).merge(routes);
    let (router, document) = whole.split_for_parts();
    let text = document.to_json().unwrap_or_default();
    let told = move || async move { ([(CONTENT_TYPE, "application/json")], text) };
    router.route(ADDRESS, get(told))
}
