//! Names of files and columns for things that have names of their own, of which any letter may be part.

use std::collections::BTreeSet;

/// What is named after something.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// A file: letters, digits, `-` and `_`, and on some systems `A` is `a`.
    File,
    /// A file in small letters of English, as certificates are.
    PlainFile,
    /// A column of CSV, without what separates cells.
    Column,
}

impl Place {
    /// The name of a thing that has no others beside it.
    fn alone(self, name: &str) -> String {
        let name = match self {
            Self::File => replaced(name, "_", |c| c.is_alphanumeric() || c == '-' || c == '_'),
            Self::PlainFile => {
                replaced(name, "-", |c| c.is_ascii_alphanumeric() || c == '-').to_lowercase()
            }
            Self::Column => {
                return replaced(name, "_", |c| !matches!(c, ',' | '"' | '\n' | '\r'));
            }
        };
        let name = cut(&name);
        match is_device(name) {
            true => format!("{name}{}", self.joint()),
            false => name.to_owned(),
        }
    }

    /// What two names must not share.
    fn key(self, name: &str) -> String {
        match self {
            // Some systems compare small letters, some large ones.
            Self::File | Self::PlainFile => name.to_uppercase().to_lowercase(),
            Self::Column => name.to_owned(),
        }
    }

    /// What stands before the number of one that is numbered.
    const fn joint(self) -> &'static str {
        match self {
            Self::PlainFile => "-",
            Self::File | Self::Column => "_",
        }
    }
}

/// Bytes of a name of a file: 255 are possible (`NAME_MAX`), with a number, an ending and what is written beside it.
const LONGEST: usize = 120;

/// As much of a name as a file may have.
fn cut(name: &str) -> &str {
    let end = (0..=LONGEST).rev().find(|end| name.is_char_boundary(*end)).unwrap_or_default();
    name.get(..end).filter(|_| name.len() > LONGEST).unwrap_or(name)
}

/// True for what names a device on Windows, whatever ending stands behind it.
fn is_device(name: &str) -> bool {
    let name = name.to_lowercase();
    let numbered = name.strip_prefix("com").or_else(|| name.strip_prefix("lpt"));
    let is_digit = |rest: &str| rest.len() == 1 && rest.bytes().all(|it| it.is_ascii_digit());
    matches!(name.as_str(), "con" | "prn" | "aux" | "nul") || numbered.is_some_and(is_digit)
}

fn replaced(name: &str, by: &str, fits: impl Fn(char) -> bool) -> String {
    name.chars().map(|c| if fits(c) { c.to_string() } else { by.to_owned() }).collect()
}

/// Things by their own names and by those of their files or columns, of which no two are alike.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Names {
    place: Place,
    pairs: Vec<(String, String)>,
}

impl Names {
    /// The names of all things that stand beside each other, in their order. One that can be written keeps its name, unless
    /// one before it has it; of those that have to be written otherwise, all but the first get a number behind.
    #[must_use]
    pub fn of<S: AsRef<str>>(place: Place, names: impl IntoIterator<Item = S>) -> Self {
        Self::with_endings(place, names.into_iter().map(|name| (name, String::new())))
    }

    /// As [`of`](Self::of), of things whose names of files end in something more, which is as it is.
    #[must_use]
    pub fn with_endings<S: AsRef<str>>(
        place: Place,
        things: impl IntoIterator<Item = (S, String)>,
    ) -> Self {
        let of_thing = |(name, ending): (S, String)| {
            let name = name.as_ref();
            (format!("{name}{ending}"), place.alone(name) + &ending)
        };
        let (own, alone): (Vec<String>, Vec<String>) = things.into_iter().map(of_thing).unzip();
        let written = distinct(place, &own, &alone);
        Self { place, pairs: own.into_iter().zip(written).collect() }
    }

    /// The name of a file or column of that thing.
    #[must_use]
    pub fn name(&self, own: &str) -> String {
        let found = self.pairs.iter().find(|(name, _)| name == own);
        found.map_or_else(|| self.place.alone(own), |(_, written)| written.clone())
    }

    /// The names in the order of the things.
    pub fn iter(&self) -> impl Iterator<Item = &str> {
        self.pairs.iter().map(|(_, written)| written.as_str())
    }

    /// A sentence for each thing that is written otherwise than it is called, letters' cases aside.
    pub fn changed(&self) -> impl Iterator<Item = String> {
        self.pairs.iter().filter_map(|(own, _)| self.told(own))
    }

    /// The same of one thing.
    #[must_use]
    pub fn told(&self, own: &str) -> Option<String> {
        let written = self.name(own);
        let what = if self.place == Place::Column { "column" } else { "file" };
        (own.to_lowercase() != written.to_lowercase())
            .then(|| format!("{own:?} is `{written}` in the name of its {what}"))
    }
}

/// The names that things have alone, with numbers behind those that another one has.
fn distinct(place: Place, own: &[String], alone: &[String]) -> Vec<String> {
    // Nobody is numbered into the name that another one has by itself.
    let wanted: BTreeSet<String> = alone.iter().map(|name| place.key(name)).collect();
    let mut taken = BTreeSet::new();
    let mut written = alone.to_vec();
    let is_kept = |index: &usize| own.get(*index) == alone.get(*index);
    let (first, then): (Vec<usize>, Vec<usize>) = (0..own.len()).partition(is_kept);
    for index in first.into_iter().chain(then) {
        let Some(name) = written.get_mut(index) else { continue };
        if taken.insert(place.key(name)) {
            continue;
        }
        let is_free =
            |it: &String| !wanted.contains(&place.key(it)) && !taken.contains(&place.key(it));
        let numbered = (2_u64..).map(|number| format!("{name}{}{number}", place.joint()));
        *name = numbered.into_iter().find(is_free).unwrap_or_default();
        taken.insert(place.key(name));
    }
    written
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(place: Place, names: &[&str]) -> Vec<String> {
        Names::of(place, names).iter().map(str::to_owned).collect()
    }

    /// Of `PID` and `pid`, `ä` and `ö`, `a/b` and `a.b` one certificate was left, and "wrote" was told twice.
    #[test]
    fn things_of_different_names_have_files_and_columns_of_different_names() {
        let plain = ["PID", "pid", "ä", "ö", "a/b", "a.b", "pid-2"];
        let written = ["pid-3", "pid", "-", "--2", "a-b", "a-b-2", "pid-2"];
        assert_eq!(names(Place::PlainFile, &plain), written);
        let file = ["a b", "a_b", "A_B", "ä", "ö", "a.b"];
        assert_eq!(names(Place::File, &file), ["a_b_3", "a_b", "A_B_2", "ä", "ö", "a_b_4"]);
        let column = ["a,b", "a_b", "PID", "pid"];
        assert_eq!(names(Place::Column, &column), ["a_b_2", "a_b", "PID", "pid"]);
    }

    #[test]
    fn one_that_is_harmless_and_alone_keeps_its_name_and_a_changed_one_is_told() {
        let of = |place, names: &[&str]| Names::of(place, names).changed().collect::<Vec<_>>();
        assert_eq!(names(Place::PlainFile, &["FSPID", "CPID"]), ["fspid", "cpid"]);
        assert_eq!(of(Place::PlainFile, &["FSPID", "CPID"]), [""; 0]);
        assert_eq!(of(Place::Column, &["a,b"]), ["\"a,b\" is `a_b` in the name of its column"]);
        assert_eq!(of(Place::File, &["a", "A"]), ["\"A\" is `A_2` in the name of its file"]);
    }

    #[test]
    fn no_name_of_a_file_is_too_long_or_a_device_and_none_is_that_of_another() {
        let long =
            ["x".repeat(255), "X".repeat(255), "ü".repeat(127), format!("{}y", "x".repeat(255))];
        let short = [
            "PID", "pid", "a b", "a_b", "ä", "ö", "CON", "nul", "com1", "com10", "..", ".", "ı",
            "I",
        ];
        let own: Vec<&str> = short.into_iter().chain(long.iter().map(String::as_str)).collect();
        for place in [Place::File, Place::PlainFile] {
            let written = names(place, &own);
            let mut keys: Vec<String> = written.iter().map(|name| place.key(name)).collect();
            keys.sort_unstable();
            keys.dedup();
            assert_eq!(keys.len(), own.len(), "{written:?}");
            assert!(written.iter().all(|it| it.len() < 130 && !is_device(it)), "{written:?}");
        }
        assert_eq!(names(Place::File, &["CON", "com1", "com10"]), ["CON_", "com1_", "com10"]);
        assert_eq!(names(Place::PlainFile, &["NUL", "console"]), ["nul-", "console"]);
    }
}
