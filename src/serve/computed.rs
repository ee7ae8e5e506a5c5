//! Requests that are computed on demand: texts as in files, answered by [`crate::explore`].

use axum::body::Bytes;
use axum::extract::State;
use axum::http::header::HeaderMap;
use axum::response::Response;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::asked::text;
use super::openapi::Encoded;
use super::problem::{Denied, Problem, Refused};
use super::served::Served;
use super::work::Pace;
use crate::explore::answer::WithCommand;
use crate::explore::best_answer::BestInPlane;
use crate::explore::given_setting::GivenSetting;
use crate::explore::known::{Known, KnownFormula};
use crate::explore::law::LawCurve;
use crate::explore::point::{BlockPoint, SystemPoint};
use crate::explore::systems::KnownSystem;
use crate::explore::vc::CriticalVelocity;
use crate::explore::{self, Asked, Limits};

/// The routes of these requests.
pub(super) fn routes() -> OpenApiRouter<Served> {
    OpenApiRouter::new()
        .routes(routes!(chart))
        .routes(routes!(point))
        .routes(routes!(vc))
        .routes(routes!(best))
        .routes(routes!(motion))
        .routes(routes!(law))
        .routes(routes!(setting))
        .routes(routes!(formula))
        .routes(routes!(system))
        .routes(routes!(parameters))
}

/// Examples of texts, for the description of the interface.
mod examples {
    pub(super) const CHART: &str = "boundaries = true\n\n[axes]\n\
        alpha_v = { from = -1.0, to = 0.2, points = 60 }\n\
        tau = { from = 0.0, to = 12.0, points = 80 }\n\n[fixed]\nmu_prime = -0.3\n";
    pub(super) const POINT: &str = "[fixed]\nmu_prime = -0.3\nalpha_v = -0.33\ntau = 4.15\n";
    pub(super) const VC: &str = "[fixed]\nalpha_v = -0.33\ntau = 4.15\n\n[friction]\n\
        law = \"weakening\"\nmu0 = 0.5\nv_s = 0.5\n";
    pub(super) const BEST: &str = "[axes]\nalpha_v = { from = -1.0, to = 0.2, points = 2 }\n\
        tau = { from = 0.0, to = 12.0, points = 2 }\n\n[fixed]\nmu_prime = -0.3\n";
    pub(super) const MOTION: &str = "switch_on = 70.0\n\n[fixed]\nv0 = 0.35\n\
        alpha_v = -0.33\ntau = 4.15\n\n[friction]\nlaw = \"weakening\"\nmu0 = 0.5\n\
        v_s = 0.5\n\n[start]\nx_dot0 = 0.3535\n";
    pub(super) const LAW: &str = "[friction]\nlaw = \"stribeck\"\nmu0 = 0.4\nv_s = 0.5\n";
    pub(super) const SETTING: &str = POINT;
    pub(super) const SYSTEM: &str = "title = \"Turning\"\nP = \"s^2 + 2*zeta*s + 1 + width\"\n\
        Q = \"-width\"\n\n[parameters]\nzeta = { default = 0.02, minimum = 0 }\nwidth = 0\n";
    pub(super) const FORMULA: &str = "[friction]\nlaw = \"formula\"\nmu_k = \"mu0 + sigma*v\"\n";
}

/// A point of either kind, for the description of the interface.
#[derive(utoipa::ToSchema)]
#[serde(untagged)]
#[allow(dead_code, reason = "only described")]
enum AnyPoint {
    /// Of the block.
    Block(Box<WithCommand<BlockPoint>>),
    /// Of a system.
    System(Box<WithCommand<SystemPoint>>),
}

/// The answer to a text.
async fn answer(
    served: Served,
    request: explore::Request,
    text: Result<String, Problem>,
) -> Result<Response, Problem> {
    let asked = Asked::read(request, &text?, &Limits::default())?;
    let (turn, room) = if asked.is_slow() {
        // Those that wait for a thread take no room yet.
        let turn = served.work.turn(Pace::Slow).await?;
        (turn, served.slow_room.take(asked.bytes()).await?)
    } else {
        // What needs no room does not wait for what waits for room.
        let room = served.room.take(asked.bytes()).await?;
        (served.work.turn(Pace::Quick).await?, room)
    };
    let bytes = turn.run(move |stop| asked.answer(stop)).await?;
    Ok(room.send(request.content_type(), bytes))
}

/// A handler of texts: its comments, name, path, request and example, and what it answers.
macro_rules! of_text {
    (
        $(#[$comment:meta])*
        fn $name:ident: $path:literal, $request:ident, $example:ident => $($answer:tt)*
    ) => {
        $(#[$comment])*
        #[utoipa::path(
            post,
            path = $path,
            tag = "computed",
            request_body(
                content = String,
                content_type = "application/toml",
                example = json!(examples::$example),
            ),
            responses((status = 200, $($answer)*), Denied, Refused),
        )]
        async fn $name(
            State(served): State<Served>,
            headers: HeaderMap,
            body: Bytes,
        ) -> Result<Response, Problem> {
            answer(served, explore::Request::$request, text(&headers, &body)).await
        }
    };
}

of_text! {
    /// Cells and curves of a sweep
    ///
    /// The text is a sweep file of few cells: 4,000,000 of the closed form, 1,000,000 whose roots,
    /// or 1,000 whose motions are followed. The answer is a head (`ChartHead`) and arrays, see the
    /// description of this interface.
    fn chart: "/api/v1/chart", Chart, CHART =>
    description = "A chart", body = Encoded, content_type = "application/octet-stream"
}

of_text! {
    /// Linear stability at a point
    ///
    /// The text has the tables `[fixed]`, `[friction]` and `[units]` of a sweep file. In the place
    /// of `[friction]` there may be `system`: a table, or the name of a system of the program.
    fn point: "/api/v1/point", Point, POINT =>
    description = "The point", body = AnyPoint
}

of_text! {
    /// The critical velocity at a point, by the protocol `follow`
    ///
    /// The text has a friction law and no v0.
    fn vc: "/api/v1/vc", CriticalVelocity, VC =>
    description = "How stick-slip ends", body = WithCommand<CriticalVelocity>
}

of_text! {
    /// The best settings in a plane
    ///
    /// The text is a sweep file with two axes, a gain (of a system: any parameter) and the delay:
    /// the search is within their ends.
    fn best: "/api/v1/best", Best, BEST =>
    description = "What a search found", body = BestInPlane
}

of_text! {
    /// The motion of a case
    ///
    /// The text is a case file. Of more than 20,000 samples every second one is left out until they
    /// are fewer, but for those at events. The answer is a head (`MotionHead`) and arrays, see the
    /// description of this interface.
    fn motion: "/api/v1/motion", Motion, MOTION =>
    description = "A motion", body = Encoded, content_type = "application/octet-stream"
}

of_text! {
    /// A friction law as a curve
    ///
    /// The text has the table `[friction]`, and may have v0 in `[fixed]`, and `[units]`.
    fn law: "/api/v1/law", Law, LAW =>
    description = "The law", body = LawCurve
}

of_text! {
    /// What a file says of a setting
    ///
    /// The text is a sweep file, a case file or a setting. It names no other files.
    fn setting: "/api/v1/setting", Setting, SETTING =>
    description = "What it says", body = GivenSetting
}

of_text! {
    /// The parameters of a friction law that is a formula
    ///
    /// The text has the law and its expression in the table `[friction]`; nothing else is read.
    fn formula: "/api/v1/formula", Formula, FORMULA =>
    description = "Its parameters", body = KnownFormula
}

of_text! {
    /// A system, with its parameters and fields
    ///
    /// The text is that of a system file.
    fn system: "/api/v1/system", System, SYSTEM =>
    description = "The system", body = KnownSystem
}

/// All parameters, friction laws, fields, and systems of the program
#[utoipa::path(
    get,
    path = "/api/v1/parameters",
    tag = "computed",
    responses((status = 200, description = "What there is", body = Known), Denied),
)]
async fn parameters(State(served): State<Served>) -> Result<Response, Problem> {
    let asked = explore::Request::Parameters;
    answer(served, asked, Ok(String::new())).await
}
