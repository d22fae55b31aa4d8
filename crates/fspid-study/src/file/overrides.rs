//! `--set path=value`: changes of a document before it is checked.

use crate::file::document::{Item, Member, Value, read_value};
use crate::file::problem::nearest;
use crate::file::report::{Place, Report, excerpt};

/// A step of a path.
#[derive(Debug, PartialEq)]
enum Step {
    Name(String),
    Index(usize),
}

/// Applies `path=value` to the document; what is wrong with it is reported.
pub(crate) fn apply(report: &mut Report, document: &mut Item, text: &str) {
    let origin = format!("--set {}", excerpt(text));
    let Some((path, value)) = text.split_once('=') else {
        let place = whole(report, &origin, text);
        let allowed = "path=value, such as loop.sample_period_s=0.02";
        return report.missing(place, "", "there is no `=`", allowed);
    };
    let Some(steps) = steps(path) else {
        let place = whole(report, &origin, path);
        let allowed = "names joined by dots, such as controller[0].kp or controller.\"my PID\".kp";
        return report.value(place, "", "the path cannot be read", allowed);
    };
    let Some(item) = read_value(report, origin.clone(), value.trim()) else {
        return;
    };
    let set = Setting { origin, item };
    descend(report, document, &steps, "", &set);
}

/// What is set, and the words it was set with.
struct Setting {
    origin: String,
    item: Item,
}

fn whole(report: &mut Report, origin: &str, text: &str) -> Place {
    let source = report.add_source(Some(origin.to_owned()), text);
    Place { source, start: 0, end: text.len() }
}

/// The steps of `controller[0].nominal.kp` or `controller."my PID".kp`.
fn steps(path: &str) -> Option<Vec<Step>> {
    let mut steps = Vec::new();
    let mut rest = path.trim();
    loop {
        if let Some(quoted) = rest.strip_prefix('"') {
            let (name, after) = quoted.split_once('"')?;
            steps.push(Step::Name(name.to_owned()));
            rest = after;
        } else {
            let end = rest.find(['.', '[']).unwrap_or(rest.len());
            let (name, after) = rest.split_at(end);
            if name.trim().is_empty() {
                return None;
            }
            steps.push(Step::Name(name.trim().to_owned()));
            rest = after;
        }
        while let Some(bracket) = rest.strip_prefix('[') {
            let (index, after) = bracket.split_once(']')?;
            steps.push(Step::Index(index.trim().parse().ok()?));
            rest = after;
        }
        if rest.is_empty() {
            // As deep as a file may nest.
            return (steps.len() <= 64).then_some(steps);
        }
        rest = rest.strip_prefix('.')?;
    }
}

fn descend(report: &mut Report, at: &mut Item, steps: &[Step], path: &str, set: &Setting) {
    let Some((step, rest)) = steps.split_first() else {
        *at = set.item.clone();
        return;
    };
    let kind = at.value.type_name();
    match (&mut at.value, step) {
        (Value::Table(members), Step::Name(name)) => {
            let path = join(path, name);
            let member = member(members, name, set.item.place);
            descend(report, &mut member.item, rest, &path, set);
        }
        (Value::Array(items), step) => match index(items, step) {
            Ok(index) => {
                let path = format!("{path}[{index}]");
                if let Some(item) = items.get_mut(index) {
                    descend(report, item, rest, &path, set);
                }
            }
            Err((message, allowed)) => {
                let place = whole(report, &set.origin, "");
                report.missing(place, path, message, allowed);
            }
        },
        (_, step) => {
            let place = whole(report, &set.origin, "");
            let message = match step {
                Step::Name(name) => format!("has no `{name}` in it: it is {kind}"),
                Step::Index(index) => format!("has no [{index}]: it is {kind}"),
            };
            report.missing(place, path, message, "");
        }
    }
}

fn join(path: &str, name: &str) -> String {
    let name = excerpt(name);
    if path.is_empty() { name } else { format!("{path}.{name}") }
}

/// The member of that name; an empty table is put there if there is none, for the check to judge.
fn member<'a>(members: &'a mut Vec<Member>, name: &str, place: Place) -> &'a mut Member {
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
