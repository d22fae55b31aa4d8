//! An aircraft that another simulator flies.

use super::angle;
use super::flight::{ALTITUDES, ALTITUDES_FT};
use crate::keyed::word::words;
use crate::keyed::{
    FILE_PATH, Key, Range, Section, TEXT, Table, choosing, defaulted, finite, number, of_kinds,
    one_of, optional, plain, positive, required, table, tables, variant, whole, word,
};

words! {
    /// Other simulators.
    SimulatorKind { Jsbsim = "jsbsim", Fmu = "fmu" }
}

words! {
    /// Where the wheels are.
    GearWord { Up = "up", Down = "down" }
}

words! {
    /// What holds the wings.
    WingsWord { Levelled = "levelled", Free = "free" }
}

/// The version that the tests of this program fly.
pub(crate) const JSBSIM_VERSION: &str = "1.3.3";

pub(crate) const AIRCRAFT: Key<str> = required(
    "aircraft",
    TEXT,
    "Name of the aircraft, which is that of its folder, such as \"c172x\" or \"B747\".",
);
pub(crate) const FOLDER: Key<str> = optional(
    "folder",
    FILE_PATH,
    "A folder of your own with `aircraft`, and with `engine` and `systems` if it has them, relative to this file; if left out, those of JSBSim's package.",
);
pub(crate) const VERSION: Key<str> = optional(
    "version",
    TEXT,
    "The version of JSBSim that has to be there, another one is refused: another version flies another flight. If left out \"1.3.3\".",
);
pub(crate) const AIRSPEED: [Key<f64>; 3] = [
    optional("airspeed_m_s", positive("m/s"), "True airspeed."),
    optional("airspeed_kt", positive("kt"), "True airspeed."),
    optional("airspeed_ft_s", positive("ft/s"), "True airspeed."),
];
pub(crate) const CALIBRATED_KT: Key<f64> =
    optional("calibrated_kt", positive("kt"), "Calibrated airspeed.");
pub(crate) const MACH: Key<f64> = optional("mach", positive(""), "Mach number.");
pub(crate) const ALTITUDE: [Key<f64>; 2] = [
    optional("altitude_m", number("m", ALTITUDES), "Altitude above mean sea level."),
    optional("altitude_ft", number("ft", ALTITUDES_FT), "Altitude above mean sea level."),
];
pub(crate) const CLIMB_ANGLE_DEG: Key<f64> = defaulted(
    "climb_angle_deg",
    number("deg", Range::Between(-89.0, 89.0)),
    0.0,
    "Angle of the flight path over the horizon at which JSBSim trims it, climbing positive.",
);
pub(crate) const HEADING_DEG: Key<f64> =
    defaulted("heading_deg", angle(), 0.0, "Clockwise from north.");
pub(crate) const GEAR: Key<GearWord> = defaulted(
    "gear",
    word(),
    GearWord::Up,
    "Wheels that can be drawn in: where they are when it is trimmed.",
);
pub(crate) const WINGS: Key<WingsWord> = defaulted(
    "wings",
    word(),
    WingsWord::Levelled,
    "Levelled by a proportional law of bank and roll rate at the aileron's command, or free.",
);
pub(crate) const SEED: Key<i64> = defaulted(
    "seed",
    whole(0, 2_147_483_647),
    1,
    "What JSBSim's random numbers begin with: the same turbulence for the same seed.",
);
pub(crate) const PROPERTY: Key<[Section]> = optional(
    "property",
    tables(&PROPERTY_TABLE, 0, 100),
    "Properties of JSBSim that are set once the aircraft is trimmed, in this order: wind, gusts, turbulence, failures.",
);
pub(crate) const ANSWER_LIMIT_S: Key<f64> = defaulted(
    "answer_limit_s",
    number("s", Range::Between(0.001, 3600.0)),
    5.0,
    "The longest time for the answer to a sample, by the clock; a simulator that takes longer hangs.",
);

pub(crate) const NAME: Key<str> =
    required("name", TEXT, "Name of the property, such as \"atmosphere/turb-type\".");
pub(crate) const VALUE: Key<f64> = required("value", finite(""), "Its value, in JSBSim's unit.");

pub(crate) const FILE: Key<str> =
    required("file", FILE_PATH, "The FMU, relative to this file; it runs as you do.");
pub(crate) const INPUTS: Key<Section> = optional(
    "inputs",
    table(&INPUTS_TABLE),
    "How the FMU calls its elevator; the unit is that of the key.",
);
pub(crate) const OUTPUTS: Key<Section> = optional(
    "outputs",
    table(&OUTPUTS_TABLE),
    "How the FMU calls pitch and pitch rate; the unit is that of the key.",
);
pub(crate) const TRIM_ELEVATOR_DEG: Key<f64> = defaulted(
    "trim_elevator_deg",
    number("deg", Range::Between(-90.0, 90.0)),
    0.0,
    "Elevator at the trim at which the FMU starts, trailing edge down positive.",
);
const fn called(name: &'static str, doc: &'static str) -> Key<str> {
    optional(name, TEXT, doc)
}
/// The FMU's name of its elevator, in radians and in degrees.
pub(crate) const FMU_INPUTS: [Key<str>; 2] = [
    called(
        "elevator_rad",
        "The input that is the elevator, trailing edge down positive, in radians; `-name` turns the sign.",
    ),
    called("elevator_deg", "The same in degrees."),
];
/// The same of what it shows.
pub(crate) const FMU_OUTPUTS: [[Key<str>; 2]; 2] = [
    [
        called("theta_rad", "The output that is the pitch angle, in radians."),
        called("theta_deg", "The same in degrees."),
    ],
    [
        called("q_rad_s", "The output that is the pitch rate, in radians per second."),
        called("q_deg_s", "The same in degrees per second."),
    ],
];
static INPUTS_TABLE: Table = plain(
    "The elevator of an FMU by its name there; `-name` turns a sign.",
    &[&[&FMU_INPUTS[0], &FMU_INPUTS[1]]],
);
static OUTPUTS_TABLE: Table = plain(
    "Outputs of an FMU by their names there; `-name` turns a sign.",
    &[&[&FMU_OUTPUTS[0][0], &FMU_OUTPUTS[0][1]], &[&FMU_OUTPUTS[1][0], &FMU_OUTPUTS[1][1]]],
);

static PROPERTY_TABLE: Table = plain("A property of JSBSim.", &[&[&NAME, &VALUE]]);

pub(super) static SIMULATOR_TABLE: Table = of_kinds(
    "An aircraft that another simulator flies, in a process of its own; pitch counts from the trim, which is the simulator's. What asks equations is refused.",
    &[&[&ANSWER_LIMIT_S]],
    &[
        variant(
            "jsbsim",
            choosing(
                "JSBSim, through its Python package, which is not part of this program: `pip install jsbsim==1.3.3`.",
                &[
                    &[&AIRCRAFT, &FOLDER, &VERSION],
                    &[&AIRSPEED[0], &AIRSPEED[1], &AIRSPEED[2], &CALIBRATED_KT, &MACH],
                    &[&ALTITUDE[0], &ALTITUDE[1], &CLIMB_ANGLE_DEG, &HEADING_DEG],
                    &[&GEAR, &WINGS, &SEED, &PROPERTY],
                ],
                &[
                    one_of!(AIRSPEED[0], AIRSPEED[1], AIRSPEED[2], CALIBRATED_KT, MACH),
                    one_of!(ALTITUDE[0], ALTITUDE[1]),
                ],
            ),
        ),
        variant(
            "fmu",
            plain(
                "An FMU for co-simulation, FMI 2.0 or 3.0: elevator in, pitch and pitch rate out. It starts at its trim.",
                &[&[&FILE, &INPUTS, &OUTPUTS, &TRIM_ELEVATOR_DEG]],
            ),
        ),
    ],
);
