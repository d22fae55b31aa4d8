//! What varies of an aircraft in flight: configurations, the ground below it, Mach number, fuel.

use super::aircraft::{LATERAL_ROW_TABLE, LONGITUDINAL_ROW_TABLE};
use super::flight::CHORD_SHARE;
use crate::keyed::document::Item;
use crate::keyed::{
    Key, KeyRow, Range, Section, TEXT, Table, choosing, not_negative, number, one_of, optional,
    own, positive, required, table, tables,
};

pub(crate) const NAME: Key<str> =
    required("name", TEXT, "Name by which a flight extends it; each only once.");
pub(crate) const SOURCE: Key<str> = optional("source", TEXT, "Where the numbers come from.");
pub(crate) const ASSUMPTION: Key<str> =
    optional("assumption", TEXT, "In place of a source: that the numbers are assumed, and why so.");
pub(crate) const LIFT: Key<Section> =
    optional("lift", table(&LONGITUDINAL_ROW_TABLE), "Increment of CL, fully out.");
pub(crate) const DRAG: Key<Section> =
    optional("drag", table(&LONGITUDINAL_ROW_TABLE), "Increment of CD, fully out.");
pub(crate) const PITCH: Key<Section> =
    optional("pitch", table(&LONGITUDINAL_ROW_TABLE), "Increment of Cm, fully out.");
pub(crate) const SIDE: Key<Section> =
    optional("side", table(&LATERAL_ROW_TABLE), "Increment of CY, fully out.");
pub(crate) const ROLL: Key<Section> =
    optional("roll", table(&LATERAL_ROW_TABLE), "Increment of Cl, fully out.");
pub(crate) const YAW: Key<Section> =
    optional("yaw", table(&LATERAL_ROW_TABLE), "Increment of Cn, fully out.");
pub(crate) const MOST_AIRSPEED: [Key<f64>; 3] = [
    optional(
        "most_airspeed_m_s",
        positive("m/s"),
        "True airspeed up to which it may be out at all; faster a flight leaves the range of its model. No limit if left out.",
    ),
    optional("most_airspeed_kt", positive("kt"), "As most_airspeed_m_s."),
    optional("most_airspeed_ft_s", positive("ft/s"), "As most_airspeed_m_s."),
];

/// Increments of coefficients.
const INCREMENTS: &[KeyRow] = &[&LIFT, &DRAG, &PITCH, &SIDE, &ROLL, &YAW];

/// Most configurations of a file.
const MOST: usize = 20;

pub(super) static CONFIGURATION_TABLE: Table = choosing(
    "Something that is extended and retracted in flight; its increments count at the same angle of attack and are linear in how far it is out.",
    &[
        &[&NAME, &SOURCE, &ASSUMPTION],
        INCREMENTS,
        &[&MOST_AIRSPEED[0], &MOST_AIRSPEED[1], &MOST_AIRSPEED[2]],
    ],
    &[one_of!(SOURCE, ASSUMPTION)],
);

pub(crate) const CONFIGURATION: Key<[Section]> = optional(
    "configuration",
    tables(&CONFIGURATION_TABLE, 0, MOST),
    "Flaps, gear, speedbrake and the like of an aircraft of derivatives, beside those of its file.",
);

pub(crate) const OUT_AT_START: Key<Item> = optional(
    "configuration",
    own(names_in_words, names_schema),
    "Names of configurations that are fully out at the start, at which it is trimmed; none if left out.",
);

pub(crate) fn names_in_words() -> String {
    "a list of texts, each the name of a configuration".to_owned()
}

fn names_schema() -> serde_json::Value {
    serde_json::json!({ "type": "array", "items": { "type": "string" } })
}

pub(crate) const CHANGED: Key<str> = required("name", TEXT, "Name of the configuration.");
pub(crate) const TO: Key<f64> = required(
    "to",
    number("", Range::UpTo(1.0)),
    "How far out it then is: 0 retracted, 1 fully out.",
);
pub(crate) const AT_S: Key<f64> = required("at_s", not_negative("s"), "When it begins to move.");
pub(crate) const TAKES_S: Key<f64> =
    required("takes_s", positive("s"), "How long it moves, at a constant rate.");

static CONFIGURATION_CHANGE_TABLE: Table = choosing(
    "A configuration that is extended or retracted in flight.",
    &[&[&CHANGED, &TO, &AT_S, &TAKES_S]],
    &[],
);

pub(crate) const CONFIGURATION_CHANGE: Key<[Section]> = optional(
    "configuration_change",
    tables(&CONFIGURATION_CHANGE_TABLE, 0, 100),
    "Configurations that move in flight; those of one configuration in order of time.",
);

pub(crate) const WING_HEIGHT: [Key<f64>; 2] = [
    optional(
        "wing_height_m",
        not_negative("m"),
        "Height of the wing above the ground when the altitude that is flown is that of the ground.",
    ),
    optional("wing_height_ft", not_negative("ft"), "As wing_height_m."),
];
pub(crate) const INDUCED_DRAG_FACTOR: Key<f64> = optional(
    "induced_drag_factor",
    positive(""),
    "k of CD = CD0 + k CL²; that of the derivatives' own tangent if left out.",
);

static GROUND_EFFECT_TABLE: Table = choosing(
    "The ground below the wing: less drag due to lift below one span (McCormick).",
    &[&[&WING_HEIGHT[0], &WING_HEIGHT[1], &INDUCED_DRAG_FACTOR]],
    &[one_of!(WING_HEIGHT[0], WING_HEIGHT[1])],
);

pub(crate) const GROUND_EFFECT: Key<Section> = optional(
    "ground_effect",
    table(&GROUND_EFFECT_TABLE),
    "What the ground does to an aircraft of derivatives, in place of what its file says; without this table there and here nothing.",
);

pub(crate) const ROW_MACH: Key<f64> = required("mach", positive(""), "Mach number.");

static MACH_ROW_TABLE: Table = choosing(
    "Increments at a Mach number, beside the coefficients of the flight condition.",
    &[&[&ROW_MACH], INCREMENTS],
    &[],
);

pub(crate) const MACH_ROWS: Key<[Section]> = optional(
    "mach_row",
    tables(&MACH_ROW_TABLE, 2, 100),
    "Increments over Mach number in rising order, straight lines between them; the derivatives are trusted from the first row to the last.",
);

pub(crate) const ON_BOARD: [Key<f64>; 2] = [
    optional(
        "on_board_kg",
        positive("kg"),
        "Fuel at the start; the mass that flies then has it in it.",
    ),
    optional("on_board_lb", positive("lb"), "As on_board_kg."),
];
pub(crate) const FLOW: [Key<f64>; 2] = [
    optional("flow_kg_s", positive("kg/s"), "Fuel that is burnt, the same all the time."),
    optional("flow_lb_h", positive("lb/h"), "As flow_kg_s."),
];
pub(crate) const SPECIFIC: [Key<f64>; 2] = [
    optional(
        "specific_kg_n_s",
        positive("kg/(N s)"),
        "Fuel that is burnt for each newton of thrust.",
    ),
    optional("specific_lb_lbf_h", positive("lb/(lbf h)"), "As specific_kg_n_s."),
];
pub(crate) const TANK_MAC: Key<f64> = optional(
    "tank_mac",
    CHORD_SHARE,
    "Tank behind the leading edge of the mean chord, as a share of it; at the centre of gravity if left out.",
);

static FUEL_TABLE: Table = choosing(
    "Fuel that is burnt, so that mass, centre of gravity and inertia change; without fuel there is no thrust.",
    &[&[&ON_BOARD[0], &ON_BOARD[1], &FLOW[0], &FLOW[1], &SPECIFIC[0], &SPECIFIC[1], &TANK_MAC]],
    &[one_of!(ON_BOARD[0], ON_BOARD[1]), one_of!(FLOW[0], FLOW[1], SPECIFIC[0], SPECIFIC[1])],
);

pub(crate) const FUEL: Key<Section> = optional(
    "fuel",
    table(&FUEL_TABLE),
    "Fuel of a nonlinear aircraft of derivatives; without this table none is burnt.",
);

/// What an aircraft file says of it.
pub(super) const OF_FILES: &[KeyRow] = &[&FILE_CONFIGURATION, &FILE_GROUND_EFFECT, &MACH_ROWS];

pub(crate) const FILE_CONFIGURATION: Key<[Section]> = optional(
    "configuration",
    tables(&CONFIGURATION_TABLE, 0, MOST),
    "Flaps, gear, speedbrake and the like.",
);
pub(crate) const FILE_GROUND_EFFECT: Key<Section> = optional(
    "ground_effect",
    table(&GROUND_EFFECT_TABLE),
    "What the ground does; nothing if left out.",
);
