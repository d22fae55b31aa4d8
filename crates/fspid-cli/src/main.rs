//! `fspid`: the workbench for fuzzy self-tuning PID flight controllers, on the command line.
//!
//! One file a command; each calls one function of a library and prints what it answers. Standard
//! output is data, standard error is for people.

mod argument;
mod commands;
mod exit;
mod line;
mod stream;
mod version;

use std::process::ExitCode;

use clap::{CommandFactory, Parser, Subcommand};

use commands::memory::Size;
use exit::Failure;

/// Design, simulate and judge fuzzy self-tuning PID controllers of an aircraft's pitch.
#[derive(Debug, Parser)]
#[command(
    name = "fspid",
    version,
    long_version = version::LONG,
    arg_required_else_help = true,
    after_help = "Exit codes: 0 done; 1 a requirement or claim check was not met; 2 the input is wrong; 4 the output could not be written; 130 interrupted, or beyond --max-memory.\nWith --format json standard output holds one JSON object: the answer, or {\"error\": {\"code\", \"message\", …}}.\n`-` is standard input or output wherever a file is named.\nStart with `fspid init pitch.toml`, then `fspid simulate pitch.toml --report pitch.html`;\nor with a fuzzy system: `fspid check tip.toml`, then `fspid infer tip.toml --input service=7 --input food=8`."
)]
struct Arguments {
    /// Memory that the program may take, such as 2GiB; flights that need more are not begun, and what grows beyond is stopped.
    /// By default flights may need what the machine has left.
    #[arg(long, global = true, value_name = "SIZE", help_heading = "Options of every command")]
    max_memory: Option<Size>,
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    Reproduce(commands::reproduce::Arguments),
    Init(commands::init::Arguments),
    Check(commands::check::Arguments),
    Simulate(commands::simulate::Arguments),
    Show(commands::show::Arguments),
    #[command(alias = "analyze")]
    Analyse(commands::analyse::Arguments),
    Certify(commands::certify::Arguments),
    Verify(commands::verify::Arguments),
    Campaign(commands::campaign::Arguments),
    Tune(commands::tune::Arguments),
    Contest(commands::contest::Arguments),
    Limit(commands::limit::Arguments),
    Adaptation(commands::adaptation::Arguments),
    Export(commands::export::Arguments),
    Fly(commands::fly::Arguments),
    Drive(commands::drive::Arguments),
    Infer(commands::infer::Arguments),
    Explain(commands::explain::Arguments),
    Convert(commands::convert::Arguments),
    Learn(commands::learn::Arguments),
    Surface(commands::surface::Arguments),
    Audit(commands::audit::Arguments),
    Aircraft(commands::aircraft::Arguments),
    Bench(commands::bench::Arguments),
    Schema(commands::schema::Arguments),
    Serve(commands::serve::Arguments),
    Completions(commands::completions::Arguments),
    Manual(commands::manual::Arguments),
    #[command(hide = true)]
    ExternalController(commands::external_controller::Arguments),
}

fn main() -> ExitCode {
    commands::interrupt::listen();
    let done = match line::parsed::<Arguments>() {
        Ok(arguments) => {
            commands::memory::allow(arguments.max_memory);
            run(arguments.command)
        }
        Err(end) => end.map_or(Ok(()), Err),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            failure.tell();
            ExitCode::from(failure.code())
        }
    }
}

fn run(command: Command) -> Result<(), Failure> {
    // Who has a server's token may save a scenario: no program that one names is started there.
    if !matches!(command, Command::Serve(_)) {
        let in_real_time =
            matches!(&command, Command::Simulate(arguments) if arguments.in_real_time());
        commands::external_controller::host(matches!(command, Command::Fly(_)), in_real_time);
    }
    match command {
        Command::Reproduce(arguments) => commands::reproduce::run(&arguments),
        Command::Init(arguments) => commands::init::run(&arguments),
        Command::Check(arguments) => commands::check::run(&arguments),
        Command::Simulate(arguments) => commands::simulate::run(&arguments),
        Command::Show(arguments) => commands::show::run(&arguments),
        Command::Analyse(arguments) => commands::analyse::run(&arguments),
        Command::Certify(arguments) => commands::certify::run(&arguments),
        Command::Verify(arguments) => commands::verify::run(&arguments),
        Command::Campaign(arguments) => commands::campaign::run(&arguments),
        Command::Tune(arguments) => commands::tune::run(&arguments),
        Command::Contest(arguments) => commands::contest::run(&arguments),
        Command::Limit(arguments) => commands::limit::run(&arguments),
        Command::Adaptation(arguments) => commands::adaptation::run(&arguments),
        Command::Export(arguments) => commands::export::run(&arguments),
        Command::Fly(arguments) => commands::fly::run(&arguments),
        Command::Drive(arguments) => commands::drive::run(&arguments),
        Command::Infer(arguments) => commands::infer::run(&arguments),
        Command::Explain(arguments) => commands::explain::run(&arguments),
        Command::Convert(arguments) => commands::convert::run(&arguments),
        Command::Learn(arguments) => commands::learn::run(&arguments),
        Command::Surface(arguments) => commands::surface::run(&arguments),
        Command::Audit(arguments) => commands::audit::run(&arguments),
        Command::Aircraft(arguments) => commands::aircraft::run(&arguments),
        Command::Bench(arguments) => commands::bench::run(&arguments),
        Command::Schema(arguments) => commands::schema::run(&arguments),
        Command::Serve(arguments) => commands::serve::run(&arguments),
        Command::Completions(arguments) => {
            commands::completions::run(&arguments, Arguments::command())
        }
        Command::Manual(arguments) => commands::manual::run(&arguments, Arguments::command()),
        Command::ExternalController(arguments) => commands::external_controller::run(&arguments),
    }
}
