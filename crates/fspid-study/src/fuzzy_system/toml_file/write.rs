//! Writing a system down.

/// The shortest digits that read back as the same number.
pub(super) fn number(value: f64) -> String {
    format!("{value:?}")
}

/// A text in quotes; what cannot be seen is escaped.
pub(super) fn quoted(text: &str) -> String {
    let escaped = |c: char| match c {
        '"' | '\\' => format!("\\{c}"),
        '\n' => "\\n".to_owned(),
        '\t' => "\\t".to_owned(),
        c if c.is_control() => format!("\\u{:04X}", u32::from(c)),
        c => c.to_string(),
    };
    format!("\"{}\"", text.chars().map(escaped).collect::<String>())
}
