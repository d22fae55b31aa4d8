//! A file that one process at a time may write for hours.

use std::fs::{self, File, TryLockError};
use std::io;
use std::path::{Path, PathBuf};

use fspid_scenario::apart;

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
        Self::at(PathBuf::from(name))
    }

    /// The same with the lock's own path.
    pub(super) fn at(path: PathBuf) -> Result<Self, NotLocked> {
        loop {
            let file = lock_file(&path)?;
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

/// The file that a lock is held on. It is removed in the end, so that one of somebody else is refused: a lock is empty, and
/// no link.
fn lock_file(path: &Path) -> io::Result<File> {
    let is_lock = |found: fs::Metadata| found.is_file() && found.len() == 0;
    if path.symlink_metadata().is_ok_and(|found| !is_lock(found)) {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        return Err(io::Error::other(format!("{name} has the name of the lock and is none")));
    }
    apart::writing(path).map_err(|clash| io::Error::new(io::ErrorKind::InvalidInput, clash))?;
    File::options().create(true).append(true).open(path)
}

impl Drop for Locked {
    fn drop(&mut self) {
        let _ = fs::remove_file(&self.path);
    }
}

/// True if that open file is the one at the path.
#[cfg(unix)]
pub(super) fn is_at(file: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt as _;
    let number = |found: fs::Metadata| (found.dev(), found.ino());
    let (open, there) = (file.metadata().map(number), fs::metadata(path).map(number));
    open.ok().is_some_and(|open| there.ok() == Some(open))
}

#[cfg(not(unix))]
pub(super) fn is_at(_: &File, path: &Path) -> bool {
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

    /// `tune d.toml.state.json.lock --out d.toml` removed the scenario.
    #[test]
    fn what_only_has_the_name_of_a_lock_is_refused_and_stays() {
        let folder = tempfile::tempdir().expect("a folder");
        let at = |name: &str| folder.path().join(name);
        fs::write(at("a.lock"), "schema = 1").expect("written");
        fs::create_dir(at("b.lock")).expect("made");
        for name in ["a", "b"] {
            let told = Locked::beside(&at(name)).expect_err("refused").to_string();
            assert!(told.contains("has the name of the lock and is none"), "{told}");
        }
        assert_eq!(fs::read_to_string(at("a.lock")).expect("a file"), "schema = 1");
        fs::write(at("c.lock"), "").expect("written");
        let _protected = apart::protect([at("c.lock")]);
        assert!(Locked::beside(&at("c")).is_err() && at("c.lock").exists());
    }
}
