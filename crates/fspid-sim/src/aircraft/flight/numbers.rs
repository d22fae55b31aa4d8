//! The state vector of a flying aircraft, with read and write access to each component: used to perturb it for linearisation
//! by differences.

use fspid_aircraft::{EulerAngles, HALF_POWER, Quaternion, Spool};

use super::{AircraftFlight, AircraftMotion, Moving};
use crate::beyond::{AILERON, ALTITUDE, BEYOND, HEADING, POWER, THROTTLE};

impl AircraftFlight {
    /// Change of pitch, u, w, q, deflection and, for a lag of second order, its rate; SI.
    pub(crate) fn values(&self, motion: &AircraftMotion) -> Vec<f64> {
        let velocity = motion.body.state.velocity_body_m_s;
        let deflection_rad = self.actuator.deflection_rad(&motion.body.actuator);
        let mut values = vec![
            motion.theta_rad,
            velocity.x,
            velocity.z,
            motion.body.state.rates_rad_s.y,
            deflection_rad,
        ];
        values
            .extend((self.actuator.lag().order() == 2).then(|| motion.body.actuator.rate_rad_s()));
        values
    }

    /// Moves one of [`values`](Self::values).
    pub(crate) fn nudge(&self, motion: &mut AircraftMotion, place: usize, by: f64) {
        match place {
            0 => {
                let euler = motion.body.state.euler();
                let turned = EulerAngles { theta_rad: euler.theta_rad + by, ..euler };
                motion.body.state.attitude = Quaternion::from_euler(turned);
                motion.theta_rad += by;
            }
            1 => motion.body.state.velocity_body_m_s.x += by,
            2 => motion.body.state.velocity_body_m_s.z += by,
            3 => motion.body.state.rates_rad_s.y += by,
            _ => motion.body.actuator.nudge(place - 4, by),
        }
        self.look(motion);
    }

    /// True for an engine that does not follow its throttle at once.
    pub(crate) fn has_lagging_engine(&self) -> bool {
        self.plant.spool() != Spool::Instant
    }

    /// Of an engine that is led elsewhere while the power that it is asked for and the power that it has lie on two sides of half
    /// of it: on which side each is. Nothing of every other engine.
    pub(crate) fn sides_of_half_power(&self, motion: &AircraftMotion) -> Option<[bool; 2]> {
        let asked = self.gearing().power(motion.throttle);
        let sides = [asked, motion.body.power].map(|power| power >= HALF_POWER);
        (self.plant.spool() == Spool::StevensLewis).then_some(sides)
    }

    /// Altitude, heading, v, p, r, bank, power of the engine, aileron, rudder and throttle; SI. The surfaces are held from where
    /// leveller and damper had them last, with the bank that was commanded then, and so is the throttle, by which an engine that
    /// follows at once accelerates the aircraft that is looked at.
    pub(crate) fn beyond(&self, motion: &AircraftMotion) -> [f64; BEYOND] {
        let Moving { state, power, .. } = &motion.body;
        let (euler, rates_rad_s) = (state.euler(), state.rates_rad_s);
        [
            state.altitude_m(),
            euler.psi_rad,
            state.velocity_body_m_s.y,
            rates_rad_s.x,
            rates_rad_s.z,
            euler.phi_rad,
            *power,
            motion.aileron_rad,
            motion.rudder_rad,
            motion.throttle,
        ]
    }

    /// Moves one of [`beyond`](Self::beyond).
    pub(crate) fn nudge_beyond(&self, motion: &mut AircraftMotion, place: usize, by: f64) {
        let Moving { state, power, .. } = &mut motion.body;
        let euler = state.euler();
        match place {
            ALTITUDE => state.position_ned_m.z -= by,
            HEADING => {
                let psi_rad = euler.psi_rad + by;
                state.attitude = Quaternion::from_euler(EulerAngles { psi_rad, ..euler });
            }
            2 => state.velocity_body_m_s.y += by,
            3 => state.rates_rad_s.x += by,
            4 => state.rates_rad_s.z += by,
            5 => {
                let phi_rad = euler.phi_rad + by;
                state.attitude = Quaternion::from_euler(EulerAngles { phi_rad, ..euler });
            }
            POWER => *power += by,
            AILERON => motion.aileron_rad += by,
            THROTTLE => motion.throttle += by,
            _ => motion.rudder_rad += by,
        }
        self.look(motion);
    }
}
