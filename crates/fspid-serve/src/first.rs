//! Two things that are waited for, of which the first one counts.

use std::future::{Future, poll_fn};
use std::pin::pin;
use std::task::Poll;

/// Which of the two came.
pub(crate) enum First<A, B> {
    /// The one that is named first; it is asked first.
    This(A),
    /// The other one.
    Other(B),
}

/// Waits for either; the one that did not come is dropped.
pub(crate) async fn first<A: Future, B: Future>(one: A, other: B) -> First<A::Output, B::Output> {
    let (mut one, mut other) = (pin!(one), pin!(other));
    poll_fn(move |context| {
        if let Poll::Ready(came) = one.as_mut().poll(context) {
            return Poll::Ready(First::This(came));
        }
        other.as_mut().poll(context).map(First::Other)
    })
    .await
}
