//! Connections: who may hold one, and for how long. Whoever says nothing, or reads nothing, makes
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

/// Connections that are open at a time.
const MOST_OPEN: usize = 512;
/// The head of a request is read for so long, and its body again.
const TO_ASK: Duration = Duration::from_secs(10);
/// A client has so long to read an answer.
const TO_READ: Duration = Duration::from_secs(60);
/// Where the system gives no connection, it is asked again after so long.
const AFTER_ERROR: Duration = Duration::from_millis(50);
/// Bytes of the head of a request.
const LONGEST_HEAD: usize = 1 << 16;

/// Where connections come from.
#[derive(Debug)]
pub(super) enum Listener {
    Tcp(tokio::net::TcpListener),
    #[cfg(unix)]
    Unix(tokio::net::UnixListener),
}

/// Those that are open and have asked nothing yet, the oldest first.
type Silent = VecDeque<(Arc<AtomicBool>, AbortHandle)>;

/// Answers all who connect; never ends by itself.
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
                // Where the system refuses, answers take longer.
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

/// Ends the connection that has said nothing for longest.
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
    // Clients that break off are no news.
    drop(connection.await);
    drop(place);
}

/// What ends with the first request of a connection that is answered.
#[derive(Clone)]
struct Silence(Arc<AtomicBool>);

/// A request may be made, so its connection makes no room for others.
pub(super) fn is_answered(request: &Request) {
    if let Some(Silence(asked)) = request.extensions().get() {
        asked.store(true, Ordering::Relaxed);
    }
}

/// Reads the body of a request, of so many bytes at most, before anything is done about it.
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

/// A connection that is closed if its other end does not read in time.
struct Patient<S> {
    stream: S,
    patience: Duration,
    /// Runs while something waits to be read there.
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

    /// The result of a write that has to wait: an error once its time is over.
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

    /// Comes when all of an answer is written.
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

    /// An answer that is not read is given up; one that is read is not, however long it is.
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
