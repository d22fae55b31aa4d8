//! Loadings and climbs of a scenario's aircraft.

use crate::flying::{NAVION, apart, column, flown, refusal, trimmed};

/// At sea level, over ground that is lower: a flight begins above it.
const AT_THE_REFERENCE: [&str; 3] =
    ["aircraft.airspeed_ft_s=176", "aircraft.altitude_ft=0", "aircraft.ground_m=-1000"];
/// 2000 lbf by the 32.2 ft/s² of the Navion's source.
const LIGHT: &str = "aircraft.mass_kg=906.4536";

/// -1.504 deg and 280.1 lbf, computed apart. It used to be another wing: -0.001 deg and 338.6 lbf.
#[test]
fn a_lighter_aircraft_flies_on_the_same_wing_whichever_way_it_is_made_lighter() {
    for lighter in [LIGHT, "aircraft.name.mass.weight_lbf=2000.0"] {
        let plant = trimmed(&[&AT_THE_REFERENCE[..], &[lighter]].concat());
        let trim = plant.trim();
        let alpha_deg = trim.point.alpha_rad.to_degrees();
        assert!((alpha_deg + 1.504).abs() < 1e-3, "{lighter}: {alpha_deg}");
        let thrust_lbf = trim.thrust_n / 4.448_221_615_260_5;
        assert!((thrust_lbf - 280.1).abs() < 0.1, "{lighter}: {thrust_lbf}");
    }
}

/// 4.5 % of the chord further aft: Cm_alpha -0.683 + 0.045 · 4.44.
#[test]
fn a_centre_of_gravity_further_aft_makes_the_aircraft_less_stable() {
    let frequency = |set: &[&str]| {
        let plant = trimmed(set).linear().expect("has a linear model");
        let poles = plant.transfer_function().poles().expect("poles");
        poles.iter().map(|pole| pole.re.hypot(pole.im)).fold(0.0, f64::max)
    };
    let (known, aft) = (frequency(&[]), frequency(&["aircraft.cg_mac=0.34"]));
    assert!(aft < 0.95 * known && aft > 0.75 * known, "{known} {aft}");
    assert_eq!(known, frequency(&["aircraft.cg_mac=0.295"]));
}

#[test]
fn a_loading_that_makes_no_sense_is_refused_by_its_key() {
    let told = refusal(&[
        "aircraft.name=etkin-747",
        "aircraft.airspeed_ft_s=774",
        "aircraft.altitude_ft=40000",
        "aircraft.cg_mac=0.3",
    ]);
    assert!(told.contains("aircraft.cg_mac") && told.contains("linear model"), "{told}");
    let told = refusal(&["aircraft.iy_kg_m2=4000", "aircraft.iy_gyration_m=2"]);
    assert!(told.contains("aircraft.iy_gyration_m: not together with `iy_kg_m2`"), "{told}");
    let told = refusal(&["aircraft.ix_kg_m2=1", "aircraft.ixz_kg_m2=1e6"]);
    assert!(told.contains("belong to no body"), "{told}");
    let told = refusal(&["aircraft.cg_mac=25"]);
    assert!(told.contains("aircraft.cg_mac"), "{told}");
}

/// `aircraft trim` knew a climb angle, scenarios did not.
#[test]
fn a_scenario_climbs_at_its_angle() {
    let quiet = ["setpoint.amplitude_deg=0.0", "aircraft.climb_angle_deg=3"];
    let trace = flown(NAVION, &quiet);
    let (altitude_m, last) = (column(&trace, "altitude_m"), trace.rows() - 1);
    let climbed_m = altitude_m[last] - altitude_m[0];
    // 10 s at 176 ft/s; the air is thinner higher up, where the same throttle and elevator climb a little less.
    let expected_m = 53.6448 * 10.0 * 3.0_f64.to_radians().sin();
    assert!((climbed_m / expected_m - 1.0).abs() < 0.01, "{climbed_m} {expected_m}");
    let level = trimmed(&[]);
    let climbing = trimmed(&["aircraft.climb_angle_deg=3"]);
    assert!(climbing.trim().thrust_n > level.trim().thrust_n + 500.0);
}

#[test]
fn a_climbing_aircraft_answers_small_commands_as_its_linear_model() {
    let climb = ["aircraft.climb_angle_deg=3", "loop.duration_s=5.0"];
    let nonlinear = flown(NAVION, &climb);
    let linear = flown(NAVION, &[&climb[..], &["aircraft.model=linear"]].concat());
    let most = linear.theta_rad.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
    let apart = apart(&nonlinear.theta_rad, &linear.theta_rad);
    // In 5 s it climbs 14 m, into air that is 0.13 % thinner, which the linear model does not know.
    assert!(apart < 0.03 * most, "{apart} of {most}");
}

/// Down through the layer near the ground the same seed is rougher along and shorter: not that of the start.
#[test]
fn turbulence_follows_a_flight_that_descends() {
    let text = format!("{NAVION}[turbulence]\nintensity = \"moderate\"\nseed = 4\n");
    for model in ["aircraft.model=nonlinear", "aircraft.model=linear"] {
        let down = ["aircraft.climb_angle_deg=-3", "loop.duration_s=20.0", model];
        let gust = |more: &[&str]| {
            let trace = flown(&text, &[&down[..], more].concat());
            let nonlinear = trace.column("air_forward_m_s");
            nonlinear.or_else(|| trace.column("gust_forward_m_s")).expect("moving air").to_vec()
        };
        let follows = gust(&[]);
        assert_eq!(follows, gust(&["turbulence.follows=flight"]), "{model}");
        let stays = gust(&["turbulence.follows=start"]);
        assert_eq!(follows[0], stays[0]);
        assert!(apart(&follows, &stays) > 0.05, "{model}");
    }
    let level = |more: &[&str]| flown(&text, more);
    assert_eq!(level(&[]), level(&["turbulence.follows=start"]));
}

#[test]
fn a_linear_model_alone_does_not_climb() {
    let told = refusal(&[
        "aircraft.name=etkin-747",
        "aircraft.airspeed_ft_s=774",
        "aircraft.altitude_ft=40000",
        "aircraft.climb_angle_deg=2",
    ]);
    assert!(told.contains("aircraft.climb_angle_deg") && told.contains("level flight"), "{told}");
}
