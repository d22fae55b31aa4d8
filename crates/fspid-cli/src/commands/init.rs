//! `fspid init`: a scenario to start from.

use clap::Args;

use crate::argument::{OutFile, written};
use crate::exit::{Failure, note, print};
use fspid_study::{file, output};

/// Write a commented scenario to start from.
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// Where to write it; standard output if left out. An existing file is not touched.
    #[arg(value_parser = written(&["toml"]))]
    file: Option<OutFile>,
}

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let Some(path) = &arguments.file else {
        return print(file::starter());
    };
    if path.exists() {
        let path = path.display();
        return Err(Failure::input(format_args!("{path} exists; choose another name")));
    }
    output::write(path, file::starter())?;
    let path = path.display();
    note(format_args!("wrote {path}; fly it with: fspid simulate {path} --report report.html"));
    Ok(())
}
