//! The page and its files, which are part of the program.

use axum::extract::Path;
use axum::extract::rejection::PathRejection;
use axum::http::header::CONTENT_TYPE;
use axum::response::{IntoResponse, Response};

use super::problem::{Problem, nothing_here};

const FRONT: &str = include_str!("page/index.html");

/// Name and text of a file.
macro_rules! files {
    ($($name:literal),* $(,)?) => {
        [$(($name, include_str!(concat!("page/", $name)))),*]
    };
}

const FILES: &[(&str, &str)] = &files![
    "amounts.js",
    "asked.js",
    "catalogue.js",
    "cells.js",
    "changes.js",
    "colours.js",
    "controls.js",
    "dom.js",
    "dropped.js",
    "editor.js",
    "explorer.css",
    "explorer.js",
    "file.js",
    "following.js",
    "formula.js",
    "frame.js",
    "help.js",
    "helping.js",
    "jobs.js",
    "kept.js",
    "legend.js",
    "limits.js",
    "list.js",
    "live.js",
    "maps.css",
    "mistake.js",
    "model.js",
    "motion.js",
    "newest.js",
    "notices.js",
    "onwards.js",
    "panel.js",
    "pen.js",
    "picture.js",
    "plane.js",
    "plots.js",
    "pointing.js",
    "presets.js",
    "queue.js",
    "region.js",
    "saved.js",
    "scale.js",
    "slice.js",
    "source.js",
    "stale.js",
    "state.js",
    "steps.js",
    "sweep.js",
    "system.js",
    "table.js",
    "thumbnails.js",
    "trace.js",
    // The library uPlot, as published.
    "uplot.css",
    "uplot-license.txt",
    "uplot.js",
    "waiting.js",
];

/// The page.
pub(super) fn front() -> Response {
    ([(CONTENT_TYPE, "text/html; charset=utf-8")], FRONT).into_response()
}

/// A small page that leads on to the page itself.
pub(super) fn onwards() -> Response {
    let text = "<!doctype html><meta charset=\"utf-8\"><link rel=\"icon\" href=\"data:,\">\
        <title>slipmap</title><script src=\"/onwards.js\"></script>\
        <noscript><meta http-equiv=\"refresh\" content=\"0; url=/\"></noscript>\
        <p><a href=\"/\">slipmap</a>";
    ([(CONTENT_TYPE, "text/html; charset=utf-8")], text).into_response()
}

/// One of its files.
pub(super) async fn asset(name: Result<Path<String>, PathRejection>) -> Result<Response, Problem> {
    let Path(name) = name.map_err(|_| nothing_here())?;
    let file = FILES.iter().find(|(known, _)| *known == name);
    let (name, text) = *file.ok_or_else(nothing_here)?;
    let kind = match name.rsplit_once('.') {
        Some((_, "js")) => "text/javascript; charset=utf-8",
        Some((_, "css")) => "text/css; charset=utf-8",
        _ => "text/plain; charset=utf-8",
    };
    Ok(([(CONTENT_TYPE, kind)], text).into_response())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_file_of_the_page_is_handed_out() {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/src/serve/page");
        // One is of no use to a page with a server, the other is the page itself.
        let besides = ["worker.js", "index.html"];
        let mut found: Vec<String> = std::fs::read_dir(folder)
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .filter(|name| !besides.contains(&name.as_str()))
            .collect();
        found.sort();
        let mut known: Vec<&str> = FILES.iter().map(|&(name, _)| name).collect();
        known.sort_unstable();
        assert_eq!(found, known);
    }
}
