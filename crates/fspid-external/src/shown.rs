//! What JSBSim shows at a sample, in its units, and what is made of it.

use fspid_numeric::units::FOOT_M;
use fspid_sim::external_plant::PlantSample;

use crate::frame::numbers;

/// Numbers that JSBSim shows at a sample.
const SHOWN: usize = 34;
/// Bytes of a sample: its number, and the numbers.
pub(crate) const SAMPLE: usize = 8 + 8 * SHOWN;

/// The number of a sample.
pub(crate) fn number_of(frame: &[u8; SAMPLE]) -> u64 {
    let [number, ..] = numbers::<1>(frame);
    number.to_bits()
}

/// The sample of what JSBSim shows, in the order of the bridge, in feet and pounds; nothing where a number is not finite.
pub(crate) fn sample_of(frame: &[u8; SAMPLE]) -> Option<PlantSample> {
    let [theta, q, bank, airspeed, altitude, height, alpha, elevator, aileron, rest @ ..] =
        numbers::<SHOWN>(frame.get(8..)?);
    let [u, v, w, u_aero, v_aero, w_aero, x_lb, y_lb, z_lb, weight_lb, touches, rest @ ..] = rest;
    let [heading, sideslip, p, r, throttle, climb, north, east, north_m, east_m, rest @ ..] = rest;
    let [u_dot, v_dot, w_dot, throttle_command] = rest;
    // How the air moves is how the body moves less how it moves through the air.
    let air = [u - u_aero, v - v_aero, w - w_aero].map(|ft_s| ft_s * FOOT_M);
    let felt = [x_lb, y_lb, z_lb].map(|force_lb| force_lb / weight_lb);
    // Turning with the body changes no length.
    let speed = (u * u + v * v + w * w).sqrt();
    let gained = (u * u_dot + v * v_dot + w * w_dot) / speed;
    let [air_x, air_y, air_z] = air;
    let [felt_x, felt_y, felt_z] = felt;
    PlantSample::of(&[
        theta,
        q,
        bank,
        airspeed * FOOT_M,
        altitude * FOOT_M,
        height * FOOT_M,
        alpha,
        elevator,
        aileron,
        air_x,
        air_y,
        air_z,
        felt_x,
        felt_y,
        felt_z,
        touches,
        heading,
        sideslip,
        p,
        r,
        throttle,
        climb * FOOT_M,
        north * FOOT_M,
        east * FOOT_M,
        north_m,
        east_m,
        if speed > 0.0 { gained * FOOT_M } else { 0.0 },
        throttle_command,
    ])
}

#[cfg(test)]
#[allow(clippy::float_cmp, reason = "numbers that are exact")]
mod tests {
    use super::*;

    fn frame(shown: &[f64; SHOWN]) -> [u8; SAMPLE] {
        let mut frame = [0; SAMPLE];
        frame[..8].copy_from_slice(&7_u64.to_ne_bytes());
        for (place, value) in frame[8..].chunks_exact_mut(8).zip(shown) {
            place.copy_from_slice(&value.to_ne_bytes());
        }
        frame
    }

    #[test]
    fn feet_and_pounds_become_metres_and_weights_and_a_turn_changes_no_speed() {
        let mut shown: [f64; SHOWN] = std::array::from_fn(|place| place as f64);
        // Over the ground 3, 0, 4; through the air 1, -2, 5; a turn, and 2 ft/s² along the path.
        shown[9..15].copy_from_slice(&[3.0, 0.0, 4.0, 1.0, -2.0, 5.0]);
        shown[15..19].copy_from_slice(&[10.0, 0.0, -2000.0, 2000.0]);
        shown[30..33].copy_from_slice(&[-4.0 + 1.2, 9.0, 3.0 + 1.6]);
        let sample = sample_of(&frame(&shown)).expect("finite");
        assert_eq!(number_of(&frame(&shown)), 7);
        assert_eq!(sample.air_m_s, [2.0, 2.0, -1.0].map(|ft_s| ft_s * FOOT_M));
        assert_eq!(sample.felt, [0.005, 0.0, -1.0]);
        assert!((sample.path_acceleration_m_s2 - 2.0 * FOOT_M).abs() < 1e-15);
        assert_eq!((sample.airspeed_m_s, sample.altitude_m), (3.0 * FOOT_M, 4.0 * FOOT_M));
        assert_eq!((sample.heading_rad, sample.throttle), (20.0, 24.0));
        assert_eq!(sample.over_ground_m_s, [26.0 * FOOT_M, 27.0 * FOOT_M]);
        assert_eq!((sample.position_m, sample.throttle_command), ([28.0, 29.0], 33.0));
        shown[12] = f64::NAN;
        assert_eq!(sample_of(&frame(&shown)), None);
    }
}
