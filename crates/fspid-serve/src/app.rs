//! What every request passes: the guard, the routes, and a net below them.

use std::any::Any;
use std::future::{Future, poll_fn};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::pin::pin;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::task::Poll;

use axum::Router;
use axum::body::Body;
use axum::http::{Request, Response, StatusCode};
use axum::response::IntoResponse;
use hyper::body::Incoming;
use tower_service::Service;

use crate::answer::{Refusal, guarded};
use crate::body::Seated;
use crate::guard::{Guard, Trust};
use crate::jobs::Jobs;
use crate::listen::{Seat, Seats, Worth};
use crate::page::Page;
use crate::scenarios::Shelf;
use crate::settings::Limits;
use crate::stream::Streams;
use crate::telemetry::Telemetry;

/// A server's parts.
pub(crate) struct App {
    pub(crate) guard: Guard,
    pub(crate) limits: Limits,
    pub(crate) seats: Seats,
    pub(crate) streams: Streams,
    pub(crate) page: Page,
    pub(crate) shelf: Arc<Shelf>,
    pub(crate) jobs: Arc<Jobs>,
    pub(crate) telemetry: Option<Telemetry>,
    /// Handlers that panicked.
    pub(crate) panics: AtomicU64,
}

impl App {
    /// The answer to a request, whatever happens.
    pub(crate) async fn answer(
        self: Arc<Self>,
        request: Request<Incoming>,
        seat: Arc<Seat>,
        router: Router,
    ) -> Response<Seated> {
        let (head, body) = request.into_parts();
        let answer = match self.guard.check(&head) {
            Err(refusal) => refusal.into_response(),
            Ok(trust) => {
                seat.set(match trust {
                    Trust::Anybody => Worth::Anybody,
                    Trust::Person => Worth::Person,
                });
                let request = Request::from_parts(head, Body::new(body));
                self.routed(request, router).await
            }
        };
        guarded(answer).map(|body| Seated::new(body, seat))
    }

    async fn routed(&self, request: Request<Body>, mut router: Router) -> Response<Body> {
        match caught(router.call(request)).await {
            Ok(Ok(answer)) => answer,
            Ok(Err(never)) => match never {},
            Err(_) => self.of_panic(),
        }
    }

    /// What is told of a mistake in this program: which of them it was, so that it is found among what standard error says.
    fn of_panic(&self) -> Response<Body> {
        let id = self.panics.fetch_add(1, Ordering::Relaxed) + 1;
        let sentence = "a mistake in fspid; standard error says more, and the server goes on";
        Refusal::new(StatusCode::INTERNAL_SERVER_ERROR, sentence).with("id", id).into_response()
    }
}

/// What a future comes to, or what it panicked with.
async fn caught<F: Future>(future: F) -> Result<F::Output, Box<dyn Any + Send>> {
    let mut future = pin!(future);
    // Nothing of a future that panicked is looked at again.
    poll_fn(move |context| match catch_unwind(AssertUnwindSafe(|| future.as_mut().poll(context))) {
        Ok(Poll::Pending) => Poll::Pending,
        Ok(Poll::Ready(done)) => Poll::Ready(Ok(done)),
        Err(panic) => Poll::Ready(Err(panic)),
    })
    .await
}

#[cfg(test)]
mod tests {
    use std::io::{Read as _, Write as _};
    use std::net::TcpStream;

    use crate::{Opened, Server, Settings};

    #[test]
    fn a_handler_that_panics_is_told_with_a_number_and_the_server_goes_on() {
        let folder = tempfile::tempdir().expect("a folder");
        let settings = Settings::new(Opened::Folder(folder.path().to_owned()));
        let server = Server::start(settings).expect("it begins");
        let ask = |path: &str| {
            let (host, token) = (server.address(), server.token());
            let mut stream = TcpStream::connect(host).expect("a connection");
            write!(stream, "GET {path} HTTP/1.1\r\nHost: {host}\r\nX-Fspid-Token: {token}\r\nConnection: close\r\n\r\n")
                .expect("asked");
            let mut answer = String::new();
            stream.read_to_string(&mut answer).expect("answered");
            answer
        };
        for id in 1..=2 {
            let answer = ask("/api/panic");
            assert!(answer.starts_with("HTTP/1.1 500"), "{answer}");
            assert!(answer.contains(&format!("\"id\":{id}")), "{answer}");
            assert!(answer.contains("content-security-policy"), "{answer}");
        }
        assert!(ask("/api/health").contains("\"panics\":2"));
    }
}
