//! Small motions of an aircraft with everything around its pitch loop: what one sample makes of them.
//!
//! The flying code itself is asked: a flight stands at the trim with one mode engaged for good, each of its numbers is moved
//! a little either way, and one sample is flown. Limits are left out, gains are those at rest, and the air stands still. Sensors
//! show late what they show late, that of the pitch loop with their scale, and nothing else; of one with a clock of its own the
//! largest age is taken. Every target is what the trim has; a beam is level there.

use fspid_core::{Gains, Pid, PidConfig, State};
use fspid_lti::{Complex, Matrix, eigenvalues, modulus};

use super::Course;
use crate::autopilot::{Autopilot, Entry, GlideSlope, Mode, OuterLoop, Quantity, TotalEnergy};
use crate::controller::Controller;
use crate::error::SimError;
use crate::flown::Perturbation;
use crate::loop_model::{MOST_AS_STATES, Sensing};
use crate::scenario::{Prepared, Scenario};
use crate::sensor::{Sensor, SensorState};
use crate::surroundings::{Surroundings, Weather};
use crate::timing::Timing;
use crate::trace::Outcome;

/// Smaller poles are gone within a sample: those of delays, and of what is remembered of the sample before.
const GONE: f64 = 1e-6;
/// Samples flown before anything is moved, beside those that sensors remember: all loops are engaged then.
const SETTLING_SAMPLES: usize = 3;
/// How far the antenna of a level beam is, m: from there a height is seen as it is, to 10⁻¹⁰ m.
const FAR_M: f64 = 1e7;

/// The poles of a mode, in the plane of s.
#[derive(Clone, Debug, PartialEq)]
pub struct ModePoles {
    /// Number of the mode, from 0.
    pub mode: usize,
    /// Poles of the sampled loop, each as $s = \ln z / T$ in 1/s; those of pure delays, z = 0, are left out.
    pub poles: Vec<Complex>,
    /// Largest size of z.
    pub spectral_radius: f64,
}

/// The poles of a scenario's aircraft with a controller and, one mode after another, everything that an autopilot engages;
/// none without an autopilot.
///
/// Left out are positions and, in modes that hold neither altitude nor a beam, the altitude; in modes that hold no heading, the
/// heading: nothing pulls on them, and their poles are at 0.
///
/// # Errors
/// [`SimError`] where the flight cannot be prepared or the eigenvalues are not found.
pub fn mode_poles(
    scenario: &Scenario,
    controller: &Controller,
    gains: Gains<f64>,
) -> Result<Vec<ModePoles>, SimError> {
    let Some(autopilot) = &scenario.autopilot else { return Ok(Vec::new()) };
    let controller = unlimited(controller, gains)?;
    let numbers = 0..autopilot.modes().len();
    numbers.map(|mode| poles_of(scenario, autopilot, mode, &controller)).collect()
}

fn poles_of(
    scenario: &Scenario,
    autopilot: &Autopilot,
    mode: usize,
    controller: &Controller,
) -> Result<ModePoles, SimError> {
    let samples = on_its_way(scenario);
    if samples > MOST_AS_STATES {
        return Err(SimError::LongWay { samples, most: MOST_AS_STATES });
    }
    let still = still(scenario, autopilot, mode)?;
    let settling = settling_samples(scenario)?;
    let motion = one_sample(&still, settling, autopilot.modes().get(mode), controller);
    let (_, matrix) = motion.map_err(|ended| ended.of(mode))?;
    let dt_s = scenario.timing.dt_s();
    let found = eigenvalues(&matrix)?;
    let spectral_radius = found.iter().map(|z| modulus(*z)).fold(0.0, f64::max);
    let poles = found.iter().filter(|z| modulus(**z) > GONE).map(|z| in_s(*z, dt_s)).collect();
    Ok(ModePoles { mode, poles, spectral_radius })
}

/// $s = \ln z / T$.
fn in_s(z: Complex, dt_s: f64) -> Complex {
    Complex::new(libm::log(modulus(z)) / dt_s, libm::atan2(z.im, z.re) / dt_s)
}

/// Spectral radius of all small motions about the trim of an aircraft with nothing around its pitch loop: roll, yaw and bank
/// with leveller and damper among them. None with an autopilot, whose modes have them, and where the aileron rolls nothing.
///
/// # Errors
/// As [`mode_poles`].
pub(crate) fn radius_alone(
    scenario: &Scenario,
    controller: &Controller,
    gains: Gains<f64>,
) -> Result<Option<f64>, SimError> {
    if scenario.autopilot.is_some()
        || scenario.plant.aircraft().is_none()
        || on_its_way(scenario) > MOST_AS_STATES
    {
        return Ok(None);
    }
    let controller = unlimited(controller, gains)?;
    let still = still_alone(scenario)?.prepare()?;
    let motion = one_sample(&still, settling_samples(scenario)?, None, &controller);
    let (places, matrix) = motion.map_err(|ended| ended.of(0))?;
    let at = |beyond: usize| {
        places.iter().position(|place| matches!(place, Place::Beyond(at) if *at == beyond))
    };
    let rolls = at(ROLLING).zip(at(AILERON)).and_then(|(row, column)| matrix.get(row, column));
    if rolls.is_none_or(|by_aileron| by_aileron == 0.0) {
        return Ok(None);
    }
    let found = eigenvalues(&matrix)?;
    Ok(Some(found.iter().map(|z| modulus(*z)).fold(0.0, f64::max)))
}

/// The scenario at rest in still air, without what is around its pitch loop.
fn still_alone(scenario: &Scenario) -> Result<Scenario, SimError> {
    let mut still = scenario.clone();
    still.autopilot = None;
    still.disturbances.clear();
    let dt_s = scenario.timing.dt_s();
    // Long enough to settle, however short the flight is.
    let samples = settling_samples(scenario)? + 10;
    still.timing = Timing::new(dt_s, samples as f64 * dt_s)?;
    let course = scenario.surroundings.weather.as_ref().map(|weather| weather.course);
    let calm = |course| Weather { course, winds: Vec::new(), turbulence: None };
    let around_rest = |sensor: Option<Sensor>| sensor.map(|it| it.around_rest(dt_s));
    let Surroundings { pitch_sensor, rate_sensor, .. } = scenario.surroundings;
    still.surroundings = Surroundings {
        weather: course.map(calm),
        pitch_sensor: around_rest(pitch_sensor),
        rate_sensor: around_rest(rate_sensor),
    };
    Ok(still)
}

/// The scenario at rest in still air with one mode engaged for good, nothing of it limited.
fn still(scenario: &Scenario, autopilot: &Autopilot, mode: usize) -> Result<Prepared, SimError> {
    let mut still = still_alone(scenario)?;
    let dt_s = scenario.timing.dt_s();
    // A scale would move the trim of what is not counted from it.
    let late =
        |sensor: Option<Sensor>| sensor.map(|it| it.around_rest(dt_s)).map(Sensor::without_scale);
    let beam = autopilot.glide_slope().zip(scenario.plant.aircraft()).map(|(beam, plant)| {
        let (sine, cosine) = crate::math::sin_cos(beam.course_rad);
        GlideSlope {
            angle_rad: 0.0,
            antenna_m: [FAR_M * cosine, FAR_M * sine],
            altitude_m: plant.trim().target.altitude_m,
            angle_sensor: late(beam.angle_sensor),
            range_sensor: late(beam.range_sensor),
            ..*beam
        }
    });
    let loops = autopilot.loops().iter().map(|outer| {
        let gains = at_rest(&outer.controller);
        let controller = unlimited(&outer.controller, gains)?;
        Ok(OuterLoop { controller, sensor: late(outer.sensor), ..outer.clone() })
    });
    let loops = loops.collect::<Result<Vec<_>, SimError>>()?;
    let energy = autopilot.total_energy().map(|total| {
        Ok::<_, SimError>(TotalEnergy {
            energy: unlimited(&total.energy, at_rest(&total.energy))?,
            distribution: unlimited(&total.distribution, at_rest(&total.distribution))?,
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
fn on_its_way(scenario: &Scenario) -> usize {
    let dt_s = scenario.timing.dt_s();
    let late = |sensor| Sensing::through(Some(sensor), dt_s).remembered();
    let samples = sensors(scenario).map(late);
    samples.fold(scenario.actuator.delay_samples(), usize::saturating_add)
}

/// Samples after which every sensor looks at what was after the start.
fn settling_samples(scenario: &Scenario) -> Result<usize, SimError> {
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

/// The gains that a controller has with everything at zero.
fn at_rest(controller: &Controller) -> Gains<f64> {
    match controller {
        Controller::Fixed(pid) => pid.gains(),
        Controller::SelfTuning(fspid) => fspid.tuner().gains_at_rest(),
    }
}

/// A controller with these gains that no limit acts on.
fn unlimited(controller: &Controller, gains: Gains<f64>) -> Result<Controller, SimError> {
    let config = PidConfig {
        anti_windup: fspid_core::AntiWindup::None,
        limits: None,
        slew_rad_s: None,
        ..controller.config_at(gains)
    };
    Ok(Controller::Fixed(Pid::new(gains, config)?))
}

/// A flight between two samples.
#[derive(Clone)]
struct Flying<'a> {
    course: Course<&'a Prepared>,
    memory: State<f64>,
}

/// Why a flight about the trim has no next sample.
enum Ended {
    Flight(Outcome),
    Failed(SimError),
}

impl From<SimError> for Ended {
    fn from(error: SimError) -> Self {
        Self::Failed(error)
    }
}

impl Ended {
    /// In words, of a mode.
    fn of(self, mode: usize) -> SimError {
        match self {
            Self::Flight(Outcome::Diverged { at_s }) => {
                SimError::LeavesTrim { mode, at_s, how: "diverges" }
            }
            Self::Flight(Outcome::HitGround { at_s }) => {
                SimError::LeavesTrim { mode, at_s, how: "hits the ground" }
            }
            // Nobody else flies what has equations, and it is long enough.
            Self::Flight(_) => SimError::NotLinear,
            Self::Failed(error) => error,
        }
    }
}

impl Flying<'_> {
    fn fly(&mut self, controller: &Controller) -> Result<(), Ended> {
        let seen = self.course.look().map_err(Ended::Flight)?;
        let step = controller.step(&mut self.memory, seen.sample());
        let (_, command_rad) = self.course.take(seen, step);
        Ok(self.course.advance(command_rad)?)
    }
}

/// A number of a flight.
#[derive(Clone, Copy)]
enum Place {
    /// Of pitching and its actuator.
    Pitching(usize),
    /// Of an aircraft beyond pitching.
    Beyond(usize),
    /// A command on its way, the oldest first.
    OnItsWay(usize),
    /// Of what a controller remembers: the pitch controller's, then those of engaged loops.
    Remembered(usize, usize),
    /// What a sensor looks at later, and how many samples before.
    Seen(usize, usize),
}

/// All numbers of a flight that count: what nothing pulls on is left out.
fn places(flying: &mut Flying<'_>, mode: Option<&Mode>, controller: &Controller) -> Vec<Place> {
    let seen = seen_places(flying, mode);
    let course = &flying.course;
    let autopilot = course.prepared().autopilot.as_ref();
    let loops = autopilot.map(Autopilot::loops).unwrap_or_default();
    let engaged = || mode.iter().flat_map(|mode| &mode.engaged).filter_map(|&at| loops.get(at));
    let holds = |quantity: Quantity| engaged().any(|outer| outer.holds == quantity);
    let total = mode.is_some_and(|mode| mode.total_energy);
    let counts = |place: &usize| match *place {
        ALTITUDE => total || holds(Quantity::Altitude) || holds(Quantity::GlideSlope),
        HEADING => holds(Quantity::Heading),
        POWER => course.propagation().has_lagging_engine(),
        _ => true,
    };
    let pitching = course.propagation().values(course.plant()).len();
    let energy = autopilot.and_then(Autopilot::total_energy).filter(|_| total);
    let energy = energy.iter().flat_map(|total| [&total.energy, &total.distribution]);
    // In the order of the memories.
    let numbered = mode.iter().flat_map(|mode| {
        let mut numbers = mode.engaged.clone();
        numbers.sort_unstable();
        numbers
    });
    let engaged = numbered.filter_map(|at| loops.get(at)).map(|outer| &outer.controller);
    let controllers = std::iter::once(controller).chain(engaged).chain(energy);
    let remembered = controllers.enumerate().flat_map(|(number, controller)| {
        // What a gain of zero never lets into the command stands still, or is gone at once.
        let Gains { ki, kd, .. } = controller.nominal();
        let counts = move |place: &usize| if *place == 0 { ki != 0.0 } else { kd != 0.0 };
        (0..REMEMBERED).filter(counts).map(move |place| Place::Remembered(number, place))
    });
    (0..pitching)
        .map(Place::Pitching)
        .chain((0..BEYOND).filter(counts).map(Place::Beyond))
        .chain((0..course.delayed.commands_rad.len()).map(Place::OnItsWay))
        .chain(remembered)
        .chain(seen)
        .collect()
}

/// What the sensors that a mode sees by look at later.
fn seen_places(flying: &mut Flying<'_>, mode: Option<&Mode>) -> Vec<Place> {
    let engaged = |number: usize| mode.is_some_and(|mode| mode.engaged.contains(&number));
    let sensors = flying.sensors_mut().enumerate();
    let counted = sensors.filter(|(_, (number, _))| number.is_none_or(engaged));
    let each = counted.flat_map(|(place, (_, sensor))| {
        (1..=sensor.depends_on()).map(move |samples| Place::Seen(place, samples))
    });
    each.collect()
}

impl Flying<'_> {
    /// Every sensor, with the number of the loop that sees by it alone.
    fn sensors_mut(&mut self) -> impl Iterator<Item = (Option<usize>, &mut SensorState)> {
        let Course { sensors, around, .. } = &mut self.course;
        let around = around.iter_mut().flat_map(|around| around.state.sensors_mut());
        sensors.each_mut().map(|sensor| (None, sensor)).chain(around)
    }

    fn seen(&mut self, sensor: usize, samples: usize) -> Option<&mut f64> {
        let k = self.course.k;
        self.sensors_mut().nth(sensor)?.1.past(k, samples)
    }

    fn read(&mut self, places: &[Place]) -> Vec<f64> {
        let seen = places.iter().map(|place| match *place {
            Place::Seen(sensor, samples) => self.seen(sensor, samples).copied(),
            _ => None,
        });
        let seen: Vec<Option<f64>> = seen.collect();
        let course = &self.course;
        let pitching = course.propagation().values(course.plant());
        let beyond = course.propagation().beyond(course.plant());
        let on_its_way: Vec<f64> = course.delayed.in_order().collect();
        let channels = course.around.iter().flat_map(|around| around.state.memories());
        let memories: Vec<_> =
            std::iter::once(&self.memory).chain(channels).map(remembered).collect();
        let read = |place: &Place| match *place {
            Place::Pitching(at) => pitching.get(at).copied(),
            Place::Beyond(at) => beyond.get(at).copied(),
            Place::OnItsWay(at) => on_its_way.get(at).copied(),
            Place::Remembered(number, at) => {
                memories.get(number).and_then(|it| it.get(at)).copied()
            }
            Place::Seen(..) => None,
        };
        places.iter().zip(seen).map(|(place, seen)| seen.or(read(place)).unwrap_or(0.0)).collect()
    }

    fn nudge(&mut self, place: Place, by: f64) {
        if let Place::Seen(sensor, samples) = place {
            self.seen(sensor, samples).into_iter().for_each(|value| *value += by);
            return;
        }
        let course = &mut self.course;
        let stage = &course.prepared.stages[course.stage].propagation;
        match place {
            Place::Pitching(at) => stage.nudge(&mut course.plant, at, by),
            Place::Beyond(at) => stage.nudge_beyond(&mut course.plant, at, by),
            Place::OnItsWay(at) => course.delayed.nudge(at, by),
            Place::Remembered(number, at) => {
                let channels =
                    course.around.iter_mut().flat_map(|around| around.state.memories_mut());
                let mut memories = std::iter::once(&mut self.memory).chain(channels);
                if let Some(memory) = memories.nth(number) {
                    nudge_memory(memory, at, by);
                }
            }
            Place::Seen(..) => {}
        }
    }
}

/// Numbers of an aircraft beyond pitching, and the places of some of them.
pub(crate) const BEYOND: usize = 9;
/// Altitude.
pub(crate) const ALTITUDE: usize = 0;
/// Heading.
pub(crate) const HEADING: usize = 1;
/// Power of the engine.
pub(crate) const POWER: usize = 6;
/// Roll rate.
const ROLLING: usize = 3;
/// Aileron.
pub(crate) const AILERON: usize = 7;

/// What a controller without limits remembers.
const REMEMBERED: usize = 3;

fn remembered(memory: &State<f64>) -> [f64; REMEMBERED] {
    let input_rad = memory.previous.map_or(0.0, |previous| previous.derivative_input_rad);
    [memory.integral, memory.derivative_rad_s, input_rad]
}

fn nudge_memory(memory: &mut State<f64>, place: usize, by: f64) {
    match (place, &mut memory.previous) {
        (0, _) => memory.integral += by,
        (1, _) => memory.derivative_rad_s += by,
        (_, Some(previous)) => previous.derivative_input_rad += by,
        (_, None) => {}
    }
}

/// Half the width of the differences; what is between them is smooth, so that their error is near 10⁻¹⁰ of what they are of.
const DIFFERENCE: f64 = 1e-5;

/// What one sample makes of each number, by central differences.
fn one_sample(
    prepared: &Prepared,
    settling_samples: usize,
    mode: Option<&Mode>,
    controller: &Controller,
) -> Result<(Vec<Place>, Matrix), Ended> {
    let course = Course::start(prepared, &Perturbation::NONE)?;
    let mut at = Flying { course, memory: State::new() };
    for _ in 0..settling_samples {
        at.fly(controller)?;
    }
    let places = places(&mut at, mode, controller);
    let from = at.read(&places);
    let mut matrix = Matrix::zeros(from.len(), from.len());
    for (column, (place, value)) in places.iter().zip(&from).enumerate() {
        let half = DIFFERENCE * value.abs().max(1.0);
        let arrive = |by: f64| {
            let mut moved = at.clone();
            moved.nudge(*place, by);
            moved.fly(controller)?;
            Ok::<_, Ended>(moved.read(&places))
        };
        let (more, less) = (arrive(half)?, arrive(-half)?);
        for (row, (more, less)) in more.iter().zip(&less).enumerate() {
            matrix.set(row, column, (more - less) / (2.0 * half)).map_err(SimError::from)?;
        }
    }
    Ok((places, matrix))
}
