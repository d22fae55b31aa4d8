//! Aircraft files: stability derivatives, a linear model or tables, in the units of their source.

use fspid_sim::ElevatorSign;

use super::flight::{ALTITUDE, ALTITUDE_FT, CG_MAC};
use super::tables::TABLES;
use super::word::{Word, words};
use super::{
    Choice, Key, Kind, Range, Table, Variant, Way, finite, optional, plain, positive, required,
};

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

const COEFFICIENT: Kind = finite("");
const DEG: Kind = Kind::Number { unit: "deg", range: Range::Between(-90.0, 90.0) };
const DEG_RANGE: Kind = Kind::Interval { unit: "deg", range: Range::Between(-180.0, 180.0) };

const fn interval(unit: &'static str) -> Kind {
    Kind::Interval { unit, range: Range::Finite }
}

/// An aircraft in a file of its own.
pub(crate) static AIRCRAFT_FILE: Table = Table {
    doc: "An aircraft.",
    groups: &[&[
        required("name", Kind::Text, "Name."),
        optional("title", Kind::Text, "What it is, in a line."),
        required("source", Kind::Text, "Where the numbers come from."),
        optional("notes", Kind::Text, "What else should be known."),
    ]],
    choices: &[],
    variants: &[
        Variant {
            name: AircraftKind::Derivatives.name(),
            table: plain("Stability derivatives.", &[DERIVATIVES]),
        },
        Variant { name: AircraftKind::Linear.name(), table: plain("A linear model.", &[LINEAR]) },
        Variant {
            name: AircraftKind::Tables.name(),
            table: plain("Tables in files of their own.", &[TABLES]),
        },
    ],
};

const DERIVATIVES: &[Key] = &[
    required("reference", Kind::Table(&REFERENCE), "Flight condition of the derivatives."),
    required("geometry", Kind::Table(&GEOMETRY), "Lengths of the wing."),
    required("mass", Kind::Table(&MASS), "Weight and moments of inertia."),
    required("longitudinal", Kind::Table(&LONGITUDINAL), "Lift, drag, pitching moment."),
    optional("lateral", Kind::Table(&LATERAL), "Side force, roll, yaw; without it there are none."),
    required("validity", Kind::Table(&VALIDITY), "Where the derivatives are trusted."),
    required("travel", Kind::Table(&TRAVEL), "How far the controls go."),
];

const LINEAR: &[Key] = &[
    optional(
        "elevator_sign",
        Kind::Word(ElevatorSign::WORDS),
        "What a positive elevator does; \"nose-down-positive\" if left out.",
    ),
    optional(
        "condition",
        Kind::Table(&CONDITION),
        "Where the model holds; without it a scenario's airspeed and altitude are assumptions, and the air is calm.",
    ),
    optional("geometry", Kind::Table(&SPAN), "The wing, on which turbulence depends."),
    required(
        "equations",
        Kind::Tables { table: &EQUATION, least: 1, most: 4 },
        "One equation a state; all list the states in this order.",
    ),
];

static CONDITION: Table = Table {
    doc: "The level flight around which a linear model holds.",
    groups: &[&[
        optional("airspeed_ft_s", positive("ft/s"), "True airspeed."),
        optional("airspeed_m_s", positive("m/s"), "True airspeed."),
        optional(
            "altitude_ft",
            Kind::Number { unit: "ft", range: ALTITUDE_FT },
            "Geopotential altitude.",
        ),
        optional(
            "altitude_m",
            Kind::Number { unit: "m", range: ALTITUDE },
            "Geopotential altitude.",
        ),
        optional("mach", positive(""), "Mach number."),
    ]],
    choices: &[one_of!("airspeed_ft_s", "airspeed_m_s"), one_of!("altitude_ft", "altitude_m")],
    variants: &[],
};

static SPAN: Table = Table {
    doc: "The wing of a linear model.",
    groups: &[&[
        optional("span_ft", positive("ft"), "Span."),
        optional("span_m", positive("m"), "Span."),
    ]],
    choices: &[one_of!("span_ft", "span_m")],
    variants: &[],
};

static REFERENCE: Table = Table {
    doc: "Flight condition of the derivatives.",
    groups: &[&[
        optional("airspeed_ft_s", positive("ft/s"), "True airspeed."),
        optional("airspeed_m_s", positive("m/s"), "True airspeed."),
        optional("altitude_ft", finite("ft"), "Geopotential altitude."),
        optional("altitude_m", finite("m"), "Geopotential altitude."),
        required("mach", positive(""), "Mach number."),
        optional("density_slug_ft3", positive("slug/ft3"), "Density of the air."),
        optional("density_kg_m3", positive("kg/m3"), "Density of the air."),
        optional(
            "dynamic_pressure_psf",
            positive("psf"),
            "As the source prints it; otherwise that of density and airspeed.",
        ),
        optional("dynamic_pressure_pa", positive("Pa"), "As dynamic_pressure_psf."),
        optional("gravity_ft_s2", positive("ft/s2"), "With which masses are made of weights."),
        optional("gravity_m_s2", positive("m/s2"), "With which masses are made of weights."),
        required("alpha_deg", DEG, "Angle of attack of the fuselage."),
        optional(
            "cg_mac",
            CG_MAC,
            "Centre of gravity of the derivatives behind the leading edge of the mean chord, as a share of it; without it a scenario cannot move it.",
        ),
    ]],
    choices: &[
        one_of!("airspeed_ft_s", "airspeed_m_s"),
        one_of!("altitude_ft", "altitude_m"),
        one_of!("density_slug_ft3", "density_kg_m3"),
        one_of!("gravity_ft_s2", "gravity_m_s2"),
    ],
    variants: &[],
};

static GEOMETRY: Table = Table {
    doc: "Lengths of the wing.",
    groups: &[&[
        optional("area_ft2", positive("ft2"), "Area."),
        optional("area_m2", positive("m2"), "Area."),
        optional("span_ft", positive("ft"), "Span."),
        optional("span_m", positive("m"), "Span."),
        optional("chord_ft", positive("ft"), "Mean chord."),
        optional("chord_m", positive("m"), "Mean chord."),
    ]],
    choices: &[
        one_of!("area_ft2", "area_m2"),
        one_of!("span_ft", "span_m"),
        one_of!("chord_ft", "chord_m"),
    ],
    variants: &[],
};

static MASS: Table = Table {
    doc: "Weight at the flight condition, which the lift there carries, and moments of inertia about the axes of the fuselage; a scenario loads the aircraft otherwise by its own keys.",
    groups: &[&[
        optional("weight_lbf", positive("lbf"), "Weight."),
        optional("weight_n", positive("N"), "Weight."),
        optional("ix_slug_ft2", positive("slug ft2"), "About the forward axis."),
        optional("ix_kg_m2", positive("kg m2"), "About the forward axis."),
        optional("iy_slug_ft2", positive("slug ft2"), "About the right axis."),
        optional("iy_kg_m2", positive("kg m2"), "About the right axis."),
        optional("iz_slug_ft2", positive("slug ft2"), "About the downward axis."),
        optional("iz_kg_m2", positive("kg m2"), "About the downward axis."),
        optional("ixz_slug_ft2", finite("slug ft2"), "Product of inertia."),
        optional("ixz_kg_m2", finite("kg m2"), "Product of inertia."),
    ]],
    choices: &[
        one_of!("weight_lbf", "weight_n"),
        one_of!("ix_slug_ft2", "ix_kg_m2"),
        one_of!("iy_slug_ft2", "iy_kg_m2"),
        one_of!("iz_slug_ft2", "iz_kg_m2"),
        one_of!("ixz_slug_ft2", "ixz_kg_m2"),
    ],
    variants: &[],
};

static LONGITUDINAL: Table = plain(
    "Longitudinal coefficients.",
    &[&[
        required("lift", Kind::Table(&LONGITUDINAL_ROW), "CL, up across the flow."),
        required("drag", Kind::Table(&LONGITUDINAL_ROW), "CD, back along the flow."),
        required("pitch", Kind::Table(&LONGITUDINAL_ROW), "Cm, nose up."),
        optional("thrust_speed", COEFFICIENT, "CTxu; 0 if left out."),
    ]],
);

static LONGITUDINAL_ROW: Table = plain(
    "A coefficient; what is left out is 0.",
    &[&[
        optional("reference", COEFFICIENT, "At the flight condition."),
        optional("alpha", COEFFICIENT, "By angle of attack."),
        optional("alpha_rate", COEFFICIENT, "By its rate, times half a chord over airspeed."),
        optional("pitch_rate", COEFFICIENT, "By pitch rate, times half a chord over airspeed."),
        optional("speed", COEFFICIENT, "By relative change of speed."),
        optional("elevator", COEFFICIENT, "By elevator, trailing edge down positive."),
    ]],
);

static LATERAL: Table = plain(
    "Lateral coefficients.",
    &[&[
        required("side", Kind::Table(&LATERAL_ROW), "CY, to the right."),
        required("roll", Kind::Table(&LATERAL_ROW), "Cl, right wing down."),
        required("yaw", Kind::Table(&LATERAL_ROW), "Cn, nose right."),
    ]],
);

static LATERAL_ROW: Table = plain(
    "A coefficient; what is left out is 0.",
    &[&[
        optional("beta", COEFFICIENT, "By sideslip."),
        optional("roll_rate", COEFFICIENT, "By roll rate, times half a span over airspeed."),
        optional("yaw_rate", COEFFICIENT, "By yaw rate, times half a span over airspeed."),
        optional("aileron", COEFFICIENT, "By aileron."),
        optional("rudder", COEFFICIENT, "By rudder."),
    ]],
);

static VALIDITY: Table = Table {
    doc: "Where the derivatives are trusted.",
    groups: &[&[
        optional("airspeed_ft_s", interval("ft/s"), "True airspeed."),
        optional("airspeed_m_s", interval("m/s"), "True airspeed."),
        required("mach", interval(""), "Mach number."),
        required("alpha_deg", DEG_RANGE, "Angle of attack from the reference."),
        required("beta_deg", DEG_RANGE, "Sideslip."),
        optional("altitude_ft", interval("ft"), "Geopotential altitude."),
        optional("altitude_m", interval("m"), "Geopotential altitude."),
    ]],
    choices: &[one_of!("airspeed_ft_s", "airspeed_m_s"), one_of!("altitude_ft", "altitude_m")],
    variants: &[],
};

pub(super) const SURFACE_KEYS: &[Key] = &[
    required("elevator_deg", DEG_RANGE, "Elevator, trailing edge down positive."),
    required("aileron_deg", DEG_RANGE, "Aileron."),
    required("rudder_deg", DEG_RANGE, "Rudder."),
];

static TRAVEL: Table = plain(
    "How far the controls go.",
    &[
        SURFACE_KEYS,
        &[required("throttle", interval(""), "Thrust in multiples of that of the reference.")],
    ],
);

static EQUATION: Table = plain(
    "Rate of change of a state.",
    &[&[
        required("state", Kind::Word(StateWord::WORDS), "Which."),
        required(
            "by_states",
            Kind::Numbers { unit: "", range: Range::Finite, least: 1, most: 4 },
            "By each of the states, in the order of the equations.",
        ),
        required("by_elevator", finite(""), "By the elevator in rad."),
        optional(
            "by_pitch_gust",
            finite(""),
            "By the pitch rate of the air in rad/s: 0 if left out, as it is for theta_rad; known if any equation has it.",
        ),
    ]],
);
