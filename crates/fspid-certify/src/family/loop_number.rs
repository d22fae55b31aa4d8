//! Which number of a loop a place of a scenario is.

use fspid_proof::ScaledSensor;
use fspid_scenario::file::SettingPath;
use fspid_scenario::units::{FOOT_M, KNOT_M_S, SLUG_KG};

/// A number of the loop that may lie between bounds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum LoopNumber {
    /// A coefficient of the plant's numerator, highest power first.
    Numerator(usize),
    /// A coefficient of its denominator.
    Denominator(usize),
    /// The actuator's τ, s.
    TimeConstant,
    /// The actuator's natural frequency, rad/s.
    NaturalFrequency,
    /// The actuator's damping ratio.
    Damping,
    /// The scale error of a sensor, %.
    Scale(ScaledSensor),
    /// A number of an aircraft of derivatives, and the size of its unit in SI.
    Aircraft(AircraftNumber, f64),
}

/// A number that an aircraft's linear model follows from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum AircraftNumber {
    Mass,
    /// Moment of inertia in pitch.
    Inertia,
    /// Its radius of gyration.
    Gyration,
    /// Centre of gravity, as a share of the mean chord.
    CentreOfGravity,
    Airspeed,
    Altitude,
    /// A derivative: of lift, drag or pitching moment.
    Derivative(Coefficient, Derivative),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Coefficient {
    Lift,
    Drag,
    Pitch,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Derivative {
    Alpha,
    AlphaRate,
    PitchRate,
    Speed,
    Elevator,
}

impl LoopNumber {
    /// The sensor that it is the scale of.
    pub(super) fn sensor(self) -> Option<ScaledSensor> {
        match self {
            Self::Scale(sensor) => Some(sensor),
            _ => None,
        }
    }

    /// True for what the dynamic pressure of a trim follows from, by which gains are scheduled.
    pub(super) fn is_of_pressure(self) -> bool {
        matches!(self, Self::Aircraft(AircraftNumber::Airspeed | AircraftNumber::Altitude, _))
    }

    /// The number at a place; none for places that are none of these.
    pub(super) fn at(path: &SettingPath) -> Option<Self> {
        let (table, rest) = path.text().split_once('.')?;
        match (table, rest) {
            ("actuator", "time_constant_s") => Some(Self::TimeConstant),
            ("actuator", "natural_frequency_rad_s") => Some(Self::NaturalFrequency),
            ("actuator", "damping") => Some(Self::Damping),
            ("sensor", "pitch.scale_error_pct") => Some(Self::Scale(ScaledSensor::Pitch)),
            ("sensor", "rate.scale_error_pct") => Some(Self::Scale(ScaledSensor::Rate)),
            ("plant", _) => {
                let last = rest.rsplit('.').next()?;
                let (name, index) = last.strip_suffix(']')?.split_once('[')?;
                let index = index.parse().ok()?;
                match name {
                    "numerator" => Some(Self::Numerator(index)),
                    "denominator" => Some(Self::Denominator(index)),
                    _ => None,
                }
            }
            ("aircraft", _) => of_aircraft(rest).map(|(number, unit)| Self::Aircraft(number, unit)),
            _ => None,
        }
    }
}

fn of_aircraft(key: &str) -> Option<(AircraftNumber, f64)> {
    let slug_ft2 = SLUG_KG * FOOT_M * FOOT_M;
    Some(match key {
        "mass_kg" => (AircraftNumber::Mass, 1.0),
        "iy_kg_m2" => (AircraftNumber::Inertia, 1.0),
        "iy_slug_ft2" => (AircraftNumber::Inertia, slug_ft2),
        "iy_gyration_m" => (AircraftNumber::Gyration, 1.0),
        "cg_mac" => (AircraftNumber::CentreOfGravity, 1.0),
        "airspeed_m_s" => (AircraftNumber::Airspeed, 1.0),
        "airspeed_kt" => (AircraftNumber::Airspeed, KNOT_M_S),
        "airspeed_ft_s" => (AircraftNumber::Airspeed, FOOT_M),
        "altitude_m" => (AircraftNumber::Altitude, 1.0),
        "altitude_ft" => (AircraftNumber::Altitude, FOOT_M),
        _ => {
            let (_, derivative) = key.split_once(".longitudinal.")?;
            let (row, name) = derivative.split_once('.')?;
            let row = match row {
                "lift" => Coefficient::Lift,
                "drag" => Coefficient::Drag,
                "pitch" => Coefficient::Pitch,
                _ => return None,
            };
            let name = match name {
                "alpha" => Derivative::Alpha,
                "alpha_rate" => Derivative::AlphaRate,
                "pitch_rate" => Derivative::PitchRate,
                "speed" => Derivative::Speed,
                "elevator" => Derivative::Elevator,
                _ => return None,
            };
            (AircraftNumber::Derivative(row, name), 1.0)
        }
    })
}
