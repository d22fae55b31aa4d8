//! Aircraft as people and scripts meet them on the command line; numbers are those of the handbooks.

use std::path::Path;
use std::process::{Command, Output};

use serde_json::Value;

fn fspid(arguments: &[&str], folder: &Path) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_fspid"));
    command.args(arguments).current_dir(folder).output().expect("the program starts")
}

/// `fspid aircraft …` where it writes nothing.
fn aircraft(arguments: &[&str]) -> Output {
    fspid(&[&["aircraft"], arguments].concat(), Path::new("."))
}

fn stdout(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).expect("UTF-8")
}

fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).expect("UTF-8")
}

fn text(arguments: &[&str]) -> String {
    let output = aircraft(arguments);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    stdout(&output)
}

fn json(arguments: &[&str]) -> Value {
    let text = text(&[arguments, &["--format", "json"]].concat());
    serde_json::from_str(&text).expect("JSON on standard output")
}

/// The message of a command that fails with code 2 and answers nothing.
fn refused(arguments: &[&str]) -> String {
    let output = aircraft(arguments);
    assert_eq!((output.status.code(), stdout(&output).as_str()), (Some(2), ""));
    stderr(&output)
}

fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

#[track_caller]
fn near(found: &Value, expected: f64, tolerance: f64) {
    let found = number(found);
    assert!((found - expected).abs() <= tolerance, "{found} is not {expected}");
}

/// Half of the last printed digit, and a little.
#[track_caller]
fn row(found: &Value, printed: &[f64], half_digit: f64) {
    let found = found.as_array().expect("a list");
    assert_eq!(found.len(), printed.len());
    for (found, printed) in found.iter().zip(printed) {
        near(found, *printed, 1.002 * half_digit);
    }
}

/// The handbook's flights: the air of the source, feet and pounds.
const BOOK: [&str; 4] = ["--air", "source", "--units", "english"];

#[test]
fn the_list_says_of_which_class_an_aircraft_is_and_whether_it_can_be_trimmed() {
    let list = text(&["list"]);
    assert!(list.contains("navion") && list.contains("derivatives"));
    let list = json(&["list"]);
    let said = |name: &str, key: &str| {
        let list = list["aircraft"].as_array().expect("a list");
        let found = list.iter().find(|aircraft| aircraft["name"] == name).expect("it is there");
        found[key].clone()
    };
    for (name, class, known_by) in [
        ("cessna-172", "light", "derivatives"),
        ("etkin-747", "transport", "linear"),
        ("zagi", "uav", "derivatives"),
    ] {
        assert_eq!((said(name, "class"), said(name, "known_by")), (class.into(), known_by.into()));
    }
}

#[test]
fn an_aircraft_is_shown_in_the_units_that_are_asked_for() {
    let english = json(&["show", "navion", "--units", "english"]);
    near(&english["body"]["weight_lbf"], 2750.0, 1e-9);
    near(&english["body"]["iy_slug_ft2"], 3000.0, 1e-9);
    near(&english["reference"]["airspeed_ft_s"], 176.0, 1e-9);
    let si = json(&["show", "navion"]);
    near(&si["reference"]["airspeed_m_s"], 53.6448, 1e-9);
    near(&si["coefficients"]["pitching_moment"]["pitch_rate"], -9.96, 1e-12);
    near(&si["travel"]["elevator_deg"][0], -25.0, 1e-9);
    let shown = text(&["show", "etkin-747"]);
    assert!(shown.contains("cannot be trimmed") && shown.contains("s⁴ + 0.7504680 s³"), "{shown}");
    assert!(shown.contains("altitude       12192.0 m"), "{shown}");
    assert!(shown.contains("a positive elevator turns the nose down"), "{shown}");
    let transport = json(&["show", "ctms-transport"]);
    assert_eq!(transport["elevator_sign"], "nose-up-positive");
    assert_eq!(transport["condition"], serde_json::json!({}));
}

#[test]
fn trims_have_the_printed_angles_and_thrusts() {
    let trim = |name, speed| json(&[&["trim", name, "--speed", speed], &BOOK[..]].concat());
    let navion = trim("navion", "130");
    near(&navion["trim"]["alpha_deg"], 4.55257, 5e-6);
    near(&navion["trim"]["elevator_deg"], -3.36881, 5e-6);
    near(&navion["trim"]["thrust_lbf"], 282.705, 5e-4);
    let boeing = trim("b747-cruise-low", "720ft/s");
    near(&boeing["trim"]["alpha_deg"], -0.82612, 5e-6);
    near(&boeing["trim"]["elevator_deg"], 0.67549, 5e-6);
    near(&boeing["trim"]["thrust_lbf"], 39982.93, 5e-3);
    let told = text(&[&["trim", "navion", "--speed", "130"], &BOOK[..]].concat());
    assert!(told.contains("4.55257 deg") && told.contains("282.705 lbf"), "{told}");
}

#[test]
fn one_speed_in_four_units_is_one_trim() {
    let alpha =
        |speed: &str| number(&json(&["trim", "navion", "--speed", speed])["trim"]["alpha_deg"]);
    let expected = alpha("50");
    for speed in ["50m/s", "180 km/h", "164.04199475065616ft/s", "97.19222462203024kt"] {
        assert!((alpha(speed) - expected).abs() < 1e-9, "{speed}");
    }
    let feet = json(&["trim", "navion", "--altitude", "5000ft"]);
    near(&feet["flight"]["altitude_m"], 1524.0, 1e-9);
    near(&feet["flight"]["density_kg_m3"], 1.055546, 5e-7);
}

#[test]
fn a_climb_takes_more_throttle_by_the_weight_along_the_path() {
    let throttle =
        |angle| number(&json(&["trim", "navion", "--climb-angle", angle])["trim"]["throttle"]);
    assert!(throttle("3deg") > throttle("0") && throttle("0") > throttle("-3deg"));
    assert!((throttle("3deg") - throttle("0.05235987755982988rad")).abs() < 1e-9);
}

#[test]
fn a_flight_that_cannot_be_held_says_which_limit_is_in_the_way_and_how_far_it_came() {
    let slow = refused(&["trim", "navion", "--speed", "60kt"]);
    assert!(slow.contains("no trim at 30.8667 m/s, 0 m"), "{slow}");
    assert!(slow.contains("angle of attack 10.9404 deg; allowed is -8 to 10 deg"), "{slow}");
    assert!(slow.contains("it would take angle of attack 10.9404 deg, elevator"), "{slow}");
    let steep = refused(&["modes", "navion", "--climb-angle", "20"]);
    assert!(steep.contains("throttle 3.73598; allowed is 0 to 2"), "{steep}");
}

#[test]
fn an_aircraft_with_a_linear_model_alone_gives_the_reason() {
    for command in [
        &["trim", "etkin-747"][..],
        &["derive", "etkin-747"],
        &["linearise", "etkin-747", "--speed", "200"],
        &["qualities", "ctms-transport"],
        &["envelope", "etkin-747", "--speeds", "1:2:2", "--altitudes", "0:1:2"],
    ] {
        let message = refused(command);
        assert!(message.contains("known only by its linear model"), "{command:?}: {message}");
    }
}

#[test]
fn mistakes_are_told_all_at_once_with_what_is_known() {
    let units = refused(&["trim", "navion", "--speed", "176fps", "--altitude", "2fl"]);
    assert!(units.contains("`fps` is no unit known here; known are m/s, km/h, ft/s, kt"));
    assert!(units.contains("`fl` is no unit known here; known are km, m, ft"), "{units}");
    let unknown = refused(&["show", "navon"]);
    assert!(unknown.contains("did you mean `navion`?") && unknown.contains("cessna-172"));
    for (speed, altitude) in [("-5", "0"), ("0", "0"), ("nan", "0"), ("50", "100km")] {
        refused(&["trim", "navion", "--speed", speed, "--altitude", altitude]);
    }
    assert!(refused(&["show", "missing.toml"]).contains("there is no such file"));
    assert!(refused(&["trim", "navion", "--climb-angle", "90"]).contains("between -90 and 90"));
}

#[test]
fn linear_models_have_the_printed_polynomials() {
    let linear = json(&[&["linearise", "navion", "--speed", "130"], &BOOK[..]].concat());
    let plant = &linear["theta_over_elevator"];
    row(&plant["numerator"], &[-6.404598, -9.509671, -0.898821], 5e-7);
    row(&plant["denominator"], &[1.0, 3.741500, 7.225941, 0.537982, 0.583926], 5e-7);
    let longitudinal = &linear["longitudinal"];
    assert_eq!(longitudinal["states"][0], "u_ft_s");
    assert_eq!(longitudinal["inputs"][0], "elevator_rad");
    assert_eq!(linear["lateral"]["states"][3], "phi_rad");
    let etkin = json(&["linearise", "etkin-747", "--units", "english"]);
    row(&etkin["longitudinal"]["a"][1], &[-0.09055, -0.3151, 773.98, 0.0], 1e-9);
    row(&etkin["theta_over_elevator"]["numerator"], &[-1.158, -0.3545249, -0.0038726], 5e-8);
    let angles = json(&["linearise", "navion", "--states", "speed-and-angle"]);
    assert_eq!(angles["longitudinal"]["states"][1], "alpha_rad");
    assert_eq!(angles["lateral"]["states"][0], "beta_rad");
}

#[test]
fn the_same_matrix_comes_in_both_units() {
    let entry = |units: &str, row: usize, column: usize| {
        let linear = json(&["linearise", "navion", "--units", units]);
        number(&linear["longitudinal"]["a"][row][column])
    };
    // Rate of w by pitch rate is a speed; of pitch rate by w one over a length and a time.
    assert!((entry("si", 1, 2) - 0.3048 * entry("english", 1, 2)).abs() < 1e-9);
    assert!((entry("si", 2, 1) - entry("english", 2, 1) / 0.3048).abs() < 1e-9);
}

const SCENARIO: &str = r#"
schema = 1
name = "a step"
plant = { file = "slow.toml" }
actuator = { time_constant_s = 0.1 }
loop = { sample_period_s = 0.01, duration_s = 10.0 }
setpoint = { kind = "step", amplitude_deg = 1.0, at_s = 0.0 }
controller = [
    { name = "PID", kind = "pid", kp = 1.0, ki = 0.02, kd = 0.05 },
    { name = "wild", kind = "pid", kp = 40.0, ki = 0.0, kd = 0.0 },
]
"#;

/// A folder with the scenario and the plant that it names.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("step.toml"), SCENARIO).expect("written");
    let arguments =
        ["aircraft", "linearise", "navion", "--speed", "130ft/s", "--plant", "slow.toml"];
    let output = fspid(&arguments, folder.path());
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(stderr(&output).contains("wrote slow.toml"));
    folder
}

#[test]
fn a_plant_file_of_a_linear_model_flies_in_a_scenario() {
    let folder = folder();
    let output = fspid(&["simulate", "step.toml", "--format", "json"], folder.path());
    // One of the two loops is unstable.
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    let flown: Value = serde_json::from_str(&stdout(&output)).expect("JSON");
    assert!(flown.to_string().contains("\"PID\""));
    let written = std::fs::read_to_string(folder.path().join("slow.toml")).expect("read");
    assert!(written.contains("speed_m_s = 39.62") && written.contains("Nelson"), "{written}");
    assert!(written.contains("elevator_sign = \"nose-down-positive\""));
}

#[test]
fn a_plant_file_counts_the_elevator_as_its_aircraft_does_and_knows_where_it_holds() {
    let folder = tempfile::tempdir().expect("a folder");
    let written = |name: &str| {
        let output = fspid(&["aircraft", "linearise", name, "--plant", "it.toml"], folder.path());
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        std::fs::read_to_string(folder.path().join("it.toml")).expect("read")
    };
    let transport = written("ctms-transport");
    assert!(transport.contains("elevator_sign = \"nose-up-positive\""), "{transport}");
    assert!(!transport.contains("speed_m_s"), "{transport}");
    let etkin = written("etkin-747");
    assert!(etkin.contains("elevator_sign = \"nose-down-positive\""), "{etkin}");
    assert!(etkin.contains("speed_m_s = 235.9152\naltitude_m = 12192.0\nmach = 0.8"), "{etkin}");
}

#[test]
fn modes_have_the_printed_frequencies_and_dampings() {
    let modes = json(&[&["modes", "b747-cruise-low", "--speed", "560"], &BOOK[..]].concat());
    let [short, long] = [0, 1].map(|index: usize| &modes["longitudinal"][index]);
    assert_eq!((&short["name"], &long["name"]), (&"short period".into(), &"phugoid".into()));
    near(&short["natural_frequency_rad_s"], 1.03354, 5e-6);
    near(&short["damping_ratio"], 0.46898, 5e-6);
    near(&long["natural_frequency_rad_s"], 0.07881, 5e-6);
    near(&long["damping_ratio"], 0.02490, 5e-6);
    let (half_s, pole) = (number(&short["time_to_half_s"]), number(&short["pole_rad_s"][0]));
    assert!((half_s + std::f64::consts::LN_2 / pole).abs() < 1e-12);
    let names: Vec<&Value> =
        modes["lateral"].as_array().expect("a list").iter().map(|mode| &mode["name"]).collect();
    assert!(names.contains(&&"Dutch roll".into()) && names.contains(&&"spiral".into()));
    let diverging = text(&["modes", "b747-cruise-high"]);
    assert!(diverging.contains("spiral") && diverging.contains("diverges"), "{diverging}");
    let without_speed = text(&["modes", "ctms-transport"]);
    assert!(without_speed.contains("neutral") && !without_speed.contains("e-17"));
}

#[test]
fn every_printed_digit_of_the_papers_navion_comes_out() {
    let derived = json(&["derive", "navion", "--units", "english"]);
    let paper = &derived["paper"];
    assert_eq!(paper["verdict"], "every printed digit comes out");
    let found = paper["coefficients"].as_array().expect("a list");
    for (found, exact) in found.iter().zip([11.730435, 22.57798, 4.9676, 12.941]) {
        near(&found["derived"], exact, 5e-10);
    }
    near(&derived["derivatives"]["m_w_per_ft_s"], -0.04997, 5e-6);
    near(&derived["derivatives"]["z_elevator_ft_s2"], -28.169, 5e-4);
    near(&derived["derivatives"]["m_q_per_s"], -2.0767, 5e-5);
}

#[test]
fn the_papers_747_comes_out_with_two_odd_constants_and_the_text_says_so() {
    let derived = json(&["derive", "b747-cruise-low"]);
    assert!(number(&derived["paper"]["worst_half_digits"]) <= 1.5);
    let rows = &derived["theta_over_elevator"];
    row(&rows["source"]["numerator"], &[-1.689707, -0.837298, -0.009776], 5e-7);
    row(&rows["constant_thrust"]["numerator"], &[-1.689707, -0.836295, -0.009285], 5e-7);
    row(&rows["simplified"]["denominator"], &[1.0, 1.179222, 1.597643, 0.012751, 0.007308], 5.3e-7);
    row(&rows["printed_sign"]["numerator"], &[-1.689641, -0.950206, -0.010587], 5e-7);
    assert_eq!(
        (&rows["source"]["stable"], &rows["printed_sign"]["stable"]),
        (&true.into(), &false.into())
    );
    let told = text(&["derive", "b747-cruise-low"]);
    assert!(told.contains("within 1.4 units of half the last printed digit"), "{told}");
    assert!(told.contains("32.37072 ft/s²") && told.contains("287.4994 psf"), "{told}");
    assert!(told.contains("no source has them"), "{told}");
    assert!(json(&["derive", "cessna-172"])["paper"].is_null());
}

/// The handbook's n/α and CAP are for g = 32.2 ft/s², these for standard gravity: 0.08 % apart. Its 2.928 and 2.471
/// rad/s are read off a grid; elsewhere it has the first as 2.929.
#[test]
fn qualities_have_the_handbooks_values_and_name_their_clauses() {
    let boeing = json(&["qualities", "b747-paper"]);
    let values = &boeing["values"];
    near(&values["n_alpha_g_per_rad"], 10.170 * 9.81456 / 9.80665, 6e-4);
    near(&values["cap_rad_s2_per_g"], 0.1518 * 9.80665 / 9.81456, 6e-5);
    near(&values["neutral_rad_s"], 2.929, 6e-4);
    near(&values["bandwidth_rad_s"], 1.445, 6e-4);
    near(&values["phase_delay_s"], 0.0697, 6e-5);
    let level = |judged: &Value, title: &str| {
        let levels = judged["levels"].as_array().expect("a list");
        let found = levels.iter().find(|level| level["requirement"] == title).expect("judged");
        assert!(found["clause"].as_str().expect("a clause").starts_with("MIL-"));
        found["level"].clone()
    };
    assert_eq!(level(&boeing, "control anticipation parameter"), 1);
    assert_eq!(level(&boeing, "phugoid damping"), 2);
    let approach = json(&["qualities", "b747-paper", "--category", "C"]);
    assert_eq!(level(&approach, "control anticipation parameter"), 2);
    let late = json(&["qualities", "b747-paper", "--delay", "50ms"]);
    near(&late["values"]["neutral_rad_s"], 2.471, 1e-3);
    near(&late["values"]["phase_delay_s"], 0.1131, 6e-5);
    let navion = text(&["qualities", "navion", "--class", "I", "--category", "a"]);
    for clause in ["MIL-F-8785C 3.2.2.1.2, table IV", "MIL-F-8785C 3.3.1.1, table VI"] {
        assert!(navion.contains(clause), "{navion}");
    }
    assert!(refused(&["qualities", "navion", "--servo", "-1"]).contains("--servo must be"));
    assert!(refused(&["qualities", "navion", "--delay", "1h"]).contains("known are ms, s"));
}

/// It stood in JSON alone.
#[test]
fn what_is_not_asked_of_a_requirement_is_told_in_the_text() {
    let words = text(&["qualities", "navion", "--class", "I", "--category", "a"]);
    let words = words.split_whitespace().collect::<Vec<_>>().join(" ");
    let told = "Dutch roll: damping, its product with the frequency, and the frequency; the more damping that large ratios of roll to sideslip take";
    assert!(words.contains(told) && words.contains("is NOT ASKED FOR here"), "{words}");
}

#[test]
fn an_envelope_says_at_each_point_what_holds_or_what_is_in_the_way() {
    let folder = folder();
    let grid = ["--speeds", "35:85:6", "--altitudes", "0:5000:6"];
    let arguments =
        [&["aircraft", "envelope", "navion", "--csv", "points.csv", "--svg", "maps"], &grid[..]];
    let output = fspid(&arguments.concat(), folder.path());
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(stdout(&output).contains("of 36 points can be flown"), "{}", stdout(&output));
    let csv = std::fs::read_to_string(folder.path().join("points.csv")).expect("read");
    let mut lines = csv.lines();
    let heading = lines.next().expect("a heading");
    assert!(heading.starts_with("airspeed_m_s,altitude_m,flyable,reason,alpha_deg,elevator_deg"));
    assert_eq!(lines.clone().count(), 36);
    let columns = heading.split(',').count();
    assert!(lines.clone().all(|line| line.split(',').count() == columns), "{csv}");
    let fast = lines.find(|line| line.starts_with("85.0,0.0,")).expect("a point");
    assert!(fast.contains("airspeed 85 m/s; allowed is 32.004 to 82.296 m/s"), "{fast}");
    for map in ["alpha", "elevator", "throttle", "short_period_damping", "cap_level"] {
        let path = folder.path().join(format!("maps/{map}.svg"));
        let svg = std::fs::read_to_string(path).expect("drawn");
        assert!(svg.contains("no trim there"), "{map}");
    }
    let one = json(&["envelope", "navion", "--speeds", "45:55:3", "--altitudes", "0:0:1"]);
    let point = json(&["trim", "navion", "--speed", "45"]);
    assert_eq!(one["points"][0]["alpha_deg"], point["trim"]["alpha_deg"]);
}

#[test]
fn an_envelope_judges_the_sampled_loop_of_a_scenario_at_each_point() {
    let folder = folder();
    let ask = |controller: &[&str]| {
        let grid = ["--speeds", "40:60:3", "--altitudes", "0:2000:2", "--scenario", "step.toml"];
        let base = ["aircraft", "envelope", "navion", "--format", "json"];
        fspid(&[&base[..], &grid, controller].concat(), folder.path())
    };
    let points = |controller: &[&str]| -> Vec<(f64, Value)> {
        let output = ask(controller);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        let found: Value = serde_json::from_str(&stdout(&output)).expect("JSON");
        let points = found["points"].as_array().expect("points").clone();
        let told = |point: &Value| {
            (number(&point["loop_spectral_radius"]), point["loop_gain_margin_db"].clone())
        };
        points.iter().map(told).collect()
    };
    assert!(points(&["--controller", "PID"]).iter().all(|(radius, margin)| {
        *radius < 1.0 && margin.as_f64().is_some_and(|margin| margin > 6.0)
    }));
    let wild = points(&["--controller", "wild"]);
    assert!(wild.iter().all(|(radius, margin)| *radius > 1.0 && margin.is_null()));
    for (controller, reason) in [
        (&[][..], "--controller is missing; the scenario has PID, wild"),
        (&["--controller", "FSPID"], "`FSPID` is not there; the scenario has PID, wild"),
    ] {
        let output = ask(controller);
        assert_eq!(output.status.code(), Some(2));
        assert!(stderr(&output).contains(reason), "{}", stderr(&output));
    }
}

#[test]
fn ranges_of_an_envelope_that_cannot_be_are_refused() {
    for (speeds, altitudes) in [
        ("40:80", "0:1:2"),
        ("80:40:3", "0:1:2"),
        ("40:80:9999", "0:1:2"),
        ("40:80fps:3", "0:1:2"),
        ("-40:80:3", "0:1:2"),
        ("40:80:3", "x:1:2"),
    ] {
        refused(&["envelope", "navion", "--speeds", speeds, "--altitudes", altitudes]);
    }
}

const TOY: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../fspid-daveml/tests/data/toy.dml");

#[test]
fn an_imported_model_passes_its_check_cases_and_reads_back() {
    let folder = tempfile::tempdir().expect("a folder");
    let import =
        |arguments: &[&str]| fspid(&[&["aircraft", "import"], arguments].concat(), folder.path());
    let output = import(&[TOY, "--out", "toy.toml"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(stdout(&output).contains("check cases: all 5 passed"), "{}", stdout(&output));
    let again = import(&["toy.toml", "--out", "again.toml"]);
    assert_eq!(stdout(&again), stdout(&output));
    let written = ["toy.toml", "again.toml"]
        .map(|name| std::fs::read(folder.path().join(name)).expect("read"));
    assert_eq!(written[0], written[1]);
}

/// Only --iy was known.
#[test]
fn every_moment_of_inertia_can_be_loaded() {
    for (option, key) in [("--ix", "ix_kg_m2"), ("--iy", "iy_kg_m2"), ("--iz", "iz_kg_m2")] {
        let trim = json(&["trim", "navion", option, "5000 kg m2"]);
        near(&trim["flight"][key], 5000.0, 1e-9);
        let told = refused(&["trim", "navion", option, "0 kg m2"]);
        assert!(told.contains(&format!("{option} must be above 0")), "{told}");
    }
}

#[test]
fn an_import_that_fails_says_where_and_writes_nothing() {
    let folder = tempfile::tempdir().expect("a folder");
    let good = std::fs::read_to_string(TOY).expect("read");
    let wrong = good.replacen("<signalValue>", "<signalValue>9", 1);
    let broken = good.replacen("</variableDef>", "", 1);
    assert!(wrong != good && broken != good);
    for (name, text, reason) in
        [("wrong.dml", wrong, "check case"), ("broken.dml", broken, "broken.dml:")]
    {
        std::fs::write(folder.path().join(name), text).expect("written");
        let output = fspid(&["aircraft", "import", name, "--out", "out.toml"], folder.path());
        assert_eq!(output.status.code(), Some(2), "{name}");
        assert!(stderr(&output).contains(reason), "{}", stderr(&output));
        assert!(!folder.path().join("out.toml").exists());
    }
    let output = fspid(&["aircraft", "import", TOY, "--out", "missing/out.toml"], folder.path());
    assert_eq!(output.status.code(), Some(4));
}

/// An aircraft file in a folder of its own, with a change, and what `check` says of it.
fn checked(change: (&str, &str), arguments: &[&str]) -> Output {
    let folder = tempfile::tempdir().expect("a folder");
    let begun = fspid(&["init", "--template", "aircraft", "-"], folder.path());
    let text = stdout(&begun).replace(change.0, change.1);
    std::fs::write(folder.path().join("mine.toml"), text).expect("written");
    fspid(&[&["check", "mine.toml"], arguments].concat(), folder.path())
}

#[test]
fn check_tells_the_motions_of_an_aircraft_and_what_in_its_numbers_is_hardly_meant() {
    let good = checked(("", ""), &[]);
    assert_eq!((good.status.code(), stderr(&good).as_str()), (Some(0), ""));
    let motions = "mine.toml: good; My aircraft, 17 m/s, 100 m\nshort period 14.8 rad/s, damping 0.78; phugoid 0.582 rad/s, damping 0.124; ";
    assert!(stdout(&good).starts_with(motions), "{}", stdout(&good));

    let turned = checked(("elevator = -0.8488", "elevator = 0.8488"), &["--format", "json"]);
    let answer: Value = serde_json::from_slice(&turned.stdout).expect("JSON");
    let warning = answer["warnings"][0].as_str().expect("a warning");
    assert!(warning.starts_with("pitch by elevator is 0.8488: its trailing edge down does not"));
    assert!(stderr(&turned).contains(warning));
    near(&answer["modes"]["longitudinal"][0]["damping_ratio"], 0.78, 0.005);

    let slow = checked(("airspeed_m_s = 17.0", "airspeed_m_s = 11.0"), &[]);
    assert_eq!(slow.status.code(), Some(0));
    assert!(stdout(&slow).ends_with("cannot be trimmed at the flight condition of its data\n"));
    let why = "warning: at the flight condition of its data: ";
    assert!(stderr(&slow).contains(why), "{}", stderr(&slow));

    let wrong = checked(("iy_kg_m2", "iyy_kg_m2"), &[]);
    assert_eq!((wrong.status.code(), stdout(&wrong).as_str()), (Some(2), ""));
    assert!(stderr(&wrong).contains("mass.iyy_kg_m2: unknown key"), "{}", stderr(&wrong));
}

/// A scenario with such an aircraft was flown without a word.
#[test]
fn a_scenario_says_what_is_hardly_meant_in_its_aircraft() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path();
    let template = ["init", "--template"];
    fspid(&[&template[..], &["aircraft", "mine.toml"]].concat(), path);
    let scenario =
        stdout(&fspid(&[&template[..], &["aircraft-in-turbulence", "-"]].concat(), path));
    let scenario = scenario.replace("name = \"navion\"", "file = \"mine.toml\"").replace(
        "airspeed_ft_s = 176.0\naltitude_ft = 5000.0",
        "airspeed_m_s = 17.0\naltitude_m = 100.0",
    );
    std::fs::write(path.join("pitch.toml"), scenario).expect("written");
    let set = "aircraft.file.longitudinal.pitch.alpha=0.1";
    let output = fspid(&["check", "pitch.toml"], path);
    assert_eq!((output.status.code(), stderr(&output).as_str()), (Some(0), ""));
    let output = fspid(&["check", "pitch.toml", "--set", set], path);
    assert!(
        stderr(&output).contains("warning: the aircraft's pitch by alpha is 0.1: "),
        "{}",
        stderr(&output)
    );
}
