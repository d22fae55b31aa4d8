//! Files that this program writes for itself and reads again: JSON whose first line carries the digest of all that
//! follows, so that no changed byte goes unseen.
//!
//! ```text
//! {
//!   "digest": "64 hexadecimal digits",
//!   …
//! ```

use std::io::ErrorKind;
use std::path::Path;

use fspid_scenario::file::{read_own, unread_in_words};
use serde::Serialize;
use serde::de::DeserializeOwned;
use sha2::{Digest as _, Sha256};

use crate::error::TuneError;

/// What stands before the digest, and behind it.
const BEFORE: &str = "{\n  \"digest\": \"";
const BEHIND: &str = "\",\n";
/// How the text of every object with something in it begins.
const OPENED: &str = "{\n";

/// Why nothing was read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Broken {
    /// There is no digest.
    NoDigest,
    /// The digest is that of another text.
    Changed,
    /// It is as it was written, and means nothing here.
    Strange,
}

impl Broken {
    /// In words that go on after the name of the file.
    fn sentence(self) -> &'static str {
        match self {
            Self::NoDigest => {
                "it has no digest: another version wrote it, or it was changed after it was written"
            }
            Self::Changed => {
                "it was changed after it was written: its digest is that of another text"
            }
            Self::Strange => "it was saved by another version",
        }
    }
}

/// The text of an object with its digest.
pub(crate) fn text(value: &impl Serialize) -> String {
    let text = format!("{:#}\n", serde_json::to_value(value).unwrap_or_default());
    let rest = text.strip_prefix(OPENED).unwrap_or(&text);
    format!("{BEFORE}{}{BEHIND}{rest}", digest(rest))
}

/// What a file with such a text holds.
///
/// # Errors
/// [`TuneError::Changed`], and [`TuneError::State`] for what cannot be read, or means nothing here.
pub(crate) fn read_file<T: DeserializeOwned>(path: &Path) -> Result<T, TuneError> {
    let name = path.display().to_string();
    let state = |reason: String| TuneError::State { path: name.clone(), reason };
    let text = match read_own(path) {
        Ok(text) => Ok(text),
        // No UTF-8.
        Err(error) if error.kind() == ErrorKind::InvalidData => Err(Broken::Changed),
        Err(error) => return Err(state(unread_in_words(&error))),
    };
    text.and_then(|text| read(&text)).map_err(|broken| match broken {
        Broken::Strange => state(broken.sentence().to_owned()),
        Broken::NoDigest | Broken::Changed => {
            TuneError::Changed { path: name.clone(), reason: broken.sentence().to_owned() }
        }
    })
}

/// What such a text holds.
fn read<T: DeserializeOwned>(text: &str) -> Result<T, Broken> {
    let sealed = text.strip_prefix(BEFORE).and_then(|text| text.split_once(BEHIND));
    let (found, rest) = sealed.ok_or(Broken::NoDigest)?;
    if found != digest(rest) {
        return Err(Broken::Changed);
    }
    serde_json::from_str(&format!("{OPENED}{rest}")).map_err(|_| Broken::Strange)
}

fn digest(text: &str) -> String {
    Sha256::digest(text).iter().map(|byte| format!("{byte:02x}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    #[test]
    fn every_changed_lost_or_added_byte_is_seen() {
        let value = BTreeMap::from([("a".to_owned(), vec![1.5, -0.25]), ("b".to_owned(), vec![])]);
        let text = text(&value);
        assert_eq!(read::<BTreeMap<String, Vec<f64>>>(&text), Ok(value));
        for place in 0..text.len() {
            let mut bytes = text.clone().into_bytes();
            bytes[place] ^= 1;
            let changed = String::from_utf8(bytes).expect("still ASCII");
            let lost = [&text[..place], &text[place + 1..]].concat();
            let added = [&text[..place], " ", &text[place..]].concat();
            for wrong in [changed, lost, added] {
                let found = read::<BTreeMap<String, Vec<f64>>>(&wrong);
                assert!(matches!(found, Err(Broken::NoDigest | Broken::Changed)), "{wrong}");
            }
        }
        assert_eq!(read::<BTreeMap<String, bool>>(&text), Err(Broken::Strange));
    }
}
