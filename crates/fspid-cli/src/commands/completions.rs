//! `fspid completions`: what a shell needs to complete words.

use clap::{Args, Command};
use clap_complete::Shell;
use serde_json::json;

use super::{Format, json_text};
use crate::exit::{Failure, print};

/// Print the script with which a shell completes commands, options and their values.
#[derive(Debug, Args)]
#[command(
    after_help = "Where it belongs:\n  bash        fspid completions bash > ~/.local/share/bash-completion/completions/fspid\n  zsh         fspid completions zsh > ~/.zfunc/_fspid, with `fpath+=~/.zfunc` before `compinit` in ~/.zshrc\n  fish        fspid completions fish > ~/.config/fish/completions/fspid.fish\n  powershell  fspid completions powershell >> $PROFILE"
)]
pub(crate) struct Arguments {
    /// The shell.
    #[arg(value_enum)]
    shell: Shell,
    /// How the script is told.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
}

pub(crate) fn run(arguments: &Arguments, mut program: Command) -> Result<(), Failure> {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut program, "fspid", &mut script);
    let script = String::from_utf8_lossy(&script);
    match arguments.format {
        Format::Text => print(&script),
        Format::Json => print(&json_text(&json!({
            "schema": 1, "shell": arguments.shell.to_string(), "script": script,
        }))),
    }
}
