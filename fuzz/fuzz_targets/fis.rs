//! `.fis`: reading never panics; what is written can be read, and is written the same again.

use fspid_formats::{WriteOptions, fis};

pub(crate) fn read(bytes: &[u8]) -> Option<()> {
    let reading = fis::read(std::str::from_utf8(bytes).ok()?).ok()?;
    for lossy in [false, true] {
        let Ok(writing) = fis::write(&reading.parts, WriteOptions { lossy }) else { continue };
        let again = fis::read(&writing.text).expect("what is written can be read");
        let twice = fis::write(&again.parts, WriteOptions { lossy: false });
        assert_eq!(twice.expect("what is read can be written").text, writing.text);
    }
    Some(())
}
