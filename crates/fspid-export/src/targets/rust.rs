//! Rust: a constant of `fspid-core`, and a program that asks it for the answers to vectors.

use fspid_numeric::Real;

use super::{Flown, Source};
use crate::compose::Refusal;
use crate::file::File;
use crate::write;

pub(super) fn files<R: Real>(source: &Source<'_, R>) -> Result<Vec<File>, Refusal> {
    let Source { prefix, heading, vectors, .. } = source;
    let Flown { controller, .. } = source.flown.as_ref().ok_or(Refusal::NoController)?;
    let prefix = &module(prefix);
    let check = write::rust_harness(controller, prefix, heading, vectors);
    Ok(vec![
        File::text(format!("{prefix}.rs"), write::rust(controller, heading)),
        File::text("lib.rs", LIBRARY.replace("PREFIX", prefix)),
        File::text("Cargo.toml", MANIFEST.replace("PREFIX", prefix).replace("VERSION", VERSION)),
        File::text(format!("{prefix}_check.rs"), check),
    ])
}

/// A name that a module, its file and a package may have.
fn module(prefix: &str) -> String {
    const TAKEN: &str = " abstract alloc as async await become box break build const continue core crate do dyn else enum extern \
        false final fn for fspid_core gen if impl in let lib loop macro main match mod move mut override priv proc_macro pub ref \
        return self static std struct super test trait true try type typeof unsafe unsized use virtual where while yield ";
    let is_taken = TAKEN.split_whitespace().any(|word| word == prefix);
    if is_taken { format!("{prefix}_design") } else { prefix.to_owned() }
}

const VERSION: &str = env!("CARGO_PKG_VERSION");

const LIBRARY: &str = "\
//! A controller that can fly: no standard library, no heap, nothing built when the program starts.
#![no_std]
#![forbid(unsafe_code)]

pub mod PREFIX;
";

// Of exactly this version: what a setting means and which exist may change with each.
const MANIFEST: &str = "\
[package]
name = \"PREFIX\"
version = \"0.0.0\"
edition = \"2024\"
publish = false

[lib]
path = \"lib.rs\"

[[example]]
name = \"check\"
path = \"PREFIX_check.rs\"

[dependencies]
# Or, where it is not in a registry that you use: { path = \"the folder of fspid/crates/fspid-core\" }
fspid-core = \"=VERSION\"
";

#[cfg(test)]
mod tests {
    use super::module;

    #[test]
    fn a_name_that_rust_or_the_package_has_taken_is_another_one() {
        assert_eq!(["loop", "lib", "pitch"].map(module), ["loop_design", "lib_design", "pitch"]);
        // build.rs would be run before the build, and main.rs be a program.
        assert_eq!(["build", "main"].map(module), ["build_design", "main_design"]);
    }
}
