//! How the parameters were found: seeds, costs, evaluations, and what each seed answered.

use serde_json::{Value, json};

use super::Options;
use super::staged::SeedResult;
use fspid_optimise::Space;

/// What one seed found.
#[derive(Clone, Debug, PartialEq)]
pub struct SeedRecord {
    /// The seed.
    pub seed: u64,
    /// Cost reached.
    pub cost: f64,
    /// Evaluations spent.
    pub evaluations: usize,
    /// The parameters, in the problem's order.
    pub point: Vec<f64>,
}

/// One search problem.
#[derive(Clone, Debug, PartialEq)]
pub struct ProblemRecord {
    /// What was searched.
    pub name: String,
    /// Names of the parameters.
    pub parameters: Vec<String>,
    /// The seed whose answer is kept.
    pub kept: u64,
    /// All seeds.
    pub runs: Vec<SeedRecord>,
}

impl ProblemRecord {
    /// Lowest and highest value of each parameter over the seeds.
    #[must_use]
    pub fn spread(&self) -> Vec<(f64, f64)> {
        (0..self.parameters.len())
            .map(|index| {
                let values = self.runs.iter().filter_map(|run| run.point.get(index).copied());
                values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
                    (low.min(value), high.max(value))
                })
            })
            .collect()
    }
}

/// All search problems of an identification.
#[derive(Clone, Debug, PartialEq)]
pub struct Record {
    /// The command that repeats it.
    pub command: String,
    /// Every search.
    pub problems: Vec<ProblemRecord>,
}

impl Record {
    pub(super) fn new(options: Options) -> Self {
        Self { command: options.command(), problems: Vec::new() }
    }

    pub(super) fn push(&mut self, name: &str, space: &Space, runs: &[SeedResult], kept: u64) {
        self.problems.push(ProblemRecord {
            name: name.to_owned(),
            parameters: space.parameters().iter().map(|p| p.name.to_owned()).collect(),
            kept,
            runs: runs
                .iter()
                .map(|run| SeedRecord {
                    seed: run.seed,
                    cost: run.cost,
                    evaluations: run.evaluations,
                    point: run.point.clone(),
                })
                .collect(),
        });
    }

    /// The record as JSON.
    #[must_use]
    pub fn json(&self) -> Value {
        let problem = |problem: &ProblemRecord| {
            let run = |run: &SeedRecord| {
                json!({
                    "seed": run.seed,
                    "cost": run.cost,
                    "evaluations": run.evaluations,
                    "point": run.point,
                })
            };
            json!({
                "name": problem.name,
                "parameters": problem.parameters,
                "kept_seed": problem.kept,
                "runs": problem.runs.iter().map(run).collect::<Vec<_>>(),
            })
        };
        json!({
            "command": self.command,
            "problems": self.problems.iter().map(problem).collect::<Vec<_>>(),
        })
    }

    /// Reads a record that [`json`](Self::json) wrote; `None` for anything else.
    #[must_use]
    pub fn from_json(text: &str) -> Option<Self> {
        let value: Value = serde_json::from_str(text).ok()?;
        let run = |run: &Value| {
            Some(SeedRecord {
                seed: run["seed"].as_u64()?,
                cost: run["cost"].as_f64()?,
                evaluations: usize::try_from(run["evaluations"].as_u64()?).ok()?,
                point: run["point"].as_array()?.iter().map(Value::as_f64).collect::<Option<_>>()?,
            })
        };
        let problem = |problem: &Value| {
            let parameters = problem["parameters"].as_array()?;
            Some(ProblemRecord {
                name: problem["name"].as_str()?.to_owned(),
                parameters: parameters
                    .iter()
                    .map(|name| name.as_str().map(str::to_owned))
                    .collect::<Option<_>>()?,
                kept: problem["kept_seed"].as_u64()?,
                runs: problem["runs"].as_array()?.iter().map(run).collect::<Option<_>>()?,
            })
        };
        Some(Self {
            command: value["command"].as_str()?.to_owned(),
            problems: value["problems"].as_array()?.iter().map(problem).collect::<Option<_>>()?,
        })
    }
}
