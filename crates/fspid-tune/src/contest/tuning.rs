//! One controller tuned with one seed, kept in the contest's folder.

use std::path::{Path, PathBuf};

use fspid_campaign::Plan;
use fspid_study::output;
use serde::{Deserialize, Serialize};

use crate::crew::Crew;
use crate::error::TuneError;
use crate::kept::{Kept, Then, Unfit};
use crate::problem::TuningProblem;
use crate::sealed;
use crate::search::{Effort, stop_in_words};
use crate::source::Source;
use crate::tuned::{Number, Tuned};

/// Version of what is kept.
const SCHEMA: u32 = 1;

/// What a tuning found.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Found {
    schema: u32,
    /// The program that searched.
    program: String,
    /// Digest of everything that decides what a candidate is worth.
    of: String,
    /// Name of the controller.
    pub controller: String,
    /// How it was searched.
    pub effort: Effort,
    /// Candidates flown, the start not counted.
    pub candidates: usize,
    /// Flights of a candidate.
    pub flights: usize,
    /// Why the search is over.
    pub stop: String,
    /// Cost on the training cases; none where no candidate was allowed.
    pub cost: Option<f64>,
    /// What is wrong with flights of the best candidate; empty where all is well.
    pub reasons: Vec<String>,
    /// The numbers that were free.
    pub numbers: Vec<Number>,
    /// The best candidate's place in the unit cube.
    pub(crate) point: Vec<f64>,
}

/// How far a search is.
#[derive(Clone, Debug, PartialEq)]
pub struct Progress {
    /// Name of the controller.
    pub controller: String,
    /// Seed of the search.
    pub seed: u64,
    /// Number of the search, from 1, and how many there are.
    pub search: (usize, usize),
    /// Candidates flown of this search, and how many there will be.
    pub candidates: (usize, usize),
    /// Whether it was found finished.
    pub was_there: bool,
}

/// A search that is asked for.
pub(crate) struct Task<'a> {
    pub(crate) source: &'a Source,
    pub(crate) problem: &'a TuningProblem,
    pub(crate) effort: Effort,
    /// Where its files lie, and what their names begin with.
    pub(crate) folder: &'a Path,
    pub(crate) stem: String,
    /// Its number and how many there are.
    pub(crate) search: (usize, usize),
}

impl Task<'_> {
    fn path(&self, ending: &str) -> PathBuf {
        self.folder.join(format!("{}.{ending}", self.stem))
    }

    /// What was found before, or is found now.
    ///
    /// # Errors
    /// A start without a cost, files that cannot be written, others who could not fly.
    pub(crate) fn done(
        &self,
        crew: Crew<'_>,
        tell: &mut dyn FnMut(&Progress) -> Then,
    ) -> Result<Found, TuneError> {
        if let Some(found) = self.kept()? {
            return match tell(&self.progress(found.candidates, true)) {
                Then::Stop => Err(TuneError::Stopped),
                _ => Ok(found),
            };
        }
        let mut place = Kept::at(Some(self.path("state.json")), Unfit::Replaced);
        let (mut search, _) = place.begun(self.problem, &self.effort, crew)?;
        let stop =
            place.search(&mut search, &mut |search| tell(&self.progress(search.spent(), false)))?;
        let tuned = Tuned::of(self.problem, &search, stop);
        let tuned = tuned.map_err(|error| place.left(&search, error))?;
        let found = self.found(&tuned);
        let heading =
            tuned.heading(&self.effort.command(self.source, Some(self.problem.controller())));
        let text = self.problem.design(&tuned.best.point, &heading)?;
        output::write(&self.path("toml"), text)?;
        output::write(&self.path("json"), sealed::text(&found))?;
        // A state that stays is not used again: what was found comes before it.
        let _ = place.remove();
        Ok(found)
    }

    /// What was found before, if it is of the same search.
    ///
    /// # Errors
    /// A file that is not what was written: whose design it is nobody knows.
    fn kept(&self) -> Result<Option<Found>, TuneError> {
        let path = self.path("json");
        if !path.exists() {
            return Ok(None);
        }
        match sealed::read_file(&path) {
            Ok(found) => Ok(Some(found).filter(|found| self.fits(found))),
            Err(TuneError::State { .. }) => Ok(None),
            Err(changed) => Err(changed),
        }
    }

    fn fits(&self, found: &Found) -> bool {
        let point = &found.point;
        found.schema == SCHEMA
            && found.program == Plan::this_program()
            && found.of == self.problem.digest()
            && found.effort == self.effort
            && point.len() == self.problem.space().dimension()
            && point.iter().all(|x| (0.0..=1.0).contains(x))
            && self.path("toml").exists()
    }

    fn progress(&self, spent: usize, was_there: bool) -> Progress {
        Progress {
            controller: self.problem.controller().to_owned(),
            seed: self.effort.seed,
            search: self.search,
            candidates: (spent, self.effort.budget),
            was_there,
        }
    }

    fn found(&self, tuned: &Tuned) -> Found {
        let best = &tuned.best;
        Found {
            schema: SCHEMA,
            program: Plan::this_program(),
            of: self.problem.digest(),
            controller: self.problem.controller().to_owned(),
            effort: self.effort.clone(),
            candidates: tuned.spent,
            flights: tuned.flights,
            stop: stop_in_words(tuned.stop).to_owned(),
            cost: best.score.is_allowed().then_some(best.score.cost).filter(|it| it.is_finite()),
            reasons: tuned.reasons.clone(),
            numbers: tuned.numbers.clone(),
            point: best.point.clone(),
        }
    }
}
