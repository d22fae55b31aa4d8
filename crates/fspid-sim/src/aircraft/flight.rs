//! An aircraft from one sample to the next.

use fspid_aircraft::integrate::rk4;
use fspid_aircraft::{
    AirMotion, Aircraft, Controls, EulerAngles, ForceModel, Instant, Quaternion, RIGID_STATES,
    RigidState, Vector3,
};

use super::corner::Corner;
use super::{AircraftPlant, AircraftSample, Atmosphere, Forces, MOST_STEP_S, WingLeveller};
use crate::actuator::{Actuator, ActuatorState};
use crate::air::{self, DrydenState, Grid, Place};
use crate::error::SimError;
use crate::surroundings::Weather;
use crate::timing::Timing;

/// Everything of an aircraft's flight that does not depend on the controller.
#[derive(Clone, Debug)]
pub(crate) struct AircraftFlight {
    plant: AircraftPlant,
    actuator: Actuator,
    leveller: WingLeveller,
    steps: SubSteps,
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

/// Where aircraft and actuator are.
#[derive(Clone, Debug)]
pub(crate) struct AircraftMotion {
    /// Sample that has been reached.
    k: usize,
    /// Time of the air's grid that has been reached, and the turbulence from it on.
    tick: usize,
    turbulence: Option<DrydenState>,
    /// Aileron, within its travel, rad.
    aileron_rad: f64,
    /// Way through the air since the start, m.
    distance_m: f64,
    state: RigidState,
    /// Pitch less that of the trim, rad.
    theta_rad: f64,
    actuator: ActuatorState,
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

impl AircraftMotion {
    /// Change of pitch from the trim, rad.
    pub(crate) fn theta_rad(&self) -> f64 {
        self.theta_rad
    }

    /// Pitch rate of the body, rad/s.
    pub(crate) fn rate_rad_s(&self) -> f64 {
        self.state.rates_rad_s.y
    }

    /// True for an aircraft on its back or nowhere: its pitch angle means nothing any more.
    pub(crate) fn is_lost(&self) -> bool {
        let down = self.state.attitude.to_ned(Vector3::new(0.0, 0.0, 1.0)).z;
        let sum: f64 = self.state.to_array().iter().sum();
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
        let start = start(plant, &atmosphere);
        Ok(Self {
            plant: plant.clone(),
            actuator,
            leveller: WingLeveller::of(plant.aircraft(), plant.trim()),
            steps: SubSteps::of(timing.dt_s()),
            grid: Grid::new(timing.dt_s()),
            trim_theta_rad: start.euler().theta_rad,
            start,
            atmosphere,
        })
    }

    /// True at or below the ground, if the plant has one.
    pub(crate) fn is_at_ground(&self, motion: &AircraftMotion) -> bool {
        self.plant.ground_altitude_m().is_some_and(|ground_m| motion.state.altitude_m() <= ground_m)
    }

    fn aircraft(&self) -> &Aircraft<Forces> {
        self.plant.aircraft()
    }

    pub(crate) fn at_rest(&self) -> AircraftMotion {
        AircraftMotion {
            k: 0,
            tick: 0,
            turbulence: self.atmosphere.start_turbulence(),
            aileron_rad: self.aileron_rad(&self.start),
            distance_m: 0.0,
            state: self.start,
            theta_rad: 0.0,
            actuator: ActuatorState::default(),
        }
    }

    /// Moves an actuator without lag to its command at once; another stays where it is.
    pub(crate) fn settle(&self, motion: &mut AircraftMotion, command_rad: f64) {
        self.actuator.settle(&mut motion.actuator, command_rad);
    }

    /// Elevator, trailing edge down positive, disturbance included, within its travel, rad.
    pub(crate) fn elevator_rad(&self, motion: &AircraftMotion, disturbance_rad: f64) -> f64 {
        let deflection_rad = self.actuator.deflection_rad(&motion.actuator) + disturbance_rad;
        let travel = self.aircraft().model().travel().elevator_rad;
        travel.clamp(self.plant.trim().point.elevator_rad - deflection_rad)
    }

    fn aileron_rad(&self, state: &RigidState) -> f64 {
        let travel = self.aircraft().model().travel().aileron_rad;
        travel.clamp(self.leveller.aileron_rad(state.euler().phi_rad))
    }

    fn controls(&self, elevator_rad: f64, aileron_rad: f64) -> Controls {
        Controls { elevator_rad, aileron_rad, ..self.plant.trim().controls }
    }

    /// The air where the aircraft is.
    fn air(&self, motion: &AircraftMotion) -> AirMotion {
        self.atmosphere.at(&self.place(motion), self.atmosphere.turbulence(&motion.turbulence))
    }

    fn place(&self, motion: &AircraftMotion) -> Place {
        place(&motion.state, &self.atmosphere, motion.distance_m)
    }

    /// One sample period with command and disturbance held.
    pub(crate) fn advance(
        &self,
        motion: &mut AircraftMotion,
        command_rad: f64,
        disturbance_rad: f64,
    ) {
        let held = [command_rad, disturbance_rad];
        if self.atmosphere.moves() {
            for piece in self.grid.pieces(motion.k) {
                self.reach(motion, piece.tick);
                self.way(motion, held, piece.length_s);
            }
            motion.k += 1;
            self.reach(motion, self.grid.tick(motion.k));
        } else {
            for _ in 0..self.steps.count {
                motion.aileron_rad = self.aileron_rad(&motion.state);
                *motion = self.stepped(motion, held, self.steps.step_s);
            }
            motion.aileron_rad = self.aileron_rad(&motion.state);
            motion.k += 1;
        }
        motion.theta_rad = motion.state.euler().theta_rad - self.trim_theta_rad;
    }

    /// Takes the turbulence and the aileron of a time of the grid.
    fn reach(&self, motion: &mut AircraftMotion, tick: usize) {
        while motion.tick < tick {
            motion.tick += 1;
            self.atmosphere.advance(&mut motion.turbulence, motion.tick);
            motion.aileron_rad = self.aileron_rad(&motion.state);
        }
    }

    /// A part of a period in moving air, cut where winds are not smooth.
    fn way(&self, motion: &mut AircraftMotion, held: [f64; 2], length_s: f64) {
        let mut left_s = length_s;
        // Every corner is met once; the bound is for air that carries an aircraft to and fro.
        for _ in 0..MOST_CORNERS {
            let next = self.stepped(motion, held, left_s);
            let Some(corner) = self.atmosphere.corner(&self.place(motion), &self.place(&next))
            else {
                *motion = next;
                return;
            };
            let (there, step_s) = self.stepped_to(motion, held, (corner, left_s));
            *motion = there;
            left_s -= step_s;
        }
        *motion = self.stepped(motion, held, left_s);
    }

    /// The motion at a corner that a step of `most_s` passes, and how long a step reaches it: by regula falsi.
    fn stepped_to(
        &self,
        motion: &AircraftMotion,
        held: [f64; 2],
        (corner, most_s): (Corner, f64),
    ) -> (AircraftMotion, f64) {
        let past_m = |motion: &AircraftMotion| corner.past_m(&self.place(motion));
        let (mut before, mut after) = ((0.0, past_m(motion)), most_s);
        let mut beyond_m = past_m(&self.stepped(motion, held, most_s));
        let mut found = (motion.clone(), 0.0);
        for _ in 0..MOST_TRIES {
            let step_s = before.0 + (after - before.0) * before.1 / (before.1 - beyond_m);
            let there = self.stepped(motion, held, step_s);
            let here_m = past_m(&there);
            found = (there, step_s);
            if corner.is_at(&self.place(&found.0)) {
                break;
            }
            if (here_m < 0.0) == (before.1 < 0.0) {
                before = (step_s, here_m);
            } else {
                (after, beyond_m) = (step_s, here_m);
            }
        }
        found
    }

    /// The motion after one step of Runge and Kutta, in the air of the place at each stage.
    fn stepped(
        &self,
        motion: &AircraftMotion,
        [command_rad, disturbance_rad]: [f64; 2],
        step_s: f64,
    ) -> AircraftMotion {
        let mut next = motion.clone();
        let turbulence = self.atmosphere.turbulence(&motion.turbulence);
        let [begin, middle, end] = self.stages(&mut next, ([command_rad, disturbance_rad], step_s));
        let rate = |time_s: f64, values: &[f64; STATES]| {
            let controls = match time_s {
                t if t <= 0.0 => &begin,
                t if t < step_s => &middle,
                _ => &end,
            };
            self.rate(values, controls, turbulence)
        };
        let values = rk4::step(rate, 0.0, &joined(&motion.state, motion.distance_m), step_s);
        let (state, distance_m) = parted(&values);
        next.state = RigidState { attitude: state.attitude.normalised(), ..state };
        next.distance_m = distance_m;
        next
    }

    /// Rates of the body's state and of the way through the air.
    fn rate(
        &self,
        values: &[f64; STATES],
        controls: &Controls,
        turbulence: air::AirMotion,
    ) -> [f64; STATES] {
        let (state, distance_m) = parted(values);
        let air = self.atmosphere.at(&place(&state, &self.atmosphere, distance_m), turbulence);
        let instant = self.aircraft().instant(&state, controls, &air);
        let rates = state.rate(&instant.accelerations);
        let mut all = [0.0; STATES];
        all[..RIGID_STATES].copy_from_slice(&rates);
        all[RIGID_STATES] = instant.flow.airspeed_m_s;
        all
    }

    /// The controls at the beginning, the middle and the end of a sub-step; the actuator is left at
    /// the end.
    fn stages(
        &self,
        motion: &mut AircraftMotion,
        ([command_rad, disturbance_rad], step_s): ([f64; 2], f64),
    ) -> [Controls; 3] {
        [0.0, 0.5, 0.5].map(|share| {
            if share > 0.0 {
                self.actuator.advance(&mut motion.actuator, command_rad, share * step_s);
            }
            self.controls(self.elevator_rad(motion, disturbance_rad), motion.aileron_rad)
        })
    }

    /// True where a limit of the actuator or the travel of the elevator acts on the coming sample.
    pub(crate) fn is_limited(&self, motion: &AircraftMotion, command_rad: f64) -> bool {
        let dt_s = self.steps.step_s * f64::from(self.steps.count);
        let free_rad =
            self.plant.trim().point.elevator_rad - self.actuator.deflection_rad(&motion.actuator);
        let cut = (self.elevator_rad(motion, 0.0) - free_rad).abs() > 0.0;
        cut || self.actuator.is_limited(&motion.actuator, command_rad, dt_s)
    }

    /// Change of pitch, u, w, q, deflection and, for a lag of second order, its rate; SI.
    pub(crate) fn values(&self, motion: &AircraftMotion) -> Vec<f64> {
        let velocity = motion.state.velocity_body_m_s;
        let deflection_rad = self.actuator.deflection_rad(&motion.actuator);
        let mut values = vec![
            motion.theta_rad,
            velocity.x,
            velocity.z,
            motion.state.rates_rad_s.y,
            deflection_rad,
        ];
        values.extend((self.actuator.lag().order() == 2).then(|| motion.actuator.rate_rad_s()));
        values
    }

    /// Moves one of [`values`](Self::values).
    pub(crate) fn nudge(&self, motion: &mut AircraftMotion, place: usize, by: f64) {
        match place {
            0 => {
                let euler = motion.state.euler();
                let turned = EulerAngles { theta_rad: euler.theta_rad + by, ..euler };
                motion.state.attitude = Quaternion::from_euler(turned);
                motion.theta_rad += by;
            }
            1 => motion.state.velocity_body_m_s.x += by,
            2 => motion.state.velocity_body_m_s.z += by,
            3 => motion.state.rates_rad_s.y += by,
            _ => motion.actuator.nudge(place - 4, by),
        }
    }

    /// What is observable at a sample beyond pitch.
    pub(crate) fn sample(&self, motion: &AircraftMotion, elevator_rad: f64) -> AircraftSample {
        let (state, air) = (&motion.state, self.air(motion));
        let aileron_rad = motion.aileron_rad;
        let instant =
            self.aircraft().instant(state, &self.controls(elevator_rad, aileron_rad), &air);
        let wind_body_m_s = state.attitude.to_body(air.wind_ned_m_s);
        let felt = self.load_factors(&instant);
        AircraftSample {
            airspeed_m_s: instant.flow.airspeed_m_s,
            altitude_m: state.altitude_m(),
            alpha_rad: instant.flow.alpha_rad,
            bank_rad: state.euler().phi_rad,
            aileron_rad,
            load_factor: -felt.z,
            air_m_s: (wind_body_m_s + air.gust_body_m_s).to_array(),
            apparent_vertical_rad: apparent_vertical_rad(state, felt),
            departure: self.aircraft().model().validity().departure(&instant.flow),
        }
    }

    fn load_factors(&self, instant: &Instant) -> Vector3 {
        let aircraft = self.aircraft();
        instant.load_factors(aircraft.mass().mass_kg, aircraft.environment().gravity_m_s2)
    }
}

/// Angle between the true vertical and that of a pendulum, $\arctan(a_x / g)$ with the acceleration
/// along the heading, rad.
fn apparent_vertical_rad(state: &RigidState, load_factors: Vector3) -> f64 {
    let felt = state.attitude.to_ned(load_factors);
    let (sine, cosine) = crate::math::sin_cos(state.euler().psi_rad);
    libm::atan2(felt.x * cosine + felt.y * sine, 1.0)
}

/// States of a body and its way through the air.
const STATES: usize = RIGID_STATES + 1;
/// Most corners in a part of a period that a step ends at.
const MOST_CORNERS: usize = 64;
/// Most tries for a corner; three are usual.
const MOST_TRIES: usize = 20;

fn joined(state: &RigidState, distance_m: f64) -> [f64; STATES] {
    let mut values = [distance_m; STATES];
    values[..RIGID_STATES].copy_from_slice(&state.to_array());
    values
}

fn parted(values: &[f64; STATES]) -> (RigidState, f64) {
    let mut state = [0.0; RIGID_STATES];
    state.copy_from_slice(&values[..RIGID_STATES]);
    (RigidState::from_array(&state), values[RIGID_STATES])
}

fn place(state: &RigidState, atmosphere: &Atmosphere, distance_m: f64) -> Place {
    let [north_m, east_m, _] = state.position_ned_m.to_array();
    let height_m = state.altitude_m() - atmosphere.ground_altitude_m();
    // No wind of the family asks for the time.
    Place { time_s: 0.0, distance_m, north_m, east_m, height_m }
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
    let wind_ned_m_s = atmosphere.wind(&place(&still, atmosphere, 0.0)).wind_ned_m_s;
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
