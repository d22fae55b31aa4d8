//! What a search found, for people and programs.

use fspid_diagnostics::digits::to_digits;
use fspid_optimise::Stop;
use fspid_page::columns::cut;
use fspid_scenario::requirement::Requirement;
use fspid_scenario::tuning::{Free, Over};
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use crate::error::TuneError;
use crate::limit::proved_percent;
use crate::problem::TuningProblem;
use crate::search::{Search, Trial, stop_in_words};
use crate::slopes::Counted;

/// How near to a bound a number counts as at it, as a share of the way between the bounds.
const AT_BOUND: f64 = 1e-3;
/// Least width of the first column of the answer.
const LEAST_WIDTH: usize = 40;
/// Most characters of a controller's name in a table.
const MOST_OF_NAME: usize = 24;
/// Most entries of a front that are told to people.
const MOST_OF_FRONT: usize = 20;

/// What a search found.
#[derive(Clone, Debug)]
pub struct Tuned {
    /// Name of the controller.
    pub controller: String,
    /// How it was searched.
    pub effort: crate::search::Effort,
    /// Why the search is over.
    pub stop: Stop,
    /// Candidates flown, the start not counted.
    pub spent: usize,
    /// Flights of a candidate.
    pub flights: usize,
    /// What a search by slopes has done beside flying candidates.
    pub counted: Option<Counted>,
    /// The start.
    pub start: Trial,
    /// The best candidate.
    pub best: Trial,
    /// What is wrong with flights of the best one; empty where all is well.
    pub reasons: Vec<String>,
    /// What is said of the best one's loop at rest, each once: its gains, and loads that it does not remove.
    pub at_rest: Vec<String>,
    /// Whether candidates had to remove a constant load.
    pub removes_constant_load: bool,
    /// The trade-offs, where a front was searched.
    pub front: Vec<Trial>,
    /// Volume of the front.
    pub front_volume: Option<f64>,
    /// The numbers that were free.
    pub numbers: Vec<Number>,
    objectives: Vec<(String, &'static str)>,
    limits: Vec<Requirement>,
    front_numbers: Vec<Vec<f64>>,
    over: Over,
}

/// A number that was free.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Number {
    /// Where it stands.
    pub path: String,
    /// What the search began from.
    pub start: f64,
    /// What was found.
    pub value: f64,
    /// Bounds; none for labels of rules.
    pub bounds: Option<[f64; 2]>,
    /// Whether it lies at one of its bounds.
    pub at_bound: bool,
}

impl Tuned {
    /// Of a search that is over; a best one that is not allowed is flown again for its reasons.
    ///
    /// # Errors
    /// [`TuneError::Stopped`], and others who could not fly.
    pub fn of(problem: &TuningProblem, search: &Search<'_>, stop: Stop) -> Result<Self, TuneError> {
        let (start, best) = (search.trials()[0].clone(), search.best().clone());
        let front: Vec<Trial> = search.front().into_iter().cloned().collect();
        let objectives = problem.tuning().objectives.iter().map(|objective| {
            let measure = objective.requirement.measure;
            (measure.name().to_owned(), measure.unit())
        });
        let mut reasons = match best.score.is_allowed() {
            true => Vec::new(),
            false => problem.reasons(&best.point, search.crew())?,
        };
        let limits = problem.tuning().limits.iter().zip(&best.score.limited);
        reasons.extend(limits.filter(|(limit, mean)| !limit.is_met_by(**mean)).map(
            |(limit, mean)| {
                let (name, limits) = (limit.measure.name(), limit.limits_in_words());
                format!("    mean over the flights: {name} {}, {limits}", shown(Some(*mean)))
            },
        ));
        Ok(Self {
            controller: problem.controller().to_owned(),
            effort: search.effort().clone(),
            stop,
            spent: search.spent(),
            flights: problem.flights(),
            counted: search.counted(),
            numbers: numbers(problem, &start, &best),
            front_numbers: front.iter().map(|it| problem.space().numbers(&it.point)).collect(),
            start,
            at_rest: problem.at_rest(&best.point),
            removes_constant_load: problem.removes_constant_load(),
            best,
            reasons,
            front,
            front_volume: search.front_volume(),
            objectives: objectives.collect(),
            limits: problem.tuning().limits.clone(),
            over: problem.tuning().over,
        })
    }

    /// True where every flight of the best candidate came back and met its requirements.
    #[must_use]
    pub fn is_allowed(&self) -> bool {
        self.best.score.is_allowed()
    }

    /// The answer for people.
    #[must_use]
    pub fn text(&self) -> String {
        let effort = &self.effort;
        let mut out = format!(
            "{}: {} with seed {}, {} candidates of {} flight{}; {}\n",
            self.controller,
            effort.optimiser,
            effort.seed,
            self.spent,
            self.flights,
            if self.flights == 1 { "" } else { "s" },
            stop_in_words(self.stop),
        );
        if let Some(counted) = &self.counted {
            out.push_str(&format!("  Of these, {}.\n", counted.in_words(self.flights)));
        }
        let width = self.width();
        let heading = self.over_in_words();
        out.push_str(&format!("\n  {heading:<width$}{:>14}{:>14}\n", "start", "found"));
        for (index, (name, unit)) in self.objectives.iter().enumerate() {
            let value = |trial: &Trial| shown(trial.score.values.get(index).copied());
            let name = if unit.is_empty() { name.clone() } else { format!("{name} [{unit}]") };
            out.push_str(&format!(
                "  {name:<width$}{:>14}{:>14}\n",
                value(&self.start),
                value(&self.best)
            ));
        }
        for (index, limit) in self.limits.iter().enumerate() {
            let value = |trial: &Trial| shown(trial.score.limited.get(index).copied());
            let name = format!("mean {}, {}", limit.measure.name(), limit.limits_in_words());
            let (start, found) = (value(&self.start), value(&self.best));
            out.push_str(&format!("  {name:<width$}{start:>14}{found:>14}\n"));
        }
        let cost = |trial: &Trial| match trial.score.is_allowed() {
            true => shown(Some(trial.score.cost)),
            false => "not allowed".to_owned(),
        };
        out.push_str(&format!(
            "  {:<width$}{:>14}{:>14}\n",
            "cost",
            cost(&self.start),
            cost(&self.best)
        ));
        self.tell_numbers(&mut out);
        self.tell_at_rest(&mut out);
        self.tell_front(&mut out);
        if !self.reasons.is_empty() {
            out.push_str("\nThe best candidate is not good enough:\n");
            self.reasons.iter().for_each(|reason| out.push_str(&format!("{reason}\n")));
        }
        out
    }

    /// The free numbers with their bounds.
    fn tell_numbers(&self, out: &mut String) {
        let width = self.width();
        out.push_str(&format!(
            "\n  {:<width$}{:>14}{:>14}  bounds\n",
            "free number", "start", "found"
        ));
        for number in &self.numbers {
            let (start, value) = (shown(Some(number.start)), shown(Some(number.value)));
            let bounds = number.bounds.map_or(String::new(), |[lower, upper]| {
                let note = if number.at_bound { "; the bound is active" } else { "" };
                let [lower, upper] = [lower, upper].map(|bound| shown(Some(bound)));
                format!("{lower} to {upper}{note}")
            });
            let name = short(&number.path, &self.controller);
            out.push_str(&format!("  {name:<width$}{start:>14}{value:>14}  {bounds}\n"));
        }
    }

    /// Several controllers that were tuned alike, side by side, each with how much of what is possible it reaches, %, where
    /// that is known.
    #[must_use]
    pub fn side_by_side(all: &[(&Self, Option<f64>)]) -> String {
        let Some((first, _)) = all.first() else {
            return String::new();
        };
        let (all, possible): (Vec<&Self>, Vec<Option<f64>>) = all.iter().copied().unzip();
        let names: Vec<String> = all.iter().map(|it| cut(&it.controller, MOST_OF_NAME)).collect();
        let width = names.iter().map(|name| name.chars().count()).max().unwrap_or(0).max(12) + 2;
        let row = |name: &str, cells: Vec<String>| {
            let cells: String = cells.iter().map(|cell| format!("{cell:>width$}")).collect();
            format!("  {name:<LEAST_WIDTH$}{cells}\n")
        };
        let mut out = String::from("\nSide by side, tuned alike\n");
        out.push_str(&row(&first.over_in_words(), names));
        for (index, (name, unit)) in first.objectives.iter().enumerate() {
            let name = if unit.is_empty() { name.clone() } else { format!("{name} [{unit}]") };
            let value = |it: &&Self| shown(it.best.score.values.get(index).copied());
            out.push_str(&row(&name, all.iter().map(value).collect()));
        }
        for (index, limit) in first.limits.iter().enumerate() {
            let name = format!("mean {}, {}", limit.measure.name(), limit.limits_in_words());
            let value = |it: &&Self| shown(it.best.score.limited.get(index).copied());
            out.push_str(&row(&name, all.iter().map(value).collect()));
        }
        let cost = |it: &&Self| match it.is_allowed() {
            true => shown(Some(it.best.score.cost)),
            false => "not allowed".to_owned(),
        };
        out.push_str(&row("cost", all.iter().map(cost).collect()));
        if possible.iter().any(Option::is_some) {
            let share = |it: Option<f64>| it.map_or("\u{2013}".to_owned(), proved_percent);
            let cells = possible.into_iter().map(share).collect();
            out.push_str(&row("of what is possible [%]", cells));
        }
        let numbers = |it: &&Self| it.numbers.len().to_string();
        out.push_str(&row("free numbers", all.iter().map(numbers).collect()));
        out.push_str(&row("candidates", all.iter().map(|it| it.spent.to_string()).collect()));
        out.push_str(
            "One tuning of each on the cases that it was tuned on: this names no winner; `fspid contest` judges on others.\n",
        );
        out
    }

    /// The loop at rest, and what was asked of it by default.
    fn tell_at_rest(&self, out: &mut String) {
        if !self.at_rest.is_empty() {
            out.push_str("\nAt rest:\n");
            self.at_rest.iter().for_each(|words| out.push_str(&format!("  {words}\n")));
        }
        if self.removes_constant_load {
            out.push_str(
                "\nEach candidate had to take off a constant load at the servo: at most half of its largest effect left at the end of the flight, nothing for good (tuning.constant_load = \"removed\", the default).\n",
            );
        }
    }

    fn tell_front(&self, out: &mut String) {
        let Some(volume) = self.front_volume else {
            return;
        };
        let names: Vec<&str> = self.objectives.iter().map(|(name, _)| name.as_str()).collect();
        out.push_str(&format!(
            "\n{} trade-offs, hypervolume {}; {}:\n",
            self.front.len(),
            shown(Some(volume)),
            names.join(", ")
        ));
        for trial in self.front.iter().take(MOST_OF_FRONT) {
            let values = trial.score.values.iter().map(|value| shown(Some(*value)));
            out.push_str(&format!("  {}\n", values.collect::<Vec<_>>().join(", ")));
        }
        if self.front.len() > MOST_OF_FRONT {
            out.push_str("  and more, in the history and the JSON\n");
        }
        out.push_str(match self.over {
            Over::Mean => "The design is the one with the least weighted sum.\n",
            // Each measure has a worst flight of its own, the cost has one.
            Over::Worst => "The design is the candidate with the least cost: the greatest weighted sum of a flight. Trade-offs tell the greatest of each measure by itself, so that another one may have less of their weighted sum, or the design not be among them.\n",
            Over::Tail { .. } => "The design is the candidate with the least cost: the mean of the greatest weighted sums of flights. Trade-offs tell the mean of the greatest of each measure by itself, so that another one may have less of their weighted sum, or the design not be among them.\n",
        });
    }

    /// Width of the first column of the answer.
    fn width(&self) -> usize {
        let short = |it: &Number| short(&it.path, &self.controller).chars().count();
        let names = self.numbers.iter().map(short);
        names.chain([LEAST_WIDTH]).max().unwrap_or(LEAST_WIDTH) + 1
    }

    fn over_in_words(&self) -> String {
        match self.over {
            Over::Mean => "mean over the flights".to_owned(),
            Over::Worst => "worst of the flights".to_owned(),
            Over::Tail { share } => {
                format!("mean over the worst {} % of the flights", 100.0 * share)
            }
        }
    }

    /// What a design says of itself in its first lines.
    #[must_use]
    pub fn heading(&self, command: &str) -> Vec<String> {
        let values: Vec<String> = self
            .objectives
            .iter()
            .zip(&self.best.score.values)
            .map(|((name, _), value)| format!("{name} {}", shown(Some(*value))))
            .collect();
        let mut lines = vec![
            format!("Controller \"{}\" was tuned by: {command}", self.controller),
            format!(
                "{} candidates, {}; {}: {}",
                self.spent,
                stop_in_words(self.stop),
                self.over_in_words(),
                values.join(", ")
            ),
        ];
        if !self.is_allowed() {
            lines.push("NOT GOOD ENOUGH: flights are lost or requirements are broken.".to_owned());
        }
        lines
    }

    /// The answer for programs.
    #[must_use]
    pub fn json(&self) -> Value {
        let effort = &self.effort;
        let score = |trial: &Trial| {
            json!({
                "cost": trial.score.is_allowed().then_some(trial.score.cost),
                "allowed": trial.score.is_allowed(),
                "violation": trial.score.violation,
                "objectives": trial.score.values,
                "limited": trial.score.limited,
            })
        };
        let front = self.front.iter().zip(&self.front_numbers).map(
            |(trial, numbers)| json!({ "objectives": trial.score.values, "parameters": numbers }),
        );
        json!({
            "schema": 1,
            "controller": self.controller,
            "optimiser": effort.optimiser,
            "budget": effort.budget,
            "seed": effort.seed,
            "candidates": self.spent,
            "flights_per_candidate": self.flights,
            "slopes": self.counted,
            "stop": self.stop,
            "measures": self.objectives.iter().map(|(name, _)| name).collect::<Vec<_>>(),
            "start": score(&self.start),
            "best": score(&self.best),
            "parameters": self.numbers,
            "front": self.front_volume.map(|_| front.collect::<Vec<_>>()),
            "hypervolume": self.front_volume,
            "constant_load": if self.removes_constant_load { "removed" } else { "ignored" },
            "at_rest": self.at_rest,
            "reasons": self.reasons.iter().map(|reason| reason.trim()).collect::<Vec<_>>(),
        })
    }
}

fn numbers(problem: &TuningProblem, start: &Trial, best: &Trial) -> Vec<Number> {
    let space = problem.space();
    let bounds = space.parameters().iter().flat_map(|mark| match &mark.free {
        Free::Number(number) => vec![Some([number.lower, number.upper])],
        Free::Grid(_) => vec![None; mark.dimensions()],
        Free::Numbers(numbers) => numbers.bounds().into_iter().map(Some).collect(),
    });
    let values = space.numbers(&start.point).into_iter().zip(space.numbers(&best.point));
    let rows = space.names().into_iter().zip(values).zip(bounds).zip(&best.point);
    rows.map(|(((path, (start, value)), bounds), unit)| {
        let is_at_end = !(AT_BOUND..=1.0 - AT_BOUND).contains(unit);
        Number { path, start, value, bounds, at_bound: bounds.is_some() && is_at_end }
    })
    .collect()
}

/// A path without the step to its controller.
fn short(path: &str, controller: &str) -> String {
    let prefixes = [format!("controller.{controller}."), format!("controller.\"{controller}\".")];
    let rest = prefixes.iter().find_map(|prefix| path.strip_prefix(prefix.as_str()));
    rest.unwrap_or(path).to_owned()
}

/// A number in five digits.
fn shown(value: Option<f64>) -> String {
    value.map_or("none".to_owned(), |value| to_digits(value, 5))
}
