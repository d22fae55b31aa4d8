//! Another simulator in the loop: our actuator moves its elevator, and its pitch is what is measured.

use fspid_aircraft::Range;
use fspid_aircraft::atmosphere::STANDARD_GRAVITY_M_S2;

use crate::actuated::Held;
use crate::actuator::{Actuator, ActuatorState};
use crate::aircraft::{AircraftSample, MOST_STEP_S};
use crate::autopilot::{Cut, Throttle};
use crate::error::SimError;
use crate::math::{sin_cos, turned_towards};
use crate::surroundings::Weather;
use crate::timing::Timing;

use super::air::{AirState, MovingAir};
use super::{
    Beginning, ExternalPlant, PlantLoss, PlantSample, SampleInput, Simulates, Simulator, StepInput,
};

/// How far a throttle goes.
const THROTTLE_TRAVEL: Range = Range { min: 0.0, max: 1.0 };

/// The flight of an external plant behind an actuator.
#[derive(Clone, Debug)]
pub(crate) struct ExternalFlight {
    plant: ExternalPlant,
    actuator: Actuator,
    /// Steps of the simulator a sample, and their length, s.
    steps: u32,
    step_s: f64,
    air: Option<MovingAir>,
    moves_throttle: bool,
}

/// What is around the plant beside its actuator.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Around<'a> {
    /// Air of ours.
    pub(crate) weather: Option<&'a Weather>,
    /// Whether an autopilot moves the throttle.
    pub(crate) moves_throttle: bool,
}

/// Where it is.
#[derive(Debug)]
pub(crate) struct ExternalMotion {
    /// None once it is lost, and in a copy.
    flying: Result<Box<dyn Simulates>, PlantLoss>,
    start: PlantSample,
    now: PlantSample,
    actuator: ActuatorState,
    air: Option<AirState>,
    /// What enters each step of a sample.
    inputs: Vec<StepInput>,
    shows_aircraft: bool,
}

impl Clone for ExternalMotion {
    /// What is there, without the process, which cannot be copied.
    fn clone(&self) -> Self {
        let flying = match &self.flying {
            Ok(_) => Err(PlantLoss::Copied),
            Err(loss) => Err(*loss),
        };
        let (air, inputs) = (self.air.clone(), self.inputs.clone());
        let Self { start, now, actuator, shows_aircraft, .. } = *self;
        Self { flying, start, now, actuator, air, inputs, shows_aircraft }
    }
}

impl ExternalMotion {
    /// Change of pitch from the trim, rad.
    pub(crate) fn theta_rad(&self) -> f64 {
        self.now.theta_rad - self.start.theta_rad
    }

    pub(crate) fn rate_rad_s(&self) -> f64 {
        self.now.q_rad_s
    }

    /// How it was lost, if it was.
    pub(crate) fn loss(&self) -> Option<PlantLoss> {
        self.flying.as_ref().err().copied()
    }

    /// The throttle that its trim asks for, and how far it goes; none of a simulator that shows none.
    pub(crate) fn throttle(&self) -> Option<Throttle> {
        let trim = self.start.throttle_command;
        self.shows_aircraft.then_some(Throttle { trim, travel: THROTTLE_TRAVEL })
    }

    /// True for an aircraft on its back.
    pub(crate) fn is_lost(&self) -> bool {
        let ((_, cos_bank), (_, cos_theta)) =
            (sin_cos(self.now.bank_rad), sin_cos(self.now.theta_rad));
        // Written so that NaN is lost.
        !(cos_bank * cos_theta > 0.0)
    }

    pub(crate) fn is_at_ground(&self) -> bool {
        self.shows_aircraft && (self.now.is_on_ground || self.now.height_m <= 0.0)
    }

    /// The elevator as the simulator has it, rad.
    pub(crate) fn elevator_rad(&self) -> f64 {
        self.now.elevator_rad
    }

    /// What it shows beyond pitch, if it does.
    pub(crate) fn sample(&self) -> Option<AircraftSample> {
        let now = &self.now;
        let [over_north_m_s, over_east_m_s] = now.over_ground_m_s;
        let ground_speed_m_s = libm::hypot(over_north_m_s, over_east_m_s);
        self.shows_aircraft.then(|| AircraftSample {
            airspeed_m_s: now.airspeed_m_s,
            // No control law of a file flies there, which alone asks.
            equivalent_airspeed_m_s: f64::NAN,
            mach: f64::NAN,
            altitude_m: now.altitude_m,
            alpha_rad: now.alpha_rad,
            bank_rad: now.bank_rad,
            aileron_rad: now.aileron_rad,
            load_factor: -now.felt[2],
            load_factors: now.felt,
            air_m_s: now.air_m_s,
            position_m: now.position_m,
            heading_rad: turned_towards(0.0, now.heading_rad),
            attitude_rad: now.theta_rad,
            sideslip_rad: now.sideslip_rad,
            roll_yaw_rad_s: now.roll_yaw_rad_s,
            throttle: now.throttle,
            flight_path_rad: libm::atan2(now.climb_m_s, ground_speed_m_s),
            climb_m_s: now.climb_m_s,
            ground_speed_m_s,
            over_ground_m_s: now.over_ground_m_s,
            path_acceleration_m_s2: now.path_acceleration_m_s2,
            // Simulators tell how the air moves, and not how it turns.
            air_rad_s: [0.0; 3],
            energy_height_m: now.altitude_m
                + now.airspeed_m_s * now.airspeed_m_s / (2.0 * STANDARD_GRAVITY_M_S2),
            apparent_vertical_rad: apparent_vertical_rad(now),
            departure: None,
            shown: None,
        })
    }
}

/// Angle between the true vertical and that of a pendulum, along the heading, rad.
fn apparent_vertical_rad(sample: &PlantSample) -> f64 {
    let [x, y, z] = sample.felt;
    let ((sin_bank, cos_bank), (sin_theta, cos_theta)) =
        (sin_cos(sample.bank_rad), sin_cos(sample.theta_rad));
    let ahead = x * cos_theta + (y * sin_bank + z * cos_bank) * sin_theta;
    libm::atan2(ahead, 1.0)
}

impl ExternalFlight {
    /// Equal steps of the simulator, the longest of at most [`MOST_STEP_S`] that fit into the period.
    ///
    /// # Errors
    /// [`SimError::NoGustEntry`] for moving air around a simulator that takes none, [`SimError::Number`] for air out of its
    /// range.
    pub(crate) fn new(
        plant: &ExternalPlant,
        actuator: Actuator,
        timing: Timing,
        around: Around<'_>,
    ) -> Result<Self, SimError> {
        // A millionth more than whole is rounding.
        let count = (timing.dt_s() / MOST_STEP_S - 1e-6).ceil().max(1.0);
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "at least 1, and the cast saturates"
        )]
        let steps = count as u32;
        let step_s = timing.dt_s() / count;
        let air = match (around.weather, &plant.simulator) {
            (None, _) => None,
            (Some(weather), Simulator::Jsbsim(jsbsim)) => {
                MovingAir::new(weather, jsbsim.altitude_m, (step_s, steps))?
            }
            (Some(_), Simulator::Fmu(_)) => return Err(SimError::NoGustEntry),
        };
        let moves_throttle = around.moves_throttle;
        Ok(Self { plant: plant.clone(), actuator, steps, step_s, air, moves_throttle })
    }

    /// True where a sample says more than pitch.
    pub(crate) fn shows_aircraft(&self) -> bool {
        self.plant.simulator.shows_aircraft()
    }

    /// Starts the simulator.
    pub(crate) fn start(&self) -> Result<ExternalMotion, SimError> {
        let flying = self.plant.start(&Beginning {
            step_s: self.step_s,
            steps: self.steps,
            wind_m_s: self.air.as_ref().map(MovingAir::start_m_s),
            moves_throttle: self.moves_throttle,
        })?;
        let start = flying.start();
        Ok(ExternalMotion {
            flying: Ok(flying),
            start,
            now: start,
            actuator: ActuatorState::default(),
            air: self.air.as_ref().map(MovingAir::start),
            inputs: vec![StepInput::default(); self.steps as usize],
            shows_aircraft: self.shows_aircraft(),
        })
    }

    /// Moves an actuator without lag to its command at once; another stays where it is.
    pub(crate) fn settle(&self, motion: &mut ExternalMotion, command_rad: f64) {
        self.actuator.settle(&mut motion.actuator, command_rad);
    }

    /// Which way the command cannot be followed by our actuator; how far the simulator's elevator goes is its own.
    pub(crate) fn cut(&self, motion: &ExternalMotion, command_rad: f64) -> Cut {
        let dt_s = self.step_s * f64::from(self.steps);
        if !self.actuator.is_limited(&motion.actuator, command_rad, dt_s) {
            return Cut::Not;
        }
        Cut::towards(command_rad - self.actuator.deflection_rad(&motion.actuator))
    }

    /// One sample period with command and disturbance held. The elevator of each step is that of its middle, the air that of
    /// its end.
    pub(crate) fn advance(&self, motion: &mut ExternalMotion, command_rad: f64, held: &Held<'_>) {
        let trim_rad = motion.start.elevator_rad;
        let (actuator, now) = (&mut motion.actuator, motion.now);
        for input in &mut motion.inputs {
            self.actuator.advance(actuator, command_rad, 0.5 * self.step_s);
            let deflection_rad = self.actuator.deflection_rad(actuator);
            self.actuator.advance(actuator, command_rad, 0.5 * self.step_s);
            // Trailing edge down is nose down.
            input.elevator_rad = trim_rad - (deflection_rad + held.elevator_rad);
        }
        if let Some((air, state)) = self.air.as_ref().zip(motion.air.as_mut()) {
            air.tell(state, &now, &mut motion.inputs);
        }
        let throttle = motion.start.throttle_command + held.autopilot.throttle;
        let asked = SampleInput { throttle };
        let Ok(flying) = &mut motion.flying else { return };
        match flying.advance(&asked, &motion.inputs) {
            Ok(now) => motion.now = now,
            Err(loss) => motion.flying = Err(loss),
        }
        if let Some((air, state)) = self.air.as_ref().zip(motion.air.as_mut()) {
            air.leave(state, [&now, &motion.now]);
        }
    }
}
