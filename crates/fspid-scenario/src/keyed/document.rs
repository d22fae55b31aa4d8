//! TOML text as a tree in which each value knows its place.

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::syntax;
use fspid_diagnostics::{Report, Span};

/// Largest file, in bytes.
pub(crate) const FILE_LIMIT: u64 = 10 * 1024 * 1024;
/// Deepest nesting of brackets, and most dots in a key.
const DEPTH_LIMIT: usize = 64;

/// A value and where it stands.
#[derive(Clone, Debug)]
pub(crate) struct Item {
    pub(crate) place: Span,
    pub(crate) value: Value,
}

/// A value of the document.
#[derive(Clone, Debug)]
pub(crate) enum Value {
    Text(String),
    /// An integer of TOML; as a number, and exactly if it fits.
    Integer(f64, Option<i64>),
    /// Not finite where the text says so or is too large.
    Float(f64),
    Boolean(bool),
    Date,
    Array(Vec<Item>),
    Table(Vec<Member>),
}

impl Value {
    /// What it is, in words.
    pub(crate) fn type_name(&self) -> &'static str {
        match self {
            Self::Text(_) => "text",
            Self::Integer(..) | Self::Float(_) => "a number",
            Self::Boolean(_) => "a boolean",
            Self::Date => "a date",
            Self::Array(_) => "a list",
            Self::Table(_) => "a table",
        }
    }
}

impl Item {
    /// What a table says under a key.
    pub(crate) fn member(&self, name: &str) -> Option<&Self> {
        let Value::Table(members) = &self.value else {
            return None;
        };
        members.iter().find(|member| member.name == name).map(|member| &member.item)
    }

    /// The number that it is.
    pub(crate) fn number(&self) -> Option<f64> {
        match self.value {
            Value::Integer(number, _) | Value::Float(number) => Some(number),
            _ => None,
        }
    }

    /// What it says without the places, so that texts that mean the same are written alike: for digests.
    pub(crate) fn meaning(&self) -> String {
        match &self.value {
            Value::Text(text) => format!("{text:?}"),
            Value::Integer(number, None) | Value::Float(number) => format!("{number:?}"),
            Value::Integer(_, Some(whole)) => whole.to_string(),
            Value::Boolean(boolean) => boolean.to_string(),
            Value::Date => "date".to_owned(),
            Value::Array(items) => {
                let items: Vec<String> = items.iter().map(Self::meaning).collect();
                format!("[{}]", items.join(","))
            }
            Value::Table(members) => {
                let member = |it: &Member| format!("{:?}={}", it.name, it.item.meaning());
                let mut members: Vec<String> = members.iter().map(member).collect();
                members.sort_unstable();
                format!("{{{}}}", members.join(","))
            }
        }
    }
}

/// A key with its value.
#[derive(Clone, Debug)]
pub(crate) struct Member {
    pub(crate) name: String,
    /// Where the key stands.
    pub(crate) place: Span,
    pub(crate) item: Item,
}

/// The text without a byte order mark.
pub(crate) fn without_mark(text: &str) -> &str {
    text.strip_prefix('\u{feff}').unwrap_or(text)
}

/// Reads a document; `None` after reporting why it cannot be read.
pub(crate) fn read(report: &mut Report, origin: Option<String>, text: &str) -> Option<Item> {
    let text = without_mark(text);
    let source = report.add_source(origin, text);
    check_shape(report, source, text)?;
    let table = match DeTable::parse(text) {
        Ok(table) => table,
        Err(error) => {
            report_syntax(report, source, text, &error);
            for error in syntax::further(text, &error) {
                report_syntax(report, source, text, &error);
            }
            return None;
        }
    };
    let end = text.len().min(1);
    let place = Span { source, start: 0, end };
    let value = Value::Table(members(source, table.get_ref()));
    Some(Item { place, value })
}

/// Reads a single value, such as the right side of `--set`.
pub(crate) fn read_value(report: &mut Report, origin: String, text: &str) -> Option<Item> {
    let source = report.add_source(Some(origin), text);
    check_shape(report, source, text)?;
    let error = match DeValue::parse(text) {
        Ok(value) => return Some(item(source, &value)),
        Err(error) => error,
    };
    let bare = |c: char| c.is_alphanumeric() || "-_./: ".contains(c);
    if text.trim().starts_with(char::is_alphabetic) && text.chars().all(bare) {
        let place = Span { source, start: 0, end: text.len() };
        let value = Value::Text(text.trim().to_owned());
        return Some(Item { place, value });
    }
    report_syntax(report, source, text, &error);
    None
}

/// Reports why a text is no TOML.
fn report_syntax(report: &mut Report, source: usize, text: &str, error: &toml::de::Error) {
    let span = error.span().unwrap_or(0..0);
    let (at, reason) = syntax::reason(text, error);
    let span = if at == span.start { span } else { at..at };
    report.line(place(source, span), reason);
}

/// Refuses what could overwhelm the parser: NUL, and nesting without end.
fn check_shape(report: &mut Report, source: usize, text: &str) -> Option<()> {
    let at = |start| Span { source, start, end: start };
    if let Some(position) = text.find('\0') {
        let message = "a NUL byte; this is no text file";
        report.missing(at(position), "", message, "text in UTF-8");
        return None;
    }
    if let Some(position) = too_deep(text) {
        let allowed = format!("{DEPTH_LIMIT} levels of brackets or of dotted keys");
        report.missing(at(position), "", "nested too deeply", allowed);
        return None;
    }
    Some(())
}

/// Where brackets or dots go deeper than the limit, outside of strings and comments.
fn too_deep(text: &str) -> Option<usize> {
    let bytes = text.as_bytes();
    let (mut depth, mut dots, mut at) = (0_usize, 0_usize, 0);
    while let Some(&byte) = bytes.get(at) {
        match byte {
            b'#' => at = find(bytes, at, b"\n"),
            b'"' | b'\'' => {
                at = string_end(bytes, at);
                continue;
            }
            b'[' | b'{' => {
                depth += 1;
                dots = 0;
            }
            b']' | b'}' => {
                depth = depth.saturating_sub(1);
                dots = 0;
            }
            b'\n' | b',' | b'=' => dots = 0,
            b'.' => dots += 1,
            _ => {}
        }
        if depth > DEPTH_LIMIT || dots >= DEPTH_LIMIT {
            return Some(at);
        }
        at += 1;
    }
    None
}

/// The first place from `at` on where `pattern` begins, or the end.
fn find(bytes: &[u8], at: usize, pattern: &[u8]) -> usize {
    let rest = bytes.get(at..).unwrap_or_default();
    let found = rest.windows(pattern.len()).position(|window| window == pattern);
    found.map_or(bytes.len(), |offset| at + offset)
}

/// The byte after the string that begins at `at`; a line's end closes one that is left open.
fn string_end(bytes: &[u8], at: usize) -> usize {
    let rest = bytes.get(at..).unwrap_or_default();
    let quote = rest.first().copied().unwrap_or(b'"');
    let long = rest.starts_with(&[quote; 3]);
    let mut end = at + if long { 3 } else { 1 };
    while let Some(&byte) = bytes.get(end) {
        let escaped = byte == b'\\' && quote == b'"';
        let rest = bytes.get(end..).unwrap_or_default();
        if escaped {
            end += 1;
        } else if long && rest.starts_with(&[quote; 3]) {
            return end + 3;
        } else if !long && (byte == quote || byte == b'\n') {
            return end + usize::from(byte == quote);
        }
        end += 1;
    }
    bytes.len()
}

fn members(source: usize, table: &DeTable<'_>) -> Vec<Member> {
    let member = |(key, value): (&Spanned<_>, &Spanned<DeValue<'_>>)| {
        let key: &Spanned<std::borrow::Cow<'_, str>> = key;
        Member {
            name: key.get_ref().to_string(),
            place: place(source, key.span()),
            item: item(source, value),
        }
    };
    table.iter().map(member).collect()
}

fn item(source: usize, value: &Spanned<DeValue<'_>>) -> Item {
    let place = place(source, value.span());
    let value = match value.get_ref() {
        DeValue::String(text) => Value::Text(text.to_string()),
        DeValue::Integer(integer) => {
            let exact = i64::from_str_radix(integer.as_str(), integer.radix()).ok();
            let wide = i128::from_str_radix(integer.as_str(), integer.radix());
            let number = wide.map_or(f64::INFINITY, |wide| wide as f64);
            Value::Integer(number, exact)
        }
        DeValue::Float(float) => Value::Float(float.as_str().parse().unwrap_or(f64::NAN)),
        DeValue::Boolean(boolean) => Value::Boolean(*boolean),
        DeValue::Datetime(_) => Value::Date,
        DeValue::Array(items) => Value::Array(items.iter().map(|i| item(source, i)).collect()),
        DeValue::Table(table) => Value::Table(members(source, table)),
    };
    Item { place, value }
}

fn place(source: usize, span: std::ops::Range<usize>) -> Span {
    Span { source, start: span.start, end: span.end }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn brackets_in_strings_and_comments_do_not_count_as_nesting() {
        let many = "[".repeat(100);
        for text in [
            format!("# {many}\na = 1"),
            format!("a = \"{many}\""),
            format!("a = '{many}'"),
            format!("a = \"\"\"\n{many}\"\n\"\"\""),
            format!("a = \"\\\"{many}\""),
        ] {
            assert_eq!(too_deep(&text), None, "{text}");
            assert!(too_deep(&format!("{text}\nb = {many}")).is_some(), "{text}");
        }
        assert!(too_deep(&"a.".repeat(65)).is_some());
    }
}
