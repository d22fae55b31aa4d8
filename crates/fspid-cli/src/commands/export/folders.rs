//! Where an export is written to.

use std::io;
use std::path::Path;

use super::Arguments;
use crate::exit::Failure;
use fspid_export::{Export, File};
use fspid_scenario::apart::from_root;
use fspid_study::output::{self, Contents, Taken, is_free, write_folders};

/// Refuses folders that may not be written into, before anything is computed.
pub(super) fn check(arguments: &Arguments) -> Result<(), Failure> {
    free("--out", &arguments.out, arguments.force)?;
    let Some(evidence) = &arguments.evidence else { return Ok(()) };
    free("--evidence", evidence, arguments.force)?;
    // What its script found before is of what was exported before.
    let results = evidence.join("results");
    if results.exists() {
        return Err(Failure::input(format_args!(
            "{} holds what the script of an earlier export found, which would stand beside this one; remove it, or choose another folder",
            results.display()
        )));
    }
    if from_root(&arguments.out).starts_with(from_root(evidence)) {
        return Err(Failure::input(
            "--out is in the folder of --evidence, which has files of the same names; each needs a folder of its own",
        ));
    }
    Ok(())
}

/// Refuses a folder with files in it, and what is no folder.
fn free(option: &str, folder: &Path, force: bool) -> Result<(), Failure> {
    let name = folder.display();
    match is_free(folder) {
        Ok(false) if !force => Err(Failure::input(format_args!(
            "{name} is not empty; choose another folder, or --force to write into it"
        ))),
        Ok(_) => Ok(()),
        Err(error) if error.kind() == io::ErrorKind::NotADirectory => Err(Failure::input(
            format_args!("{option} needs a folder, and {name} is a file or a link to nothing"),
        )),
        Err(error) => Err(Failure::input(format_args!(
            "{name}: it cannot be seen what is in it: {}",
            output::in_words(&error)
        ))),
    }
}

/// Bytes of a file's name: `NAME_MAX` of Linux is 255, and a number stands in front while files are exchanged.
const LONGEST: usize = 240;

/// Writes all files, or none.
pub(super) fn write(arguments: &Arguments, exported: &Export) -> Result<(), Failure> {
    fn contents(files: &[File]) -> Contents<'_> {
        files.iter().map(|it| (it.name.as_str(), it.bytes.as_slice())).collect()
    }
    let is_long = |it: &File| it.name.split('/').any(|name| name.len() > LONGEST);
    if let Some(file) = exported.files.iter().chain(&exported.evidence).find(|it| is_long(it)) {
        let name = &file.name;
        return Err(Failure::input(format_args!(
            "`{name}` is too long for a file, which {LONGEST} letters may name; --prefix NAME gives another"
        )));
    }
    let mut folders = vec![(&*arguments.out, contents(&exported.files))];
    folders.extend(arguments.evidence.as_deref().map(|it| (it, contents(&exported.evidence))));
    let taken = if arguments.force { Taken::WrittenOver } else { Taken::Refused };
    Ok(write_folders(&folders, taken)?)
}
