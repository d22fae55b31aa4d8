//! Sensors in the feedback path.

use crate::keyed::{
    Key, KeyRow, Section, Table, carried, defaulted, finite, not_negative, optional, plain,
    required, table, whole,
};
use fspid_sim::sensor::SensorPreset;

fn presets() -> Vec<&'static str> {
    SensorPreset::ALL.iter().map(|preset| preset.name).collect()
}

pub(crate) const PRESET: Key<str> = required(
    "preset",
    carried(presets),
    "Sensors that the program carries; what the channels give replaces their values.",
);
pub(crate) const SEED: Key<i64> = defaulted(
    "seed",
    whole(0, i64::MAX),
    1,
    "The same seed gives the same errors, a number for each sample of the sensor: with a sampling time of its own at any period of the loop, without one new numbers of the same density at another period.",
);
pub(crate) const PITCH: Key<Section> =
    optional("pitch", table(&PITCH_TABLE), "Changes to the pitch channel.");
pub(crate) const RATE: Key<Section> =
    optional("rate", table(&RATE_TABLE), "Changes to the pitch-rate channel.");

pub(super) static SENSOR_TABLE: Table =
    plain("What measures pitch and pitch rate.", &[&[&PRESET, &SEED, &PITCH, &RATE]]);

pub(crate) const DRIFT_TIME_S: Key<f64> =
    optional("drift_time_s", not_negative("s"), "Correlation time of the drift.");
pub(crate) const SCALE_ERROR_PCT: Key<f64> =
    optional("scale_error_pct", finite("%"), "Scale error.");
pub(crate) const PERIOD_S: Key<f64> =
    optional("period_s", not_negative("s"), "Sampling time of its own; 0 for that of the loop.");
pub(crate) const DELAY_S: Key<f64> =
    optional("delay_s", not_negative("s"), "From looking to showing.");

/// What both channels have.
const COMMON: &[KeyRow] = &[&DRIFT_TIME_S, &SCALE_ERROR_PCT, &PERIOD_S, &DELAY_S];

/// The keys of a channel for angles, or for rates.
pub(crate) struct Channel {
    pub(crate) noise: Key<f64>,
    pub(crate) bias: Key<f64>,
    pub(crate) drift: Key<f64>,
    pub(crate) resolution: Key<f64>,
    /// Vertical gyros alone.
    pub(crate) erection: Option<Key<f64>>,
}

pub(crate) const OF_PITCH: Channel = Channel {
    noise: NOISE_DEG_RT_HZ,
    bias: BIAS_DEG,
    drift: DRIFT_DEG,
    resolution: RESOLUTION_DEG,
    erection: Some(ERECTION_DEG_MIN),
};

pub(crate) const OF_RATE: Channel = Channel {
    noise: NOISE_DEG_S_RT_HZ,
    bias: BIAS_DEG_S,
    drift: DRIFT_DEG_S,
    resolution: RESOLUTION_DEG_S,
    erection: None,
};

pub(crate) const NOISE_DEG_RT_HZ: Key<f64> =
    optional("noise_deg_rt_hz", not_negative("deg/√Hz"), "One-sided noise density.");
pub(crate) const BIAS_DEG: Key<f64> =
    optional("bias_deg", not_negative("deg"), "Standard deviation of a flight's bias.");
pub(crate) const DRIFT_DEG: Key<f64> =
    optional("drift_deg", not_negative("deg"), "Standard deviation of the drift.");
pub(crate) const RESOLUTION_DEG: Key<f64> =
    optional("resolution_deg", not_negative("deg"), "Resolution; 0 for none.");
pub(crate) const ERECTION_DEG_MIN: Key<f64> = optional(
    "erection_deg_min",
    not_negative("deg/min"),
    "How fast a vertical gyro erects; 0 for none.",
);

static PITCH_TABLE: Table = plain(
    "Pitch channel.",
    &[&[&NOISE_DEG_RT_HZ, &BIAS_DEG, &DRIFT_DEG, &RESOLUTION_DEG, &ERECTION_DEG_MIN], COMMON],
);

pub(crate) const NOISE_DEG_S_RT_HZ: Key<f64> =
    optional("noise_deg_s_rt_hz", not_negative("deg/s/√Hz"), "One-sided noise density.");
pub(crate) const BIAS_DEG_S: Key<f64> =
    optional("bias_deg_s", not_negative("deg/s"), "Standard deviation of a flight's bias.");
pub(crate) const DRIFT_DEG_S: Key<f64> =
    optional("drift_deg_s", not_negative("deg/s"), "Standard deviation of the drift.");
pub(crate) const RESOLUTION_DEG_S: Key<f64> =
    optional("resolution_deg_s", not_negative("deg/s"), "Resolution; 0 for none.");

static RATE_TABLE: Table = plain(
    "Pitch-rate channel.",
    &[&[&NOISE_DEG_S_RT_HZ, &BIAS_DEG_S, &DRIFT_DEG_S, &RESOLUTION_DEG_S], COMMON],
);
