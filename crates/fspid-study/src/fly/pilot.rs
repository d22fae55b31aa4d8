//! The controller's side of the conversation.

use std::fmt;

use fspid_core::{Faults, Sample, State};
use fspid_sim::{Controller, NamedController, Scenario};

use super::line::{Angles, Line, Request};
use super::log::{Log, Summary};
use super::rate::RateFilter;
use fspid_diagnostics::known_words;

/// Of the period: how far `dt_s` may lie beside it and still be kept. As for events in a scenario.
const SAME_PERIOD: f64 = 1e-6;
/// What no controller believes.
const NO_SAMPLE: Sample<f64> =
    Sample { setpoint_rad: f64::NAN, measurement_rad: f64::NAN, rate_rad_s: f64::NAN };
/// Faults at which a controller holds its command.
const HOLDING: [Faults; 3] = [Faults::NOT_FINITE, Faults::IMPLAUSIBLE, Faults::OVERFLOW];

/// Why no controller was chosen.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ChoiceError {
    /// There are several, and none was named.
    #[error("several controllers; choose one with --controller: {}", known.join(", "))]
    Several {
        /// Their names.
        known: Vec<String>,
    },
    /// It is a program that has a socket of its own.
    #[error(
        "`{name}` is an external controller, which flies in simulate, verify, analyse --fly, campaign and contest alone; choose one with equations"
    )]
    External {
        /// Its name.
        name: String,
    },
    /// There is none of that name.
    #[error("there is no controller `{name}`{}", known_words(name, &names(known)))]
    Unknown {
        /// The name.
        name: String,
        /// The names there are.
        known: Vec<String>,
    },
}

fn names(known: &[String]) -> Vec<&str> {
    known.iter().map(String::as_str).collect()
}

/// A line out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Answer {
    /// The controller has started anew.
    Ready,
    /// A command in the unit of the line, nose up positive; always finite.
    Command(f64),
}

impl fmt::Display for Answer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Ready => f.write_str("ok"),
            // Zero without a sign, as in traces.
            Self::Command(command) => write!(f, "{:?}", command + 0.0),
        }
    }
}

/// A controller that answers lines.
#[derive(Clone, Debug)]
pub struct Pilot {
    controller: Controller,
    angles: Angles,
    state: State<f64>,
    rate: RateFilter,
    log: Log,
}

impl Pilot {
    /// The scenario's controller of that name, or its only one, before its first sample.
    ///
    /// # Errors
    /// [`ChoiceError`] where the name is none of the scenario's, or none is given and there are
    /// several.
    pub fn new(
        scenario: &Scenario,
        name: Option<&str>,
        angles: Angles,
    ) -> Result<Self, ChoiceError> {
        let is_external = |name: &&str| scenario.externals.iter().any(|it| it.name == *name);
        if let Some(name) = name.filter(is_external) {
            return Err(ChoiceError::External { name: name.to_owned() });
        }
        let controller = chosen(&scenario.controllers, name)?.controller;
        let rate = RateFilter::new(controller.config().dt_s);
        Ok(Self { controller, angles, state: State::new(), rate, log: Log::default() })
    }

    /// The controller's sample period, s.
    #[must_use]
    pub fn period_s(&self) -> f64 {
        self.controller.config().dt_s
    }

    /// Answers a line; there is no answer to an empty one and to a comment.
    pub fn answer(&mut self, line: &[u8]) -> Option<Answer> {
        self.log.next_line();
        match Line::read(line, self.angles) {
            Ok(Line::Nothing) => None,
            Ok(Line::Reset) => Some(self.reset()),
            Ok(Line::Sample(request)) => Some(self.respond(request)),
            Err(problem) => Some(self.hold(&problem)),
        }
    }

    /// What is to be told to people since the last call.
    pub fn take_notes(&mut self) -> Vec<String> {
        self.log.take()
    }

    /// What happened so far.
    #[must_use]
    pub fn summary(&self) -> Summary {
        self.log.summary
    }

    fn reset(&mut self) -> Answer {
        self.state = State::new();
        self.rate = RateFilter::new(self.period_s());
        self.log.summary.resets += 1;
        Answer::Ready
    }

    fn respond(&mut self, request: Request) -> Answer {
        if let Err(problem) = self.judge_period(request.dt_s) {
            return self.hold(&problem);
        }
        let Request { setpoint_rad, measurement_rad, .. } = request;
        let rate_rad_s = self.rate_rad_s(&request);
        let (answer, fault) = self.step(Sample { setpoint_rad, measurement_rad, rate_rad_s });
        if HOLDING.iter().any(|&holding| fault.contains(holding)) {
            self.log.held(&fault.to_string());
            return answer;
        }
        self.rate.remember(measurement_rad, rate_rad_s);
        if !fault.is_empty() {
            self.log.fault(fault);
        }
        answer
    }

    /// The last command once more.
    fn hold(&mut self, problem: &str) -> Answer {
        self.log.held(problem);
        self.step(NO_SAMPLE).0
    }

    fn step(&mut self, sample: Sample<f64>) -> (Answer, Faults) {
        let step = self.controller.step(&mut self.state, sample);
        self.log.summary.commands += 1;
        let command = self.angles.of_radians(step.command_rad);
        (Answer::Command(command), self.state.take_faults())
    }

    /// Counts a slip; an error where no time can have passed.
    fn judge_period(&mut self, dt_s: f64) -> Result<(), String> {
        if !dt_s.is_finite() {
            return Err(format!("dt_s is {dt_s:?}; allowed is a finite number"));
        }
        if self.rate.is_fresh() {
            return Ok(());
        }
        if dt_s <= 0.0 {
            return Err(format!("dt_s is {dt_s:?}; time has to pass between two samples"));
        }
        let period_s = self.period_s();
        if (dt_s - period_s).abs() > SAME_PERIOD * period_s {
            self.log.slip(dt_s, period_s);
        }
        Ok(())
    }

    /// The rate that was sent, or else the estimate; zero where none is needed.
    fn rate_rad_s(&mut self, request: &Request) -> f64 {
        if let Some(rate_rad_s) = request.rate_rad_s {
            return rate_rad_s;
        }
        let estimate_rad_s = self.rate.estimate_rad_s(request.measurement_rad);
        if self.controller.uses_rate() {
            self.log.estimated_rate(self.rate.time_constant_s());
        }
        estimate_rad_s
    }
}

fn chosen<'a>(
    controllers: &'a [NamedController],
    name: Option<&str>,
) -> Result<&'a NamedController, ChoiceError> {
    let known = || controllers.iter().map(|named| named.name.clone()).collect();
    match (name, controllers) {
        (None, [only]) => Ok(only),
        (None, _) => Err(ChoiceError::Several { known: known() }),
        (Some(name), _) => controllers
            .iter()
            .find(|named| named.name == name)
            .ok_or_else(|| ChoiceError::Unknown { name: name.to_owned(), known: known() }),
    }
}
