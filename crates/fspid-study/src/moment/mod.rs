//! One sample of a flight: what the controller saw, which rules answered, and what its command was made of.
//!
//! The flight is flown again up to that sample by the controller itself, so that everything told here is what flew.

mod json;
mod rules;
mod sets;

use fspid_core::equations::{Memory, Parts};
use fspid_core::{Gains, Sample, State, Step};
use fspid_scenario::file::Study;
use fspid_sim::{Controller, InFlight, Prepared, SimError};

pub use rules::{Fired, Fuzzy, Increment};
pub use sets::{SetCurves, set_curves, visits};

/// A controller at one sample of its flight.
#[derive(Clone, Debug)]
pub struct Moment {
    /// Name of the controller.
    pub controller: String,
    /// Time of the sample, s.
    pub at_s: f64,
    /// What it was given.
    pub sample: Sample<f64>,
    /// What it answered.
    pub step: Step<f64>,
    /// What the answer was made of before any limit.
    pub parts: Parts<f64>,
    /// The command before any limit, rad.
    pub free_rad: f64,
    /// The gains that it starts from.
    pub nominal: Gains<f64>,
    /// What its supervisor saw and concluded; none for fixed gains, and within the dead zone.
    pub fuzzy: Option<Fuzzy>,
}

/// Why there is no moment.
#[derive(Debug, thiserror::Error)]
pub enum NoMoment {
    /// No controller of that name whose equations are here.
    #[error("there is no controller `{0}` whose equations are known")]
    NoController(String),
    /// The flight ended before.
    #[error("the flight of {controller} ended before {at_s} s")]
    Ended {
        /// Who flew.
        controller: String,
        /// What was asked, s.
        at_s: f64,
    },
    /// The scenario cannot be flown.
    #[error(transparent)]
    Simulation(#[from] SimError),
    /// The controller held its last command: a fault.
    #[error("{controller} held its command at {at_s} s: its sample was not admitted")]
    Held {
        /// Who flew.
        controller: String,
        /// What was asked, s.
        at_s: f64,
    },
}

impl Moment {
    /// The controller of that name at the last sample that is not after `at_s`.
    ///
    /// # Errors
    /// [`NoMoment`].
    pub fn of(study: &Study, name: &str, at_s: f64) -> Result<Self, NoMoment> {
        let scenario = &study.scenario;
        let named = scenario.controllers.iter().find(|named| named.name == name);
        let named = named.ok_or_else(|| NoMoment::NoController(name.to_owned()))?;
        let prepared = scenario.prepare()?;
        let Some((before, sample, step, k)) = flown(&prepared, &named.controller, at_s)? else {
            return Err(NoMoment::Ended { controller: name.to_owned(), at_s });
        };
        let (equations, nominal) = (named.controller.equations(), named.controller.nominal());
        let free = equations.free(&before, &sample, &step.gains);
        // What a step answers from its equations; another command is one that was held.
        let answered = equations.regulated(&before, &free, step.gains.ki);
        if answered.command_rad.to_bits() != step.command_rad.to_bits() {
            return Err(NoMoment::Held { controller: name.to_owned(), at_s });
        }
        Ok(Self {
            controller: name.to_owned(),
            at_s: scenario.timing.time_s(k),
            sample,
            step,
            parts: equations.parts(&free, &sample, &step.gains),
            free_rad: free.command_rad,
            nominal,
            fuzzy: match &named.controller {
                Controller::Fixed(_) => None,
                Controller::SelfTuning(fspid) => {
                    Fuzzy::of(fspid.tuner(), fspid.tuner_equations(), &before, &sample)
                }
            },
        })
    }
}

/// The sample asked for: the memory before it, what was seen, the answer and its number.
type Flown = (Memory<f64>, Sample<f64>, Step<f64>, usize);

fn flown(
    prepared: &Prepared,
    controller: &Controller,
    at_s: f64,
) -> Result<Option<Flown>, SimError> {
    let (mut flight, mut state) = (InFlight::start(prepared)?, State::new());
    let timing = prepared.timing();
    let mut found = None;
    while let Ok(seen) = flight.seen() {
        if timing.time_s(seen.k) > at_s && found.is_some() {
            return Ok(found);
        }
        let sample = used(controller, seen.sample());
        let first = || controller.equations().at_first(&sample, &controller.nominal());
        let before = state.memory().unwrap_or_else(first);
        let step = controller.step(&mut state, sample);
        found = Some((before, sample, step, seen.k));
        flight.act(step)?;
    }
    // The last sample of a flight stands for every time up to its end.
    let end_s = timing.end_s();
    Ok(found.filter(|(.., k)| timing.time_s(*k) + timing.dt_s() > at_s.min(end_s)))
}

/// The sample with a rate of zero where no rate matters, as a step takes it.
fn used(controller: &Controller, sample: Sample<f64>) -> Sample<f64> {
    if controller.uses_rate() { sample } else { Sample { rate_rad_s: 0.0, ..sample } }
}
