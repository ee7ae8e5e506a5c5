//! Answers whose parts are made one after the other, while they are sent.

use std::io;
use std::pin::Pin;
use std::task::{Context, Poll, ready};

use axum::body::{Body, Bytes};
use hyper::body::{Body as Parts, Frame};

/// A part of an answer and what makes the next one; none at the end.
pub(super) type Part<S> = io::Result<Option<(Bytes, S)>>;

/// An answer whose next part is being made.
struct Streamed<S, F> {
    make: F,
    next: Option<Pin<Box<dyn Future<Output = Part<S>> + Send>>>,
}

/// The answer whose parts `make` makes, from `state` on. An error breaks it off.
pub(super) fn streamed<S, F, P>(state: S, mut make: F) -> Body
where
    S: 'static,
    F: FnMut(S) -> P + Send + Unpin + 'static,
    P: Future<Output = Part<S>> + Send + 'static,
{
    let next = Some(Box::pin(make(state)) as _);
    Body::new(Streamed { make, next })
}

impl<S, F, P> Parts for Streamed<S, F>
where
    F: FnMut(S) -> P + Unpin,
    P: Future<Output = Part<S>> + Send + 'static,
{
    type Data = Bytes;
    type Error = io::Error;

    fn poll_frame(
        self: Pin<&mut Self>,
        context: &mut Context<'_>,
    ) -> Poll<Option<io::Result<Frame<Bytes>>>> {
        let this = self.get_mut();
        let Some(next) = &mut this.next else {
            return Poll::Ready(None);
        };
        let made = ready!(next.as_mut().poll(context));
        this.next = None;
        Poll::Ready(match made {
            Ok(Some((bytes, state))) => {
                this.next = Some(Box::pin((this.make)(state)));
                Some(Ok(Frame::data(bytes)))
            }
            Ok(None) => None,
            Err(error) => Some(Err(error)),
        })
    }
}
