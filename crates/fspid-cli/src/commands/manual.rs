//! `fspid manual`: a page for `man` of the program and of each command.

use clap::{Args, Command};
use clap_mangen::Man;
use serde_json::json;

use super::{Format, json_text};
use crate::argument::Folder;
use crate::exit::{Failure, print};
use fspid_study::output::{make_folder, write_all};

/// Write the manual: a page for `man` of the program and of each command, with what `--help` says.
#[derive(Debug, Args)]
#[command(
    after_help = "Example:\n  fspid manual --out ~/.local/share/man/man1 && man fspid-simulate"
)]
pub(crate) struct Arguments {
    /// The folder to write into; pages of the same names are written anew.
    #[arg(long, value_name = "DIR")]
    out: Folder,
    /// How it is told what was written.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
}

pub(crate) fn run(arguments: &Arguments, mut program: Command) -> Result<(), Failure> {
    program.build();
    let mut pages = Vec::new();
    collect(&program, &mut pages).map_err(|error| Failure::output(&error))?;
    make_folder(&arguments.out)?;
    let files: Vec<_> =
        pages.iter().map(|(name, page)| (arguments.out.join(name), page.as_slice())).collect();
    write_all(&files)?;
    let paths = files.iter().map(|(path, _)| path.display().to_string());
    match arguments.format {
        Format::Text => print(&paths.map(|it| it + "\n").collect::<String>()),
        Format::Json => print(&json_text(&json!({
            "schema": 1, "folder": arguments.out.display().to_string(), "files": paths.collect::<Vec<_>>(),
        }))),
    }
}

/// The page of a command, and those of the commands below it: their names and texts.
fn collect(command: &Command, pages: &mut Vec<(String, Vec<u8>)>) -> std::io::Result<()> {
    let name = command.get_display_name().unwrap_or_else(|| command.get_name()).to_owned();
    let mut page = Vec::new();
    // No date: the same program has the same pages.
    Man::new(command.clone())
        .manual("fspid")
        .source(concat!("fspid ", env!("CARGO_PKG_VERSION")))
        .render(&mut page)?;
    pages.push((format!("{name}.1"), page));
    let below = command.get_subcommands().filter(|it| !it.is_hide_set() && it.get_name() != "help");
    below.into_iter().try_for_each(|it| collect(it, pages))
}
