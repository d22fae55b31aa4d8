//! `fspid external-controller`: the process in which an external controller flies, which nobody calls but `fspid`
//! itself; and the option that lets one fly beside those of a scenario.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Args;

use crate::argument::NamedFile;
use crate::exit::{Failure, note};
use fspid_external::{ProcessHost, serve};
use fspid_scenario::file::unread_in_words;
use fspid_sim::Scenario;
use fspid_sim::external::set_host;

/// The name of this command.
const NAME: &str = "external-controller";

/// Answer samples with an external controller; `fspid` starts this for itself.
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// `library` or `fmu`.
    kind: String,
    /// Time from sample to sample, s.
    dt_s: f64,
    /// The library, or the folder of the FMU.
    path: PathBuf,
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
}

impl Beside {
    /// The changes of a scenario behind those that are given: an entry of its controllers for each.
    pub(crate) fn overrides(&self, given: &[String]) -> Result<Vec<String>, Failure> {
        let added = self.libraries.iter().map(|file| entry("library", file));
        let added = added.chain(self.fmus.iter().map(|file| entry("fmu", file)));
        given.iter().cloned().map(Ok).chain(added).collect()
    }

    /// True if there is one.
    pub(crate) fn is_given(&self) -> bool {
        !self.libraries.is_empty() || !self.fmus.is_empty()
    }
}

/// Refuses a controller without equations where only those can be asked that have some, or leaves it out and says so.
pub(crate) fn leave_out(scenario: &Scenario, asked: Option<&str>) -> Result<(), Failure> {
    const WAY: &str = "an external controller has no equations here; simulate, verify, analyse --fly, campaign and contest fly it";
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

fn entry(key: &str, file: &Path) -> Result<String, Failure> {
    let refused = |reason: &dyn std::fmt::Display| {
        Failure::input(format_args!("{}: cannot be read: {reason}", file.display()))
    };
    let path = file.canonicalize().map_err(|error| refused(&unread_in_words(&error)))?;
    let name = path.file_name().unwrap_or_default();
    match (name.to_str(), path.to_str()) {
        (Some(name), Some(path)) => {
            let (name, path) = (toml_text(name), toml_text(path));
            Ok(format!("controller[]={{ name = {name}, kind = \"external\", {key} = {path} }}"))
        }
        _ => Err(refused(&"its path is no text")),
    }
}

/// A text as TOML writes it: as JSON does, but for one character.
fn toml_text(text: &str) -> String {
    serde_json::Value::from(text).to_string().replace('\u{7f}', "\\u007f")
}

/// The program that runs, whatever lies at its path by now: Linux keeps it there, also once it is removed.
const RUNNING: &str = "/proc/self/exe";

/// Lets this program start itself for external controllers.
pub(crate) fn host() {
    let running = Some(PathBuf::from(RUNNING)).filter(|path| path.exists());
    if let Some(program) = running.or_else(|| std::env::current_exe().ok()) {
        set_host(ProcessHost::new(program, &[NAME]).telling(|words| note(words)));
    }
}

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    match serve(&arguments.kind, &arguments.path, arguments.dt_s) {
        ExitCode::SUCCESS => Ok(()),
        _ => {
            Err(Failure::input("this command is for `fspid` itself: a scenario names the library"))
        }
    }
}
