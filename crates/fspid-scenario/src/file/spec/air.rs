//! Winds, gusts and turbulence.

use fspid_sim::air::{Follows, Severity, Specification};

use super::word::{Word, words, words_of};
use super::{
    Choice, Default, Key, Kind, Range, Table, Variant, Way, defaulted, finite, not_negative,
    optional, plain, positive, required,
};

words! {
    /// Winds.
    WindKind { Steady = "steady", LogShear = "log-shear", Microburst = "microburst" }
}

words! {
    /// Gusts.
    GustKind { RampHold = "ramp-hold", FullCycle = "full-cycle" }
}

words_of!(Specification { MilF8785c = "mil-f-8785c", MilHdbk1797 = "mil-hdbk-1797" });
words_of!(Severity { Light = "light", Moderate = "moderate", Severe = "severe" });
words_of!(Follows { Start = "start", Flight = "flight" });

pub(super) static TURBULENCE: Table = plain(
    "Turbulence of the form of Dryden.",
    &[&[
        defaulted(
            "model",
            Kind::Word(Specification::WORDS),
            Default::Word("mil-f-8785c"),
            "Document that scale lengths are stated by.",
        ),
        required(
            "intensity",
            Kind::Word(Severity::WORDS),
            "Severity: by the chart aloft, by its wind at 20 ft near the ground.",
        ),
        optional(
            "follows",
            Kind::Word(Follows::WORDS),
            "Height and airspeed of its lengths and intensities: those of the start, or each 10 ms those of the flight; if left out \"start\", for an aircraft that climbs or descends \"flight\".",
        ),
        optional("w20_m_s", not_negative("m/s"), "Wind at 20 ft in place of the severity's."),
        defaulted(
            "seed",
            Kind::Integer { least: 0, most: i64::MAX },
            Default::Integer(1),
            "The same seed gives the same turbulence at any sample period: it is drawn each 10 ms and held.",
        ),
    ]],
);

const FROM: Key = defaulted(
    "from_deg",
    Kind::Number { unit: "deg", range: Range::Between(-360.0, 360.0) },
    Default::Number(0.0),
    "Direction that the wind comes from, clockwise from north.",
);

pub(super) static WIND: Table = Table {
    doc: "The wind; an aircraft starts trimmed in the wind of its start.",
    groups: &[],
    choices: &[],
    variants: &[
        Variant {
            name: WindKind::Steady.name(),
            table: Table {
                doc: "The same everywhere.",
                groups: &[&[
                    optional("speed_m_s", not_negative("m/s"), "Horizontal speed."),
                    optional("speed_kt", not_negative("kt"), "Horizontal speed."),
                    FROM,
                    defaulted("up_m_s", finite("m/s"), Default::Number(0.0), "Upward speed."),
                ]],
                choices: &[one_of!("speed_m_s", "speed_kt")],
                variants: &[],
            },
        },
        Variant {
            name: WindKind::LogShear.name(),
            table: Table {
                doc: "Growing with the logarithm of the height up to 1000 ft.",
                groups: &[&[
                    optional("w20_m_s", positive("m/s"), "Speed 20 ft above the ground."),
                    optional("w20_kt", positive("kt"), "Speed 20 ft above the ground."),
                    FROM,
                    defaulted(
                        "roughness_m",
                        positive("m"),
                        Default::Number(0.045_72),
                        "Roughness length; 0.15 ft for approaches.",
                    ),
                ]],
                choices: &[one_of!("w20_m_s", "w20_kt")],
                variants: &[],
            },
        },
        Variant {
            name: WindKind::Microburst.name(),
            table: plain(
                "Air that falls and spreads over the ground.",
                &[&[
                    required("outflow_m_s", positive("m/s"), "Largest outflow."),
                    required("radius_m", positive("m"), "Radius of the downdraught."),
                    required("peak_height_m", positive("m"), "Height of the largest outflow."),
                    required("north_m", finite("m"), "Axis, north of the start."),
                    defaulted(
                        "east_m",
                        finite("m"),
                        Default::Number(0.0),
                        "Axis, east of the start.",
                    ),
                ]],
            ),
        },
    ],
};

const AMPLITUDE: &[Key] = &[
    defaulted("forward_m_s", finite("m/s"), Default::Number(0.0), "Speed of the air forward."),
    defaulted("right_m_s", finite("m/s"), Default::Number(0.0), "Speed of the air to the right."),
    defaulted("up_m_s", finite("m/s"), Default::Number(0.0), "Speed of the air upward."),
    defaulted(
        "at_s",
        not_negative("s"),
        Default::Number(0.0),
        "When an aircraft that keeps its speed flies into it.",
    ),
];

pub(super) static GUST: Table = Table {
    doc: "A gust along the axes of the aircraft.",
    groups: &[AMPLITUDE],
    choices: &[],
    variants: &[
        Variant {
            name: GustKind::RampHold.name(),
            table: plain(
                "Rises as half a cosine over a length and stays (MIL-F-8785C).",
                &[&[required("length_m", positive("m"), "Length of the rise.")]],
            ),
        },
        Variant {
            name: GustKind::FullCycle.name(),
            table: plain(
                "One minus cosine: rises over the gradient distance and falls again (CS 25.341).",
                &[&[required("gradient_m", positive("m"), "Gradient distance: half the length.")]],
            ),
        },
    ],
};
