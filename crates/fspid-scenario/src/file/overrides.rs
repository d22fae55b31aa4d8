//! `--set path=value`: changes of a document before it is checked.
//!
//! `list[]=value` puts an entry behind those of a list.
//!
//! A path may lead through a key that names a file or preset into what that says, as in
//! `plant.preset.numerator[0]`. Such a change waits in [`Files`] until the file has been read.

use crate::file::files::Files;
use crate::keyed::document::{Item, Member, Value, read_value};
use crate::setting_path::{Step, renamed, steps};
use fspid_diagnostics::{Report, Span, excerpt, nearest};

/// Name of the key that lists changes in the file itself.
pub(crate) const KEY: &str = "set";

/// Applies the changes that the document lists itself; a list that is none is left for the check.
pub(crate) fn apply_listed(report: &mut Report, files: &mut Files<'_>, document: &mut Item) {
    let Value::Table(members) = &document.value else {
        return;
    };
    let listed = members.iter().find(|member| member.name == KEY).map(|member| &member.item.value);
    let Some(Value::Array(items)) = listed else {
        return;
    };
    let text = |item: &Item| match &item.value {
        Value::Text(text) => Some((item.place, text.clone())),
        _ => None,
    };
    let texts: Vec<(Span, String)> = items.iter().filter_map(text).collect();
    for (place, text) in texts {
        let text = renamed::in_change(report, place, text);
        apply(report, files, document, &text);
    }
}

/// What the key may hold, in words.
pub(crate) fn listed_in_words() -> String {
    "a list of texts `path=value`, such as [\"plant.preset.numerator[0]=-1.5\"]".to_owned()
}

/// As JSON Schema.
pub(crate) fn listed_schema() -> serde_json::Value {
    serde_json::json!({ "type": "array", "items": { "type": "string" } })
}

/// Reports a list of changes that is none.
pub(crate) fn check_listed(report: &mut Report, item: &Item) {
    let is_text = |item: &Item| matches!(item.value, Value::Text(_));
    if !matches!(&item.value, Value::Array(items) if items.iter().all(is_text)) {
        let message = format!("wrong type: {}", item.value.type_name());
        report.value(item.place, KEY, message, listed_in_words());
    }
}

/// Applies `path=value` to the document; what is wrong with it is reported.
pub(crate) fn apply(report: &mut Report, files: &mut Files<'_>, document: &mut Item, text: &str) {
    let origin = format!("--set {}", excerpt(text));
    let Some((path, value)) = text.split_once('=') else {
        let place = whole(report, &origin, text);
        let allowed = "path=value, such as loop.sample_period_s=0.02";
        return report.missing(place, "", "there is no `=`", allowed);
    };
    let (path, appends) = path.trim().strip_suffix("[]").map_or((path, false), |it| (it, true));
    let Some(mut steps) = steps(path) else {
        let place = whole(report, &origin, path);
        let allowed = "names joined by dots, such as controller[0].kp or controller.\"my PID\".kp";
        return report.value(place, "", "the path cannot be read", allowed);
    };
    let Some(mut item) = read_value(report, origin.clone(), value.trim()) else {
        return;
    };
    if let Some(key) = renamed::in_steps(&mut steps) {
        key.warn(report, item.place, path.trim());
    }
    renamed::in_item(report, &mut item, &mut steps.clone());
    let item = match appends {
        true => appended(document, &steps, item),
        false => item,
    };
    let set = Setting { origin, item };
    put(report, files, document, (&steps, &set));
}

/// The list at a path with one more entry; what is no list is left to the check.
fn appended(document: &Item, steps: &[Step], entry: Item) -> Item {
    let place = entry.place;
    let mut entries = match find(document, steps, "") {
        Found::Here(Item { value: Value::Array(entries), .. }) => entries.clone(),
        Found::Here(_) | Found::InFile(..) | Found::Nothing => Vec::new(),
    };
    entries.push(entry);
    Item { place, value: Value::Array(entries) }
}

/// Puts a value into the document, or keeps it for the file that its path leads into.
pub(crate) fn put(
    report: &mut Report,
    files: &mut Files<'_>,
    document: &mut Item,
    (steps, set): (&[Step], &Setting),
) {
    if let Some((path, rest)) = descend(report, document, steps, "", set) {
        files.change(Change { path, steps: rest.to_vec(), set: set.clone() });
    }
}

/// What is set, and the words it was set with.
#[derive(Clone, Debug)]
pub(crate) struct Setting {
    pub(crate) origin: String,
    pub(crate) item: Item,
}

/// A change inside of a file that the key at `path` names.
#[derive(Clone, Debug)]
pub(crate) struct Change {
    pub(crate) path: String,
    steps: Vec<Step>,
    set: Setting,
}

impl Change {
    /// What is changed, for digests.
    pub(crate) fn meaning(&self) -> String {
        format!("{} {:?} {}", self.path, self.steps, self.set.item.meaning())
    }

    /// Changes what the file says.
    pub(crate) fn apply(&self, report: &mut Report, document: &mut Item) {
        if descend(report, document, &self.steps, "", &self.set).is_some() {
            let place = whole(report, &self.set.origin, "");
            report.missing(place, &self.path, "a file there names no other file", "");
        }
    }

    /// The change as `path=value`, where the key stands at another path; `written` writes a value.
    pub(crate) fn text(&self, path: &str, written: fn(&Value) -> String) -> String {
        let mut text = path.to_owned();
        for step in &self.steps {
            match step {
                Step::Index(index) => text.push_str(&format!("[{index}]")),
                Step::Name(name) => text.push_str(&format!(".\"{name}\"")),
            }
        }
        format!("{text}={}", written(&self.set.item.value))
    }

    /// Reports that there is no file at the path.
    pub(crate) fn report_unused(&self, report: &mut Report) {
        let place = whole(report, &self.set.origin, "");
        let message = match self.steps.first() {
            Some(Step::Index(index)) => format!("has no [{index}]: it is text"),
            Some(Step::Name(name)) => format!("has no `{name}` in it: it is text"),
            None => "is text".to_owned(),
        };
        report.missing(place, &self.path, message, "");
    }
}

fn whole(report: &mut Report, origin: &str, text: &str) -> Span {
    let source = report.add_source(Some(origin.to_owned()), text);
    Span { source, start: 0, end: text.len() }
}

/// Follows the steps and sets what is there. Answers the path of a text on the way and the steps
/// that lead into the file it names, if there is one.
fn descend<'s>(
    report: &mut Report,
    at: &mut Item,
    steps: &'s [Step],
    path: &str,
    set: &Setting,
) -> Option<(String, &'s [Step])> {
    let Some((step, rest)) = steps.split_first() else {
        *at = set.item.clone();
        return None;
    };
    let kind = at.value.type_name();
    match (&mut at.value, step) {
        (Value::Table(members), Step::Name(name)) => {
            let path = join(path, name);
            let member = member(members, name, set.item.place);
            descend(report, &mut member.item, rest, &path, set)
        }
        (Value::Array(items), step) => match index(items, step) {
            Ok(index) => {
                let path = format!("{path}[{index}]");
                descend(report, items.get_mut(index)?, rest, &path, set)
            }
            Err((message, allowed)) => {
                let place = whole(report, &set.origin, "");
                report.missing(place, path, message, allowed);
                None
            }
        },
        (Value::Text(_), _) => Some((path.to_owned(), steps)),
        (_, step) => {
            let place = whole(report, &set.origin, "");
            let message = match step {
                Step::Name(name) => format!("has no `{name}` in it: it is {kind}"),
                Step::Index(index) => format!("has no [{index}]: it is {kind}"),
            };
            report.missing(place, path, message, "");
            None
        }
    }
}

/// What is found at the end of a path.
pub(crate) enum Found<'a> {
    /// The value itself.
    Here(&'a Item),
    /// The key that names a file, and the steps inside of that.
    InFile(String, &'a [Step]),
    /// Nothing.
    Nothing,
}

/// Follows the steps without changing anything.
pub(crate) fn find<'a>(at: &'a Item, steps: &'a [Step], path: &str) -> Found<'a> {
    let Some((step, rest)) = steps.split_first() else {
        return Found::Here(at);
    };
    match (&at.value, step) {
        (Value::Table(members), Step::Name(name)) => {
            let member = members.iter().find(|member| member.name == *name);
            member.map_or(Found::Nothing, |it| find(&it.item, rest, &join(path, name)))
        }
        (Value::Array(items), step) => {
            let found = index(items, step).ok().and_then(|at| Some((at, items.get(at)?)));
            found.map_or(Found::Nothing, |(at, item)| find(item, rest, &format!("{path}[{at}]")))
        }
        (Value::Text(_), _) => Found::InFile(path.to_owned(), steps),
        _ => Found::Nothing,
    }
}

/// The steps with entries of lists by their numbers, as far as the document has them.
pub(crate) fn numbered(at: &Item, steps: &[Step]) -> Vec<Step> {
    let Some((step, rest)) = steps.split_first() else { return Vec::new() };
    let next = match (&at.value, step) {
        (Value::Table(members), Step::Name(name)) => {
            let member = members.iter().find(|member| member.name == *name);
            member.map(|it| (step.clone(), &it.item))
        }
        (Value::Array(items), step) => {
            let found = index(items, step).ok();
            found.and_then(|at| Some((Step::Index(at), items.get(at)?)))
        }
        _ => None,
    };
    match next {
        Some((step, item)) => std::iter::once(step).chain(numbered(item, rest)).collect(),
        None => steps.to_vec(),
    }
}

fn join(path: &str, name: &str) -> String {
    let name = excerpt(name);
    if path.is_empty() { name } else { format!("{path}.{name}") }
}

/// The member of that name; an empty table is put there if there is none, for the check to judge.
fn member<'a>(members: &'a mut Vec<Member>, name: &str, place: Span) -> &'a mut Member {
    let known = members.iter().position(|member| member.name == name);
    let index = known.unwrap_or_else(|| {
        let value = Value::Table(Vec::new());
        let item = Item { place, value };
        let name = name.to_owned();
        members.push(Member { name, place, item });
        members.len() - 1
    });
    &mut members[index]
}

/// Which entry of a list is meant, or what is wrong and what is known.
fn index(items: &[Item], step: &Step) -> Result<usize, (String, String)> {
    let names: Vec<&str> = items.iter().filter_map(name_of).collect();
    let (found, suggestion) = match step {
        Step::Index(index) => ((*index < items.len()).then_some(*index), String::new()),
        Step::Name(name) => {
            let found = items.iter().position(|item| name_of(item) == Some(name));
            let meant = nearest(name, &names).map(|meant| format!("; did you mean `{meant}`?"));
            (found, meant.unwrap_or_default())
        }
    };
    found.ok_or_else(|| {
        let message = match step {
            Step::Index(index) => format!("there is no entry {index}"),
            Step::Name(name) => format!("there is no entry named `{name}`{suggestion}"),
        };
        let mut known = match items.len() {
            0 => "none, the list is empty".to_owned(),
            1 => "index 0".to_owned(),
            count => format!("an index from 0 to {}", count - 1),
        };
        if !names.is_empty() {
            known = format!("{known}, or a name: {}", names.join(", "));
        }
        (message, known)
    })
}

fn name_of(item: &Item) -> Option<&str> {
    let Value::Table(members) = &item.value else {
        return None;
    };
    let name = members.iter().find(|member| member.name == "name")?;
    match &name.item.value {
        Value::Text(text) => Some(text),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_is_read_with_names_indices_and_quotes() {
        let name = |text: &str| Step::Name(text.to_owned());
        let expected = vec![name("controller"), Step::Index(1), name("kp")];
        assert_eq!(steps("controller[1].kp"), Some(expected));
        let expected = vec![name("controller"), name("my.PID"), name("kp")];
        assert_eq!(steps("controller.\"my.PID\".kp"), Some(expected));
        for bad in ["", ".", "a.", "a[", "a[x]", "a..b", "a\"b"] {
            assert_eq!(steps(bad).is_some(), bad == "a\"b", "{bad}");
        }
    }
}
