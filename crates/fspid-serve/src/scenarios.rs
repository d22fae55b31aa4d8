//! The scenarios that a person has opened: found, read, and saved whole or not at all.
//!
//! A client names a scenario by an id, which is looked up among those that were found; no path is ever made of what it
//! sends.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use axum::http::StatusCode;
use fspid_diagnostics::{Problem, Problems};
use fspid_scenario::file::{self, Study};
use fspid_scenario::fuzzy_system::is_scenario;
use fspid_study::output;
use fspid_tune::Written;
use serde_json::{Value, json};
use sha2::{Digest as _, Sha256};

use crate::answer::Refusal;
use crate::settings::Opened;

/// How deep below the folder scenarios are looked for.
const MOST_DEEP: usize = 8;
/// Entries of folders that are looked at.
const MOST_ENTRIES: usize = 20_000;
/// Scenarios that are shown.
const MOST_SCENARIOS: usize = 1000;
/// Cases of a text that are read when it is saved. Each is the whole text once more, and a text may be of thousands.
const MOST_CASES: usize = 512;
/// Folders in which nobody writes scenarios, beside those whose names begin with a dot.
const OTHERS: [&str; 2] = ["target", "node_modules"];

/// What is opened.
#[derive(Debug)]
pub(crate) struct Shelf {
    /// The folder from the root, without links.
    root: PathBuf,
    /// The scenario that is opened alone; it may be a link to another folder, since a person has named it.
    only: Option<PathBuf>,
    /// What was found, by its id.
    known: Mutex<BTreeMap<String, Found>>,
    /// Held while a scenario is compared and saved.
    saving: Mutex<()>,
}

/// A scenario that was found.
#[derive(Clone, Debug)]
struct Found {
    path: PathBuf,
    name: String,
}

/// A scenario that was read.
#[derive(Clone, Debug)]
pub(crate) struct Scenario {
    pub(crate) id: String,
    pub(crate) name: String,
    pub(crate) text: String,
    pub(crate) digest: String,
}

impl Shelf {
    /// What a person opens.
    ///
    /// # Errors
    /// What cannot be opened, in words.
    pub(crate) fn open(opened: &Opened) -> Result<Self, String> {
        let (folder, only) = match opened {
            Opened::Folder(folder) => (folder.clone(), None),
            Opened::Scenario(path) => {
                (fspid_scenario::apart::folder_of(path).to_owned(), Some(path))
            }
        };
        let unread = |path: &Path, reason: &std::io::Error| {
            format!("{}: {}", path.display(), file::unread_in_words(reason))
        };
        if let Some(path) = only {
            file::open_regular(path).map_err(|reason| unread(path, &reason))?;
        }
        let root = folder.canonicalize().map_err(|reason| unread(&folder, &reason))?;
        fs::read_dir(&root).map_err(|reason| match root.is_dir() {
            true => unread(&folder, &reason),
            false => format!("{}: it is neither a scenario nor a folder", folder.display()),
        })?;
        let only = only.map(|path| root.join(path.file_name().unwrap_or_default()));
        let (known, saving) = (Mutex::default(), Mutex::default());
        Ok(Self { root, only, known, saving })
    }

    /// `[{id, name}]`, in the order of the names.
    pub(crate) fn list(&self) -> Value {
        let found = self.found();
        let mut rows: Vec<(&String, &String)> =
            found.iter().map(|(id, found)| (&found.name, id)).collect();
        rows.sort();
        let rows = rows.into_iter().map(|(name, id)| json!({ "id": id, "name": name }));
        let list = rows.collect();
        *self.known.lock().unwrap_or_else(PoisonError::into_inner) = found;
        list
    }

    /// The scenario with an id.
    pub(crate) fn read(&self, id: &str) -> Result<Scenario, Refusal> {
        let found = self.find(id)?;
        let bytes = file::read_regular(&found.path)
            .map_err(|reason| Refusal::missing(format_args!("{}: {reason}", found.name)))?;
        let digest = digest(&bytes);
        let text = String::from_utf8(bytes).map_err(|error| {
            let at = error.utf8_error().valid_up_to();
            let sentence = format!("{}: not UTF-8 from byte {at} on", found.name);
            Refusal::new(StatusCode::UNPROCESSABLE_ENTITY, sentence)
        })?;
        Ok(Scenario { id: id.to_owned(), name: found.name, text, digest })
    }

    /// Saves a scenario, unless its file is another than the one that the person has seen. A text with problems is saved
    /// too, for somebody works on it; they are told.
    pub(crate) fn save(&self, id: &str, text: &str, seen: &str) -> Result<Value, Refusal> {
        let saving = self.saving.lock().unwrap_or_else(PoisonError::into_inner);
        let now = self.read(id)?;
        if now.digest != seen {
            let sentence = format!("{} has changed since it was read", now.name);
            let refusal = Refusal::new(StatusCode::CONFLICT, sentence).with("digest", now.digest);
            return Err(refusal.with("text", now.text));
        }
        let found = self.find(id)?;
        output::write(&found.path, text).map_err(|error| {
            let reason = output::in_words(&error.reason);
            let sentence = format!("{}: {reason}; the file is as it was", found.name);
            Refusal::new(StatusCode::INSUFFICIENT_STORAGE, sentence)
        })?;
        // A contest of a hundred cases is read a hundred times: nobody else waits for that.
        drop(saving);
        let told = json!({ "digest": digest(text.as_bytes()), "problems": problems(&found, text) });
        Ok(told)
    }

    /// Where the scenario with an id lies.
    pub(crate) fn path(&self, id: &str) -> Result<PathBuf, Refusal> {
        self.find(id).map(|found| found.path)
    }

    /// The scenario with an id, if it still lies where it may.
    fn find(&self, id: &str) -> Result<Found, Refusal> {
        let missing = || Refusal::missing("there is no such scenario");
        if !is_id(id) {
            return Err(missing());
        }
        let known = self.known.lock().unwrap_or_else(PoisonError::into_inner).get(id).cloned();
        let found = known.or_else(|| {
            self.list();
            self.known.lock().unwrap_or_else(PoisonError::into_inner).get(id).cloned()
        });
        found.filter(|found| self.is_within(&found.path)).ok_or_else(missing)
    }

    /// True for a regular file below the folder, or the one that a person has named, wherever links lead.
    fn is_within(&self, path: &Path) -> bool {
        let is_own = self.only.as_deref() == Some(path)
            || path.canonicalize().is_ok_and(|place| place.starts_with(&self.root));
        is_own && fs::metadata(path).is_ok_and(|data| data.is_file())
    }

    /// What there is now.
    fn found(&self) -> BTreeMap<String, Found> {
        let paths = match &self.only {
            Some(path) => vec![path.clone()],
            None => {
                let (mut paths, mut entries) = (Vec::new(), 0);
                self.walk(&self.root, 0, &mut entries, &mut paths);
                paths
            }
        };
        let row = |path: PathBuf| {
            let below = path.strip_prefix(&self.root).unwrap_or(&path);
            let id = digest(below.as_os_str().as_encoded_bytes()).get(..ID_DIGITS)?.to_owned();
            let steps = below.components().map(|step| step.as_os_str().to_string_lossy());
            let name = steps.collect::<Vec<_>>().join("/");
            Some((id, Found { path, name }))
        };
        paths.into_iter().filter_map(row).collect()
    }

    fn walk(&self, folder: &Path, deep: usize, entries: &mut usize, paths: &mut Vec<PathBuf>) {
        let Ok(listed) = fs::read_dir(folder) else { return };
        let mut listed: Vec<_> = listed.flatten().collect();
        // The same ones are left out each time where there are too many.
        listed.sort_by_key(fs::DirEntry::file_name);
        for entry in listed {
            *entries += 1;
            if *entries > MOST_ENTRIES || paths.len() >= MOST_SCENARIOS {
                return;
            }
            let (path, name) = (entry.path(), entry.file_name());
            let name = name.to_string_lossy();
            if name.starts_with('.') {
                continue;
            }
            // Folders behind links are not entered: they may lead in a circle.
            let is_folder = entry.file_type().is_ok_and(|kind| kind.is_dir());
            if is_folder && deep < MOST_DEEP && !OTHERS.contains(&name.as_ref()) {
                self.walk(&path, deep + 1, entries, paths);
            } else if !is_folder && name.ends_with(".toml") && self.is_within(&path) {
                // A name that is no text is none that anybody could be shown.
                paths.extend(path.to_str().is_some_and(is_scenario).then_some(path));
            }
        }
    }
}

/// Digits of an id.
const ID_DIGITS: usize = 32;

fn is_id(text: &str) -> bool {
    text.len() == ID_DIGITS && text.bytes().all(|c| matches!(c, b'0'..=b'9' | b'a'..=b'f'))
}

/// SHA-256 in hexadecimal digits.
pub(crate) fn digest(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}

/// What is wrong with the text of a scenario, and with what its dispersions and cases make of it, as `fspid check` tells it
/// in JSON; none where nothing is.
fn problems(found: &Found, text: &str) -> Value {
    let (name, folder) = (found.name.as_str(), found.path.parent());
    let written = Written { text, name, folder, overrides: &[] };
    let template = match written.template() {
        Ok(template) => template,
        Err(problems) => return problems.to_json(),
    };
    match cases(template.study()) {
        count if count > MOST_CASES => {
            let allowed = format!("up to {MOST_CASES} are read here; `fspid check` reads all");
            let problem = Problem::whole(format!("{count} cases"), allowed);
            Problems::new(name, vec![problem], 0).to_json()
        }
        _ => written.check_beyond(&template).err().map_or(Value::Null, |wrong| wrong.to_json()),
    }
}

/// How many cases a scenario is tuned on and judged by.
fn cases(study: &Study) -> usize {
    let tuned = study.tuning.as_ref().map_or(0, |it| it.cases.len());
    tuned + study.contest.as_ref().map_or(0, |it| it.cases.len())
}
