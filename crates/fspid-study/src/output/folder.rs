//! Folders of files that belong together: all of them are the new ones, or none is.
//!
//! New files are written into a folder of their own inside of the one that they are for, so on the same disk. When all
//! are whole, the old ones of their names get a second name or are copied, the new ones take their places, and then the old
//! ones are removed; whatever fails before that is undone. So no place is ever empty, and what a process that was killed has
//! left holds nothing that is missing. Files of other names are never touched.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use fspid_scenario::apart;

use super::locked::{Locked, NotLocked};
use super::unfinished::{
    alone_in, is_unfinished, new_folder_in, remove_left_files, remove_left_folders,
};
use super::{OutputError, failed, flush, make_folder, place, write_all};

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
        if !is_unfinished(&entry?.file_name()) {
            return Ok(false);
        }
    }
    Ok(true)
}

/// What becomes of a folder with files in it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Taken {
    /// It is refused, also where they came while new ones were made.
    Refused,
    /// Those of the same names are written over.
    WrittenOver,
}

/// Writes all files of all folders, or none.
///
/// # Errors
/// [`OutputError`] with the file that could not be written; every folder is then as it was.
pub fn write_folders(folders: &[(&Path, Contents<'_>)], taken: Taken) -> Result<(), OutputError> {
    // What is undone stands in the order in which it is not: moves first, folders that were made last.
    let mut made = Made::default();
    // Of two processes the files of one would stand beside those of the other.
    let mut alone = Vec::new();
    let mut new = Vec::new();
    for (folder, contents) in folders {
        made.folder(folder)?;
        alone.push(held(folder)?);
        if taken == Taken::Refused && !is_free(folder).map_err(|reason| failed(folder, reason))? {
            return Err(failed(folder, io::Error::other("another process wrote there meanwhile")));
        }
        new.push(staged(folder, contents)?);
    }
    let mut moved = Moved::default();
    let mut old = Vec::new();
    for ((folder, contents), new) in folders.iter().zip(&new) {
        let away = beside(folder)?.keep();
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
        let failed = |reason: io::Error| failed(place, reason);
        match fs::metadata(place) {
            Ok(found) if found.is_dir() => return Err(failed(io::ErrorKind::IsADirectory.into())),
            // A pipe or a device would be gone.
            Ok(found) if !found.is_file() => {
                return Err(failed(io::Error::other("it is no regular file")));
            }
            _ => {}
        }
        if place.symlink_metadata().is_ok() {
            let name = place.file_name().unwrap_or_default().to_string_lossy();
            let away = away.join(format!("{}-{name}", self.0.len()));
            // Not every file system has second names.
            let kept = || fs::hard_link(place, &away).or_else(|_| fs::copy(place, &away).map(drop));
            kept().map_err(failed)?;
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

/// Nobody else puts files there as long as it lives.
fn held(folder: &Path) -> Result<Locked, OutputError> {
    let alone = alone_in(folder).map_err(|reason| match reason {
        NotLocked::Busy => failed(folder, io::Error::other("another process is writing there")),
        NotLocked::Failed(reason) => failed(folder, reason),
    })?;
    remove_left_files(folder);
    remove_left_folders(folder);
    Ok(alone)
}

/// The files in a folder of their own, on the disk.
fn staged(folder: &Path, contents: &Contents<'_>) -> Result<tempfile::TempDir, OutputError> {
    let new = beside(folder)?;
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

fn beside(folder: &Path) -> Result<tempfile::TempDir, OutputError> {
    new_folder_in(folder).map_err(|reason| failed(folder, reason))
}

#[cfg(test)]
mod tests {
    use super::super::unfinished::{ALONE, new_file_in};
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
        write_folders(&[(&one, old)], Taken::WrittenOver).expect("written");
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
        let told = write_folders(&[(&two, new()), (&one, new())], Taken::WrittenOver)
            .expect_err("refused")
            .to_string();
        assert!(told.contains("c.c: it is a folder; nothing there was changed"), "{told}");
        assert_eq!(
            ["a.c", "deep/b.c", "own.c"].map(|it| read(one.join(it))),
            ["old", "old", "mine"]
        );
        assert_eq!(fs::read_dir(&one).expect("listed").count(), 3, "nothing is left beside");
        assert!(one.join("deep/c.c/d").is_dir() && !root.path().join("made").exists());
        fs::remove_dir_all(one.join("deep/c.c")).expect("removed");
        write_folders(&[(&two, new()), (&one, new())], Taken::WrittenOver).expect("written");
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
        fs::create_dir_all(&folder).expect("a folder");
        // As they are made, and as they stay where their process is killed.
        let left = [beside(&folder), beside(&folder)].map(|it| it.expect("a folder").keep());
        fs::write(left[0].join("a.c"), "half").expect("written");
        let half = new_file_in(&folder).expect("a file").into_temp_path().keep().expect("kept");
        fs::write(folder.join(ALONE), "").expect("written");
        assert!(half.exists() && is_free(&folder).is_ok_and(|it| it));
        write_folders(&[(&folder, contents(&[("a.c", "new")]))], Taken::WrittenOver)
            .expect("written");
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

    #[test]
    fn one_process_at_a_time_writes_into_a_folder_and_not_over_what_came_meanwhile() {
        let root = tempfile::tempdir().expect("a folder");
        let new = || contents(&[("a.c", "new")]);
        let other = alone_in(root.path()).expect("nobody is there");
        let told = |taken| write_folders(&[(root.path(), new())], taken).expect_err("").to_string();
        assert!(told(Taken::WrittenOver).contains("another process is writing there"));
        fs::write(root.path().join("a.c"), "theirs").expect("written");
        drop(other);
        assert!(told(Taken::Refused).contains("another process wrote there meanwhile"));
        assert_eq!(read(root.path().join("a.c")), "theirs");
        assert_eq!(fs::read_dir(root.path()).expect("listed").count(), 1);
    }
}
