//! An aircraft from one sample to the next.

mod abreast;
mod changing;
mod numbers;
mod shown;

use fspid_aircraft::integrate::rk4;
use fspid_aircraft::{
    AirMotion, Aircraft, Controls, EulerAngles, Flow, ForceModel, Gearing, Quaternion,
    RIGID_STATES, RigidState, Spool, Vector3,
};

pub(crate) use abreast::{AircraftAbreast, NotAbreast, Wing};

use super::corner::Corner;
use super::{
    AircraftPlant, AircraftSample, Atmosphere, Forces, MOST_STEP_S, WingLeveller, YawDamper,
};
use crate::actuated::Held;
use crate::actuator::{Actuator, ActuatorState};
use crate::air::{self, AirPlace, Grid, Shaping};
use crate::autopilot::{Commands, Cut};
use crate::error::SimError;
use crate::surroundings::Weather;
use crate::timing::Timing;

/// Everything of an aircraft's flight that does not depend on the controller.
#[derive(Clone, Debug)]
pub(crate) struct AircraftFlight {
    plant: AircraftPlant,
    actuator: Actuator,
    leveller: WingLeveller,
    damper: Option<YawDamper>,
    steps: SubSteps,
    dt_s: f64,
    grid: Grid,
    atmosphere: Atmosphere,
    start: RigidState,
    /// Pitch of the trim, rad.
    trim_theta_rad: f64,
}

/// How a sample period is cut.
#[derive(Clone, Copy, Debug, PartialEq)]
struct SubSteps {
    count: u32,
    step_s: f64,
}

/// Where aircraft, actuator and air are.
#[derive(Clone, Debug)]
pub(crate) struct AircraftMotion {
    /// Sample that has been reached.
    k: usize,
    /// Time of the air's grid that has been reached.
    tick: usize,
    /// From that time on.
    turbulence: Option<Shaping>,
    /// Aileron and rudder, within their travel, rad.
    aileron_rad: f64,
    rudder_rad: f64,
    /// What the wing leveller holds, rad.
    bank_rad: f64,
    /// True where a control law moves aileron and rudder in place of leveller and damper.
    is_steered: bool,
    /// Throttle that is asked for, within its travel.
    throttle: f64,
    /// Pitch less that of the trim, rad.
    theta_rad: f64,
    body: Moving,
    sight: Sight,
}

/// What follows from where a body and its air are, and is asked for by many.
#[derive(Clone, Copy, Debug)]
struct Sight {
    euler: EulerAngles,
    /// The air as the aircraft meets it.
    flow: Flow,
}

/// What moves between the times of the grid.
#[derive(Clone, Copy, Debug)]
struct Moving {
    state: RigidState,
    /// Way through the air since the start, m.
    distance_m: f64,
    /// Power of the engine, as its gearing counts it.
    power: f64,
    /// Time since the start, s.
    time_s: f64,
    /// Fuel that was burnt, kg.
    burnt_kg: f64,
    actuator: ActuatorState,
}

/// What is held while it does.
#[derive(Clone, Copy, Debug)]
struct Holding {
    command_rad: f64,
    disturbance_rad: f64,
    aileron_rad: f64,
    rudder_rad: f64,
    throttle: f64,
    turbulence: air::AirMotion,
}

impl SubSteps {
    fn of(dt_s: f64) -> Self {
        // A millionth more than whole is rounding.
        let count = (dt_s / MOST_STEP_S - 1e-6).ceil().max(1.0);
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "at least 1, and the cast saturates"
        )]
        let whole = count as u32;
        Self { count: whole, step_s: dt_s / count }
    }
}

/// Longest step of the integration of a loop with that period, s.
pub(crate) fn step_s(dt_s: f64) -> f64 {
    SubSteps::of(dt_s).step_s
}

impl AircraftMotion {
    /// Change of pitch from the trim, rad.
    pub(crate) fn theta_rad(&self) -> f64 {
        self.theta_rad
    }

    /// Pitch rate of the body, rad/s.
    pub(crate) fn rate_rad_s(&self) -> f64 {
        self.body.state.rates_rad_s.y
    }

    /// True for an aircraft on its back or nowhere: its pitch angle means nothing any more.
    pub(crate) fn is_lost(&self) -> bool {
        let down = self.body.state.attitude.to_ned(Vector3::new(0.0, 0.0, 1.0)).z;
        let sum: f64 = self.body.state.to_array().iter().sum();
        // Written so that NaN is lost.
        !(down > 0.0 && sum.is_finite())
    }
}

impl AircraftFlight {
    /// The flight of a plant behind an actuator through the weather.
    pub(crate) fn new(
        plant: &AircraftPlant,
        actuator: Actuator,
        weather: Option<&Weather>,
        timing: Timing,
    ) -> Result<Self, SimError> {
        let atmosphere = Atmosphere::new(weather, plant.trim().target.altitude_m)?;
        let atmosphere = atmosphere.with_corners(plant.corners_s(), plant.corner_altitude_m());
        let start = start(plant, &atmosphere);
        Ok(Self {
            plant: plant.clone(),
            actuator,
            leveller: WingLeveller::with_time(
                plant.aircraft(),
                plant.trim(),
                plant.lateral().bank_time_s,
            ),
            damper: damper(plant),
            steps: SubSteps::of(timing.dt_s()),
            dt_s: timing.dt_s(),
            grid: Grid::new(timing.dt_s()),
            trim_theta_rad: start.euler().theta_rad,
            start,
            atmosphere,
        })
    }

    /// True at or below the ground, if the plant has one.
    pub(crate) fn is_at_ground(&self, motion: &AircraftMotion) -> bool {
        self.plant
            .ground_altitude_m()
            .is_some_and(|ground_m| motion.body.state.altitude_m() <= ground_m)
    }

    fn aircraft(&self) -> &Aircraft<Forces> {
        self.plant.aircraft()
    }

    pub(crate) fn at_rest(&self) -> AircraftMotion {
        let body = Moving {
            state: self.start,
            distance_m: 0.0,
            time_s: 0.0,
            burnt_kg: 0.0,
            power: self.gearing().power(self.plant.trim().controls.throttle),
            actuator: ActuatorState::default(),
        };
        let turbulence = self.atmosphere.start_turbulence();
        let sight = self.sight(&body, turbulence.as_ref());
        AircraftMotion {
            k: 0,
            tick: 0,
            aileron_rad: self.aileron_rad(&sight.euler, 0.0),
            rudder_rad: self.rudder_rad(&self.start, &sight.euler, || sight.flow.airspeed_m_s),
            bank_rad: 0.0,
            is_steered: false,
            throttle: self.plant.trim().controls.throttle,
            theta_rad: 0.0,
            turbulence,
            body,
            sight,
        }
    }

    fn sight(&self, body: &Moving, turbulence: Option<&Shaping>) -> Sight {
        let air = self.atmosphere.at(&self.place(body), held_motion(turbulence));
        Sight { euler: body.state.euler(), flow: self.aircraft().flow(&body.state, &air) }
    }

    /// Looks again, where body or air are no longer what they were.
    fn look(&self, motion: &mut AircraftMotion) {
        motion.sight = self.sight(&motion.body, motion.turbulence.as_ref());
    }

    fn gearing(&self) -> Gearing {
        self.aircraft().model().gearing()
    }

    /// The throttle that acts: what is asked for, or what the engine's power has come to.
    fn acting_throttle(&self, power: f64, asked: f64) -> f64 {
        match self.plant.spool() {
            Spool::Instant => asked,
            Spool::FirstOrder { .. } | Spool::StevensLewis => self.gearing().throttle(power),
        }
    }

    /// Moves an actuator without lag to its command at once; another stays where it is.
    pub(crate) fn settle(&self, motion: &mut AircraftMotion, command_rad: f64) {
        self.actuator.settle(&mut motion.body.actuator, command_rad);
    }

    /// Elevator, trailing edge down positive, disturbance included, within its travel, rad.
    pub(crate) fn elevator_rad(&self, motion: &AircraftMotion, disturbance_rad: f64) -> f64 {
        self.elevator_at_rad(&motion.body.actuator, disturbance_rad)
    }

    fn elevator_at_rad(&self, actuator: &ActuatorState, disturbance_rad: f64) -> f64 {
        let deflection_rad = self.actuator.deflection_rad(actuator) + disturbance_rad;
        let travel = self.aircraft().model().travel().elevator_rad;
        travel.clamp(self.plant.trim().point.elevator_rad - deflection_rad)
    }

    fn aileron_rad(&self, euler: &EulerAngles, bank_rad: f64) -> f64 {
        let travel = self.aircraft().model().travel().aileron_rad;
        travel.clamp(self.leveller.aileron_rad(euler.phi_rad - bank_rad))
    }

    fn rudder_rad(
        &self,
        state: &RigidState,
        euler: &EulerAngles,
        airspeed_m_s: impl FnOnce() -> f64,
    ) -> f64 {
        let trimmed_rad = self.plant.trim().controls.rudder_rad;
        let Some(damper) = &self.damper else { return trimmed_rad };
        let &EulerAngles { phi_rad, theta_rad, .. } = euler;
        let (sine, _) = crate::math::sin_cos(phi_rad);
        let (_, cosine) = crate::math::sin_cos(theta_rad);
        // Relative to the air: a steady wind carries a turn along and changes nothing about it.
        let speed_m_s = airspeed_m_s().max(1.0);
        let turn_rad_s = self.aircraft().environment().gravity_m_s2 / speed_m_s * sine * cosine;
        let rudder_rad = damper.rudder_rad(state.rates_rad_s.z, turn_rad_s);
        self.aircraft().model().travel().rudder_rad.clamp(trimmed_rad + rudder_rad)
    }

    /// Moves aileron and rudder to where leveller and damper have them now.
    fn steer(&self, motion: &mut AircraftMotion) {
        if motion.is_steered {
            return;
        }
        let euler = motion.sight.euler;
        motion.aileron_rad = self.aileron_rad(&euler, motion.bank_rad);
        let state = &motion.body.state;
        let airspeed_m_s = || self.aircraft().flow(state, &self.air(motion)).airspeed_m_s;
        motion.rudder_rad = self.rudder_rad(state, &euler, airspeed_m_s);
    }

    /// Takes what an autopilot commands until the next sample.
    fn follow(&self, motion: &mut AircraftMotion, commands: &Commands) {
        // Within its travel: the autopilot keeps it there.
        motion.throttle = self.plant.trim().controls.throttle + commands.throttle;
        motion.bank_rad = commands.bank_rad;
        motion.is_steered = commands.lateral_rad.is_some();
        if let Some([aileron_rad, rudder_rad]) = commands.lateral_rad {
            let travel = self.aircraft().model().travel();
            motion.aileron_rad = travel.aileron_rad.clamp(aileron_rad);
            motion.rudder_rad = travel.rudder_rad.clamp(rudder_rad);
        }
    }

    /// The air where the aircraft is.
    fn air(&self, motion: &AircraftMotion) -> AirMotion {
        self.atmosphere.at(&self.place(&motion.body), turbulence(motion))
    }

    fn place(&self, body: &Moving) -> AirPlace {
        place(&body.state, &self.atmosphere, [body.distance_m, body.time_s])
    }

    /// One sample period with command and disturbance held.
    pub(crate) fn advance(
        &self,
        motion: &mut AircraftMotion,
        command_rad: f64,
        outside: &Held<'_>,
    ) {
        let held = [command_rad, outside.elevator_rad];
        self.follow(motion, &outside.autopilot);
        if self.atmosphere.moves() {
            for (number, piece) in self.grid.pieces(motion.k).enumerate() {
                self.reach(motion, piece.tick);
                // What was seen at the sample holds at its beginning alone.
                let seen = (number == 0).then_some(motion.sight.flow);
                let held = holding(motion, held);
                motion.body = self.way(motion.body, &held, piece.length_s, seen);
                motion.sight.euler = motion.body.state.euler();
            }
            self.arrive(motion);
        } else {
            let mut seen = Some(motion.sight.flow);
            for _ in 0..self.steps.count {
                let held = holding(motion, held);
                motion.body = match self.varying() {
                    Some(_) => self.way(motion.body, &held, self.steps.step_s, seen.take()),
                    None => self.stepped(&motion.body, &held, self.steps.step_s, seen.take()),
                };
                motion.sight.euler = motion.body.state.euler();
                self.steer(motion);
            }
            self.arrive(motion);
        }
        let air = self.air(motion);
        motion.sight.flow = self.aircraft().flow(&motion.body.state, &air);
    }

    /// At the next sample, but for the flow there.
    fn arrive(&self, motion: &mut AircraftMotion) {
        motion.k += 1;
        if self.atmosphere.moves() {
            self.reach(motion, self.grid.tick(motion.k));
        }
        // From the sample, not by a running sum.
        motion.body.time_s = motion.k as f64 * self.dt_s;
        motion.theta_rad = motion.sight.euler.theta_rad - self.trim_theta_rad;
    }

    /// Takes the turbulence and the aileron of a time of the grid.
    fn reach(&self, motion: &mut AircraftMotion, tick: usize) {
        while motion.tick < tick {
            motion.tick += 1;
            let (place, air) = (self.place(&motion.body), self.air(motion));
            let state = &motion.body.state;
            if let Some(shaping) = &mut motion.turbulence {
                let airspeed_m_s = || self.aircraft().flow(state, &air).airspeed_m_s;
                shaping.advance(place.height_m, airspeed_m_s);
            }
            self.steer(motion);
        }
    }

    /// A part of a period in moving air, cut where winds are not smooth.
    fn way(
        &self,
        mut body: Moving,
        held: &Holding,
        length_s: f64,
        mut seen: Option<Flow>,
    ) -> Moving {
        let mut left_s = length_s;
        // Every corner is met once; the bound is for air that carries an aircraft to and fro.
        for _ in 0..MOST_CORNERS {
            let next = self.stepped(&body, held, left_s, seen.take());
            let Some(corner) = self.atmosphere.corner(&self.place(&body), &self.place(&next))
            else {
                return next;
            };
            let (there, step_s) = self.stepped_to([&body, &next], held, corner, left_s);
            body = there;
            left_s -= step_s;
        }
        self.stepped(&body, held, left_s, None)
    }

    /// The motion at a corner that a step of `most_s` passes, and how long a step reaches it: by regula falsi.
    fn stepped_to(
        &self,
        [body, beyond]: [&Moving; 2],
        held: &Holding,
        corner: Corner,
        most_s: f64,
    ) -> (Moving, f64) {
        let past = |body: &Moving| corner.past(&self.place(body));
        let (mut before, mut after) = ((0.0, past(body)), (most_s, past(beyond)));
        let mut found = (*body, 0.0);
        for _ in 0..MOST_TRIES {
            let step_s = before.0 + (after.0 - before.0) * before.1 / (before.1 - after.1);
            found = (self.stepped(body, held, step_s, None), step_s);
            if corner.is_at(&self.place(&found.0)) {
                break;
            }
            let here = (step_s, past(&found.0));
            if (here.1 < 0.0) == (before.1 < 0.0) {
                before = here;
            } else {
                after = here;
            }
        }
        found
    }

    /// The motion after one step of Runge and Kutta, in the air of the place at each stage; `seen` is the flow of the first
    /// stage, if it is known.
    fn stepped(&self, body: &Moving, held: &Holding, step_s: f64, seen: Option<Flow>) -> Moving {
        if let Some(varying) = self.varying() {
            return self.stepped_varying(varying, (body, held), step_s);
        }
        let mut next = *body;
        let [begin, middle, end] = self.stages(&mut next.actuator, held, step_s);
        let rate = |time_s: f64, values: &[f64; STATES]| {
            let controls = match time_s {
                t if t <= 0.0 => &begin,
                t if t < step_s => &middle,
                _ => &end,
            };
            let seen = seen.filter(|_| time_s <= 0.0);
            self.rate((values, body.time_s + time_s), controls, held, seen)
        };
        let values = rk4::step(rate, 0.0, &joined(body), step_s);
        let Way { state, distance_m, power } = parted(&values);
        Moving {
            state: RigidState { attitude: state.attitude.normalised(), ..state },
            distance_m,
            power,
            time_s: body.time_s + step_s,
            ..next
        }
    }

    /// Rates of the body's state, of the way through the air, and of the engine's power.
    fn rate(
        &self,
        (values, time_s): (&[f64; STATES], f64),
        controls: &Controls,
        held: &Holding,
        seen: Option<Flow>,
    ) -> [f64; STATES] {
        let Way { state, distance_m, power } = parted(values);
        let place = place(&state, &self.atmosphere, [distance_m, time_s]);
        let air = self.atmosphere.at(&place, held.turbulence);
        let throttle = self.acting_throttle(power, held.throttle);
        let controls = Controls { throttle, ..*controls };
        let flow = seen.unwrap_or_else(|| self.aircraft().flow(&state, &air));
        let instant = self.aircraft().instant_in(flow, &state, &controls, &air);
        let rates = state.rate(&instant.accelerations);
        let mut all = [0.0; STATES];
        all[..RIGID_STATES].copy_from_slice(&rates);
        all[RIGID_STATES] = instant.flow.airspeed_m_s;
        let asked = self.gearing().power(held.throttle);
        all[RIGID_STATES + 1] = self.plant.spool().rate_per_s(power, asked);
        all
    }

    /// The controls at the beginning, the middle and the end of a sub-step; the actuator is left at
    /// the end.
    fn stages(&self, actuator: &mut ActuatorState, held: &Holding, step_s: f64) -> [Controls; 3] {
        [0.0, 0.5, 0.5].map(|share| {
            if share > 0.0 {
                self.actuator.advance(actuator, held.command_rad, share * step_s);
            }
            let elevator_rad = self.elevator_at_rad(actuator, held.disturbance_rad);
            Controls {
                elevator_rad,
                aileron_rad: held.aileron_rad,
                rudder_rad: held.rudder_rad,
                throttle: held.throttle,
            }
        })
    }

    /// True where a limit of the actuator or the travel of the elevator acts on the coming sample.
    pub(crate) fn is_limited(&self, motion: &AircraftMotion, command_rad: f64) -> bool {
        let dt_s = self.steps.step_s * f64::from(self.steps.count);
        let free_rad = self.plant.trim().point.elevator_rad
            - self.actuator.deflection_rad(&motion.body.actuator);
        let cut = (self.elevator_rad(motion, 0.0) - free_rad).abs() > 0.0;
        cut || self.actuator.is_limited(&motion.body.actuator, command_rad, dt_s)
    }

    /// Which way the command cannot be followed by the elevator.
    pub(crate) fn cut(&self, motion: &AircraftMotion, command_rad: f64) -> Cut {
        if !self.is_limited(motion, command_rad) {
            return Cut::Not;
        }
        Cut::towards(command_rad - self.actuator.deflection_rad(&motion.body.actuator))
    }
}

/// States of a body, its way through the air, and the power of its engine.
const STATES: usize = RIGID_STATES + 2;
/// Most corners in a part of a period that a step ends at.
const MOST_CORNERS: usize = 64;
/// Most tries for a corner; three are usual.
const MOST_TRIES: usize = 20;

/// The air's turbulence in a motion; none without.
fn turbulence(motion: &AircraftMotion) -> air::AirMotion {
    held_motion(motion.turbulence.as_ref())
}

fn held_motion(turbulence: Option<&Shaping>) -> air::AirMotion {
    turbulence.map(Shaping::motion).unwrap_or_default()
}

/// The yaw damper of a plant that has one.
fn damper(plant: &AircraftPlant) -> Option<YawDamper> {
    let asked = plant.lateral().yaw_damping;
    (asked > 0.0).then(|| YawDamper::of(plant.aircraft(), plant.trim(), asked))
}

/// Everything that is held from here on.
fn holding(motion: &AircraftMotion, [command_rad, disturbance_rad]: [f64; 2]) -> Holding {
    let &AircraftMotion { aileron_rad, rudder_rad, throttle, .. } = motion;
    let turbulence = turbulence(motion);
    Holding { command_rad, disturbance_rad, aileron_rad, rudder_rad, throttle, turbulence }
}

fn joined(body: &Moving) -> [f64; STATES] {
    let mut values = [body.power; STATES];
    values[..RIGID_STATES].copy_from_slice(&body.state.to_array());
    values[RIGID_STATES] = body.distance_m;
    values
}

/// What is integrated.
struct Way {
    state: RigidState,
    distance_m: f64,
    power: f64,
}

fn parted(values: &[f64; STATES]) -> Way {
    let mut state = [0.0; RIGID_STATES];
    state.copy_from_slice(&values[..RIGID_STATES]);
    let (state, distance_m) = (RigidState::from_array(&state), values[RIGID_STATES]);
    Way { state, distance_m, power: values[RIGID_STATES + 1] }
}

fn place(state: &RigidState, atmosphere: &Atmosphere, [distance_m, time_s]: [f64; 2]) -> AirPlace {
    let [north_m, east_m, _] = state.position_ned_m.to_array();
    let height_m = state.altitude_m() - atmosphere.ground_altitude_m();
    AirPlace { time_s, distance_m, north_m, east_m, height_m }
}

/// At the course's start and heading, moving with the wind that blows there.
fn start(plant: &AircraftPlant, atmosphere: &Atmosphere) -> RigidState {
    let trim = plant.trim();
    let ([north_m, east_m], psi_rad) = atmosphere.start();
    let attitude = EulerAngles { psi_rad, ..trim.state.euler() };
    let still = RigidState {
        position_ned_m: Vector3::new(north_m, east_m, -trim.target.altitude_m),
        attitude: Quaternion::from_euler(attitude),
        ..trim.state
    };
    let wind_ned_m_s = atmosphere.wind(&place(&still, atmosphere, [0.0; 2])).wind_ned_m_s;
    let drift_m_s = still.attitude.to_body(wind_ned_m_s);
    RigidState { velocity_body_m_s: still.velocity_body_m_s + drift_m_s, ..still }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_period_is_cut_into_equal_steps_of_at_most_ten_milliseconds() {
        for (dt_s, count) in
            [(0.001, 1), (0.01, 1), (0.010_001, 2), (0.025, 3), (0.1, 10), (0.7, 70)]
        {
            let steps = SubSteps::of(dt_s);
            assert_eq!(steps.count, count, "{dt_s}");
            assert!((steps.step_s * f64::from(count) - dt_s).abs() < 1e-15);
        }
    }
}
