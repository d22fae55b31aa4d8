//! How flights ended: verdicts, failures, the worst of them. Checks on the way that the rows are all there.

use std::collections::BTreeMap;

use fspid_study::metrics::LEFT_RANGE;

use super::data::{FailedRun, Severity, VerdictCount};
use super::source::Source;
use super::{FAILED_RUNS, NotMerged, SummaryError};
use crate::rows::{
    CONTROLLER, CONTROLLER_LOST, DIVERGED_AT, FAILED, HIT_GROUND, MODE_NEVER_BEGAN, PLANT_LOST,
    REASONS, REFUSED, RUN, STABILITY, UNDECIDED, VERDICT,
};
use crate::table::{ColumnTable, Kind, TableError, Values};

/// Verdicts from good to bad.
const VERDICTS: [&str; 10] = [
    "settled",
    "flown",
    "not settled",
    REFUSED,
    MODE_NEVER_BEGAN,
    "unstable",
    CONTROLLER_LOST,
    PLANT_LOST,
    HIT_GROUND,
    "diverged",
];

/// How one controller's flights ended.
#[derive(Default)]
pub(super) struct Flights {
    verdicts: BTreeMap<String, u64>,
    pub(super) failed: u64,
    pub(super) refused: u64,
    pub(super) undecided: u64,
    pub(super) worst: Vec<FailedRun>,
    /// Of the first runs: 1 for a failed one, else 0.
    pub(super) first_failed: Vec<f64>,
}

/// A row, as far as it says how a flight ended.
struct Ending<'a> {
    run: u64,
    failed: bool,
    verdict: &'a str,
    is_undecided: bool,
    reasons: Option<&'a str>,
    diverged_at_s: Option<f64>,
}

/// How each controller's flights ended.
pub(super) fn read(source: &Source) -> Result<Vec<Flights>, SummaryError> {
    let mut flights: Vec<Flights> =
        source.head.controllers.iter().map(|_| Flights::default()).collect();
    let mut names = vec![RUN, CONTROLLER, FAILED, VERDICT, REASONS, DIVERGED_AT];
    // Rows of an earlier format do not say.
    let schema = source.files.first().schema();
    names.extend(
        [STABILITY].iter().filter(|name| schema.columns().iter().any(|it| it.name == **name)),
    );
    let mut row = 0;
    for table in source.files.columns(&names)? {
        let table = table?;
        let columns = Columns::of(&table)?;
        for index in 0..table.rows() {
            let place = row % source.controllers();
            let ending = columns.ending(source, row, index)?;
            if let Some(flights) = flights.get_mut(place) {
                flights.add(&ending, source.first_runs);
            }
            row += 1;
        }
    }
    Ok(flights)
}

/// The columns of a row group.
struct Columns<'a> {
    runs: &'a [Option<i64>],
    controllers: &'a [Option<String>],
    failed: &'a [Option<bool>],
    verdicts: &'a [Option<String>],
    stabilities: &'a [Option<String>],
    reasons: &'a [Option<String>],
    diverged_at_s: &'a [Option<f64>],
}

impl<'a> Columns<'a> {
    fn of(table: &'a ColumnTable) -> Result<Self, TableError> {
        Ok(Self {
            runs: integers(table, RUN)?,
            controllers: texts(table, CONTROLLER)?,
            failed: booleans(table, FAILED)?,
            verdicts: texts(table, VERDICT)?,
            stabilities: texts(table, STABILITY).unwrap_or_default(),
            reasons: texts(table, REASONS)?,
            diverged_at_s: table.floats(DIVERGED_AT)?,
        })
    }

    /// A row of the group, which is row `row` of the file.
    fn ending(
        &self,
        source: &Source,
        row: usize,
        index: usize,
    ) -> Result<Ending<'a>, SummaryError> {
        let of_run = source.controllers().max(1);
        let run = source.run(row);
        let expected = source.head.controllers.get(row % of_run);
        let found = self.runs.get(index).copied().flatten();
        let controller = self.controllers.get(index).and_then(Option::as_ref);
        if found.and_then(|found| u64::try_from(found).ok()) != Some(run) || controller != expected
        {
            let controller = expected.cloned().unwrap_or_default();
            return Err(source.refusal(NotMerged::Order { row: row as u64, run, controller }));
        }
        let empty = |column| source.refusal(NotMerged::Empty { row: row as u64, column });
        let failed = self.failed.get(index).copied().flatten();
        let verdict = self.verdicts.get(index).and_then(Option::as_deref);
        let stability = self.stabilities.get(index).and_then(Option::as_deref);
        Ok(Ending {
            run,
            failed: failed.ok_or_else(|| empty(FAILED))?,
            verdict: verdict.ok_or_else(|| empty(VERDICT))?,
            is_undecided: stability == Some(UNDECIDED),
            reasons: self.reasons.get(index).and_then(Option::as_deref),
            diverged_at_s: self.diverged_at_s.get(index).copied().flatten(),
        })
    }
}

impl Flights {
    /// Counts by verdict, from good to bad, unknown words last.
    pub(super) fn verdicts(&self) -> Vec<VerdictCount> {
        let count = |verdict: &str| {
            let flights = *self.verdicts.get(verdict)?;
            Some(VerdictCount { verdict: verdict.to_owned(), flights })
        };
        let known = VERDICTS.iter().filter_map(|verdict| count(verdict));
        let others = self.verdicts.keys().filter(|verdict| !VERDICTS.contains(&verdict.as_str()));
        known.chain(others.filter_map(|verdict| count(verdict))).collect()
    }

    /// With what later rows say.
    pub(super) fn merge(&mut self, later: Self) {
        for (verdict, flights) in later.verdicts {
            *self.verdicts.entry(verdict).or_default() += flights;
        }
        self.failed += later.failed;
        self.refused += later.refused;
        self.undecided += later.undecided;
        self.first_failed.extend(later.first_failed);
        later.worst.into_iter().for_each(|failed| self.keep(failed));
    }

    fn add(&mut self, ending: &Ending<'_>, first_runs: usize) {
        match self.verdicts.get_mut(ending.verdict) {
            Some(count) => *count += 1,
            None => {
                self.verdicts.insert(ending.verdict.to_owned(), 1);
            }
        }
        self.failed += u64::from(ending.failed);
        self.refused += u64::from(ending.verdict == REFUSED);
        self.undecided += u64::from(ending.is_undecided);
        if self.first_failed.len() < first_runs {
            self.first_failed.push(f64::from(u8::from(ending.failed)));
        }
        if ending.failed {
            self.name(ending);
        }
    }

    /// Keeps a failed run if it is among the worst so far.
    fn name(&mut self, ending: &Ending<'_>) {
        let severity = match ending.verdict {
            "diverged" => Severity::Diverged,
            HIT_GROUND => Severity::HitGround,
            CONTROLLER_LOST => Severity::ControllerLost,
            PLANT_LOST => Severity::PlantLost,
            "unstable" => Severity::Unstable,
            MODE_NEVER_BEGAN => Severity::ModeNeverBegan,
            REFUSED => Severity::Refused,
            // The column of the verdict says what the measures come to.
            _ if ending.reasons.is_some_and(|it| it.contains(LEFT_RANGE)) => Severity::LeftRange,
            // Alone among the reasons where nothing is required, and never among those of requirements.
            verdict @ "not settled" if ending.reasons.is_some_and(|it| it.starts_with(verdict)) => {
                Severity::NotSettled
            }
            _ => Severity::RequirementsNotMet,
        };
        let Ending { run, diverged_at_s, .. } = *ending;
        // Only what is kept has its reasons copied.
        if self.place(severity, diverged_at_s) < FAILED_RUNS {
            let reasons = ending.reasons.unwrap_or_default().to_owned();
            self.keep(FailedRun { run, severity, diverged_at_s, reasons });
        }
    }

    /// Where a failed run comes among the worst. Rows come in the order of runs: of equally bad ones the first stay in front.
    fn place(&self, severity: Severity, diverged_at_s: Option<f64>) -> usize {
        let at_s = |at_s: Option<f64>| at_s.unwrap_or(f64::INFINITY);
        self.worst.partition_point(|other| {
            let earlier = at_s(other.diverged_at_s).total_cmp(&at_s(diverged_at_s));
            other.severity.cmp(&severity).then(earlier).is_le()
        })
    }

    fn keep(&mut self, failed: FailedRun) {
        let place = self.place(failed.severity, failed.diverged_at_s);
        if place < FAILED_RUNS {
            self.worst.insert(place, failed);
            self.worst.truncate(FAILED_RUNS);
        }
    }
}

fn wrong(table: &ColumnTable, column: &str, found: Kind) -> TableError {
    let expected = table.column(column).map_or(found, Values::kind);
    TableError::Kind { column: column.to_owned(), expected, found }
}

fn integers<'a>(table: &'a ColumnTable, column: &str) -> Result<&'a [Option<i64>], TableError> {
    match table.column(column)? {
        Values::Integer(cells) => Ok(cells),
        _ => Err(wrong(table, column, Kind::Integer)),
    }
}

fn texts<'a>(table: &'a ColumnTable, column: &str) -> Result<&'a [Option<String>], TableError> {
    match table.column(column)? {
        Values::Text(cells) => Ok(cells),
        _ => Err(wrong(table, column, Kind::Text)),
    }
}

/// The cells of a column of truths.
pub(super) fn booleans<'a>(
    table: &'a ColumnTable,
    column: &str,
) -> Result<&'a [Option<bool>], TableError> {
    match table.column(column)? {
        Values::Boolean(cells) => Ok(cells),
        _ => Err(wrong(table, column, Kind::Boolean)),
    }
}
