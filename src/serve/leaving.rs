//! Whether the client of a request is still there while its answer is computed.
//!
//! A client that has closed its connection and one that has only said that it sends no more look
//! the same, until something is sent: the system of the first one refuses it. So while the answer
//! to a request is computed after whose end nothing more can come, `100 Continue` is sent again and
//! again. Clients of HTTP/1.1 skip it. Those of HTTP/1.0 are not sent any: what they have asked is
//! computed to its end.

use std::io::{ErrorKind, IoSlice, Result};
use std::pin::{Pin, pin};
use std::sync::atomic::{AtomicU8, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::task::{Context, Poll, Waker, ready};
use std::time::Duration;

use axum::http::Version;
use tokio::io::{AsyncRead, AsyncWrite, Interest, ReadBuf, Ready};
use tokio::sync::Notify;
use tokio::time::sleep;

use super::patient::Patient;

/// How often it is checked whether the client is there.
const PAUSE: Duration = Duration::from_millis(50);
/// What is sent to find out.
const ARE_YOU_THERE: &[u8] = b"HTTP/1.1 100 Continue\r\n\r\n";

/// What connections are made of.
pub(super) trait Socket: AsyncRead + AsyncWrite + Unpin + Send + 'static {
    /// Waits until something can be read or written, or an end has been closed.
    fn ready(&self, interest: Interest) -> impl Future<Output = Result<Ready>> + Send;

    /// Writes what can be written at once.
    fn try_write(&self, bytes: &[u8]) -> Result<usize>;
}

impl Socket for tokio::net::TcpStream {
    fn ready(&self, interest: Interest) -> impl Future<Output = Result<Ready>> + Send {
        self.ready(interest)
    }

    fn try_write(&self, bytes: &[u8]) -> Result<usize> {
        self.try_write(bytes)
    }
}

#[cfg(unix)]
impl Socket for tokio::net::UnixStream {
    fn ready(&self, interest: Interest) -> impl Future<Output = Result<Ready>> + Send {
        self.ready(interest)
    }

    fn try_write(&self, bytes: &[u8]) -> Result<usize> {
        self.try_write(bytes)
    }
}

/// Nothing is asked on a connection.
const NOTHING: u8 = 0;
/// A request of HTTP/1.0 is answered.
const OLD: u8 = 1;
/// A request of HTTP/1.1 is answered.
const NEW: u8 = 2;

/// What is asked on a connection, and not answered yet.
#[derive(Debug, Default)]
pub(super) struct Asking {
    now: AtomicU8,
    begun: Notify,
}

/// A request whose answer has not begun.
pub(super) struct Answering(Arc<Asking>);

impl Asking {
    /// A request has come.
    pub(super) fn begin(self: &Arc<Self>, version: Version) -> Answering {
        let now = if version < Version::HTTP_11 { OLD } else { NEW };
        self.now.store(now, Ordering::Relaxed);
        self.begun.notify_one();
        Answering(Arc::clone(self))
    }

    fn now(&self) -> u8 {
        self.now.load(Ordering::Relaxed)
    }
}

impl Drop for Answering {
    fn drop(&mut self) {
        self.0.now.store(NOTHING, Ordering::Relaxed);
    }
}

/// Returns once the client of a request has gone. It belongs to the task that answers.
pub(super) async fn gone<S: Socket>(stream: &Watched<S>, asking: &Asking) {
    loop {
        asking.begun.notified().await;
        while asking.now() != NOTHING {
            sleep(PAUSE).await;
            let now = asking.now();
            if now != NOTHING && stream.line().has_gone(now == NEW) {
                return;
            }
        }
    }
}

/// A connection that is looked at while it is read and written.
#[derive(Debug)]
pub(super) struct Watched<S>(Arc<Mutex<Line<S>>>);

#[derive(Debug)]
struct Line<S> {
    stream: Patient<S>,
    /// The end of what is sent to find out, which comes before anything else.
    owed: &'static [u8],
}

impl<S> Clone for Watched<S> {
    fn clone(&self) -> Self {
        Self(Arc::clone(&self.0))
    }
}

impl<S> Watched<S> {
    pub(super) fn new(stream: Patient<S>) -> Self {
        Self(Arc::new(Mutex::new(Line { stream, owed: &[] })))
    }

    fn line(&self) -> MutexGuard<'_, Line<S>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl<S: Socket> Line<S> {
    /// Whether the client has gone. With `asks`, one that sends no more is asked.
    fn has_gone(&mut self, asks: bool) -> bool {
        match self.state() {
            Poll::Ready(Ok(state)) if state.is_write_closed() => true,
            Poll::Ready(Ok(state)) => asks && state.is_read_closed() && self.ask().is_err(),
            Poll::Ready(Err(_)) => true,
            Poll::Pending => false,
        }
    }

    /// What the system says of the connection.
    fn state(&self) -> Poll<Result<Ready>> {
        let any = Interest::READABLE | Interest::WRITABLE;
        let state = pin!(Socket::ready(self.stream.stream(), any));
        state.poll(&mut Context::from_waker(Waker::noop()))
    }

    /// Sends what is only for finding out, unless something waits to be sent.
    fn ask(&mut self) -> Result<()> {
        if self.stream.is_behind() || !self.owed.is_empty() {
            return Ok(());
        }
        match self.stream.stream().try_write(ARE_YOU_THERE) {
            // Of nothing, nothing is owed.
            Ok(0) => Ok(()),
            Ok(written) => {
                self.owed = &ARE_YOU_THERE[written..];
                Ok(())
            }
            Err(error) if error.kind() == ErrorKind::WouldBlock => Ok(()),
            Err(error) => Err(error),
        }
    }

    /// Sends what is owed.
    fn pay(&mut self, context: &mut Context<'_>) -> Poll<Result<()>> {
        while !self.owed.is_empty() {
            let written = ready!(Pin::new(&mut self.stream).poll_write(context, self.owed))?;
            self.owed = &self.owed[written..];
            if written == 0 {
                return Poll::Ready(Err(ErrorKind::WriteZero.into()));
            }
        }
        Poll::Ready(Ok(()))
    }
}

impl<S: Socket> AsyncRead for Watched<S> {
    fn poll_read(
        self: Pin<&mut Self>,
        context: &mut Context<'_>,
        buffer: &mut ReadBuf<'_>,
    ) -> Poll<Result<()>> {
        Pin::new(&mut self.line().stream).poll_read(context, buffer)
    }
}

impl<S: Socket> AsyncWrite for Watched<S> {
    fn poll_write(
        self: Pin<&mut Self>,
        context: &mut Context<'_>,
        bytes: &[u8],
    ) -> Poll<Result<usize>> {
        let mut line = self.line();
        ready!(line.pay(context))?;
        Pin::new(&mut line.stream).poll_write(context, bytes)
    }

    fn poll_write_vectored(
        self: Pin<&mut Self>,
        context: &mut Context<'_>,
        bytes: &[IoSlice<'_>],
    ) -> Poll<Result<usize>> {
        let mut line = self.line();
        ready!(line.pay(context))?;
        Pin::new(&mut line.stream).poll_write_vectored(context, bytes)
    }

    fn is_write_vectored(&self) -> bool {
        self.line().stream.is_write_vectored()
    }

    fn poll_flush(self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<Result<()>> {
        let mut line = self.line();
        ready!(line.pay(context))?;
        Pin::new(&mut line.stream).poll_flush(context)
    }

    fn poll_shutdown(self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<Result<()>> {
        Pin::new(&mut self.line().stream).poll_shutdown(context)
    }
}
