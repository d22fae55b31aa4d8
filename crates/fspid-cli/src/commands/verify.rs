//! `fspid verify`: are the requirements met?

use std::path::Path;

use clap::Args;

use super::external_controller::Beside;
use super::{Format, json_text};
use crate::argument::{Folder, InFile, OutFile, written};
use crate::exit::{Failure, note, print, wrote};
use fspid_scenario::file;
use fspid_study::output;
use fspid_study::verify::interval::{Question as Interval, interval};
use fspid_study::verify::{Question, Verification, names_a_set, verify};
use serde_json::json;

/// Judge the requirements of a scenario: pass or fail with the number, the worst case, and a file that replays it.
///
/// Requirements are `[[requirement]]` entries of the scenario, ready sets, and files that several
/// scenarios share. A requirement that cannot be evaluated is not met, and says why; a value that
/// equals its limit meets it.
#[derive(Debug, Args)]
#[command(after_long_help = LONG_HELP, after_help = HELP)]
pub(crate) struct Arguments {
    /// The scenario file.
    file: InFile,
    /// Add a ready set, `mil-f-9490d`, `mil-f-8785c` or `ctms`, with its choices after a colon:
    /// `--set mil-f-8785c:level=2,category=C`; or change a value first, as in `fspid simulate`:
    /// `--set loop.sample_period_s=0.02`.
    #[arg(long = "set", value_name = "NAME | PATH=VALUE")]
    settings: Vec<String>,
    #[command(flatten)]
    beside: Beside,
    /// Add the requirements of a file with `[[requirement]]` entries.
    #[arg(long = "requirements", value_name = "FILE.toml")]
    requirement_files: Vec<InFile>,
    /// Tell between which values a number of the file keeps the requirements met, in place of judging the file as it is
    /// written: `--interval controller.FSPID.nominal.kp`, as `fspid check --paths` calls it. Once for each. What lies between
    /// the values that are looked at is not looked at.
    #[arg(long = "interval", value_name = "PATH", conflicts_with_all = ["requirement_files", "junit", "report", "replay", "libraries", "fmus"])]
    intervals: Vec<String>,
    /// How the answer is written.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
    /// Write the answer as JUnit XML too, for continuous integration.
    #[arg(value_parser = written(&["xml"]), long, value_name = "OUT.xml")]
    junit: Option<OutFile>,
    /// Write a report that opens offline in a browser: the verdict, a table for each controller, and what is to be known of
    /// the numbers. The flights are drawn by `fspid simulate --report`.
    #[arg(value_parser = written(&["html", "htm"]), long, value_name = "OUT.html")]
    report: Option<OutFile>,
    /// Write a scenario for each line into this folder that gives its number again.
    #[arg(long, value_name = "DIR", num_args = 0..=1, default_missing_value = "verify-replay")]
    replay: Option<Folder>,
}

const HELP: &str = "Examples:
  fspid verify pitch.toml --set ctms
  fspid verify pitch.toml --set mil-f-9490d --set mil-f-8785c:level=1,category=C --junit out.xml
  fspid verify pitch.toml --set ctms --report verify.html
  fspid verify pitch.toml --set ctms --replay again
  fspid simulate again/02-ctms-overshoot-FSPID.toml
  fspid verify pitch.toml --set ctms --interval controller.FSPID.nominal.kp
Exit codes: 0 all met; 1 one is not met, or a flight failed by itself; 2 the input is wrong; 4 the output could not be written.
More, with every measure and set: fspid verify --help";

const LONG_HELP: &str = "A requirement:
  [[requirement]]
  measure = \"phase_margin_deg\"       # see below
  least = 45.0                       # or most, or both
  controller = \"FSPID\"               # all controllers without this
  id = \"R-17\"                        # its name in answers
  clause = \"3.1.3.6\"                 # where it is from, as far as you like:
  source = \"our specification\"       #   source, note and
  confidence = \"own\"                 #   read, quoted, transcribed, disputed, recalled or own

  [[requirement]]
  set = \"mil-f-8785c\"                # a ready set in place of a measure
  level = 2

Measures of steps of the command, the worst step counts (only those of step_deg, if given):
  overshoot_pct rise_time_s settling_time_s final_error_pct final_error_deg
  recovery_time_s (needs within_deg; from the step, or from from_s)
Measures of the flight:
  rms_error_deg largest_error_deg (from_s, to_s)
  iae_deg_s itae_deg_s2 largest_command_deg command_rate_deg_s command_variation_deg
  elevator_rate_deg_s elevator_travel_deg saturated_pct
Measures of the flight of a nonlinear aircraft (from_s, to_s); a linear plant has none of them:
  largest_load_factor_g least_load_factor_g largest_bank_deg largest_alpha_deg alpha_margin_deg
  largest_airspeed_kt least_airspeed_kt airspeed_deviation_kt (true airspeed; from that of the trim)
  largest_pitch_deg least_pitch_deg
  altitude_loss_ft altitude_deviation_ft (from the start, or from target_ft or target_m)
  altitude_overshoot_ft (needs target_ft or target_m) largest_sink_ft_min final_sink_ft_min
Measures of the loop as sampled, at the gains it has at rest; the worst plant counts:
  stable gain_margin_db gain_margin_low_db gain_margin_high_db phase_margin_deg (from_hz, to_hz)
  delay_margin_s disk_margin sensitivity_peak gain_crossover_rad_s mode_damping (from_hz, to_hz)
The same at the worst gains that the supervisor produces over its range, held still (memoryless law):
  frozen_stable frozen_gain_margin_db frozen_phase_margin_deg frozen_disk_margin
The loop while its gains move, for all set-points and loads that the scenario commands, as certify proves it:
  certified
Measures of the aircraft without its controller, behind servo and dead time:
  short_period_damping cap_rad_s2_per_g phugoid_damping phugoid_doubling_s
  phugoid_oscillation_doubling_s phugoid_divergence_doubling_s equivalent_delay_s

Ready sets and their choices, the first of each if left out:
  mil-f-9490d  speed=normal|below|limit|beyond, air=smooth|turbulent, first_aeroelastic_mode_hz=HZ
  mil-f-8785c  level=1|2|3, category=B|A|C
  ctms         none
  mil-f-9490d-altitude  air=smooth|turbulent, target_ft=FT or target_m=M (that of the start)
  rvsm         air=smooth|turbulent, target_ft=FT or target_m=M (that of the start; an overshoot needs one)
  ac-25.1329   none

Examples:
  fspid verify pitch.toml --set ctms
  fspid verify pitch.toml --set mil-f-9490d --set mil-f-8785c:level=1,category=C --junit out.xml
  fspid verify pitch.toml --requirements ours.toml --format json
  fspid verify pitch.toml --set ctms --report verify.html
  fspid verify pitch.toml --set ctms --replay again
  fspid simulate again/02-ctms-overshoot-FSPID.toml
Exit codes: 0 all met; 1 one is not met, or a flight failed by itself; 2 the input is wrong; 4 the output could not be written.";

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    if !arguments.intervals.is_empty() {
        return tell_intervals(arguments);
    }
    let requirement_files: Vec<&Path> =
        arguments.requirement_files.iter().map(AsRef::as_ref).collect();
    let settings = arguments.beside.overrides(&arguments.settings)?;
    let question = Question {
        path: &arguments.file,
        settings: &settings,
        requirement_files: &requirement_files,
    };
    let verification = verify(&question).map_err(Failure::input)?;
    for warning in verification.warnings() {
        note(format_args!("warning: {warning}"));
    }
    let replays = match &arguments.replay {
        Some(folder) => Some(write_replays(&verification, folder)?),
        None => None,
    };
    let replays = replays.as_deref();
    if let Some(path) = &arguments.junit {
        output::write(path, verification.junit(replays))?;
    }
    if let Some(path) = &arguments.report {
        output::write(path, verification.page())?;
        wrote(path);
    }
    match arguments.format {
        Format::Text => print(&verification.text(replays))?,
        Format::Json => print(&json_text(&verification.json(replays)))?,
    }
    match (verification.unmet(), verification.failed_flights.len()) {
        (0, 0) => Ok(()),
        (unmet, flights) => Err(Failure::not_met_of(unmet, verification.judgements.len(), flights)),
    }
}

/// Between which values each number holds.
fn tell_intervals(arguments: &Arguments) -> Result<(), Failure> {
    if let Some(change) = arguments.settings.iter().find(|it| !names_a_set(it)) {
        return Err(Failure::input(format_args!(
            "--set {change}: --interval looks around the values of the file as it is written; allowed beside it are ready sets"
        )));
    }
    let text = file::read_text(&arguments.file).map_err(Failure::load)?;
    let (name, folder) = (arguments.file.display().to_string(), arguments.file.parent());
    let folder = Some(folder.unwrap_or(Path::new("")));
    let look = |path: &String| {
        let sets = &arguments.settings;
        interval(&Interval { text: &text, name: &name, folder, path, sets }).map_err(Failure::input)
    };
    let found = arguments.intervals.iter().map(look).collect::<Result<Vec<_>, _>>()?;
    match arguments.format {
        Format::Text => {
            let lines = found.iter().map(|it| format!("{}: {}\n", it.path, it.text()));
            print(&lines.collect::<String>())?;
        }
        Format::Json => {
            let list: Vec<_> = found.iter().map(|it| it.json()).collect();
            print(&json_text(&json!({ "schema": 1, "intervals": list })))?;
        }
    }
    match found.iter().filter(|it| !it.holds()).count() {
        0 => Ok(()),
        count => Err(Failure::not_met(format_args!(
            "{count} of {} numbers do not hold at their values",
            found.len()
        ))),
    }
}

/// Writes the replays; their paths, in the order of the lines.
fn write_replays(verification: &Verification, folder: &Path) -> Result<Vec<String>, Failure> {
    output::make_folder(folder)?;
    let replays = verification.replays(folder);
    let files: Vec<_> =
        replays.iter().map(|it| (folder.join(&it.name), it.text.as_bytes())).collect();
    output::write_all(&files)?;
    Ok(files.iter().map(|(path, _)| path.display().to_string()).collect())
}
