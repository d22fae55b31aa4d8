//! Who may ask: looked at before a request is routed, so that no route can forget it.

use std::net::{IpAddr, SocketAddr};

use axum::http::header::{CONTENT_LENGTH, CONTENT_TYPE, HOST, ORIGIN, TRANSFER_ENCODING};
use axum::http::request::Parts;
use axum::http::{HeaderName, Method, StatusCode};

use crate::answer::Refusal;
use crate::token::Token;

/// The header in which the page sends the token.
pub(crate) const TOKEN_HEADER: HeaderName = HeaderName::from_static("x-fspid-token");

/// How far a client is trusted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Trust {
    /// It may have the page.
    Anybody,
    /// It has shown the token.
    Person,
}

/// What requests are held against.
#[derive(Debug)]
pub(crate) struct Guard {
    /// Names by which this server may be called, with the port.
    hosts: Vec<String>,
    token: Token,
    body_bytes: usize,
}

impl Guard {
    pub(crate) fn new(address: SocketAddr, token: Token, body_bytes: usize) -> Self {
        Self { hosts: hosts(address), token, body_bytes }
    }

    /// How far the client is trusted, or why it gets nothing.
    pub(crate) fn check(&self, head: &Parts) -> Result<Trust, Refusal> {
        self.check_place(head)?;
        if self.too_large(head) {
            return Err(too_large(self.body_bytes));
        }
        if !is_of_api(head.uri.path()) {
            return match is_read(&head.method) {
                true => Ok(Trust::Anybody),
                false => Err(only_read()),
            };
        }
        let mut shown = head.headers.get_all(TOKEN_HEADER).iter();
        match (shown.next(), shown.next()) {
            (Some(token), None) if self.token.is(token.as_bytes()) => {}
            _ => return Err(Refusal::new(StatusCode::UNAUTHORIZED, NO_TOKEN)),
        }
        match is_read(&head.method) || is_json(head) || is_bare(head) {
            true => Ok(Trust::Person),
            false => Err(Refusal::new(StatusCode::UNSUPPORTED_MEDIA_TYPE, NOT_JSON)),
        }
    }

    /// Refuses who asks for another place, as a name that leads here does, and who asks from another page.
    fn check_place(&self, head: &Parts) -> Result<(), Refusal> {
        let mut hosts = head.headers.get_all(HOST).iter();
        let is_here = match (hosts.next(), hosts.next()) {
            (Some(host), None) => self.is_own(host.as_bytes()),
            _ => false,
        };
        // The form that proxies are asked in names the place as well.
        let named = head.uri.authority().is_none_or(|it| self.is_own(it.as_str().as_bytes()));
        if !is_here || !named {
            return Err(Refusal::new(StatusCode::FORBIDDEN, OTHER_HOST));
        }
        let is_own = |origin: &[u8]| {
            origin.strip_prefix(b"http://").is_some_and(|authority| self.is_own(authority))
        };
        match head.headers.get_all(ORIGIN).iter().all(|origin| is_own(origin.as_bytes())) {
            true => Ok(()),
            false => Err(Refusal::new(StatusCode::FORBIDDEN, OTHER_ORIGIN)),
        }
    }

    fn is_own(&self, authority: &[u8]) -> bool {
        self.hosts.iter().any(|host| host.as_bytes().eq_ignore_ascii_case(authority))
    }

    /// True for a body that says itself that it is too large; others are counted as they come.
    fn too_large(&self, head: &Parts) -> bool {
        let said = head.headers.get(CONTENT_LENGTH).and_then(|it| it.to_str().ok()?.parse().ok());
        said.is_some_and(|bytes: u64| bytes > self.body_bytes as u64)
    }
}

const NO_TOKEN: &str = "this needs the token that the address ends with which `fspid serve` printed, as the header X-Fspid-Token";
const NOT_JSON: &str = "what changes something is asked for as application/json";
const OTHER_HOST: &str =
    "this server is asked by its own address alone, which `fspid serve` printed";
const OTHER_ORIGIN: &str = "another page may not ask here";

/// A body beyond the limit.
pub(crate) fn too_large(most: usize) -> Refusal {
    Refusal::new(StatusCode::PAYLOAD_TOO_LARGE, format_args!("the most is {most} bytes"))
}

fn only_read() -> Refusal {
    Refusal::new(StatusCode::METHOD_NOT_ALLOWED, "the page can only be read")
}

/// True where something is read and nothing is changed.
fn is_read(method: &Method) -> bool {
    method == Method::GET || method == Method::HEAD
}

fn is_of_api(path: &str) -> bool {
    path == "/api" || path.starts_with("/api/")
}

fn is_json(head: &Parts) -> bool {
    let kind = head.headers.get(CONTENT_TYPE).and_then(|it| it.to_str().ok());
    let essence = kind.and_then(|it| it.split(';').next()).unwrap_or_default();
    essence.trim().eq_ignore_ascii_case("application/json")
}

/// True for a removal that carries nothing, as no form and no picture of another page can ask for.
fn is_bare(head: &Parts) -> bool {
    let carries = [CONTENT_TYPE, CONTENT_LENGTH, TRANSFER_ENCODING];
    let says = |name: &HeaderName| head.headers.get(name).is_some_and(|it| it != "0");
    head.method == Method::DELETE && !carries.iter().any(says)
}

/// Every name by which a person may call a server at this address.
fn hosts(address: SocketAddr) -> Vec<String> {
    let mut names = vec!["localhost".to_owned(), "127.0.0.1".to_owned(), "[::1]".to_owned()];
    match address.ip() {
        IpAddr::V4(ip) => names.push(ip.to_string()),
        IpAddr::V6(ip) => names.push(format!("[{ip}]")),
    }
    let port = address.port();
    let with_port = |name: &String| format!("{name}:{port}");
    let mut hosts: Vec<String> = names.iter().map(with_port).collect();
    // A browser leaves out the port that is usual.
    if port == 80 {
        hosts.extend(names);
    }
    hosts
}
