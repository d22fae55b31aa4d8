//! Slow clients, large requests, many connections, streams that come and go.

use std::io::{Read as _, Write as _};
use std::net::TcpStream;
use std::time::Duration;

use serde_json::json;

use crate::common::{Answer, Served};

/// Reads until the server closes; how much came.
fn until_closed(mut stream: TcpStream) -> usize {
    let mut bytes = Vec::new();
    // A reset is an end as well.
    let _ = stream.read_to_end(&mut bytes);
    bytes.len()
}

#[test]
fn who_takes_too_long_for_the_head_of_a_request_is_closed() {
    let served = Served::with(|settings| settings.limits.head = Duration::from_millis(50));
    for sent in ["", "GET / HT", "GET /api/health HTTP/1.1\r\nHost: x\r\nX-Long: ", "\r\n\r\n"] {
        let mut stream = served.connect();
        stream.write_all(sent.as_bytes()).expect("sent");
        until_closed(stream);
    }
    // One that is silent after an answer, too.
    let mut stream = served.connect();
    stream.write_all(served.head("GET", "/api/health", "\r\n").as_bytes()).expect("sent");
    assert!(until_closed(stream) > 100);
}

#[test]
fn who_takes_too_long_for_a_body_is_told_so() {
    let served = Served::with(|settings| settings.limits.body = Duration::from_millis(50));
    let head = served.head(
        "POST",
        "/api/jobs",
        "Content-Type: application/json\r\nContent-Length: 100\r\n\r\n{\"kind\":",
    );
    let mut stream = served.connect();
    stream.write_all(head.as_bytes()).expect("sent");
    assert_eq!(Answer::read(stream).status, 408);
}

#[test]
fn the_deadlines_and_limits_that_nobody_changes_are_those_that_are_promised() {
    let limits = fspid_serve::Limits::default();
    assert_eq!((limits.head, limits.body), (Duration::from_secs(5), Duration::from_secs(30)));
    assert_eq!((limits.body_bytes, limits.connections, limits.streams), (1 << 20, 64, 16));
    assert_eq!((limits.job, limits.job_bytes), (Duration::from_secs(12 * 3600), 2 << 30));
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    assert_eq!((limits.jobs, limits.queue), (cores.saturating_sub(1).max(1), 8));
}

#[test]
fn a_body_beyond_one_mebibyte_is_refused_whether_it_says_so_or_not() {
    let served = Served::new();
    let path = format!("/api/scenarios/{}", served.id("mine.toml"));
    let kind = "Content-Type: application/json\r\nConnection: close\r\n";
    let said = served.head("PUT", &path, &format!("{kind}Content-Length: 1048577\r\n\r\n"));
    assert_eq!(served.raw(said.as_bytes()).status, 413);
    let huge = served.head("PUT", &path, &format!("{kind}Content-Length: 99999999999999\r\n\r\n"));
    assert_eq!(served.raw(huge.as_bytes()).status, 413);
    let mut chunked =
        served.head("PUT", &path, &format!("{kind}Transfer-Encoding: chunked\r\n\r\n"));
    for _ in 0..17 {
        chunked.push_str(&format!("10000\r\n{}\r\n", "x".repeat(0x10000)));
    }
    chunked.push_str("0\r\n\r\n");
    assert_eq!(served.raw(chunked.as_bytes()).status, 413);
    let text = " ".repeat(1_000_000);
    let digest = served.json(&path)["digest"].clone();
    let just = served.ask("PUT", &path, Some(json!({ "text": text, "digest": digest })));
    assert_eq!(just.status, 200, "{}", just.head);
}

#[test]
fn a_head_that_is_too_long_is_refused() {
    let served = Served::new();
    let long = format!("GET /{} HTTP/1.1\r\nHost: {}\r\n\r\n", "a".repeat(100_000), served.host());
    assert!((400..500).contains(&served.raw(long.as_bytes()).status));
    let many: String = (0..200).map(|k| format!("X-{k}: 1\r\n")).collect();
    let head = served.head("GET", "/api/health", &format!("{many}\r\n"));
    assert!((400..500).contains(&served.raw(head.as_bytes()).status));
}

#[test]
fn with_five_hundred_slow_clients_a_person_is_answered() {
    let served = Served::new();
    let mut slow = Vec::new();
    for k in 0..500 {
        let mut stream = served.connect();
        let begun = ["", "GET / HTTP/1.1\r\nHost: ", "POST /api/jobs HTTP/1.1\r\nX: y\r\n"][k % 3];
        // One that had to go for another is closed already.
        let _ = stream.write_all(begun.as_bytes());
        slow.push(stream);
    }
    let health = served.json("/api/health");
    let connections = health["connections"].as_u64().expect("a count");
    assert!(connections <= 64, "{health}");
    drop(slow);
    // The one that asks.
    served.until(|health| health["connections"] == json!(1));
}

/// While the server was at a large body, many came; all places then went to the last of them, and the first, whose question lay
/// there unread, was closed without an answer.
#[test]
fn whoever_has_asked_is_answered_however_many_come_behind() {
    let served = Served::new();
    let body = format!("[{}0]", "0,".repeat(500_000));
    let more = format!(
        "Content-Type: application/json\r\nContent-Length: {}\r\nConnection: close\r\n\r\n{body}",
        body.len()
    );
    let large = served.head("POST", "/api/jobs", &more);
    for _ in 0..10 {
        let mut busy = served.connect();
        busy.write_all(large.as_bytes()).expect("sent");
        let mut person = served.connect();
        let asked = served.head("GET", "/api/health", "Connection: close\r\n\r\n");
        person.write_all(asked.as_bytes()).expect("sent");
        let behind: Vec<TcpStream> = (0..90).map(|_| served.connect()).collect();
        assert_eq!(Answer::read(person).status, 200);
        drop(behind);
        assert_eq!(Answer::read(busy).status, 400);
    }
}

#[test]
fn clients_that_read_nothing_keep_nobody_away() {
    let page = vec![b'x'; 4 << 20];
    let served = Served::with(|settings| {
        settings.page = fspid_serve::Page::of(&[("index.html", &page)], None);
    });
    let host = served.host();
    let deaf: Vec<TcpStream> = (0..100)
        .map(|_| {
            let mut stream = served.connect();
            let _ = write!(stream, "GET / HTTP/1.1\r\nHost: {host}\r\n\r\n");
            stream
        })
        .collect();
    assert!(served.json("/api/health")["connections"].as_u64().is_some_and(|it| it <= 64));
    drop(deaf);
}

#[test]
fn there_are_so_many_streams_and_one_more_is_refused_until_one_is_left() {
    let served = Served::with(|settings| settings.telemetry_port = Some(0));
    let mut streams: Vec<_> = (0..16).map(|_| served.stream("/api/telemetry/events", "")).collect();
    let told = served.get("/api/telemetry/events").error(429);
    assert!(told.contains("16 streams"), "{told}");
    streams.pop();
    served.until(|health| health["streams"] == json!(15));
    streams.push(served.stream("/api/telemetry/events", ""));
    drop(streams);
    served.until(|health| health["streams"] == json!(0) && health["connections"] == json!(1));
}

#[test]
fn a_thousand_streams_that_come_and_go_leave_no_connection_and_no_stream() {
    let served = Served::with(|settings| settings.telemetry_port = Some(0));
    for _ in 0..1000 {
        let mut stream = served.stream("/api/telemetry/events", "");
        assert_eq!(stream.next().expect("the first").1, "begun");
        drop(stream);
        served.until(|health| health["streams"].as_u64().is_some_and(|open| open < 16));
    }
    served.until(|health| health["streams"] == json!(0) && health["connections"] == json!(1));
}

#[test]
fn many_at_once_are_all_answered() {
    let served = Served::new();
    std::thread::scope(|scope| {
        for _ in 0..8 {
            scope.spawn(|| (0..50).for_each(|_| assert_eq!(served.get("/api/health").status, 200)));
        }
    });
    assert_eq!(served.json("/api/health")["panics"], json!(0));
}
