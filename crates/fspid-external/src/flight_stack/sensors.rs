//! What PX4's sensors show of an aircraft on board.

use fspid_aircraft::atmosphere::{
    Air, SEA_LEVEL_DENSITY_KG_M3, SEA_LEVEL_PRESSURE_PA, STANDARD_GRAVITY_M_S2,
};
use fspid_aircraft::{EulerAngles, Quaternion, Vector3};
use fspid_mavlink::{HilAttitude, HilPlace, HilSensor};
use fspid_sim::flight_stack::{Aboard, Place};

use crate::earth::EARTH_RADIUS_M;

/// Magnetic field of the Earth's dipole at its equator, gauss, an assumption: 31.2 µT, as if its axis were that of the
/// Earth. A real field is up to half as strong again.
const EQUATOR_GAUSS: f64 = 0.312;

/// What is shown.
pub(super) struct Sensed {
    pub(super) sensors: HilSensor,
    pub(super) place: HilPlace,
    pub(super) attitude: HilAttitude,
}

/// What sensors without errors show at a time, µs.
///
/// Beyond the standard atmosphere the air of its end is shown.
pub(super) fn sensed(aboard: &Aboard, place: &Place, time_us: u64) -> Sensed {
    let [phi_rad, theta_rad, psi_rad] = aboard.attitude_rad;
    let attitude = Quaternion::from_euler(EulerAngles { phi_rad, theta_rad, psi_rad });
    let [north_m, east_m, down_m] = aboard.position_m;
    let air = Air::standard((-down_m).clamp(-5_000.0, 84_852.0)).ok();
    let pressure_pa = air.map_or(SEA_LEVEL_PRESSURE_PA, |air| air.pressure_pa);
    let density_kg_m3 = air.map_or(SEA_LEVEL_DENSITY_KG_M3, |air| air.density_kg_m3);
    let dynamic_pressure_pa = 0.5 * density_kg_m3 * aboard.airspeed_m_s * aboard.airspeed_m_s;
    let round = libm::cos(place.latitude_rad).max(0.01);
    Sensed {
        sensors: HilSensor {
            time_us,
            felt_m_s2: aboard.felt_m_s2,
            rates_rad_s: aboard.rates_rad_s,
            field_gauss: attitude.to_body(field_gauss(place)).to_array(),
            pressure_pa,
            dynamic_pressure_pa,
            pressure_altitude_m: -down_m,
            temperature_k: air.map_or(f64::NAN, |air| air.temperature_k),
        },
        place: HilPlace {
            time_us,
            latitude_deg: (place.latitude_rad + north_m / EARTH_RADIUS_M).to_degrees(),
            longitude_deg: (place.longitude_rad + east_m / (EARTH_RADIUS_M * round)).to_degrees(),
            altitude_m: -down_m,
            velocity_m_s: aboard.velocity_m_s,
        },
        attitude: HilAttitude {
            quaternion: attitude.to_array(),
            rates_rad_s: aboard.rates_rad_s,
            airspeed_m_s: aboard.airspeed_m_s,
            indicated_m_s: libm::sqrt(2.0 * dynamic_pressure_pa / SEA_LEVEL_DENSITY_KG_M3),
            felt_g: aboard.felt_m_s2.map(|felt| felt / STANDARD_GRAVITY_M_S2),
        },
    }
}

/// The field of an axial dipole, turned by the declination: to the north, the east and down, gauss.
///
/// $$ B_h = B_0 \cos\lambda, \qquad B_d = 2 B_0 \sin\lambda $$
fn field_gauss(place: &Place) -> Vector3 {
    let (sine, cosine) = libm::sincos(place.latitude_rad);
    let (aside, ahead) = libm::sincos(place.declination_rad);
    let level_gauss = EQUATOR_GAUSS * cosine;
    Vector3::new(level_gauss * ahead, level_gauss * aside, 2.0 * EQUATOR_GAUSS * sine)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn aboard(attitude_rad: [f64; 3], altitude_m: f64) -> Aboard {
        Aboard {
            attitude_rad,
            rates_rad_s: [0.0; 3],
            felt_m_s2: [0.0, 0.0, -STANDARD_GRAVITY_M_S2],
            position_m: [1000.0, 0.0, -altitude_m],
            velocity_m_s: [50.0, 0.0, 0.0],
            airspeed_m_s: 50.0,
        }
    }

    /// Numbers of the standard atmosphere at 1000 m: 89 874.6 Pa, 281.65 K, 1.11164 kg/m³ (ISO 2533).
    #[test]
    fn air_is_the_standard_one_and_a_kilometre_to_the_north_is_some_32_seconds_of_latitude() {
        let place = Place { latitude_rad: 0.8, longitude_rad: 0.1, declination_rad: 0.0 };
        let Sensed { sensors, place: there, attitude } =
            sensed(&aboard([0.0; 3], 1000.0), &place, 5);
        assert!((sensors.pressure_pa - 89_874.6).abs() < 0.5, "{}", sensors.pressure_pa);
        assert!((sensors.temperature_k - 281.65).abs() < 0.01);
        assert!((sensors.dynamic_pressure_pa - 0.5 * 1.11164 * 2500.0).abs() < 0.05);
        assert!((there.latitude_deg - 0.8_f64.to_degrees() - 32.4 / 3600.0).abs() < 1e-5);
        assert!((attitude.indicated_m_s - 50.0 * (1.11164_f64 / 1.225).sqrt()).abs() < 1e-3);
    }

    /// A dipole's field dips by an angle whose tangent is twice that of the latitude.
    #[test]
    fn the_field_dips_as_a_dipole_does_and_turns_with_the_body() {
        let place = Place { latitude_rad: 0.8, longitude_rad: 0.0, declination_rad: 0.1 };
        let level = sensed(&aboard([0.0; 3], 0.0), &place, 0).sensors.field_gauss;
        let [north, east, down] = level;
        assert!((down / north.hypot(east) - 2.0 * 0.8_f64.tan()).abs() < 1e-12);
        assert!((east / north - 0.1_f64.tan()).abs() < 1e-12);
        // Headed to magnetic north all of the level part is ahead.
        let headed = sensed(&aboard([0.0, 0.0, 0.1], 0.0), &place, 0).sensors.field_gauss;
        assert!((headed[0] - north.hypot(east)).abs() < 1e-12 && headed[1].abs() < 1e-12);
        // A nose straight up looks against the field that points down.
        let up = sensed(&aboard([0.0, std::f64::consts::FRAC_PI_2, 0.0], 0.0), &place, 0);
        assert!((up.sensors.field_gauss[0] + down).abs() < 1e-12);
    }
}
