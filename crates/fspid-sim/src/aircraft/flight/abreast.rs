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

use super::{AircraftFlight, AircraftMotion, AircraftSample, Moving, holding, turbulence};
use crate::actuator::lag::{TERMS, powers, second_order_after};
use crate::actuator::{ActuatorState, Lag};
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

    /// Becomes others and multiples of rates, added in order.
    #[inline(always)]
    fn become_sum<const K: usize>(&mut self, of: &Self, factors: [f64; K], rates: [&Self; K]) {
        for (place, sum) in self.states.iter_mut().enumerate() {
            add(sum, &of.states[place], factors, rates.map(|rates| &rates.states[place]));
        }
        let rates_of = rates.map(|rates| &rates.distance_m);
        add(&mut self.distance_m, &of.distance_m, factors, rates_of);
        add(&mut self.power, &of.power, factors, rates.map(|rates| &rates.power));
    }
}

#[inline(always)]
fn add<const K: usize>(sum: &mut Lanes, of: &Lanes, factors: [f64; K], rates: [&Lanes; K]) {
    for lane in 0..LANES {
        let mut value = of[lane];
        for number in 0..K {
            value += factors[number] * rates[number][lane];
        }
        sum[lane] = value;
    }
}

/// Aircraft side by side.
#[derive(Clone, Debug)]
pub(crate) struct AircraftAbreast {
    instructions: InstructionSet,
    aircraft: Abreast,
    /// Where all are, where they are at a stage, and their rates there.
    here: Numbers,
    stage: Numbers,
    rates: [Numbers; 4],
    airs: Airs,
    flows: Flows,
    angles: Angles,
    way: Way,
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
            stage: Numbers::default(),
            rates: [Numbers::default(); 4],
            airs: Airs::default(),
            flows: Flows::default(),
            angles: Angles::default(),
            way: Way::default(),
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
            samples[lane] =
                Some(flight.observed(motion, &controls, &flight.air(motion), felt.at(lane)));
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
        self.load(wings);
        let level = self.instructions.level();
        let Self { aircraft, here, stage, rates, airs, flows, angles, way, .. } = self;
        way.begin(wings, step_s);
        dispatch!(level, _simd => way.drives.move_on());
        way.turn(wings, 1);
        dispatch!(level, _simd => way.drives.move_on());
        way.turn(wings, 2);
        way.enter(wings, here, airs, 0);
        let controls = way.controls(wings, here, &mut rates[0], 0);
        let first = &mut rates[0];
        dispatch!(level, _simd => stage_rates(aircraft, here, (&controls, airs), (flows, seen), first));
        for (number, part) in [(1, 1), (2, 1), (3, 2)] {
            let (done, coming) = rates.split_at_mut(number);
            let (before, after) = (&done[number - 1], &mut coming[0]);
            let after_s = way.after_s[part];
            dispatch!(level, _simd => stage.become_sum(here, [after_s], [before]));
            way.enter(wings, stage, airs, part);
            let controls = way.controls(wings, stage, after, part);
            dispatch!(level, _simd => stage_rates(aircraft, stage, (&controls, airs), (flows, false), after));
        }
        let weights = [step_s / 6.0, step_s / 3.0, step_s / 3.0, step_s / 6.0];
        dispatch!(level, _simd => end(here, weights, rates.each_ref(), stage, angles));
        std::mem::swap(here, stage);
        for (lane, wing) in wings.iter_mut().enumerate() {
            if let Some(wing) = wing {
                self.arrive(lane, wing, step_s);
            }
        }
    }

    /// Puts a flight where its lane has come to, or where it comes to alone if there is a corner on its way.
    fn arrive(&self, lane: usize, wing: &mut Wing<'_>, step_s: f64) {
        let (flight, before) = (wing.flight, wing.motion.body);
        let next = Moving {
            state: self.here.state(lane),
            distance_m: self.here.distance_m[lane],
            power: self.here.power[lane],
            burnt_kg: before.burnt_kg,
            time_s: before.time_s + step_s,
            actuator: self.way.actuators[lane],
        };
        let has_corner = || flight.atmosphere.corner(&flight.place(&before), &flight.place(&next));
        if flight.atmosphere.has_winds() && has_corner().is_some() {
            let held = holding(wing.motion, [wing.command_rad, wing.disturbance_rad]);
            wing.motion.body = flight.way(before, &held, step_s, None);
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
    here.become_sum(base, weights, rates);
    normalise(&mut here.states);
    angles(&here.states, turned);
}

/// What a step of each flight is made with.
#[derive(Clone, Debug, Default)]
struct Way {
    /// Controls at the beginning, the middle and the end; the throttle that is asked for.
    stages: [[Lanes; CONTROLS]; 3],
    /// Where they have come to.
    actuators: [ActuatorState; LANES],
    drives: Drives,
    /// From the beginning of the step to its stages, s.
    after_s: [f64; 3],
}

impl Way {
    /// Everything at the beginning of a step.
    fn begin(&mut self, wings: &Wings<'_>, step_s: f64) {
        self.after_s = [0.0, 0.5 * step_s, step_s];
        self.drives.most = 0;
        for (lane, wing) in wings.iter().enumerate() {
            let Some(Wing { flight, motion, command_rad, .. }) = wing else { continue };
            self.actuators[lane] = motion.body.actuator;
            let held = [motion.aileron_rad, motion.rudder_rad, motion.throttle];
            for stage in &mut self.stages {
                let [_, aileron_rad, rudder_rad, throttle] = stage;
                (aileron_rad[lane], rudder_rad[lane], throttle[lane]) = held.into();
            }
            self.stages[0][0][lane] = self.elevator_rad(lane, wing.as_ref());
            let actuator = &mut self.actuators[lane];
            let target_rad = flight.actuator.set_off(actuator, *command_rad);
            self.drives.put(lane, flight.actuator.lag(), target_rad, self.after_s[1], actuator);
        }
    }

    /// Where the elevators are behind another half of the step.
    fn turn(&mut self, wings: &Wings<'_>, stage: usize) {
        for (lane, wing) in wings.iter().enumerate() {
            let Some(Wing { flight, command_rad, .. }) = wing else { continue };
            let actuator = &mut self.actuators[lane];
            if self.drives.is_in_lane[lane] {
                flight.actuator.land(actuator, self.drives.at(lane));
                flight.actuator.set_off(actuator, *command_rad);
            } else {
                flight.actuator.advance(actuator, *command_rad, self.after_s[1]);
            }
            self.stages[stage][0][lane] = self.elevator_rad(lane, wing.as_ref());
        }
    }

    fn elevator_rad(&self, lane: usize, wing: Option<&Wing<'_>>) -> f64 {
        wing.map_or(0.0, |wing| {
            wing.flight.elevator_at_rad(&self.actuators[lane], wing.disturbance_rad)
        })
    }

    /// Takes the winds of the places of a stage; where there are none, the air is held.
    fn enter(&self, wings: &Wings<'_>, numbers: &Numbers, airs: &mut Airs, stage: usize) {
        for (lane, wing) in wings.iter().enumerate() {
            let Some(Wing { flight, motion, .. }) = wing else { continue };
            if flight.atmosphere.has_winds() {
                let time_s = motion.body.time_s + self.after_s[stage];
                let way = [numbers.distance_m[lane], time_s];
                let place = super::place(&numbers.state(lane), &flight.atmosphere, way);
                airs.put(lane, &flight.atmosphere.at(&place, turbulence(motion)));
            }
        }
    }

    /// Controls of a stage, with the throttle that acts; the rates of the powers.
    fn controls(
        &self,
        wings: &Wings<'_>,
        numbers: &Numbers,
        rates: &mut Numbers,
        stage: usize,
    ) -> [Lanes; CONTROLS] {
        let mut controls = self.stages[stage];
        for (lane, wing) in wings.iter().enumerate() {
            let Some(Wing { flight, motion, .. }) = wing else { continue };
            let (power, asked) = (numbers.power[lane], motion.throttle);
            controls[3][lane] = flight.acting_throttle(power, asked);
            let wanted = flight.gearing().power(asked);
            rates.power[lane] = flight.plant.spool().rate_per_s(power, wanted);
        }
        controls
    }
}

/// Actuators that nothing but a lag of second order moves, over half a step.
#[derive(Clone, Debug, Default)]
struct Drives {
    is_in_lane: [bool; LANES],
    position_rad: Lanes,
    rate_rad_s: Lanes,
    target_rad: Lanes,
    wn: Lanes,
    damping: Lanes,
    piece_s: Lanes,
    pieces: Lanes,
    most: u32,
}

impl Drives {
    fn put(
        &mut self,
        lane: usize,
        lag: Lag,
        target_rad: Option<f64>,
        time_s: f64,
        actuator: &ActuatorState,
    ) {
        self.is_in_lane[lane] = target_rad.is_some();
        let (Some(target_rad), Some((wn, damping))) = (target_rad, lag.second_order_parameters())
        else {
            // One second of nothing.
            (self.wn[lane], self.damping[lane], self.pieces[lane]) = (1.0, 1.0, 0.0);
            return;
        };
        let pieces = lag.pieces(time_s);
        self.most = self.most.max(pieces);
        self.pieces[lane] = f64::from(pieces);
        self.piece_s[lane] = time_s / f64::from(pieces);
        (self.wn[lane], self.damping[lane]) = (wn, damping);
        self.target_rad[lane] = target_rad;
        self.position_rad[lane] = actuator.position_rad();
        self.rate_rad_s[lane] = actuator.rate_rad_s();
    }

    fn at(&self, lane: usize) -> [f64; 2] {
        [self.position_rad[lane], self.rate_rad_s[lane]]
    }

    /// All behind half a step.
    #[inline(always)]
    fn move_on(&mut self) {
        let mut all = [[0.0; LANES]; TERMS];
        for lane in 0..LANES {
            let of_lane = powers(self.wn[lane] * self.piece_s[lane]);
            for term in 0..TERMS {
                all[term][lane] = of_lane[term];
            }
        }
        for piece in 0..self.most {
            let piece = f64::from(piece);
            for lane in 0..LANES {
                let from = [self.position_rad[lane], self.rate_rad_s[lane]];
                let mut powers = [0.0; TERMS];
                for term in 0..TERMS {
                    powers[term] = all[term][lane];
                }
                let lag = [self.wn[lane], self.damping[lane]];
                let [x, rate] = second_order_after(from, self.target_rad[lane], lag, &powers);
                let is_on = piece < self.pieces[lane];
                self.position_rad[lane] = if is_on { x } else { from[0] };
                self.rate_rad_s[lane] = if is_on { rate } else { from[1] };
            }
        }
    }
}
