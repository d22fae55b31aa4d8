//! A campaign ready to fly: what run *i* draws, and what comes of it.

use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};

use fspid_study::dispersion::{Dispersion, Distribution, Drawn};
use fspid_study::file::{NewValue, SettingPath, Study, Template};
use rayon::prelude::*;

use crate::engine::{self, Memory};
use crate::error::CampaignError;
use crate::plan::{Plan, Range};
use crate::rows::{Rows, Run};
use crate::sample::Cube;
use crate::table::Table;

/// A planned campaign with its scenario read.
#[derive(Clone, Debug)]
pub struct Campaign {
    plan: Plan,
    template: Template,
    cube: Cube,
    rows: Rows,
    /// The first coordinate of each dispersion.
    first: Vec<usize>,
    /// The number that stands in the scenario at each path of each dispersion, where draws are relative.
    nominal: Vec<Vec<f64>>,
}

/// How far a campaign is; may be read while it flies.
#[derive(Debug, Default)]
pub struct Progress {
    flown: AtomicU64,
    found: AtomicU64,
    failed: AtomicU64,
}

impl Progress {
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
        let dimensions = study.dispersions.iter().map(Dispersion::dimensions).sum();
        let cube = Cube::new(plan.sampling, dimensions, plan.runs, plan.seed)?;
        let rows = Rows::of(study)?;
        let nominal = template.check_dispersions().map_err(CampaignError::Scenario)?;
        let first = first_coordinates(&template.study().dispersions);
        Ok(Self { cube, rows, first, nominal, plan, template })
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

    /// How many numbers between 0 and 1 decide about a run.
    #[must_use]
    pub fn dimensions(&self) -> usize {
        self.template.study().dispersions.iter().map(Dispersion::dimensions).sum()
    }

    /// What a function says of the coordinates of each dispersion, in the order of the cube's.
    pub(crate) fn in_cube<T: Clone + Default>(&self, of: impl Fn(&Dispersion) -> Vec<T>) -> Vec<T> {
        let mut all = vec![T::default(); self.dimensions()];
        for (dispersion, &first) in self.template.study().dispersions.iter().zip(&self.first) {
            for (place, value) in all.iter_mut().skip(first).zip(of(dispersion)) {
                *place = value;
            }
        }
        all
    }

    /// What run `number` draws.
    #[must_use]
    pub fn drawn(&self, number: u64) -> Vec<Drawn> {
        let mut point = vec![0.0; self.dimensions()];
        self.cube.point(number, &mut point);
        self.drawn_at(&point)
    }

    /// What is drawn at a point of the unit cube.
    #[must_use]
    pub fn drawn_at(&self, point: &[f64]) -> Vec<Drawn> {
        let mut drawn = Vec::new();
        for (dispersion, &first) in self.template.study().dispersions.iter().zip(&self.first) {
            let mine = point.get(first..first + dispersion.dimensions()).unwrap_or_default();
            dispersion.draw(mine, &mut drawn);
        }
        drawn
    }

    /// The values that draws put into the scenario.
    #[must_use]
    pub fn values(&self, drawn: &[Drawn]) -> Vec<(&SettingPath, NewValue)> {
        let mut rest = drawn;
        let mut values = Vec::new();
        for (dispersion, nominal) in self.template.study().dispersions.iter().zip(&self.nominal) {
            let (mine, others) = rest.split_at(dispersion.names().count().min(rest.len()));
            rest = others;
            values.extend(dispersion.values(mine, nominal));
        }
        values
    }

    /// The scenario of a run.
    ///
    /// # Errors
    /// Why its numbers make no scenario.
    pub fn study(&self, drawn: &[Drawn]) -> Result<Study, String> {
        let built = self.template.with(&self.values(drawn));
        built.map_err(|problems| problems.first_in_a_line())
    }

    /// Flies some runs on all threads of the pool that this is called in.
    ///
    /// # Errors
    /// None where the runs are of this campaign.
    pub fn fly(&self, range: Range, progress: &Progress) -> Result<Table, CampaignError> {
        let at_once = engine::at_once(self.template.study()) as u64;
        let groups = (range.end.saturating_sub(range.first)).div_ceil(at_once);
        let fly = |memory: &mut Memory, group: u64| {
            let first = range.first + group * at_once;
            let numbers = first..(first + at_once).min(range.end);
            let drawn = numbers.map(|number| (number, self.drawn(number)));
            let runs = self.fly_with(memory, drawn);
            progress.add(&runs, self.rows.of_run());
            self.rows.table(&runs)
        };
        let tables: Vec<_> = (0..groups).into_par_iter().map_init(Memory::default, fly).collect();
        let mut whole = Table::new(std::sync::Arc::clone(self.rows.schema()));
        for table in tables {
            whole.append(&table?)?;
        }
        Ok(whole)
    }

    /// Flies a few runs side by side.
    pub fn fly_together(&self, drawn: impl Iterator<Item = (u64, Vec<Drawn>)>) -> Vec<Run> {
        self.fly_with(&mut Memory::default(), drawn)
    }

    fn fly_with(
        &self,
        memory: &mut Memory,
        drawn: impl Iterator<Item = (u64, Vec<Drawn>)>,
    ) -> Vec<Run> {
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
            run.flights = flights.map_err(|error| error.to_string());
        }
        runs
    }
}

/// The first coordinate of each dispersion. Seeds come last: the last dimensions of an even sequence
/// are its least even ones, and what a seed does with them nobody can tell.
fn first_coordinates(dispersions: &[Dispersion]) -> Vec<usize> {
    let is_seed = |dispersion: &Dispersion| matches!(dispersion.distribution, Distribution::Seed);
    let mut order: Vec<usize> = (0..dispersions.len()).collect();
    order.sort_by_key(|&index| is_seed(&dispersions[index]));
    let mut first = vec![0; dispersions.len()];
    let mut next = 0;
    for index in order {
        first[index] = next;
        next += dispersions[index].dimensions();
    }
    first
}
