//! The relay experiment, flown: sampled, with every limit of the loop.

use core::f64::consts::PI;
use core::ops::ControlFlow;

use fspid_sim::signal::{Profile, Shape};
use fspid_sim::{EarlyEnd, EndCause, Outcome, Scenario, Timing, fly_commanded};

use super::RuleError;
use super::options::RelayOptions;
use super::ultimate::UltimatePoint;

/// Cycles that are averaged, and compared with as many before.
const CYCLES: usize = 4;
/// Of many cycles this share is averaged: noise of a sensor takes more than four to average out.
const SHARE: usize = 4;
/// Change of mean period and amplitude from one group to the next at which the oscillation has settled.
const SETTLED: f64 = 0.005;
/// After so many cycles noise keeps the means from settling any better, and a change within one standard error of the
/// difference of two means is let pass.
const PATIENCE: usize = 40;
/// Scatter of the amplitude from cycle to cycle that is warned of.
const SCATTER: f64 = 0.05;
/// Share of half a period that the elevator may be on its way at its rate limit without being warned of.
const TRAVEL: f64 = 0.1;
/// Difference from the exact ultimate point that is warned of.
const APART: f64 = 0.15;

/// What a relay experiment showed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RelayExperiment {
    /// Command to either side, rad.
    pub amplitude_rad: f64,
    /// Switching level to either side, rad.
    pub hysteresis_rad: f64,
    /// Amplitude of the seen pitch angle, half of peak to peak, rad.
    pub oscillation_rad: f64,
    /// Period, s.
    pub period_s: f64,
    /// How far the oscillation lies off zero, rad.
    pub offset_rad: f64,
    /// Standard deviation of the amplitude from cycle to cycle, over its mean.
    pub scatter: f64,
    /// Cycles until it had settled.
    pub cycles: usize,
    /// When, s.
    pub settled_s: f64,
    /// Phase of the process at the oscillation by the describing function, deg: −180 without hysteresis.
    pub phase_deg: f64,
    /// Ultimate gain and period by the describing function.
    pub ultimate: UltimatePoint,
}

/// One cycle, from switch to nose up to the next.
#[derive(Clone, Copy, Default)]
struct Cycle {
    samples: usize,
    lowest_rad: f64,
    highest_rad: f64,
}

impl Cycle {
    fn amplitude_rad(&self) -> f64 {
        0.5 * (self.highest_rad - self.lowest_rad)
    }
}

/// Means over the last cycles.
#[derive(Clone, Copy)]
struct Settled {
    period_samples: f64,
    amplitude_rad: f64,
    middle_rad: f64,
    scatter: f64,
}

/// The relay and what it has seen.
struct Relay {
    options: RelayOptions,
    up: bool,
    current: Cycle,
    cycles: Vec<Cycle>,
}

impl Relay {
    fn new(options: RelayOptions) -> Self {
        Self { options, up: true, current: Cycle::default(), cycles: Vec::new() }
    }

    /// Answers a seen pitch angle, rad.
    fn answer(&mut self, pitch_rad: f64) -> f64 {
        if self.up && pitch_rad > self.options.hysteresis_rad {
            self.up = false;
        } else if !self.up && pitch_rad < -self.options.hysteresis_rad {
            self.up = true;
            let next = Cycle { samples: 0, lowest_rad: pitch_rad, highest_rad: pitch_rad };
            self.cycles.push(core::mem::replace(&mut self.current, next));
        }
        self.current.samples += 1;
        self.current.lowest_rad = self.current.lowest_rad.min(pitch_rad);
        self.current.highest_rad = self.current.highest_rad.max(pitch_rad);
        if self.up { self.options.amplitude_rad } else { -self.options.amplitude_rad }
    }

    /// Means of samples, amplitude and middle over the last cycles, if those before were the same.
    fn settled(&self) -> Option<Settled> {
        // The first cycle begins at rest and is never compared.
        let (_, cycles) = self.cycles.split_first()?;
        let group = CYCLES.max(cycles.len() / SHARE);
        let recent = cycles.len().checked_sub(2 * group)?;
        let (before, last) = cycles.get(recent..)?.split_at(group);
        let (before, found) = (means(before), means(last));
        let [period, amplitude, _] = found;
        let scatter = scatter(last, amplitude);
        let noise = scatter * (2.0 / group as f64).sqrt();
        let change = if cycles.len() < PATIENCE { SETTLED } else { SETTLED.max(noise) };
        let same = (before[0] - period).abs() <= change * period
            && (before[1] - amplitude).abs() <= change * amplitude;
        same.then(|| Settled {
            period_samples: period,
            amplitude_rad: amplitude,
            middle_rad: found[2],
            scatter,
        })
    }
}

/// Standard deviation of the amplitude from cycle to cycle, over its mean.
fn scatter(cycles: &[Cycle], mean_rad: f64) -> f64 {
    let off = |cycle: &Cycle| {
        (cycle.amplitude_rad() / mean_rad - 1.0) * (cycle.amplitude_rad() / mean_rad - 1.0)
    };
    (cycles.iter().map(off).sum::<f64>() / cycles.len().max(1) as f64).sqrt()
}

fn means(cycles: &[Cycle]) -> [f64; 3] {
    let mean = |value: fn(&Cycle) -> f64| {
        cycles.iter().map(value).sum::<f64>() / cycles.len().max(1) as f64
    };
    [
        mean(|cycle| cycle.samples as f64),
        mean(Cycle::amplitude_rad),
        mean(|cycle| 0.5 * (cycle.highest_rad + cycle.lowest_rad)),
    ]
}

/// Flies a relay in the controller's place, in calm air, with the set-point at zero and no disturbance.
///
/// With amplitudes d of the relay and a of the oscillation and the hysteresis ε
///
/// $$ -\frac{1}{N(a)} = -\frac{\pi}{4 d} \left( \sqrt{a^2 - \varepsilon^2} + j \varepsilon \right),
/// \quad K_u \approx \frac{4 d}{\pi \sqrt{a^2 - \varepsilon^2}} $$
pub(super) fn experiment(
    scenario: &Scenario,
    options: RelayOptions,
) -> Result<RelayExperiment, RuleError> {
    let RelayOptions { amplitude_rad, hysteresis_rad, longest_s, .. } = options;
    require_passed(scenario, amplitude_rad)?;
    let still = still(scenario, longest_s)?;
    let dt_s = still.timing.dt_s();
    let prepared = still.prepare()?;
    // Two closures share it: one answers, one looks whether to go on.
    let relay = core::cell::RefCell::new(Relay::new(options));
    let mut found = None;
    let outcome = fly_commanded(
        &prepared,
        |sample| relay.borrow_mut().answer(sample.measurement_rad),
        |instant| match relay.borrow().settled() {
            Some(settled) => {
                found = Some((settled, instant.k));
                ControlFlow::Break(())
            }
            None => ControlFlow::Continue(()),
        },
    )?;
    if let Outcome::EndedEarly(EarlyEnd { at_s, cause }) = outcome {
        match cause {
            EndCause::Diverged => return Err(RuleError::RelayDiverged { at_s }),
            EndCause::HitGround => return Err(RuleError::RelayHitGround { at_s }),
            // A relay is no program that could be lost, and what another simulator flies is not asked.
            EndCause::ControllerLost(_) | EndCause::PlantLost(_) => {}
        }
    }
    let cycles = relay.borrow().cycles.len();
    let Some((settled, k)) = found else {
        return Err(RuleError::NoOscillation { longest_s, cycles });
    };
    let oscillation_rad = settled.amplitude_rad;
    // Written so that NaN is refused.
    if !(oscillation_rad > hysteresis_rad) {
        let amplitude_rad = oscillation_rad;
        return Err(RuleError::RelayTooSmall { amplitude_rad, hysteresis_rad });
    }
    let along = (oscillation_rad * oscillation_rad - hysteresis_rad * hysteresis_rad).sqrt();
    let period_s = settled.period_samples * dt_s;
    let gain = 4.0 * amplitude_rad / (PI * along);
    let lead_rad = libm::asin(hysteresis_rad / oscillation_rad);
    Ok(RelayExperiment {
        amplitude_rad,
        hysteresis_rad,
        oscillation_rad,
        period_s,
        offset_rad: settled.middle_rad,
        scatter: settled.scatter,
        cycles,
        settled_s: k as f64 * dt_s,
        phase_deg: fspid_scenario::units::degrees(lead_rad) - 180.0,
        ultimate: UltimatePoint { gain, period_s, lowest_gain: None },
    })
}

/// The scenario at rest: its plant, actuator and sensors alone.
fn still(scenario: &Scenario, longest_s: f64) -> Result<Scenario, RuleError> {
    let mut still = scenario.clone();
    still.plant_changes.clear();
    still.disturbances.clear();
    still.controllers.clear();
    still.surroundings.weather = None;
    still.autopilot = None;
    still.setpoint = Profile::new(0.0, Shape::Step { at_s: 0.0 })?;
    still.timing = Timing::new(scenario.timing.dt_s(), longest_s)?;
    Ok(still)
}

/// `Ok` where the actuator lets the relay's command through.
fn require_passed(scenario: &Scenario, amplitude_rad: f64) -> Result<(), RuleError> {
    let actuator = scenario.actuator;
    // Dead bands and biases move the command a little, limits of command and travel cut it.
    let bounds = [actuator.command_limits_rad(), actuator.travel_rad()];
    let ends = bounds.into_iter().flatten().flat_map(|(low, high)| [-low, high]);
    let reached_rad = ends.fold(f64::INFINITY, f64::min);
    if amplitude_rad <= reached_rad {
        return Ok(());
    }
    Err(RuleError::RelayCut { amplitude_rad, reached_rad })
}

impl RelayExperiment {
    /// What is to be said of the experiment, beside the exact ultimate point if there is one.
    pub(super) fn warnings(
        &self,
        scenario: &Scenario,
        exact: Option<&UltimatePoint>,
    ) -> Vec<String> {
        let mut warnings = Vec::new();
        let rate = scenario.actuator.rate_limit_rad_s();
        let travel_s = rate.map_or(0.0, |rate| 2.0 * self.amplitude_rad / rate);
        if travel_s > TRAVEL * 0.5 * self.period_s {
            warnings.push(format!(
                "the elevator needs {travel_s:.3} s of each half period of {:.3} s to follow the relay: its rate limit is in the result",
                0.5 * self.period_s
            ));
        }
        if self.scatter > SCATTER {
            warnings.push(format!(
                "the amplitude scatters by {:.0} % from cycle to cycle: noise or drift of the sensor is in the result, and a larger relay amplitude would drown it",
                100.0 * self.scatter
            ));
        }
        if self.offset_rad.abs() > TRAVEL * self.oscillation_rad {
            warnings.push(format!(
                "the oscillation lies off zero by {:.0} % of its amplitude",
                100.0 * self.offset_rad.abs() / self.oscillation_rad
            ));
        }
        if let Some(exact) = exact {
            let off = [self.ultimate.gain / exact.gain, self.period_s / exact.period_s];
            if off.iter().any(|ratio| (ratio - 1.0).abs() > APART) {
                warnings.push(format!(
                    "the relay's ultimate gain is {:.2} times and its period {:.2} times that of the linear loop: harmonics, hysteresis or limits are in the result",
                    off[0], off[1]
                ));
            }
        }
        warnings
    }
}
