//! An aircraft in an FMU, in a process as that of an FMU that is a controller.

use fspid_sim::core::Sample;
use fspid_sim::external::{Answers, Host as _};
use fspid_sim::external_plant::{FmuPlant, PlantSample, SampleInput, Simulates, StepInput};
use fspid_sim::{External, ExternalPlant, ExternalSource, PlantLoss, SimError};

use crate::pace::Pace;
use crate::process::ProcessHost;

/// A flight of it.
#[derive(Debug)]
pub(crate) struct FmuFlight {
    answers: Box<dyn Answers>,
    start: PlantSample,
    pub(crate) pace: Option<Pace>,
    /// Samples so far.
    sample: u64,
}

impl FmuFlight {
    /// Starts it, at rest.
    pub(crate) fn start(
        host: Option<&ProcessHost>,
        (fmu, plant): (&FmuPlant, &ExternalPlant),
        step_s: f64,
    ) -> Result<Self, SimError> {
        let external = External {
            source: ExternalSource::FmuPlant(fmu.file.clone()),
            contents: Some(fmu.contents.clone()),
            answer_limit_s: plant.answer_limit_s,
            dt_s: step_s,
            renamed: fmu.renamed.clone(),
        };
        let mut answers = host.ok_or(SimError::NoPlantHost)?.start(&external).map_err(of_plant)?;
        let lost = |loss: PlantLoss| SimError::PlantNotStarted {
            name: format!("FMU {}", fmu.file.display()),
            reason: format!("it {loss} before its flight"),
            allowed: "an FMU that answers where it starts".to_owned(),
        };
        // Where it starts: no elevator, no step.
        let start = asked(answers.as_mut(), f64::NAN).map_err(lost)?;
        let start = PlantSample { elevator_rad: fmu.trim_elevator_rad, ..start };
        Ok(Self { answers, start, pace: None, sample: 0 })
    }
}

/// What a host says of a controller, of an aircraft.
fn of_plant(error: SimError) -> SimError {
    match error {
        SimError::NotStarted { file, reason, allowed } => {
            SimError::PlantNotStarted { name: format!("FMU {file}"), reason, allowed }
        }
        SimError::Host { file, reason } => {
            SimError::PlantHost { name: format!("FMU {file}"), reason }
        }
        other => other,
    }
}

fn asked(answers: &mut dyn Answers, elevator_rad: f64) -> Result<PlantSample, PlantLoss> {
    let sample = Sample { setpoint_rad: elevator_rad, measurement_rad: 0.0, rate_rad_s: 0.0 };
    let step = answers.answer(sample)?;
    let (theta_rad, q_rad_s) = (step.command_rad, step.gains.kp);
    match theta_rad.is_finite() && q_rad_s.is_finite() {
        true => Ok(PlantSample { theta_rad, q_rad_s, elevator_rad, ..PlantSample::default() }),
        false => Err(PlantLoss::NotFinite),
    }
}

impl Simulates for FmuFlight {
    fn start(&self) -> PlantSample {
        self.start
    }

    /// It has an elevator alone: air and autopilots around an FMU are refused where they are read.
    fn advance(&mut self, _: &SampleInput, steps: &[StepInput]) -> Result<PlantSample, PlantLoss> {
        let mut found = Err(PlantLoss::NoAnswer);
        for step in steps {
            found = Ok(asked(self.answers.as_mut(), step.elevator_rad)?);
        }
        self.sample += 1;
        if let Some(pace) = &mut self.pace {
            pace.wait(self.sample);
        }
        found
    }
}
