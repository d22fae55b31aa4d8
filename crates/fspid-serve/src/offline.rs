//! A server without a network, for fuzzing: bytes of a connection in, bytes of the answers out.
//!
//! All that is left out is the socket: hyper reads the bytes, and guard, routes and files are those of every server. No job is
//! begun, each waits.

use std::io;
use std::net::{Ipv4Addr, SocketAddr};
use std::path::Path;
use std::pin::Pin;
use std::sync::atomic::AtomicU64;
use std::sync::{Arc, Mutex, PoisonError};
use std::task::{Context, Poll};

use hyper::rt::{Read, ReadBufCursor, Write};

use crate::app::App;
use crate::guard::Guard;
use crate::jobs::{Jobs, Place};
use crate::listen::{self, Seats};
use crate::page::Page;
use crate::routes;
use crate::scenarios::Shelf;
use crate::settings::{Limits, Opened};
use crate::stream::Streams;
use crate::telemetry::Telemetry;
use crate::token::Token;

/// The port that it would listen on.
const PORT: u16 = 8000;

/// A server that listens nowhere.
#[derive(Clone)]
pub struct Offline(Arc<App>);

impl Offline {
    /// One for the scenarios of a folder, with a token of 32 hexadecimal digits. It is called `127.0.0.1:8000`.
    ///
    /// # Errors
    /// A folder that cannot be opened, in a sentence.
    pub fn new(folder: &Path, token: &str) -> Result<Self, String> {
        // None runs: what jobs do is no affair of requests.
        let limits = Limits { jobs: 0, queue: 2, ..Limits::default() };
        let address = SocketAddr::from((Ipv4Addr::LOCALHOST, PORT));
        let place = Place::new(None).map_err(|(_, reason)| reason.to_string())?;
        Ok(Self(Arc::new(App {
            guard: Guard::new(address, Token::of(token), limits.body_bytes),
            limits,
            seats: Seats::new(limits.connections),
            streams: Streams::default(),
            page: Page::of(&[("index.html", b"<!doctype html>the page")], None),
            shelf: Arc::new(Shelf::open(&Opened::Folder(folder.to_owned()))?),
            jobs: Jobs::new(place, &limits),
            telemetry: Some(Telemetry::new(PORT)),
            panics: AtomicU64::new(0),
        })))
    }

    /// What a client gets that sends these bytes and then waits until the connection is closed. It needs a runtime with a
    /// clock, and does not come back from a stream: whoever waits has to limit that. What was written till then is in the
    /// list.
    pub async fn answer(&self, bytes: Vec<u8>, written: &Arc<Mutex<Vec<u8>>>) {
        let Some(seat) = self.0.seats.take() else { return };
        let wire = Wire { unread: bytes, at: 0, written: Arc::clone(written) };
        let router = routes::router(&self.0);
        listen::serve(wire, seat, (Arc::clone(&self.0), router)).await;
    }
}

/// What one client sends, and what it gets.
struct Wire {
    unread: Vec<u8>,
    at: usize,
    written: Arc<Mutex<Vec<u8>>>,
}

impl Read for Wire {
    fn poll_read(
        mut self: Pin<&mut Self>,
        _: &mut Context<'_>,
        mut buffer: ReadBufCursor<'_>,
    ) -> Poll<io::Result<()>> {
        let rest = self.unread.get(self.at..).unwrap_or_default();
        let part = rest.get(..rest.len().min(buffer.remaining())).unwrap_or_default();
        if part.is_empty() {
            // The client says nothing more, and stays: its deadline ends the connection.
            return Poll::Pending;
        }
        buffer.put_slice(part);
        self.at += part.len();
        Poll::Ready(Ok(()))
    }
}

impl Write for Wire {
    fn poll_write(
        self: Pin<&mut Self>,
        _: &mut Context<'_>,
        bytes: &[u8],
    ) -> Poll<io::Result<usize>> {
        self.written.lock().unwrap_or_else(PoisonError::into_inner).extend_from_slice(bytes);
        Poll::Ready(Ok(bytes.len()))
    }

    fn poll_flush(self: Pin<&mut Self>, _: &mut Context<'_>) -> Poll<io::Result<()>> {
        Poll::Ready(Ok(()))
    }

    fn poll_shutdown(self: Pin<&mut Self>, _: &mut Context<'_>) -> Poll<io::Result<()>> {
        Poll::Ready(Ok(()))
    }
}
