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
//! # What changes
//! Of an aircraft whose forces [vary](Forces::Varied) configurations move along straight lines over time, fuel is a state
//! of the integration, and the ground acts below one span. A step ends where a configuration begins or ceases to move,
//! where the ground begins to act, and where the tank runs dry; with an empty tank there is no thrust. Where a row of a
//! table over Mach number is passed it does not end, and its error there is of the second order.
//!
//! # Not here
//! Plant changes. Without an [`autopilot`](crate::autopilot) the throttle does not move.

mod atmosphere;
mod changing;
mod column;
mod corner;
mod flight;
mod forces;
mod leveller;
mod linear;
mod standing;

pub(crate) use atmosphere::Atmosphere;
pub use changing::{
    Changing, ConfigurationChange, DEPLOYMENT_COLUMNS, Deployment, Fuel, MOST_CONFIGURATIONS, Shown,
};
pub use column::{AIRCRAFT_COLUMNS, AircraftSample};
pub(crate) use flight::{
    AircraftAbreast, AircraftFlight, AircraftMotion, NotAbreast, Wing, step_s,
};
pub use forces::Forces;
pub use leveller::{LEVELLING_TIME_S, WingLeveller, YawDamper};
pub use linear::AfterBurning;
pub(crate) use standing::{Change, Standing, pitch_rad};

use fspid_aircraft::{Aircraft, Spool, Trim, TrimTarget};

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
    /// What controllers count from: the trim of the start of the flight, wherever it has led since.
    counted_from: Trim,
    ground_altitude_m: Option<f64>,
    spool: Spool,
    lateral: Lateral,
    changing: Changing,
}

/// How the lateral motion is looked after.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lateral {
    /// How fast the wing leveller comes to its bank, s.
    pub bank_time_s: f64,
    /// Damping ratio that the yaw damper brings the Dutch roll near; 0 for no damper.
    pub yaw_damping: f64,
}

impl Default for Lateral {
    /// The wing leveller alone.
    fn default() -> Self {
        Self { bank_time_s: LEVELLING_TIME_S, yaw_damping: 0.0 }
    }
}

impl AircraftPlant {
    /// The aircraft in straight flight at the target's speed and altitude.
    ///
    /// # Errors
    /// [`SimError::Trim`] where there is no such flight, with what stands in its way.
    pub fn trimmed(aircraft: Aircraft<Forces>, target: TrimTarget) -> Result<Self, SimError> {
        let trim = aircraft.trim(target).map_err(|failure| SimError::Trim(Box::new(failure)))?;
        let changing = aircraft.model().varied().map(Changing::none_of).unwrap_or_default();
        Ok(Self {
            aircraft,
            trim,
            counted_from: trim,
            changing,
            ground_altitude_m: None,
            spool: Spool::Instant,
            lateral: Lateral::default(),
        })
    }

    /// The same above a ground, at which a flight ends.
    ///
    /// # Errors
    /// [`SimError::Number`] for a ground that is not below the aircraft.
    pub fn above_ground(self, altitude_m: f64) -> Result<Self, SimError> {
        positive("height above the ground, m", self.trim.target.altitude_m - altitude_m)?;
        Ok(Self { ground_altitude_m: Some(altitude_m), ..self })
    }

    /// The same with what changes in flight; it is for the model of this aircraft.
    #[must_use]
    pub fn changing_so(self, changing: Changing) -> Self {
        Self { changing, ..self }
    }

    /// What changes in flight.
    #[must_use]
    pub fn changing(&self) -> &Changing {
        &self.changing
    }

    /// Times at which something begins or ceases to change, s.
    fn corners_s(&self) -> Vec<f64> {
        self.changing.corners_s()
    }

    /// Altitude below which the ground acts, m, if it does.
    fn corner_altitude_m(&self) -> Option<f64> {
        let effect = self.aircraft.model().varied()?.effects().ground?;
        Some(effect.upper_altitude_m())
    }

    /// The same with an engine whose power follows the throttle so; only an autopilot moves a throttle.
    ///
    /// # Errors
    /// [`SimError::Number`] for a time constant that is not finite and positive.
    pub fn with_engine(self, spool: Spool) -> Result<Self, SimError> {
        if let Spool::FirstOrder { time_constant_s } = spool {
            positive("time constant of the engine, s", time_constant_s)?;
        }
        Ok(Self { spool, ..self })
    }

    /// The same with its lateral motion looked after so.
    ///
    /// # Errors
    /// [`SimError::Number`] for a time that is not finite and positive, and for a damping ratio that is not from 0 to 1.
    pub fn with_lateral(self, lateral: Lateral) -> Result<Self, SimError> {
        positive("time to a bank, s", lateral.bank_time_s)?;
        let (found, allowed) = (lateral.yaw_damping, "0 to 1");
        if !(0.0..=1.0).contains(&found) {
            return Err(SimError::Number {
                what: "damping ratio of the yaw damper",
                found,
                allowed,
            });
        }
        Ok(Self { lateral, ..self })
    }

    /// How the lateral motion is looked after.
    #[must_use]
    pub fn lateral(&self) -> Lateral {
        self.lateral
    }

    /// How the engine's power follows the throttle.
    #[must_use]
    pub fn spool(&self) -> Spool {
        self.spool
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
