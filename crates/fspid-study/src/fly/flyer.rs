//! Who answers samples: a controller with equations, or a program that is asked.

use fspid_core::{Faults, Sample, State};
use fspid_sim::external::Answers;
use fspid_sim::{Controller, ControllerLoss, External, ExternalSource, SimError};

use super::latched::Latched;

/// What no controller believes.
const NO_SAMPLE: Sample<f64> =
    Sample { setpoint_rad: f64::NAN, measurement_rad: f64::NAN, rate_rad_s: f64::NAN };

/// The answer to a sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Stepped {
    /// The command, rad; always finite.
    pub(super) command_rad: f64,
    /// Faults that this sample met.
    pub(super) fault: Faults,
    /// How the controller was lost at this sample.
    pub(super) loss: Option<ControllerLoss>,
}

/// A controller in flight.
#[derive(Debug)]
pub(super) enum Flyer {
    /// By its equations.
    Own { controller: Box<Controller>, state: State<f64> },
    /// By asking.
    External(Asked),
}

impl Flyer {
    /// A controller at rest.
    pub(super) fn own(controller: Controller) -> Self {
        Self::Own { controller: Box::new(controller), state: State::new() }
    }

    /// A program, started.
    pub(super) fn external(external: External) -> Result<Self, SimError> {
        if let ExternalSource::Law(law) = &external.source {
            return Err(SimError::NotStarted {
                file: law.path.display().to_string(),
                reason: "a control law hears all that an aircraft shows, and lines tell of pitch"
                    .to_owned(),
                allowed: "one that answers pitch; `simulate` flies control laws".to_owned(),
            });
        }
        let answers = external.start()?;
        Ok(Self::External(Asked::new(external, answers)))
    }

    /// Its sample period, s.
    pub(super) fn period_s(&self) -> f64 {
        match self {
            Self::Own { controller, .. } => controller.config().dt_s,
            Self::External(asked) => asked.external.dt_s,
        }
    }

    /// True if it needs the pitch rate; what a program does with one is not known.
    pub(super) fn uses_rate(&self) -> bool {
        match self {
            Self::Own { controller, .. } => controller.uses_rate(),
            Self::External(_) => true,
        }
    }

    /// True for a program.
    pub(super) fn is_external(&self) -> bool {
        matches!(self, Self::External(_))
    }

    /// True where nobody answers any more: the command is held until a new start.
    pub(super) fn is_lost(&self) -> bool {
        matches!(self, Self::External(Asked { answers: None, .. }))
    }

    /// Starts a new flight.
    pub(super) fn reset(&mut self) -> Result<(), SimError> {
        match self {
            Self::Own { state, .. } => *state = State::new(),
            Self::External(asked) => {
                // The process of the flight before ends first.
                asked.answers = None;
                (asked.command_rad, asked.latched) = (0.0, Latched::NONE);
                asked.answers = Some(asked.external.start()?);
            }
        }
        Ok(())
    }

    /// The answer to a sample.
    pub(super) fn step(&mut self, sample: Sample<f64>) -> Stepped {
        match self {
            Self::Own { controller, state } => {
                let command_rad = controller.step(state, sample).command_rad;
                Stepped { command_rad, fault: state.take_faults(), loss: None }
            }
            Self::External(asked) => asked.step(sample),
        }
    }

    /// The last command once more, rad, where a line has no sample.
    pub(super) fn hold(&mut self) -> f64 {
        self.step(NO_SAMPLE).command_rad
    }
}

/// A program that is asked, sample by sample.
#[derive(Debug)]
pub(super) struct Asked {
    external: External,
    /// Nobody once it was lost.
    answers: Option<Box<dyn Answers>>,
    /// The last command, rad; 0 before the first.
    command_rad: f64,
    /// What it has told so far: a program tells faults latched.
    latched: Latched,
}

impl Asked {
    /// A program that was started, before its first sample.
    pub(super) fn new(external: External, answers: Box<dyn Answers>) -> Self {
        let answers = Some(answers);
        Self { external, answers, command_rad: 0.0, latched: Latched::NONE }
    }

    /// Angles that are not finite are kept from it: guards are ours, and one that has none would answer NaN for ever. An
    /// export has guards that hold the same command. A rate is not, for who does not use it goes on.
    fn step(&mut self, sample: Sample<f64>) -> Stepped {
        let held = |command_rad, fault, loss| Stepped { command_rad, fault, loss };
        if !(sample.setpoint_rad.is_finite() && sample.measurement_rad.is_finite()) {
            return held(self.command_rad, Faults::NOT_FINITE, None);
        }
        let Some(answers) = &mut self.answers else {
            return held(self.command_rad, Faults::NONE, None);
        };
        match answers.answer(sample) {
            Ok(step) => {
                let fault = self.latched.fault(sample, &step);
                self.command_rad = step.command_rad;
                Stepped { command_rad: step.command_rad, fault, loss: None }
            }
            Err(loss) => {
                self.answers = None;
                held(self.command_rad, Faults::NONE, Some(loss))
            }
        }
    }
}
