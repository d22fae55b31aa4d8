//! What fuzzylite and the dialects of FCL call norms, membership functions and defuzzifiers: one row
//! each.

pub(crate) mod methods;
pub(crate) mod norms;
pub(crate) mod shapes;

/// Most words that a message lists.
const MOST_LISTED: usize = 30;

/// What would be right in place of `found`, as a message says it: the known words if they are few,
/// else how many there are and the nearest.
pub(crate) fn known<'k>(words: impl Iterator<Item = &'k str> + Clone, found: &str) -> String {
    let count = words.clone().take(MOST_LISTED + 1).count();
    if count == 0 {
        return String::new();
    }
    if count <= MOST_LISTED {
        return crate::report::one_of(words, found);
    }
    let first: Vec<String> = words.take(MOST_LISTED).map(|word| format!("`{word}`")).collect();
    format!("one of {}, …", first.join(", "))
}
