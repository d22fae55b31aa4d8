//! What a server is asked to do, and how much of it.

use std::net::{IpAddr, Ipv4Addr};
use std::path::PathBuf;
use std::time::Duration;

use crate::page::Page;

/// What a person opens.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Opened {
    /// The scenarios in and below a folder.
    Folder(PathBuf),
    /// One scenario alone.
    Scenario(PathBuf),
}

/// What a server serves, and where.
#[derive(Clone, Debug)]
pub struct Settings {
    /// What is opened.
    pub opened: Opened,
    /// Address that is listened on; loopback unless somebody asks for another.
    pub host: IpAddr,
    /// Port; 0 for any that is free.
    pub port: u16,
    /// Port on loopback on which telemetry comes by UDP; 0 for any that is free, none for no telemetry.
    pub telemetry_port: Option<u16>,
    /// Where jobs keep what they write; a folder that goes with the server where none is named.
    pub kept: Option<PathBuf>,
    /// The page.
    pub page: Page,
    /// How much of everything.
    pub limits: Limits,
}

impl Settings {
    /// The page that the crate was built with, on a free port of this machine.
    #[must_use]
    pub fn new(opened: Opened) -> Self {
        Self {
            opened,
            host: IpAddr::V4(Ipv4Addr::LOCALHOST),
            port: 0,
            telemetry_port: None,
            kept: None,
            page: Page::built(),
            limits: Limits::default(),
        }
    }
}

/// How much of everything: what lies beyond is refused, and never waited for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// How long a client may take to send the head of a request.
    pub head: Duration,
    /// How long it may take to send the body.
    pub body: Duration,
    /// How long a stream is silent at most: a comment is sent then.
    pub silence: Duration,
    /// Largest body of a request, in bytes.
    pub body_bytes: usize,
    /// Connections at a time.
    pub connections: usize,
    /// Streams of events at a time.
    pub streams: usize,
    /// Jobs that run at a time.
    pub jobs: usize,
    /// Jobs that wait.
    pub queue: usize,
    /// How long a job may run.
    pub job: Duration,
    /// Memory that a job may take, in bytes.
    pub job_bytes: u64,
}

impl Default for Limits {
    /// As many jobs as the machine has cores but one, which is left for answers.
    fn default() -> Self {
        Self {
            head: Duration::from_secs(5),
            body: Duration::from_secs(30),
            silence: Duration::from_secs(15),
            body_bytes: 1024 * 1024,
            connections: 64,
            streams: 16,
            jobs: cores().saturating_sub(1).max(1),
            queue: 8,
            job: Duration::from_secs(12 * 3600),
            job_bytes: 2 * 1024 * 1024 * 1024,
        }
    }
}

/// Cores of this machine.
pub(crate) fn cores() -> usize {
    std::thread::available_parallelism().map_or(1, std::num::NonZero::get)
}
