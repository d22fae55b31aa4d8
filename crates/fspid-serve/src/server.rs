//! A server: begun, asked where it is, and stopped.

use std::io::{self, Write as _};
use std::net::{IpAddr, SocketAddr, TcpListener};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::AtomicU64;
use std::thread::{self, JoinHandle};

use fspid_study::output::in_words;
use tempfile::NamedTempFile;
use tokio::net::UdpSocket;
use tokio::runtime::{Builder, Runtime};
use tokio::sync::oneshot;

use crate::app::App;
use crate::first::first;
use crate::guard::Guard;
use crate::jobs::{Jobs, Place};
use crate::listen::{Seats, for_runtime, listen};
use crate::scenarios::Shelf;
use crate::settings::{Settings, cores};
use crate::stream::Streams;
use crate::telemetry::{self, Telemetry};
use crate::token::Token;

/// Threads on which files are read and saved.
const FILE_THREADS: usize = 4;

/// Why a server does not begin.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum StartError {
    /// What shall be opened cannot be.
    #[error("{0}")]
    Opened(String),
    /// All addresses at once: which of them a client may name as the host would be anybody's guess.
    #[error("{0} stands for every address of this machine; name one of them")]
    EveryAddress(IpAddr),
    /// A port is taken.
    #[error("port {port} is taken; name another one with {option}, or 0 for any that is free")]
    Taken {
        /// The port.
        port: u16,
        /// The option that names it.
        option: &'static str,
    },
    /// An address cannot be listened on.
    #[error("{address} cannot be listened on: {reason}")]
    Address {
        /// The address.
        address: SocketAddr,
        /// Why.
        reason: io::Error,
    },
    /// There is no place for what jobs write.
    #[error("{}: {}", path.display(), in_words(reason))]
    Folder {
        /// The folder.
        path: PathBuf,
        /// Why.
        reason: io::Error,
    },
    /// The system has no threads or no random bits.
    #[error("{0}")]
    System(String),
}

/// A server that runs until it is stopped or dropped.
#[derive(Debug)]
pub struct Server {
    address: SocketAddr,
    telemetry_port: Option<u16>,
    token: Token,
    jobs: Arc<Jobs>,
    /// Gone once it is told to stop.
    stop: Option<oneshot::Sender<()>>,
    thread: Option<JoinHandle<()>>,
}

impl Server {
    /// Begins to serve, on a thread of its own.
    ///
    /// # Errors
    /// [`StartError`]: nothing has begun then.
    pub fn start(settings: Settings) -> Result<Self, StartError> {
        let Settings { opened, host, port, telemetry_port, kept, page, limits } = settings;
        if host.is_unspecified() {
            return Err(StartError::EveryAddress(host));
        }
        let shelf = Shelf::open(&opened).map_err(StartError::Opened)?;
        let listener = bound(SocketAddr::new(host, port), "--port", TcpListener::bind)?;
        let address = listener.local_addr().map_err(system)?;
        let heard =
            |port| bound(telemetry::address(port), "--telemetry", std::net::UdpSocket::bind);
        let socket = telemetry_port.map(heard).transpose()?;
        let port_of = |socket: &std::net::UdpSocket| socket.local_addr().map(|it| it.port());
        let telemetry_port = socket.as_ref().map(port_of).transpose().map_err(system)?;
        let token = Token::random().map_err(system)?;
        let place =
            Place::new(kept).map_err(|(path, reason)| StartError::Folder { path, reason })?;
        let jobs = Jobs::new(place, &limits);
        let app = Arc::new(App {
            guard: Guard::new(address, token.clone(), limits.body_bytes),
            limits,
            seats: Seats::new(limits.connections),
            streams: Streams::default(),
            page,
            shelf: Arc::new(shelf),
            jobs: Arc::clone(&jobs),
            telemetry: telemetry_port.map(Telemetry::new),
            panics: AtomicU64::new(0),
        });
        let runtime = Builder::new_current_thread()
            .enable_all()
            .max_blocking_threads(FILE_THREADS)
            .build()
            .map_err(system)?;
        let (stop, stopped) = oneshot::channel();
        let sockets = (listener, socket);
        let work = move || run(&runtime, sockets, app, stopped);
        let thread =
            thread::Builder::new().name("server".to_owned()).spawn(work).map_err(system)?;
        let (stop, thread) = (Some(stop), Some(thread));
        Ok(Self { address, telemetry_port, token, jobs, stop, thread })
    }

    /// Where it listens.
    #[must_use]
    pub fn address(&self) -> SocketAddr {
        self.address
    }

    /// The port that telemetry is heard on, if it is.
    #[must_use]
    pub fn telemetry_port(&self) -> Option<u16> {
        self.telemetry_port
    }

    /// What requests have to show.
    #[must_use]
    pub fn token(&self) -> &str {
        self.token.text()
    }

    /// The address for a browser of this machine, with the token behind it: no browser sends what stands there to anybody.
    #[must_use]
    pub fn url(&self) -> String {
        let host = match self.address.ip() {
            IpAddr::V4(ip) => ip.to_string(),
            IpAddr::V6(ip) => format!("[{ip}]"),
        };
        format!("http://{host}:{}/#token={}", self.address.port(), self.token())
    }

    /// A file that only this user can read and that leads a browser to the page. The address itself would stand in the list of
    /// all processes.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn door(&self) -> io::Result<NamedTempFile> {
        let mut file = tempfile::Builder::new().prefix("fspid-").suffix(".html").tempfile()?;
        let url = self.url();
        writeln!(
            file,
            "<!doctype html><meta charset=\"utf-8\"><meta name=\"referrer\" content=\"no-referrer\"><meta http-equiv=\"refresh\" content=\"0; url={url}\"><title>fspid</title><a href=\"{url}\">fspid</a>"
        )?;
        Ok(file)
    }

    /// Ends its jobs, then itself; comes back when both have ended.
    pub fn stop(mut self) {
        self.end();
    }

    fn end(&mut self) {
        self.jobs.close();
        drop(self.stop.take());
        if let Some(thread) = self.thread.take() {
            // It ends also where it has panicked.
            let _ = thread.join();
        }
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        self.end();
    }
}

/// Leaves one core of the machine to whoever asks: the threads that all jobs share are one less than there are cores. Says
/// nothing where the process has such threads already.
pub fn leave_a_core() {
    let threads = cores().saturating_sub(1).max(1);
    let _ = rayon::ThreadPoolBuilder::new().num_threads(threads).build_global();
}

fn run(
    runtime: &Runtime,
    (listener, socket): (TcpListener, Option<std::net::UdpSocket>),
    app: Arc<App>,
    stopped: oneshot::Receiver<()>,
) {
    runtime.block_on(async {
        // A socket that the runtime does not take is one that nobody hears.
        let Ok(listener) = for_runtime(listener) else { return };
        let hears = socket.zip(app.telemetry.clone()).and_then(|(socket, telemetry)| {
            socket.set_nonblocking(true).ok()?;
            Some(telemetry.hear(UdpSocket::from_std(socket).ok()?))
        });
        if let Some(hears) = hears {
            tokio::spawn(hears);
        }
        first(stopped, listen(listener, app)).await;
    });
}

fn bound<T>(
    address: SocketAddr,
    option: &'static str,
    bind: impl FnOnce(SocketAddr) -> io::Result<T>,
) -> Result<T, StartError> {
    bind(address).map_err(|reason| match reason.kind() {
        io::ErrorKind::AddrInUse => StartError::Taken { port: address.port(), option },
        _ => StartError::Address { address, reason },
    })
}

fn system(reason: impl ToString) -> StartError {
    StartError::System(reason.to_string())
}
