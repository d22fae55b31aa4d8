//! Aircraft files of kind `tables`.

use fspid_daveml::flight::Gearing;

use super::aircraft::SURFACE_KEYS;
use super::word::{Word, words_of};
use super::{
    Choice, Default, Key, Kind, Table, Way, defaulted, finite, optional, plain, positive, required,
};

words_of!(Gearing { Proportional = "proportional", StevensLewis = "stevens-lewis" });

pub(super) const TABLES: &[Key] = &[
    required("tables", Kind::Table(&TABLE_FILES), "The files."),
    required("body", Kind::Table(&TABLE_BODY), "What the tables of the body do not say."),
    optional(
        "engine",
        Kind::Table(&TABLE_ENGINE),
        "What the tables of the engine do not say; with propulsion, and only then.",
    ),
    required("travel", Kind::Table(&SURFACES), "How far the surfaces go."),
    optional("air", Kind::Table(&TABLE_AIR), "Air of its source, if it is to be flown in it."),
];

static TABLE_FILES: Table = plain(
    "DAVE-ML files or those that `fspid aircraft import` wrote, relative to this file.",
    &[&[
        required("aerodynamics", Kind::Path, "Coefficients, reference area, span and chord."),
        required("inertia", Kind::Path, "Mass, moments of inertia, centre of mass."),
        optional(
            "propulsion",
            Kind::Path,
            "Thrust; without it the aircraft has no engine, and glides.",
        ),
    ]],
);

static TABLE_BODY: Table = Table {
    doc: "What the tables of the body do not say.",
    groups: &[&[
        optional("gravity_ft_s2", positive("ft/s2"), "Gravity in which it flies."),
        optional("gravity_m_s2", positive("m/s2"), "Gravity in which it flies."),
        optional(
            "centre_of_mass_pct",
            finite("%"),
            "Span along the mean chord; where the tables have it if left out.",
        ),
    ]],
    choices: &[one_of!("gravity_ft_s2", "gravity_m_s2")],
    variants: &[],
};

static TABLE_AIR: Table = Table {
    doc: "Air of the source, the same everywhere.",
    groups: &[&[
        optional("density_slug_ft3", positive("slug/ft3"), "Density."),
        optional("density_kg_m3", positive("kg/m3"), "Density."),
        optional("speed_of_sound_ft_s", positive("ft/s"), "Speed of sound."),
        optional("speed_of_sound_m_s", positive("m/s"), "Speed of sound."),
    ]],
    choices: &[
        one_of!("density_slug_ft3", "density_kg_m3"),
        one_of!("speed_of_sound_ft_s", "speed_of_sound_m_s"),
    ],
    variants: &[],
};

static TABLE_ENGINE: Table = Table {
    doc: "What the tables of the engine do not say.",
    groups: &[&[
        defaulted(
            "gearing",
            Kind::Word(Gearing::WORDS),
            Default::Word("proportional"),
            "Power by throttle: as much, or as in the F-16 model.",
        ),
        optional("angular_momentum_slug_ft2_s", finite("slug ft2/s"), "Of the rotor, forward."),
        optional("angular_momentum_kg_m2_s", finite("kg m2/s"), "Of the rotor, forward."),
    ]],
    choices: &[one_of!("angular_momentum_slug_ft2_s", "angular_momentum_kg_m2_s")],
    variants: &[],
};

static SURFACES: Table =
    plain("How far the surfaces go; the throttle goes from 0 to 1.", &[SURFACE_KEYS]);
