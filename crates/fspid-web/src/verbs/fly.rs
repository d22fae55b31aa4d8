//! A flight: measures, verdicts, requirements, and its traces as columns.

use fspid_study::simulation::{ControllerResult, Simulation};
use serde_json::{Value, json};

use super::Answered;
use crate::Answer;
use crate::question::Question;

/// The answer of `simulate --format json`, and the columns of its CSV.
pub(super) fn fly(question: &Question) -> Answered {
    let study = question.study()?;
    let simulation = Simulation::of(&study).map_err(Answer::refused)?;
    let mut answer = Answer::of(Value::Null);
    let traces = simulation.results.iter().map(|result| trace(&mut answer, result));
    let traces: Vec<Value> = traces.collect();
    answer.json = json!({
        "simulation": simulation.json(),
        "met": simulation.requirements_met(),
        "failed": !simulation.failed_flights().is_empty(),
        "traces": traces,
    });
    Ok(answer)
}

fn trace(answer: &mut Answer, result: &ControllerResult) -> Value {
    let columns = result.columns().into_iter();
    let columns = columns.map(|(name, values)| json!({ "name": name, "at": answer.keep(values) }));
    json!({
        "name": result.name,
        "columns": columns.collect::<Vec<_>>(),
        "notes": result.notes(),
        "good": result.verdict().is_good(),
    })
}
