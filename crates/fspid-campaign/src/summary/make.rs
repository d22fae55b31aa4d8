//! A summary from a file.

use std::path::Path;

use rayon::prelude::*;

use super::data::{
    ControllerSummary, MeasureCount, MeasureSummary, Note, Probability, Sensitivity,
    SensitivityTarget, Summary, SummarySettings,
};
use super::flights::{self, Flights};
use super::sensitivity::{Factors, Selections};
use super::source::Source;
use super::{SummaryError, measures, requirements};
use crate::sample::Sampling;
use crate::table::Column;

/// What columns of numbers say of one controller, as they are read.
#[derive(Default)]
struct Columns {
    selections: Selections,
    measures: Vec<MeasureSummary>,
    sensitivities: Vec<Sensitivity>,
}

impl Summary {
    /// Of a merged file, every byte of which is read and checked.
    ///
    /// Uses the threads of the pool that it is called in; the answer does not depend on how many they are.
    ///
    /// # Errors
    /// A file that cannot be read, is damaged or is not a merged one; a confidence that is not inside (0, 1).
    pub fn of(path: &Path, settings: SummarySettings) -> Result<Self, SummaryError> {
        Probability::of(0, 1, settings.confidence)?;
        let source = Source::open(path, settings)?;
        let flights = flights::read(&source)?;
        let requirements = requirements::read(&source)?;
        let columns = columns(&source, &flights)?;
        let parts = source.head.controllers.iter().zip(flights).zip(requirements).zip(columns);
        let controllers = parts.map(|(((name, flights), requirements), columns)| {
            let probability = |count| Probability::of(count, source.head.runs, settings.confidence);
            Ok(ControllerSummary {
                name: name.clone(),
                verdicts: flights.verdicts(),
                failed: probability(flights.failed)?,
                refused: probability(flights.refused)?,
                requirements,
                measures: columns.measures,
                failed_runs: flights.worst,
                sensitivities: columns.sensitivities,
            })
        });
        let controllers = controllers.collect::<Result<Vec<_>, SummaryError>>()?;
        let notes = notes(&source, &controllers);
        Ok(Self { head: source.head, controllers, notes })
    }
}

/// Reads the columns of numbers one after the other.
fn columns(source: &Source, flights: &[Flights]) -> Result<Vec<Columns>, SummaryError> {
    let factors = Factors::read(source)?;
    let mut columns: Vec<Columns> = flights.iter().map(|_| Columns::default()).collect();
    columns.par_iter_mut().zip(flights).for_each(|(columns, flights)| {
        let target = SensitivityTarget::Failure;
        let failing = factors.sensitivity(&mut columns.selections, target, &flights.first_failed);
        columns.sensitivities.push(failing);
    });
    let (asked, confidence) = (source.requirements(), source.head.confidence);
    for column in source.measures() {
        let limits = asked.iter().find(|asked| asked.value() == column.name).map(|it| it.limits);
        let cells = measures::read(source, &column.name)?;
        let results = columns.par_iter_mut().zip(cells);
        let results = results.map(|(columns, cells)| {
            columns.depend(&factors, column, &cells);
            columns.measures.push(cells.summary(column, limits, confidence)?);
            Ok(())
        });
        results.collect::<Result<(), SummaryError>>()?;
    }
    Ok(columns)
}

impl Columns {
    fn depend(&mut self, factors: &Factors, column: &Column, cells: &measures::Cells) {
        let target = SensitivityTarget::Measure(column.name.clone());
        let depends = factors.sensitivity(&mut self.selections, target, &cells.first);
        self.sensitivities.push(depends);
    }
}

/// What must be known to read the numbers.
fn notes(source: &Source, controllers: &[ControllerSummary]) -> Vec<Note> {
    let head = &source.head;
    let mut notes = Vec::new();
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
        let judged: u64 = controller.requirements.iter().map(|it| it.not_met.of).sum();
        if judged == 0 && controller.refused.count < head.runs {
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
