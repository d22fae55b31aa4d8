//! Files that are read and files that are written, kept apart: by which file each is, and not by what it is called.
//!
//! A program says once which files it was asked to write ([`declare`]). From then on a file that is read must be none of
//! them, and a file that is written must be none that was read. Who answers one question after the other, as a library
//! does, says of each which files it is made of ([`protect`]). Who says nothing is asked nothing.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, OnceLock, PoisonError};

/// Most links that are followed from one to the next, as Linux does (path_resolution(7)).
const MOST_LINKS: usize = 40;

/// Which file a path leads to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Identity {
    /// One that is there: its device, and its number on it.
    #[cfg(unix)]
    There(u64, u64),
    /// One that is not there yet: its folder from the root, and its name in small letters, which file systems that do not
    /// tell letters apart have for one.
    Named(PathBuf, String),
}

impl Identity {
    /// Of the file at a path; none of a folder, a device, a pipe or a standard stream, where nothing can be lost.
    #[must_use]
    pub fn of(path: &Path) -> Option<Self> {
        if path == Path::new("-") {
            return None;
        }
        match fs::metadata(path) {
            Ok(found) => Self::there(path, &found),
            Err(_) => {
                let place = target(path);
                Some(Self::named(&from_root(folder_of(&place)), &place))
            }
        }
    }

    /// Of a file that is open, as standard output may be.
    #[cfg(unix)]
    #[must_use]
    pub fn of_open(file: &fs::File) -> Option<Self> {
        Self::there(Path::new(""), &file.metadata().ok()?)
    }

    #[cfg(unix)]
    fn there(_: &Path, found: &fs::Metadata) -> Option<Self> {
        use std::os::unix::fs::MetadataExt as _;
        found.is_file().then(|| Self::There(found.dev(), found.ino()))
    }

    #[cfg(not(unix))]
    fn there(path: &Path, found: &fs::Metadata) -> Option<Self> {
        let path = path.canonicalize().ok().filter(|_| found.is_file())?;
        Some(Self::named(folder_of(&path), &path))
    }

    fn named(folder: &Path, path: &Path) -> Self {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        Self::Named(folder.to_owned(), name.to_lowercase())
    }
}

/// Where links lead in the end, also to a file that is not there; the path itself where it is no link.
#[must_use]
pub fn target(path: &Path) -> PathBuf {
    let mut at = path.to_owned();
    for _ in 0..MOST_LINKS {
        let Ok(next) = fs::read_link(&at) else { break };
        at = at.parent().unwrap_or(Path::new("")).join(next);
    }
    at
}

/// The folder that a file lies in.
#[must_use]
pub fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    }
}

/// A folder's path from the root, links followed as far as it is there.
#[must_use]
pub fn from_root(folder: &Path) -> PathBuf {
    let path = std::path::absolute(folder).unwrap_or_else(|_| folder.to_owned());
    let is_there = path.ancestors().find_map(|above| Some((above, above.canonicalize().ok()?)));
    is_there.map_or_else(
        || path.clone(),
        |(above, found)| {
            path.strip_prefix(above).map_or_else(|_| path.clone(), |it| found.join(it))
        },
    )
}

/// A file as a command line names it.
#[derive(Clone, Debug)]
pub struct Named {
    /// The argument, such as `--trace`.
    pub argument: String,
    /// The path that was given for it.
    pub path: PathBuf,
    /// Which file that is.
    pub identity: Identity,
}

impl Named {
    /// The file at a path; none where nothing can be lost.
    #[must_use]
    pub fn new(argument: String, path: &Path) -> Option<Self> {
        Some(Self { argument, path: path.to_owned(), identity: Identity::of(path)? })
    }

    fn words(&self) -> String {
        match self.path.as_os_str().is_empty() {
            true => self.argument.clone(),
            false => format!("{} {}", self.argument, self.path.display()),
        }
    }
}

/// Why a file may not be written: it would be written over what is read, or over what else is written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Clash(String);

impl std::fmt::Display for Clash {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for Clash {}

/// The first output that is the file of an input or of another output.
#[must_use]
pub fn clash(inputs: &[Named], outputs: &[Named]) -> Option<Clash> {
    (1..).zip(outputs).find_map(|(next, output)| {
        let is_same = |it: &&Named| it.identity == output.identity;
        let own = "an output needs a file of its own";
        let over = |input: &Named| {
            let (output, input) = (output.words(), input.words());
            Clash(format!(
                "{output} would be written over {input}, which is read: they are one file; {own}"
            ))
        };
        let both = |other: &Named| {
            Clash(format!("{} and {} are one file; {own}", output.words(), other.words()))
        };
        let others = outputs.get(next..).unwrap_or_default();
        let read = inputs.iter().find(is_same).map(over);
        read.or_else(|| others.iter().find(is_same).map(both))
    })
}

/// What this process was asked to write.
static OUTPUTS: OnceLock<Vec<Named>> = OnceLock::new();
/// What it has read.
static READ: Mutex<Vec<(PathBuf, Identity)>> = Mutex::new(Vec::new());

/// What answers are made of that are asked for or written just now, each with the number of who says so.
static PROTECTED: Mutex<Vec<(u64, PathBuf)>> = Mutex::new(Vec::new());

/// Files that nothing is written over as long as this lives.
#[derive(Debug)]
pub struct Protected(u64);

/// Lets nothing be written over these files, by whichever name, until the answer is dropped.
#[must_use]
pub fn protect(files: impl IntoIterator<Item = PathBuf>) -> Protected {
    static NEXT: AtomicU64 = AtomicU64::new(0);
    let number = NEXT.fetch_add(1, Ordering::Relaxed);
    let mut protected = PROTECTED.lock().unwrap_or_else(PoisonError::into_inner);
    protected.extend(files.into_iter().map(|path| (number, path)));
    Protected(number)
}

impl Drop for Protected {
    fn drop(&mut self) {
        let mut protected = PROTECTED.lock().unwrap_or_else(PoisonError::into_inner);
        protected.retain(|(number, _)| *number != self.0);
    }
}

/// Says what this process was asked to write, once and before it reads anything.
pub fn declare(outputs: Vec<Named>) {
    let _ = OUTPUTS.set(outputs);
}

/// Refuses to read what is to be written; what is read is known from here on.
///
/// # Errors
/// [`Clash`] with the argument that names the file as an output.
pub fn reading(path: &Path) -> Result<(), Clash> {
    let Some(outputs) = OUTPUTS.get() else { return Ok(()) };
    let Some(identity) = Identity::of(path) else { return Ok(()) };
    let clash = clash_of(outputs, &identity);
    note(path, identity);
    clash.map_or(Ok(()), Err)
}

/// As [`reading`], of a file that the program itself may write anew: a part that turns out to be damaged, a state.
///
/// # Errors
/// As [`reading`].
pub fn reading_own(path: &Path) -> Result<(), Clash> {
    let Some(outputs) = OUTPUTS.get().filter(|outputs| !outputs.is_empty()) else { return Ok(()) };
    let Some(identity) = Identity::of(path) else { return Ok(()) };
    let Some(clash) = clash_of(outputs, &identity) else { return Ok(()) };
    // Whoever goes on without the file does not write over it later.
    note(path, identity);
    Err(clash)
}

fn note(path: &Path, identity: Identity) {
    let mut read = READ.lock().unwrap_or_else(PoisonError::into_inner);
    if read.iter().all(|(_, known)| *known != identity) {
        read.push((path.to_owned(), identity));
    }
}

fn clash_of(outputs: &[Named], identity: &Identity) -> Option<Clash> {
    let output = outputs.iter().find(|output| output.identity == *identity)?;
    Some(Clash(format!(
        "{} would be written over it: they are one file; an output needs a file of its own",
        output.words()
    )))
}

/// True for a file that was read, also where it was refused then.
#[must_use]
pub fn was_read(identity: &Identity) -> bool {
    let read = READ.lock().unwrap_or_else(PoisonError::into_inner);
    read.iter().any(|(_, known)| known == identity)
}

/// Refuses to write over what was read or is protected, and a file that no argument names over one that an argument does.
///
/// # Errors
/// [`Clash`] with the other one.
pub fn writing(path: &Path) -> Result<(), Clash> {
    let Some(identity) = Identity::of(path) else { return Ok(()) };
    over_protected(&identity)?;
    let Some(outputs) = OUTPUTS.get() else { return Ok(()) };
    let read = READ.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some((path, _)) = read.iter().find(|(_, known)| *known == identity) {
        return Err(over(path));
    }
    let is_now = |output: &&Named| {
        output.identity == identity || Identity::of(&output.path).as_ref() == Some(&identity)
    };
    match outputs.iter().all(|output| output.path != path) {
        true => outputs.iter().find(is_now).map_or(Ok(()), |output| {
            Err(Clash(format!("it is the file of {}; each needs one of its own", output.words())))
        }),
        false => Ok(()),
    }
}

fn over_protected(identity: &Identity) -> Result<(), Clash> {
    let protected = PROTECTED.lock().unwrap_or_else(PoisonError::into_inner);
    // Which file that is by now: it may have been replaced since it was read.
    let found = protected.iter().find(|(_, path)| Identity::of(path).as_ref() == Some(identity));
    found.map_or(Ok(()), |(_, path)| Err(over(path)))
}

fn over(known: &Path) -> Clash {
    Clash(format!("it is {}, which was read; write somewhere else", known.display()))
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_the_same_by_each_of_its_names() {
        let folder = tempfile::tempdir().expect("a folder");
        let at = |name: &str| folder.path().join(name);
        fs::write(at("a"), "x").expect("written");
        fs::hard_link(at("a"), at("hard")).expect("linked");
        std::os::unix::fs::symlink("a", at("soft")).expect("linked");
        std::os::unix::fs::symlink("soft", at("softer")).expect("linked");
        for name in ["./a", "hard", "soft", "softer"] {
            assert_eq!(Identity::of(&at(name)), Identity::of(&at("a")), "{name}");
        }
        fs::write(at("b"), "x").expect("written");
        assert_ne!(Identity::of(&at("b")), Identity::of(&at("a")));
        // What is no file is made here: in a container /dev/null may be one.
        let _socket = std::os::unix::net::UnixListener::bind(at("socket")).expect("bound");
        assert_eq!(Identity::of(&at("socket")), None);
        assert_eq!(Identity::of(folder.path()), None);
    }

    #[test]
    fn a_file_that_is_not_there_yet_is_the_same_in_other_letters_and_behind_a_link() {
        let folder = tempfile::tempdir().expect("a folder");
        let at = |name: &str| folder.path().join(name);
        std::os::unix::fs::symlink("new.csv", at("link")).expect("linked");
        fs::create_dir(at("deep")).expect("made");
        for name in ["NEW.csv", "link", "deep/../new.csv"] {
            assert_eq!(Identity::of(&at(name)), Identity::of(&at("new.csv")), "{name}");
        }
        assert_eq!(Identity::of(&at("none/a")), Identity::of(&at("none/./A")));
        assert_ne!(Identity::of(&at("other.csv")), Identity::of(&at("new.csv")));
    }

    /// In Python `flight.to_csv("a.toml")` wrote over the scenario.
    #[test]
    fn what_is_protected_is_not_written_over_by_any_name_and_may_be_afterwards() {
        let folder = tempfile::tempdir().expect("a folder");
        let at = |name: &str| folder.path().join(name);
        fs::write(at("a"), "x").expect("written");
        std::os::unix::fs::symlink("a", at("soft")).expect("linked");
        let [first, second] = [protect([at("a")]), protect([at("a"), at("b")])];
        for name in ["a", "soft", "./a", "B"] {
            let told = writing(&at(name)).expect_err("refused").to_string();
            assert!(told.contains("which was read"), "{name}: {told}");
        }
        assert_eq!(writing(&at("c")), Ok(()));
        drop(second);
        assert!(writing(&at("a")).is_err() && writing(&at("b")).is_ok());
        // Replaced by another file of its name, it is what it was.
        fs::write(at("new"), "y").expect("written");
        fs::rename(at("new"), at("a")).expect("moved");
        assert!(writing(&at("soft")).is_err());
        drop(first);
        assert_eq!(writing(&at("a")), Ok(()));
    }

    #[test]
    fn links_in_a_circle_come_to_an_end() {
        let folder = tempfile::tempdir().expect("a folder");
        let at = |name: &str| folder.path().join(name);
        std::os::unix::fs::symlink("two", at("one")).expect("linked");
        std::os::unix::fs::symlink("one", at("two")).expect("linked");
        assert!(target(&at("one")).is_symlink());
    }
}
