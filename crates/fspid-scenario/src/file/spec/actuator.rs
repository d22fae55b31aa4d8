//! The actuator of the elevator.

use fspid_sim::actuator::Preset;

use super::{
    Default, Kind, Range, Table, defaulted, finite, not_negative, optional, plain, positive,
};

fn presets() -> Vec<&'static str> {
    Preset::ALL.iter().map(|preset| preset.name).collect()
}

/// An interval of angles.
const ANGLES: Kind = Kind::Interval { unit: "deg", range: Range::Between(-180.0, 180.0) };

pub(super) static ACTUATOR: Table = plain(
    "A servo of first order with optional limits behind a delay; what else is given makes it an \
     actuator. Angles are nose up positive.",
    &[&[
        optional(
            "preset",
            Kind::Preset(presets),
            "An actuator that the program carries; what else is given replaces its values.",
        ),
        defaulted(
            "time_constant_s",
            not_negative("s"),
            Default::Number(0.0),
            "Time constant; 0 for none, or for the lag of the preset.",
        ),
        optional(
            "natural_frequency_rad_s",
            positive("rad/s"),
            "Natural frequency of a lag of second order, with damping.",
        ),
        optional("damping", positive(""), "Damping ratio, with natural_frequency_rad_s."),
        optional(
            "position_limit_deg",
            positive("deg"),
            "The deflection is kept within plus and minus this.",
        ),
        optional("travel_deg", ANGLES, "Stops of the deflection: nose down, nose up."),
        optional(
            "rate_limit_deg_s",
            positive("deg/s"),
            "The deflection's rate is kept within plus and minus this.",
        ),
        optional(
            "deadband_deg",
            not_negative("deg"),
            "Commands up to plus and minus this do nothing; 0 if left out.",
        ),
        optional(
            "backlash_deg",
            not_negative("deg"),
            "Full width of the play between actuator and surface; 0 if left out.",
        ),
        optional("bias_deg", finite("deg"), "Error of the deflection; 0 if left out."),
        defaulted(
            "delay_samples",
            Kind::Integer { least: 0, most: 10_000 },
            Default::Integer(0),
            "How many samples the command arrives late.",
        ),
    ]],
);
