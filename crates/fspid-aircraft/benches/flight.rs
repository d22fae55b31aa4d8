//! How fast one core trims and flies.

fn main() {}
