//! `fspid campaign rare`: how often a requirement is not met where counting is hopeless.

use clap::{Args, ValueEnum};

use super::super::progress::Telling;
use super::super::{Format, interrupt};
use super::progress::told_of_search;
use super::{failure, fits};
use crate::argument::{self, InFile, count, positive_share};
use crate::exit::{Failure, note};
use fspid_campaign::sample::Sampling;
use fspid_campaign::{Folder, Question, local, rare};
use fspid_scenario::count as counts;
use fspid_study::shell;

/// Say how rarely a requirement fails: once in a million flights, or in a thousand million, without flying them all.
#[derive(Debug, Args)]
#[command(after_help = HELP)]
pub(super) struct Arguments {
    /// The scenario file.
    scenario: InFile,
    /// Id of the requirement whose failure is looked for; flights that diverge, hit the ground or fail by themselves fail it.
    #[arg(long, value_name = "REQUIREMENT")]
    fails: String,
    /// The controller; the one that the requirement names, or the first.
    #[arg(long, value_name = "NAME")]
    controller: Option<String>,
    /// How failures are looked for.
    #[arg(long, value_enum, default_value_t = Way::Subset)]
    method: Way,
    /// About how many flights may be flown; more make the interval narrower.
    #[arg(long, default_value_t = 50_000, value_parser = count::<u64>(&counts::RARE_FLIGHTS))]
    flights: u64,
    /// Probability a flight that is required; the upper end of the interval must not be above.
    #[arg(long, value_name = "PROBABILITY", value_parser = positive_share)]
    most: Option<f64>,
    /// Seed of everything that is drawn.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Set a value before anything is drawn, e.g. `--set loop.duration_s=30`.
    #[arg(long = "set", value_name = "PATH=VALUE")]
    overrides: Vec<String>,
    /// Folder that keeps what was flown, the answer and a figure of the levels; the same command goes on there.
    #[arg(long, value_name = "DIR")]
    out: Option<argument::Folder>,
    /// How many threads; 0 for as many as the machine has. The result is the same.
    #[arg(long, default_value_t = 0, value_parser = count::<usize>(&counts::THREADS))]
    threads: usize,
    /// Say nothing while flying.
    #[arg(long)]
    quiet: bool,
    /// How the answer is written.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
}

const HELP: &str = "Methods:
  subset      climbs level by level to flights that are nearer to the failure; ten teams on their own say how
              sure the number is
  importance  draws flights where failures are and counts each by how much rarer it is; for few dispersions
              and one region of failures, there far surer
  both        half of the flights each, and whether they agree

Examples, after `fspid init --template campaign drawn.toml`:
  fspid campaign rare drawn.toml --fails overshoot_pct
  fspid campaign rare drawn.toml --fails overshoot_pct --method both --most 1e-6
  fspid campaign rare drawn.toml --fails overshoot_pct --flights 1000000 --out rare  # goes on
Exit codes: 0 answered, and below --most if that is given; 1 not shown to be below --most;
2 the input is wrong; 4 the output could not be written.";

/// How failures are looked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Way {
    /// Subset simulation.
    Subset,
    /// Importance sampling by cross-entropy.
    Importance,
    /// Both, each with half of the flights.
    Both,
}

impl From<Way> for rare::Method {
    fn from(way: Way) -> Self {
        match way {
            Way::Subset => Self::Subset,
            Way::Importance => Self::Importance,
            Way::Both => Self::Both,
        }
    }
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let question = Question {
        scenario: &arguments.scenario,
        overrides: &arguments.overrides,
        runs: 1,
        seed: arguments.seed,
        sampling: Sampling::Random,
        shards: fspid_campaign::Shards::ForThreads,
    };
    let here = Folder::new(std::path::Path::new("."));
    let campaign = fspid_campaign::plan(&question, &here).map_err(failure)?;
    for warning in &campaign.template().study().warnings {
        note(format_args!("warning: {warning}"));
    }
    let asked = rare::Question {
        fails: arguments.fails.clone(),
        controller: arguments.controller.clone(),
        method: arguments.method.into(),
        flights: arguments.flights,
        seed: arguments.seed,
        most: arguments.most,
    };
    // What is asked in vain is told before anything begins.
    let nothing = fspid_campaign::Progress::default();
    rare::Target::of(&campaign, &nothing, &asked.fails, asked.controller.as_deref())
        .map_err(failure)?;
    fits(&campaign, arguments.threads, arguments.flights)?;
    let folder = arguments.out.as_ref().map(|out| Folder::new(out));
    interrupt::ends_with(match &folder {
        Some(folder) => format!(
            "interrupted; what is flown stays in {}, and the same command goes on there",
            shell::word(&folder.path().display().to_string())
        ),
        None => "interrupted; without --out nothing is kept, so that it begins anew".to_owned(),
    });
    let telling = if arguments.quiet { Telling::Nothing } else { Telling::for_standard_error() };
    let answer = told_of_search(telling, arguments.flights, |progress| {
        local::in_threads(arguments.threads, || {
            rare::rare(&campaign, &asked, folder.as_ref(), progress)
        })?
    });
    let answer = answer.map_err(failure)?;
    arguments.format.print(|| answer.text(), || answer.json())?;
    match answer.is_allowed() {
        Some(false) => Err(Failure::not_met("not shown to be as rare as --most asks")),
        _ => Ok(()),
    }
}
