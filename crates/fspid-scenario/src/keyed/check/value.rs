//! The check of a single value.

use fspid_fuzzy::Defuzzifier;

use crate::keyed::check::unit::in_text;
use crate::keyed::check::{grid, hint, in_words, number_grid, quoted, table};
use crate::keyed::document::{Item, Value};
use crate::keyed::{Checked, Kind, Range, Table};
use fspid_diagnostics::{Report, Span};

/// The value if it is of its kind; otherwise its problems are reported.
pub(super) fn check(
    report: &mut Report,
    kind: &'static Kind,
    item: &Item,
    path: &str,
) -> Option<Checked> {
    match kind {
        Kind::Number { unit, range } => {
            number(report, item, path, *range, unit).map(Checked::Number)
        }
        Kind::Integer { least, most } => {
            integer(report, item, path, (*least, *most)).map(Checked::Integer)
        }
        Kind::Boolean => match item.value {
            Value::Boolean(boolean) => Some(Checked::Boolean(boolean)),
            _ => wrong_type(report, item, path, kind),
        },
        Kind::FreeText => match &item.value {
            Value::Text(text) => Some(Checked::Text(text.clone())),
            _ => wrong_type(report, item, path, kind),
        },
        Kind::Text | Kind::Path => match &item.value {
            Value::Text(text) if !text.trim().is_empty() => Some(Checked::Text(text.clone())),
            Value::Text(_) => {
                report.value(item.place, path, "the text is empty", allowed(kind));
                None
            }
            _ => wrong_type(report, item, path, kind),
        },
        Kind::Word(words) => word(report, item, path, words, "word").map(Checked::Text),
        Kind::Preset(list) => word(report, item, path, &list(), "preset").map(Checked::Text),
        Kind::Rules { names, grids } => rules(report, item, path, (*names, grids)),
        Kind::Grid => grid::check(report, item, path).map(Checked::Grid),
        Kind::NumberGrid => number_grid::check(report, item, path).map(Checked::NumberGrid),
        Kind::Defuzzifier => defuzzifier(report, item, path).map(Checked::Defuzzifier),
        Kind::Own { .. } => Some(Checked::Item(item.clone())),
        Kind::Numbers { unit, range, least, most } => {
            numbers(report, item, path, (*range, unit), (*least, *most)).map(Checked::Numbers)
        }
        Kind::Interval { unit, range } => {
            interval(report, item, path, (*range, unit)).map(Checked::Numbers)
        }
        Kind::Table(spec) => table(report, spec, item, path).map(Checked::Section),
        Kind::Tables { table, least, most } => tables(report, item, path, (table, *least, *most)),
    }
}

/// What a key may hold, in words.
pub(crate) fn allowed(kind: &Kind) -> String {
    match kind {
        Kind::Number { unit, range } => range.words(unit),
        Kind::Integer { least, most } if least == most => format!("{least}"),
        Kind::Integer { least, most } => format!("a whole number from {least} to {most}"),
        Kind::Boolean => "true or false".to_owned(),
        Kind::Text | Kind::FreeText => "a text in quotes".to_owned(),
        Kind::Path => "the path of a file in quotes".to_owned(),
        Kind::Word(words) => quoted(words),
        Kind::Preset(list) => quoted(&list()),
        Kind::Rules { names, .. } => format!(
            "{}, the path of a .toml file, or a table with delta_kp, delta_ki and delta_kd",
            quoted(&names())
        ),
        Kind::Grid => "seven lines of seven labels out of NB NM NS ZO PS PM PB".to_owned(),
        Kind::NumberGrid => number_grid::ALLOWED.to_owned(),
        Kind::Defuzzifier => Defuzzifier::NAMES.to_owned(),
        Kind::Own { allowed, .. } => allowed(),
        Kind::Numbers { range: Range::Finite, .. } => "a list of finite numbers".to_owned(),
        Kind::Numbers { range, unit, .. } => {
            format!("a list of numbers, each {}", range.words(unit))
        }
        Kind::Interval { range, unit } => {
            format!("[lower, upper] with lower below upper, each {}", range.words(unit))
        }
        Kind::Table(spec) => in_words(spec),
        Kind::Tables { .. } => "tables under a heading in double brackets".to_owned(),
    }
}

pub(super) fn wrong_type<T>(
    report: &mut Report,
    item: &Item,
    path: &str,
    kind: &Kind,
) -> Option<T> {
    let message = format!("wrong type: {}", item.value.type_name());
    report.value(item.place, path, message, allowed(kind));
    None
}

pub(super) fn number(
    report: &mut Report,
    item: &Item,
    path: &str,
    range: Range,
    unit: &'static str,
) -> Option<f64> {
    let (Value::Integer(value, _) | Value::Float(value)) = item.value else {
        let found = item.value.type_name();
        let instead = match &item.value {
            Value::Text(text) => in_text(text, unit).unwrap_or_default(),
            other => hint::of_range(other, path).to_owned(),
        };
        report.value(item.place, path, format!("wrong type: {found}{instead}"), range.words(unit));
        return None;
    };
    if range.contains(value) {
        return Some(value);
    }
    let message = if value.is_nan() {
        "not a number"
    } else if value.is_finite() {
        "out of range"
    } else {
        "not a finite number"
    };
    report.value(item.place, path, message, range.words(unit));
    None
}

fn integer(report: &mut Report, item: &Item, path: &str, (least, most): (i64, i64)) -> Option<i64> {
    let kind = Kind::Integer { least, most };
    let message = match item.value {
        Value::Integer(_, Some(value)) if (least..=most).contains(&value) => return Some(value),
        Value::Integer(..) => "out of range",
        Value::Float(_) => "not a whole number",
        _ => return wrong_type(report, item, path, &kind),
    };
    report.value(item.place, path, message, allowed(&kind));
    None
}

/// A word out of a list; `what` says what the word is.
pub(super) fn word(
    report: &mut Report,
    item: &Item,
    path: &str,
    known: &[&str],
    what: &str,
) -> Option<String> {
    let Value::Text(text) = &item.value else {
        let message = format!("wrong type: {}", item.value.type_name());
        report.value(item.place, path, message, quoted(known));
        return None;
    };
    if known.contains(&text.as_str()) {
        return Some(text.clone());
    }
    let message = format!("unknown {what}{}", hint::of_word(text, known));
    report.value(item.place, path, message, quoted(known));
    None
}

fn numbers(
    report: &mut Report,
    item: &Item,
    path: &str,
    (range, unit): (Range, &'static str),
    (least, most): (usize, usize),
) -> Option<Vec<(f64, Span)>> {
    let kind = Kind::Numbers { unit, range, least, most };
    let Value::Array(items) = &item.value else {
        return wrong_type(report, item, path, &kind);
    };
    if !(least..=most).contains(&items.len()) {
        let message = match items.len() {
            0 => "the list is empty".to_owned(),
            count => format!("{count} numbers"),
        };
        let allowed = match least == most {
            true => format!("{most} numbers"),
            false => format!("{least} to {most} numbers"),
        };
        report.value(item.place, path, message, allowed);
        return None;
    }
    let before = report.count();
    let mut values = Vec::with_capacity(items.len());
    for (index, item) in items.iter().enumerate() {
        let path = format!("{path}[{index}]");
        values.extend(number(report, item, &path, range, unit).map(|value| (value, item.place)));
    }
    (report.count() == before).then_some(values)
}

fn interval(
    report: &mut Report,
    item: &Item,
    path: &str,
    (range, unit): (Range, &'static str),
) -> Option<Vec<(f64, Span)>> {
    let kind = Kind::Interval { unit, range };
    let Value::Array(items) = &item.value else {
        return wrong_type(report, item, path, &kind);
    };
    if items.len() != 2 {
        let message = format!("{} numbers instead of two", items.len());
        report.value(item.place, path, message, allowed(&kind));
        return None;
    }
    let values = numbers(report, item, path, (range, unit), (2, 2))?;
    if let [(lower, _), (upper, _)] = *values
        && lower >= upper
    {
        let message = "the lower is not below the upper";
        report.value(item.place, path, message, allowed(&kind));
        return None;
    }
    Some(values)
}

fn tables(
    report: &mut Report,
    item: &Item,
    path: &str,
    (spec, least, most): (&'static Table, usize, usize),
) -> Option<Checked> {
    let Value::Array(items) = &item.value else {
        let message = format!("expected a list of tables, not {}", item.value.type_name());
        let allowed = format!("[[{path}]] in double brackets before each");
        report.missing(item.place, path, message, allowed);
        return None;
    };
    if !(least..=most).contains(&items.len()) {
        let message = match items.len() {
            0 => "there is none".to_owned(),
            count => format!("{count} of them"),
        };
        report.missing(item.place, path, message, format!("{least} to {most}"));
        return None;
    }
    let sections = items
        .iter()
        .enumerate()
        .filter_map(|(index, item)| table(report, spec, item, &format!("{path}[{index}]")));
    Some(Checked::Sections(sections.collect()))
}

fn rules(
    report: &mut Report,
    item: &Item,
    path: &str,
    (names, grids): (fn() -> Vec<&'static str>, &'static Table),
) -> Option<Checked> {
    let kind = Kind::Rules { names, grids };
    let text = match &item.value {
        Value::Table(_) => return table(report, grids, item, path).map(Checked::Section),
        Value::Text(text) => text,
        _ => return wrong_type(report, item, path, &kind),
    };
    let known = names();
    let is_file =
        std::path::Path::new(text).extension().is_some_and(|extension| extension == "toml");
    if known.contains(&text.as_str()) || is_file {
        return Some(Checked::Text(text.clone()));
    }
    let message = format!("unknown rule table{}", hint::of_word(text, &known));
    report.value(item.place, path, message, allowed(&kind));
    None
}

fn defuzzifier(report: &mut Report, item: &Item, path: &str) -> Option<Defuzzifier> {
    let Value::Text(text) = &item.value else {
        return wrong_type(report, item, path, &Kind::Defuzzifier);
    };
    match text.parse() {
        Ok(defuzzifier) => Some(defuzzifier),
        Err(error) => {
            let message = match error {
                fspid_fuzzy::FuzzyError::UnknownDefuzzifier => "unknown defuzzifier".to_owned(),
                other => other.to_string(),
            };
            report.value(item.place, path, message, Defuzzifier::NAMES);
            None
        }
    }
}
