//! What varies in flight: configurations, the ground, Mach number and fuel, against formulas on paper.

use fspid_aircraft::Quantity;
use fspid_aircraft::data::DerivativeData;
use fspid_scenario::file;
use fspid_sim::{Plant, Trace};
use fspid_study::analysis::{Analysis, Question};

use crate::flying::{NAVION, apart, column, flown, refusal, study, trimmed};

/// Nobody answers, and nothing is asked: what is seen is the aircraft alone.
const ALONE: [&str; 4] = [
    "controller[0].kp=0.0",
    "controller[0].ki=0.0",
    "controller[0].kd=0.0",
    "setpoint.amplitude_deg=0.0",
];
const FLAPS: &str = "configuration=[{name='flaps', assumption='made up', lift={reference=0.4, alpha=0.2}, \
                     drag={reference=0.03}, pitch={reference=-0.05}}]";
const REFERENCE: [&str; 3] =
    ["aircraft.altitude_ft=0", "aircraft.ground_m=-1000", "aircraft.atmosphere=reference"];

fn all<'a>(parts: &[&[&'a str]]) -> Vec<&'a str> {
    parts.concat()
}

fn navion() -> DerivativeData {
    *file::aircraft("navion").expect("carried").derivatives().expect("derivatives")
}

/// Dynamic pressure times area at the reference, N.
fn scale_n(data: &DerivativeData) -> f64 {
    let v = data.reference.airspeed_m_s;
    0.5 * data.reference.density_kg_m3 * v * v * data.geometry.area_m2
}

fn last(values: &[f64]) -> f64 {
    *values.last().expect("samples")
}

/// Level: the lift and the thrust across the flow carry the weight, moments balance, the thrust along it is the drag.
#[test]
fn the_trim_with_flaps_is_that_of_the_equations_on_paper() {
    let data = navion();
    let (lift, drag, pitch) =
        (data.longitudinal.lift, data.longitudinal.drag, data.longitudinal.pitch);
    let lift_1 = data.mass_kg() * data.reference.gravity_m_s2 / scale_n(&data);
    let (mut alpha, mut elevator): (f64, f64) = (0.0, 0.0);
    for _ in 0..200 {
        elevator = (0.05 - pitch.alpha * alpha) / pitch.elevator;
        let drag = drag.reference + 0.03 + drag.alpha * alpha;
        alpha = -(0.4 + lift.elevator * elevator + drag * alpha.tan()) / (lift.alpha + 0.2);
    }
    let plant = trimmed(&all(&[&REFERENCE, &[FLAPS, "aircraft.configuration=['flaps']"]]));
    let trim = plant.trim();
    assert!((trim.point.alpha_rad - alpha).abs() < 1e-9, "{} {alpha}", trim.point.alpha_rad);
    assert!((trim.point.elevator_rad - elevator).abs() < 1e-9);
    let thrust_n = scale_n(&data) * (drag.reference + 0.03 + drag.alpha * alpha) / alpha.cos();
    assert!((trim.thrust_n / thrust_n - 1.0).abs() < 1e-9, "{} {thrust_n}", trim.thrust_n);
    assert!(lift_1 > 0.0 && alpha < -0.05);
}

/// While a flap runs out, its moment grows with the time: q = ΔCm q S c t² / (2 Iy T) before the aircraft answers.
#[test]
fn a_flap_that_runs_out_turns_the_nose_by_its_moment() {
    let data = navion();
    let flap = "configuration=[{name='flaps', assumption='made up', pitch={reference=-0.05}}]";
    let change = "configuration_change=[{name='flaps', to=1.0, at_s=1.0, takes_s=4.0}]";
    let short = ["loop.duration_s=1.06", "loop.sample_period_s=0.01"];
    let trace = flown(NAVION, &all(&[&ALONE, &REFERENCE, &short, &[flap, change]]));
    let moment_n_m = -0.05 * scale_n(&data) * data.geometry.chord_m;
    let (t, iy) = (0.06, data.inertia.iy_kg_m2);
    let expected = moment_n_m / iy * t * t / (2.0 * 4.0);
    let q = last(&trace.q_rad_s);
    // The damping of 3.6/s or so takes some per cent in 60 ms.
    assert!((q / expected - 1.0).abs() < 0.12 && q.abs() < expected.abs(), "{q} {expected}");
    assert!(trace.q_rad_s.iter().take(100).all(|q| q.abs() < 1e-9));
    let out = column(&trace, "deployment_1");
    assert!((last(out) - 0.015).abs() < 1e-12 && out[100].abs() < 1e-12, "{}", last(out));
}

/// The same numbers as increments and in the aircraft's own file.
#[test]
fn an_increment_flies_as_a_file_that_has_it_in_its_derivatives() {
    let out = [
        "configuration=[{name='out', source='none', lift={alpha=0.3, pitch_rate=0.5, elevator=0.02}, \
         pitch={reference=0.01, alpha=-0.1, alpha_rate=-0.5, pitch_rate=-1.0, elevator=-0.1}, \
         side={beta=-0.1}, roll={beta=-0.02, aileron=-0.01}, yaw={yaw_rate=-0.05}}]",
        "aircraft.configuration=['out']",
    ];
    let own = [
        "aircraft.name.longitudinal.lift.alpha=4.74",
        "aircraft.name.longitudinal.lift.pitch_rate=4.3",
        "aircraft.name.longitudinal.lift.elevator=0.375",
        "aircraft.name.longitudinal.pitch.reference=0.01",
        "aircraft.name.longitudinal.pitch.alpha=-0.783",
        "aircraft.name.longitudinal.pitch.alpha_rate=-4.86",
        "aircraft.name.longitudinal.pitch.pitch_rate=-10.96",
        "aircraft.name.longitudinal.pitch.elevator=-1.023",
        "aircraft.name.lateral.side.beta=-0.664",
        "aircraft.name.lateral.roll.beta=-0.094",
        "aircraft.name.lateral.roll.aileron=-0.144",
        "aircraft.name.lateral.yaw.yaw_rate=-0.175",
    ];
    let rough = "turbulence={intensity='moderate', seed=3}";
    for more in [[rough, "aircraft.cg_mac=0.295"], [rough, "aircraft.cg_mac=0.32"]] {
        let (one, other) =
            (flown(NAVION, &all(&[&out, &more])), flown(NAVION, &all(&[&own, &more])));
        assert!(apart(&one.theta_rad, &other.theta_rad) < 1e-9);
        let bank = |trace: &Trace| column(trace, "bank_rad").to_vec();
        assert!(apart(&bank(&one), &bank(&other)) < 1e-9);
    }
}

#[test]
fn a_flight_of_configurations_that_stay_retracted_is_that_without_them() {
    let plain = flown(NAVION, &[]);
    let known = flown(NAVION, &[FLAPS]);
    assert_eq!(plain, known);
    let moved =
        flown(NAVION, &[FLAPS, "configuration_change=[{name='flaps', to=0.0, at_s=1, takes_s=1}]"]);
    assert!(apart(&plain.theta_rad, &moved.theta_rad) < 1e-12);
}

/// Steps of 10, 5 and 2.5 ms with a flap that begins and ceases to move at no sample, below one span, and out of fuel.
#[test]
fn the_error_of_a_step_falls_with_its_fourth_power_while_everything_varies() {
    let theta = |dt_s: f64, more: &[&str]| {
        let period = format!("loop.sample_period_s={dt_s}");
        let set =
            all(&[&ALONE, &["loop.duration_s=2.0", "aircraft.cg_mac=0.295"], &[&period], more]);
        flown(NAVION, &set).theta_rad
    };
    let quick = "configuration=[{name='flaps', assumption='made up', lift={reference=1.0}, \
                 drag={reference=0.2}, pitch={reference=-0.3}}]";
    let change = "configuration_change=[{name='flaps', to=0.6, at_s=0.1234, takes_s=0.0777}, \
                  {name='flaps', to=0.1, at_s=0.4567, takes_s=0.3}]";
    let down = [
        "aircraft.altitude_ft=40",
        "aircraft.climb_angle_deg=-4",
        "ground_effect={wing_height_m=1.0, induced_drag_factor=2.0}",
        quick,
        change,
    ];
    let dry = ["fuel={on_board_kg=0.9, flow_kg_s=0.777, tank_mac=1.2}", quick, change];
    for more in [&[quick, change][..], &down, &dry] {
        let exact = theta(0.000_312_5, more);
        let error = |dt_s: f64, by: usize| {
            let fine: Vec<f64> = exact.iter().copied().step_by(by).collect();
            apart(&theta(dt_s, more), &fine)
        };
        let errors = [error(0.01, 32), error(0.005, 16), error(0.0025, 8)];
        let orders = [errors[0] / errors[1], errors[1] / errors[2]].map(f64::log2);
        assert!(orders.iter().all(|order| *order > 3.5), "{orders:?} {errors:?}");
    }
}

/// T cos α = D with the parabola of the ground's formula, and the lift by the same balance.
#[test]
fn the_thrust_near_the_ground_is_that_of_the_drag_polar_on_paper() {
    let data = navion();
    let (lift, drag) = (data.longitudinal.lift, data.longitudinal.drag);
    let weight_n = data.mass_kg() * data.reference.gravity_m_s2;
    let span_m = data.geometry.span_m;
    let scale_n = scale_n(&data);
    let k = drag.alpha / (2.0 * (data.weight_n / scale_n) * lift.alpha);
    for height_m in [0.5, 2.0, 5.0, 8.0] {
        let altitude = format!("aircraft.altitude_m={height_m}");
        let near = ["ground_effect={wing_height_m=1.2}", "aircraft.atmosphere=reference"];
        let text = NAVION.replace("altitude_ft = 1000.0", "altitude_m = 1.0");
        let set = all(&[&near, &[&altitude]]);
        let Plant::Aircraft(plant) = study(&text, &set).scenario.plant else { panic!("flies") };
        let trim = plant.trim();
        let (alpha, thrust_n) = (trim.point.alpha_rad, trim.thrust_n);
        let lifted = (weight_n - thrust_n * alpha.sin()) / scale_n;
        let spans = 16.0 * (height_m + 1.2) / span_m;
        let phi = spans * spans / (1.0 + spans * spans) + 1.0 / 257.0;
        let expected = drag.reference + drag.alpha * alpha - (1.0 - phi) * k * lifted * lifted;
        let found = thrust_n * alpha.cos() / scale_n;
        assert!((found - expected).abs() < 1e-9, "{height_m}: {found} {expected}");
        assert!(found < drag.reference + drag.alpha * alpha);
    }
}

#[test]
fn there_is_no_effect_of_the_ground_above_one_span() {
    let near = "ground_effect={wing_height_m=1.2}";
    let quiet = all(&[&ALONE, &["aircraft.altitude_ft=60", "loop.duration_s=3.0"]]);
    let (with, without) = (flown(NAVION, &all(&[&quiet, &[near]])), flown(NAVION, &quiet));
    assert!(apart(&with.theta_rad, &without.theta_rad) < 1e-12);
    assert!(column(&with, "ground_effect").iter().all(|factor| *factor == 1.0));
    assert!(without.column("ground_effect").is_none());
}

/// 0.05 kg/s for 10 s, and by thrust, which an engine without a law of speed keeps.
#[test]
fn the_mass_after_a_flight_is_that_of_the_integral() {
    let quiet = all(&[&ALONE, &["aircraft.cg_mac=0.295"]]);
    let flow = flown(NAVION, &all(&[&quiet, &["fuel={on_board_kg=100, flow_kg_s=0.05}"]]));
    assert!((last(column(&flow, "fuel_kg")) - 99.5).abs() < 1e-9);
    let mass = column(&flow, "mass_kg");
    assert!((mass[0] - last(mass) - 0.5).abs() < 1e-9);
    assert!((mass[0] - navion().mass_kg()).abs() < 1e-9);
    let by_thrust = ["fuel={on_board_kg=100, specific_kg_n_s=5e-5}"];
    let plant = trimmed(&all(&[&quiet, &by_thrust]));
    let burnt = flown(NAVION, &all(&[&quiet, &by_thrust]));
    let expected_kg = 5e-5 * plant.trim().thrust_n * 10.0;
    let found_kg = 100.0 - last(column(&burnt, "fuel_kg"));
    assert!((found_kg / expected_kg - 1.0).abs() < 1e-9, "{found_kg} {expected_kg}");
}

/// A lighter aircraft on the same wing feels more: load factor times weight is the force.
#[test]
fn an_aircraft_that_grows_lighter_rises() {
    let quiet = all(&[&ALONE, &["loop.duration_s=5.0"]]);
    let burning = flown(NAVION, &all(&[&quiet, &["fuel={on_board_kg=300, flow_kg_s=20}"]]));
    let plain = flown(NAVION, &quiet);
    let height = |trace: &Trace| last(column(trace, "altitude_m"));
    assert!(height(&burning) > height(&plain) + 0.5);
    let (loads, mass) = (column(&burning, "load_factor"), column(&burning, "mass_kg"));
    assert!((loads[0] - 1.0).abs() < 1e-3 && loads[40] > 1.0 && mass[40] < mass[0] - 7.9);
}

/// 0.3 kg at 0.1 kg/s: dry at 3 s, then the drag alone takes speed, and the flight says so.
#[test]
fn an_empty_tank_ends_the_thrust_and_is_told() {
    let dry = ["fuel={on_board_kg=0.3, flow_kg_s=0.1}", "loop.duration_s=4.0"];
    let trace = flown(NAVION, &all(&[&ALONE, &dry]));
    let (fuel, throttle) = (column(&trace, "fuel_kg"), column(&trace, "throttle"));
    assert!((fuel[299] - 0.0001 * 10.0).abs() < 1e-9 && fuel[301] == 0.0, "{}", fuel[299]);
    assert!(throttle[299] > 0.5 && throttle[301] == 0.0);
    let exit = trace.exit.expect("told");
    assert_eq!(exit.departure.quantity, Quantity::Fuel);
    assert!((exit.at_s - 3.0).abs() < 0.011, "{}", exit.at_s);
    let speed = column(&trace, "airspeed_m_s");
    let plant = trimmed(&all(&[&ALONE, &dry]));
    let slope = (speed[305] - speed[301]) / 0.04;
    let expected = -plant.trim().thrust_n / navion().mass_kg();
    assert!((slope / expected - 1.0).abs() < 0.05, "{slope} {expected}");
}

/// Aft fuel moves the centre of gravity forward as it goes: the nose falls.
#[test]
fn fuel_behind_the_centre_of_gravity_lets_the_nose_fall_as_it_goes() {
    let quiet = all(&[&ALONE, &["loop.duration_s=6.0"]]);
    let of = |tank: &str| {
        let fuel = format!("fuel={{on_board_kg=150, flow_kg_s=10, tank_mac={tank}}}");
        last(&flown(NAVION, &all(&[&quiet, &[&fuel]])).theta_rad)
    };
    let (ahead, at, behind) = (of("0.1"), of("0.295"), of("0.5"));
    assert!(behind < at - 1e-3 && at < ahead - 1e-3, "{ahead} {at} {behind}");
}

#[test]
fn a_configuration_beyond_its_speed_leaves_the_range_of_the_model() {
    let flaps = "configuration=[{name='flaps', source='none', most_airspeed_m_s=50, drag={reference=0.001}}]";
    let change = "configuration_change=[{name='flaps', to=0.5, at_s=2.0, takes_s=1.0}]";
    let exit = flown(NAVION, &[flaps, change]).exit.expect("too fast");
    assert_eq!(exit.departure.quantity, Quantity::Airspeed);
    assert_eq!(exit.departure.allowed.max, 50.0);
    assert!((exit.at_s - 2.01).abs() < 1e-9, "{}", exit.at_s);
    let told = refusal(&[flaps, "aircraft.configuration=['flaps']"]);
    assert!(told.contains("airspeed"), "{told}");
}

/// Halfway between two rows: half of the increment of the second.
#[test]
fn rows_over_mach_number_add_by_straight_lines_and_end_the_trust_at_the_last() {
    let rows = "aircraft.name.mach_row=[{mach=0.1}, {mach=0.2, drag={reference=0.02}}]";
    let plain = trimmed(&REFERENCE);
    let with = trimmed(&all(&[&REFERENCE, &[rows]]));
    let flow = plain.aircraft().flow(&plain.trim().state, &fspid_aircraft::AirMotion::STILL);
    let added_n = scale_n(&navion()) * 0.02 * (flow.mach() - 0.1) / 0.1;
    let (before, after) = (plain.trim(), with.trim());
    let found_n = after.thrust_n * after.point.alpha_rad.cos()
        - before.thrust_n * before.point.alpha_rad.cos();
    assert!((found_n / added_n - 1.0).abs() < 1e-3, "{found_n} {added_n}");
    let short = rows.replace("0.2", "0.12");
    let told = refusal(&all(&[&REFERENCE, &[&short]]));
    assert!(told.contains("Mach number"), "{told}");
}

#[test]
fn what_moves_in_flight_is_said_to_be_left_out() {
    let change = "configuration_change=[{name='flaps', to=0.5, at_s=2.0, takes_s=1.0}]";
    let moves = study(NAVION, &[FLAPS, change]);
    let text = Analysis::of(&moves, Question::default()).expect("a loop").text();
    assert!(text.contains("While configurations move"), "{text}");
    let still = study(NAVION, &[FLAPS, "aircraft.configuration=['flaps']"]);
    let text = Analysis::of(&still, Question::default()).expect("a loop").text();
    assert!(!text.contains("While configurations move"), "{text}");
}

#[test]
fn everything_that_is_wrong_is_refused_by_its_key_and_all_at_once() {
    let change = |text: &str| format!("configuration_change=[{text}]");
    let unknown = change("{name='flpas', to=1, at_s=1, takes_s=1}");
    let told = refusal(&[FLAPS, &unknown, "aircraft.configuration=['gaer']"]);
    assert!(told.contains("did you mean `flaps`?"), "{told}");
    assert!(told.contains("aircraft.configuration") && told.contains("2 problems"), "{told}");
    let out = change("{name='flaps', to=1.5, at_s=1, takes_s=1}");
    assert!(refusal(&[FLAPS, &out]).contains("configuration_change[0].to: out of range"));
    let none = change("{name='flaps', to=1, at_s=1, takes_s=0}");
    assert!(refusal(&[FLAPS, &none]).contains("configuration_change[0].takes_s"));
    let both =
        change("{name='flaps', to=1, at_s=1, takes_s=2}, {name='flaps', to=0, at_s=2, takes_s=1}");
    let told = refusal(&[FLAPS, &both]);
    assert!(
        told.contains("configuration_change[1].at_s: configuration_change[0] has not ended"),
        "{told}"
    );
    let twice = FLAPS.replace("}]", "}, {name='flaps', source='none'}]");
    assert!(refusal(&[&twice]).contains("the name is taken"));
    let told = refusal(&["fuel={on_board_kg=2000, flow_kg_s=1}"]);
    assert!(told.contains("fuel.on_board_kg") && told.contains("mass without fuel"), "{told}");
    let told = refusal(&["aircraft.configuration=['flaps']"]);
    assert!(told.contains("has no configurations"), "{told}");
    let told = refusal(&["configuration=[{name='bare'}]"]);
    assert!(told.contains("source") && told.contains("assumption"), "{told}");
}

#[test]
fn what_has_no_derivatives_has_no_configurations() {
    let plant = NAVION.replace(
        "[aircraft]\nname = \"navion\"\nairspeed_ft_s = 176.0\naltitude_ft = 1000.0",
        "[plant]\npreset = \"navion-paper\"",
    );
    let set = [FLAPS, "fuel={on_board_kg=1, flow_kg_s=1}", "ground_effect={wing_height_m=1}"];
    let set: Vec<String> = set.iter().map(|&change| change.to_owned()).collect();
    let told = file::parse(&plant, "test.toml", None, &set).expect_err("linear").to_string();
    for path in ["configuration[0]", "fuel", "ground_effect"] {
        assert!(told.contains(path), "{path}: {told}");
    }
    let moving = ["aircraft.model=linear", "fuel={on_board_kg=1, flow_kg_s=1}"];
    assert!(refusal(&moving).contains("a linear model does not change in flight"));
    // Its linear model has the flaps of the start.
    let poles = |set: &[&str]| {
        let Plant::Linear(plant) = study(NAVION, set).scenario.plant else { panic!("linear") };
        plant.transfer_function().denominator().coefficients().to_vec()
    };
    let out = [FLAPS, "aircraft.configuration=['flaps']", "aircraft.model=linear"];
    assert_ne!(poles(&out), poles(&["aircraft.model=linear"]));
}
