//! Who may ask: Host, Origin, token, kind of content; for every route there is.

use serde_json::json;

use crate::common::{Answer, Served};

/// Every route with an id in it, and the page's files.
fn every_route() -> Vec<(String, String)> {
    let page = [("GET", "/"), ("GET", "/app.js"), ("GET", "/nothing"), ("GET", "/api")];
    let mut all: Vec<(String, String)> = Vec::new();
    for (method, path) in fspid_serve::routes().chain(page) {
        let path = path.replace("{id}", "0123456789abcdef0123456789abcdef").replace("{run}", "3");
        all.push((method.to_owned(), path));
    }
    assert!(all.len() >= 12, "{all:?}");
    all
}

fn is_of_api(path: &str) -> bool {
    path.starts_with("/api")
}

#[test]
fn every_route_refuses_another_host_another_origin_and_no_host_before_anything_else() {
    let served = Served::new();
    let (host, token) = (served.host(), served.server.token());
    let port = served.server.address().port();
    let no_origin = String::new();
    let hosts = [
        "evil.example".to_owned(),
        format!("evil.example:{port}"),
        format!("127.0.0.1.evil.example:{port}"),
        "127.0.0.1".to_owned(),
        format!("127.0.0.1:{}", port ^ 1),
        format!("localhost.:{port}"),
        String::new(),
    ];
    let hosts = hosts.iter().map(|it| (format!("Host: {it}\r\n"), no_origin.clone()));
    let origins = ["http://evil.example", "null", "https://127.0.0.1", "", "file://"];
    let origins =
        origins.iter().map(|it| (format!("Host: {host}\r\n"), format!("Origin: {it}\r\n")));
    let secure = (format!("Host: {host}\r\n"), format!("Origin: https://{host}\r\n"));
    let twice =
        (format!("Host: {host}\r\n"), format!("Origin: http://{host}\r\nOrigin: http://a\r\n"));
    let cases: Vec<_> = hosts.chain(origins).chain([secure, twice]).collect();
    for (method, path) in every_route() {
        for (host, origin) in &cases {
            let head = format!(
                "{method} {path} HTTP/1.1\r\n{host}{origin}X-Fspid-Token: {token}\r\nContent-Type: application/json\r\nContent-Length: 2\r\nConnection: close\r\n\r\n{{}}"
            );
            let answer = served.raw(head.as_bytes());
            assert_eq!(answer.status, 403, "{method} {path} with {host}{origin}: {answer:?}");
            assert_guarded(&answer);
        }
        let none = format!("{method} {path} HTTP/1.0\r\nX-Fspid-Token: {token}\r\n\r\n");
        assert_eq!(served.raw(none.as_bytes()).status, 403, "{method} {path} without a host");
        let proxy = format!(
            "{method} http://evil.example{path} HTTP/1.1\r\nHost: {host}\r\nX-Fspid-Token: {token}\r\nConnection: close\r\n\r\n"
        );
        assert_eq!(served.raw(proxy.as_bytes()).status, 403, "{method} {path} as of a proxy");
    }
}

#[test]
fn the_servers_own_names_are_taken_and_its_own_page_may_ask() {
    let served = Served::new();
    let (port, token) = (served.server.address().port(), served.server.token());
    for host in ["127.0.0.1", "localhost", "LocalHost", "[::1]"] {
        for origin in [String::new(), format!("Origin: http://{host}:{port}\r\n")] {
            let head = format!(
                "GET /api/health HTTP/1.1\r\nHost: {host}:{port}\r\n{origin}X-Fspid-Token: {token}\r\nConnection: close\r\n\r\n"
            );
            assert_eq!(served.raw(head.as_bytes()).status, 200, "{host} {origin}");
        }
    }
}

#[test]
fn every_question_below_api_needs_the_token_and_no_other_will_do() {
    let served = Served::new();
    let (host, token) = (served.host(), served.server.token().to_owned());
    let wrong = [
        String::new(),
        "X-Fspid-Token: \r\n".to_owned(),
        format!("X-Fspid-Token: {}\r\n", &token[..31]),
        format!("X-Fspid-Token: {token}0\r\n"),
        format!("X-Fspid-Token: {}\r\n", "0".repeat(32)),
        format!("X-Fspid-Token: {token}\r\nX-Fspid-Token: {token}\r\n"),
        format!("Cookie: token={token}\r\n"),
        format!("Authorization: Bearer {token}\r\n"),
    ];
    for (method, path) in every_route() {
        for more in &wrong {
            let head = format!(
                "{method} {path} HTTP/1.1\r\nHost: {host}\r\n{more}Content-Type: application/json\r\nContent-Length: 2\r\nConnection: close\r\n\r\n{{}}"
            );
            let answer = served.raw(head.as_bytes());
            match is_of_api(&path) {
                true => assert_eq!(answer.status, 401, "{method} {path} with {more}"),
                false => assert!([200, 404].contains(&answer.status), "{path}: {answer:?}"),
            }
        }
        let in_address = format!(
            "GET {path}?token={token} HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\n\r\n"
        );
        let answer = served.raw(in_address.as_bytes());
        assert!(!is_of_api(&path) || answer.status == 401, "{path}: {answer:?}");
    }
}

#[test]
fn a_method_that_a_path_does_not_have_is_refused_with_those_that_it_has() {
    let served = Served::new();
    for (method, path) in every_route().iter().filter(|(_, path)| path.starts_with("/api/")) {
        let has = |other: &str| every_route().contains(&(other.to_owned(), path.clone()));
        for other in ["GET", "PUT", "POST", "DELETE", "PATCH"].into_iter().filter(|it| !has(it)) {
            let more = "Content-Type: application/json\r\nContent-Length: 2\r\nConnection: close\r\n\r\n{}";
            let answer = served.raw(served.head(other, path, more).as_bytes());
            assert_guarded(&answer);
            let refused = answer.json(405);
            let told = refused["error"].as_str().expect("a sentence");
            assert!(told.starts_with(other) && told.contains(method.as_str()), "{told}");
        }
    }
}

#[test]
fn what_changes_something_has_to_be_json_as_no_form_is() {
    let served = Served::new();
    let mut asked = 0;
    for (method, path) in every_route().iter().filter(|(method, _)| method != "GET") {
        for kind in ["text/plain", "application/x-www-form-urlencoded", "multipart/form-data", ""] {
            let more = format!(
                "Content-Type: {kind}\r\nContent-Length: 2\r\nConnection: close\r\n\r\n{{}}"
            );
            let answer = served.raw(served.head(method, path, &more).as_bytes());
            assert_eq!(answer.status, 415, "{method} {path} as {kind}");
            asked += 1;
        }
    }
    assert!(asked >= 12, "{asked}");
}

#[test]
fn no_get_changes_anything_and_no_other_method_is_known() {
    let served = Served::new();
    let before = std::fs::read(served.path("mine.toml")).expect("a file");
    let id = served.id("mine.toml");
    let body = json!({ "text": "changed", "digest": "0", "kind": "tune", "id": id }).to_string();
    for (_, path) in every_route() {
        let path = path.replace("0123456789abcdef0123456789abcdef", &id);
        if path.ends_with("/events") {
            continue;
        }
        let more = format!(
            "Content-Type: application/json\r\nContent-Length: {}\r\nConnection: close\r\n\r\n{body}",
            body.len()
        );
        let answer = served.raw(served.head("GET", &path, &more).as_bytes());
        assert!([200, 404, 405].contains(&answer.status), "GET {path}: {answer:?}");
    }
    assert_eq!(std::fs::read(served.path("mine.toml")).expect("a file"), before);
    assert_eq!(served.json("/api/jobs"), json!([]));
    for method in ["PATCH", "OPTIONS", "TRACE", "CONNECT", "PROPFIND"] {
        for (_, path) in every_route() {
            let more = "Content-Type: application/json\r\nConnection: close\r\n\r\n";
            let answer = served.raw(served.head(method, &path, more).as_bytes());
            assert!((400..500).contains(&answer.status), "{method} {path}: {answer:?}");
            assert!(!answer.head.contains("access-control"), "{answer:?}");
        }
    }
}

/// What every answer has to carry.
fn assert_guarded(answer: &Answer) {
    let policy = "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; style-src 'self'; connect-src 'self'; worker-src 'self'; img-src 'self' data: blob:; frame-ancestors 'none'; base-uri 'none'; form-action 'none'";
    for line in [
        format!("content-security-policy: {policy}"),
        "x-content-type-options: nosniff".to_owned(),
        "referrer-policy: no-referrer".to_owned(),
        "cache-control: no-store".to_owned(),
    ] {
        assert!(answer.head.lines().any(|it| it == line), "{line} is not in {answer:?}");
    }
}

#[test]
fn every_answer_forbids_what_is_written_into_a_page() {
    let served = Served::new();
    for (method, path) in every_route() {
        if path.ends_with("/events") {
            continue;
        }
        assert_guarded(&served.ask(&method, &path, Some(json!({}))));
    }
}

#[test]
fn the_page_needs_no_token_and_is_files_of_the_program_alone() {
    let served = Served::new();
    let plain = |path: &str| {
        let host = served.host();
        served.raw(
            format!("GET {path} HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\n\r\n").as_bytes(),
        )
    };
    let index = plain("/");
    assert!(index.status == 200 && index.body.ends_with("the page"), "{index:?}");
    assert!(index.head.contains("content-type: text/html"), "{index:?}");
    let script = plain("/app.js");
    assert!(script.head.contains("content-type: text/javascript"), "{script:?}");
    for path in ["/mine.toml", "/../mine.toml", "/index.html/..", "//app.js", "/App.js"] {
        assert_eq!(plain(path).status, 404, "{path}");
    }
}

#[test]
fn a_page_that_was_not_built_says_how() {
    let served = Served::with(|settings| settings.page = fspid_serve::Page::default());
    let answer = served.get("/");
    assert!(answer.status == 200 && answer.body.contains("web/build.sh"), "{answer:?}");
    assert!(!answer.body.contains("<script") && !answer.body.contains("style="), "{answer:?}");
    assert_eq!(served.json("/api/health")["page_built"], json!(false));
}

#[cfg(unix)]
#[test]
fn the_file_that_leads_a_browser_to_the_page_can_be_read_by_its_user_alone() {
    use std::os::unix::fs::PermissionsExt as _;
    let served = Served::new();
    let door = served.server.door().expect("a file");
    let mode = door.path().metadata().expect("it is there").permissions().mode();
    assert_eq!(mode & 0o777, 0o600);
    let text = std::fs::read_to_string(door.path()).expect("a text");
    assert!(text.contains(&served.server.url()) && !text.contains("<script"), "{text}");
}

#[test]
fn every_address_at_once_is_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut settings = crate::common::settings(folder.path());
    settings.host = "0.0.0.0".parse().expect("an address");
    let told = fspid_serve::Server::start(settings).expect_err("refused").to_string();
    assert!(told.contains("name one of them"), "{told}");
}

#[test]
fn the_token_is_behind_the_address_where_no_browser_sends_it() {
    let served = Served::new();
    let (url, token) = (served.server.url(), served.server.token().to_owned());
    assert_eq!(url, format!("http://{}/#token={token}", served.host()));
    assert!(served.server.address().ip().is_loopback());
    let other = Served::new();
    assert_ne!(other.server.token(), token);
}

/// What a program would begin a connection, or send a packet, with.
const OUTGOING: [&str; 6] =
    ["connect(", "send_to(", ".send(packet", "Client", "http_client", "reqwest"];

/// In what is compiled without tests.
#[test]
fn nothing_in_the_crate_begins_a_connection() {
    let crate_folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    let (mut folders, mut looked) = (vec![crate_folder.join("src")], 0);
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                folders.push(path);
                continue;
            }
            let text = std::fs::read_to_string(&path).expect("a text");
            let text = text.split("#[cfg(test)]\nmod tests").next().unwrap_or_default();
            let found = OUTGOING.iter().find(|word| text.contains(**word));
            assert_eq!(found, None, "{}", path.display());
            looked += 1;
        }
    }
    assert!(looked > 20, "{looked}");
    let workspace =
        std::fs::read_to_string(crate_folder.join("../../Cargo.toml")).expect("it is there");
    // How they are built for tests is said behind them.
    let (dependencies, _) = workspace.split_once("\n[profile.").expect("profiles");
    let lines =
        dependencies.lines().filter(|line| line.starts_with("hyper") || line.starts_with("axum"));
    assert!(lines.clone().count() == 3 && lines.into_iter().all(|line| !line.contains("client")));
}

/// The guide says which test holds what: each is there, and each route is in it.
#[test]
fn the_guide_names_every_route_and_no_test_that_there_is_not() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    let read = |path: &str| std::fs::read_to_string(folder.join(path)).expect("a text");
    let guide = read("../../docs/guide/cockpit.md");
    for (method, path) in fspid_serve::routes() {
        assert!(guide.contains(&format!("`{method} {path}`")), "{method} {path}");
    }
    let sources = [
        "tests/guard.rs",
        "tests/jobs.rs",
        "tests/load.rs",
        "tests/scenarios.rs",
        "tests/telemetry.rs",
        "src/app.rs",
        "src/token.rs",
        "../fspid-cli/tests/serve.rs",
    ];
    let sources: String = sources.map(read).concat();
    let words = guide.split('`').skip(1).step_by(2);
    let tests: Vec<&str> =
        words.filter(|word| word.matches('_').count() > 4 && !word.contains(' ')).collect();
    assert!(tests.len() > 20, "{}", tests.len());
    for test in tests {
        assert!(sources.contains(&format!("fn {test}()")), "{test}");
    }
}
