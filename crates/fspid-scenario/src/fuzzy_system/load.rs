//! A system by the name of its file or of a shipped rule table.

use std::fmt;
use std::path::Path;

use fspid_core::fuzzy::OutOfRange;
use fspid_formats::fcl::{Dialect, ReadOptions};
use fspid_formats::{fcl, fis, fll, fml};
use fspid_fuzzy::system::{Parts, Sampling, System};
use fspid_fuzzy::{LABEL_COUNT, NumberTable, Supervisor};

use super::{scenario, toml_file};
use crate::file::files::{STANDARD_INPUT, read_regular};
use crate::file::{Problems, rule_table_names};
use crate::supervisor::{Question, Refused};

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

/// True for a file that describes a fuzzy system: by its ending, and of a `.toml` file by its `kind`.
#[must_use]
pub fn is_system(path: &Path) -> bool {
    match Format::of(path) {
        None => false,
        Some(Format::Toml) => text(path).is_ok_and(|text| toml_file::is_of_this_kind(&text)),
        Some(_) => true,
    }
}

/// Name of the supervisor whose rules conclude numbers, all of them 0 so far: what learning begins from.
pub const NUMBER_GRID: &str = "sugeno-grid";

/// True for a name that stands for a system of any half range.
#[must_use]
pub fn needs_range(name: &str) -> bool {
    name == NUMBER_GRID || rule_table_names().contains(&name)
}

/// True for a `.toml` file with a rule table alone.
#[must_use]
pub fn is_rule_table_file(path: &Path) -> bool {
    Format::of(path) == Some(Format::Toml) && text(path).is_ok_and(|text| is_rule_table(&text))
}

/// True for a text with a rule table alone: three grids, and neither a fuzzy system nor a scenario.
fn is_rule_table(text: &str) -> bool {
    let has = |key: &str| {
        let lines = text.lines().map(str::trim_start);
        let mut values = lines.filter_map(|line| line.strip_prefix(key));
        values.any(|rest| rest.trim_start().starts_with('='))
    };
    let has_grids = ["delta_kp", "delta_ki", "delta_kd"].into_iter().all(has);
    has_grids && !toml_file::is_of_this_kind(text) && !scenario::is_one(text)
}

/// What a text is that is no scenario, in words; `None` for one that may be a scenario.
pub(crate) fn other_kind(text: &str) -> Option<&'static str> {
    let begins_block = |line: &str| line.trim_start().starts_with("FUNCTION_BLOCK");
    match Format::of_text(text) {
        Format::Toml if toml_file::is_of_this_kind(text) => Some("a fuzzy system"),
        Format::Toml if is_rule_table(text) => Some("a rule table"),
        Format::Toml => None,
        // The words may stand in a text of a scenario.
        Format::Fcl if !text.lines().any(begins_block) => None,
        Format::Fis | Format::T2fis | Format::Fcl | Format::Fll | Format::Fml => {
            Some("a fuzzy system")
        }
    }
}

/// True for a file with a scenario.
#[must_use]
pub fn is_scenario(name: &str) -> bool {
    let path = Path::new(name);
    Format::of(path) == Some(Format::Toml) && text(path).is_ok_and(|text| scenario::is_one(&text))
}

/// The system in a file, or that of a shipped rule table with a half range. A scenario file stands for the
/// supervisor of its self-tuning controller.
///
/// # Errors
/// [`LoadError`] with everything that is wrong.
pub fn load(name: &str, options: Options<'_>) -> Result<Loaded, LoadError> {
    if needs_range(name) {
        return shipped(name, options);
    }
    let path = Path::new(name);
    let format = Format::of(path).ok_or_else(|| LoadError::UnknownFormat { name: name.into() })?;
    if format == Format::Toml && text(path).is_ok_and(|text| is_rule_table(&text)) {
        return shipped(name, options);
    }
    let mut misplaced = Vec::new();
    if options.range.is_some() {
        misplaced.push("--range goes with a shipped rule table; a file says its own ranges".into());
    }
    if format != Format::Fcl && (options.dialect.is_some() || options.block.is_some()) {
        misplaced.push("--dialect and --block go with an .fcl file".into());
    }
    if !misplaced.is_empty() {
        return Err(LoadError::Refused(Refused::all(misplaced)));
    }
    let text = text(path)?;
    let loaded = match format == Format::Toml && scenario::is_one(&text) {
        true => scenario::read(path, &text, options.controller)?,
        false if options.controller.is_some() => return Err(no_scenario()),
        false => read(name, &text, format, options)?,
    };
    Ok(Loaded { system: changed(loaded.system, options)?, notes: loaded.notes })
}

fn text(path: &Path) -> Result<String, LoadError> {
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
            let system = toml_file::parse(text, name).map_err(LoadError::Problems)?;
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

fn no_scenario() -> LoadError {
    LoadError::Refused(Refused::one("--controller goes with a scenario file"))
}

fn shipped(name: &str, options: Options<'_>) -> Result<Loaded, LoadError> {
    if options.controller.is_some() {
        return Err(no_scenario());
    }
    let Some(range) = options.range else {
        let missing = format!("{name} needs --range, the half range of its inputs and outputs");
        return Err(LoadError::Refused(Refused::one(missing)));
    };
    let supervisor = if name == NUMBER_GRID {
        let zeros = [[[0.0; LABEL_COUNT]; LABEL_COUNT]; 3];
        NumberTable::new(zeros)
            // Its outermost sets are level: nothing is to be clamped, which not every format could say.
            .and_then(|table| Supervisor::of_numbers(&table, range, OutOfRange::Evaluate))
            .map_err(|error| LoadError::Refused(Refused::one(error.to_string())))?
    } else {
        let question = Question {
            table: name,
            range,
            defuzzifier: "exact",
            out_of_range: options.out_of_range.unwrap_or(OutOfRange::Clamp.name()),
        };
        question.supervisor().map_err(LoadError::Refused)?
    };
    let mut parts = Parts::from(&supervisor);
    parts.name = name.to_owned();
    let system = built(parts)?;
    Ok(Loaded { system: changed(system, options)?, notes: Vec::new() })
}

/// The same system with the options in place of what its file says.
fn changed(system: System, options: Options<'_>) -> Result<System, LoadError> {
    if options.sampling.is_none() && options.out_of_range.is_none() {
        return Ok(system);
    }
    let mut parts = system.parts().clone();
    let mut problems = Vec::new();
    if let Some(text) = options.sampling {
        match text.parse::<Sampling>() {
            Ok(sampling) => parts.outputs.iter_mut().for_each(|output| {
                output.defuzzifier = output.defuzzifier.with_sampling(sampling);
            }),
            Err(_) => {
                problems.push(format!("--defuzzifier {text}: known are {}", Sampling::NAMES));
            }
        }
    }
    if let Some(text) = options.out_of_range {
        match OutOfRange::ALL.into_iter().find(|policy| policy.name() == text) {
            Some(policy) => {
                parts.inputs.iter_mut().for_each(|input| input.out_of_range = policy);
            }
            None => {
                let known = OutOfRange::ALL.map(OutOfRange::name).join(", ");
                problems.push(format!("--out-of-range {text}: known are {known}"));
            }
        }
    }
    if problems.is_empty() { built(parts) } else { Err(LoadError::Refused(Refused::all(problems))) }
}

pub(super) fn built(parts: Parts) -> Result<System, LoadError> {
    System::new(parts).map_err(|errors| {
        LoadError::Refused(Refused::all(errors.iter().map(ToString::to_string).collect()))
    })
}
