//! The command line: what holds for the arguments of every command.

use std::any::TypeId;
use std::error::Error as _;
use std::ffi::OsString;
use std::num::{IntErrorKind, ParseFloatError, ParseIntError};

use clap::builder::StyledStr;
use clap::error::{ContextKind, ContextValue, Error, ErrorKind};
use clap::{Arg, ArgMatches, Command, Parser};
use fspid_scenario::apart::{self, Clash, Named};

use crate::argument::{Drawings, InFile, NamedFile, OutFile, STANDARD, Source};
use crate::exit::{Failure, Output};
use crate::stream::{self, Stream};
use fspid_scenario::count::{Count, of_option};

/// The arguments of the program; `None` in place of a failure where only help was asked for.
pub(crate) fn parsed<P: Parser>() -> Result<P, Option<Failure>> {
    let words: Vec<OsString> = std::env::args_os().collect();
    // Of a line that is not understood no word is known to be no input.
    arguments(words.clone()).inspect_err(|_| stream::keep_out_of(&words))
}

fn arguments<P: Parser>(mut words: Vec<OsString>) -> Result<P, Option<Failure>> {
    // `fspid help --help` asks for help, and that is what `help` gives.
    if words.iter().skip(1).take(2).any(|word| word == "help") {
        words.retain(|word| word != "--help" && word != "-h");
    }
    // Told before anything is read, so that what is wrong with the line itself can be JSON too.
    let as_json = words.windows(2).any(|pair| pair[0] == "--format" && pair[1] == "json")
        || words.iter().any(|word| word == "--format=json");
    let mut output = Output { as_json, is_file: false };
    output.set();
    let command = prepared(P::command());
    let parsed = command.clone().try_get_matches_from(words.clone());
    let matches = parsed.map_err(|error| failure(error, &words))?;
    let is_read = |it: &Arg| is::<InFile>(it) || is::<Source>(it);
    let read = standard_files(&command, &matches, &is_read);
    if read.len() > 1 {
        return Err(Some(Failure::input(format_args!(
            "standard input is one file, and {} - ask for it",
            read.join(" - and ")
        ))));
    }
    let is_written = |it: &Arg| is::<OutFile>(it) || is::<Drawings>(it);
    let files = standard_files(&command, &matches, &is_written);
    match (files.as_slice(), as_json) {
        ([], _) => {}
        ([one], true) => {
            return Err(Some(Failure::input(format_args!(
                "standard output holds one thing: {one} -, or the answer as JSON"
            ))));
        }
        ([_], false) => output.is_file = true,
        (several, _) => {
            return Err(Some(Failure::input(format_args!(
                "standard output holds one thing, and {} - ask for it",
                several.join(" - and ")
            ))));
        }
    }
    output.set();
    let outputs = outputs_apart(&command, &matches);
    let outputs = outputs.map_err(|clash| Some(Failure::input(clash)))?;
    // A server saves what it has read: that is what it is for.
    if matches.subcommand_name() != Some("serve") {
        apart::declare(outputs);
    }
    P::from_arg_matches(&matches).map_err(|error| failure(error, &words))
}

/// The files that the command is asked to write. Refuses those that are the file of an input or of each other, before
/// anything is read or written.
fn outputs_apart(command: &Command, matches: &ArgMatches) -> Result<Vec<Named>, Clash> {
    let is_read = |it: &Arg| is::<InFile>(it) || is::<NamedFile>(it) || is::<Source>(it);
    let is_written = |it: &Arg| is::<OutFile>(it) || is::<Drawings>(it);
    let mut outputs = named_files(command, matches, &is_written);
    outputs.extend(Stream::Output.named());
    let inputs = named_files(command, matches, &is_read);
    // Standard error and output may be one file: a log.
    let errors: Vec<Named> = Stream::Error.named().into_iter().collect();
    match apart::clash(&inputs, &outputs).or_else(|| apart::clash(&inputs, &errors)) {
        Some(clash) => Err(clash),
        None => Ok(outputs),
    }
}

/// The files that arguments of a kind name; a drawing's folder is none.
fn named_files(
    command: &Command,
    matches: &ArgMatches,
    is_kind: &dyn Fn(&Arg) -> bool,
) -> Vec<Named> {
    let files = |argument: &Arg| {
        let values = matches.get_raw(argument.get_id().as_str()).into_iter().flatten();
        let name = name(argument);
        values.filter_map(|value| Named::new(name.clone(), value.as_ref())).collect::<Vec<_>>()
    };
    if let Some((name, matches)) = matches.subcommand() {
        let below = command.find_subcommand(name);
        return below.map_or(Vec::new(), |command| named_files(command, matches, is_kind));
    }
    command.get_arguments().filter(|it| is_kind(it)).flat_map(files).collect()
}

/// The command with what every argument has: numbers may be negative, so that the mistake is told in words; and files
/// say what `-` is, counts what is allowed.
pub(crate) fn prepared(command: Command) -> Command {
    below(command, "")
}

/// The same for what stands below a path, such as `campaign `.
fn below(command: Command, path: &str) -> Command {
    let command = command.mut_args(|it| argument(it, path.trim_end()));
    command.mut_subcommands(|it| {
        let path = format!("{path}{} ", it.get_name());
        below(it, &path)
    })
}

/// The count that an argument of a command asks for.
fn count(argument: &Arg, command: &str) -> Option<Count> {
    argument.get_long().and_then(|long| of_option(command, long))
}

fn argument(argument: Arg, command: &str) -> Arg {
    if !argument.get_action().takes_values() {
        return argument;
    }
    let argument = match argument.is_allow_hyphen_values_set() {
        true => argument,
        false => argument.allow_negative_numbers(true),
    };
    let more = match (standard(&argument), count(&argument, command)) {
        (Some(what), _) => format!("`-` is {what}"),
        (None, Some(Count { least, most, .. })) => format!("from {least} to {most}"),
        (None, None) => return argument,
    };
    let with = |help: &StyledStr| {
        let help = help.to_string();
        match help.contains("`-`") {
            true => help,
            false => format!("{}; {more}", help.trim_end_matches('.')),
        }
    };
    let (short, long) = (argument.get_help().map(with), argument.get_long_help().map(with));
    let argument = short.into_iter().fold(argument, Arg::help);
    long.into_iter().fold(argument, Arg::long_help)
}

/// What `-` stands for in an argument; `None` for one that names no file.
pub(crate) fn standard(argument: &Arg) -> Option<&'static str> {
    match () {
        () if is::<InFile>(argument) || is::<Source>(argument) => Some("standard input"),
        () if is::<OutFile>(argument) || is::<Drawings>(argument) => Some("standard output"),
        () => None,
    }
}

pub(crate) fn is<T: 'static>(argument: &Arg) -> bool {
    argument.get_value_parser().type_id() == TypeId::of::<T>()
}

/// The arguments of a kind that are given as `-`; one that is given so twice stands twice.
fn standard_files(
    command: &Command,
    matches: &ArgMatches,
    is_kind: &dyn Fn(&Arg) -> bool,
) -> Vec<String> {
    if let Some((name, matches)) = matches.subcommand() {
        let below = command.find_subcommand(name);
        return below.map_or(Vec::new(), |command| standard_files(command, matches, is_kind));
    }
    let standard = |argument: &Arg| {
        let values = matches.get_raw(argument.get_id().as_str()).into_iter().flatten();
        let name = name(argument);
        values.filter(|value| *value == STANDARD).map(move |_| name.clone()).collect::<Vec<_>>()
    };
    command.get_arguments().filter(|it| is_kind(it)).flat_map(standard).collect()
}

/// An argument as it is written.
fn name(argument: &Arg) -> String {
    match argument.get_long() {
        Some(long) => format!("--{long}"),
        None => argument.to_string(),
    }
}

/// What is wrong with the line, or that only help was asked for.
fn failure(error: Error, words: &[OsString]) -> Option<Failure> {
    // Help and version are no mistakes; clap knows which stream is right.
    if !error.use_stderr() {
        return match error.print() {
            Ok(()) => None,
            Err(error) => Failure::of_writing(&error).err(),
        };
    }
    if let Some(told) = wrong_value(&error) {
        return Some(Failure::input(told));
    }
    if let Some(told) = parted_set(&error, words) {
        return Some(Failure::usage(told));
    }
    if error.kind() == ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand {
        return Some(Failure::plain(error.render()));
    }
    let told = without_trailing_tip(&error.render().to_string());
    let told = told.strip_prefix("error: ").unwrap_or(&told).to_owned();
    Some(Failure::usage(told))
}

/// What is told of `--set PATH VALUE`, of which the value was taken for another argument.
fn parted_set(error: &Error, words: &[OsString]) -> Option<String> {
    let Some(ContextValue::String(unexpected)) = error.get(ContextKind::InvalidArg) else {
        return None;
    };
    if error.kind() != ErrorKind::UnknownArgument {
        return None;
    }
    let words: Vec<_> = words.iter().map(|word| word.to_string_lossy()).collect();
    words.windows(3).find_map(|three| {
        let [option, path, value] = [&three[0], &three[1], &three[2]];
        let is_value = value == unexpected || value.parse::<f64>().is_ok();
        (option == "--set" && !path.contains('=') && is_value)
            .then(|| format!("--set takes one word: {path}={value}"))
    })
}

/// Without the advice to write a mistyped option behind `--`: no file of this program is called `--controller`.
fn without_trailing_tip(told: &str) -> String {
    let is_tip = |part: &&str| {
        part.starts_with("  tip: to pass '") && part.contains(" as a value, use '-- ")
    };
    told.split("\n\n").filter(|part| !is_tip(part)).collect::<Vec<_>>().join("\n\n")
}

/// "--runs is -5; allowed is a whole number, 0 or more".
fn wrong_value(error: &Error) -> Option<String> {
    if error.kind() != ErrorKind::ValueValidation {
        return None;
    }
    let text = |kind| match error.get(kind) {
        Some(ContextValue::String(text)) => Some(text.as_str()),
        _ => None,
    };
    let argument = text(ContextKind::InvalidArg)?;
    let value = text(ContextKind::InvalidValue).unwrap_or_default();
    let argument = match argument.strip_prefix("--") {
        Some(_) => argument.split(' ').next().unwrap_or(argument),
        None => argument,
    };
    let reason = error.source()?;
    if let Some(reason) = reason.downcast_ref::<ParseIntError>() {
        return Some(match reason.kind() {
            IntErrorKind::PosOverflow => format!("{argument} is {value}, which is too large"),
            _ => format!("{argument} is {value}; allowed is a whole number, 0 or more"),
        });
    }
    if reason.is::<ParseFloatError>() {
        return Some(format!("{argument} is {value}; allowed is a number, such as 0.5"));
    }
    let reason = reason.to_string();
    if let Some(range) = reason.strip_prefix(&format!("{value} is not in ")) {
        return Some(format!("{argument} is {value}; allowed is {}", range_in_words(range)));
    }
    Some(match (reason.starts_with("allowed is "), argument.starts_with("--")) {
        (true, _) => format!("{argument} is {value}; {reason}"),
        (false, true) => format!("{argument} {value}: {reason}"),
        // Where an argument has no name, its value says which it is.
        (false, false) => format!("{value}: {reason}"),
    })
}

/// `1..=100` as "1 to 100".
fn range_in_words(range: &str) -> String {
    match range.split_once("..=") {
        Some((first, last)) => format!("{first} to {last}"),
        None => range.to_owned(),
    }
}

#[cfg(all(test, unix))]
mod matrix;

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use clap::CommandFactory as _;

    use super::*;
    use crate::argument::{Folder, NamedFile};
    use fspid_scenario::count::COUNTS;

    /// Every command with its path, such as `campaign run`; groups of commands are no commands themselves.
    fn commands(command: &Command, path: &str) -> Vec<(String, Command)> {
        let below: Vec<_> = command
            .get_subcommands()
            .filter(|it| it.get_name() != "help")
            .flat_map(|it| commands(it, &format!("{path} {}", it.get_name())))
            .collect();
        match below.is_empty() {
            true => vec![(path.trim().to_owned(), command.clone())],
            false => below,
        }
    }

    /// Every command for people; `fspid` calls those that are hidden.
    pub(super) fn all() -> Vec<(String, Command)> {
        let mut all = commands(&prepared(crate::Arguments::command()), "");
        all.retain(|(_, command)| !command.is_hide_set());
        all
    }

    /// `--trace -` wrote a file that was called `-`.
    #[test]
    fn every_argument_that_names_a_file_knows_standard_input_or_output_and_says_so() {
        let commands = all();
        assert!(commands.len() > 30, "{}", commands.len());
        for (path, command) in &commands {
            for argument in command.get_arguments() {
                let place = format!("{path} {}", name(argument));
                assert!(!is::<PathBuf>(argument), "{place} takes any path");
                let help = argument.get_help().map(ToString::to_string).unwrap_or_default();
                let long = argument.get_long_help().map_or(help.clone(), ToString::to_string);
                if standard(argument).is_some() {
                    assert!(help.contains("`-`") && long.contains("`-`"), "{place}: {help}");
                    continue;
                }
                let values = argument.get_value_names().unwrap_or_default().join(" ");
                let is_named = is::<Folder>(argument) || is::<NamedFile>(argument);
                let names_a_file = ["FILE", "OUT.", "DIR", "FOLDER", "SYSTEM"]
                    .iter()
                    .any(|word| values.contains(word));
                assert!(!names_a_file || is_named, "{place}: {values}");
                assert!(!is_named || !help.contains("`-`"), "{place}: {help}");
            }
        }
    }

    /// Whole numbers that name one of many, and are no counts.
    const NAMES: [&str; 4] = ["seed", "run", "number", "port"];

    /// `--seeds 18446744073709551615` panicked, `--population 100000000` and `--threads 1000000` asked for more than there is.
    #[test]
    fn every_count_has_a_limit_in_the_table_and_is_refused_beyond_it() {
        let (mut counts, whole) = (Vec::new(), [is::<u16>, is::<u32>, is::<u64>, is::<usize>]);
        for (path, command) in all() {
            for argument in command.get_arguments().filter(|it| whole.iter().any(|is| is(it))) {
                if NAMES.contains(&argument.get_id().as_str()) {
                    continue;
                }
                let place = format!("{path} {}", name(argument));
                let limits = count(argument, &path);
                let limits = limits.unwrap_or_else(|| panic!("{place} has no row in the table"));
                for found in [u64::MAX, limits.most + 1, limits.least.wrapping_sub(1)] {
                    let told = refused(argument, found);
                    assert!(told.contains(&limits.allowed()), "{place} {found}: {told}");
                }
                for good in [limits.least, limits.most] {
                    assert_eq!(refused(argument, good), "", "{place} {good}");
                }
                let help = argument.get_help().map(ToString::to_string).unwrap_or_default();
                assert!(help.ends_with(&format!("to {}", limits.most)), "{place}: {help}");
                counts.push(place);
            }
        }
        let rows = COUNTS.iter().flat_map(|count| count.options);
        rows.for_each(|row| assert!(counts.iter().any(|it| it == row), "no command has {row}"));
    }

    /// What is told of a value of one argument; nothing if it is taken.
    fn refused(argument: &Arg, value: u64) -> String {
        let alone = Arg::new("it").long("it").value_parser(argument.get_value_parser().clone());
        let line = ["--it".to_owned(), value.to_string()];
        let parsed = Command::new("it").no_binary_name(true).arg(alone).try_get_matches_from(line);
        parsed.err().map(|error| error.to_string()).unwrap_or_default()
    }

    #[test]
    fn every_command_answers_as_json_if_asked() {
        for (path, command) in all() {
            let format = command.get_arguments().find(|it| it.get_long() == Some("format"));
            let values = format.map(|it| it.get_possible_values()).unwrap_or_default();
            assert!(values.iter().any(|value| value.get_name() == "json"), "{path}");
        }
    }
}
