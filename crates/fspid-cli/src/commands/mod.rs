//! The commands, one file each.

pub(crate) mod adaptation;
pub(crate) mod aircraft;
pub(crate) mod analyse;
pub(crate) mod audit;
pub(crate) mod bench;
pub(crate) mod campaign;
pub(crate) mod certify;
pub(crate) mod check;
pub(crate) mod cluster;
pub(crate) mod completions;
pub(crate) mod contest;
pub(crate) mod convert;
mod drawings;
pub(crate) mod drive;
pub(crate) mod explain;
pub(crate) mod export;
pub(crate) mod external_controller;
pub(crate) mod fly;
pub(crate) mod infer;
pub(crate) mod init;
pub(crate) mod interrupt;
pub(crate) mod learn;
pub(crate) mod limit;
pub(crate) mod manual;
pub(crate) mod memory;
mod progress;
pub(crate) mod reproduce;
pub(crate) mod schema;
pub(crate) mod serve;
pub(crate) mod show;
pub(crate) mod simulate;
pub(crate) mod surface;
pub(crate) mod tune;
pub(crate) mod verify;

use crate::argument::Source;
use crate::exit::{Failure, note, print};
use clap::{Args, ValueEnum};
use fspid_scenario::fuzzy_system;
use fspid_scenario::fuzzy_system::{Dialect, Options, System};
pub(crate) use fspid_study::json::answer_text as json_text;

/// How a fuzzy system answers, where its file shall not decide.
#[derive(Debug, Args)]
pub(crate) struct Loading {
    /// Half range of a rule table's inputs and outputs (the paper uses 5 and 40).
    #[arg(long, allow_negative_numbers = true)]
    pub(crate) range: Option<f64>,
    /// How integrals are computed: `exact`, `endpoints:N` (MATLAB: 101), `midpoint:N`,
    /// `trapezoid:N`, `left-end:N` or `vertices:N` (scikit-fuzzy); by default as the file's own tool does.
    #[arg(long, value_name = "RULE")]
    pub(crate) defuzzifier: Option<String>,
    /// What to do with inputs beyond their range: `clamp`, `evaluate` or `error`.
    #[arg(long, value_name = "POLICY")]
    pub(crate) out_of_range: Option<String>,
    /// The tool that an .fcl file was written for, if it is not to be found out.
    #[arg(long, value_enum, value_name = "TOOL")]
    pub(crate) dialect: Option<Tool>,
    /// The function block of an .fcl file, if there are several.
    #[arg(long, value_name = "NAME")]
    pub(crate) block: Option<String>,
    /// The controller of a scenario file whose supervisor is meant, if several have one.
    #[arg(long, value_name = "NAME")]
    pub(crate) controller: Option<String>,
}

/// Which fuzzy system is asked, the same for every command that asks one.
#[derive(Debug, Args)]
pub(crate) struct Which {
    /// A file (.toml, .fis, .t2fis, .fcl, .fll, .xml), a scenario for its supervisor, a rule table, or `printed`, `mirrored` or
    /// `sugeno-grid`; rule tables need --range. The table `printed` if left out.
    pub(crate) system: Option<Source>,
    /// The rule table in place of SYSTEM: `printed`, `mirrored`, or a file.
    #[arg(long, conflicts_with = "system")]
    pub(crate) table: Option<Source>,
    #[command(flatten)]
    pub(crate) loading: Loading,
}

impl Which {
    /// The name of the system.
    pub(crate) fn name(&self) -> &str {
        let named = self.system.as_deref().or(self.table.as_deref());
        named.unwrap_or("printed")
    }

    /// The system; what had to be assumed is told as warnings.
    pub(crate) fn load(&self) -> Result<System, Failure> {
        self.loading.load(self.name())
    }
}

/// The inputs of a question, spelled alike everywhere.
#[derive(Debug, Args)]
pub(crate) struct Inputs {
    /// The value of an input; once for each input.
    #[arg(long, alias = "fix", value_name = "NAME=VALUE", allow_hyphen_values = true)]
    pub(crate) input: Vec<String>,
    /// The error, in the units of a supervisor: short for `--input error=…`.
    #[arg(long, allow_negative_numbers = true)]
    pub(crate) error: Option<f64>,
    /// The change of the error, in the units of a supervisor: short for `--input change=…`.
    #[arg(long, allow_negative_numbers = true)]
    pub(crate) change: Option<f64>,
}

impl Inputs {
    /// All of them as `name=value`.
    pub(crate) fn texts(&self) -> Vec<String> {
        let short = [("error", self.error), ("change", self.change)];
        let short =
            short.into_iter().filter_map(|(name, value)| Some(format!("{name}={:?}", value?)));
        self.input.iter().cloned().chain(short).collect()
    }
}

/// A tool with a dialect of FCL.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Tool {
    /// IEC 61131-7, the standard.
    Iec,
    /// fuzzylite.
    Fuzzylite,
    /// jFuzzyLogic.
    Jfuzzylogic,
}

impl From<Tool> for Dialect {
    fn from(tool: Tool) -> Self {
        match tool {
            Tool::Iec => Self::Iec,
            Tool::Fuzzylite => Self::Fuzzylite,
            Tool::Jfuzzylogic => Self::JFuzzyLogic,
        }
    }
}

impl Loading {
    /// The options as the study takes them.
    pub(crate) fn options(&self) -> Options<'_> {
        Options {
            range: self.range,
            sampling: self.defuzzifier.as_deref(),
            out_of_range: self.out_of_range.as_deref(),
            dialect: self.dialect.map(Dialect::from),
            block: self.block.as_deref(),
            controller: self.controller.as_deref(),
        }
    }

    /// The system of that name; what had to be assumed is told as warnings.
    pub(crate) fn load(&self, name: &str) -> Result<System, Failure> {
        Self::load_with(name, self.options())
    }

    /// Two systems, of which each takes the options that belong to its kind: --range what is shipped,
    /// --controller what is a scenario.
    pub(crate) fn load_both(&self, names: [&str; 2]) -> Result<[System; 2], Failure> {
        let options = self.options();
        let is_any = |has: fn(&str) -> bool| names.iter().any(|name| has(name));
        let load = |name: &str| {
            let (shipped, scenario) =
                (fuzzy_system::needs_range(name), fuzzy_system::is_scenario(name));
            // Where neither of the two has a use for an option, the first one refuses it.
            let mine = Options {
                range: options.range.filter(|_| shipped || !is_any(fuzzy_system::needs_range)),
                controller: options
                    .controller
                    .filter(|_| scenario || !is_any(fuzzy_system::is_scenario)),
                ..options
            };
            Self::load_with(name, mine)
        };
        Ok([load(names[0])?, load(names[1])?])
    }

    fn load_with(name: &str, options: Options<'_>) -> Result<System, Failure> {
        let loaded = fuzzy_system::load(name, options).map_err(Failure::input)?;
        for found in &loaded.notes {
            note(format_args!("warning: {found}"));
        }
        Ok(loaded.system)
    }
}

/// How an answer is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Format {
    /// For people.
    Text,
    /// For programs.
    Json,
}

impl Format {
    /// Prints the form that was asked for.
    pub(crate) fn print(
        self,
        text: impl FnOnce() -> String,
        json: impl FnOnce() -> serde_json::Value,
    ) -> Result<(), Failure> {
        match self {
            Self::Text => print(&text()),
            Self::Json => print(&json_text(&json())),
        }
    }
}
