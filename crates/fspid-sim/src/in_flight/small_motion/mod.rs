//! Linearisation of an aircraft with its autopilot about a trim: the one-sample transition matrix, by differences of the
//! flying code.
//!
//! The flying code itself is asked: a flight stands at the trim with one mode engaged for good, each of its numbers is moved
//! a little either way, and one sample is flown. Limits are left out, gains are those at rest (what they make of what outer
//! loops hold is [added](moving)), and the wind is that of the start. Sensors
//! show late what they show late, that of the pitch loop with their scale. Where one has a clock of its own, samples are flown
//! until all ages have come, or the largest age is taken, or the smallest ([`Seeing`]). Every target is what the trim has; a beam is level there. The actuator is its lag and its
//! delay.

mod dead_zones;
mod moving;
mod numbers;
mod still;

use fspid_core::{Gains, State};
use fspid_lti::{Complex, Matrix, eigenvalues, modulus};

use self::dead_zones::holds_beyond_dead_zones;
use self::moving::{Sides, sides};
use self::numbers::{Ended, Flying, Place, is_of_the_wings, places};
use self::still::{on_its_way, settling_samples, still, still_alone, unlimited};
use super::Course;
use crate::aircraft::{AircraftPlant, Change};
use crate::autopilot::{Autopilot, Mode};
use crate::beyond::{AILERON, POWER, ROLLING, TURNING};
use crate::controller::Controller;
use crate::error::SimError;
use crate::flown::Perturbation;
use crate::loop_model::MOST_AS_STATES;
use crate::rest::{Doubt, Stand};
use crate::scenario::{Prepared, Scenario};
use crate::sensor::Seeing;
use crate::stability::MODE_RADIUS;

/// Smaller poles are gone within a sample: those of delays, and of what is remembered of the sample before.
const GONE: f64 = 1e-6;

/// The poles of a mode, in the plane of s.
#[derive(Clone, Debug, PartialEq)]
pub struct ModePoles {
    /// Number of the mode, from 0.
    pub mode: usize,
    /// When the mode and the aircraft are as they are here at the earliest, s.
    pub from_s: f64,
    /// Poles of the sampled loop, each as $s = \ln z / T$ in 1/s; those of pure delays, z = 0, are left out.
    pub poles: Vec<Complex>,
    /// Largest size of z; where rules have a kink at rest, of all sides, or what a motion through them was seen to grow by.
    pub spectral_radius: f64,
    /// Why it is not known whether the mode holds.
    pub doubt: Option<Doubt>,
}

impl ModePoles {
    fn undecided(mode: usize, doubt: Doubt) -> Self {
        let (poles, doubt) = (Vec::new(), Some(doubt));
        Self { mode, from_s: 0.0, poles, spectral_radius: f64::NAN, doubt }
    }
}

/// The poles of a scenario's aircraft with a controller and, one mode after another, everything that an autopilot engages;
/// none without an autopilot. After those of the aircraft of the start come those of the one that each change of a configuration
/// leaves, about its own trim, for the modes that it may meet; none of one that has no trim, or does not stay
/// there, or whose data have a kink right there.
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
    let standings = scenario.plant.aircraft().map(AircraftPlant::standings).unwrap_or_default();
    let mut all = Vec::new();
    for standing in standings.iter().filter(|it| it.by != Change::Fuel) {
        let Some(own) = standing.flown_in(scenario) else { continue };
        if own.plant.aircraft().is_some_and(|it| it.aircraft().has_kink_at(it.trim())) {
            continue;
        }
        for (mode, begins_s) in standing.modes(scenario) {
            let found = poles_shown(&own, (controller, gains), mode);
            let from_s = begins_s.max(standing.from_s);
            match found {
                Ok(poles) => all.push(ModePoles { from_s, ..poles }),
                Err(error) if !standing.is_after_a_change() => return Err(error),
                Err(_) => {}
            }
        }
    }
    Ok(all)
}

/// Of one mode, with sensors as late as they ever are; whether it grows is said of them as they come. Poles that say otherwise
/// are left out.
fn poles_shown(
    scenario: &Scenario,
    held: (&Controller, Gains<f64>),
    mode: usize,
) -> Result<ModePoles, SimError> {
    let latest = poles_of_mode(scenario, held, mode, Seeing::Latest)?;
    let first = Seeing::first(scenario);
    if first == Seeing::Latest {
        return Ok(latest);
    }
    let ModePoles { spectral_radius, doubt, .. } = poles_of_mode(scenario, held, mode, first)?;
    let agree = doubt == latest.doubt
        && (spectral_radius <= MODE_RADIUS) == (latest.spectral_radius <= MODE_RADIUS);
    let poles = if agree { latest.poles } else { Vec::new() };
    Ok(ModePoles { poles, spectral_radius, doubt, ..latest })
}

/// A mode of an autopilot whose small motions are asked.
struct Asked<'a> {
    scenario: &'a Scenario,
    autopilot: &'a Autopilot,
    mode: usize,
    seeing: Seeing,
    /// Of pitch, without limits.
    controller: Controller,
}

impl Asked<'_> {
    fn mode(&self) -> Option<&Mode> {
        self.autopilot.modes().get(self.mode)
    }

    fn small<'a>(&self, prepared: &'a Prepared) -> Result<Small<'a>, SimError> {
        let samples = [settling_samples(self.scenario)?, self.seeing.samples(self.scenario)];
        let found = Small::of(prepared, samples, self.mode(), self.controller);
        found.map_err(|ended| ended.of(self.mode))?.without_free_wings()
    }
}

/// The same of one mode of the autopilot that a scenario has.
pub(crate) fn poles_of_mode(
    scenario: &Scenario,
    (controller, gains): (&Controller, Gains<f64>),
    mode: usize,
    seeing: Seeing,
) -> Result<ModePoles, SimError> {
    let autopilot = scenario.autopilot.as_ref().ok_or(SimError::NotLinear)?;
    let controller = unlimited(controller, gains)?;
    let samples = on_its_way(scenario);
    if samples > MOST_AS_STATES {
        return Err(SimError::LongWay { samples, most: MOST_AS_STATES });
    }
    let asked = Asked { scenario, autopilot, mode, seeing, controller };
    let prepared = still(scenario, autopilot, mode, seeing)?;
    let small = asked.small(&prepared)?;
    if small.jumps {
        return Ok(ModePoles::undecided(mode, Doubt::Kink));
    }
    let (found, largest) = match sides(&asked, &small)? {
        None => {
            let found = eigenvalues(&small.matrix)?;
            let largest = found.iter().map(|z| modulus(*z)).fold(0.0, f64::max);
            (found, largest)
        }
        Some(Sides { stand, eigenvalues, largest }) => match stand {
            Stand::Holds => (eigenvalues, largest),
            Stand::Grows { spectral_radius } => (eigenvalues, spectral_radius),
            Stand::Undecided { .. } => {
                return Ok(ModePoles::undecided(mode, Doubt::OuterGains));
            }
        },
    };
    let dt_s = scenario.timing.dt_s();
    let poles = found.iter().filter(|z| modulus(**z) > GONE).map(|z| in_s(*z, dt_s)).collect();
    let spectral_radius = a_sample(largest, small.samples);
    // Within the dead zones it holds.
    if spectral_radius <= MODE_RADIUS && !holds_beyond_dead_zones(&asked)? {
        return Ok(ModePoles::undecided(mode, Doubt::OuterGains));
    }
    Ok(ModePoles { mode, from_s: 0.0, poles, spectral_radius, doubt: None })
}

/// What a growth over so many samples is a sample.
fn a_sample(radius: f64, samples: usize) -> f64 {
    if samples == 1 { radius } else { libm::pow(radius, 1.0 / samples as f64) }
}

/// $s = \ln z / T$.
fn in_s(z: Complex, dt_s: f64) -> Complex {
    Complex::new(libm::log(modulus(z)) / dt_s, libm::atan2(z.im, z.re) / dt_s)
}

/// Spectral radii of the small motions about the trim of an aircraft with nothing around its pitch loop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Alone {
    /// Of pitch, speed and engine.
    pub(crate) pitching: f64,
    /// Of everything, roll, yaw and bank with leveller and damper among them; none where the aileron rolls nothing.
    pub(crate) all: Option<f64>,
}

/// The small motions of an aircraft without an autopilot, whose modes have them; none of a plant that is no aircraft, and of one
/// where too much is on its way.
///
/// # Errors
/// As [`mode_poles`].
pub(crate) fn radii_alone(
    scenario: &Scenario,
    (controller, gains): (&Controller, Gains<f64>),
    seeing: Seeing,
) -> Result<Option<Alone>, SimError> {
    if scenario.autopilot.is_some()
        || scenario.plant.aircraft().is_none()
        || on_its_way(scenario) > MOST_AS_STATES
    {
        return Ok(None);
    }
    let controller = unlimited(controller, gains)?;
    let still = still_alone(scenario, seeing)?.prepare()?;
    let samples = [settling_samples(scenario)?, seeing.samples(scenario)];
    let small = Small::of(&still, samples, None, controller).map_err(|ended| ended.of(0))?;
    let Small { places, matrix, .. } = &small;
    let radius = |matrix: &Matrix| radius(matrix).map(|radius| a_sample(radius, samples[1]));
    let at = |beyond: usize| {
        places.iter().position(|place| matches!(place, Place::Beyond(at) if *at == beyond))
    };
    let rolls = at(ROLLING).zip(at(AILERON)).and_then(|(row, column)| matrix.get(row, column));
    // Nobody moves the throttle: an engine that would jump comes to the power of the trim by itself.
    let stands = |place: &Place| small.jumps && matches!(place, Place::Beyond(POWER));
    let without = |left_out: &dyn Fn(&Place) -> bool| {
        let kept = places.iter().enumerate().filter(|(_, place)| !left_out(place));
        radius(&part(matrix, &kept.map(|(at, _)| at).collect::<Vec<_>>())?)
    };
    let all = rolls.filter(|by_aileron| *by_aileron != 0.0).map(|_| without(&stands));
    let pitching = without(&|place| stands(place) || is_of_the_wings(place))?;
    Ok(Some(Alone { pitching, all: all.transpose()? }))
}

fn radius(matrix: &Matrix) -> Result<f64, SimError> {
    Ok(eigenvalues(matrix)?.iter().map(|z| modulus(*z)).fold(0.0, f64::max))
}

/// Rows and columns of these places.
fn part(matrix: &Matrix, places: &[usize]) -> Result<Matrix, SimError> {
    let mut part = Matrix::zeros(places.len(), places.len());
    for (row, from_row) in places.iter().enumerate() {
        for (column, from_column) in places.iter().enumerate() {
            part.set(row, column, matrix.get(*from_row, *from_column).unwrap_or(0.0))?;
        }
    }
    Ok(part)
}

/// Half the width of the differences; what is between them is smooth, so that their error is near 10⁻¹⁰ of what they are of.
const DIFFERENCE: f64 = 1e-5;

/// What some samples make of each number, after others, by central differences.
struct Small<'a> {
    /// After those others.
    at: Flying<'a>,
    samples: usize,
    controller: Controller,
    places: Vec<Place>,
    matrix: Matrix,
    /// An engine was on two sides of a jump of its rate: of a difference across it nothing is known.
    jumps: bool,
}

/// A rate of roll or yaw that changes by no more than this in what is asked, by anything, has no forces.
const NO_FORCES: f64 = 1e-9;

impl<'a> Small<'a> {
    fn of(
        prepared: &'a Prepared,
        [settling_samples, samples]: [usize; 2],
        mode: Option<&Mode>,
        controller: Controller,
    ) -> Result<Self, Ended> {
        let course = Course::start(prepared, &Perturbation::NONE)?;
        let mut at = Flying { course, memory: State::new() };
        for _ in 0..settling_samples {
            at.fly(&controller)?;
        }
        let places = places(&mut at, mode, &controller);
        let from = at.read(&places);
        let matrix = Matrix::zeros(from.len(), from.len());
        let mut small = Self { at, samples, controller, places, matrix, jumps: false };
        for (column, (place, value)) in small.places.clone().into_iter().zip(from).enumerate() {
            let (column_of, jumps) = small.differences(place, value)?;
            small.jumps |= jumps;
            for (row, entry) in column_of.into_iter().enumerate() {
                small.matrix.set(row, column, entry).map_err(SimError::from)?;
            }
        }
        Ok(small)
    }

    /// Without side speed, roll, yaw, bank and their surfaces, where nothing turns the aircraft: of the same pole at 1, three and
    /// more times, rounding makes poles that are off by its cube root.
    fn without_free_wings(mut self) -> Result<Self, SimError> {
        let turning: Vec<usize> = self
            .places
            .iter()
            .enumerate()
            .filter(|(_, place)| TURNING.iter().any(|&at| **place == Place::Beyond(at)))
            .map(|(at, _)| at)
            .collect();
        let stays = |row: usize| {
            let mut columns = 0..self.places.len();
            columns.all(|column| {
                let kept = if row == column { 1.0 } else { 0.0 };
                let entry = self.matrix.get(row, column);
                entry.is_some_and(|entry| (entry - kept).abs() <= NO_FORCES)
            })
        };
        if turning.iter().all(|row| stays(*row)) {
            let places = self.places.iter().enumerate();
            let kept: Vec<usize> =
                places.filter(|(_, place)| !is_of_the_wings(place)).map(|(at, _)| at).collect();
            self.matrix = part(&self.matrix, &kept)?;
            self.places = kept.iter().filter_map(|at| self.places.get(*at)).copied().collect();
        }
        Ok(self)
    }

    /// What becomes of a number that is `value` now, and whether an engine was on two sides of a jump.
    fn differences(&self, place: Place, value: f64) -> Result<(Vec<f64>, bool), Ended> {
        let half = DIFFERENCE * value.abs().max(1.0);
        let side = self.at.sides_of_half_power();
        let mut jumps = false;
        let mut arrive = |by: f64| {
            let mut moved = self.at.clone();
            moved.nudge(place, by);
            jumps |= moved.sides_of_half_power() != side;
            for _ in 0..self.samples {
                moved.fly(&self.controller)?;
                jumps |= moved.sides_of_half_power() != side;
            }
            Ok::<_, Ended>(moved.read(&self.places))
        };
        let (more, less) = (arrive(half)?, arrive(-half)?);
        let slopes = more.iter().zip(&less).map(|(more, less)| (more - less) / (2.0 * half));
        Ok((slopes.collect(), jumps))
    }

    /// The same of a number that need not be one of the matrix.
    fn column(&self, place: Place) -> Result<Vec<f64>, Ended> {
        let value = self.at.clone().read(&[place]);
        Ok(self.differences(place, value.first().copied().unwrap_or(0.0))?.0)
    }

    /// What a loop is held at, and what it commands, as its controller counts.
    fn held_by(&self, autopilot: &Autopilot, number: usize) -> Option<[f64; 2]> {
        self.at.course.around.as_ref()?.state.held_by(autopilot, number)
    }
}
