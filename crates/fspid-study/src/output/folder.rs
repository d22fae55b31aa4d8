//! Folders of files that belong together: all of them are the new ones, or none is.
//!
//! New files are written into a folder of their own inside of the one that they are for, so on the same disk. When all
//! are whole, the old ones of their names are moved away, the new ones take their places, and then the old ones are
//! removed; whatever fails before that is undone. Files of other names are never touched.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use fspid_scenario::apart;

use super::{OutputError, failed, flush, make_folder, place, write_all};

/// What the names of folders begin with in which new files are written; one that is left was cut off.
const NEW: &str = ".fspid-new-";
/// What those begin with in which old files wait until the new ones stand.
const OLD: &str = ".fspid-old-";
// Both begin with `super::UNFINISHED`.

/// Files with their names in the folder, `/` in them where they lie in a folder of it.
pub type Contents<'a> = Vec<(&'a str, &'a [u8])>;

/// True if the folder is not there or holds nothing but what a writing that was cut off has left.
///
/// # Errors
/// Why it cannot be known; [`io::ErrorKind::NotADirectory`] for a file, and for a link to nothing.
pub fn is_free(folder: &Path) -> io::Result<bool> {
    let entries = match folder.read_dir() {
        Err(error) if error.kind() == io::ErrorKind::NotFound => {
            let is_link = folder.symlink_metadata().is_ok();
            return if is_link { Err(io::ErrorKind::NotADirectory.into()) } else { Ok(true) };
        }
        entries => entries?,
    };
    for entry in entries {
        if !entry?.file_name().to_string_lossy().starts_with(NEW) {
            return Ok(false);
        }
    }
    Ok(true)
}

/// Writes all files of all folders, or none.
///
/// # Errors
/// [`OutputError`] with the file that could not be written; every folder is then as it was.
pub fn write_folders(folders: &[(&Path, Contents<'_>)]) -> Result<(), OutputError> {
    // What is undone stands in the order in which it is not: moves first, folders that were made last.
    let mut made = Made::default();
    let mut new = Vec::new();
    for (folder, contents) in folders {
        new.push(staged(folder, contents, &mut made)?);
    }
    let mut moved = Moved::default();
    let mut old = Vec::new();
    for ((folder, contents), new) in folders.iter().zip(&new) {
        let away = beside(folder, OLD)?.keep();
        made.0.push(away.clone());
        for (name, _) in contents {
            // A link stays one, and what it leads to is written.
            let place = apart::target(&folder.join(name));
            made.folder(place.parent().unwrap_or(folder))?;
            moved.place(&new.path().join(name), &place, &away)?;
        }
        flush(folder);
        old.push(away);
    }
    moved.0.clear();
    made.0.clear();
    // An old file that stays in its folder is no reason to say that the new ones are not there.
    old.iter().for_each(|away| drop(fs::remove_dir_all(away)));
    Ok(())
}

/// Folders that were made, which are removed where they are empty.
#[derive(Default)]
struct Made(Vec<PathBuf>);

impl Made {
    fn folder(&mut self, folder: &Path) -> Result<(), OutputError> {
        let missing = |it: &&Path| !it.as_os_str().is_empty() && !it.exists();
        let missing: Vec<&Path> = folder.ancestors().take_while(missing).collect();
        self.0.extend(missing.into_iter().rev().map(Path::to_owned));
        make_folder(folder)
    }
}

impl Drop for Made {
    fn drop(&mut self) {
        self.0.iter().rev().for_each(|folder| drop(fs::remove_dir(folder)));
    }
}

/// Files that were moved: from where, and to where; they are moved back.
#[derive(Default)]
struct Moved(Vec<[PathBuf; 2]>);

impl Moved {
    /// Moves what stands at a place away, and the new file there.
    fn place(&mut self, new: &Path, place: &Path, away: &Path) -> Result<(), OutputError> {
        if place.is_dir() {
            return Err(failed(place, io::ErrorKind::IsADirectory.into()));
        }
        let failed = |reason| failed(place, reason);
        if place.symlink_metadata().is_ok() {
            let name = place.file_name().unwrap_or_default().to_string_lossy();
            let away = away.join(format!("{}-{name}", self.0.len()));
            // With a second name for the old file its place is never empty; not every file system has one.
            let named = fs::hard_link(place, &away).or_else(|_| fs::rename(place, &away));
            named.map_err(failed)?;
            self.0.push([place.to_owned(), away]);
        }
        fs::rename(new, place).map_err(failed)?;
        self.0.push([new.to_owned(), place.to_owned()]);
        Ok(())
    }
}

impl Drop for Moved {
    fn drop(&mut self) {
        for [from, to] in self.0.iter().rev() {
            // Of two names of one file both stay.
            if fs::rename(to, from).is_ok() {
                let _ = fs::remove_file(to);
            }
        }
    }
}

/// The files in a folder of their own, on the disk.
fn staged(
    folder: &Path,
    contents: &Contents<'_>,
    made: &mut Made,
) -> Result<tempfile::TempDir, OutputError> {
    made.folder(folder)?;
    remove_cut_off(folder);
    let new = beside(folder, NEW)?;
    let mut files = Vec::new();
    for (name, bytes) in contents {
        let at = folder.join(name);
        place(&at).map_err(|reason| failed(&at, reason))?;
        let path = new.path().join(name);
        let above = path.parent().unwrap_or(folder);
        make_folder(above).map_err(|error| failed(&folder.join(name), error.reason))?;
        files.push((path, *bytes));
    }
    write_all(&files).map_err(|error| {
        let name = error.path.strip_prefix(new.path()).unwrap_or(&error.path);
        failed(&folder.join(name), error.reason)
    })?;
    Ok(new)
}

/// Removes what a writing that was cut off has left, which takes up the disk and is nobody's.
fn remove_cut_off(folder: &Path) {
    let entries = folder.read_dir().into_iter().flatten().flatten();
    let is_left = |name: &std::ffi::OsString| name.to_string_lossy().starts_with(NEW);
    for entry in entries.filter(|entry| is_left(&entry.file_name())) {
        let _ = fs::remove_dir_all(entry.path());
    }
}

fn beside(folder: &Path, kind: &str) -> Result<tempfile::TempDir, OutputError> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(kind).tempdir_in(folder).map_err(|reason| failed(folder, reason))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn contents(files: &[(&'static str, &'static str)]) -> Contents<'static> {
        files.iter().map(|(name, text)| (*name, text.as_bytes())).collect()
    }

    fn read(path: impl AsRef<Path>) -> String {
        fs::read_to_string(path).expect("a file")
    }

    /// Four of ten files were the new ones, and "nothing there was changed".
    #[test]
    fn where_one_file_cannot_be_placed_every_folder_is_as_it_was() {
        let root = tempfile::tempdir().expect("a folder");
        let [one, two] = ["one", "made/two"].map(|name| root.path().join(name));
        let old = contents(&[("a.c", "old"), ("deep/b.c", "old")]);
        write_folders(&[(&one, old)]).expect("written");
        fs::write(one.join("own.c"), "mine").expect("written");
        // A folder stands where the last file belongs.
        fs::create_dir_all(one.join("deep/c.c/d")).expect("a folder");
        let new = || {
            contents(&[
                ("a.c", "new"),
                ("deep/b.c", "new"),
                ("new/e.c", "new"),
                ("deep/c.c", "new"),
            ])
        };
        let told = write_folders(&[(&two, new()), (&one, new())]).expect_err("refused").to_string();
        assert!(told.contains("c.c: it is a folder; nothing there was changed"), "{told}");
        assert_eq!(
            ["a.c", "deep/b.c", "own.c"].map(|it| read(one.join(it))),
            ["old", "old", "mine"]
        );
        assert_eq!(fs::read_dir(&one).expect("listed").count(), 3, "nothing is left beside");
        assert!(one.join("deep/c.c/d").is_dir() && !root.path().join("made").exists());
        fs::remove_dir_all(one.join("deep/c.c")).expect("removed");
        write_folders(&[(&two, new()), (&one, new())]).expect("written");
        assert_eq!(
            ["a.c", "deep/c.c", "own.c"].map(|it| read(one.join(it))),
            ["new", "new", "mine"]
        );
        assert_eq!(fs::read_dir(&one).expect("listed").count(), 4);
    }

    #[test]
    fn a_folder_with_what_was_cut_off_is_free_and_a_file_or_a_link_to_nothing_is_none() {
        let root = tempfile::tempdir().expect("a folder");
        let folder = root.path().join("it");
        assert!(is_free(&folder).is_ok_and(|it| it));
        fs::create_dir_all(folder.join(".fspid-new-1")).expect("a folder");
        assert!(is_free(&folder).is_ok_and(|it| it));
        write_folders(&[(&folder, contents(&[("a.c", "new")]))]).expect("written");
        assert_eq!(fs::read_dir(&folder).expect("listed").count(), 1);
        assert!(is_free(&folder).is_ok_and(|it| !it));
        let is_none =
            |path: &Path| is_free(path).is_err_and(|it| it.kind() == io::ErrorKind::NotADirectory);
        assert!(is_none(&folder.join("a.c")));
        #[cfg(unix)]
        {
            let link = root.path().join("link");
            std::os::unix::fs::symlink("nothing", &link).expect("a link");
            assert!(is_none(&link));
        }
    }
}
