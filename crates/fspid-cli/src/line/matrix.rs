//! Every output of every command against every input of it, and against its other outputs. Commands, inputs and outputs
//! are those that the parser has, so that a new one is asked too.

use std::ffi::OsString;
use std::fs;
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};

use clap::{Arg, ArgMatches, Command};

use super::tests::all;
use super::{is, name, outputs_apart};
use crate::argument::{Drawings, Folder, InFile, NamedFile, OutFile, Source};

/// Endings of which each output takes one.
const ENDINGS: [&str; 7] = ["csv", "html", "xml", "toml", "parquet", "svg", "fis"];
/// What some command needs beside its required arguments: one of a group.
const BESIDE: [&[&str]; 4] = [&[], &["--input=x=1"], &["--data=other"], &["--points=2,2"]];

fn is_read(argument: &Arg) -> bool {
    is::<InFile>(argument) || is::<NamedFile>(argument) || is::<Source>(argument)
}

fn is_written(argument: &Arg) -> bool {
    is::<OutFile>(argument) || is::<Drawings>(argument)
}

/// The words of a line in which these arguments have these values, and all that must be there has some.
fn words(command: &Command, given: &[(&Arg, &Path)], beside: &[&str]) -> Vec<OsString> {
    let value = |argument: &Arg| {
        let given = given.iter().find(|(it, _)| it.get_id() == argument.get_id());
        let needed = || argument.is_required_set().then(|| needed(argument).into());
        given.map(|(_, path)| path.as_os_str().to_owned()).or_else(needed)
    };
    let written = |argument: &Arg| {
        let value = value(argument)?;
        Some(match argument.get_long() {
            Some(long) => [OsString::from(format!("--{long}=")), value].into_iter().collect(),
            None => value,
        })
    };
    let words = command.get_arguments().filter_map(written);
    words.chain(beside.iter().map(OsString::from)).collect()
}

/// A value for what must be there.
fn needed(argument: &Arg) -> String {
    let possible = argument.get_possible_values();
    match possible.first() {
        Some(value) => value.get_name().to_owned(),
        None if is::<Folder>(argument) || is_read(argument) => "other".to_owned(),
        None if is_written(argument) => "other.toml".to_owned(),
        None => "1".to_owned(),
    }
}

/// The line as the parser takes it, with one of the things beside it that it may need.
fn parsed(command: &Command, given: &[(&Arg, &Path)]) -> Option<ArgMatches> {
    let command = command.clone().no_binary_name(true);
    BESIDE.iter().find_map(|beside| {
        command.clone().try_get_matches_from(words(&command, given, beside)).ok()
    })
}

/// Endings that two arguments take.
fn endings(command: &Command, [output, other]: [&Arg; 2]) -> Option<[&'static str; 2]> {
    let all = ENDINGS.iter().flat_map(|mine| ENDINGS.iter().map(|theirs| [*mine, *theirs]));
    let name = |stem: &str, ending: &str| PathBuf::from(format!("{stem}.{ending}"));
    all.into_iter().find(|[mine, theirs]| {
        let (mine, theirs) = (name("mine", mine), name("theirs", theirs));
        parsed(command, &[(output, &mine), (other, &theirs)]).is_some()
    })
}

/// One file by two names, with these endings.
type Way = (&'static str, fn(&Path, &Path));

const WAYS: [Way; 4] = [
    ("a second name", |mine, theirs| {
        fs::write(theirs, "schema = 1").expect("written");
        fs::hard_link(theirs, mine).expect("linked");
    }),
    ("a link to it", |mine, theirs| {
        fs::write(theirs, "schema = 1").expect("written");
        symlink(theirs.file_name().expect("a name"), mine).expect("linked");
    }),
    ("a link to a link from it", |mine, theirs| {
        fs::write(mine, "schema = 1").expect("written");
        let between = mine.with_file_name("between");
        symlink(mine, &between).expect("linked");
        symlink("between", theirs).expect("linked");
    }),
    ("a link to what is not there yet", |mine, theirs| {
        symlink(theirs.file_name().expect("a name"), mine).expect("linked");
    }),
];

/// Whether two arguments that name one file are refused, whichever way they name it.
fn refused(command: &Command, pair: [&Arg; 2]) -> Result<(), String> {
    let [mine, theirs] = endings(command, pair).ok_or("no line is taken with both of them")?;
    for (way, make) in WAYS {
        let folder = tempfile::tempdir().expect("a folder");
        let at = |stem: &str, ending| folder.path().join(format!("{stem}.{ending}"));
        let (mine, theirs) = (at("mine", mine), at("theirs", theirs));
        make(&mine, &theirs);
        check(command, [(pair[0], &mine), (pair[1], &theirs)], way)?;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let (same, dotted) = (format!("same.{mine}"), format!("./same.{mine}"));
    let (same, dotted) = (folder.path().join(same), folder.path().join(dotted));
    fs::write(&same, "schema = 1").expect("written");
    // Outputs of two kinds never have one name.
    match parsed(command, &[(pair[0], &same), (pair[1], &dotted)]) {
        Some(_) => check(command, [(pair[0], &same), (pair[1], &dotted)], "its own name"),
        None => Ok(()),
    }
}

fn check(command: &Command, given: [(&Arg, &Path); 2], way: &str) -> Result<(), String> {
    let matches = parsed(command, &given).ok_or_else(|| format!("{way}: the line is not taken"))?;
    let clash = outputs_apart(command, &matches).err().ok_or_else(|| format!("{way} is taken"))?;
    let told = clash.to_string();
    let are_named = given.iter().all(|(argument, _)| told.contains(&name(argument)));
    are_named.then_some(()).ok_or(told)
}

/// `simulate a.toml --trace a.toml` was written over the scenario, and `--trace x --report x` over each other.
#[test]
fn no_output_of_any_command_is_written_over_an_input_or_another_output() {
    let mut asked = 0;
    for (path, command) in all() {
        let ours =
            |is_kind: fn(&Arg) -> bool| command.get_arguments().filter(move |it| is_kind(it));
        let others: Vec<&Arg> = ours(is_read).chain(ours(is_written)).collect();
        for output in ours(is_written) {
            // Two that no line has together are no two files.
            let never_beside = command.get_arg_conflicts_with(output);
            let beside = |other: &&&Arg| {
                let is_other = |it: &Arg| it.get_id() == other.get_id();
                !is_other(output) && !never_beside.iter().any(|it| is_other(it))
            };
            for other in others.iter().filter(beside) {
                let told = refused(&command, [output, other]);
                assert_eq!(told, Ok(()), "{path}: {} over {}", name(output), name(other));
                asked += 1;
            }
        }
    }
    assert!(asked > 30, "{asked} pairs were asked");
}
