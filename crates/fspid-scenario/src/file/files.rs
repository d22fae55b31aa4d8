//! The files that a file refers to, and the digest of all that was read.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use sha2::{Digest as _, Sha256};

use crate::file::overrides::Change;
use crate::keyed::Section;
use crate::keyed::Table;
use crate::keyed::document::Item;
use crate::regular_file::{read_program, read_regular, unread_in_words};
use fspid_diagnostics::Report;

/// Why a file cannot be referred to.
const NO_FOLDER: &str = "this scenario is not in a folder, so it cannot refer to files";

/// Where a file lies, from the root, and what is in it.
type Found = (PathBuf, Arc<[u8]>);

/// What was read, by its path. A scenario that is built again and again is built of the same bytes,
/// whatever became of its files meanwhile: those that its digest is of.
#[derive(Clone, Debug, Default)]
pub(crate) struct Kept(Arc<Mutex<BTreeMap<PathBuf, Found>>>);

impl Kept {
    fn read(
        &self,
        path: PathBuf,
        read: fn(&Path) -> Result<Vec<u8>, String>,
    ) -> Result<Found, String> {
        let mut kept = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(found) = kept.get(&path) {
            return Ok(found.clone());
        }
        let bytes: Arc<[u8]> = read(&path)?.into();
        let root = path.canonicalize().map_err(|error| unread_in_words(&error))?;
        let found = (root, bytes);
        kept.insert(path, found.clone());
        Ok(found)
    }
}

/// Reads files and keeps the digest of everything read, and what plant and aircraft files say.
pub(crate) struct Files<'a> {
    folder: Option<&'a Path>,
    hasher: Sha256,
    kept: Kept,
    /// Path of the key that refers to a file, the file's specification, and what it says.
    referred: Vec<(String, &'static Table, Section)>,
    /// Path of a key that is left out, and the word that a file makes its default.
    filled: Vec<(String, &'static str)>,
    /// Changes that wait for the file that they are in, and whether it came.
    changes: Vec<(Change, bool)>,
    /// What files say that were changed, before the changes, by the path of the key that names them.
    written: Vec<(String, Item)>,
    /// Files that were read, as the scenario names them, each once.
    names: Vec<String>,
    /// What was read, by the path of the key that names it; kept if asked for.
    documents: Option<Vec<(String, Item)>>,
}

impl<'a> Files<'a> {
    /// Relative paths are those of `folder`; without one, no file can be referred to.
    pub(crate) fn new(folder: Option<&'a Path>) -> Self {
        Self {
            folder,
            hasher: Sha256::new(),
            kept: Kept::default(),
            referred: Vec::new(),
            filled: Vec::new(),
            changes: Vec::new(),
            written: Vec::new(),
            names: Vec::new(),
            documents: None,
        }
    }

    /// The same with what was read before.
    pub(crate) fn of_kept(folder: Option<&'a Path>, kept: &Kept) -> Self {
        Self { kept: kept.clone(), ..Self::new(folder) }
    }

    /// For the same scenario with another value: the same changes wait, and what was read is read no more.
    pub(crate) fn again(&self) -> Self {
        let changes = self.changes().map(|change| (change.clone(), false)).collect();
        Self { changes, ..Self::of_kept(self.folder, &self.kept) }
    }

    /// Keeps what the file says that the key at `path` refers to.
    pub(crate) fn keep(&mut self, path: String, spec: &'static Table, section: Section) {
        self.referred.push((path, spec, section));
    }

    /// Keeps the default of the key at `path`, which depends on what a file says.
    pub(crate) fn fill(&mut self, path: String, word: &'static str) {
        self.filled.push((path, word));
    }

    /// The default of the key at `path`, if what a file says makes it.
    pub(crate) fn filled(&self, path: &str) -> Option<&'static str> {
        let (_, word) = self.filled.iter().find(|(at, _)| at == path)?;
        Some(word)
    }

    /// Keeps a change until the file has been read that it is in.
    pub(crate) fn change(&mut self, change: Change) {
        self.changes.push((change, false));
    }

    /// The changes that wait.
    pub(crate) fn changes(&self) -> impl Iterator<Item = &Change> {
        self.changes.iter().map(|(change, _)| change)
    }

    /// Changes what the file says that the key at `path` refers to; every file passes here.
    pub(crate) fn apply_changes(&mut self, report: &mut Report, path: &str, document: &mut Item) {
        if self.changes.iter().any(|(change, _)| change.path == path) {
            self.written.push((path.to_owned(), document.clone()));
        }
        for (change, used) in self.changes.iter_mut().filter(|(change, _)| change.path == path) {
            change.apply(report, document);
            *used = true;
        }
        if let Some(documents) = &mut self.documents {
            documents.push((path.to_owned(), document.clone()));
        }
    }

    /// What the file says that the key at `path` names, without the changes; none where there are no changes.
    pub(crate) fn written(&self, path: &str) -> Option<&Item> {
        let (_, document) = self.written.iter().find(|(at, _)| at == path)?;
        Some(document)
    }

    /// Keeps what is read from here on.
    pub(crate) fn keep_documents(&mut self) {
        self.documents = Some(Vec::new());
    }

    /// What was read that the key at `path` names.
    pub(crate) fn document(&self, path: &str) -> Option<&Item> {
        let mut documents = self.documents.iter().flatten();
        documents.find(|(at, _)| at == path).map(|(_, document)| document)
    }

    /// Reports changes whose file never came, where nothing else explains that.
    pub(crate) fn report_unused_changes(&self, report: &mut Report) {
        if report.count() == 0 {
            let unused = self.changes.iter().filter(|(_, used)| !used);
            unused.for_each(|(change, _)| change.report_unused(report));
        }
    }

    /// What the file says that the key at `path` refers to.
    pub(crate) fn referred(&self, path: &str) -> Option<(&'static Table, &Section)> {
        let (_, spec, section) = self.referred.iter().find(|(at, ..)| at == path)?;
        Some((spec, section))
    }

    /// Adds a text to the digest, with its length, so that no two sets of texts look alike.
    pub(crate) fn digest(&mut self, text: &str) {
        self.digest_bytes(text.as_bytes());
    }

    fn name(&mut self, path: &str) {
        if !self.names.iter().any(|name| name == path) {
            self.names.push(path.to_owned());
        }
    }

    /// Adds the files of another reading to the digest and to the names, if there are any that were not read here.
    pub(crate) fn join(&mut self, other: Self) {
        let is_new = |name: &&String| !self.names.contains(name);
        let new: Vec<String> = other.names.iter().filter(is_new).cloned().collect();
        if !new.is_empty() {
            self.names.extend(new);
            self.digest(&other.finish());
        }
    }

    /// Files that were read, as the scenario names them.
    pub(crate) fn names(&self) -> &[String] {
        &self.names
    }

    /// The digest in hexadecimal digits.
    pub(crate) fn finish(self) -> String {
        let bytes = self.hasher.finalize();
        bytes.iter().map(|byte| format!("{byte:02x}")).collect()
    }

    /// Adds bytes to the digest as [`digest`](Self::digest) adds a text.
    fn digest_bytes(&mut self, bytes: &[u8]) {
        self.hasher.update((bytes.len() as u64).to_le_bytes());
        self.hasher.update(bytes);
    }

    /// Where a program lies that is referred to, from the root, and its bytes; what it is goes into the digest.
    pub(crate) fn program(&mut self, path: &str) -> Result<Found, String> {
        let folder = self.folder.ok_or(NO_FOLDER)?;
        self.name(path);
        let (path, bytes) = self.kept.read(folder.join(path), read_program)?;
        self.digest_bytes(&bytes);
        Ok((path, bytes))
    }

    /// Where a folder of JSBSim's files lies, from the root. What is there of the aircraft, and all engines and systems, goes
    /// into the digest, each with its name.
    pub(crate) fn model_folder(&mut self, path: &str, aircraft: &str) -> Result<PathBuf, String> {
        let folder = self.folder.ok_or(NO_FOLDER)?;
        let main = format!("{path}/aircraft/{aircraft}/{aircraft}.xml");
        let said = |reason: String| format!("{main}: {reason}");
        self.kept.read(folder.join(&main), read_program).map_err(said)?;
        for part in [
            format!("{path}/aircraft/{aircraft}"),
            format!("{path}/engine"),
            format!("{path}/systems"),
        ] {
            let mut names: Vec<String> = match std::fs::read_dir(folder.join(&part)) {
                Ok(entries) => entries
                    .flatten()
                    .filter_map(|entry| entry.file_name().into_string().ok())
                    .collect(),
                Err(_) => Vec::new(),
            };
            names.sort();
            for name in names.iter().filter(|name| name.ends_with(".xml")) {
                let file = format!("{part}/{name}");
                self.name(&file);
                let (_, bytes) = self.kept.read(folder.join(&file), read_program)?;
                self.digest(name);
                self.digest_bytes(&bytes);
            }
        }
        folder.join(path).canonicalize().map_err(|error| unread_in_words(&error))
    }

    /// The text of a file that is referred to.
    // A page has no files: what only they can say is not even compiled for it.
    #[inline(always)]
    pub(crate) fn read(&mut self, path: &str) -> Result<String, String> {
        if cfg!(target_family = "wasm") { Err(NO_FOLDER.to_owned()) } else { self.read_there(path) }
    }

    fn read_there(&mut self, path: &str) -> Result<String, String> {
        let folder = self.folder.ok_or(NO_FOLDER)?;
        self.name(path);
        let (_, bytes) = self.kept.read(folder.join(path), read_regular)?;
        String::from_utf8(bytes.to_vec()).map_err(|error| {
            let position = error.utf8_error().valid_up_to();
            format!("not UTF-8 from byte {position} on")
        })
    }
}
