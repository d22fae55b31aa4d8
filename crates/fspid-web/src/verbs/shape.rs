//! The supervisor of a controller: its sets as curves, its rules, and how often each of them is the strongest.

use fspid_core::{SelfTuner, SetCentres};
use fspid_fuzzy::{Label, Output, Supervisor};
use fspid_scenario::file::{paths_json, paths_of};
use fspid_sim::Controller;
use fspid_study::fuzzy_system::{RuleMarks, rule_marks};
use fspid_study::moment::{set_curves, visits};
use fspid_study::report::supervisor::odd_cells;
use serde_json::{Map, Value, json};

use super::Answered;
use super::open::path_of;
use crate::Answer;
use crate::question::{NAME, Question, wrong};

pub(super) fn shape(question: &Question) -> Answered {
    let (study, name) = (question.study()?, question.text("controller")?);
    let named = study.scenario.controllers.iter().find(|named| named.name == name);
    let Some(Controller::SelfTuning(fspid)) = named.map(|named| &named.controller) else {
        return Err(Answer::refused(format_args!("{name} has no supervisor")));
    };
    let rows = paths_of(question.text("text")?, NAME, None, &[]).map_err(|found| wrong(&found))?;
    let tuner = fspid.tuner();
    let mut answer = Answer::of(Value::Null);
    let curves = set_curves(tuner);
    let inputs = answer.keep(curves.inputs);
    let grades = curves.grades.map(|input| input.map(|grades| answer.keep(grades)));
    let table = path_of(name, &paths_json(&rows)).map(|path| format!("{path}.supervisor"));
    let named = rows
        .iter()
        .find(|row| Some(&row.path) == table.as_ref().map(|it| format!("{it}.table")).as_ref());
    answer.json = json!({
        "controller": name,
        "path": table,
        "named_table": named.and_then(|row| row.value.as_ref()),
        "range": tuner.supervisor().range(),
        "labels": Label::ALL.map(Label::name),
        "centres": centres(tuner),
        "rules": rules(tuner.supervisor()),
        "odd": odd(tuner.supervisor()),
        "audit": rule_marks(tuner.supervisor()).iter().map(RuleMarks::json).collect::<Vec<_>>(),
        "visits": visits(&study, name),
        "curves": { "inputs": inputs, "error": grades[0], "change": grades[1] },
    });
    Ok(answer)
}

/// Centres of the small and the medium sets as fractions of the range, and whether a file says them.
fn centres(tuner: &SelfTuner<f64>) -> Value {
    let sets = tuner.settings().input_sets;
    let one = |centres: Option<SetCentres<f64>>| match centres {
        Some(found) => json!({ "small": found.small(), "medium": found.medium(), "even": false }),
        None => json!({ "small": 1.0 / 3.0, "medium": 2.0 / 3.0, "even": true }),
    };
    json!({ "error": one(sets.error), "change": one(sets.change) })
}

/// The three grids, labels or numbers, by the keys that a file has for them; nothing in them for a network.
fn rules(supervisor: &Supervisor<f64>) -> Value {
    let table = supervisor.table();
    let grid = |output: Output| match (&table, supervisor.numbers()) {
        (Some(table), _) => {
            let grid = table.grid(output);
            let row = |error| Label::ALL.map(|change| grid.at(error, change).name());
            json!(Label::ALL.map(row))
        }
        (None, Some(numbers)) => json!(numbers.grid(output)),
        (None, None) => Value::Null,
    };
    let grids: Map<String, Value> =
        Output::ALL.into_iter().map(|output| (output.name().to_owned(), grid(output))).collect();
    let is_network = supervisor.network().is_some();
    json!({ "are_labels": table.is_some(), "is_network": is_network, "grids": grids })
}

/// Cells that break the symmetry of their grid.
fn odd(supervisor: &Supervisor<f64>) -> Vec<Value> {
    let cells = supervisor.table().map(|table| odd_cells(&table)).unwrap_or_default();
    let one = |cell: &fspid_study::report::supervisor::OddCell| {
        json!({
            "grid": cell.output.name(), "cell": [cell.at.0.index(), cell.at.1.index()],
            "opposite": [cell.opposite.0.index(), cell.opposite.1.index()],
        })
    };
    cells.iter().map(one).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use fspid_fuzzy::{Network, OutOfRange};

    #[test]
    fn a_network_says_that_it_is_one_and_has_no_cells_to_draw() {
        let network = Network::new([[0.5; 8]; 6]).expect("allowed");
        let supervisor = Supervisor::of_network(&network, 1.0, OutOfRange::Clamp).expect("allowed");
        let rules = rules(&supervisor);
        assert_eq!((&rules["is_network"], &rules["are_labels"]), (&json!(true), &json!(false)));
        assert_eq!(rules["grids"]["delta_kp"], Value::Null);
        assert!(odd(&supervisor).is_empty() && rule_marks(&supervisor).is_empty());
    }
}
