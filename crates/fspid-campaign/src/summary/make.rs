//! A summary from a file.

use std::path::Path;

use fspid_scenario::measure::{Family, Measure};
use rayon::prelude::*;

use super::data::{
    ControllerSummary, MeasureCount, MeasureSummary, Note, Probability, RequirementSummary,
    Sensitivity, SensitivityTarget, Summary, SummarySettings,
};
use super::flights::{self, Flights};
use super::measures::{Cells, Finite};
use super::partial::Partial;
use super::sensitivity::{Factors, Selections};
use super::source::Source;
use super::{SummaryError, measures, requirements};
use crate::sample::Sampling;
use crate::statistics::Sketch;
use crate::table::Column;

/// What columns of numbers say of one controller, as they are read.
#[derive(Default)]
struct Columns {
    selections: Selections,
    measures: Vec<MeasureSummary>,
    sensitivities: Vec<Sensitivity>,
}

impl Summary {
    /// Of a merged file, or of the parts in a campaign's folder, every byte of which is read and checked.
    ///
    /// Uses the threads of the pool that it is called in; the answer does not depend on how many they are, nor on how
    /// the campaign was cut into parts.
    ///
    /// # Errors
    /// A file that cannot be read, is damaged or is not a merged one; parts that are missing, unless that is allowed,
    /// or do not belong together; a confidence that is not inside (0, 1).
    pub fn of(path: &Path, settings: SummarySettings) -> Result<Self, SummaryError> {
        Probability::of(0, 1, settings.confidence)?;
        let source = Source::open(path, settings)?;
        let controllers = match (source.is_exact(), source.is_small()) {
            (true, false) => by_columns(&source)?,
            (true, true) => by_pieces::<Vec<f64>>(&source)?,
            (false, _) => by_pieces::<Sketch>(&source)?,
        };
        let notes = notes(&source, &controllers);
        Ok(Self { head: source.head, controllers, notes })
    }
}

/// Column by column, with all values of one.
fn by_columns(source: &Source) -> Result<Vec<ControllerSummary>, SummaryError> {
    let flights = flights::read(source)?;
    let asked = source.requirements();
    let tallies = asked.iter().map(|asked| requirements::tallies(source, asked));
    let tallies = tallies.collect::<Result<Vec<_>, _>>()?;
    let factors = Factors::read(source)?;
    let cells = source.measures().map(|column| measures::read::<Vec<f64>>(source, &column.name));
    let columns = columns(source, &flights, &factors, cells)?;
    controllers(source, flights, requirements::summaries(source, tallies)?, columns)
}

/// In one pass, with what adds up.
fn by_pieces<F: Finite>(source: &Source) -> Result<Vec<ControllerSummary>, SummaryError> {
    let partial =
        Partial::<F>::of_pieces(&source.pieces()).unwrap_or_else(|| Partial::of(source))?;
    let Partial { flights, tallies, cells, factors } = partial;
    let factors = factors.of_runs(source.head.runs);
    let columns = columns(source, &flights, &factors, cells.into_iter().map(Ok))?;
    controllers(source, flights, requirements::summaries(source, tallies)?, columns)
}

fn controllers(
    source: &Source,
    flights: Vec<Flights>,
    requirements: Vec<Vec<RequirementSummary>>,
    columns: Vec<Columns>,
) -> Result<Vec<ControllerSummary>, SummaryError> {
    let parts = source.head.controllers.iter().zip(flights).zip(requirements).zip(columns);
    let controllers = parts.map(|(((name, flights), requirements), columns)| {
        let probability = |count| Probability::of(count, source.head.runs, source.head.confidence);
        Ok(ControllerSummary {
            name: name.clone(),
            verdicts: flights.verdicts(),
            failed: probability(flights.failed)?,
            refused: probability(flights.refused)?,
            undecided: flights.undecided,
            requirements,
            measures: columns.measures,
            failed_runs: flights.worst,
            sensitivities: columns.sensitivities,
        })
    });
    controllers.collect()
}

/// What columns of numbers say, one after the other as they come.
fn columns<F: Finite>(
    source: &Source,
    flights: &[Flights],
    factors: &Factors,
    cells: impl Iterator<Item = Result<Vec<Cells<F>>, SummaryError>>,
) -> Result<Vec<Columns>, SummaryError> {
    let mut columns: Vec<Columns> = flights.iter().map(|_| Columns::default()).collect();
    columns.par_iter_mut().zip(flights).for_each(|(columns, flights)| {
        let target = SensitivityTarget::Failure;
        let failing = factors.sensitivity(&mut columns.selections, target, &flights.first_failed);
        columns.sensitivities.push(failing);
    });
    let (asked, confidence) = (source.requirements(), source.head.confidence);
    for (column, cells) in source.measures().zip(cells) {
        let limits = asked.iter().find(|asked| asked.value() == column.name).map(|it| it.limits);
        let results = columns.par_iter_mut().zip(cells?);
        let results = results.map(|(columns, cells)| {
            columns.depend(factors, column, &cells.first);
            columns.measures.push(cells.summary(column, limits, confidence)?);
            Ok(())
        });
        results.collect::<Result<(), SummaryError>>()?;
    }
    Ok(columns)
}

impl Columns {
    fn depend(&mut self, factors: &Factors, column: &Column, first: &[f64]) {
        let target = SensitivityTarget::Measure(column.name.clone());
        let depends = factors.sensitivity(&mut self.selections, target, first);
        self.sensitivities.push(depends);
    }
}

/// What must be known to read the numbers.
fn notes(source: &Source, controllers: &[ControllerSummary]) -> Vec<Note> {
    let head = &source.head;
    let mut notes = Vec::new();
    if let Some(shards) = head.shards.filter(|shards| shards.found < shards.of) {
        notes.push(Note::Incomplete { shards, runs: head.runs, planned_runs: head.planned_runs });
    }
    if !source.is_exact() {
        let relative_width = crate::statistics::sketch::RELATIVE_WIDTH;
        notes.push(Note::FromSketches { rows: head.rows, relative_width });
    }
    if head.sampling != Sampling::Random {
        notes.push(Note::RunsNotIndependent { sampling: head.sampling });
    }
    if head.sampling == Sampling::Sobol {
        notes.push(Note::SharesOvercorrected);
    }
    let runs_used = super::SENSITIVITY_RUNS as u64;
    if head.runs > runs_used {
        notes.push(Note::FirstRunsOnly { runs_used, runs: head.runs });
    }
    for controller in controllers {
        let name = || controller.name.clone();
        if !controller.is_judged() && controller.refused.count < head.runs {
            notes.push(Note::NothingRequired { controller: name() });
        }
        let of = |flights: fn(&MeasureSummary) -> u64| -> Vec<MeasureCount> {
            let counts = controller.measures.iter();
            let counts =
                counts.map(|it| MeasureCount { name: it.name.clone(), flights: flights(it) });
            counts.filter(|it| it.flights > 0).collect()
        };
        let mut missing = of(|it| if it.is_event { 0 } else { it.missing });
        missing.retain(|it| controller.is_asked(&it.name));
        if !missing.is_empty() {
            notes.push(Note::Missing { controller: name(), measures: missing });
        }
        let not_finite = of(|it| it.not_finite);
        if !not_finite.is_empty() {
            notes.push(Note::NotFinite { controller: name(), measures: not_finite });
        }
    }
    notes
}

impl ControllerSummary {
    /// True where some flight was judged by a requirement of more than the aircraft alone; otherwise a flight that does
    /// not fail was called good by nobody.
    #[must_use]
    pub fn is_judged(&self) -> bool {
        let is_of_aircraft = |measure: &str| {
            Measure::from_name(measure).is_some_and(|it| it.family() == Family::Airframe)
        };
        self.requirements.iter().any(|it| it.not_met.of > 0 && !is_of_aircraft(&it.measure))
    }

    /// True where the aircraft alone is asked something.
    pub(super) fn is_aircraft_judged(&self) -> bool {
        !self.is_judged() && self.requirements.iter().any(|it| it.not_met.of > 0)
    }

    /// False for the column of a requirement that does not concern this controller.
    fn is_asked(&self, column: &str) -> bool {
        let of_requirement = |it: &&super::RequirementSummary| {
            column.strip_prefix(crate::rows::REQUIREMENT).and_then(|it| it.strip_suffix(".value"))
                == Some(it.id.as_str())
        };
        let requirement = self.requirements.iter().find(of_requirement);
        requirement.is_none_or(|requirement| requirement.not_met.of > 0)
    }
}
