//! Connections: how many, and for how long. A client that sends nothing, or reads nothing, makes
//! room for others.

use std::collections::VecDeque;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use axum::Router;
use axum::body::{Body, to_bytes};
use axum::extract::Request;
use axum::http::{StatusCode, header};
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};
use hyper::server::conn::http1;
use hyper::service::{Service, service_fn};
use hyper_util::rt::{TokioIo, TokioTimer};
use hyper_util::service::TowerToHyperService;
use tokio::sync::Semaphore;
use tokio::task::AbortHandle;
use tokio::time::{sleep, timeout};

use super::leaving::{Asking, Socket, Watched, gone};
use super::patient::Patient;
use super::problem::Problem;

/// The most connections that are open at a time.
const MOST_OPEN: usize = 512;
/// The longest time to read the head of a request, and again to read its body.
pub(super) const TO_ASK: Duration = Duration::from_secs(10);
/// The longest time a client may take to read an answer.
const TO_READ: Duration = Duration::from_secs(60);
/// The time before another try when the system gives no connection.
const AFTER_ERROR: Duration = Duration::from_millis(50);
/// The most bytes of the head of a request.
const LONGEST_HEAD: usize = 1 << 16;

/// Where connections come from.
#[derive(Debug)]
pub(super) enum Listener {
    Tcp(tokio::net::TcpListener),
    #[cfg(unix)]
    Unix(tokio::net::UnixListener),
}

/// Open connections that have sent no request yet, the oldest first.
type Silent = VecDeque<(Arc<AtomicBool>, AbortHandle)>;

/// Answers all clients; never ends by itself.
pub(super) async fn answer(listener: Listener, app: Router) {
    let places = Arc::new(Semaphore::new(MOST_OPEN));
    let mut silent = Silent::new();
    loop {
        let place = Arc::clone(&places);
        if place.available_permits() == 0 {
            end_oldest(&mut silent);
        }
        let Ok(place) = place.acquire_owned().await else {
            return;
        };
        let asked = Arc::new(AtomicBool::new(false));
        let app = app.clone();
        let answered = match &listener {
            Listener::Tcp(tcp) => tcp.accept().await.map(|(stream, _)| {
                // If the system refuses this, answers are only slower.
                drop(stream.set_nodelay(true));
                tokio::spawn(one(stream, app, Arc::clone(&asked), place))
            }),
            #[cfg(unix)]
            Listener::Unix(unix) => unix
                .accept()
                .await
                .map(|(stream, _)| tokio::spawn(one(stream, app, Arc::clone(&asked), place))),
        };
        match answered {
            Ok(task) => {
                silent
                    .retain(|(asked, task)| !asked.load(Ordering::Relaxed) && !task.is_finished());
                silent.push_back((asked, task.abort_handle()));
            }
            Err(_) => sleep(AFTER_ERROR).await,
        }
    }
}

/// Ends the connection that has been silent for longest.
fn end_oldest(silent: &mut Silent) {
    while let Some((asked, task)) = silent.pop_front() {
        if !asked.load(Ordering::Relaxed) && !task.is_finished() {
            task.abort();
            return;
        }
    }
}

/// Answers one connection, as long as its client is there.
async fn one<S: Socket>(
    stream: S,
    app: Router,
    asked: Arc<AtomicBool>,
    place: tokio::sync::OwnedSemaphorePermit,
) {
    let app = TowerToHyperService::new(app);
    let asking = Arc::new(Asking::default());
    let begun = Arc::clone(&asking);
    let service = service_fn(move |mut request: hyper::Request<hyper::body::Incoming>| {
        request.extensions_mut().insert(Silence(Arc::clone(&asked)));
        let answering = begun.begin(request.version());
        let answer = app.call(request);
        async move {
            let answer = answer.await;
            drop(answering);
            answer
        }
    });
    let stream = Watched::new(Patient::new(stream, TO_READ));
    let connection = http1::Builder::new()
        .timer(TokioTimer::new())
        .header_read_timeout(TO_ASK)
        .max_buf_size(LONGEST_HEAD)
        // A client may say that it sends no more, and wait for its answer.
        .half_close(true)
        .serve_connection(TokioIo::new(stream.clone()), service);
    tokio::select! {
        // Clients that break off are not reported.
        _ = connection => {}
        () = gone(&stream, &asking) => {}
    }
    drop(place);
}

/// Set by the first request of a connection that is answered.
#[derive(Clone)]
struct Silence(Arc<AtomicBool>);

/// Marks the connection of an accepted request, so that it is not ended to make room for others.
pub(super) fn is_answered(request: &Request) {
    if let Some(Silence(asked)) = request.extensions().get() {
        asked.store(true, Ordering::Relaxed);
    }
}

/// Reads the body of a request, of at most `most` bytes, before the request is handled.
pub(super) async fn read_body(request: Request, most: usize, next: Next) -> Response {
    let (head, body) = request.into_parts();
    let refused = |status, detail: &str| closing(Problem::of(status, detail));
    match timeout(TO_ASK, to_bytes(body, most)).await {
        Ok(Ok(bytes)) => next.run(Request::from_parts(head, Body::from(bytes))).await,
        Ok(Err(error)) if is_of_connection(&error) => refused(
            StatusCode::BAD_REQUEST,
            "the request ended before all of it came",
        ),
        Ok(Err(_)) => refused(StatusCode::PAYLOAD_TOO_LARGE, "the request is too long"),
        Err(_) => refused(StatusCode::REQUEST_TIMEOUT, "the request came too slowly"),
    }
}

/// The answer about a request whose body is not read to its end: the connection is closed.
pub(super) fn closing(problem: Problem) -> Response {
    let mut response = problem.into_response();
    let close = header::HeaderValue::from_static("close");
    response.headers_mut().insert(header::CONNECTION, close);
    response
}

/// Whether a body could not be read, rather than being too long.
fn is_of_connection(error: &axum::Error) -> bool {
    let error: &(dyn std::error::Error + 'static) = error;
    let mut causes = std::iter::successors(Some(error), |error| error.source());
    causes.any(<dyn std::error::Error>::is::<hyper::Error>)
}
