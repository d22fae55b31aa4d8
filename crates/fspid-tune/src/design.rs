//! A design: the scenario's own text with what was found in place of the marks.

use std::path::PathBuf;

use fspid_scenario::file::{Extra, LoadError, NewValue, Template, read_text, with_listed};
use fspid_scenario::tuning::{Free, TunableParameter};

use crate::error::TuneError;
use crate::source::{Source, folder_of};
use crate::space::Space;

/// The text of a scenario file without its byte order mark.
///
/// # Errors
/// A file that cannot be read.
pub(crate) fn text_of(source: &Source) -> Result<String, TuneError> {
    let text = read_text(&source.path)?;
    Ok(text.strip_prefix('\u{feff}').unwrap_or(&text).to_owned())
}

/// Checks that a design of this scenario can lie in another folder, before anything is searched.
///
/// # Errors
/// A folder in its place, or a file that would not be found from there.
pub fn check_place(source: &Source, out: &std::path::Path) -> Result<(), TuneError> {
    fspid_study::output::no_folder(out).map_err(TuneError::Output)?;
    let text = text_of(source)?;
    let extra = Extra { overrides: &source.overrides, ..Extra::default() };
    let name = out.display().to_string();
    if Template::parse(&text, &name, Some(folder_of(out)), &extra).is_err() {
        return Err(TuneError::Value {
            what: "--out",
            found: name,
            allowed: "a file in the folder of the scenario, which names files relative to itself"
                .to_owned(),
        });
    }
    Ok(())
}

/// A scenario as it was read when its search began: its file may be another one by the time that something is found.
#[derive(Clone, Debug)]
pub(crate) struct Original {
    name: String,
    folder: PathBuf,
    text: String,
    overrides: Vec<String>,
}

impl Original {
    /// What a source says now, and the scenario that it is.
    ///
    /// # Errors
    /// Everything that is wrong with it.
    pub(crate) fn read(source: &Source) -> Result<(Self, Template), TuneError> {
        let text = text_of(source)?;
        let extra = Extra { overrides: &source.overrides, ..Extra::default() };
        let name = source.path.display().to_string();
        let folder = folder_of(&source.path).to_owned();
        let template = Template::parse(&text, &name, Some(&folder), &extra);
        let template = template.map_err(LoadError::Problems)?;
        Ok((Self { name, folder, text, overrides: source.overrides.clone() }, template))
    }
}

/// The scenario with the values of a point in place of its marks; `heading` comes first, as comments.
///
/// # Errors
/// A text that would not be this scenario again: nothing is written that cannot be read.
pub(crate) fn text(
    original: &Original,
    space: &Space,
    point: &[f64],
    heading: &[String],
) -> Result<String, TuneError> {
    let text = unread(original, space, point, heading);
    let name = format!("a design of {}", original.name);
    Template::parse(&text, &name, Some(&original.folder), &Extra::default())?;
    Ok(text)
}

fn unread(original: &Original, space: &Space, point: &[f64], heading: &[String]) -> String {
    let Original { text: original, overrides, .. } = original;
    let values = space.values(point);
    let mut places: Vec<(&TunableParameter, &NewValue)> =
        space.parameters().iter().zip(values.iter().map(|(_, value)| value)).collect();
    places.sort_by_key(|(mark, _)| mark.bytes().start);
    let mut body = String::new();
    let mut from = 0;
    let mut changes: Vec<String> = overrides.clone();
    for (mark, value) in places {
        let bytes = mark.bytes();
        if bytes.is_empty() {
            // The mark came from outside; it was set there, and its value is set after it.
            changes.push(format!("{}={value}", mark.path.text()));
            continue;
        }
        body.push_str(original.get(from..bytes.start).unwrap_or_default());
        body.push_str(&written(mark, value));
        from = bytes.end;
    }
    body.push_str(original.get(from..).unwrap_or_default());
    with_changes(&body, heading, &changes)
}

/// A text with comments before it, and with changes behind those that it lists itself.
pub(crate) fn with_changes(body: &str, heading: &[String], changes: &[String]) -> String {
    let mut out = String::new();
    for line in heading {
        out.push_str(&format!("# {line}\n"));
    }
    // A list of its own stays where it is: a text has one.
    if let Some(listed) = with_listed(body, changes) {
        return out + &listed;
    }
    if !changes.is_empty() {
        let quoted: Vec<String> = changes.iter().map(|change| format!("{change:?}")).collect();
        out.push_str(&format!("set = [{}]\n", quoted.join(", ")));
    }
    out + body
}

/// A value as a person would write it; a grid in lines.
fn written(mark: &TunableParameter, value: &NewValue) -> String {
    match (&mark.free, value) {
        (Free::Grid(_), NewValue::Text(text)) => format!("\"\"\"\n{text}\n\"\"\""),
        (Free::Numbers(_), NewValue::Rows(rows)) => rows_of(rows),
        _ => value.to_string(),
    }
}

/// Rows of numbers, one in a line, the columns below each other.
fn rows_of(rows: &[Vec<f64>]) -> String {
    let texts: Vec<Vec<String>> =
        rows.iter().map(|row| row.iter().map(|number| format!("{number:?}")).collect()).collect();
    let width = texts.iter().flatten().map(String::len).max().unwrap_or(0);
    let mut out = "[\n".to_owned();
    for row in texts {
        let row: Vec<String> = row.iter().map(|text| format!("{text:>width$}")).collect();
        out.push_str(&format!("  [{}],\n", row.join(", ")));
    }
    out.push(']');
    out
}
