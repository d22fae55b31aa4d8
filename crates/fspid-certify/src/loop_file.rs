//! Plant, actuator and sensing of a certificate's loop.

use fspid_proof::LoopDescription;
use fspid_proof::sizes::MOST_STATES;
use fspid_sim::actuator::{Actuator, Lag};
use fspid_sim::loop_model::Sensing;
use fspid_sim::{Controller, ElevatorSign, LinearPlant, SimError};
use serde::{Deserialize, Serialize};

use super::shape::Wrong;

/// The loop as written.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct LoopFile {
    pub(super) sample_period_s: f64,
    numerator: Vec<f64>,
    denominator: Vec<f64>,
    elevator_sign: Sign,
    actuator: ActuatorFile,
    pitch_sensing: SensingFile,
    rate_sensing: SensingFile,
}

#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Sign {
    NoseUpPositive,
    NoseDownPositive,
}

#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct ActuatorFile {
    lag: LagFile,
    delay_samples: usize,
    command_limits_rad: Option<(f64, f64)>,
    travel_rad: Option<(f64, f64)>,
    rate_limit_rad_s: Option<f64>,
    bias_rad: f64,
}

#[derive(Debug, Serialize, Deserialize)]
#[serde(tag = "order", rename_all = "kebab-case", deny_unknown_fields)]
enum LagFile {
    None,
    First { time_constant_s: f64 },
    Second { natural_frequency_rad_s: f64, damping: f64 },
}

#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct SensingFile {
    scale: f64,
    samples: usize,
    part: f64,
    resolution: f64,
}

impl LoopFile {
    pub(super) fn of(description: &LoopDescription) -> Self {
        Self {
            sample_period_s: description.controller.config().dt_s,
            numerator: description.numerator.clone(),
            denominator: description.denominator.clone(),
            elevator_sign: match description.elevator_sign {
                ElevatorSign::NoseUpPositive => Sign::NoseUpPositive,
                ElevatorSign::NoseDownPositive => Sign::NoseDownPositive,
            },
            actuator: ActuatorFile::of(&description.actuator),
            pitch_sensing: SensingFile::of(&description.pitch),
            rate_sensing: SensingFile::of(&description.rate),
        }
    }

    /// Everything but the controller, or all that is wrong with it. It is not asked here whether the loop is
    /// one that a proof can speak of.
    pub(super) fn parts(&self) -> Result<LoopParts, Vec<Wrong>> {
        let mut problems = Vec::new();
        let mut tell = |path: &str, what: String| {
            problems.push(Wrong { path: format!("loop.{path}"), what });
        };
        let elevator_sign = match self.elevator_sign {
            Sign::NoseUpPositive => ElevatorSign::NoseUpPositive,
            Sign::NoseDownPositive => ElevatorSign::NoseDownPositive,
        };
        // Refuses what is no plant: lengths, numbers that are not finite, feedthrough.
        let plant = LinearPlant::new(&self.numerator, &self.denominator, elevator_sign);
        let plant = plant.map_err(|error| tell("denominator", error.to_string()));
        let actuator = self.actuator.build().map_err(|error| tell("actuator", error.to_string()));
        let pitch = self.pitch_sensing.build().map_err(|what| tell("pitch_sensing", what));
        let rate = self.rate_sensing.build().map_err(|what| tell("rate_sensing", what));
        let (Ok(_), Ok(actuator), Ok(pitch), Ok(rate)) = (plant, actuator, pitch, rate) else {
            return Err(problems);
        };
        let (numerator, denominator) = (self.numerator.clone(), self.denominator.clone());
        Ok(LoopParts { numerator, denominator, elevator_sign, actuator, pitch, rate })
    }
}

/// A loop without its controller.
#[derive(Debug)]
pub(super) struct LoopParts {
    numerator: Vec<f64>,
    denominator: Vec<f64>,
    elevator_sign: ElevatorSign,
    actuator: Actuator,
    pitch: Sensing,
    rate: Sensing,
}

impl LoopParts {
    pub(super) fn with(self, controller: Controller) -> LoopDescription {
        let Self { numerator, denominator, elevator_sign, actuator, pitch, rate } = self;
        LoopDescription { numerator, denominator, elevator_sign, actuator, pitch, rate, controller }
    }
}

impl ActuatorFile {
    fn of(actuator: &Actuator) -> Self {
        let lag = actuator.lag();
        let second = lag.second_order_parameters();
        Self {
            lag: match (lag.time_constant_s(), second) {
                (Some(time_constant_s), _) => LagFile::First { time_constant_s },
                (None, Some((natural_frequency_rad_s, damping))) => {
                    LagFile::Second { natural_frequency_rad_s, damping }
                }
                (None, None) => LagFile::None,
            },
            delay_samples: actuator.delay_samples(),
            command_limits_rad: actuator.command_limits_rad(),
            travel_rad: actuator.travel_rad(),
            rate_limit_rad_s: actuator.rate_limit_rad_s(),
            bias_rad: actuator.bias_rad(),
        }
    }

    fn build(&self) -> Result<Actuator, SimError> {
        let lag = match self.lag {
            LagFile::None => Lag::NONE,
            LagFile::First { time_constant_s } => Lag::first_order(time_constant_s)?,
            LagFile::Second { natural_frequency_rad_s, damping } => {
                Lag::second_order(natural_frequency_rad_s, damping)?
            }
        };
        let mut actuator =
            Actuator::new(lag).with_delay(self.delay_samples)?.with_bias(self.bias_rad)?;
        if let Some((least, most)) = self.command_limits_rad {
            actuator = actuator.with_command_limits(least, most)?;
        }
        if let Some((least, most)) = self.travel_rad {
            actuator = actuator.with_travel(least, most)?;
        }
        if let Some(limit) = self.rate_limit_rad_s {
            actuator = actuator.with_rate_limit(limit)?;
        }
        Ok(actuator)
    }
}

impl SensingFile {
    fn of(sensing: &Sensing) -> Self {
        Self {
            scale: sensing.scale,
            samples: sensing.samples,
            part: sensing.part,
            resolution: sensing.resolution,
        }
    }

    fn build(&self) -> Result<Sensing, String> {
        let Self { scale, samples, part, resolution } = *self;
        let good = scale.is_finite()
            && (0.0..1.0).contains(&part)
            && samples <= MOST_STATES
            && resolution >= 0.0
            && resolution.is_finite();
        let sensing = Sensing { scale, samples, part, resolution, ..Sensing::DIRECT };
        good.then_some(sensing).ok_or_else(|| {
            format!("allowed are a finite scale, up to {MOST_STATES} samples, a part from 0 to below 1, and a resolution of 0 or more")
        })
    }
}
