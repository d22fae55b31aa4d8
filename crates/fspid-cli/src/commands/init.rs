//! `fspid init`: a file to start from.

use clap::Args;
use serde_json::{Value, json};

use super::Format;
use crate::argument::{OutFile, is_standard, written};
use crate::exit::{Failure, note};
use fspid_scenario::file::{self, STARTERS, Starter};
use fspid_study::{output, shell};

/// Write a commented file to start from: a scenario, or with --template something else.
#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  fspid init pitch.toml\n  fspid init --list\n  fspid init --template tuning my.toml; fspid tune my.toml --out design.toml"
)]
pub(crate) struct Arguments {
    /// Where to write it; standard output if left out. An existing file is not touched.
    #[arg(value_parser = written(&["toml"]))]
    file: Option<OutFile>,
    /// What to start from; `--list` tells them all.
    #[arg(long, value_name = "NAME", default_value = STARTERS[0].name)]
    template: String,
    /// List what there is to start from.
    #[arg(long, conflicts_with_all = ["file", "template"])]
    list: bool,
    /// How the answer is written: what was written and what to do with it.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
}

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    if arguments.list {
        let json = || json!({ "schema": 1, "templates": STARTERS.map(|it| row_json(&it, None)) });
        return arguments.format.print(list, json);
    }
    let name = arguments.template.as_str();
    let starter = file::starter_named(name).ok_or_else(|| {
        let known = file::known_words(name, &STARTERS.map(|starter| starter.name));
        Failure::input(format_args!("there is no template `{name}`{known}"))
    })?;
    if let Some(path) = arguments.file.as_ref().filter(|path| is_standard(path)) {
        return Ok(output::write(path, starter.text)?);
    }
    let Some(path) = &arguments.file else {
        return arguments.format.print(|| starter.text.to_owned(), || row_json(starter, None));
    };
    if path.exists() {
        let path = path.display();
        return Err(Failure::input(format_args!("{path} exists; choose another name")));
    }
    output::write_new(path, starter.text)?;
    let shown = path.display().to_string();
    let command = starter.command.replace("FILE", &shell::word(&shown));
    match arguments.format {
        Format::Text => note(format_args!("wrote {shown}; next: {command}")),
        Format::Json => arguments.format.print(String::new, || row_json(starter, Some(&shown)))?,
    }
    Ok(())
}

fn list() -> String {
    let row = |it: &Starter| format!("{:<24}{}\n", it.name, it.about);
    STARTERS.iter().map(row).collect()
}

fn row_json(starter: &Starter, file: Option<&str>) -> Value {
    let mut row = json!({
        "schema": 1, "template": starter.name, "about": starter.about, "next": starter.command,
    });
    match file {
        Some(file) => row["file"] = json!(file),
        None => row["text"] = json!(starter.text),
    }
    row
}
