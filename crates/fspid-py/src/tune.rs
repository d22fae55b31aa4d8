//! The free numbers of a scenario, chosen.

use std::path::PathBuf;
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

use fspid::campaign::local;
use fspid::study::output;
use fspid::tune::baseline::Baseline;
use fspid::tune::rule::{Form, Options, Rule, Verdict};
use fspid::tune::{
    AskedEffort, Crew, Effort, Kept, Search, Source, Then, TuneError, Tuned, TuningProblem, design,
    history,
};
use pyo3::prelude::*;

use crate::answer::Answer;
use crate::crew::Caller;
use crate::origin::{Origin, as_file};
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
    /// Searches for its free numbers; the file is the design. `fly` flies in place of this machine's threads, and `tell` is
    /// told of the progress then: candidates flown, and how many there will be.
    #[pyo3(signature = (wanted, fly=None, tell=None))]
    fn tune(
        &self,
        py: Python<'_>,
        wanted: Wanted,
        fly: Option<Py<PyAny>>,
        tell: Option<Py<PyAny>>,
    ) -> PyResult<Answer> {
        let (source, kept_beside) = (self.source(py)?, self.kept_beside());
        let origin = self.made_of_all(&source).map_err(|found| error::tune(py, &found))?;
        let wanted = wanted.placed();
        let outputs = [("out", wanted.out.as_deref()), ("history", wanted.history.as_deref())];
        origin.apart_from(&outputs).map_err(|clash| error::input(py, clash))?;
        let tuning = Tuning { source, wanted, kept_beside, origin };
        let Some(fly) = fly else {
            let answer = interrupt::run_flagged(py, move |stop| {
                let is_asked = || stop.load(Ordering::Relaxed);
                local::in_threads(tuning.wanted.threads, || {
                    tuning.searched(Crew::Here(&is_asked), &mut |_| match is_asked() {
                        true => Then::Stop,
                        false => Then::GoOn,
                    })
                })?
            })?;
            return answer.map_err(|found| error::tune(py, &found));
        };
        let caller = Caller::new(fly);
        let told = |search: &Search<'_>| {
            let progress = (search.spent(), search.effort().budget);
            let called =
                caller.call(|py| tell.as_ref().map(|it| it.call1(py, progress)).transpose());
            if called.is_ok() { Then::GoOn } else { Then::Stop }
        };
        // On this thread, where Ctrl-C reaches what Python does.
        let answer = py.detach(|| tuning.searched(Crew::Others(&caller), &mut { told }));
        answer.map_err(|found| caller.raise(py, &found))
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
        let answer = answer.map_err(|found| error::tune(py, &found))?;
        Ok(answer.from(self.made_of()))
    }
}

/// A design's place beside its scenario, from where files are named alike.
fn beside(source: &Source) -> PathBuf {
    source.path.with_file_name(DESIGN)
}

/// A search that is asked for.
struct Tuning {
    source: Source,
    wanted: Wanted,
    kept_beside: Option<PathBuf>,
    origin: Origin,
}

impl Tuning {
    /// Searches to the end, and writes what was found; `then` is asked before each generation.
    fn searched(
        &self,
        crew: Crew<'_>,
        then: &mut dyn FnMut(&Search<'_>) -> Then,
    ) -> Result<Answer, TuneError> {
        let Self { source, wanted, kept_beside, origin } = self;
        let _protected = origin.protected();
        let problem = TuningProblem::new(source, wanted.controller.as_deref())?;
        if let Some(out) = &wanted.out {
            design::check_place(source, out)?;
        }
        let effort = wanted.effort(&problem);
        let kept_beside = kept_beside.as_deref();
        let mut place = Kept::beside(wanted.out.as_deref(), kept_beside, problem.file_name());
        let (mut search, _) = place.begun(&problem, &effort, crew)?;
        let mut saving = Saving::default();
        let stop = place.search(&mut search, &mut |search| match then(search) {
            Then::GoOn if search.spent() > 0 && saving.is_due() => Then::Save,
            then => then,
        })?;
        let tuned = Tuned::of(&problem, &search, stop);
        let tuned = tuned.map_err(|error| place.left(&search, error))?;
        if let Some(path) = &wanted.history {
            history::write(path, &problem, &search)?;
        }
        let heading = tuned.heading(&effort.command(source, wanted.controller.as_deref()));
        let text = problem.design(&search.best().point, &heading)?;
        if let Some(out) = &wanted.out {
            output::write(out, &text)?;
        }
        // What cannot be removed is refused by the next search there, in words.
        let _ = place.remove();
        let answer = Answer::new(tuned.text(), &tuned.json(), tuned.is_allowed());
        Ok(answer.with_files(vec![(DESIGN.to_owned(), text)]).from(origin.clone()))
    }
}

/// When the state of a search is saved: at once, and then every few seconds.
#[derive(Default)]
pub(crate) struct Saving(Option<Instant>);

impl Saving {
    pub(crate) fn is_due(&mut self) -> bool {
        let is_due = self.0.is_none_or(|saved| saved.elapsed() >= SAVED_EVERY);
        if is_due {
            self.0 = Some(Instant::now());
        }
        is_due
    }
}

impl Wanted {
    /// With files where the program has standard output.
    fn placed(mut self) -> Self {
        self.out = self.out.as_deref().map(as_file);
        self.history = self.history.as_deref().map(as_file);
        self
    }

    fn effort(&self, problem: &TuningProblem) -> Effort {
        let asked = AskedEffort {
            optimiser: self.optimiser.clone(),
            budget: self.budget,
            seed: self.seed,
            population: self.population,
            anywhere: self.anywhere,
        };
        asked.of(problem.tuning())
    }
}
