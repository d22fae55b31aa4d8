//! Local stability of a scenario's loops: the spectral radius of the sampled closed loop, linearised about each equilibrium.
//!
//! A slow divergence looks good in a short window. This asks the poles of the one-sample transition matrix instead, the
//! [`loop_model`](crate::loop_model)'s. [`instability`] judges fixed gains about the origin; [`growth_at_rest`] judges every
//! controller at every equilibrium of the scenario: self-tuners with the gains that they have there, nonlinear aircraft by
//! their linear model at the trim, autopilots by the poles of each mode. Not here: large motions, which need a certificate
//! (`fspid-proof`), and gains that move.

use fspid_core::{Gains, PidConfig};
use fspid_lti::{Complex, Matrix, eigenvalues, spectral_radius};

use crate::aircraft::AircraftPlant;
use crate::around_trim;
use crate::controller::Controller;
use crate::error::SimError;
use crate::held_limits;
use crate::integral_limits;
use crate::loop_model::{BreakPoint, LoopModel, Memory, SampledPlant};
use crate::plant::LinearPlant;
use crate::rest::{Doubt, Rest, RestPoint, Stand};
use crate::scenario::Scenario;

pub use crate::flight_doubt::{doubt_of_flight, doubt_when_flown, doubts_of_flights};

/// A radius this close below 1 cannot be told from 1 after rounding; it counts as unstable.
const MARGIN: f64 = 1e-9;

/// An unstable closed loop: how unstable, from when, and about which equilibrium.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unstable {
    /// Spectral radius of the sampled closed loop, 1 or above.
    pub spectral_radius: f64,
    /// From when the plant is the one that is not held, s.
    pub from_s: f64,
    /// Time in which what grows becomes twice as large, s; infinite where nothing grows.
    pub doubling_s: f64,
    /// What is held meanwhile.
    pub at: RestPoint,
    /// Number of the autopilot's mode, from 0, where it is the loops around the pitch loop that do not hold.
    pub mode: Option<usize>,
}

/// The instability of a loop with fixed gains, if it has one: `None` for a stable loop and for gains that move.
///
/// A nonlinear aircraft is judged by its linear model around the trim: where that grows, the flight
/// leaves the trim, however small the disturbance.
///
/// Limits of controller and servo are passed over: around rest, where they do not act, they save no loop that
/// is unstable without them. Deadband and play of an actuator are passed over as well. Scale and delay
/// of sensors count, but for a sensor with a clock of its own, whose values change their age.
///
/// # Errors
/// [`SimError`] where the plant cannot be discretised, an aircraft has no linear model, or the
/// eigenvalues are not found.
pub fn instability(
    scenario: &Scenario,
    controller: &Controller,
) -> Result<Option<Unstable>, SimError> {
    scenario.plant.require_equations()?;
    let Controller::Fixed(pid) = controller else {
        return Ok(None);
    };
    let (gains, config) = (pid.gains(), pid.config());
    let trimmed = scenario.plant.aircraft().map(AircraftPlant::linear).transpose()?;
    let around_trim = trimmed.iter().map(|plant| (0.0, plant));
    for (from_s, plant) in around_trim.chain(scenario.lasting_plants()) {
        let spectral_radius = radius_at_rest(scenario, plant, gains, config)?;
        // What cannot be told from the edge counts as unstable here, and so does NaN.
        if !(spectral_radius < 1.0 - MARGIN) {
            let doubling_s = doubling_s(spectral_radius, scenario.timing.dt_s());
            let at = RestPoint::TRIM;
            return Ok(Some(Unstable { spectral_radius, from_s, doubling_s, at, mode: None }));
        }
    }
    Ok(None)
}

/// Spectral radius of the loop of one plant with fixed gains; of a long way 0 for one that holds, and 1 where rounding hides
/// whether it does.
fn radius_at_rest(
    scenario: &Scenario,
    plant: &LinearPlant,
    gains: Gains<f64>,
    config: &PidConfig<f64>,
) -> Result<f64, SimError> {
    let model = fixed_model(scenario, plant, gains, config)?;
    if !model.settings().is_long() {
        return Ok(spectral_radius(&model.closed_matrix(gains)?)?);
    }
    match model.unstable_radius(gains) {
        Ok(radius) => Ok(radius.unwrap_or(0.0)),
        Err(SimError::Linear(error)) => error.undecided_radius().ok_or(error.into()),
        Err(error) => Err(error),
    }
}

/// True where fixed gains hold a plant for certain.
pub(crate) fn holds(
    scenario: &Scenario,
    plant: &LinearPlant,
    gains: Gains<f64>,
    config: &PidConfig<f64>,
) -> bool {
    radius_at_rest(scenario, plant, gains, config).is_ok_and(|radius| radius < 1.0 - MARGIN)
}

/// Norm of a loop's matrix below which no question about its poles leaves the range of 64-bit numbers:
/// far below the tenth root of the largest.
const TAME: f64 = 1e30;

/// Whether the loop of a controller with a plant can be asked for its poles, with the gains it starts from and with those
/// that it has at rest. Whether they are stable is another question.
///
/// # Errors
/// [`SimError`] where the plant cannot be sampled, or the loop leaves the range of 64-bit numbers.
pub fn can_be_judged(
    scenario: &Scenario,
    plant: &LinearPlant,
    controller: &Controller,
) -> Result<(), SimError> {
    let gains = controller.nominal();
    let memory = Memory::of_gains(gains, controller.config());
    let model = LoopModel::of(scenario, plant, controller.config(), memory)?;
    if model.settings().is_long() {
        // Margins are not asked of it. What is undecided is told beside its flight.
        return match model.unstable_radius(gains) {
            Err(SimError::Linear(error)) if error.undecided_radius().is_some() => Ok(()),
            other => other.map(|_| ()),
        };
    }
    // What margins are asked of.
    model.sharpened(scenario, plant)?.open(gains, BreakPoint::default())?;
    is_in_range(&closed_loop(scenario, plant, gains, controller.config())?)?;
    let Controller::SelfTuning(fspid) = controller else { return Ok(()) };
    for rest in Rest::all(scenario, plant, controller, fspid.tuner().gains_at_rest()) {
        for side in &rest.sides {
            let model = side.model(scenario, plant, controller)?;
            is_in_range(&model.closed_matrix(side.gains)?)?;
        }
    }
    Ok(())
}

/// Poles take a while, where much is on its way, and those of tame numbers are always found.
fn is_in_range(closed: &Matrix) -> Result<(), SimError> {
    // Written so that NaN is asked.
    if !(closed.norm_one() < TAME) {
        spectral_radius(closed)?;
    }
    Ok(())
}

/// Local instability of a loop about its equilibria, for every kind of controller; limits that do not act there are left out.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GrowthAtRest {
    /// The first plant and equilibrium that are certainly unstable.
    pub certain: Option<Unstable>,
    /// Where none is certainly unstable: the first equilibrium whose stability is undecided.
    pub undecided: Option<Undecided>,
}

/// An equilibrium whose local stability could not be decided.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Undecided {
    /// What is held meanwhile.
    pub at: RestPoint,
    /// Why.
    pub doubt: Doubt,
}

impl Undecided {
    /// With nothing held.
    #[must_use]
    pub fn at_trim(doubt: Doubt) -> Self {
        Self { at: RestPoint::TRIM, doubt }
    }
}

impl GrowthAtRest {
    /// Takes a doubt, if it is the first.
    pub(crate) fn doubt(&mut self, undecided: Undecided) {
        self.undecided.get_or_insert(undecided);
    }

    /// With what was found elsewhere.
    pub(crate) fn and(self, other: Self) -> Self {
        Self {
            certain: self.certain.or(other.certain),
            undecided: self.undecided.or(other.undecided),
        }
    }

    /// True where nothing grows and nothing is undecided.
    pub(crate) fn holds(&self) -> bool {
        self.certain.is_none() && self.undecided.is_none()
    }

    /// What is certain leaves no doubt.
    fn settled(self) -> Self {
        Self { undecided: self.undecided.filter(|_| self.certain.is_none()), ..self }
    }
}

/// Asks each plant that lasts at every rest of the scenario, with the gains that the controller has with everything at
/// zero: what [`Stand`] says of each. A nonlinear aircraft is judged by its linear model around the trim, and where it has an
/// autopilot by its small motions with everything that each mode engages ([`mode_poles`](crate::mode_poles)); so is the aircraft
/// that it comes to be, by a configuration that moves or fuel that is burnt.
///
/// A pole on the unit circle grows nothing. One within 10⁻⁹ of it cannot be told from such a one after rounding and is
/// undecided: at 100 Hz it would double in 80 days, at 10 kHz in 19 hours.
///
/// # Errors
/// As [`instability`].
pub fn growth_at_rest(
    scenario: &Scenario,
    controller: &Controller,
    gains: Gains<f64>,
) -> Result<GrowthAtRest, SimError> {
    scenario.plant.require_equations()?;
    let mut found = GrowthAtRest::default();
    if let Some(aircraft) = scenario.plant.aircraft() {
        found = around_trim::growth(scenario, aircraft, controller, gains)?;
    }
    for (from_s, plant) in scenario.lasting_plants() {
        if found.certain.is_none() {
            found = found.and(growth_of_plant(scenario, (from_s, plant), controller, gains)?);
        }
    }
    if let Some(doubt) = doubt_of_limits(scenario, controller, gains) {
        found.doubt(Undecided::at_trim(doubt));
    }
    Ok(found.settled())
}

/// Why a flight is undecided at rest although its loops with each plant may not be: what [`growth_at_rest`] says of an aircraft,
/// and of limits that leave too little to a plant that does not come to rest by itself.
///
/// # Errors
/// As [`instability`].
pub fn doubt_beyond(
    scenario: &Scenario,
    controller: &Controller,
    gains: Gains<f64>,
) -> Result<Option<Undecided>, SimError> {
    if scenario.plant.aircraft().is_some() {
        return Ok(growth_at_rest(scenario, controller, gains)?.undecided);
    }
    Ok(doubt_of_limits(scenario, controller, gains).map(Undecided::at_trim))
}

/// Whether limits leave what the rest at the end of a flight takes.
fn doubt_of_limits(
    scenario: &Scenario,
    controller: &Controller,
    gains: Gains<f64>,
) -> Option<Doubt> {
    if integral_limits::are_exceeded(scenario, controller, gains) {
        return Some(Doubt::IntegralLimits);
    }
    held_limits::are_exceeded(scenario, controller, gains).then_some(Doubt::BeyondLimits)
}

/// Asks one plant, which a flight has from a time on, at every rest.
pub(crate) fn growth_of_plant(
    scenario: &Scenario,
    (from_s, plant): (f64, &LinearPlant),
    controller: &Controller,
    gains: Gains<f64>,
) -> Result<GrowthAtRest, SimError> {
    let mut found = GrowthAtRest::default();
    if plant.is_between_slopes() {
        found.doubt(Undecided::at_trim(Doubt::Kink));
        return Ok(found);
    }
    let sampled = SampledPlant::of(scenario, plant)?;
    for rest in Rest::all(scenario, plant, controller, gains) {
        let at = rest.at;
        match rest.stand(scenario, &sampled, controller)? {
            Stand::Holds => {}
            Stand::Undecided(doubt) => found.doubt(Undecided { at, doubt }),
            Stand::Grows { spectral_radius } => {
                let doubling_s = doubling_s(spectral_radius, scenario.timing.dt_s());
                let mode = None;
                let certain = Unstable { spectral_radius, from_s, doubling_s, at, mode };
                return Ok(GrowthAtRest { certain: Some(certain), ..found });
            }
        }
    }
    Ok(found)
}

/// Up to this spectral radius a mode of an autopilot grows nothing: above 1 by the error of the differences that found it,
/// with room. At 50 Hz what it lets pass doubles in 38 hours.
pub const MODE_RADIUS: f64 = 1.0 + 1e-7;

pub(crate) fn doubling_s(spectral_radius: f64, dt_s: f64) -> f64 {
    let rate = libm::log(spectral_radius);
    if rate > 0.0 { dt_s * core::f64::consts::LN_2 / rate } else { f64::INFINITY }
}

/// Spectral radius of the sampled loop of one plant with fixed gains and no limits. That of a sensor with a clock of its own is
/// no one loop and is refused: [`growth_at_rest`] asks all its ages as they come.
///
/// # Errors
/// [`SimError`] where the plant is an aircraft, cannot be discretised or the eigenvalues are not found, and
/// [`SimError::ChangingAges`] where what a sensor shows changes its age.
pub fn loop_spectral_radius(
    scenario: &Scenario,
    gains: Gains<f64>,
    config: &PidConfig<f64>,
) -> Result<f64, SimError> {
    Ok(spectral_radius(&one_loop(scenario, gains, config)?)?)
}

/// Poles of the sampled loop of one plant with fixed gains and no limits.
///
/// # Errors
/// As [`loop_spectral_radius`].
pub fn loop_poles(
    scenario: &Scenario,
    gains: Gains<f64>,
    config: &PidConfig<f64>,
) -> Result<Vec<Complex>, SimError> {
    Ok(eigenvalues(&one_loop(scenario, gains, config)?)?)
}

/// The one-sample matrix of a loop that is the same at every sample.
fn one_loop(
    scenario: &Scenario,
    gains: Gains<f64>,
    config: &PidConfig<f64>,
) -> Result<Matrix, SimError> {
    scenario.plant.require_equations()?;
    let plant = scenario.plant.linear().ok_or(SimError::NotLinear)?;
    let model = LoopModel::of(scenario, plant, config, Memory::of_gains(gains, config))?;
    if model.has_changing_ages() {
        return Err(SimError::ChangingAges);
    }
    model.closed_matrix(gains)
}

/// The one-sample matrix of the loop with the set-point at zero, as if ages that change were none: a question about numbers, and
/// none about whether the loop holds.
fn closed_loop(
    scenario: &Scenario,
    plant: &LinearPlant,
    gains: Gains<f64>,
    config: &PidConfig<f64>,
) -> Result<Matrix, SimError> {
    fixed_model(scenario, plant, gains, config)?.closed_matrix(gains)
}

/// The loop of a controller whose gains do not move, for which ages that change are none.
fn fixed_model(
    scenario: &Scenario,
    plant: &LinearPlant,
    gains: Gains<f64>,
    config: &PidConfig<f64>,
) -> Result<LoopModel<f64>, SimError> {
    let model = LoopModel::of(scenario, plant, config, Memory::of_gains(gains, config))?;
    Ok(model.without_changing_ages())
}
