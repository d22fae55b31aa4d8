//! What a flight knows, by the names of the standard, and units.

use fspid_aircraft::{Controls, Flow, Quantity as Limit};
use fspid_numeric::units::{DEGREE_RAD, FOOT_M, KNOT_M_S, POUND_FORCE_N, SLUG_KG};

use crate::flight::error::FlightError;
use crate::flight::sign::sign;
use crate::model::Port;

/// A unit in the spelling of the standard, and what it is in SI.
pub(super) type Unit = (&'static str, f64);

/// Units of one kind, the SI unit first.
pub(super) type Units = &'static [Unit];

pub(super) const ANGLE: Units = &[("rad", 1.0), ("deg", DEGREE_RAD)];
pub(super) const RATE: Units = &[("rad_s", 1.0), ("deg_s", DEGREE_RAD)];
pub(super) const SPEED: Units = &[("m_s", 1.0), ("ft_s", FOOT_M), ("nmi_h", KNOT_M_S)];
pub(super) const LENGTH: Units = &[("m", 1.0), ("ft", FOOT_M)];
const AREA: Units = &[("m2", 1.0), ("ft2", FOOT_M * FOOT_M)];
pub(super) const PART: Units = &[("nd", 1.0), ("frac", 1.0), ("pct", 0.01)];
const FORCE: Units = &[("N", 1.0), ("lbf", POUND_FORCE_N)];
const MOMENT: Units = &[("Nm", 1.0), ("ftlbf", FOOT_M * POUND_FORCE_N)];
const MASS: Units = &[("kg", 1.0), ("slug", SLUG_KG)];
const INERTIA: Units = &[("kgm2", 1.0), ("slugft2", FOOT_M * POUND_FORCE_N)];

/// Units of an output by the beginning of its name.
const OUTPUTS: &[(&str, Units)] = &[
    ("aeroBody", PART),
    ("bodyMomentOfInertia", INERTIA),
    ("bodyPosition", LENGTH),
    ("bodyProductOfInertia", INERTIA),
    ("referenceWingArea", AREA),
    ("referenceWing", LENGTH),
    ("thrustBodyForce", FORCE),
    ("thrustBodyMoment", MOMENT),
    ("totalMass", MASS),
];

/// Something that a flight knows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Quantity {
    Airspeed,
    Alpha,
    Beta,
    Roll,
    Pitch,
    Yaw,
    Elevator,
    Aileron,
    Rudder,
    Mach,
    Altitude,
    Power,
    AlphaRate,
}

/// Every quantity with its name in the standard and its units, in the order of [`Quantities`].
///
/// The lever angle of an engine is a part of its travel, written in percent.
const QUANTITIES: [(&str, Quantity, Units); 13] = [
    ("trueAirspeed", Quantity::Airspeed, SPEED),
    ("angleOfAttack", Quantity::Alpha, ANGLE),
    ("angleOfSideslip", Quantity::Beta, ANGLE),
    ("bodyAngularRate_Roll", Quantity::Roll, RATE),
    ("bodyAngularRate_Pitch", Quantity::Pitch, RATE),
    ("bodyAngularRate_Yaw", Quantity::Yaw, RATE),
    ("elevatorDeflection", Quantity::Elevator, ANGLE),
    ("aileronDeflection", Quantity::Aileron, ANGLE),
    ("rudderDeflection", Quantity::Rudder, ANGLE),
    ("mach", Quantity::Mach, PART),
    ("altitudeMSL", Quantity::Altitude, LENGTH),
    ("powerLeverAngle", Quantity::Power, PART),
    ("angleOfAttackRate", Quantity::AlphaRate, RATE),
];

impl Quantity {
    /// The quantity with that name; capitals do not count.
    pub(super) fn named(name: &str) -> Option<Self> {
        let found = QUANTITIES.iter().find(|(known, ..)| known.eq_ignore_ascii_case(name));
        found.map(|&(_, quantity, _)| quantity)
    }

    /// All names, in the order of the list.
    pub(super) fn all_names() -> [&'static str; QUANTITIES.len()] {
        QUANTITIES.map(|(name, ..)| name)
    }

    /// All names, with commas.
    pub(super) fn names() -> String {
        Self::all_names().join(", ")
    }

    /// SI units in one unit of a variable, negative of one that counts the other way.
    pub(super) fn factor(self, port: &Port) -> Result<f64, FlightError> {
        let row = QUANTITIES.iter().find(|(_, quantity, _)| *quantity == self);
        Ok(sign(port)? * factor(port, row.map_or(PART, |&(.., units)| units))?)
    }

    /// What a model's box calls it.
    pub(super) fn limit(self) -> Option<Limit> {
        match self {
            Self::Airspeed => Some(Limit::Airspeed),
            Self::Mach => Some(Limit::Mach),
            Self::Alpha => Some(Limit::Alpha),
            Self::Beta => Some(Limit::Beta),
            Self::Altitude => Some(Limit::Altitude),
            _ => None,
        }
    }
}

/// SI units in one unit of an output, negative of one that counts the other way.
pub(super) fn output_factor(port: &Port) -> Result<f64, FlightError> {
    let row = OUTPUTS.iter().find(|(beginning, _)| port.name.starts_with(beginning));
    Ok(sign(port)? * factor(port, row.map_or(PART, |&(_, units)| units))?)
}

pub(super) fn factor(port: &Port, units: Units) -> Result<f64, FlightError> {
    let found = units.iter().find(|(unit, _)| *unit == port.units);
    found.map(|&(_, factor)| factor).ok_or_else(|| FlightError::Units {
        name: port.name.clone(),
        found: port.units.clone(),
        known: units.iter().map(|&(unit, _)| unit).collect::<Vec<_>>().join(", "),
    })
}

/// Values of all quantities in SI, in the order of their list.
#[derive(Clone, Copy, Debug)]
pub(super) struct Quantities([f64; QUANTITIES.len()]);

impl Quantities {
    pub(super) fn of(flow: &Flow, controls: &Controls, power: f64) -> Self {
        let [roll, pitch, yaw] = flow.rates_rad_s.to_array();
        Self([
            flow.airspeed_m_s,
            flow.alpha_rad,
            flow.beta_rad,
            roll,
            pitch,
            yaw,
            controls.elevator_rad,
            controls.aileron_rad,
            controls.rudder_rad,
            flow.mach(),
            flow.altitude_m,
            power,
            0.0,
        ])
    }

    /// Values in the order of the list.
    pub(super) const fn new(values: [f64; QUANTITIES.len()]) -> Self {
        Self(values)
    }

    /// The same with the angle of attack changing at a rate; it rests otherwise.
    pub(super) fn with_alpha_rate(self, alpha_rate_rad_s: f64) -> Self {
        self.with(Quantity::AlphaRate, alpha_rate_rad_s)
    }

    /// The same with another value of one quantity.
    pub(super) fn with(mut self, quantity: Quantity, value: f64) -> Self {
        if let Some(place) = self.0.get_mut(quantity as usize) {
            *place = value;
        }
        self
    }

    #[inline]
    pub(super) fn get(&self, quantity: Quantity) -> f64 {
        self.0.get(quantity as usize).copied().unwrap_or(f64::NAN)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantities_stand_in_the_order_of_their_list() {
        for (index, &(name, quantity, units)) in QUANTITIES.iter().enumerate() {
            assert_eq!(quantity as usize, index);
            assert_eq!(Quantity::named(name), Some(quantity));
            assert_eq!(units[0].1, 1.0);
        }
    }

    #[test]
    fn a_slug_is_what_a_pound_force_moves_by_a_foot_a_second_squared() {
        assert!((MASS[1].1 - 14.593_902_937_206_364).abs() < 1e-12);
        assert!((INERTIA[1].1 - MASS[1].1 * FOOT_M * FOOT_M).abs() < 1e-15);
    }
}
