//! Reference flights for linearisation: at rest at a trim, in constant air, with no limit active.

use fspid_core::{Gains, Pid, PidConfig};

use crate::actuator::Actuator;
use crate::air::{Steady, Wind, sum_at};
use crate::autopilot::{Autopilot, Entry, GlideSlope, Mode, OuterLoop, TotalEnergy};
use crate::controller::Controller;
use crate::error::SimError;
use crate::loop_model::{Sensing, comes_again_after};
use crate::rest::settled;
use crate::scenario::{Prepared, Scenario};
use crate::sensor::{Seeing, Sensor};
use crate::surroundings::{Surroundings, Weather, seen};
use crate::timing::Timing;

/// Samples flown before anything is moved, beside those that sensors remember: all loops are engaged then.
const SETTLING_SAMPLES: usize = 3;
/// How far the antenna of a level beam is, m: from there a height is seen as it is, to 10⁻¹⁰ m.
const FAR_M: f64 = 1e7;

/// Most samples that are flown to ask for all ages of the sensors in their order: some hundredths of a second.
const MOST_FLOWN: usize = 30_000;
/// Numbers of a flight beside what is on its way, about.
const NUMBERS: usize = 40;

impl Seeing {
    /// The way in which a scenario's sensors show them: as they come, where ages change and come again soon.
    pub(crate) fn first(scenario: &Scenario) -> Self {
        match samples_of_all_ages(scenario) {
            Some(_) => Self::AsTheyCome,
            None => Self::Latest,
        }
    }

    /// Samples over which they are asked.
    pub(super) fn samples(self, scenario: &Scenario) -> usize {
        match self {
            Self::AsTheyCome => samples_of_all_ages(scenario).unwrap_or(1),
            Self::Latest | Self::Earliest | Self::Midway | Self::Erecting => 1,
        }
    }

    /// The ways in which they may show them beside the [`first`](Self::first).
    pub(crate) fn others(scenario: &Scenario) -> Vec<Self> {
        let dt_s = scenario.timing.dt_s();
        let has_ages = |sensor: &Sensor| Sensing::through(Some(sensor), dt_s).at_largest_age;
        let is_open = sensors(scenario).any(has_ages) && Self::first(scenario) == Self::Latest;
        let ages = is_open.then_some([Self::Midway, Self::Earliest]);
        let pitch = &scenario.surroundings.pitch_sensor;
        let erects = pitch.is_some_and(|sensor| sensor.model().erection_rad_s > 0.0);
        ages.into_iter().flatten().chain(erects.then_some(Self::Erecting)).collect()
    }
}

/// Samples after which all ages of a scenario's sensors come again; none where none changes, or it takes too long to ask.
fn samples_of_all_ages(scenario: &Scenario) -> Option<usize> {
    let dt_s = scenario.timing.dt_s();
    let has_ages = |sensor: &&Sensor| Sensing::through(Some(sensor), dt_s).at_largest_age;
    let periods = sensors(scenario).filter(has_ages).map(|sensor| sensor.model().period_s / dt_s);
    let periods: Vec<f64> = periods.collect();
    let samples = comes_again_after(&periods).filter(|_| !periods.is_empty())?;
    let flown = 2 * samples * (NUMBERS + on_its_way(scenario));
    (flown <= MOST_FLOWN).then_some(samples)
}

/// The scenario at rest in still air, without what is around its pitch loop.
pub(super) fn still_alone(scenario: &Scenario, seeing: Seeing) -> Result<Scenario, SimError> {
    let mut still = scenario.clone();
    still.autopilot = None;
    still.disturbances.clear();
    // Without what is wider than small motions, or keeps a surface from them.
    still.actuator =
        Actuator::new(scenario.actuator.lag()).with_delay(scenario.actuator.delay_samples())?;
    let dt_s = scenario.timing.dt_s();
    // Long enough to settle, however short the flight is.
    let samples = settling_samples(scenario)? + seeing.samples(scenario) + 10;
    still.timing = Timing::new(dt_s, samples as f64 * dt_s)?;
    let course = scenario.surroundings.weather.as_ref().map(|weather| weather.course);
    let calm = |course| Weather { course, winds: Vec::new(), turbulence: None };
    let around_rest = |sensor: Option<Sensor>| sensor.map(|it| it.around_rest(dt_s, seeing));
    let Surroundings { pitch_sensor, rate_sensor, .. } = scenario.surroundings;
    still.surroundings = Surroundings {
        weather: course.map(calm),
        pitch_sensor: around_rest(pitch_sensor),
        rate_sensor: around_rest(rate_sensor),
    };
    Ok(still)
}

/// The wind in which a flight begins, as if it stayed, of an aircraft that is turned to the north: what is counted over the ground
/// moves by it more or less for the same motion through the air.
fn wind_of_the_start(weather: &Weather) -> Option<Wind> {
    let earth_m_s = sum_at(&weather.winds, &weather.course.place(0.0)).earth_m_s;
    let earth_m_s = seen(earth_m_s, weather.course.heading_rad);
    let blows = earth_m_s.iter().any(|part| *part != 0.0);
    blows.then_some(Wind::Steady(Steady { earth_m_s }))
}

/// The heading that a scenario begins on, rad.
fn begins_on_rad(scenario: &Scenario) -> f64 {
    scenario.surroundings.weather.as_ref().map_or(0.0, |it| it.course.heading_rad)
}

/// The scenario at rest in the wind of its start with one mode engaged for good, nothing of it limited, and turned to the north:
/// a heading of half a turn is one that small motions jump across.
pub(super) fn still(
    scenario: &Scenario,
    autopilot: &Autopilot,
    mode: usize,
    seeing: Seeing,
) -> Result<Prepared, SimError> {
    let mut still = still_alone(scenario, seeing)?;
    if let Some((air, own)) =
        still.surroundings.weather.as_mut().zip(scenario.surroundings.weather.as_ref())
    {
        air.winds.extend(wind_of_the_start(own));
        air.course.heading_rad = 0.0;
    }
    let heading_rad = begins_on_rad(scenario);
    let dt_s = scenario.timing.dt_s();
    // A scale would move the trim of what is not counted from it.
    let late = |sensor: Option<Sensor>| {
        sensor.map(|it| it.around_rest(dt_s, seeing)).map(Sensor::without_scale)
    };
    let beam = autopilot.glide_slope().zip(scenario.plant.aircraft()).map(|(beam, plant)| {
        let course_rad = beam.course_rad - heading_rad;
        let (sine, cosine) = crate::math::sin_cos(course_rad);
        GlideSlope {
            course_rad,
            angle_rad: 0.0,
            antenna_m: [FAR_M * cosine, FAR_M * sine],
            altitude_m: plant.trim().target.altitude_m,
            angle_sensor: late(beam.angle_sensor),
            range_sensor: late(beam.range_sensor),
        }
    });
    let loops = autopilot.loops().iter().map(|outer| {
        let controller = resting(&outer.controller)?;
        Ok(OuterLoop { controller, sensor: late(outer.sensor), ..outer.clone() })
    });
    let loops = loops.collect::<Result<Vec<_>, SimError>>()?;
    let energy = autopilot.total_energy().map(|total| {
        Ok::<_, SimError>(TotalEnergy {
            energy: resting(&total.energy)?,
            distribution: resting(&total.distribution)?,
            ..*total
        })
    });
    let alone = autopilot.modes().get(mode).map(|mode| Mode {
        entry: Entry::default(),
        targets: Vec::new(),
        bank_rad: 0.0,
        ..mode.clone()
    });
    let modes = alone.into_iter().collect();
    still.autopilot = Some(Autopilot::new(loops, energy.transpose()?, beam, modes)?);
    still.prepare()
}

/// Samples of commands on their way, and of what sensors show later.
pub(super) fn on_its_way(scenario: &Scenario) -> usize {
    let dt_s = scenario.timing.dt_s();
    let late = |sensor| Sensing::through(Some(sensor), dt_s).remembered();
    let samples = sensors(scenario).map(late);
    samples.fold(scenario.actuator.delay_samples(), usize::saturating_add)
}

/// Samples after which every sensor looks at what was after the start.
pub(super) fn settling_samples(scenario: &Scenario) -> Result<usize, SimError> {
    let dt_s = scenario.timing.dt_s();
    let mut samples = sensors(scenario).map(|sensor| sensor.memory_samples(dt_s));
    let longest = samples.try_fold(0, |longest, found| found.map(|found| longest.max(found)))?;
    Ok(SETTLING_SAMPLES + longest)
}

/// Every sensor of a scenario with an autopilot.
fn sensors(scenario: &Scenario) -> impl Iterator<Item = &Sensor> {
    let Surroundings { pitch_sensor, rate_sensor, .. } = &scenario.surroundings;
    let autopilot = scenario.autopilot.as_ref();
    let loops = autopilot.map(Autopilot::loops).unwrap_or_default();
    let beam = autopilot.and_then(Autopilot::glide_slope).into_iter();
    let of_beam = beam.flat_map(|beam| [&beam.angle_sensor, &beam.range_sensor]);
    let of_loops = loops.iter().map(|outer| &outer.sensor);
    [pitch_sensor, rate_sensor].into_iter().chain(of_loops).chain(of_beam).flatten()
}

/// The gains that a controller comes to with everything at zero; none where they gather without end.
pub(super) fn at_rest(controller: &Controller) -> Option<Gains<f64>> {
    match controller {
        Controller::Fixed(pid) => Some(pid.gains()),
        Controller::SelfTuning(fspid) => settled(fspid),
    }
}

/// A controller with the gains that it comes to, or begins with where they never stand still, and no limits.
fn resting(controller: &Controller) -> Result<Controller, SimError> {
    unlimited(controller, at_rest(controller).unwrap_or_else(|| controller.nominal()))
}

/// A controller with these gains that no limit acts on.
pub(super) fn unlimited(
    controller: &Controller,
    gains: Gains<f64>,
) -> Result<Controller, SimError> {
    let config = PidConfig {
        anti_windup: fspid_core::AntiWindup::None,
        limits: None,
        slew_rad_s: None,
        ..controller.config_at(gains)
    };
    Ok(Controller::Fixed(Pid::new(gains, config)?))
}
