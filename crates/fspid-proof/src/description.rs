//! What a certificate is about, complete in itself.

use fspid_core::{AntiWindup, PidConfig, SecondInput, SelfTuner, TunerSettings};
use fspid_numeric::scalar::Interval;
use fspid_sim::actuator::{Actuator, ActuatorParts};
use fspid_sim::loop_model::{Followers, LoopModel, LoopSettings, Memory, Sensing};
use fspid_sim::sensor::Sensor;
use fspid_sim::{Controller, ElevatorSign, LinearPlant, Scenario, SimError};

use crate::caps::WrongSize;
use crate::check::{ActuatorLag, NotProved, PrintedPlant};
use crate::gain_set::NoBound;

/// A flight whose pitch angle goes beyond this is lost: $10^6$ degrees, as in simulations.
const LOST_RAD: f64 = 1e6 * core::f64::consts::PI / 180.0;

/// A loop from plant to controller, with everything that its proof rests on.
#[derive(Clone, Debug, PartialEq)]
pub struct LoopDescription {
    /// Numerator from elevator to pitch, highest power of s first.
    pub numerator: Vec<f64>,
    /// Denominator, highest power of s first.
    pub denominator: Vec<f64>,
    /// Which way the elevator is counted.
    pub elevator_sign: ElevatorSign,
    /// What moves the elevator.
    pub actuator: Actuator,
    /// How the pitch angle is seen.
    pub pitch: Sensing,
    /// How the pitch rate is seen.
    pub rate: Sensing,
    /// Who answers.
    pub controller: Controller,
}

/// Why nothing can be proved of a loop.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum NotProvable {
    /// Deadband or play: around rest the actuator is no linear system.
    #[error(
        "the actuator has {what}, so that around rest the loop is not linear and may keep a small oscillation; a proof needs an actuator without"
    )]
    NotLinearAroundRest {
        /// What is in the way.
        what: &'static str,
    },
    /// A sensor with a clock of its own: there is no single matrix from one sample to the next.
    #[error(
        "a sensor samples with a clock of its own, so that the age of its values changes and no single matrix leads from one sample to the next; a proof needs period_s to be that of the loop, or 0"
    )]
    ChangingAge,
    /// A vertical gyro that erects, in an aircraft.
    #[error(
        "the vertical gyro erects to the apparent vertical at a bounded rate, so that around rest the loop is not linear and may keep an oscillation; a proof needs erection_deg_min to be 0"
    )]
    Erection,
    /// A trim right on a kink of the aircraft's data.
    #[error(
        "the trim lies right on a kink of the aircraft's data, where each side has slopes of its own and no linear model is that of its small motions; a proof needs a trim beside it"
    )]
    Kink,
    /// A rate that is seen at rest, and gains that depend on it or multiply it.
    #[error(
        "{what}, and the rate sensor has a bias: at rest a rate is seen that is not there, so that rest is not at the nominal gains and moves with them; a proof needs a rate sensor without bias"
    )]
    BiasedRate {
        /// What is in the way.
        what: &'static str,
    },
    /// Somebody did not want the answer any more.
    #[error("it was stopped before there was an answer, which says nothing of the loop")]
    Stopped,
    /// Nothing bounds the gains of an accumulating law.
    #[error(transparent)]
    UnboundedGains(#[from] NoBound),
    /// The loop has more states than a proof may speak of.
    #[error("{0}")]
    TooLarge(WrongSize),
    /// The model is refused.
    #[error(transparent)]
    Model(#[from] SimError),
    /// The plant cannot be enclosed.
    #[error(transparent)]
    Plant(#[from] NotProved),
}

/// What keeps a self-tuner from being proved, where its rate sensor shows a rate that is not there.
fn beyond_proof(tuner: &SelfTuner<f64>) -> Option<&'static str> {
    let TunerSettings {
        // Covered: an error turned round is another cell of the same surface.
        error_sign: _,
        // Covered: all inputs are in the claim, whatever shows them, but for a bias.
        second_input,
        // Covered by the rows of the supervisor's inputs.
        change: _,
        input_scale: _,
        // Covered: cells are told by their inputs.
        input_sets: _,
        // Covered by the set of gains.
        output_scale: _,
        // Covered by the loop, which is affine in the gains with its followers, but for a bias.
        gain_coupling,
        law: _,
        gain_limits: _,
        dead_zone: _,
    } = tuner.settings();
    if *second_input == SecondInput::Rate {
        return Some("the supervisor sees the measured pitch rate");
    }
    (gain_coupling.rate_gain != 0.0).then_some("the gain of the pitch rate follows kd")
}

/// What keeps an actuator from being proved.
fn not_linear_around_rest(actuator: &Actuator) -> Option<&'static str> {
    let ActuatorParts {
        // Covered by the model of the plant and its queue.
        lag: _,
        delay_samples: _,
        // Bounded: an ellipsoid in which none acts, or said to be left out.
        command_limits_rad: _,
        rate_limit_rad_s: _,
        travel_rad: _,
        deadband_rad,
        play_rad,
        // Bounded: a load.
        bias_rad: _,
    } = actuator.parts();
    // Written so that NaN is refused.
    if !(deadband_rad <= 0.0) {
        return Some("a deadband");
    }
    (!(play_rad <= 0.0)).then_some("play")
}

impl LoopDescription {
    /// The loop of one of a scenario's plants with a controller.
    ///
    /// # Errors
    /// [`NotProvable`] for a structure whose matrix is not affine in the gains, or not one matrix.
    pub fn of(
        scenario: &Scenario,
        plant: &LinearPlant,
        controller: &Controller,
    ) -> Result<Self, NotProvable> {
        if plant.is_between_slopes() {
            return Err(NotProvable::Kink);
        }
        let transfer_function = plant.transfer_function();
        let surroundings = &scenario.surroundings;
        let dt_s = controller.config().dt_s;
        let erects = |sensor: &Sensor| sensor.model().erection_rad_s > 0.0;
        // A linear plant has no speed, and its apparent vertical is the true one.
        if scenario.plant.aircraft().is_some() && surroundings.pitch_sensor.iter().any(erects) {
            return Err(NotProvable::Erection);
        }
        let biased = surroundings.rate_sensor.as_ref().is_some_and(|sensor| sensor.bias() != 0.0);
        if let Controller::SelfTuning(fspid) = controller
            && biased
            && let Some(what) = beyond_proof(fspid.tuner())
        {
            return Err(NotProvable::BiasedRate { what });
        }
        let description = Self {
            numerator: transfer_function.numerator().coefficients().to_vec(),
            denominator: transfer_function.denominator().coefficients().to_vec(),
            elevator_sign: plant.elevator_sign(),
            actuator: scenario.actuator,
            pitch: Sensing::through(surroundings.pitch_sensor.as_ref(), dt_s),
            rate: Sensing::through(surroundings.rate_sensor.as_ref(), dt_s),
            controller: *controller,
        };
        description.provable()
    }

    /// The description if it is of a loop that a proof can speak of.
    ///
    /// # Errors
    /// [`NotProvable`].
    pub fn provable(self) -> Result<Self, NotProvable> {
        if let Some(what) = not_linear_around_rest(&self.actuator) {
            return Err(NotProvable::NotLinearAroundRest { what });
        }
        if self.pitch.at_largest_age || (self.controller.uses_rate() && self.rate.at_largest_age) {
            return Err(NotProvable::ChangingAge);
        }
        // Before anything is enclosed: the size of everything that follows.
        if let Some(wrong) = self.too_large() {
            return Err(NotProvable::TooLarge(wrong));
        }
        Ok(self)
    }

    /// Everything of the loop but plant and gains.
    #[must_use]
    pub fn settings(&self) -> LoopSettings {
        let config = *self.controller.config();
        let memory = match &self.controller {
            Controller::Fixed(pid) => Memory::of_gains(pid.gains(), &config),
            Controller::SelfTuning(fspid) => {
                let (nominal, scale) =
                    (fspid.tuner().nominal(), fspid.tuner().settings().output_scale);
                let there = |nominal: f64, scale: f64| nominal != 0.0 || scale != 0.0;
                let integral = there(nominal.ki, scale.ki);
                Memory::of_terms(integral, there(nominal.kd, scale.kd), &config).with_previous()
            }
        };
        LoopSettings {
            config,
            followers: Followers::of(&self.controller),
            memory,
            delay_samples: self.actuator.delay_samples(),
            pitch: self.pitch,
            rate: self.rate,
        }
    }

    /// True with a sample guard that a flight can reach before it counts as lost.
    pub(crate) fn is_guarded(&self) -> bool {
        !(self.controller.config().guard.limit_rad() >= LOST_RAD)
    }

    /// True where the pitch rate moves the gains and nothing else.
    pub(crate) fn only_supervisor_sees_rate(&self) -> bool {
        self.controller.uses_rate() && !self.settings().uses_rate()
    }

    /// The loop with every number enclosed.
    ///
    /// # Errors
    /// [`NotProved`] for a plant that cannot be sampled.
    pub fn enclosed(&self) -> Result<LoopModel<Interval>, NotProved> {
        Ok(LoopModel::new(self.printed().sampled()?, self.settings()))
    }

    /// Plant and actuator as they are printed.
    #[must_use]
    pub fn printed(&self) -> PrintedPlant<'_> {
        PrintedPlant {
            numerator: &self.numerator,
            denominator: &self.denominator,
            elevator_sign: self.elevator_sign,
            lag: ActuatorLag::from(self.actuator.lag()),
            dt_s: self.controller.config().dt_s,
        }
    }

    /// What limits motions that are not small, in words; a proof of the loop around rest leaves
    /// these out.
    #[must_use]
    pub fn limits(&self) -> Vec<&'static str> {
        let PidConfig {
            // Covered by the model of the loop.
            dt_s: _,
            rate_gain_s: _,
            derivative: _,
            // Covered with fixed gains; with gains that move bounded, by the range of set-points and loads.
            setpoint_weights: _,
            integral: _,
            // Covered: it stands still with the set-point; the integral takes it up, without one it is in the error.
            feedforward: _,
            anti_windup,
            limits,
            slew_rad_s,
            // Bounded, see `is_guarded`.
            guard: _,
        } = self.controller.config();
        let actuator = &self.actuator;
        let clamps = match anti_windup {
            AntiWindup::Clamping(_) => true,
            // These act at limits alone.
            AntiWindup::None | AntiWindup::Conditional | AntiWindup::BackCalculation { .. } => {
                false
            }
        };
        [
            (limits.is_some(), "output limits of the controller"),
            (slew_rad_s.is_some(), "slew limit of the controller"),
            (clamps, "limits of the integral"),
            (actuator.command_limits_rad().is_some(), "limits of the servo's command"),
            (actuator.travel_rad().is_some(), "ends of the actuator's travel"),
            (actuator.rate_limit_rad_s().is_some(), "rate limit of the actuator"),
            (self.is_guarded(), "sample guard of the controller"),
        ]
        .into_iter()
        .filter_map(|(there, what)| there.then_some(what))
        .collect()
    }
}
