//! What all episodes of an environment share: what flies, what an action is, in which unit angles are told.

use std::sync::Arc;

use fspid::campaign::sample::Sampling;
use fspid::campaign::{Draws, MOST_RUNS};
use fspid::core::{Faults, Gains, Pid, State, Step};
use fspid::scenario::file::{Extra, Study, Template};
use fspid::scenario::units::{degrees, radians};
use fspid::sim::{Controller, Outcome, Prepared, Seen};
use fspid::study::metrics::Verdict;
use pyo3::prelude::*;

use crate::error;
use crate::scenario::Scenario;

/// Numbers of an observation: set-point, measured pitch, measured pitch rate, error as measured, last command.
pub(super) const OBSERVED: usize = 5;

/// The lower and the upper end of each number of an action.
type Intervals = Vec<(f64, f64)>;

/// What an action is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Action {
    /// A command, nose up positive.
    Elevator,
    /// Gains kp, ki and kd of the controller at that place of the scenario.
    Gains { place: usize },
}

/// What an episode is flown with.
#[derive(Clone)]
pub(super) struct Setting {
    study: Arc<Study>,
    /// The flight of all episodes, where none differs from another.
    prepared: Option<Arc<Prepared>>,
    dispersed: Option<Box<(Template, Draws)>>,
    pub(super) action: Action,
    /// Angles in degrees; in radians else.
    is_in_degrees: bool,
    /// Ends of what an action may be, in its unit.
    pub(super) ends: Intervals,
    /// Ends to which an action is cut.
    cuts: Intervals,
}

/// What is asked for.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(super) struct Wanted {
    controller: Option<String>,
    action: String,
    unit: String,
    ends: Option<Intervals>,
}

/// The flight of an episode.
#[derive(Clone)]
pub(super) struct Episode {
    pub(super) study: Arc<Study>,
    pub(super) prepared: Arc<Prepared>,
    /// Memory of the controller whose gains are given.
    memory: State<f64>,
    /// In the unit of angles.
    command: f64,
}

/// What an action comes to, beside what is seen then.
pub(super) struct Rewarded {
    pub(super) observation: [f64; OBSERVED],
    pub(super) reward: f64,
    /// How the flight ended, if it did.
    pub(super) outcome: Option<Outcome>,
}

impl Setting {
    pub(super) fn new(py: Python<'_>, scenario: &Scenario, wanted: &Wanted) -> PyResult<Self> {
        let refused = |told: String| error::input(py, told);
        let study = scenario.shared_study();
        let action = action(&study, wanted).map_err(refused)?;
        let is_in_degrees = match wanted.unit.as_str() {
            "deg" => true,
            "rad" => false,
            other => {
                return Err(refused(format!("angles are in `{other}`; allowed is deg or rad")));
            }
        };
        let (mut prepared, mut dispersed) = (None, None);
        if study.dispersions.is_empty() {
            let found = study.scenario.prepare().map_err(|it| error::input(py, it))?;
            prepared = Some(Arc::new(found));
        } else {
            let template = template(py, scenario)?;
            let draws = Draws::new(&template, Sampling::Random, MOST_RUNS, 0);
            let draws = draws.map_err(|found| error::campaign(py, &found))?;
            dispersed = Some(Box::new((template, draws)));
        }
        let (ends, cuts) = (Vec::new(), Vec::new());
        let mut setting = Self { study, prepared, dispersed, action, is_in_degrees, ends, cuts };
        (setting.ends, setting.cuts) = match &wanted.ends {
            None => setting.own_ends().map_err(refused)?,
            Some(given) => {
                let given = setting.checked_ends(given).map_err(refused)?;
                (given.clone(), given)
            }
        };
        Ok(setting)
    }

    /// An angle of radians in the unit of angles.
    fn told(&self, angle_rad: f64) -> f64 {
        if self.is_in_degrees { degrees(angle_rad) } else { angle_rad }
    }

    fn in_rad(&self, angle: f64) -> f64 {
        if self.is_in_degrees { radians(angle) } else { angle }
    }

    fn size(&self) -> usize {
        match self.action {
            Action::Elevator => 1,
            Action::Gains { .. } => 3,
        }
    }

    /// The ends of actions that follow from the scenario, and where actions are cut.
    ///
    /// A command is cut by the output limits of the first controller, as that cuts its own; the servo cuts by itself.
    fn own_ends(&self) -> Result<(Intervals, Intervals), String> {
        let scenario = &self.study.scenario;
        match self.action {
            Action::Elevator => {
                let everything = (f64::NEG_INFINITY, f64::INFINITY);
                let limits =
                    scenario.controllers.first().and_then(|it| it.controller.config().limits);
                let told = |(least, most)| (self.told(least), self.told(most));
                let cut = limits.map_or(everything, |it| told((it.lower(), it.upper())));
                let servo = scenario.actuator.command_limits_rad().map_or(everything, told);
                let ends = vec![(cut.0.max(servo.0), cut.1.min(servo.1))];
                Ok((self.checked_ends(&ends)?, vec![cut]))
            }
            Action::Gains { place } => {
                let Gains { kp, ki, kd } = scenario.controllers[place].controller.nominal();
                let about = |gain: f64| (gain.min(0.0) * 2.0, gain.max(0.0) * 2.0);
                let ends = [kp, ki, kd].map(about).to_vec();
                Ok((ends.clone(), ends))
            }
        }
    }

    fn checked_ends(&self, given: &[(f64, f64)]) -> Result<Intervals, String> {
        if given.len() != self.size() {
            let (found, size) = (given.len(), self.size());
            return Err(format!("the box has {found} intervals; an action has {size} numbers"));
        }
        match given.iter().find(|(least, most)| !(least <= most)) {
            Some((least, most)) => {
                Err(format!("the box goes from {least} to {most}; allowed is a lower end first"))
            }
            None => Ok(given.to_vec()),
        }
    }

    /// The flight of a run of a seed: run `run` of a campaign of this seed with independent points.
    pub(super) fn begin(&self, seed: u64, run: u64) -> Result<Episode, String> {
        let (study, prepared) = self.drawn(seed, run)?;
        Ok(Episode { study, prepared, memory: State::new(), command: 0.0 })
    }

    fn drawn(&self, seed: u64, run: u64) -> Result<(Arc<Study>, Arc<Prepared>), String> {
        if let Some(prepared) = &self.prepared {
            return Ok((Arc::clone(&self.study), Arc::clone(prepared)));
        }
        let Some((template, draws)) = self.dispersed.as_deref() else {
            return Err("nothing is prepared".to_owned());
        };
        if run >= MOST_RUNS {
            return Err(format!("the run is {run}; allowed is less than {MOST_RUNS}"));
        }
        let draws = draws.reseeded(seed).map_err(|found| found.to_string())?;
        let which = |told: String| format!("seed {seed}, run {run}: {told}");
        let drawn = draws.drawn(run);
        let study = template.with(&draws.values(&drawn));
        let study = study.map_err(|found| which(found.first_in_a_line()))?;
        let prepared = study.scenario.prepare().map_err(|found| which(found.to_string()))?;
        Ok((Arc::new(study), Arc::new(prepared)))
    }

    /// What an agent sees.
    pub(super) fn observation(&self, seen: &Seen, episode: &Episode) -> [f64; OBSERVED] {
        let [measurement_rad, rate_rad_s] = seen.measured;
        let error_rad = seen.setpoint_rad - measurement_rad;
        let [setpoint, measurement, rate, error] =
            [seen.setpoint_rad, measurement_rad, rate_rad_s, error_rad].map(|it| self.told(it));
        [setpoint, measurement, rate, error, episode.command]
    }

    /// The step of an action at a sample.
    pub(super) fn step(
        &self,
        episode: &mut Episode,
        seen: &Seen,
        action: &[f64],
    ) -> Result<Step<f64>, String> {
        let mut cut = [0.0; 3];
        for ((place, &number), &(least, most)) in cut.iter_mut().zip(action).zip(&self.cuts) {
            if !number.is_finite() {
                return Err(format!("the action is {number}; allowed are finite numbers"));
            }
            *place = number.clamp(least, most);
        }
        let is_cut = cut.iter().zip(action).any(|(cut, given)| cut.to_bits() != given.to_bits());
        let step = match self.action {
            Action::Elevator => Step {
                command_rad: self.in_rad(cut[0]),
                gains: Gains::ZERO,
                saturated: is_cut,
                faults: Faults::NONE,
            },
            Action::Gains { place } => {
                let [kp, ki, kd] = cut;
                let gains = Gains { kp, ki, kd };
                let settings = episode.study.scenario.controllers[place].controller;
                let pid = Pid::new(gains, settings.config_at(gains));
                let pid = Controller::Fixed(pid.map_err(|found| found.to_string())?);
                pid.step(&mut episode.memory, seen.sample())
            }
        };
        episode.command = self.told(step.command_rad);
        Ok(step)
    }

    /// What comes of a step that answered `seen`, with what is seen `then`.
    ///
    /// The reward is $-T |r - \theta|$ at the sample that was answered, so that those of all samples sum up to what the
    /// program calls `iae`, negated. Where a flight is lost, all samples that are left cost as much as its last one.
    pub(super) fn rewarded(
        &self,
        episode: &Episode,
        seen: &Seen,
        then: Result<Seen, Outcome>,
    ) -> Rewarded {
        let timing = episode.prepared.timing();
        let samples = match then {
            Ok(_) | Err(Outcome::Completed) => 1,
            Err(_) => timing.rows() - seen.k,
        };
        let error = self.told((seen.setpoint_rad - seen.theta_rad).abs());
        Rewarded {
            observation: self.observation(then.as_ref().unwrap_or(seen), episode),
            reward: -error * timing.dt_s() * samples as f64,
            outcome: then.err(),
        }
    }
}

/// How a flight ended, in the program's words.
pub(super) fn in_words(outcome: Outcome) -> String {
    let verdict = match outcome {
        Outcome::Completed => Verdict::Flown,
        Outcome::EndedEarly(end) => Verdict::EndedEarly(end),
        Outcome::ModeNeverBegan { mode } => Verdict::ModeNeverBegan { mode },
    };
    verdict.to_string()
}

fn action(study: &Study, wanted: &Wanted) -> Result<Action, String> {
    let scenario = &study.scenario;
    let controllers = &scenario.controllers;
    let place = match &wanted.controller {
        None => 0,
        Some(name) if scenario.externals.iter().any(|named| named.name == *name) => {
            return Err(format!(
                "the controller `{name}` is a program; allowed is one with equations, whose settings are known"
            ));
        }
        Some(name) => {
            let names: Vec<&str> = controllers.iter().map(|named| named.name.as_str()).collect();
            let known = || fspid::scenario::file::known_words(name, &names);
            let found = names.iter().position(|known| known == name);
            found.ok_or_else(|| format!("there is no controller `{name}`{}", known()))?
        }
    };
    match wanted.action.as_str() {
        "elevator" => Ok(Action::Elevator),
        "gains" if controllers.is_empty() => {
            Err("the scenario has no controller with equations, whose gains could be given".into())
        }
        "gains" => Ok(Action::Gains { place }),
        other => Err(format!("the action is `{other}`; allowed is elevator or gains")),
    }
}

/// The scenario, ready for draws.
fn template(py: Python<'_>, scenario: &Scenario) -> PyResult<Template> {
    let (text, name, folder) = scenario.origin();
    let extra = Extra { overrides: scenario.overrides(), ..Extra::default() };
    let template = Template::parse(text, &name, folder, &extra);
    template.map_err(|found| error::problems(py, &found))
}
