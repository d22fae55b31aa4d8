//! The worst flights, with what it takes to fly them again.

use fspid_page::analysis::{Chapter, DataTable, Datum, Item};

use super::Source;
use super::words::{count, cut};
use crate::rows::MODE_NEVER_BEGAN;
use crate::summary::{ControllerSummary, FailedRun, Severity};

/// Longest reasons that a row shows, in characters.
const MOST_REASONS: usize = 300;

/// Most controllers with a table: pages shall stay small.
const MOST_TABLES: usize = 16;

pub(super) fn chapter(source: &Source<'_>) -> Chapter {
    let mut items = Vec::new();
    for (n, controller) in source.summary.controllers.iter().enumerate().take(MOST_TABLES) {
        if controller.failed_runs.is_empty() {
            continue;
        }
        items.push(Item::Table(table(source, n, controller)));
    }
    if items.is_empty() {
        items.push(Item::Text(
            "No flight failed. The flights with the worst values of each requirement are in the table of requirements.".to_owned(),
        ));
    } else {
        items.insert(0, Item::Text(
            "Each command flies one run again, bit for bit, in the folder of the campaign, and writes the traces of all controllers.".to_owned(),
        ));
    }
    Chapter { id: "worst".to_owned(), title: "Worst flights".to_owned(), items }
}

fn table(source: &Source<'_>, place: usize, controller: &ControllerSummary) -> DataTable {
    let row = |it: &FailedRun| {
        vec![
            Datum::Text(it.run.to_string()),
            Datum::Text(severity(it)),
            Datum::Text(cut(&it.reasons, MOST_REASONS)),
            Datum::Code(source.replay(it.run)),
        ]
    };
    let (shown, all) = (controller.failed_runs.len() as u64, controller.failed.count);
    DataTable {
        caption: format!(
            "{}: {} of {} flights that failed, the worst kind first: diverged ones by time, the others by run.",
            source.name(place),
            count(shown),
            count(all)
        ),
        head: ["run", "how", "why", "flown again"].map(str::to_owned).to_vec(),
        rows: controller.failed_runs.iter().map(row).collect(),
        cards: true,
    }
}

fn severity(run: &FailedRun) -> String {
    match (run.severity, run.diverged_at_s) {
        (Severity::Diverged, Some(at_s)) => {
            format!("diverged at {} s", super::words::number(at_s))
        }
        (Severity::Diverged, None) => "diverged".to_owned(),
        (Severity::HitGround, _) => "hit the ground".to_owned(),
        (Severity::ControllerLost, _) => "controller lost".to_owned(),
        (Severity::PlantLost, _) => "plant lost".to_owned(),
        (Severity::Unstable, _) => "unstable loop".to_owned(),
        (Severity::ModeNeverBegan, _) => MODE_NEVER_BEGAN.to_owned(),
        (Severity::LeftRange, _) => "left the range".to_owned(),
        (Severity::Refused, _) => "no scenario".to_owned(),
        (Severity::RequirementsNotMet, _) => "requirements not met".to_owned(),
        (Severity::NotSettled, _) => "not settled".to_owned(),
    }
}
