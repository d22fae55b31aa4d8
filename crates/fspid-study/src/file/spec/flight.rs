//! The aircraft of a scenario and where it flies.

use super::{
    Choice, Default, Kind, Range, Table, Way, angle, defaulted, finite, optional, positive,
};
use crate::file::aircraft::aircraft_names;

/// Words for how an aircraft is flown.
const MODELS: [&str; 2] = ["nonlinear", "linear"];
/// Words for drag away from the reference.
const DRAG_LAWS: [&str; 2] = ["linear", "polar"];
/// Words for thrust away from the reference.
const THRUST_LAWS: [&str; 2] = ["constant", "with-speed"];
/// Words for the air.
const ATMOSPHERES: [&str; 2] = ["standard", "reference"];

/// Words for what leaving the range of the data is.
const VALIDITIES: [&str; 2] = ["fail", "warn"];

/// The standard atmosphere.
pub(super) const ALTITUDE: Range = Range::Between(-5_000.0, 84_852.0);
/// The same in feet.
pub(super) const ALTITUDE_FT: Range = Range::Between(-16_404.0, 278_385.0);

pub(super) static AIRCRAFT: Table = Table {
    doc: "An aircraft from its data, in trimmed level flight; pitch counts from the trim.",
    groups: &[&[
        optional("name", Kind::Preset(aircraft_names), "An aircraft that the program carries."),
        optional("file", Kind::Path, "An aircraft file, relative to this file."),
        optional("airspeed_m_s", positive("m/s"), "True airspeed."),
        optional("airspeed_kt", positive("kt"), "True airspeed."),
        optional("airspeed_ft_s", positive("ft/s"), "True airspeed."),
        optional(
            "altitude_m",
            Kind::Number { unit: "m", range: ALTITUDE },
            "Geopotential altitude.",
        ),
        optional(
            "altitude_ft",
            Kind::Number { unit: "ft", range: ALTITUDE_FT },
            "Geopotential altitude.",
        ),
        optional(
            "model",
            Kind::Word(&MODELS),
            "All six degrees of freedom, or the linear pitch model at the trim; if left out \"nonlinear\", for an aircraft of which only a linear model is known \"linear\".",
        ),
        defaulted(
            "drag",
            Kind::Word(&DRAG_LAWS),
            Default::Word("linear"),
            "Drag by lift: along the tangent at the reference, or the parabola with it.",
        ),
        defaulted(
            "thrust",
            Kind::Word(&THRUST_LAWS),
            Default::Word("constant"),
            "Thrust by speed: none, or by the derivative of the data.",
        ),
        defaulted(
            "atmosphere",
            Kind::Word(&ATMOSPHERES),
            Default::Word("standard"),
            "Air and gravity: standard, or everywhere those of the data's flight condition.",
        ),
        defaulted("heading_deg", angle(), Default::Number(0.0), "Clockwise from north."),
        defaulted(
            "ground_m",
            finite("m"),
            Default::Number(0.0),
            "Altitude of the ground; a nonlinear flight begins above it and ends at it, a failure.",
        ),
        defaulted(
            "validity",
            Kind::Word(&VALIDITIES),
            Default::Word("fail"),
            "What a nonlinear flight comes to that leaves the range in which the aircraft's data are trusted: a failure, or a warning.",
        ),
    ]],
    choices: &[
        one_of!("name", "file"),
        one_of!("airspeed_m_s", "airspeed_kt", "airspeed_ft_s"),
        one_of!("altitude_m", "altitude_ft"),
    ],
    variants: &[],
};
