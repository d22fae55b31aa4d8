//! Texts of fuzzy systems: which format they are in, and what they say.

mod markup;
mod numbers;
mod toml_file;

use std::fmt;
use std::path::Path;

use fspid_diagnostics::{Problems, Report};
use fspid_formats::fcl::{Dialect, ReadOptions};
use fspid_formats::{fcl, fis, fll, fml};
use fspid_fuzzy::system::{Parts, System};

use crate::carried::rule_table_names;
use crate::keyed::document::{Item, Value, read as read_document};
use crate::refused::Refused;
use crate::regular_file::{STANDARD_INPUT, read_regular};
pub use numbers::{Numbers, numbers_of};
pub(crate) use toml_file::is_of_this_kind;
pub use toml_file::{parse, schema, write};

/// How a system is to answer, where its file shall not decide.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Options<'a> {
    /// Half range of a shipped rule table.
    pub range: Option<f64>,
    /// How integrals are computed.
    pub sampling: Option<&'a str>,
    /// What happens to inputs outside of their ranges.
    pub out_of_range: Option<&'a str>,
    /// The dialect of an `.fcl` file, if it is not to be found out.
    pub dialect: Option<Dialect>,
    /// The function block of an `.fcl` file, if there are several.
    pub block: Option<&'a str>,
    /// The controller of a scenario file whose supervisor is meant, if it has several.
    pub controller: Option<&'a str>,
}

/// A system and what is worth knowing about how it was read.
#[derive(Clone, Debug)]
pub struct Loaded {
    /// The system.
    pub system: System,
    /// What was assumed and repaired, each with its place.
    pub notes: Vec<String>,
}

/// Why there is no system.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum LoadError {
    /// No file of a known format, and no shipped rule table.
    UnknownFormat {
        /// What was given.
        name: String,
    },
    /// The file could not be read.
    Unreadable {
        /// Its path.
        path: String,
        /// The reason.
        reason: String,
    },
    /// The file is wrong.
    Problems(Problems),
    /// An option is wrong.
    Refused(Refused),
}

impl fmt::Display for LoadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::UnknownFormat { name } => {
                let tables = rule_table_names().join(", ");
                write!(
                    f,
                    "{name}: no fuzzy system; known are files that end in {}, the rule tables {tables}, and {NUMBER_GRID}",
                    Format::endings_in_words()
                )
            }
            Self::Unreadable { path, reason } => write!(f, "{path}: cannot be read: {reason}"),
            Self::Problems(problems) => problems.fmt(f),
            Self::Refused(refused) => refused.fmt(f),
        }
    }
}

impl std::error::Error for LoadError {}

/// The formats of systems, by the ending of the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Our own.
    Toml,
    /// MATLAB.
    Fis,
    /// IEC 61131-7.
    Fcl,
    /// fuzzylite.
    Fll,
    /// IEEE 1855, the Fuzzy Markup Language.
    Fml,
    /// Taskin's interval type-2 toolbox: MATLAB's format with pairs of membership functions.
    T2fis,
}

impl Format {
    /// All of them, in the order in which they are told.
    pub const ALL: [Self; 6] =
        [Self::Toml, Self::Fis, Self::T2fis, Self::Fcl, Self::Fll, Self::Fml];

    /// The endings of files of all formats.
    pub const ENDINGS: [&'static str; 6] = ["toml", "fis", "t2fis", "fcl", "fll", "xml"];

    /// The format of files with an ending.
    #[must_use]
    pub fn of_ending(ending: &str) -> Option<Self> {
        let place = Self::ENDINGS.iter().position(|known| ending.eq_ignore_ascii_case(known))?;
        Self::ALL.get(place).copied()
    }

    /// The endings of all formats in words.
    pub fn endings_in_words() -> String {
        let [others @ .., last] = Self::ENDINGS.map(|ending| format!(".{ending}"));
        format!("{} or {last}", others.join(", "))
    }

    /// The format of a file, by its ending; that of standard input by what it begins with.
    #[must_use]
    pub fn of(path: &Path) -> Option<Self> {
        if path == Path::new(STANDARD_INPUT) {
            return text(path).ok().map(|text| Self::of_text(&text));
        }
        Self::of_ending(path.extension()?.to_str()?)
    }

    /// The format of a text that has no ending, by what it begins with. The toolbox of `.t2fis` writes MATLAB's words.
    fn of_text(text: &str) -> Self {
        let text = text.trim_start_matches('\u{feff}').trim_start();
        let has_block = || text.to_ascii_uppercase().contains("FUNCTION_BLOCK");
        match text {
            fis if fis.starts_with("[System]") => Self::Fis,
            fll if fll.starts_with("Engine:") => Self::Fll,
            // Neither of the others can begin so.
            fml if fml.starts_with('<') => Self::Fml,
            _ if has_block() => Self::Fcl,
            _ => Self::Toml,
        }
    }
}

/// Name of the supervisor whose rules conclude numbers, all of them 0 so far: what learning begins from.
pub const NUMBER_GRID: &str = "sugeno-grid";

/// True for a text with a rule table alone: three grids, and neither a fuzzy system nor a scenario.
pub(crate) fn is_rule_table(text: &str) -> bool {
    let has = |key: &str| {
        let lines = text.lines().map(str::trim_start);
        let mut values = lines.filter_map(|line| line.strip_prefix(key));
        values.any(|rest| rest.trim_start().starts_with('='))
    };
    let has_grids = ["delta_kp", "delta_ki", "delta_kd"].into_iter().all(has);
    has_grids && !is_of_this_kind(text) && !is_scenario_text(text)
}

/// What a text is that is no scenario, in words; `None` for one that may be a scenario.
pub(crate) fn other_kind(text: &str) -> Option<&'static str> {
    let begins_block = |line: &str| line.trim_start().starts_with("FUNCTION_BLOCK");
    match Format::of_text(text) {
        Format::Toml if is_of_this_kind(text) => Some("a fuzzy system"),
        Format::Toml if is_rule_table(text) => Some("a rule table"),
        Format::Toml => None,
        // The words may stand in a text of a scenario.
        Format::Fcl if !text.lines().any(begins_block) => None,
        Format::Fml if !markup::is_fml(text) => Some(markup::called(text)),
        Format::Fis | Format::T2fis | Format::Fcl | Format::Fll | Format::Fml => {
            Some("a fuzzy system")
        }
    }
}

/// True for a text with controllers, however they are written.
///
/// A text that is no TOML is one if a line of it looks like their heading, so that what is wrong with it is told
/// as of a scenario.
pub(crate) fn is_scenario_text(text: &str) -> bool {
    if is_of_this_kind(text) {
        return false;
    }
    let is_heading = |line: &str| {
        let heading: String = line.chars().filter(|c| !c.is_whitespace()).collect();
        heading.starts_with("[[controller]]")
    };
    match read_document(&mut Report::default(), None, text) {
        Some(Item { value: Value::Table(members), .. }) => {
            members.iter().any(|member| member.name == "controller")
        }
        _ => text.lines().any(is_heading),
    }
}

pub(crate) fn text(path: &Path) -> Result<String, LoadError> {
    let unreadable = |reason| LoadError::Unreadable { path: path.display().to_string(), reason };
    let bytes = read_regular(path).map_err(unreadable)?;
    String::from_utf8(bytes).map_err(|error| {
        let at = error.utf8_error().valid_up_to();
        unreadable(format!("not UTF-8 from byte {at} on"))
    })
}

/// The system of a text in a format; `name` is that of the file in messages.
///
/// # Errors
/// [`LoadError::Problems`].
pub fn read(
    name: &str,
    text: &str,
    format: Format,
    options: Options<'_>,
) -> Result<Loaded, LoadError> {
    match format {
        Format::Toml => {
            let system = parse(text, name).map_err(LoadError::Problems)?;
            Ok(Loaded { system, notes: Vec::new() })
        }
        Format::Fis | Format::T2fis => of_tool(name, fis::read(text)),
        Format::Fml => of_tool(name, fml::read(text)),
        Format::Fll => of_tool(name, fll::read(text)),
        Format::Fcl => {
            let options = ReadOptions { dialect: options.dialect, block: options.block };
            of_tool(name, fcl::read_with(text, options))
        }
    }
}

/// The system that a reader of another tool's format found.
fn of_tool(
    name: &str,
    reading: Result<fspid_formats::Reading, Problems>,
) -> Result<Loaded, LoadError> {
    let reading = reading.map_err(|problems| LoadError::Problems(problems.in_file(name)))?;
    let note = |note: fspid_formats::Note| match note.place {
        Some(place) => format!("{name}:{place}: {}", note.message),
        None => format!("{name}: {}", note.message),
    };
    let notes = reading.notes.into_iter().map(note).collect();
    let system = System::new(reading.parts).map_err(|errors| {
        let told = errors.iter().map(|error| format!("{name}: {error}"));
        LoadError::Refused(Refused::all(told.collect()))
    })?;
    Ok(Loaded { system, notes })
}

/// The system of its parts.
pub(crate) fn built(parts: Parts) -> Result<System, LoadError> {
    System::new(parts).map_err(|errors| {
        LoadError::Refused(Refused::all(errors.iter().map(ToString::to_string).collect()))
    })
}
