//! What fuzzylite and the dialects of FCL call norms, membership functions and defuzzifiers: one row
//! each.

pub(crate) mod methods;
pub(crate) mod norms;
pub(crate) mod shapes;

use fspid_diagnostics::nearest;

/// Most words that a message lists.
const MOST_LISTED: usize = 30;
/// Most words among which the nearest is looked for.
const MOST_COMPARED: usize = 200;

/// What would be right in place of `found`, as a message says it: the known words, or the first of
/// them if they are many, and the nearest.
pub(crate) fn known<'k>(words: impl Iterator<Item = &'k str> + Clone, found: &str) -> String {
    let listed: Vec<_> = words.clone().take(MOST_LISTED + 1).map(|w| format!("`{w}`")).collect();
    let Some(first) = listed.get(..listed.len().min(MOST_LISTED)).filter(|l| !l.is_empty()) else {
        return String::new();
    };
    let more = if listed.len() > MOST_LISTED { ", …" } else { "" };
    let word = Some(found).filter(|found| !found.is_empty());
    let compared: Vec<&str> = words.take(MOST_COMPARED).collect();
    let near = word.and_then(|found| nearest(found, &compared));
    let asked = near.map_or(String::new(), |word| format!("; did you mean `{word}`?"));
    format!("one of {}{more}{asked}", first.join(", "))
}
