//! Every setting of a scenario in one list, whether the file gave it or a default filled it in.

use fspid_fuzzy::LABEL_COUNT;

use crate::keyed::check::grid_text;

use crate::file::files::Files;
use crate::file::rewrite;
use crate::file::spec::SCENARIO;
use crate::keyed::{Checked, Entry, KeyRow, Kind, Section, Table, join};

/// Most numbers of a list that are all written.
const MOST_NUMBERS: usize = 12;
/// Numbers that are written of a longer list, before the last one.
const FIRST_NUMBERS: usize = 4;
/// Most characters of a text that are written.
const MOST_CHARACTERS: usize = 500;
/// Longest name in a path, in characters; a table with a longer one is told by its number.
const LONGEST_NAME: usize = 60;

/// One setting of a scenario.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Setting {
    /// The top-level table that it is in, such as `loop` or `controller.FSPID`; empty for none.
    pub table: String,
    /// Where it is, such as `controller.FSPID.supervisor.range`: what `--set` changes. What a file
    /// says is below the key that names it, as in `plant.preset.numerator`.
    pub path: String,
    /// The value in one line, as TOML has it. Long lists and texts are cut, with their length.
    pub value: String,
    /// The unit, empty where there is none.
    pub unit: &'static str,
    /// Written in the file, in an override, or in a file that one of them names; otherwise a
    /// default filled it in.
    pub given: bool,
}

/// All settings of a checked scenario, in the order of the specification. A key without a default
/// that is left out is not among them.
pub(crate) fn settings(files: &Files<'_>, scenario: &Section) -> Vec<Setting> {
    let mut walk = Walk { files, table: String::new(), settings: Vec::new() };
    walk.keys(&SCENARIO, scenario, "");
    walk.settings
}

struct Walk<'a> {
    files: &'a Files<'a>,
    /// The top-level table that the walk is in, empty outside of all.
    table: String,
    settings: Vec<Setting>,
}

impl Walk<'_> {
    fn keys(&mut self, spec: &'static Table, section: &Section, path: &str) {
        if !section.kind.is_empty() {
            self.push(join(path, "kind"), text(section.kind), "", true);
        }
        for key in spec.keys_of(section.kind) {
            let (name, inner) = (key.name(), join(path, key.name().as_str()));
            match section.entry(name) {
                Some(entry) => self.entry(key, entry, inner, &section.path(name)),
                None => self.absent(key, inner, &section.path(name)),
            }
        }
    }

    /// A key that holds a value; `place` is its path with every table told by its number.
    fn entry(&mut self, key: KeyRow, entry: &Entry, path: String, place: &str) {
        match (&entry.value, key.kind()) {
            (Checked::Section(section), Kind::Table(spec) | Kind::Rules { grids: spec, .. }) => {
                self.inside(path, |walk, path| walk.keys(spec, section, path));
            }
            (Checked::Sections(sections), Kind::Tables { table, .. }) => {
                for (index, section) in sections.iter().enumerate() {
                    let path = format!("{path}{}", step(section, index));
                    self.inside(path, |walk, path| walk.keys(table, section, path));
                }
            }
            (value, kind) => {
                self.push(path.clone(), written(value), kind.unit(), entry.given);
                if let Some((spec, file)) = self.files.referred(place) {
                    self.keys(spec, file, &path);
                }
            }
        }
    }

    /// A key that the file leaves out: its default may be what another file makes it, and the keys of its table may
    /// have some.
    fn absent(&mut self, key: KeyRow, path: String, place: &str) {
        if let Some(word) = self.files.filled(place) {
            return self.push(path, text(word), key.kind().unit(), false);
        }
        match (key.default(), key.kind()) {
            (Some(default), kind) => self.push(path, written(&default), kind.unit(), false),
            (_, Kind::Table(spec)) if spec.may_be_empty() => {
                self.inside(path, |walk, path| {
                    for key in spec.keys() {
                        let name = key.name().as_str();
                        walk.absent(key, join(path, name), &join(place, name));
                    }
                });
            }
            _ => {}
        }
    }

    /// Walks on in a table, which is a top-level one if there is none around it.
    fn inside(&mut self, path: String, walk: impl FnOnce(&mut Self, &str)) {
        let is_top = self.table.is_empty();
        if is_top {
            self.table.clone_from(&path);
        }
        walk(self, &path);
        if is_top {
            self.table.clear();
        }
    }

    fn push(&mut self, path: String, value: String, unit: &'static str, given: bool) {
        let table = self.table.clone();
        self.settings.push(Setting { table, path, value, unit, given });
    }
}

/// The step to a table of a list: its name where a path can hold it, its number elsewhere.
pub(super) fn step(section: &Section, index: usize) -> String {
    named_step(section.own_name(), index)
}

/// The step to the entry of a list that has this name, or none.
pub(crate) fn named_step(name: &str, index: usize) -> String {
    let is_bare = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '_';
    let fits = (1..=LONGEST_NAME).contains(&name.chars().count())
        && !name.contains(|c| c == '"' || is_hidden(c));
    match fits {
        true if name.chars().all(is_bare) => format!(".{name}"),
        true => format!(".\"{name}\""),
        false => format!("[{index}]"),
    }
}

/// Characters that break a line, turn it around or cannot be seen.
fn is_hidden(c: char) -> bool {
    c.is_control()
        || matches!(c, '\u{200B}'..='\u{200F}' | '\u{2028}'..='\u{202E}' | '\u{2060}'..='\u{206F}' | '\u{FEFF}')
}

/// A value as TOML has it.
pub(super) fn written(value: &Checked) -> String {
    match value {
        Checked::Number(value) => number(*value),
        Checked::Integer(value) => value.to_string(),
        Checked::Boolean(value) => value.to_string(),
        Checked::Text(value) => text(value),
        Checked::Numbers(values) => {
            let values: Vec<f64> = values.iter().map(|(value, _)| *value).collect();
            numbers(&values)
        }
        Checked::Grid(grid) => text(&grid_text(grid)),
        Checked::NumberGrid(cells) => {
            let row = |cells: &[(f64, _)]| -> String {
                let cells: Vec<String> = cells.iter().map(|(cell, _)| number(*cell)).collect();
                format!("[{}]", cells.join(", "))
            };
            format!("[{}]", cells.chunks(LABEL_COUNT).map(row).collect::<Vec<_>>().join(", "))
        }
        Checked::Defuzzifier(rule) => text(&rule.to_string()),
        Checked::Item(item) => rewrite::written(&item.value),
        // Their own keys are written, one by one.
        Checked::Section(_) | Checked::Sections(_) => String::new(),
    }
}

/// The shortest digits that read back as the same number.
pub(super) fn number(value: f64) -> String {
    if value == 0.0 || (1e-4..1e7).contains(&value.abs()) {
        format!("{value:?}")
    } else {
        format!("{value:e}")
    }
}

fn numbers(values: &[f64]) -> String {
    let list = |values: &[f64]| -> String {
        let written: Vec<String> = values.iter().map(|value| number(*value)).collect();
        written.join(", ")
    };
    match values {
        [first @ .., last] if values.len() > MOST_NUMBERS => {
            let first = first.get(..FIRST_NUMBERS).unwrap_or(first);
            format!("[{}, …, {}] ({} numbers)", list(first), number(*last), values.len())
        }
        all => format!("[{}]", list(all)),
    }
}

/// A text in quotes, cut where it is long.
fn text(value: &str) -> String {
    match value.chars().count() {
        count if count > MOST_CHARACTERS => {
            let shown: String = value.chars().take(MOST_CHARACTERS).collect();
            let shown = quoted(&shown);
            format!("{}…\" ({count} characters)", shown.strip_suffix('"').unwrap_or(&shown))
        }
        _ => quoted(value),
    }
}

/// A text in quotes; what cannot be seen is escaped.
pub(super) fn quoted(value: &str) -> String {
    let escaped = |c: char| match c {
        '"' | '\\' => format!("\\{c}"),
        '\n' => "\\n".to_owned(),
        '\t' => "\\t".to_owned(),
        c if is_hidden(c) => format!("\\u{:04X}", u32::from(c)),
        c => c.to_string(),
    };
    format!("\"{}\"", value.chars().map(escaped).collect::<String>())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_has_the_shortest_digits_that_toml_reads_back() {
        for (value, expected) in [
            (0.0, "0.0"),
            (-0.1, "-0.1"),
            (5.0, "5.0"),
            (0.1 + 0.2, "0.30000000000000004"),
            (1e9, "1e9"),
            (1e-100, "1e-100"),
            (f64::MAX, "1.7976931348623157e308"),
        ] {
            assert_eq!(number(value), expected);
            let read: toml::Table = format!("x = {expected}").parse().expect("it is TOML");
            assert_eq!(read["x"].as_float(), Some(value));
        }
    }

    #[test]
    fn a_long_list_is_cut_and_tells_its_length() {
        let values: Vec<f64> = (0..1000).map(f64::from).collect();
        assert_eq!(numbers(&values), "[0.0, 1.0, 2.0, 3.0, …, 999.0] (1000 numbers)");
        assert_eq!(numbers(&values[..2]), "[0.0, 1.0]");
        assert!(!numbers(&values[..MOST_NUMBERS]).contains('…'));
    }

    #[test]
    fn a_text_of_any_characters_is_one_line_that_toml_reads_back() {
        let hostile = "a\"b\\c\nd\te\r\u{1b}[31m\u{2028}\u{202e}\u{85}ä";
        let written = text(hostile);
        assert!(!written.contains(is_hidden), "{written:?}");
        let read: toml::Table = format!("x = {written}").parse().expect("it is TOML");
        assert_eq!(read["x"].as_str(), Some(hostile));
        let long = text(&"ü".repeat(1001));
        assert!(long.ends_with("…\" (1001 characters)") && long.chars().count() < 600, "{long}");
    }
}
