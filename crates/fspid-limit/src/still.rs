//! What commands are taken to be: within a range, and as still as those of flights until something happens.

use fspid_sim::{Noises, Scenario, Surroundings};

/// Constraints assumed on the command in addition to those of the actuator.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Assumed {
    /// Of an actuator without limits: they are within ± this, rad.
    pub within_rad: f64,
    /// Until something happens they are near zero; none where they may be anything.
    pub still: Option<Still>,
}

impl Assumed {
    /// Nothing but a range for an actuator without limits, rad.
    #[must_use]
    pub const fn within(within_rad: f64) -> Self {
        Self { within_rad, still: None }
    }
}

/// Nobody moves for what has not happened yet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Still {
    /// First sample at which anything moves the aircraft, or what is commanded or seen of it, but noise of measurements.
    pub until: usize,
    /// The same, s.
    pub until_s: f64,
    /// Commands before are within ± this, rad.
    pub within_rad: f64,
}

impl Still {
    /// Of a scenario: as still as these commands of flights, rad, are until something happens; none where something does
    /// from the start on.
    pub fn of<'a>(scenario: &Scenario, flown: impl Iterator<Item = &'a [f64]>) -> Option<Self> {
        let timing = scenario.timing;
        let (setpoint_rad, _) = scenario.setpoint.sampled(timing);
        let commanded = setpoint_rad.iter().position(|it| *it != 0.0).unwrap_or(timing.rows());
        let pushed_s = scenario.pushes_s(Noises::ThatMove).first().copied();
        let pushed = pushed_s.map_or(timing.rows(), |at_s| timing.first_sample_at(at_s));
        let until = if is_off_from_the_start(scenario) { 0 } else { commanded.min(pushed) };
        let before = flown.flat_map(|commands| commands.iter().take(until));
        let within_rad = before.fold(0.0_f64, |most, u| most.max(u.abs()));
        (until > 0).then(|| Self { until, until_s: timing.time_s(until), within_rad })
    }
}

/// True where air, a bias of the actuator or one of a sensor act from the first sample on.
fn is_off_from_the_start(scenario: &Scenario) -> bool {
    let Surroundings { weather, pitch_sensor, rate_sensor } = &scenario.surroundings;
    let mut sensors = pitch_sensor.iter().chain(rate_sensor);
    weather.is_some()
        || scenario.actuator.parts().bias_rad != 0.0
        || sensors.any(|it| it.model().bias != 0.0)
}
