//! The outcome of a contest: who stands where.

use serde_json::Value;

use super::compare::{Comparison, Standing, compared, compared_with};
use super::judged::{Judged, Quantity};
use super::summary::{Part, Summary};
use super::{json, text};
use crate::search::Effort;

/// Under which conditions a contest was held.
#[derive(Clone, Debug, PartialEq)]
pub struct Setting {
    /// Name of the scenario; may be empty.
    pub scenario: String,
    /// Its file, as commands name it.
    pub file: String,
    /// Changes from outside.
    pub overrides: Vec<String>,
    /// The folder that it is kept in, as commands name it.
    pub folder: String,
    /// Digest of the scenario.
    pub digest: String,
    /// How each controller was tuned; empty where none was.
    pub efforts: Vec<Effort>,
    /// Names of the training cases; empty for the scenario as written.
    pub training: Vec<String>,
    /// What the tuning made small, in words.
    pub objectives: Vec<String>,
    /// Limits of means over the training flights, in words.
    pub limits: Vec<String>,
    /// Draws of each training case; 0 for none.
    pub training_runs: u64,
    /// Draws of each case of the contest; 0 for none.
    pub runs: u64,
}

/// Who is first on some cases.
#[derive(Clone, Debug, PartialEq)]
pub struct First {
    /// Places of the controllers, the best first: fewest lost flights, then the smallest mean ratio of the error.
    pub ranking: Vec<usize>,
    /// Their mean ratios of the error to that of the controller compared with, in the order of the controllers; none
    /// where there are no cases that both flew.
    pub ratios: Vec<Option<f64>>,
}

/// The outcome of a contest.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    /// All flights.
    pub judged: Judged,
    /// How it was held.
    pub setting: Setting,
    /// What each controller came to.
    pub summaries: Vec<Summary>,
    /// Comparisons of the error integral; none where one is 0.
    pub error: Option<Vec<Comparison>>,
    /// Comparisons of the error integral of all others with the first of the ranking, who wins by these; none where one is 0.
    pub beside_first: Option<Vec<Comparison>>,
    /// Comparisons of the way of the elevator; none where one is 0.
    pub activity: Option<Vec<Comparison>>,
    /// Comparisons of the cost; none where one is not above 0, or without objectives.
    pub cost: Option<Vec<Comparison>>,
}

impl Outcome {
    pub(super) fn new(judged: Judged, setting: Setting) -> Self {
        let places = 0..judged.contestants.len();
        let summaries = places.map(|it| Summary::of(&judged, it)).collect();
        let cost =
            if setting.objectives.is_empty() { None } else { compared(&judged, Quantity::Cost) };
        let mut outcome = Self {
            summaries,
            error: compared(&judged, Quantity::ERROR),
            beside_first: None,
            activity: compared(&judged, Quantity::ACTIVITY),
            cost,
            judged,
            setting,
        };
        outcome.beside_first = match outcome.leader() {
            leader if leader == outcome.judged.against => outcome.error.clone(),
            leader => compared_with(&outcome.judged, Quantity::ERROR, leader),
        };
        outcome
    }

    /// Place of the controller that is first on all cases, who need not win.
    pub(super) fn leader(&self) -> usize {
        self.first().ranking.first().copied().unwrap_or(self.judged.against)
    }

    /// The comparison of a controller in the error.
    #[must_use]
    pub fn comparison(&self, contestant: usize) -> Option<&Comparison> {
        of(self.error.as_ref(), contestant)
    }

    /// The comparison of a controller in the way of the elevator.
    #[must_use]
    pub fn activity_of(&self, contestant: usize) -> Option<&Comparison> {
        of(self.activity.as_ref(), contestant)
    }

    /// How a controller stands against the one compared with; open for itself.
    #[must_use]
    pub fn standing(&self, contestant: usize) -> Standing {
        self.comparison(contestant).map_or(Standing::Open, |it| it.standing)
    }

    /// Who is first on all cases.
    #[must_use]
    pub fn first(&self) -> First {
        self.ranked(|it| &it.whole, |it| it.ratio.mean)
    }

    /// Who is first in a group of cases.
    #[must_use]
    pub fn first_of_group(&self, group: usize) -> First {
        self.ranked(|it| &it.groups[group], |it| it.groups.get(group)?.mean)
    }

    fn ranked<'a>(
        &'a self,
        part: impl Fn(&'a Summary) -> &'a Part,
        ratio: impl Fn(&'a Comparison) -> Option<f64>,
    ) -> First {
        let of = |place: usize| match place == self.judged.against {
            true => Some(1.0),
            false => self.comparison(place).and_then(&ratio),
        };
        let ratios: Vec<Option<f64>> = (0..self.judged.contestants.len()).map(of).collect();
        let lost = |place: usize| part(&self.summaries[place]).count.lost_share();
        let error = |place: usize| ratios[place].unwrap_or(f64::INFINITY);
        let mut ranking: Vec<usize> = (0..ratios.len()).collect();
        ranking.sort_by(|&a, &b| {
            lost(a).total_cmp(&lost(b)).then(error(a).total_cmp(&error(b))).then(a.cmp(&b))
        });
        First { ranking, ratios }
    }

    /// The answer for people.
    #[must_use]
    pub fn text(&self) -> String {
        text::text(self)
    }

    /// The answer for programs.
    #[must_use]
    pub fn json(&self) -> Value {
        json::json(self)
    }
}

fn of(comparisons: Option<&Vec<Comparison>>, contestant: usize) -> Option<&Comparison> {
    comparisons?.iter().find(|it| it.contestant == contestant)
}
