//! Where jobs keep what they write.

use std::fs;
use std::io;
use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};

use tempfile::TempDir;

/// A folder that somebody named, or one of the server's own, which is made for the first job: a server that is killed
/// leaves nothing behind if it has not worked.
#[derive(Debug)]
pub(crate) enum Place {
    Kept(PathBuf),
    Own(Mutex<Option<TempDir>>),
}

impl Place {
    /// The folder; one that somebody named is made at once.
    ///
    /// # Errors
    /// A folder that cannot be made.
    pub(crate) fn new(kept: Option<PathBuf>) -> Result<Self, (PathBuf, io::Error)> {
        match kept {
            None => Ok(Self::Own(Mutex::default())),
            Some(path) => match fs::create_dir_all(&path) {
                Ok(()) => Ok(Self::Kept(path)),
                Err(reason) => Err((path, reason)),
            },
        }
    }

    /// Its path; it is there.
    ///
    /// # Errors
    /// A folder that cannot be made.
    pub(super) fn path(&self) -> io::Result<PathBuf> {
        let own = match self {
            Self::Kept(path) => return Ok(path.clone()),
            Self::Own(own) => own,
        };
        let mut own = own.lock().unwrap_or_else(PoisonError::into_inner);
        let folder = match own.take() {
            Some(folder) => folder,
            None => tempfile::Builder::new().prefix("fspid-").tempdir()?,
        };
        let path = folder.path().to_owned();
        *own = Some(folder);
        Ok(path)
    }

    /// Removes what goes with the server.
    pub(super) fn remove(&self) {
        if let Self::Own(own) = self {
            own.lock().unwrap_or_else(PoisonError::into_inner).take();
        }
    }
}
