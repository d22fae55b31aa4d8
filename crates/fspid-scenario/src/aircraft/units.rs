//! Units in which aircraft are asked about and answered for.

use crate::units::{DEGREE_RAD, FOOT_M, POUND_FORCE_N, SLUG_KG};

/// Metres in a nautical mile, by definition.
const NAUTICAL_MILE_M: f64 = 1852.0;

/// A system of units.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Units {
    /// Metres, kilograms, newtons.
    #[default]
    Si,
    /// Feet, slugs, pounds of force.
    English,
}

/// What a number measures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A number without a unit.
    Plain,
    /// A speed.
    Speed,
    /// A length.
    Length,
    /// An area.
    Area,
    /// A mass.
    Mass,
    /// A force.
    Force,
    /// A moment of inertia.
    Inertia,
    /// An angular momentum.
    Momentum,
    /// A density of air.
    Density,
    /// A pressure.
    Pressure,
    /// An acceleration.
    Acceleration,
    /// An angle.
    Angle,
    /// An angular acceleration.
    AngularAcceleration,
    /// A frequency.
    Frequency,
    /// A rate, 1/s.
    Rate,
    /// A squared rate, 1/s².
    SquaredRate,
    /// Something for each length.
    PerLength,
    /// Something for each length and time.
    PerLengthTime,
    /// Control anticipation: angular acceleration for each multiple of gravity.
    CapUnit,
    /// Multiples of gravity for each angle of attack.
    LoadPerAngle,
    /// A ratio in decibels.
    Decibel,
    /// A time.
    Time,
}

/// A unit: how it is written, the last part of a key, and its size in SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unit {
    /// How it is written.
    pub symbol: &'static str,
    /// The last part of a key.
    pub key: &'static str,
    /// Its size in SI.
    pub size: f64,
}

const fn unit(symbol: &'static str, key: &'static str, size: f64) -> Unit {
    Unit { symbol, key, size }
}

impl Units {
    /// The unit of a kind of quantity.
    #[must_use]
    pub const fn of(self, kind: Kind) -> Unit {
        match (kind, self) {
            (Kind::Plain, _) => unit("", "", 1.0),
            (Kind::Angle, _) => unit("deg", "deg", DEGREE_RAD),
            (Kind::AngularAcceleration, _) => unit("deg/s²", "deg_s2", DEGREE_RAD),
            (Kind::Frequency, _) => unit("rad/s", "rad_s", 1.0),
            (Kind::Rate, _) => unit("1/s", "per_s", 1.0),
            (Kind::SquaredRate, _) => unit("1/s²", "per_s2", 1.0),
            (Kind::CapUnit, _) => unit("rad/s² per g", "rad_s2_per_g", 1.0),
            (Kind::LoadPerAngle, _) => unit("g/rad", "g_per_rad", 1.0),
            (Kind::Decibel, _) => unit("dB", "db", 1.0),
            (Kind::Time, _) => unit("s", "s", 1.0),
            (_, Self::Si) => si(kind),
            (_, Self::English) => english(kind),
        }
    }

    /// A value in SI as it is told.
    #[must_use]
    pub fn told(self, kind: Kind, value_si: f64) -> f64 {
        value_si / self.of(kind).size
    }

    /// Name for programs.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Si => "si",
            Self::English => "english",
        }
    }
}

const fn si(kind: Kind) -> Unit {
    match kind {
        Kind::Speed => unit("m/s", "m_s", 1.0),
        Kind::Length => unit("m", "m", 1.0),
        Kind::Area => unit("m²", "m2", 1.0),
        Kind::Mass => unit("kg", "kg", 1.0),
        Kind::Force => unit("N", "n", 1.0),
        Kind::Inertia => unit("kg m²", "kg_m2", 1.0),
        Kind::Momentum => unit("kg m²/s", "kg_m2_s", 1.0),
        Kind::Density => unit("kg/m³", "kg_m3", 1.0),
        Kind::Pressure => unit("Pa", "pa", 1.0),
        Kind::PerLength => unit("1/m", "per_m", 1.0),
        Kind::PerLengthTime => unit("1/(m s)", "per_m_s", 1.0),
        _ => unit("m/s²", "m_s2", 1.0),
    }
}

const fn english(kind: Kind) -> Unit {
    match kind {
        Kind::Speed => unit("ft/s", "ft_s", FOOT_M),
        Kind::Length => unit("ft", "ft", FOOT_M),
        Kind::Area => unit("ft²", "ft2", FOOT_M * FOOT_M),
        Kind::Mass => unit("slug", "slug", SLUG_KG),
        Kind::Force => unit("lbf", "lbf", POUND_FORCE_N),
        Kind::Inertia => unit("slug ft²", "slug_ft2", SLUG_KG * FOOT_M * FOOT_M),
        Kind::Momentum => unit("slug ft²/s", "slug_ft2_s", SLUG_KG * FOOT_M * FOOT_M),
        Kind::Density => unit("slug/ft³", "slug_ft3", SLUG_KG / (FOOT_M * FOOT_M * FOOT_M)),
        Kind::Pressure => unit("psf", "psf", POUND_FORCE_N / (FOOT_M * FOOT_M)),
        Kind::PerLength => unit("1/ft", "per_ft", 1.0 / FOOT_M),
        Kind::PerLengthTime => unit("1/(ft s)", "per_ft_s", 1.0 / FOOT_M),
        _ => unit("ft/s²", "ft_s2", FOOT_M),
    }
}

/// Units that an airspeed may be given in.
pub const SPEEDS: [Unit; 4] = [
    unit("m/s", "m_s", 1.0),
    unit("km/h", "km_h", 1.0 / 3.6),
    unit("ft/s", "ft_s", FOOT_M),
    unit("kt", "kt", NAUTICAL_MILE_M / 3600.0),
];

/// Units that an altitude may be given in.
pub const LENGTHS: [Unit; 3] =
    [unit("km", "km", 1000.0), unit("m", "m", 1.0), unit("ft", "ft", FOOT_M)];

/// A pound of mass, by definition.
const POUND_KG: f64 = 0.453_592_37;

/// Units that a mass may be given in.
pub const MASSES: [Unit; 4] = [
    unit("kg", "kg", 1.0),
    unit("t", "t", 1000.0),
    unit("lb", "lb", POUND_KG),
    unit("slug", "slug", SLUG_KG),
];

/// Units that a moment of inertia may be given in.
pub const INERTIAS: [Unit; 2] =
    [unit("kg m2", "kg_m2", 1.0), unit("slug ft2", "slug_ft2", SLUG_KG * FOOT_M * FOOT_M)];

/// Units that an angle may be given in.
pub const ANGLES: [Unit; 2] = [unit("deg", "deg", DEGREE_RAD), unit("rad", "rad", 1.0)];

/// Units that a time may be given in.
pub const TIMES: [Unit; 2] = [unit("ms", "ms", 1e-3), unit("s", "s", 1.0)];

/// A knot in m/s.
pub const KNOT_M_S: f64 = NAUTICAL_MILE_M / 3600.0;
