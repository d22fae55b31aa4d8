//! Control laws that come as files: they see all that an aircraft shows, remember nothing, and move more than the elevator.

use std::fmt;
use std::path::PathBuf;
use std::sync::Arc;

use fspid_core::{Faults, Gains, Sample, Step};

use crate::aircraft::AircraftSample;
use crate::external::{Answers, Asked, ControllerLoss};
use crate::seen::Seen;

/// Outputs of a control law at one sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LawAnswer {
    /// The command of the elevator from the trim, nose up positive, rad.
    pub command_rad: f64,
    /// What else it moves.
    pub asked: Asked,
}

/// A control law without a memory.
pub trait ControlLaw: fmt::Debug + Send + Sync {
    /// What it wants at a sample. Pitch and pitch rate are those of [`Seen::measured`], through the sensors of the
    /// scenario; all else is true.
    fn answer(&self, seen: &Seen, aircraft: &AircraftSample) -> LawAnswer;
}

/// A control law and the file that it came from. Two are equal if they are the same object.
#[derive(Clone, Debug)]
pub struct SharedLaw {
    /// Its file.
    pub path: PathBuf,
    /// The law.
    pub law: Arc<dyn ControlLaw>,
}

impl PartialEq for SharedLaw {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.law, &other.law)
    }
}

impl Eq for SharedLaw {}

impl SharedLaw {
    /// One flight of it.
    pub(crate) fn start(&self) -> LawInFlight {
        LawInFlight { law: Arc::clone(&self.law), asked: Asked::default() }
    }
}

/// A control law in flight.
#[derive(Debug)]
pub(crate) struct LawInFlight {
    law: Arc<dyn ControlLaw>,
    asked: Asked,
}

impl Answers for LawInFlight {
    /// A control law cannot answer a sample of pitch alone.
    fn answer(&mut self, _: Sample<f64>) -> Result<Step<f64>, ControllerLoss> {
        Err(ControllerLoss::NoAnswer)
    }

    fn answer_aboard(
        &mut self,
        seen: &Seen,
        aircraft: Option<&AircraftSample>,
    ) -> Result<Step<f64>, ControllerLoss> {
        let LawAnswer { command_rad, asked } =
            self.law.answer(seen, aircraft.ok_or(ControllerLoss::NoAnswer)?);
        let others = asked.throttle.into_iter().chain(asked.lateral_rad.into_iter().flatten());
        if !others.chain([command_rad]).all(f64::is_finite) {
            return Err(ControllerLoss::NotFinite);
        }
        self.asked = asked;
        Ok(Step { command_rad, gains: Gains::ZERO, saturated: false, faults: Faults::NONE })
    }

    fn asked(&self) -> Asked {
        self.asked
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Debug)]
    struct Answering(LawAnswer);

    impl ControlLaw for Answering {
        fn answer(&self, _: &Seen, _: &AircraftSample) -> LawAnswer {
            self.0
        }
    }

    fn asked(command_rad: f64, asked: Asked) -> Result<Step<f64>, ControllerLoss> {
        let law = Arc::new(Answering(LawAnswer { command_rad, asked }));
        let shared = SharedLaw { path: PathBuf::from("a.dml"), law };
        let seen =
            Seen { k: 0, setpoint_rad: 0.0, theta_rad: 0.0, q_rad_s: 0.0, measured: [0.0; 2] };
        shared.start().answer_aboard(&seen, Some(&AircraftSample::default()))
    }

    #[test]
    fn a_law_that_answers_no_number_anywhere_is_lost_and_not_followed() {
        assert_eq!(asked(0.1, Asked::default()).map(|step| step.command_rad), Ok(0.1));
        let throttle = Asked { throttle: Some(f64::NAN), ..Asked::default() };
        let rudder = Asked { lateral_rad: Some([0.0, f64::INFINITY]), ..Asked::default() };
        for (command_rad, more) in [(f64::NAN, Asked::default()), (0.0, throttle), (0.0, rudder)] {
            assert_eq!(asked(command_rad, more).err(), Some(ControllerLoss::NotFinite));
        }
    }
}
