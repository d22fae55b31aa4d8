//! One environment, whose flight is recorded.

use std::sync::{Arc, Mutex, PoisonError};

use fspid::sim::{InFlight, Outcome, Prepared, Trace};
use fspid::study::analysis::AtRest;
use fspid::study::simulation::{ControllerResult, Simulation};
use pyo3::prelude::*;

use super::setting::{Episode, OBSERVED, Setting, Wanted, in_words};
use crate::answer::Flight;
use crate::error;
use crate::origin::Origin;
use crate::scenario::Scenario;

/// What the trace of an environment is called.
const NAME: &str = "agent";

/// What is observed, the reward, whether and how the flight is over.
type Stepped = ([f64; OBSERVED], f64, bool, bool, Option<String>);

/// A pitch loop that waits for actions.
#[pyclass(frozen, module = "fspid._core")]
pub(crate) struct Environment {
    setting: Setting,
    now: Mutex<Option<Now>>,
    origin: Origin,
}

struct Now {
    episode: Episode,
    flight: InFlight<Arc<Prepared>>,
    trace: Trace,
}

impl Environment {
    fn with<T>(&self, work: impl FnOnce(&mut Option<Now>) -> T) -> T {
        work(&mut self.now.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

#[pymethods]
impl Environment {
    /// Of a scenario.
    #[new]
    fn new(py: Python<'_>, scenario: &Scenario, wanted: Wanted) -> PyResult<Self> {
        let setting = Setting::new(py, scenario, &wanted)?;
        Ok(Self { setting, now: Mutex::new(None), origin: scenario.made_of() })
    }

    /// Ends of the numbers of an action.
    #[getter]
    fn ends(&self) -> Vec<(f64, f64)> {
        self.setting.ends.clone()
    }

    /// Begins a run of a seed; what is seen first.
    fn reset(&self, py: Python<'_>, seed: u64, run: u64) -> PyResult<[f64; OBSERVED]> {
        let begun = py.detach(|| {
            let episode = self.setting.begin(seed, run)?;
            let flight = InFlight::start(Arc::clone(&episode.prepared));
            let flight = flight.map_err(|found| found.to_string())?;
            let trace = Trace::with_room(&episode.prepared);
            Ok(Now { episode, flight, trace })
        });
        let now = begun.map_err(|told: String| error::input(py, told))?;
        let seen = now.flight.seen().map_err(|outcome| error::input(py, in_words(outcome)))?;
        let observation = self.setting.observation(&seen, &now.episode);
        self.with(|place| *place = Some(now));
        Ok(observation)
    }

    /// Answers the sample that waits.
    fn step(&self, py: Python<'_>, action: Vec<f64>) -> PyResult<Stepped> {
        let stepped = self.with(|now| {
            let now = now.as_mut().ok_or("reset() comes before the first step")?;
            now.step(&self.setting, &action)
        });
        stepped.map_err(|told: String| error::input(py, told))
    }

    /// The flight so far, as if a scenario had been flown; none before the first reset.
    fn flight(&self) -> Option<Flight> {
        self.with(|now| now.as_ref().map(|now| now.flight(self.origin.clone())))
    }
}

impl Now {
    fn step(&mut self, setting: &Setting, action: &[f64]) -> Result<Stepped, String> {
        let seen = self.flight.seen().map_err(|outcome| {
            let told = in_words(outcome);
            format!("the flight is over: {told}; reset() begins the next one")
        })?;
        let step = setting.step(&mut self.episode, &seen, action)?;
        let instant = self.flight.act(step).map_err(|found| found.to_string())?;
        if let Some(instant) = instant {
            self.trace.push(&self.episode.prepared, &instant);
        }
        let rewarded = setting.rewarded(&self.episode, &seen, self.flight.seen());
        if let Some(outcome) = rewarded.outcome {
            self.trace.outcome = outcome;
        }
        let truncated = rewarded.outcome == Some(Outcome::Completed);
        let terminated = rewarded.outcome.is_some() && !truncated;
        let outcome = rewarded.outcome.map(in_words);
        Ok((rewarded.observation, rewarded.reward, terminated, truncated, outcome))
    }

    fn flight(&self, origin: Origin) -> Flight {
        let Episode { study, prepared, .. } = &self.episode;
        let (flown, rest) = ((self.trace.clone(), prepared.edges()), (AtRest::unknown(), None));
        let simulation = Simulation {
            scenario: study.scenario.name.clone(),
            results: vec![ControllerResult::of(study, NAME, flown, rest)],
            judgements: Vec::new(),
            range_rule: study.range_rule,
            failed_own_flights: Vec::new(),
        };
        Flight::new(Arc::clone(study), simulation, origin)
    }
}
