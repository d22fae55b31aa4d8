//! `fspid contest`: controllers tuned alike, judged on what none of them was tuned on.

use std::time::{Duration, Instant};

use clap::Args;

use super::cluster::{Cluster, with_crew};
use super::limit::told;
use super::progress::{Telling, answer_after, duration, tell};
use super::{Format, interrupt, json_text, memory};
use crate::argument::{Folder, InFile, count};
use crate::exit::{Failure, note, print};
use fspid_diagnostics::digits::{counted, grouped};
use fspid_scenario::count as counts;
use fspid_study::output;
use fspid_tune::contest::{Contest, Options, Progress, Then};
use fspid_tune::front::{Asked, Front};
use fspid_tune::limit::NearLimit;
use fspid_tune::{Crew, Source, TuneError};

/// How often the state of a search is saved.
const SAVED_EVERY: Duration = Duration::from_secs(2);

/// Candidates that are flown to know how long one takes.
const REHEARSED: usize = 8;

/// Tune every controller of a scenario alike, and judge all on what none of them was tuned on.
///
/// Controllers with marks are tuned on the cases of `[tuning]` with the same budget, optimiser, objective and
/// seeds; those without fly as they are written. All are judged on the cases of `[contest]`. The answer says who
/// wins where, by how much, and whether that is significant. The folder holds the designs, every flight
/// (contest.parquet), the answer for programs (contest.json) and the page (contest.html). A contest that was
/// interrupted goes on where it was when the same command is given again.
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// The scenario file.
    scenario: InFile,
    /// The folder in which everything is kept.
    #[arg(long, value_name = "DIR")]
    out: Folder,
    /// How many seeds each controller is tuned with; by default as the scenario says.
    #[arg(long, value_name = "K", value_parser = count::<u64>(&counts::SEEDS))]
    seeds: Option<u64>,
    /// How many candidates each tuning flies; by default as the scenario says.
    #[arg(long, value_name = "N", value_parser = count::<usize>(&counts::BUDGET))]
    budget: Option<usize>,
    /// Set a value before anything is read, e.g. `--set loop.duration_s=30`.
    #[arg(long = "set", value_name = "PATH=VALUE")]
    overrides: Vec<String>,
    /// How many threads; 0 for as many as the machine has. The result is the same.
    #[arg(long, default_value_t = 0, value_parser = count::<usize>(&counts::THREADS))]
    threads: usize,
    #[command(flatten)]
    cluster: Cluster,
    /// Tune everybody at a ladder of efforts, and compare along all of it: `travel` alone takes 0.5 to 2 times the mean
    /// elevator travel that the tuning allows, `travel=8,10,15` these, deg. Each effort is a contest in a folder of its own;
    /// front.html and front.json tell of all.
    #[arg(long, value_name = "travel[=DEG,…]", value_parser = front, conflicts_with = "limit")]
    front: Option<AskedFront>,
    /// Tell as well how near each controller's best design comes to the limit of every linear case, at its own travel, and
    /// write it as limit.json. Takes some seconds a case.
    #[arg(long)]
    limit: bool,
    /// Say nothing of the progress.
    #[arg(long)]
    quiet: bool,
    /// How the answer is written.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
}

/// A ladder of efforts: mean travels, deg; none for one around the scenario's limit.
#[derive(Clone, Debug)]
struct AskedFront(Option<Vec<f64>>);

fn front(text: &str) -> Result<AskedFront, String> {
    let allowed = "a front is `travel`, or `travel=` with two or more different numbers of degrees above 0 and at most 1e6, with commas between";
    if text.trim() == "travel" {
        return Ok(AskedFront(None));
    }
    let given = text.trim().strip_prefix("travel=").ok_or(allowed)?;
    let travel = |part: &str| part.trim().parse().ok().filter(|deg| *deg > 0.0 && *deg <= 1e6);
    let travels: Option<Vec<f64>> = given.split(',').map(travel).collect();
    travels
        .filter(|it| it.len() > 1 && all_differ(it))
        .map(|it| AskedFront(Some(it)))
        .ok_or(allowed.to_owned())
}

fn all_differ(travels: &[f64]) -> bool {
    let mut sorted = travels.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted.is_sorted_by(|low, high| low < high)
}

/// Holds a contest at every effort.
fn run_front(arguments: &Arguments, asked: &AskedFront) -> Result<(), Failure> {
    let (source, options) = asked_for(arguments);
    let front = Front::new(&source, &options, asked.0.as_deref()).map_err(failure)?;
    front.warnings().iter().for_each(|it| note(format_args!("warning: {it}")));
    let telling = if arguments.quiet { Telling::Nothing } else { Telling::for_standard_error() };
    interrupt::watch();
    let carrier = arguments.cluster.carrier(&source)?;
    if carrier.is_none() {
        memory::asked(front.needed(memory::threads(arguments.threads)))?;
    }
    let rungs: Vec<f64> = front.contests().map(|(travel_deg, _)| travel_deg).collect();
    let held = with_crew(carrier.as_ref(), arguments.threads, |crew| {
        let mut watch = Watch::new(telling, Vec::new());
        let mut then = |place: usize, progress: &Progress| {
            let travel_deg = rungs.get(place).copied().unwrap_or_default();
            watch.before_all = format!("{travel_deg} deg ({} of {}): ", place + 1, rungs.len());
            watch.then(progress)
        };
        let told = |now: &str| {
            if telling == Telling::Line {
                tell(telling, now);
            }
        };
        let held = front.hold(
            &arguments.out,
            crew,
            &mut then,
            Asked { told: &told, stop: interrupt::asked },
        );
        watch.end();
        held
    });
    let outcome = held?.map_err(failure)?;
    let answer = match arguments.format {
        Format::Text => outcome.text(),
        Format::Json => json_text(&outcome.json()),
    };
    print(&answer)?;
    if !arguments.quiet {
        let page = arguments.out.join("front.html");
        note(format_args!("wrote {}; the contests of all efforts lie beside it", page.display()));
    }
    Ok(())
}

fn asked_for(arguments: &Arguments) -> (Source, Options) {
    let path = arguments.scenario.to_path_buf();
    let source = Source { path, overrides: arguments.overrides.clone() };
    (source, Options { seeds: arguments.seeds, budget: arguments.budget })
}

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    if let Some(asked) = &arguments.front {
        return run_front(arguments, asked);
    }
    let (source, options) = asked_for(arguments);
    let contest = Contest::new(&source, &options).map_err(failure)?;
    contest.warnings().iter().for_each(|it| note(format_args!("warning: {it}")));
    let telling = if arguments.quiet { Telling::Nothing } else { Telling::for_standard_error() };
    interrupt::watch();
    let carrier = arguments.cluster.carrier(&source)?;
    if carrier.is_none() {
        memory::asked(contest.needed(memory::threads(arguments.threads)))?;
    }
    let held = with_crew(carrier.as_ref(), arguments.threads, |crew| {
        let expected = match (telling, crew) {
            (Telling::Nothing, _) | (_, Crew::Others(_)) => Vec::new(),
            (Telling::Line | Telling::Lines, Crew::Here(_)) => expected(&contest, crew)?,
        };
        let mut watch = Watch::new(telling, expected);
        let held = contest.hold(&arguments.out, crew, &mut |progress| watch.then(progress));
        watch.end();
        held
    });
    let outcome = held?.map_err(failure)?;
    let near = arguments
        .limit
        .then(|| told(telling, |told| contest.near_limit(&outcome, told, interrupt::asked)));
    let near = near.transpose().map_err(failure)?;
    let answer = match arguments.format {
        Format::Text => outcome.text() + &near.as_ref().map_or(String::new(), NearLimit::text),
        Format::Json => {
            let mut answer = outcome.json();
            if let Some(near) = &near {
                answer["limit"] = near.json();
            }
            json_text(&answer)
        }
    };
    if let Some(near) = &near {
        output::write(&arguments.out.join("limit.json"), json_text(&near.json()))?;
    }
    print(&answer)?;
    if !arguments.quiet {
        let page = arguments.out.join("contest.html");
        note(format_args!("wrote {}; designs and all flights lie beside it", page.display()));
    }
    Ok(())
}

fn failure(error: TuneError) -> Failure {
    match error {
        _ if error.is_of_output() => Failure::output(error),
        TuneError::Stopped => Failure::interrupted(format_args!(
            "interrupted; the same command goes on from there: {}",
            interrupt::command()
        )),
        _ => Failure::of_input(&error, error.problems()),
    }
}

/// How long a candidate of each controller takes, s, by flying some; tells how long all of them will.
fn expected(contest: &Contest, crew: Crew<'_>) -> Result<Vec<(String, f64)>, TuneError> {
    let each = |(name, _): (&str, usize)| {
        let begun = Instant::now();
        contest.rehearse(name, REHEARSED, crew)?;
        Ok((name.to_owned(), begun.elapsed().as_secs_f64() / REHEARSED as f64))
    };
    let expected = contest.searches().map(each).collect::<Result<Vec<_>, TuneError>>()?;
    let seconds: f64 = contest.searches().zip(&expected).map(|((_, n), (_, s))| n as f64 * s).sum();
    if let Some((_, candidates)) = contest.searches().next() {
        note(format_args!(
            "{} tuned with {} candidates each: about {} on this machine, what is there already and the judging not counted",
            counted(expected.len(), "controller"),
            grouped(candidates as u64),
            duration(seconds)
        ));
    }
    Ok(expected)
}

/// Tells how far the contest is, and when states are to be saved.
struct Watch {
    telling: Telling,
    told: Instant,
    kept: Instant,
    last: Option<String>,
    /// What stands before every line.
    before_all: String,
    /// Seconds that a candidate of each controller was expected to take.
    expected: Vec<(String, f64)>,
    /// When flying began.
    begun: Option<Instant>,
    /// Seconds that were expected for what was flown since.
    flown_s: f64,
    /// The search and its candidates when it was last told of.
    before: (usize, usize),
}

impl Watch {
    fn new(telling: Telling, expected: Vec<(String, f64)>) -> Self {
        let now = Instant::now();
        let before = (0, 0);
        Self {
            telling,
            told: now,
            kept: now,
            last: None,
            before_all: String::new(),
            expected,
            begun: None,
            flown_s: 0.0,
            before,
        }
    }

    fn seconds(&self, controller: &str) -> f64 {
        let found = self.expected.iter().find(|(name, _)| name == controller);
        found.map_or(0.0, |(_, seconds)| *seconds)
    }

    /// Seconds that are left, by what flying took so far beside what was expected; none before something was flown.
    fn left(&mut self, progress: &Progress) -> Option<f64> {
        let ((number, of), (spent, budget)) = (progress.search, progress.candidates);
        if progress.was_there {
            return None;
        }
        let begun = *self.begun.get_or_insert_with(Instant::now);
        let was = if self.before.0 == number { self.before.1 } else { 0 };
        if self.before != (0, 0) {
            self.flown_s += spent.saturating_sub(was) as f64 * self.seconds(&progress.controller);
        }
        self.before = (number, spent);
        // Those that come after this one, in their order.
        let seeds = of.checked_div(self.expected.len()).unwrap_or(1).max(1);
        let rest = (number..of).filter_map(|place| self.expected.get(place / seeds));
        let rest: f64 = rest.map(|(_, seconds)| *seconds * budget as f64).sum();
        let mine = budget.saturating_sub(spent) as f64 * self.seconds(&progress.controller);
        let pace = begun.elapsed().as_secs_f64() / self.flown_s;
        (self.flown_s > 0.0 && pace.is_finite()).then_some((mine + rest) * pace)
    }

    fn then(&mut self, progress: &Progress) -> Then {
        if self.telling != Telling::Nothing {
            let mut text = format!("{}{}", self.before_all, line(progress));
            if let Some(left) = self.left(progress) {
                text.push_str(&format!(", {} left", duration(left)));
            }
            if self.told.elapsed() >= self.telling.period() {
                self.told = Instant::now();
                tell(self.telling, &text);
            }
            self.last = Some(text);
        }
        if interrupt::asked() {
            return Then::Stop;
        }
        // A state of no candidates is worth nothing.
        if progress.was_there || self.kept.elapsed() < SAVED_EVERY {
            return Then::GoOn;
        }
        self.kept = Instant::now();
        Then::Save
    }

    fn end(&self) {
        if let Some(last) = &self.last {
            answer_after(self.telling, last);
        }
    }
}

fn line(progress: &Progress) -> String {
    let Progress { controller, seed, search: (number, of), candidates: (spent, budget), .. } =
        progress;
    format!(
        "tuning {number} of {of}: {controller} with seed {seed}, {} of {} candidates",
        grouped(*spent as u64),
        grouped(*budget as u64)
    )
}
