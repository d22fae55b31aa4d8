//! What is added to the coefficients of an aircraft: by a flap, by a gear, by another Mach number.

use super::derivatives::{Lateral, LateralCoefficient, Longitudinal, LongitudinalCoefficient};

/// Increments of all coefficients, about the centre of gravity of the derivatives that they are added to.
///
/// An increment is what the coefficient is more at the same angle of attack, sideslip, rates and deflections, as data
/// sheets print it: that of drag has the drag due to more lift in it.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Increment {
    /// Of lift, drag and pitching moment.
    pub longitudinal: Longitudinal,
    /// Of side force, rolling moment and yawing moment.
    pub lateral: Lateral,
}

impl Increment {
    /// These increments and a share of others.
    #[must_use]
    pub fn plus(&self, share: f64, more: &Self) -> Self {
        let row = |base: &LongitudinalCoefficient, more: &LongitudinalCoefficient| {
            LongitudinalCoefficient {
                reference: base.reference + share * more.reference,
                alpha: base.alpha + share * more.alpha,
                alpha_rate: base.alpha_rate + share * more.alpha_rate,
                pitch_rate: base.pitch_rate + share * more.pitch_rate,
                speed: base.speed + share * more.speed,
                elevator: base.elevator + share * more.elevator,
            }
        };
        let aside = |base: &LateralCoefficient, more: &LateralCoefficient| LateralCoefficient {
            beta: base.beta + share * more.beta,
            roll_rate: base.roll_rate + share * more.roll_rate,
            yaw_rate: base.yaw_rate + share * more.yaw_rate,
            aileron: base.aileron + share * more.aileron,
            rudder: base.rudder + share * more.rudder,
        };
        let (of, by) = (&self.longitudinal, &more.longitudinal);
        let (of_lateral, by_lateral) = (&self.lateral, &more.lateral);
        Self {
            longitudinal: Longitudinal {
                lift: row(&of.lift, &by.lift),
                drag: row(&of.drag, &by.drag),
                pitch: row(&of.pitch, &by.pitch),
                thrust_speed: of.thrust_speed + share * by.thrust_speed,
            },
            lateral: Lateral {
                side: aside(&of_lateral.side, &by_lateral.side),
                roll: aside(&of_lateral.roll, &by_lateral.roll),
                yaw: aside(&of_lateral.yaw, &by_lateral.yaw),
            },
        }
    }
}

/// Something that is extended and retracted in flight: a flap, a gear, a speedbrake.
#[derive(Debug, Clone, PartialEq)]
pub struct Configuration {
    /// Name in scenarios.
    pub name: String,
    /// What it adds when it is fully out; linear in how far it is out.
    pub increment: Increment,
    /// True airspeed up to which it may be out at all, m/s; infinite where nobody says.
    pub most_airspeed_m_s: f64,
    /// Where the numbers come from, or the assumption that they are.
    pub source: String,
}
