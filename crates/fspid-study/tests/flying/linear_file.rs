//! Aircraft of which only a linear model is known: flown where it holds, refused elsewhere.

use fspid_aircraft::data::Laws;
use fspid_aircraft::{AirMotion, TrimTarget, Vector3, VelocityForm};
use fspid_scenario::file::{self, aircraft};
use fspid_sim::ElevatorSign;
use fspid_study::simulation::Simulation;

use crate::flying::{NAVION, apart, flown, largest, study};

const ETKIN: [&str; 3] =
    ["aircraft.name=etkin-747", "aircraft.airspeed_ft_s=774", "aircraft.altitude_ft=40000"];
const CTMS: [&str; 3] =
    ["aircraft.name=ctms-transport", "aircraft.airspeed_ft_s=500", "aircraft.altitude_ft=20000"];

/// Values of the matrix exponential in feet and degrees: oracles/make_linear_aircraft.py.
const ETKIN_STEP: &str = include_str!("../data/etkin_step.csv");

fn refusal(text: &str, set: &[&str]) -> String {
    let set: Vec<String> = set.iter().map(|&change| change.to_owned()).collect();
    file::parse(text, "test.toml", None, &set).expect_err("it is wrong").to_string()
}

/// With changes after those that choose the aircraft.
fn with<'a>(aircraft: &[&'a str], more: &[&'a str]) -> Vec<&'a str> {
    [aircraft, more].concat()
}

/// Etkin and Reid, table 6.3, rad/s, to their printed digits.
#[test]
fn the_747_of_etkin_has_the_modes_of_the_book() {
    let study = study(NAVION, &ETKIN);
    let plant = study.scenario.plant.linear().expect("it flies linear");
    let poles = plant.transfer_function().poles().expect("poles");
    for (re, im, half_digit) in [(-0.003_289, 0.067_23, 5e-6), (-0.3719, 0.8875, 5e-5)] {
        let near = |found: f64, printed: f64| (found - printed).abs() <= half_digit;
        assert!(poles.iter().any(|pole| near(pole.re, re) && near(pole.im, im)), "{poles:?}");
    }
}

/// One degree of elevator, trailing edge down, without a controller. The polynomials have lost no more than a millionth
/// of the largest angle after 200 s, in which errors of a pole grow with time.
#[test]
fn an_open_loop_step_of_its_elevator_is_that_of_the_first_order_equations() {
    let step = "[[disturbance]]\nkind = \"step\"\nenters_at = \"elevator\"\namplitude_deg = -1.0\nat_s = 0.0\n";
    let quiet = [
        "setpoint.amplitude_deg=0.0",
        "loop.duration_s=200.0",
        "loop.sample_period_s=0.5",
        "controller.PID.kp=0.0",
        "controller.PID.ki=0.0",
        "controller.PID.kd=0.0",
    ];
    let text = format!("{NAVION}{step}").replace("[actuator]\ntime_constant_s = 0.1\n", "");
    let trace = flown(&text, &with(&ETKIN, &quiet));
    let (mut rows, mut largest) = (0, 0.0_f64);
    for line in ETKIN_STEP.lines().skip(1) {
        let numbers: Vec<f64> =
            line.split(',').map(|cell| cell.parse().expect("a number")).collect();
        let [time_s, theta_deg, q_deg_s] = numbers[..] else { panic!("{line}") };
        let row = trace.time_s.iter().position(|time| (time - time_s).abs() < 1e-9).expect("flown");
        let (theta, q) = (trace.theta_rad[row].to_degrees(), trace.q_rad_s[row].to_degrees());
        assert!((theta - theta_deg).abs() < 1e-8, "{time_s} s: {theta} and {theta_deg} deg");
        assert!((q - q_deg_s).abs() < 1e-8, "{time_s} s: {q} and {q_deg_s} deg/s");
        (rows, largest) = (rows + 1, largest.max(theta_deg.abs()));
    }
    assert!(rows == 51 && largest > 3.0, "{rows} rows, {largest} deg");
}

/// Its elevator counts the other way than that of the aircraft with derivatives, and its pitch angle grows by 56.7 times
/// its pitch rate: the plant of its polynomials knows neither.
#[test]
fn the_transport_of_the_web_course_flies_as_its_plant_does() {
    let as_plant = NAVION.replace(
        "[aircraft]\nname = \"navion\"\nairspeed_ft_s = 176.0\naltitude_ft = 1000.0",
        "[plant]\npreset = \"ctms-pitch\"",
    );
    assert_ne!(as_plant, NAVION);
    let (aircraft, plant) = (flown(NAVION, &CTMS), flown(&as_plant, &[]));
    assert!(largest(&plant.theta_rad) > 1e-3);
    assert!(apart(&aircraft.theta_rad, &plant.theta_rad) < 1e-9);
    assert!(apart(&aircraft.q_rad_s, &plant.q_rad_s) < 1e-9);
    assert!(apart(&aircraft.elevator_rad, &plant.elevator_rad) < 1e-9);
}

#[test]
fn a_gain_above_zero_holds_the_pitch_of_both() {
    for (set, sign) in
        [(ETKIN, ElevatorSign::NoseDownPositive), (CTMS, ElevatorSign::NoseUpPositive)]
    {
        let p = ["controller.PID.ki=0.0", "controller.PID.kd=0.0", "loop.duration_s=60.0"];
        let study = study(NAVION, &with(&set, &p));
        assert_eq!(study.scenario.plant.linear().expect("linear").elevator_sign(), sign);
        let simulation = Simulation::of(&study).expect("it flies");
        let theta_rad = &simulation.results[0].trace.theta_rad;
        let last = theta_rad.last().expect("a row") / 0.1_f64.to_radians();
        assert!(!simulation.results[0].metrics.verdict.is_failure());
        assert!(last > 0.5 && last < 1.5, "{set:?}: {last} of the step");
    }
}

#[test]
fn it_flies_at_its_condition_and_nowhere_else() {
    let refusal = |set: &[&str]| refusal(NAVION, &with(&ETKIN, set));
    let fast = refusal(&["aircraft.airspeed_ft_s=800"]);
    assert!(fast.contains("aircraft.airspeed_ft_s: only a linear model"), "{fast}");
    assert!(fast.contains("holds at one flight condition"), "{fast}");
    assert!(fast.contains("allowed: 774 ft/s, or within 0.5 % of it"), "{fast}");
    let low = refusal(&["aircraft.altitude_ft=39000"]);
    assert!(low.contains("allowed: 40000 ft, or within 200 ft of it"), "{low}");
    let set = ["aircraft.name=etkin-747", "aircraft.altitude_ft=40000"];
    let metric = NAVION
        .replace("airspeed_ft_s = 176.0", "airspeed_m_s = 200.0")
        .replace("altitude_ft = 1000.0", "altitude_m = 1000.0");
    let both = self::refusal(&metric, &set[..1]);
    assert!(both.contains("allowed: 235.9152 m/s"), "{both}");
    assert!(both.contains("allowed: 12192 m, or within 200 ft of it"), "{both}");
    let knots = NAVION.replace("airspeed_ft_s = 176.0", "airspeed_kt = 400.0");
    assert!(self::refusal(&knots, &set).contains("allowed: 458.5825 kt"));
    // Rounded as people round.
    let rounded = metric.replace("200.0", "236.0").replace("1000.0", "12200.0");
    assert!(study(&rounded, &set[..1]).warnings.is_empty());
}

#[test]
fn what_only_forces_can_do_is_refused_in_words() {
    for (change, reason) in [
        ("aircraft.model=nonlinear", "it has no forces to fly nonlinear"),
        ("aircraft.drag=polar", "only a linear model of the aircraft is known, which says it"),
        ("aircraft.thrust=with-speed", "only a linear model of the aircraft is known, which says"),
        ("aircraft.atmosphere=reference", "its file says no air of its own"),
        ("aircraft.ground_m=20000", "the ground is above the aircraft"),
    ] {
        for aircraft in [ETKIN, CTMS] {
            let problems = refusal(NAVION, &with(&aircraft, &[change]));
            assert!(problems.contains(reason), "{change}: {problems}");
        }
    }
    assert!(study(NAVION, &with(&ETKIN, &["aircraft.model=linear"])).warnings.is_empty());
}

#[test]
fn an_airspeed_without_a_condition_is_called_an_assumption_once() {
    let assumed = study(NAVION, &CTMS);
    let [warning] = &assumed.warnings[..] else { panic!("{:?}", assumed.warnings) };
    assert!(warning.contains("aircraft.name: \"ctms-transport\" is a linear model"), "{warning}");
    assert!(warning.contains("152.4 m/s and 6096 m are an assumption"), "{warning}");
    assert!(study(NAVION, &ETKIN).warnings.is_empty());
    // Any other is as good.
    study(NAVION, &with(&CTMS, &["aircraft.airspeed_ft_s=900", "aircraft.altitude_ft=1000"]));
}

/// Loads per angle of attack are known where the airspeed is; an assumed airspeed makes none.
#[test]
fn what_needs_an_airspeed_is_judged_where_the_file_has_one() {
    let text = format!("{NAVION}[[requirement]]\nmeasure = \"cap_rad_s2_per_g\"\nmost = 1000.0\n");
    let told = |set: &[&str]| Simulation::of(&study(&text, set)).expect("it flies").text();
    let (etkin, ctms) = (told(&ETKIN), told(&CTMS));
    // V / (g T) with the zero 1/T of the printed numerator, and the printed short period: 0.9257 over 7.09 g per rad.
    assert!(etkin.contains("met: (aircraft) cap_rad_s2_per_g 0.1305"), "{etkin}");
    assert!(ctms.contains("nobody says how fast the aircraft flies"), "{ctms}");
}

const SEVERE: &str = "[turbulence]\nintensity = \"severe\"\nseed = 3\n";
const UPDRAUGHT: &str = "[[gust]]\nkind = \"full-cycle\"\nup_m_s = 5.0\nforward_m_s = 3.0\ngradient_m = 60.0\nat_s = 1.0\n";
const B747: [&str; 4] = [
    "aircraft.name=b747-cruise-low",
    "aircraft.airspeed_ft_s=673.0",
    "aircraft.altitude_ft=20000.0",
    "aircraft.model=linear",
];

const HEAD: &str = r#"
name = "boeing"
source = "computed"
kind = "linear"
[condition]
airspeed_ft_s = 673.0
altitude_ft = 20000.0
[geometry]
span_ft = 196.0
"#;

/// The linear model of the Boeing 747 with derivatives as a file, in m and s, with w or with alpha.
fn boeing(downward: &str) -> String {
    let data = aircraft("b747-cruise-low").expect("carried");
    let boeing = data.aircraft(Laws::default(), data.standard_environment()).expect("it flies");
    let airspeed_m_s = 673.0 * 0.3048;
    let target = TrimTarget { airspeed_m_s, altitude_m: 6096.0, flight_path_rad: 0.0 };
    let trim = boeing.trim(target).expect("a trim");
    let model = boeing.linearise(&trim).longitudinal(VelocityForm::Components).expect("finite");
    let turning = |q_rad_s: f64| {
        let gust_rates_rad_s = Vector3::new(0.0, q_rad_s, 0.0);
        let motion = AirMotion { gust_rates_rad_s, ..AirMotion::STILL };
        boeing.rate(&trim.state.to_array(), &trim.controls, &motion)
    };
    let (more, less) = (turning(1e-3), turning(-1e-3));
    // Places of u, w, q in a rigid state; of pitch nothing is known by the air.
    let by_gust = |place: usize| (more[place] - less[place]) / 2e-3;
    let by_gust = [by_gust(3), by_gust(5), by_gust(11), 0.0];
    let sizes = if downward == "alpha_rad" { [1.0, airspeed_m_s, 1.0, 1.0] } else { [1.0; 4] };
    let mut text = String::from(HEAD);
    for (row, state) in ["u_m_s", downward, "q_rad_s", "theta_rad"].into_iter().enumerate() {
        let entry = |column: usize| model.a().get(row, column).expect("it is there");
        let states: Vec<f64> =
            (0..4).map(|column| entry(column) * sizes[column] / sizes[row]).collect();
        let elevator = model.b().get(row, 0).expect("it is there") / sizes[row];
        let gust = by_gust[row] / sizes[row];
        text.push_str(&format!(
            "[[equations]]\nstate = \"{state}\"\nby_states = {states:?}\nby_elevator = {elevator:?}\n\
             by_pitch_gust = {gust:?}\n"
        ));
    }
    text
}

/// The same matrices and the same air; what is left are differences of polynomials and of central differences.
#[test]
fn moving_air_acts_on_a_linear_file_as_on_the_linear_model_of_the_same_aircraft() {
    for air in [SEVERE, UPDRAUGHT] {
        let text = format!("{NAVION}{air}");
        let expected = flown(&text, &B747);
        assert!(largest(&expected.theta_rad) > 1e-3, "the air moves it");
        for downward in ["w_m_s", "alpha_rad"] {
            let folder = tempfile::tempdir().expect("a folder");
            std::fs::write(folder.path().join("boeing.toml"), boeing(downward)).expect("written");
            let text = text
                .replace("name = \"navion\"\nair", "file = \"boeing.toml\"\nair")
                .replace("176.0", "673.0")
                .replace("1000.0", "20000.0");
            let study = file::parse(&text, "test.toml", Some(folder.path()), &[]);
            let study = study.unwrap_or_else(|problems| panic!("{problems}"));
            let found = Simulation::of(&study).expect("it flies").results.remove(0).trace;
            let error = apart(&found.theta_rad, &expected.theta_rad) / largest(&expected.theta_rad);
            assert!(error < 1e-6, "{downward}: {error}");
        }
    }
}

#[test]
fn a_file_that_does_not_say_how_air_acts_flies_in_calm_air_alone() {
    for air in [SEVERE, UPDRAUGHT, "[wind]\nkind = \"steady\"\nspeed_kt = 30.0\nfrom_deg = 0.0\n"] {
        let text = format!("{NAVION}{air}");
        let problems = refusal(&text, &CTMS);
        assert!(problems.contains("does not say how moving air acts on it"), "{problems}");
        assert!(problems.contains("by_pitch_gust"), "{problems}");
        study(&text, &ETKIN);
    }
    let folder = tempfile::tempdir().expect("a folder");
    let write =
        |text: &str| std::fs::write(folder.path().join("mine.toml"), text).expect("written");
    let text = NAVION
        .replace("name = \"navion\"\nair", "file = \"mine.toml\"\nair")
        .replace("176.0", "673.0")
        .replace("1000.0", "20000.0");
    let read = |air: &str| file::parse(&format!("{text}{air}"), "t", Some(folder.path()), &[]);
    write(&boeing("w_m_s").replace("[geometry]\nspan_ft = 196.0\n", ""));
    let problems = read(SEVERE).expect_err("no span").to_string();
    assert!(problems.contains("no span, on which turbulence depends"), "{problems}");
    read(UPDRAUGHT).expect("a gust needs none");
    write(&boeing("w_m_s").replace("by_pitch_gust", "#"));
    assert!(read(UPDRAUGHT).expect_err("silent").to_string().contains("moving air acts"));
    write(HEAVE);
    assert!(read("").expect_err("no pitch").to_string().contains("is the pitch angle"));
}

/// A linear file without pitch.
const HEAVE: &str = r#"
name = "heave"
source = "made up"
kind = "linear"
[[equations]]
state = "w_m_s"
by_states = [-1.0, 200.0]
by_elevator = -5.0
[[equations]]
state = "q_rad_s"
by_states = [-0.01, -1.0]
by_elevator = -1.0
"#;

/// The flight of an aircraft file at the speed and altitude of the Boeing, or what is wrong with it.
fn of_file(aircraft: &str, air: &str) -> Result<file::Study, String> {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("mine.toml"), aircraft).expect("written");
    let text = NAVION
        .replace("name = \"navion\"\nair", "file = \"mine.toml\"\nair")
        .replace("176.0", "673.0")
        .replace("1000.0", "20000.0");
    let study = file::parse(&format!("{text}{air}"), "t", Some(folder.path()), &[]);
    study.map_err(|problems| problems.to_string())
}

const CONDITION: &str = "[condition]\nairspeed_ft_s = 673.0\naltitude_ft = 20000.0\n";

/// It says how the air acts on it by equations of u and w, but turbulence at an assumed speed would be another at another.
#[test]
fn a_linear_file_without_a_condition_flies_in_calm_air_alone() {
    let whole = boeing("w_m_s");
    let assumed = whole.replace(CONDITION, "");
    assert_ne!(assumed, whole);
    for air in [SEVERE, UPDRAUGHT, "[wind]\nkind = \"steady\"\nspeed_kt = 30.0\nfrom_deg = 0.0\n"] {
        of_file(&whole, air).expect("its speed is known");
        let problems = of_file(&assumed, air).expect_err("its speed is not known");
        assert!(problems.contains("the aircraft's file has no condition"), "{problems}");
        assert!(problems.contains("allowed: still air, or an aircraft file with a condition"));
    }
    let calm = of_file(&assumed, "").expect("calm air");
    let [warning] = &calm.warnings[..] else { panic!("{:?}", calm.warnings) };
    assert!(warning.contains("it flies in calm air alone"), "{warning}");
}

#[test]
fn a_linear_file_says_each_state_once() {
    let u = |state: &str| boeing("w_m_s").replace("state = \"theta_rad\"", state);
    for (aircraft, message) in [
        (u("state = \"u_m_s\""), "the state is that of equations[0]"),
        (u("state = \"u_ft_s\""), "the state is that of equations[0]"),
        (u("state = \"alpha_rad\""), "w and alpha are one state, which is that of equations[1]"),
    ] {
        let problems = of_file(&aircraft, "").expect_err("twice");
        assert!(problems.contains(&format!("equations[3].state: {message}")), "{problems}");
        assert!(problems.contains("allowed: one equation a state"), "{problems}");
        let alone = file::parse_aircraft(&aircraft, "mine.toml", None).expect_err("twice");
        assert!(alone.to_string().contains(message), "{alone}");
    }
}

#[test]
fn the_condition_of_a_linear_file_is_where_a_scenario_can_fly() {
    for (key, range) in [
        ("altitude_ft = 4000000.0", "-16404 to 278385"),
        ("altitude_m = 1e6", "-5000 to 84852"),
        ("altitude_m = -6000.0", "-5000 to 84852"),
    ] {
        let aircraft = boeing("w_m_s").replace("altitude_ft = 20000.0", key);
        let problems = of_file(&aircraft, "").expect_err("beyond the atmosphere");
        let name = key.split(' ').next().expect("a name");
        assert!(problems.contains(&format!("condition.{name}: ")), "{problems}");
        assert!(problems.contains(range), "{problems}");
    }
}

/// The nose turns by a moment; what would move it at once is refused at its key, and not by the order of a polynomial.
#[test]
fn air_that_would_change_the_pitch_angle_at_once_is_refused_at_its_equation() {
    let theta = |from: &str, to: &str| {
        let text = boeing("w_m_s");
        let (before, last) = text.split_at(text.rfind("[[equations]]").expect("four"));
        let changed = last.replace(from, to);
        assert_ne!(last, changed);
        format!("{before}{changed}")
    };
    let problems = of_file(&theta("by_pitch_gust = 0.0", "by_pitch_gust = 0.5"), "");
    let problems = problems.expect_err("it jumps");
    assert!(problems.contains("equations[3].by_pitch_gust: the air turns the aircraft"));
    assert!(problems.contains("found: 0.5; allowed: 0, or leave it out"), "{problems}");
    assert!(!problems.contains("numerator"), "{problems}");
    of_file(&theta("by_pitch_gust = 0.0", ""), UPDRAUGHT).expect("0 if left out");
    let moved = theta("by_states = [", "by_states = [0.1, 0.0, 1.0, 0.0] # [");
    let problems = of_file(&moved, "").expect_err("it jumps");
    assert!(problems.contains("equations[3].by_states: a gust would change the pitch"));
    // No gust acts on it, and the matrix is as good as any.
    of_file(&moved.replace("by_pitch_gust", "#"), "").expect("calm air");
}

#[test]
fn what_flies_where_a_linear_file_or_forces_choose_is_told_as_a_default() {
    let told = |set: &[&str]| {
        let settings = study(NAVION, set).settings;
        let mut model = settings.into_iter().filter(|setting| setting.path == "aircraft.model");
        let (first, second) = (model.next().expect("it is told"), model.next());
        assert!(second.is_none() && first.table == "aircraft" && first.unit.is_empty());
        (first.value, first.given)
    };
    assert_eq!(told(&[]), ("\"nonlinear\"".to_owned(), false));
    for aircraft in [ETKIN, CTMS] {
        assert_eq!(told(&aircraft), ("\"linear\"".to_owned(), false));
    }
    assert_eq!(told(&["aircraft.model=linear"]), ("\"linear\"".to_owned(), true));
    let by_file = of_file(&boeing("w_m_s"), "").expect("right").settings;
    assert!(by_file.iter().any(|it| it.path == "aircraft.model" && it.value == "\"linear\""));
}

/// No airspeed, load factor or altitude is made up for a flight that has none.
#[test]
fn its_trace_has_no_column_of_a_trim() {
    for set in [ETKIN, CTMS] {
        assert!(flown(NAVION, &set).columns.is_empty());
    }
}
