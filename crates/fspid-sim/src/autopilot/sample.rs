//! What a trace says of an autopilot.

use super::quantity::Quantity;

/// State of the autopilot at one sample, as traces show it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AutopilotSample {
    /// Number of the mode, from 0.
    pub mode: u32,
    /// What each of [`Quantity::ALL`] is to be; where nobody holds it, what it is.
    pub targets: [f64; Quantity::ALL.len()],
    /// Height above the beam of the glide slope as it is shown, m; 0 without one.
    pub above_beam_m: f64,
    /// Behind the antenna of the glide slope: there is no beam, and the last height that was shown stays.
    pub is_behind_beam: bool,
    /// The throttle that is asked for, counted as the aircraft's data do.
    pub throttle: f64,
    /// The bank that is asked for, rad.
    pub bank_rad: f64,
    /// An engaged loop is at a limit of its own, of value or of rate, or the throttle at an end of its travel.
    pub is_limited: bool,
}

/// Names of [`AutopilotSample::values`], in order; modes count from 1.
pub const AUTOPILOT_COLUMNS: [&str; 9] = [
    "mode",
    "altitude_target_m",
    "vertical_speed_target_m_s",
    "flight_path_target_rad",
    "airspeed_target_m_s",
    "heading_target_rad",
    "above_glide_slope_m",
    "throttle_command",
    "bank_command_rad",
];

impl AutopilotSample {
    /// The numbers in the order of [`AUTOPILOT_COLUMNS`].
    #[must_use]
    pub fn values(&self) -> [f64; AUTOPILOT_COLUMNS.len()] {
        let [altitude_m, vertical_speed_m_s, path_rad, airspeed_m_s, _, heading_rad] = self.targets;
        [
            f64::from(self.mode) + 1.0,
            altitude_m,
            vertical_speed_m_s,
            path_rad,
            airspeed_m_s,
            heading_rad,
            self.above_beam_m,
            self.throttle,
            self.bank_rad,
        ]
    }
}
