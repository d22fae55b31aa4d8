//! `fspid campaign report`: what a file of rows says.

use clap::Args;

use super::super::{Format, json_text};
use crate::argument::{NamedFile, OutFile, written};
use crate::exit::{Failure, print, wrote};
use fspid_campaign::report;
use fspid_campaign::summary::{self, Summary, SummarySettings};
use fspid_study::output;

/// Say what a campaign found: how often it fails, with confidence bounds, and what that depends on.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// The merged file of a campaign; it is read here and there, so that it has to have a name.
    file: NamedFile,
    /// Write a page that opens offline in a browser: distributions, envelopes, failure maps.
    #[arg(value_parser = written(&["html", "htm"]), long, value_name = "OUT.html")]
    out: Option<OutFile>,
    /// How sure the intervals shall be.
    #[arg(long, default_value_t = SummarySettings::default().confidence)]
    confidence: f64,
    /// How the answer is written.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let settings = SummarySettings { confidence: arguments.confidence };
    let summary = Summary::of(&arguments.file, settings).map_err(Failure::input)?;
    if let Some(path) = &arguments.out {
        let folder = arguments.file.parent().filter(|folder| !folder.as_os_str().is_empty());
        let folder = Some(folder.map_or(".".to_owned(), |folder| folder.display().to_string()));
        let settings = report::Settings { summary: settings, folder };
        let page = report::page_of(&arguments.file, &summary, &settings).map_err(Failure::input)?;
        output::write(path, page)?;
        wrote(path);
    }
    match arguments.format {
        Format::Text => print(&summary::text(&summary)),
        Format::Json => print(&json_text(&summary::json(&summary))),
    }
}
