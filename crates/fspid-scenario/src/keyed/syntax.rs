//! Why a line is no TOML, in the words of who wrote it.

use std::borrow::Cow;
use std::iter;
use std::ops::Range;

use toml::de::{DeTable, Error};

/// Most lines of which it is told why they are no TOML: each takes another reading of the text.
const MOST_LINES: usize = 20;

/// What is told of a mistake.
type Told = Cow<'static, str>;

/// Where a text is wrong, as a byte, and what is: mostly where the parser stopped.
pub(super) fn reason(text: &str, error: &Error) -> (usize, String) {
    let at = error.span().map_or(0, |span| span.start);
    if error.message().starts_with("duplicate key") {
        return twice(text, at);
    }
    let message = match slip(text, at) {
        Some(slip) => slip,
        None if is_bare_text(text, at, error) => "string values must be quoted".into(),
        None => error.message().replace('\n', ", ").into(),
    };
    (at, format!("not TOML: {message}"))
}

/// The errors that a text has after its first, as long as each before is a known mistake within one line: without such a
/// line the rest is read as it was meant. After any other, what follows may be its echo.
pub(super) fn further(text: &str, first: &Error) -> Vec<Error> {
    let mut text = text.to_owned();
    let mut error = first.clone();
    let next = || {
        let line = faulty_line(&text, error.span()?.start)?;
        text.replace_range(line.clone(), &" ".repeat(line.len()));
        error = DeTable::parse(&text).err()?;
        Some(error.clone())
    };
    iter::from_fn(next).take(MOST_LINES - 1).collect()
}

/// Where the line of a known mistake stands, if nothing of it goes on in another line.
fn faulty_line(text: &str, at: usize) -> Option<Range<usize>> {
    slip(text, at)?;
    let start = line_start(text, at);
    let line = line_at(text, at);
    let count = |sign| line.matches(sign).count();
    let is_whole = count('[') == count(']')
        && count('{') == count('}')
        && !line.contains("\"\"\"")
        && !line.contains("'''");
    (is_whole && !line.trim().is_empty()).then(|| start..start + line.len())
}

/// What is told of a key or table that is here twice. Of an entry of a list that stands in single brackets that line is the one
/// to be changed, be it the first or the second.
fn twice(text: &str, at: usize) -> (usize, String) {
    let same = "this key or table is here twice";
    let Some((name, is_list)) = heading(line_at(text, at)) else {
        return (at, same.to_owned());
    };
    let mut starts = text.split_inclusive('\n').scan(0, |start, line| {
        let this = *start;
        *start += line.len();
        Some((this, line))
    });
    let Some((other, _)) = starts.find(|(_, line)| heading(line) == Some((name, !is_list))) else {
        return (at, format!("{same}; of several in a list each has double brackets"));
    };
    let single = if is_list { other } else { at };
    let message = format!(
        "`[[{name}]]` is there too: of several in a list each has double brackets, the first as well"
    );
    (single, message)
}

/// The name of a table's heading, and whether its brackets are double.
fn heading(line: &str) -> Option<(&str, bool)> {
    let line = line.split('#').next().unwrap_or_default().trim();
    let within = |open, close| line.strip_prefix(open)?.strip_suffix(close).map(str::trim);
    match within("[[", "]]") {
        Some(name) => Some((name, true)),
        None => within("[", "]").map(|name| (name, false)),
    }
}

/// True for a text without quotes that begins as `nan`, `inf`, `true` or `false` do: the parser takes it for one of these.
fn is_bare_text(text: &str, at: usize, error: &Error) -> bool {
    let is_word = text.get(at..).is_some_and(|rest| rest.starts_with(char::is_alphabetic));
    let literals = ["`nan`", "`inf`", "`true`", "`false`"];
    is_word && literals.iter().any(|literal| error.message().contains(literal))
}

/// The mistakes that are made again and again, for which the parser's words name a remedy that is none.
fn slip(text: &str, at: usize) -> Option<Told> {
    if is_decimal_comma(text, at) {
        return Some("a number with a comma; its decimal sign is a point".into());
    }
    let line = line_at(text, at);
    if has_foreign_comment(line) {
        return Some("a comment begins with `#`".into());
    }
    let Some((key, value)) = line.split_once('=') else {
        let is_colon = line.split_once(':').is_some_and(|(key, _)| is_bare(key.trim()));
        // Without either it may be the value of a `--set`, or of a list over several lines.
        let colon = is_colon.then_some("a key and its value have `=` between them".into());
        return colon.or_else(|| of_value(line.trim()).filter(|_| !line.trim().is_empty()));
    };
    let value = value.split('#').next().unwrap_or("").trim();
    if value.ends_with(';') {
        return of_value(value);
    }
    // Two keys on a line, or a table within it, are another matter.
    if value.contains('=') || !key.trim().split('.').all(|part| is_bare(part.trim())) {
        return None;
    }
    of_value(value)
}

/// True for a line with a comment as MATLAB or C has it.
fn has_foreign_comment(line: &str) -> bool {
    let line = line.split('#').next().unwrap_or_default().trim();
    // What stands after the last text of the line.
    let outside = line.rsplit(['"', '\'']).next().unwrap_or_default();
    let after_number = outside.split_once('%').is_some_and(|(before, after)| {
        // `10 %` is a number with its unit.
        before.trim().is_empty() || !after.trim().is_empty()
    });
    line.starts_with("//") || after_number || outside.contains(" //")
}

/// What is told of a list whose numbers have no commas between them, as MATLAB writes one.
fn spaced_list(value: &str) -> Option<Told> {
    let within = value.strip_prefix('[')?.strip_suffix(']')?;
    if within.contains(';') {
        return Some("a list has commas between its numbers, and no semicolon".into());
    }
    let numbers: Vec<&str> = within.split([',', ' ', '\t']).filter(|it| !it.is_empty()).collect();
    let are_numbers = numbers.iter().all(|it| it.parse::<f64>().is_ok());
    let lacks_commas = within.matches(',').count() + 1 < numbers.len();
    let list = numbers.join(", ");
    (are_numbers && lacks_commas)
        .then(|| format!("numbers of a list have commas between them: [{list}]").into())
}

/// What is told of a plant as MATLAB makes one.
fn system(value: &str) -> Option<Told> {
    let is_made = ["tf(", "ss(", "zpk("].iter().any(|made| value.starts_with(made));
    is_made
        .then_some("a plant is `numerator = [1.0, 2.0]` and `denominator = [1.0, 2.0, 3.0]`".into())
}

fn of_value(value: &str) -> Option<Told> {
    let special = || spaced_list(value).or_else(|| system(value));
    if value.ends_with(';') {
        return Some("a line ends without a semicolon".into());
    }
    special().or_else(|| of_word_or_number(value).map(Cow::Borrowed))
}

fn of_word_or_number(value: &str) -> Option<&'static str> {
    let rest = value.trim_start_matches(['+', '-']);
    let after = rest.trim_start_matches(|c: char| c.is_ascii_digit() || c == '.');
    let starts_with_digit = rest.starts_with(|c: char| c.is_ascii_digit());
    if value.is_empty() {
        Some("nothing stands after `=`; here a value belongs")
    } else if matches!(value, "True" | "TRUE" | "False" | "FALSE") {
        Some("true and false are written in small letters")
    } else if value.starts_with(['“', '”', '„', '«', '‘', '’']) {
        Some("a text stands in straight quotes, \"…\"")
    } else if starts_with_digit && after.trim_start().starts_with(is_of_unit) && !is_power(after) {
        Some("a number stands alone: its unit is that of the key's name")
    } else if starts_with_digit && after.trim_start().starts_with(['/', '*', '^']) {
        Some("a number is written worked out")
    } else if !after.is_empty() || !rest.contains(|c: char| c.is_ascii_digit()) {
        None
    } else if rest.starts_with('.') || rest.ends_with('.') {
        Some("a number has a digit before and after its point")
    } else if rest.starts_with('0') {
        Some("a number starts with no zero that could be left away")
    } else {
        None
    }
}

/// True for the first sign of a unit.
fn is_of_unit(sign: char) -> bool {
    sign.is_alphabetic() || sign == '°' || sign == '%'
}

/// True for `e3` after a number, for one that is not written to its end, and for `0x` and its like.
fn is_power(after: &str) -> bool {
    if after.starts_with(['x', 'o', 'b']) {
        return true;
    }
    let Some(rest) = after.strip_prefix(['e', 'E']) else {
        return false;
    };
    rest.trim_start_matches(['+', '-']).chars().all(|c| c.is_ascii_digit())
}

/// True for a key that needs no quotes.
fn is_bare(key: &str) -> bool {
    !key.is_empty() && key.chars().all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-')
}

/// The line in which a byte lies; that of the end where it begins none.
fn line_at(text: &str, at: usize) -> &str {
    text[line_start(text, at)..].lines().next().unwrap_or("")
}

/// Where that line begins.
fn line_start(text: &str, at: usize) -> usize {
    let head = text.get(..at).unwrap_or(text);
    let is_end = head.len() == text.len();
    let head = head.strip_suffix('\n').filter(|_| is_end).unwrap_or(head);
    head.rfind('\n').map_or(0, |newline| newline + 1)
}

/// True for the comma of `10,5`, where the number should have ended.
fn is_decimal_comma(text: &str, at: usize) -> bool {
    let around = at.checked_sub(1).and_then(|begin| text.get(begin..at + 2));
    matches!(around.map(str::as_bytes), Some([before, b',', after])
        if before.is_ascii_digit() && after.is_ascii_digit())
}

#[cfg(test)]
mod tests {
    use super::*;
    use toml::de::DeTable;

    fn told(line: &str) -> String {
        let text = format!("schema = 1\n{line}\nlast = 2\n");
        let error = DeTable::parse(&text).expect_err("it is wrong");
        reason(&text, &error).1
    }

    #[test]
    fn what_is_often_written_wrongly_is_told_with_its_remedy() {
        for (line, words) in [
            ("name =", "nothing stands after `=`"),
            ("name = # a comment", "nothing stands after `=`"),
            ("kp = 5 deg", "its unit is that of the key's name"),
            ("kp = -5.5deg", "its unit is that of the key's name"),
            ("kp = 5°", "its unit is that of the key's name"),
            ("kp = 10 %", "its unit is that of the key's name"),
            ("kp = 1e3 m", "its unit is that of the key's name"),
            ("kp = 1,5", "its decimal sign is a point"),
            ("kp = True", "in small letters"),
            ("kp: 5", "`=` between them"),
            ("kp = 1/2", "worked out"),
            ("kp = .5", "before and after its point"),
            ("kp = 5.", "before and after its point"),
            ("kp = 05", "no zero"),
            ("name = “x”", "straight quotes"),
            ("name = pitch", "must be quoted"),
            ("name = navion-paper", "must be quoted"),
            ("name = inner", "must be quoted"),
            ("name = trial", "must be quoted"),
            ("name = { kind = falcon }", "must be quoted"),
            ("kp = 1.0 % a comment", "a comment begins with `#`"),
            ("kp = 1.0 // a comment", "a comment begins with `#`"),
            ("% a comment", "a comment begins with `#`"),
            ("name = \"10 % of it\" % a comment", "a comment begins with `#`"),
            ("b = [11.73 22.578]", "commas between them: [11.73, 22.578]"),
            ("b = [1, 2 -3e1] # a comment", "commas between them: [1, 2, -3e1]"),
            ("b = [1 2; 3 4]", "no semicolon"),
            ("b = [1 2];", "without a semicolon"),
            ("plant = tf([1 2], [1 2 3])", "a plant is `numerator ="),
            ("kp = 1.0;", "without a semicolon"),
            ("kp = \"a\"; # a comment", "without a semicolon"),
            ("x = { a = 1 };", "without a semicolon"),
            ("kp = 1e", "exponent"),
            ("[loop", "unclosed table"),
            ("a = 1 b = 2", "unexpected key or value"),
            ("a = 0x1G", "invalid hexadecimal"),
        ] {
            let told = told(line);
            assert!(told.starts_with("not TOML: ") && told.contains(words), "{line}: {told}");
        }
        assert_eq!(told("a = 1\na = 2"), "this key or table is here twice");
        let error = toml::de::DeValue::parse("5 deg").expect_err("it is wrong");
        let (_, told) = reason("5 deg", &error);
        assert!(told.contains("its unit"), "{told}");
    }

    /// The first was told alone, so that a file of MATLAB's lines was mended one by one.
    #[test]
    fn known_mistakes_of_several_lines_are_told_together_and_echoes_are_not() {
        let told = |text: &str| {
            let first = DeTable::parse(text).expect_err("it is wrong");
            let lines = |error: &Error| {
                let at = reason(text, error).0;
                text[..at].matches('\n').count() + 1
            };
            let further = further(text, &first);
            iter::once(&first).chain(&further).map(lines).collect::<Vec<_>>()
        };
        assert_eq!(told("a = 1;\nb = 2\nc = [1 2]\nd = .5\n"), [1, 3, 4]);
        assert_eq!(told("a = 1;\n[loop\nc = .5\n"), [2], "after another one nothing is sure");
        assert_eq!(told("a = [1 2\n3]\nc = .5\n").len(), 1);
        assert_eq!(told(&"a = .5\n".repeat(50)).len(), MOST_LINES);
        assert_eq!(told("a = 5 °\r\nb = 5 °\r\n"), [1, 2]);
    }

    /// The place was that of the second heading, whichever of the two was to be changed.
    #[test]
    fn of_a_table_and_a_list_of_one_name_the_single_brackets_are_told() {
        for (text, line, words) in [
            ("[a]\nb = 1\n[[a]] # second\nb = 2\n", "[a]", "`[[a]]` is there too"),
            ("[[a]]\nb = 1\n[ a ]\nb = 2\n", "[ a ]", "`[[a]]` is there too"),
            ("[a]\nb = 1\n[a]\nb = 2\n", "[a]", "twice; of several in a list"),
        ] {
            let error = DeTable::parse(text).expect_err("it is wrong");
            let (at, told) = reason(text, &error);
            assert!(told.contains(words), "{text}: {told}");
            assert_eq!(line_at(text, at), line, "{text}");
        }
    }

    #[test]
    fn the_last_line_without_an_end_and_signs_of_many_bytes_are_read() {
        for text in ["kp =", "kp = 5 °", "ä: 5", "=", "\u{feff}", "kp = “"] {
            if let Err(error) = DeTable::parse(text) {
                assert!(!reason(text, &error).1.is_empty(), "{text}");
            }
        }
    }
}
