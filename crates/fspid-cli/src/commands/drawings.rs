//! Drawings, one file each.

use std::path::Path;

use crate::exit::{Failure, note};
use fspid_study::output;

/// One drawing into its file; several into a folder, or beside each other if `path` is a file's.
pub(super) fn write(path: &Path, figures: Vec<(&str, &str)>) -> Result<(), Failure> {
    let is_drawing = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("svg"));
    if !is_drawing {
        output::make_folder(path)?;
    }
    let several = figures.len() > 1;
    for (name, svg) in figures {
        let file = match (is_drawing, several) {
            (true, false) => path.to_owned(),
            (true, true) => {
                let stem = path.file_stem().unwrap_or_default().to_string_lossy();
                path.with_file_name(format!("{stem}-{}.svg", file_name(name)))
            }
            (false, _) => path.join(format!("{}.svg", file_name(name))),
        };
        output::write(&file, svg)?;
        note(format_args!("wrote {}", file.display()));
    }
    Ok(())
}

/// A name that every file system takes.
fn file_name(name: &str) -> String {
    let fits = |c: char| c.is_alphanumeric() || c == '-' || c == '_';
    name.chars().map(|c| if fits(c) { c } else { '_' }).collect()
}
