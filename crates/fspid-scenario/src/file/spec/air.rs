//! Winds, gusts and turbulence.

use crate::keyed::word::{words, words_of};
use crate::keyed::{
    FILE_PATH, Key, KeyRow, Range, TEXT, Table, choosing, defaulted, finite, not_negative, number,
    numbers, of_kinds, one_of, optional, plain, positive, required, variant, whole, word,
};
use fspid_sim::air::{Follows, LogShear, Severity, Specification, WindTable};

words! {
    /// Winds.
    WindKind { Steady = "steady", LogShear = "log-shear", Microburst = "microburst", Table = "table" }
}

words! {
    /// Gusts.
    GustKind { RampHold = "ramp-hold", FullCycle = "full-cycle", Design = "cs-25.341" }
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
pub(crate) const ROUGHNESS_M: Key<f64> = defaulted(
    "roughness_m",
    number("m", Range::PositiveUpTo(LogShear::MOST_ROUGHNESS_M)),
    0.045_72,
    "Roughness length; 0.15 ft for approaches, 2 ft otherwise, at most the 3 ft at which the layer begins.",
);
pub(crate) const OUTFLOW_M_S: Key<f64> =
    required("outflow_m_s", positive("m/s"), "Largest outflow.");
pub(crate) const RADIUS_M: Key<f64> =
    required("radius_m", positive("m"), "Radius of the downdraught.");
pub(crate) const PEAK_HEIGHT_M: Key<f64> =
    required("peak_height_m", positive("m"), "Height of the largest outflow.");
pub(crate) const NORTH_M: Key<f64> = required("north_m", finite("m"), "Axis, north of the start.");
pub(crate) const EAST_M: Key<f64> =
    defaulted("east_m", finite("m"), 0.0, "Axis, east of the start.");

const ROWS: (usize, usize) = (2, WindTable::MOST_ROWS);

pub(crate) const WIND_FILE: Key<str> = optional(
    "file",
    FILE_PATH,
    "A table as CSV, relative to this file: a first line with names that end in units, rows in rising order.",
);
pub(crate) const TIME_S: Key<[f64]> = optional(
    "time_s",
    numbers("s", Range::Finite, ROWS),
    "Times since the start, each above the one before.",
);
pub(crate) const DISTANCE_M: Key<[f64]> = optional(
    "distance_m",
    numbers("m", Range::Finite, ROWS),
    "Ways through the air since the start, each above the one before.",
);
pub(crate) const HEIGHT_M: Key<[f64]> = optional(
    "height_m",
    numbers("m", Range::Finite, ROWS),
    "Heights above the ground, each above the one before.",
);

const fn velocities(name: &'static str, doc: &'static str) -> Key<[f64]> {
    optional(name, numbers("m/s", Range::Finite, ROWS), doc)
}

pub(crate) const NORTH_M_S: Key<[f64]> =
    velocities("north_m_s", "Speed of the air to the north at each row; 0 if left out.");
pub(crate) const EAST_M_S: Key<[f64]> =
    velocities("east_m_s", "Speed of the air to the east at each row; 0 if left out.");
pub(crate) const ROWS_UP_M_S: Key<[f64]> =
    velocities("up_m_s", "Speed of the air upward at each row; 0 if left out.");
pub(crate) const ROWS_FORWARD_M_S: Key<[f64]> = velocities(
    "forward_m_s",
    "Speed of the air along the aircraft's own axis at each row; 0 if left out.",
);
pub(crate) const ROWS_RIGHT_M_S: Key<[f64]> =
    velocities("right_m_s", "Speed of the air to the aircraft's right at each row; 0 if left out.");

/// What the rows of a table go by.
pub(crate) const AXES: [Key<[f64]>; 3] = [TIME_S, DISTANCE_M, HEIGHT_M];
/// Velocities of a table, in the order of their directions in a file.
pub(crate) const VELOCITIES: [Key<[f64]>; 5] =
    [NORTH_M_S, EAST_M_S, ROWS_UP_M_S, ROWS_FORWARD_M_S, ROWS_RIGHT_M_S];

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
        variant(
            WindKind::Table.name(),
            choosing(
                "Rows over time, distance or height, here or in a file; between them straight lines, beyond them the first and the last.",
                &[
                    &[&WIND_FILE, &TIME_S, &DISTANCE_M, &HEIGHT_M],
                    &[&NORTH_M_S, &EAST_M_S, &ROWS_UP_M_S, &ROWS_FORWARD_M_S, &ROWS_RIGHT_M_S],
                ],
                &[one_of!(WIND_FILE, TIME_S, DISTANCE_M, HEIGHT_M)],
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

const AMPLITUDE: &[KeyRow] = &[&FORWARD_M_S, &RIGHT_M_S, &GUST_UP_M_S];

pub(crate) const LENGTH_M: Key<f64> = required("length_m", positive("m"), "Length of the rise.");
pub(crate) const GRADIENT_M: Key<f64> =
    required("gradient_m", positive("m"), "Gradient distance: half the length.");

pub(crate) const GRADIENTS: Key<i64> = required(
    "gradients",
    whole(2, 500),
    "How many gradient distances from 30 to 350 ft, evenly apart; each of them up and down, so that there are twice as many cases.",
);
pub(crate) const CASE: Key<i64> = required(
    "case",
    whole(1, 1000),
    "Which of the cases, from 1: 30 ft up, 30 ft down, the next distance up, and so on.",
);
pub(crate) const ALLEVIATION: Key<f64> = defaulted(
    "alleviation",
    number("", Range::PositiveUpTo(1.0)),
    1.0,
    "Flight profile alleviation factor of the aircraft.",
);

pub(super) static GUST_TABLE: Table = of_kinds(
    "A gust along the axes of the aircraft.",
    &[&[&AT_S]],
    &[
        variant(
            GustKind::RampHold.name(),
            plain(
                "Rises as half a cosine over a length and stays (MIL-F-8785C).",
                &[AMPLITUDE, &[&LENGTH_M]],
            ),
        ),
        variant(
            GustKind::FullCycle.name(),
            plain(
                "One minus cosine: rises over the gradient distance and falls again (CS 25.341).",
                &[AMPLITUDE, &[&GRADIENT_M]],
            ),
        ),
        variant(
            GustKind::Design.name(),
            plain(
                "A vertical design gust of CS 25.341 at the altitude of the trim, one of a sweep of gradient distances.",
                &[&[&CASE, &GRADIENTS, &ALLEVIATION]],
            ),
        ),
    ],
);
