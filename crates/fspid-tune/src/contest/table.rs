//! Every flight of a contest as a row of a Parquet file.

use std::path::Path;
use std::sync::Arc;

use fspid_campaign::table::{Cell, Column, ColumnTable, Kind, MAX_TEXT_BYTES, Schema, Writer};
use fspid_study::output;

use super::flight::{FAILED, Flight, LOST, MEASURES};
use super::judged::Judged;
use crate::error::TuneError;

/// Key of the metadata that names the scenario.
const SCENARIO_KEY: &str = "fspid.scenario";

/// Writes all flights: controllers, designs, cases, runs.
///
/// # Errors
/// A file that cannot be written.
pub(super) fn write(path: &Path, judged: &Judged, digest: &str) -> Result<(), TuneError> {
    let table = table(judged)?;
    let metadata = vec![(SCENARIO_KEY.to_owned(), digest.to_owned())];
    let written = output::write_by(path, |file| {
        let mut writer = Writer::new(file, table.schema(), &metadata)?;
        writer.write(&table)?;
        writer.finish(&[])?;
        Ok::<_, TuneError>(())
    });
    written.map_err(|error| error.of_writing(path))
}

fn table(judged: &Judged) -> Result<ColumnTable, TuneError> {
    let mut table = ColumnTable::new(Arc::new(schema()?));
    for contestant in &judged.contestants {
        for design in &contestant.designs {
            let seed = design.found.as_ref().map(|found| found.effort.seed as i64);
            for (place, case) in judged.cases.iter().enumerate() {
                for (run, flight) in judged.flights(design, place).iter().enumerate() {
                    let head = [
                        Cell::Text(short(&contestant.name)),
                        seed.map_or(Cell::Absent, Cell::Integer),
                        Cell::Text(short(&case.name)),
                        Cell::Text(short(&case.group)),
                        Cell::Integer(run as i64),
                    ];
                    push(&mut table, &head, flight)?;
                }
            }
        }
    }
    Ok(table)
}

fn push(table: &mut ColumnTable, head: &[Cell<'_>], flight: &Flight) -> Result<(), TuneError> {
    let number = |value: Option<f64>| value.map_or(Cell::Absent, Cell::Float);
    let reasons = flight.reasons.join("; ");
    let mut row = head.to_vec();
    row.extend([
        Cell::Text(short(&flight.verdict)),
        Cell::Boolean(flight.lost),
        Cell::Boolean(flight.unstable),
        Cell::Boolean(flight.undecided),
        Cell::Boolean(flight.failed),
        if reasons.is_empty() { Cell::Absent } else { Cell::Text(short(&reasons)) },
        number(flight.cost),
    ]);
    row.extend(flight.measures.iter().map(|value| number(*value)));
    table.push(&row)?;
    Ok(())
}

/// As much of a text as a cell holds.
fn short(text: &str) -> &str {
    text.get(..text.floor_char_boundary(MAX_TEXT_BYTES)).unwrap_or(text)
}

fn schema() -> Result<Schema, TuneError> {
    let column = Column::new;
    let mut columns = vec![
        column("controller", Kind::Text).meaning("name of the controller"),
        column("seed", Kind::Integer)
            .meaning("seed that it was tuned with; empty for one that was not tuned"),
        column("case", Kind::Text).meaning("name of the case"),
        column("group", Kind::Text).meaning("group of the case"),
        column("run", Kind::Integer).meaning("number of the draw within the case, from 0"),
        column("verdict", Kind::Text).meaning("verdict on the flight"),
        column("lost", Kind::Boolean)
            .meaning(format!("it {LOST}")),
        column("unstable", Kind::Boolean).meaning(
            "the loop is unstable at rest, with the gains that it has there; such a flight counts as failed",
        ),
        column("undecided", Kind::Boolean)
            .meaning("nobody can tell whether the loop is stable, at rest or where its flight leads"),
        column("failed", Kind::Boolean).meaning(format!("it {FAILED}")),
        column("reasons", Kind::Text).meaning("why it failed or has no cost"),
        column("cost", Kind::Float)
            .meaning("what the objectives of the tuning cost; empty for a lost flight"),
    ];
    let measures = MEASURES.map(|it| Column::new(it.name(), Kind::Float).unit(it.unit()));
    columns.extend(measures);
    Ok(Schema::new(columns)?)
}
