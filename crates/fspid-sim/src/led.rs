//! A mode that leads an aircraft away from where it started: which, by what, and where to.

use core::fmt;

use fspid_numeric::units::degrees;

use crate::autopilot::Quantity;

/// Which part of the flight of a mode.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Leg {
    /// What it comes to in time.
    End,
    /// The way there, which lasts.
    OnTheWay,
    /// A turn with nobody at the throttle: the airspeed falls to one of its own, which is not known.
    Turn,
    /// A turn in which throttle or pitch do not hold what they are to.
    InTurn,
}

/// An autopilot mode whose steady flight differs from the initial trim.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Led {
    /// Number of the mode, from 0.
    pub mode: usize,
    /// What is written that it holds, in SI units, if anything is.
    pub target: Option<(Quantity, f64)>,
    /// The airspeed to which it leads, m/s; none where it leads to no straight flight within the limits.
    pub airspeed_m_s: Option<f64>,
    /// On which part of its flight.
    pub leg: Leg,
}

impl fmt::Display for Led {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "mode {} of the autopilot", self.mode + 1)?;
        if let Some((quantity, target)) = self.target {
            let (value, unit) = match quantity {
                Quantity::Altitude | Quantity::GlideSlope => (target, "m"),
                Quantity::VerticalSpeed | Quantity::Airspeed => (target, "m/s"),
                Quantity::FlightPath | Quantity::Heading => (degrees(target), "deg"),
            };
            // No more digits than say something.
            let value = libm::round(value * 1e6) / 1e6;
            write!(f, ", which holds {} at {value} {unit},", quantity.in_words())?;
        }
        let when = match self.leg {
            Leg::End => "in the end",
            Leg::OnTheWay => "on the way there",
            Leg::InTurn => "in its turn",
            Leg::Turn => {
                return f.write_str(
                    " turns with nobody at the throttle, and so comes to an airspeed of its own, which is not asked",
                );
            }
        };
        match self.airspeed_m_s {
            Some(airspeed_m_s) => write!(
                f,
                " brings the aircraft {when} to {airspeed_m_s:.1} m/s, with the throttle as it is if nobody moves it, and as far as its limits go if somebody does"
            ),
            None => write!(
                f,
                " leads {when} to no steady flight within the limits of the aircraft's data, its controls and its loops, with the throttle as it is where nobody moves it"
            ),
        }
    }
}
