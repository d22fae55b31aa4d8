//! Every reader in one program, so that it is linked once: `FSPID_FUZZ_TARGET` names the one that is asked.

#![no_main]

mod certificate;
mod csv;
mod daveml;
mod fcl;
mod fis;
mod fll;
mod fly;
mod fml;
mod formula;
mod mavlink;
mod part;
mod plan;
mod scenario;
mod server;
mod set;
mod state;
mod toml;

use std::sync::OnceLock;

/// Reads bytes; nothing where they are refused.
type Reader = fn(&[u8]) -> Option<()>;

/// A module for each file in this folder but this one, by its name.
const READERS: [(&str, Reader); 17] = [
    ("certificate", certificate::read),
    ("csv", csv::read),
    ("daveml", daveml::read),
    ("fcl", fcl::read),
    ("fis", fis::read),
    ("fll", fll::read),
    ("fly", fly::read),
    ("fml", fml::read),
    ("formula", formula::read),
    ("mavlink", mavlink::read),
    ("part", part::read),
    ("plan", plan::read),
    ("scenario", scenario::read),
    ("server", server::read),
    ("set", set::read),
    ("state", state::read),
    ("toml", toml::read),
];

/// The reader that is asked, and whether it is told what was read: a seed that is refused shows nothing.
fn chosen() -> (Reader, bool) {
    static CHOSEN: OnceLock<(Reader, bool)> = OnceLock::new();
    *CHOSEN.get_or_init(|| {
        let name = std::env::var("FSPID_FUZZ_TARGET").unwrap_or_default();
        let found = READERS.iter().find(|(reader, _)| *reader == name);
        let names = READERS.map(|(reader, _)| reader).join(", ");
        let (_, reader) = found.unwrap_or_else(|| panic!("FSPID_FUZZ_TARGET is one of {names}"));
        (*reader, std::env::var_os("FSPID_FUZZ_TELL").is_some())
    })
}

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let (reader, tells) = chosen();
    if reader(bytes).is_some() && tells {
        eprintln!("read");
    }
});
