//! How far a campaign is, for people.

use std::sync::mpsc::{self, RecvTimeoutError};
use std::time::{Duration, Instant};

use fspid_campaign::Progress;
use fspid_diagnostics::digits::grouped;

use super::super::progress::{Telling, answer_after, duration, tell};

/// Works and tells how far it is on standard error.
pub(super) fn told<T>(telling: Telling, runs: u64, work: impl FnOnce(&Progress) -> T) -> T {
    told_by(telling, &|progress, elapsed| line(progress, runs, elapsed), work)
}

/// The same of a search, which may end with fewer runs, and whose failures are not counted one by one.
pub(super) fn told_of_search<T>(
    telling: Telling,
    most: u64,
    work: impl FnOnce(&Progress) -> T,
) -> T {
    told_by(telling, &|progress, elapsed| runs_line(progress, most, elapsed), work)
}

fn told_by<T>(
    telling: Telling,
    line: &(dyn Fn(&Progress, Duration) -> String + Sync),
    work: impl FnOnce(&Progress) -> T,
) -> T {
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
                tell(telling, &line(progress, start.elapsed()));
            }
        });
        let answer = work(progress);
        drop(done);
        answer_after(telling, &line(progress, start.elapsed()));
        answer
    })
}

fn line(progress: &Progress, runs: u64, elapsed: Duration) -> String {
    let line = runs_line(progress, runs, elapsed);
    if progress.flown() == 0 {
        return line;
    }
    // Of runs that were there already nobody has counted.
    let now = if progress.found() > 0 { "of those flown now " } else { "" };
    let failed = progress.failed();
    format!("{line}, {now}{} flight{} failed", grouped(failed), if failed == 1 { "" } else { "s" })
}

fn runs_line(progress: &Progress, runs: u64, elapsed: Duration) -> String {
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
        parts.push(format!("{} flown before", grouped(found)));
    }
    parts.join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn work_that_is_told_gives_its_answer_and_ends() {
        assert_eq!(told(Telling::Lines, 3, |progress| progress.flown() + 7), 7);
        assert_eq!(told(Telling::Nothing, 3, |_| 8), 8);
    }
}
