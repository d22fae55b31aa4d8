//! Winds, gusts and turbulence.

use crate::keyed::word::{words, words_of};
use crate::keyed::{
    Key, KeyRow, Range, TEXT, Table, choosing, defaulted, finite, not_negative, number, of_kinds,
    one_of, optional, plain, positive, required, variant, whole, word,
};
use fspid_sim::air::{Follows, Severity, Specification};

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

pub(crate) const MODEL: Key<Specification> = defaulted(
    "model",
    word(),
    Specification::MilF8785c,
    "Document that scale lengths are stated by.",
);
pub(crate) const INTENSITY: Key<Severity> = required(
    "intensity",
    word(),
    "Severity: by the chart aloft, by its wind at 20 ft near the ground.",
);
pub(crate) const FOLLOWS: Key<Follows> = optional(
    "follows",
    word(),
    "Height and airspeed of its lengths and intensities: those of the start, or each 10 ms those of the flight; if left out \"start\", for an aircraft that climbs or descends \"flight\".",
);
pub(crate) const TURBULENCE_W20_M_S: Key<f64> =
    optional("w20_m_s", not_negative("m/s"), "Wind at 20 ft in place of the severity's.");
pub(crate) const SEED: Key<i64> = defaulted(
    "seed",
    whole(0, i64::MAX),
    1,
    "The same seed gives the same turbulence at any sample period: it is drawn each 10 ms and held.",
);

pub(crate) const MIXTURE: Key<str> = optional(
    "mixture",
    TEXT,
    "Seeds with weights in place of `seed`, as `campaign rare` mixes air: \"7*0.8 + 9*0.6\"; the squares of the weights sum to 1.",
);

pub(super) static TURBULENCE_TABLE: Table = plain(
    "Turbulence of the form of Dryden.",
    &[&[&MODEL, &INTENSITY, &FOLLOWS, &TURBULENCE_W20_M_S, &SEED, &MIXTURE]],
);

pub(crate) const FROM: Key<f64> = defaulted(
    "from_deg",
    number("deg", Range::Between(-360.0, 360.0)),
    0.0,
    "Direction that the wind comes from, clockwise from north.",
);

pub(crate) const SPEED: [Key<f64>; 2] = [
    optional("speed_m_s", not_negative("m/s"), "Horizontal speed."),
    optional("speed_kt", not_negative("kt"), "Horizontal speed."),
];
pub(crate) const UP_M_S: Key<f64> = defaulted("up_m_s", finite("m/s"), 0.0, "Upward speed.");
pub(crate) const W20: [Key<f64>; 2] = [
    optional("w20_m_s", positive("m/s"), "Speed 20 ft above the ground."),
    optional("w20_kt", positive("kt"), "Speed 20 ft above the ground."),
];
pub(crate) const ROUGHNESS_M: Key<f64> =
    defaulted("roughness_m", positive("m"), 0.045_72, "Roughness length; 0.15 ft for approaches.");
pub(crate) const OUTFLOW_M_S: Key<f64> =
    required("outflow_m_s", positive("m/s"), "Largest outflow.");
pub(crate) const RADIUS_M: Key<f64> =
    required("radius_m", positive("m"), "Radius of the downdraught.");
pub(crate) const PEAK_HEIGHT_M: Key<f64> =
    required("peak_height_m", positive("m"), "Height of the largest outflow.");
pub(crate) const NORTH_M: Key<f64> = required("north_m", finite("m"), "Axis, north of the start.");
pub(crate) const EAST_M: Key<f64> =
    defaulted("east_m", finite("m"), 0.0, "Axis, east of the start.");

pub(super) static WIND_TABLE: Table = of_kinds(
    "The wind; an aircraft starts trimmed in the wind of its start.",
    &[],
    &[
        variant(
            WindKind::Steady.name(),
            choosing(
                "The same everywhere.",
                &[&[&SPEED[0], &SPEED[1], &FROM, &UP_M_S]],
                &[one_of!(SPEED[0], SPEED[1])],
            ),
        ),
        variant(
            WindKind::LogShear.name(),
            choosing(
                "Growing with the logarithm of the height up to 1000 ft.",
                &[&[&W20[0], &W20[1], &FROM, &ROUGHNESS_M]],
                &[one_of!(W20[0], W20[1])],
            ),
        ),
        variant(
            WindKind::Microburst.name(),
            plain(
                "Air that falls and spreads over the ground.",
                &[&[&OUTFLOW_M_S, &RADIUS_M, &PEAK_HEIGHT_M, &NORTH_M, &EAST_M]],
            ),
        ),
    ],
);

pub(crate) const FORWARD_M_S: Key<f64> =
    defaulted("forward_m_s", finite("m/s"), 0.0, "Speed of the air forward.");
pub(crate) const RIGHT_M_S: Key<f64> =
    defaulted("right_m_s", finite("m/s"), 0.0, "Speed of the air to the right.");
pub(crate) const GUST_UP_M_S: Key<f64> =
    defaulted("up_m_s", finite("m/s"), 0.0, "Speed of the air upward.");
pub(crate) const AT_S: Key<f64> = defaulted(
    "at_s",
    not_negative("s"),
    0.0,
    "When an aircraft that keeps its speed flies into it.",
);

const AMPLITUDE: &[KeyRow] = &[&FORWARD_M_S, &RIGHT_M_S, &GUST_UP_M_S, &AT_S];

pub(crate) const LENGTH_M: Key<f64> = required("length_m", positive("m"), "Length of the rise.");
pub(crate) const GRADIENT_M: Key<f64> =
    required("gradient_m", positive("m"), "Gradient distance: half the length.");

pub(super) static GUST_TABLE: Table = of_kinds(
    "A gust along the axes of the aircraft.",
    &[AMPLITUDE],
    &[
        variant(
            GustKind::RampHold.name(),
            plain("Rises as half a cosine over a length and stays (MIL-F-8785C).", &[&[&LENGTH_M]]),
        ),
        variant(
            GustKind::FullCycle.name(),
            plain(
                "One minus cosine: rises over the gradient distance and falls again (CS 25.341).",
                &[&[&GRADIENT_M]],
            ),
        ),
    ],
);
