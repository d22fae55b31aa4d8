//! `.xml` of IEEE 1855: reading never panics; what is written comes back as itself.

pub(crate) fn read(bytes: &[u8]) -> Option<()> {
    fspid_formats::fuzzing::fml(bytes);
    fspid_formats::fml::read(std::str::from_utf8(bytes).ok()?).ok().map(drop)
}
