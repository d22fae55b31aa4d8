//! A group of flights from start to end.

use core::ops::ControlFlow;

use fspid_numeric::InstructionSet;

use super::Entrant;
use super::airframes::{Airframes, Entering, Sighted};
use super::lane::{Lanes, Mask, NO, YES, all, mask};
use super::pid_lanes::Controllers;
use super::plant::Plants;
use super::queue::Queue;
use super::refusal::Refusal;
use super::row::BatchRow;
use super::samples::Samples;
use crate::error::SimError;
use crate::propagation::{DIVERGED_RAD, Propagation};
use crate::propagator::Propagator;
use crate::scenario::Prepared;
use crate::timing::Timing;
use crate::trace::{EndCause, Outcome};

/// The signals of one flight; all empty, and so zero, once it has ended.
#[derive(Clone, Copy, Debug, Default)]
struct Signals<'a> {
    setpoint_rad: &'a [f64],
    at_servo: &'a [f64],
    at_elevator: &'a [f64],
    at_measurement: &'a [f64],
}

impl<'a> Signals<'a> {
    fn new(prepared: &'a Prepared) -> Self {
        let column = |column: &'a Option<Vec<f64>>| column.as_deref().unwrap_or_default();
        Self {
            setpoint_rad: &prepared.setpoint_rad,
            at_servo: column(&prepared.at_servo),
            at_elevator: column(&prepared.at_elevator),
            at_measurement: column(&prepared.at_measurement),
        }
    }
}

/// A discretised plant of one flight and the sample from which it holds.
#[derive(Clone, Copy, Debug)]
struct Stage<'a> {
    from: usize,
    propagator: &'a Propagator,
}

/// The stages of one flight.
#[derive(Clone, Debug)]
struct Course<'a> {
    stages: Vec<Stage<'a>>,
    now: usize,
}

impl<'a> Course<'a> {
    fn next_from(&self) -> usize {
        self.stages.get(self.now + 1).map_or(usize::MAX, |stage| stage.from)
    }

    fn propagator(&self) -> Option<&'a Propagator> {
        self.stages.get(self.now).map(|stage| stage.propagator)
    }
}

/// Up to `W` flights side by side.
#[derive(Clone, Debug)]
pub(super) struct Group<'a, const W: usize> {
    timing: Timing,
    signals: [Signals<'a>; W],
    courses: Vec<Course<'a>>,
    /// First sample at which a plant changes.
    next_change: usize,
    airframes: Airframes<W>,
    controllers: Controllers<'a, W>,
    flying: Mask<W>,
    outcomes: Vec<Result<Outcome, SimError>>,
}

impl<'a, const W: usize> Group<'a, W> {
    pub(super) fn new(
        flights: &[Entrant<'a>],
        instructions: InstructionSet,
    ) -> Result<Self, Refusal> {
        if flights.len() > W {
            return Err(Refusal::TooMany { found: flights.len(), most: W });
        }
        let courses: Vec<Course<'a>> = flights
            .iter()
            .enumerate()
            .map(|(flight, entrant)| course(flight, entrant.prepared))
            .collect::<Result<_, _>>()?;
        let orders = || courses.iter().filter_map(Course::propagator).map(Propagator::order);
        let (order, timing) = match (orders().next(), flights.first()) {
            (Some(order), Some(first)) => (order, first.prepared.timing),
            // Nobody flies; any order and timing will do.
            _ => (1, Timing::new(1.0, 1.0).map_err(|_| Refusal::TooMany { found: 0, most: W })?),
        };
        let differs = |flight, what| Refusal::Differs { flight, what };
        if let Some(flight) = orders().position(|other| other != order) {
            return Err(differs(flight, "the order of its plant"));
        }
        if let Some(flight) = flights.iter().position(|other| other.prepared.timing != timing) {
            return Err(differs(flight, "its timing"));
        }
        let mut delays = [0; W];
        for (delay, entrant) in delays.iter_mut().zip(flights) {
            *delay = entrant.prepared.delay_samples;
        }
        let mut group = Self {
            timing,
            signals: [Signals::default(); W],
            next_change: usize::MAX,
            airframes: Airframes { plants: Plants::at_rest(order), queue: Queue::new(delays) },
            controllers: Controllers::new(
                flights.iter().map(|entrant| entrant.controller).collect(),
                instructions,
            )?,
            flying: [NO; W],
            outcomes: flights.iter().map(|_| Ok(Outcome::Completed)).collect(),
            courses,
        };
        for (lane, entrant) in flights.iter().enumerate() {
            group.signals[lane] = Signals::new(entrant.prepared);
            group.flying[lane] = YES;
            if let Some(propagator) = group.courses[lane].propagator() {
                group.airframes.plants.load(lane, propagator);
            }
        }
        group.find_next_change();
        Ok(group)
    }

    pub(super) fn into_outcomes(self) -> Vec<Result<Outcome, SimError>> {
        self.outcomes
    }

    fn find_next_change(&mut self) {
        let flown = self.courses.iter().zip(&self.flying).filter(|(_, flies)| **flies == YES);
        self.next_change = flown.map(|(course, _)| course.next_from()).min().unwrap_or(usize::MAX);
    }

    /// Flies all samples, or until the observer ends it.
    #[inline(always)]
    pub(super) fn fly(&mut self, observer: &mut dyn FnMut(&BatchRow<'_, W>) -> ControlFlow<()>) {
        for k in 0..self.timing.rows() {
            if self.next_change <= k {
                self.change_plants(k);
            }
            self.drop_lost(k);
            if self.flying == [NO; W] || self.sample(k, observer).is_break() {
                return;
            }
        }
    }

    #[inline(always)]
    fn sample(
        &mut self,
        k: usize,
        observer: &mut dyn FnMut(&BatchRow<'_, W>) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let entering = Entering {
            setpoint_rad: self.gather(k, |signals| signals.setpoint_rad),
            at_servo_rad: self.gather(k, |signals| signals.at_servo),
            at_elevator_rad: self.gather(k, |signals| signals.at_elevator),
            at_measurement_rad: self.gather(k, |signals| signals.at_measurement),
        };
        let Sighted { theta_rad, q_rad_s, measurement_rad } = self.airframes.look(&entering);
        self.controllers.step(Samples {
            setpoint_rad: &entering.setpoint_rad,
            measurement_rad: &measurement_rad,
            rate_rad_s: &q_rad_s,
        });
        let commanded_rad = &self.controllers.steps.command_rad;
        let command_rad = self.airframes.take(k, commanded_rad, &entering);
        let elevator_rad = self.airframes.plants.elevator_rad(&entering.at_elevator_rad);
        let goes_on = observer(&BatchRow {
            k,
            flying: &self.flying,
            setpoint_rad: &entering.setpoint_rad,
            theta_rad: &theta_rad,
            q_rad_s: &q_rad_s,
            elevator_rad: &elevator_rad,
            measurement_rad: &measurement_rad,
            command_rad: &self.controllers.steps.command_rad,
            gains: &self.controllers.steps.gains,
            excess: &self.controllers.steps.saturated,
            faults: &self.controllers.steps.faults,
        });
        let held = self.airframes.advance(&command_rad, &entering);
        if held != [NO; W] {
            self.advance_held(&held, &command_rad, &entering.at_elevator_rad);
        }
        goes_on
    }

    /// A signal of all flights at a sample; zero where there is none.
    #[inline(always)]
    fn gather(&self, k: usize, signal: impl Fn(&Signals<'a>) -> &'a [f64]) -> Lanes<W> {
        let mut values = [0.0; W];
        for (value, signals) in values.iter_mut().zip(&self.signals) {
            *value = signal(signals).get(k).copied().unwrap_or(0.0);
        }
        values
    }

    #[cold]
    #[inline(never)]
    fn change_plants(&mut self, k: usize) {
        for (lane, course) in self.courses.iter_mut().enumerate() {
            if self.flying[lane] != YES || course.next_from() > k {
                continue;
            }
            while course.next_from() <= k {
                course.now += 1;
            }
            if let Some(propagator) = course.propagator() {
                self.airframes.plants.load(lane, propagator);
            }
        }
        self.find_next_change();
    }

    /// Ends flights that have diverged, as [`Motion::is_lost`](crate::propagation::Motion::is_lost).
    #[inline(always)]
    fn drop_lost(&mut self, k: usize) {
        let (theta_rad, mut here) = (self.airframes.plants.theta_rad(), [NO; W]);
        for lane in 0..W {
            here[lane] = mask(theta_rad[lane].abs() <= DIVERGED_RAD);
        }
        if !all(&here) {
            let outcome = Outcome::ended_early(self.timing.time_s(k), EndCause::Diverged);
            for lane in 0..self.outcomes.len() {
                if here[lane] == NO {
                    self.end(lane, Ok(outcome));
                }
            }
        }
    }

    /// Ends a flight: from here on its lane computes zeros.
    #[cold]
    #[inline(never)]
    fn end(&mut self, lane: usize, outcome: Result<Outcome, SimError>) {
        self.outcomes[lane] = outcome;
        self.flying[lane] = NO;
        self.signals[lane] = Signals::default();
        self.airframes.park(lane);
        self.controllers.park(lane);
    }

    #[cold]
    #[inline(never)]
    fn advance_held(&mut self, held: &Mask<W>, command_rad: &Lanes<W>, disturbance_rad: &Lanes<W>) {
        for lane in 0..self.courses.len() {
            let Some(propagator) = self.courses[lane].propagator().filter(|_| held[lane] == YES)
            else {
                continue;
            };
            let (command_rad, disturbance_rad) = (command_rad[lane], disturbance_rad[lane]);
            let passed =
                self.airframes.plants.advance_held(lane, propagator, command_rad, disturbance_rad);
            if let Err(error) = passed {
                self.end(lane, Err(error));
            }
        }
    }
}

/// The stages of a flight, if lanes can fly them.
fn course(flight: usize, prepared: &Prepared) -> Result<Course<'_>, Refusal> {
    let refused = |what| Refusal::Part { flight, what };
    if prepared.has_sensors() {
        return Err(refused("a sensor"));
    }
    let mut stages = Vec::with_capacity(prepared.stages.len());
    for stage in &prepared.stages {
        match &stage.propagation {
            Propagation::AsOne(propagator) => stages.push(Stage { from: stage.from, propagator }),
            Propagation::ByLegs(_) => return Err(refused("an actuator or gusts")),
            Propagation::Aircraft(_) => return Err(refused("a nonlinear aircraft")),
            Propagation::External(_) => return Err(refused("another simulator")),
        }
    }
    Ok(Course { stages, now: 0 })
}
