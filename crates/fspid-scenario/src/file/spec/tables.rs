//! Aircraft files of kind `tables`.

use crate::keyed::word::words_of;
use crate::keyed::{
    FILE_PATH, Key, KeyRow, Section, Table, choosing, defaulted, finite, one_of, optional, plain,
    positive, required, table, word,
};
use fspid_aircraft::Gearing;

use super::aircraft::SURFACE_KEYS;

words_of!(Gearing { Proportional = "proportional", StevensLewis = "stevens-lewis" });

pub(crate) const TABLES: Key<Section> = required("tables", table(&TABLE_FILES_TABLE), "The files.");
pub(crate) const BODY: Key<Section> =
    required("body", table(&TABLE_BODY_TABLE), "What the tables of the body do not say.");
pub(crate) const ENGINE: Key<Section> = optional(
    "engine",
    table(&TABLE_ENGINE_TABLE),
    "What the tables of the engine do not say; with propulsion, and only then.",
);
pub(crate) const TRAVEL: Key<Section> =
    required("travel", table(&SURFACES_TABLE), "How far the surfaces go.");
pub(crate) const AIR: Key<Section> =
    optional("air", table(&TABLE_AIR_TABLE), "Air of its source, if it is to be flown in it.");

pub(super) const OF_TABLES: &[KeyRow] = &[&TABLES, &BODY, &ENGINE, &TRAVEL, &AIR];

pub(crate) const AERODYNAMICS: Key<str> =
    required("aerodynamics", FILE_PATH, "Coefficients, reference area, span and chord.");
pub(crate) const INERTIA: Key<str> =
    required("inertia", FILE_PATH, "Mass, moments of inertia, centre of mass.");
pub(crate) const PROPULSION: Key<str> =
    optional("propulsion", FILE_PATH, "Thrust; without it the aircraft has no engine, and glides.");

static TABLE_FILES_TABLE: Table = plain(
    "DAVE-ML files or those that `fspid aircraft import` wrote, relative to this file.",
    &[&[&AERODYNAMICS, &INERTIA, &PROPULSION]],
);

pub(crate) const GRAVITY: [Key<f64>; 2] = [
    optional("gravity_ft_s2", positive("ft/s2"), "Gravity in which it flies."),
    optional("gravity_m_s2", positive("m/s2"), "Gravity in which it flies."),
];
pub(crate) const CENTRE_OF_MASS_PCT: Key<f64> = optional(
    "centre_of_mass_pct",
    finite("%"),
    "Span along the mean chord; where the tables have it if left out.",
);

static TABLE_BODY_TABLE: Table = choosing(
    "What the tables of the body do not say.",
    &[&[&GRAVITY[0], &GRAVITY[1], &CENTRE_OF_MASS_PCT]],
    &[one_of!(GRAVITY[0], GRAVITY[1])],
);

pub(crate) const DENSITY: [Key<f64>; 2] = [
    optional("density_slug_ft3", positive("slug/ft3"), "Density."),
    optional("density_kg_m3", positive("kg/m3"), "Density."),
];
pub(crate) const SPEED_OF_SOUND: [Key<f64>; 2] = [
    optional("speed_of_sound_ft_s", positive("ft/s"), "Speed of sound."),
    optional("speed_of_sound_m_s", positive("m/s"), "Speed of sound."),
];

static TABLE_AIR_TABLE: Table = choosing(
    "Air of the source, the same everywhere.",
    &[&[&DENSITY[0], &DENSITY[1], &SPEED_OF_SOUND[0], &SPEED_OF_SOUND[1]]],
    &[one_of!(DENSITY[0], DENSITY[1]), one_of!(SPEED_OF_SOUND[0], SPEED_OF_SOUND[1])],
);

pub(crate) const GEARING: Key<Gearing> = defaulted(
    "gearing",
    word(),
    Gearing::Proportional,
    "Power by throttle: as much, or as in the F-16 model.",
);
pub(crate) const ANGULAR_MOMENTUM: [Key<f64>; 2] = [
    optional("angular_momentum_slug_ft2_s", finite("slug ft2/s"), "Of the rotor, forward."),
    optional("angular_momentum_kg_m2_s", finite("kg m2/s"), "Of the rotor, forward."),
];

static TABLE_ENGINE_TABLE: Table = choosing(
    "What the tables of the engine do not say.",
    &[&[&GEARING, &ANGULAR_MOMENTUM[0], &ANGULAR_MOMENTUM[1]]],
    &[one_of!(ANGULAR_MOMENTUM[0], ANGULAR_MOMENTUM[1])],
);

static SURFACES_TABLE: Table =
    plain("How far the surfaces go; the throttle goes from 0 to 1.", &[SURFACE_KEYS]);
