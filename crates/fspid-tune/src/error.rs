//! What can be wrong with a tuning.

use std::io;
use std::path::Path;

use fspid_campaign::CampaignError;
use fspid_campaign::table::TableError;
use fspid_scenario::count::CountError;
use fspid_scenario::file::{LoadError, Problems};
use fspid_study::output::OutputError;
use serde_json::Value;
use thiserror::Error;

use crate::wrong_cases::problems_of_cases;

/// A case of a tuning or a contest that makes the scenario wrong.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("case \"{case}\" makes the scenario wrong:\n{problems}")]
pub struct WrongCase {
    /// Name of the case.
    pub case: String,
    /// What is wrong then.
    pub problems: LoadError,
}

impl WrongCase {
    /// Its name, and what is wrong.
    pub(crate) fn told(&self) -> (&str, &LoadError) {
        (&self.case, &self.problems)
    }
}

/// Everything that is wrong with a contest, one below the other.
fn indented(problems: &[String], wrong_cases: &[WrongCase]) -> String {
    let told = problems.iter().cloned().chain(wrong_cases.iter().map(ToString::to_string));
    let told = told.map(|it| format!("    {}", it.trim_end().replace('\n', "\n    ")));
    told.collect::<Vec<_>>().join("\n")
}

/// How a scenario says what a good flight is.
const OBJECTIVE: &str = "add it, for instance:\n\n        [[tuning.objective]]\n        measure = \"iae_deg_s\"\n\n        [[tuning.objective]]\n        measure = \"elevator_travel_deg\"\n        weight = 0.1\n";
/// How a number is marked free.
const MARK: &str = "mark some, for instance:\n\n        kp = { tune = [0.1, 10.0], scale = \"log\", start = 1.0 }\n\n    the search begins at `start`, which has to fly in every case; a whole scenario: fspid init --template tuning";

/// What is told beside a missing objective where nothing is marked free either.
fn marks_as_well(is_marked: bool) -> String {
    if is_marked {
        return String::new();
    }
    format!("\n    and no number is marked free\n    {MARK}")
}

/// Why a tuning or a contest could not begin or go on.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum TuneError {
    /// The scenario is wrong.
    #[error("{0}")]
    Scenario(#[from] Problems),
    /// The scenario cannot be read.
    #[error("{0}")]
    Unreadable(#[from] LoadError),
    /// A case makes the scenario wrong.
    #[error("{0}")]
    Case(Box<WrongCase>),
    /// The scenario says nothing of tuning.
    #[error(
        "{path}: it does not say what a good flight is\n    {}{}",
        OBJECTIVE,
        marks_as_well(*is_marked)
    )]
    NoObjective {
        /// The scenario.
        path: String,
        /// Whether a number is marked free.
        is_marked: bool,
    },
    /// Nothing is marked free.
    #[error("{path}: no number of controller \"{controller}\" is marked free\n    {}", MARK)]
    NothingFree {
        /// The scenario.
        path: String,
        /// The controller.
        controller: String,
    },
    /// Several controllers have free numbers.
    #[error(
        "several controllers have free numbers: {}; name one with --controller or `tuning.controller`",
        fspid_diagnostics::listed(names)
    )]
    WhichController {
        /// Their names.
        names: Vec<String>,
    },
    /// Something in a tuning that has no slope, for an optimiser that goes by slopes.
    #[error(
        "`{optimiser}` goes downhill by slopes, and there is none with {what}; another optimiser, such as cma-es, needs none"
    )]
    NoSlope {
        /// Name of the optimiser.
        optimiser: &'static str,
        /// What has none.
        what: String,
    },
    /// A name that is not known.
    #[error("there is no {what} `{found}`{known}")]
    Unknown {
        /// What it is.
        what: &'static str,
        /// What was given.
        found: String,
        /// What was probably meant, and what is known.
        known: String,
    },
    /// A word or number that is not allowed.
    #[error("{what} is {found}; allowed is {allowed}")]
    Value {
        /// What it is.
        what: &'static str,
        /// What was given.
        found: String,
        /// What is allowed.
        allowed: String,
    },
    /// A count beyond its limits.
    #[error("{0}")]
    Count(#[from] CountError),
    /// The start does not fly, or has no value of the objective.
    #[error(
        "the start has no cost, so that a search from it would be blind:\n{}\n    give the marks a `start` that flies in every case, or begin anywhere with --anywhere",
        reasons.join("\n")
    )]
    Start {
        /// Why, flight by flight.
        reasons: Vec<String>,
    },
    /// Draws or threads.
    #[error("{0}")]
    Campaign(#[from] CampaignError),
    /// A saved state that is not of this search, or that cannot be read.
    #[error("{path}: {reason}; move it away to begin anew")]
    State {
        /// Path of the state.
        path: String,
        /// Why it cannot be used.
        reason: String,
    },
    /// Another process searches for the same design.
    #[error(
        "{path}: another process is tuning there; wait until it has ended, or name another file with --out"
    )]
    Busy {
        /// Path of its state.
        path: String,
    },
    /// A file that this program wrote for itself, and that is not what was written.
    #[error("{path}: {reason}; move it away to begin anew")]
    Changed {
        /// Path of the file.
        path: String,
        /// How that is known.
        reason: String,
    },
    /// The history cannot be made.
    #[error("{0}")]
    History(#[from] TableError),
    /// A file cannot be written.
    #[error("{0}")]
    Output(#[from] OutputError),
    /// A rule that gives no gains.
    #[error("{0}")]
    Rule(#[from] crate::rule::RuleError),
    /// A contest that cannot be held.
    #[error("{path}: this is no fair contest:\n{}", indented(problems, wrong_cases))]
    Contest {
        /// The scenario.
        path: String,
        /// What is wrong with its rules and controllers.
        problems: Vec<String>,
        /// Cases that make the scenario wrong.
        wrong_cases: Vec<WrongCase>,
    },
    /// A controller of a contest cannot be tuned.
    #[error("controller \"{controller}\": {reason}")]
    Entrant {
        /// Its name.
        controller: String,
        /// Why.
        reason: Box<TuneError>,
    },
    /// A contest that was asked to stop; it goes on from there.
    #[error("stopped; the same command goes on from there")]
    Stopped,
    /// A search that was asked to stop, and has no place to keep its state.
    #[error(
        "interrupted; the search begins anew, because a scenario from standard input has no place beside it: add --out design.toml, and it goes on"
    )]
    NotKept,
    /// Others who should have flown, and could not.
    #[error("{reason}")]
    Engine {
        /// Why.
        reason: String,
    },
    /// Nothing that the search tried can be flown.
    #[error("none of {tried} candidates could be flown in every case; the best one: {reason}")]
    NothingFlies {
        /// How many there were.
        tried: usize,
        /// What was wrong with the best.
        reason: String,
    },
}

impl TuneError {
    /// What is wrong with the scenario, as JSON: as [`Problems::to_json`] has it, with the name of a case as `case` where a
    /// case makes it wrong; nothing where something else is.
    #[must_use]
    pub fn problems(&self) -> Option<Value> {
        match self {
            Self::Scenario(problems) | Self::Unreadable(LoadError::Problems(problems)) => {
                Some(problems.to_json())
            }
            Self::Case(wrong) => problems_of_cases([wrong.told()]),
            Self::Contest { wrong_cases, .. } => {
                problems_of_cases(wrong_cases.iter().map(WrongCase::told))
            }
            _ => None,
        }
    }

    /// True where something could not be written; else the input is what is wrong.
    #[must_use]
    pub fn is_of_output(&self) -> bool {
        match self {
            Self::Output(error) => !error.is_clash(),
            Self::History(_) => true,
            Self::Campaign(error) => error.is_of_output(),
            _ => false,
        }
    }

    /// The same, with the file where the system did not let its table be written.
    pub(crate) fn of_writing(self, path: &Path) -> Self {
        let Self::History(error) = &self else { return self };
        let Some(found) = error.of_system() else { return self };
        let again = || io::Error::from(found.kind());
        let reason = found.raw_os_error().map_or_else(again, io::Error::from_raw_os_error);
        Self::Output(OutputError { path: path.to_owned(), reason })
    }
}
