//! Systems on which no controller and no simulator can be started.

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;

use fspid_sim::external::{Answers, Host};
use fspid_sim::external_plant::{Beginning, JsbsimLinear, PlantHost, Simulates};
use fspid_sim::{External, ExternalPlant, SimError};

use crate::flight_stack;

/// What would start external controllers.
#[derive(Clone, Debug)]
pub struct ProcessHost;

impl ProcessHost {
    /// Starts nothing here.
    #[must_use]
    pub fn new(_: PathBuf, _: &[&str]) -> Self {
        Self
    }

    /// Tells nothing here.
    #[must_use]
    pub fn telling(self, _: fn(&str)) -> Self {
        self
    }

    /// Keeps no time here.
    #[must_use]
    pub fn in_real_time(self, _: fn(&str)) -> Self {
        self
    }

    /// Prints nothing here.
    #[must_use]
    pub fn printing_at_most(self, _: u64) -> Self {
        self
    }
}

impl Host for ProcessHost {
    fn start(&self, external: &External) -> Result<Box<dyn Answers>, SimError> {
        if let Some(stack) = external.source.flight_stack() {
            return flight_stack::start(external, stack, None, Arc::new(|_| {}));
        }
        Err(SimError::NotStarted {
            file: external.source.name(),
            reason: "external controllers talk over a socket of Unix, which this system has not"
                .to_owned(),
            allowed: "a scenario without them, or fspid on Linux or macOS".to_owned(),
        })
    }
}

/// Serves nothing here.
#[must_use]
pub fn serve(_: &str, _: &Path, _: f64, _: &[String]) -> ExitCode {
    ExitCode::FAILURE
}

/// What would start other simulators.
#[derive(Clone, Debug)]
pub struct SimulatorHost;

impl SimulatorHost {
    /// Starts nothing here.
    #[must_use]
    pub fn new(_: PathBuf) -> Self {
        Self
    }

    /// Flies nothing here.
    #[must_use]
    pub fn flying_fmus(self, _: ProcessHost) -> Self {
        self
    }

    /// Tells nothing here.
    #[must_use]
    pub fn in_real_time(self, _: fn(&str)) -> Self {
        self
    }

    /// Starts nothing here.
    #[must_use]
    pub fn starting_within(self, _: std::time::Duration) -> Self {
        self
    }
}

impl PlantHost for SimulatorHost {
    fn start(&self, plant: &ExternalPlant, _: &Beginning) -> Result<Box<dyn Simulates>, SimError> {
        Err(nowhere(plant))
    }

    fn linear_model(&self, plant: &ExternalPlant) -> Result<JsbsimLinear, SimError> {
        Err(nowhere(plant))
    }
}

fn nowhere(plant: &ExternalPlant) -> SimError {
    let reason = "other simulators talk over a socket of Unix, which this system has not";
    SimError::PlantHost { name: plant.simulator.name().to_owned(), reason: reason.to_owned() }
}
