//! Arguments that name files: `-` is standard input or output everywhere, and an unknown ending is refused.

use std::ffi::{OsStr, OsString};
use std::ops::Deref;
use std::path::{Path, PathBuf};

use clap::builder::{
    OsStringValueParser, StringValueParser, TypedValueParser, ValueParser, ValueParserFactory,
};
use fspid_scenario::count::Count;

/// What stands for standard input and output.
pub(crate) const STANDARD: &str = "-";

/// True for the name that stands for standard input or output.
pub(crate) fn is_standard(path: &Path) -> bool {
    path == Path::new(STANDARD)
}

/// A file that is read; `-` is standard input.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct InFile(PathBuf);

/// A file that is read and cannot be standard input: one that is read here and there, or beside a stream.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct NamedFile(PathBuf);

/// A file that is written; `-` is standard output.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct OutFile(PathBuf);

/// A folder, which standard output cannot be.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Folder(PathBuf);

/// A drawing, or a folder for several; `-` is standard output, for one of them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Drawings(PathBuf);

/// The name of something that the program carries, or a file; `-` is standard input.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Source(String);

macro_rules! path {
    ($($name:ident)*) => {$(
        impl Deref for $name {
            type Target = Path;
            fn deref(&self) -> &Path {
                &self.0
            }
        }

        impl AsRef<Path> for $name {
            fn as_ref(&self) -> &Path {
                &self.0
            }
        }
    )*};
}
path!(InFile NamedFile OutFile Folder Drawings);

impl Deref for Source {
    type Target = str;
    fn deref(&self) -> &str {
        &self.0
    }
}

impl ValueParserFactory for InFile {
    type Parser = ValueParser;
    fn value_parser() -> ValueParser {
        let read = |text: OsString| named(text).and_then(readable).map(Self);
        OsStringValueParser::new().try_map(read).into()
    }
}

impl ValueParserFactory for NamedFile {
    type Parser = ValueParser;
    fn value_parser() -> ValueParser {
        OsStringValueParser::new().try_map(Self::named).into()
    }
}

impl ValueParserFactory for Source {
    type Parser = ValueParser;
    fn value_parser() -> ValueParser {
        StringValueParser::new().try_map(|text| named(text).map(Self)).into()
    }
}

impl ValueParserFactory for Folder {
    type Parser = ValueParser;
    fn value_parser() -> ValueParser {
        OsStringValueParser::new().try_map(Self::named).into()
    }
}

impl ValueParserFactory for Drawings {
    type Parser = ValueParser;
    fn value_parser() -> ValueParser {
        OsStringValueParser::new().try_map(Self::named).into()
    }
}

impl NamedFile {
    fn named(text: OsString) -> Result<Self, String> {
        let path: PathBuf = named(text)?;
        match is_standard(&path) {
            true => Err("a file with a name is needed, which standard input is not".to_owned()),
            false => Ok(Self(path)),
        }
    }
}

impl Folder {
    fn named(text: OsString) -> Result<Self, String> {
        let path: PathBuf = named(text)?;
        match is_standard(&path) {
            true => Err("a folder is needed, which standard output is not".to_owned()),
            false => Ok(Self(path)),
        }
    }
}

impl Drawings {
    const ENDING: &str = "svg";

    fn named(text: OsString) -> Result<Self, String> {
        let path: PathBuf = named(text)?;
        if is_standard(&path) || path.is_dir() || has_ending(&path, &[Self::ENDING]) {
            return Ok(Self(path));
        }
        match path.extension() {
            None => Ok(Self(path)),
            Some(_) => {
                Err("unknown ending; known is .svg, and a name without an ending is a folder"
                    .to_owned())
            }
        }
    }

    /// True for one file, and not a folder.
    pub(crate) fn is_file(&self) -> bool {
        !self.0.is_dir() && has_ending(&self.0, &[Self::ENDING])
    }
}

/// What is named; nothing is, where a shell's variable is not set, and would be taken for the folder that one is in.
fn named<T: AsRef<OsStr>, P: From<T>>(text: T) -> Result<P, String> {
    match text.as_ref().is_empty() {
        true => Err("a name is needed; is a variable of the shell not set?".to_owned()),
        false => Ok(text.into()),
    }
}

/// Names of standard input on systems that have one.
const DEVICES: [&str; 3] = ["/dev/stdin", "/dev/fd/0", "/proc/self/fd/0"];

/// A file that is read; standard input by its name has no end that is known, unless a file was put there.
fn readable(path: PathBuf) -> Result<PathBuf, String> {
    let is_device = DEVICES.iter().any(|device| path.as_os_str() == *device);
    match is_device && !path.is_file() {
        true => Err(format!("standard input is `{STANDARD}`")),
        false => Ok(path),
    }
}

/// A file that is written, with one of these endings.
pub(crate) fn written(endings: &'static [&'static str]) -> ValueParser {
    let ended = move |text: OsString| {
        let path: PathBuf = named(text)?;
        // A device or a pipe has no ending.
        let is_special = std::fs::metadata(&path).is_ok_and(|data| !data.is_file());
        if is_standard(&path) || is_special || has_ending(&path, endings) {
            return Ok(OutFile(path));
        }
        let what = match path.extension() {
            Some(_) => "unknown ending",
            None => "no ending",
        };
        let known: Vec<String> = endings.iter().map(|ending| format!(".{ending}")).collect();
        let known = match known.as_slice() {
            [one] => format!("known is {one}"),
            several => format!("known are {}", several.join(", ")),
        };
        Err(format!("{what}; {known}, and `-` for standard output"))
    };
    OsStringValueParser::new().try_map(ended).into()
}

/// A whole number within the limits of the table.
pub(crate) fn count<N>(count: &'static Count) -> ValueParser
where
    N: TryFrom<u64> + Clone + Send + Sync + 'static,
{
    let counted = move |text: String| {
        let number = text.parse().ok().filter(|number| count.allows(*number));
        number.and_then(|number| N::try_from(number).ok()).ok_or_else(|| count.allowed())
    };
    StringValueParser::new().try_map(counted).into()
}

/// A probability that may be required: above 0, up to 1.
pub(crate) fn positive_share(text: &str) -> Result<f64, String> {
    let share = text.parse().ok().filter(|share: &f64| *share > 0.0 && *share <= 1.0);
    share.ok_or_else(|| "allowed is a number above 0, up to 1".to_owned())
}

fn has_ending(path: &Path, endings: &[&str]) -> bool {
    let ending = path.extension().and_then(|ending| ending.to_str());
    ending.is_some_and(|it| endings.iter().any(|known| it.eq_ignore_ascii_case(known)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use fspid_scenario::count::SEEDS;

    #[test]
    fn a_drawing_in_an_unknown_format_is_refused_and_not_taken_for_a_folder() {
        let named = |text: &str| Drawings::named(text.into());
        assert!(named("tipper.png").is_err_and(|told| told.contains("known is .svg")));
        assert!(named("a.SVG").is_ok_and(|it| it.is_file()));
        assert!(named("figures").is_ok_and(|it| !it.is_file()));
        assert!(named("-").is_ok_and(|it| is_standard(&it)));
    }

    #[test]
    fn a_count_says_its_least_and_most() {
        let parser = count::<u64>(&SEEDS);
        let command = clap::Command::new("it").arg(clap::Arg::new("n").value_parser(parser));
        let told = |text: &str| {
            let parsed = command.clone().no_binary_name(true).try_get_matches_from([text]);
            parsed.err().map(|error| error.to_string()).unwrap_or_default()
        };
        assert_eq!(told("1000"), "");
        for wrong in ["0", "1001", "x", "1.5"] {
            assert!(told(wrong).contains("a whole number from 1 to 1000"), "{}", told(wrong));
        }
    }

    /// `--out "$NOT_SET"` wrote over what was in the folder that one is in.
    #[test]
    fn nothing_is_no_name() {
        let command = clap::Command::new("it").no_binary_name(true).args([
            clap::Arg::new("in").long("in").value_parser(clap::value_parser!(InFile)),
            clap::Arg::new("named").long("named").value_parser(clap::value_parser!(NamedFile)),
            clap::Arg::new("out").long("out").value_parser(written(&["csv"])),
            clap::Arg::new("folder").long("folder").value_parser(clap::value_parser!(Folder)),
            clap::Arg::new("drawings").long("drawings").value_parser(clap::value_parser!(Drawings)),
            clap::Arg::new("source").long("source").value_parser(clap::value_parser!(Source)),
        ]);
        for option in ["--in", "--named", "--out", "--folder", "--drawings", "--source"] {
            let parsed = command.clone().try_get_matches_from([option, ""]);
            let told = parsed.err().map(|error| error.to_string()).unwrap_or_default();
            assert!(told.contains("a name is needed"), "{option}: {told}");
            assert!(
                command.clone().try_get_matches_from([option, "a.csv"]).is_ok()
                    || option == "--drawings"
            );
        }
    }

    #[test]
    fn a_folder_is_not_standard_output() {
        assert!(Folder::named("-".into()).is_err());
        assert!(Folder::named("out".into()).is_ok());
    }
}
