//! What a certificate is about, complete in itself.

use core::fmt;

use fspid_core::{AntiWindup, Sees, SelfTuner};
use fspid_fuzzy::scalar::Interval;
use fspid_sim::actuator::Actuator;
use fspid_sim::loop_model::{LoopModel, LoopSettings, Memory, Sensing};
use fspid_sim::{Controller, ElevatorSign, LinearPlant, Scenario, SimError};

use crate::check::{ActuatorLag, NotProved, PrintedPlant};
use crate::gain_set::NoBound;
use crate::sizes::WrongSize;

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
#[derive(Clone, Debug, PartialEq)]
pub enum NotProvable {
    /// Deadband or play: around rest the actuator is no linear system.
    NotLinearAroundRest {
        /// What is in the way.
        what: &'static str,
    },
    /// A sensor with a clock of its own: there is no single matrix from one sample to the next.
    ChangingAge,
    /// A self-tuner of another structure than the paper's.
    Structure {
        /// What is in the way.
        what: &'static str,
    },
    /// Nothing bounds the gains of an accumulating law.
    UnboundedGains(NoBound),
    /// The loop has more states than a proof may speak of.
    TooLarge(WrongSize),
    /// The model is refused.
    Model(SimError),
    /// The plant cannot be enclosed.
    Plant(NotProved),
}

impl fmt::Display for NotProvable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotLinearAroundRest { what } => write!(
                f,
                "the actuator has {what}, so that around rest the loop is not linear and may keep a small oscillation; a proof needs an actuator without"
            ),
            Self::ChangingAge => f.write_str(
                "a sensor samples with a clock of its own, so that the age of its values changes and no single matrix leads from one sample to the next; a proof needs period_s to be that of the loop, or 0",
            ),
            Self::Structure { what } => write!(
                f,
                "{what}; a proof speaks of supervisors whose rules conclude labels and that see the error and its change through even sets, and of controllers of which only the gains move"
            ),
            Self::UnboundedGains(reason) => reason.fmt(f),
            Self::TooLarge(wrong) => wrong.fmt(f),
            Self::Plant(reason) => reason.fmt(f),
            Self::Model(error) => error.fmt(f),
        }
    }
}

impl core::error::Error for NotProvable {}

impl From<NoBound> for NotProvable {
    fn from(reason: NoBound) -> Self {
        Self::UnboundedGains(reason)
    }
}

impl From<NotProved> for NotProvable {
    fn from(reason: NotProved) -> Self {
        Self::Plant(reason)
    }
}

impl From<SimError> for NotProvable {
    fn from(error: SimError) -> Self {
        Self::Model(error)
    }
}

/// What keeps a self-tuner from being proved; nothing for one that is plain.
fn beyond_proof(tuner: &SelfTuner<f64>) -> Option<&'static str> {
    let settings = tuner.settings();
    if tuner.is_plain() {
        return None;
    }
    if tuner.supervisor().numbers().is_some() {
        return Some("the supervisor's rules conclude numbers (Takagi and Sugeno)");
    }
    Some(match settings.sees {
        Sees::ErrorAndRate => "the supervisor sees the measured pitch rate",
        Sees::ErrorAndModelError(_) => "the supervisor sees the error of a reference model",
        Sees::ErrorAndChange if !settings.input_sets.are_even() => {
            "the sets of the supervisor's inputs are not even"
        }
        Sees::ErrorAndChange => "set-point weight or rate gain follow the gains",
    })
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
        let transfer_function = plant.transfer_function();
        let surroundings = &scenario.surroundings;
        let dt_s = controller.shell().dt_s;
        let description = Self {
            numerator: transfer_function.numerator().coefficients().to_vec(),
            denominator: transfer_function.denominator().coefficients().to_vec(),
            elevator_sign: plant.elevator_sign(),
            actuator: scenario.actuator()?,
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
        if self.actuator.deadband_rad() > 0.0 {
            return Err(NotProvable::NotLinearAroundRest { what: "a deadband" });
        }
        if self.actuator.play_rad() > 0.0 {
            return Err(NotProvable::NotLinearAroundRest { what: "play" });
        }
        if let Controller::SelfTuning(fspid) = &self.controller
            && let Some(what) = beyond_proof(fspid.tuner())
        {
            return Err(NotProvable::Structure { what });
        }
        let uses_rate = self.controller.shell().rate_gain_s != 0.0;
        if self.pitch.at_largest_age || (uses_rate && self.rate.at_largest_age) {
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
        let shell = *self.controller.shell();
        let memory = match &self.controller {
            Controller::Fixed(pid) => Memory::of_gains(pid.gains(), &shell),
            Controller::SelfTuning(fspid) => {
                let (nominal, scale) =
                    (fspid.tuner().nominal(), fspid.tuner().settings().output_scale);
                let there = |nominal: f64, scale: f64| nominal != 0.0 || scale != 0.0;
                let integral = there(nominal.ki, scale.ki);
                Memory::of_terms(integral, there(nominal.kd, scale.kd), &shell).with_previous()
            }
        };
        LoopSettings {
            shell,
            memory,
            delay_samples: self.actuator.delay_samples(),
            pitch: self.pitch,
            rate: self.rate,
        }
    }

    /// True with a sample guard that a flight can reach before it counts as lost.
    pub(crate) fn is_guarded(&self) -> bool {
        !(self.controller.shell().guard.limit_rad() >= LOST_RAD)
    }

    /// The loop with every number enclosed.
    ///
    /// # Errors
    /// [`NotProved`] for a plant that cannot be sampled.
    pub fn enclosed(&self) -> Result<LoopModel<Interval>, NotProved> {
        let plant = PrintedPlant {
            numerator: &self.numerator,
            denominator: &self.denominator,
            elevator_sign: self.elevator_sign,
            lag: ActuatorLag::from(self.actuator.lag()),
            dt_s: self.controller.shell().dt_s,
        };
        Ok(LoopModel::new(plant.sampled()?, self.settings()))
    }

    /// What limits motions that are not small, in words; a proof of the loop around rest leaves
    /// these out.
    #[must_use]
    pub fn limits(&self) -> Vec<&'static str> {
        let shell = self.controller.shell();
        let actuator = &self.actuator;
        [
            (shell.limits.is_some(), "output limits of the controller"),
            (shell.slew_rad_s.is_some(), "slew limit of the controller"),
            (matches!(shell.anti_windup, AntiWindup::Clamping(_)), "limits of the integral"),
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
