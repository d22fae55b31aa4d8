//! The reports as documents: complete, self-contained, well-formed, escaped, and the same each time.

use fspid_scenario::file::{self, Study};
use fspid_study::report;
use fspid_study::simulation::Simulation;

use crate::sound::assert_sound;

fn flight(text: &str) -> (Study, Simulation) {
    let study = file::parse(text, "test.toml", None, &[]).expect("the scenario is right");
    let simulation = Simulation::of(&study).expect("it can be flown");
    (study, simulation)
}

fn of_flight(text: &str) -> String {
    let (study, simulation) = flight(text);
    report::of_simulation(&study, &simulation)
}

/// The card blamed the step for the load: "Settled. First step: … overshoot 22.77 %" where the step alone has 16.86 %.
#[test]
fn the_card_of_a_flight_says_that_a_load_is_in_the_measures_of_its_step() {
    let load = "First step, with what disturbs from 4 s on in it: rise time";
    let page = of_flight(file::starter());
    assert_eq!(page.matches(load).count(), 2);
    assert!(!page.contains("First step: "));
    let calm = ["disturbance=[]".to_owned()];
    let study = file::parse(file::starter(), "test.toml", None, &calm).expect("right");
    let page = report::of_simulation(&study, &Simulation::of(&study).expect("it flies"));
    assert!(page.matches("First step: rise time").count() == 2 && !page.contains(load));
}

/// A scenario with a hostile name, whose first controller diverges and whose second accumulates.
const HOSTILE: &str = r#"
schema = 1
name = "<script>alert('x')</script> & \"quotes\" {{ 7 * 6 }}"
[plant]
preset = "navion-paper"
[actuator]
time_constant_s = 0.1
[loop]
sample_period_s = 0.01
duration_s = 10.0
[setpoint]
kind = "square"
amplitude_deg = 1.0
half_period_s = 2.5
bipolar = true
[[controller]]
name = "<img src=x onerror=alert(1)>"
kind = "p"
kp = 60.0
[[controller]]
name = "</svg><script>F</script>"
kind = "fspid"
nominal = { kp = 0.7, ki = 0.07, kd = 0.05 }
law = "accumulating"
supervisor = { table = "printed", range = 40.0, error_scale = 30.0, change_scale = 30.0, output_scale = { kp = 0.01, ki = 0.001, kd = 0.001 } }
[[requirement]]
measure = "overshoot_pct"
most = 5.0
"#;

/// Bytes as letters, three in four.
fn base64(bytes: &[u8]) -> String {
    const LETTERS: &[u8] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let four = |three: &[u8]| {
        let bits = three.iter().fold(0_usize, |bits, byte| (bits << 8) | usize::from(*byte));
        let bits = bits << (8 * (3 - three.len()));
        let letter = |n: usize| match n <= three.len() {
            true => char::from(LETTERS[(bits >> (18 - 6 * n)) & 63]),
            false => '=',
        };
        (0..4).map(letter).collect::<String>()
    };
    bytes.chunks(3).map(four).collect()
}

#[test]
fn a_browser_may_run_the_script_of_reports_and_no_other() {
    use fspid_page::page::{SCRIPT, SCRIPT_DIGEST};
    use sha2::{Digest as _, Sha256};
    assert_eq!(SCRIPT_DIGEST, format!("sha256-{}", base64(&Sha256::digest(SCRIPT))));
    let html = of_flight(HOSTILE);
    let policy = format!(
        "default-src 'none'; style-src 'unsafe-inline'; img-src data:; script-src '{SCRIPT_DIGEST}'"
    );
    assert!(html.contains(&policy), "{}", &html[..600]);
}

#[test]
fn two_reports_of_a_flight_have_the_same_bytes() {
    assert!(of_flight(HOSTILE) == of_flight(HOSTILE));
}

#[test]
fn names_stay_text_wherever_they_appear() {
    let html = of_flight(HOSTILE);
    assert_sound(&html);
    assert!(html.contains("&lt;script&gt;alert("));
    assert!(html.matches("<script").count() == 1 && !html.contains("onerror=alert(1)>"));
    assert!(html.contains("{{ 7 * 6 }}"), "a name is no template");
}

#[test]
fn a_flight_that_diverged_shows_that_and_no_measure() {
    let html = of_flight(HOSTILE);
    let verdict = html.find("DIVERGED").expect("said in capitals");
    assert!(verdict < html.find("Time responses").expect("later"), "the verdict comes first");
    let (_, row) =
        html.split_once("<th scope=\"row\">&lt;img").expect("a row of the failed controller");
    let (row, _) = row.split_once("</tr>").expect("closed");
    assert!(row.contains("diverged at t ="), "{row}");
    assert!(!row.contains("class=\"number\""), "{row}");
    assert!(html.contains("NOT MET"));
}

#[test]
fn an_accumulating_law_without_limits_is_warned_of() {
    let html = of_flight(HOSTILE);
    assert!(html.contains("This law adds increments up."));
    assert!(html.contains("at rest the accumulating law moves"), "the warning of the file");
}

#[test]
fn a_supervisor_that_sees_something_else_than_the_change_is_described_in_words() {
    let words = [
        "reference model of second order with 1.250 rad",
        "have their centres at 0.2000 and 0.5000",
        "moves by 3.000 per unit of kd",
    ];
    let plain = of_flight(file::starter());
    let text = file::starter().replace(
        "range = 5.0",
        "range = 5.0\nsecond_input = \"error-and-model-error\"\nmodel = { bandwidth_rad_s = 1.25 }\nerror_set_centres = [0.2, 0.5]",
    );
    let text = text.replace(
        "law = \"memoryless\"",
        "law = \"memoryless\"\ngain_coupling = { rate_gain_per_kd = 3.0 }",
    );
    let html = of_flight(&text);
    assert_sound(&html);
    for words in words {
        assert!(html.contains(words) && !plain.contains(words), "{words}");
    }
}

#[test]
fn the_starter_s_report_is_sound_and_shows_the_defaults() {
    let html = of_flight(file::starter());
    assert_sound(&html);
    for setting in
        ["sample_guard_deg", "integral", "supervisor.defuzzifier", "actuator.delay_samples"]
    {
        assert!(html.contains(&format!("<th scope=\"row\">{setting}</th>")), "{setting}");
    }
}

#[test]
fn a_flight_without_a_step_has_a_report() {
    let text = file::starter().replace("amplitude_deg = 5.0\n", "amplitude_deg = 0.0\n");
    let html = of_flight(&text);
    assert_sound(&html);
    assert!(html.contains("Flown"));
}

#[test]
fn a_flight_of_a_thousand_steps_does_not_bury_its_report() {
    let text = HOSTILE.replace("half_period_s = 2.5", "half_period_s = 0.02");
    let html = of_flight(&text);
    assert_sound(&html);
    assert!(html.contains("more steps: `fspid simulate --format json` lists them all"));
    assert!(html.len() < 2_000_000, "{} bytes", html.len());
}

/// A Navion with gains that go with dynamic pressure.
const SCHEDULED: &str = r#"
schema = 1
name = "scheduled"
[aircraft]
name = "navion"
airspeed_m_s = 60.0
altitude_m = 1000.0
model = "linear"
[loop]
sample_period_s = 0.01
duration_s = 1.0
[setpoint]
kind = "step"
amplitude_deg = 1.0
at_s = 0.0
[[controller]]
name = "PID"
kind = "pid"
kp = 0.8
ki = 0.4
kd = 0.2
rate_gain = 0.1
derivative_filter_s = 0.05
schedule = { dynamic_pressure_pa = 1000.0, exponent = -1.0 }
[[controller]]
name = "P"
kind = "p"
kp = 0.8
rate_gain = 0.1
schedule = { dynamic_pressure_pa = 1000.0 }
"#;

#[test]
fn a_report_shows_the_gains_that_fly() {
    let (study, simulation) = flight(SCHEDULED);
    let page = report::of_simulation(&study, &simulation);
    assert!(page.contains("Gains that fly"), "no table");
    assert!(page.contains("those of the file times 0.49"), "no factor");
    let lines: Vec<String> = study.derived_gains.iter().map(ToString::to_string).collect();
    assert!(lines[1].starts_with("P: kp 0.39"), "{lines:?}");
    assert!(lines[1].contains("schedule at a dynamic pressure of 2000.9"), "{lines:?}");
}

#[test]
fn a_report_says_what_was_set_from_outside_of_its_file() {
    let set = ["loop.duration_s=2.0".to_owned(), "controller.P.kp=1.0 & up".to_owned()];
    let text = HOSTILE.replace("<img src=x onerror=alert(1)>", "P");
    let study = file::parse(&text, "test.toml", None, &set[..1]).expect("the scenario is right");
    let simulation = Simulation::of(&study).expect("it can be flown");
    let page = report::of_simulation(&study, &simulation);
    let command = "fspid simulate FILE --set loop.duration_s=2.0 --report OUT.html";
    assert!(page.contains(command), "{command}");
    assert!(of_flight(&text).contains("fspid simulate FILE --report OUT.html"));
    let mut hostile = study;
    hostile.overrides = set.to_vec();
    let page = report::of_simulation(&hostile, &simulation);
    assert!(page.contains("--set &#x27;controller.P.kp=1.0 &amp; up&#x27;"), "quoted and escaped");
}
