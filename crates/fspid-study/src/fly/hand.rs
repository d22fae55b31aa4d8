//! A controller that is asked sample by sample, by who has a clock of its own.

use fspid_core::Sample;
use fspid_sim::{ControllerLoss, Scenario};

use super::flyer::Flyer;
use super::pilot::{ChoiceError, flyer};

/// A controller of a scenario in flight.
#[derive(Debug)]
pub struct Hand(Flyer);

impl Hand {
    /// The scenario's controller of that name, or its only one, before its first sample.
    ///
    /// # Errors
    /// As [`Pilot::new`](super::Pilot::new).
    pub fn new(scenario: &Scenario, name: Option<&str>) -> Result<Self, ChoiceError> {
        flyer(scenario, name).map(Self)
    }

    /// Its command, rad, nose up positive; always finite. A sample that is not finite gets the last one once more.
    ///
    /// # Errors
    /// [`ControllerLoss`] of a program, which answers no more.
    pub fn answer(&mut self, sample: Sample<f64>) -> Result<f64, ControllerLoss> {
        let stepped = self.0.step(sample);
        stepped.loss.map_or(Ok(stepped.command_rad), Err)
    }
}
