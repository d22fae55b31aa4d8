//! Every reader in one program, so that it is linked once: `FSPID_FUZZ_TARGET` names the one that is asked.

#![no_main]

#[cfg(feature = "whole-program")]
mod certificate;
#[cfg(feature = "whole-program")]
mod csv;
mod daveml;
mod fcl;
mod fis;
mod fll;
#[cfg(feature = "whole-program")]
mod fly;
mod fml;
mod formula;
mod mavlink;
#[cfg(feature = "whole-program")]
mod part;
#[cfg(feature = "whole-program")]
mod plan;
mod scenario;
#[cfg(feature = "whole-program")]
mod server;
mod set;
#[cfg(feature = "whole-program")]
mod state;
mod toml;

use std::sync::OnceLock;

/// Reads bytes; nothing where they are refused.
type Reader = fn(&[u8]) -> Option<()>;

/// A module for each file in this folder but this one, by its name.
const READERS: &[(&str, Reader)] = &[
    #[cfg(feature = "whole-program")]
    ("certificate", certificate::read),
    #[cfg(feature = "whole-program")]
    ("csv", csv::read),
    ("daveml", daveml::read),
    ("fcl", fcl::read),
    ("fis", fis::read),
    ("fll", fll::read),
    #[cfg(feature = "whole-program")]
    ("fly", fly::read),
    ("fml", fml::read),
    ("formula", formula::read),
    ("mavlink", mavlink::read),
    #[cfg(feature = "whole-program")]
    ("part", part::read),
    #[cfg(feature = "whole-program")]
    ("plan", plan::read),
    ("scenario", scenario::read),
    #[cfg(feature = "whole-program")]
    ("server", server::read),
    ("set", set::read),
    #[cfg(feature = "whole-program")]
    ("state", state::read),
    ("toml", toml::read),
];

/// The reader that is asked, and whether it is told what was read: a seed that is refused shows nothing.
fn chosen() -> (Reader, bool) {
    static CHOSEN: OnceLock<(Reader, bool)> = OnceLock::new();
    *CHOSEN.get_or_init(|| {
        let name = std::env::var("FSPID_FUZZ_TARGET").unwrap_or_default();
        let found = READERS.iter().find(|(reader, _)| *reader == name);
        let names: Vec<&str> = READERS.iter().map(|(reader, _)| *reader).collect();
        let (_, reader) = found.unwrap_or_else(|| panic!("FSPID_FUZZ_TARGET is one of {}", names.join(", ")));
        (*reader, std::env::var_os("FSPID_FUZZ_TELL").is_some())
    })
}

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let (reader, tells) = chosen();
    if reader(bytes).is_some() && tells {
        eprintln!("read");
    }
});
