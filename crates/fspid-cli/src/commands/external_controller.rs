//! `fspid external-controller`: the process in which an external controller flies, which nobody calls but `fspid`
//! itself; and the option that lets one fly beside those of a scenario.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Args;

use crate::argument::NamedFile;
use crate::exit::{Failure, note};
use fspid_external::{ProcessHost, SimulatorHost, serve};
use fspid_scenario::file::{self, Study, unread_in_words};
use fspid_scenario::toml_text::quoted;
use fspid_sim::Scenario;
use fspid_sim::external::set_host;
use fspid_sim::external_plant::set_plant_host;

/// The name of this command.
const NAME: &str = "external-controller";
/// Bytes that controllers print beside a stream of commands: with what `fly` tells it fits into every pipe.
const MOST_PRINTED: u64 = 2048;

/// Answer samples with an external controller; `fspid` starts this for itself.
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// `library` or `fmu`.
    kind: String,
    /// Time from sample to sample, s.
    dt_s: f64,
    /// The library, or the folder of the FMU.
    path: PathBuf,
    /// Names of the FMU's variables, such as `setpoint_rad=theta_ref`.
    renamed: Vec<String>,
}

/// Controllers that fly beside those of the scenario.
#[derive(Debug, Args)]
pub(crate) struct Beside {
    /// Fly a shared library as one more controller, called as its file is; it runs as you do. Once for each.
    #[arg(long = "library", value_name = "FILE.so")]
    libraries: Vec<NamedFile>,
    /// Fly an FMU for co-simulation as one more controller, called as its file is. Once for each.
    #[arg(long = "fmu", value_name = "FILE.fmu")]
    fmus: Vec<NamedFile>,
    /// How the FMU calls an input: `--input setpoint_rad=theta_ref`, or `setpoint_deg` for one in degrees;
    /// `measurement_rad` and `rate_rad_s` alike. Once for each.
    #[arg(long = "input", value_name = "NAME=VARIABLE", value_parser = named, requires = "fmus")]
    inputs: Vec<Named>,
    /// How the FMU calls its command: `--output command_rad=delta_e`, or `command_rad=-delta_e` for one that turns the
    /// nose down where it is positive.
    #[arg(long = "output", value_name = "NAME=VARIABLE", value_parser = named, requires = "fmus")]
    outputs: Vec<Named>,
}

/// A variable of an FMU by our name and its own.
#[derive(Clone, Debug)]
struct Named {
    ours: String,
    theirs: String,
}

fn named(text: &str) -> Result<Named, String> {
    let allowed = || "allowed is NAME=VARIABLE, such as setpoint_rad=theta_ref".to_owned();
    let (ours, theirs) = text.split_once('=').ok_or_else(allowed)?;
    Ok(Named { ours: ours.to_owned(), theirs: theirs.to_owned() })
}

/// The names of a scenario's table, behind the key of an FMU.
fn renamed(key: &str, names: &[Named]) -> String {
    if names.is_empty() {
        return String::new();
    }
    let pair = |it: &Named| format!("{:?} = {:?}", it.ours, it.theirs);
    format!(", {key} = {{ {} }}", names.iter().map(pair).collect::<Vec<_>>().join(", "))
}

impl Beside {
    /// A scenario with its changes and these controllers; what is to be said of it is said.
    pub(crate) fn study(&self, file: &Path, given: &[String]) -> Result<Study, Failure> {
        let study = file::load(file, &self.overrides(given)?).map_err(Failure::load)?;
        for warning in &study.warnings {
            note(format_args!("warning: {warning}"));
        }
        Ok(study)
    }

    /// The changes of a scenario behind those that are given: an entry of its controllers for each.
    pub(crate) fn overrides(&self, given: &[String]) -> Result<Vec<String>, Failure> {
        let is_named = !(self.inputs.is_empty() && self.outputs.is_empty());
        if is_named && self.fmus.len() > 1 {
            let way = "a scenario names those of each: inputs = { setpoint_rad = \"theta_ref\" }";
            let reason = format!("--input and --output go with one --fmu; {way}");
            return Err(Failure::input(reason));
        }
        let names = renamed("inputs", &self.inputs) + &renamed("outputs", &self.outputs);
        let added = self.libraries.iter().map(|file| entry("library", file, ""));
        let added = added.chain(self.fmus.iter().map(|file| entry("fmu", file, &names)));
        given.iter().cloned().map(Ok).chain(added).collect()
    }

    /// The name of the only one.
    pub(crate) fn only(&self) -> Option<String> {
        let mut all = self.libraries.iter().chain(&self.fmus);
        let first = all.next().filter(|_| all.next().is_none())?;
        // Called as the file is that a link leads to.
        let path = first.canonicalize().ok()?;
        Some(path.file_name()?.to_str()?.to_owned())
    }

    /// True if there is one.
    pub(crate) fn is_given(&self) -> bool {
        !self.libraries.is_empty() || !self.fmus.is_empty()
    }
}

/// Refuses a controller without equations where only those can be asked that have some, or leaves it out and says so.
pub(crate) fn leave_out(scenario: &Scenario, asked: Option<&str>) -> Result<(), Failure> {
    const WAY: &str = "an external controller has no equations here; simulate, verify, analyse --fly, campaign, contest and `fly` fly it";
    let externals = || scenario.externals.iter().map(|named| named.name.as_str());
    let is_asked = |name: &&str| asked == Some(*name) || scenario.controllers.is_empty();
    if let Some(name) = externals().find(is_asked) {
        return Err(Failure::input(format_args!("controller `{name}`: {WAY}")));
    }
    if asked.is_none() {
        externals().for_each(|name| note(format_args!("controller `{name}` is left out: {WAY}")));
    }
    Ok(())
}

fn entry(key: &str, file: &Path, more: &str) -> Result<String, Failure> {
    let refused = |reason: &dyn std::fmt::Display| {
        Failure::input(format_args!("{}: cannot be read: {reason}", file.display()))
    };
    let path = file.canonicalize().map_err(|error| refused(&unread_in_words(&error)))?;
    let name = path.file_name().unwrap_or_default();
    match (name.to_str(), path.to_str()) {
        (Some(name), Some(path)) => {
            let (name, path) = (quoted(name), quoted(path));
            Ok(format!(
                "controller[]={{ name = {name}, kind = \"external\", {key} = {path}{more} }}"
            ))
        }
        _ => Err(refused(&"its path is no text")),
    }
}

/// The program that runs, whatever lies at its path by now: Linux keeps it there, also once it is removed.
const RUNNING: &str = "/proc/self/exe";

/// Names the Python that flies other simulators; without it, the `python3` of the path.
const PYTHON: &str = "FSPID_PYTHON";

/// Lets this program start itself for external controllers and FMUs, and Python for JSBSim, in real time if asked. Of what
/// they print beside a stream of commands as much is passed on as a client need not read.
pub(crate) fn host(beside_a_stream: bool, in_real_time: bool) {
    let running = Some(PathBuf::from(RUNNING)).filter(|path| path.exists());
    let Some(program) = running.or_else(|| std::env::current_exe().ok()) else { return };
    let host = ProcessHost::new(program, &[NAME]).telling(|words| note(words));
    let python = std::env::var_os(PYTHON).filter(|name| !name.is_empty());
    let python = python.unwrap_or_else(|| "python3".into());
    let simulators = SimulatorHost::new(python.into()).flying_fmus(host.clone());
    set_plant_host(match in_real_time {
        true => simulators.in_real_time(|words| note(words)),
        false => simulators,
    });
    let host = if in_real_time { host.in_real_time(|words| note(words)) } else { host };
    set_host(match beside_a_stream {
        true => host.printing_at_most(MOST_PRINTED),
        false => host,
    });
}

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    match serve(&arguments.kind, &arguments.path, arguments.dt_s, &arguments.renamed) {
        ExitCode::SUCCESS => Ok(()),
        _ => {
            Err(Failure::input("this command is for `fspid` itself: a scenario names the library"))
        }
    }
}
