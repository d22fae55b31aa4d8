//! The controller's side of the conversation.

use fspid_diagnostics::digits::to_six_decimals;
use std::fmt;

use fspid_core::Sample;
use fspid_sim::{Flyer as Named, Scenario, SimError};

use super::flyer::Flyer;
use super::latched::HOLDING;
use super::line::{Angles, Line, Request};
use super::log::{Log, Summary};
use super::rate::RateFilter;
use fspid_diagnostics::known_words;

/// Of the period: how far `dt_s` may lie beside it and still be kept. As for events in a scenario.
const SAME_PERIOD: f64 = 1e-6;

/// Why no controller was chosen.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ChoiceError {
    /// There are several, and none was named.
    #[error(
        "several controllers; choose one with --controller: {}",
        fspid_diagnostics::listed(known)
    )]
    Several {
        /// Their names.
        known: Vec<String>,
    },
    /// It is a program that cannot be started.
    #[error(transparent)]
    NotStarted(#[from] SimError),
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
#[derive(Debug)]
pub struct Pilot {
    flyer: Flyer,
    angles: Angles,
    /// Number of the next sample of this flight.
    sample: u64,
    rate: RateFilter,
    log: Log,
}

impl Pilot {
    /// The scenario's controller of that name, or its only one, before its first sample.
    ///
    /// # Errors
    /// [`ChoiceError`] where the name is none of the scenario's, or none is given and there are
    /// several; where it is a program that cannot be started.
    pub fn new(
        scenario: &Scenario,
        name: Option<&str>,
        angles: Angles,
    ) -> Result<Self, ChoiceError> {
        let flyer = flyer(scenario, name)?;
        let rate = RateFilter::new(flyer.period_s());
        Ok(Self { flyer, angles, sample: 0, rate, log: Log::default() })
    }

    /// The controller's sample period, s.
    #[must_use]
    pub fn period_s(&self) -> f64 {
        self.flyer.period_s()
    }

    /// True where the controller is a program, which can be lost.
    #[must_use]
    pub fn is_external(&self) -> bool {
        self.flyer.is_external()
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
        if let Err(error) = self.flyer.reset() {
            self.log.lost(&error.to_string());
        }
        self.sample = 0;
        self.rate = RateFilter::new(self.period_s());
        self.log.summary.resets += 1;
        Answer::Ready
    }

    fn respond(&mut self, request: Request) -> Answer {
        if let Err(problem) = self.judge_period(request.dt_s) {
            return self.hold(&problem);
        }
        if self.flyer.is_lost() {
            self.log.summary.held += 1;
            return self.repeated();
        }
        let Request { setpoint_rad, measurement_rad, .. } = request;
        let rate_rad_s = self.rate_rad_s(&request);
        let time_s = self.sample as f64 * self.period_s();
        let stepped = self.flyer.step(Sample { setpoint_rad, measurement_rad, rate_rad_s });
        let (answer, fault) = (self.command(stepped.command_rad), stepped.fault);
        if let Some(loss) = stepped.loss {
            let what = format!("the controller {loss} at t = {} s", to_six_decimals(time_s));
            self.log.lost(&what);
            self.log.summary.held += 1;
            return answer;
        }
        if HOLDING.iter().any(|&holding| fault.contains(holding)) {
            self.log.held(&fault.to_string());
            return answer;
        }
        // One that is not finite was not used.
        let known = rate_rad_s.is_finite();
        let remembered = if known { rate_rad_s } else { self.rate.estimate_rad_s(measurement_rad) };
        self.rate.remember(measurement_rad, remembered);
        if !fault.is_empty() {
            self.log.fault(fault);
        }
        answer
    }

    /// The last command once more, and why.
    fn hold(&mut self, problem: &str) -> Answer {
        self.log.held(problem);
        self.repeated()
    }

    fn repeated(&mut self) -> Answer {
        let command_rad = self.flyer.hold();
        self.command(command_rad)
    }

    /// Of a sample, which every command is.
    fn command(&mut self, command_rad: f64) -> Answer {
        self.sample += 1;
        self.log.summary.commands += 1;
        Answer::Command(self.angles.of_radians(command_rad))
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
        if self.flyer.uses_rate() {
            self.log.estimated_rate(self.rate.time_constant_s(), self.flyer.is_external());
        }
        estimate_rad_s
    }
}

/// The scenario's controller of that name, or its only one, before its first sample.
pub(super) fn flyer(scenario: &Scenario, name: Option<&str>) -> Result<Flyer, ChoiceError> {
    Ok(match chosen(scenario, name)? {
        Named::Own(named) => Flyer::own(named.controller),
        Named::External(named) => Flyer::external(named.external.clone())?,
    })
}

fn chosen<'a>(scenario: &'a Scenario, name: Option<&str>) -> Result<Named<'a>, ChoiceError> {
    let mut all = scenario.flyers();
    let known = || scenario.flyers().map(|named| named.name().to_owned()).collect();
    match (name, scenario.flyers().count()) {
        (None, 1) => all.next().ok_or_else(|| ChoiceError::Several { known: known() }),
        (None, _) => Err(ChoiceError::Several { known: known() }),
        (Some(name), _) => all
            .find(|named| named.name() == name)
            .ok_or_else(|| ChoiceError::Unknown { name: name.to_owned(), known: known() }),
    }
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use fspid_core::{Controller, Gains, Guard, Pid, PidConfig, State, Step};
    use fspid_sim::external::Answers;
    use fspid_sim::{ControllerLoss, External, ExternalSource};

    use super::super::flyer::Asked;
    use super::*;

    /// An export: it answers as its original, with faults latched.
    #[derive(Debug)]
    struct Export(Controller<f64>, State<f64>);

    impl Answers for Export {
        fn answer(&mut self, sample: Sample<f64>) -> Result<Step<f64>, ControllerLoss> {
            Ok(self.0.step(&mut self.1, sample))
        }
    }

    fn controller([kp, ki]: [f64; 2], rate_gain_s: f64) -> Controller<f64> {
        let guard = Guard::new(90_f64.to_radians()).expect("positive");
        let config = PidConfig { rate_gain_s, guard, ..PidConfig::sampled_every(0.01) };
        Controller::Fixed(Pid::new(Gains { kp, ki, kd: 0.1 }, config).expect("good settings"))
    }

    fn pilot(flyer: Flyer) -> Pilot {
        let rate = RateFilter::new(flyer.period_s());
        Pilot { flyer, angles: Angles::Degrees, sample: 0, rate, log: Log::default() }
    }

    fn exported(controller: Controller<f64>) -> Pilot {
        let external = External {
            source: ExternalSource::Library(PathBuf::from("a.so")),
            contents: None,
            answer_limit_s: 5.0,
            dt_s: 0.01,
            renamed: Vec::new(),
        };
        let export = Export(controller, State::new());
        pilot(Flyer::External(Asked::new(external, Box::new(export))))
    }

    /// Pitches that move, with glitches of every size; most lines have no rate.
    fn line(k: u32) -> String {
        let rest = 4.0 * libm::sin(f64::from(k) * 0.05);
        match k {
            5 | 9 | 10 | 300 => "0 -180 0.01".to_owned(),
            // Too fast for the guard, where nothing else is wrong.
            40..=43 | 301 => "0 75 0.01".to_owned(),
            60 | 61 => format!("5 {rest:?} 0.01 -100"),
            80 => format!("5 {rest:?} 0.01 inf"),
            120 => "95 2 0.01".to_owned(),
            121 => "1e300 2 0.01".to_owned(),
            // Slowly to where nothing was believed before, and still there.
            150..=250 => format!("0 {:?} 0.01", f64::from(k - 150) * 0.6),
            251..=290 => "0 60 0.01".to_owned(),
            _ => format!("5 {rest:?} 0.01"),
        }
    }

    /// The second glitch of -180 deg went into the estimate of the rate, and commands were others for hundreds of samples.
    #[test]
    fn an_export_answers_as_its_original_after_any_number_of_samples_beyond_the_guard() {
        for (gains, rate_gain_s) in [([1.0, 0.0], 0.3), ([1.0, 0.5], 0.3), ([2.0, 0.5], 0.0)] {
            let controller = controller(gains, rate_gain_s);
            let mut pilots = [pilot(Flyer::own(controller)), exported(controller)];
            for k in 0..600 {
                let [own, export] = pilots.each_mut().map(|it| it.answer(line(k).as_bytes()));
                assert_eq!(own, export, "{gains:?} {rate_gain_s:?} sample {k}: {}", line(k));
            }
            let [own, export] = pilots.map(|it| it.summary());
            assert!(own.held > 5);
            assert_eq!(own, export, "{gains:?} {rate_gain_s:?}");
        }
    }
}
