//! A connection that is closed if the other end does not read in time.

use std::io::{Error, ErrorKind, Result};
use std::pin::Pin;
use std::task::{Context, Poll, ready};
use std::time::Duration;

use tokio::io::{AsyncRead, AsyncWrite, ReadBuf};
use tokio::time::{Instant, Sleep};

/// A connection that is closed if the other end does not read in time.
#[derive(Debug)]
pub(super) struct Patient<S> {
    stream: S,
    patience: Duration,
    /// The deadline for the other end to read, while something waits to be read.
    until: Option<Pin<Box<Sleep>>>,
}

impl<S> Patient<S> {
    pub(super) fn new(stream: S, patience: Duration) -> Self {
        Self {
            stream,
            patience,
            until: None,
        }
    }

    pub(super) fn stream(&self) -> &S {
        &self.stream
    }

    /// Whether something that was written waits to be sent.
    pub(super) fn is_behind(&self) -> bool {
        self.until.is_some()
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

    use tokio::time::sleep;

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
