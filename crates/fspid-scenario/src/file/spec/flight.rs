//! The aircraft of a scenario and where it flies.

use super::angle;
use super::configuration::OUT_AT_START;
use crate::keyed::word::{words, words_of};
use crate::keyed::{
    FILE_PATH, Key, KeyRow, KindOf, Range, Table, carried, choosing, defaulted, finite, number,
    one_of, optional, positive, word,
};
use fspid_aircraft::aerodynamics::derivatives::{DragLaw, ThrustLaw};

use crate::carried::aircraft_names;

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
pub(super) const ALTITUDES: Range = Range::Between(-5_000.0, 84_852.0);
/// The same in feet.
pub(super) const ALTITUDES_FT: Range = Range::Between(-16_404.0, 278_385.0);

/// A centre of gravity along the mean chord.
pub(super) const CHORD_SHARE: KindOf<f64> = number("", Range::Between(-1.0, 2.0));

pub(crate) const MASS_KG: Key<f64> = optional(
    "mass_kg",
    positive("kg"),
    "Mass that flies; the wing stays that of the data. If left out, that of the data.",
);
pub(crate) const CG_MAC: Key<f64> = optional(
    "cg_mac",
    CHORD_SHARE,
    "Centre of gravity behind the leading edge of the mean chord, as a share of it; moments of the derivatives follow. If left out, that of the data.",
);
pub(crate) const IX: [Key<f64>; 2] = [
    optional(
        "ix_kg_m2",
        positive("kg m2"),
        "Moment of inertia about the forward axis of the fuselage; if left out, that of the data, whatever the mass.",
    ),
    optional("ix_slug_ft2", positive("slug ft2"), "As ix_kg_m2."),
];
pub(crate) const IX_GYRATION_M: Key<f64> = optional(
    "ix_gyration_m",
    positive("m"),
    "Radius of gyration in place of ix_kg_m2: the moment is mass times its square.",
);
pub(crate) const IY: [Key<f64>; 2] = [
    optional("iy_kg_m2", positive("kg m2"), "Moment of inertia about the right axis; as ix_kg_m2."),
    optional("iy_slug_ft2", positive("slug ft2"), "As iy_kg_m2."),
];
pub(crate) const IY_GYRATION_M: Key<f64> =
    optional("iy_gyration_m", positive("m"), "Radius of gyration in place of iy_kg_m2.");
pub(crate) const IZ: [Key<f64>; 2] = [
    optional(
        "iz_kg_m2",
        positive("kg m2"),
        "Moment of inertia about the downward axis of the fuselage; as ix_kg_m2.",
    ),
    optional("iz_slug_ft2", positive("slug ft2"), "As iz_kg_m2."),
];
pub(crate) const IZ_GYRATION_M: Key<f64> =
    optional("iz_gyration_m", positive("m"), "Radius of gyration in place of iz_kg_m2.");
pub(crate) const IXZ: [Key<f64>; 2] = [
    optional("ixz_kg_m2", finite("kg m2"), "Product of inertia; if left out, that of the data."),
    optional("ixz_slug_ft2", finite("slug ft2"), "As ixz_kg_m2."),
];

/// How the aircraft is loaded; what is left out is that of its data.
pub(crate) const LOADING: &[KeyRow] = &[
    &MASS_KG,
    &CG_MAC,
    &IX[0],
    &IX[1],
    &IX_GYRATION_M,
    &IY[0],
    &IY[1],
    &IY_GYRATION_M,
    &IZ[0],
    &IZ[1],
    &IZ_GYRATION_M,
    &IXZ[0],
    &IXZ[1],
];

pub(crate) const NAME: Key<str> =
    optional("name", carried(aircraft_names), "An aircraft that the program carries.");
pub(crate) const FILE: Key<str> =
    optional("file", FILE_PATH, "An aircraft file, relative to this file.");
pub(crate) const AIRSPEED: [Key<f64>; 3] = [
    optional("airspeed_m_s", positive("m/s"), "True airspeed."),
    optional("airspeed_kt", positive("kt"), "True airspeed."),
    optional("airspeed_ft_s", positive("ft/s"), "True airspeed."),
];
pub(crate) const ALTITUDE: [Key<f64>; 2] = [
    optional("altitude_m", number("m", ALTITUDES), "Geopotential altitude."),
    optional("altitude_ft", number("ft", ALTITUDES_FT), "Geopotential altitude."),
];
pub(crate) const MODEL: Key<ModelWord> = optional(
    "model",
    word(),
    "All six degrees of freedom, or the linear pitch model at the trim; if left out \"nonlinear\", for an aircraft of which only a linear model is known \"linear\".",
);
pub(crate) const DRAG: Key<DragLaw> = defaulted(
    "drag",
    word(),
    DragLaw::Linear,
    "Drag by lift: along the tangent at the reference, or the parabola with it.",
);
pub(crate) const THRUST: Key<ThrustLaw> = defaulted(
    "thrust",
    word(),
    ThrustLaw::Constant,
    "Thrust by speed: none, or by the derivative of the data.",
);
pub(crate) const ATMOSPHERE: Key<AtmosphereWord> = defaulted(
    "atmosphere",
    word(),
    AtmosphereWord::Standard,
    "Air and gravity: the standard atmosphere with standard gravity (with that of its file for an aircraft of tables), or everywhere those of the data's flight condition.",
);
pub(crate) const CLIMB_ANGLE_DEG: Key<f64> = optional(
    "climb_angle_deg",
    number("deg", Range::Between(-89.0, 89.0)),
    "Angle of the flight path over the horizon at which it is trimmed, climbing positive; level if left out, and in its glide an aircraft without an engine.",
);
pub(crate) const HEADING_DEG: Key<f64> =
    defaulted("heading_deg", angle(), 0.0, "Clockwise from north.");
pub(crate) const GROUND_M: Key<f64> = defaulted(
    "ground_m",
    finite("m"),
    0.0,
    "Altitude of the ground; a nonlinear flight begins above it and ends at it, a failure.",
);
pub(crate) const VALIDITY: Key<ValidityWord> = defaulted(
    "validity",
    word(),
    ValidityWord::Fail,
    "What a nonlinear flight comes to that leaves the range in which the aircraft's data are trusted: a failure, or a warning.",
);

pub(super) static AIRCRAFT_TABLE: Table = choosing(
    "An aircraft from its data, in trimmed straight flight; pitch counts from the trim.",
    &[
        &[&NAME, &FILE, &AIRSPEED[0], &AIRSPEED[1], &AIRSPEED[2], &ALTITUDE[0]],
        &[&ALTITUDE[1], &MODEL, &DRAG, &THRUST, &ATMOSPHERE, &CLIMB_ANGLE_DEG],
        &[&HEADING_DEG, &GROUND_M, &VALIDITY, &OUT_AT_START],
        LOADING,
    ],
    &[
        one_of!(NAME, FILE),
        one_of!(AIRSPEED[0], AIRSPEED[1], AIRSPEED[2]),
        one_of!(ALTITUDE[0], ALTITUDE[1]),
    ],
);
