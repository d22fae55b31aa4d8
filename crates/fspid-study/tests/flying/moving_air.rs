//! Winds, gusts, turbulence and sensors around a nonlinear aircraft.

use crate::flying::{NAVION, apart, column, flown, largest};

const TURBULENCE: &str = "[turbulence]\nintensity = \"moderate\"\nseed = 4\n";
const QUIET: [&str; 2] = ["setpoint.amplitude_deg=0.0", "loop.duration_s=60.0"];

fn turbulent(more: &str) -> String {
    format!("{NAVION}{TURBULENCE}{more}")
}

#[test]
fn the_same_turbulence_gives_the_same_bits_and_another_seed_another_flight() {
    let flight = flown(&turbulent(""), &QUIET);
    assert_eq!(flown(&turbulent(""), &QUIET), flight);
    let other = flown(&turbulent(""), &[&QUIET[..], &["turbulence.seed=5"]].concat());
    assert!(apart(&other.theta_rad, &flight.theta_rad) > 1e-3);
}

/// Turbulence takes numbers of its own streams: a sensor with the same seed changes none of them.
/// Winds along the body stay what they are although the aircraft now flies another way.
#[test]
fn a_sensor_does_not_change_the_gusts() {
    let plain = flown(&turbulent(""), &QUIET);
    let seen = flown(&turbulent("[sensor]\npreset = \"mems\"\nseed = 4\n"), &QUIET);
    for name in ["air_forward_m_s", "air_right_m_s", "air_down_m_s"] {
        assert_eq!(column(&plain, name), column(&seen, name), "{name}");
    }
    assert!(apart(&seen.theta_rad, &plain.theta_rad) > 1e-4);
    assert!(plain.column("measured_theta_rad").is_none());
    assert!(apart(column(&seen, "measured_theta_rad"), &seen.theta_rad) > 1e-3);
}

#[test]
fn the_wing_leveller_keeps_every_aircraft_upright_in_severe_turbulence() {
    for (name, airspeed, altitude) in [
        ("navion", "176.0", "2000.0"),
        ("cessna-172", "219.0", "5000.0"),
        ("b747-approach", "221.0", "1500.0"),
        ("b747-cruise-low", "673.0", "20000.0"),
        ("b747-cruise-high", "871.0", "40000.0"),
    ] {
        let set = [
            format!("aircraft.name={name}"),
            format!("aircraft.airspeed_ft_s={airspeed}"),
            format!("aircraft.altitude_ft={altitude}"),
        ];
        let set: Vec<&str> = set.iter().map(String::as_str).chain(QUIET).collect();
        let trace = flown(&turbulent("").replace("moderate", "severe"), &set);
        assert_eq!(trace.rows(), 6001, "{name}");
        let bank_deg = largest(column(&trace, "bank_rad")).to_degrees();
        assert!(bank_deg > 0.1 && bank_deg < 45.0, "{name}: {bank_deg} deg");
    }
}

/// The aircraft starts trimmed in its wind, which carries it along: pitch does not know of it.
#[test]
fn a_steady_wind_changes_the_way_over_ground_alone() {
    let wind = "[wind]\nkind = \"steady\"\nspeed_kt = 30.0\nfrom_deg = 60.0\n";
    let calm = flown(NAVION, &["setpoint.amplitude_deg=1.0"]);
    let windy = flown(&format!("{NAVION}{wind}"), &["setpoint.amplitude_deg=1.0"]);
    assert!(apart(&calm.theta_rad, &windy.theta_rad) < 1e-10);
    let speeds = ["airspeed_m_s", "altitude_m"];
    for name in speeds {
        assert!(apart(column(&calm, name), column(&windy, name)) < 1e-8, "{name}");
    }
    let forward_m_s = column(&windy, "air_forward_m_s")[0];
    assert!((forward_m_s + 30.0 * 1852.0 / 3600.0 * 0.5).abs() < 0.05, "{forward_m_s}");
}

/// 1 m/s of updraught at V adds 1/V of angle of attack, before the aircraft answers.
#[test]
fn an_updraught_raises_the_angle_of_attack() {
    let gust = "[[gust]]\nkind = \"full-cycle\"\nup_m_s = 3.0\ngradient_m = 5.0\nat_s = 1.0\n";
    let trace = flown(&format!("{NAVION}{gust}"), &["setpoint.amplitude_deg=0.0"]);
    let alpha_rad = column(&trace, "alpha_rad");
    let raised = largest(alpha_rad) - alpha_rad[0].abs();
    assert!((raised - 3.0 / 53.6448).abs() < 0.01, "{raised}");
    assert!(largest(column(&trace, "load_factor")) > 1.3);
    assert_eq!(largest(&column(&trace, "air_down_m_s")[..100]), 0.0);
}

/// Accelerations tilt the vertical that a gyro erects to; an aircraft that slows down shows it.
#[test]
fn a_vertical_gyro_sags_in_a_climb() {
    let gyro = "[sensor]\npreset = \"vertical-gyro\"\n[sensor.pitch]\nbias_deg = 0.0\n";
    let set = ["setpoint.amplitude_deg=5.0", "loop.duration_s=20.0"];
    let trace = flown(&format!("{NAVION}{gyro}"), &set);
    let error_deg = apart(column(&trace, "measured_theta_rad"), &trace.theta_rad).to_degrees();
    // 3 deg/min for 20 s is 1 deg.
    assert!(error_deg > 0.1 && error_deg <= 1.0 + 1e-9, "{error_deg}");
}
