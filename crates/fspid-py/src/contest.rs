//! Controllers tuned alike, and judged on what none of them was tuned on.

use std::path::PathBuf;
use std::sync::atomic::Ordering;

use fspid::campaign::local;
use fspid::tune::contest::{Contest, Options, Progress, Then};
use fspid::tune::{Crew, Source, TuneError};
use pyo3::prelude::*;

use crate::answer::Answer;
use crate::crew::Caller;
use crate::scenario::Scenario;
use crate::tune::Saving;
use crate::{error, interrupt};

/// How a contest is held.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Wanted {
    out: PathBuf,
    seeds: Option<u64>,
    budget: Option<usize>,
    threads: usize,
}

#[pymethods]
impl Scenario {
    /// Holds a contest in a folder, or goes on with it. `fly` flies in place of this machine's threads, and `tell` is told of
    /// the progress then: the search and how many there are, candidates flown and how many there will be.
    #[pyo3(signature = (wanted, fly=None, tell=None))]
    fn contest(
        &self,
        py: Python<'_>,
        wanted: Wanted,
        fly: Option<Py<PyAny>>,
        tell: Option<Py<PyAny>>,
    ) -> PyResult<Answer> {
        let source = self.source(py)?;
        let origin = self.made_of_all(&source).map_err(|found| error::tune(py, &found))?;
        let made_of = origin.clone();
        let Some(fly) = fly else {
            let answer = interrupt::run_flagged(py, move |stop| {
                let is_asked = || stop.load(Ordering::Relaxed);
                let _protected = made_of.protected();
                local::in_threads(wanted.threads, || {
                    held(&source, &wanted, Crew::Here(&is_asked), &mut |_| match is_asked() {
                        true => Then::Stop,
                        false => Then::GoOn,
                    })
                })?
            })?;
            let answer = answer.map_err(|found| error::tune(py, &found))?;
            return Ok(answer.from(origin));
        };
        let caller = Caller::new(fly);
        let told = |now: &Progress| {
            let ((number, of), (spent, budget)) = (now.search, now.candidates);
            let progress = (number, of, spent, budget);
            let called =
                caller.call(|py| tell.as_ref().map(|it| it.call1(py, progress)).transpose());
            if called.is_ok() { Then::GoOn } else { Then::Stop }
        };
        // On this thread, where Ctrl-C reaches what Python does.
        let answer = py.detach(|| {
            let _protected = origin.protected();
            held(&source, &wanted, Crew::Others(&caller), &mut { told })
        });
        Ok(answer.map_err(|found| caller.raise(py, &found))?.from(origin))
    }
}

/// Holds it to the end; `then` is asked before each generation.
fn held(
    source: &Source,
    wanted: &Wanted,
    crew: Crew<'_>,
    then: &mut dyn FnMut(&Progress) -> Then,
) -> Result<Answer, TuneError> {
    let options = Options { seeds: wanted.seeds, budget: wanted.budget };
    let contest = Contest::new(source, &options)?;
    let mut saving = Saving::default();
    let outcome = contest.hold(&wanted.out, crew, &mut |progress| match then(progress) {
        Then::GoOn if !progress.was_there && progress.candidates.0 > 0 && saving.is_due() => {
            Then::Save
        }
        then => then,
    })?;
    let page = std::fs::read_to_string(wanted.out.join("contest.html")).ok();
    let answer = Answer::new(outcome.text(), &outcome.json(), true);
    Ok(match page {
        Some(page) => answer.with_page(page),
        None => answer,
    })
}
