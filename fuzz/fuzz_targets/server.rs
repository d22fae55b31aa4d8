//! Arbitrary bytes as what a client sends to the server of the cockpit: answered, with the policy, without a panic; nothing
//! below `/api` is told or done without the token.

use std::path::PathBuf;
use std::sync::{Arc, Mutex, OnceLock};
use std::time::Duration;

use fspid_serve::offline::Offline;
use tokio::runtime::{Builder, Runtime};

/// The token, and what stands in the scenario of the folder: seeds know both, and answers may tell what they hold.
const TOKEN: &str = "0123456789abcdef0123456789abcdef";
const TEXT: &str = "schema = 1\nname = \"KEPT-TO-ITSELF\"\n[[controller]]\nname = \"PID\"\n";

/// Longer than every deadline of the server, and shorter than a stream: time goes on by itself where nobody works.
const PATIENCE: Duration = Duration::from_secs(120);

/// A folder with one scenario that stays as long as the program runs.
fn folder() -> &'static PathBuf {
    static FOLDER: OnceLock<PathBuf> = OnceLock::new();
    FOLDER.get_or_init(|| {
        let folder = std::env::temp_dir().join(format!("fspid-fuzz-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder");
        folder
    })
}

/// What a client gets that sends these bytes.
fn answered(server: &Offline, bytes: &[u8]) -> Vec<u8> {
    thread_local! {
        static RUNTIME: Runtime =
            Builder::new_current_thread().enable_all().start_paused(true).build().expect("a runtime");
    }
    let written = Arc::new(Mutex::new(Vec::new()));
    RUNTIME.with(|runtime| {
        // It ends at its deadlines; only a stream does not.
        let answer = server.answer(bytes.to_vec(), &written);
        let _ = runtime.block_on(async { tokio::time::timeout(PATIENCE, answer).await });
    });
    written.lock().expect("nobody panicked").clone()
}

pub(crate) fn read(bytes: &[u8]) -> Option<()> {
    let file = folder().join("mine.toml");
    if std::fs::read_to_string(&file).ok().as_deref() != Some(TEXT) {
        std::fs::write(&file, TEXT).expect("written");
    }
    let server = Offline::new(folder(), TOKEN).expect("a server");
    let answers = answered(&server, bytes);
    let text = String::from_utf8_lossy(&answers);
    let heads: Vec<&str> = text.split("HTTP/1.").skip(1).collect();
    heads.iter().for_each(|answer| check(answer));
    let has_token = bytes.windows(TOKEN.len()).any(|part| part == TOKEN.as_bytes());
    let says_put = bytes.windows(3).any(|part| part == b"PUT");
    let entries = std::fs::read_dir(folder()).expect("a folder").count();
    assert_eq!(entries, 1, "a file more, or none");
    if !has_token {
        assert!(!text.contains("KEPT-TO-ITSELF") && !text.contains("mine.toml"), "{text}");
        assert!(heads.iter().all(|answer| !(is_json(answer) && is_well(answer))), "{text}");
    }
    if !has_token || !says_put {
        assert_eq!(std::fs::read_to_string(&file).expect("a file"), TEXT);
    }
    // A seed that is refused at the door shows nothing of what stands behind it.
    heads.iter().any(|answer| is_well(answer)).then_some(())
}

/// An answer, from its version on: one that the server itself has made carries the policy; hyper refuses what is no request
/// by itself, without a body.
fn check(answer: &str) {
    let status = answer.get(2..5).unwrap_or_default();
    assert!(status != "500", "{answer}");
    let head = answer.split("\r\n\r\n").next().unwrap_or_default().to_ascii_lowercase();
    let is_guarded =
        ["content-security-policy: default-src 'none';", "x-content-type-options: nosniff"]
            .iter()
            .all(|line| head.contains(line));
    let is_bare = head.contains("content-length: 0") && ["400", "414", "431"].contains(&status);
    // That a body may come now; it is no answer yet.
    assert!(is_guarded || is_bare || status == "100", "{answer}");
}

fn is_well(answer: &str) -> bool {
    answer.get(2..3) == Some("2")
}

fn is_json(answer: &str) -> bool {
    let head = answer.split("\r\n\r\n").next().unwrap_or_default();
    ["application/json", "text/event-stream"].iter().any(|kind| head.contains(kind))
}
