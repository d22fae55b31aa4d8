//! `fspid contest`: controllers tuned alike, judged on what none of them was tuned on.

use std::time::{Duration, Instant};

use clap::Args;

use super::progress::{Telling, answer_after, grouped, tell};
use super::{Format, json_text};
use crate::argument::{Folder, InFile};
use crate::exit::{Failure, note, print};
use fspid_campaign::local;
use fspid_tune::contest::{Contest, Options, Progress, Then};
use fspid_tune::{Source, TuneError};

/// How often the state of a search is saved.
const SAVED_EVERY: Duration = Duration::from_secs(2);

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
    #[arg(long, value_name = "K")]
    seeds: Option<u64>,
    /// How many candidates each tuning flies; by default as the scenario says.
    #[arg(long, value_name = "N")]
    budget: Option<usize>,
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
    let options = Options { seeds: arguments.seeds, budget: arguments.budget };
    let contest = Contest::new(&source, &options).map_err(failure)?;
    contest.warnings().iter().for_each(|it| note(format_args!("warning: {it}")));
    let telling = if arguments.quiet { Telling::Nothing } else { Telling::for_standard_error() };
    let mut watch = Watch { telling, told: Instant::now(), kept: Instant::now(), last: None };
    let held = local::in_threads(arguments.threads, || {
        contest.hold(&arguments.out, &mut |progress| watch.then(progress))
    });
    let outcome = held.map_err(Failure::input)?.map_err(failure)?;
    watch.end();
    let answer = match arguments.format {
        Format::Text => outcome.text(),
        Format::Json => json_text(&outcome.json()),
    };
    print(&answer)?;
    if !arguments.quiet {
        let page = arguments.out.join("contest.html");
        note(format_args!("wrote {}; designs and all flights lie beside it", page.display()));
    }
    Ok(())
}

fn failure(error: TuneError) -> Failure {
    match error {
        TuneError::Output(_) | TuneError::History(_) => Failure::output(error),
        _ => Failure::input(error),
    }
}

/// Tells how far the contest is, and when states are to be saved.
struct Watch {
    telling: Telling,
    told: Instant,
    kept: Instant,
    last: Option<String>,
}

impl Watch {
    fn then(&mut self, progress: &Progress) -> Then {
        if self.telling != Telling::Nothing {
            let text = line(progress);
            if self.told.elapsed() >= self.telling.period() {
                self.told = Instant::now();
                tell(self.telling, &text);
            }
            self.last = Some(text);
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
