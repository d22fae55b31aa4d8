//! Drawings, one file each.

use crate::argument::{Drawings, is_standard};
use crate::exit::{Failure, note, wrote};
use fspid_study::output::{self, Names, Place};

/// One drawing into its file; several into a folder, or beside each other if `path` is a file's.
pub(super) fn write(path: &Drawings, figures: Vec<(&str, &str)>) -> Result<(), Failure> {
    if is_standard(path) {
        return match figures.as_slice() {
            [(_, svg)] => Ok(output::write(path, svg)?),
            several => Err(several_on_one(several)),
        };
    }
    let is_drawing = path.is_file();
    if !is_drawing {
        output::make_folder(path)?;
    }
    let several = figures.len() > 1;
    let names = Names::of(Place::File, figures.iter().map(|(name, _)| name));
    if several || !is_drawing {
        names.changed().for_each(note);
    }
    let mut files = Vec::new();
    for ((_, svg), name) in figures.iter().zip(names.iter()) {
        let file = match (is_drawing, several) {
            (true, false) => path.to_path_buf(),
            (true, true) => {
                let stem = path.file_stem().unwrap_or_default().to_string_lossy();
                path.with_file_name(format!("{stem}-{}.svg", name))
            }
            (false, _) => path.join(format!("{}.svg", name)),
        };
        files.push((file, svg.as_bytes()));
    }
    output::write_all(&files)?;
    files.iter().for_each(|(file, _)| wrote(file));
    Ok(())
}

/// Several drawings that cannot stand on standard output together.
fn several_on_one(figures: &[(&str, &str)]) -> Failure {
    let names: Vec<&str> = figures.iter().map(|(name, _)| *name).collect();
    Failure::input(format_args!(
        "standard output holds one drawing, and there are {}: {}; name a folder",
        figures.len(),
        names.join(", ")
    ))
}
