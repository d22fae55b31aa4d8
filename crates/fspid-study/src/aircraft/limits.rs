//! Where a model is trusted, and how far its controls go.

use fspid_aircraft::{Travel, Validity};

use super::facts::Facts;
use fspid_scenario::aircraft::units::Kind;

/// Where a model is trusted; `alpha` is what its angle of attack is called.
pub(super) fn validity(alpha: &str, validity: &Validity) -> Facts {
    Facts::default()
        .range("true airspeed", "airspeed", Kind::Speed, validity.airspeed_m_s)
        .range("Mach number", "mach", Kind::Plain, validity.mach)
        .range(alpha, "alpha", Kind::Angle, validity.alpha_rad)
        .range("sideslip", "beta", Kind::Angle, validity.beta_rad)
        .range("altitude", "altitude", Kind::Length, validity.altitude_m)
}

/// How far controls go; `throttle` is what it is called.
pub(super) fn travel(throttle: &str, travel: &Travel) -> Facts {
    let elevator = "elevator, trailing edge down positive";
    Facts::default()
        .range(elevator, "elevator", Kind::Angle, travel.elevator_rad)
        .range("aileron", "aileron", Kind::Angle, travel.aileron_rad)
        .range("rudder", "rudder", Kind::Angle, travel.rudder_rad)
        .range(throttle, "throttle", Kind::Plain, travel.throttle)
}
