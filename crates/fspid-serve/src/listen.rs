//! Connections: so many at a time, and none that a slow client can keep from somebody else.
//!
//! `axum::serve` has no deadline for the head of a request; the connections are therefore accepted here and served by
//! hyper, whose deadline works once it has a timer.

use std::convert::Infallible;
use std::io;
use std::sync::atomic::{AtomicU8, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use axum::Router;
use hyper::rt::{Read, Write};
use hyper::server::conn::http1;
use hyper::service::service_fn;
use hyper_util::rt::{TokioIo, TokioTimer};
use tokio::net::TcpListener;
use tokio::sync::Notify;

use crate::app::App;
use crate::first::first;
use crate::routes;

/// How long nobody is let in where the system has no room for another connection.
const PAUSE: Duration = Duration::from_millis(50);
/// Most lines in the head of a request.
const MOST_HEADERS: usize = 64;
/// Most bytes that are kept of a connection before they are understood: a longer head is refused.
const MOST_HEAD: usize = 32 * 1024;

/// What a connection is worth that somebody else might need.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Worth {
    /// It has sent no whole request, or is silent since its last one.
    Waiting,
    /// It gets something that anybody may have.
    Anybody,
    /// It has shown the token.
    Person,
}

/// A place that a connection has taken.
#[derive(Debug)]
pub(crate) struct Seat {
    worth: AtomicU8,
    leave: Notify,
}

impl Seat {
    fn new() -> Self {
        Self { worth: AtomicU8::new(Worth::Waiting as u8), leave: Notify::new() }
    }

    pub(crate) fn set(&self, worth: Worth) {
        self.worth.store(worth as u8, Ordering::Relaxed);
    }

    fn worth(&self) -> u8 {
        self.worth.load(Ordering::Relaxed)
    }
}

/// All places, in the order in which they were taken.
#[derive(Debug)]
pub(crate) struct Seats {
    taken: Mutex<Vec<Arc<Seat>>>,
    most: usize,
}

impl Seats {
    pub(crate) fn new(most: usize) -> Self {
        Self { taken: Mutex::new(Vec::new()), most }
    }

    /// How many are taken.
    pub(crate) fn count(&self) -> usize {
        self.taken.lock().unwrap_or_else(PoisonError::into_inner).len()
    }

    /// A place for a new connection. Where all are taken, that which is worth least has to go, of several the one that came
    /// first; none where all have shown the token.
    pub(crate) fn take(&self) -> Option<Arc<Seat>> {
        let mut taken = self.taken.lock().unwrap_or_else(PoisonError::into_inner);
        if taken.len() >= self.most {
            let least = taken.iter().enumerate().min_by_key(|(_, seat)| seat.worth());
            let (index, _) = least.filter(|(_, seat)| seat.worth() < Worth::Person as u8)?;
            taken.remove(index).leave.notify_one();
        }
        let seat = Arc::new(Seat::new());
        taken.push(Arc::clone(&seat));
        Some(seat)
    }

    fn free(&self, seat: &Arc<Seat>) {
        let mut taken = self.taken.lock().unwrap_or_else(PoisonError::into_inner);
        taken.retain(|it| !Arc::ptr_eq(it, seat));
    }
}

/// Lets clients in until it is dropped.
pub(crate) async fn listen(listener: TcpListener, app: Arc<App>) {
    let router = routes::router(&app);
    loop {
        let Ok((stream, _)) = listener.accept().await else {
            // The system has no room, or the client has gone: others are let in all the same.
            tokio::time::sleep(PAUSE).await;
            continue;
        };
        // Who finds no place finds a closed connection.
        if let Some(seat) = app.seats.take() {
            tokio::spawn(serve(TokioIo::new(stream), seat, (Arc::clone(&app), router.clone())));
        }
        // What it has sent already is read before the next one is let in: of many that come at once, the first would have
        // to go for the last, unread.
        tokio::task::yield_now().await;
    }
}

/// Serves a connection until it is closed.
pub(crate) async fn serve<S: Read + Write + Unpin>(
    stream: S,
    seat: Arc<Seat>,
    (app, router): (Arc<App>, Router),
) {
    let answer = |request| {
        let (app, seat, router) = (Arc::clone(&app), Arc::clone(&seat), router.clone());
        async move { Ok::<_, Infallible>(app.answer(request, seat, router).await) }
    };
    let connection = http1::Builder::new()
        .timer(TokioTimer::new())
        .header_read_timeout(app.limits.head)
        .max_headers(MOST_HEADERS)
        .max_buf_size(MOST_HEAD)
        .serve_connection(stream, service_fn(answer));
    // How a client leaves is its own affair.
    let _ = first(connection, seat.leave.notified()).await;
    app.seats.free(&seat);
}

/// A listener of the standard library, for the runtime.
pub(crate) fn for_runtime(listener: std::net::TcpListener) -> io::Result<TcpListener> {
    listener.set_nonblocking(true)?;
    TcpListener::from_std(listener)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_oldest_of_those_that_wait_has_to_go_and_who_has_shown_the_token_never() {
        let seats = Seats::new(3);
        let [first, second, third] = [(); 3].map(|()| seats.take().expect("a place"));
        first.set(Worth::Person);
        second.set(Worth::Anybody);
        let fourth = seats.take().expect("that of the third, which waits");
        fourth.set(Worth::Person);
        let is_taken = |seat: &Arc<Seat>| {
            seats.taken.lock().expect("sound").iter().any(|it| Arc::ptr_eq(it, seat))
        };
        assert!(is_taken(&first) && is_taken(&second) && !is_taken(&third));
        seats.take().expect("that of the second, which has no token").set(Worth::Person);
        assert!(!is_taken(&second) && seats.take().is_none());
        seats.free(&first);
        assert!(seats.count() == 2 && seats.take().is_some());
    }
}
