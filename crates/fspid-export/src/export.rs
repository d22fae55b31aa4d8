//! The files of an export.

use std::panic::resume_unwind;
use std::thread;

use fspid_core::fuzzy::{FuzzyError, RANGE_LIMITS_F32, UNITS};
use fspid_core::{ConfigError, Controller};
use fspid_numeric::Real;

use crate::compose::{Angles, Refusal, outline, precision_of, program};
use crate::evidence::{self, Subject};
use crate::file::File;
pub(crate) use crate::names::identifier;
use crate::names::prefix;
use crate::program::Precision;
use crate::targets::{Flown, Source, Target, Written};
use crate::vectors::{SEED, eventful, vectors};
use crate::write::{self, Heading};

/// What is asked for.
#[derive(Clone, Debug)]
pub struct Request<'a> {
    /// The controller's name in its scenario.
    pub name: &'a str,
    /// In which language.
    pub target: Target,
    /// With which digits.
    pub precision: Precision,
    /// In which unit angles go in and come out.
    pub angles: Angles,
    /// How many samples the vectors have.
    pub samples: usize,
    /// How many points a table has along each input.
    pub points: usize,
    /// SHA-256 of the scenario, in hexadecimal digits.
    pub digest: &'a str,
    /// For which elevator it was designed, in a sentence that every file gets; none where nobody knows.
    pub elevator: Option<String>,
    /// What is known of its loop; none where nobody asked.
    pub its_loop: Option<LoopWord>,
    /// Data for a review is asked for, which takes a minute; C has it.
    pub evidence: bool,
}

/// What is known of the loop that a controller was exported from: the same bits say nothing of it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LoopWord {
    /// In words, as "stable at rest".
    pub words: String,
    /// It is not known to be stable.
    pub is_in_doubt: bool,
}

/// Why there is no export.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ExportError {
    /// The controller has no program.
    #[error("controller `{name}`: {reason}")]
    Refused {
        /// The controller.
        name: String,
        /// Why.
        reason: Refusal,
    },
    /// A setting does not survive rounding.
    #[error(
        "controller `{name}` cannot fly with numbers of 32 bits: {}{}", of_single(*reason), if *is_table { ", and a table has no others" } else { "; --numbers double keeps them" }
    )]
    Rounded {
        /// The controller.
        name: String,
        /// Why.
        reason: ConfigError,
        /// It is a table, which has 32 bits at most.
        is_table: bool,
    },
}

/// A controller in another language.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Export {
    /// What every name begins with.
    pub prefix: String,
    /// The files.
    pub files: Vec<File>,
    /// The files of the evidence, where it is asked for and the target has some.
    pub evidence: Vec<File>,
    /// What was chosen, and why.
    pub notes: Vec<String>,
}

/// Writes a controller in another language, with vectors that show that it answers alike.
///
/// # Errors
/// [`ExportError`] names what cannot be exported and what would make it possible.
pub fn export(controller: &Controller<f64>, request: &Request<'_>) -> Result<Export, ExportError> {
    export_called(controller, request, &prefix(request.name))
}

/// As [`export`], with what every name in the code begins with: one of [`prefixes`](crate::prefixes), or a
/// [`prefix`] that is one of itself.
///
/// # Errors
/// As [`export`].
pub fn export_called(
    controller: &Controller<f64>,
    request: &Request<'_>,
    prefix: &str,
) -> Result<Export, ExportError> {
    let period_s = controller.config().dt_s;
    match request.precision {
        Precision::Double => exported(controller, request, prefix, period_s),
        Precision::Single => {
            let rounded = controller.rounded::<f32>().map_err(|reason| ExportError::Rounded {
                name: request.name.to_owned(),
                reason,
                is_table: request.target == Target::Table,
            })?;
            exported(&rounded, request, prefix, period_s)
        }
    }
}

fn exported<R: Real>(
    controller: &Controller<R>,
    request: &Request<'_>,
    prefix: &str,
    period_s: f64,
) -> Result<Export, ExportError> {
    let refused = |reason| ExportError::Refused { name: request.name.to_owned(), reason };
    let program = match program(controller, request.angles) {
        // `fspid-core` runs there itself.
        Err(Refusal::Defuzzifier(_)) if request.target == Target::Rust => {
            outline(controller, request.angles)
        }
        program => program.map_err(refused)?,
    };
    let drawn = if request.target.has_events() { eventful } else { vectors };
    let vectors = drawn(controller, request.angles, SEED, request.samples);
    let mut notes = Vec::from_iter(renamed(request.name, prefix));
    notes.extend(way(controller));
    notes.push(match request.its_loop.as_ref().filter(|it| it.is_in_doubt) {
        Some(it) => format!("warning: of the loop of this scenario: {}; {NOT_JUDGED}", it.words),
        None => NOT_JUDGED.to_owned(),
    });
    if request.precision == Precision::Single {
        notes.push(SINGLE.to_owned());
    }
    let heading = Heading {
        name: request.name,
        digest: request.digest,
        precision: precision_of::<R>(),
        angles: Some(request.angles),
        elevator: request.elevator.as_deref(),
    };
    let source = Source {
        program: &program,
        prefix,
        heading: &heading,
        vectors: &vectors,
        flown: Some(Flown { controller, period_s, points: request.points }),
    };
    let written = written(request.target, &source).map_err(refused)?;
    notes.extend(written.notes);
    let files = written.files;
    let subject = Subject {
        program: &program,
        controller,
        prefix,
        heading: &heading,
        vectors: &vectors,
        its_loop: request.its_loop.as_ref(),
        code: &files,
    };
    let has_evidence = request.evidence && request.target == Target::C;
    let evidence = match has_evidence {
        true if cfg!(target_family = "wasm") => return Err(refused(Refusal::NotInPages)),
        true => evidence::files(&subject),
        false => Vec::new(),
    };
    Ok(Export { prefix: prefix.to_owned(), files, evidence, notes })
}

/// The files of the target, and the vectors.
pub(crate) fn written<R: Real>(target: Target, source: &Source<'_, R>) -> Result<Written, Refusal> {
    // A table is no controller.
    if target == Target::Table {
        return target.files(source);
    }
    let (written, csv) =
        both(|| target.files(source), || write::csv(source.program, source.vectors));
    let mut written = written?;
    written.files.push(File::text("vectors.csv", csv));
    Ok(written)
}

/// Two answers at once: the digits of a hundred thousand numbers take as long as all else.
fn both<A, B: Send>(one: impl FnOnce() -> A, other: impl FnOnce() -> B + Send) -> (A, B) {
    // A page has no threads.
    if cfg!(target_family = "wasm") {
        return (one(), other());
    }
    thread::scope(|scope| {
        let other = scope.spawn(other);
        (one(), other.join().unwrap_or_else(|panic| resume_unwind(panic)))
    })
}

/// Why in the digits and with the limits of 32 bits.
fn of_single(reason: ConfigError) -> String {
    match reason {
        ConfigError::Supervisor(FuzzyError::Range { found }) => {
            let [least, most] = [RANGE_LIMITS_F32.start(), RANGE_LIMITS_F32.end()];
            format!(
                "range is {:e}; allowed is at least {least:e} and at most {most:e}",
                found as f32
            )
        }
        ConfigError::Number { what, found, allowed } if found.is_finite() => {
            format!("{what} is {:?}; allowed is {allowed}", found as f32)
        }
        ConfigError::Number { what, .. } => {
            format!("{what} lies beyond them; allowed is at most {:e}", f32::MAX)
        }
        other => other.to_string(),
    }
}

/// That a name is another one in the code, if it is.
pub(crate) fn renamed(name: &str, called: &str) -> Option<String> {
    (name != called).then(|| format!("`{name}` is called `{called}` in the code"))
}

const NOT_JUDGED: &str =
    "the same bits say nothing of the loop: `fspid verify` and `fspid certify` judge it";
const SINGLE: &str =
    "settings were rounded to 32 bits; verdicts, margins and certificates are of 64 bits";

/// How the supervisor infers.
fn way<R: Real>(controller: &Controller<R>) -> Option<String> {
    let Controller::SelfTuning(fspid) = controller else { return None };
    let supervisor = fspid.tuner().supervisor();
    if supervisor.network().is_some() {
        return Some(format!("a network of {UNITS} hidden units: no rules"));
    }
    let way = match (supervisor.numbers(), supervisor.defuzzifier()) {
        (Some(_), _) => "rules that conclude numbers: bilinear interpolation".to_owned(),
        (None, fspid_core::fuzzy::Defuzzifier::Exact) => {
            "rules that conclude labels: centre of gravity in closed form".to_owned()
        }
        (None, sampled) => {
            format!("rules that conclude labels: centre of gravity by samples, {sampled}")
        }
    };
    Some(way)
}
