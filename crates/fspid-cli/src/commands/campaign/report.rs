//! `fspid campaign report`: what the rows of a campaign say.

use clap::Args;

use super::super::{Format, json_text};
use crate::argument::{NamedFile, OutFile, count, written};
use crate::exit::{Failure, print, wrote};
use fspid_campaign::report;
use fspid_campaign::summary::{self, Summary, SummarySettings};
use fspid_scenario::count as counts;
use fspid_study::output;

/// Say what a campaign found: how often it fails, with confidence bounds, and what that depends on.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// The merged file of a campaign, or its folder: its parts are read where they are not merged.
    file: NamedFile,
    /// Write a page that opens offline in a browser: distributions, envelopes, failure maps.
    #[arg(value_parser = written(&["html", "htm"]), long, value_name = "OUT.html")]
    out: Option<OutFile>,
    /// How sure the intervals shall be.
    #[arg(long, default_value_t = SummarySettings::default().confidence)]
    confidence: f64,
    /// Say what there is so far, where shards are missing; every answer names how many.
    #[arg(long)]
    incomplete: bool,
    /// Most rows whose values are sorted for exact quantiles; of more, each quantile says how far it may be off.
    #[arg(long, value_name = "ROWS", default_value_t = SummarySettings::default().exact_rows, value_parser = count::<u64>(&counts::EXACT_ROWS))]
    exact_rows: u64,
    /// How the answer is written.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let Arguments { confidence, exact_rows, incomplete, .. } = *arguments;
    let settings = SummarySettings { confidence, exact_rows, incomplete };
    let summary = Summary::of(&arguments.file, settings).map_err(Failure::input)?;
    if let Some(path) = &arguments.out {
        let folder = match arguments.file.is_dir() {
            true => Some(&*arguments.file),
            false => arguments.file.parent().filter(|folder| !folder.as_os_str().is_empty()),
        };
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
