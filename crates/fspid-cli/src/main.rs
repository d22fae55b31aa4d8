//! fspid
fn main() {}
