//! Many environments at once, in lanes where lanes can fly them.

use std::sync::{Arc, Mutex, PoisonError};

use fspid::scenario::count::ENVIRONMENTS;
use fspid::sim::Outcome;
use fspid::sim::batch::{Formation, LANES};
use pyo3::prelude::*;
use rayon::prelude::*;

use super::setting::{Episode, OBSERVED, Setting, Wanted, in_words};
use crate::array::{Column, Numbers};
use crate::error;
use crate::scenario::Scenario;

/// What a column says of an environment that goes on, that was lost, that is at its scenario's end.
const GOES_ON: f64 = 0.0;
const TERMINATED: f64 = 1.0;
const TRUNCATED: f64 = 2.0;

/// What is observed row by row, rewards, and what the constants above say.
type Stepped = (Column, Column, Column);

/// Pitch loops of one scenario that wait for actions.
#[pyclass(frozen, module = "fspid._core")]
pub(crate) struct Environments {
    setting: Setting,
    count: usize,
    crews: Mutex<Vec<Crew>>,
}

/// As many environments as a formation has places.
struct Crew {
    formation: Formation<LANES>,
    members: Vec<Member>,
}

struct Member {
    seed: u64,
    run: u64,
    /// None before the first reset.
    episode: Option<Episode>,
    observation: [f64; OBSERVED],
    reward: f64,
    outcome: Option<Outcome>,
}

impl Crew {
    fn new(members: usize) -> Self {
        let (observation, reward, outcome) = ([0.0; OBSERVED], 0.0, None);
        let member = || Member { seed: 0, run: 0, episode: None, observation, reward, outcome };
        let members = std::iter::repeat_with(member).take(members).collect();
        Self { formation: Formation::default(), members }
    }

    /// Begins a run of a seed at a place.
    fn begin(&mut self, setting: &Setting, place: usize, of: (u64, u64)) -> Result<(), String> {
        let episode = setting.begin(of.0, of.1)?;
        let started = self.formation.start(place, Arc::clone(&episode.prepared));
        started.map_err(|found| found.to_string())?;
        let member = &mut self.members[place];
        if let Some(Ok(seen)) = self.formation.seen(place) {
            member.observation = setting.observation(&seen, &episode);
        }
        (member.seed, member.run) = of;
        (member.reward, member.outcome) = (0.0, None);
        member.episode = Some(episode);
        Ok(())
    }

    /// Answers the samples of all that fly; whoever had ended begins its next run.
    fn step(&mut self, setting: &Setting, actions: &[f64]) -> Result<(), String> {
        let size = setting.ends.len();
        let (mut command_rad, mut answered) = ([0.0; LANES], [None; LANES]);
        for (place, (member, action)) in
            self.members.iter_mut().zip(actions.chunks_exact(size)).enumerate()
        {
            let episode = member.episode.as_mut().ok_or("reset() comes before the first step")?;
            let Some(Ok(seen)) = self.formation.seen(place) else { continue };
            command_rad[place] = setting.step(episode, &seen, action)?.command_rad;
            answered[place] = Some(seen);
        }
        self.formation.act(&command_rad).map_err(|found| found.to_string())?;
        let members = self.members.len();
        for (place, answered) in answered.into_iter().enumerate().take(members) {
            let member = &mut self.members[place];
            match (answered, self.formation.seen(place), &member.episode) {
                (Some(seen), Some(then), Some(episode)) => {
                    let rewarded = setting.rewarded(episode, &seen, then);
                    member.observation = rewarded.observation;
                    (member.reward, member.outcome) = (rewarded.reward, rewarded.outcome);
                }
                _ => {
                    let next = (member.seed, member.run + 1);
                    self.begin(setting, place, next)?;
                }
            }
        }
        Ok(())
    }

    /// True where a thread of its own is worth it: flights without lanes, and such as begin with draws.
    fn is_long(&self) -> bool {
        let place = |place| {
            let waits = matches!(self.formation.seen(place), Some(Ok(_)));
            !(waits && self.formation.is_in_lane(place))
        };
        (0..self.members.len()).any(place)
    }
}

impl Environments {
    fn with<T>(&self, work: impl FnOnce(&mut Vec<Crew>) -> T) -> T {
        work(&mut self.crews.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

/// What all members have, one after the other.
fn stepped(crews: &[Crew]) -> Stepped {
    let members = || crews.iter().flat_map(|crew| &crew.members);
    let column = |name: &str, values| Column::new(name.to_owned(), values);
    let end = |member: &Member| match member.outcome {
        None => GOES_ON,
        Some(Outcome::Completed) => TRUNCATED,
        Some(_) => TERMINATED,
    };
    (
        column("observation", members().flat_map(|member| member.observation).collect()),
        column("reward", members().map(|member| member.reward).collect()),
        column("end", members().map(end).collect()),
    )
}

#[pymethods]
impl Environments {
    /// So many of a scenario.
    #[new]
    fn new(py: Python<'_>, scenario: &Scenario, wanted: Wanted, count: usize) -> PyResult<Self> {
        ENVIRONMENTS.check(count).map_err(|found| error::input(py, found))?;
        let setting = Setting::new(py, scenario, &wanted)?;
        let crews = (0..count).step_by(LANES).map(|first| Crew::new(LANES.min(count - first)));
        Ok(Self { setting, count, crews: Mutex::new(crews.collect()) })
    }

    /// Ends of the numbers of an action.
    #[getter]
    fn ends(&self) -> Vec<(f64, f64)> {
        self.setting.ends.clone()
    }

    /// How many fly in lanes.
    #[getter]
    fn in_lanes(&self) -> usize {
        let of = |crew: &Crew| (0..LANES).filter(|place| crew.formation.is_in_lane(*place)).count();
        self.with(|crews| crews.iter().map(of).sum())
    }

    /// Seed and run of each.
    #[getter]
    fn runs(&self) -> Vec<(u64, u64)> {
        let of = |member: &Member| (member.seed, member.run);
        self.with(|crews| crews.iter().flat_map(|crew| &crew.members).map(of).collect())
    }

    /// Begins a run of a seed in each; what is seen first.
    fn reset(&self, py: Python<'_>, of: Vec<(u64, u64)>) -> PyResult<Column> {
        if of.len() != self.count {
            let (found, count) = (of.len(), self.count);
            return Err(error::input(py, format_args!("{found} seeds; there are {count} loops")));
        }
        let begun = py.detach(|| {
            self.with(|crews| {
                let crews_with_runs = crews.par_iter_mut().zip(of.par_chunks(LANES));
                let begin = |(crew, of): (&mut Crew, &[(u64, u64)])| {
                    let mut all = of.iter().enumerate();
                    all.try_for_each(|(place, &of)| crew.begin(&self.setting, place, of))
                };
                crews_with_runs.try_for_each(begin)?;
                Ok(stepped(crews).0)
            })
        });
        begun.map_err(|told: String| error::input(py, told))
    }

    /// Answers all samples that wait: an action each, one after the other. Whoever had ended begins its next run.
    fn step(&self, py: Python<'_>, actions: &Bound<'_, PyAny>) -> PyResult<Stepped> {
        let actions = Numbers::of(actions, "actions")?;
        let size = self.setting.ends.len();
        let (found, asked) = (actions.as_slice().len(), self.count * size);
        if found != asked {
            return Err(error::input(py, format_args!("{found} numbers; {asked} are asked for")));
        }
        let numbers = actions.as_slice();
        if let Some(number) = numbers.iter().find(|number| !number.is_finite()) {
            // Nobody has acted yet.
            let told = format_args!("an action is {number}; allowed are finite numbers");
            return Err(error::input(py, told));
        }
        let acted = py.detach(|| self.with(|crews| self.act(crews, numbers)));
        acted.map_err(|told| error::input(py, told))
    }

    /// How those that have just ended did: their places, each with the program's words.
    fn outcomes(&self) -> Vec<(usize, String)> {
        self.with(|crews| {
            let members = crews.iter().flat_map(|crew| &crew.members).enumerate();
            members.filter_map(|(place, it)| Some((place, in_words(it.outcome?)))).collect()
        })
    }
}

impl Environments {
    fn act(&self, crews: &mut [Crew], actions: &[f64]) -> Result<Stepped, String> {
        let numbers = LANES * self.setting.ends.len();
        let step = |(crew, actions): (&mut Crew, &[f64])| crew.step(&self.setting, actions);
        if crews.len() > 1 && crews.iter().any(Crew::is_long) {
            let all = crews.par_iter_mut().zip(actions.par_chunks(numbers));
            all.try_for_each(step)?;
        } else {
            crews.iter_mut().zip(actions.chunks(numbers)).try_for_each(step)?;
        }
        Ok(stepped(crews))
    }
}
