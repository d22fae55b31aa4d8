//! Words of commands as a shell takes them.

/// A text as one word: in quotes where a shell would take it apart or read something into it.
#[must_use]
pub fn word(text: &str) -> String {
    let is_plain = |c: char| c.is_alphanumeric() || "-_./:=+,".contains(c);
    if !text.is_empty() && text.chars().all(is_plain) {
        return text.to_owned();
    }
    format!("'{}'", text.replace('\'', "'\\''"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folders_and_changes_pass_through_a_shell() {
        assert_eq!(word("out/robust-1"), "out/robust-1");
        assert_eq!(word("it's here"), "'it'\\''s here'");
        assert_eq!(word("a;rm -rf *"), "'a;rm -rf *'");
        assert_eq!(word("a\\b"), "'a\\b'");
        assert_eq!(word(""), "''");
        assert_eq!(word("plant.numerator[0]=1.0"), "'plant.numerator[0]=1.0'");
        assert_eq!(word("loop.duration_s=1.0"), "loop.duration_s=1.0");
    }
}
