//! What a flight leaves behind: one row of a table, and what its columns mean.
//!
//! Names, units and meanings of the columns are part of the format: they are documented in
//! `docs/campaigns.md` and change with [`FORMAT`] only.

use std::sync::Arc;

use fspid_scenario::dispersion::{Dispersion, Drawn};
use fspid_scenario::file::Study;
use fspid_scenario::requirement::Requirement;
use fspid_scenario::units::degrees;
use fspid_study::judgement::Judgement;
use fspid_study::metrics::{CommandEffort, ErrorIntegrals, StepMetrics, Verdict};
use serde::Serialize;

use crate::engine::FlightResult;
use crate::table::{Cell, Column, ColumnTable, Kind, MAX_TEXT_BYTES, Schema, TableError};

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

/// Which values of a measure are bad.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Bad {
    /// High ones, as of overshoot.
    High,
    /// Low ones, as of a margin.
    Low,
}

/// A measure of a flight that has a column.
struct MeasureColumn {
    name: &'static str,
    unit: &'static str,
    /// Which values are bad, whatever is asked; none where both sides are, or neither.
    bad: Option<Bad>,
    meaning: &'static str,
    value: fn(&FlightResult) -> Option<f64>,
}

const HIGH: Option<Bad> = Some(Bad::High);
const LOW: Option<Bad> = Some(Bad::Low);

const fn measure(
    (name, unit): (&'static str, &'static str),
    bad: Option<Bad>,
    value: fn(&FlightResult) -> Option<f64>,
    meaning: &'static str,
) -> MeasureColumn {
    MeasureColumn { name, unit, bad, meaning, value }
}

fn first(flight: &FlightResult) -> StepMetrics {
    flight.metrics.first_step()
}

fn integral(flight: &FlightResult, value: fn(ErrorIntegrals) -> f64) -> Option<f64> {
    flight.metrics.integrals.ok().map(value)
}

fn command(flight: &FlightResult, value: fn(CommandEffort) -> f64) -> Option<f64> {
    flight.metrics.effort.ok().map(value)
}

/// Of a flight that can be measured at all.
fn of_whole(flight: &FlightResult, value: fn(&FlightResult) -> f64) -> Option<f64> {
    flight.metrics.effort.ok().map(|_| value(flight))
}

#[rustfmt::skip] // a table: one row a measure
const MEASURES: [MeasureColumn; 22] = [
    measure(("rise_time_s", "s"), HIGH, |f| first(f).rise_time_s.ok(), "10 % to 90 % of the first step of the command"),
    measure(("settling_time_s", "s"), HIGH, |f| first(f).settling_time_s.ok(), "until the response to the first step stays within 2 % of it"),
    measure(("transient_time_s", "s"), HIGH, |f| first(f).transient_time_s.ok(), "until the response to the first step stays within 2 % of its largest error"),
    measure(("overshoot_pct", "%"), HIGH, |f| first(f).overshoot_pct.ok(), "beyond the set-point after the first step, of the step"),
    measure(("undershoot_pct", "%"), HIGH, |f| first(f).undershoot_pct.ok(), "first the wrong way after the first step, of the step"),
    measure(("final_error_pct", "%"), None, |f| first(f).final_error_pct.ok(), "left at the end of the first step's window, of the step; positive below the set-point"),
    measure(("peak_deg", "deg"), None, |f| first(f).peak.ok().map(degrees), "largest distance from where the first step began"),
    measure(("peak_time_s", "s"), None, |f| first(f).peak_time_s.ok(), "time of the peak after the first step"),
    measure(("iae_deg_s", "deg s"), HIGH, |f| integral(f, |i| degrees(i.iae_rad_s)), "integral of the size of the error over the flight"),
    measure(("itae_deg_s2", "deg s²"), HIGH, |f| integral(f, |i| degrees(i.itae_rad_s2)), "the same, weighted with the time since the last step"),
    measure(("ise_deg2_s", "deg² s"), HIGH, |f| integral(f, |i| degrees(degrees(i.ise_rad2_s))), "integral of the squared error over the flight"),
    measure(("itse_deg2_s2", "deg² s²"), HIGH, |f| integral(f, |i| degrees(degrees(i.itse_rad2_s2))), "the same, weighted with the time since the last step"),
    measure(("rms_error_deg", "deg"), HIGH, |f| f.metrics.rms_error_rad.ok().map(degrees), "root mean square of the error over the flight"),
    measure(("largest_error_deg", "deg"), HIGH, |f| of_whole(f, |f| degrees(f.largest_error_rad)), "largest size of the error"),
    measure(("command_variation_deg", "deg"), HIGH, |f| command(f, |e| degrees(e.variation_rad)), "way of the command: sum of the sizes of its changes"),
    measure(("largest_command_deg", "deg"), HIGH, |f| command(f, |e| degrees(e.largest_rad)), "largest size of the command"),
    measure(("command_rate_deg_s", "deg/s"), HIGH, |f| command(f, |e| degrees(e.fastest_rad_s)), "fastest change of the command from sample to sample"),
    measure(("elevator_travel_deg", "deg"), HIGH, |f| of_whole(f, |f| degrees(f.elevator.variation_rad)), "way of the elevator: sum of the sizes of its changes"),
    measure(("largest_elevator_deg", "deg"), HIGH, |f| of_whole(f, |f| degrees(f.elevator.largest_rad)), "largest size of the elevator deflection"),
    measure(("elevator_rate_deg_s", "deg/s"), HIGH, |f| of_whole(f, |f| degrees(f.elevator.fastest_rad_s)), "fastest change of the elevator from sample to sample"),
    measure(("saturated_pct", "%"), HIGH, |f| f.metrics.effort.ok().and(f.saturated_share).map(|share| 100.0 * share), "samples whose command was cut by the controller's own limits"),
    measure((LEFT_VALIDITY_AT, "s"), LOW, |f| f.exit.map(|exit| exit.at_s), "when an aircraft first left the range of its model; empty if it did not"),
];

/// Names of the columns of measures, with their units.
pub fn measure_names() -> impl Iterator<Item = (&'static str, &'static str)> {
    MEASURES.iter().map(|measure| (measure.name, measure.unit))
}

/// A measure of a flight by the name of its column; `None` where it has none.
#[must_use]
pub fn measured(flight: &FlightResult, name: &str) -> Option<f64> {
    (MEASURES.iter().find(|measure| measure.name == name)?.value)(flight)
}

/// Which values of a measure are bad, by the name of its column, where that is known.
#[must_use]
pub fn bad_side(name: &str) -> Option<Bad> {
    MEASURES.iter().find(|measure| measure.name == name)?.bad
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
        let measures = MEASURES.iter();
        columns.extend(measures.map(|measure| {
            Column::new(measure.name, Kind::Float).unit(measure.unit).meaning(measure.meaning)
        }));
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
        let measure = |measure: &MeasureColumn| flight.and_then(|it| (measure.value)(it));
        cells.extend(MEASURES.iter().map(|column| Cell::from(measure(column))));
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
