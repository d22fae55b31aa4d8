//! `fspid simulate`: fly a scenario.

use clap::Args;

use super::external_controller::Beside;
use super::progress::{Telling, at_work};
use super::{Format, interrupt, json_text, limit, memory};
use crate::argument::{InFile, OutFile, written};
use crate::exit::{Failure, note, print};
use fspid_scenario::file::Study;
use fspid_sim::{NamedExternal, Scenario};
use fspid_study::memory::Needed;
use fspid_study::simulation::Simulation;
use fspid_study::{output, report};
use fspid_tune::limit::{Answer, Ladder, Measure, Options, Travel};

/// Fly a scenario: metrics and verdict of each controller, traces and a report if asked for.
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// The scenario file.
    file: InFile,
    /// Set a value before flying, e.g. `--set loop.sample_period_s=0.02`.
    #[arg(long = "set", value_name = "PATH=VALUE")]
    overrides: Vec<String>,
    #[command(flatten)]
    beside: Beside,
    /// Let each sample take as long as it is, for a scenario with `[simulator]`, ArduPilot or PX4; each late one is told.
    #[arg(long)]
    real_time: bool,
    /// Tell as well how much of what is possible at its elevator travel each controller reaches, as `fspid limit` does.
    #[arg(long)]
    limit: bool,
    /// How the answer is written.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
    /// Write the traces of all controllers to this CSV file.
    #[arg(value_parser = written(&["csv"]), long, value_name = "OUT.csv")]
    trace: Option<OutFile>,
    /// Write a report that opens offline in a browser.
    #[arg(value_parser = written(&["html", "htm"]), long, value_name = "OUT.html")]
    report: Option<OutFile>,
}

impl Arguments {
    /// True where a flight shall take as long as it is.
    pub(crate) fn in_real_time(&self) -> bool {
        self.real_time
    }
}

/// True where somebody else flies with us, who may have a clock or a person beside it.
fn has_another_clock(scenario: &Scenario) -> bool {
    let is_stack = |named: &NamedExternal| named.external.source.flight_stack().is_some();
    scenario.plant.external().is_some() || scenario.externals.iter().any(is_stack)
}

/// The limit at the travel of every controller.
fn near_limit(study: &Study) -> Result<Answer, Failure> {
    let options = Options {
        measure: Measure::Iae,
        travel: Travel::Elevator,
        ladder: Ladder::None,
        anticipate: false,
        causal: false,
    };
    let work = |told: &dyn Fn(&str)| Answer::of(study, options, told, interrupt::asked);
    limit::told(Telling::for_standard_error(), work).map_err(limit::failure)
}

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let study = arguments.beside.study(&arguments.file, &arguments.overrides)?;
    if arguments.real_time && !has_another_clock(&study.scenario) {
        return Err(Failure::input(
            "--real-time goes with a scenario that has [simulator], ArduPilot or PX4; `fspid show` shows the trace of any flight at its pace",
        ));
    }
    let is_written = arguments.trace.is_some() || arguments.report.is_some();
    memory::asked(Needed::for_traces(&study.scenario, is_written))?;
    let simulation = at_work("flying", || Simulation::of(&study)).map_err(Failure::input)?;
    if let Some(path) = &arguments.trace {
        simulation.column_names().changed().for_each(note);
        output::write(path, simulation.csv())?;
    }
    let limit = arguments.limit.then(|| near_limit(&study)).transpose()?;
    if let Some(path) = &arguments.report {
        let possible = limit.as_ref().map(|it| it.chapter().section("possible"));
        output::write(path, report::of_simulation_with(&study, &simulation, possible))?;
    }
    match arguments.format {
        Format::Text => {
            let near = limit.as_ref().map_or(String::new(), Answer::controllers_text);
            print(&(simulation.text() + &near))?;
        }
        Format::Json => {
            let mut answer = simulation.json();
            if let Some(limit) = &limit {
                answer["limit"] = limit.json();
            }
            print(&json_text(&answer))?;
        }
    }
    let unmet = simulation.judgements.iter().filter(|judgement| !judgement.met).count();
    match (unmet, simulation.failed_flights().len()) {
        (0, 0) => Ok(()),
        (unmet, flights) => Err(Failure::not_met_of(unmet, simulation.judgements.len(), flights)),
    }
}
