//! Where a model is meant to be used, and by which limit it is left.

use std::fmt;

use crate::controls::Controls;
use crate::error::AircraftError;
use crate::flow::Flow;
use crate::words::Words;

/// A closed interval; its ends may be infinite.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Range {
    /// Lower end.
    pub min: f64,
    /// Upper end.
    pub max: f64,
}

impl Range {
    /// All numbers.
    pub const ALL: Self = Self { min: f64::NEG_INFINITY, max: f64::INFINITY };

    /// Range between two ends.
    ///
    /// # Errors
    /// Ends that are not in order, or NaN.
    pub fn new(what: &'static str, min: f64, max: f64) -> Result<Self, AircraftError> {
        if min < max {
            Ok(Self { min, max })
        } else {
            Err(AircraftError::EmptyRange { what, min, max })
        }
    }

    /// Range of one size on both sides of zero.
    #[must_use]
    pub const fn within(size: f64) -> Self {
        Self { min: -size, max: size }
    }

    /// Whether a value is inside; a NaN never is.
    #[must_use]
    pub fn contains(&self, value: f64) -> bool {
        self.min <= value && value <= self.max
    }

    /// The value of the range that is nearest.
    #[must_use]
    pub fn clamp(&self, value: f64) -> f64 {
        if value < self.min {
            self.min
        } else if value > self.max {
            self.max
        } else {
            value
        }
    }
}

/// What has a limit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Quantity {
    /// True airspeed in m/s.
    Airspeed,
    /// Mach number.
    Mach,
    /// Angle of attack in rad.
    Alpha,
    /// Sideslip in rad.
    Beta,
    /// Altitude in m.
    Altitude,
    /// Elevator in rad.
    Elevator,
    /// Aileron in rad.
    Aileron,
    /// Rudder in rad.
    Rudder,
    /// Throttle in the measure of the model.
    Throttle,
    /// Fuel in kg.
    Fuel,
    /// What enters a table of the model and is none of these, in the unit of its file.
    Table(TableInput),
}

/// A variable that enters tables.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct TableInput {
    name: Words<48>,
    unit: Words<16>,
}

impl TableInput {
    /// The variable with an identifier and a unit of its file; both are cut where they are very long.
    #[must_use]
    pub fn new(id: &str, unit: &str) -> Self {
        let unit = if unit == "nd" { "" } else { unit };
        Self { name: Words::new(&format!("table input {id}")), unit: Words::new(unit) }
    }
}

impl Quantity {
    /// Name for a sentence.
    #[must_use]
    pub fn name(&self) -> &str {
        match self {
            Self::Airspeed => "airspeed",
            Self::Mach => "Mach number",
            Self::Alpha => "angle of attack",
            Self::Beta => "sideslip",
            Self::Altitude => "altitude",
            Self::Elevator => "elevator",
            Self::Aileron => "aileron",
            Self::Rudder => "rudder",
            Self::Throttle => "throttle",
            Self::Fuel => "fuel",
            Self::Table(input) => input.name.as_str(),
        }
    }

    /// Unit of its values here.
    #[must_use]
    pub fn unit(&self) -> &str {
        match self {
            Self::Airspeed => "m/s",
            Self::Altitude => "m",
            Self::Fuel => "kg",
            Self::Mach | Self::Throttle => "",
            Self::Alpha | Self::Beta | Self::Elevator | Self::Aileron | Self::Rudder => "rad",
            Self::Table(input) => input.unit.as_str(),
        }
    }
}

/// A quantity that is not where it is allowed to be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Departure {
    /// What.
    pub quantity: Quantity,
    /// Where it is.
    pub value: f64,
    /// Where it may be.
    pub allowed: Range,
}

impl fmt::Display for Departure {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { quantity, value, allowed: Range { min, max } } = self;
        if *quantity == Quantity::Fuel {
            return formatter.write_str("the tank is empty, allowed is fuel for the whole flight");
        }
        let (name, unit) = (quantity.name(), quantity.unit());
        let space = if unit.is_empty() { "" } else { " " };
        write!(formatter, "{name} {value}{space}{unit}, allowed {min} to {max}{space}{unit}")
    }
}

/// Ranges of flight in which a model is known to be worth something.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Validity {
    /// True airspeed in m/s.
    pub airspeed_m_s: Range,
    /// Mach number.
    pub mach: Range,
    /// Angle of attack in rad.
    pub alpha_rad: Range,
    /// Sideslip in rad.
    pub beta_rad: Range,
    /// Geopotential altitude in m.
    pub altitude_m: Range,
}

impl Validity {
    /// No limit known.
    pub const EVERYWHERE: Self = Self {
        airspeed_m_s: Range::ALL,
        mach: Range::ALL,
        alpha_rad: Range::ALL,
        beta_rad: Range::ALL,
        altitude_m: Range::ALL,
    };

    /// First limit by which a flow is outside, in the order of the fields.
    #[must_use]
    pub fn departure(&self, flow: &Flow) -> Option<Departure> {
        self.departures(flow).next()
    }

    /// All limits by which a flow is outside.
    pub fn departures(&self, flow: &Flow) -> impl Iterator<Item = Departure> + use<> {
        outside([
            (Quantity::Airspeed, flow.airspeed_m_s, self.airspeed_m_s),
            (Quantity::Mach, flow.mach(), self.mach),
            (Quantity::Alpha, flow.alpha_rad, self.alpha_rad),
            (Quantity::Beta, flow.beta_rad, self.beta_rad),
            (Quantity::Altitude, flow.altitude_m, self.altitude_m),
        ])
    }
}

/// How far the controls of a model go.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Travel {
    /// Elevator.
    pub elevator_rad: Range,
    /// Aileron.
    pub aileron_rad: Range,
    /// Rudder.
    pub rudder_rad: Range,
    /// Throttle.
    pub throttle: Range,
}

impl Travel {
    /// No limit known.
    pub const UNLIMITED: Self = Self {
        elevator_rad: Range::ALL,
        aileron_rad: Range::ALL,
        rudder_rad: Range::ALL,
        throttle: Range::ALL,
    };

    /// All controls that are beyond their stops.
    pub fn departures(&self, controls: &Controls) -> impl Iterator<Item = Departure> + use<> {
        outside([
            (Quantity::Elevator, controls.elevator_rad, self.elevator_rad),
            (Quantity::Aileron, controls.aileron_rad, self.aileron_rad),
            (Quantity::Rudder, controls.rudder_rad, self.rudder_rad),
            (Quantity::Throttle, controls.throttle, self.throttle),
        ])
    }

    /// The nearest positions that the controls can take.
    #[must_use]
    pub fn clamp(&self, controls: Controls) -> Controls {
        Controls {
            elevator_rad: self.elevator_rad.clamp(controls.elevator_rad),
            aileron_rad: self.aileron_rad.clamp(controls.aileron_rad),
            rudder_rad: self.rudder_rad.clamp(controls.rudder_rad),
            throttle: self.throttle.clamp(controls.throttle),
        }
    }
}

fn outside<const N: usize>(
    values: [(Quantity, f64, Range); N],
) -> impl Iterator<Item = Departure> + use<N> {
    values
        .into_iter()
        .filter(|(_, value, allowed)| !allowed.contains(*value))
        .map(|(quantity, value, allowed)| Departure { quantity, value, allowed })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::atmosphere::Air;
    use crate::vector::Vector3;

    fn flow(velocity_body_m_s: Vector3, altitude_m: f64) -> Flow {
        let air = Air::standard(0.0).expect("sea level");
        Flow::new(velocity_body_m_s, Vector3::ZERO, altitude_m, air)
    }

    fn box_of_a_light_aircraft() -> Validity {
        Validity {
            airspeed_m_s: Range { min: 30.0, max: 80.0 },
            alpha_rad: Range { min: -0.1, max: 0.2 },
            ..Validity::EVERYWHERE
        }
    }

    #[test]
    fn every_limit_that_is_left_is_named() {
        let validity = box_of_a_light_aircraft();
        let inside = flow(Vector3::new(50.0, 0.0, 2.0), 0.0);
        assert_eq!(validity.departure(&inside), None);
        let outside = flow(Vector3::new(20.0, 0.0, 10.0), 0.0);
        let left: Vec<_> = validity.departures(&outside).map(|out| out.quantity).collect();
        assert_eq!(left, [Quantity::Airspeed, Quantity::Alpha]);
    }

    #[test]
    fn a_flow_that_is_not_a_number_is_outside() {
        let broken = flow(Vector3::new(f64::NAN, 0.0, 0.0), 0.0);
        assert!(box_of_a_light_aircraft().departure(&broken).is_some());
        assert!(!Range::ALL.contains(f64::NAN));
    }

    #[test]
    fn a_departure_says_what_is_where_and_what_is_allowed() {
        let slow = flow(Vector3::new(20.0, 0.0, 0.0), 0.0);
        let departure = box_of_a_light_aircraft().departure(&slow).expect("too slow");
        assert_eq!(departure.to_string(), "airspeed 20 m/s, allowed 30 to 80 m/s");
    }

    #[test]
    fn ends_in_the_wrong_order_are_refused() {
        assert!(Range::new("elevator in rad", 0.3, -0.3).is_err());
        assert!(Range::new("elevator in rad", f64::NAN, 1.0).is_err());
        assert!(Range::new("elevator in rad", f64::NEG_INFINITY, 1.0).is_ok());
    }
}
