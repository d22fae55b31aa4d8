//! A server with a folder, and clients that speak HTTP by hand: what no browser would send is what is tested.

use std::fs;
use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::net::TcpStream;
use std::path::{Path, PathBuf};
use std::time::Duration;

use fspid_serve::{Limits, Opened, Page, Server, Settings};
use serde_json::Value;
use tempfile::TempDir;

/// A scenario with everything that jobs ask for: marks, dispersions, a contest.
pub(crate) const SCENARIO: &str = include_str!("../data/all.toml");

/// Stands for the files of the page.
const FILES: [(&str, &[u8]); 2] = [("index.html", b"<!doctype html>the page"), ("app.js", b"1;")];

/// A server on a folder with one scenario, `mine.toml`.
pub(crate) struct Served {
    pub(crate) server: Server,
    folder: TempDir,
}

/// Limits that no test comes upon by chance: whoever waits, waits for a state.
pub(crate) fn patient() -> Limits {
    let hour = Duration::from_secs(3600);
    Limits { head: hour, body: hour, silence: hour, jobs: 1, ..Limits::default() }
}

/// The settings of tests for a folder.
pub(crate) fn settings(folder: &Path) -> Settings {
    let page = Page::of(&FILES, None);
    Settings { page, limits: patient(), ..Settings::new(Opened::Folder(folder.to_owned())) }
}

impl Served {
    pub(crate) fn new() -> Self {
        Self::with(|_| {})
    }

    /// With other settings.
    pub(crate) fn with(change: impl FnOnce(&mut Settings)) -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        fs::write(folder.path().join("mine.toml"), SCENARIO).expect("written");
        let mut settings = settings(folder.path());
        change(&mut settings);
        Self { server: Server::start(settings).expect("it begins"), folder }
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub(crate) fn host(&self) -> String {
        self.server.address().to_string()
    }

    pub(crate) fn connect(&self) -> TcpStream {
        TcpStream::connect(self.server.address()).expect("a connection")
    }

    /// Sends bytes and reads until the server closes.
    pub(crate) fn raw(&self, bytes: &[u8]) -> Answer {
        let mut stream = self.connect();
        // A server that refuses early may close before all is written.
        let _ = stream.write_all(bytes);
        Answer::read(stream)
    }

    /// The head of a request with the right host and token.
    pub(crate) fn head(&self, method: &str, path: &str, more: &str) -> String {
        let (host, token) = (self.host(), self.server.token());
        format!("{method} {path} HTTP/1.1\r\nHost: {host}\r\nX-Fspid-Token: {token}\r\n{more}")
    }

    /// A request as the page sends it.
    pub(crate) fn ask(&self, method: &str, path: &str, body: Option<Value>) -> Answer {
        let body = body.map_or(String::new(), |body| body.to_string());
        let more = match method {
            "GET" => String::new(),
            _ => format!("Content-Type: application/json\r\nContent-Length: {}\r\n", body.len()),
        };
        let head = self.head(method, path, &more);
        self.raw(format!("{head}Connection: close\r\n\r\n{body}").as_bytes())
    }

    pub(crate) fn get(&self, path: &str) -> Answer {
        self.ask("GET", path, None)
    }

    /// The answer in JSON to what is well.
    pub(crate) fn json(&self, path: &str) -> Value {
        self.get(path).json(200)
    }

    /// Id of a scenario by its name.
    pub(crate) fn id(&self, name: &str) -> String {
        let list = self.json("/api/scenarios");
        let rows = list.as_array().expect("a list");
        let row = rows.iter().find(|row| row["name"] == name);
        let row = row.unwrap_or_else(|| panic!("no {name} in {list}"));
        row["id"].as_str().expect("a text").to_owned()
    }

    /// Begins a job on `mine.toml`; its id.
    pub(crate) fn begin(&self, kind: &str, options: Value) -> String {
        let id = self.id("mine.toml");
        let asked = serde_json::json!({ "kind": kind, "id": id, "options": options });
        let answer = self.ask("POST", "/api/jobs", Some(asked)).json(202);
        answer["job"].as_str().expect("a text").to_owned()
    }

    /// The events of a job from one on.
    pub(crate) fn events(&self, job: &str, last: Option<u64>) -> Events {
        let last = last.map_or(String::new(), |last| format!("Last-Event-ID: {last}\r\n"));
        self.stream(&format!("/api/jobs/{job}/events"), &last)
    }

    /// A stream.
    pub(crate) fn stream(&self, path: &str, more: &str) -> Events {
        let mut stream = self.connect();
        write!(stream, "{}\r\n", self.head("GET", path, more)).expect("asked");
        let mut lines = BufReader::new(stream);
        let mut head = String::new();
        while !head.ends_with("\r\n\r\n") {
            assert_ne!(lines.read_line(&mut head).expect("a head"), 0, "{head}");
        }
        assert!(head.starts_with("HTTP/1.1 200"), "{head}");
        Events { lines, rest: String::new() }
    }

    /// Every event of a job until its end.
    pub(crate) fn followed(&self, job: &str) -> Vec<(u64, String, Value)> {
        self.events(job, None).collect()
    }

    /// Waits until the health page shows something.
    pub(crate) fn until(&self, is: impl Fn(&Value) -> bool) {
        while !is(&self.json("/api/health")) {
            std::thread::yield_now();
        }
    }
}

/// An answer that was read to its end.
#[derive(Debug)]
pub(crate) struct Answer {
    pub(crate) status: u16,
    pub(crate) head: String,
    pub(crate) body: String,
}

impl Answer {
    pub(crate) fn read(mut stream: TcpStream) -> Self {
        let mut bytes = Vec::new();
        // A connection that is reset has said what it had to say.
        let _ = stream.read_to_end(&mut bytes);
        let text = String::from_utf8_lossy(&bytes).into_owned();
        let (head, body) = text.split_once("\r\n\r\n").unwrap_or((text.as_str(), ""));
        let status = head.split(' ').nth(1).and_then(|word| word.parse().ok()).unwrap_or(0);
        Self { status, head: head.to_ascii_lowercase(), body: body.to_owned() }
    }

    pub(crate) fn json(&self, status: u16) -> Value {
        assert_eq!(self.status, status, "{self:?}");
        serde_json::from_str(&self.body).unwrap_or_else(|_| panic!("no JSON: {self:?}"))
    }

    /// A sentence of a refusal.
    pub(crate) fn error(&self, status: u16) -> String {
        self.json(status)["error"].as_str().expect("a sentence").to_owned()
    }
}

/// Events of a stream, read as they come.
pub(crate) struct Events {
    lines: BufReader<TcpStream>,
    rest: String,
}

impl Events {
    /// The next line of the stream; chunks are taken apart.
    fn line(&mut self) -> Option<String> {
        loop {
            if let Some((line, rest)) = self.rest.split_once('\n') {
                let (line, rest) = (line.to_owned(), rest.to_owned());
                self.rest = rest;
                return Some(line);
            }
            let mut size = String::new();
            self.lines.read_line(&mut size).ok()?;
            let size = usize::from_str_radix(size.trim(), 16).ok().filter(|size| *size > 0)?;
            let mut chunk = vec![0; size + 2];
            self.lines.read_exact(&mut chunk).ok()?;
            self.rest.push_str(std::str::from_utf8(&chunk[..size]).expect("UTF-8"));
        }
    }
}

impl Iterator for Events {
    type Item = (u64, String, Value);

    /// Number, name and data; one without a number has 0.
    fn next(&mut self) -> Option<Self::Item> {
        let (mut id, mut name, mut data) = (0, String::new(), Value::Null);
        loop {
            let line = self.line()?;
            match line.split_once(": ") {
                Some(("id", text)) => id = text.parse().expect("a number"),
                Some(("event", text)) => text.clone_into(&mut name),
                Some(("data", text)) => data = serde_json::from_str(text).expect("JSON"),
                _ if line.is_empty() && !name.is_empty() => return Some((id, name, data)),
                _ => {}
            }
        }
    }
}
