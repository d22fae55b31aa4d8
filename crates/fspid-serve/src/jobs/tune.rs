//! A tuning: every candidate is told, and the design of the best one so far.

use std::time::Duration;

use fspid_scenario::count::{BUDGET, POPULATION};
use fspid_tune::{
    AskedEffort, Beginning, Crew, Effort, Kept, Search, Then, Trial, Tuned, TuningProblem, Unfit,
};
use serde_json::{Value, json};

use super::asked::counted;
use super::rest::Rest;
use super::task::{Ended, Pace, Task};
use crate::answer::Refusal;
use crate::request::Fields;

/// How often the state of the search is saved.
const SAVED_EVERY: Duration = Duration::from_secs(2);
/// Candidates of one event.
const AT_ONCE: usize = 500;

/// The options of `fspid tune`.
#[derive(Clone, Debug)]
pub(super) struct Tune {
    pub(super) overrides: Vec<String>,
    controller: Option<String>,
    effort: AskedEffort,
}

impl Tune {
    pub(super) fn read(options: &mut Fields) -> Result<Self, Refusal> {
        let whole = |number: Option<u64>| number.and_then(|it| usize::try_from(it).ok());
        Ok(Self {
            overrides: options.texts("set")?,
            controller: options.text("controller")?,
            effort: AskedEffort {
                optimiser: options.text("optimiser")?,
                budget: whole(counted(options, "budget", BUDGET)?),
                seed: options.whole("seed")?,
                population: whole(counted(options, "population", POPULATION)?),
                anywhere: options.flag("anywhere")?,
            },
        })
    }

    /// Candidates of a generation, where somebody has said how many.
    pub(super) fn population(&self) -> u64 {
        self.effort.population.map_or(0, |candidates| candidates as u64)
    }

    pub(super) fn work(&self, task: &Task<'_>) -> Result<Value, Ended> {
        let problem = TuningProblem::new(&task.source, self.controller.as_deref())?;
        let effort = self.effort.of(problem.tuning());
        let stops = || task.is_stopped();
        let mut place = Kept::at(Some(task.folder.join("state.json")), Unfit::Replaced);
        let (mut search, beginning) = place.begun(&problem, &effort, Crew::Here(&stops))?;
        let goes_on = matches!(beginning, Beginning::Resumed(_)).then(|| search.spent());
        task.tell("begun", &begun(&problem, &effort, goes_on));
        let mut teller = Teller {
            task,
            problem: &problem,
            told: 0,
            best: None,
            front: Vec::new(),
            rest: Rest::new(),
        };
        let (mut pace, mut saved) = (Pace::new(), Pace::new());
        // The first time is now, where there is nothing to save.
        saved.is_due(SAVED_EVERY);
        let stop = place.search(&mut search, &mut |search| {
            if pace.is_time_to_tell() {
                teller.tell(search);
            }
            match (task.is_stopped(), saved.is_due(SAVED_EVERY)) {
                (true, _) => Then::Stop,
                (false, true) => Then::Save,
                (false, false) => Then::GoOn,
            }
        })?;
        teller.tell(&search);
        teller.tell_front(&search);
        let tuned = Tuned::of(&problem, &search, stop).map_err(|it| place.left(&search, it))?;
        let heading = tuned.heading(&effort.command(&task.source, self.controller.as_deref()));
        let design = teller.design(&search.best().point, &heading);
        // One that stays is of a search that has ended, and is found as such.
        let _ = place.remove();
        Ok(json!({ "text": tuned.text(), "json": tuned.json(), "design": design }))
    }
}

/// What is searched, and how; after how many candidates where it goes on.
fn begun(problem: &TuningProblem, effort: &Effort, goes_on: Option<usize>) -> Value {
    let space = problem.space();
    let start = space.numbers(&space.start());
    let numbers = space.names().into_iter().zip(start);
    let numbers = numbers.map(|(path, start)| json!({ "path": path, "start": start }));
    let objectives = problem.tuning().objectives.iter().map(|objective| {
        let measure = objective.requirement.measure;
        json!({ "measure": measure.name(), "unit": measure.unit(), "weight": objective.weight })
    });
    json!({
        "controller": problem.controller(),
        "optimiser": effort.optimiser,
        "budget": effort.budget,
        "seed": effort.seed,
        "flights": problem.flights(),
        "numbers": numbers.collect::<Vec<_>>(),
        "objectives": objectives.collect::<Vec<_>>(),
        "goes_on_after": goes_on,
        "warnings": problem.warnings(),
    })
}

/// Tells what is new about a search.
struct Teller<'a> {
    task: &'a Task<'a>,
    problem: &'a TuningProblem,
    /// Candidates that were told, the start among them.
    told: usize,
    /// What the best one cost that was told.
    best: Option<f64>,
    /// The trade-offs that were told.
    front: Vec<Vec<f64>>,
    rest: Rest,
}

impl Teller<'_> {
    fn tell(&mut self, search: &Search<'_>) {
        while let Some(new) = search.trials().get(self.told..).filter(|new| !new.is_empty()) {
            let part = new.get(..AT_ONCE).unwrap_or(new);
            let rows: Vec<Value> = part.iter().map(|trial| self.row(trial)).collect();
            self.task.tell("candidates", &json!({ "first": self.told, "trials": rows }));
            self.told += part.len();
        }
        let (spent, budget) = (search.spent() as u64, search.effort().budget as u64);
        self.task.progress(spent, budget, "candidates");
        let best = search.best();
        if self.best.is_none_or(|told| best.score.cost < told) {
            self.best = Some(best.score.cost);
            let mut row = self.row(best);
            let heading = ["The best so far of a search that goes on.".to_owned()];
            row["text"] = self.design(&best.point, &heading).into();
            self.task.tell("best", &row);
        }
        if let Some(began) = self.rest.is_over() {
            self.tell_front(search);
            self.rest.begin(began);
        }
    }

    /// Tells the trade-offs that nothing beats, where a front is searched and has changed.
    fn tell_front(&mut self, search: &Search<'_>) {
        if self.problem.tuning().objectives.len() < 2 {
            return;
        }
        let front = search.front();
        // A search for one cost knows its best one alone.
        if front.len() < 2 {
            return;
        }
        let points: Vec<Vec<f64>> = front.iter().map(|trial| trial.point.clone()).collect();
        if points == self.front {
            return;
        }
        self.front = points;
        let rows: Vec<Value> = front.iter().map(|trial| self.row(trial)).collect();
        self.task.tell("front", &json!({ "trials": rows }));
    }

    /// A candidate: what it costs where it is allowed, its numbers, and the values of the objectives.
    fn row(&self, trial: &Trial) -> Value {
        let score = &trial.score;
        json!({
            "generation": trial.generation,
            "allowed": score.is_allowed(),
            "cost": score.is_allowed().then_some(score.cost),
            "violation": score.violation,
            "values": score.values,
            "parameters": self.problem.space().numbers(&trial.point),
        })
    }

    /// The text of a design; none where the scenario's file has changed since, for it would be put in the place of that, or
    /// where it would be no scenario.
    fn design(&self, point: &[f64], heading: &[String]) -> Option<String> {
        self.task.is_as_seen().then(|| self.problem.design(point, heading).ok()).flatten()
    }
}
