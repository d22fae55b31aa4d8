//! Gain, delay and phase margins by flying: how much the flown scenario bears.
//!
//! Something is put between controller and servo ([`Perturbation`]) and made larger until the flight
//! no longer holds ([`Criterion`]). It works for whatever flies: linear plants and nonlinear aircraft,
//! fixed gains and gains that a supervisor tunes, limits and disturbances included. What it says is
//! true of this scenario with its size of command, and of no other; where the loop is linear it agrees
//! with the margins of the linear loop within what a flight of that length can tell.
//!
//! Sizes are tried on a ladder first, and the step to the first that fails is then halved. A loop that
//! fails and holds again between two rungs looks as if it held. A flight that fails without diverging
//! is flown again for longer, and counts as held if that one holds: a slow motion that dies out looks
//! like one that grows while there is little of it to see. So is a flight that holds while it still
//! oscillates: it may be on its way to a size at which it lasts. One that oscillates above the floor at
//! the end of the longest flight, and not much less than before, does not hold.

use fspid_core::{Gains, Law};

use super::holding::is_quiet;
use super::ladder::{Ladder, geometric};
use super::perturbation::MOST_DELAY_SAMPLES;
use super::{AllPass, Criterion, Envelope, Failure, Margin, Perturbation};
use crate::controller::Controller;
use crate::describing::OpenLoop;
use crate::error::{SimError, positive};
use crate::plant::{LinearPlant, Plant};
use crate::scenario::{Prepared, Respondent, Scenario};
use crate::timing::Timing;
use crate::trace::EndCause;

/// An oscillation that is down to this share of what it was a third of the flight before is dying out.
const DYING: f64 = 0.5;
/// Largest factor on the command, and its inverse the smallest: 60 dB.
pub const MOST_GAIN: f64 = 1000.0;
/// Largest extra delay, s; at most 10 000 samples.
pub const MOST_DELAY_S: f64 = 5.0;
/// Rungs of the ladders of gain and delay for each doubling.
const RUNGS_A_DOUBLING: f64 = 4.0;
/// First rung of the ladder of delays, samples.
const FIRST_DELAY_SAMPLES: f64 = 0.25;
/// Delays are not told apart below this, samples.
const DELAY_WIDTH_SAMPLES: f64 = 0.02;
/// Rungs of phase lags: every 5 deg below 180 deg.
const LAG_RUNGS: u32 = 35;
/// From one rung of phase lags to the next, rad.
const LAG_STEP_RAD: f64 = 5.0 * std::f64::consts::PI / 180.0;
/// Lags are not told apart below this, rad: 0.1 deg.
const LAG_WIDTH_RAD: f64 = 0.1 * std::f64::consts::PI / 180.0;

/// How margins are looked for.
#[derive(Clone, Debug, PartialEq)]
pub struct EmpiricalOptions {
    /// When a flight counts as not held.
    pub criterion: Criterion,
    /// Length of each flight, s; that of the scenario where there is none.
    pub duration_s: Option<f64>,
    /// How many times as long a flight is flown again, up to twice, before it counts as not held, 1 or
    /// more.
    pub patience: f64,
    /// Largest relative width of an answer; delays are told apart down to a fiftieth of a sample and
    /// lags down to 0.1 deg.
    pub tolerance: f64,
    /// Where a phase lag is what it is called, rad/s; the gain crossovers of the loop around rest where
    /// there are none.
    pub crossovers_rad_s: Option<Vec<f64>>,
}

impl Default for EmpiricalOptions {
    fn default() -> Self {
        let criterion = Criterion::default();
        let (duration_s, crossovers_rad_s) = (None, None);
        Self { criterion, duration_s, patience: 4.0, tolerance: 0.005, crossovers_rad_s }
    }
}

/// Phase margin measured by simulation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PhaseMargin {
    /// Frequency at which the all-pass has the lag, rad/s; at lower ones it has less, at higher more.
    pub at_rad_s: f64,
    /// Lag, rad.
    pub lag_rad: Margin,
}

/// Gain, delay and phase margins measured by simulation.
#[derive(Clone, Debug, PartialEq)]
pub struct EmpiricalMargins {
    /// Factor above 1 on the command.
    pub gain_up: Margin,
    /// Factor below 1 on the command.
    pub gain_down: Margin,
    /// Extra delay of the command, s.
    pub delay_s: Margin,
    /// Extra phase lag at each gain crossover; none where there is no crossover.
    pub phase: Vec<PhaseMargin>,
    /// The unperturbed flight.
    pub nominal: Envelope,
    /// Swing of the error up to which a flight of the first length counts as held, rad.
    pub floor_rad: f64,
    /// Nothing new happens to the loop after the first third of the flight. Where this is false, a
    /// swing is a failure only if it is also twice that of the unperturbed flight.
    pub quiet: bool,
    /// Flights that were flown, the longer ones included.
    pub flights: usize,
}

/// Result of the margin search by simulation.
#[derive(Clone, Debug, PartialEq)]
pub enum EmpiricalAnswer {
    /// The unperturbed flight holds, and bears so much.
    Margins(Box<EmpiricalMargins>),
    /// The unperturbed flight does not hold: there are no margins.
    NominalFails {
        /// Why.
        failure: Failure,
        /// The flight.
        nominal: Envelope,
    },
    /// There is no error at any sample of the unperturbed flight, so that flights show nothing.
    NothingMoves,
}

/// Gain, delay and phase margins between controller and servo, measured by simulating the scenario.
///
/// # Errors
/// [`SimError`] where the scenario cannot be flown, or an aircraft has no linear model for the gain
/// crossovers of the loop around its trim.
pub fn empirical_margins(
    scenario: &Scenario,
    controller: &Controller,
    options: &EmpiricalOptions,
) -> Result<EmpiricalAnswer, SimError> {
    flown_margins(scenario, Respondent::Equations(controller), options)
}

/// The same of whatever answers; an external controller, of whose loop nobody knows the gain crossovers, bears a phase
/// lag at those frequencies only that the options say.
///
/// # Errors
/// As [`empirical_margins`]; where an external controller cannot be started, or flies once for each start of its own.
pub fn flown_margins(
    scenario: &Scenario,
    respondent: Respondent<'_>,
    options: &EmpiricalOptions,
) -> Result<EmpiricalAnswer, SimError> {
    if let Respondent::External(external) = respondent {
        external.source.require_many_flights()?;
    }
    let tolerance = positive("tolerance", options.tolerance)?;
    let patience = options.patience;
    if !(patience >= 1.0 && patience.is_finite()) {
        let (what, allowed) = ("patience", "a finite number, 1 or above");
        return Err(SimError::Number { what, found: patience, allowed });
    }
    let duration_s = options.duration_s.unwrap_or_else(|| scenario.timing.end_s());
    let first = Length::of(scenario, respondent, &options.criterion, duration_s)?;
    if first.nominal.largest_rad <= 0.0 {
        return Ok(EmpiricalAnswer::NothingMoves);
    }
    let longer = Length::of(scenario, respondent, &options.criterion, patience * duration_s)?;
    // The longer flight has the last word, and tells of slower growth.
    if let Some(failure) = longer.nominal.failure(&options.criterion, longer.floor_rad) {
        return Ok(EmpiricalAnswer::NominalFails { failure, nominal: longer.nominal });
    }
    let crossovers_rad_s = match (&options.crossovers_rad_s, respondent) {
        (Some(given), _) => given.clone(),
        (None, Respondent::Equations(controller)) => gain_crossovers_rad_s(scenario, controller)?,
        (None, Respondent::External(_)) => Vec::new(),
    };
    let longest = patience * patience * duration_s;
    let longest = Length::of(scenario, respondent, &options.criterion, longest)?;
    let lengths = [&first, &longer, &longest];
    let criterion = &options.criterion;
    let mut trials = Trials { lengths, respondent, criterion, tolerance, flights: 2 };
    Ok(EmpiricalAnswer::Margins(Box::new(EmpiricalMargins {
        gain_up: trials.gain(|factor| factor)?,
        gain_down: trials.gain(|factor| 1.0 / factor)?,
        delay_s: trials.delay_s()?,
        phase: trials.phase(&crossovers_rad_s)?,
        nominal: first.nominal,
        floor_rad: first.floor_rad,
        quiet: first.quiet,
        flights: trials.flights,
    })))
}

/// The gains that a loop has at rest: fixed ones, nominal ones with what the rules add at the origin,
/// and, where the gains accumulate, those that they start from.
#[must_use]
pub fn gains_around_rest(controller: &Controller) -> Gains<f64> {
    match controller {
        Controller::Fixed(pid) => pid.gains(),
        Controller::SelfTuning(fspid) => match fspid.tuner().settings().law {
            Law::Memoryless => fspid.tuner().gains_at_rest(),
            Law::Accumulating { .. } => fspid.tuner().nominal(),
        },
    }
}

/// The plant of a scenario around rest: itself, or an aircraft's linear model at its trim.
///
/// # Errors
/// [`SimError`] where an aircraft has no such model.
pub fn plant_around_rest(scenario: &Scenario) -> Result<LinearPlant, SimError> {
    match &scenario.plant {
        Plant::Linear(plant) => Ok(plant.clone()),
        Plant::Aircraft(plant) => plant.linear(),
        Plant::External(_) => scenario.plant.require_equations().and(Err(SimError::NotLinear)),
    }
}

fn gain_crossovers_rad_s(
    scenario: &Scenario,
    controller: &Controller,
) -> Result<Vec<f64>, SimError> {
    let plant = plant_around_rest(scenario)?;
    let gains = gains_around_rest(controller);
    OpenLoop::of(scenario, &plant, &controller.config_at(gains), gains)?.gain_crossovers_rad_s()
}

/// The scenario in one length.
struct Length {
    prepared: Prepared,
    nominal: Envelope,
    floor_rad: f64,
    quiet: bool,
}

impl Length {
    fn of(
        scenario: &Scenario,
        respondent: Respondent<'_>,
        criterion: &Criterion,
        duration_s: f64,
    ) -> Result<Self, SimError> {
        let timing = Timing::new(scenario.timing.dt_s(), duration_s)?;
        let flown = Scenario { timing, ..scenario.clone() };
        let prepared = flown.prepare()?;
        let nominal = Envelope::of(&prepared, respondent, &Perturbation::NONE)?;
        let quiet = is_quiet(&flown, &prepared);
        let floor_rad = criterion.floor_rad(&nominal, quiet);
        Ok(Self { prepared, nominal, floor_rad, quiet })
    }
}

/// Flights of one controller with perturbations.
struct Trials<'a> {
    /// The first length and two longer ones.
    lengths: [&'a Length; 3],
    respondent: Respondent<'a>,
    criterion: &'a Criterion,
    tolerance: f64,
    flights: usize,
}

impl Trials<'_> {
    fn dt_s(&self) -> f64 {
        self.lengths[0].prepared.timing.dt_s()
    }

    /// Why a perturbed flight does not hold. Divergence is believed at once, and that a flight holds once
    /// its oscillation is gone; everything else is flown for longer.
    fn failure(&mut self, perturbation: &Perturbation) -> Result<Option<Failure>, SimError> {
        let mut failure = None;
        for length in self.lengths {
            self.flights += 1;
            let envelope = Envelope::of(&length.prepared, self.respondent, perturbation)?;
            failure = envelope.failure(self.criterion, length.floor_rad);
            let [middle_rad, last_rad] = envelope.oscillations_rad;
            match failure {
                Some(Failure::EndedEarly(end)) if end.cause != EndCause::HitGround => break,
                None if last_rad <= length.floor_rad => break,
                None if last_rad > DYING * middle_rad => {
                    failure = Some(Failure::Oscillates { middle_rad, last_rad });
                }
                _ => {}
            }
        }
        Ok(failure)
    }

    /// The margin of a factor from 1 on, of which `gain` makes that on the command.
    fn gain(&mut self, gain: impl Fn(f64) -> f64) -> Result<Margin, SimError> {
        let rung = libm::exp2(1.0 / RUNGS_A_DOUBLING);
        let rungs = geometric(rung, rung, MOST_GAIN);
        let ladder = Ladder { from: 1.0, rungs, tolerance: self.tolerance, width: 0.0 };
        let margin = ladder.climb(|factor| self.failure(&Perturbation::of_gain(gain(factor))))?;
        Ok(margin.map(gain))
    }

    fn delay_s(&mut self) -> Result<Margin, SimError> {
        let dt_s = self.dt_s();
        let rung = libm::exp2(1.0 / RUNGS_A_DOUBLING);
        let most_samples = MOST_DELAY_SAMPLES.min(MOST_DELAY_S / dt_s);
        let rungs = geometric(FIRST_DELAY_SAMPLES, rung, most_samples);
        let (tolerance, width) = (self.tolerance, DELAY_WIDTH_SAMPLES);
        let ladder = Ladder { from: 0.0, rungs, tolerance, width };
        let margin = ladder.climb(|samples| self.failure(&Perturbation::of_delay(samples)))?;
        Ok(margin.map(|samples| samples * dt_s))
    }

    fn phase(&mut self, crossovers_rad_s: &[f64]) -> Result<Vec<PhaseMargin>, SimError> {
        let dt_s = self.dt_s();
        let rungs = (1..=LAG_RUNGS).map(|rung| LAG_STEP_RAD * f64::from(rung)).collect();
        let (tolerance, width) = (self.tolerance, LAG_WIDTH_RAD);
        let ladder = Ladder { from: 0.0, rungs, tolerance, width };
        let at = |&at_rad_s: &f64| {
            let lag_rad = ladder.climb(|lag_rad| {
                let all_pass = AllPass::lagging(lag_rad, at_rad_s, dt_s)?;
                self.failure(&Perturbation::of_lag(all_pass))
            })?;
            Ok(PhaseMargin { at_rad_s, lag_rad })
        };
        crossovers_rad_s.iter().map(at).collect()
    }
}
