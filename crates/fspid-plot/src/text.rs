//! Words and numbers for SVG: sizes, rounding, escaping, lowered and raised parts, widths and ids.

/// Font size of figure titles (px).
pub(super) const TITLE_PX: f64 = 14.0;
/// Font size of axis labels and legends (px).
pub(super) const LABEL_PX: f64 = 12.0;

/// A coordinate with at most two decimals, never "-0" and never a word.
pub(super) fn num(value: f64) -> String {
    if !value.is_finite() {
        return "0".to_owned();
    }
    let text = format!("{:.2}", value.clamp(-1e7, 1e7));
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

/// Escapes for text and attributes; control characters, which XML does not know, are dropped.
pub(super) fn escape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\n' | '\t' => out.push(' '),
            c if c.is_control() || c == '\u{fffe}' || c == '\u{ffff}' => {}
            c => out.push(c),
        }
    }
    out
}

/// `text` without the marks for lowered and raised parts, to be read aloud.
pub(super) fn unmarked(text: &str) -> String {
    text.replace("_{", "").replace("^{", "").replace('}', "")
}

/// Escaped text in which `_{…}` is lowered and `^{…}` raised.
pub(super) fn rich(text: &str) -> String {
    let mut out = String::new();
    let mut rest = text;
    let mut back_em = 0.0;
    while let Some(at) = rest.find("_{").into_iter().chain(rest.find("^{")).min() {
        let (before, marked) = rest.split_at(at);
        let Some(close) = marked.find('}') else { break };
        let shift_em = if marked.starts_with('_') { 0.18 } else { -0.3 };
        out.push_str(&shifted(before, back_em, ""));
        let carry_em = if before.is_empty() { back_em } else { 0.0 };
        // The step is in ems of the small size, 0.75 of the size around it.
        out.push_str(&shifted(
            &marked[2..close],
            (shift_em + carry_em) / 0.75,
            " font-size=\"75%\"",
        ));
        back_em = -shift_em;
        rest = &marked[close + 1..];
    }
    out.push_str(&shifted(rest, back_em, ""));
    out
}

/// `text` moved down by `shift_em`; nothing when there is no text.
fn shifted(text: &str, shift_em: f64, attributes: &str) -> String {
    match text {
        "" => String::new(),
        _ if shift_em == 0.0 => escape(text),
        _ => format!("<tspan dy=\"{}em\"{attributes}>{}</tspan>", num(shift_em), escape(text)),
    }
}

/// Width of `text` at `size` px in a common sans-serif face, on the safe side (px).
pub(super) fn text_width(text: &str, size: f64) -> f64 {
    let mut next = text.chars().skip(1);
    let mut is_marked = false;
    let ems: f64 = text
        .chars()
        .map(|c| match (c, next.next()) {
            // Marks of lowered and raised parts are not drawn; other lines below words are.
            ('_' | '^', Some('{')) => {
                is_marked = true;
                0.0
            }
            ('{' | '}', _) if is_marked => 0.0,
            (c, _) => ems(c),
        })
        .sum();
    ems * size
}

/// Width of a character (em).
fn ems(c: char) -> f64 {
    match c {
        'i' | 'j' | 'l' | 'I' | '.' | ',' | ':' | ';' | '|' | '\'' | '!' => 0.28,
        'f' | 't' | 'r' | ' ' | '(' | ')' | '[' | ']' | '/' | '-' => 0.36,
        'm' | 'w' | 'M' | 'W' | '%' | '@' => 0.9,
        // Scripts of East Asia, and pictures.
        '\u{2e80}'.. => 1.1,
        c if c.is_uppercase() => 0.72,
        _ => 0.57,
    }
}

/// Letters and digits of the title, for readable ids.
pub(super) fn slug(title: &str) -> String {
    let mut out = String::new();
    for c in title.chars().filter(char::is_ascii) {
        if c.is_ascii_alphanumeric() {
            out.push(c.to_ascii_lowercase());
        } else if !out.is_empty() && !out.ends_with('-') {
            out.push('-');
        }
        if out.len() >= 24 {
            break;
        }
    }
    let out = out.trim_end_matches('-');
    if out.is_empty() { "untitled".to_owned() } else { out.to_owned() }
}

/// FNV-1a hash: figures with one title but different content get different ids.
pub(super) fn fingerprint(text: &str) -> u32 {
    text.bytes().fold(0x811c_9dc5, |hash, byte| (hash ^ u32::from(byte)).wrapping_mul(0x0100_0193))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coordinates_are_short_and_never_minus_zero() {
        assert_eq!(num(-0.001), "0");
        assert_eq!(num(f64::NAN), "0");
        assert_eq!(num(1.10), "1.1");
    }

    #[test]
    fn lines_below_words_take_room_and_marks_take_none() {
        assert!(text_width("phase_margin", 10.0) > text_width("phasemargin", 10.0));
        assert!((text_width("k_{p}", 10.0) - text_width("kp", 10.0)).abs() < 1e-9);
    }

    #[test]
    fn control_characters_are_dropped_and_markup_is_escaped() {
        assert_eq!(escape("a<b>&\"\u{1}\u{0}"), "a&lt;b&gt;&amp;&quot;");
    }

    #[test]
    fn an_unclosed_subscript_is_written_as_it_is() {
        assert_eq!(rich("k_{p"), "k_{p");
        assert!(rich("k_{p} x").contains("75%\">p</tspan>"));
    }
}
