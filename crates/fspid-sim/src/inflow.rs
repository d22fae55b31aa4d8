//! Inputs of a linear plant that do not depend on the controller: disturbances and gusts at every sample.

use crate::error::SimError;
use crate::plant::LinearPlant;
use crate::propagation::Propagation;
use crate::scenario::Scenario;
use crate::surroundings::held;

/// Set-point, disturbances and air of a flight of one linear plant, sample by sample: everything that does not depend on
/// commands. With the sampled plant it is the flight for any history of commands.
#[derive(Clone, Debug, PartialEq)]
pub struct Inflow {
    /// Commanded pitch, rad.
    pub setpoint_rad: Vec<f64>,
    /// Added to the command that arrives at the actuator, rad.
    pub at_servo_rad: Vec<f64>,
    /// Added to the deflection, without the actuator's bias, rad.
    pub at_elevator_rad: Vec<f64>,
    /// What the air adds to the plant's states over the sample; empty in calm air.
    pub by_air: Vec<Vec<f64>>,
}

impl Scenario {
    /// What enters this scenario's plant, if it is linear and stays as it is, with that plant.
    ///
    /// # Errors
    /// [`SimError::NotLinear`] for another plant and for one that changes; otherwise as [`prepare`](Self::prepare).
    pub fn inflow(&self) -> Result<(Inflow, &LinearPlant), SimError> {
        let prepared = self.prepare()?;
        let (Some(plant), [stage]) = (self.plant.linear(), prepared.stages.as_slice()) else {
            return Err(SimError::NotLinear);
        };
        let rows = prepared.timing().rows();
        let air = (prepared.gusts(), prepared.gust_responses.as_deref());
        let by_air = match &stage.propagation {
            Propagation::ByLegs(actuated) if prepared.gusts().is_some() => {
                (0..rows).map(|k| actuated.by_air(&held(0.0, air, k))).collect()
            }
            _ => Vec::new(),
        };
        let column = |values: &Option<Vec<f64>>| values.clone().unwrap_or_else(|| vec![0.0; rows]);
        let inflow = Inflow {
            setpoint_rad: prepared.setpoint_rad().to_vec(),
            at_servo_rad: column(&prepared.at_servo),
            at_elevator_rad: column(&prepared.at_elevator),
            by_air,
        };
        Ok((inflow, plant))
    }
}
