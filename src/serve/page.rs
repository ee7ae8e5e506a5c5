//! The page and its files, which are part of the program.

use axum::extract::Path;
use axum::http::header::CONTENT_TYPE;
use axum::response::{IntoResponse, Response};

use super::problem::{Problem, nothing_here};

const FRONT: &str = include_str!("page/index.html");
/// Name, type and text of the others.
const FILES: [(&str, &str, &str); 4] = [
    (
        "explorer.js",
        "text/javascript",
        include_str!("page/explorer.js"),
    ),
    ("chart.js", "text/javascript", include_str!("page/chart.js")),
    (
        "request.js",
        "text/javascript",
        include_str!("page/request.js"),
    ),
    (
        "explorer.css",
        "text/css",
        include_str!("page/explorer.css"),
    ),
];

/// The page.
pub(super) fn front() -> Response {
    ([(CONTENT_TYPE, "text/html; charset=utf-8")], FRONT).into_response()
}

/// One of its files.
pub(super) async fn asset(Path(name): Path<String>) -> Result<Response, Problem> {
    let file = FILES.iter().find(|(known, ..)| *known == name);
    let (_, kind, text) = file.ok_or_else(nothing_here)?;
    Ok(([(CONTENT_TYPE, format!("{kind}; charset=utf-8"))], *text).into_response())
}
