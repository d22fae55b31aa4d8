//! Another simulator in the loop: our actuator moves its elevator, and its pitch is what is measured.

use fspid_aircraft::atmosphere::STANDARD_GRAVITY_M_S2;

use crate::actuator::{Actuator, ActuatorState};
use crate::aircraft::{AircraftSample, MOST_STEP_S};
use crate::error::SimError;
use crate::math::sin_cos;
use crate::timing::Timing;

use super::{ExternalPlant, PlantLoss, PlantSample, Simulates};

/// The flight of an external plant behind an actuator.
#[derive(Clone, Debug)]
pub(crate) struct ExternalFlight {
    plant: ExternalPlant,
    actuator: Actuator,
    /// Steps of the simulator a sample, and their length, s.
    steps: u32,
    step_s: f64,
}

/// Where it is.
#[derive(Debug)]
pub(crate) struct ExternalMotion {
    /// None once it is lost, and in a copy.
    flying: Result<Box<dyn Simulates>, PlantLoss>,
    start: PlantSample,
    now: PlantSample,
    actuator: ActuatorState,
    shows_aircraft: bool,
}

impl Clone for ExternalMotion {
    /// What is there, without the process, which cannot be copied.
    fn clone(&self) -> Self {
        let flying = match &self.flying {
            Ok(_) => Err(PlantLoss::Copied),
            Err(loss) => Err(*loss),
        };
        let Self { start, now, actuator, shows_aircraft, .. } = *self;
        Self { flying, start, now, actuator, shows_aircraft }
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
            air_m_s: now.air_m_s,
            position_m: now.position_m,
            heading_rad: within_half_a_turn(now.heading_rad),
            attitude_rad: now.theta_rad,
            sideslip_rad: now.sideslip_rad,
            roll_yaw_rad_s: now.roll_yaw_rad_s,
            throttle: now.throttle,
            flight_path_rad: libm::atan2(now.climb_m_s, ground_speed_m_s),
            climb_m_s: now.climb_m_s,
            ground_speed_m_s,
            // Nobody asks: an autopilot of ours flies aircraft of ours.
            path_acceleration_m_s2: 0.0,
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

/// An angle within ±π.
fn within_half_a_turn(angle_rad: f64) -> f64 {
    use std::f64::consts::TAU;
    angle_rad - TAU * (angle_rad / TAU).round()
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
    pub(crate) fn new(plant: &ExternalPlant, actuator: Actuator, timing: Timing) -> Self {
        // A millionth more than whole is rounding.
        let count = (timing.dt_s() / MOST_STEP_S - 1e-6).ceil().max(1.0);
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "at least 1, and the cast saturates"
        )]
        let steps = count as u32;
        Self { plant: plant.clone(), actuator, steps, step_s: timing.dt_s() / count }
    }

    /// True where a sample says more than pitch.
    pub(crate) fn shows_aircraft(&self) -> bool {
        self.plant.simulator.shows_aircraft()
    }

    /// Starts the simulator.
    pub(crate) fn start(&self) -> Result<ExternalMotion, SimError> {
        let flying = self.plant.start(self.step_s, self.steps)?;
        let start = flying.start();
        Ok(ExternalMotion {
            flying: Ok(flying),
            start,
            now: start,
            actuator: ActuatorState::default(),
            shows_aircraft: self.shows_aircraft(),
        })
    }

    /// Moves an actuator without lag to its command at once; another stays where it is.
    pub(crate) fn settle(&self, motion: &mut ExternalMotion, command_rad: f64) {
        self.actuator.settle(&mut motion.actuator, command_rad);
    }

    /// One sample period with command and disturbance held. The elevator of each step is that of its middle.
    pub(crate) fn advance(
        &self,
        motion: &mut ExternalMotion,
        command_rad: f64,
        disturbance_rad: f64,
    ) {
        let trim_rad = motion.start.elevator_rad;
        let actuator = &mut motion.actuator;
        let elevators_rad: Vec<f64> = (0..self.steps)
            .map(|_| {
                self.actuator.advance(actuator, command_rad, 0.5 * self.step_s);
                let deflection_rad = self.actuator.deflection_rad(actuator);
                self.actuator.advance(actuator, command_rad, 0.5 * self.step_s);
                // Trailing edge down is nose down.
                trim_rad - (deflection_rad + disturbance_rad)
            })
            .collect();
        let Ok(flying) = &mut motion.flying else { return };
        match flying.advance(&elevators_rad) {
            Ok(now) => motion.now = now,
            Err(loss) => motion.flying = Err(loss),
        }
    }
}
