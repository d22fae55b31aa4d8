//! How far a campaign is, for people: a line that moves on a terminal, plain lines in a file.

use std::io::{self, IsTerminal as _, Write as _};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::time::{Duration, Instant};

use fspid_campaign::Progress;

/// How often the line on a terminal is drawn anew.
const REDRAW: Duration = Duration::from_millis(200);
/// How often a plain line is written.
const LINE: Duration = Duration::from_secs(10);

/// How progress is told.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Telling {
    /// Not at all.
    Nothing,
    /// In one line that moves.
    Line,
    /// In plain lines, seldom.
    Lines,
}

impl Telling {
    /// What suits standard error.
    pub(super) fn for_standard_error() -> Self {
        if io::stderr().is_terminal() { Self::Line } else { Self::Lines }
    }

    fn period(self) -> Duration {
        if self == Self::Line { REDRAW } else { LINE }
    }
}

/// Works and tells how far it is on standard error.
pub(super) fn told<T>(telling: Telling, runs: u64, work: impl FnOnce(&Progress) -> T) -> T {
    let progress = Progress::default();
    if telling == Telling::Nothing {
        return work(&progress);
    }
    let start = Instant::now();
    let (done, waiting) = mpsc::channel::<()>();
    std::thread::scope(|scope| {
        let progress = &progress;
        scope.spawn(move || {
            // Until the other end is dropped.
            while waiting.recv_timeout(telling.period()) == Err(RecvTimeoutError::Timeout) {
                tell(telling, &line(progress, runs, start.elapsed()));
            }
        });
        let answer = work(progress);
        drop(done);
        answer_after(telling, &line(progress, runs, start.elapsed()));
        answer
    })
}

fn tell(telling: Telling, line: &str) {
    let mut out = io::stderr().lock();
    // A closed standard error is no reason to stop flying.
    let _ = match telling {
        Telling::Line => write!(out, "\r\x1b[K{line}"),
        _ => writeln!(out, "{line}"),
    };
    let _ = out.flush();
}

/// The last line stays.
fn answer_after(telling: Telling, line: &str) {
    tell(telling, line);
    if telling == Telling::Line {
        let _ = writeln!(io::stderr());
    }
}

fn line(progress: &Progress, runs: u64, elapsed: Duration) -> String {
    let (flown, found) = (progress.flown(), progress.found());
    let seconds = elapsed.as_secs_f64();
    let mut parts = vec![format!("{} of {} runs", grouped(flown + found), grouped(runs))];
    if flown > 0 && seconds > 0.0 {
        let rate = flown as f64 / seconds;
        parts.push(format!("{} a second", grouped(rate.round() as u64)));
        let left = runs.saturating_sub(flown + found);
        if left > 0 {
            parts.push(format!("{} left", duration(left as f64 / rate)));
        }
    }
    if found > 0 {
        parts.push(format!("{} found", grouped(found)));
    }
    let failed = progress.failed();
    parts.push(format!("{} flight{} failed", grouped(failed), if failed == 1 { "" } else { "s" }));
    parts.join(", ")
}

/// A number with its digits in groups of three.
fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let mut text = String::new();
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            text.push(' ');
        }
        text.push(digit);
    }
    text
}

fn duration(seconds: f64) -> String {
    let seconds = seconds.ceil().min(1e9) as u64;
    let (hours, minutes) = (seconds / 3600, seconds / 60 % 60);
    match (hours, minutes) {
        (0, 0) => format!("{seconds} s"),
        (0, _) => format!("{minutes} min {} s", seconds % 60),
        _ => format!("{hours} h {minutes} min"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_and_times_are_written_for_people() {
        assert_eq!([0, 999, 1000, 1_234_567].map(grouped), ["0", "999", "1 000", "1 234 567"]);
        let times = [0.2, 59.0, 61.0, 3600.0 * 25.0].map(duration);
        assert_eq!(times, ["1 s", "59 s", "1 min 1 s", "25 h 0 min"]);
    }

    #[test]
    fn work_that_is_told_gives_its_answer_and_ends() {
        assert_eq!(told(Telling::Lines, 3, |progress| progress.flown() + 7), 7);
        assert_eq!(told(Telling::Nothing, 3, |_| 8), 8);
    }
}
