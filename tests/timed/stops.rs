//! Long answers end soon once nobody waits for them: each kind of request and of piece is stopped
//! amid its work.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use crate::alone;
use slipmap::explore::{Asked, Limits, Problem, Request};

/// When an answer is stopped, and how long it may take from then on: half a second, on a machine
/// that has other things to do as well.
const STOPPED_AFTER: Duration = Duration::from_millis(300);
const SOON: Duration = Duration::from_millis(1500);

/// Asks for an answer that takes long, and stops it. It has to be at work by then.
fn stopped(request: Request, text: &str) {
    let asked = Asked::read(request, text, &Limits::default()).unwrap();
    let stop = Arc::new(AtomicBool::new(false));
    let begun = Instant::now();
    let answer = std::thread::scope(|scope| {
        let answer = scope.spawn(|| asked.answer(&stop));
        std::thread::sleep(STOPPED_AFTER);
        stop.store(true, Ordering::Relaxed);
        answer.join().unwrap()
    });
    let took = begun.elapsed();
    assert_eq!(
        answer.map(|bytes| bytes.len()),
        Err(Problem::stopped()),
        "{text}"
    );
    assert!(took < STOPPED_AFTER + SOON, "{took:?}: {text}");
}

/// A sweep over the gain of velocity control and the delay, with `fields` and fixed values.
fn plane(head: &str, longest: f64, fixed: &str) -> String {
    format!(
        "{head}\n[axes]\nalpha_v = {{ from = -2.0, to = 2.0, points = 60 }}\n\
         tau = {{ from = 0.1, to = {longest:?}, points = 60 }}\n[fixed]\nmu_prime = -0.3\n{fixed}\n"
    )
}

const COUNTS: &str = "fields = [\"n_unstable\"]";

#[test]
fn following_curves_stops() {
    let _alone = alone();
    let boundaries = format!("{COUNTS}\nboundaries = true");
    // Whole curves, with memory and latency.
    stopped(
        Request::Chart,
        &plane(&boundaries, 1000.0, "memory = 0.9\nlatency = 2.0"),
    );
    // Degrees of stability.
    let degrees = format!("{boundaries}\ndegree_of_stability = [0.01, 0.02, 0.05, 0.1]");
    stopped(Request::Chart, &plane(&degrees, 1000.0, "memory = 0.5"));
}

#[test]
fn searching_for_best_settings_stops() {
    let _alone = alone();
    let best = format!("{COUNTS}\nbest = true");
    stopped(
        Request::Chart,
        &plane(&best, 100.0, "memory = 0.95\nlatency = 2.0"),
    );
}

#[test]
fn cells_stop() {
    let _alone = alone();
    for (fields, longest, fixed) in [
        ("\"stability_radius\"", 30.0, "memory = 0.5\nlatency = 0.3"),
        ("\"abscissa\"", 1000.0, "memory = 0.9\nlatency = 30.0"),
    ] {
        let head = format!("fields = [{fields}]");
        stopped(Request::Chart, &plane(&head, longest, fixed));
    }
}

#[test]
fn motions_stop() {
    let _alone = alone();
    let law = "[friction]\nlaw = \"weakening\"\nmu0 = 0.5\nv_s = 0.5";
    let text = plane("fields = [\"vc\"]", 100.0, "")
        .replace("mu_prime = -0.3\n", "")
        .replace("points = 60", "points = 12");
    stopped(Request::Chart, &format!("{text}{law}\n"));
}

/// A plane that one column shows to have more curves than are traced is left out before any of them
/// is followed.
#[test]
fn far_too_many_curves_are_refused_at_once() {
    let _alone = alone();
    let boundaries = format!("{COUNTS}\nboundaries = true");
    let text = plane(&boundaries, 1000.0, "memory = 0.999999\nlatency = 1000.0");
    let asked = Asked::read(Request::Chart, &text, &Limits::default()).unwrap();
    let begun = Instant::now();
    assert!(asked.answer(&Arc::new(AtomicBool::new(false))).is_ok());
    assert!(
        begun.elapsed() < Duration::from_secs(20),
        "{:?}",
        begun.elapsed()
    );
}
