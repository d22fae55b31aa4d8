//! Flights side by side that wait for commands, each at a sample of its own.

use std::sync::Arc;

use fearless_simd::dispatch;
use fspid_core::{Faults, Gains, Step};
use fspid_numeric::InstructionSet;

use super::airframes::{Airframes, Entering, Sighted};
use super::lane::{Lanes, NO, YES};
use super::plant::Plants;
use super::queue::Queue;
use crate::error::SimError;
use crate::in_flight::InFlight;
use crate::propagation::{DIVERGED_RAD, Propagation};
use crate::propagator::Propagator;
use crate::scenario::Prepared;
use crate::seen::Seen;
use crate::trace::{EndCause, Outcome};

/// Places for `W` flights whose commands come from outside, each with the bits of [`InFlight`]. Plants with first-order
/// servos fly in lanes, all of one order; what has no lanes, and what is of another order, flies one by one.
///
/// Flights begin when they are put into their places, whatever the others do. Threads are the caller's business.
#[derive(Clone, Debug)]
pub struct Formation<const W: usize> {
    instructions: InstructionSet,
    places: [Place; W],
    /// Lanes, from the first flight that has one.
    airframes: Option<Airframes<W>>,
    /// What enters the samples that wait.
    entering: Entering<W>,
    /// Samples that were answered.
    answered: usize,
}

#[derive(Clone, Debug)]
enum Place {
    Empty,
    InLane(Lane),
    Alone(Box<InFlight<Arc<Prepared>>>),
}

/// Where the flight of a lane is, but for its numbers.
#[derive(Clone, Debug)]
struct Lane {
    prepared: Arc<Prepared>,
    k: usize,
    stage: usize,
    seen: Result<Seen, Outcome>,
}

impl Lane {
    fn propagator(&self) -> Option<&Propagator> {
        in_lane(&self.prepared.stages.get(self.stage)?.propagation)
    }

    /// Takes the plant of this sample; true where it is another one.
    fn change_plant(&mut self) -> bool {
        let before = self.stage;
        while self.prepared.stages.get(self.stage + 1).is_some_and(|next| next.from <= self.k) {
            self.stage += 1;
        }
        self.stage != before
    }

    /// A signal at this sample; zero where there is none.
    fn at(&self, column: &Option<Vec<f64>>) -> f64 {
        column.as_ref().and_then(|values| values.get(self.k)).copied().unwrap_or(0.0)
    }
}

fn in_lane(propagation: &Propagation) -> Option<&Propagator> {
    match propagation {
        Propagation::AsOne(propagator) => Some(propagator),
        Propagation::ByLegs(_) | Propagation::Aircraft(_) | Propagation::External(_) => None,
    }
}

/// The first plant of a flight, if lanes can fly it.
fn first_in_lane(prepared: &Prepared) -> Option<&Propagator> {
    let mut all = prepared.stages.iter().map(|stage| in_lane(&stage.propagation));
    let first = all.next().flatten().filter(|_| !prepared.has_sensors())?;
    all.all(|later| later.is_some()).then_some(first)
}

impl<const W: usize> Default for Formation<W> {
    fn default() -> Self {
        Self {
            instructions: InstructionSet::best(),
            places: [const { Place::Empty }; W],
            airframes: None,
            entering: Entering::NOTHING,
            answered: 0,
        }
    }
}

impl<const W: usize> Formation<W> {
    /// Lets a flight begin at a place, in place of the one that was there.
    ///
    /// # Errors
    /// As [`InFlight::start`]. [`SimError::Number`] for a place that there is not.
    pub fn start(&mut self, place: usize, prepared: Arc<Prepared>) -> Result<(), SimError> {
        if place >= W {
            let (what, found) = ("place of a flight", place as f64);
            return Err(SimError::Number { what, found, allowed: "less than the number of lanes" });
        }
        self.clear(place);
        if self.take_lane(place, &prepared) {
            let seen = Err(Outcome::Completed);
            self.places[place] = Place::InLane(Lane { prepared, k: 0, stage: 0, seen });
            self.look(place);
        } else {
            self.places[place] = Place::Alone(Box::new(InFlight::start(prepared)?));
        }
        Ok(())
    }

    /// What is seen at the sample that waits at a place, or how the flight there ended; `None` for a place without one.
    #[must_use]
    pub fn seen(&self, place: usize) -> Option<Result<Seen, Outcome>> {
        match self.places.get(place)? {
            Place::Empty => None,
            Place::InLane(lane) => Some(lane.seen),
            Place::Alone(flight) => Some(flight.seen()),
        }
    }

    /// True where the flight of a place flies in a lane.
    #[must_use]
    pub fn is_in_lane(&self, place: usize) -> bool {
        matches!(self.places.get(place), Some(Place::InLane(_)))
    }

    /// Answers the samples of all flights that wait, with commands in rad, and flies on to the next ones. What stands at
    /// a place where nobody waits means nothing.
    ///
    /// # Errors
    /// The first of what [`InFlight::act`] answers; a flight in a lane that failed has left its place.
    pub fn act(&mut self, command_rad: &[f64; W]) -> Result<(), SimError> {
        let mut acted = Ok(());
        if self.airframes.is_some() {
            acted = dispatch!(self.instructions.level(), _simd => self.act_in_lanes(command_rad));
        }
        for (place, &command_rad) in self.places.iter_mut().zip(command_rad) {
            if let Place::Alone(flight) = place {
                let faults = Faults::NONE;
                let step = Step { command_rad, gains: Gains::ZERO, saturated: false, faults };
                acted = acted.and(flight.act(step).map(drop));
            }
        }
        acted
    }

    #[inline(always)]
    fn act_in_lanes(&mut self, command_rad: &[f64; W]) -> Result<(), SimError> {
        let Some(airframes) = &mut self.airframes else {
            return Ok(());
        };
        let mut given_rad = [0.0; W];
        for lane in 0..W {
            if let Place::InLane(Lane { seen: Ok(_), .. }) = self.places[lane] {
                given_rad[lane] = command_rad[lane];
            }
        }
        let arrived_rad = airframes.take(self.answered, &given_rad, &self.entering);
        let held = airframes.advance(&arrived_rad, &self.entering);
        self.answered += 1;
        let mut passed = Ok(());
        if held != [NO; W] {
            passed = self.advance_held(&held, &arrived_rad);
        }
        self.look_on();
        passed
    }

    #[cold]
    #[inline(never)]
    fn advance_held(&mut self, held: &[u64; W], command_rad: &Lanes<W>) -> Result<(), SimError> {
        let mut passed = Ok(());
        for lane in 0..W {
            let Some(airframes) = self.airframes.as_mut().filter(|_| held[lane] == YES) else {
                continue;
            };
            let Place::InLane(flight) = &self.places[lane] else { continue };
            let Some(propagator) = flight.propagator() else { continue };
            let disturbance_rad = self.entering.at_elevator_rad[lane];
            let (plants, command_rad) = (&mut airframes.plants, command_rad[lane]);
            let advanced = plants.advance_held(lane, propagator, command_rad, disturbance_rad);
            if advanced.is_err() {
                self.clear(lane);
            }
            passed = passed.and(advanced);
        }
        passed
    }

    /// Looks at the next samples of all lanes that fly.
    #[inline(always)]
    fn look_on(&mut self) {
        for lane in 0..W {
            if let Place::InLane(flight @ Lane { seen: Ok(_), .. }) = &mut self.places[lane] {
                flight.k += 1;
                self.enter(lane);
            }
        }
        let Some(airframes) = &self.airframes else { return };
        let sighted = airframes.look(&self.entering);
        for lane in 0..W {
            if let Place::InLane(Lane { seen: Ok(_), .. }) = self.places[lane] {
                self.show(lane, &sighted);
            }
        }
    }

    /// Looks at the first sample of a lane.
    fn look(&mut self, lane: usize) {
        self.enter(lane);
        if let Some(airframes) = &self.airframes {
            let sighted = airframes.look(&self.entering);
            self.show(lane, &sighted);
        }
    }

    /// Takes the plant and the signals of a lane's sample; of one behind the last the flight ends.
    #[inline(always)]
    fn enter(&mut self, lane: usize) {
        let (Place::InLane(flight), Some(airframes)) =
            (&mut self.places[lane], &mut self.airframes)
        else {
            return;
        };
        if flight.change_plant()
            && let Some(propagator) = flight.propagator()
        {
            airframes.plants.load(lane, propagator);
        }
        let prepared = &flight.prepared;
        let setpoint_rad = prepared.setpoint_rad.get(flight.k).copied();
        self.entering.setpoint_rad[lane] = setpoint_rad.unwrap_or(0.0);
        self.entering.at_servo_rad[lane] = flight.at(&prepared.at_servo);
        self.entering.at_elevator_rad[lane] = flight.at(&prepared.at_elevator);
        self.entering.at_measurement_rad[lane] = flight.at(&prepared.at_measurement);
        if setpoint_rad.is_none() {
            self.end(lane, Outcome::Completed);
        }
    }

    /// Keeps what there is to see in a lane that flies, or ends its flight.
    #[inline(always)]
    fn show(&mut self, lane: usize, sighted: &Sighted<W>) {
        let Place::InLane(flight) = &mut self.places[lane] else { return };
        let theta_rad = sighted.theta_rad[lane];
        // Written so that NaN is lost.
        if !(theta_rad.abs() <= DIVERGED_RAD) {
            let at_s = flight.prepared.timing.time_s(flight.k);
            return self.end(lane, Outcome::ended_early(at_s, EndCause::Diverged));
        }
        let q_rad_s = sighted.q_rad_s[lane];
        flight.seen = Ok(Seen {
            k: flight.k,
            setpoint_rad: self.entering.setpoint_rad[lane],
            theta_rad,
            q_rad_s,
            measured: [sighted.measurement_rad[lane], q_rad_s],
        });
    }

    #[cold]
    #[inline(never)]
    fn end(&mut self, lane: usize, outcome: Outcome) {
        if let Place::InLane(flight) = &mut self.places[lane] {
            flight.seen = Err(outcome);
        }
        self.park(lane);
    }

    /// Empties a place.
    fn clear(&mut self, place: usize) {
        self.places[place] = Place::Empty;
        self.park(place);
    }

    /// Lets a lane compute zeros.
    fn park(&mut self, lane: usize) {
        if let Some(airframes) = &mut self.airframes {
            airframes.park(lane);
        }
        let Entering { setpoint_rad, at_servo_rad, at_elevator_rad, at_measurement_rad } =
            &mut self.entering;
        for column in [setpoint_rad, at_servo_rad, at_elevator_rad, at_measurement_rad] {
            column[lane] = 0.0;
        }
    }

    /// Puts the plant of a flight at rest into a parked lane, if lanes can fly it.
    fn take_lane(&mut self, lane: usize, prepared: &Prepared) -> bool {
        let Some(propagator) = first_in_lane(prepared) else {
            return false;
        };
        let order = propagator.order();
        let airframes = self.airframes.get_or_insert_with(|| Airframes {
            plants: Plants::at_rest(order),
            queue: Queue::new([0; W]),
        });
        if airframes.plants.order() != order {
            return false;
        }
        airframes.queue.begin(lane, prepared.delay_samples, self.answered);
        airframes.plants.load(lane, propagator);
        true
    }
}
