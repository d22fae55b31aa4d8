//! What the audit says of single cells of a supervisor's rules, for who edits them: holes, and steps that go the wrong way.
//!
//! Labels are the audit's own findings. Numbers have no labels that could be put in order, so that they are compared
//! themselves, by the same rule: along each input most steps go one way, and those that go the other way are exceptions.

use fspid_fuzzy::audit::{Direction, GridAudit, rule_base};
use fspid_fuzzy::system::{Parts, System};
use fspid_fuzzy::{LABEL_COUNT, Output, Supervisor};
use serde_json::{Value, json};

/// A cell: places of the labels of the error and of its change.
type Cell = [usize; 2];

/// How a gain's rules go along one input, the other held.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Along {
    /// `error` or `change`.
    pub input: &'static str,
    /// Where most steps go.
    pub direction: Direction,
    /// Steps that were compared.
    pub steps: usize,
    /// Neighbours that go the other way, the one with the lower label of the input first.
    pub exceptions: Vec<[Cell; 2]>,
}

/// What is true of the cells of one gain.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RuleMarks {
    /// Which gain.
    pub output: Output,
    /// How many cells there are.
    pub cells: usize,
    /// Cells without a rule.
    pub holes: Vec<Cell>,
    /// Along the error and along its change.
    pub along: [Along; 2],
}

/// The marks of each gain's rules; nothing for a network, which has none.
#[must_use]
pub fn rule_marks(supervisor: &Supervisor<f64>) -> Vec<RuleMarks> {
    let Ok(parts) = Parts::try_from(supervisor) else { return Vec::new() };
    let Ok(system) = System::new(parts) else { return Vec::new() };
    let rules = rule_base(&system).outputs.into_iter();
    let grids = rules.zip(Output::ALL).filter_map(|(rules, output)| Some((output, rules.grid?)));
    grids.map(|(output, grid)| of_grid(supervisor, output, &grid)).collect()
}

fn of_grid(supervisor: &Supervisor<f64>, output: Output, grid: &GridAudit) -> RuleMarks {
    let audited = |input: usize| {
        let axis = grid.labels.as_ref()?.along.get(input)?;
        let exceptions = axis.exceptions.iter();
        let pairs =
            exceptions.filter_map(|pair| Some([cell(&pair.cells[0])?, cell(&pair.cells[1])?]));
        Some((axis.direction, axis.neighbours, pairs.collect()))
    };
    let along = ["error", "change"].map(|name| {
        let input = usize::from(name == "change");
        let found = match supervisor.numbers() {
            Some(numbers) => Some(compared(numbers.grid(output), input)),
            None => audited(input),
        };
        let (direction, steps, exceptions) = found.unwrap_or((Direction::Constant, 0, Vec::new()));
        Along { input: name, direction, steps, exceptions }
    });
    let holes = grid.holes.iter().filter_map(|it| cell(it)).collect();
    RuleMarks { output, cells: grid.cells, holes, along }
}

fn cell(places: &[usize]) -> Option<Cell> {
    places.try_into().ok()
}

/// How numbers go along an input: where most steps go, how many there are, and those that go the other way.
fn compared(
    numbers: &[[f64; LABEL_COUNT]; LABEL_COUNT],
    input: usize,
) -> (Direction, usize, Vec<[Cell; 2]>) {
    let mut steps = Vec::new();
    for lower in 0..LABEL_COUNT - 1 {
        for other in 0..LABEL_COUNT {
            let pair =
                [lower, lower + 1].map(|at| if input == 0 { [at, other] } else { [other, at] });
            let [from, to] = pair.map(|[error, change]| numbers[error][change]);
            steps.push((pair, to - from));
        }
    }
    let count = |sign: f64| steps.iter().filter(|(_, step)| step * sign > 0.0).count();
    let (rises, falls) = (count(1.0), count(-1.0));
    let (direction, against) = match (rises, falls) {
        (0, 0) => (Direction::Constant, 0.0),
        _ if rises >= falls => (Direction::Rising, -1.0),
        _ => (Direction::Falling, 1.0),
    };
    let exceptions = steps.iter().filter(|(_, step)| step * against > 0.0).map(|(pair, _)| *pair);
    (direction, steps.len(), exceptions.collect())
}

impl Along {
    /// In a clause: "falls along error but for 3 of 42 steps".
    #[must_use]
    pub fn words(&self) -> String {
        let way = match self.direction {
            Direction::Constant if self.steps == 0 => {
                return format!("is not compared along {}", self.input);
            }
            Direction::Constant => return format!("stays as it is along {}", self.input),
            Direction::Rising => "rises",
            Direction::Falling => "falls",
        };
        let but = match self.exceptions.len() {
            0 => "without exception".to_owned(),
            count => format!("but for {count} of {} steps", self.steps),
        };
        format!("{way} along {} {but}", self.input)
    }
}

impl RuleMarks {
    /// In a sentence.
    #[must_use]
    pub fn words(&self) -> String {
        let holes = match self.holes.len() {
            0 => format!("each of the {} cells has a rule", self.cells),
            count => format!("{count} of {} cells have no rule", self.cells),
        };
        let [error, change] = self.along.each_ref().map(Along::words);
        format!("{holes}; {error}, {change}")
    }

    /// For programs.
    #[must_use]
    pub fn json(&self) -> Value {
        let along = self.along.iter().map(
            |it| json!({ "input": it.input, "words": it.words(), "exceptions": it.exceptions }),
        );
        json!({
            "grid": self.output.name(), "words": self.words(), "holes": self.holes,
            "along": along.collect::<Vec<_>>(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fspid_fuzzy::{Defuzzifier, Label, OutOfRange, RuleTable};
    use fspid_scenario::file::rule_table;

    fn supervisor(table: &RuleTable) -> Supervisor<f64> {
        Supervisor::new(table, 5.0, Defuzzifier::Exact, OutOfRange::Clamp).expect("a supervisor")
    }

    #[test]
    fn numbers_are_compared_as_the_audit_compares_labels() {
        for name in ["printed", "mirrored"] {
            let table = rule_table(name).expect("shipped");
            for found in rule_marks(&supervisor(&table)) {
                let grid = table.grid(found.output);
                let place = |error, change| grid.at(error, change).index() as f64;
                let numbers = Label::ALL.map(|error| Label::ALL.map(|change| place(error, change)));
                for (input, along) in found.along.iter().enumerate() {
                    let (direction, steps, mut exceptions) = compared(&numbers, input);
                    exceptions.sort_unstable();
                    let mut audited = along.exceptions.clone();
                    audited.sort_unstable();
                    assert_eq!((direction, steps), (along.direction, along.steps), "{name}");
                    assert_eq!(exceptions, audited, "{name}");
                }
            }
        }
    }

    #[test]
    fn a_shipped_table_has_no_hole_and_kp_falls_along_both_inputs() {
        let marks = rule_marks(&supervisor(&rule_table("printed").expect("shipped")));
        assert_eq!(marks.len(), 3);
        assert!(marks.iter().all(|it| it.holes.is_empty() && it.cells == 49));
        assert_eq!(
            marks[0].words(),
            "each of the 49 cells has a rule; falls along error without exception, falls along change without exception"
        );
        assert!(marks[2].along.iter().any(|it| !it.exceptions.is_empty()), "{}", marks[2].words());
    }
}
