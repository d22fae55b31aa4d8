//! Attitude sensors of aircraft, by name.

use fspid_numeric::units::DEGREE_RAD;

use super::SensorModel;

/// A named attitude sensor: what it does to pitch, rad, and to pitch rate, rad/s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SensorPreset {
    /// Name in files.
    pub name: &'static str,
    /// Where its numbers come from; A and a number is an assumption in `docs/paper/assumptions.md`.
    pub source: &'static str,
    /// Pitch channel.
    pub pitch: SensorModel,
    /// Pitch-rate channel.
    pub rate: SensorModel,
}

const NOTHING: SensorModel = SensorModel {
    noise_density: 0.0,
    bias: 0.0,
    drift: 0.0,
    drift_time_s: 0.0,
    scale_error: 0.0,
    resolution: 0.0,
    period_s: 0.0,
    delay_s: 0.0,
    erection_rad_s: 0.0,
};

impl SensorPreset {
    /// Every preset.
    pub const ALL: &[Self] = &[
        Self { name: "ideal", source: "by definition", pitch: NOTHING, rate: NOTHING },
        Self {
            name: "irs",
            source: "resolution and update rate: ARINC 429, label 324 and rate words; the rest: A27",
            pitch: SensorModel {
                bias: 0.05 * DEGREE_RAD,
                resolution: 0.01 * DEGREE_RAD,
                period_s: 0.025,
                delay_s: 0.02,
                ..NOTHING
            },
            rate: SensorModel {
                resolution: 0.015 * DEGREE_RAD,
                period_s: 0.01,
                delay_s: 0.01,
                ..NOTHING
            },
        },
        Self {
            name: "ahrs",
            source: "A28",
            pitch: SensorModel {
                bias: 0.35 * DEGREE_RAD,
                drift: 0.5 * DEGREE_RAD,
                drift_time_s: 60.0,
                resolution: 0.01 * DEGREE_RAD,
                period_s: 0.02,
                delay_s: 0.02,
                ..NOTHING
            },
            rate: SensorModel {
                noise_density: 0.004 * DEGREE_RAD,
                bias: 0.02 * DEGREE_RAD,
                resolution: 0.015 * DEGREE_RAD,
                period_s: 0.02,
                delay_s: 0.01,
                ..NOTHING
            },
        },
        Self {
            name: "mems",
            source: "A29",
            pitch: SensorModel {
                bias: 0.5 * DEGREE_RAD,
                drift: 1.0 * DEGREE_RAD,
                drift_time_s: 30.0,
                period_s: 0.01,
                delay_s: 0.01,
                ..NOTHING
            },
            rate: SensorModel {
                noise_density: 0.007 * DEGREE_RAD,
                bias: 0.5 * DEGREE_RAD,
                scale_error: 0.01,
                period_s: 0.005,
                delay_s: 0.005,
                ..NOTHING
            },
        },
        Self {
            name: "vertical-gyro",
            source: "A30",
            pitch: SensorModel {
                bias: 0.5 * DEGREE_RAD,
                erection_rad_s: 0.05 * DEGREE_RAD,
                ..NOTHING
            },
            rate: NOTHING,
        },
    ];

    /// The preset with that name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<&'static Self> {
        Self::ALL.iter().find(|preset| preset.name == name)
    }
}
