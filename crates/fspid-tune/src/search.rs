//! A search, generation by generation: it can be stopped, written and gone on with, with the same bits.

use fspid_campaign::Plan as Campaign;
use fspid_optimise::{
    Kind, NsgaII, Optimiser, ParetoOptimiser, Plan, Snapshot, Start, Stop, hypervolume,
};
use fspid_scenario::count::{BUDGET, POPULATION};
use fspid_scenario::file::known_words;
use fspid_scenario::tuning::Tuning;
use fspid_study::shell::word;
use serde::{Deserialize, Serialize};

use crate::crew::Crew;
use crate::error::TuneError;
use crate::problem::TuningProblem;
use crate::score::Score;
use crate::slopes::{Counted, Descents, Differentiable, Sequential};
use crate::source::Source;

/// How wide the first candidates lie about the start, as a share of the cube. On the scenario of the gallery a
/// spread of 0.2 lost the allowed region of two seeds in four within 400 candidates; 0.05 and 0.1 none.
const SPREAD: f64 = 0.1;
/// Candidates of a generation of the front's optimiser, unless asked otherwise.
const FRONT_POPULATION: usize = 40;
/// Names of the optimisers that go downhill by slopes: of the merit, and of the cost and each limit by itself.
const OF_MERIT: &str = "bfgs";
const OF_LIMITS: &str = "sqp";
const BY_SLOPES: [&str; 2] = [OF_MERIT, OF_LIMITS];

/// How a search is made.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Effort {
    /// Name of the optimiser.
    pub optimiser: String,
    /// Candidates that are flown, the start not counted.
    pub budget: usize,
    /// Seed of every random number.
    pub seed: u64,
    /// Candidates of a generation; what the optimiser is used to where it is left open.
    pub population: Option<usize>,
    /// Whether the first candidates lie anywhere, and not about the start.
    pub anywhere: bool,
}

/// What of an [`Effort`] was asked for; the rest is as the scenario says.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct AskedEffort {
    /// Name of the optimiser.
    pub optimiser: Option<String>,
    /// Candidates that are flown, the start not counted.
    pub budget: Option<usize>,
    /// Seed of every random number.
    pub seed: Option<u64>,
    /// Candidates of a generation.
    pub population: Option<usize>,
    /// Whether the first candidates lie anywhere, and not about the start.
    pub anywhere: bool,
}

impl AskedEffort {
    /// With the scenario's own numbers where nothing was asked.
    #[must_use]
    pub fn of(&self, tuning: &Tuning) -> Effort {
        Effort {
            optimiser: self.optimiser.clone().unwrap_or_else(|| tuning.optimiser.clone()),
            budget: self.budget.unwrap_or(tuning.budget),
            seed: self.seed.unwrap_or(tuning.seed),
            population: self.population,
            anywhere: self.anywhere,
        }
    }
}

impl Effort {
    /// Names of the optimisers.
    #[must_use]
    pub fn optimisers() -> Vec<&'static str> {
        Kind::NAMES.iter().map(|(_, name)| *name).chain(BY_SLOPES).chain([NsgaII::NAME]).collect()
    }

    /// The command that searches so, beside the scenario.
    #[must_use]
    pub fn command(&self, source: &Source, controller: Option<&str>) -> String {
        let name = source.path.file_name().map(|name| name.to_string_lossy().into_owned());
        let mut words = vec!["fspid tune".to_owned(), word(&name.unwrap_or_default())];
        let mut option = |name: &str, value: &str| words.push(format!("--{name} {}", word(value)));
        if let Some(controller) = controller {
            option("controller", controller);
        }
        option("optimiser", &self.optimiser);
        option("budget", &self.budget.to_string());
        option("seed", &self.seed.to_string());
        if let Some(population) = self.population {
            option("population", &population.to_string());
        }
        source.overrides.iter().for_each(|change| option("set", change));
        if self.anywhere {
            words.push("--anywhere".to_owned());
        }
        words.join(" ")
    }

    fn check(&self, objectives: usize) -> Result<(), TuneError> {
        let wrong = |what, found: String, allowed: &str| {
            Err(TuneError::Value { what, found, allowed: allowed.to_owned() })
        };
        BUDGET.check(self.budget)?;
        if !Self::optimisers().contains(&self.optimiser.as_str()) {
            let found = self.optimiser.clone();
            let known = known_words(&found, &Self::optimisers());
            return Err(TuneError::Unknown { what: "optimiser", found, known });
        }
        if self.optimiser == NsgaII::NAME && objectives < 2 {
            let found = format!("\"{}\" with one objective", NsgaII::NAME);
            return wrong(
                "the optimiser",
                found,
                "another one, or two [[tuning.objective]] or more",
            );
        }
        self.population.map_or(Ok(()), |count| POPULATION.check(count))?;
        Ok(())
    }
}

/// A candidate that was flown.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Trial {
    /// Generation, from 0 for the start alone.
    pub generation: u64,
    /// Its place in the unit cube.
    pub point: Vec<f64>,
    /// What it is worth.
    pub score: Score,
}

/// The optimiser at work.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Engine {
    One(Box<Snapshot>),
    Slopes(Box<Descents>),
    Programmes(Box<Sequential>),
    Front(NsgaII),
}

/// Everything of a search but its problem, as plain data.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct State {
    /// Version of this format.
    schema: u32,
    /// The program that saved it.
    program: String,
    /// Digest of everything that decides about the search.
    of: String,
    effort: Effort,
    generation: u64,
    engine: Engine,
    trials: Vec<Trial>,
}

const STATE_SCHEMA: u32 = 1;

enum Running<'a> {
    One(Box<dyn Optimiser>),
    Slopes(Box<Descents>, Box<Differentiable<'a>>),
    Programmes(Box<Sequential>, Box<Differentiable<'a>>),
    Front(NsgaII),
}

/// A search for the best numbers of a problem.
pub struct Search<'a> {
    problem: &'a TuningProblem,
    crew: Crew<'a>,
    effort: Effort,
    running: Running<'a>,
    generation: u64,
    trials: Vec<Trial>,
    best: usize,
}

impl<'a> Search<'a> {
    /// A search at its beginning; the start is flown.
    ///
    /// # Errors
    /// An effort that is none, a start without a cost (unless candidates begin anywhere), a crew that does not fly.
    pub fn begin(
        problem: &'a TuningProblem,
        effort: Effort,
        crew: Crew<'a>,
    ) -> Result<Self, TuneError> {
        effort.check(problem.tuning().objectives.len())?;
        let slopes = differentiable(problem, &effort)?;
        let start = problem.space().start();
        let score = problem.scores_by(std::slice::from_ref(&start), crew)?.pop();
        let Some(score) = score.filter(|score| effort.anywhere || !score.values.is_empty()) else {
            return Err(TuneError::Start { reasons: problem.reasons_of_loss(&start, crew)? });
        };
        let running = match slopes {
            Some(slopes) if effort.optimiser == OF_LIMITS => {
                let programmes = Sequential::new(&start, effort.seed, effort.anywhere);
                Running::Programmes(Box::new(programmes), Box::new(slopes))
            }
            Some(slopes) => {
                let descents = Descents::new(&start, effort.seed, effort.anywhere);
                Running::Slopes(Box::new(descents), Box::new(slopes))
            }
            None => started(problem, &effort, &start),
        };
        let trials = vec![Trial { generation: 0, point: start, score }];
        Ok(Self { problem, crew, effort, running, generation: 0, trials, best: 0 })
    }

    /// A search that goes on where its state was saved.
    ///
    /// # Errors
    /// A state of another search, or one that no search can have been in; `path` is told.
    pub fn resume(
        (problem, crew): (&'a TuningProblem, Crew<'a>),
        effort: &Effort,
        state: State,
        path: &str,
    ) -> Result<Self, TuneError> {
        let wrong = |reason: String| TuneError::State { path: path.to_owned(), reason };
        if state.schema != STATE_SCHEMA || state.program != Campaign::this_program() {
            return Err(wrong("it was saved by another version".to_owned()));
        }
        if state.of != problem.digest() || state.effort != *effort {
            return Err(wrong("it is the state of another search".to_owned()));
        }
        let dimension = problem.space().dimension();
        let is_sound = |trial: &Trial| {
            trial.point.len() == dimension
                && trial.point.iter().all(|x| (0.0..=1.0).contains(x))
                && !trial.score.cost.is_nan()
        };
        if state.trials.is_empty() || !state.trials.iter().all(is_sound) {
            return Err(wrong("its trials do not fit together".to_owned()));
        }
        let running = match state.engine {
            Engine::One(snapshot) => {
                Running::One(snapshot.resume().map_err(|error| wrong(error.to_string()))?)
            }
            Engine::Slopes(descents) => {
                let is_sound = descents.is_sound(dimension);
                Running::Slopes(descents, sound_slopes(problem, effort, is_sound, wrong)?)
            }
            Engine::Programmes(programmes) => {
                let is_sound = programmes.is_sound(dimension);
                Running::Programmes(programmes, sound_slopes(problem, effort, is_sound, wrong)?)
            }
            Engine::Front(front) => {
                Running::Front(front.resumed().map_err(|error| wrong(error.to_string()))?)
            }
        };
        let mut search = Self {
            problem,
            crew,
            effort: state.effort,
            running,
            generation: state.generation,
            trials: state.trials,
            best: 0,
        };
        search.find_best(0);
        Ok(search)
    }

    /// Its state between two generations.
    #[must_use]
    pub fn state(&self) -> State {
        State {
            schema: STATE_SCHEMA,
            program: Campaign::this_program(),
            of: self.problem.digest(),
            effort: self.effort.clone(),
            generation: self.generation,
            engine: match &self.running {
                Running::One(optimiser) => Engine::One(Box::new(optimiser.snapshot())),
                Running::Slopes(descents, _) => Engine::Slopes(descents.clone()),
                Running::Programmes(programmes, _) => Engine::Programmes(programmes.clone()),
                Running::Front(front) => Engine::Front(front.clone()),
            },
            trials: self.trials.clone(),
        }
    }

    /// Flies one more generation; answers why the search is over, if it is.
    ///
    /// # Errors
    /// [`TuneError::Stopped`], and others who could not fly: the search is where it was, and flies the same generation when
    /// it is asked again.
    pub fn advance(&mut self) -> Result<Option<Stop>, TuneError> {
        let left = self.effort.budget.saturating_sub(self.spent());
        if left == 0 {
            return Ok(Some(Stop::Budget));
        }
        let mut points = match &mut self.running {
            Running::One(optimiser) => optimiser.ask(),
            Running::Slopes(..) => return self.descend(),
            Running::Programmes(..) => return self.step(),
            Running::Front(front) => front.ask(),
        };
        if points.is_empty() {
            return Ok(Some(self.stop().unwrap_or(Stop::Collapsed)));
        }
        points.truncate(left);
        let scores = self.problem.scores_by(&points, self.crew)?;
        match &mut self.running {
            Running::One(optimiser) => {
                optimiser.tell(&scores.iter().map(|score| score.cost).collect::<Vec<_>>());
            }
            Running::Slopes(..) | Running::Programmes(..) => {}
            Running::Front(front) => {
                front
                    .tell(&scores.iter().map(|score| score.objectives.clone()).collect::<Vec<_>>());
            }
        }
        self.generation += 1;
        let generation = self.generation;
        let from = self.trials.len();
        let trials = points.into_iter().zip(scores);
        self.trials.extend(trials.map(|(point, score)| Trial { generation, point, score }));
        self.find_best(from);
        Ok((self.spent() >= self.effort.budget).then_some(Stop::Budget))
    }

    /// Flies one more candidate of a descent, and follows its flights back where its slope is wanted.
    fn descend(&mut self) -> Result<Option<Stop>, TuneError> {
        let Running::Slopes(descents, slopes) = &self.running else { return Ok(None) };
        let point = descents.ask();
        let mut flights = self.problem.flights_of(std::slice::from_ref(&point), self.crew)?;
        let flights = flights.pop().unwrap_or_default();
        let score = self.problem.score(&flights);
        let penalty = descents.penalty(slopes.merit(&flights, 0.0).value);
        let merit = slopes.merit(&flights, penalty);
        // The way back is flown here, whoever flies forwards.
        if let Crew::Here(stops) = self.crew
            && stops()
        {
            return Err(TuneError::Stopped);
        }
        let most = slopes.most_analyses(&merit.weights);
        let left = self.effort.budget.saturating_sub(self.spent() + 1);
        let wanted = descents.wants_slope(&merit)
            && left >= Counted::of_slope(most).candidates(self.problem.flights());
        let found = wanted.then(|| slopes.slope(&point, &merit.weights)).flatten();
        self.generation += 1;
        let (generation, from) = (self.generation, self.trials.len());
        self.trials.push(Trial { generation, point, score });
        self.find_best(from);
        let best = &self.trials[self.best].point;
        if let Running::Slopes(descents, _) = &mut self.running {
            let found = found.map(|found| (found.slope, found.analyses));
            descents.tell(&merit, penalty, found, best);
        }
        Ok((self.spent() >= self.effort.budget).then_some(Stop::Budget))
    }

    /// Flies the next candidate of sequential programmes, for which the slopes of all limits are found where it stands.
    fn step(&mut self) -> Result<Option<Stop>, TuneError> {
        let best = self.trials[self.best].point.clone();
        let Running::Programmes(programmes, slopes) = &mut self.running else { return Ok(None) };
        // What is asked for is kept once its flights are in: a search that is stopped asks again.
        let mut next = programmes.clone();
        let counted = next.counted().candidates(self.problem.flights());
        let left = self.effort.budget.saturating_sub(self.trials.len() - 1 + counted);
        let ends = next.wants_slopes() && left <= slopes.most_of_rows();
        let point = match ends {
            true => next.without_slopes(&best, self.generation),
            false => next.ask(slopes, &best),
        };
        if let Crew::Here(stops) = self.crew
            && stops()
        {
            return Err(TuneError::Stopped);
        }
        let mut flights = self.problem.flights_of(std::slice::from_ref(&point), self.crew)?;
        let flights = flights.pop().unwrap_or_default();
        let score = self.problem.score(&flights);
        let penalty = next.penalty(slopes.merit(&flights, 0.0).value);
        let merit = slopes.merit(&flights, penalty);
        if !ends {
            next.tell(&merit, penalty, &flights, &best);
        }
        *programmes = next;
        self.generation += 1;
        let (generation, from) = (self.generation, self.trials.len());
        self.trials.push(Trial { generation, point, score });
        self.find_best(from);
        Ok((self.spent() >= self.effort.budget).then_some(Stop::Budget))
    }

    /// What a search by slopes has done beside flying candidates; none for another one.
    #[must_use]
    pub fn counted(&self) -> Option<Counted> {
        match &self.running {
            Running::Slopes(descents, _) => Some(descents.counted()),
            Running::Programmes(programmes, _) => Some(programmes.counted()),
            Running::One(_) | Running::Front(_) => None,
        }
    }

    /// Who flies.
    pub(crate) fn crew(&self) -> Crew<'a> {
        self.crew
    }

    fn stop(&self) -> Option<Stop> {
        match &self.running {
            Running::One(optimiser) => optimiser.stop(),
            Running::Slopes(..) | Running::Programmes(..) => None,
            Running::Front(front) => front.stop(),
        }
    }

    fn find_best(&mut self, from: usize) {
        for (index, trial) in self.trials.iter().enumerate().skip(from) {
            if trial.score.cost < self.trials[self.best].score.cost {
                self.best = index;
            }
        }
    }

    /// How it is made.
    #[must_use]
    pub fn effort(&self) -> &Effort {
        &self.effort
    }

    /// Candidates flown so far, the start not counted; slopes count as the candidates whose flights they are worth.
    #[must_use]
    pub fn spent(&self) -> usize {
        let slopes = self.counted().map_or(0, |it| it.candidates(self.problem.flights()));
        self.trials.len().saturating_sub(1) + slopes
    }

    /// Every candidate flown so far, the start first.
    #[must_use]
    pub fn trials(&self) -> &[Trial] {
        &self.trials
    }

    /// The one that costs least.
    #[must_use]
    pub fn best(&self) -> &Trial {
        &self.trials[self.best]
    }

    /// The trade-offs that no other candidate beats, in ascending order of the first objective; one entry
    /// where there is one objective or the search is for one cost.
    #[must_use]
    pub fn front(&self) -> Vec<&Trial> {
        let allowed: Vec<&Trial> = self.trials.iter().filter(|it| it.score.is_allowed()).collect();
        if !matches!(self.running, Running::Front(_)) {
            return vec![self.best()];
        }
        let costs = |trial: &Trial| trial.score.objectives.clone();
        let beats = |one: &Trial, other: &Trial| {
            let pairs = || one.score.objectives.iter().zip(&other.score.objectives);
            pairs().all(|(a, b)| a <= b) && pairs().any(|(a, b)| a < b)
        };
        let mut front: Vec<&Trial> = Vec::new();
        for trial in allowed {
            if front.iter().any(|other| beats(other, trial) || costs(other) == costs(trial)) {
                continue;
            }
            front.retain(|other| !beats(trial, other));
            front.push(trial);
        }
        let first = |trial: &Trial| trial.score.objectives.first().copied().unwrap_or(0.0);
        front.sort_by(|a, b| first(a).total_cmp(&first(b)));
        front
    }

    /// Volume between the front and the references of the objectives, in their costs; the worst of the
    /// first candidates stands for a reference that is left out. None where the search is for one cost.
    #[must_use]
    pub fn front_volume(&self) -> Option<f64> {
        let Running::Front(_) = self.running else {
            return None;
        };
        let first = self.trials.iter().filter(|it| it.generation <= 1 && it.score.is_allowed());
        let first: Vec<&Trial> = first.collect();
        let reference = self.problem.tuning().objectives.iter().enumerate().map(|(index, it)| {
            let worst = first.iter().map(|trial| trial.score.objectives[index]);
            let worst = worst.fold(f64::NEG_INFINITY, f64::max);
            it.reference.map_or(worst, |value| it.weight * value)
        });
        let reference: Vec<f64> = reference.collect();
        let points: Vec<&[f64]> =
            self.front().into_iter().map(|it| it.score.objectives.as_slice()).collect();
        Some(hypervolume(&points, &reference))
    }
}

/// What a search by slopes goes by; none for another one.
fn differentiable<'a>(
    problem: &'a TuningProblem,
    effort: &Effort,
) -> Result<Option<Differentiable<'a>>, TuneError> {
    let name = BY_SLOPES.into_iter().find(|name| effort.optimiser == *name);
    name.map(|name| Differentiable::new(problem, name)).transpose()
}

/// The slopes of a search that goes on, if what it saved fits together.
fn sound_slopes<'a>(
    problem: &'a TuningProblem,
    effort: &Effort,
    is_sound: bool,
    wrong: impl Fn(String) -> TuneError,
) -> Result<Box<Differentiable<'a>>, TuneError> {
    let slopes = differentiable(problem, effort)?.filter(|_| is_sound);
    let slopes =
        slopes.ok_or_else(|| wrong("the numbers of its descent do not fit together".to_owned()))?;
    Ok(Box::new(slopes))
}

fn started<'a>(problem: &TuningProblem, effort: &Effort, start: &[f64]) -> Running<'a> {
    let dimension = problem.space().dimension();
    let kind = Kind::from_name(&effort.optimiser);
    let usual = kind.map_or(FRONT_POPULATION, |kind| kind.usual_population(dimension));
    // A generation that takes all of the budget learns nothing.
    let most = (effort.budget / 4).max(4);
    let population = effort.population.unwrap_or(usual.min(most));
    let plan = Plan { dimension, population, budget: effort.budget, seed: effort.seed };
    let about = if effort.anywhere { Start::Anywhere } else { Start::About(start, SPREAD) };
    match kind {
        Some(kind) => Running::One(kind.start(plan, about)),
        None => Running::Front(NsgaII::new(plan, problem.tuning().objectives.len(), about)),
    }
}

/// A stop in words.
#[must_use]
pub fn stop_in_words(stop: Stop) -> &'static str {
    match stop {
        Stop::Budget => "the budget is spent",
        Stop::Target => "the cost wanted was reached",
        Stop::NoProgress => "the candidates no longer differ in cost",
        Stop::Collapsed => "the candidates no longer differ at all",
        Stop::Taken => "what was found so far was taken; the search is not over",
    }
}
