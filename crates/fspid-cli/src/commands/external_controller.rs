//! `fspid external-controller`: the process in which an external controller flies. Nobody calls it but `fspid` itself.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Args;

use crate::exit::Failure;
use fspid_external::{ProcessHost, serve};
use fspid_sim::external::set_host;

/// The name of this command.
const NAME: &str = "external-controller";

/// Answer samples with a controller of a shared library; `fspid` starts this for itself.
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// The library.
    library: PathBuf,
}

/// Lets this program start itself for external controllers.
pub(crate) fn host() {
    if let Ok(program) = std::env::current_exe() {
        set_host(ProcessHost::new(program, &[NAME]));
    }
}

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    match serve(&arguments.library) {
        ExitCode::SUCCESS => Ok(()),
        _ => {
            Err(Failure::input("this command is for `fspid` itself: a scenario names the library"))
        }
    }
}
