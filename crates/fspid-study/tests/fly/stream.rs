//! Who flies, and how a conversation ends.

use std::io;

use fspid_study::fly::{Angles, ChoiceError, Pilot, StreamError, fly};

use super::{pilot, study};

#[test]
fn a_line_without_end_is_one_bad_line_and_takes_no_memory() {
    let endless = io::Read::take(io::repeat(b'1'), 50_000_000);
    let input = io::Read::chain(endless, &b"\n5 0 0.01\n"[..]);
    let (mut pilot, mut output) = (pilot("PID", Angles::Degrees), Vec::new());
    let mut told = Vec::new();
    fly(&mut pilot, &mut io::BufReader::new(input), &mut output, |note| told.push(note.to_owned()))
        .expect("answered");
    assert_eq!(told, ["line 1: longer than 4096 bytes; the command was held"]);
    assert_eq!(String::from_utf8_lossy(&output).lines().count(), 2);
}

#[test]
fn without_a_name_only_an_only_controller_flies() {
    let scenario = study().scenario;
    let known = ["P", "PID", "FSPID"].map(str::to_owned).to_vec();
    let choice = |name| Pilot::new(&scenario, name, Angles::Degrees).map(|_| ());
    assert_eq!(choice(None), Err(ChoiceError::Several { known: known.clone() }));
    let name = "pid".to_owned();
    assert_eq!(choice(Some("pid")), Err(ChoiceError::Unknown { name, known }));
    assert_eq!(choice(Some("P")), Ok(()));
    let mut alone = scenario.clone();
    alone.controllers.truncate(1);
    assert!(Pilot::new(&alone, None, Angles::Degrees).is_ok());
}

/// A writer whose reader went away after a few lines.
struct GoneAfter(usize);

impl io::Write for GoneAfter {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0 = self.0.checked_sub(1).ok_or(io::ErrorKind::BrokenPipe)?;
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

#[test]
fn a_reader_that_has_gone_away_ends_the_flight() {
    let mut pilot = pilot("PID", Angles::Degrees);
    let lines = b"5 0 0.01\n".repeat(9);
    let done = fly(&mut pilot, &mut lines.as_slice(), &mut GoneAfter(3), |_| ());
    let StreamError::Writing(error) = done.expect_err("it ended") else { panic!("not by reading") };
    assert_eq!(error.kind(), io::ErrorKind::BrokenPipe);
    assert_eq!(pilot.summary().commands, 4);
}
