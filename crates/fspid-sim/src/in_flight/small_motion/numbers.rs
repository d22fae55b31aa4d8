//! The state vector that is linearised: which components of a flight belong to it, and read and write access to each.

use fspid_core::{Gains, State};

use crate::autopilot::{Autopilot, Mode, Quantity};
use crate::beyond::{ALTITUDE, BEYOND, HEADING, POWER, THROTTLE};
use crate::controller::Controller;
use crate::error::SimError;
use crate::in_flight::Course;
use crate::scenario::Prepared;
use crate::sensor::SensorState;
use crate::trace::{EarlyEnd, EndCause, Outcome};

/// A flight between two samples.
#[derive(Clone)]
pub(super) struct Flying<'a> {
    pub(super) course: Course<&'a Prepared>,
    pub(super) memory: State<f64>,
}

/// Why a flight about the trim has no next sample.
pub(super) enum Ended {
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
    pub(super) fn of(self, mode: usize) -> SimError {
        match self {
            Self::Flight(Outcome::EndedEarly(EarlyEnd { at_s, cause: EndCause::Diverged })) => {
                SimError::LeavesTrim { mode, at_s, how: "diverges" }
            }
            Self::Flight(Outcome::EndedEarly(EarlyEnd { at_s, cause: EndCause::HitGround })) => {
                SimError::LeavesTrim { mode, at_s, how: "hits the ground" }
            }
            // Nobody else flies what has equations, and it is long enough.
            Self::Flight(_) => SimError::NotLinear,
            Self::Failed(error) => error,
        }
    }
}

impl Flying<'_> {
    pub(super) fn fly(&mut self, controller: &Controller) -> Result<(), Ended> {
        let seen = self.course.look().map_err(Ended::Flight)?;
        let step = controller.step(&mut self.memory, seen.sample());
        let (_, command_rad) = self.course.take(seen, step);
        Ok(self.course.advance(command_rad)?)
    }
}

/// A number of a flight.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Place {
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
    /// What a sensor with a clock of its own shows until it looks again.
    Shown(usize),
}

/// All numbers of a flight that count: what nothing pulls on is left out.
pub(super) fn places(
    flying: &mut Flying<'_>,
    mode: Option<&Mode>,
    controller: &Controller,
) -> Vec<Place> {
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
        let shown = sensor.holds().then_some(Place::Shown(place));
        (1..=sensor.depends_on()).map(move |samples| Place::Seen(place, samples)).chain(shown)
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

    /// On which sides of half power the engine is asked and is, where that matters.
    pub(super) fn sides_of_half_power(&self) -> Option<[bool; 2]> {
        self.course.propagation().sides_of_half_power(self.course.plant())
    }

    fn seen(&mut self, sensor: usize, samples: usize) -> Option<&mut f64> {
        let k = self.course.k;
        self.sensors_mut().nth(sensor)?.1.past(k, samples)
    }

    fn shown(&mut self, sensor: usize) -> Option<&mut f64> {
        Some(self.sensors_mut().nth(sensor)?.1.held())
    }

    pub(super) fn read(&mut self, places: &[Place]) -> Vec<f64> {
        let seen = places.iter().map(|place| match *place {
            Place::Seen(sensor, samples) => self.seen(sensor, samples).copied(),
            Place::Shown(sensor) => self.shown(sensor).copied(),
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
            Place::Seen(..) | Place::Shown(_) => None,
        };
        places.iter().zip(seen).map(|(place, seen)| seen.or(read(place)).unwrap_or(0.0)).collect()
    }

    pub(super) fn nudge(&mut self, place: Place, by: f64) {
        if let Place::Seen(sensor, samples) = place {
            self.seen(sensor, samples).into_iter().for_each(|value| *value += by);
            return;
        }
        if let Place::Shown(sensor) = place {
            self.shown(sensor).into_iter().for_each(|value| *value += by);
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
            Place::Seen(..) | Place::Shown(_) => {}
        }
    }
}

/// True for what moves the wings and the nose aside: no number of an aircraft in the plane of its flight.
pub(super) fn is_of_the_wings(place: &Place) -> bool {
    matches!(place, Place::Beyond(at) if ![ALTITUDE, POWER, THROTTLE].contains(at))
}

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
