//! A controller at the other end of two pipes: nothing waits for anything but an answer.

use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, Command, Output, Stdio};
use std::sync::mpsc::{Receiver, channel};

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    let made =
        command(&["init", "pitch.toml"], folder.path()).output().expect("the program starts");
    assert!(made.status.success());
    folder
}

fn command(arguments: &[&str], folder: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_fspid"));
    command.args(arguments).current_dir(folder);
    command
}

/// `fspid fly` with pipes at all three ends.
fn flying(arguments: &[&str], folder: &Path) -> Child {
    let arguments = [&["fly", "pitch.toml"], arguments].concat();
    command(&arguments, folder)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts")
}

/// The answers to a whole input.
fn answered(arguments: &[&str], input: &str, folder: &Path) -> Output {
    let mut child = flying(arguments, folder);
    child.stdin.take().expect("a pipe").write_all(input.as_bytes()).expect("taken");
    child.wait_with_output().expect("it ends")
}

fn text(bytes: &[u8]) -> &str {
    std::str::from_utf8(bytes).expect("UTF-8")
}

/// A client that writes a line and waits for one.
struct Client {
    child: Child,
    requests: ChildStdin,
    answers: Receiver<String>,
}

impl Client {
    fn new(arguments: &[&str], folder: &Path) -> Self {
        let mut child = flying(arguments, folder);
        let requests = child.stdin.take().expect("a pipe");
        let output = BufReader::new(child.stdout.take().expect("a pipe"));
        let (sender, answers) = channel();
        std::thread::spawn(move || {
            for line in output.lines().map_while(Result::ok) {
                let _ = sender.send(line);
            }
        });
        Self { child, requests, answers }
    }

    /// Waits however long it takes: a program that kept its answers back would never come to the
    /// end of this test, and a slow machine does.
    fn ask(&mut self, line: &str) -> String {
        self.requests.write_all(format!("{line}\n").as_bytes()).expect("taken");
        self.answers.recv().expect("an answer before the next question")
    }

    fn ask_number(&mut self, line: &str) -> f64 {
        self.ask(line).parse().expect("a number")
    }

    fn end(self) -> Output {
        drop(self.requests);
        self.child.wait_with_output().expect("it ends")
    }
}

#[test]
fn each_line_is_answered_before_the_next_is_asked() {
    let folder = folder();
    let mut client = Client::new(&["--controller", "PID"], folder.path());
    for k in 0..500 {
        client.ask_number(&format!("5 {} 0.01", f64::from(k) * 0.01));
    }
    assert_eq!(client.ask("# a comment has no answer\n\nreset"), "ok");
    client.ask_number("5 0 0.01");
    let end = client.end();
    assert_eq!((end.status.code(), text(&end.stderr)), (Some(0), ""));
}

/// Pitch acceleration from elevator, angle of attack and pitch rate; fspid knows nothing of it.
#[test]
fn a_simulator_of_ones_own_is_flown_to_the_set_point() {
    let folder = folder();
    for name in ["PID", "FSPID"] {
        let mut client = Client::new(&["--controller", name], folder.path());
        let (mut pitch, mut rate, mut attack) = (0.0, 0.0, 0.0);
        for _ in 0..2000 {
            let elevator = client.ask_number(&format!("5 {pitch:?} 0.01 {rate:?}"));
            let acceleration = 3.0 * elevator - 2.0 * attack - 1.2 * rate;
            attack += 0.01 * (rate - 0.8 * attack);
            rate += 0.01 * acceleration;
            pitch += 0.01 * rate;
        }
        assert!((pitch - 5.0_f64).abs() < 0.1, "{name}: {pitch}");
        assert_eq!(text(&client.end().stderr), "");
    }
}

/// The trace has degrees, and these have lost up to the last place of the radians; in radians it is
/// bit for bit, see the tests of `fspid-study`.
#[test]
fn the_trace_of_a_simulation_gets_its_own_commands() {
    let folder = folder();
    let simulated = command(&["simulate", "pitch.toml", "--trace", "t.csv"], folder.path());
    let _ = { simulated }.output().expect("the program starts");
    let trace = std::fs::read_to_string(folder.path().join("t.csv")).expect("written");
    let mut lines = trace.lines();
    let heading: Vec<&str> = lines.next().expect("a heading").split(',').collect();
    let column = |name: &str| heading.iter().position(|word| *word == name).expect(name);
    for name in ["PID", "FSPID"] {
        let [theta, q, command] =
            ["theta_deg", "q_deg_s", "command_deg"].map(|word| column(&format!("{name}.{word}")));
        let mut input = String::new();
        let mut recorded = Vec::new();
        for cells in lines.clone().map(|line| line.split(',').collect::<Vec<_>>()) {
            input += &format!("{},{},0.01,{}\n", cells[1], cells[theta], cells[q]);
            recorded.push(cells[command].parse::<f64>().expect("a number"));
        }
        let output = answered(&["--controller", name], &input, folder.path());
        let commands: Vec<f64> =
            text(&output.stdout).lines().map(|line| line.parse().expect("a number")).collect();
        assert_eq!(commands.len(), 1001);
        assert!(commands.iter().zip(&recorded).all(|(a, b)| (a - b).abs() < 1e-12), "{name}");
    }
}

/// A pipe holds some 64 KiB; told in full this would be megabytes, and the commands would stop.
#[test]
fn a_client_that_never_reads_what_is_told_still_gets_its_commands() {
    let folder = folder();
    let mut client = Client::new(&["--controller", "PID"], folder.path());
    for _ in 0..20_000 {
        assert_eq!(client.ask("nonsense"), "0.0");
    }
    let end = client.end();
    assert_eq!(end.status.code(), Some(0));
    assert!(end.stderr.len() < 4096);
    let told = text(&end.stderr);
    assert!(told.starts_with("line 1: `nonsense` is not a number; the command was held"), "{told}");
    let summary = "commands 20000, slips 0, held 20000, other faults 0, resets 0\n";
    assert!(told.ends_with(summary), "{told}");
}

#[test]
fn strictly_a_slip_ends_with_one() {
    let folder = folder();
    let code = |arguments: &[&str], input| answered(arguments, input, folder.path()).status.code();
    let slip = "5 0 0.01\n5 0 0.02\n";
    assert_eq!(code(&["--controller", "PID"], slip), Some(0));
    assert_eq!(code(&["--controller", "PID", "--strict"], slip), Some(1));
    assert_eq!(code(&["--controller", "PID", "--strict"], "5 0 0.01\n5 0 0.01\n"), Some(0));
}

#[test]
fn the_last_line_needs_no_end_and_an_empty_input_is_an_end() {
    let folder = folder();
    let output = answered(&["--controller", "PID"], "0 0 0.01", folder.path());
    assert_eq!((output.status.code(), text(&output.stdout)), (Some(0), "0.0\n"));
    let output = answered(&["--controller", "PID"], "", folder.path());
    assert_eq!((output.status.code(), output.stdout.len(), output.stderr.len()), (Some(0), 0, 0));
}

#[test]
fn a_setting_of_the_file_can_be_changed_and_radians_are_taken() {
    let folder = folder();
    let change = ["--controller", "PID", "--set", "controller.PID.kp=2", "--angles", "radians"];
    let unchanged = ["--set", "controller.PID.ki=0", "--set", "controller.PID.kd=0"];
    let output = answered(&[&change[..], &unchanged].concat(), "0.1 0 0.01", folder.path());
    assert_eq!(text(&output.stdout), "0.2\n");
}

#[test]
fn no_controller_is_guessed() {
    let folder = folder();
    let told = |arguments: &[&str]| {
        let output = command(arguments, folder.path()).stdin(Stdio::null()).output();
        let output = output.expect("the program starts");
        assert_eq!((output.status.code(), output.stdout.len()), (Some(2), 0));
        text(&output.stderr).to_owned()
    };
    let several = told(&["fly", "pitch.toml"]);
    assert!(several.contains("several controllers; choose one with --controller: PID, FSPID"));
    let unknown = told(&["fly", "pitch.toml", "--controller", "FSIPD"]);
    assert!(unknown.contains("no controller `FSIPD`; did you mean `FSPID`? Known are PID, FSPID"));
    assert!(told(&["fly", "nowhere.toml"]).contains("nowhere.toml: cannot be read"));
}

#[test]
fn a_simulator_that_has_gone_away_is_a_normal_end() {
    let folder = folder();
    let mut child = flying(&["--controller", "PID"], folder.path());
    let mut requests = child.stdin.take().expect("a pipe");
    drop(child.stdout.take());
    for _ in 0..50_000 {
        if requests.write_all(b"5 0 0.01\n").is_err() {
            break;
        }
    }
    drop(requests);
    let output = child.wait_with_output().expect("it ends");
    assert_eq!((output.status.code(), text(&output.stderr)), (Some(0), ""));
}

#[cfg(target_os = "linux")]
#[test]
fn answers_that_cannot_be_written_end_with_four() {
    let folder = folder();
    let full = std::fs::OpenOptions::new().write(true).open("/dev/full").expect("a full device");
    let mut child = command(&["fly", "pitch.toml", "--controller", "PID"], folder.path())
        .stdin(Stdio::piped())
        .stdout(full)
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts");
    child.stdin.take().expect("a pipe").write_all(b"5 0 0.01\n").expect("taken");
    let output = child.wait_with_output().expect("it ends");
    assert_eq!(output.status.code(), Some(4));
}
