//! A simple wing leveller: stabilises the lateral motion while the controller under study flies pitch.

use fspid_aircraft::{AirMotion, Aircraft, Controls, ForceModel, RigidState, Trim, Vector3};

/// How fast the wings return to level, s.
pub const LEVELLING_TIME_S: f64 = 2.0;

/// A wing leveller: aileron against bank.
///
/// $$ \delta_a = -k_\phi \phi, \qquad k_\phi = \frac{-L_p}{L_{\delta_a} T}, \quad T = 2 \text{ s} $$
///
/// With the roll rate quasi-steady, $p = -L_{\delta_a} \delta_a / L_p$, the bank then falls as
/// $\dot \phi = -\phi / T$. $L_p$ and $L_{\delta_a}$ are what roll rate and aileron add to the roll
/// acceleration at the trim, so that the sign of the aileron is that of the aircraft's own data. The
/// aileron stays within its travel, its drive is ideal, and the rudder does not move. An aircraft
/// without aileron or without roll damping has no leveller.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WingLeveller {
    /// $k_\phi$: aileron per bank.
    pub gain: f64,
}

/// Half the width of the differences: 0.01 rad/s of roll rate, 0.01 rad of aileron.
const DIFFERENCE: f64 = 0.01;

impl WingLeveller {
    /// The leveller of an aircraft at its trim.
    #[must_use]
    pub fn of<M: ForceModel>(aircraft: &Aircraft<M>, trim: &Trim) -> Self {
        Self::with_time(aircraft, trim, LEVELLING_TIME_S)
    }

    /// The same with another time $T$, s.
    #[must_use]
    pub fn with_time<M: ForceModel>(aircraft: &Aircraft<M>, trim: &Trim, time_s: f64) -> Self {
        let damping = slope(|roll_rad_s| {
            let rates_rad_s = Vector3::new(roll_rad_s, 0.0, 0.0);
            roll_acceleration(aircraft, &RigidState { rates_rad_s, ..trim.state }, &trim.controls)
        });
        let power = slope(|aileron_rad| {
            let controls = Controls { aileron_rad, ..trim.controls };
            roll_acceleration(aircraft, &trim.state, &controls)
        });
        let gain = -damping / (power * time_s);
        Self { gain: if gain.is_finite() && damping < 0.0 { gain } else { 0.0 } }
    }

    /// Aileron at a bank, before its stops.
    #[must_use]
    pub fn aileron_rad(&self, bank_rad: f64) -> f64 {
        -self.gain * bank_rad
    }
}

/// A yaw damper: rudder against the yaw rate that a turn without sideslip does not need.
///
/// $$ \delta_r = -k_r (r - r_t), \quad r_t = \frac{g}{V} \sin\phi \cos\theta, \qquad
///    k_r = \frac{2 \zeta \sqrt{N_\beta} + N_r}{N_{\delta_r}} $$
///
/// $\sqrt{N_\beta}$ is near the frequency of the Dutch roll and $-N_r$ near twice its damping times that, so that the roll comes
/// near a damping ratio of $\zeta$ where it was less. The derivatives are taken of the yaw acceleration at the trim. An
/// aircraft without rudder, or with enough damping of its own, has no damper.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct YawDamper {
    /// $k_r$, s: rudder per yaw rate.
    pub gain_s: f64,
}

impl YawDamper {
    /// The damper of an aircraft at its trim for a damping ratio.
    #[must_use]
    pub fn of<M: ForceModel>(aircraft: &Aircraft<M>, trim: &Trim, damping_ratio: f64) -> Self {
        let yaw = |state: &RigidState, controls: &Controls| {
            let instant = aircraft.instant(state, controls, &AirMotion::STILL);
            instant.accelerations.angular_rad_s2.z
        };
        let damping = slope(|yaw_rad_s| {
            let rates_rad_s = Vector3::new(0.0, 0.0, yaw_rad_s);
            yaw(&RigidState { rates_rad_s, ..trim.state }, &trim.controls)
        });
        let power = slope(|rudder_rad| yaw(&trim.state, &Controls { rudder_rad, ..trim.controls }));
        let stiffness = slope(|sideslip_rad| {
            let velocity_m_s = trim.state.velocity_body_m_s;
            let aside_m_s = velocity_m_s.norm() * libm::tan(sideslip_rad);
            let velocity_body_m_s = velocity_m_s + Vector3::new(0.0, aside_m_s, 0.0);
            yaw(&RigidState { velocity_body_m_s, ..trim.state }, &trim.controls)
        });
        let missing = 2.0 * damping_ratio * stiffness.max(0.0).sqrt() + damping;
        let gain_s = missing / power;
        Self { gain_s: if gain_s.is_finite() && missing > 0.0 { gain_s } else { 0.0 } }
    }

    /// Rudder at a yaw rate, before its stops; `turn_rad_s` is that of a turn without sideslip.
    #[must_use]
    pub fn rudder_rad(&self, yaw_rad_s: f64, turn_rad_s: f64) -> f64 {
        -self.gain_s * (yaw_rad_s - turn_rad_s)
    }
}

fn slope(function: impl Fn(f64) -> f64) -> f64 {
    (function(DIFFERENCE) - function(-DIFFERENCE)) / (2.0 * DIFFERENCE)
}

fn roll_acceleration<M: ForceModel>(
    aircraft: &Aircraft<M>,
    state: &RigidState,
    controls: &Controls,
) -> f64 {
    aircraft.instant(state, controls, &AirMotion::STILL).accelerations.angular_rad_s2.x
}

#[cfg(test)]
mod tests {
    use fspid_aircraft::aerodynamics::derivatives::{
        DerivativeModel, DragLaw, Geometry, Lateral, LateralCoefficient, Longitudinal,
        LongitudinalCoefficient, ThrustLaw,
    };
    use fspid_aircraft::{Environment, MassProperties, Travel, TrimTarget, Validity};

    use super::*;

    /// Lengths and inertias of 1, a reference at 50 m/s in air of 1 kg/m³, roll derivatives as given.
    fn leveller(roll: LateralCoefficient) -> WingLeveller {
        let coefficient = |reference, alpha, elevator| LongitudinalCoefficient {
            reference,
            alpha,
            elevator,
            ..LongitudinalCoefficient::default()
        };
        let model = DerivativeModel {
            geometry: Geometry { area_m2: 1.0, span_m: 1.0, chord_m: 1.0 },
            longitudinal: Longitudinal {
                lift: coefficient(10.0 / 1250.0, 5.0, 0.0),
                drag: coefficient(0.01, 0.0, 0.0),
                pitch: coefficient(0.0, -1.0, -1.0),
                thrust_speed: 0.0,
            },
            lateral: Lateral { roll, ..Lateral::default() },
            reference_airspeed_m_s: 50.0,
            reference_thrust_n: 12.5,
            drag_law: DragLaw::Linear,
            thrust_law: ThrustLaw::Constant,
            validity: Validity::EVERYWHERE,
            travel: Travel::UNLIMITED,
        };
        let mass = MassProperties {
            mass_kg: 1.0,
            ix_kg_m2: 1.0,
            iy_kg_m2: 1.0,
            iz_kg_m2: 1.0,
            ixz_kg_m2: 0.0,
            engine_kg_m2_s: 0.0,
        };
        let environment = Environment::uniform(10.0, 1.0, 340.0);
        let aircraft = Aircraft::new(mass, model, environment).expect("a body");
        let target = TrimTarget { airspeed_m_s: 50.0, altitude_m: 0.0, flight_path_rad: 0.0 };
        WingLeveller::of(&aircraft, &aircraft.trim(target).expect("the reference"))
    }

    /// Lp = Clp b/2V and Lδ = Clδ share their factor: k = 0.4 · (1/100) / (0.1 · 2).
    #[test]
    fn the_gain_is_roll_damping_over_aileron_power_and_time() {
        for power in [0.1, -0.1] {
            let roll = LateralCoefficient { roll_rate: -0.4, aileron: power, ..Default::default() };
            let gain = leveller(roll).gain;
            assert!((gain - 0.004 / (power * LEVELLING_TIME_S)).abs() < 1e-9, "{gain}");
            assert!(leveller(roll).aileron_rad(0.1) * power < 0.0);
        }
    }

    #[test]
    fn without_aileron_or_roll_damping_there_is_no_leveller() {
        for (roll_rate, aileron) in [(0.0, 0.1), (0.2, 0.1), (-0.4, 0.0)] {
            let roll = LateralCoefficient { roll_rate, aileron, ..Default::default() };
            assert_eq!(leveller(roll), WingLeveller::default());
        }
    }
}
