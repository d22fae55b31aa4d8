//! Streams of server-sent events: of a job from any event on, of telemetry from now on.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

use axum::body::{Body, Bytes};
use axum::http::{HeaderMap, Response, StatusCode};
use serde_json::json;
use tokio::sync::mpsc::{self, Sender};
use tokio::time::timeout;

use crate::answer::{Refusal, of_kind};
use crate::body::Sent;
use crate::first::{First, first};
use crate::jobs::{Event, Job};
use crate::settings::Limits;
use crate::telemetry::Telemetry;

/// Pieces that wait for a client: one that reads slowly has its events fetched more slowly.
const WAITING: usize = 4;
/// Events that are sent in one piece.
const AT_ONCE: usize = 64;

/// The streams that are open.
#[derive(Debug, Default)]
pub(crate) struct Streams {
    open: Arc<AtomicUsize>,
}

/// One of them; counted until it is dropped.
struct Open(Arc<AtomicUsize>);

impl Drop for Open {
    fn drop(&mut self) {
        self.0.fetch_sub(1, Ordering::Relaxed);
    }
}

impl Streams {
    /// How many are open.
    pub(crate) fn count(&self) -> usize {
        self.open.load(Ordering::Relaxed)
    }

    fn opened(&self, most: usize) -> Result<Open, Refusal> {
        let more = |open: usize| (open < most).then_some(open + 1);
        match self.open.fetch_update(Ordering::Relaxed, Ordering::Relaxed, more) {
            Ok(_) => Ok(Open(Arc::clone(&self.open))),
            Err(_) => {
                Err(Refusal::busy(format_args!("{most} streams are open, and no more may be")))
            }
        }
    }

    /// The events of a job, from the one behind that which the client has seen last.
    pub(crate) fn of_job(
        &self,
        job: Arc<Job>,
        headers: &HeaderMap,
        limits: &Limits,
    ) -> Result<Response<Body>, Refusal> {
        let next = next_event(headers)?;
        let (open, silence) = (self.opened(limits.streams)?, limits.silence);
        Ok(streamed(|pieces| async move {
            let _open = open;
            tell_job(&job, next, &pieces, silence).await;
        }))
    }

    /// Telemetry as it comes.
    pub(crate) fn of_telemetry(
        &self,
        telemetry: &Telemetry,
        limits: &Limits,
    ) -> Result<Response<Body>, Refusal> {
        let (open, silence) = (self.opened(limits.streams)?, limits.silence);
        let mut lines = telemetry.follow();
        Ok(streamed(|pieces| async move {
            let _open = open;
            let begun = Event::new("begun", &lines.told());
            if pieces.send(begun.piece()).await.is_err() {
                return;
            }
            loop {
                let next = first(timeout(silence, lines.next()), pieces.closed()).await;
                let piece = match next {
                    First::This(Ok(Some(event))) => event.piece(),
                    First::This(Err(_)) => SILENT,
                    First::This(Ok(None)) | First::Other(()) => return,
                };
                if pieces.send(piece).await.is_err() {
                    return;
                }
            }
        }))
    }
}

/// A comment, which says that the stream is alive.
const SILENT: Bytes = Bytes::from_static(b":\n\n");

/// An answer whose pieces a task sends until nobody reads any more.
fn streamed<F: Future<Output = ()> + Send + 'static>(
    tell: impl FnOnce(Sender<Bytes>) -> F,
) -> Response<Body> {
    let (pieces, sent) = mpsc::channel(WAITING);
    tokio::spawn(tell(pieces));
    of_kind(StatusCode::OK, "text/event-stream", Body::new(Sent(sent)))
}

/// Number of the first event that the client has not seen.
fn next_event(headers: &HeaderMap) -> Result<u64, Refusal> {
    let Some(last) = headers.get("last-event-id") else { return Ok(0) };
    let number = last.to_str().ok().and_then(|text| text.trim().parse::<u64>().ok());
    let next = number.and_then(|number| number.checked_add(1));
    next.ok_or_else(|| Refusal::wrong("Last-Event-ID is no number of an event"))
}

async fn tell_job(job: &Job, mut next: u64, pieces: &Sender<Bytes>, silence: Duration) {
    let mut news = job.news();
    loop {
        // Before the events are looked at: what comes meanwhile is news.
        news.borrow_and_update();
        let found = job.events(next, AT_ONCE);
        if found.lost > 0 {
            let lost = Event::new("lost", &json!({ "events": found.lost }));
            if pieces.send(lost.piece()).await.is_err() {
                return;
            }
        }
        if !found.events.is_empty() {
            let piece: Vec<u8> = found.events.iter().flat_map(|event| event.piece()).collect();
            if pieces.send(piece.into()).await.is_err() {
                return;
            }
        }
        next = found.next;
        if found.is_all && found.is_over {
            return;
        }
        if !found.is_all {
            continue;
        }
        match first(timeout(silence, news.changed()), pieces.closed()).await {
            First::This(Ok(Ok(()))) => {}
            First::This(Err(_)) => {
                if pieces.send(SILENT).await.is_err() {
                    return;
                }
            }
            First::This(Ok(Err(_))) | First::Other(()) => return,
        }
    }
}
