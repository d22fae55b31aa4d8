//! `fspid reproduce`: the paper, flown again.

use std::path::Path;

use clap::Args;
use serde_json::{Map, Value, json};

use super::Format;
use crate::argument::{Folder, count};
use crate::exit::{Failure, note};
use fspid_paper::identify::{Options, identify};
use fspid_paper::{Library, Reproduction, Status, Stored, fallen, recorded_toml};
use fspid_scenario::count as counts;
use fspid_study::output;

/// Regenerate the paper's figures, judge every claim in it, and write one report.
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// Folder for the report, the figures, the traces and the claims.
    #[arg(long, value_name = "DIR", default_value = "out")]
    out: Folder,
    /// Exit with 1 when a claim stands worse than recorded.
    #[arg(long)]
    check: bool,
    /// Find the unpublished parameters anew, from the claims alone (minutes); writes DIR/paper.
    #[arg(long)]
    identify: bool,
    /// First seed of the search.
    #[arg(long, default_value_t = 1, requires = "identify")]
    seed: u64,
    /// Number of seeds; the best is kept and the spread reported.
    #[arg(long, default_value_t = 3, requires = "identify", value_parser = count::<u64>(&counts::SEEDS))]
    seeds: u64,
    /// How the answer is written.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
}

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let out = &arguments.out;
    output::make_folder(out)?;
    let (library, reproduction) = if arguments.identify {
        identified(arguments)?
    } else {
        (Library::stored(), Reproduction::stored().map_err(Failure::input)?)
    };
    write_all(out, &library, &reproduction)?;
    arguments.format.print(|| summary(out, &reproduction), || summary_json(out, &reproduction))?;
    if arguments.check { check(&reproduction) } else { Ok(()) }
}

fn identified(arguments: &Arguments) -> Result<(Library, Reproduction), Failure> {
    let options = Options { seed: arguments.seed, seeds: arguments.seeds };
    let found = identify(options, |line| note(line)).map_err(Failure::input)?;
    let record = format!("{:#}\n", found.record.json());
    let folder = arguments.out.join("paper");
    output::make_folder(&folder)?;
    output::write(&folder.join("identification.json"), record)?;
    for Stored { name, text } in found.library.scenarios() {
        write_below(&folder, name, text)?;
    }
    let reproduction = Reproduction::of(&found.library, found.record).map_err(Failure::input)?;
    Ok((found.library, reproduction))
}

fn write_all(out: &Path, library: &Library, reproduction: &Reproduction) -> Result<(), Failure> {
    for (name, text) in fspid_paper::report::files_of_reproduction(library, reproduction) {
        write_below(out, &name, &text)?;
    }
    output::write(&out.join("claims.json"), format!("{:#}\n", reproduction.claims_json()))?;
    output::write(&out.join("statuses.toml"), recorded_toml(reproduction))?;
    output::write(
        &out.join("report.html"),
        fspid_paper::report::of_reproduction(library, reproduction),
    )?;
    Ok(())
}

fn write_below(folder: &Path, name: &str, text: &str) -> Result<(), Failure> {
    let path = folder.join(name);
    if let Some(parent) = path.parent() {
        output::make_folder(parent)?;
    }
    Ok(output::write(&path, text)?)
}

fn summary(out: &Path, reproduction: &Reproduction) -> String {
    let counts =
        Status::ALL.map(|status| format!("{} {}", reproduction.count(status), status.name()));
    let (numbers, sentences) = (reproduction.claims.len(), reproduction.statements.len());
    let [own, shared] = reproduction.numbers_reproduced();
    format!(
        "{} claims, {numbers} numbers and {sentences} sentences, with parameters of each figure's own: {}\n\
         of the {numbers} numbers {own} come out so, and {shared} with one set of parameters for all figures of a range\n\
         report: {}\n",
        numbers + sentences,
        counts.join(", "),
        out.join("report.html").display()
    )
}

fn summary_json(out: &Path, reproduction: &Reproduction) -> Value {
    let counts = Status::ALL.map(|status| (status.name(), reproduction.count(status)));
    let fallen = fallen(reproduction);
    let fallen: Vec<Value> = fallen
        .iter()
        .map(|it| json!({ "id": it.id, "recorded": it.recorded.to_string(), "now": it.now.to_string() }))
        .collect();
    json!({
        "schema": 1,
        "claims": reproduction.statuses().count(),
        "statuses": counts.into_iter().map(|(name, count)| (name.to_owned(), json!(count))).collect::<Map<_, _>>(),
        "fallen": fallen,
        "report": out.join("report.html").display().to_string(),
    })
}

fn check(reproduction: &Reproduction) -> Result<(), Failure> {
    let fallen = fallen(reproduction);
    if fallen.is_empty() {
        return Ok(());
    }
    let lines = fallen
        .iter()
        .map(|claim| format!("{}: {} recorded, now {}", claim.id, claim.recorded, claim.now));
    Err(Failure::not_met(lines.collect::<Vec<_>>().join("\n")))
}
