//! A contest.

use std::time::Duration;

use fspid_scenario::count::{BUDGET, SEEDS};
use fspid_tune::Crew;
use fspid_tune::contest::{Contest as Held, Options, Progress, Then};
use serde_json::{Value, json};

use super::asked::counted;
use super::task::{Ended, Pace, Task};
use crate::answer::Refusal;
use crate::request::Fields;

/// How often the state of a search is saved.
const SAVED_EVERY: Duration = Duration::from_secs(2);

/// The options of `fspid contest`.
#[derive(Clone, Debug)]
pub(super) struct Contest {
    pub(super) overrides: Vec<String>,
    seeds: Option<u64>,
    budget: Option<usize>,
}

impl Contest {
    pub(super) fn read(options: &mut Fields) -> Result<Self, Refusal> {
        let budget = counted(options, "budget", BUDGET)?;
        Ok(Self {
            overrides: options.texts("set")?,
            seeds: counted(options, "seeds", SEEDS)?,
            budget: budget.and_then(|it| usize::try_from(it).ok()),
        })
    }

    pub(super) fn work(&self, task: &Task<'_>) -> Result<Value, Ended> {
        let options = Options { seeds: self.seeds, budget: self.budget };
        let contest = Held::new(&task.source, &options)?;
        let tuned: Vec<Value> = contest
            .searches()
            .map(|(name, budget)| json!({ "controller": name, "candidates": budget }))
            .collect();
        task.tell("begun", &json!({ "searches": tuned, "warnings": contest.warnings() }));
        let stops = || task.is_stopped();
        let (mut pace, mut saved) = (Pace::new(), Pace::new());
        let outcome = contest.hold(&task.folder, Crew::Here(&stops), &mut |progress| {
            if pace.is_time_to_tell() {
                tell(task, progress);
            }
            match (task.is_stopped(), !progress.was_there && saved.is_due(SAVED_EVERY)) {
                (true, _) => Then::Stop,
                (false, true) => Then::Save,
                (false, false) => Then::GoOn,
            }
        })?;
        Ok(json!({ "text": outcome.text(), "json": outcome.json() }))
    }
}

/// How far it is: of all searches, the flights that judge not counted.
fn tell(task: &Task<'_>, progress: &Progress) {
    let ((search, searches), (spent, budget)) = (progress.search, progress.candidates);
    let done = search.saturating_sub(1) * budget + spent.min(budget);
    let (controller, seed) = (&progress.controller, progress.seed);
    let what = format!("candidates: {controller} with seed {seed}, tuning {search} of {searches}");
    task.progress(done as u64, (searches * budget) as u64, &what);
}
