//! A fair contest: controllers that are tuned alike, judged on what none of them was tuned on.
//!
//! ```text
//! scenario ─the same budget, optimiser, objectives, seeds▶ designs ─cases of the contest▶ flights ─▶ who wins where
//! ```
//!
//! Controllers without marks fly as they are. What is found is kept in a folder, so that a contest that was
//! interrupted goes on with the same bits; threads do not show in it either.
//!
//! # What is said of differences
//! Flights of one case, and flights of one design, are not independent. Cases and designs are therefore the units that
//! are counted, never flights: [`TwoWay`] gives the error of a mean ratio with a part for cases and a part for
//! designs, [`SignedRank`] asks the cases alone without assuming a distribution. A difference is called significant
//! where both tests say so, after Holm's correction for the number of controllers compared.
//!
//! A flight is lost if it diverges, if its error grows beyond 90 deg, or if it cannot be flown. A loop that
//! is unstable at rest is measured as it flew, but its flight counts as failed, and who has one does not win. A lost flight has no error that could be averaged. It makes the mean of its design
//! infinite, its case ranks behind every case without, and a controller that loses more flights than another ranks
//! behind it and is never called better, whatever its error elsewhere; whether it is called worse is for the signed
//! ranks of the cases to say.

mod alike;
mod check;
mod compare;
mod flight;
mod headline;
mod json;
mod judged;
mod mirror;
mod near_limit;
#[cfg(test)]
mod oracle;
mod outcome;
mod page;
mod signed_rank;
mod student;
mod summary;
mod table;
mod text;
mod tuning;
mod twins;
mod two_way;
mod words;

use std::ops::Range;
use std::path::Path;

use fspid_campaign::Folder;
use fspid_campaign::engine::FlightResult;
use fspid_scenario::tuning::{Contest as Rules, Tuning};
use fspid_study::memory::Needed;
use fspid_study::output;

pub use crate::kept::Then;
pub(crate) use compare::{Bar, CONFIDENCE, barred};
pub use compare::{Comparison, Lost, Ratio, Standing};
#[cfg(test)]
pub(crate) use flight::OVERSHOOT;
pub(crate) use flight::measured;
pub use flight::{Flight, MEASURES};
pub use judged::{Case, CaseGroup, Contestant, Count, Design, Judged, Quantity};
pub use outcome::{First, Outcome, Setting};
pub use signed_rank::SignedRank;
pub(crate) use student::beyond;
pub use summary::{Mirror, Part, Spread, Summary};
pub use tuning::{Found, Progress};
pub use two_way::{TwoWay, holm};
pub(crate) use words::nothing_allowed;
pub(crate) use words::some_of;

use crate::crew::Crew;
use crate::error::TuneError;
use crate::flights::{Flights, Seeds, drawn_as, each_once};
use crate::problem::TuningProblem;
use crate::search::Effort;
use crate::source::{Source, in_commands};
use tuning::Task;

/// What can be chosen about a contest.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Options {
    /// How many seeds each controller is tuned with; by default as the scenario says.
    pub seeds: Option<u64>,
    /// Candidates of each tuning; by default as the scenario says.
    pub budget: Option<usize>,
}

/// A controller that takes part.
#[derive(Clone, Debug)]
struct Entrant {
    name: String,
    /// How it is tuned; none for one without marks.
    problem: Option<TuningProblem>,
    /// What it is judged on.
    flights: Flights,
}

/// A contest that can be held.
#[derive(Clone, Debug)]
pub struct Contest {
    source: Source,
    name: String,
    digest: String,
    tuning: Option<Tuning>,
    rules: Rules,
    efforts: Vec<Effort>,
    entrants: Vec<Entrant>,
    /// Place of the controller that the others are compared with.
    against: usize,
}

/// Names of the cases of a tuning, each with its flights of some designs.
type Training = Vec<(String, Vec<Vec<Flight>>)>;

/// The part of the folder in which designs lie.
const DESIGNS: &str = "designs";

impl Contest {
    /// Reads and checks a contest; nothing is flown.
    ///
    /// # Errors
    /// Everything that makes it none: fewer than two controllers, cases that were tuned on, cases that make the
    /// scenario wrong, a tuning that is none.
    pub fn new(source: &Source, options: &Options) -> Result<Self, TuneError> {
        check::checked(source, options)
    }

    /// What is allowed in the scenario and its cases and probably not meant, each once.
    #[must_use]
    pub fn warnings(&self) -> Vec<String> {
        let tuned = self.entrants.iter().filter_map(|entrant| entrant.problem.as_ref());
        let tuned: Vec<String> = tuned.flat_map(TuningProblem::warnings).collect();
        let judged = self.entrants.iter().flat_map(|entrant| entrant.flights.warnings());
        each_once(tuned.iter().chain(judged))
    }

    /// Memory that its flights hold at once on so many threads, with the cases of everybody.
    #[must_use]
    pub fn needed(&self, threads: usize) -> Needed {
        let tuned = self.entrants.iter().filter_map(|entrant| entrant.problem.as_ref());
        let tuned = tuned.map(|problem| problem.needed(threads));
        let judged = self.entrants.iter().map(|entrant| entrant.flights.needed(threads));
        tuned.chain(judged).fold(Needed::for_flights(0, threads), Needed::and)
    }

    /// How many tunings each controller has that is tuned.
    pub(crate) const fn seeds(&self) -> usize {
        self.efforts.len()
    }

    /// The controllers that are tuned, each with the candidates of all its tunings.
    pub fn searches(&self) -> impl Iterator<Item = (&str, usize)> {
        let candidates: usize = self.efforts.iter().map(|effort| effort.budget).sum();
        let tuned = self.entrants.iter().filter(|entrant| entrant.problem.is_some());
        tuned.map(move |entrant| (entrant.name.as_str(), candidates))
    }

    /// Flies the start of a controller's tuning so many times, for whoever wants to know how long a candidate takes.
    ///
    /// # Errors
    /// [`TuneError::Stopped`], and others who could not fly.
    pub fn rehearse(
        &self,
        controller: &str,
        candidates: usize,
        crew: Crew<'_>,
    ) -> Result<(), TuneError> {
        let entrant = self.entrants.iter().find(|entrant| entrant.name == controller);
        if let Some(problem) = entrant.and_then(|entrant| entrant.problem.as_ref()) {
            problem.scores_by(&vec![problem.space().start(); candidates], crew)?;
        }
        Ok(())
    }

    /// The flights that a controller is judged on.
    pub(crate) fn flights_of(&self, controller: &str) -> Option<&Flights> {
        let entrant = self.entrants.iter().find(|entrant| entrant.name == controller);
        entrant.map(|entrant| &entrant.flights)
    }

    /// Some flights that a controller is judged on, for whoever asks.
    pub(crate) fn block(
        &self,
        controller: &str,
        points: &[Vec<f64>],
        flights: Range<usize>,
    ) -> Result<Vec<Flight>, TuneError> {
        let Some(mine) = self.flights_of(controller) else {
            return Ok(Vec::new());
        };
        mine.block(points, flights, &|flight, s| self.read(flight, s), &|| false)
    }

    /// What is told of a flight.
    fn read(&self, flight: Result<&FlightResult, String>, duration_s: f64) -> Flight {
        let objectives =
            self.tuning.as_ref().map_or(&[][..], |tuning| tuning.objectives.as_slice());
        match flight {
            Ok(flight) => Flight::of(flight, objectives, duration_s),
            Err(reason) => Flight::refused(reason),
        }
    }

    /// Tunes what is to be tuned, judges all, and writes `contest.parquet`, `contest.json` and `contest.html` into
    /// the folder, designs below it. Designs that are there already are not searched again.
    ///
    /// `tell` is called before each generation and for each design that was there.
    ///
    /// # Errors
    /// Another process in the folder, a start without a cost, files that cannot be written, others who could not fly, or
    /// [`TuneError::Stopped`].
    pub fn hold(
        &self,
        folder: &Path,
        crew: Crew<'_>,
        tell: &mut dyn FnMut(&Progress) -> Then,
    ) -> Result<Outcome, TuneError> {
        let designs = folder.join(DESIGNS);
        output::make_folder(&designs)?;
        let _lock = Folder::new(folder).lock(true)?;
        let found = self.tuned(&designs, crew, tell)?;
        let judged = self.judged(found, crew)?;
        table::write(&folder.join("contest.parquet"), &judged, &self.digest)?;
        let outcome = Outcome::new(judged, self.setting(folder));
        output::write(&folder.join("contest.json"), format!("{:#}\n", outcome.json()))?;
        output::write(&folder.join("contest.html"), page::page(self, &outcome))?;
        Ok(outcome)
    }

    /// What each tuning found, a list for each controller.
    fn tuned(
        &self,
        folder: &Path,
        crew: Crew<'_>,
        tell: &mut dyn FnMut(&Progress) -> Then,
    ) -> Result<Vec<Vec<Found>>, TuneError> {
        let tuned = self.entrants.iter().filter(|it| it.problem.is_some()).count();
        let (mut number, all) = (0, tuned * self.efforts.len());
        let mut found = Vec::new();
        for (place, entrant) in self.entrants.iter().enumerate() {
            let mut mine = Vec::new();
            for effort in self.efforts.iter().filter(|_| entrant.problem.is_some()) {
                let Some(problem) = &entrant.problem else {
                    continue;
                };
                number += 1;
                let stem = format!("{}-{}-seed-{}", place + 1, bare(&entrant.name), effort.seed);
                let search = (number, all);
                let effort = effort.clone();
                let task = Task { source: &self.source, problem, effort, folder, stem, search };
                mine.push(task.done(crew, tell).map_err(|error| of_entrant(error, &entrant.name))?);
            }
            found.push(mine);
        }
        Ok(found)
    }

    /// All designs flown on all cases.
    fn judged(&self, found: Vec<Vec<Found>>, crew: Crew<'_>) -> Result<Judged, TuneError> {
        let contestants = self.entrants.iter().zip(found).map(|(entrant, found)| {
            let is_tuned = entrant.problem.is_some();
            let found: Vec<Option<Found>> = match is_tuned {
                true => found.into_iter().map(Some).collect(),
                false => vec![None],
            };
            let point = |it: &Option<Found>| it.as_ref().map_or(Vec::new(), |it| it.point.clone());
            let points: Vec<Vec<f64>> = found.iter().map(point).collect();
            let flown = entrant.flights.flown(&points, &|flight, s| self.read(flight, s), crew)?;
            let designs = found.into_iter().zip(flown);
            Ok(Contestant {
                name: entrant.name.clone(),
                is_tuned,
                designs: designs.map(|(found, flights)| Design { found, flights }).collect(),
            })
        });
        let contestants = contestants.collect::<Result<_, TuneError>>()?;
        let judged = Judged::new(contestants, self.cases(), self.against);
        let mut judged = judged;
        for (place, entrant) in self.entrants.iter().enumerate() {
            if let (Some(problem), Some(contestant)) =
                (&entrant.problem, judged.contestants.get(place))
            {
                let training = self.trained(problem, &contestant.designs)?;
                judged.trained_on(place, &training);
            }
        }
        Ok(judged)
    }

    /// The flights of the tuning's cases by the designs of one who was tuned: a judged case that it flies as one of them was
    /// tuned on, however it is written.
    fn trained(&self, problem: &TuningProblem, designs: &[Design]) -> Result<Training, TuneError> {
        let found = designs.iter().filter_map(|design| design.found.as_ref());
        let points: Vec<Vec<f64>> = found.map(|found| found.point.clone()).collect();
        let flights = problem.its_flights();
        let flown =
            flights.flown(&points, &|flight, s| self.read(flight, s), Crew::Here(&|| false))?;
        let mut from = 0;
        let cases = flights.cases().iter().map(|case| {
            let of_case = from..from + case.runs();
            from = of_case.end;
            let mine =
                flown.iter().map(|all| all.get(of_case.clone()).unwrap_or_default().to_vec());
            (case.name.clone(), mine.collect())
        });
        Ok(cases.collect())
    }

    fn cases(&self) -> Vec<Case> {
        let runs = |case: usize| {
            let first = self.entrants.first();
            first.and_then(|it| it.flights.cases().get(case)).map_or(0, |it| it.runs())
        };
        let place = |name: &String| self.rules.cases.iter().position(|it| it.name == *name);
        let cases = self.rules.cases.iter().enumerate().map(|(index, case)| Case {
            name: case.name.clone(),
            group: case.group.clone(),
            set: case.set.clone(),
            weight: case.weight,
            runs: runs(index),
            draws_seed: (self.rules.runs > 0)
                .then(|| Seeds::OfEach(self.rules.run_seed).of(Some(drawn_as(case)))),
            mirror_of: case.mirror_of.as_ref().and_then(place),
        });
        cases.collect()
    }

    fn setting(&self, folder: &Path) -> Setting {
        let training = self.tuning.as_ref().map(|it| it.cases.as_slice()).unwrap_or_default();
        Setting {
            scenario: self.name.clone(),
            file: in_commands(&self.source.path),
            overrides: self.source.overrides.clone(),
            folder: in_commands(folder),
            digest: self.digest.clone(),
            efforts: self.efforts.clone(),
            training: training.iter().map(|case| case.name.clone()).collect(),
            objectives: self.tuning.as_ref().map_or(Vec::new(), words::objectives),
            limits: self.tuning.as_ref().map_or(Vec::new(), words::limits),
            training_runs: self.tuning.as_ref().map_or(0, |it| it.runs),
            runs: self.rules.runs,
        }
    }
}

/// A name as part of a file's name.
fn bare(name: &str) -> String {
    let kept = |c: char| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '-' };
    let text: String = name.chars().map(kept).take(40).collect();
    let words: Vec<&str> = text.split('-').filter(|word| !word.is_empty()).collect();
    words.join("-")
}

fn of_entrant(error: TuneError, controller: &str) -> TuneError {
    match error {
        TuneError::Stopped
        | TuneError::Engine { .. }
        | TuneError::Output(_)
        | TuneError::History(_) => error,
        reason => {
            TuneError::Entrant { controller: controller.to_owned(), reason: Box::new(reason) }
        }
    }
}
