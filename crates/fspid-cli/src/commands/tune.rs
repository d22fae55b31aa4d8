//! `fspid tune`: the free numbers of a scenario, chosen.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use clap::Args;
use serde_json::{Value, json};

use super::cluster::{Carrier, Cluster, with_crew};
use super::limit::told;
use super::progress::{Telling, answer_after, duration, tell};
use super::{Format, interrupt, json_text, memory};
use crate::argument::{InFile, OutFile, count, is_standard, written};
use crate::exit::{Failure, note, print, wrote};
use fspid_diagnostics::digits::grouped;
use fspid_scenario::count as counts;
use fspid_scenario::file::known_words;
use fspid_study::{output, shell};
use fspid_tune::baseline::Baseline;
use fspid_tune::limit::NearLimit;
use fspid_tune::rule::{Form, Options, Rule, Verdict};
use fspid_tune::{
    AskedEffort, Beginning, Crew, Effort, Kept, Search, Source, Stop, Then, TuneError, Tuned,
    TuningProblem, design, history,
};

/// How often the state of a search is saved.
const SAVED_EVERY: Duration = Duration::from_secs(2);

/// Choose the numbers of a scenario that are marked free, so that its flights become good.
///
/// Mark numbers with `{ tune = [0.1, 10.0], scale = "log", start = 1.0 }`, say under [[tuning.objective]] what
/// shall become small, and under [[tuning.case]] on what to fly. Requirements of the scenario are limits
/// that come before any cost. The same seed gives the same design on any number of threads; a search that
/// was interrupted goes on where it was when the same command is given again: its state is kept beside the design, or
/// beside the scenario where none is written.
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// The scenario file.
    scenario: InFile,
    /// The controller; needed only where several have free numbers.
    #[arg(long, value_name = "NAME")]
    controller: Option<String>,
    /// Tune every controller that has free numbers, all alike, and print them side by side. With --out each gets a
    /// design of its own, as in `design-PID.toml`.
    #[arg(long, conflicts_with_all = ["controller", "rule", "history"])]
    all: bool,
    /// How to search: cma-es, de, l-shade, pso, ga, nelder-mead, bfgs or sqp by slopes of the flights (sqp
    /// with those of each limit by itself), or nsga-ii for trade-offs; by default as the scenario says.
    #[arg(long, value_name = "NAME")]
    optimiser: Option<String>,
    /// How many candidates to fly; by default as the scenario says.
    #[arg(long, value_name = "N", value_parser = count::<usize>(&counts::BUDGET))]
    budget: Option<usize>,
    /// Seed of the search; by default as the scenario says.
    #[arg(long, value_name = "S")]
    seed: Option<u64>,
    /// Candidates of a generation; by default what serves the optimiser.
    #[arg(long, value_name = "N", value_parser = count::<usize>(&counts::POPULATION))]
    population: Option<usize>,
    /// Search for nothing: take the gains of a classical rule. `--rule list` tells them all.
    #[arg(long, value_name = "NAME", conflicts_with_all = ["optimiser", "budget", "seed", "population", "anywhere", "history", "engine"])]
    rule: Option<String>,
    /// Terms that the rule shall give: p, pi or pid; by default what the rule is made for.
    #[arg(long, value_name = "TERMS", requires = "rule")]
    form: Option<String>,
    /// Time constant that the closed loop shall have, s; for simc and lambda.
    #[arg(long, value_name = "SECONDS", requires = "rule")]
    closed_loop_s: Option<f64>,
    /// Begin anywhere within the bounds, and not about the start.
    #[arg(long)]
    anywhere: bool,
    /// Search no further: take the best of what a search has found so far, with the same options, whether it was
    /// interrupted or is still going on. Its state stays, so that it can go on.
    #[arg(long, conflicts_with = "rule")]
    so_far: bool,
    /// Write the design: the scenario with what was found in place of the marks.
    #[arg(value_parser = written(&["toml"]), long, value_name = "FILE")]
    out: Option<OutFile>,
    /// Write every candidate as a row of a Parquet file.
    #[arg(value_parser = written(&["parquet"]), long, value_name = "FILE")]
    history: Option<OutFile>,
    /// Set a value before anything is read, e.g. `--set loop.duration_s=30`.
    #[arg(long = "set", value_name = "PATH=VALUE")]
    overrides: Vec<String>,
    /// How many threads; 0 for as many as the machine has. The result is the same.
    #[arg(long, default_value_t = 0, value_parser = count::<usize>(&counts::THREADS))]
    threads: usize,
    #[command(flatten)]
    cluster: Cluster,
    /// Tell as well how much of what is possible at its own elevator travel each design reaches in each flight that it is
    /// tuned on, as `fspid limit` does.
    #[arg(long, conflicts_with = "rule")]
    limit: bool,
    /// Say nothing of the progress.
    #[arg(long)]
    quiet: bool,
    /// How the answer is written.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
}

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let source =
        Source { path: arguments.scenario.to_path_buf(), overrides: arguments.overrides.clone() };
    if let Some(rule) = &arguments.rule {
        return by_rule(arguments, &source, rule);
    }
    interrupt::watch();
    let carrier = arguments.cluster.carrier(&source)?;
    let tuning = Tuning { arguments, source: &source, carrier: carrier.as_ref() };
    let tuned = match arguments.all {
        false => vec![tuning.one(arguments.controller.as_deref())?],
        true => tuning.all()?,
    };
    match arguments.format {
        Format::Text => {
            let mut answer = tuned.iter().map(Found::text).collect::<Vec<_>>().join("\n");
            if arguments.all {
                let columns: Vec<_> =
                    tuned.iter().map(|it| (&it.tuned, it.of_possible_pct())).collect();
                answer.push_str(&Tuned::side_by_side(&columns));
            }
            print(&answer)?;
        }
        Format::Json if arguments.all => {
            let each: Vec<_> = tuned.iter().map(Found::json).collect();
            print(&json_text(&json!({ "schema": 1, "controllers": each })))?;
        }
        Format::Json => tuned.iter().try_for_each(|it| print(&json_text(&it.json())))?,
    }
    match tuned.iter().all(|it| it.tuned.is_allowed()) {
        true => {
            told_next(arguments, &tuned);
            Ok(())
        }
        false => Err(Failure::not_met(
            "no candidate came back from every flight and met every requirement",
        )),
    }
}

/// Tells the command that judges each design that was written.
fn told_next(arguments: &Arguments, tuned: &[Found]) {
    if arguments.quiet || !matches!(arguments.format, Format::Text) {
        return;
    }
    for design in tuned.iter().filter_map(|it| it.design.as_deref()) {
        if !is_standard(design) {
            note(format_args!("next: fspid verify {}", shell::word(&design.display().to_string())));
        }
    }
}

/// What was found, and how near it comes to the limit, where that was asked.
struct Found {
    tuned: Tuned,
    near: Option<NearLimit>,
    /// Where its design is written.
    design: Option<PathBuf>,
}

impl Found {
    fn text(&self) -> String {
        self.tuned.text() + &self.near.as_ref().map_or(String::new(), NearLimit::text)
    }

    /// How much of what is possible it reaches in the mean, %.
    fn of_possible_pct(&self) -> Option<f64> {
        self.near.as_ref()?.of_possible_pct().first().copied().flatten()
    }

    fn json(&self) -> Value {
        let mut answer = self.tuned.json();
        if let Some(near) = &self.near {
            answer["limit"] = near.json();
        }
        answer
    }
}

/// What is tuned, and by whom.
struct Tuning<'a> {
    arguments: &'a Arguments,
    source: &'a Source,
    carrier: Option<&'a Carrier>,
}

impl Tuning<'_> {
    /// Every controller with free numbers, one after the other, with the same effort.
    fn all(&self) -> Result<Vec<Found>, Failure> {
        let names = fspid_tune::controllers_with_marks(self.source).map_err(failure)?;
        if names.is_empty() {
            return self.one(None).map(|tuned| vec![tuned]);
        }
        names.iter().map(|name| self.one(Some(name))).collect()
    }

    /// Tunes one controller, and writes its design.
    fn one(&self, name: Option<&str>) -> Result<Found, Failure> {
        let Self { arguments, source, .. } = self;
        let problem = TuningProblem::new(source, name).map_err(failure)?;
        problem.warnings().iter().for_each(|it| note(format_args!("warning: {it}")));
        let out = arguments.out.as_ref();
        let out = out.map(|out| design_file(arguments, out, problem.file_name()));
        if let Some(out) = &out {
            design::check_place(source, out).map_err(failure)?;
        }
        let effort = effort(arguments, &problem);
        if self.carrier.is_none() {
            let flights = problem.needed(memory::threads(arguments.threads));
            let candidates = effort.population.unwrap_or(0) as u64;
            memory::asked(flights.with_candidates(candidates))?;
        }
        let mut place = kept(arguments, out.as_deref(), problem.file_name());
        let tuned = with_crew(self.carrier, arguments.threads, |crew| {
            search(arguments, (&problem, crew), &effort, &mut place)
        });
        let (tuned, best) = tuned?.map_err(failure)?;
        if let Some(out) = &out {
            let heading = tuned.heading(&effort.command(source, name));
            output::write(out, problem.design(&best, &heading).map_err(failure)?)?;
            wrote(out);
        }
        // The state is kept until all is told.
        let near = arguments.limit.then(|| {
            told(telling(arguments), |told| problem.near_limit(&best, told, interrupt::asked))
        });
        let near = near.transpose().map_err(failure)?;
        if arguments.so_far {
            return Ok(Found { tuned, near, design: out });
        }
        if let Err(path) = place.remove() {
            note(format_args!("warning: {} could not be removed", path.display()));
        }
        Ok(Found { tuned, near, design: out })
    }
}

fn telling(arguments: &Arguments) -> Telling {
    if arguments.quiet { Telling::Nothing } else { Telling::for_standard_error() }
}

/// Where the design of a controller is written.
fn design_file(arguments: &Arguments, out: &Path, file_name: &str) -> PathBuf {
    if !arguments.all || is_standard(out) {
        return out.to_owned();
    }
    let stem = out.file_stem().unwrap_or_default().to_string_lossy();
    out.with_file_name(format!("{stem}-{file_name}.toml"))
}

/// The gains of a classical rule.
fn by_rule(arguments: &Arguments, source: &Source, name: &str) -> Result<(), Failure> {
    if name == "list" {
        let row = |rule: &Rule| format!("{:<18}{}\n", rule.name(), rule.about());
        return arguments.format.print(
            || Rule::ALL.iter().map(row).collect(),
            || {
                let one = |rule: &Rule| json!({ "name": rule.name(), "about": rule.about() });
                json!({ "rules": Rule::ALL.iter().map(one).collect::<Vec<_>>() })
            },
        );
    }
    let rule = Rule::from_name(name).ok_or_else(|| unknown("rule", name, &Rule::NAMES))?;
    let form = match arguments.form.as_deref() {
        None => None,
        Some(name) => {
            Some(Form::from_name(name).ok_or_else(|| unknown("form", name, &["p", "pi", "pid"]))?)
        }
    };
    let options = Options { form, closed_loop_s: arguments.closed_loop_s, ..Options::default() };
    let found = Baseline::of(source, arguments.controller.as_deref(), rule, &options);
    let found = found.map_err(failure)?;
    match arguments.format {
        Format::Text => print(&found.answer())?,
        Format::Json => print(&json_text(&found.json()))?,
    }
    if let Some(out) = &arguments.out {
        let heading = [format!(
            "Controller \"{}\" by the rule {}: {}",
            found.controller,
            rule.name(),
            found.design.verdict.sentence()
        )];
        output::write(out, found.text(source, out, &heading).map_err(failure)?)?;
        wrote(out);
    }
    match found.design.verdict {
        Verdict::NotHeld(_) => Err(Failure::not_met("the rule's gains do not hold this aircraft")),
        _ => Ok(()),
    }
}

fn unknown(what: &str, found: &str, known: &[&str]) -> Failure {
    Failure::input(format_args!("there is no {what} `{found}`{}", known_words(found, known)))
}

fn failure(error: TuneError) -> Failure {
    match error {
        _ if error.is_of_output() => Failure::output(error),
        TuneError::NotKept => Failure::interrupted(error),
        TuneError::Stopped => Failure::interrupted(format_args!(
            "interrupted; the same command goes on from there: {}",
            interrupt::command()
        )),
        _ => Failure::of_input(&error, error.problems()),
    }
}

fn effort(arguments: &Arguments, problem: &TuningProblem) -> Effort {
    let asked = AskedEffort {
        optimiser: arguments.optimiser.clone(),
        budget: arguments.budget,
        seed: arguments.seed,
        population: arguments.population,
        anywhere: arguments.anywhere,
    };
    asked.of(problem.tuning())
}

/// Searches to the end; what was found, and the best point.
fn search(
    arguments: &Arguments,
    (problem, crew): (&TuningProblem, Crew<'_>),
    effort: &Effort,
    place: &mut Kept,
) -> Result<(Tuned, Vec<f64>), TuneError> {
    if arguments.so_far {
        let search = place.as_saved(problem, effort, crew)?;
        return found(arguments, (problem, &search), Stop::Taken);
    }
    let (mut search, beginning) = place.begun(problem, effort, crew)?;
    match beginning {
        Beginning::Anew => {}
        Beginning::Resumed(path) => note(format_args!(
            "going on after {} candidates, from {}",
            grouped(search.spent() as u64),
            path.display()
        )),
        Beginning::Unkept(why) => {
            note(format_args!("warning: {why}; it stays as it is, and this search keeps no state"))
        }
    }
    let telling = telling(arguments);
    let begun = Begun { at: Instant::now(), spent: search.spent() };
    let (mut told, mut saved) = (Instant::now(), None::<Instant>);
    let stop = place.search(&mut search, &mut |search| {
        if telling != Telling::Nothing && told.elapsed() >= telling.period() {
            told = Instant::now();
            tell(telling, &line(search, begun));
        }
        if interrupt::asked() {
            return Then::Stop;
        }
        // The first generation is kept at once: what is found must not be lost, nor whether it can be kept.
        let is_due = saved.is_none_or(|saved| saved.elapsed() >= SAVED_EVERY);
        if search.spent() == begun.spent || !is_due {
            return Then::GoOn;
        }
        saved = Some(Instant::now());
        Then::Save
    })?;
    if telling != Telling::Nothing {
        answer_after(telling, &line(&search, begun));
    }
    found(arguments, (problem, &search), stop).map_err(|error| place.left(&search, error))
}

/// What a search has found, and the best point.
fn found(
    arguments: &Arguments,
    (problem, search): (&TuningProblem, &Search<'_>),
    stop: Stop,
) -> Result<(Tuned, Vec<f64>), TuneError> {
    if let Some(path) = &arguments.history {
        history::write(path, problem, search)?;
    }
    Ok((Tuned::of(problem, search, stop)?, search.best().point.clone()))
}

/// Where the state is kept: beside the design; beside the scenario where none is written.
fn kept(arguments: &Arguments, out: Option<&Path>, file_name: &str) -> Kept {
    let file = |path: &&Path| !is_standard(path);
    let scenario: &Path = &arguments.scenario;
    Kept::beside(out.filter(file), Some(scenario).filter(file), file_name)
}

/// When a search went on, and how many candidates it had flown by then.
#[derive(Clone, Copy)]
struct Begun {
    at: Instant,
    spent: usize,
}

fn line(search: &Search<'_>, begun: Begun) -> String {
    let (spent, budget) = (search.spent(), search.effort().budget);
    let mut parts =
        vec![format!("{} of {} candidates", grouped(spent as u64), grouped(budget as u64))];
    let score = &search.best().score;
    parts.push(match score.is_allowed() {
        true => format!("best cost {:.6}", score.cost),
        false => format!("none allowed yet, violation {:.4}", score.violation),
    });
    let seconds = begun.at.elapsed().as_secs_f64();
    let flown = spent.saturating_sub(begun.spent);
    if flown > 0 && spent < budget {
        let left = (budget - spent) as f64 * seconds / flown as f64;
        parts.push(format!("{} left", duration(left)));
    }
    parts.join(", ")
}
