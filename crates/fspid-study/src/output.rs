//! Files that are either the old ones or the new ones, never halves.

mod folder;
mod locked;
mod names;
mod unfinished;

use std::collections::BTreeSet;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write as _};
use std::panic::resume_unwind;
use std::path::{Path, PathBuf};
use std::thread;

use fspid_scenario::apart::{self, Clash, folder_of};

pub use folder::{Contents, Taken, is_free, write_folders};
pub use locked::{Locked, NotLocked};
pub use names::{Names, Place};
pub use unfinished::is_unfinished;

use unfinished::new_file_in;

/// A file or folder that could not be written. Nothing at the path has changed.
#[derive(Debug, thiserror::Error)]
#[error("cannot write {}: {}; nothing there was changed", path.display(), in_words(reason))]
pub struct OutputError {
    /// Where.
    pub path: PathBuf,
    /// Why.
    pub reason: io::Error,
}

impl OutputError {
    /// True where the file may not be written, for something is read there or written by another name: what was asked is
    /// wrong, and not the disk.
    #[must_use]
    pub fn is_clash(&self) -> bool {
        self.reason.get_ref().is_some_and(|reason| reason.is::<Clash>())
    }
}

/// Why a file could not be written; the system's own words would name the new file beside it, which
/// nobody knows.
#[must_use]
pub fn in_words(reason: &io::Error) -> String {
    match reason.kind() {
        io::ErrorKind::StorageFull => "the disk is full",
        io::ErrorKind::NotFound => "its folder does not exist",
        io::ErrorKind::PermissionDenied => "permission denied",
        io::ErrorKind::ReadOnlyFilesystem => "the file system is read-only",
        io::ErrorKind::IsADirectory => "it is a folder",
        io::ErrorKind::FileTooLarge => {
            "files may not be so large here (`ulimit -f` says how large)"
        }
        io::ErrorKind::InvalidFilename => "its name is too long",
        io::ErrorKind::CrossesDevices => "a link there leads to another disk",
        io::ErrorKind::NotADirectory | io::ErrorKind::AlreadyExists => "what is there is no folder",
        _ => return reason.to_string(),
    }
    .to_owned()
}

/// Writes `contents` to `path`: into a new file beside it first, flushed to the disk, then renamed. `-` is standard
/// output.
///
/// # Errors
/// [`OutputError`] with the path; an existing file is then as it was.
pub fn write(path: &Path, contents: impl AsRef<[u8]>) -> Result<(), OutputError> {
    write_by(path, |file| file.write_all(contents.as_ref()).map_err(|reason| failed(path, reason)))
}

/// Refuses the place of a file where a folder is, before anything is computed for it.
///
/// # Errors
/// [`OutputError`] with the path.
pub fn no_folder(path: &Path) -> Result<(), OutputError> {
    let is_folder = || io::Error::new(io::ErrorKind::IsADirectory, "it is a folder");
    if path.is_dir() { Err(failed(path, is_folder())) } else { Ok(()) }
}

/// As [`write()`], of a file that is not there yet: of two who write it at once one is told.
///
/// # Errors
/// [`OutputError`] with the path, where something has that name by then too.
pub fn write_new(path: &Path, contents: impl AsRef<[u8]>) -> Result<(), OutputError> {
    let write = |file: &mut BufWriter<&File>| {
        file.write_all(contents.as_ref()).map_err(|reason| failed(path, reason))
    };
    let ((), whole) = begun(path, write)?;
    if let Some(Whole { file, path }) = whole {
        let folder = folder_of(&path).to_owned();
        file.persist_noclobber(&path).map_err(|error| failed(&path, error.error))?;
        flush(&folder);
    }
    Ok(())
}

/// Writes many files, none of them under its name before all are whole: where one cannot be written, no file has changed.
/// Several are flushed to the disk at a time, which is what takes the time.
///
/// # Errors
/// [`OutputError`] with the path of the first that could not be written.
pub fn write_all(files: &[(PathBuf, &[u8])]) -> Result<(), OutputError> {
    let begin = |(path, contents): &(PathBuf, &[u8])| {
        let write = |file: &mut BufWriter<&File>| file.write_all(contents);
        begun(path, |file| write(file).map_err(|reason| failed(path, reason)))
    };
    let begin_each = |part: &[_]| part.iter().map(begin).collect::<Result<Vec<_>, OutputError>>();
    let share = files.len().div_ceil(AT_A_TIME).max(1);
    let whole: Result<Vec<_>, _> = thread::scope(|scope| {
        let parts: Vec<_> =
            files.chunks(share).map(|part| scope.spawn(move || begin_each(part))).collect();
        let joined = parts.into_iter().map(thread::ScopedJoinHandle::join);
        joined.map(|part| part.unwrap_or_else(|panic| resume_unwind(panic))).collect()
    });
    let whole: Vec<Whole> = whole?.into_iter().flatten().filter_map(|((), whole)| whole).collect();
    let folders: BTreeSet<PathBuf> = whole.iter().map(|it| it.folder().to_owned()).collect();
    whole.into_iter().try_for_each(Whole::persist)?;
    folders.iter().for_each(|folder| flush(folder));
    Ok(())
}

/// How many files are flushed at a time.
const AT_A_TIME: usize = 4;

/// As [`write()`], of what a function writes piece by piece. Nothing there is changed where it fails.
///
/// # Errors
/// The function's own, and [`OutputError`].
pub fn write_by<T, E: From<OutputError>>(
    path: &Path,
    contents: impl FnOnce(&mut BufWriter<&File>) -> Result<T, E>,
) -> Result<T, E> {
    let (answer, whole) = begun(path, contents)?;
    if let Some(whole) = whole {
        let folder = whole.folder().to_owned();
        whole.persist()?;
        flush(&folder);
    }
    Ok(answer)
}

/// A new file beside its place, on the disk.
struct Whole {
    file: tempfile::NamedTempFile,
    path: PathBuf,
}

impl Whole {
    fn folder(&self) -> &Path {
        folder_of(&self.path)
    }

    /// Puts it at its place.
    fn persist(self) -> Result<(), OutputError> {
        let Self { file, path } = self;
        file.persist(&path).map_err(|error| failed(&path, error.error))?;
        Ok(())
    }
}

/// Flushes the names in a folder; not every file system knows how, and the files are safe without.
fn flush(folder: &Path) {
    let _ = File::open(folder).and_then(|folder| folder.sync_all());
}

fn failed(path: &Path, reason: io::Error) -> OutputError {
    OutputError { path: path.to_owned(), reason }
}

/// Writes what is to stand at the path: into a new file beside it, or into what is there if that is no file.
fn begun<T, E: From<OutputError>>(
    path: &Path,
    contents: impl FnOnce(&mut BufWriter<&File>) -> Result<T, E>,
) -> Result<(T, Option<Whole>), E> {
    let failed = |reason| failed(path, reason);
    if path == Path::new("-") {
        let answer = filled(&standard_output().map_err(failed)?, contents, failed)?;
        return Ok((answer, None));
    }
    no_folder(path)?;
    // A device or pipe is written as it is: it has nothing that could be lost.
    if fs::metadata(path).is_ok_and(|data| !data.is_file()) {
        let file = File::options().write(true).open(path).map_err(failed)?;
        return Ok((filled(&file, contents, failed)?, None));
    }
    let place = place(path).map_err(failed)?;
    let file = new_file_in(folder_of(&place)).map_err(failed)?;
    let answer = filled(file.as_file(), contents, failed)?;
    file.as_file().sync_all().map_err(failed)?;
    Ok((answer, Some(Whole { file, path: place })))
}

/// Where a file is written that may be: a link stays one, and what it leads to is written.
fn place(path: &Path) -> io::Result<PathBuf> {
    apart::writing(path).map_err(|clash| io::Error::new(io::ErrorKind::InvalidInput, clash))?;
    let place = apart::target(path);
    match place.symlink_metadata() {
        Ok(found) if found.is_symlink() => Err(io::Error::other("links there lead in a circle")),
        // A name that is too long would be found out when others already stand at their places.
        Err(error) if error.kind() == io::ErrorKind::InvalidFilename => Err(error),
        _ => Ok(place),
    }
}

fn filled<T, E: From<OutputError>>(
    file: &File,
    contents: impl FnOnce(&mut BufWriter<&File>) -> Result<T, E>,
    failed: impl Fn(io::Error) -> OutputError,
) -> Result<T, E> {
    let mut buffered = BufWriter::new(file);
    let answer = contents(&mut buffered)?;
    buffered.flush().map_err(failed)?;
    Ok(answer)
}

/// Standard output as a file; what is written there stands after what was printed before.
fn standard_output() -> io::Result<File> {
    let stdout = io::stdout();
    stdout.lock().flush()?;
    #[cfg(unix)]
    {
        use std::os::fd::AsFd as _;
        Ok(File::from(stdout.as_fd().try_clone_to_owned()?))
    }
    #[cfg(windows)]
    {
        use std::os::windows::io::AsHandle as _;
        Ok(File::from(stdout.as_handle().try_clone_to_owned()?))
    }
    #[cfg(not(any(unix, windows)))]
    {
        Err(io::Error::new(io::ErrorKind::Unsupported, "standard output is no file here"))
    }
}

/// Makes a folder and those above it.
///
/// # Errors
/// [`OutputError`] with the path.
pub fn make_folder(path: &Path) -> Result<(), OutputError> {
    fs::create_dir_all(path).map_err(|reason| OutputError { path: path.to_owned(), reason })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_replaced_whole() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.txt");
        write(&path, "old").expect("written");
        write(&path, "new and longer").expect("written");
        assert_eq!(fs::read_to_string(&path).expect("read"), "new and longer");
        assert_eq!(fs::read_dir(folder.path()).expect("listed").count(), 1);
    }

    #[test]
    fn a_missing_folder_is_an_error_that_names_the_file() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("missing/a.txt");
        let message = write(&path, "x").expect_err("no folder").to_string();
        assert!(message.contains("missing") && message.contains("nothing there was changed"));
    }

    #[test]
    fn a_folder_in_the_way_is_an_error_and_stays() {
        let folder = tempfile::tempdir().expect("a folder");
        assert!(write(folder.path(), "x").is_err());
        assert!(folder.path().is_dir());
    }

    #[test]
    fn of_many_files_none_changes_where_one_cannot_be_written() {
        let folder = tempfile::tempdir().expect("a folder");
        let paths: Vec<PathBuf> = (0..9).map(|k| folder.path().join(k.to_string())).collect();
        let files = |text: &'static [u8]| paths.iter().map(|it| (it.clone(), text)).collect();
        let mut files: [Vec<(PathBuf, &[u8])>; 2] = [files(b"old"), files(b"new")];
        write_all(&files[0]).expect("written");
        files[1].push((folder.path().join("missing/a.txt"), b"new"));
        let message = write_all(&files[1]).expect_err("no folder").to_string();
        assert!(message.contains("missing"), "{message}");
        for path in &paths {
            assert_eq!(fs::read(path).expect("read"), b"old");
        }
        assert_eq!(fs::read_dir(folder.path()).expect("listed").count(), paths.len());
    }

    /// A proof of 35 had a name that was too long, and 13 of them were written.
    #[cfg(unix)]
    #[test]
    fn a_name_that_is_too_long_is_known_before_others_are_placed() {
        let folder = tempfile::tempdir().expect("a folder");
        let at = |name: &str| folder.path().join(name);
        let files: [(PathBuf, &[u8]); 2] = [(at("a"), b"new"), (at(&"x".repeat(300)), b"new")];
        let told = write_all(&files).expect_err("too long").to_string();
        assert!(told.contains("its name is too long"), "{told}");
        assert_eq!(fs::read_dir(folder.path()).expect("listed").count(), 0);
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_full_device_is_an_error() {
        assert!(write(Path::new("/dev/full"), "x").is_err());
    }
}
