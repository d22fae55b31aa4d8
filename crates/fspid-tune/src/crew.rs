//! Execution of flights for searches and contests: on threads of this machine, or by external workers that receive orders.
//!
//! ```text
//! points ─order▶ engine ─parts of it▶ workers ─flights, their numbers as bits▶ engine ─▶ scores
//! ```
//!
//! A flight depends on its point, its case and its run alone: an order can be parted anywhere, and its answer has the
//! bits of this machine.

use std::ops::Range;
use std::sync::{Arc, Mutex, PoisonError};

use fspid_campaign::Plan;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use crate::bits;
use crate::contest::{Contest, Options};
use crate::error::TuneError;
use crate::flights::Flights;
use crate::problem::TuningProblem;
use crate::source::Source;

/// Who flies.
#[derive(Clone, Copy)]
pub enum Crew<'a> {
    /// All threads of the pool that the call is made in, until this says that they shall stop; it is asked before each
    /// group of flights.
    Here(&'a (dyn Fn() -> bool + Sync)),
    /// Others.
    Others(&'a dyn Engine),
}

impl Crew<'_> {
    /// The threads of this machine, to the end.
    pub const UNSTOPPED: Self = Self::Here(&|| false);
}

/// Others who fly: a cluster behind something that hands out tasks.
pub trait Engine {
    /// Answers what [`Worker::fly`] answered to parts that make up the whole order, in their order.
    ///
    /// # Errors
    /// [`TuneError::Engine`] with what went wrong, [`TuneError::Stopped`] where somebody asked to stop.
    fn fly(&self, order: &Order) -> Result<Vec<String>, TuneError>;
}

/// What flights are flown for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Part {
    /// A search for the best numbers.
    Tuning,
    /// A contest's judgement on what nobody was tuned on.
    Judging,
}

/// Flights of one controller at some points, as somebody else can fly them who has the scenario.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Order {
    /// The program that asks.
    program: String,
    controller: String,
    part: Part,
    /// Digest of everything that decides about the flights but the points.
    of: String,
    #[serde(with = "bits")]
    points: Vec<Vec<f64>>,
    /// How many flights it asks for, and how many of them fly best together.
    flights: usize,
    at_once: usize,
}

/// What a worker answers.
#[derive(Serialize, Deserialize)]
struct Answer<T> {
    of: String,
    flights: Range<usize>,
    flown: Vec<T>,
}

impl Order {
    pub(crate) fn of(flights: &Flights, points: &[Vec<f64>]) -> Self {
        let (controller, part) = flights.asked_by();
        Self {
            program: Plan::this_program(),
            controller: controller.to_owned(),
            part,
            of: flights.digest().to_owned(),
            points: points.to_vec(),
            flights: flights.count() * points.len(),
            at_once: flights.at_once(),
        }
    }

    /// How many flights it asks for.
    #[must_use]
    pub fn flights(&self) -> usize {
        self.flights
    }

    /// How many of them fly best together; parts should hold so many, or some times as many.
    #[must_use]
    pub fn at_once(&self) -> usize {
        self.at_once
    }

    /// As text, for [`Worker::fly`].
    #[must_use]
    pub fn text(&self) -> String {
        serde_json::to_string(self).unwrap_or_default()
    }

    /// All flights out of the answers of workers to parts of the order.
    pub(crate) fn taken_in<T: DeserializeOwned>(
        &self,
        answers: Vec<String>,
    ) -> Result<Vec<T>, TuneError> {
        let mut all = Vec::with_capacity(self.flights);
        for answer in answers {
            let answer: Answer<T> =
                serde_json::from_str(&answer).map_err(|error| no_answer(&error.to_string()))?;
            let Answer { of, flights: range, flown } = answer;
            if of != self.of || range.start != all.len() || range.len() != flown.len() {
                return Err(no_answer("it is the answer to something else"));
            }
            all.extend(flown);
        }
        match all.len() == self.flights {
            true => Ok(all),
            false => {
                Err(no_answer(&format!("{} of {} flights are there", all.len(), self.flights)))
            }
        }
    }

    fn answered<T: Serialize>(
        &self,
        flights: &Range<usize>,
        flown: Vec<T>,
    ) -> Result<String, TuneError> {
        let answer = Answer { of: self.of.clone(), flights: flights.clone(), flown };
        serde_json::to_string(&answer).map_err(|error| engine(error.to_string()))
    }
}

/// Flies parts of orders for somebody else who has the same scenario.
#[derive(Debug)]
pub struct Worker {
    source: Source,
    /// What was flown for last: orders come one after the other.
    now: Mutex<Option<Job>>,
}

/// What a worker has read for an order.
#[derive(Clone, Debug)]
enum Job {
    Tuning(Arc<TuningProblem>),
    Judging(Arc<Contest>),
}

impl Job {
    fn read(source: &Source, order: &Order) -> Result<Self, TuneError> {
        Ok(match order.part {
            Part::Tuning => {
                Self::Tuning(Arc::new(TuningProblem::new(source, Some(&order.controller))?))
            }
            Part::Judging => Self::Judging(Arc::new(Contest::new(source, &ANY_EFFORT)?)),
        })
    }

    fn is_for(&self, order: &Order) -> bool {
        let flights = match (self, order.part) {
            (Self::Tuning(problem), Part::Tuning) => Some(problem.its_flights()),
            (Self::Judging(contest), Part::Judging) => contest.flights_of(&order.controller),
            _ => None,
        };
        flights.is_some_and(|flights| flights.digest() == order.of)
    }

    fn fly(&self, order: &Order, flights: Range<usize>) -> Result<String, TuneError> {
        match self {
            Self::Tuning(problem) => {
                order.answered(&flights, problem.block(&order.points, flights.clone())?)
            }
            Self::Judging(contest) => {
                let (who, points) = (&order.controller, &order.points);
                order.answered(&flights, contest.block(who, points, flights.clone())?)
            }
        }
    }
}

/// How a contest is held decides nothing about its flights.
const ANY_EFFORT: Options = Options { seeds: Some(1), budget: Some(1) };

impl Worker {
    /// A worker with a scenario; nothing is read yet.
    #[must_use]
    pub fn new(source: Source) -> Self {
        Self { source, now: Mutex::new(None) }
    }

    /// Flies some flights of an order on all threads of the pool that this is called in.
    ///
    /// # Errors
    /// An order of another program or scenario, and a scenario that is wrong.
    pub fn fly(&self, order: &str, flights: Range<usize>) -> Result<String, TuneError> {
        let order: Order = serde_json::from_str(order)
            .map_err(|error| engine(format!("this is no order: {error}")))?;
        let (own, theirs) = (Plan::this_program(), &order.program);
        if own != *theirs {
            return Err(engine(format!(
                "this worker has {own} and the driver {theirs}, so that bits may differ"
            )));
        }
        self.job(&order)?.fly(&order, flights)
    }

    /// What the order is about, read from the scenario unless it was read before.
    fn job(&self, order: &Order) -> Result<Job, TuneError> {
        let mut now = self.now.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(job) = now.as_ref().filter(|job| job.is_for(order)) {
            return Ok(job.clone());
        }
        let job = Job::read(&self.source, order)?;
        if !job.is_for(order) {
            return Err(engine(OTHER_FLIGHTS.to_owned()));
        }
        *now = Some(job.clone());
        Ok(job)
    }
}

const OTHER_FLIGHTS: &str = "what a worker has read is not what the driver asks about: a file that the scenario names is another one there";

fn engine(reason: String) -> TuneError {
    TuneError::Engine { reason }
}

fn no_answer(reason: &str) -> TuneError {
    engine(format!("a worker's answer cannot be used: {reason}"))
}
