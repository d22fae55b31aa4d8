//! The sampled loop around rest as one matrix that is affine in the gains.
//!
//! Plant and actuator between two samples, the queue of delayed commands, what the sensors still hold
//! back, and the controller as it is implemented:
//!
//! $$ z_{k+1} = M(k_p, k_i, k_d) z_k, \qquad
//! z = (x, \delta, \text{commands}, \text{pitch}, \text{rate}, I, d, c_{k-1}, w) $$
//!
//! with the set-point at zero and no limit at work. The bumpless integral, the literal one, a filtered
//! or plain derivative and whole-sample delays all leave M affine in the three gains, which is what
//! proofs over corners of a set of gains rest on. A set-point weight that moves with the gains leaves it
//! so, the set-point being zero, and so does a gain of the rate loop that moves with `kd`: it either follows here
//! ([`Followers`]), or is taken as it is at the gains in question ([`Controller::config_at`](crate::Controller::config_at)).
//!
//! The controller's rows are derivatives of the equations that fly, [`fspid_core::equations`]. They are
//! generic over the number, so that an enclosure in intervals and the analysis in floats are of the same
//! loop.

mod assembly;
mod break_point;
mod clocks;
#[cfg(test)]
mod from_the_core;
mod long_way;
mod memory;
mod opening;
mod parts;
mod sensing;
#[cfg(test)]
mod tests;

use fspid_core::{Controller, GainCoupling, Gains, PidConfig};
use fspid_lti::Matrix;
use fspid_numeric::Scalar;
use fspid_numeric::scalar::{Base, Interval};

use crate::error::SimError;
use crate::law::LinearStep;
use crate::plant::LinearPlant;
use crate::scenario::Scenario;

pub use break_point::BreakPoint;
pub(crate) use clocks::{Clocks, Phases, comes_again_after};
pub use long_way::MOST_AS_STATES;
pub use memory::Memory;
pub(crate) use parts::LoopParts;
pub use sensing::Sensing;

/// Plant and actuator over one sample without limits.
#[derive(Clone, Debug, PartialEq)]
pub struct SampledPlant<T> {
    /// States of plant and actuator, pitch angle first.
    pub states: usize,
    /// Rows over states and arriving command, one after the other.
    pub rows: Vec<T>,
    /// Row from states to pitch rate.
    pub rate: Vec<T>,
}

/// What follows the gains of a self-tuner, and the gains from which that is counted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Followers {
    /// By how much.
    pub coupling: GainCoupling<f64>,
    /// The gains at which the configuration is what it says.
    pub nominal: Gains<f64>,
}

impl Followers {
    /// Nothing follows: the configuration is that of the gains in question.
    pub const NONE: Self = Self { coupling: GainCoupling::NONE, nominal: Gains::ZERO };

    /// Those of a controller.
    #[must_use]
    pub fn of(controller: &Controller<f64>) -> Self {
        match controller {
            Controller::Fixed(_) => Self::NONE,
            Controller::SelfTuning(fspid) => Self {
                coupling: fspid.tuner().settings().gain_coupling,
                nominal: fspid.tuner().nominal(),
            },
        }
    }
}

/// Everything of a loop around rest but its gains and its plant.
#[derive(Clone, Debug, PartialEq)]
pub struct LoopSettings {
    /// Everything of the controller but its gains.
    pub config: PidConfig<f64>,
    /// What of that moves with the gains.
    pub followers: Followers,
    /// What of the controller's memory is part of the loop.
    pub memory: Memory,
    /// Whole samples by which a command arrives late.
    pub delay_samples: usize,
    /// How the pitch angle is seen.
    pub pitch: Sensing,
    /// How the pitch rate is seen.
    pub rate: Sensing,
}

impl LoopSettings {
    /// True if the seen rate enters the command at some gains.
    #[must_use]
    pub fn uses_rate(&self) -> bool {
        self.config.rate_gain_s != 0.0 || self.followers.coupling.rate_gain != 0.0
    }

    /// Those of a scenario with a controller's configuration at its gains.
    pub(crate) fn of(scenario: &Scenario, config: &PidConfig<f64>, memory: Memory) -> Self {
        let surroundings = &scenario.surroundings;
        Self {
            config: *config,
            followers: Followers::NONE,
            memory,
            delay_samples: scenario.actuator.delay_samples(),
            pitch: Sensing::through(surroundings.pitch_sensor.as_ref(), config.dt_s),
            rate: Sensing::through(surroundings.rate_sensor.as_ref(), config.dt_s),
        }
    }
}

impl From<LinearStep> for SampledPlant<f64> {
    /// Without the disturbance at the elevator.
    fn from(step: LinearStep) -> Self {
        let by_state_and_command = step.rows.chunks_exact(step.states + 2);
        let rows = by_state_and_command.flat_map(|row| &row[..=step.states]).copied().collect();
        Self { states: step.states, rows, rate: step.rate_row }
    }
}

impl SampledPlant<f64> {
    /// One of a scenario's plants, with its actuator, over a sample of the scenario.
    ///
    /// # Errors
    /// [`SimError`] where it cannot be sampled.
    pub fn of(scenario: &Scenario, plant: &LinearPlant) -> Result<Self, SimError> {
        let step = scenario.propagation(plant, scenario.timing.dt_s())?.linear_step();
        step.map(Self::from).ok_or(SimError::NotLinear)
    }
}

/// What gains that remember make of a constant part of the command, a state of the loop:
///
/// $$ w_k = \phi w_{k-1} + a e_k + b (e_k - c_{k-1}) - r q_k, \qquad u_k = \dots + w_k $$
///
/// with the seen error e, the last one c and the seen rate q.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gathered<T> {
    /// What stays of it from one sample to the next, φ.
    pub keeps: T,
    /// By the error, a, rad per rad.
    pub by_error: T,
    /// By the change of the error in a sample, b, rad per rad. It acts only in a loop that remembers the last sample.
    pub by_change: T,
    /// By the rate, r, s.
    pub by_rate: T,
}

/// A sampled loop around rest.
#[derive(Clone, Debug, PartialEq)]
pub struct LoopModel<T> {
    plant: SampledPlant<T>,
    settings: LoopSettings,
    /// Rows of the plant over states and command, less 1 on the diagonal, and what 64 bits leave out of them.
    change: Option<[Vec<T>; 2]>,
    /// Rad of command per rad by which the error changes in a sample, beside the derivative.
    change_gain: T,
    gathered: Option<Gathered<T>>,
}

impl<T: Base> LoopModel<T> {
    /// A loop of a sampled plant.
    #[must_use]
    pub fn new(plant: SampledPlant<T>, settings: LoopSettings) -> Self {
        Self { plant, settings, change: None, change_gain: T::zero(), gathered: None }
    }

    /// The loop with a command of so many rad for each rad by which the error changes in a sample, beside the
    /// derivative: what gains that move with the change make of a constant part of the command. It acts only in a
    /// loop that remembers the last sample.
    #[must_use]
    pub fn with_change_gain(&self, change_gain: T) -> Self {
        Self { change_gain, ..self.clone() }
    }

    /// The loop with what gains that remember make of a constant part of the command.
    #[must_use]
    pub fn with_gathered(&self, gathered: Option<Gathered<T>>) -> Self {
        Self { gathered, ..self.clone() }
    }

    /// True if the seen rate is part of the loop; what is gathered may see it.
    fn uses_rate(&self) -> bool {
        self.settings.uses_rate() || self.gathered.is_some()
    }

    /// Everything but gains and plant.
    #[must_use]
    pub fn settings(&self) -> &LoopSettings {
        &self.settings
    }

    /// True where a sensor shows values of changing age, of which the largest is in the loop.
    #[must_use]
    pub fn has_changing_ages(&self) -> bool {
        let rate = self.uses_rate() && self.settings.rate.at_largest_age;
        self.settings.pitch.at_largest_age || rate
    }

    /// The loop as if sensors whose values change their age showed the quantity as it is.
    #[must_use]
    pub fn without_changing_ages(mut self) -> Self {
        for sensing in [&mut self.settings.pitch, &mut self.settings.rate] {
            if sensing.at_largest_age {
                *sensing = Sensing::DIRECT;
            }
        }
        self
    }

    /// The loop with sensors, pitch and rate, that look otherwise.
    #[must_use]
    pub(crate) fn seeing(&self, [pitch, rate]: [Sensing; 2]) -> Self {
        let settings = LoopSettings { pitch, rate, ..self.settings.clone() };
        Self { settings, ..self.clone() }
    }

    /// The plant.
    #[must_use]
    pub fn plant(&self) -> &SampledPlant<T> {
        &self.plant
    }

    /// Number of states.
    #[must_use]
    pub fn size(&self) -> usize {
        self.layout().size()
    }

    /// What each state is, in the order of the matrix.
    #[must_use]
    pub fn state_names(&self) -> Vec<String> {
        self.layout().names()
    }

    /// The one-sample matrix of the closed loop, row after row.
    #[must_use]
    pub fn closed(&self, gains: Gains<T>) -> Vec<Vec<T>> {
        self.assembly(gains).closed()
    }

    /// The row from the state to the command, rad, limits left out.
    #[must_use]
    pub fn command_row(&self, gains: Gains<T>) -> Vec<T> {
        self.assembly(gains).command()
    }

    /// The row from the state to the command that arrives at the actuator now, rad.
    #[must_use]
    pub fn arriving_row(&self, gains: Gains<T>) -> Vec<T> {
        self.assembly(gains).arriving()
    }

    /// The row from the state to the integral's term of the command, rad; zeros without an integral.
    #[must_use]
    pub fn integral_row(&self, gains: Gains<T>) -> Vec<T> {
        self.assembly(gains).integral_term()
    }

    /// The state in which the pitch angle is off by `pitch`, as long as the loop remembers, and
    /// everything else at rest.
    #[must_use]
    pub fn pitch_off(&self, pitch: T) -> Vec<T> {
        self.assembly(zero_gains()).pitch_off(pitch, self.settings.pitch.scale)
    }

    /// What a unit of command adds to the next state, rad.
    #[must_use]
    pub fn by_command(&self) -> Vec<T> {
        self.assembly(zero_gains()).broken(BreakPoint::Command).entry
    }

    /// What a unit that is added to what the loop sees of a quantity adds to the next state.
    #[must_use]
    pub fn by_seen(&self, point: BreakPoint, gains: Gains<T>) -> Vec<T> {
        self.assembly(gains).broken(point).entry
    }

    /// What a unit that is added to the seen pitch, and to the seen rate, adds to the command at once.
    #[must_use]
    pub fn command_by_seen(&self, gains: Gains<T>) -> [T; 2] {
        self.assembly(gains).command_by_seen()
    }

    /// Rows from the state to the seen pitch, rad, and the seen rate, rad/s; zeros for a rate that is not used.
    #[must_use]
    pub fn seen_rows(&self) -> [Vec<T>; 2] {
        let assembly = self.assembly(zero_gains());
        [BreakPoint::Pitch, BreakPoint::Rate].map(|point| assembly.broken(point).exit)
    }

    /// Rows from the state to the error, rad, and its change since the last sample, rad, as the
    /// controller sees them; the change is 0 in a loop that does not remember the last sample.
    #[must_use]
    pub fn error_rows(&self) -> [Vec<T>; 2] {
        self.assembly(zero_gains()).error_rows()
    }
}

impl LoopModel<f64> {
    /// The loop of one of a scenario's plants with a controller's configuration.
    ///
    /// # Errors
    /// [`SimError`] where the plant cannot be sampled.
    pub fn of(
        scenario: &Scenario,
        plant: &LinearPlant,
        config: &PidConfig<f64>,
        memory: Memory,
    ) -> Result<Self, SimError> {
        let plant = SampledPlant::of(scenario, plant)?;
        Ok(Self::new(plant, LoopSettings::of(scenario, config, memory)))
    }

    /// The same loop with the digits of its slow modes, which the matrix of a sample has not beside its ones: for
    /// margins, which are then proved of the loop itself. The plant and the scenario are those it was made of.
    ///
    /// # Errors
    /// [`SimError`] where the plant cannot be sampled.
    pub fn sharpened(self, scenario: &Scenario, plant: &LinearPlant) -> Result<Self, SimError> {
        let propagation = scenario.propagation(plant, self.settings.config.dt_s)?;
        Ok(Self { change: propagation.linear_change(plant)?, ..self })
    }

    /// The one-sample matrix of the closed loop.
    ///
    /// # Errors
    /// Gains so large that an entry overflows, and a way that is too long for a matrix.
    pub fn closed_matrix(&self, gains: Gains<f64>) -> Result<Matrix, SimError> {
        self.settings.require_matrix()?;
        Ok(Matrix::from_rows(&self.closed(gains))?)
    }
}

impl LoopModel<Interval> {
    /// The loop of the middles of all numbers.
    #[must_use]
    pub fn midpoint(&self) -> LoopModel<f64> {
        let middles = |values: &[Interval]| values.iter().map(|value| value.midpoint()).collect();
        let plant = SampledPlant {
            states: self.plant.states,
            rows: middles(&self.plant.rows),
            rate: middles(&self.plant.rate),
        };
        let change_gain = self.change_gain.midpoint();
        let gathered = self.gathered.map(|it| Gathered {
            keeps: it.keeps.midpoint(),
            by_error: it.by_error.midpoint(),
            by_change: it.by_change.midpoint(),
            by_rate: it.by_rate.midpoint(),
        });
        LoopModel { plant, settings: self.settings.clone(), change: None, change_gain, gathered }
    }
}

fn zero_gains<T: Scalar>() -> Gains<T> {
    Gains { kp: T::zero(), ki: T::zero(), kd: T::zero() }
}
