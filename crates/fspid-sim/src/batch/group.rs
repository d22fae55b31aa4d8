//! A group of flights from start to end.

use fspid_numeric::InstructionSet;

use super::Entrant;
use super::lane::{Lanes, Mask, NO, YES, all, mask};
use super::pid_lanes::Controllers;
use super::plant::Plants;
use super::refusal::Refusal;
use super::row::BatchRow;
use super::samples::Samples;
use crate::error::SimError;
use crate::propagation::{DIVERGED_RAD, Propagation};
use crate::propagator::Propagator;
use crate::scenario::Prepared;
use crate::timing::Timing;
use crate::trace::Outcome;

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
    plants: Plants<W>,
    controllers: Controllers<'a, W>,
    queue: Queue<W>,
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
        let mut group = Self {
            timing,
            signals: [Signals::default(); W],
            next_change: usize::MAX,
            plants: Plants::at_rest(order),
            controllers: Controllers::new(
                flights.iter().map(|entrant| entrant.controller).collect(),
                instructions,
            )?,
            queue: Queue::new(flights),
            flying: [NO; W],
            outcomes: flights.iter().map(|_| Ok(Outcome::Completed)).collect(),
            courses,
        };
        for (lane, entrant) in flights.iter().enumerate() {
            group.signals[lane] = Signals::new(entrant.prepared);
            group.flying[lane] = YES;
            if let Some(propagator) = group.courses[lane].propagator() {
                group.plants.load(lane, propagator);
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

    /// Flies all samples.
    #[inline(always)]
    pub(super) fn fly(&mut self, observer: &mut impl FnMut(&BatchRow<'_, W>)) {
        for k in 0..self.timing.rows() {
            if self.next_change <= k {
                self.change_plants(k);
            }
            self.drop_lost(k);
            if self.flying == [NO; W] {
                return;
            }
            self.sample(k, observer);
        }
    }

    #[inline(always)]
    fn sample(&mut self, k: usize, observer: &mut impl FnMut(&BatchRow<'_, W>)) {
        let setpoint_rad = self.gather(k, |signals| signals.setpoint_rad);
        let disturbance_rad = self.gather(k, |signals| signals.at_elevator);
        let at_servo_rad = self.gather(k, |signals| signals.at_servo);
        let mut measurement_rad = self.gather(k, |signals| signals.at_measurement);
        let theta_rad = self.plants.theta_rad();
        for lane in 0..W {
            measurement_rad[lane] += theta_rad[lane];
        }
        let q_rad_s = self.plants.rate_rad_s(&disturbance_rad);
        self.controllers.step(Samples {
            setpoint_rad: &setpoint_rad,
            measurement_rad: &measurement_rad,
            rate_rad_s: &q_rad_s,
        });
        let mut command_rad = self.queue.pass(k, &self.controllers.steps.command_rad);
        for lane in 0..W {
            command_rad[lane] += at_servo_rad[lane];
        }
        self.plants.settle(&command_rad);
        let elevator_rad = self.plants.elevator_rad(&disturbance_rad);
        observer(&BatchRow {
            k,
            flying: &self.flying,
            setpoint_rad: &setpoint_rad,
            theta_rad: &theta_rad,
            q_rad_s: &q_rad_s,
            elevator_rad: &elevator_rad,
            measurement_rad: &measurement_rad,
            command_rad: &self.controllers.steps.command_rad,
            gains: &self.controllers.steps.gains,
            excess: &self.controllers.steps.saturated,
            faults: &self.controllers.steps.faults,
        });
        let held = self.plants.advance(&command_rad, &disturbance_rad);
        if held != [NO; W] {
            self.advance_held(&held, &command_rad, &disturbance_rad);
        }
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
                self.plants.load(lane, propagator);
            }
        }
        self.find_next_change();
    }

    /// Ends flights that have diverged, as [`Motion::is_lost`](crate::propagation::Motion::is_lost).
    #[inline(always)]
    fn drop_lost(&mut self, k: usize) {
        let (theta_rad, mut here) = (self.plants.theta_rad(), [NO; W]);
        for lane in 0..W {
            here[lane] = mask(theta_rad[lane].abs() <= DIVERGED_RAD);
        }
        if !all(&here) {
            let outcome = Outcome::Diverged { at_s: self.timing.time_s(k) };
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
        self.plants.park(lane);
        self.controllers.park(lane);
        self.queue.park(lane);
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
            let passed = self.plants.advance_held(lane, propagator, command_rad, disturbance_rad);
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
        }
    }
    Ok(Course { stages, now: 0 })
}

/// Commands on their way to the servos: a ring of as many samples as the longest delay.
#[derive(Clone, Debug)]
struct Queue<const W: usize> {
    ring: Vec<Lanes<W>>,
    delay_samples: [usize; W],
    longest: usize,
}

impl<const W: usize> Queue<W> {
    fn new(flights: &[Entrant<'_>]) -> Self {
        let mut delay_samples = [0; W];
        for (place, entrant) in delay_samples.iter_mut().zip(flights) {
            *place = entrant.prepared.delay_samples;
        }
        let longest = delay_samples.iter().copied().max().unwrap_or(0);
        Self { ring: vec![[0.0; W]; longest + 1], delay_samples, longest }
    }

    /// Takes the commands of sample `k` and answers those that arrive.
    #[inline(always)]
    fn pass(&mut self, k: usize, command_rad: &Lanes<W>) -> Lanes<W> {
        if self.longest == 0 {
            return *command_rad;
        }
        let size = self.ring.len();
        self.ring[k % size] = *command_rad;
        let mut arrived_rad = [0.0; W];
        for lane in 0..W {
            // Before its first command a servo is commanded to rest, as the ring is filled.
            arrived_rad[lane] = self.ring[(k + size - self.delay_samples[lane]) % size][lane];
        }
        arrived_rad
    }

    fn park(&mut self, lane: usize) {
        self.ring.iter_mut().for_each(|commands| commands[lane] = 0.0);
    }
}
