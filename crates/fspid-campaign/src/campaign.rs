//! A campaign ready to fly: what run *i* draws, and what comes of it.

use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use fspid_scenario::dispersion::Drawn;
use fspid_scenario::file::{Study, Template};
use rayon::prelude::*;

use crate::draws::Draws;
use crate::engine::{self, Memory};
use crate::error::CampaignError;
use crate::plan::Plan;
use crate::range::Range;
use crate::rows::{Rows, Run};
use crate::table::ColumnTable;

/// A planned campaign with its scenario read.
#[derive(Clone, Debug)]
pub struct Campaign {
    plan: Plan,
    template: Template,
    draws: Draws,
    rows: Rows,
}

/// How far a campaign is; may be read while it flies.
#[derive(Debug, Default)]
pub struct Progress {
    flown: AtomicU64,
    found: AtomicU64,
    failed: AtomicU64,
    stopped: AtomicBool,
}

impl Progress {
    /// Asks the campaign to stop: what is flown just now is lost, shards that are written stay.
    pub fn stop(&self) {
        self.stopped.store(true, Ordering::Relaxed);
    }

    pub(crate) fn is_stopped(&self) -> bool {
        self.stopped.load(Ordering::Relaxed)
    }

    /// Runs flown so far.
    #[must_use]
    pub fn flown(&self) -> u64 {
        self.flown.load(Ordering::Relaxed)
    }

    /// Runs that had been flown before.
    #[must_use]
    pub fn found(&self) -> u64 {
        self.found.load(Ordering::Relaxed)
    }

    /// Flights that failed so far, of those flown now.
    #[must_use]
    pub fn failed(&self) -> u64 {
        self.failed.load(Ordering::Relaxed)
    }

    pub(crate) fn add_found(&self, runs: u64) {
        self.found.fetch_add(runs, Ordering::Relaxed);
    }

    pub(crate) fn add_flown(&self, runs: u64) {
        self.flown.fetch_add(runs, Ordering::Relaxed);
    }

    fn add(&self, runs: &[Run], controllers: usize) {
        let failed = |run: &Run| match &run.flights {
            Ok(flights) => flights.iter().filter(|flight| flight.is_failed()).count(),
            Err(_) => controllers,
        };
        let failed: usize = runs.iter().map(failed).sum();
        self.flown.fetch_add(runs.len() as u64, Ordering::Relaxed);
        self.failed.fetch_add(failed as u64, Ordering::Relaxed);
    }
}

impl Campaign {
    /// Reads the scenario of a plan that lies in `folder`, and checks what it disperses.
    ///
    /// # Errors
    /// A scenario that is wrong, that disperses nothing, or that its dispersions make wrong.
    pub fn new(plan: Plan, folder: &Path) -> Result<Self, CampaignError> {
        let template = plan.template(folder)?;
        Self::of_template(plan, template)
    }

    /// As [`new`](Self::new), of a scenario that is read already.
    ///
    /// # Errors
    /// As there.
    pub fn of_template(plan: Plan, template: Template) -> Result<Self, CampaignError> {
        let study = template.study();
        if study.dispersions.is_empty() {
            return Err(CampaignError::NothingDispersed { path: plan.scenario_path });
        }
        let rows = Rows::of(study)?;
        let draws = Draws::new(&template, plan.sampling, plan.runs, plan.seed)?;
        Ok(Self { draws, rows, plan, template })
    }

    /// The plan.
    #[must_use]
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// The scenario.
    #[must_use]
    pub fn template(&self) -> &Template {
        &self.template
    }

    /// The rows that flights leave.
    #[must_use]
    pub fn rows(&self) -> &Rows {
        &self.rows
    }

    /// What its runs draw.
    #[must_use]
    pub fn draws(&self) -> &Draws {
        &self.draws
    }

    /// What run `number` draws.
    #[must_use]
    pub fn drawn(&self, number: u64) -> Vec<Drawn> {
        self.draws.drawn(number)
    }

    /// The scenario of a run.
    ///
    /// # Errors
    /// Why its numbers make no scenario.
    pub fn study(&self, drawn: &[Drawn]) -> Result<Study, String> {
        let built = self.template.with(&self.draws.values(drawn));
        built.map_err(|problems| problems.first_in_a_line())
    }

    /// Flies some runs on all threads of the pool that this is called in.
    ///
    /// # Errors
    /// [`CampaignError::Stopped`] where it was asked to, and a machine that cannot start external controllers; no other where
    /// the runs are of this campaign.
    pub fn fly(&self, range: Range, progress: &Progress) -> Result<ColumnTable, CampaignError> {
        let at_once = engine::at_once(self.template.study()) as u64;
        let groups = (range.end.saturating_sub(range.first)).div_ceil(at_once);
        let fly = |memory: &mut Memory, group: u64| {
            if progress.is_stopped() {
                return Err(CampaignError::Stopped);
            }
            let first = range.first + group * at_once;
            let numbers = first..(first + at_once).min(range.end);
            let drawn = numbers.map(|number| (number, self.drawn(number)));
            let runs = self.fly_with(memory, drawn)?;
            progress.add(&runs, self.rows.of_run());
            Ok(self.rows.table(&runs)?)
        };
        let tables: Vec<Result<ColumnTable, CampaignError>> =
            (0..groups).into_par_iter().map_init(Memory::default, fly).collect();
        let mut whole = ColumnTable::new(std::sync::Arc::clone(self.rows.schema()));
        for table in tables {
            whole.append(&table?)?;
        }
        Ok(whole)
    }

    /// Flies a few runs side by side.
    ///
    /// # Errors
    /// A machine that cannot start external controllers: that is no row of theirs.
    pub fn fly_together(
        &self,
        drawn: impl Iterator<Item = (u64, Vec<Drawn>)>,
    ) -> Result<Vec<Run>, CampaignError> {
        self.fly_with(&mut Memory::default(), drawn)
    }

    fn fly_with(
        &self,
        memory: &mut Memory,
        drawn: impl Iterator<Item = (u64, Vec<Drawn>)>,
    ) -> Result<Vec<Run>, CampaignError> {
        let mut runs = Vec::new();
        let mut studies = Vec::new();
        for (number, drawn) in drawn {
            let flights = match self.study(&drawn) {
                Ok(study) => {
                    studies.push(study);
                    Ok(Vec::new())
                }
                Err(reason) => Err(reason),
            };
            runs.push(Run { number, drawn, flights });
        }
        let flown = engine::fly_with(memory, &studies);
        let waiting = runs.iter_mut().filter(|run| run.flights.is_ok());
        for (run, flights) in waiting.zip(flown) {
            run.flights = match flights {
                Err(error) if error.is_of_host() => return Err(error.into()),
                flights => flights.map_err(|error| error.to_string()),
            };
        }
        Ok(runs)
    }
}
