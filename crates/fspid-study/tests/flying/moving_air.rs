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
        ("cessna-310", "150.0", "1500.0"),
        ("beaver", "148.0", "2000.0"),
        ("learjet-24", "677.0", "40000.0"),
        ("citation-500", "197.0", "9900.0"),
        ("aerosonde", "82.0", "328.0"),
        ("skywalker-x8", "59.0", "328.0"),
        ("ultra-stick-25e", "56.0", "328.0"),
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

/// In still air at rest the aircraft goes straight north at its airspeed, and nothing else moves.
#[test]
fn a_trace_tells_the_way_the_attitude_and_the_energy() {
    let trace = flown(NAVION, &["setpoint.amplitude_deg=0.0"]);
    let (last, speed_m_s) = (trace.rows() - 1, column(&trace, "airspeed_m_s")[0]);
    let north_m = column(&trace, "north_m")[last];
    assert!((north_m - speed_m_s * trace.time_s[last]).abs() < 1e-6, "{north_m}");
    for name in ["east_m", "heading_rad", "sideslip_rad", "p_rad_s", "r_rad_s", "flight_path_rad"] {
        assert!(largest(column(&trace, name)) < 1e-9, "{name}");
    }
    // Standard gravity, to the last digit that is defined.
    let energy_m = 304.8 + speed_m_s * speed_m_s / (2.0 * 9.80665);
    assert!((column(&trace, "energy_height_m")[last] - energy_m).abs() < 1e-6);
    // Level flight: pitch is the angle of attack.
    assert!((column(&trace, "attitude_rad")[0] - column(&trace, "alpha_rad")[0]).abs() < 1e-9);
    let throttle = column(&trace, "throttle");
    assert!(throttle[0] > 0.0 && throttle.iter().all(|it| it.to_bits() == throttle[0].to_bits()));
}

/// The climb is the rate of the altitude over the speed over ground, and pitch its sum with the angle of attack
/// where wings are level and the air is still.
#[test]
fn the_flight_path_is_how_the_altitude_changes() {
    let trace = flown(NAVION, &["setpoint.amplitude_deg=3.0"]);
    let [path, altitude, north] =
        ["flight_path_rad", "altitude_m", "north_m"].map(|name| column(&trace, name));
    let [attitude, alpha] = ["attitude_rad", "alpha_rad"].map(|name| column(&trace, name));
    for k in (1..trace.rows() - 1).step_by(97) {
        let slope = (altitude[k + 1] - altitude[k - 1]) / (north[k + 1] - north[k - 1]);
        // Of central differences over 0.02 s.
        assert!((path[k].tan() - slope).abs() < 1e-4, "{k}: {} {slope}", path[k]);
        assert!((attitude[k] - alpha[k] - path[k]).abs() < 1e-9, "{k}");
    }
    assert!(largest(path).to_degrees() > 1.0);
}

/// Kinematics of Euler angles: bank and heading are what the rates add up to.
#[test]
fn rates_of_the_body_add_up_to_bank_and_heading() {
    let trace = flown(&turbulent(""), &QUIET);
    let [bank, pitch, heading, p, r] =
        ["bank_rad", "attitude_rad", "heading_rad", "p_rad_s", "r_rad_s"]
            .map(|name| column(&trace, name));
    let rates = |k: usize| {
        let across = trace.q_rad_s[k] * bank[k].sin() + r[k] * bank[k].cos();
        [p[k] + pitch[k].tan() * across, across / pitch[k].cos()]
    };
    let mut sums = [bank[0], heading[0]];
    for k in 1..trace.rows() {
        let dt_s = trace.time_s[k] - trace.time_s[k - 1];
        for (sum, (one, next)) in sums.iter_mut().zip(rates(k - 1).into_iter().zip(rates(k))) {
            *sum += 0.5 * (one + next) * dt_s;
        }
    }
    let last = trace.rows() - 1;
    // The trapezoidal rule over 6000 samples of a rough flight.
    assert!((sums[0] - bank[last]).abs() < 1e-3, "{} {}", sums[0], bank[last]);
    assert!((sums[1] - heading[last]).abs() < 1e-3, "{} {}", sums[1], heading[last]);
    assert!(largest(heading).to_degrees() > 0.1);
}

/// Turbulence turns the air, a wind does not: rates of the air are those of turbulence and gusts.
#[test]
fn the_air_turns_in_turbulence_alone() {
    let wind = "[wind]\nkind = \"steady\"\nspeed_kt = 30.0\nfrom_deg = 90.0\n";
    let [windy, rough] =
        [format!("{NAVION}{wind}"), turbulent("")].map(|text| flown(&text, &QUIET));
    for name in ["air_roll_rad_s", "air_pitch_rad_s", "air_yaw_rad_s"] {
        assert!(largest(column(&windy, name)) <= 0.0, "{name}");
        assert!(largest(column(&rough, name)) > 1e-3, "{name}");
    }
    // Carried to the west by the whole wind, with the nose north.
    let last = windy.rows() - 1;
    let drift_m = column(&windy, "east_m")[last];
    assert!((drift_m + 30.0 * 1852.0 / 3600.0 * 60.0).abs() < 0.1, "{drift_m}");
    assert!(largest(column(&windy, "heading_rad")) < 1e-9);
}

/// A slow Navion, whose body stands 7.9 deg above its path, in winds of a hundredth of a metre a second. Linear it came to 0.0020 deg
/// in a head wind where the nonlinear one comes to 0.0006: winds of Earth axes were those of the path.
#[test]
fn a_small_wind_moves_the_linear_aircraft_as_it_moves_the_nonlinear_one() {
    for wind in ["north_m_s", "up_m_s"] {
        let pitch = |model: &str| {
            let text = format!(
                "schema = 1\nname = \"slow\"\naircraft = {{ name = \"navion\", airspeed_m_s = 36.0, altitude_m = 1000.0, model = \"{model}\" }}\nloop = {{ sample_period_s = 0.01, duration_s = 8.0 }}\nsetpoint = {{ kind = \"step\", amplitude_deg = 0.0 }}\nwind = {{ kind = \"table\", time_s = [0.0, 2.0, 4.0, 9.0], {wind} = [0.0, 0.01, -0.01, 0.01] }}\ncontroller = [{{ name = \"none\", kind = \"pid\", kp = 0.0, ki = 0.0, kd = 0.0 }}]\n"
            );
            flown(&text, &[]).theta_rad
        };
        let (linear, nonlinear) = (pitch("linear"), pitch("nonlinear"));
        let share = apart(&linear, &nonlinear) / largest(&nonlinear);
        assert!(share < 0.02, "{wind}: {share}");
    }
}
