//! What is observable of an aircraft at a sample.

use fspid_aircraft::{AirMotion, Controls, Flow, RigidState, Vector3, load_factors};

use super::{AircraftFlight, AircraftMotion, AircraftSample, Moving, Sight};

impl AircraftFlight {
    /// What is observable at a sample beyond pitch.
    pub(crate) fn sample(&self, motion: &AircraftMotion, elevator_rad: f64) -> AircraftSample {
        let air = self.air(motion);
        let controls = self.controls(motion, elevator_rad);
        let instant = self.instant_in(motion.sight.flow, &motion.body, &controls, &air);
        let felt = [instant.loads.force_n, instant.accelerations.velocity_rate_body_m_s2];
        self.observed(motion, &controls, &air, felt)
    }

    /// Controls at a sample.
    pub(super) fn controls(&self, motion: &AircraftMotion, elevator_rad: f64) -> Controls {
        let throttle = self.acting_throttle(motion.body.power, motion.throttle);
        let throttle = self.fed_throttle(motion.body.burnt_kg, throttle);
        let &AircraftMotion { aileron_rad, rudder_rad, .. } = motion;
        Controls { elevator_rad, aileron_rad, rudder_rad, throttle }
    }

    /// What is observable with a force of air and engine, N, and a rate of change of the velocity's components, m/s².
    pub(super) fn observed(
        &self,
        motion: &AircraftMotion,
        controls: &Controls,
        air: &AirMotion,
        [force_n, velocity_rate_m_s2]: [Vector3; 2],
    ) -> AircraftSample {
        let (state, Sight { euler: attitude, flow }) = (&motion.body.state, &motion.sight);
        let felt = self.load_factors(&motion.body, force_n);
        let [north_m, east_m, _] = state.position_ned_m.to_array();
        let over_ground_m_s = state.attitude.to_ned(state.velocity_body_m_s);
        let [over_north_m_s, over_east_m_s, sink_m_s] = over_ground_m_s.to_array();
        let climb_m_s = -sink_m_s;
        let ground_speed_m_s = libm::hypot(over_north_m_s, over_east_m_s);
        AircraftSample {
            airspeed_m_s: flow.airspeed_m_s,
            equivalent_airspeed_m_s: flow.equivalent_airspeed_m_s(),
            mach: flow.mach(),
            altitude_m: state.altitude_m(),
            alpha_rad: flow.alpha_rad,
            bank_rad: attitude.phi_rad,
            aileron_rad: motion.aileron_rad,
            load_factor: -felt.z,
            load_factors: felt.to_array(),
            air_m_s: (state.attitude.to_body(air.wind_ned_m_s) + air.gust_body_m_s).to_array(),
            position_m: [north_m, east_m],
            heading_rad: attitude.psi_rad,
            attitude_rad: attitude.theta_rad,
            sideslip_rad: flow.beta_rad,
            roll_yaw_rad_s: [state.rates_rad_s.x, state.rates_rad_s.z],
            throttle: controls.throttle,
            flight_path_rad: libm::atan2(climb_m_s, ground_speed_m_s),
            climb_m_s,
            ground_speed_m_s,
            over_ground_m_s: [over_north_m_s, over_east_m_s],
            path_acceleration_m_s2: path_acceleration_m_s2(state, velocity_rate_m_s2),
            air_rad_s: air.gust_rates_rad_s.to_array(),
            energy_height_m: self.energy_height_m(flow),
            apparent_vertical_rad: apparent_vertical_rad(state, attitude.psi_rad, felt),
            departure: self.departure(&motion.body, (flow, controls)),
            shown: self.shown(&motion.body),
        }
    }

    fn energy_height_m(&self, flow: &Flow) -> f64 {
        let gravity_m_s2 = self.aircraft().environment().gravity_m_s2;
        let airspeed_m_s = flow.airspeed_m_s;
        flow.altitude_m + airspeed_m_s * airspeed_m_s / (2.0 * gravity_m_s2)
    }

    fn load_factors(&self, body: &Moving, force_n: Vector3) -> Vector3 {
        let gravity_m_s2 = self.aircraft().environment().gravity_m_s2;
        load_factors(force_n, self.mass(body).mass_kg, gravity_m_s2)
    }
}

/// Angle between the true vertical and that of a pendulum, $\arctan(a_x / g)$ with the acceleration
/// along the heading, rad.
fn apparent_vertical_rad(state: &RigidState, heading_rad: f64, load_factors: Vector3) -> f64 {
    let felt = state.attitude.to_ned(load_factors);
    let (sine, cosine) = crate::math::sin_cos(heading_rad);
    libm::atan2(felt.x * cosine + felt.y * sine, 1.0)
}

/// How fast the speed over the ground changes, m/s²; 0 at rest. Turning with the body changes no length.
fn path_acceleration_m_s2(state: &RigidState, velocity_rate_m_s2: Vector3) -> f64 {
    let velocity_m_s = state.velocity_body_m_s;
    let speed_m_s = velocity_m_s.norm();
    let along = velocity_m_s.dot(velocity_rate_m_s2);
    if speed_m_s > 0.0 { along / speed_m_s } else { 0.0 }
}
