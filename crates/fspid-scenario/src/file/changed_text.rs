//! A scenario's text with one value changed, and everything else as it was written: comments, order, white space.
//!
//! A value that stands in the text is replaced where it stands; one of a table that stands there is added to that table.
//! Whatever else can be changed, such as a number of a preset, becomes an entry of the scenario's own list `set`.

use super::files::Files;
use super::overrides::{self, Found, find};
use super::tunable::{KEY, START};
use crate::keyed::document::{self, Item, Member, Value};
use crate::setting_path::{Step, bare, renamed, steps};
use fspid_diagnostics::{Problems, Report, Span};

/// The text with `value`, as TOML has it, at `path`, as `--set` takes it. Whether the scenario is good with it is for
/// [`parse`](super::parse) to say.
///
/// # Errors
/// A text that is no TOML, a path or a value that cannot be read, a place that cannot be there.
pub fn changed_text(text: &str, path: &str, value: &str) -> Result<String, Problems> {
    let mut report = Report::default();
    let changed = changed(&mut report, document::without_mark(text), path, value.trim());
    report.finish("scenario.toml")?;
    Ok(changed.unwrap_or_else(|| text.to_owned()))
}

/// The text with more entries behind those of its own list of changes, each `path=value`; none for a text without one.
#[must_use]
pub fn with_listed(text: &str, changes: &[String]) -> Option<String> {
    let document = document::read(&mut Report::default(), None, text)?;
    let list = document.member(overrides::KEY)?;
    let Value::Array(entries) = &list.value else { return None };
    let quoted: Vec<String> = changes.iter().map(|change| format!("{change:?}")).collect();
    let quoted = quoted.join(", ");
    Some(match entries.last() {
        _ if changes.is_empty() => text.to_owned(),
        Some(last) => {
            spliced(text, Span { start: last.place.end, ..last.place }, &format!(", {quoted}"))
        }
        None => spliced(text, list.place, &format!("[{quoted}]")),
    })
}

fn changed(report: &mut Report, text: &str, path: &str, value: &str) -> Option<String> {
    let mut document = document::read(report, None, text)?;
    renamed::in_item(report, &mut document, &mut Vec::new());
    // What is wrong with path or value is told as of `--set`.
    let change = format!("{path}={value}");
    let mut wanted = document.clone();
    overrides::apply(report, &mut Files::new(None), &mut wanted, &change);
    let mut steps = steps(path).filter(|_| report.count() == 0)?;
    renamed::in_steps(&mut steps);
    // A text that TOML has without quotes only behind `--set`.
    let value = match document::read_value(&mut Report::default(), String::new(), value)?.value {
        Value::Text(text) if !value.starts_with(['"', '\'']) => format!("{text:?}"),
        _ => value.to_owned(),
    };
    let added = match find(&document, &steps, "") {
        Found::Here(found) if found.member(KEY).is_some() && found.member(START).is_none() => {
            steps.push(Step::Name(START.to_owned()));
            return added(text, &document, &steps, &value);
        }
        // Below its header a table has no place of its own that could hold another value.
        Found::Here(found) if has_header(text, found) => None,
        Found::Here(found) => return Some(replaced(text, found, &value)),
        Found::InFile(..) => None,
        Found::Nothing => added(text, &document, &steps, &value),
    };
    let is_wanted = |text: &String| {
        let again = document::read(&mut Report::default(), None, text);
        again.is_some_and(|again| again.meaning() == wanted.meaning())
    };
    added.filter(is_wanted).or_else(|| Some(listed(text, &document, path, &value)))
}

/// The text with a value in the place of another; of a mark its value at the start.
fn replaced(text: &str, found: &Item, value: &str) -> String {
    let mark = found.member(KEY).and_then(|_| found.member(START));
    spliced(text, mark.unwrap_or(found).place, value)
}

fn spliced(text: &str, Span { start, end, .. }: Span, new: &str) -> String {
    let [before, behind] = [text.get(..start), text.get(end..)].map(Option::unwrap_or_default);
    format!("{before}{new}{behind}")
}

/// The text with a key more in the deepest table of the path that is there.
fn added(text: &str, document: &Item, steps: &[Step], value: &str) -> Option<String> {
    let there = |count: &usize| matches!(find(document, &steps[..*count], ""), Found::Here(_));
    let count = (0..steps.len()).rev().find(there)?;
    let Found::Here(table) = find(document, &steps[..count], "") else { return None };
    let Value::Table(members) = &table.value else { return None };
    let name = |step: &Step| match step {
        Step::Name(name) => Some(bare(name)),
        Step::Index(_) => None,
    };
    let key = steps[count..].iter().map(name).collect::<Option<Vec<_>>>()?.join(".");
    let line = format!("{key} = {value}");
    let end = table.place.end.min(text.len());
    if text.get(table.place.start..end).is_some_and(|it| it.starts_with('{')) {
        let brace = text.get(..end)?.rfind('}')?;
        let before = text.get(..brace)?.trim_end();
        let comma = if before.ends_with(['{', ',']) { "" } else { "," };
        return Some(format!("{before}{comma} {line} {}", text.get(brace..)?));
    }
    let at = line_end(text, last_of(text, members, table, count == 0)?);
    let ends = text.get(..at)?.ends_with('\n') || at == 0;
    let gap = if ends { "" } else { "\n" };
    Some(format!("{}{gap}{line}\n{}", text.get(..at)?, text.get(at..)?))
}

/// Where the last value of a table ends that stands below its header; that of the header itself if there is none.
fn last_of(text: &str, members: &[Member], table: &Item, is_root: bool) -> Option<usize> {
    let start = if is_root { 0 } else { table.place.end };
    let before_header = members.iter().filter(|member| !has_header(text, &member.item));
    let ends = before_header.map(|member| member.item.place.end).filter(|end| *end >= start);
    match ends.max() {
        None if is_root => None,
        found => Some(found.unwrap_or(start)),
    }
}

/// True for a table that has a header of its own, and for a list of them.
fn has_header(text: &str, item: &Item) -> bool {
    let starts_with =
        |item: &Item, c| text.get(item.place.start..).is_some_and(|it| it.starts_with(c));
    match &item.value {
        Value::Table(_) => !starts_with(item, '{'),
        Value::Array(items) => items.first().is_some_and(|first| {
            matches!(first.value, Value::Table(_)) && !starts_with(first, '{')
        }),
        _ => false,
    }
}

/// The beginning of the line behind a place.
fn line_end(text: &str, at: usize) -> usize {
    let rest = text.get(at..).unwrap_or_default();
    rest.find('\n').map_or(text.len(), |end| at + end + 1)
}

/// The text with the change in its list of changes, in the place of an older one of the same path.
fn listed(text: &str, document: &Item, path: &str, value: &str) -> String {
    let entry = format!("{:?}", format!("{}={value}", path.trim()));
    let Some(list) = document.member(overrides::KEY) else {
        let line = format!("{} = [{entry}]\n", overrides::KEY);
        let Value::Table(members) = &document.value else { return text.to_owned() };
        let at = last_of(text, members, document, true).map_or(0, |end| line_end(text, end));
        let [before, behind] = [text.get(..at), text.get(at..)].map(Option::unwrap_or_default);
        let gap = if before.is_empty() || before.ends_with('\n') { "" } else { "\n" };
        return format!("{before}{gap}{line}{behind}");
    };
    let Value::Array(entries) = &list.value else { return text.to_owned() };
    let is_same = |item: &&Item| match &item.value {
        Value::Text(text) => text.split_once('=').is_some_and(|(old, _)| old.trim() == path.trim()),
        _ => false,
    };
    if let Some(old) = entries.iter().rev().find(is_same) {
        return spliced(text, old.place, &entry);
    }
    match entries.last() {
        Some(last) => {
            spliced(text, Span { start: last.place.end, ..last.place }, &format!(", {entry}"))
        }
        None => spliced(text, list.place, &format!("[{entry}]")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "# The flight.\nschema = 1 # so far\nname = \"x\"\n\n[plant]\npreset = \"navion-paper\" # light\n\n[loop]\nsample_period_s = 0.01\nduration_s = 10.0\n\n[[controller]]\nname = \"A\"\nkind = \"fspid\"\nnominal = { kp = 1.0, ki = 0.5 } # found by hand\n[controller.supervisor]\ntable = \"printed\"\nrange = 5.0\n\n[[controller]]\nname = \"B\"\nkind = \"pid\"\nkp = { tune = [0.1, 3.0], start = 1.0 }\n";

    fn change(path: &str, value: &str) -> String {
        changed_text(TEXT, path, value).expect("a path that can be changed")
    }

    #[test]
    fn a_value_is_replaced_where_it_stands_and_nothing_else_moves() {
        let found = change("controller.A.nominal.kp", "2.5");
        assert_eq!(found, TEXT.replace("kp = 1.0, ki", "kp = 2.5, ki"));
        let found = change("loop.duration_s", "20.0");
        assert_eq!(found, TEXT.replace("duration_s = 10.0", "duration_s = 20.0"));
    }

    #[test]
    fn a_mark_keeps_its_range_and_gets_another_start() {
        let found = change("controller.B.kp", "2.0");
        assert_eq!(found, TEXT.replace("start = 1.0", "start = 2.0"));
    }

    #[test]
    fn a_key_that_is_left_out_is_added_to_its_table() {
        let found = change("controller.A.nominal.kd", "0.1");
        assert_eq!(found, TEXT.replace("ki = 0.5 }", "ki = 0.5, kd = 0.1 }"));
        let found = change("controller.A.supervisor.error_scale", "2.0");
        assert_eq!(found, TEXT.replace("range = 5.0\n", "range = 5.0\nerror_scale = 2.0\n"));
        let found = change("controller.A.supervisor.output_scale.kp", "2.0");
        assert_eq!(found, TEXT.replace("range = 5.0\n", "range = 5.0\noutput_scale.kp = 2.0\n"));
        let found = change("actuator.time_constant_s", "0.2");
        assert_eq!(
            found,
            TEXT.replace("name = \"x\"\n", "name = \"x\"\nactuator.time_constant_s = 0.2\n")
        );
    }

    #[test]
    fn what_stands_in_a_preset_becomes_one_entry_of_the_list_of_changes() {
        let once = change("plant.preset.numerator[0]", "-1.5");
        let line = "set = [\"plant.preset.numerator[0]=-1.5\"]\n";
        assert_eq!(once, TEXT.replace("name = \"x\"\n", &format!("name = \"x\"\n{line}")));
        let twice = changed_text(&once, "plant.preset.numerator[0]", "-2.0").expect("again");
        assert_eq!(twice, once.replace("=-1.5", "=-2.0"));
        let other = changed_text(&once, "plant.preset.numerator[1]", "-2.0").expect("another");
        assert_eq!(other, once.replace("-1.5\"]", "-1.5\", \"plant.preset.numerator[1]=-2.0\"]"));
    }

    #[test]
    fn a_whole_table_below_its_header_becomes_an_entry_of_the_list_of_changes() {
        let found = change("loop", "{ sample_period_s = 0.02, duration_s = 5.0 }");
        let line = "set = [\"loop={ sample_period_s = 0.02, duration_s = 5.0 }\"]\n";
        assert_eq!(found, TEXT.replace("name = \"x\"\n", &format!("name = \"x\"\n{line}")));
    }

    #[test]
    fn entries_go_behind_those_of_a_list_however_it_is_written() {
        let more = ["a.b=1".to_owned(), "c=\"d\"".to_owned()];
        for (list, found) in [
            ("set = []\n", "set = [\"a.b=1\", \"c=\\\"d\\\"\"]\n"),
            (
                "\"set\" = [\n 'e=2', # so\n]\n",
                "\"set\" = [\n 'e=2', \"a.b=1\", \"c=\\\"d\\\"\", # so\n]\n",
            ),
        ] {
            let text = format!("schema = 1\n{list}[loop]\nset = 1\n");
            assert_eq!(with_listed(&text, &more), Some(text.replace(list, found)));
            assert_eq!(with_listed(&text, &[]), Some(text));
        }
        assert_eq!(with_listed("[loop]\nset = []\n", &more), None);
    }

    #[test]
    fn what_cannot_be_there_is_refused() {
        for (path, value) in
            [("controller.C.kp", "1.0"), ("a..b", "1.0"), ("loop.duration_s", "= 1")]
        {
            assert!(changed_text(TEXT, path, value).is_err(), "{path}={value}");
        }
        assert!(changed_text("a = = 1", "a", "1").is_err());
    }
}
