//! Does a self-tuner adapt, or does it only answer the moment? The same flights again, with something else in the place of
//! the supervisor's gains.
//!
//! ```text
//! flights as they are ─gains, inputs▶ means, shuffles ─the same flights▶ what each is worth ─▶ shares of the win
//! ```
//!
//! # Shares
//! From the controller that is compared with to the self-tuner as it is, one thing is put in after the other: its fixed
//! numbers without a supervisor; the mean of its gains over all flights; at each moment the mean of the gains that the same
//! flight has on other plants, which knows command, disturbance and time, but not the plant; and at last its own gains.
//! Only what these still add is adaptation to the plant. The differences of the logarithms of the IAE add up to the whole
//! win, so that each has a share of it. What is put in earlier takes what later things could have done as well; the order is
//! that of how much has to be known.
//!
//! # What is no win
//! Who wins is held to what a contest holds its winner to: where a flight as it is, or of the one compared with, is of a loop
//! that is unstable at rest or of which nobody can tell, or where the self-tuner fails more flights, its error says nothing.
//!
//! # How sure
//! A plant is an aircraft at a condition with its actuator, however it is written: plants whose flights are alike with either
//! of them, to a millionth of their size at every sample, are one. Flights of one plant are not independent, least of all steps
//! up and down of a linear one; so plants that have a flight in the win are left out with all their flights, in at most twenty
//! parts, one after the other, and the flights of the others that go by gains of all or of other plants are flown again without
//! them (a jackknife: Busing, Meijer and van der Leeden 1999). Seeds of the shuffles are left out one by one. Intervals are
//! Student's, of 95 %, and of shares Fieller's, of which there are none where the whole may be nothing.

mod answer;
mod barred;
mod best;
mod draws;
mod flown;
mod json;
mod means;
mod page;
mod plants;
mod text;
mod trace;
mod treatment;

use std::sync::atomic::AtomicUsize;

use fspid_campaign::engine::{Judging, Memory, Stability};
use fspid_core::Gains;
use fspid_scenario::count::{BUDGET, RUNS, SEEDS};
use fspid_scenario::file::{Study, known_words};
use fspid_scenario::tuning::Case;
use fspid_sim::Controller;
use fspid_study::memory::Needed;
use rayon::prelude::*;

pub use answer::{Answer, Followed, Following, Moved, PlantRow, Row, Step};
pub use draws::Estimate;
pub use flown::Watch;
pub use treatment::Treatment;

use crate::crew::Part;
use crate::error::TuneError;
use crate::flights::{Asked, Dispersed, Flights, FlownCase, Seeds, each_once, flown_cases};
use crate::flyer::Flyer;
use crate::source::Source;
use crate::space::Space;
use barred::{Contested, Flier};
use best::Best;
use draws::Parts;
use flown::{First, Schedules, Treated, Value, Values};
use plants::Plants;

/// What can be chosen.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Options {
    /// The self-tuner; the first one by default.
    pub controller: Option<String>,
    /// The controller that it is compared with; by default that of the contest, or the first with fixed gains.
    pub against: Option<String>,
    /// How often time is shuffled.
    pub seeds: u64,
    /// The first of the seeds, of all random numbers but the draws of dispersions that a contest or a tuning says the seed of.
    pub seed: u64,
    /// Candidates of the search for the best gains of each plant.
    pub budget: usize,
    /// Draws of the dispersions in each case; by default as the contest or the tuning says.
    pub runs: Option<u64>,
}

impl Default for Options {
    fn default() -> Self {
        Self { controller: None, against: None, seeds: 5, seed: 1, budget: 240, runs: None }
    }
}

/// An experiment that can be made.
#[derive(Clone, Debug)]
pub struct Adaptation {
    source: Source,
    options: Options,
    name: String,
    digest: String,
    controller: String,
    against: Option<String>,
    flights: Flights,
    theirs: Option<Flights>,
}

/// Flights whose gains are in memory together.
const AT_ONCE: usize = 256;

/// What is known of all flights when they are treated.
#[derive(Clone, Copy)]
struct Known<'a> {
    firsts: &'a [First],
    plants: &'a Plants,
    schedules: &'a Schedules,
}

/// A flight with everything in the place of the supervisor that needs no other plant; as it is; and of the other controller.
struct Stood {
    values: Values,
    as_it_is: Contested,
    other: Option<Contested>,
}

/// A controller with those of its flights that it has.
fn flier<'a>(name: &str, flown: impl Iterator<Item = Option<&'a Contested>>) -> Flier {
    let mut flier = Flier { name: name.to_owned(), ..Flier::default() };
    for Contested { value, flight, .. } in flown.flatten() {
        flier.values.push(*value);
        flier.flights.push(flight.clone());
    }
    flier
}

/// A flight: its case and the number of its run.
type Job<'a> = (&'a FlownCase, usize);

impl Adaptation {
    /// Reads and checks; nothing is flown. The flights are the cases of the contest, else those of the tuning, else the
    /// scenario as it is written.
    ///
    /// # Errors
    /// Everything that is wrong with the scenario or a case; no self-tuner; counts beyond their limits.
    pub fn new(source: &Source, options: &Options) -> Result<Self, TuneError> {
        SEEDS.check(options.seeds)?;
        BUDGET.check(options.budget)?;
        options.runs.map_or(Ok(()), |runs| RUNS.check(runs))?;
        let template = source.template()?;
        let study = template.study();
        let controller = self_tuner(study, options.controller.as_deref())?;
        let against = compared_with(study, options.against.as_deref(), &controller)?;
        let (cases, dispersed) = cases(study, options);
        let flights = |controller: &str| {
            // Marks fly as they start.
            let cases = flown_cases(source, Flyer { controller, free: &[] }, cases, dispersed)?;
            let judging = Judging { stability: Stability::AsFlown, loads: false };
            let asked = Asked { controller: controller.to_owned(), part: Part::Judging, judging };
            Ok::<_, TuneError>(Flights::new(asked, Space::new(Vec::new()), cases, Vec::new()))
        };
        Ok(Self {
            flights: flights(&controller)?,
            theirs: against.as_deref().map(flights).transpose()?,
            source: source.clone(),
            options: options.clone(),
            name: study.scenario.name.clone(),
            digest: study.digest.clone(),
            controller,
            against,
        })
    }

    /// Memory that its flights hold at once on so many threads.
    #[must_use]
    pub fn needed(&self, threads: usize) -> Needed {
        let theirs = self.theirs.iter().map(|flights| flights.needed(threads));
        theirs.fold(self.flights.needed(threads), Needed::and)
    }

    /// What is allowed in the scenario and its cases and probably not meant, each once.
    #[must_use]
    pub fn warnings(&self) -> Vec<String> {
        each_once(self.flights.warnings())
    }

    /// About how many flights it takes.
    #[must_use]
    pub fn expected(&self) -> usize {
        let drawn = Treatment::DRAWN.len() * usize::try_from(self.options.seeds).unwrap_or(0);
        // Without each part of the plants two flights more; nobody knows yet how many plants there are.
        let left = Treatment::OF_OTHERS.len() * draws::most_parts(self.flights.count());
        // Also to tell plants apart, and for the gains of others.
        self.flights.count() * (12 + drawn + left + self.options.budget)
    }

    /// Makes it, on all threads of the pool that this is called in. The same bits on any number of them.
    ///
    /// # Errors
    /// [`TuneError::Stopped`]; a case that cannot be flown.
    pub fn measured(&self, watch: Watch<'_>) -> Result<Answer, TuneError> {
        let jobs: Vec<Job<'_>> = self.flights.jobs().collect();
        let firsts = self.firsts(&jobs, watch)?;
        let plants = Plants::of(&firsts, |flight, other| {
            flown::with_plant_of(self.study(jobs[flight])?, self.study(jobs[other])?, watch)
        })?;
        let nobody = Parts::of(&vec![false; plants.count()]);
        let schedules = self.schedules(&jobs, (&firsts, &plants), &nobody, watch)?;
        let known = Known { firsts: &firsts, plants: &plants, schedules: &schedules };
        let stood: Vec<Stood> = jobs
            .par_iter()
            .enumerate()
            .map_init(Memory::default, |memory, (number, job)| {
                self.treated(memory, (number, *job), known, watch)
            })
            .collect::<Result<_, _>>()?;
        let best: Vec<Option<Best>> = (0..plants.count())
            .into_par_iter()
            .map(|plant| self.best(plant, &jobs, &stood, &plants, watch))
            .collect::<Result<_, _>>()?;
        let barred = self.barred(&stood);
        let mut values: Vec<Values> = stood.into_iter().map(|it| it.values).collect();
        for (plant, best) in best.iter().enumerate() {
            let mine = plants.flown(plant, &firsts);
            for (place, value) in mine.zip(best.iter().flat_map(|best| &best.values)) {
                values[place][Treatment::PlantTuned.place()] = vec![*value];
            }
        }
        let parts = Parts::of(&means::in_the_win(&values, &plants.of, plants.count()));
        let left = self.left(&jobs, (&firsts, &plants), &parts, watch)?;
        let treated = values.into_iter().zip(left).map(|(values, left)| Treated { values, left });
        let treated: Vec<Treated> = treated.collect();
        let named = jobs.iter().map(|(case, _)| case.name.clone()).collect();
        let answer = answer::answer(self, named, (&firsts, &plants, &parts), &treated, &best);
        Ok(answer.barred_by(barred))
    }

    /// Why nothing is won, if it is not, whatever the errors are.
    fn barred(&self, stood: &[Stood]) -> Option<String> {
        let own = stood.iter().map(|it| Some(&it.as_it_is));
        let own = flier(&self.controller, own);
        let against = self.against.as_deref();
        barred::bar(own, against.map(|name| flier(name, stood.iter().map(|it| it.other.as_ref()))))
    }

    /// All flights as they are.
    fn firsts(&self, jobs: &[Job<'_>], watch: Watch<'_>) -> Result<Vec<First>, TuneError> {
        jobs.par_iter().map(|job| Ok(flown::first(&self.study(*job)?, watch)?.0)).collect()
    }

    /// What gains the flights have at each moment that are not lost, by signals, plants and their parts.
    fn schedules(
        &self,
        jobs: &[Job<'_>],
        (firsts, plants): (&[First], &Plants),
        parts: &Parts,
        watch: Watch<'_>,
    ) -> Result<Schedules, TuneError> {
        let mut schedules = Schedules::of(firsts, &plants.of);
        for (some, place) in jobs.chunks(AT_ONCE).zip((0..).step_by(AT_ONCE)) {
            let flown = some.par_iter().map(|job| flown::first(&self.study(*job)?, watch));
            let flown = flown.collect::<Result<Vec<_>, TuneError>>()?;
            for ((first, gains), plant) in flown.iter().zip(&plants.of[place..]) {
                if !first.lost {
                    schedules.add(&first.signals, (*plant, parts.part(*plant)), gains);
                }
            }
        }
        Ok(schedules)
    }

    /// What depends on other plants, without each part of them; of plants that are in the win alone.
    fn left(
        &self,
        jobs: &[Job<'_>],
        (firsts, plants): (&[First], &Plants),
        parts: &Parts,
        watch: Watch<'_>,
    ) -> Result<Vec<Vec<[Option<Value>; 2]>>, TuneError> {
        if parts.count() == 0 {
            return Ok(vec![Vec::new(); jobs.len()]);
        }
        let schedules = self.schedules(jobs, (firsts, plants), parts, watch)?;
        let without = plants.without(firsts, parts);
        let left = |memory: &mut Memory, (job, plant): (&Job<'_>, &usize)| {
            let Some(part) = parts.part(*plant) else { return Ok(Vec::new()) };
            let study = self.study(*job)?;
            let standing = flown::standing(memory, &study, &without, watch)?;
            let of = (*plant, part, parts.count());
            let others = flown::without_parts(&study, of, &schedules, watch)?;
            Ok(standing.into_iter().map(Some).zip(others).map(<[_; 2]>::from).collect())
        };
        jobs.par_iter().zip(&plants.of).map_init(Memory::default, left).collect()
    }

    fn study(&self, (case, run): Job<'_>) -> Result<Study, TuneError> {
        self.flights.study(&[], case, run).map_err(|reason| TuneError::Engine { reason })
    }

    fn treated(
        &self,
        memory: &mut Memory,
        (number, job): (usize, Job<'_>),
        Known { firsts, plants, schedules }: Known<'_>,
        watch: Watch<'_>,
    ) -> Result<Stood, TuneError> {
        let study = self.study(job)?;
        let other = self.theirs.as_ref().map(|theirs| {
            let (case, run) = theirs.jobs().nth(number).ok_or("nobody flies".to_owned())?;
            theirs.study(&[], case, run)
        });
        let other = other.transpose().map_err(|reason| TuneError::Engine { reason })?;
        let nominal = flown::tuner(&study).map_or(Gains::ZERO, |it| it.tuner().nominal());
        let plant = plants.of.get(number).copied().unwrap_or(0);
        let means = [
            (Treatment::Nominal, nominal),
            (Treatment::ClassMean, plants.all),
            (Treatment::PlantMean, plants.means.get(plant).copied().unwrap_or(nominal)),
            (Treatment::FlightMean, firsts.get(number).map_or(nominal, First::mean)),
        ];
        let as_it_is = Contested::of(memory, &study, watch)?;
        let other = other.map(|other| Contested::of(memory, &other, watch)).transpose()?;
        let mut values = Values::default();
        values[Treatment::AsItIs.place()] = vec![as_it_is.value];
        values[Treatment::Against.place()].extend(other.as_ref().map(|it| it.value));
        let gains = means.map(|(_, gains)| gains);
        let standing = flown::standing(memory, &study, &gains, watch)?;
        for ((treatment, _), value) in means.iter().zip(standing) {
            values[treatment.place()] = vec![value];
        }
        let seeds = (self.options.seed, self.options.seeds);
        let again = flown::replayed(&study, (number, plant), schedules, seeds, watch)?;
        for treatment in Treatment::DRAWN.into_iter().chain([Treatment::OtherPlants]) {
            values[treatment.place()].clone_from(&again[treatment.place()]);
        }
        Ok(Stood { values, as_it_is, other })
    }

    fn best(
        &self,
        plant: usize,
        jobs: &[Job<'_>],
        stood: &[Stood],
        plants: &Plants,
        watch: Watch<'_>,
    ) -> Result<Option<Best>, TuneError> {
        let mine = jobs.iter().zip(stood).zip(&plants.of).filter(|(_, of)| **of == plant);
        let mut asked = Vec::new();
        for ((job, Stood { as_it_is: Contested { value, result, .. }, .. }), _) in mine {
            // What is lost as it is has nothing to be compared with; the places are those of `Plants::flown`.
            if let Some(as_it_is) = result.clone().filter(|_| !value.lost) {
                asked.push(best::Asked { study: self.study(*job)?, as_it_is });
            }
        }
        let start = plants.means.get(plant).copied().unwrap_or(plants.all);
        best::best(&asked, start, (self.options.budget, self.options.seed), watch)
    }
}

/// Whether a controller tunes itself.
fn is_self_tuner(controller: &Controller) -> bool {
    matches!(controller, Controller::SelfTuning(_))
}

fn self_tuner(study: &Study, named: Option<&str>) -> Result<String, TuneError> {
    let all = study.scenario.controllers.iter();
    let names: Vec<&str> =
        all.filter(|it| is_self_tuner(&it.controller)).map(|it| it.name.as_str()).collect();
    let found = match named {
        None => names.first().copied(),
        Some(name) => names.iter().copied().find(|it| *it == name),
    };
    found.map(str::to_owned).ok_or_else(|| TuneError::Value {
        what: "the self-tuner",
        found: named.map_or("none".to_owned(), |name| format!("\"{name}\"")),
        allowed: match names.is_empty() {
            true => "a controller of kind fspid, of which the scenario has none".to_owned(),
            false => names.join(", "),
        },
    })
}

fn compared_with(
    study: &Study,
    named: Option<&str>,
    controller: &str,
) -> Result<Option<String>, TuneError> {
    let names: Vec<&str> =
        study.scenario.flyers().map(|flyer| flyer.name()).filter(|it| *it != controller).collect();
    let of_contest = || study.contest.as_ref().and_then(|contest| contest.against.as_deref());
    if let Some(name) = named {
        return match names.contains(&name) {
            true => Ok(Some(name.to_owned())),
            false => Err(TuneError::Unknown {
                what: "other controller",
                found: name.to_owned(),
                known: known_words(name, &names),
            }),
        };
    }
    let own = study.scenario.controllers.iter();
    let fixed = own.filter(|it| !is_self_tuner(&it.controller)).map(|it| it.name.as_str());
    let found = of_contest().filter(|name| names.contains(name)).or(fixed.into_iter().next());
    Ok(found.map(str::to_owned))
}

/// The cases that are flown, and how often.
fn cases<'a>(study: &'a Study, options: &Options) -> (&'a [Case], Dispersed) {
    let runs = options.runs;
    let key = "--runs";
    if let Some(contest) = &study.contest {
        let runs = runs.unwrap_or(contest.runs);
        return (&contest.cases, Dispersed { key, runs, seeds: Seeds::OfEach(contest.run_seed) });
    }
    match &study.tuning {
        Some(tuning) => {
            let runs = runs.unwrap_or(tuning.runs);
            (&tuning.cases, Dispersed { key, runs, seeds: Seeds::OfAll(tuning.run_seed) })
        }
        None => {
            (&[], Dispersed { key, runs: runs.unwrap_or(0), seeds: Seeds::OfAll(options.seed) })
        }
    }
}

/// Counts flights that nobody waits for.
#[must_use]
pub fn uncounted() -> AtomicUsize {
    AtomicUsize::new(0)
}
