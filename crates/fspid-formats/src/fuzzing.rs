//! What must hold for any bytes at all, for fuzzers: `fuzz_target!(|data: &[u8]| fspid_formats::fuzzing::fcl(data));`
//!
//! A text is read or refused; what is read and can be written comes back as itself.

use crate::fcl::{self, Dialect, ReadOptions};
use crate::note::{Reading, WriteOptions, Writing};
use crate::{Note, fll, fml};
use fspid_diagnostics::Problems;
use fspid_fuzzy::system::Parts;

/// Any bytes as FCL.
///
/// # Panics
/// If something that is written does not come back as itself.
pub fn fcl(data: &[u8]) {
    let Ok(text) = str::from_utf8(data) else { return };
    let Ok(reading) = fcl::read(text) else { return };
    for dialect in [Dialect::Iec, Dialect::Fuzzylite, Dialect::JFuzzyLogic] {
        let options = ReadOptions { dialect: Some(dialect), block: None };
        comes_back(
            &reading.parts,
            |parts| fcl::write(parts, dialect, WriteOptions::default()),
            |text| fcl::read_with(text, options),
        );
    }
}

/// Any bytes as FLL.
///
/// # Panics
/// If something that is written does not come back as itself, or a system that was read cannot be
/// written.
pub fn fll(data: &[u8]) {
    let Ok(text) = str::from_utf8(data) else { return };
    let Ok(reading) = fll::read(text) else { return };
    let write = |parts: &Parts| fll::write(parts, WriteOptions::default());
    let written = comes_back(&reading.parts, write, fll::read);
    assert!(written.is_some(), "{:#?}", reading.parts);
}

/// Any bytes as FML.
///
/// # Panics
/// If something that is written does not come back as itself.
pub fn fml(data: &[u8]) {
    let Ok(text) = str::from_utf8(data) else { return };
    let Ok(reading) = fml::read(text) else { return };
    comes_back(&reading.parts, |parts| fml::write(parts, WriteOptions::default()), fml::read);
}

/// What is written reads back, and is then the same for ever. Nothing if it cannot be written.
fn comes_back(
    parts: &Parts,
    write: impl Fn(&Parts) -> Result<Writing, Problems>,
    read: impl Fn(&str) -> Result<Reading, Problems>,
) -> Option<Vec<Note>> {
    let first = write(parts).ok()?;
    let again = |text: &str| match read(text) {
        Ok(reading) => reading.parts,
        Err(problems) => panic!("{problems}\n{text}"),
    };
    let parts = again(&first.text);
    match write(&parts) {
        Ok(second) => assert_eq!(again(&second.text), parts, "{}", second.text),
        Err(problems) => panic!("{problems}\n{}", first.text),
    }
    Some(first.notes)
}
