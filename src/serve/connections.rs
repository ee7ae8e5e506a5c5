//! Connections: how many, and for how long. A client that sends nothing, or reads nothing, makes
//! room for others.

use std::collections::VecDeque;
use std::io::{Error, ErrorKind, Result};
use std::pin::Pin;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::task::{Context, Poll, ready};
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
use tokio::io::{AsyncRead, AsyncWrite, ReadBuf};
use tokio::sync::Semaphore;
use tokio::task::AbortHandle;
use tokio::time::{Instant, Sleep, sleep, timeout};

use super::problem::Problem;

/// The most connections that are open at a time.
const MOST_OPEN: usize = 512;
/// The longest time to read the head of a request, and again to read its body.
const TO_ASK: Duration = Duration::from_secs(10);
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

/// Answers one connection.
async fn one<S: AsyncRead + AsyncWrite + Unpin + Send + 'static>(
    stream: S,
    app: Router,
    asked: Arc<AtomicBool>,
    place: tokio::sync::OwnedSemaphorePermit,
) {
    let app = TowerToHyperService::new(app);
    let service = service_fn(move |mut request: hyper::Request<hyper::body::Incoming>| {
        request.extensions_mut().insert(Silence(Arc::clone(&asked)));
        app.call(request)
    });
    let stream = TokioIo::new(Patient::new(stream, TO_READ));
    let connection = http1::Builder::new()
        .timer(TokioTimer::new())
        .header_read_timeout(TO_ASK)
        .max_buf_size(LONGEST_HEAD)
        .serve_connection(stream, service);
    // Clients that break off are not reported.
    drop(connection.await);
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
    let refused = |status, detail: &str| {
        let mut response = Problem::of(status, detail).into_response();
        let close = header::HeaderValue::from_static("close");
        response.headers_mut().insert(header::CONNECTION, close);
        response
    };
    match timeout(TO_ASK, to_bytes(body, most)).await {
        Ok(Ok(bytes)) => next.run(Request::from_parts(head, Body::from(bytes))).await,
        Ok(Err(_)) => refused(StatusCode::PAYLOAD_TOO_LARGE, "the request is too long"),
        Err(_) => refused(StatusCode::REQUEST_TIMEOUT, "the request came too slowly"),
    }
}

/// A connection that is closed if the other end does not read in time.
struct Patient<S> {
    stream: S,
    patience: Duration,
    /// The deadline for the other end to read, while something waits to be read.
    until: Option<Pin<Box<Sleep>>>,
}

impl<S> Patient<S> {
    fn new(stream: S, patience: Duration) -> Self {
        Self {
            stream,
            patience,
            until: None,
        }
    }

    /// The result of a write that has to wait: an error after the deadline.
    fn wait<T>(&mut self, context: &mut Context<'_>) -> Poll<Result<T>> {
        let end = Instant::now() + self.patience;
        let until = self
            .until
            .get_or_insert_with(|| Box::pin(tokio::time::sleep_until(end)));
        ready!(until.as_mut().poll(context));
        Poll::Ready(Err(Error::from(ErrorKind::TimedOut)))
    }
}

impl<S: AsyncRead + Unpin> AsyncRead for Patient<S> {
    fn poll_read(
        self: Pin<&mut Self>,
        context: &mut Context<'_>,
        buffer: &mut ReadBuf<'_>,
    ) -> Poll<Result<()>> {
        Pin::new(&mut self.get_mut().stream).poll_read(context, buffer)
    }
}

impl<S: AsyncWrite + Unpin> AsyncWrite for Patient<S> {
    fn poll_write(
        self: Pin<&mut Self>,
        context: &mut Context<'_>,
        bytes: &[u8],
    ) -> Poll<Result<usize>> {
        let this = self.get_mut();
        match Pin::new(&mut this.stream).poll_write(context, bytes) {
            Poll::Pending => this.wait(context),
            done @ Poll::Ready(_) => done,
        }
    }

    fn poll_write_vectored(
        self: Pin<&mut Self>,
        context: &mut Context<'_>,
        bytes: &[std::io::IoSlice<'_>],
    ) -> Poll<Result<usize>> {
        let this = self.get_mut();
        match Pin::new(&mut this.stream).poll_write_vectored(context, bytes) {
            Poll::Pending => this.wait(context),
            done @ Poll::Ready(_) => done,
        }
    }

    fn is_write_vectored(&self) -> bool {
        self.stream.is_write_vectored()
    }

    /// Called when all of an answer is written.
    fn poll_flush(self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<Result<()>> {
        let this = self.get_mut();
        match Pin::new(&mut this.stream).poll_flush(context) {
            Poll::Pending => this.wait(context),
            done @ Poll::Ready(_) => {
                this.until = None;
                done
            }
        }
    }

    fn poll_shutdown(self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<Result<()>> {
        let this = self.get_mut();
        match Pin::new(&mut this.stream).poll_shutdown(context) {
            Poll::Pending => this.wait(context),
            done @ Poll::Ready(_) => done,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An answer that is not read is given up. One that is read is not, however long it takes.
    #[cfg(unix)]
    #[test]
    fn a_client_that_does_not_read_is_given_up() {
        let runtime = tokio::runtime::Builder::new_current_thread()
            .enable_all()
            .build()
            .unwrap();
        let written = |reads: bool| {
            let patience = Duration::from_millis(200);
            runtime.block_on(async move {
                let (ours, theirs) = tokio::net::UnixStream::pair().unwrap();
                let reading = tokio::spawn(async move {
                    let mut read = vec![0; 1 << 16];
                    loop {
                        if reads && theirs.try_read(&mut read).is_ok_and(|bytes| bytes == 0) {
                            break;
                        }
                        sleep(Duration::from_millis(1)).await;
                    }
                });
                let mut stream = Patient::new(ours, patience);
                let part = vec![7; 1 << 16];
                let mut left = 10_usize << 20;
                let done = std::future::poll_fn(|context| {
                    while left > 0 {
                        let written = Pin::new(&mut stream).poll_write(context, &part);
                        left = left.saturating_sub(ready!(written)?);
                        ready!(Pin::new(&mut stream).poll_flush(context))?;
                    }
                    Poll::Ready(Result::Ok(()))
                });
                let done = done.await;
                reading.abort();
                done
            })
        };
        assert!(written(true).is_ok());
        assert_eq!(written(false).unwrap_err().kind(), ErrorKind::TimedOut);
    }
}
