//! `fspid tune`: the free numbers of a scenario, chosen.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use clap::Args;

use super::progress::{Telling, answer_after, duration, grouped, tell};
use super::{Format, json_text};
use crate::argument::{InFile, OutFile, written};
use crate::exit::{Failure, note, print, wrote};
use fspid_campaign::local;
use fspid_study::file::known_words;
use fspid_study::output;
use fspid_tune::baseline::Baseline;
use fspid_tune::rule::{Form, Options, Rule, Verdict};
use fspid_tune::{Effort, Problem, Search, Source, State, TuneError, Tuned, design, history};

/// How often the state of a search is saved.
const SAVED_EVERY: Duration = Duration::from_secs(2);

/// Choose the numbers of a scenario that are marked free, so that its flights become good.
///
/// Mark numbers with `{ tune = [0.1, 10.0], scale = "log", start = 1.0 }`, say under [[tuning.objective]] what
/// shall become small, and under [[tuning.case]] on what to fly. Requirements of the scenario are limits
/// that come before any cost. The same seed gives the same design on any number of threads; a search that
/// was interrupted goes on where it was when the same command is given again.
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// The scenario file.
    scenario: InFile,
    /// The controller; needed only where several have free numbers.
    #[arg(long, value_name = "NAME")]
    controller: Option<String>,
    /// How to search: cma-es, de, l-shade, pso, ga, nelder-mead, or nsga-ii for trade-offs; by default as
    /// the scenario says.
    #[arg(long, value_name = "NAME")]
    optimiser: Option<String>,
    /// How many candidates to fly; by default as the scenario says.
    #[arg(long, value_name = "N")]
    budget: Option<usize>,
    /// Seed of the search; by default as the scenario says.
    #[arg(long, value_name = "S")]
    seed: Option<u64>,
    /// Candidates of a generation; by default what serves the optimiser.
    #[arg(long, value_name = "N")]
    population: Option<usize>,
    /// Search for nothing: take the gains of a classical rule. `--rule list` tells them all.
    #[arg(long, value_name = "NAME", conflicts_with_all = ["optimiser", "budget", "seed", "population", "anywhere", "history"])]
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
    #[arg(long, default_value_t = 0)]
    threads: usize,
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
    let problem = Problem::new(&source, arguments.controller.as_deref()).map_err(failure)?;
    problem.warnings().iter().for_each(|it| note(format_args!("warning: {it}")));
    if let Some(out) = &arguments.out {
        design::check_place(&source, out).map_err(failure)?;
    }
    let effort = effort(arguments, &problem);
    let tuned = local::in_threads(arguments.threads, || search(arguments, &problem, &effort));
    let (tuned, best) = tuned.map_err(Failure::input)?.map_err(failure)?;
    let answer = match arguments.format {
        Format::Text => tuned.text(),
        Format::Json => json_text(&tuned.json()),
    };
    print(&answer)?;
    if let Some(out) = &arguments.out {
        let heading = tuned.heading(&effort.command(&source, arguments.controller.as_deref()));
        let text = design::text(&source, problem.space(), &best, &heading).map_err(failure)?;
        output::write(out, text)?;
        remove(&state_path(out));
        wrote(out);
    }
    match tuned.is_allowed() {
        true => Ok(()),
        false => Err(Failure::not_met(
            "no candidate came back from every flight and met every requirement",
        )),
    }
}

/// The gains of a classical rule.
fn by_rule(arguments: &Arguments, source: &Source, name: &str) -> Result<(), Failure> {
    if name == "list" {
        let row = |rule: &Rule| format!("{:<18}{}\n", rule.name(), rule.about());
        return print(&Rule::ALL.iter().map(row).collect::<String>());
    }
    let rule = Rule::from_name(name).ok_or_else(|| unknown("rule", name, &Rule::NAMES))?;
    let form = match arguments.form.as_deref() {
        None => None,
        Some(name) => {
            Some(Form::from_name(name).ok_or_else(|| unknown("form", name, &["p", "pi", "pid"]))?)
        }
    };
    let options = Options { form, closed_loop_s: arguments.closed_loop_s, ..Options::default() };
    let found = Baseline::of(source, arguments.controller.as_deref(), (rule, &options));
    let found = found.map_err(failure)?;
    match arguments.format {
        Format::Text => print(&found.design.text())?,
        Format::Json => print(&json_text(&found.design.json()))?,
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
        TuneError::Output(_) | TuneError::History(_) => Failure::output(error),
        _ => Failure::input(error),
    }
}

fn effort(arguments: &Arguments, problem: &Problem) -> Effort {
    let tuning = problem.tuning();
    Effort {
        optimiser: arguments.optimiser.clone().unwrap_or_else(|| tuning.optimiser.clone()),
        budget: arguments.budget.unwrap_or(tuning.budget),
        seed: arguments.seed.unwrap_or(tuning.seed),
        population: arguments.population,
        anywhere: arguments.anywhere,
    }
}

/// Searches to the end; what was found, and the best point.
fn search(
    arguments: &Arguments,
    problem: &Problem,
    effort: &Effort,
) -> Result<(Tuned, Vec<f64>), TuneError> {
    let saved = arguments.out.as_deref().map(state_path);
    let mut search = begun(problem, effort, saved.as_deref())?;
    let telling = if arguments.quiet { Telling::Nothing } else { Telling::for_standard_error() };
    let begun_at = (Instant::now(), search.spent());
    // The first generation is kept at once: what is found must not be lost, nor whether it can be kept.
    let (mut told, mut kept) = (Instant::now(), None::<Instant>);
    let stop = loop {
        if let Some(stop) = search.advance() {
            break stop;
        }
        if telling != Telling::Nothing && told.elapsed() >= telling.period() {
            told = Instant::now();
            tell(telling, &line(&search, begun_at));
        }
        if let Some(path) = &saved
            && kept.is_none_or(|kept| kept.elapsed() >= SAVED_EVERY)
        {
            output::write(path, json_text(&state_json(&search.state())))?;
            kept = Some(Instant::now());
        }
    };
    if telling != Telling::Nothing {
        answer_after(telling, &line(&search, begun_at));
    }
    if let Some(path) = &arguments.history {
        history::write(path, problem, &search)?;
    }
    let tuned = Tuned::of(problem, &search, stop);
    Ok((tuned, search.best().point.clone()))
}

fn begun<'a>(
    problem: &'a Problem,
    effort: &Effort,
    saved: Option<&Path>,
) -> Result<Search<'a>, TuneError> {
    let Some(path) = saved.filter(|path| path.exists()) else {
        return Search::begin(problem, effort.clone());
    };
    let name = path.display().to_string();
    let wrong = |reason: String| TuneError::State { path: name.clone(), reason };
    let text = std::fs::read_to_string(path).map_err(|error| wrong(output::in_words(&error)))?;
    let state: State = serde_json::from_str(&text).map_err(|error| wrong(error.to_string()))?;
    let search = Search::resume(problem, effort, state, &name)?;
    note(format_args!("going on after {} candidates, from {name}", grouped(search.spent() as u64)));
    Ok(search)
}

fn state_json(state: &State) -> serde_json::Value {
    serde_json::to_value(state).unwrap_or_default()
}

/// Where the state of a search lies while it goes on.
fn state_path(out: &Path) -> PathBuf {
    let mut name = out.as_os_str().to_owned();
    name.push(".state.json");
    PathBuf::from(name)
}

/// The state of a search that is over is of no use any more.
fn remove(path: &Path) {
    if path.exists() && std::fs::remove_file(path).is_err() {
        note(format_args!("warning: {} could not be removed", path.display()));
    }
}

fn line(search: &Search<'_>, (start, before): (Instant, usize)) -> String {
    let (spent, budget) = (search.spent(), search.effort().budget);
    let mut parts =
        vec![format!("{} of {} candidates", grouped(spent as u64), grouped(budget as u64))];
    let score = &search.best().score;
    parts.push(match score.is_allowed() {
        true => format!("best cost {:.6}", score.cost),
        false => format!("none allowed yet, violation {:.4}", score.violation),
    });
    let seconds = start.elapsed().as_secs_f64();
    let flown = spent.saturating_sub(before);
    if flown > 0 && spent < budget {
        let left = (budget - spent) as f64 * seconds / flown as f64;
        parts.push(format!("{} left", duration(left)));
    }
    parts.join(", ")
}
