//! Aircraft files: stability derivatives, a linear model or tables, in the units of their source.

use crate::keyed::word::words;
use crate::keyed::{
    Key, KeyRow, KindOf, Range, Section, TEXT, Table, choosing, finite, interval, number, numbers,
    of_kinds, one_of, optional, plain, positive, required, table, tables, variant, word,
};
use fspid_sim::ElevatorSign;

use super::configuration::OF_FILES;
use super::flight::{ALTITUDES, ALTITUDES_FT, CHORD_SHARE};
use super::tables::OF_TABLES;

words! {
    /// What an aircraft is known by.
    AircraftKind { Derivatives = "derivatives", Linear = "linear", Tables = "tables" }
}

words! {
    /// States that an equation of a linear model may be for; the unit is the last part.
    StateWord {
        ForwardFeet = "u_ft_s",
        ForwardMetres = "u_m_s",
        DownwardFeet = "w_ft_s",
        DownwardMetres = "w_m_s",
        Alpha = "alpha_rad",
        PitchRate = "q_rad_s",
        Theta = "theta_rad",
    }
}

const COEFFICIENT: KindOf<f64> = finite("");
const DEG: KindOf<f64> = number("deg", Range::Between(-90.0, 90.0));
const DEG_RANGE: KindOf<(f64, f64)> = interval("deg", Range::Between(-180.0, 180.0));

const fn span(unit: &'static str) -> KindOf<(f64, f64)> {
    interval(unit, Range::Finite)
}

pub(crate) const NAME: Key<str> = required("name", TEXT, "Name.");
pub(crate) const TITLE: Key<str> = optional("title", TEXT, "What it is, in a line.");
pub(crate) const SOURCE: Key<str> = required("source", TEXT, "Where the numbers come from.");
pub(crate) const NOTES: Key<str> = optional("notes", TEXT, "What else should be known.");

/// An aircraft in a file of its own.
pub(crate) static AIRCRAFT_FILE: Table = of_kinds(
    "An aircraft.",
    &[&[&NAME, &TITLE, &SOURCE, &NOTES]],
    &[
        variant(
            AircraftKind::Derivatives.name(),
            plain("Stability derivatives.", &[DERIVATIVES, OF_FILES]),
        ),
        variant(AircraftKind::Linear.name(), plain("A linear model.", &[LINEAR])),
        variant(AircraftKind::Tables.name(), plain("Tables in files of their own.", &[OF_TABLES])),
    ],
);

pub(crate) const REFERENCE: Key<Section> =
    required("reference", table(&REFERENCE_TABLE), "Flight condition of the derivatives.");
pub(crate) const GEOMETRY: Key<Section> =
    required("geometry", table(&GEOMETRY_TABLE), "Lengths of the wing.");
pub(crate) const MASS: Key<Section> =
    required("mass", table(&MASS_TABLE), "Weight and moments of inertia.");
pub(crate) const LONGITUDINAL: Key<Section> =
    required("longitudinal", table(&LONGITUDINAL_TABLE), "Lift, drag, pitching moment.");
pub(crate) const LATERAL: Key<Section> =
    optional("lateral", table(&LATERAL_TABLE), "Side force, roll, yaw; without it there are none.");
pub(crate) const VALIDITY: Key<Section> =
    required("validity", table(&VALIDITY_TABLE), "Where the derivatives are trusted.");
pub(crate) const TRAVEL: Key<Section> =
    required("travel", table(&TRAVEL_TABLE), "How far the controls go.");

const DERIVATIVES: &[KeyRow] =
    &[&REFERENCE, &GEOMETRY, &MASS, &LONGITUDINAL, &LATERAL, &VALIDITY, &TRAVEL];

pub(crate) const ELEVATOR_SIGN: Key<ElevatorSign> = optional(
    "elevator_sign",
    word(),
    "What a positive elevator does; \"nose-down-positive\" if left out.",
);
pub(crate) const CONDITION: Key<Section> = optional(
    "condition",
    table(&CONDITION_TABLE),
    "Where the model holds; without it a scenario's airspeed and altitude are assumptions, and the air is calm.",
);
pub(crate) const LINEAR_GEOMETRY: Key<Section> =
    optional("geometry", table(&SPAN_TABLE), "The wing, on which turbulence depends.");
pub(crate) const EQUATIONS: Key<[Section]> = required(
    "equations",
    tables(&EQUATION_TABLE, 1, 4),
    "One equation a state; all list the states in this order.",
);

const LINEAR: &[KeyRow] = &[&ELEVATOR_SIGN, &CONDITION, &LINEAR_GEOMETRY, &EQUATIONS];

pub(crate) const CONDITION_AIRSPEED: [Key<f64>; 2] = [
    optional("airspeed_ft_s", positive("ft/s"), "True airspeed."),
    optional("airspeed_m_s", positive("m/s"), "True airspeed."),
];
pub(crate) const CONDITION_ALTITUDE: [Key<f64>; 2] = [
    optional("altitude_ft", number("ft", ALTITUDES_FT), "Geopotential altitude."),
    optional("altitude_m", number("m", ALTITUDES), "Geopotential altitude."),
];
pub(crate) const CONDITION_MACH: Key<f64> = optional("mach", positive(""), "Mach number.");

static CONDITION_TABLE: Table = choosing(
    "The level flight around which a linear model holds.",
    &[
        &[&CONDITION_AIRSPEED[0], &CONDITION_AIRSPEED[1], &CONDITION_ALTITUDE[0]],
        &[&CONDITION_ALTITUDE[1], &CONDITION_MACH],
    ],
    &[
        one_of!(CONDITION_AIRSPEED[0], CONDITION_AIRSPEED[1]),
        one_of!(CONDITION_ALTITUDE[0], CONDITION_ALTITUDE[1]),
    ],
);

pub(crate) const SPAN: [Key<f64>; 2] =
    [optional("span_ft", positive("ft"), "Span."), optional("span_m", positive("m"), "Span.")];

static SPAN_TABLE: Table =
    choosing("The wing of a linear model.", &[&[&SPAN[0], &SPAN[1]]], &[one_of!(SPAN[0], SPAN[1])]);

pub(crate) const REFERENCE_AIRSPEED: [Key<f64>; 2] = [
    optional("airspeed_ft_s", positive("ft/s"), "True airspeed."),
    optional("airspeed_m_s", positive("m/s"), "True airspeed."),
];
pub(crate) const REFERENCE_ALTITUDE: [Key<f64>; 2] = [
    optional("altitude_ft", finite("ft"), "Geopotential altitude."),
    optional("altitude_m", finite("m"), "Geopotential altitude."),
];
pub(crate) const REFERENCE_MACH: Key<f64> = required("mach", positive(""), "Mach number.");
pub(crate) const DENSITY: [Key<f64>; 2] = [
    optional("density_slug_ft3", positive("slug/ft3"), "Density of the air."),
    optional("density_kg_m3", positive("kg/m3"), "Density of the air."),
];
pub(crate) const DYNAMIC_PRESSURE: [Key<f64>; 2] = [
    optional(
        "dynamic_pressure_psf",
        positive("psf"),
        "As the source prints it; otherwise that of density and airspeed.",
    ),
    optional("dynamic_pressure_pa", positive("Pa"), "As dynamic_pressure_psf."),
];
pub(crate) const GRAVITY: [Key<f64>; 2] = [
    optional("gravity_ft_s2", positive("ft/s2"), "With which masses are made of weights."),
    optional("gravity_m_s2", positive("m/s2"), "With which masses are made of weights."),
];
pub(crate) const REFERENCE_ALPHA_DEG: Key<f64> =
    required("alpha_deg", DEG, "Angle of attack of the fuselage.");
pub(crate) const CG_MAC: Key<f64> = optional(
    "cg_mac",
    CHORD_SHARE,
    "Centre of gravity of the derivatives behind the leading edge of the mean chord, as a share of it; without it a scenario cannot move it.",
);

static REFERENCE_TABLE: Table = choosing(
    "Flight condition of the derivatives.",
    &[
        &[&REFERENCE_AIRSPEED[0], &REFERENCE_AIRSPEED[1], &REFERENCE_ALTITUDE[0]],
        &[&REFERENCE_ALTITUDE[1], &REFERENCE_MACH, &DENSITY[0], &DENSITY[1]],
        &[&DYNAMIC_PRESSURE[0], &DYNAMIC_PRESSURE[1], &GRAVITY[0], &GRAVITY[1]],
        &[&REFERENCE_ALPHA_DEG, &CG_MAC],
    ],
    &[
        one_of!(REFERENCE_AIRSPEED[0], REFERENCE_AIRSPEED[1]),
        one_of!(REFERENCE_ALTITUDE[0], REFERENCE_ALTITUDE[1]),
        one_of!(DENSITY[0], DENSITY[1]),
        one_of!(GRAVITY[0], GRAVITY[1]),
    ],
);

pub(crate) const AREA: [Key<f64>; 2] =
    [optional("area_ft2", positive("ft2"), "Area."), optional("area_m2", positive("m2"), "Area.")];
pub(crate) const CHORD: [Key<f64>; 2] = [
    optional("chord_ft", positive("ft"), "Mean chord."),
    optional("chord_m", positive("m"), "Mean chord."),
];

static GEOMETRY_TABLE: Table = choosing(
    "Lengths of the wing.",
    &[&[&AREA[0], &AREA[1], &SPAN[0], &SPAN[1], &CHORD[0], &CHORD[1]]],
    &[one_of!(AREA[0], AREA[1]), one_of!(SPAN[0], SPAN[1]), one_of!(CHORD[0], CHORD[1])],
);

pub(crate) const WEIGHT: [Key<f64>; 2] = [
    optional("weight_lbf", positive("lbf"), "Weight."),
    optional("weight_n", positive("N"), "Weight."),
];
pub(crate) const IX: [Key<f64>; 2] = [
    optional("ix_slug_ft2", positive("slug ft2"), "About the forward axis."),
    optional("ix_kg_m2", positive("kg m2"), "About the forward axis."),
];
pub(crate) const IY: [Key<f64>; 2] = [
    optional("iy_slug_ft2", positive("slug ft2"), "About the right axis."),
    optional("iy_kg_m2", positive("kg m2"), "About the right axis."),
];
pub(crate) const IZ: [Key<f64>; 2] = [
    optional("iz_slug_ft2", positive("slug ft2"), "About the downward axis."),
    optional("iz_kg_m2", positive("kg m2"), "About the downward axis."),
];
pub(crate) const IXZ: [Key<f64>; 2] = [
    optional("ixz_slug_ft2", finite("slug ft2"), "Product of inertia."),
    optional("ixz_kg_m2", finite("kg m2"), "Product of inertia."),
];

static MASS_TABLE: Table = choosing(
    "Weight at the flight condition, which the lift there carries, and moments of inertia about the axes of the fuselage; a scenario loads the aircraft otherwise by its own keys.",
    &[
        &[&WEIGHT[0], &WEIGHT[1], &IX[0], &IX[1], &IY[0], &IY[1], &IZ[0], &IZ[1]],
        &[&IXZ[0], &IXZ[1]],
    ],
    &[
        one_of!(WEIGHT[0], WEIGHT[1]),
        one_of!(IX[0], IX[1]),
        one_of!(IY[0], IY[1]),
        one_of!(IZ[0], IZ[1]),
        one_of!(IXZ[0], IXZ[1]),
    ],
);

pub(crate) const LIFT: Key<Section> =
    required("lift", table(&LONGITUDINAL_ROW_TABLE), "CL, up across the flow.");
pub(crate) const DRAG: Key<Section> =
    required("drag", table(&LONGITUDINAL_ROW_TABLE), "CD, back along the flow.");
pub(crate) const PITCH: Key<Section> =
    required("pitch", table(&LONGITUDINAL_ROW_TABLE), "Cm, nose up.");
pub(crate) const THRUST_SPEED: Key<f64> =
    optional("thrust_speed", COEFFICIENT, "CTxu; 0 if left out.");

static LONGITUDINAL_TABLE: Table =
    plain("Longitudinal coefficients.", &[&[&LIFT, &DRAG, &PITCH, &THRUST_SPEED]]);

pub(crate) const COEFFICIENT_REFERENCE: Key<f64> =
    optional("reference", COEFFICIENT, "At the flight condition.");
pub(crate) const ALPHA: Key<f64> = optional("alpha", COEFFICIENT, "By angle of attack.");
pub(crate) const ALPHA_RATE: Key<f64> =
    optional("alpha_rate", COEFFICIENT, "By its rate, times half a chord over airspeed.");
pub(crate) const PITCH_RATE: Key<f64> =
    optional("pitch_rate", COEFFICIENT, "By pitch rate, times half a chord over airspeed.");
pub(crate) const SPEED: Key<f64> = optional("speed", COEFFICIENT, "By relative change of speed.");
pub(crate) const ELEVATOR: Key<f64> =
    optional("elevator", COEFFICIENT, "By elevator, trailing edge down positive.");

pub(super) static LONGITUDINAL_ROW_TABLE: Table = plain(
    "A coefficient; what is left out is 0.",
    &[&[&COEFFICIENT_REFERENCE, &ALPHA, &ALPHA_RATE, &PITCH_RATE, &SPEED, &ELEVATOR]],
);

pub(crate) const SIDE: Key<Section> =
    required("side", table(&LATERAL_ROW_TABLE), "CY, to the right.");
pub(crate) const ROLL: Key<Section> =
    required("roll", table(&LATERAL_ROW_TABLE), "Cl, right wing down.");
pub(crate) const YAW: Key<Section> = required("yaw", table(&LATERAL_ROW_TABLE), "Cn, nose right.");

static LATERAL_TABLE: Table = plain("Lateral coefficients.", &[&[&SIDE, &ROLL, &YAW]]);

pub(crate) const BETA: Key<f64> = optional("beta", COEFFICIENT, "By sideslip.");
pub(crate) const ROLL_RATE: Key<f64> =
    optional("roll_rate", COEFFICIENT, "By roll rate, times half a span over airspeed.");
pub(crate) const YAW_RATE: Key<f64> =
    optional("yaw_rate", COEFFICIENT, "By yaw rate, times half a span over airspeed.");
pub(crate) const AILERON: Key<f64> = optional("aileron", COEFFICIENT, "By aileron.");
pub(crate) const RUDDER: Key<f64> = optional("rudder", COEFFICIENT, "By rudder.");

pub(super) static LATERAL_ROW_TABLE: Table = plain(
    "A coefficient; what is left out is 0.",
    &[&[&BETA, &ROLL_RATE, &YAW_RATE, &AILERON, &RUDDER]],
);

pub(crate) const VALIDITY_AIRSPEED: [Key<(f64, f64)>; 2] = [
    optional("airspeed_ft_s", span("ft/s"), "True airspeed."),
    optional("airspeed_m_s", span("m/s"), "True airspeed."),
];
pub(crate) const VALIDITY_MACH: Key<(f64, f64)> = required("mach", span(""), "Mach number.");
pub(crate) const VALIDITY_ALPHA_DEG: Key<(f64, f64)> =
    required("alpha_deg", DEG_RANGE, "Angle of attack from the reference.");
pub(crate) const BETA_DEG: Key<(f64, f64)> = required("beta_deg", DEG_RANGE, "Sideslip.");
pub(crate) const VALIDITY_ALTITUDE: [Key<(f64, f64)>; 2] = [
    optional("altitude_ft", span("ft"), "Geopotential altitude."),
    optional("altitude_m", span("m"), "Geopotential altitude."),
];

static VALIDITY_TABLE: Table = choosing(
    "Where the derivatives are trusted.",
    &[
        &[&VALIDITY_AIRSPEED[0], &VALIDITY_AIRSPEED[1], &VALIDITY_MACH],
        &[&VALIDITY_ALPHA_DEG, &BETA_DEG, &VALIDITY_ALTITUDE[0], &VALIDITY_ALTITUDE[1]],
    ],
    &[
        one_of!(VALIDITY_AIRSPEED[0], VALIDITY_AIRSPEED[1]),
        one_of!(VALIDITY_ALTITUDE[0], VALIDITY_ALTITUDE[1]),
    ],
);

pub(crate) const ELEVATOR_DEG: Key<(f64, f64)> =
    required("elevator_deg", DEG_RANGE, "Elevator, trailing edge down positive.");
pub(crate) const AILERON_DEG: Key<(f64, f64)> = required("aileron_deg", DEG_RANGE, "Aileron.");
pub(crate) const RUDDER_DEG: Key<(f64, f64)> = required("rudder_deg", DEG_RANGE, "Rudder.");

pub(super) const SURFACE_KEYS: &[KeyRow] = &[&ELEVATOR_DEG, &AILERON_DEG, &RUDDER_DEG];

pub(crate) const THROTTLE: Key<(f64, f64)> =
    required("throttle", span(""), "Thrust in multiples of that of the reference.");

static TRAVEL_TABLE: Table = plain("How far the controls go.", &[SURFACE_KEYS, &[&THROTTLE]]);

pub(crate) const STATE: Key<StateWord> = required("state", word(), "Which.");
pub(crate) const BY_STATES: Key<[f64]> = required(
    "by_states",
    numbers("", Range::Finite, (1, 4)),
    "By each of the states, in the order of the equations.",
);
pub(crate) const BY_ELEVATOR: Key<f64> =
    required("by_elevator", finite(""), "By the elevator in rad.");
pub(crate) const BY_PITCH_GUST: Key<f64> = optional(
    "by_pitch_gust",
    finite(""),
    "By the pitch rate of the air in rad/s: 0 if left out, as it is for theta_rad; known if any equation has it.",
);

static EQUATION_TABLE: Table =
    plain("Rate of change of a state.", &[&[&STATE, &BY_STATES, &BY_ELEVATOR, &BY_PITCH_GUST]]);
