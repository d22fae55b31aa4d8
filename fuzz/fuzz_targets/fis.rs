//! `.fis`: reading never panics; what is written can be read, and is written the same again.
#![no_main]

use fspid_formats::{WriteOptions, fis};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    let Ok(reading) = fis::read(text) else { return };
    for lossy in [false, true] {
        let Ok(writing) = fis::write(&reading.parts, WriteOptions { lossy }) else { continue };
        let again = fis::read(&writing.text).expect("what is written can be read");
        let twice = fis::write(&again.parts, WriteOptions { lossy: false });
        assert_eq!(twice.expect("what is read can be written").text, writing.text);
    }
});
