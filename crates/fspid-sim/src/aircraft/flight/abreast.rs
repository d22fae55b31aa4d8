//! Aircraft side by side from one sample to the next.
//!
//! What is continuous goes in lanes: the stages of Runge and Kutta with their aerodynamics, the angles and the flow at a sample.
//! What is discrete or rare is done lane by lane by the functions of a single flight: actuators, turbulence, winds, engines,
//! steering, a step that meets a corner of the winds. So every flight has the bits that it has alone.

#![allow(
    clippy::needless_range_loop,
    reason = "a lane is a place in many arrays at once, and such loops become vectors"
)]

use fearless_simd::dispatch;
use fspid_aircraft::abreast::{
    Abreast, Airs, Angles, Felt, Flows, LANES, Lanes, Member, angles, angles_at, normalise,
};
use fspid_aircraft::{CONTROLS, RIGID_STATES, RigidState};
use fspid_numeric::InstructionSet;

use super::{AircraftFlight, AircraftMotion, AircraftSample, Holding, Moving, holding};
use crate::autopilot::Commands;

/// One of the flights, on its way to the next sample.
#[derive(Debug)]
pub(crate) struct Wing<'a> {
    pub(crate) flight: &'a AircraftFlight,
    pub(crate) motion: &'a mut AircraftMotion,
    /// Command that has arrived, rad.
    pub(crate) command_rad: f64,
    /// Disturbance at the elevator, rad.
    pub(crate) disturbance_rad: f64,
    pub(crate) autopilot: Commands,
}

/// Flights by lane; none where a flight has ended or never was.
pub(crate) type Wings<'a> = [Option<Wing<'a>>; LANES];

/// Why a flight cannot fly beside the first one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum NotAbreast {
    /// Forces that are no derivatives.
    Forces,
    /// Drag or thrust by another law.
    Laws,
    /// Air that moves where that of the first does not, or does not where that does.
    Air,
}

/// What is integrated, by lane.
#[derive(Clone, Copy, Debug, Default)]
struct Numbers {
    states: [Lanes; RIGID_STATES],
    distance_m: Lanes,
    power: Lanes,
}

impl Numbers {
    fn put(&mut self, lane: usize, body: &Moving) {
        for (lanes, value) in self.states.iter_mut().zip(body.state.to_array()) {
            lanes[lane] = value;
        }
        self.distance_m[lane] = body.distance_m;
        self.power[lane] = body.power;
    }

    fn state(&self, lane: usize) -> RigidState {
        RigidState::from_array(&self.states.map(|lanes| lanes[lane]))
    }

    /// These and multiples of rates, added in order.
    #[inline(always)]
    fn and<const K: usize>(&self, factors: [f64; K], rates: [&Self; K]) -> Self {
        let mut sum = *self;
        for (factor, rates) in factors.into_iter().zip(rates) {
            for (lanes, rates) in sum.states.iter_mut().zip(&rates.states) {
                add(lanes, factor, rates);
            }
            add(&mut sum.distance_m, factor, &rates.distance_m);
            add(&mut sum.power, factor, &rates.power);
        }
        sum
    }
}

#[inline(always)]
fn add(lanes: &mut Lanes, factor: f64, rates: &Lanes) {
    for lane in 0..LANES {
        lanes[lane] += factor * rates[lane];
    }
}

/// Aircraft side by side.
#[derive(Clone, Debug)]
pub(crate) struct AircraftAbreast {
    instructions: InstructionSet,
    aircraft: Abreast,
    here: Numbers,
    airs: Airs,
    flows: Flows,
    angles: Angles,
}

fn member(flight: &AircraftFlight) -> Result<Member<'_>, NotAbreast> {
    let aircraft = flight.aircraft();
    let model = aircraft.model().derivatives().ok_or(NotAbreast::Forces)?;
    Ok((aircraft.mass(), aircraft.environment(), model))
}

impl AircraftAbreast {
    /// The first flight in all lanes.
    ///
    /// # Errors
    /// [`NotAbreast::Forces`].
    pub(crate) fn new(
        instructions: InstructionSet,
        first: &AircraftFlight,
    ) -> Result<Self, NotAbreast> {
        Ok(Self {
            instructions,
            aircraft: Abreast::new(member(first)?),
            here: Numbers::default(),
            airs: Airs::default(),
            flows: Flows::default(),
            angles: Angles::default(),
        })
    }

    /// Another flight in its lane.
    ///
    /// # Errors
    /// [`NotAbreast`].
    pub(crate) fn put(
        &mut self,
        lane: usize,
        flight: &AircraftFlight,
        first: &AircraftFlight,
    ) -> Result<(), NotAbreast> {
        if flight.atmosphere.moves() != first.atmosphere.moves() {
            return Err(NotAbreast::Air);
        }
        self.aircraft.put(lane, member(flight)?).map_err(|_| NotAbreast::Laws)
    }

    /// What is there to begin with.
    pub(crate) fn look(&mut self, wings: &mut Wings<'_>) {
        self.load(wings);
        self.see(wings);
    }

    /// The motions at a sample; lanes without one compute what the first one does.
    fn load(&mut self, wings: &Wings<'_>) {
        let first = wings.iter().flatten().next();
        for (lane, wing) in wings.iter().enumerate() {
            let Some(Wing { flight, motion, .. }) = wing.as_ref().or(first) else { return };
            self.here.put(lane, &motion.body);
            self.airs.put(lane, &flight.air(motion));
        }
    }

    /// The flow around the aircraft.
    fn see(&mut self, wings: &mut Wings<'_>) {
        let Self { aircraft, here, airs, flows, .. } = self;
        dispatch!(self.instructions.level(), _simd => aircraft.flows(&here.states, airs, flows));
        for (lane, wing) in wings.iter_mut().enumerate() {
            if let Some(wing) = wing {
                wing.motion.sight.flow = self.flows.at(lane);
            }
        }
    }

    /// What is observable at a sample beyond pitch; asked for before anything moves.
    pub(crate) fn samples(
        &self,
        motions: &[Option<(&AircraftFlight, &AircraftMotion, f64)>; LANES],
    ) -> [Option<AircraftSample>; LANES] {
        let mut controls = [[0.0; LANES]; CONTROLS];
        for (lane, &motion) in motions.iter().enumerate() {
            let Some((flight, motion, elevator_rad)) = motion else { continue };
            let values = flight.controls(motion, elevator_rad).to_array();
            for (lanes, value) in controls.iter_mut().zip(values) {
                lanes[lane] = value;
            }
        }
        let mut felt = Felt::default();
        let Self { aircraft, here, airs, flows, .. } = self;
        dispatch!(self.instructions.level(), _simd => aircraft.felt(&here.states, &controls, airs, flows, &mut felt));
        let mut samples = [None; LANES];
        for (lane, &motion) in motions.iter().enumerate() {
            let Some((flight, motion, elevator_rad)) = motion else { continue };
            let controls = flight.controls(motion, elevator_rad);
            samples[lane] = Some(flight.observed(motion, &controls, &flight.air(motion), felt.at(lane)));
        }
        samples
    }

    /// One sample period with commands and disturbances held, as [`AircraftFlight::advance`].
    pub(crate) fn advance(&mut self, wings: &mut Wings<'_>) {
        let Some(first) = wings.iter().flatten().next() else { return };
        let (flight, k) = (first.flight, first.motion.k);
        for Wing { flight, motion, autopilot, .. } in wings.iter_mut().flatten() {
            flight.follow(motion, autopilot);
        }
        if flight.atmosphere.moves() {
            for (number, piece) in flight.grid.pieces(k).enumerate() {
                for wing in wings.iter_mut().flatten() {
                    wing.flight.reach(wing.motion, piece.tick);
                }
                self.step(wings, piece.length_s, number == 0);
            }
        } else {
            for number in 0..flight.steps.count {
                self.step(wings, flight.steps.step_s, number == 0);
                for wing in wings.iter_mut().flatten() {
                    wing.flight.steer(wing.motion);
                }
            }
        }
        for wing in wings.iter_mut().flatten() {
            wing.flight.arrive(wing.motion);
        }
        self.look(wings);
    }

    /// A part of a period, as [`AircraftFlight::way`]; `seen` where the flow at its beginning is known.
    fn step(&mut self, wings: &mut Wings<'_>, step_s: f64, seen: bool) {
        let mut way = Way::new(wings, step_s);
        self.load(wings);
        way.enter(&self.here, &mut self.airs, 0);
        let rates = |all: &mut Self, way: &Way<'_>, stage: usize, numbers: &Numbers, known: bool| {
            let mut rates = Numbers { power: way.power_rates(numbers), ..Numbers::default() };
            let controls = way.controls(stage, numbers);
            let Self { aircraft, airs, flows, .. } = all;
            dispatch!(all.instructions.level(), _simd => stage_rates(aircraft, numbers, (&controls, airs), (flows, known), &mut rates));
            rates
        };
        let level = self.instructions.level();
        let (base, half_s) = (self.here, 0.5 * step_s);
        let k1 = rates(self, &way, 0, &base, seen);
        let at = dispatch!(level, _simd => base.and([half_s], [&k1]));
        way.enter(&at, &mut self.airs, 1);
        let k2 = rates(self, &way, 1, &at, false);
        let at = dispatch!(level, _simd => base.and([half_s], [&k2]));
        way.enter(&at, &mut self.airs, 1);
        let k3 = rates(self, &way, 1, &at, false);
        let at = dispatch!(level, _simd => base.and([step_s], [&k3]));
        way.enter(&at, &mut self.airs, 2);
        let k4 = rates(self, &way, 2, &at, false);
        let weights = [step_s / 6.0, step_s / 3.0, step_s / 3.0, step_s / 6.0];
        let (here, turned) = (&mut self.here, &mut self.angles);
        dispatch!(level, _simd => end(&base, weights, [&k1, &k2, &k3, &k4], here, turned));
        let ends = way.ends;
        for (lane, wing) in wings.iter_mut().enumerate() {
            if let (Some(wing), Some((held, actuator))) = (wing, ends[lane]) {
                self.arrive(lane, wing, (&held, actuator), step_s);
            }
        }
    }

    /// Puts a flight where its lane has come to, or where it comes to alone if there is a corner on its way.
    fn arrive(
        &self,
        lane: usize,
        wing: &mut Wing<'_>,
        (held, actuator): (&Holding, crate::actuator::ActuatorState),
        step_s: f64,
    ) {
        let (flight, before) = (wing.flight, wing.motion.body);
        let next = Moving {
            state: self.here.state(lane),
            distance_m: self.here.distance_m[lane],
            power: self.here.power[lane],
            time_s: before.time_s + step_s,
            actuator,
        };
        let (from, to) = (flight.place(&before), flight.place(&next));
        if flight.atmosphere.corner(&from, &to).is_some() {
            wing.motion.body = flight.way(before, held, step_s, None);
            wing.motion.sight.euler = wing.motion.body.state.euler();
        } else {
            wing.motion.body = next;
            wing.motion.sight.euler = angles_at(&self.angles, lane);
        }
    }
}

/// Rates at a stage; the flow may be known.
#[inline(always)]
fn stage_rates(
    aircraft: &Abreast,
    numbers: &Numbers,
    (controls, airs): (&[Lanes; CONTROLS], &Airs),
    (flows, known): (&mut Flows, bool),
    rates: &mut Numbers,
) {
    if !known {
        aircraft.flows(&numbers.states, airs, flows);
    }
    aircraft.rates(&numbers.states, controls, airs, flows, &mut rates.states);
    rates.distance_m = *flows.airspeed_m_s();
}

/// The end of a step, and the angles there.
#[inline(always)]
fn end(
    base: &Numbers,
    weights: [f64; 4],
    rates: [&Numbers; 4],
    here: &mut Numbers,
    turned: &mut Angles,
) {
    *here = base.and(weights, rates);
    normalise(&mut here.states);
    angles(&here.states, turned);
}

/// What a step of each flight is made with.
struct Way<'a> {
    flights: [Option<&'a AircraftFlight>; LANES],
    /// Controls at the beginning, the middle and the end; the throttle that is asked for.
    stages: [[Lanes; CONTROLS]; 3],
    /// What is held, and the actuator at the end.
    ends: [Option<(Holding, crate::actuator::ActuatorState)>; LANES],
    /// Time of the beginning, s.
    from_s: Lanes,
    step_s: f64,
}

impl<'a> Way<'a> {
    fn new(wings: &Wings<'a>, step_s: f64) -> Self {
        let mut way = Self {
            flights: [None; LANES],
            stages: [[[0.0; LANES]; CONTROLS]; 3],
            ends: [None; LANES],
            from_s: [0.0; LANES],
            step_s,
        };
        for (lane, wing) in wings.iter().enumerate() {
            let Some(Wing { flight, motion, command_rad, disturbance_rad, .. }) = wing else {
                continue;
            };
            let held = holding(motion, [*command_rad, *disturbance_rad]);
            let mut actuator = motion.body.actuator;
            let stages = flight.stages(&mut actuator, &held, step_s);
            for (lanes, controls) in way.stages.iter_mut().zip(stages) {
                for (lanes, value) in lanes.iter_mut().zip(controls.to_array()) {
                    lanes[lane] = value;
                }
            }
            way.flights[lane] = Some(flight);
            way.ends[lane] = Some((held, actuator));
            way.from_s[lane] = motion.body.time_s;
        }
        way
    }

    /// Takes the winds of the places of a stage; where there are none, the air is held.
    fn enter(&self, numbers: &Numbers, airs: &mut Airs, stage: usize) {
        let after_s = [0.0, 0.5 * self.step_s, self.step_s][stage];
        for lane in 0..LANES {
            let (Some(flight), Some((held, _))) = (self.flights[lane], &self.ends[lane]) else {
                continue;
            };
            if flight.atmosphere.has_winds() {
                let way = [numbers.distance_m[lane], self.from_s[lane] + after_s];
                let place = super::place(&numbers.state(lane), &flight.atmosphere, way);
                airs.put(lane, &flight.atmosphere.at(&place, held.turbulence));
            }
        }
    }

    fn power_rates(&self, numbers: &Numbers) -> Lanes {
        let mut rates = [0.0; LANES];
        for lane in 0..LANES {
            if let (Some(flight), Some((held, _))) = (self.flights[lane], &self.ends[lane]) {
                let asked = flight.gearing().power(held.throttle);
                rates[lane] = flight.plant.spool().rate_per_s(numbers.power[lane], asked);
            }
        }
        rates
    }

    /// Controls of a stage, with the throttle that acts.
    fn controls(&self, stage: usize, numbers: &Numbers) -> [Lanes; CONTROLS] {
        let mut controls = self.stages[stage];
        for lane in 0..LANES {
            if let (Some(flight), Some((held, _))) = (self.flights[lane], &self.ends[lane]) {
                controls[3][lane] = flight.acting_throttle(numbers.power[lane], held.throttle);
            }
        }
        controls
    }
}
