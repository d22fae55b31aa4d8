//! Controllers tuned alike, and judged on what none of them was tuned on.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use fspid::campaign::local;
use fspid::tune::contest::{Contest, Options, Progress, Then};
use pyo3::prelude::*;

use crate::answer::Answer;
use crate::scenario::Scenario;
use crate::{error, interrupt};

/// How often the state of a search is saved.
const SAVED_EVERY: Duration = Duration::from_secs(2);

#[pymethods]
impl Scenario {
    /// Holds a contest in a folder, or goes on with it.
    fn contest(
        &self,
        py: Python<'_>,
        out: PathBuf,
        seeds: Option<u64>,
        budget: Option<usize>,
        threads: usize,
    ) -> PyResult<Answer> {
        let source = self.source(py)?;
        let stop = Arc::new(AtomicBool::new(false));
        let asked = Arc::clone(&stop);
        let answer = interrupt::run_until(
            py,
            || stop.store(true, Ordering::Relaxed),
            move || {
                local::in_threads(threads, || {
                    let contest = Contest::new(&source, &Options { seeds, budget })?;
                    let mut kept = Instant::now();
                    let outcome =
                        contest.hold(&out, &mut |progress| then(&asked, &mut kept, progress))?;
                    let page = std::fs::read_to_string(out.join("contest.html")).ok();
                    let answer = Answer::new(outcome.text(), &outcome.json(), true);
                    Ok(match page {
                        Some(page) => answer.with_page(page),
                        None => answer,
                    })
                })?
            },
        )?;
        answer.map_err(|found| error::tune(py, &found))
    }
}

fn then(asked: &AtomicBool, kept: &mut Instant, progress: &Progress) -> Then {
    if asked.load(Ordering::Relaxed) {
        return Then::Stop;
    }
    if progress.was_there || kept.elapsed() < SAVED_EVERY {
        return Then::GoOn;
    }
    *kept = Instant::now();
    Then::Save
}
