//! Requirements on the flight of an aircraft: loads, altitude, airspeed, angle of attack, bank, descent.

use fspid_scenario::measure::{Family, Measure};
use fspid_study::judgement::Judgement;
use fspid_study::simulation::Simulation;

use crate::flying::{NAVION, column, flown, largest, study};

/// A gust that lifts and drops, so that every measure moves.
const GUST: &str = "[[gust]]\nkind = \"full-cycle\"\nup_m_s = 3.0\ngradient_m = 50.0\nat_s = 1.0\n";
const FOOT_M: f64 = 0.3048;

fn judged(more: &str, set: &[&str]) -> Vec<Judgement> {
    let text = format!("{NAVION}{GUST}{more}");
    Simulation::of(&study(&text, set)).expect("it flies").judgements
}

fn asked(measure: Measure, conditions: &str) -> String {
    format!("[[requirement]]\nmeasure = \"{}\"\nleast = 0.0\n{conditions}\n", measure.name())
}

/// The value of a measure and when it was found.
fn value(measure: Measure, conditions: &str, set: &[&str]) -> (f64, f64) {
    let judgements = judged(&asked(measure, conditions), set);
    let found = judgements[0].found.as_ref().unwrap_or_else(|why| panic!("{why}"));
    (found.value, found.place.at_s.expect("a time"))
}

fn reason(measure: Measure, conditions: &str, set: &[&str]) -> String {
    let judgements = judged(&asked(measure, conditions), set);
    assert!(!judgements[0].met);
    judgements[0].found.as_ref().expect_err("no value").to_string()
}

fn near(found: f64, expected: f64) {
    assert!((found - expected).abs() <= 1e-9 * expected.abs().max(1.0), "{found} {expected}");
}

/// Computed from the columns by other words: folds over everything.
#[test]
fn every_measure_of_an_aircraft_is_what_its_trace_shows() {
    let set = ["setpoint.amplitude_deg=2.0"];
    let trace = flown(&format!("{NAVION}{GUST}"), &set);
    let of = |name: &str| column(&trace, name).to_vec();
    let most = |values: Vec<f64>| values.into_iter().fold(f64::NEG_INFINITY, f64::max);
    let least = |values: Vec<f64>| values.into_iter().fold(f64::INFINITY, f64::min);
    let measured = |measure| value(measure, "", &set).0;
    let feet = |metres: f64| metres / FOOT_M;
    let knots = |speed: f64| speed * 3600.0 / 1852.0;
    near(measured(Measure::LargestLoadFactor), most(of("load_factor")));
    near(measured(Measure::LeastLoadFactor), least(of("load_factor")));
    let start = of("altitude_m")[0];
    near(measured(Measure::AltitudeLoss), feet(start - least(of("altitude_m"))).max(0.0));
    let away: Vec<f64> = of("altitude_m").iter().map(|it| (it - start).abs()).collect();
    near(measured(Measure::AltitudeDeviation), feet(most(away)));
    near(measured(Measure::LargestAirspeed), knots(most(of("airspeed_m_s"))));
    near(measured(Measure::LeastAirspeed), knots(least(of("airspeed_m_s"))));
    let trim = 176.0 * FOOT_M;
    let away: Vec<f64> = of("airspeed_m_s").iter().map(|it| (it - trim).abs()).collect();
    near(measured(Measure::AirspeedDeviation), knots(most(away)));
    near(measured(Measure::LargestAlpha), most(of("alpha_rad")).to_degrees());
    // The navion's data hold up to 10 deg.
    near(measured(Measure::AlphaMargin), 10.0 - most(of("alpha_rad")).to_degrees());
    near(measured(Measure::LargestBank), largest(&of("bank_rad")).to_degrees());
    near(measured(Measure::LargestPitch), most(of("attitude_rad")).to_degrees());
    near(measured(Measure::LeastPitch), least(of("attitude_rad")).to_degrees());
    near(measured(Measure::LargestSink), -60.0 * feet(least(of("climb_m_s"))).min(0.0));
    near(measured(Measure::FinalSink), -60.0 * feet(*of("climb_m_s").last().expect("flown")));
}

#[test]
fn none_of_them_is_without_an_answer() {
    let climb = ["aircraft.climb_angle_deg=3.0", "setpoint.amplitude_deg=0.0"];
    for measure in of_aircraft() {
        let overshoots = measure == Measure::AltitudeOvershoot;
        let conditions = if overshoots { "target_ft = 1050.0\nto_s = 9.0" } else { "" };
        assert!(value(measure, conditions, &climb).0.is_finite(), "{}", measure.name());
    }
}

/// A climb at a steady angle: rate and altitude are trigonometry.
#[test]
fn a_steady_climb_has_the_rate_and_the_altitude_of_its_angle() {
    let text =
        NAVION.replace("altitude_ft = 1000.0", "altitude_ft = 1000.0\nclimb_angle_deg = 3.0");
    let of = |measure: Measure, conditions: &str| {
        let text = format!(
            "{text}{}",
            asked(measure, conditions)
                .replace("least = 0.0", "least = -1e9")
                .replace("-1e9", if measure.is_signed() { "-1e9" } else { "0.0" })
        );
        let study = study(&text, &["setpoint.amplitude_deg=0.0"]);
        let judgements = Simulation::of(&study).expect("it flies").judgements;
        judgements[0].found.clone().unwrap_or_else(|why| panic!("{why}")).value
    };
    let climb_ft_s = 176.0 * 3.0_f64.to_radians().sin();
    let about = |found: f64, expected: f64| {
        // The throttle stays, and the air gets thinner by 0.3 % on the way.
        assert!((found - expected).abs() < 0.01 * expected.abs() + 0.5, "{found} {expected}");
    };
    about(of(Measure::FinalSink, ""), -60.0 * climb_ft_s);
    about(of(Measure::AltitudeDeviation, ""), 10.0 * climb_ft_s);
    about(of(Measure::AltitudeDeviation, "to_s = 4.0"), 4.0 * climb_ft_s);
    let in_time = "target_ft = 1050.0\nto_s = 9.0";
    about(of(Measure::AltitudeOvershoot, in_time), 9.0 * climb_ft_s - 50.0);
    about(of(Measure::AltitudeDeviation, "target_m = 304.8\nfrom_s = 2.0"), 10.0 * climb_ft_s);
    assert!(of(Measure::AltitudeLoss, "") <= 0.0 && of(Measure::LargestSink, "") <= 0.0);
    about(of(Measure::AltitudeLoss, "target_ft = 2000.0"), 1000.0);
}

#[test]
fn a_target_that_is_not_reached_is_not_praised_for_no_overshoot() {
    let climb = ["aircraft.climb_angle_deg=3.0", "setpoint.amplitude_deg=0.0"];
    let why = |conditions: &str| reason(Measure::AltitudeOvershoot, conditions, &climb);
    assert!(why("target_ft = 5000.0").contains("was not reached"), "{}", why("target_ft = 5000.0"));
    assert!(why("target_ft = 500.0").contains("was not reached"));
    assert!(why("target_ft = 1000.0").contains("starts at the target"));
    // In time, not ever.
    assert!(why("target_ft = 1050.0\nto_s = 2.0").contains("was not reached"));
}

/// Two samples were enough for a set that asks for a held level from some second on.
#[test]
fn a_level_that_is_held_from_the_last_moments_on_is_not_evaluated() {
    let why = reason(Measure::AltitudeDeviation, "from_s = 9.98", &[]);
    assert!(why.contains("only 0.02 s were flown"), "{why}");
    assert!(value(Measure::AltitudeDeviation, "from_s = 9.0", &[]).0.is_finite());
    assert!(value(Measure::AltitudeDeviation, "from_s = 9.98\nto_s = 10.0", &[]).0.is_finite());
}

#[test]
fn when_the_worst_was_is_told() {
    let (_, at_s) = value(Measure::LargestLoadFactor, "", &[]);
    assert!(at_s > 1.0 && at_s < 4.0, "{at_s}");
    let (later, at_s) = value(Measure::LargestLoadFactor, "from_s = 6.0\nto_s = 8.0", &[]);
    assert!((6.0..=8.0).contains(&at_s) && later < value(Measure::LargestLoadFactor, "", &[]).0);
}

fn of_aircraft() -> impl Iterator<Item = Measure> {
    Measure::ALL.into_iter().filter(|measure| measure.family() == Family::Aircraft)
}

fn target(measure: Measure) -> &'static str {
    if measure == Measure::AltitudeOvershoot { "target_ft = 900.0" } else { "" }
}

#[test]
fn a_linear_plant_refuses_them_by_name() {
    for measure in of_aircraft() {
        let set = ["aircraft.model=linear"];
        let why = reason(measure, target(measure), &set);
        assert!(why.contains(measure.name()) && why.contains("linear plant"), "{why}");
    }
}

/// A flight that ends at the ground, or diverges, meets none of them however wide the limits are.
#[test]
fn a_flight_that_ends_early_meets_none_of_them() {
    for (set, why) in [
        (["aircraft.ground_m=300.0", "aircraft.climb_angle_deg=-3.0"], "hit the ground"),
        (["controller.PID.kp=-40.0", "aircraft.validity=warn"], ""),
    ] {
        for measure in of_aircraft() {
            let wide = if measure.is_signed() { "least = -1e300" } else { "least = 0.0" };
            let requirement = asked(measure, target(measure)).replace("least = 0.0", wide);
            let judgements = judged(&requirement, &set);
            assert!(!judgements[0].met, "{}", measure.name());
            let found = judgements[0].found.as_ref().expect_err("no value").to_string();
            assert!(found.contains(why), "{found}");
        }
    }
}

#[test]
fn limits_below_zero_are_for_what_can_be() {
    let text =
        |measure: &str| format!("{NAVION}[[requirement]]\nmeasure = \"{measure}\"\nleast = -1.0\n");
    let parsed = |measure: &str| fspid_scenario::file::parse(&text(measure), "a.toml", None, &[]);
    assert!(parsed("least_load_factor_g").is_ok());
    let problems = parsed("largest_bank_deg").expect_err("never below 0").to_string();
    assert!(problems.contains("requirement[0].least: out of range"), "{problems}");
    assert!(problems.contains("a finite number, 0 or above"), "{problems}");
    let both = "target_ft = 1.0\ntarget_m = 1.0\n";
    let two = format!("{NAVION}{}", asked(Measure::AltitudeLoss, both));
    let problems = fspid_scenario::file::parse(&two, "a.toml", None, &[]).expect_err("two");
    assert!(problems.to_string().contains("not together with `target_ft`"), "{problems}");
    let none = format!("{NAVION}{}", asked(Measure::AltitudeOvershoot, ""));
    let problems = fspid_scenario::file::parse(&none, "a.toml", None, &[]).expect_err("none");
    assert!(problems.to_string().contains("it goes with `altitude_overshoot_ft`"), "{problems}");
}

#[test]
fn a_set_takes_the_target_that_is_chosen() {
    let set = "[[requirement]]\nset = \"rvsm\"\ntarget_ft = 1050.0\n";
    let climb = ["aircraft.climb_angle_deg=3.0", "setpoint.amplitude_deg=0.0"];
    let text = format!("{NAVION}{set}");
    let judgements = Simulation::of(&study(&text, &climb)).expect("it flies").judgements;
    let overshoot = judgements.iter().find(|it| it.requirement.id == "rvsm/level-overshoot");
    let overshoot = overshoot.expect("asked");
    assert_eq!(overshoot.requirement.conditions.target_ft, Some(1050.0));
    // It still climbs at the end.
    let going = overshoot.found.as_ref().expect_err("it goes on").to_string();
    assert!(!overshoot.met && going.contains("still goes away"), "{going}");
    // Ten seconds are no minute: nothing was flown from there on.
    let keeping = judgements.iter().find(|it| it.requirement.id == "rvsm/level-keeping");
    assert!(keeping.expect("asked").found.is_err());
    // Without a target there is nothing to overshoot, which is said.
    let bare = format!("{NAVION}[[requirement]]\nset = \"rvsm\"\n");
    let judgements = Simulation::of(&study(&bare, &[])).expect("it flies").judgements;
    let why = judgements.iter().filter_map(|it| it.found.as_ref().err()).map(ToString::to_string);
    assert!(why.collect::<String>().contains("nobody says which altitude is aimed at"));
}

/// Requirements on the aircraft itself and on its loop.
const ASKED: &str = "[[requirement]]\nmeasure = \"short_period_damping\"\nleast = 0.3\n\
                     [[requirement]]\nmeasure = \"phase_margin_deg\"\nleast = 30.0\n\
                     [[requirement]]\nmeasure = \"cap_rad_s2_per_g\"\nmost = 3.6\n";

fn of_changed(more: &str, set: &[&str]) -> Vec<Judgement> {
    let text = format!("{NAVION}{more}{ASKED}");
    Simulation::of(&study(&text, set)).expect("it flies").judgements
}

/// Damping and anticipation were those of the aircraft of the start, with flaps that take most of the damping.
#[test]
fn the_aircraft_itself_is_judged_after_each_change_of_a_configuration() {
    let flaps = "[[configuration]]\nname = \"flaps\"\nassumption = \"made up\"\npitch.alpha = -2.0\npitch.pitch_rate = 9.0\n\
                 [[configuration_change]]\nname = \"flaps\"\nto = 1.0\nat_s = 1.0\ntakes_s = 1.0\n";
    let wide = ["aircraft.validity=warn"];
    let later = of_changed(flaps, &wide);
    let at_once = of_changed(
        flaps,
        &[wide[0], "aircraft.configuration=['flaps']", "configuration_change=[]"],
    );
    let before = of_changed(flaps, &[wide[0], "configuration_change[0].to=0.0"]);
    for place in [0, 2] {
        let value = |of: &[Judgement]| of[place].found.as_ref().expect("a value").value;
        assert!(!later[place].met && before[place].met, "{:?}", later[place]);
        assert!((value(&later) / value(&at_once) - 1.0).abs() < 1e-3, "{:?}", later[place].found);
        let at = later[place].found.as_ref().expect("a value").place.plant.expect("of later");
        assert!((at.index, at.from_s) == (1, 2.0), "{at:?}");
    }
}

/// Margins, and the aircraft itself, were those of the full tank.
#[test]
fn the_aircraft_is_judged_with_the_fuel_that_its_flight_leaves() {
    let burns = |flow_kg_s: f64| {
        let fuel =
            format!("[fuel]\non_board_kg = 227.0\nflow_kg_s = {flow_kg_s}\ntank_mac = -1.0\n");
        of_changed(&fuel, &["aircraft.validity=warn"])
    };
    let end_s = study(NAVION, &[]).scenario.timing.end_s();
    // Nearly all of it, and nearly nothing.
    let (dry, full) = (burns(226.0 / end_s), burns(1e-6));
    for place in [0, 1] {
        assert!(!dry[place].met && full[place].met, "{:?} {:?}", dry[place], full[place]);
    }
    // Where thrust decides how much is burnt the tank is empty, and nobody says that its loop is unstable for certain.
    let fuel = "[fuel]\non_board_kg = 227.0\nspecific_kg_n_s = 1e-5\ntank_mac = -1.0\n";
    let by_thrust = of_changed(fuel, &["aircraft.validity=warn"]);
    for place in [0, 1] {
        assert!(!by_thrust[place].met, "{:?}", by_thrust[place]);
        let told = format!("{:?}", by_thrust[place].found);
        assert!(!told.contains("Unstable"), "{told}");
    }
}
