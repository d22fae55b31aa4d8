//! Where every number comes from, and how to fly it again.

use crate::report::Paper;
use crate::report::templates::render;
use fspid_page::context;
use fspid_page::page::PageSection;

/// Versions, digests, commands.
pub(super) fn section(paper: &Paper<'_>) -> PageSection {
    let reproduction = paper.reproduction;
    let mut seeds: Vec<u64> = reproduction
        .record
        .problems
        .iter()
        .flat_map(|p| p.runs.iter().map(|run| run.seed))
        .collect();
    seeds.sort_unstable();
    seeds.dedup();
    let seeds: Vec<String> = seeds.iter().map(u64::to_string).collect();
    let figures: Vec<_> = reproduction
        .figures
        .iter()
        .map(|flown| {
            context! {
                name => format!("{}/figure-{}.toml", flown.fit.name(), flown.figure.id),
                digest => flown.study.digest,
            }
        })
        .collect();
    let context = context! {
        version => env!("CARGO_PKG_VERSION"),
        identification => reproduction.record.command,
        seeds => seeds.join(", "),
        digest => reproduction.digest,
        scenarios => paper.library.scenarios().len(),
        figures,
    };
    PageSection::of("provenance", "Provenance", render("provenance", context))
}
