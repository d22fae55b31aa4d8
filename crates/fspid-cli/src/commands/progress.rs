//! How far a long work is, for people: a line that moves on a terminal, plain lines in a file.

use std::io::{self, IsTerminal as _, Write as _};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::thread;
use std::time::{Duration, Instant};

use crate::stream::Stream;

/// How often the line on a terminal is drawn anew.
const REDRAW: Duration = Duration::from_millis(200);
/// How often a plain line is written.
const LINE: Duration = Duration::from_secs(10);

/// How progress is told.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Telling {
    /// Not at all.
    Nothing,
    /// In one line that moves.
    Line,
    /// In plain lines, seldom.
    Lines,
}

impl Telling {
    /// What suits standard error.
    pub(crate) fn for_standard_error() -> Self {
        if io::stderr().is_terminal() { Self::Line } else { Self::Lines }
    }

    /// How often it is told.
    pub(crate) fn period(self) -> Duration {
        if self == Self::Line { REDRAW } else { LINE }
    }
}

/// Tells a line; on a terminal it takes the place of the one before.
pub(crate) fn tell(telling: Telling, line: &str) {
    if Stream::Error.is_input() {
        return;
    }
    let mut out = io::stderr().lock();
    // A closed standard error is no reason to stop flying.
    let _ = match telling {
        Telling::Line => write!(out, "\r\x1b[K{line}"),
        _ => writeln!(out, "{line}"),
    };
    let _ = out.flush();
}

/// The last line stays.
pub(crate) fn answer_after(telling: Telling, line: &str) {
    tell(telling, line);
    if telling == Telling::Line {
        let _ = writeln!(io::stderr());
    }
}

/// Works, and tells every now and then that it still does, and for how long.
pub(crate) fn alive<T>(
    telling: Telling,
    what: &(dyn Fn() -> String + Sync),
    work: impl FnOnce() -> T,
) -> T {
    let (working, ended) = mpsc::channel::<()>();
    thread::scope(|scope| {
        // Gone with this closure, even where the work panics.
        let working = working;
        scope.spawn(move || {
            let begun = Instant::now();
            while ended.recv_timeout(telling.period()) == Err(RecvTimeoutError::Timeout) {
                tell(telling, &format!("{}, {}", what(), duration(begun.elapsed().as_secs_f64())));
            }
        });
        let answer = work();
        drop(working);
        answer
    })
}

/// Works, and tells on standard error that it still does once that takes a while.
pub(crate) fn at_work<T>(what: &str, work: impl FnOnce() -> T) -> T {
    let telling = Telling::for_standard_error();
    let answer = alive(telling, &|| what.to_owned(), work);
    // The answer begins on an empty line.
    if telling == Telling::Line {
        tell(telling, "");
    }
    answer
}

/// A time in words.
pub(crate) fn duration(seconds: f64) -> String {
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
    fn times_are_written_for_people() {
        let times = [0.2, 59.0, 61.0, 3600.0 * 25.0].map(duration);
        assert_eq!(times, ["1 s", "59 s", "1 min 1 s", "25 h 0 min"]);
    }
}
