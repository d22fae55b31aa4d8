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
        // Nobody knows what a longer flight of one that is undecided at rest comes to.
        "good": result.verdict().is_good() && result.at_rest.undecided.is_none(),
    })
}

#[cfg(test)]
mod tests {
    use fspid_scenario::file;

    use super::*;

    /// An unstable plant under a load; a limit holds 10 deg of it.
    const LOADED: &str = include_str!("../../../fspid-study/tests/data/at_a_limit.toml");

    #[test]
    fn a_flight_that_is_undecided_at_rest_is_not_called_good() {
        let is_good = |load_deg: f64| {
            let set = [
                format!("disturbance[0].amplitude_deg={load_deg:?}"),
                "loop.duration_s=1.5".to_owned(),
            ];
            let study = file::parse(LOADED, "test.toml", None, &set).expect("a scenario");
            let simulation = Simulation::of(&study).expect("it flies");
            trace(&mut Answer::of(Value::Null), &simulation.results[0])["good"].clone()
        };
        assert_eq!((is_good(3.0), is_good(11.0)), (true.into(), false.into()));
    }
}
