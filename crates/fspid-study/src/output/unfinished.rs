//! New files beside their places until they are whole, and what killed processes have left of theirs.

use std::collections::BTreeSet;
use std::ffi::OsStr;
use std::fs::{self, File, TryLockError};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use super::locked::{Locked, NotLocked, is_at};

/// What the names of files and folders begin with until they are whole.
const UNFINISHED: &str = ".fspid-";
/// What they end in, so that nothing of a user's is taken for one.
const ENDING: &str = ".unfinished";
/// Held by who puts many files into a folder, which is where its name is.
pub(super) const ALONE: &str = ".fspid-alone.unfinished";

/// Keeps other processes away that put many files into a folder.
pub(super) fn alone_in(folder: &Path) -> Result<Locked, NotLocked> {
    Locked::at(folder.join(ALONE))
}

/// A new folder inside of another, for who is alone in that one.
pub(super) fn new_folder_in(folder: &Path) -> io::Result<tempfile::TempDir> {
    tempfile::Builder::new().prefix(UNFINISHED).suffix(ENDING).tempdir_in(folder)
}

/// A new file that nobody takes for one that was left: its lock ends with the process, however that ends.
pub(super) fn new_file_in(folder: &Path) -> io::Result<tempfile::NamedTempFile> {
    remove_left(folder);
    let mut builder = tempfile::Builder::new();
    builder.prefix(UNFINISHED).suffix(ENDING);
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt as _;
        // As any new file: the user's mask takes its part away.
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    loop {
        let file = builder.tempfile_in(folder)?;
        match file.as_file().try_lock() {
            // Somebody may have taken it for left before it had its lock.
            Ok(()) if !is_at(file.as_file(), file.path()) => {}
            Err(TryLockError::WouldBlock) => {}
            // On a file system without locks nothing is taken for left either.
            Ok(()) | Err(TryLockError::Error(_)) => return Ok(file),
        }
    }
}

/// Removes what processes have left in a folder that were killed; each folder is looked at once.
fn remove_left(folder: &Path) {
    static SEEN: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());
    let mut seen = SEEN.lock().unwrap_or_else(PoisonError::into_inner);
    // Under its lock: no other thread makes a file there before all has been looked at.
    if seen.insert(folder.to_owned()) {
        sweep(folder);
    }
}

/// Removes what is left in a folder now.
fn sweep(folder: &Path) {
    remove_left_files(folder);
    // Folders are nobody's while nobody is alone there.
    if unfinished(folder).any(|path| is_folder(&path))
        && let Ok(_alone) = alone_in(folder)
    {
        remove_left_folders(folder);
    }
}

/// Removes files of processes that were killed.
pub(super) fn remove_left_files(folder: &Path) {
    unfinished(folder).for_each(|path| remove_if_left(&path));
}

/// Removes folders of processes that were killed. Only for who is alone there.
pub(super) fn remove_left_folders(folder: &Path) {
    for path in unfinished(folder).filter(|path| is_folder(path)) {
        let _ = fs::remove_dir_all(path);
    }
}

fn unfinished(folder: &Path) -> impl Iterator<Item = PathBuf> {
    let entries = folder.read_dir().into_iter().flatten().flatten();
    entries.filter(|entry| is_unfinished(&entry.file_name())).map(|entry| entry.path())
}

/// True for the name of what is not whole yet.
#[must_use]
pub fn is_unfinished(name: &OsStr) -> bool {
    name.to_str().is_some_and(|name| name.starts_with(UNFINISHED) && name.ends_with(ENDING))
}

fn is_folder(path: &Path) -> bool {
    path.symlink_metadata().is_ok_and(|found| found.is_dir())
}

/// Removes a file whose process is gone, while its lock is held: who has made it just now would take the lock, find the
/// file, and go on with one that is gone a moment later.
fn remove_if_left(path: &Path) {
    if !path.symlink_metadata().is_ok_and(|found| found.is_file()) {
        return;
    }
    if let Ok(file) = File::options().write(true).open(path)
        && file.try_lock().is_ok()
        && is_at(&file, path)
    {
        let _ = fs::remove_file(path);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `.fspid-…` of gigabytes stayed for good.
    #[test]
    fn what_a_killed_process_left_is_removed_by_the_next_and_nothing_else() {
        let folder = tempfile::tempdir().expect("a folder");
        let at = |name: &str| folder.path().join(name);
        let others = [".fspid-config", "a.unfinished", "a.csv"];
        for name in others.iter().chain(&[".fspid-1.unfinished", ".fspid-2.unfinished"]) {
            fs::write(at(name), "x").expect("written");
        }
        let held = File::open(at(".fspid-2.unfinished")).expect("opened");
        held.try_lock().expect("of a process that goes on");
        let new = new_file_in(folder.path()).expect("a file");
        assert!(!at(".fspid-1.unfinished").exists() && at(".fspid-2.unfinished").exists());
        assert!(others.iter().all(|name| at(name).exists()) && new.path().exists());
    }

    /// `export` said that its folder does not exist, about once in a hundred times on a machine with much to do.
    #[test]
    fn a_file_that_was_made_is_not_taken_for_one_that_was_left_whoever_looks_meanwhile() {
        let folder = tempfile::tempdir().expect("a folder");
        let is_over = std::sync::atomic::AtomicBool::new(false);
        let make = || {
            let made = (0..500).filter(|_| {
                let file = new_file_in(folder.path()).expect("a file");
                std::thread::yield_now();
                !file.path().exists()
            });
            made.count()
        };
        let lost = std::thread::scope(|scope| {
            let look = || {
                while !is_over.load(std::sync::atomic::Ordering::Relaxed) {
                    remove_left_files(folder.path());
                }
            };
            (0..2).for_each(|_| drop(scope.spawn(look)));
            let makers: Vec<_> = (0..3).map(|_| scope.spawn(make)).collect();
            let lost: usize = makers.into_iter().map(|it| it.join().expect("no panic")).sum();
            is_over.store(true, std::sync::atomic::Ordering::Relaxed);
            lost
        });
        assert_eq!(lost, 0);
    }

    #[test]
    fn folders_that_were_left_are_removed_unless_somebody_is_alone_there() {
        let folder = tempfile::tempdir().expect("a folder");
        let left = new_folder_in(folder.path()).expect("a folder").keep();
        fs::write(left.join("a.c"), "x").expect("written");
        let alone = alone_in(folder.path()).expect("nobody is there");
        assert!(matches!(alone_in(folder.path()), Err(NotLocked::Busy)));
        sweep(folder.path());
        assert!(left.join("a.c").exists(), "its process goes on");
        drop(alone);
        sweep(folder.path());
        assert_eq!(fs::read_dir(folder.path()).expect("listed").count(), 0);
    }
}
