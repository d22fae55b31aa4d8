//! How a controller is called in the code, so that exports side by side share no name.

/// Libraries that Lua has loaded before it looks for a file, and headers of C that a file must not hide.
const TAKEN: &str = "bit32 coroutine debug io math os package string table utf8 \
                     assert complex ctype errno fenv float inttypes iso646 limits locale setjmp signal stdalign \
                     stdarg stdatomic stdbool stddef stdint stdio stdlib stdnoreturn tgmath threads time uchar \
                     wchar wctype";

/// A name as every language takes it: lower-case letters, digits and underscores, a letter first.
#[must_use]
pub fn identifier(name: &str) -> String {
    let mut text = String::new();
    for c in name.chars() {
        match c.to_ascii_lowercase() {
            c if c.is_ascii_alphanumeric() => text.push(c),
            _ if !text.ends_with('_') => text.push('_'),
            _ => {}
        }
    }
    let text = text.trim_matches('_');
    if TAKEN.split_whitespace().any(|taken| taken == text) {
        return format!("controller_{text}");
    }
    match text.chars().next() {
        Some(first) if first.is_ascii_alphabetic() => text.to_owned(),
        Some(_) => format!("controller_{text}"),
        None => "controller".to_owned(),
    }
}

/// What stands behind a prefix in the names of files: a prefix that ended so would be another export's file.
const ENDINGS: [&str; 10] = [
    "check",
    "selftest",
    "external",
    "table",
    "f32",
    "i16",
    "words",
    "sfun",
    "sketch",
    "ardupilot",
];

/// What every name of a controller's code begins with: [`identifier`], with `_controller` behind an ending that files have.
#[must_use]
pub fn prefix(name: &str) -> String {
    let text = identifier(name);
    let is_ending = text.rsplit_once('_').is_some_and(|(_, last)| ENDINGS.contains(&last));
    if is_ending { text + "_controller" } else { text }
}

/// The prefixes of controllers that stand side by side: one that another before it has gets `_2`, `_3`, ….
#[must_use]
pub fn prefixes(names: &[&str]) -> Vec<String> {
    let mut taken: Vec<String> = Vec::new();
    for name in names {
        let wanted = prefix(name);
        let numbered = (2..).map(|number| format!("{wanted}_{number}"));
        let mut all = std::iter::once(wanted.clone()).chain(numbered);
        taken.push(all.find(|it| !taken.contains(it)).unwrap_or(wanted));
    }
    taken
}

#[cfg(test)]
mod tests {
    use super::*;

    /// "A b" and "a-B" were both `a_b`, and `fspid_check.c` was a file of both "FSPID" and "FSPID check".
    #[test]
    fn controllers_side_by_side_share_no_prefix_and_no_file() {
        let names = ["A b", "a-B", "a b 2", "Ω", "舵", "FSPID", "FSPID check", "FSPID external"];
        let told = ["a_b", "a_b_2", "a_b_2_2", "controller", "controller_2", "fspid"];
        let prefixes = prefixes(&names);
        assert_eq!(prefixes[..6], told);
        assert_eq!(prefixes[6..], ["fspid_check_controller", "fspid_external_controller"]);
        assert!(prefixes.iter().all(|it| prefix(it) == *it), "each may be given as it is");
    }
}
