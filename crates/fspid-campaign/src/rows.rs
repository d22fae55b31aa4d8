//! The result table of a campaign: one row for each flight, and the meaning of its columns.
//!
//! Names, units and meanings of the columns are part of the format: they are documented in
//! `docs/campaigns.md` and change with [`FORMAT`] only.

use std::sync::Arc;

use fspid_scenario::dispersion::{Dispersion, Drawn};
use fspid_scenario::file::Study;
use fspid_scenario::requirement::Requirement;
use fspid_study::judgement::Judgement;
use fspid_study::metrics::{METRICS, Metric, Verdict};

use crate::engine::FlightResult;
use crate::table::{Cell, Column, ColumnTable, Kind, MAX_TEXT_BYTES, Schema, TableError};

pub use fspid_study::metrics::Bad;

/// The verdict on a flight that ended at the ground.
pub const HIT_GROUND: &str = "hit the ground";

/// The verdict on a flight whose external controller gave no answer.
pub const CONTROLLER_LOST: &str = "controller lost";

/// The verdict on a flight whose autopilot waited in vain for a mode to begin.
pub const MODE_NEVER_BEGAN: &str = "mode never began";

/// The verdict of a flight whose simulator gave no answer.
pub const PLANT_LOST: &str = "plant lost";

/// Version of the rows.
pub const FORMAT: u32 = 2;

/// Column of the run's number.
pub const RUN: &str = "run";
/// Column of the controller's name.
pub const CONTROLLER: &str = "controller";
/// Column that says whether the flight counts as failed.
pub const FAILED: &str = "failed";
/// Column of the verdict in a word.
pub const VERDICT: &str = "verdict";
/// Column of the loop's stability at rest, in a word. Rows of format 1 have none.
pub const STABILITY: &str = "stability";
/// What stands there where it could not be told.
pub const UNDECIDED: &str = "undecided";
/// Column of the time at which a flight diverged.
pub const DIVERGED_AT: &str = "diverged_at_s";
/// Column of the time at which an aircraft left the range of its model.
pub const LEFT_VALIDITY_AT: &str = "left_validity_at_s";
/// Column of the reasons of a failure.
pub const REASONS: &str = "reasons";
/// What the names of columns of drawn numbers begin with.
pub const PARAMETER: &str = "parameter.";
/// What the names of columns of requirements begin with.
pub const REQUIREMENT: &str = "requirement.";
/// The verdict on a run whose numbers make no scenario.
pub const REFUSED: &str = "refused";

/// A run: what was drawn, and what came of it.
#[derive(Clone, Debug)]
pub struct Run {
    /// Number of the run, from 0.
    pub number: u64,
    /// What was drawn, one entry a column of the dispersions.
    pub drawn: Vec<Drawn>,
    /// Each controller's flight, or why there is none.
    pub flights: Result<Vec<FlightResult>, String>,
}

/// What is kept beside the measures: when an aircraft left the range of its model, if it did.
const LEFT_VALIDITY_IS: &str =
    "when an aircraft first left the range of its model; empty if it did not";

/// Names of the columns of measures, with their units.
pub fn measure_names() -> impl Iterator<Item = (&'static str, &'static str)> {
    METRICS.iter().map(|metric| (metric.name, metric.unit)).chain([(LEFT_VALIDITY_AT, "s")])
}

/// A measure of a flight by the name of its column; `None` where it has none.
#[must_use]
pub fn measured(flight: &FlightResult, name: &str) -> Option<f64> {
    match Metric::from_name(name) {
        Some(metric) => metric.of_flight(&flight.metrics).ok(),
        None if name == LEFT_VALIDITY_AT => left_validity_at_s(flight),
        None => None,
    }
}

fn left_validity_at_s(flight: &FlightResult) -> Option<f64> {
    flight.exit.map(|exit| exit.at_s)
}

/// Which values of a measure are bad, by the name of its column, where that is known.
#[must_use]
pub fn bad_side(name: &str) -> Option<Bad> {
    if name == LEFT_VALIDITY_AT { Some(Bad::Low) } else { Metric::from_name(name)?.bad }
}

/// True for a measure with a sign that is asked for by its size, by the name of its column.
#[must_use]
pub fn is_of_size(name: &str) -> bool {
    Metric::from_name(name).is_some_and(Metric::is_of_size)
}

/// The rows of a campaign: which columns they have, and how they are filled.
#[derive(Clone, Debug)]
pub struct Rows {
    schema: Arc<Schema>,
    controllers: Vec<String>,
    requirements: Vec<Requirement>,
}

impl Rows {
    /// The rows of a study's campaign.
    ///
    /// # Errors
    /// [`TableError`] for two columns of one name.
    pub fn of(study: &Study) -> Result<Self, TableError> {
        let requirements = &study.requirements;
        let mut columns = head(study.scenario.plant.aircraft().is_some());
        columns.extend(study.dispersions.iter().flat_map(parameters));
        columns.extend(METRICS.iter().map(|metric| {
            Column::new(metric.name, Kind::Float).unit(metric.unit).meaning(metric.meaning)
        }));
        let left = Column::new(LEFT_VALIDITY_AT, Kind::Float).unit("s");
        columns.push(left.meaning(LEFT_VALIDITY_IS));
        columns.extend(requirements.iter().flat_map(asked));
        Ok(Self {
            schema: Arc::new(Schema::new(columns)?),
            controllers: study.scenario.flyers().map(|it| it.name().to_owned()).collect(),
            requirements: requirements.clone(),
        })
    }

    /// The columns.
    #[must_use]
    pub fn schema(&self) -> &Arc<Schema> {
        &self.schema
    }

    /// Rows of one run.
    #[must_use]
    pub fn of_run(&self) -> usize {
        self.controllers.len()
    }

    /// The rows of some runs, in their order, each controller in its own order.
    ///
    /// # Errors
    /// None where the runs are of this campaign.
    pub fn table(&self, runs: &[Run]) -> Result<ColumnTable, TableError> {
        let mut table = ColumnTable::new(Arc::clone(&self.schema));
        for run in runs {
            for (place, controller) in self.controllers.iter().enumerate() {
                self.push(&mut table, run, place, controller)?;
            }
        }
        Ok(table)
    }

    fn push(
        &self,
        table: &mut ColumnTable,
        run: &Run,
        place: usize,
        controller: &str,
    ) -> Result<(), TableError> {
        let flight = run.flights.as_ref().map(|flights| flights.get(place));
        let flight = flight.ok().flatten();
        let reasons = match &run.flights {
            Ok(_) => flight.map(FlightResult::reasons).unwrap_or_default().join("; "),
            Err(reason) => reason.clone(),
        };
        let reasons = shortened(&reasons);
        let mut cells: Vec<Cell<'_>> = vec![
            i64::try_from(run.number).unwrap_or(i64::MAX).into(),
            controller.into(),
            (!reasons.is_empty()).into(),
            flight.map_or(REFUSED, |flight| word(flight.metrics.verdict)).into(),
            Some(reasons).filter(|reasons| !reasons.is_empty()).into(),
            flight.and_then(|flight| flight.at_rest.stability_word()).into(),
            flight.and_then(FlightResult::diverged_at_s).into(),
        ];
        cells.extend(run.drawn.iter().map(cell));
        let of_flight = |metric: &Metric| metric.of_flight(&flight?.metrics).ok();
        cells.extend(METRICS.iter().map(|metric| Cell::from(of_flight(metric))));
        cells.push(flight.and_then(left_validity_at_s).into());
        for requirement in &self.requirements {
            let judgement = flight.and_then(|flight| judged(flight, requirement));
            let value = judgement.and_then(|it| it.found.as_ref().ok()).map(|case| case.value);
            cells.push(value.into());
            cells.push(judgement.map(|judgement| judgement.met).into());
        }
        table.push(&cells)
    }
}

fn judged<'a>(flight: &'a FlightResult, requirement: &Requirement) -> Option<&'a Judgement> {
    flight.judgements.iter().find(|judgement| judgement.requirement.id == requirement.id)
}

const FAILED_IS: &str = "true for a flight that diverged, an unstable loop, a requirement that is not met, a run whose numbers make no scenario; where nothing is required of the controller, also for a step that was not settled";
const FAILED_IN_AIR: &str = "true for a flight that diverged or hit the ground, an unstable loop, a requirement that is not met, a range of the aircraft's data that was left unless the scenario has `validity = \"warn\"`, a run whose numbers make no scenario; where nothing is required of the controller, also for a step that was not settled";
const VERDICT_IS: &str =
    "settled, not settled, flown (no step to settle), diverged, unstable, or refused";
const VERDICT_IN_AIR: &str = "settled, not settled, flown (no step to settle), diverged, hit the ground, unstable, or refused";

const STABILITY_IS: &str = "of the loop at rest: stable, unstable or undecided; empty where it could not be asked, as of a program without equations";

/// The columns of every campaign; only a nonlinear aircraft has a ground and a range.
fn head(has_ground: bool) -> Vec<Column> {
    let column = |name, kind, meaning: &str| Column::new(name, kind).meaning(meaning);
    let (failed, verdict) =
        if has_ground { (FAILED_IN_AIR, VERDICT_IN_AIR) } else { (FAILED_IS, VERDICT_IS) };
    vec![
        column(RUN, Kind::Integer, "number of the run, from 0"),
        column(CONTROLLER, Kind::Text, "name of the controller"),
        column(FAILED, Kind::Boolean, failed),
        column(VERDICT, Kind::Text, verdict),
        column(REASONS, Kind::Text, "why it failed; empty where it did not"),
        column(STABILITY, Kind::Text, STABILITY_IS),
        column(DIVERGED_AT, Kind::Float, "when the flight diverged").unit("s"),
    ]
}

fn parameters(dispersion: &Dispersion) -> Vec<Column> {
    let column = |name: &str| {
        let kind = match dispersion.is_text() {
            true => Kind::Text,
            false if dispersion.is_whole() => Kind::Integer,
            false => Kind::Float,
        };
        let meaning = dispersion.in_words(name);
        Column::new(format!("{PARAMETER}{name}"), kind).meaning(meaning)
    };
    dispersion.names().map(column).collect()
}

fn asked(requirement: &Requirement) -> [Column; 2] {
    let (id, measure) = (&requirement.id, requirement.measure);
    let limits = requirement.limits_in_words();
    [
        Column::new(format!("{REQUIREMENT}{id}.value"), Kind::Float)
            .unit(measure.unit())
            .meaning(format!("{}, the worst case; required: {limits}", measure.name())),
        Column::new(format!("{REQUIREMENT}{id}.met"), Kind::Boolean)
            .meaning(format!("whether {} is {limits}", measure.name())),
    ]
}

fn cell(drawn: &Drawn) -> Cell<'_> {
    match drawn {
        Drawn::Number(number) => (*number).into(),
        Drawn::Whole(whole) => (*whole).into(),
        Drawn::Text(text) => text.as_str().into(),
    }
}

fn word(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Unstable { .. } => "unstable",
        verdict => verdict.kind(),
    }
}

/// As much of a text as a cell can hold.
fn shortened(text: &str) -> &str {
    text.get(..text.floor_char_boundary(MAX_TEXT_BYTES)).unwrap_or(text)
}
