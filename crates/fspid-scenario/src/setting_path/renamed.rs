//! Keys that had another name: for one version the old one is read as the new one, with a warning.
//!
//! A text is renamed where it is read, and a path where it is parsed, so that nothing else knows an old key. The schema, the
//! lists of paths and the words that a mistyped key is compared with have the new ones alone.

use super::{Step, path_of, steps};
use crate::keyed::document::{Item, Member, Value};
use fspid_diagnostics::{Report, Span, excerpt};

/// A key by both of its names.
#[derive(Debug)]
pub(crate) struct Renamed {
    /// The table that it is in, as a path; [`EACH`] stands for an entry of a list.
    pub(crate) table: &'static str,
    pub(crate) old: &'static str,
    pub(crate) new: &'static str,
}

/// Any entry of a list, by its number or by its name.
pub(crate) const EACH: &str = "*";

/// What was renamed. A row stays for one version.
pub(crate) const RENAMED: [Renamed; 4] = [
    row("controller.*", "followers", "gain_coupling"),
    row("controller.*.supervisor", "sees", "second_input"),
    row("controller.*.supervisor", "error_sets", "error_set_centres"),
    row("controller.*.supervisor", "change_sets", "change_set_centres"),
];

const fn row(table: &'static str, old: &'static str, new: &'static str) -> Renamed {
    Renamed { table, old, new }
}

/// Renames the keys of a value that stands at these steps, and of everything in it. Of an old key beside its new one
/// nothing is left but the problem.
pub(crate) fn in_item(report: &mut Report, item: &mut Item, at: &mut Vec<Step>) {
    if !RENAMED.iter().any(|row| row.is_beyond(at)) {
        return;
    }
    match &mut item.value {
        Value::Table(members) => {
            for row in RENAMED.iter().filter(|row| row.is_in(at)) {
                row.rename(report, members, at);
            }
            for Member { name, item, .. } in members {
                at.push(Step::Name(name.clone()));
                in_item(report, item, at);
                at.pop();
            }
        }
        Value::Array(items) => {
            for (index, item) in items.iter_mut().enumerate() {
                at.push(Step::Index(index));
                in_item(report, item, at);
                at.pop();
            }
        }
        _ => {}
    }
}

/// Renames the key of a path; answers it if there was one. No renamed key is inside of another.
pub(crate) fn in_steps(path: &mut [Step]) -> Option<&'static Renamed> {
    let is_old = |at: usize, row: &&Renamed| {
        path.get(at).is_some_and(|step| is(row.old, step))
            && path.get(..at).is_some_and(|before| row.is_in(before))
    };
    let found = |at| RENAMED.iter().find(|row| is_old(at, row)).map(|row| (at, row));
    let (at, row) = (0..path.len()).find_map(found)?;
    *path.get_mut(at)? = Step::Name(row.new.to_owned());
    Some(row)
}

/// A change `path=value` of the text at a place, with the new key in its path.
pub(crate) fn in_change(report: &mut Report, place: Span, text: String) -> String {
    let parts = text.split_once('=').and_then(|(path, value)| Some((path, steps(path)?, value)));
    let Some((path, mut steps, value)) = parts else {
        return text;
    };
    match in_steps(&mut steps) {
        Some(row) => {
            row.warn(report, place, path.trim());
            format!("{}={value}", path_of(&steps))
        }
        None => text,
    }
}

impl Renamed {
    /// Warns of the old key, which stands at a place in a path.
    pub(crate) fn warn(&self, report: &mut Report, place: Span, path: &str) {
        let (Self { old, new, .. }, path) = (self, excerpt(path));
        let told =
            format!("{path}: `{old}` is called `{new}` now; the old key is read for one version");
        report.warn_at(place, &told);
    }

    /// The steps lead to the table of the key.
    fn is_in(&self, at: &[Step]) -> bool {
        let parts = self.table.split('.');
        parts.clone().count() == at.len() && parts.zip(at).all(|(part, step)| is(part, step))
    }

    /// The steps lead to the table of the key, or towards it.
    fn is_beyond(&self, at: &[Step]) -> bool {
        let mut parts = self.table.split('.');
        at.iter().all(|step| parts.next().is_some_and(|part| is(part, step)))
    }

    fn rename(&self, report: &mut Report, members: &mut Vec<Member>, at: &[Step]) {
        let Some(index) = members.iter().position(|member| member.name == self.old) else {
            return;
        };
        let place = |member: &Member| member.place;
        let new = members.iter().find(|member| member.name == self.new).map(place);
        let path = path_of(&[at, &[Step::Name(self.old.to_owned())]].concat());
        match (members.get_mut(index), new) {
            (Some(member), None) => {
                self.new.clone_into(&mut member.name);
                self.warn(report, member.place, &path);
            }
            (Some(member), Some(new)) => {
                let stands = report.place(new).map(|place| format!(" in line {}", place.line));
                let stands = stands.unwrap_or_default();
                let message =
                    format!("the old key of `{}`, which is here as well{stands}", self.new);
                report.missing(member.place, &path, message, format!("`{}` alone", self.new));
                members.remove(index);
            }
            (None, _) => {}
        }
    }
}

fn is(part: &str, step: &Step) -> bool {
    part == EACH || matches!(step, Step::Name(name) if name == part)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_path_of_an_old_key_is_that_of_the_new_one() {
        for (old, new) in [
            ("controller[1].supervisor.sees", "controller[1].supervisor.second_input"),
            ("controller.followers.followers", "controller.followers.gain_coupling"),
            (
                "controller.\"a b\".supervisor.error_sets[0].start",
                "controller.\"a b\".supervisor.error_set_centres[0].start",
            ),
        ] {
            let mut found = steps(old).expect("a path");
            assert!(in_steps(&mut found).is_some(), "{old}");
            assert_eq!(path_of(&found), new);
        }
    }

    /// A controller may be called as a key was, and a key of another table is another key.
    #[test]
    fn a_word_that_is_no_old_key_stays() {
        for path in ["controller.followers.kp", "controller.PID.sees", "sees", "tuning.followers"] {
            let mut found = steps(path).expect("a path");
            assert!(in_steps(&mut found).is_none(), "{path}");
            assert_eq!(path_of(&found), path);
        }
    }
}
