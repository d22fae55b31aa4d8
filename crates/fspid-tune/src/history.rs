//! Every candidate of a search as a row of a Parquet file.

use std::path::Path;
use std::sync::Arc;

use fspid_campaign::table::{Cell, Column, ColumnTable, Kind, Schema, Writer};
use fspid_study::output;

use crate::error::TuneError;
use crate::problem::TuningProblem;
use crate::search::Search;

/// Key of the metadata that names the search.
pub const SEARCH_KEY: &str = "fspid.search";

/// Writes the candidates of a search, the start first, whole or not at all.
///
/// # Errors
/// A file that cannot be written.
pub fn write(path: &Path, problem: &TuningProblem, search: &Search<'_>) -> Result<(), TuneError> {
    let table = table(problem, search)?;
    let effort = search.effort();
    let name = format!(
        "{}; optimiser {}, budget {}, seed {}",
        problem.digest(),
        effort.optimiser,
        effort.budget,
        effort.seed
    );
    let metadata = vec![(SEARCH_KEY.to_owned(), name)];
    let written = output::write_by(path, |file| {
        let mut writer = Writer::new(file, table.schema(), &metadata)?;
        writer.write(&table)?;
        writer.finish(&[])?;
        Ok::<_, TuneError>(())
    });
    written.map_err(|error| error.of_writing(path))
}

/// The candidates of a search as rows.
///
/// # Errors
/// Two coordinates of the same name.
pub fn table(problem: &TuningProblem, search: &Search<'_>) -> Result<ColumnTable, TuneError> {
    let mut table = ColumnTable::new(Arc::new(schema(problem)?));
    for (number, trial) in search.trials().iter().enumerate() {
        let score = &trial.score;
        let mut row = vec![
            Cell::Integer(number as i64),
            Cell::Integer(trial.generation as i64),
            Cell::Float(score.cost),
            Cell::Boolean(score.is_allowed()),
            Cell::Float(score.violation),
        ];
        let count = problem.tuning().objectives.len();
        row.extend(
            (0..count).map(|at| score.values.get(at).map_or(Cell::Absent, |it| Cell::Float(*it))),
        );
        let limits = problem.tuning().limits.len();
        row.extend(
            (0..limits).map(|at| score.limited.get(at).map_or(Cell::Absent, |it| Cell::Float(*it))),
        );
        row.extend(problem.space().numbers(&trial.point).into_iter().map(Cell::Float));
        table.push(&row)?;
    }
    Ok(table)
}

fn schema(problem: &TuningProblem) -> Result<Schema, TuneError> {
    let mut columns = vec![
        Column::new("candidate", Kind::Integer).meaning("number of the candidate; 0 is the start"),
        Column::new("generation", Kind::Integer)
            .meaning("generation of the optimiser; 0 is the start"),
        Column::new("cost", Kind::Float)
            .meaning("what the search makes small; 1e12 and more where requirements are broken"),
        Column::new("allowed", Kind::Boolean)
            .meaning("every flight came back and met its requirements"),
        Column::new("violation", Kind::Float)
            .meaning("how far requirements are broken, on average over the flights"),
    ];
    for (index, objective) in problem.tuning().objectives.iter().enumerate() {
        let measure = objective.requirement.measure;
        let name = format!("objective.{index}.{}", measure.name());
        columns.push(Column::new(name, Kind::Float).unit(measure.unit()).meaning(measure.doc()));
    }
    for (index, limit) in problem.tuning().limits.iter().enumerate() {
        let name = format!("limit.{index}.{}", limit.measure.name());
        columns.push(
            Column::new(name, Kind::Float).unit(limit.measure.unit()).meaning(limit.measure.doc()),
        );
    }
    let parameter = |name: String| Column::new(format!("parameter.{name}"), Kind::Float);
    columns.extend(problem.space().names().into_iter().map(parameter));
    Ok(Schema::new(columns)?)
}
