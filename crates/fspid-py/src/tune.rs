//! The free numbers of a scenario, chosen.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use fspid::campaign::local;
use fspid::study::output;
use fspid::tune::baseline::Baseline;
use fspid::tune::rule::{Form, Options, Rule, Verdict};
use fspid::tune::{Effort, Kept, Source, Then, TuneError, Tuned, TuningProblem, design, history};
use pyo3::prelude::*;

use crate::answer::Answer;
use crate::scenario::Scenario;
use crate::{error, interrupt};

/// How often the state of a search is saved.
const SAVED_EVERY: Duration = Duration::from_secs(2);

/// What a design is called among the files of an answer.
const DESIGN: &str = "design.toml";

/// How a search is made.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Wanted {
    controller: Option<String>,
    optimiser: Option<String>,
    budget: Option<usize>,
    seed: Option<u64>,
    population: Option<usize>,
    anywhere: bool,
    out: Option<PathBuf>,
    history: Option<PathBuf>,
    threads: usize,
}

#[pymethods]
impl Scenario {
    /// Searches for its free numbers; the file is the design.
    fn tune(&self, py: Python<'_>, wanted: Wanted) -> PyResult<Answer> {
        let source = self.source(py)?;
        let stop = Arc::new(AtomicBool::new(false));
        let asked = Arc::clone(&stop);
        let kept_beside = self.kept_beside();
        let answer = interrupt::run_until(
            py,
            || stop.store(true, Ordering::Relaxed),
            move || {
                let threads = wanted.threads;
                local::in_threads(threads, || {
                    search(&source, &wanted, kept_beside.as_deref(), &asked)
                })?
            },
        )?;
        answer.map_err(|found| error::tune(py, &found))
    }

    /// The gains of a classical rule; the file is the design.
    fn tune_by_rule(
        &self,
        py: Python<'_>,
        rule: &str,
        controller: Option<String>,
        form: Option<String>,
        closed_loop_s: Option<f64>,
    ) -> PyResult<Answer> {
        let source = self.source(py)?;
        let unknown = |what: &str, name: &str, known: &[&str]| {
            let known = fspid::scenario::file::known_words(name, known);
            error::input(py, format_args!("there is no {what} `{name}`{known}"))
        };
        let rule = Rule::from_name(rule).ok_or_else(|| unknown("rule", rule, &Rule::NAMES))?;
        let form = form.map(|name| {
            Form::from_name(&name).ok_or_else(|| unknown("form", &name, &["p", "pi", "pid"]))
        });
        let options = Options { form: form.transpose()?, closed_loop_s, ..Options::default() };
        let answer = interrupt::run(py, move || {
            let found = Baseline::of(&source, controller.as_deref(), rule, &options)?;
            let good = !matches!(found.design.verdict, Verdict::NotHeld(_));
            let heading = [format!(
                "Controller \"{}\" by the rule {}: {}",
                found.controller,
                rule.name(),
                found.design.verdict.sentence()
            )];
            let text = found.text(&source, &beside(&source), &heading)?;
            let answer = Answer::new(found.answer(), &found.json(), good);
            Ok::<_, TuneError>(answer.with_files(vec![(DESIGN.to_owned(), text)]))
        })?;
        answer.map_err(|found| error::tune(py, &found))
    }
}

/// A design's place beside its scenario, from where files are named alike.
fn beside(source: &Source) -> PathBuf {
    source.path.with_file_name(DESIGN)
}

fn search(
    source: &Source,
    wanted: &Wanted,
    kept_beside: Option<&Path>,
    asked: &AtomicBool,
) -> Result<Answer, TuneError> {
    let problem = TuningProblem::new(source, wanted.controller.as_deref())?;
    if let Some(out) = &wanted.out {
        design::check_place(source, out)?;
    }
    let effort = wanted.effort(&problem);
    let mut place = Kept::beside(wanted.out.as_deref(), kept_beside, problem.controller());
    let (mut search, _) = place.begun(&problem, &effort)?;
    let mut saved = None::<Instant>;
    let stop = place.search(&mut search, &mut |search| {
        if asked.load(Ordering::Relaxed) {
            return Then::Stop;
        }
        let is_due = saved.is_none_or(|saved| saved.elapsed() >= SAVED_EVERY);
        if search.spent() == 0 || !is_due {
            return Then::GoOn;
        }
        saved = Some(Instant::now());
        Then::Save
    })?;
    if let Some(path) = &wanted.history {
        history::write(path, &problem, &search)?;
    }
    let tuned = Tuned::of(&problem, &search, stop);
    let heading = tuned.heading(&effort.command(source, wanted.controller.as_deref()));
    let text = design::text(source, problem.space(), &search.best().point, &heading)?;
    if let Some(out) = &wanted.out {
        output::write(out, &text)?;
    }
    // What cannot be removed is refused by the next search there, in words.
    let _ = place.remove();
    let answer = Answer::new(tuned.text(), &tuned.json(), tuned.is_allowed());
    Ok(answer.with_files(vec![(DESIGN.to_owned(), text)]))
}

impl Wanted {
    fn effort(&self, problem: &TuningProblem) -> Effort {
        let tuning = problem.tuning();
        Effort {
            optimiser: self.optimiser.clone().unwrap_or_else(|| tuning.optimiser.clone()),
            budget: self.budget.unwrap_or(tuning.budget),
            seed: self.seed.unwrap_or(tuning.seed),
            population: self.population,
            anywhere: self.anywhere,
        }
    }
}
