//! `fspid audit`: what is true of a fuzzy system.

use clap::Args;

use super::progress::{Telling, alive, tell};
use super::{Format, Loading, json_text};
use crate::argument::{OutFile, Source, count, written};
use crate::exit::{Failure, print, wrote};
use fspid_scenario::count as counts;
use fspid_study::fuzzy_system::{AuditQuestion, audit};
use fspid_study::{output, report};

/// Say what is true of a fuzzy system: its rules as written, and its surfaces with proof.
///
/// Ranges, slopes and shares are proved by interval arithmetic; what could not be proved within
/// the budget is said to be open, never guessed.
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// A file (.toml, .fis, .t2fis, .fcl, .fll, .xml), a scenario for its supervisor, or `printed`, `mirrored` or `sugeno-grid` with --range.
    system: Source,
    #[command(flatten)]
    loading: Loading,
    /// The range over which an input is looked at; that of the file if left out.
    #[arg(long, value_name = "NAME=LOWER..UPPER", allow_hyphen_values = true)]
    span: Vec<String>,
    /// An input at rest; 0, or the middle of a range without 0, if left out.
    #[arg(long, value_name = "NAME=VALUE", allow_hyphen_values = true)]
    rest: Vec<String>,
    /// Most boxes that are looked at for each single question; more of them prove closer bounds.
    #[arg(long, value_name = "N", value_parser = count::<u64>(&counts::BOXES))]
    boxes: Option<u64>,
    /// Write a report that opens offline in a browser.
    #[arg(value_parser = written(&["html", "htm"]), long, value_name = "OUT.html")]
    report: Option<OutFile>,
    /// How the answer is written.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
}

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let system = arguments.loading.load(&arguments.system)?;
    let question =
        AuditQuestion { spans: &arguments.span, rest: &arguments.rest, boxes: arguments.boxes };
    let telling = Telling::for_standard_error();
    let what = || "auditing; --boxes N looks at fewer boxes".to_owned();
    let audit = alive(telling, &what, || audit(&system, &question));
    if telling == Telling::Line {
        tell(telling, "");
    }
    let audit = audit.map_err(Failure::input)?;
    if let Some(path) = &arguments.report {
        output::write(path, report::of_audit(&audit))?;
        wrote(path);
    }
    match arguments.format {
        Format::Text => print(&audit.text()),
        Format::Json => print(&json_text(&audit.json())),
    }
}
