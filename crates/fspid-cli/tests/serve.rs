//! The cockpit's server as a program: its address, its end, what it leaves behind.

use std::fs;
use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};

use serde_json::{Value, json};

use crate::common::{code, fspid, text};

/// A server that runs, with its address and its token.
struct Served {
    child: Child,
    address: String,
    token: String,
}

impl Served {
    fn new(arguments: &[&str], folder: &Path) -> Self {
        Self::of(
            Command::new(env!("CARGO_BIN_EXE_fspid")).args(["serve", "--port", "0"]),
            arguments,
            folder,
        )
    }

    /// Begun by a command that ends with the program and its arguments.
    fn of(command: &mut Command, arguments: &[&str], folder: &Path) -> Self {
        let mut child = command
            .args(arguments)
            .current_dir(folder)
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .expect("the program starts");
        let mut line = String::new();
        let mut out = BufReader::new(child.stdout.take().expect("a pipe"));
        out.read_line(&mut line).expect("a line");
        let (address, token) = line.trim().split_once("/#token=").expect("an address");
        let address = address.strip_prefix("http://").expect("an address").to_owned();
        Self { child, address, token: token.to_owned() }
    }

    fn sent(&self, method: &str, path: &str, body: &str) -> TcpStream {
        let mut stream = TcpStream::connect(&self.address).expect("a connection");
        let (host, token, length) = (&self.address, &self.token, body.len());
        write!(stream, "{method} {path} HTTP/1.1\r\nHost: {host}\r\nX-Fspid-Token: {token}\r\nContent-Type: application/json\r\nContent-Length: {length}\r\nConnection: close\r\n\r\n{body}").expect("asked");
        stream
    }

    fn ask(&self, method: &str, path: &str, body: &str) -> Value {
        let mut answer = String::new();
        self.sent(method, path, body).read_to_string(&mut answer).expect("answered");
        let (head, body) = answer.split_once("\r\n\r\n").expect("a head");
        assert!(head.starts_with("HTTP/1.1 20"), "{answer}");
        serde_json::from_str(body).expect("JSON")
    }

    /// The path and the digest of the only scenario.
    fn scenario(&self) -> (String, Value) {
        let list = self.ask("GET", "/api/scenarios", "");
        let path = format!("/api/scenarios/{}", list[0]["id"].as_str().expect("an id"));
        let digest = self.ask("GET", &path, "")["digest"].clone();
        (path, digest)
    }

    fn open_files(&self) -> usize {
        fs::read_dir(format!("/proc/{}/fd", self.child.id())).map_or(0, Iterator::count)
    }

    fn interrupt(mut self) -> ExitStatus {
        let id = self.child.id().to_string();
        let asked = Command::new("kill").args(["-INT", &id]).status().expect("kill");
        assert!(asked.success());
        self.child.wait().expect("it ends")
    }
}

impl Drop for Served {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    let made = fspid(&["init", "--template", "tuning", "mine.toml"], folder.path());
    assert_eq!(code(&made), 0);
    folder
}

#[test]
fn what_is_read_is_saved_by_the_program_and_ctrl_c_is_its_good_end() {
    let folder = folder();
    let served = Served::new(&["mine.toml"], folder.path());
    let (path, digest) = served.scenario();
    let words = fs::read_to_string(folder.path().join("mine.toml")).expect("a file") + "# more\n";
    let saved = served.ask("PUT", &path, &json!({ "text": words, "digest": digest }).to_string());
    // Again: what was written may be written over.
    let body = json!({ "text": words, "digest": saved["digest"] }).to_string();
    served.ask("PUT", &path, &body);
    assert_eq!(fs::read_to_string(folder.path().join("mine.toml")).expect("a file"), words);
    let id = path.rsplit_once('/').expect("an id").1;
    let job = json!({ "kind": "tune", "id": id, "options": { "budget": 10_000_000 } });
    served.ask("POST", "/api/jobs", &job.to_string());
    assert_eq!(served.interrupt().code(), Some(0));
}

/// Killed at some point of each of forty saves.
#[test]
fn a_server_that_is_killed_while_it_saves_leaves_the_old_file_or_the_new_one() {
    let folder = folder();
    let file = folder.path().join("mine.toml");
    let begin = fs::read_to_string(&file).expect("a file");
    let text = |number: usize| format!("{begin}# {number} {}\n", "x".repeat(900_000));
    fs::write(&file, text(0)).expect("written");
    let mut now = text(0);
    for number in 1..=12 {
        let mut served = Served::new(&["mine.toml"], folder.path());
        let (path, digest) = served.scenario();
        let body = json!({ "text": text(number), "digest": digest }).to_string();
        let mut stream = served.sent("PUT", &path, &body);
        // Later and later: a thousand looks at the folder are about a save.
        (0..number * 40).for_each(|_| drop(fs::metadata(&file)));
        served.child.kill().expect("killed");
        served.child.wait().expect("ended");
        let _ = stream.read_to_end(&mut Vec::new());
        let found = fs::read_to_string(&file).expect("a file");
        assert!(found == now || found == text(number), "{} bytes", found.len());
        now = found;
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_thousand_streams_that_come_and_go_leave_no_file_open() {
    let folder = folder();
    let served = Served::new(&["mine.toml", "--telemetry", "udp:0"], folder.path());
    served.ask("GET", "/api/health", "");
    let before = served.open_files();
    for _ in 0..1000 {
        let mut stream = served.sent("GET", "/api/telemetry/events", "");
        assert!(stream.read(&mut [0; 64]).expect("a head") > 0);
        drop(stream);
        while served.ask("GET", "/api/health", "")["streams"].as_u64() > Some(8) {}
    }
    while served.open_files() > before {
        std::thread::yield_now();
    }
}

/// In a network without any way out everything is as it is: the server never begins a connection.
#[cfg(target_os = "linux")]
#[test]
fn a_server_without_a_network_misses_nothing() {
    let folder = folder();
    let alone = ["--user", "--map-root-user", "--net", "--"];
    let tried = Command::new("unshare").args(alone).arg("true").status();
    if !tried.is_ok_and(|status| status.success()) {
        // This machine lets nobody have a network of his own. That no source begins a connection is a test of the crate.
        return;
    }
    let script =
        "ip link set lo up 2>/dev/null; exec \"$0\" serve mine.toml --port 0 --format json";
    let mut command = Command::new("unshare");
    command.args(alone).args(["sh", "-c", script]).arg(env!("CARGO_BIN_EXE_fspid"));
    let mut child = command
        .current_dir(folder.path())
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .expect("it starts");
    let mut out = BufReader::new(child.stdout.take().expect("a pipe"));
    let mut told = String::new();
    while serde_json::from_str::<Value>(&told).is_err() {
        assert_ne!(out.read_line(&mut told).expect("a line"), 0, "{told}");
    }
    child.kill().expect("killed");
    child.wait().expect("ended");
    assert!(told.contains("#token="), "{told}");
}

#[test]
fn a_port_that_is_taken_ends_with_code_2_and_a_sentence() {
    let folder = folder();
    let served = Served::new(&[], folder.path());
    let port = served.address.rsplit_once(':').expect("a port").1;
    let refused = fspid(&["serve", "--port", port], folder.path());
    let told = text(&refused.stderr);
    assert_eq!(code(&refused), 2, "{told}");
    assert!(
        told.contains(&format!("port {port} is taken; name another one with --port")),
        "{told}"
    );
}

#[test]
fn what_cannot_be_served_ends_with_code_2_and_says_why() {
    let folder = folder();
    for (arguments, why) in [
        (&["missing.toml"][..], "there is no such file"),
        (&["--telemetry", "tcp:1"], "allowed is udp:PORT"),
        (&["--host", "0.0.0.0"], "name one of them"),
        (&["--port", "70000"], "--port is 70000"),
        (&["--export", "page.txt"], "known are .html, .htm"),
    ] {
        let refused = fspid(&[&["serve"], arguments].concat(), folder.path());
        let told = text(&refused.stderr);
        assert!(code(&refused) == 2 && told.contains(why), "{arguments:?}: {told}");
    }
}

/// The page is there or not, as the program was built.
#[test]
fn the_page_is_written_as_one_file_or_it_is_said_how_to_have_it() {
    let folder = folder();
    let output = fspid(&["serve", "--export", "page.html"], folder.path());
    match code(&output) {
        0 => {
            let page = fs::read_to_string(folder.path().join("page.html")).expect("a file");
            assert!(page.starts_with("<!doctype html>"), "{}", page.len());
        }
        other => {
            let told = text(&output.stderr);
            assert!(other == 2 && told.contains("web/build.sh"), "{told}");
            assert!(!folder.path().join("page.html").exists());
        }
    }
}
