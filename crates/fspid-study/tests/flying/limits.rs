//! Flights that leave the range of their model, diverge, or cannot begin.

use std::ops::ControlFlow;

use fspid_aircraft::Quantity;
use fspid_scenario::file;
use fspid_sim::{EarlyEnd, EndCause, Outcome, fly};
use fspid_study::metrics::Verdict;
use fspid_study::report;
use fspid_study::simulation::Simulation;

use crate::flying::{NAVION, column, flown, study};

#[test]
fn a_flight_beyond_its_model_says_when_and_by_which_limit() {
    let study = study(NAVION, &["setpoint.amplitude_deg=25.0", "loop.duration_s=40.0"]);
    let simulation = Simulation::of(&study).expect("it flies");
    let exit = simulation.results[0].trace.exit.expect("too slow or too steep");
    assert!(matches!(exit.departure.quantity, Quantity::Alpha | Quantity::Airspeed));
    assert_eq!(simulation.results[0].trace.outcome, Outcome::Completed);
    let sentence = format!("left the range of its model at t = {:.2} s", exit.at_s);
    assert!(simulation.text().contains(&sentence), "{}", simulation.text());
    let html = report::of_simulation(&study, &simulation);
    assert!(html.contains(&sentence));
    let json = simulation.json();
    assert_eq!(json["controllers"][0]["left_validity"]["at_s"], exit.at_s);
}

#[test]
fn an_aircraft_on_its_back_has_diverged() {
    let trace = flown(NAVION, &["controller.PID.kp=-8.0", "loop.duration_s=60.0"]);
    assert!(
        matches!(trace.outcome, Outcome::EndedEarly(EarlyEnd { cause: EndCause::Diverged, .. })),
        "{:?}",
        trace.outcome
    );
    assert!(trace.rows() < 6001);
    assert!(trace.theta_rad.iter().all(|theta| theta.is_finite()));
}

/// It used to be called flown: the window ends long before the growth shows.
#[test]
fn a_loop_that_grows_slowly_around_the_trim_is_called_unstable_and_meets_nothing() {
    let weak = ["controller.PID.kp=-0.02", "controller.PID.ki=0.0", "controller.PID.kd=0.0"];
    let text = format!("{NAVION}\n[[requirement]]\nmeasure = \"overshoot_pct\"\nmost = 1000.0\n");
    let simulation = Simulation::of(&study(&text, &weak)).expect("it flies");
    let result = &simulation.results[0];
    assert_eq!(result.trace.outcome, Outcome::Completed);
    assert!(result.trace.theta_rad.iter().all(|theta| theta.abs() < 0.1), "it looks calm");
    assert!(matches!(result.metrics.verdict, Verdict::Unstable { .. }), "{:?}", result.metrics);
    assert!(!simulation.requirements_met());
}

#[test]
fn the_elevator_stays_within_the_travel_of_the_aircraft() {
    let trace = flown(NAVION, &["setpoint.amplitude_deg=40.0", "controller.PID.kp=5.0"]);
    let within = |value: &f64| (-25.0 - 1e-9..=20.0 + 1e-9).contains(&value.to_degrees());
    assert!(trace.elevator_rad.iter().all(within));
    let least = trace.elevator_rad.iter().copied().fold(0.0, f64::min);
    assert!((least.to_degrees() + 25.0).abs() < 1e-9, "{least}");
}

#[test]
fn a_speed_that_cannot_be_flown_is_refused_where_it_stands() {
    let text = NAVION.replace("airspeed_ft_s = 176.0", "airspeed_kt = 40.0");
    let problems = file::parse(&text, "slow.toml", None, &[]).expect_err("too slow").to_string();
    assert!(problems.contains("slow.toml:6:"), "{problems}");
    assert!(problems.contains("aircraft.airspeed_kt: no trim at 20.5"), "{problems}");
    assert!(problems.contains("angle of attack"), "{problems}");
}

/// A centre of gravity far aft was told as a mistake in the speed, in radians.
#[test]
fn a_loading_that_cannot_be_held_is_not_blamed_on_the_speed() {
    for (set, words) in [
        ("aircraft.cg_mac=2", "elevator 47.0611 deg; allowed is -25 to 20 deg"),
        ("aircraft.mass_kg=90000", "angle of attack"),
        ("aircraft.climb_angle_deg=60", "throttle"),
    ] {
        let told = file::parse(NAVION, "a.toml", None, &[set.to_owned()]).expect_err("no trim");
        let told = told.to_string();
        let (key, value) = set.split_once('=').expect("two parts");
        assert!(told.contains(": aircraft: no trim at 53.6448 m/s"), "{told}");
        let given = format!("{} = {value}", key.replace("aircraft.", ""));
        assert!(told.contains(words) && told.contains(&given), "{told}");
        assert!(told.contains("airspeed_ft_s = 176.0") && !told.contains("rad,"), "{told}");
    }
}

#[test]
fn what_an_aircraft_cannot_do_is_refused_with_a_reason() {
    for (from, to, reason) in [
        (
            "name = \"navion\"\nair",
            "name = \"etkin-747\"\nair",
            "only a linear model of the aircraft is known, which holds at one flight condition",
        ),
        (
            "[loop]",
            "[[plant_change]]\nat_s = 1.0\npreset = \"ctms-pitch\"\n[loop]",
            "cannot be changed",
        ),
        ("[loop]", "[plant]\npreset = \"ctms-pitch\"\n[loop]", "not together with `"),
        ("airspeed_ft_s = 176.0", "", "airspeed_kt"),
        ("[loop]", "[aircraft.x]\n[loop]", "unknown key"),
        ("altitude_ft = 1000.0", "altitude_ft = 1000.0\nground_m = 400.0", "ground is above"),
        ("time_constant_s = 0.1", "natural_frequency_rad_s = 30.0", "it goes with"),
        ("time_constant_s = 0.1", "time_constant_s = 0.1\ndamping = 0.7", "not together with"),
        ("time_constant_s = 0.1", "travel_deg = [2.0, 5.0]", "an interval with 0 in it"),
        ("[loop]", "[sensor]\npreset = \"imu\"\n[loop]", "unknown preset"),
    ] {
        let text = NAVION.replacen(from, to, 1);
        assert_ne!(text, NAVION, "{from}");
        let problems = file::parse(&text, "wrong.toml", None, &[]).expect_err(reason).to_string();
        assert!(problems.contains(reason), "{reason}: {problems}");
    }
    let text = file::starter().to_owned() + "\n[turbulence]\nintensity = \"light\"\n";
    let problems = file::parse(&text, "plant.toml", None, &[]).expect_err("a plant").to_string();
    assert!(problems.contains("does not say how moving air acts on it"), "{problems}");
}

#[test]
fn a_trace_has_the_columns_of_its_flight_and_no_others() {
    let aircraft = study(NAVION, &[]);
    let csv = Simulation::of(&aircraft).expect("it flies").csv();
    let head = csv.lines().next().expect("a head");
    assert!(head.ends_with("kd,airspeed_m_s,altitude_m,alpha_deg,bank_deg,aileron_deg,load_factor,air_forward_m_s,air_right_m_s,air_down_m_s,north_m,east_m,heading_deg,attitude_deg,sideslip_deg,p_deg_s,r_deg_s,throttle,flight_path_deg,climb_m_s,air_roll_deg_s,air_pitch_deg_s,air_yaw_deg_s,energy_height_m"), "{head}");
    let widths: Vec<usize> = csv.lines().map(|line| line.split(',').count()).collect();
    assert!(widths.iter().all(|width| *width == widths[0]));
    let linear = flown(NAVION, &["aircraft.model=linear"]);
    assert!(linear.columns.is_empty());
    let trace = flown(NAVION, &[]);
    assert!((column(&trace, "altitude_m")[0] - 304.8).abs() < 1e-9);
    // The lift of level flight is along the vertical, the body's upward axis close to it.
    let cosine = column(&trace, "alpha_rad")[0].cos();
    assert!((column(&trace, "load_factor")[0] - cosine).abs() < 1e-9);
}

/// What is allocated is allocated before the first sample: a longer flight needs no more.
#[test]
fn a_step_of_an_aircraft_allocates_nothing() {
    let text =
        format!("{NAVION}[turbulence]\nintensity = \"light\"\n[sensor]\npreset = \"ahrs\"\n");
    let allocations = |duration: &str| {
        let scenario = study(&text, &[duration]).scenario;
        let prepared = scenario.prepare().expect("it flies");
        let controller = scenario.controllers[0].controller;
        let flight = || {
            let outcome = fly(&prepared, &controller, |_| ControlFlow::Continue(()));
            assert_eq!(outcome, Ok(Outcome::Completed));
        };
        // The first one draws into the room that a thread keeps for random numbers.
        flight();
        allocation_counter::measure(flight).count_total
    };
    assert_eq!(allocations("loop.duration_s=1.0"), allocations("loop.duration_s=20.0"));
}
