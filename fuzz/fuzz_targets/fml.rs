//! `.xml` of IEEE 1855: reading never panics; what is written comes back as itself.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| fspid_formats::fuzzing::fml(bytes));
