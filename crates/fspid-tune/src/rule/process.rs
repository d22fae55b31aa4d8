//! The process that a rule tunes for: everything from command to seen pitch, exactly sampled.

use fspid_core::{Gains, PidConfig};
use fspid_lti::{Complex, SampledLoop, modulus};
use fspid_sim::loop_model::{BreakPoint, LoopModel, Memory};
use fspid_sim::{AircraftPlant, LinearPlant, Scenario, SimError};

use super::{Options, RuleError};

/// Largest modulus of a pole of a plant that counts as stable: as [`SampledLoop::margins`], to the other side.
const STABLE_UP_TO: f64 = 1.0 + 1e-9;
/// Where an integrating process is asked for its steady rate, rad/s: far below every mode of an aircraft, far above
/// what rounding does to a pole at 1.
const SLOW_RAD_S: f64 = 1e-4;

/// The process behind a proportional controller: servo, delays, plant, sensor and the closed rate loop, if there is one.
///
/// $$ P(z) = \theta_{seen}(z) / u(z) $$
#[derive(Clone, Debug)]
pub(super) struct Process {
    scenario: Scenario,
    plant: LinearPlant,
    /// Everything of the controller but its gains.
    pub(super) config: PidConfig<f64>,
    /// P, as the loop of a gain of 1.
    pub(super) open: SampledLoop,
    /// Poles at the origin.
    pub(super) integrators: usize,
    /// Largest modulus of a pole, integrators left out.
    pub(super) spectral_radius: f64,
    /// Steady pitch angle per command, or pitch rate per command with one integrator; none with more.
    pub(super) steady: Option<f64>,
}

impl Process {
    /// The process of the plant that a scenario starts with.
    pub(super) fn of(scenario: &Scenario, options: &Options) -> Result<Self, RuleError> {
        let dt_s = scenario.timing.dt_s();
        let config = options.config.unwrap_or_else(|| PidConfig::sampled_every(dt_s));
        if config.dt_s.to_bits() != dt_s.to_bits() {
            return Err(RuleError::SamplePeriod { found: config.dt_s, allowed: dt_s });
        }
        let plant = first_plant(scenario)?;
        let memory = Memory::of_gains(Gains::ZERO, &config);
        let open = LoopModel::of(scenario, &plant, &config, memory)?
            .open(Gains { kp: 1.0, ..Gains::ZERO }, BreakPoint::Pitch)?;
        let integrators = integrators(&plant);
        let spectral_radius = radius_without(&open.open_poles()?, integrators);
        let steady = match integrators {
            0 => Some(open.at(0.0).re),
            1 => Some(-open.at(SLOW_RAD_S).im * SLOW_RAD_S),
            _ => None,
        };
        let scenario = scenario.clone();
        Ok(Self { scenario, plant, config, open, integrators, spectral_radius, steady })
    }

    /// The loop around rest with a controller of this configuration, gains and memory.
    pub(super) fn model(
        &self,
        config: &PidConfig<f64>,
        memory: Memory,
    ) -> Result<LoopModel<f64>, SimError> {
        LoopModel::of(&self.scenario, &self.plant, config, memory)
    }

    /// P times a gain, as an open loop.
    pub(super) fn scaled(&self, gain: f64) -> Result<SampledLoop, RuleError> {
        let model = self.model(&self.config, Memory::of_gains(Gains::ZERO, &self.config))?;
        Ok(model.open(Gains { kp: gain, ..Gains::ZERO }, BreakPoint::Pitch)?)
    }

    /// P at a frequency, rad/s.
    pub(super) fn at(&self, omega_rad_s: f64) -> Complex {
        self.open.at(omega_rad_s)
    }

    /// True without modes that grow.
    pub(super) fn is_stable(&self) -> bool {
        self.spectral_radius <= STABLE_UP_TO
    }

    /// `Ok` for a process that a lag or an integrator can stand for.
    pub(super) fn require_model(&self, rule: &'static str) -> Result<(), RuleError> {
        if !self.is_stable() {
            let spectral_radius = self.spectral_radius;
            return Err(RuleError::UnstablePlant { rule, spectral_radius });
        }
        self.require_sign()?;
        match self.integrators {
            0 | 1 => Ok(()),
            found => Err(RuleError::Integrators { rule, found }),
        }
    }

    /// `Ok` unless a plant that settles does so the wrong way.
    pub(super) fn require_sign(&self) -> Result<(), RuleError> {
        match self.steady {
            // Written so that NaN is refused. The steady state of an unstable plant says nothing.
            Some(steady) if self.is_stable() && !(steady > 0.0) => {
                Err(RuleError::WrongSign { steady })
            }
            _ => Ok(()),
        }
    }
}

/// The plant at the start, an aircraft's linear model at its trim in its place.
fn first_plant(scenario: &Scenario) -> Result<LinearPlant, SimError> {
    scenario.plant.require_equations()?;
    match (scenario.plant.linear(), scenario.plant.aircraft()) {
        (Some(plant), _) => Ok(plant.clone()),
        (None, Some(aircraft)) => AircraftPlant::linear(aircraft),
        (None, None) => Err(SimError::NotLinear),
    }
}

fn integrators(plant: &LinearPlant) -> usize {
    let transfer_function = plant.transfer_function();
    let [zeros, poles] = [transfer_function.numerator(), transfer_function.denominator()]
        .map(|polynomial| polynomial.roots_at_origin());
    poles.saturating_sub(zeros)
}

/// Largest modulus of the poles without the so many that are nearest to 1.
fn radius_without(poles: &[Complex], integrators: usize) -> f64 {
    let mut by_distance = poles.to_vec();
    by_distance.sort_by(|one, other| modulus(one - 1.0).total_cmp(&modulus(other - 1.0)));
    by_distance.iter().skip(integrators).map(|pole| modulus(*pole)).fold(0.0, f64::max)
}
