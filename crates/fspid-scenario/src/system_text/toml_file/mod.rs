//! Our own format of fuzzy systems: TOML that people write, in which every system can be said.
//!
//! One specification ([`spec`](self::spec)) lists the keys; the check, the JSON Schema and the
//! defaults come from it. Terms, norms and rules have words of their own, each in a file here.

mod activation;
mod conclusion;
mod fields;
mod formula;
mod membership;
mod norm;
mod read;
mod rules;
mod spec;
mod write;

use serde_json::Value;

use crate::keyed::schema::schema_of;

pub use read::parse;
pub use write::write;

/// The JSON Schema (draft 2020-12) of a fuzzy system's file.
#[must_use]
pub fn schema() -> Value {
    let mut schema = schema_of(&spec::FUZZY_SYSTEM, "fspid fuzzy system");
    schema["$defs"] = membership::definitions();
    schema
}

/// True for a text that says it is a fuzzy system; also for one with other mistakes.
pub(crate) fn is_of_this_kind(text: &str) -> bool {
    let mut head = text.lines().map(str::trim).take_while(|line| !line.starts_with('['));
    head.any(|line| {
        let value = line.strip_prefix("kind").map(str::trim_start);
        value.and_then(|rest| rest.strip_prefix('=')).is_some_and(|rest| rest.contains(spec::WORD))
    })
}
