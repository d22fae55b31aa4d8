//! What fuzzylite and the dialects of FCL call norms, membership functions and defuzzifiers: one row
//! each.

pub(crate) mod methods;
pub(crate) mod norms;
pub(crate) mod shapes;

/// Most words that a message lists.
const MOST_LISTED: usize = 30;

/// What would be right in place of `found`, as a message says it: the known words, the first of
/// them if they are many, and the nearest if they are few.
pub(crate) fn known<'k>(words: impl Iterator<Item = &'k str> + Clone, found: &str) -> String {
    let count = words.clone().take(MOST_LISTED + 1).count();
    if count == 0 {
        return String::new();
    }
    if count <= MOST_LISTED && !found.is_empty() {
        return crate::report::one_of(words, found);
    }
    let first: Vec<String> = words.take(MOST_LISTED).map(|word| format!("`{word}`")).collect();
    let more = if count > MOST_LISTED { ", …" } else { "" };
    format!("one of {}{more}", first.join(", "))
}
