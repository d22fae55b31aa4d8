//! The aircraft of a scenario and where it flies.

use fspid_aircraft::aerodynamics::derivatives::{DragLaw, ThrustLaw};

use super::word::{Word, words, words_of};
use super::{
    Choice, Default, Key, Kind, Range, Table, Way, angle, defaulted, finite, optional, positive,
};
use crate::file::aircraft::aircraft_names;

words! {
    /// How an aircraft is flown.
    ModelWord { Nonlinear = "nonlinear", Linear = "linear" }
}

words! {
    /// Whose air and gravity.
    AtmosphereWord { Standard = "standard", Reference = "reference" }
}

words_of!(DragLaw { Linear = "linear", Polar = "polar" });
words_of!(ThrustLaw { Constant = "constant", WithSpeed = "with-speed" });

words! {
    /// What leaving the range of the data comes to.
    ValidityWord { Fail = "fail", Warn = "warn" }
}

/// The standard atmosphere.
pub(super) const ALTITUDE: Range = Range::Between(-5_000.0, 84_852.0);
/// The same in feet.
pub(super) const ALTITUDE_FT: Range = Range::Between(-16_404.0, 278_385.0);

/// A centre of gravity along the mean chord.
pub(super) const CG_MAC: Kind = Kind::Number { unit: "", range: Range::Between(-1.0, 2.0) };

/// How the aircraft is loaded; what is left out is that of its data.
const LOADING: &[Key] = &[
    optional(
        "mass_kg",
        positive("kg"),
        "Mass that flies; the wing stays that of the data. If left out, that of the data.",
    ),
    optional(
        "cg_mac",
        CG_MAC,
        "Centre of gravity behind the leading edge of the mean chord, as a share of it; moments of the derivatives follow. If left out, that of the data.",
    ),
    optional(
        "ix_kg_m2",
        positive("kg m2"),
        "Moment of inertia about the forward axis of the fuselage; if left out, that of the data, whatever the mass.",
    ),
    optional("ix_slug_ft2", positive("slug ft2"), "As ix_kg_m2."),
    optional(
        "ix_gyration_m",
        positive("m"),
        "Radius of gyration in place of ix_kg_m2: the moment is mass times its square.",
    ),
    optional("iy_kg_m2", positive("kg m2"), "Moment of inertia about the right axis; as ix_kg_m2."),
    optional("iy_slug_ft2", positive("slug ft2"), "As iy_kg_m2."),
    optional("iy_gyration_m", positive("m"), "Radius of gyration in place of iy_kg_m2."),
    optional(
        "iz_kg_m2",
        positive("kg m2"),
        "Moment of inertia about the downward axis of the fuselage; as ix_kg_m2.",
    ),
    optional("iz_slug_ft2", positive("slug ft2"), "As iz_kg_m2."),
    optional("iz_gyration_m", positive("m"), "Radius of gyration in place of iz_kg_m2."),
    optional("ixz_kg_m2", finite("kg m2"), "Product of inertia; if left out, that of the data."),
    optional("ixz_slug_ft2", finite("slug ft2"), "As ixz_kg_m2."),
];

pub(super) static AIRCRAFT: Table = Table {
    doc: "An aircraft from its data, in trimmed straight flight; pitch counts from the trim.",
    groups: &[
        &[
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
                Kind::Word(ModelWord::WORDS),
                "All six degrees of freedom, or the linear pitch model at the trim; if left out \"nonlinear\", for an aircraft of which only a linear model is known \"linear\".",
            ),
            defaulted(
                "drag",
                Kind::Word(DragLaw::WORDS),
                Default::Word("linear"),
                "Drag by lift: along the tangent at the reference, or the parabola with it.",
            ),
            defaulted(
                "thrust",
                Kind::Word(ThrustLaw::WORDS),
                Default::Word("constant"),
                "Thrust by speed: none, or by the derivative of the data.",
            ),
            defaulted(
                "atmosphere",
                Kind::Word(AtmosphereWord::WORDS),
                Default::Word("standard"),
                "Air and gravity: the standard atmosphere with standard gravity (with that of its file for an aircraft of tables), or everywhere those of the data's flight condition.",
            ),
            optional(
                "climb_angle_deg",
                Kind::Number { unit: "deg", range: Range::Between(-89.0, 89.0) },
                "Angle of the flight path over the horizon at which it is trimmed, climbing positive; level if left out, and in its glide an aircraft without an engine.",
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
                Kind::Word(ValidityWord::WORDS),
                Default::Word("fail"),
                "What a nonlinear flight comes to that leaves the range in which the aircraft's data are trusted: a failure, or a warning.",
            ),
        ],
        LOADING,
    ],
    choices: &[
        one_of!("name", "file"),
        one_of!("airspeed_m_s", "airspeed_kt", "airspeed_ft_s"),
        one_of!("altitude_m", "altitude_ft"),
    ],
    variants: &[],
};
