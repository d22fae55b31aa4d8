//! A file that one process at a time may write for hours.

use std::fs::{self, File, TryLockError};
use std::io;
use std::path::{Path, PathBuf};

/// Held while a process works on a file: `NAME.lock` beside it, which is removed in the end. One that is left by a process
/// that was killed keeps nobody out.
#[derive(Debug)]
pub struct Locked {
    path: PathBuf,
    /// Closing it frees it, also when the process is killed.
    _file: File,
}

/// Why a file cannot be worked on.
#[derive(Debug, thiserror::Error)]
pub enum NotLocked {
    /// Another process does.
    #[error("another process is working on it; wait until it has ended")]
    Busy,
    /// There can be no lock beside it.
    #[error("no lock can be put beside it: {}", super::in_words(.0))]
    Failed(#[from] io::Error),
}

impl Locked {
    /// Keeps other processes away from the file at a path.
    ///
    /// # Errors
    /// [`NotLocked`].
    pub fn beside(path: &Path) -> Result<Self, NotLocked> {
        let mut name = path.as_os_str().to_owned();
        name.push(".lock");
        let path = PathBuf::from(name);
        loop {
            if fs::metadata(&path).is_ok_and(|found| !found.is_file()) {
                return Err(io::Error::other("what has the name of the lock is no file").into());
            }
            let file = File::options().create(true).append(true).open(&path)?;
            match file.try_lock() {
                // Who held it before may have removed it meanwhile.
                Ok(()) if !is_at(&file, &path) => {}
                Err(TryLockError::WouldBlock) => return Err(NotLocked::Busy),
                Ok(()) => return Ok(Self { path, _file: file }),
                // A file system without locks: files are whole all the same, since they are renamed.
                Err(TryLockError::Error(error)) if error.kind() == io::ErrorKind::Unsupported => {
                    return Ok(Self { path, _file: file });
                }
                Err(TryLockError::Error(error)) => return Err(error.into()),
            }
        }
    }
}

impl Drop for Locked {
    fn drop(&mut self) {
        let _ = fs::remove_file(&self.path);
    }
}

/// True if that open file is the one at the path.
#[cfg(unix)]
fn is_at(file: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt as _;
    let number = |found: fs::Metadata| (found.dev(), found.ino());
    let (open, there) = (file.metadata().map(number), fs::metadata(path).map(number));
    open.ok().is_some_and(|open| there.ok() == Some(open))
}

#[cfg(not(unix))]
fn is_at(_: &File, path: &Path) -> bool {
    path.exists()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_at_a_time_works_on_a_file_and_leaves_no_lock() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("design.toml");
        let held = Locked::beside(&path).expect("nobody works there");
        assert!(matches!(Locked::beside(&path), Err(NotLocked::Busy)));
        drop(held);
        fs::write(folder.path().join("design.toml.lock"), "")
            .expect("of a process that was killed");
        drop(Locked::beside(&path).expect("nobody works there"));
        assert_eq!(fs::read_dir(folder.path()).expect("listed").count(), 0);
    }
}
