//! All flights of a contest, and their means.

use std::cmp::Ordering;

use serde::Serialize;

use super::alike;
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
    /// Of which seed a campaign with the changes of the case draws the same aircraft; none where nothing is drawn.
    pub draws_seed: Option<u64>,
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

impl Contestant {
    /// How many of its tunings found nothing that was allowed, of how many.
    #[must_use]
    pub fn not_allowed(&self) -> [usize; 2] {
        let found = || self.designs.iter().filter_map(|it| it.found.as_ref());
        [found().filter(|it| it.cost.is_none()).count(), found().count()]
    }
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
    /// Of each case the place of an earlier one that everybody has flown alike, if there is one: it is no evidence
    /// of its own, such as one that moves a limit which never acts. Two controllers may fly more cases alike.
    pub twin_of: Vec<Option<usize>>,
    /// Of each controller and case the name of one of the tuning that it flies alike, if there is one; empty
    /// of a controller that was not tuned.
    pub trained_as: Vec<Vec<Option<Trained>>>,
}

/// A case of the tuning that a controller flies as one of the contest.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Trained {
    /// Its name.
    pub case: String,
    /// It is flown in another size, as a linear loop flies a step of another size: who is linear was tuned on it, and it is no
    /// evidence where everybody who was tuned is.
    pub in_another_size: bool,
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
            Self::Measure(index) => MEASURES.get(index).map_or("", |it| it.name()),
            Self::Cost => "cost",
        }
    }

    /// Unit; empty for the cost.
    #[must_use]
    pub fn unit(self) -> &'static str {
        match self {
            Self::Measure(index) => MEASURES.get(index).map_or("", |it| it.unit()),
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
    /// Flights of a loop of which nobody can tell whether it is stable.
    pub undecided: u64,
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

    /// Flights of loops that are not known to be stable.
    pub(crate) const fn not_stable(self) -> u64 {
        self.unstable + self.undecided
    }

    /// Which of two controllers loses the larger share, without rounding.
    pub(crate) fn cmp_lost(self, other: Self) -> Ordering {
        self.compared(other, |it| it.lost)
    }

    /// Which of two controllers has the larger share of some flights, without rounding.
    pub(crate) fn compared(self, other: Self, some: fn(Self) -> u64) -> Ordering {
        let crossed = |one: Self, other: Self| u128::from(some(one)) * u128::from(other.of);
        crossed(self, other).cmp(&crossed(other, self))
    }
}

impl Contestant {
    /// Designs that differ: seeds that find the same numbers are one tuning.
    pub(crate) fn tunings(&self) -> usize {
        let found = self.designs.iter().filter_map(|design| design.found.as_ref());
        let bits = found.map(|it| it.point.iter().map(|value| value.to_bits()).collect());
        let mut all: Vec<Vec<u64>> = bits.collect();
        let written = self.designs.len() - all.len();
        all.sort();
        all.dedup();
        written + all.len()
    }
}

impl Judged {
    /// All flights of the contestants; which cases are flown alike is found here.
    pub(crate) fn new(contestants: Vec<Contestant>, cases: Vec<Case>, against: usize) -> Self {
        let trained_as = vec![Vec::new(); contestants.len()];
        let mut judged = Self { contestants, cases, against, twin_of: Vec::new(), trained_as };
        judged.twin_of = alike::twins(&judged, &judged.contestants.iter().collect::<Vec<_>>());
        judged
    }

    /// Notes which cases a controller was tuned on: `training` has those of the tuning by their names, each with its flights
    /// by the designs of that controller.
    pub(crate) fn trained_on(
        &mut self,
        contestant: usize,
        training: &[(String, Vec<Vec<Flight>>)],
    ) {
        let designs = self.contestants.get(contestant).map_or(&[][..], |it| &it.designs);
        let alike = |case: usize| {
            let found = training.iter().filter_map(|(name, flights)| {
                let [mine, theirs] = self.beside(designs, case, flights)?;
                let is_same = mine.iter().zip(&theirs).all(|(a, b)| a.has_measures_of(b));
                let is_one = is_same || alike::are_in_another_size(&mine, &theirs);
                is_one.then(|| Trained { case: name.clone(), in_another_size: !is_same })
            });
            found.min_by_key(|it| it.in_another_size)
        };
        let trained_as: Vec<Option<Trained>> = (0..self.cases.len()).map(alike).collect();
        if let Some(mine) = self.trained_as.get_mut(contestant) {
            *mine = trained_as;
        }
    }

    /// The flights of a case by some designs, and others of theirs, one by one; none where there are more of one.
    fn beside<'a>(
        &self,
        designs: &'a [Design],
        case: usize,
        others: &'a [Vec<Flight>],
    ) -> Option<[Vec<&'a Flight>; 2]> {
        let mine: Vec<&[Flight]> = designs.iter().map(|it| self.flights(it, case)).collect();
        let are_as_many = mine.iter().map(|it| it.len()).eq(others.iter().map(Vec::len));
        are_as_many
            .then(|| [mine.into_iter().flatten().collect(), others.iter().flatten().collect()])
    }

    /// The name of a case of the tuning that somebody flies as a case of the contest, or everybody who was tuned in another size.
    pub(crate) fn trained_name(&self, case: usize) -> Option<&str> {
        let everybody: Vec<usize> = (0..self.contestants.len()).collect();
        self.trained_among(&everybody, case).map(|it| it.case.as_str())
    }

    /// The same of some controllers by their places.
    fn trained_among(&self, places: &[usize], case: usize) -> Option<&Trained> {
        let all = places.iter().filter_map(|place| self.trained_as.get(*place));
        let tuned: Vec<Option<&Trained>> =
            all.filter_map(|it| it.get(case)).map(Option::as_ref).collect();
        let mut found = tuned.iter().flatten();
        let everybody_is = tuned.iter().all(Option::is_some);
        found.find(|it| everybody_is || !it.in_another_size).copied()
    }

    /// Cases that are evidence: those that everybody flies as an earlier one, or somebody as one of the tuning, are not.
    pub(crate) fn evidence(&self) -> Vec<usize> {
        let is_own = |case: &usize| {
            self.twin_of.get(*case).is_none_or(Option::is_none)
                && self.trained_name(*case).is_none()
        };
        self.all().into_iter().filter(is_own).collect()
    }

    /// Cases that are evidence between some controllers by their places, whatever others make of them.
    pub(crate) fn evidence_between(&self, places: &[usize]) -> Vec<usize> {
        let some = places.iter().filter_map(|place| self.contestants.get(*place));
        let twin_of = alike::twins(self, &some.collect::<Vec<_>>());
        let is_trained = |case: usize| self.trained_among(places, case).is_some();
        let is_own = |case: &usize| twin_of[*case].is_none() && !is_trained(*case);
        self.all().into_iter().filter(is_own).collect()
    }

    /// Whether a controller was tuned, and one of them not more than once, or to the same numbers each time: then nobody knows
    /// what another tuning would have found, and there is no winner.
    #[must_use]
    pub fn is_tuned_once(&self) -> bool {
        let mut tuned = self.contestants.iter().filter(|it| it.is_tuned);
        tuned.any(|it| it.tunings() < 2)
    }

    /// Whether that is so although every controller was tuned with several seeds: one of them finds the same with each.
    pub(crate) fn has_idle_seeds(&self) -> bool {
        let mut tuned = self.contestants.iter().filter(|it| it.is_tuned);
        self.is_tuned_once() && tuned.all(|it| it.designs.len() > 1)
    }

    /// Whether there is a controller of which several seeds found a design each.
    pub(crate) fn has_several_designs(&self) -> bool {
        self.contestants.iter().any(|it| it.designs.len() > 1)
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
                count.undecided += u64::from(flight.undecided);
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
