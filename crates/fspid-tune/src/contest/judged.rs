//! All flights of a contest, and their means.

use std::cmp::Ordering;

use serde::Serialize;

use super::flight::{Flight, IAE, MEASURES, TRAVEL};
use super::tuning::Found;

/// A case that the controllers are judged on.
#[derive(Clone, Debug, PartialEq)]
pub struct Case {
    /// Its name.
    pub name: String,
    /// What kind of case it is; may be empty.
    pub group: String,
    /// What it changes.
    pub set: Vec<String>,
    /// How much it counts in means.
    pub weight: f64,
    /// How often each design flies it.
    pub runs: usize,
    /// Place of the case that it is the mirror image of.
    pub mirror_of: Option<usize>,
}

/// What was flown: what a tuning found, or a controller as it is written.
#[derive(Clone, Debug, PartialEq)]
pub struct Design {
    /// What was found; none for a controller that was not tuned.
    pub found: Option<Found>,
    /// Its flights, those of the first case first.
    pub flights: Vec<Flight>,
}

/// A controller with its designs.
#[derive(Clone, Debug, PartialEq)]
pub struct Contestant {
    /// Its name.
    pub name: String,
    /// Whether it has free numbers.
    pub is_tuned: bool,
    /// One for each seed; one alone if it was not tuned.
    pub designs: Vec<Design>,
}

/// All flights of a contest.
#[derive(Clone, Debug, PartialEq)]
pub struct Judged {
    /// The controllers, in the order of the scenario.
    pub contestants: Vec<Contestant>,
    /// The cases, in the order of the scenario.
    pub cases: Vec<Case>,
    /// Place of the controller that the others are compared with.
    pub against: usize,
}

/// What controllers are compared in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// A measure by its place in [`MEASURES`].
    Measure(usize),
    /// The cost that they were tuned for.
    Cost,
}

impl Quantity {
    /// Integral of the size of the error.
    pub const ERROR: Self = Self::Measure(IAE);
    /// Way of the elevator.
    pub const ACTIVITY: Self = Self::Measure(TRAVEL);

    /// Everything that has a mean.
    pub(crate) fn all() -> impl Iterator<Item = Self> {
        (0..MEASURES.len()).map(Self::Measure).chain([Self::Cost])
    }

    /// Name in files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Measure(index) => MEASURES.get(index).map_or("", |(name, _)| name),
            Self::Cost => "cost",
        }
    }

    /// Unit; empty for the cost.
    #[must_use]
    pub fn unit(self) -> &'static str {
        match self {
            Self::Measure(index) => MEASURES.get(index).map_or("", |(_, unit)| unit),
            Self::Cost => "",
        }
    }
}

/// Cases that are told together.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CaseGroup {
    /// Their name.
    pub name: String,
    /// Their places among all cases.
    pub cases: Vec<usize>,
}

/// How many flights are lost or fail, and how many there are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Count {
    /// Flights that are lost.
    pub lost: u64,
    /// Flights that fail: lost ones among them.
    pub failed: u64,
    /// Flights of a loop that is unstable at rest.
    pub unstable: u64,
    /// Flights of a loop that does not remove a constant load within the flight.
    #[serde(rename = "constant_load_left")]
    pub load_left: u64,
    /// Those of them of which it stays for good.
    #[serde(rename = "constant_load_stays")]
    pub load_stays: u64,
    /// All flights.
    pub of: u64,
}

impl Count {
    /// Share of the flights that is lost.
    pub(crate) fn lost_share(self) -> f64 {
        self.lost as f64 / self.of.max(1) as f64
    }

    /// Share of the flights that fails.
    pub(crate) fn failed_share(self) -> f64 {
        self.failed as f64 / self.of.max(1) as f64
    }

    /// Which of two controllers loses the larger share, without rounding.
    pub(crate) fn cmp_lost(self, other: Self) -> Ordering {
        self.compared(other, |it| it.lost)
    }

    /// Which of two controllers has the larger share of some flights, without rounding.
    pub(crate) fn compared(self, other: Self, some: fn(&Self) -> u64) -> Ordering {
        let crossed = |one: Self, other: Self| u128::from(some(&one)) * u128::from(other.of);
        crossed(self, other).cmp(&crossed(other, self))
    }
}

impl Judged {
    /// Whether a controller was tuned, and none more than once: then nobody knows what another seed would have found,
    /// and there is no winner.
    #[must_use]
    pub fn is_tuned_once(&self) -> bool {
        let tuned = || self.contestants.iter().filter(|it| it.is_tuned);
        tuned().next().is_some() && tuned().any(|it| it.designs.len() < 2)
    }

    /// Whether anybody was tuned.
    #[must_use]
    pub fn is_tuned(&self) -> bool {
        self.contestants.iter().any(|it| it.is_tuned)
    }

    /// Groups of cases in the order of their first case.
    #[must_use]
    pub fn groups(&self) -> Vec<CaseGroup> {
        let mut groups: Vec<CaseGroup> = Vec::new();
        for (index, case) in self.cases.iter().enumerate() {
            match groups.iter_mut().find(|group| group.name == case.group) {
                Some(group) => group.cases.push(index),
                None => groups.push(CaseGroup { name: case.group.clone(), cases: vec![index] }),
            }
        }
        groups
    }

    /// Places of all cases.
    pub(crate) fn all(&self) -> Vec<usize> {
        (0..self.cases.len()).collect()
    }

    /// Flights of a design on a case.
    #[must_use]
    pub fn flights<'a>(&self, design: &'a Design, case: usize) -> &'a [Flight] {
        let first: usize = self.cases.iter().take(case).map(|it| it.runs).sum();
        let runs = self.cases.get(case).map_or(0, |it| it.runs);
        design.flights.get(first..first + runs).unwrap_or_default()
    }

    /// Mean over the runs of a case; infinite where one is lost, none where nothing was asked.
    pub(crate) fn value(&self, design: &Design, case: usize, quantity: Quantity) -> Option<f64> {
        let of = |flight: &Flight| match quantity {
            Quantity::Measure(index) => flight.counted.get(index).copied().flatten(),
            Quantity::Cost => Some(flight.cost.unwrap_or(f64::INFINITY)),
        };
        let values: Vec<f64> = self.flights(design, case).iter().filter_map(of).collect();
        let count = values.len();
        (count > 0).then(|| values.into_iter().sum::<f64>() / count as f64)
    }

    /// Mean over some cases by their weights; infinite where a flight is lost.
    pub(crate) fn mean(&self, design: &Design, cases: &[usize], quantity: Quantity) -> Option<f64> {
        let (mut sum, mut whole) = (0.0, 0.0);
        for &case in cases {
            if let Some(value) = self.value(design, case, quantity) {
                let weight = self.cases[case].weight;
                sum += weight * value;
                whole += weight;
            }
        }
        (whole > 0.0).then(|| sum / whole)
    }

    /// Lost and failed flights of a controller on some cases, over all its designs.
    #[must_use]
    pub fn count(&self, contestant: &Contestant, cases: &[usize]) -> Count {
        let mut count = Count::default();
        for design in &contestant.designs {
            for flight in cases.iter().flat_map(|&case| self.flights(design, case)) {
                count.lost += u64::from(flight.lost);
                count.failed += u64::from(flight.failed);
                count.unstable += u64::from(flight.unstable);
                count.load_left += u64::from(flight.load_left);
                count.load_stays += u64::from(flight.load_stays);
                count.of += 1;
            }
        }
        count
    }

    /// The cases that nobody of some controllers lost a flight of.
    pub(crate) fn kept<'a>(
        &self,
        contestants: impl Iterator<Item = &'a Contestant> + Clone,
        cases: &[usize],
    ) -> Vec<usize> {
        let is_kept = |case: &usize| {
            let mut all = contestants.clone();
            all.all(|it| self.count(it, std::slice::from_ref(case)).lost == 0)
        };
        cases.iter().copied().filter(is_kept).collect()
    }

    /// The design that costs least on the training cases.
    #[must_use]
    pub fn best(contestant: &Contestant) -> usize {
        let cost = |design: &Design| {
            let found = design.found.as_ref();
            found.and_then(|it| it.cost).unwrap_or(f64::INFINITY)
        };
        let designs = contestant.designs.iter().enumerate();
        designs.min_by(|a, b| cost(a.1).total_cmp(&cost(b.1))).map_or(0, |(place, _)| place)
    }
}
