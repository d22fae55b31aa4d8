//! The program, run in a folder.

pub(crate) mod answers;

use std::path::Path;
use std::process::{Child, Command, Output, Stdio};

use serde_json::Value;

pub(crate) fn fspid(arguments: &[&str], folder: &Path) -> Output {
    with_input(arguments, folder, "")
}

pub(crate) fn with_input(arguments: &[&str], folder: &Path, input: &str) -> Output {
    use std::io::Write as _;
    let mut child = started(arguments, folder);
    let mut stdin = child.stdin.take().expect("standard input");
    // A program that reads nothing closes its end.
    let _ = stdin.write_all(input.as_bytes());
    drop(stdin);
    let output = child.wait_with_output().expect("it ends");
    answers::hold(arguments, &output);
    output
}

/// The program, running, with pipes to all its ends.
pub(crate) fn started(arguments: &[&str], folder: &Path) -> Child {
    Command::new(env!("CARGO_BIN_EXE_fspid"))
        .args(arguments)
        .current_dir(folder)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts")
}

pub(crate) fn code(output: &Output) -> i32 {
    output.status.code().expect("an exit code")
}

pub(crate) fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).expect("UTF-8")
}

pub(crate) fn json(output: &Output) -> Value {
    let out = text(&output.stdout);
    serde_json::from_str(&out).unwrap_or_else(|error| {
        panic!("{error}: {out}\n{}", text(&output.stderr));
    })
}
