//! `.fcl`: reading never panics; what is written comes back as itself.

pub(crate) fn read(bytes: &[u8]) -> Option<()> {
    fspid_formats::fuzzing::fcl(bytes);
    fspid_formats::fcl::read(std::str::from_utf8(bytes).ok()?).ok().map(drop)
}
