//! What an answer is made of, and answers as files: whole or not at all, and never over what they are made of.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use fspid::scenario::apart::{self, Clash, Named, Protected};
use fspid::study::output::{self, OutputError};
use pyo3::prelude::*;

use crate::error;

/// The files that an answer is made of: a scenario's own and those that it names.
#[derive(Clone, Debug, Default)]
pub(crate) struct Origin(Arc<Vec<PathBuf>>);

impl Origin {
    /// These files, wherever the program goes to later.
    pub(crate) fn of(files: impl IntoIterator<Item = PathBuf>) -> Self {
        let from_root = |path: PathBuf| std::path::absolute(&path).unwrap_or(path);
        Self(Arc::new(files.into_iter().map(from_root).collect()))
    }

    /// The same and more files.
    pub(crate) fn with(&self, files: impl IntoIterator<Item = PathBuf>) -> Self {
        Self::of(self.0.iter().cloned().chain(files))
    }

    /// Lets nothing be written over them as long as the answer lives.
    pub(crate) fn protected(&self) -> Protected {
        apart::protect(self.0.iter().cloned())
    }

    /// Refuses outputs that are one of them or each other, before anything is asked.
    pub(crate) fn apart_from(&self, outputs: &[(&str, Option<&Path>)]) -> Result<(), Clash> {
        let named = |(argument, path): &(&str, Option<&Path>)| {
            path.and_then(|path| Named::new((*argument).to_owned(), path))
        };
        let outputs: Vec<Named> = outputs.iter().filter_map(named).collect();
        let read = |path: &PathBuf| Named::new("file".to_owned(), path);
        let inputs: Vec<Named> = self.0.iter().filter_map(read).collect();
        apart::clash(&inputs, &outputs).map_or(Ok(()), Err)
    }

    /// Writes a text to a file.
    pub(crate) fn write(&self, py: Python<'_>, path: &Path, text: &str) -> PyResult<()> {
        let written = py.detach(|| {
            let _protected = self.protected();
            output::write(&as_file(path), text)
        });
        written.map_err(|found| refused(py, &found))
    }

    /// Writes files into a folder, all of them or none; it is made if it is not there.
    pub(crate) fn write_all(
        &self,
        py: Python<'_>,
        folder: &Path,
        files: &[(String, String)],
    ) -> PyResult<Vec<PathBuf>> {
        let paths: Vec<PathBuf> = files.iter().map(|(name, _)| folder.join(name)).collect();
        let texts = files.iter().map(|(_, text)| text.as_bytes());
        let whole: Vec<(PathBuf, &[u8])> = paths.iter().cloned().zip(texts).collect();
        let written = py.detach(|| {
            let _protected = self.protected();
            output::make_folder(folder)?;
            // Names may have folders of their own in them.
            paths.iter().filter_map(|path| path.parent()).try_for_each(output::make_folder)?;
            output::write_all(&whole)
        });
        written.map(|()| paths).map_err(|found| refused(py, &found))
    }
}

/// What is asked is wrong where it would be written over what was read; all else is the disk.
fn refused(py: Python<'_>, found: &OutputError) -> PyErr {
    match found.is_clash() {
        true => error::input(py, found),
        false => error::output(py, found),
    }
}

/// `-`, which is standard output for the program, names a file here.
pub(crate) fn as_file(path: &Path) -> PathBuf {
    match path == Path::new("-") {
        true => Path::new(".").join(path),
        false => path.to_owned(),
    }
}
