//! Nonlinear aircraft as plants of the loop: trimmed, then flown in six degrees of freedom.
//!
//! # What the loop sees
//! Pitch is measured as the change from the trim, so that command and metrics are those of a linear
//! plant; the command moves the elevator from where the trim has it, and the throttle stays there. The
//! deflection is kept within the travel of the aircraft's own data.
//!
//! # Between samples
//! The command and disturbances are held. The state follows by the classical method of Runge and Kutta
//! in sub-steps of at most [`MOST_STEP_S`]: in still air equal ones, the longest that fit into the
//! period; in air that moves from one time of the [grid](crate::air::GRID_S) to the next, over which
//! turbulence and the aileron of the wing leveller are held. The actuator is known in closed form and
//! stands at the beginning, the middle and the end of a sub-step where it then is; winds and gusts are
//! those of the place at each stage, and a sub-step ends where one of them is not smooth. Of the way
//! between samples the error falls with the fourth power of the sub-step.
//!
//! # Ground
//! The flight ends at the first sample at or below the ground: nobody lands here.
//!
//! # Not here
//! Plant changes, ground effect, engine lag; the throttle does not move.

mod atmosphere;
mod column;
mod corner;
mod flight;
mod forces;
mod leveller;
mod linear;

use atmosphere::Atmosphere;
pub use column::{AIRCRAFT_COLUMNS, AircraftSample};
pub(crate) use flight::{AircraftFlight, AircraftMotion};
pub use forces::Forces;
pub use leveller::{LEVELLING_TIME_S, WingLeveller};

use fspid_aircraft::{Aircraft, Trim, TrimTarget};

use crate::error::{SimError, positive};

/// Longest sub-step of the integration, s.
///
/// A mode of 10 rad/s then takes 63 steps a period, and its error is below 10⁻⁶ a period.
pub const MOST_STEP_S: f64 = 0.01;

/// An aircraft at its trim.
#[derive(Clone, Debug, PartialEq)]
pub struct AircraftPlant {
    aircraft: Aircraft<Forces>,
    trim: Trim,
    ground_altitude_m: Option<f64>,
}

impl AircraftPlant {
    /// The aircraft in straight flight at the target's speed and altitude.
    ///
    /// # Errors
    /// [`SimError::Trim`] where there is no such flight, with what stands in its way.
    pub fn trimmed(aircraft: Aircraft<Forces>, target: TrimTarget) -> Result<Self, SimError> {
        let trim = aircraft.trim(target).map_err(|failure| SimError::Trim(Box::new(failure)))?;
        Ok(Self { aircraft, trim, ground_altitude_m: None })
    }

    /// The same above a ground, at which a flight ends.
    ///
    /// # Errors
    /// [`SimError::Number`] for a ground that is not below the aircraft.
    pub fn above_ground(self, altitude_m: f64) -> Result<Self, SimError> {
        positive("height above the ground, m", self.trim.target.altitude_m - altitude_m)?;
        Ok(Self { ground_altitude_m: Some(altitude_m), ..self })
    }

    /// Altitude of the ground at which a flight ends, m; without one there is none.
    #[must_use]
    pub fn ground_altitude_m(&self) -> Option<f64> {
        self.ground_altitude_m
    }

    /// Body, forces and air.
    #[must_use]
    pub fn aircraft(&self) -> &Aircraft<Forces> {
        &self.aircraft
    }

    /// Where the flight begins.
    #[must_use]
    pub fn trim(&self) -> &Trim {
        &self.trim
    }
}
