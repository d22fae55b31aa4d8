//! `fspid bench`: how fast this machine is.

use crate::argument::count;
use clap::Args;
use fspid_campaign::bench::{Bench, Effort};
use fspid_scenario::count as counts;

use super::progress::at_work;
use super::{Format, json_text};
use crate::exit::{Failure, print};

/// Measure this machine: inferences, closed-loop steps and flights a second, on one thread and on all.
///
/// The loop is the paper's 747 with FSPID, sampled at 100 Hz, for 50 s; flights draw their plants and are
/// measured as those of a campaign. Every kind of work is repeated in rounds that take turns; the rates
/// are medians by the wall clock. All answers are compared from round to round and between scalar
/// and batched work.
///
/// In JSON the rates at the top are those of one thread, but `flights_per_s`, which is that of all
/// threads; `details` holds both, with quartiles, every round, ratios and a digest of the answers.
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// How the answer is written.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
    /// How many threads "all" are; 0 for as many as this machine runs at once.
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = count::<usize>(&counts::THREADS))]
    threads: usize,
    /// Less than a second of measuring, and less certain.
    #[arg(long)]
    quick: bool,
}

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let effort = if arguments.quick { Effort::QUICK } else { Effort::USUAL };
    let what = if arguments.quick { "measuring" } else { "measuring, which takes about a minute" };
    let bench = at_work(what, || Bench::of_this_machine(arguments.threads, effort));
    let bench = bench.map_err(Failure::not_met)?;
    match arguments.format {
        Format::Text => print(&bench.text()),
        Format::Json => print(&json_text(&bench.json())),
    }
}
