//! Sensors in the feedback path.

use fspid_sim::sensor::SensorPreset;

use super::{
    Default, Key, Kind, Table, defaulted, finite, not_negative, optional, plain, required,
};

fn presets() -> Vec<&'static str> {
    SensorPreset::ALL.iter().map(|preset| preset.name).collect()
}

pub(super) static SENSOR: Table = plain(
    "What measures pitch and pitch rate.",
    &[&[
        required(
            "preset",
            Kind::Preset(presets),
            "Sensors that the program carries; what the channels give replaces their values.",
        ),
        defaulted(
            "seed",
            Kind::Integer { least: 0, most: i64::MAX },
            Default::Integer(1),
            "The same seed gives the same errors, a number for each sample of the sensor: with a sampling time of its own at any period of the loop, without one new numbers of the same density at another period.",
        ),
        optional("pitch", Kind::Table(&PITCH), "Changes to the pitch channel."),
        optional("rate", Kind::Table(&RATE), "Changes to the pitch-rate channel."),
    ]],
);

/// What both channels have.
const COMMON: &[Key] = &[
    optional("drift_time_s", not_negative("s"), "Correlation time of the drift."),
    optional("scale_error_pct", finite("%"), "Scale error."),
    optional("period_s", not_negative("s"), "Sampling time of its own; 0 for that of the loop."),
    optional("delay_s", not_negative("s"), "From looking to showing."),
];

static PITCH: Table = plain(
    "Pitch channel.",
    &[
        &[
            optional("noise_deg_rt_hz", not_negative("deg/√Hz"), "One-sided noise density."),
            optional("bias_deg", not_negative("deg"), "Standard deviation of a flight's bias."),
            optional("drift_deg", not_negative("deg"), "Standard deviation of the drift."),
            optional("resolution_deg", not_negative("deg"), "Resolution; 0 for none."),
            optional(
                "erection_deg_min",
                not_negative("deg/min"),
                "How fast a vertical gyro erects; 0 for none.",
            ),
        ],
        COMMON,
    ],
);

static RATE: Table = plain(
    "Pitch-rate channel.",
    &[
        &[
            optional("noise_deg_s_rt_hz", not_negative("deg/s/√Hz"), "One-sided noise density."),
            optional("bias_deg_s", not_negative("deg/s"), "Standard deviation of a flight's bias."),
            optional("drift_deg_s", not_negative("deg/s"), "Standard deviation of the drift."),
            optional("resolution_deg_s", not_negative("deg/s"), "Resolution; 0 for none."),
        ],
        COMMON,
    ],
);
