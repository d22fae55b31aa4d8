//! What is told of a point that can be flown: one row a quantity.

use fspid_aircraft::ModeName;

use super::point::{Held, Point, doubles_s, pair, short_period};
use fspid_scenario::aircraft::units::Kind;

/// A quantity over an envelope.
#[derive(Clone, Copy, Debug)]
pub(super) struct Column {
    /// Name for people and in titles.
    pub(super) name: &'static str,
    /// Name for programs and files, without the unit.
    pub(super) key: &'static str,
    pub(super) kind: Kind,
    /// False for what a map would not show.
    pub(super) drawn: bool,
    /// True for what an autopilot has to be there for.
    pub(super) needs_autopilot: bool,
    read: fn(&Held) -> Option<f64>,
}

const fn column(
    name: &'static str,
    key: &'static str,
    kind: Kind,
    read: fn(&Held) -> Option<f64>,
) -> Column {
    Column { name, key, kind, drawn: true, needs_autopilot: false, read }
}

const fn autopilot(
    name: &'static str,
    key: &'static str,
    kind: Kind,
    read: fn(&Held) -> Option<f64>,
) -> Column {
    Column { needs_autopilot: true, ..column(name, key, kind, read) }
}

static COLUMNS: [Column; 16] = [
    column("angle of attack, from the reference", "alpha", Kind::Angle, |held| {
        Some(held.linear.trim.point.alpha_rad)
    }),
    column("elevator", "elevator", Kind::Angle, |held| Some(held.linear.trim.point.elevator_rad)),
    column("throttle, 1 at the reference", "throttle", Kind::Plain, |held| {
        Some(held.linear.trim.point.throttle)
    }),
    column("thrust", "thrust", Kind::Force, |held| Some(held.linear.trim.thrust_n)),
    column("short period, frequency", "short_period_frequency", Kind::Frequency, |held| {
        Some(pair(held, ModeName::ShortPeriod)?.natural_frequency_rad_s)
    }),
    column("short period, damping", "short_period_damping", Kind::Plain, |held| {
        Some(pair(held, ModeName::ShortPeriod)?.damping_ratio)
    }),
    column("phugoid, frequency", "phugoid_frequency", Kind::Frequency, |held| {
        Some(pair(held, ModeName::Phugoid)?.natural_frequency_rad_s)
    }),
    column("phugoid, damping", "phugoid_damping", Kind::Plain, |held| {
        Some(pair(held, ModeName::Phugoid)?.damping_ratio)
    }),
    column(
        "longitudinal motion, time to double",
        "longitudinal_time_to_double",
        Kind::Time,
        doubles_s,
    ),
    column("Dutch roll, frequency", "dutch_roll_frequency", Kind::Frequency, |held| {
        Some(pair(held, ModeName::DutchRoll)?.natural_frequency_rad_s)
    }),
    column("Dutch roll, damping", "dutch_roll_damping", Kind::Plain, |held| {
        Some(pair(held, ModeName::DutchRoll)?.damping_ratio)
    }),
    column("control anticipation parameter", "cap", Kind::CapUnit, |held| {
        Some(short_period(held)?.cap)
    }),
    Column {
        drawn: false,
        ..column("its level, 4 for worse than 3", "cap_level", Kind::Plain, |held| {
            Some(f64::from(short_period(held)?.cap_level.level as u8) + 1.0)
        })
    },
    autopilot("loop, smaller gain margin up to 40 dB", "loop_gain_margin", Kind::Decibel, |held| {
        held.beside.as_ref()?.gain_margin_db
    }),
    autopilot("loop, decay of its slowest motion", "loop_decay", Kind::Rate, |held| {
        held.beside.as_ref()?.decay_per_s
    }),
    Column {
        drawn: false,
        ..autopilot("loop, spectral radius", "loop_spectral_radius", Kind::Plain, |held| {
            held.beside.as_ref()?.spectral_radius
        })
    },
];

/// What is told with or without an autopilot.
pub(super) fn columns(has_autopilot: bool) -> Vec<&'static Column> {
    COLUMNS.iter().filter(|column| has_autopilot || !column.needs_autopilot).collect()
}

impl Column {
    /// The value at a point in SI; none where it cannot be flown, and where a motion is no oscillation.
    pub(super) fn of(&self, point: &Point) -> Option<f64> {
        point.flight.as_ref().ok().and_then(self.read)
    }
}
